//! The `toile` command as a person runs it.

use crate::common::{patterns, toile, words};
use serde_json::Value;
use std::process::Command;

#[test]
fn help_states_units_and_defaults() {
    let folder = tempfile::tempdir().unwrap();
    let help = words(&toile(folder.path(), &["--help"]).stdout);
    for task in [
        "make", "drape", "check", "nest", "print", "mesh", "body", "convert", "replay",
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
    let skirt = patterns().join("gathered-skirt.toile.json");
    let skirt = skirt.to_str().unwrap();
    let cases: [(&[&str], &[&str]); 10] = [
        (&["make", "gone.json"], &["gone.json", "spelling"]),
        (&["make", "broken.json"], &["broken.json", "line 1"]),
        (
            &["make", shirt, "--size", "XXXL"],
            &["XXXL", "XS, S, M, L, XL, XXL"],
        ),
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
            &["make", skirt, shirt, "--layer", "1,2,3"],
            &["--layer", "3 numbers for 2 patterns", "--layer 1,2"],
        ),
        (
            &["drape", skirt, shirt, "--layer", "1,1000"],
            &["1000", "0..=999"],
        ),
        (&["drape", skirt, "gone.json"], &["gone.json", "spelling"]),
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
fn patterns_are_checked_converted_and_converted_back() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["t-shirt", "gathered-skirt", "trousers", "poncho", "dress"] {
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
fn a_body_goes_out_as_a_file_comes_back_and_is_measured_as_a_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let body = |arguments: &str| {
        let mut all = vec!["body"];
        all.extend(arguments.split(' '));
        let output = toile(folder.path(), &all);
        assert!(output.status.success(), "{}", words(&output.stderr));
    };
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    body("--figure child-8 --out child.json");
    assert!(read("child.json").len() <= 10_000);
    body("--figure child-8 --out child.obj");
    body("--mannequin child.json --out again.obj");
    let points = |name: &str| -> Vec<f64> {
        let text = words(&read(name));
        let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
        vertices
            .flat_map(|line| line.split_whitespace().map(|x| x.parse().unwrap()))
            .collect()
    };
    let (first, again) = (points("child.obj"), points("again.obj"));
    assert!(!first.is_empty() && first.len() == again.len());
    assert!(first.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-4));
    body("--figure child-8 --motion walk --out child.glb");
    assert_eq!(&read("child.glb")[..4], b"glTF");
    // The mesh measured by the tape, and a body grown from that.
    body("--mesh child.obj --out measured.json");
    assert!(words(&read("measured.json")).contains("\"waist\""));
    body("--figure child-8 --measurements measured.json --out grown.obj");
    let refused = toile(
        folder.path(),
        &["body", "--mesh", "child.json", "--out", "x.json"],
    );
    assert_eq!(refused.status.code(), Some(2), "{}", words(&refused.stderr));
}

#[test]
fn a_body_is_fitted_scaled_and_brought_to_heads_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &str| {
        let mut all = vec!["body"];
        all.extend(arguments.split(' '));
        all.push("--json");
        let output = toile(folder.path(), &all);
        assert!(output.status.success(), "{}", words(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    run("--figure woman --out woman.obj");
    let fitted = run("--fit woman.obj --stature 1500mm --frontal 1.1 --out fitted.json");
    assert!(fitted["fit"]["radial_rms_m"].as_f64().unwrap() < 2e-3);
    assert!(fitted["fit"]["girth_rms_m"].as_f64().unwrap() < 3e-3);
    let levels = fitted["fit"]["levels"].as_array().unwrap();
    assert!(levels.len() > 80 && levels[0]["gap_m"].is_number());
    let height = |report: &Value| {
        let rows = report["measurements"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == "height").unwrap();
        row["got"].as_f64().unwrap()
    };
    assert!((height(&fitted) - 1.5).abs() < 3e-3, "{}", height(&fitted));
    // From the file it is the same body, and takes proportions besides.
    let again = run("--mannequin fitted.json --out again.obj");
    assert!((height(&again) - height(&fitted)).abs() < 5e-4);
    let six = run("--mannequin fitted.json --heads 6 --stature 1.2m --out six.json");
    assert!((six["heads"].as_f64().unwrap() / 6.0 - 1.0).abs() < 0.01);
    assert!((height(&six) - 1.2).abs() < 3e-3);
    let named = run("--figure man --proportions loomis-10 --out ten.obj");
    assert!((named["heads"].as_f64().unwrap() / 7.0 - 1.0).abs() < 0.01);
    for refused in [
        "--proportions giant --out x.obj",
        "--heads 40 --out x.obj",
        "--heads 6 --proportions man --out x.obj",
    ] {
        let mut all = vec!["body"];
        all.extend(refused.split(' '));
        let output = toile(folder.path(), &all);
        assert_eq!(output.status.code(), Some(2), "{refused}");
    }
}

#[test]
fn ellipsoids_are_edited_and_the_mannequin_is_worn() {
    let folder = tempfile::tempdir().unwrap();
    let edits = r#"[{"edit": "weigh", "primitive": 3, "weight": 1.2},
        {"edit": "blend", "primitive": 3, "blend": "blendable"},
        {"edit": "attach", "primitive": 5, "joint": "vl5"},
        {"edit": "join", "primitives": [3, 4]}]"#;
    std::fs::write(folder.path().join("edits.json"), edits).unwrap();
    let body = |arguments: &str| {
        let mut all = vec!["body"];
        all.extend(arguments.split(' '));
        toile(folder.path(), &all)
    };
    let output = body("--figure woman --edits edits.json --out own.json");
    assert!(output.status.success(), "{}", words(&output.stderr));
    let text = std::fs::read_to_string(folder.path().join("own.json")).unwrap();
    assert!(
        text.contains("\"joined\"") && text.contains("vl5"),
        "{text}"
    );
    let output = body("--mannequin own.json --out own.obj");
    assert!(output.status.success(), "{}", words(&output.stderr));
    let bad = edits.replace("\"primitive\": 3", "\"primitive\": 333");
    std::fs::write(folder.path().join("edits.json"), bad).unwrap();
    let output = body("--figure woman --edits edits.json --out x.json");
    assert_eq!(output.status.code(), Some(2));
    let said = words(&output.stderr);
    assert!(
        said.contains("333") && said.contains("edits.json"),
        "{said}"
    );
    assert!(!folder.path().join("x.json").exists());
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
    assert!(place("out/scene.frames").is_file() && place("out/flag.obj").is_file());
    std::fs::write(place("bad.json"), scene.replace("[0, 4]", "[0, 99]")).unwrap();
    let bad = run("bad.json");
    assert_eq!(bad.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bad.stderr).contains("no vertex 99"));
    let body =
        "v 0 0 0.2\nv 0.1 0 0.2\nv 0 0.1 0.2\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(place("body.obj"), body).unwrap();
    let moving = r#"{ "duration": 0.1, "method": { "name": "xpbd" }, "collision": { "cloth_offset": 0.002 },
        "objects": [
        { "name": "flag", "kind": "deformable", "mesh": "flag.obj",
          "grips": [ { "vertices": [0, 4], "motion": { "keys": [ { "time": 0, "translation": [0, 0.5, 0] } ] } } ] },
        { "name": "body", "kind": "animated", "mesh": "body.obj", "motion": { "keys": [
          { "time": 0 }, { "time": 0.05, "translation": [0, 0, 1] } ] } } ] }"#;
    std::fs::write(place("moving.json"), moving).unwrap();
    let good = run("moving.json");
    let said = String::from_utf8_lossy(&good.stderr);
    assert!(good.status.success(), "{said}");
    let moved = std::fs::read_to_string(place("out/body.obj")).unwrap();
    assert!(
        moved.contains("v 0.000000000 0.000000000 1.200000000"),
        "{moved}"
    );
    let report = std::fs::read_to_string(place("out/report.json")).unwrap();
    assert!(report.contains("\"tangles\""), "{report}");
    std::fs::write(place("bad.json"), moving.replace("xpbd", "bdf2")).unwrap();
    let bad = run("bad.json");
    assert_eq!(bad.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bad.stderr).contains("use a method that knows it: xpbd"));
    // The coat starts behind the shirt, whose triangles face the other way.
    let layered = r#"{ "duration": 0.3, "method": { "name": "xpbd" }, "collision": { "cloth_offset": 0.002 },
        "objects": [
        { "name": "coat", "kind": "deformable", "mesh": "flag.obj", "layer": 2,
          "transform": { "translation": [0, 0, -0.01] }, "material": { "restitution": 0.2 } },
        { "name": "shirt", "kind": "deformable", "mesh": "flag.obj", "layer": 1 } ] }"#;
    std::fs::write(place("layered.json"), layered).unwrap();
    let good = run("layered.json");
    let said = String::from_utf8_lossy(&good.stderr);
    assert!(good.status.success(), "{said}");
    let report = std::fs::read_to_string(place("out/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["layers"][0]["objects"][0], "shirt");
    assert_eq!(report["layers"][0]["astray"], 0);
    assert_eq!(report["layers"][0]["outer_intersections"], 0);
    assert!(
        report["tangles"]["astray"][0].as_u64() > Some(0),
        "{report}"
    );
    let refused = |from: &str, to: &str, word: &str| {
        std::fs::write(place("bad.json"), layered.replace(from, to)).unwrap();
        let bad = run("bad.json");
        let said = String::from_utf8_lossy(&bad.stderr).into_owned();
        assert_eq!(bad.status.code(), Some(2), "{said}");
        assert!(said.contains(word), "{said}");
    };
    refused("0.002", "0", "layer of \"shirt\"");
    refused("\"layer\": 2", "\"layer\": -2", "integer `-2`");
    refused("0.2 }", "2 }", "restitution");
}
