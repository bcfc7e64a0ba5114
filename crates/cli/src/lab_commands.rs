//! Commands of the laboratory: laws, chart, stability, page of accuracy, benchmarks.

use crate::arguments::{AccuracyTask, BenchTask, ChartTask, StabilityTask, Validate};
use crate::bar::Bar;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toile_lab::{ChartPlan, Check, HardRun, LabError, Law, Limit, Outcome, Section};
use toile_session::Watcher;

impl From<LabError> for Failure {
    fn from(error: LabError) -> Self {
        match error {
            LabError::Unknown { .. } => Self::bad_input(error),
            other => Self::failed(other),
        }
    }
}

/// The laws.
pub fn validate(validate: &Validate, output: &Output) -> Result<Value, Failure> {
    if validate.list {
        return list_laws(&toile_lab::laws_named(&validate.laws)?, output);
    }
    let checks = toile_lab::validate(&validate.laws, &mut Bar::new())?;
    output.say(toile_lab::table(&checks));
    output.say(toile_lab::law_table(&checks));
    let failed = checks.iter().filter(|check| !check.passed()).count();
    let listed: Vec<Value> = checks
        .iter()
        .map(|check| {
            let mut value = serde_json::to_value(check).unwrap_or_default();
            value["pass"] = check.passed().into();
            value
        })
        .collect();
    let report = json!({ "checks": listed, "failed": failed });
    let summary = format!("{} of {} failed", failed, count(checks.len(), "check"));
    if failed > 0 {
        return Err(Failure::failed(summary).with_report(report));
    }
    let seconds: f64 = checks.iter().map(|check: &Check| check.seconds).sum();
    output.say(format!(
        "all {} passed in {seconds:.1} s",
        count(checks.len(), "check")
    ));
    Ok(report)
}

/// Names laws with all their tolerances, without measuring them.
fn list_laws(laws: &[&Law], output: &Output) -> Result<Value, Failure> {
    for law in laws {
        output.say(format!("{:<16} {}", law.name, law.title));
        for tolerance in law.tolerances {
            output.say(format!("{:<18} {tolerance}", ""));
        }
    }
    let listed: Vec<Value> = laws
        .iter()
        .map(|law| json!({ "name": law.name, "title": law.title, "tolerances": law.tolerances }))
        .collect();
    Ok(json!({ "laws": listed }))
}

/// Writes named texts into a folder and says so.
fn write_files(
    folder: &Path,
    files: &[(String, String)],
    output: &Output,
) -> Result<Vec<PathBuf>, Failure> {
    let written = toile_lab::write_files(folder, files)?;
    for path in &written {
        output.say(format!("wrote {}", path.display()));
    }
    Ok(written)
}

/// Speed against accuracy.
pub fn chart(task: &ChartTask, output: &Output) -> Result<Value, Failure> {
    let mut bar = Bar::new();
    let made = match (&task.freeze, &task.reference) {
        (Some(folder), _) => Some(toile_lab::freeze(folder)?),
        (None, Some(folder)) => Some(toile_lab::reference(&task.scenes, folder, &mut bar)?),
        (None, None) => None,
    };
    if let Some(files) = made {
        output.say(format!("wrote {}", count(files.len(), "file")));
        return Ok(json!({ "files": files }));
    }
    let plan = if task.quick {
        ChartPlan::QUICK
    } else {
        ChartPlan::FULL
    };
    toile_lab::ready_to_write(&task.out, None)?;
    let data = toile_lab::chart(&task.scenes, plan, &mut bar)?;
    let mut files = toile_lab::chart_files(&data)?;
    if !task.quick && task.scenes.is_empty() {
        files.extend(toile_lab::locking_files(&toile_lab::locking(&mut bar)?)?);
    }
    drop(bar);
    let table = toile_lab::when_to_use(&data);
    output.say(&table);
    let written = write_files(&task.out, &files, output)?;
    Ok(json!({ "files": written, "chart": data }))
}

/// Where methods fail.
pub fn stability(task: &StabilityTask, output: &Output) -> Result<Value, Failure> {
    toile_lab::ready_to_write(&task.out, None)?;
    let mut bar = Bar::new();
    let cells = toile_lab::stability_map(&mut bar)?;
    let limits = toile_lab::limits(&mut bar)?;
    let hard = toile_lab::hard_cases(&mut bar)?;
    drop(bar);
    let table = toile_lab::stability_table(&limits, &hard);
    output.say(&table);
    let files = toile_lab::stability_files(&cells, &limits, &hard)?;
    let written = write_files(&task.out, &files, output)?;
    let report = json!({ "files": written, "limits": limits, "hard_cases": hard });
    let broken = what_does_not_hold(&limits, &hard);
    if broken.is_empty() {
        return Ok(report);
    }
    Err(Failure::failed(broken.join("\n")).with_report(report))
}

/// What the tables promise and the runs did not keep, a line each.
fn what_does_not_hold(limits: &[Limit], hard: &[HardRun]) -> Vec<String> {
    let missed = limits.iter().filter(|limit| !limit.holds()).map(|limit| {
        format!(
            "{} at {:.0e} N/m blows up at {:.3e} s, not at its limit of {:.3e} s",
            limit.method, limit.stiffness, limit.measured, limit.theory
        )
    });
    let unsound = hard
        .iter()
        .filter(|run| run.outcome == Outcome::Unsound)
        .map(|run| {
            format!(
                "{} in the case \"{}\" went on with an impossible state: {}",
                run.method, run.case, run.detail
            )
        });
    missed.chain(unsound).collect()
}

/// The page of accuracy.
pub fn accuracy(task: &AccuracyTask, output: &Output) -> Result<Value, Failure> {
    let chosen = toile_lab::sections_named(&task.sections)?;
    if task.list {
        return Ok(list_sections(&chosen, output));
    }
    if let Some(document) = &task.write {
        toile_lab::ready_to_write(&toile_lab::charts_beside(document), Some(document))?;
    }
    let provenance = toile_lab::provenance();
    let mut measured = Vec::new();
    for (number, section) in chosen.iter().enumerate() {
        let mut bar = Bar::new();
        let place = format!("{}, {} of {}", section.name, number + 1, chosen.len());
        let found = section.measure(&mut |stage: &str, share: f64, detail: &str| {
            bar.progress(&place, share, &format!("{stage} {detail}"))
        })?;
        drop(bar);
        output.say(format!("{}\n", found.text));
        measured.push(found);
    }
    output.say(&provenance);
    let written = match &task.write {
        Some(document) => toile_lab::write_page(document, &measured, &provenance)?,
        None => Vec::new(),
    };
    for path in &written {
        output.say(format!("wrote {}", path.display()));
    }
    let listed = measured.iter().map(|found| {
        json!({ "name": found.name, "text": found.text, "wall_s": found.wall_s, "cpu_s": found.cpu_s })
    });
    Ok(json!({
        "sections": listed.collect::<Vec<_>>(),
        "measured": provenance,
        "files": written,
    }))
}

/// Names sections with the commands that measure the same.
fn list_sections(sections: &[&Section], output: &Output) -> Value {
    for section in sections {
        output.say(format!("{:<10} {}", section.name, section.command));
    }
    let listed: Vec<Value> = sections
        .iter()
        .map(|section| json!({ "name": section.name, "title": section.title, "command": section.command }))
        .collect();
    json!({ "sections": listed })
}

/// Benchmarks.
pub fn bench(task: &BenchTask, output: &Output) -> Result<Value, Failure> {
    if task.list {
        let names = toile_lab::bench_names();
        output.say(names.join("\n"));
        return Ok(json!({ "benchmarks": names }));
    }
    let found = toile_lab::bench(&task.names, &mut Bar::new())?;
    output.say(toile_lab::bench_table(&found));
    Ok(json!({ "benchmarks": found }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stability_holds_when_limits_are_met_and_no_run_is_unsound_and_else_names_each() {
        let limit = |measured| Limit {
            method: "velocity-verlet",
            stiffness: 1e4,
            theory: 1e-3,
            measured,
        };
        let run = |outcome| HardRun {
            case: "a body that jumps",
            method: "bdf2",
            outcome,
            detail: "9 J where 1 J are possible".to_owned(),
        };
        let kept = [Outcome::Sound, Outcome::Stopped, Outcome::Slow].map(run);
        assert!(what_does_not_hold(&[limit(1.001e-3)], &kept).is_empty());
        let broken = what_does_not_hold(&[limit(2e-3)], &[run(Outcome::Unsound)]);
        assert!(broken[0].contains("velocity-verlet") && broken[0].contains("2.000e-3"));
        assert!(broken[1].contains("bdf2") && broken[1].contains("9 J"));
        assert_eq!(broken.len(), 2);
    }
}
