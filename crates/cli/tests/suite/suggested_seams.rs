//! `toile seams` as a person runs it.

use crate::common::{patterns, toile, words};
use serde_json::Value;
use std::path::Path;

/// The T-shirt without its seams, in a folder.
fn bare(folder: &Path) {
    let text = std::fs::read_to_string(patterns().join("t-shirt.toile.json")).unwrap();
    let mut shirt: Value = serde_json::from_str(&text).unwrap();
    shirt["seams"] = Value::Array(Vec::new());
    std::fs::write(folder.join("bare.toile.json"), shirt.to_string()).unwrap();
}

fn report(folder: &Path, arguments: &str) -> Value {
    let all: Vec<&str> = arguments.split(' ').collect();
    let output = toile(folder, &all);
    assert!(output.status.success(), "{}", words(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn seams_are_listed_accepted_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bare(folder);
    let listed = report(folder, "seams bare.toile.json --json");
    assert_eq!(listed["format"], "toile-seams");
    let suggestions = listed["suggestions"].as_array().unwrap();
    assert!(listed["files"].as_array().unwrap().is_empty());
    let shoulder = suggestions.iter().find(|suggestion| {
        let pairs = suggestion["pairs"].as_array().unwrap();
        let edges = pairs
            .iter()
            .flat_map(|pair| pair["edges"].as_array().unwrap());
        edges.clone().count() == 4 && edges.clone().all(|edge| edge["edge"] == "shoulder")
    });
    let number = shoulder.unwrap()["number"].as_u64().unwrap();
    let made = report(
        folder,
        &format!("seams bare.toile.json --accept {number} --out sewn.toile.json --json"),
    );
    assert_eq!(made["accepted"], serde_json::json!([number]));
    assert_eq!(made["seams"].as_array().unwrap().len(), 2);
    let again = report(folder, "seams sewn.toile.json --json");
    let open = |report: &Value| report["open"].as_array().unwrap().len();
    assert_eq!(open(&again) + 4, open(&listed));
    assert_eq!(open(&made), open(&again));
    let best = report(
        folder,
        "seams bare.toile.json --accept best --out best.toile.json --json",
    );
    let accepted = best["accepted"].as_array().unwrap();
    let sure = suggestions.iter().filter(|found| found["best"] == true);
    assert_eq!(accepted.len(), sure.count());
    assert!(!accepted.is_empty());
    let said = toile(
        folder,
        &[
            "seams",
            "bare.toile.json",
            "--accept",
            "best",
            "--out",
            "b.toile.json",
        ],
    );
    let said = words(&said.stdout);
    // What was sewn alone, by panels.
    assert!(
        said.contains(": front side (") && !said.contains("cost"),
        "{said}"
    );
    assert!(
        said.contains("left open") && said.contains("wrote b.toile.json"),
        "{said}"
    );
}

#[test]
fn wrong_numbers_and_names_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    bare(folder.path());
    for (arguments, reason) in [
        ("--accept 0 --out a.toile.json", "as in 1,4"),
        ("--accept best", "--out"),
        (
            "--accept 9999 --out a.toile.json",
            "choose numbers from 1 to",
        ),
        ("--accept best --out a.txt", "a name that ends in .txt"),
        ("--size XXXL", "XXXL"),
    ] {
        let mut all = vec!["seams", "bare.toile.json"];
        all.extend(arguments.split(' '));
        let output = toile(folder.path(), &all);
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let said = words(&output.stderr);
        assert!(said.contains(reason), "{arguments}: {said}");
    }
    assert!(!folder.path().join("a.toile.json").exists());
}

#[test]
fn the_first_candidates_of_each_edge_are_listed_and_all_when_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    bare(folder.path());
    let lines = |arguments: &[&str]| {
        let said = toile(folder.path(), arguments);
        assert!(said.status.success(), "{}", words(&said.stderr));
        words(&said.stdout)
    };
    let few = lines(&["seams", "bare.toile.json"]);
    let all = lines(&["seams", "bare.toile.json", "--all"]);
    assert!(
        few.contains("--all lists them") && !all.contains("--all"),
        "{few}"
    );
    assert!(few.lines().count() < all.lines().count(), "{few}");
    assert!(few.contains("front side ("), "{few}");
}
