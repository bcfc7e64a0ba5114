//! Bodies of tables of measurements for several sizes, as a person asks for them.

use crate::common::{patterns, toile, words};
use serde_json::Value;

/// A table for several sizes, in mm, with its base size 50 of height 176 cm.
const SIZES: &str = "<vst><unit>mm</unit><size base='500'/><height base='1760'/><body-measurements>
    <m name='height' base='1760' size_increase='0' height_increase='60'/>
    <m name='bust_circ' base='1044' size_increase='38' height_increase='2'/>
    <m name='hip_circ' base='964' size_increase='24' height_increase='12'/>
    <m name='waist_to_highhip_f' base='64'/><m name='waist_to_hip_f' base='37'/>
    </body-measurements></vst>";

#[test]
fn a_size_and_a_height_are_chosen_of_a_table_for_several() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("sizes.vst"), SIZES).unwrap();
    std::fs::write(folder.path().join("me.yaml"), "body:\n  height: 170\n").unwrap();
    let body = |arguments: &str| {
        let start = "body --json --figure man --out body.obj --measurements";
        let all: Vec<&str> = start.split(' ').chain(arguments.split(' ')).collect();
        toile(folder.path(), &all)
    };
    let asked = |report: &Value, name: &str| {
        let rows = report["measurements"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == name).unwrap();
        row["asked"].as_f64().unwrap()
    };
    for (options, size, note) in [
        ("", [1.76, 1.044, 0.964], "base, size 50 of height 176 cm,"),
        (
            " --size 52 --height 170cm",
            [1.70, 1.080, 0.976],
            "size 52 of height 170 cm is taken",
        ),
    ] {
        let output = body(&format!("sizes.vst{options}"));
        assert!(output.status.success(), "{}", words(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (name, metres) in ["height", "bust", "hips"].into_iter().zip(size) {
            let found = asked(&report, name);
            assert!((found - metres).abs() < 1e-9, "{name}: {found}");
        }
        let notes = report["notes"].as_array().unwrap();
        assert!(notes[0].as_str().unwrap().contains(note), "{notes:?}");
        assert!(
            notes[1].as_str().unwrap().contains("waist_to_hip_f"),
            "{notes:?}"
        );
    }
    for (arguments, reason) in [
        ("sizes.vst --size 500", "no size 500"),
        ("sizes.vst --height 3m", "no height 300"),
        ("me.yaml --size 50", "one body"),
    ] {
        let output = body(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        assert!(
            words(&output.stderr).contains(reason),
            "{}",
            words(&output.stderr)
        );
    }
}

#[test]
fn the_published_table_of_mens_sizes_makes_a_body_in_every_corner() {
    let start = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let shared = start.ancestors().map(|folder| folder.join("shared/data"));
    let Some(data) = shared.into_iter().find(|folder| folder.is_dir()) else {
        println!("skipped: there is no ../shared/data");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for file in ["seamly/gost_man_ru.smms", "valentina/GOST_man_ru.vst"] {
        let path = data.join(file).display().to_string();
        for size in [
            &[][..],
            &["--size", "44", "--height", "158cm"],
            &["--size", "60", "--height", "188cm"],
        ] {
            let mut all = vec![
                "body",
                "--figure",
                "man",
                "--out",
                "man.obj",
                "--measurements",
                &path,
            ];
            all.extend(size);
            let output = toile(folder.path(), &all);
            assert!(
                output.status.success(),
                "{file} {size:?}: {}",
                words(&output.stderr)
            );
            assert!(words(&output.stderr).contains("waist_to_hip_f of 3.7 cm"));
        }
    }
}

#[test]
fn a_dxf_says_how_many_sizes_it_leaves_out_and_what_writes_them() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let said = |more: &[&str]| {
        let all = ["convert", shirt.to_str().unwrap(), "shirt.dxf"];
        let all: Vec<&str> = all.iter().chain(more).copied().collect();
        words(&toile(folder.path(), &all).stdout)
    };
    let one = said(&[]);
    assert!(
        one.contains("sizes (5)") && one.contains("; --all-sizes writes them"),
        "{one}"
    );
    let all = said(&["--all-sizes"]);
    assert!(
        all.contains("sizes (6): written as shapes") && !all.contains("--all-sizes"),
        "{all}"
    );
}

#[test]
fn a_text_of_no_format_is_refused_by_what_is_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("notes.txt"), "vm stat\n1 2\n").unwrap();
    let output = toile(folder.path(), &["check", "notes.txt"]);
    let said = words(&output.stderr);
    assert!(
        said.contains("of no format that is known here; patterns are read from"),
        "{said}"
    );
}
