//! `toile nest --marker`: a marker of a pattern file, searched for, stored and written.

use crate::common::{patterns, toile, words};
use serde_json::{Value, json};
use std::path::Path;

/// A T-shirt with a marker in its file.
fn shirt(folder: &Path) {
    let text = std::fs::read_to_string(patterns().join("t-shirt.toile.json")).unwrap();
    let pattern: Value = serde_json::from_str(&text).unwrap();
    let fabric = pattern["panels"][0]["fabric"].as_u64().unwrap();
    let sizes = pattern["sizes"].as_array().unwrap();
    let medium = sizes.iter().find(|size| size["name"] == "M").unwrap();
    let marker = json!({
        "id": 900, "name": "two M", "fabric": fabric, "width": 140, "price_per_metre": 8,
        "currency": "EUR", "order": [{ "size": medium["id"], "quantity": 2 }],
    });
    let end = text.find("\"next_id\"").unwrap();
    let text = format!(
        "{}\"markers\": [{marker}],\n  \"next_id\": 901\n}}\n",
        &text[..end]
    );
    std::fs::write(folder.join("shirt.toile.json"), text).unwrap();
}

#[test]
fn a_marker_is_searched_for_stored_and_written() {
    let folder = tempfile::tempdir().unwrap();
    shirt(folder.path());
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let before = read("shirt.toile.json");
    let nest = |more: &[&str]| {
        let usual = ["nest", "shirt.toile.json", "--marker", "two M"];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        toile(folder.path(), &all)
    };
    // Nothing is laid yet.
    let output = nest(&["--stored", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["markers"][0]["unplaced"], 8);
    assert_eq!(read("shirt.toile.json"), before);
    let output = nest(&["--evaluations", "100000", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let made = &report["markers"][0];
    assert_eq!((&made["pieces"], &made["unplaced"]), (&json!(8), &json!(0)));
    assert_eq!(
        (&made["sound"], &made["currency"]),
        (&json!(true), &json!("EUR"))
    );
    let length = made["length_m"].as_f64().unwrap();
    assert!((made["cost"].as_f64().unwrap() - 8.0 * length).abs() < 1e-9);
    assert_eq!(made["width_m"], 1.4);
    assert_eq!(report["files"][0], "shirt.toile.json");
    let stored = read("shirt.toile.json");
    let pattern: Value = serde_json::from_slice(&stored).unwrap();
    let placements = pattern["markers"][0]["placements"].as_array().unwrap();
    assert_eq!(placements.len(), 8);
    // The file is a pattern as before, and its marker is written by every writer.
    let output = toile(folder.path(), &["check", "shirt.toile.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let output = nest(&["--stored", "--write", "svg,json,dxf,pdf,plt,report"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    for name in [
        "marker.svg",
        "marker.json",
        "marker.dxf",
        "marker.pdf",
        "marker.plt",
    ] {
        assert!(read(&format!("out/{name}")).len() > 1000, "{name}");
    }
    assert!(read("out/marker-report.pdf").starts_with(b"%PDF"));
    assert_eq!(read("shirt.toile.json"), stored);
    let output = toile(folder.path(), &["check", "out/marker.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let output = nest(&["--as-it-lies", "--evaluations", "1", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let again = report["markers"][0]["length_m"].as_f64().unwrap();
    assert!(again <= length + 1e-9, "{again} {length}");
}

#[test]
fn what_does_not_go_with_a_marker_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    shirt(folder.path());
    let shipped = patterns().join("trousers.toile.json");
    let shipped = shipped.to_str().unwrap();
    let own = "shirt.toile.json";
    for (arguments, what) in [
        (vec![own, "--marker", "three M"], "choose one of two M"),
        (vec![shipped, "--marker", "x"], "has no markers"),
        (vec![own, shipped, "--marker", "two M"], "one pattern"),
        (vec![own, "--marker", "two M", "--width", "1m"], "--width"),
        (vec![own, "--marker", "two M", "--sizes", "M:1"], "--size"),
        (
            vec![own, "--marker", "two M", "--stored", "--as-it-lies"],
            "--as-it-lies",
        ),
        (vec![own, "--stored"], "--marker"),
    ] {
        let all: Vec<&str> = std::iter::once("nest").chain(arguments).collect();
        let output = toile(folder.path(), &all);
        let said = words(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(what), "{said}");
    }
}

#[test]
fn an_export_of_some_formats_writes_those_alone() {
    let folder = tempfile::tempdir().unwrap();
    shirt(folder.path());
    let make = |more: &[&str]| {
        let usual = ["make", "shirt.toile.json", "--formats"];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        toile(folder.path(), &all)
    };
    let marker = [
        "marker-dxf,marker-plt",
        "--marker",
        "two M",
        "--out",
        "made",
        "--json",
    ];
    let output = make(&marker);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        report["files"],
        json!(["made/marker.dxf", "made/marker.plt"])
    );
    assert_eq!(report["report"], Value::Null);
    let nest = ["nest", "shirt.toile.json", "--marker", "two M", "--stored"];
    let nest: Vec<&str> = nest
        .into_iter()
        .chain(["--write", "dxf,plt", "--out", "nested"])
        .collect();
    assert_eq!(toile(folder.path(), &nest).status.code(), Some(0));
    let written = |dir: &str| {
        let found = std::fs::read_dir(folder.path().join(dir)).unwrap();
        let mut files: Vec<_> = found
            .map(|file| file.unwrap().path())
            .map(|path| {
                (
                    path.file_name().unwrap().to_owned(),
                    std::fs::read(path).unwrap(),
                )
            })
            .collect();
        files.sort();
        files
    };
    assert!(written("made") == written("nested"));
    let output = make(&["glb,stl"]);
    assert_eq!(output.status.code(), Some(2));
    let told = words(&output.stderr);
    assert!(
        told.contains("stl") && told.contains("marker-report"),
        "{told}"
    );
}
