//! The `toile` command as a person runs it.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn patterns() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns")
}

fn toile(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn words(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn help_states_units_and_defaults() {
    let folder = tempfile::tempdir().unwrap();
    let help = words(&toile(folder.path(), &["--help"]).stdout);
    for task in [
        "make", "drape", "check", "nest", "mesh", "body", "convert", "replay",
    ] {
        assert!(help.contains(task), "{help}");
        let help = words(&toile(folder.path(), &[task, "--help"]).stdout);
        assert!(
            help.contains("efault") || help.contains("content"),
            "{task}: {help}"
        );
    }
    let help = words(&toile(folder.path(), &["mesh", "--help"]).stdout);
    assert!(
        help.contains("[default: 10mm]") && help.contains("(m)"),
        "{help}"
    );
}

#[test]
fn bad_input_exits_with_2_and_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let shirt = shirt.to_str().unwrap();
    std::fs::write(
        folder.path().join("broken.json"),
        "{\"toile\": 1, \"panels\"",
    )
    .unwrap();
    let cases: [(&[&str], &[&str]); 7] = [
        (&["make", "gone.json"], &["gone.json", "spelling"]),
        (&["make", "broken.json"], &["broken.json", "line 1"]),
        (&["make", shirt, "--size", "XXL"], &["XXL", "S, M, L, XL"]),
        (
            &["make", shirt, "--fabric", "tweed"],
            &["tweed", "jersey, leather"],
        ),
        (
            &["make", shirt, "--body", "nobody"],
            &["error: --body", "no file nobody", "woman, man, mean"],
        ),
        (
            &["make", shirt, "--width", "12"],
            &["\"12\" has no unit", "mm, cm, m, in"],
        ),
        (
            &["mesh", shirt, "--edge", "9m", "--out", "m.obj"],
            &["edge length"],
        ),
    ];
    for (arguments, expected) in cases {
        let output = toile(folder.path(), arguments);
        let error = words(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        for word in expected {
            assert!(error.contains(word), "{arguments:?}: {error}");
        }
    }
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "nothing was written");
}

#[test]
fn a_reader_that_goes_away_does_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    for flag in ["--size=M", "--json"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
            .args(["check", shirt.to_str().unwrap(), flag])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        assert!(output.stderr.is_empty(), "{}", words(&output.stderr));
    }
}

#[test]
fn failure_to_write_exits_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let output = toile(
        folder.path(),
        &[
            "mesh",
            shirt.to_str().unwrap(),
            "--edge",
            "3cm",
            "--out",
            "no/such/m.obj",
        ],
    );
    assert_eq!(output.status.code(), Some(1), "{}", words(&output.stderr));
}

#[test]
fn json_is_one_report_on_stdout() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let shirt = shirt.to_str().unwrap();
    let output = toile(
        folder.path(),
        &["nest", shirt, "--width", "140cm", "--json"],
    );
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["ok"], true);
    assert_eq!(report["markers"][0]["width_m"], 1.4);
    assert_eq!(report["markers"][0]["sound"], true);
    assert!(folder.path().join("out/marker.svg").is_file());
    let output = toile(folder.path(), &["--json", "check", "gone.json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["ok"], false);
    assert!(report["error"].as_str().unwrap().contains("gone.json"));
}

#[test]
fn a_nesting_instance_is_solved_in_its_own_format_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"{ "name": "tri", "strip_height": 30, "items": [ { "id": 4, "demand": 5,
        "allowed_orientations": [0, 180], "shape": { "type": "simple_polygon",
        "data": [[0, 0], [20, 0], [0, 15]] } } ] }"#;
    std::fs::write(folder.path().join("tri.json"), text).unwrap();
    let solve = |out: &str| {
        let arguments = [
            "nest",
            "tri.json",
            "--evaluations",
            "200000",
            "--out",
            out,
            "--json",
        ];
        let output = toile(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(
            (&report["sound"], &report["pieces"]),
            (&true.into(), &5.into())
        );
        std::fs::read_to_string(folder.path().join(out).join("tri.json")).unwrap()
    };
    let solution = solve("a");
    assert_eq!(solution, solve("b"));
    let value: Value = serde_json::from_str(&solution).unwrap();
    assert_eq!(value["solution"]["layout"]["placed_items"][4]["item_id"], 4);
    // Five triangles of 150 on a strip of 30 take at least 25.
    let length = value["solution"]["strip_width"].as_f64().unwrap();
    assert!((25.0..45.0).contains(&length), "{length}");
    let refused = toile(folder.path(), &["nest", "tri.json", "--width", "1m"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(words(&refused.stderr).contains("tri.json"));
    let never = toile(folder.path(), &["nest", "tri.json", "--time", "-1"]);
    assert_eq!(never.status.code(), Some(2));
}

#[test]
fn markers_of_a_ratio_keep_the_rules_given() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let output = toile(
        folder.path(),
        &[
            "nest",
            shirt.to_str().unwrap(),
            "--sizes",
            "S:1,M:2",
            "--nap",
            "per-garment",
            "--repeat",
            "40mm,0mm",
            "--defect",
            "30cm,40cm,2cm,2cm",
            "--tilt",
            "2",
            "--evaluations",
            "200000",
            "--json",
        ],
    );
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["markers"][0]["sound"], true);
    assert_eq!(report["markers"][0]["pieces"], 12);
    let svg = std::fs::read_to_string(folder.path().join("out/marker.svg")).unwrap();
    assert!(svg.contains("class=\"print\"") && svg.contains("class=\"flaw\""));
    let bad = toile(
        folder.path(),
        &["nest", shirt.to_str().unwrap(), "--sizes", "S:0"],
    );
    assert_eq!(bad.status.code(), Some(2));
}

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
    assert!(rules.iter().all(|r| r["unsound"] == 0));
    let base = rules[0]["efficiency"].as_f64().unwrap();
    assert!((0.5..0.9).contains(&base), "{base}");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn patterns_are_checked_converted_and_converted_back() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["t-shirt", "gathered-skirt", "trousers", "poncho"] {
        let pattern = patterns().join(format!("{name}.toile.json"));
        let pattern = pattern.to_str().unwrap();
        let output = toile(folder.path(), &["check", pattern]);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{name}: {}",
            words(&output.stderr)
        );
        for (from, to) in [
            (pattern, "a.json"),
            ("a.json", "b.toile.json"),
            (pattern, "c.toile.json"),
        ] {
            let output = toile(folder.path(), &["convert", from, to]);
            assert_eq!(
                output.status.code(),
                Some(0),
                "{name}: {}",
                words(&output.stderr)
            );
        }
        let output = toile(folder.path(), &["check", "b.toile.json"]);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{name}: {}",
            words(&output.stderr)
        );
    }
    let native = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
    assert!(native.contains("\"panels\"") && !native.contains("\"toile\""));
}

#[test]
fn bodies_are_made_from_a_figure_or_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let table = r#"{"toile":1,"kind":"measurements","unit":"cm","measurements":{"waist":80}}"#;
    std::fs::write(folder.path().join("me.json"), table).unwrap();
    let output = toile(
        folder.path(),
        &[
            "body",
            "--figure",
            "woman",
            "--measurements",
            "me.json",
            "--out",
            "me.obj",
            "--json",
        ],
    );
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = report["measurements"].as_array().unwrap();
    let waist = rows.iter().find(|row| row["name"] == "waist").unwrap();
    assert_eq!(waist["asked"], 0.8);
    assert!((waist["got"].as_f64().unwrap() - 0.8).abs() < 1e-3);
    assert!(folder.path().join("me.obj").is_file());
    let hips = rows.iter().find(|row| row["name"] == "hips").unwrap();
    assert_eq!(
        (&waist["origin"], &hips["origin"]),
        (&"asked".into(), &"predicted".into())
    );
    // Another program's file, in motion.
    let seamly = "<vit><unit>cm</unit><m name=\"bust_circ\" value=\"90\"/></vit>";
    std::fs::write(folder.path().join("me.vit"), seamly).unwrap();
    let walking = [
        "body",
        "--measurements",
        "me.vit",
        "--motion",
        "walk",
        "--time",
        "0.2",
        "--out",
        "walk.obj",
    ];
    let output = toile(folder.path(), &walking);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        said.contains("bust") && said.contains("(predicted)"),
        "{said}"
    );
    assert!(folder.path().join("walk.obj").is_file());
    let output = toile(
        folder.path(),
        &["body", "--motion", "no.bvh", "--out", "x.obj"],
    );
    assert_eq!(output.status.code(), Some(2));
    let output = toile(
        folder.path(),
        &["body", "--figure", "giant", "--out", "x.obj"],
    );
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_scene_is_simulated_and_a_bad_one_refused() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let mut flag = String::new();
    for j in 0..5 {
        for i in 0..5 {
            flag.push_str(&format!(
                "v {} {} 0\n",
                0.05 * f64::from(i),
                1.0 - 0.05 * f64::from(j)
            ));
        }
    }
    for j in 0..4 {
        for i in 0..4 {
            let a = j * 5 + i + 1;
            flag.push_str(&format!("f {} {} {} {}\n", a, a + 5, a + 6, a + 1));
        }
    }
    std::fs::write(place("flag.obj"), flag).unwrap();
    let scene = r#"{ "duration": 0.1, "frame_step": 0.05, "glitter": 1, "objects": [
        { "name": "flag", "kind": "deformable", "mesh": "flag.obj", "pins": [0, 4] } ] }"#;
    std::fs::write(place("scene.json"), scene).unwrap();
    let run = |scene: &str| {
        std::process::Command::new(env!("CARGO_BIN_EXE_toile"))
            .args([
                "run",
                place(scene).to_str().unwrap(),
                "--out",
                place("out").to_str().unwrap(),
            ])
            .output()
            .unwrap()
    };
    let good = run("scene.json");
    assert!(
        good.status.success(),
        "{}",
        String::from_utf8_lossy(&good.stderr)
    );
    let report = std::fs::read_to_string(place("out/report.json")).unwrap();
    assert!(
        report.contains("glitter"),
        "unknown fields are reported: {report}"
    );
    assert!(place("out/frame-00001-flag.obj").is_file() && place("out/flag.obj").is_file());
    std::fs::write(place("bad.json"), scene.replace("[0, 4]", "[0, 99]")).unwrap();
    let bad = run("bad.json");
    assert_eq!(bad.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bad.stderr).contains("no vertex 99"));
}
