//! What rules of the trade cost, and flaws of rolls.

use crate::common::{patterns, toile, words};
use serde_json::Value;

#[test]
fn more_freedom_never_costs_fabric() {
    let folder = tempfile::tempdir().unwrap();
    for pattern in ["t-shirt", "trousers"] {
        let path = patterns().join(format!("{pattern}.toile.json"));
        let arguments = [
            "nest",
            path.to_str().unwrap(),
            "--study",
            "--evaluations",
            "1000",
        ];
        let output = toile(
            folder.path(),
            &[&arguments[..], &["--json", "--out", "n"]].concat(),
        );
        assert!(output.status.success(), "{}", words(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let rows = report["rules"].as_array().unwrap();
        let fabric = |start: &str| {
            let row = rows.iter().find(|row| {
                let rule = row["rule"].as_str().unwrap();
                rule.starts_with(start)
            });
            row.unwrap_or_else(|| panic!("{start}: {report}"))["fabric_m"]
                .as_f64()
                .unwrap()
        };
        let free = fabric("none");
        for freer in ["grain within 2 degrees", "pieces may be turned over"] {
            assert!(fabric(freer) <= free + 1e-9, "{pattern}: {freer}");
        }
        for stricter in [
            "nap: each garment one way",
            "nap: all one way",
            "gap of 5 mm",
            "stripes of 50 mm across",
            "checks of 50 mm",
            "three flaws",
        ] {
            assert!(fabric(stricter) >= free - 1e-9, "{pattern}: {stricter}");
        }
        assert!(fabric("nap: all one way") >= fabric("nap: each garment one way") - 1e-9);
        // Of four pieces of the T-shirt no more than four lie nowhere, whatever the number of seeds.
        let unplaced = rows.iter().map(|row| row["unplaced"].as_u64().unwrap());
        assert!(unplaced.max().unwrap() <= 4, "{pattern}: {report}");
    }
}

#[test]
fn a_roll_without_flaws_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = patterns().join("poncho.toile.json");
    let flaws_of = |roll: &str| {
        let flaw = r#"[ { "at": ["1.5m", "20cm"], "size": ["30mm", "10mm"] } ]"#;
        let settings = format!(
            r#"{{ "toile": 1, "kind": "marker-settings", "fabrics": {{ "*": {{
            "flaws": {flaw}, "rolls": [ {{ "length": "3m" {roll} }} ] }} }} }}"#
        );
        std::fs::write(folder.path().join("s.json"), settings).unwrap();
        let arguments = ["nest", path.to_str().unwrap(), "--settings", "s.json"];
        let output = toile(
            folder.path(),
            &[&arguments[..], &["--evaluations", "10", "--out", "n"]].concat(),
        );
        assert!(output.status.success(), "{}", words(&output.stderr));
        let marker = std::fs::read_to_string(folder.path().join("n/marker.json")).unwrap();
        let marker: Value = serde_json::from_str(&marker).unwrap();
        marker["fabric"]["defects"].as_array().map_or(0, Vec::len)
    };
    assert_eq!(flaws_of(""), 1);
    assert_eq!(flaws_of(r#", "flaws": []"#), 0);
    let own = r#"{ "at": ["1.6m", "10cm"], "size": ["30mm", "10mm"] }"#;
    assert_eq!(flaws_of(&format!(r#", "flaws": [ {own} ]"#)), 1);
}
