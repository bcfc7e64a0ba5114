//! Patterns of every format given to every command that takes a pattern, under its own name, another's and none:
//! each is read, or refused by name. Every option of reading is taken or refused by name, and overrides its guess.

use crate::common::{patterns, toile, words};
use serde_json::Value;
use std::path::Path;
use toile_session::{Choice, Format, ReadOption};

/// A square of 20 cm as Valentina and Seamly2D write it.
fn valentina(root_version: &str, pieces: [&str; 2]) -> String {
    let [details, detail] = pieces;
    let corner = |id: usize, x: f64, y: f64| {
        format!(r#"<point id="{id}" type="single" name="P{id}" x="{x}" y="{y}" mx="0" my="0"/>"#)
    };
    let corners = [
        (1, 0.0, 0.0),
        (2, 20.0, 0.0),
        (3, 20.0, 20.0),
        (4, 0.0, 20.0),
    ];
    let points: String = corners.map(|(id, x, y)| corner(id, x, y)).concat();
    let modelled: String = (1..=4)
        .map(|id| {
            let own = id + 10;
            format!(
                r#"<point id="{own}" idObject="{id}" inUse="true" type="modeling" mx="0" my="0"/>"#
            )
        })
        .collect();
    let nodes: String = (11..=14)
        .map(|id| format!(r#"<node idObject="{id}" type="NodePoint"/>"#))
        .collect();
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?><pattern><version>{root_version}</version><unit>cm</unit>
<description/><notes/><measurements/><increments/>
<draw name="block"><calculation>{points}</calculation><modeling>{modelled}</modeling>
<{details}><{detail} id="20" name="square" mx="0" my="0" width="1" seamAllowance="true" version="2"><nodes>{nodes}</nodes></{detail}></{details}>
</draw></pattern>"#
    )
}

/// Writes a pattern of a format into a file of a folder.
fn sample(folder: &Path, format: Format, name: &str) {
    let file = folder.join(name);
    match format {
        Format::Valentina => {
            let text = valentina("0.9.0", ["details", "detail"]);
            std::fs::write(file, text).unwrap();
        }
        Format::Seamly => {
            let text = valentina("0.6.8", ["pieces", "piece"]);
            std::fs::write(
                file,
                text.replace(
                    "<pattern>",
                    "<pattern><!--Pattern created with Seamly2D (https://seamly.io).-->",
                ),
            )
            .unwrap();
        }
        Format::Native => {
            std::fs::copy(patterns().join("poncho.toile.json"), file).unwrap();
        }
        written => {
            let poncho = patterns().join("poncho.toile.json");
            let made = format!("made{}", written.ending());
            let poncho = poncho.display().to_string();
            let arguments = ["convert", &poncho, &made, "--to", written.word()];
            let output = toile(folder, &arguments);
            assert!(output.status.success(), "{}", words(&output.stderr));
            std::fs::rename(folder.join(made), file).unwrap();
        }
    }
}

/// Commands that take a pattern, without the pattern: `IN` stands for it.
const COMMANDS: [&str; 6] = [
    "check IN",
    "convert IN out.toile.json",
    "make IN --formats pieces-svg --out out",
    "nest IN --evaluations 200 --out out",
    "print IN --out out.svg",
    "mesh IN --out out.obj",
];

#[test]
fn every_command_takes_every_format_by_its_content_under_any_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut faults = Vec::new();
    for &format in Format::all() {
        let other = match format {
            Format::Native => ".dxf",
            _ => ".toile.json",
        };
        for name in [
            format!("own{}", format.ending()),
            format!("other{other}"),
            "none".to_owned(),
        ] {
            sample(folder.path(), format, &name);
            // All commands read by the same way: the longer ones are tried under one name.
            let is_other = name.starts_with("other");
            let commands = if is_other {
                &COMMANDS[..]
            } else {
                &COMMANDS[..2]
            };
            for command in commands {
                let line = command.replace("IN", &name);
                let arguments: Vec<&str> = line.split(' ').collect();
                let output = toile(folder.path(), &arguments);
                let said = words(&output.stderr);
                // A check answers 2 for a garment that has nothing sewn yet.
                let is_answered = output.status.success()
                    || !said.contains("panicked") && said.starts_with("error: ");
                let is_read = output.status.success() || command.starts_with("check");
                if !is_answered || !is_read {
                    faults.push(format!("toile {line} ({}): {said}", format.word()));
                }
            }
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// Runs a check and returns its JSON.
fn checked(folder: &Path, arguments: &[&str]) -> Value {
    let output = toile(folder, &[&["check", "--json"], arguments].concat());
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{arguments:?}: {}", words(&output.stderr)))
}

#[test]
fn every_option_of_reading_is_taken_or_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("measures.vit"), MEASURES).unwrap();
    for &format in Format::all() {
        let name = format!("own{}", format.ending());
        sample(folder.path(), format, &name);
        if format == Format::Svg {
            // Drawings of other programs hold no document of ours.
            let text = std::fs::read_to_string(folder.path().join(&name)).unwrap();
            let (before, rest) = text.split_once("<metadata").unwrap();
            let (_, after) = rest.split_once("</metadata>").unwrap();
            let drawn = format!("{before}{after}").replace("data-toile-", "data-other-");
            std::fs::write(folder.path().join(&name), drawn).unwrap();
        }
        for &option in ReadOption::ALL {
            let value = match option {
                ReadOption::Format => format.word(),
                ReadOption::Unit => "cm",
                ReadOption::Inside => "1mm",
                ReadOption::With => "measures.vit",
            };
            let output = toile(folder.path(), &["check", &name, option.word(), value]);
            let said = words(&output.stderr);
            let refused = said.contains(option.word()) && said.starts_with("error: ");
            assert_eq!(
                !refused,
                format.takes(option),
                "{} {option}: {said}",
                format.word()
            );
        }
    }
}

/// A table of measurements of Valentina.
const MEASURES: &str = r#"<?xml version="1.0" encoding="UTF-8"?><vit><version>0.3.3</version><read-only>false</read-only>
<notes/><unit>cm</unit><pm_system>998</pm_system><personal/><body-measurements><m name="waist_circ" value="70"/></body-measurements></vit>"#;

#[test]
fn every_guess_is_overridden_by_its_option() {
    let folder = tempfile::tempdir().unwrap();
    // The poncho in a unit that nobody uses for it, and with its cut line alone.
    sample(folder.path(), Format::DxfAama, "poncho.dxf");
    let file = folder.path().join("poncho.dxf");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("METRIC", "ENGLISH")).unwrap();
    let guesses = |arguments: &[&str]| {
        let found = checked(folder.path(), arguments);
        let guesses = found["files"][0]["guesses"].as_array().cloned();
        let guesses = guesses.or_else(|| found["guesses"].as_array().cloned());
        let options = guesses.unwrap_or_default();
        let options = options
            .iter()
            .map(|guess| guess["option"].as_str().unwrap().to_owned());
        options.collect::<Vec<_>>()
    };
    let open = guesses(&["poncho.dxf"]);
    assert!(open.contains(&"--unit".to_owned()), "{open:?}");
    for option in &open {
        let value = match option.as_str() {
            "--unit" => "mm",
            "--inside" => "1mm",
            "--from" => "dxf-aama",
            other => panic!("{other}"),
        };
        let left = guesses(&["poncho.dxf", option, value]);
        assert!(!left.contains(option), "{option}: {left:?}");
    }
}
