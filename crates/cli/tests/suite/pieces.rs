//! `toile print` and `toile check --json` as a program.

use crate::common::{patterns, toile, words};
use serde_json::Value;

/// A rectangle of 40 x 10 cm with a hem of 3 cm, a dart, a notch and a hole, cut as a pair.
const PLAIN: &str = include_str!("common/plain.toile.json");

fn report(output: &std::process::Output) -> Value {
    let text = words(&output.stdout);
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn near(value: &Value, wanted: f64, within: f64) {
    let found = value.as_f64().unwrap();
    assert!((found - wanted).abs() <= within, "{found} is not {wanted}");
}

#[test]
fn check_json_gives_every_piece_and_seam_in_numbers() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plain.json"), PLAIN).unwrap();
    let output = toile(folder.path(), &["check", "plain.json", "--json"]);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let report = report(&output);
    assert_eq!(report["format"], "toile-check");
    assert_eq!(
        (&report["version"], &report["ok"]),
        (&1.into(), &true.into())
    );
    assert_eq!(report["size"], "M");
    let pieces = report["pieces"].as_array().unwrap();
    assert_eq!(pieces.len(), 2);
    let plain = &pieces[0];
    assert_eq!(
        (&plain["name"], &plain["size"]),
        (&"plain".into(), &"M".into())
    );
    assert_eq!(pieces[1]["name"], "plain mirrored");
    assert_eq!(
        (&plain["fabric"], &plain["folded"]),
        (&"poplin".into(), &false.into())
    );
    near(&plain["grain_deg"], 90.0, 1e-9);
    // 40 x 10 without a hole of 4 x 4 and a dart of 2 x 4 / 2.
    near(&plain["sewn"]["area_cm2"], 380.0, 1e-6);
    let legs = 41.231_056_256;
    near(&plain["sewn"]["outline_mm"], 980.0 + 2.0 * legs, 1e-6);
    near(&plain["cut"]["bounds_mm"][0][1], -30.0, 1e-5);
    near(&plain["cut"]["bounds_mm"][1][0], 410.0, 1e-5);
    let edges = plain["edges"].as_array().unwrap();
    let hem = edges.iter().find(|e| e["name"] == "hem").unwrap();
    near(&hem["length_mm"], 400.0, 1e-9);
    near(&hem["allowance_mm"], 30.0, 1e-9);
    assert_eq!(hem["corner"], "mitre");
    let hip = &plain["notches"][0];
    assert_eq!(
        (&hip["name"], &hip["edge"]),
        (&"hip".into(), &"right".into())
    );
    near(&hip["seam_mm"][0], 400.0, 1e-9);
    near(&hip["cut_mm"][0], 410.0, 1e-6);
    let dart = &plain["darts"][0];
    assert_eq!(
        (&dart["name"], &dart["pressed"]),
        (&"tuck".into(), &"before".into())
    );
    near(&dart["width_mm"], 20.0, 1e-9);
    near(&dart["legs_mm"][1], legs, 1e-6);
    let seam = &report["seams"][0];
    near(&seam["lengths_mm"][0], legs, 1e-6);
    near(&seam["lengths_mm"][1], legs, 1e-6);
    // Sewn shut, the dart of a straight edge leaves a dip by the angle it took.
    let [joint] = seam["joints"].as_array().unwrap().as_slice() else {
        panic!("one line crosses it, at its mouth: {seam}");
    };
    assert_eq!(joint["end"], "start");
    assert_eq!(joint["edges"], serde_json::json!(["top", "top"]));
    assert_eq!(joint["pieces"][0], joint["pieces"][1]);
    near(
        &joint["kink_deg"],
        -2.0 * 0.25_f64.atan().to_degrees(),
        1e-9,
    );
    near(&joint["step_mm"], 0.0, 1e-9);
}

#[test]
fn check_json_of_a_pattern_with_errors_has_no_pieces() {
    let folder = tempfile::tempdir().unwrap();
    let crossed = PLAIN.replace("[40, 0]", "[40, 25]");
    std::fs::write(folder.path().join("crossed.json"), crossed).unwrap();
    let output = toile(folder.path(), &["check", "crossed.json", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let report = report(&output);
    assert_eq!(report["ok"], false);
    assert!(report["pieces"].as_array().unwrap().is_empty());
    let found = report["diagnostics"].as_array().unwrap();
    assert!(found.iter().any(|d| d["severity"] == "error"), "{found:?}");
}

#[test]
fn prints_are_written_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let shirt = shirt.to_str().unwrap();
    let asked = [
        "print",
        shirt,
        "--all-sizes",
        "--pieces",
        "front,sleeve",
        "--out",
        "p.svg",
        "--json",
    ];
    let output = toile(folder.path(), &asked);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let report = report(&output);
    assert_eq!(report["sizes"].as_array().unwrap().len(), 6);
    assert_eq!(report["pieces"], serde_json::json!(["front", "sleeve"]));
    let list = &report["cut_list"][0];
    assert_eq!(
        (&list["pieces"][1]["quantity"], &list["pieces"][1]["pairs"]),
        (&2.into(), &1.into())
    );
    let text = std::fs::read_to_string(folder.path().join("p.svg")).unwrap();
    let sheets = text.matches("<inkscape:page ").count();
    assert_eq!(report["sheets"].as_u64(), Some(sheets as u64));
    let asked = [
        "print",
        shirt,
        "--paper",
        "projector",
        "--shrinkage",
        "5,2",
        "--out",
        "p.pdf",
    ];
    let output = toile(folder.path(), &asked);
    let said = words(&output.stdout);
    assert!(
        said.contains("on one page of") && said.contains("1 pair of sleeve"),
        "{said}"
    );
    assert!(folder.path().join("p.pdf").exists());
}

#[test]
fn edges_of_the_shipped_patterns_go_on_across_their_seams() {
    // Necklines, armholes, waists and hems turn by less than what a walk tells as a kink (deg). A straight
    // edge with a dart in it turns on purpose, and the dress's side seam where it meets the waist seam.
    let most = 2.0;
    let meets_waist = serde_json::json!(["side", "side_hip"]);
    let mut walked = 0;
    for name in ["t-shirt", "dress", "trousers", "gathered-skirt", "poncho"] {
        for size in ["XS", "S", "M", "L", "XL", "XXL"] {
            let pattern = patterns().join(format!("{name}.toile.json"));
            let pattern = pattern.to_str().unwrap();
            let folder = tempfile::tempdir().unwrap();
            let output = toile(folder.path(), &["check", pattern, "--size", size, "--json"]);
            let report = report(&output);
            assert_eq!(
                report["diagnostics"],
                serde_json::json!([]),
                "{name} {size}"
            );
            let seams = report["seams"].as_array().unwrap();
            walked += seams.len();
            for seam in seams {
                let sewn = seam["name"].as_str().unwrap();
                if sewn.contains(" dart of ") {
                    continue;
                }
                for joint in seam["joints"].as_array().unwrap() {
                    if name == "dress" && joint["edges"] == meets_waist {
                        continue;
                    }
                    let kink = joint["kink_deg"].as_f64().unwrap();
                    let step = joint["step_mm"].as_f64().unwrap();
                    let told = format!("{name} {size}, seam {sewn}: {joint}");
                    assert!(kink.abs() < most && step.abs() < 0.1, "{told}");
                }
            }
        }
    }
    assert!(walked > 300, "{walked} seams");
}
