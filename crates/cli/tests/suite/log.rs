//! The log that the environment variable `TOILE_LOG` asks for.

use crate::common::{patterns, words};
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command in a folder with a value of the variable, or without it.
fn logged(folder: &Path, log: Option<&str>, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command.args(arguments).current_dir(folder);
    match log {
        Some(log) => command.env("TOILE_LOG", log),
        None => command.env_remove("TOILE_LOG"),
    };
    command.output().unwrap()
}

/// What a command says on standard error with a log and without it, run in folders of their own. Held here: it
/// ends alike, prints the same, and the log only adds lines.
fn with_log_and_without(arguments: &[&str]) -> [String; 2] {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let with = logged(folders[0].path(), Some("debug"), arguments);
    let without = logged(folders[1].path(), None, arguments);
    assert_eq!(with.status.code(), without.status.code());
    assert_eq!(words(&with.stdout), words(&without.stdout));
    let [with, without] = [words(&with.stderr), words(&without.stderr)];
    let is_logged = |line: &str| line.starts_with("DEBUG toile") || line.starts_with(" INFO toile");
    let lines = with.split_inclusive('\n').filter(|line| !is_logged(line));
    assert_eq!(lines.collect::<String>(), without);
    [with, without]
}

#[track_caller]
fn assert_tells(log: &str, parts: &[&str]) {
    for part in parts {
        assert!(log.contains(part), "{part} is missing in\n{log}");
    }
}

#[test]
fn a_make_tells_stages_steps_and_residuals() {
    let skirt = patterns().join("gathered-skirt.toile.json");
    let skirt = skirt.to_str().unwrap();
    let [log, _] = with_log_and_without(&["make", skirt, "--quality", "preview", "--out", "out"]);
    let told = [
        "command begins command=\"drape\"",
        "command done command=\"drape\" seconds=",
        "step of the garment stage=Sewing",
        "stage of the garment stage=Swinging",
        "stage of the garment stage=Settling",
        "stage of the garment stage=Finished",
        "residual=",
        "mannequin recomputed",
        "drape recomputed",
        "file written file=",
    ];
    assert_tells(&log, &told);
}

#[test]
fn a_nest_tells_the_phases_of_its_search() {
    let skirt = patterns().join("gathered-skirt.toile.json");
    let skirt = skirt.to_str().unwrap();
    let [log, _] = with_log_and_without(&["nest", skirt, "--evaluations", "200000"]);
    let told = [
        "search begins items=",
        "phase=\"exploration\"",
        "phase=\"compression\"",
        "phase=\"polishing\"",
        "evaluations=",
        "length=",
    ];
    assert_tells(&log, &told);
}

#[test]
fn a_check_tells_what_was_recomputed() {
    let skirt = patterns().join("gathered-skirt.toile.json");
    let [log, without] = with_log_and_without(&["check", skirt.to_str().unwrap()]);
    assert_tells(&log, &["pattern evaluated values=", "recomputed="]);
    assert_eq!(without, "");
}

#[test]
fn a_word_that_is_not_known_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = logged(folder.path(), Some("loud"), &["check", "missing.json"]);
    assert_eq!(output.status.code(), Some(2));
    let said =
        "error: the environment variable TOILE_LOG is \"loud\": give one of off, info, debug\n";
    assert_eq!(words(&output.stderr), said);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let quiet = logged(folder.path(), Some(""), &["--version"]);
    assert_eq!(quiet.status.code(), Some(0));
}
