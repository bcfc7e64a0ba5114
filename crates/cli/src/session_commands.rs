//! Commands that run through a session.

use crate::arguments::{Make, Replay};
use crate::bar::Bar;
use crate::output::{Failure, Made, Output, count};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use toile_session::{Command, Event, Session, WornGarment, is_input, open_journal};

/// The whole job.
pub fn make(make: &Make, output: &Output) -> Result<Made, Failure> {
    let work = [
        Command::Check,
        Command::Nest,
        Command::Assemble,
        Command::drape(),
    ];
    run(make, &work, output)
}

/// The 3D half alone.
pub fn drape(make: &Make, output: &Output) -> Result<Made, Failure> {
    let work = [Command::Check, Command::Assemble, Command::drape()];
    run(make, &work, output)
}

fn run(make: &Make, work: &[Command], output: &Output) -> Result<Made, Failure> {
    refuse_layers(make)?;
    let mut commands = make.choices();
    refuse_nobody(&commands)?;
    match make.formats.is_empty() {
        true => commands.extend_from_slice(work),
        // What is asked for says what is made.
        false => commands.push(Command::Check),
    }
    commands.push(make.export());
    let mut session = Session::new();
    let events = session
        .execute_all(&commands, &mut Bar::new())
        .map_err(|error| match make.patterns.first() {
            Some(first) => Failure::from(error).about(first),
            None => Failure::from(error),
        })?;
    let project = session.project();
    let others = project.others.iter().filter(|worn| worn.pattern.is_some());
    let own = [project.pattern.name.clone()].into_iter();
    let names: Vec<String> = own.chain(others.map(WornGarment::name)).collect();
    output.say(format!(
        "{}, {}, {:.0} cm tall",
        names.join(" + "),
        project.drafted_to_words(),
        project
            .body_measurements()
            .get("height")
            .unwrap_or_default()
            * 100.0,
    ));
    output.print_events(&events);
    Ok(outcome(&events, &make.out))
}

/// Refuses layers that are not one for each pattern.
fn refuse_layers(make: &Make) -> Result<(), Failure> {
    let (layers, patterns) = (make.layer.len(), make.patterns.len());
    if layers > 0 && layers != patterns {
        return Err(Failure::bad_input(format!(
            "--layer: {} for {}; give one number for each, as in --layer {}",
            count(layers, "number"),
            count(patterns, "pattern"),
            (1..=patterns)
                .map(|k| k.to_string())
                .collect::<Vec<_>>()
                .join(",")
        )));
    }
    Ok(())
}

/// Refuses a body that is neither a figure nor a file.
fn refuse_nobody(commands: &[Command]) -> Result<(), Failure> {
    for command in commands {
        if let Command::SetBody {
            measurements: Some(file),
            ..
        } = command
            && !is_input(file)
        {
            return Err(Failure::bad_input(format!(
                "--body: there is no file {}; give woman, man, mean, dress-form, child-2 to child-14, pattern, a file of measurements, \
                 or FIGURE:FILE",
                file.display()
            )));
        }
    }
    Ok(())
}

/// A journal done again.
pub fn replay(replay: &Replay, output: &Output) -> Result<Made, Failure> {
    let about = |error: toile_session::SessionError| Failure::from(error).about(&replay.journal);
    let (commands, notes) = open_journal(&replay.journal).map_err(about)?;
    let (_, made) = Session::replay(&commands, &replay.out, &mut Bar::new()).map_err(about)?;
    let warned = notes.into_iter().map(|message| Event::Warned { message });
    let events: Vec<Event> = warned.chain(made).collect();
    output.print_events(&events);
    Ok(outcome(&events, &replay.out))
}

/// The machine-readable outcome: files, warnings, and the content of `report.json`; with the verdict on the last drape.
fn outcome(events: &[Event], folder: &Path) -> Made {
    let files: Vec<&PathBuf> = events
        .iter()
        .filter_map(|event| match event {
            Event::FilesWritten { paths } => Some(paths),
            _ => None,
        })
        .flatten()
        .collect();
    let written = folder.join("report.json");
    let report = Some(&written)
        .filter(|path| files.contains(path))
        .and_then(|path| std::fs::read_to_string(path).ok())
        .and_then(|text| serde_json::from_str::<Value>(&text).ok());
    let verdict = events.iter().rev().find_map(|event| match event {
        Event::Draped(drape) => Some(&drape.verdict),
        _ => None,
    });
    let made = json!({ "files": files, "warnings": warnings(events), "report": report });
    Made::judged(made, verdict)
}

/// What was warned of.
pub fn warnings(events: &[Event]) -> Vec<&str> {
    let warned = events.iter().filter_map(|event| match event {
        Event::Warned { message } => Some(&**message),
        _ => None,
    });
    warned.collect()
}
