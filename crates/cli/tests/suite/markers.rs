//! `toile nest` and `toile check` for a marker maker, as a program.

use crate::common::{patterns, toile, words};
use serde_json::Value;

#[test]
fn a_marker_maker_gets_rolls_spreads_costs_and_files_for_machines() {
    let folder = tempfile::tempdir().unwrap();
    let trousers = patterns().join("trousers.toile.json");
    let trousers = trousers.to_str().unwrap();
    let text = r#"{ "toile": 1, "kind": "marker-settings", "currency": "EUR",
        "fabrics": { "twill": { "price_per_metre": 10 } } }"#;
    std::fs::write(folder.path().join("s.json"), text).unwrap();
    let nest = |more: &[&str]| {
        let usual = [
            "nest",
            trousers,
            "--evaluations",
            "200000",
            "--settings",
            "s.json",
        ];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        toile(folder.path(), &all)
    };
    let output = nest(&["--spread", "folded", "--write", "dxf,plt,pdf,report"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let said = words(&output.stdout);
    assert!(said.contains("two plies are cut at once"), "{said}");
    assert!(said.contains("EUR"), "{said}");
    for name in [
        "marker.dxf",
        "marker.plt",
        "marker.pdf",
        "marker-report.pdf",
    ] {
        assert!(folder.path().join("out").join(name).is_file(), "{name}");
        assert!(said.contains(name), "{said}");
    }
    let rolls = ["--roll", "120cm,45cm", "--roll", "60cm", "--json"];
    let output = nest(&rolls);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let markers = report["markers"].as_array().unwrap();
    assert_eq!(markers[0]["roll"], "roll 1");
    let missing = &markers.last().unwrap()["missing"];
    assert!(missing[0]["reason"].as_str().unwrap().contains("roll 2: "));
    for (bad, what) in [
        (["--roll", "1,2,3"], "no unit"),
        (["--roll", "1m,2m,3m"], "3 lengths"),
        (["--price", "nan"], "--price"),
        (["--plies", "0"], "plies"),
        (["--settings", "gone.json"], "gone.json"),
        (["--write", "png"], "png"),
        (["--repeat", "50mm,40mm,30mm"], "3 lengths"),
        (["--sizes", "M:4000000000"], "number of garments"),
        (["--islands", "1000000"], "islands are too many"),
        (["--defect", "denim:1m,2cm,1cm,1cm"], "denim"),
    ] {
        let output = toile(folder.path(), &["nest", trousers, bad[0], bad[1]]);
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
        assert!(
            words(&output.stderr).contains(what),
            "{}",
            words(&output.stderr)
        );
    }
    std::fs::write(folder.path().join("s.json"), text.replace("10", "-1")).unwrap();
    let output = nest(&[]);
    assert_eq!(output.status.code(), Some(2));
    let said = words(&output.stderr);
    assert!(
        said.contains("s.json: fabrics.twill: the price is -1"),
        "{said}"
    );
}

#[test]
fn a_marker_is_judged_gone_on_from_and_written_for_other_programs() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let shirt = shirt.to_str().unwrap();
    let nest = |more: &[&str]| {
        let usual = ["nest", shirt, "--evaluations", "200000"];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        toile(folder.path(), &all)
    };
    let output = nest(&["--write", "json,instance"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let solved = toile(
        folder.path(),
        &[
            "nest",
            "out/marker-instance.json",
            "--evaluations",
            "100000",
        ],
    );
    assert_eq!(solved.status.code(), Some(0), "{}", words(&solved.stderr));
    let sound = toile(folder.path(), &["check", "out/marker.json"]);
    assert_eq!(sound.status.code(), Some(0), "{}", words(&sound.stderr));
    // A hand moves the front over its neighbours.
    let path = folder.path().join("out/marker.json");
    let mut file: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let before = file.clone();
    for point in file["pieces"][0]["outline"].as_array_mut().unwrap() {
        point[1] = (point[1].as_f64().unwrap() * 0.5 + 0.3).into();
    }
    std::fs::write(folder.path().join("moved.json"), file.to_string()).unwrap();
    let bad = toile(folder.path(), &["check", "moved.json", "--out", "judged"]);
    assert_eq!(bad.status.code(), Some(2));
    let said = words(&bad.stderr);
    assert!(
        said.contains("overlap by") && said.contains("moved.json"),
        "{said}"
    );
    let svg = std::fs::read_to_string(folder.path().join("judged/marker-judged.svg")).unwrap();
    assert!(svg.contains("class=\"overlap\""));
    // Going on keeps what is locked and is no longer than before.
    let more = [
        "--from",
        "out/marker.json",
        "--lock",
        "front,sleeve",
        "--out",
        "more",
    ];
    let output = nest(&more);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let after = std::fs::read(folder.path().join("more/marker.json")).unwrap();
    let after: Value = serde_json::from_slice(&after).unwrap();
    let place = |file: &Value, name: &str| {
        let pieces = file["pieces"].as_array().unwrap().clone();
        pieces.into_iter().find(|p| p["name"] == name).unwrap()
    };
    for name in ["front", "sleeve"] {
        assert_eq!(place(&before, name), place(&after, name));
    }
    let length = |file: &Value| file["length"].as_f64().unwrap();
    assert!(length(&after) <= length(&before) + 1e-9);
    let output = nest(&["--from", "out/marker.json", "--lock", "collar"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output.stderr).contains("\"collar\""));
}

#[cfg(unix)]
#[test]
fn an_interrupted_search_writes_the_best_so_far() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_toile"))
        .current_dir(folder.path())
        .args(["nest", shirt.to_str().unwrap(), "--time", "120"])
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(2));
    let killed = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let started = std::time::Instant::now();
    assert!(child.wait().unwrap().success());
    assert!(started.elapsed().as_secs() < 60, "it did not stop");
    assert!(folder.path().join("out/marker.json").is_file());
}

#[test]
fn damaged_pieces_are_refused_by_name_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let ring = |count: u32| -> Vec<[f64; 2]> {
        let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(count);
        (0..count)
            .map(|k| [200.0 * angle(k).cos(), 200.0 * angle(k).sin()])
            .collect()
    };
    let square = vec![[0.0, 0.0], [300.0, 0.0], [300.0, 400.0], [0.0, 400.0]];
    let wide = vec![[0.0, 0.0], [300.0, 0.0], [300.0, 1600.0], [0.0, 1600.0]];
    let tie = vec![[0.0, 0.0], [300.0, 400.0], [300.0, 0.0], [0.0, 400.0]];
    for (outline, demand, what) in [
        (
            wide,
            1,
            "is 1600 mm across the fabric and 1500 mm are usable",
        ),
        (Vec::new(), 1, "encloses no area"),
        (tie, 1, "crosses itself at (150.0, 200.0) mm"),
        (square.clone(), 0, "quantity is 0"),
        (ring(1_000_000), 1, "has 1000000 points"),
    ] {
        let item = |id: u32, demand: u32, data: &[[f64; 2]]| {
            serde_json::json!({ "id": id, "demand": demand, "allowed_orientations": [0, 180],
                "shape": { "type": "simple_polygon", "data": data } })
        };
        let items = [item(0, 1, &square), item(7, demand, &outline)];
        let text = serde_json::json!({ "name": "bad", "strip_height": 1500, "items": items });
        std::fs::write(folder.path().join("bad.json"), text.to_string()).unwrap();
        let output = toile(folder.path(), &["nest", "bad.json"]);
        assert_eq!(output.status.code(), Some(2), "{what}");
        let said = words(&output.stderr);
        assert!(said.contains("bad.json: marker: piece \"7\""), "{said}");
        assert!(said.contains(what), "{said}");
        assert!(!said.contains("piece \"0\""), "{said}");
        assert!(!folder.path().join("out").exists());
    }
    let shirt = patterns().join("t-shirt.toile.json");
    let narrow = ["nest", shirt.to_str().unwrap(), "--width", "50cm"];
    let output = toile(folder.path(), &narrow);
    assert_eq!(output.status.code(), Some(2));
    let said = words(&output.stderr);
    assert!(said.contains("piece \"front\": it is"), "{said}");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_repeat_takes_no_pattern_for_its_second_length() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let shirt = shirt.to_str().unwrap();
    let usual = ["nest", "--evaluations", "1000", "--repeat", "50mm", shirt];
    let output = toile(folder.path(), &usual);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let instance = [
        "nest",
        "out/marker-instance.json",
        "--evaluations",
        "1000",
        "--study",
    ];
    let made = toile(
        folder.path(),
        &[
            "nest",
            shirt,
            "--evaluations",
            "1000",
            "--write",
            "instance",
        ],
    );
    assert_eq!(made.status.code(), Some(0));
    let output = toile(folder.path(), &instance);
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output.stderr).contains("--study"));
}

#[test]
fn the_study_prints_what_rules_cost() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let study = [
        "--study",
        "--seeds",
        "1",
        "--evaluations",
        "20000",
        "--json",
    ];
    let mut all = vec!["nest", shirt.to_str().unwrap()];
    all.extend(study);
    let output = toile(folder.path(), &all);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rules = report["rules"].as_array().unwrap();
    assert!(rules.len() >= 15);
    assert!(rules.iter().all(|r| r["refused"].is_null()), "{rules:?}");
    let share = |r: &Value| match r["efficiency"].as_f64() {
        Some(efficiency) => r["unplaced"] == 0 && (0.05..0.95).contains(&efficiency),
        None => r["unplaced"] != 0,
    };
    assert!(rules.iter().all(share), "{rules:?}");
    let base = rules[0]["efficiency"].as_f64().unwrap();
    assert!((0.5..0.9).contains(&base), "{base}");
    assert!(!folder.path().join("out").exists());
}
