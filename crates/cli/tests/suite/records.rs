//! What the program says and lays, recorded: help texts, and one cloth laid by arguments, by settings and by a marker of
//! the document. `TOILE_RECORD=1 cargo test -p toile records::` writes the records anew; a commit that does so says
//! why.

use crate::common::{patterns, toile, words};
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/records")
}

/// Holds a text to its record, or records it where that is asked for.
fn hold(name: &str, now: &str) {
    let path = folder().join(name);
    if std::env::var_os("TOILE_RECORD").is_some() {
        std::fs::write(path, now).unwrap();
        return;
    }
    let before = std::fs::read_to_string(&path).unwrap();
    let differing = before
        .lines()
        .zip(now.lines())
        .enumerate()
        .find(|(_, (a, b))| a != b);
    assert!(before == now, "{name}: {differing:?}");
}

/// The help of a command and of all below it.
fn help(command: &[&str], text: &mut String) {
    let folder = tempfile::tempdir().unwrap();
    let all: Vec<&str> = command.iter().copied().chain(["--help"]).collect();
    let help = words(&toile(folder.path(), &all).stdout);
    writeln!(text, "toile {}\n{help}", command.join(" ")).unwrap();
    let Some((_, commands)) = help.split_once("\nCommands:\n") else {
        return;
    };
    let lines = commands.lines().take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    for name in names.filter(|name| !name.is_empty() && *name != "help") {
        let below: Vec<&str> = command.iter().copied().chain([name]).collect();
        self::help(&below, text);
    }
}

#[test]
fn help_texts_are_as_before() {
    let mut text = String::new();
    help(&[], &mut text);
    hold("help.txt", &text);
}

/// Lays a pattern and returns the bytes of its `marker.json`.
fn laid(pattern: &str, more: &[&str], files: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let usual = [
        "nest",
        pattern,
        "--evaluations",
        "100000",
        "--write",
        "json",
    ];
    let all: Vec<&str> = usual.iter().chain(more).copied().collect();
    let output = toile(folder.path(), &all);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder.path().join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    found.sort();
    let texts = found.iter().map(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        format!("{name}\n{}", std::fs::read_to_string(path).unwrap())
    });
    texts.collect()
}

#[test]
fn one_cloth_is_laid_as_before() {
    let shipped = patterns().join("trousers.toile.json");
    let trousers = shipped.to_str().unwrap();
    let arguments = [
        "--width",
        "140cm",
        "--selvedge",
        "15mm",
        "--end-margin",
        "20mm",
        "--gap",
        "4mm",
        "--nap",
        "one-way",
        "--spread",
        "face-to-face",
        "--plies",
        "4",
        "--repeat",
        "60mm,40mm",
        "--defect",
        "50cm,30cm,3cm,2cm",
    ];
    hold("marker-by-arguments.txt", &laid(trousers, &arguments, &[]));
    let settings = r#"{ "toile": 1, "kind": "marker-settings", "currency": "EUR",
        "fabrics": { "*": { "width": "140cm", "selvedge": "15mm", "end_margin": "20mm", "gap": "4mm", "nap": "one-way",
            "spread": "face-to-face", "plies": 4, "price_per_metre": 11.5,
            "print": { "repeat": ["60mm", "40mm"], "origin": ["1cm", "0mm"] },
            "flaws": [ { "at": ["50cm", "30cm"], "size": ["3cm", "2cm"], "clearance": "5mm" } ],
            "rolls": [ { "name": "A", "length": "6m" }, { "length": "20m", "width": "150cm", "flaws": [] } ] } },
        "pieces": { "*": { "tilt": 1 }, "front": { "gap": "6mm", "block": "1cm", "turns": [0] },
            "back": { "turn_over": false, "over_flaws": true } } }"#;
    let given = ["--settings", "s.json"];
    hold(
        "marker-by-settings.txt",
        &laid(trousers, &given, &[("s.json", settings)]),
    );
    let text = std::fs::read_to_string(&shipped).unwrap();
    let fabric = {
        let fabrics = &text[text.find("\"fabrics\"").unwrap()..];
        let id = &fabrics[fabrics.find("\"id\": ").unwrap() + 6..];
        id[..id.find(',').unwrap()].to_owned()
    };
    let marker = format!(
        r#"{{ "id": 100000, "name": "one", "fabric": {fabric}, "width": 140, "selvedge": 1.5, "end_margin": 2, "gap": 0.4,
            "nap": "one-way", "spread": "face-to-face", "plies": 4, "price_per_metre": 11.5, "currency": "EUR",
            "print": {{ "repeat": [6, 4], "origin": [1, 0] }},
            "flaws": [ {{ "at": [50, 30], "size": [3, 2], "clearance": 0.5 }} ], "order": [ {{ "quantity": 1 }} ] }}"#
    );
    assert!(
        text.contains("\"unit\": \"cm\""),
        "lengths of the marker are centimetres"
    );
    let start = text.rfind("\"next_id\"").unwrap();
    let text = format!(
        "{}\"markers\": [{marker}],\n  \"next_id\": 100001\n}}\n",
        &text[..start]
    );
    let given = ["--marker", "one"];
    let files = [("own.toile.json", text.as_str())];
    hold(
        "marker-by-document.txt",
        &laid("own.toile.json", &given, &files),
    );
}
