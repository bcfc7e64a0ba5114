//! Commands of the laboratory: laws, chart, stability, benchmarks.

use crate::arguments::{BenchTask, ChartTask, StabilityTask, Validate};
use crate::bar::Bar;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toile_lab::{ChartPlan, Check, LAWS, LabError, Outcome};

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
        for law in &LAWS {
            output.say(format!("{:<16} {}", law.name, law.title));
        }
        let names: Vec<Value> = LAWS
            .iter()
            .map(|law| json!({ "name": law.name, "title": law.title }))
            .collect();
        return Ok(json!({ "laws": names }));
    }
    let checks = toile_lab::validate(&validate.laws, &mut Bar::new())?;
    output.say(toile_lab::table(&checks));
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

/// Replaces a section of a document.
fn write_section(document: Option<&Path>, name: &str, text: &str) -> Result<(), Failure> {
    match document {
        Some(path) => Ok(toile_lab::write_section(path, name, text)?),
        None => Ok(()),
    }
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
    let data = toile_lab::chart(&task.scenes, plan, &mut bar)?;
    let mut files = toile_lab::chart_files(&data)?;
    if !task.quick && task.scenes.is_empty() {
        files.extend(toile_lab::locking_files(&toile_lab::locking(&mut bar)?)?);
    }
    drop(bar);
    let table = toile_lab::when_to_use(&data);
    output.say(&table);
    let written = write_files(&task.out, &files, output)?;
    write_section(task.into.as_deref(), "chart", &table)?;
    Ok(json!({ "files": written, "chart": data }))
}

/// Where methods fail.
pub fn stability(task: &StabilityTask, output: &Output) -> Result<Value, Failure> {
    let mut bar = Bar::new();
    let cells = toile_lab::stability_map(&mut bar)?;
    let limits = toile_lab::limits(&mut bar)?;
    let hard = toile_lab::hard_cases(&mut bar)?;
    drop(bar);
    let table = toile_lab::stability_table(&limits, &hard);
    output.say(&table);
    let files = toile_lab::stability_files(&cells, &limits, &hard)?;
    let written = write_files(&task.out, &files, output)?;
    write_section(task.into.as_deref(), "stability", &table)?;
    let report = json!({ "files": written, "limits": limits, "hard_cases": hard });
    let unsound = hard
        .iter()
        .filter(|run| run.outcome == Outcome::Unsound)
        .count();
    if unsound > 0 {
        let message = format!("{} went on with an impossible state", count(unsound, "run"));
        return Err(Failure::failed(message).with_report(report));
    }
    Ok(report)
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
