//! Pieces sewn inside out: set right by the other copy or half, else named.

use super::{case, toile, words};
use serde_json::Value;

fn checked(name: &str, file: &str) -> (Option<i32>, String, Value) {
    let folder = case(name);
    let said = toile(&folder, &["check", file]);
    let report = toile(&folder, &["check", file, "--json"]);
    (
        said.status.code(),
        words(&said.stdout) + &words(&said.stderr),
        serde_json::from_slice(&report.stdout).unwrap(),
    )
}

/// Messages of the diagnostics of a severity that speak of sides.
fn of_sides(report: &Value, severity: &str) -> Vec<String> {
    let found = report["diagnostics"].as_array().unwrap().iter();
    let of = found.filter(|d| d["severity"] == severity);
    let messages = of.map(|d| d["message"].as_str().unwrap().to_owned());
    messages
        .filter(|m| m.contains("right side") || m.contains("half turn"))
        .collect()
}

/// A garment's height at the vertices that two of its parts share (m), and the length of the line
/// through them.
fn shared_line(obj: &str, parts: [&str; 2]) -> [f64; 2] {
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut used = [const { Vec::new() }; 2];
    let mut part = String::new();
    for line in obj.lines() {
        let mut fields = line.split_whitespace();
        match fields.next() {
            Some("v") => {
                let numbers: Vec<f64> = fields.map(|f| f.parse().unwrap()).collect();
                points.push([numbers[0], numbers[1], numbers[2]]);
            }
            Some("g") => part = fields.collect::<Vec<_>>().join(" "),
            Some("f") => {
                let corners = fields.map(|f| f.split('/').next().unwrap());
                let corners = corners.map(|c| c.parse::<usize>().unwrap() - 1);
                for k in (0..2).filter(|&k| parts[k] == part) {
                    used[k].extend(corners.clone());
                }
            }
            _ => {}
        }
    }
    let mut shared: Vec<usize> = used[0].clone();
    shared.retain(|v| used[1].contains(v));
    shared.sort_unstable();
    shared.dedup();
    shared.sort_by(|&a, &b| points[b][1].total_cmp(&points[a][1]));
    let way = |pair: &[usize]| {
        let [a, b] = [points[pair[0]], points[pair[1]]];
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    };
    let height = points[shared[0]][1] - points[shared[shared.len() - 1]][1];
    [height, shared.windows(2).map(way).sum()]
}

#[test]
fn a_newcomers_skirt_takes_the_other_copy_and_hangs_straight() {
    let name = "pair-sewn-inside-out";
    let (status, said, report) = checked(name, "skirt.toile.json");
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains("take the other copy of panel \"back\""),
        "{said}"
    );
    let notes = of_sides(&report, "note");
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(of_sides(&report, "warning").is_empty());
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().to_str().unwrap();
    let arguments = [
        "drape",
        "skirt.toile.json",
        "--quality",
        "preview",
        "--out",
        folder,
    ];
    let output = toile(&case(name), &arguments);
    assert!(output.status.success(), "{}", words(&output.stderr));
    assert!(
        !words(&output.stderr).contains("before sewing"),
        "{}",
        words(&output.stderr)
    );
    let report = std::fs::read_to_string(out.path().join("report.json")).unwrap();
    assert!(report.contains("take the other copy of panel"), "{report}");
    let obj = std::fs::read_to_string(out.path().join("garment.obj")).unwrap();
    let [height, length] = shared_line(&obj, ["back", "back mirrored"]);
    assert!(height > 0.96 * length, "{height} m high over {length} m");
}

#[test]
fn sleeves_written_on_the_wrong_copies_are_exchanged() {
    let (status, said, report) = checked("sleeves-on-the-wrong-copies", "t-shirt.toile.json");
    assert_eq!(status, Some(0), "{said}");
    let notes = of_sides(&report, "note");
    let [note] = &notes[..] else {
        panic!("{notes:?}");
    };
    for seam in [
        "left armhole front",
        "left armhole back",
        "right armhole front",
    ] {
        assert!(note.contains(seam), "{note}");
    }
}

#[test]
fn a_back_that_no_exchange_sets_right_is_named() {
    let (status, said, report) = checked("both-backs-cut-alike", "skirt.toile.json");
    assert_eq!(status, Some(0), "{said}");
    let warnings = of_sides(&report, "warning");
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    assert!(warning.contains("is sewn inside out"), "{warning}");
    assert!(warning.contains("\"back"), "{warning}");
}

#[test]
fn a_band_with_a_half_turn_is_refused_by_name() {
    let name = "band-with-a-half-turn";
    let (status, said, report) = checked(name, "skirt.toile.json");
    assert_eq!(status, Some(2), "{said}");
    let report = match report.get("diagnostics") {
        Some(_) => report,
        None => report["report"].clone(),
    };
    let errors = of_sides(&report, "error");
    let [error] = &errors[..] else {
        panic!("{errors:?}");
    };
    for part in ["\"band front\"", "\"band back\"", "\"left band\""] {
        assert!(error.contains(part), "{error}");
    }
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().to_str().unwrap();
    let output = toile(&case(name), &["drape", "skirt.toile.json", "--out", folder]);
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output.stderr).contains("half turn"));
}
