//! Runs `toile check`: faults of patterns and of markers.

use crate::arguments::Check;
use crate::bar::Bar;
use crate::output::{Failure, Output, count};
use crate::session_commands::warnings;
use serde_json::{Value, json};
use std::path::Path;
use toile_session::{
    Choice, Command, Event, SeamInSizes, Session, Severity, SizeSelection, SizedDiagnostic,
    is_marker_file, judge_marker_file, piece_facts, seam_facts, seams_in_sizes,
};

/// One file judged, or several with a verdict each.
pub fn check(check: &Check, output: &Output) -> Result<Value, Failure> {
    if let [path] = &check.files[..] {
        return one(path, check, output);
    }
    if check.out.is_some() {
        return Err(Failure::bad_input(
            "--out takes the drawing of one marker; check the others without it",
        ));
    }
    let mut verdicts = Vec::new();
    let mut failures = Vec::new();
    for path in &check.files {
        output.say(format!("{}:", path.display()));
        let mut verdict = json!({ "file": path, "ok": true });
        let report = match one(path, check, output) {
            Ok(report) => report,
            Err(failure) => {
                output.warn(&failure);
                verdict["ok"] = false.into();
                verdict["error"] = failure.message().into();
                let report = failure.report().cloned().unwrap_or_default();
                failures.push(failure);
                report
            }
        };
        if let (Some(into), Value::Object(found)) = (verdict.as_object_mut(), report) {
            into.extend(found);
        }
        verdicts.push(verdict);
    }
    let report = json!({ "checks": verdicts });
    if failures.is_empty() {
        output.say(format!("all {} passed", count(check.files.len(), "file")));
        return Ok(report);
    }
    let summary = format!(
        "{} of {} failed",
        failures.len(),
        count(check.files.len(), "file")
    );
    // What was given is at fault if that is so of any file.
    let failure = match failures.iter().any(Failure::is_bad_input) {
        true => Failure::bad_input(summary),
        false => Failure::failed(summary),
    };
    Err(failure.with_report(report))
}

fn one(path: &Path, check: &Check, output: &Output) -> Result<Value, Failure> {
    match is_marker_file(path) {
        true => marker(path, check, output),
        false => pattern(path, check, output),
    }
}

/// Faults of a pattern.
fn pattern(path: &Path, check: &Check, output: &Output) -> Result<Value, Failure> {
    let mut session = Session::new();
    let mut commands = vec![Command::OpenPattern {
        path: path.to_owned(),
        options: check.read.options(),
    }];
    // Pieces are told in numbers of the first size that was asked for.
    if let Some(SizeSelection::Named(names)) = &check.size {
        let size = names.first().map(|(name, _)| name.clone());
        commands.push(Command::SetSize { size });
    }
    let mut events = session
        .execute_all(&commands, &mut Bar::new())
        .map_err(|error| Failure::from(error).about(path))?;
    // The size that the file keeps is one of those that are looked at.
    let usual = match session.project().pattern.sizes.is_empty() {
        true => SizeSelection::Base,
        false => SizeSelection::All,
    };
    let asked = match check.all_sizes {
        true => Some(&SizeSelection::All),
        false => check.size.as_ref(),
    };
    let found = session
        .diagnostics_by_size(Some(asked.unwrap_or(&usual)))
        .map_err(|error| Failure::from(error).about(path))?;
    let errors = count_of(&found, Severity::Error);
    events.push(Event::Checked {
        errors,
        warnings: count_of(&found, Severity::Warning),
    });
    events.extend(found.iter().map(|sized| Event::Warned {
        message: format!("{}: {sized}", path.display()),
    }));
    let read = events.iter().find_map(Event::file_read).cloned();
    let place = |place| session.project().pattern.describe(place);
    let listed: Vec<Value> = found
        .iter()
        .map(
            |SizedDiagnostic {
                 diagnostic: d,
                 sizes,
                 ..
             }| {
                json!({
                    "severity": d.severity.to_string(),
                    "sizes": sizes,
                    "place": place(&d.place),
                    "message": d.message,
                    "hint": d.hint,
                })
            },
        )
        .collect();
    output.print_events(&events);
    let (draft, evaluation) = (session.draft(), session.evaluation());
    let own = session.diagnostics();
    let is_sound = own.iter().all(|d| d.severity != Severity::Error);
    let project = session.project();
    let (pieces, seams) = match is_sound {
        true => {
            let of = (&*project.pattern, &*draft);
            (
                piece_facts(of, project.size_name()),
                seam_facts((&evaluation, &draft)),
            )
        }
        false => (Vec::new(), Vec::new()),
    };
    let by_size = match (asked, errors) {
        (Some(sizes), 0) => {
            seams_in_sizes(project, sizes).map_err(|error| Failure::from(error).about(path))?
        }
        _ => Vec::new(),
    };
    if !by_size.is_empty() {
        tell_seams(&by_size, output);
    }
    let report = json!({
        "format": "toile-check",
        "version": 1,
        "read_as": read.as_ref().map(|read| read.format.word()),
        "guesses": read.as_ref().map_or(&[][..], |read| &read.guesses),
        "lost": read.as_ref().map_or(&[][..], |read| &read.losses),
        "pattern": project.pattern.name,
        "sizes": project.pattern.sizes.iter().map(|size| &size.name).collect::<Vec<_>>(),
        "size": project.size_name(),
        "pieces": pieces,
        "seams": seams,
        "seams_by_size": by_size,
        "diagnostics": listed,
        "warnings": warnings(&events),
    });
    if errors > 0 {
        let message = format!("{}: the garment cannot be made", path.display());
        return Err(Failure::bad_input(message).with_report(report));
    }
    Ok(report)
}

/// Tells the seams whose ease or notches differ between sizes; those beyond their ease are warned of.
fn tell_seams(seams: &[SeamInSizes], output: &Output) {
    let sizes = seams.iter().map(|seam| seam.sizes.len()).max().unwrap_or(0);
    for words in seams.iter().filter_map(SeamInSizes::uneven) {
        output.say(words);
    }
    let within = seams.iter().filter(|seam| seam.is_within()).count();
    output.say(format!(
        "{within} of {} within their ease in {}",
        count(seams.len(), "seam"),
        count(sizes, "size")
    ));
}

fn count_of(found: &[SizedDiagnostic], severity: Severity) -> usize {
    let own = |sized: &&SizedDiagnostic| sized.diagnostic.severity == severity;
    found.iter().filter(own).count()
}

/// A marker judged as it stands.
fn marker(path: &Path, check: &Check, output: &Output) -> Result<Value, Failure> {
    let judged = judge_marker_file(path, check.out.as_deref())?;
    let summary = &judged.summary;
    for path in &judged.files {
        output.say(format!("wrote {}", path.display()));
    }
    let report = json!({
        "files": judged.files,
        "pieces": summary.pieces,
        "length_m": summary.length,
        "faults": judged.faults,
    });
    if judged.faults.is_empty() {
        output.say(format!(
            "{} on {:.1} cm of fabric: no faults",
            count(summary.pieces, "piece"),
            summary.length * 100.0
        ));
        return Ok(report);
    }
    let failure = Failure::bad_input(judged.faults.join("\n"));
    Err(failure.about(path).with_report(report))
}
