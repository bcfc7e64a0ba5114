//! Markers: what is asked for holds on the fabric as it is spread, cut in plies and gone on from.

use crate::marker_settings::{pattern, rolls, settings};
use std::path::PathBuf;
use toile_interchange::{MarkerFile, read_marker_json, write_marker_json};
use toile_session::{
    Budget, ClothSettings, GivenFlaw, MarkerFormat, MarkerSummary, NapRule, NestOptions,
    SessionError, Silent, SizeSelection, Spread, judge_marker_file, nest_instance, nest_patterns,
};

fn options() -> NestOptions {
    NestOptions {
        budget: Budget::Evaluations(100_000),
        formats: vec![MarkerFormat::Json],
        ..NestOptions::default()
    }
}

struct Made {
    folder: tempfile::TempDir,
    summary: Vec<MarkerSummary>,
}

impl Made {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn marker(&self, name: &str) -> MarkerFile {
        read_marker_json(&std::fs::read_to_string(self.path(name)).unwrap()).unwrap()
    }
}

fn nest(names: &[&str], options: &NestOptions) -> Result<Made, SessionError> {
    let folder = tempfile::tempdir().unwrap();
    let patterns: Vec<PathBuf> = names.iter().map(|name| pattern(name)).collect();
    let place = (folder.path(), &mut Silent as _);
    let (summary, _) = nest_patterns(&patterns, options, place)?;
    Ok(Made { folder, summary })
}

fn refused(names: &[&str], options: &NestOptions) -> String {
    match nest(names, options) {
        Err(error) => {
            assert!(error.is_bad_input(), "{error}");
            error.to_string()
        }
        Ok(made) => panic!("laid: {:?}", made.summary),
    }
}

/// Says of a marker file what `toile check` says.
fn faults(made: &Made, name: &str) -> Vec<String> {
    judge_marker_file(&made.path(name), None).unwrap().faults
}

#[test]
fn fabric_at_hand_is_shared_by_the_plies() {
    for own in [
        NestOptions {
            cloth: ClothSettings {
                rolls: rolls(&[(4.0, None)]),
                ..ClothSettings::default()
            },
            ..options()
        },
        NestOptions {
            cloth: ClothSettings {
                length: Some(4.0),
                ..ClothSettings::default()
            },
            ..options()
        },
        NestOptions {
            settings: settings(r#""fabrics": { "*": { "rolls": [ { "length": "4m" } ] } }"#),
            ..options()
        },
    ] {
        let mut own = own;
        own.cloth.plies = Some(4);
        let made = nest(&["t-shirt"], &own).unwrap();
        assert!(made.summary[0].yardage <= 4.0 + 1e-9, "{:?}", made.summary);
    }
}

#[test]
fn flaws_are_measured_on_the_open_fabric() {
    let mut options = options();
    options.cloth.spread = Some(Spread::Folded);
    options.flaws = vec![GivenFlaw::at([0.2, 1.2, 0.05, 0.05])];
    let made = nest(&["t-shirt"], &options).unwrap();
    let flaw = &made.marker("marker.json").fabric.flaws[0].outline;
    let low = flaw.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    assert!((low - 0.4).abs() < 1e-9, "{flaw:?}");
    assert!(faults(&made, "marker.json").is_empty());
    options.cloth.spread = None;
    options.flaws = vec![GivenFlaw::at([0.0, 2.0, 0.05, 0.05])];
    let words = refused(&["t-shirt"], &options);
    assert!(
        words.contains("flaw 1 of fabric \"jersey\" reaches"),
        "{words}"
    );
}

#[test]
fn what_the_entry_of_a_fabric_leaves_open_is_that_of_all() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "*": { "gap": "7mm", "selvedge": "20mm", "price_per_metre": 4 },
                        "jersey": { "gap": "3mm" } }"#,
    );
    let made = nest(&["t-shirt"], &options).unwrap();
    let fabric = made.marker("marker.json").fabric;
    assert_eq!((fabric.gap, fabric.selvedge), (0.003, 0.02));
    assert!(made.summary[0].cost.is_some());
}

#[test]
fn the_command_line_comes_first_or_is_refused() {
    let mut options = options();
    options.settings = settings(r#""pieces": { "*": { "tilt": 5 } }"#);
    options.cloth.tilt = Some(0.0);
    let made = nest(&["t-shirt"], &options).unwrap();
    let straight = |p: &toile_interchange::MarkerFilePiece| p.turn % 180.0 == 0.0;
    assert!(made.marker("marker.json").pieces.iter().all(straight));
    options.settings =
        settings(r#""fabrics": { "*": { "rolls": [ { "length": "3m", "width": "150cm" } ] } }"#);
    for (width, length, what) in [(Some(1.4), None, "--width"), (None, Some(9.0), "--length")] {
        let mut both = options.clone();
        (both.cloth.width, both.cloth.length) = (width, length);
        let words = refused(&["t-shirt"], &both);
        assert!(words.contains(what), "{words}");
    }
}

#[test]
fn a_sound_marker_gone_on_from_never_gets_longer() {
    let long = NestOptions {
        budget: Budget::Evaluations(3_000_000),
        ..options()
    };
    let good = nest(&["trousers"], &long).unwrap();
    for seed in 1..4 {
        let more = NestOptions {
            from: vec![good.marker("marker.json")],
            budget: Budget::Evaluations(1),
            seed,
            ..options()
        };
        let after = nest(&["trousers"], &more).unwrap();
        assert!(after.summary[0].length <= good.summary[0].length + 1e-9);
    }
}

#[test]
fn a_fabric_goes_on_from_its_own_marker() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "lining": { "width": "140cm" } },
           "pieces": { "front": { "also": { "lining": 1 } }, "back": { "also": { "lining": 1 } } }"#,
    );
    let made = nest(&["trousers"], &options).unwrap();
    let (shell, lining) = (made.marker("marker.json"), made.marker("marker-2.json"));
    assert_eq!(lining.fabric.name.as_deref(), Some("lining"));
    options.from = vec![made.marker("marker-2.json"), made.marker("marker.json")];
    options.locked = vec!["front".into()];
    let again = nest(&["trousers"], &options).unwrap();
    let place = |file: &MarkerFile| {
        let front = file.pieces.iter().find(|p| p.name == "front").unwrap();
        (front.at, front.turn)
    };
    assert_eq!(place(&again.marker("marker.json")), place(&shell));
    assert_eq!(place(&again.marker("marker-2.json")), place(&lining));
    // A lock that holds nothing is a mistake.
    options.from = vec![made.marker("marker-2.json")];
    options.locked = vec!["front mirrored".into()];
    let words = refused(&["trousers"], &options);
    assert!(words.contains("\"front mirrored\""), "{words}");
    // Rolls have several markers: there is none to go on from.
    options.locked.clear();
    options.cloth.rolls = rolls(&[(3.0, None)]);
    let words = refused(&["trousers"], &options);
    assert!(words.contains("rolls"), "{words}");
}

#[test]
fn our_own_markers_are_sound_to_the_check() {
    let naps = NestOptions {
        cloth: ClothSettings {
            nap: Some(NapRule::PerGarment),
            ..ClothSettings::default()
        },
        sizes: SizeSelection::Named(vec![("S".into(), 1), ("M".into(), 1)]),
        ..options()
    };
    let over = NestOptions {
        settings: settings(r#""pieces": { "*": { "over_flaws": true } }"#),
        flaws: vec![GivenFlaw::at([0.2, 0.4, 0.1, 0.1])],
        ..options()
    };
    let print = NestOptions {
        settings: settings(
            r#""fabrics": { "*": { "print": { "repeat": ["40mm", "0mm"] } } },
               "match": [["front.waist", "back.waist"]]"#,
        ),
        ..options()
    };
    for (what, options) in [("nap", &naps), ("flaws", &over), ("print", &print)] {
        let made = nest(&["t-shirt"], options).unwrap();
        assert_eq!(faults(&made, "marker.json"), [""; 0], "{what}");
    }
    // What a hand breaks is said in words.
    let made = nest(&["t-shirt"], &print).unwrap();
    let mut file = made.marker("marker.json");
    let matched = file.pieces.iter_mut().find(|p| p.on_print.is_some());
    let piece = matched.unwrap();
    piece.at[0] += 0.01;
    piece.outline.iter_mut().for_each(|p| p[0] += 0.01);
    std::fs::write(made.path("moved.json"), write_marker_json(&file).unwrap()).unwrap();
    let found = faults(&made, "moved.json");
    let beside = |f: &String| f.contains("lies beside the print");
    assert!(found.iter().any(beside), "{found:?}");
}

#[test]
fn piece_gaps_and_the_measure_of_a_changed_marker_are_judged_anew() {
    let mut options = options();
    options.settings = settings(r#""pieces": { "sleeve": { "gap": "30mm" } }"#);
    let made = nest(&["t-shirt"], &options).unwrap();
    let mut file = made.marker("marker.json");
    assert!(file.pieces.iter().any(|p| p.gap == 0.03));
    file.efficiency = 0.999;
    for piece in &mut file.pieces {
        piece.gap = 0.5;
    }
    std::fs::write(made.path("wide.json"), write_marker_json(&file).unwrap()).unwrap();
    let judged = judge_marker_file(&made.path("wide.json"), None).unwrap();
    assert!(judged.summary.efficiency < 0.95);
    let gap = |f: &String| f.contains("need 500.00 mm");
    assert!(judged.faults.iter().any(gap), "{:?}", judged.faults);
}

#[test]
fn more_pieces_than_can_be_laid_are_refused_at_once() {
    let mut options = options();
    options.sizes = SizeSelection::Named(vec![
        ("S".into(), 4_000_000_000),
        ("M".into(), 4_000_000_000),
    ]);
    let words = refused(&["t-shirt"], &options);
    assert!(words.contains("at most 2000"), "{words}");
    options.sizes = SizeSelection::Base;
    options.settings = settings(
        r#""fabrics": { "lining": { "width": "140cm" } },
           "pieces": { "front": { "also": { "lining": 4000000000 } } }"#,
    );
    let words = refused(&["trousers"], &options);
    assert!(words.contains("at most 2000"), "{words}");
}

#[test]
fn two_at_once_belong_to_one_garment_where_each_runs_one_way() {
    let mut options = options();
    options.cloth.spread = Some(Spread::Folded);
    options.cloth.nap = Some(NapRule::PerGarment);
    options.settings =
        settings(r#""pieces": { "front": { "on_fold": false }, "back": { "on_fold": false } }"#);
    options.sizes = SizeSelection::Named(vec![("M".into(), 2)]);
    let made = nest(&["t-shirt"], &options).unwrap();
    let file = made.marker("marker.json");
    let fronts = file.pieces.iter().filter(|p| p.name == "front");
    let mut garments: Vec<u32> = fronts.map(|p| p.garment).collect();
    garments.sort_unstable();
    assert_eq!(garments, [0, 1]);
}

#[test]
fn pieces_of_several_patterns_are_told_apart() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "cloth": { "width": "150cm" } }, "pieces": { "*": { "fabric": "cloth" } }"#,
    );
    let made = nest(&["t-shirt", "trousers"], &options).unwrap();
    let file = made.marker("marker.json");
    let fronts = file.pieces.iter().filter(|p| p.name.starts_with("front"));
    let mut names: Vec<&str> = fronts.map(|p| p.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.len() >= 2, "{names:?}");
    assert!(names.iter().any(|n| n.contains("T-shirt")), "{names:?}");
}

#[test]
fn what_lies_on_the_next_roll_is_not_missing() {
    let mut options = options();
    options.cloth.rolls = rolls(&[(0.8, Some(0.8)), (5.0, None)]);
    let made = nest(&["t-shirt"], &options).unwrap();
    assert_eq!(made.summary.len(), 2);
    for name in ["marker.json", "marker-2.json"] {
        assert_eq!(made.marker(name).unplaced, []);
    }
}

#[test]
fn the_remedy_on_folded_fabric_is_its_open_width() {
    let mut options = options();
    options.cloth.spread = Some(Spread::Folded);
    options.cloth.width = Some(0.3);
    let words = refused(&["t-shirt"], &options);
    let width = words.split("at least ").nth(1).unwrap();
    let width: f64 = width.split(' ').next().unwrap().parse().unwrap();
    options.cloth.width = Some(width * 1e-3 + 0.001);
    assert!(!refused_width(&options), "{words}");
    options.cloth.width = Some(width * 1e-3 - 0.01);
    assert!(refused_width(&options), "{words}");
}

/// Whether the first piece that is too wide is still said to be.
fn refused_width(options: &NestOptions) -> bool {
    match nest(&["t-shirt"], options) {
        Err(error) => error
            .to_string()
            .split("; piece")
            .next()
            .is_some_and(|first| first.contains("\"front\"") && first.contains("across")),
        Ok(_) => false,
    }
}

#[test]
fn instances_take_no_options_of_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.json");
    let text = r#"{ "name": "box", "strip_height": 10.0, "items": [ { "id": 0, "demand": 2,
        "allowed_orientations": [0.0], "shape": { "type": "simple_polygon",
        "data": [[0, 0], [4, 0], [4, 4], [0, 4]] } } ] }"#;
    std::fs::write(&path, text).unwrap();
    let place = |options: &NestOptions| {
        nest_instance(&path, options, (folder.path(), &mut Silent as _)).map(|made| made.0)
    };
    let plain = NestOptions {
        formats: NestOptions::default().formats,
        ..options()
    };
    assert_eq!(place(&plain).unwrap().pieces, 2);
    let gap = NestOptions {
        cloth: ClothSettings {
            gap: Some(0.01),
            ..ClothSettings::default()
        },
        ..plain
    };
    let words = place(&gap).unwrap_err().to_string();
    assert!(words.contains("own strip"), "{words}");
}

#[test]
fn a_flaw_lies_on_one_fabric_and_one_roll() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "lining": { "width": "140cm" } },
           "pieces": { "sleeve": { "fabric": "lining" } }"#,
    );
    let flaw = GivenFlaw::at([0.2, 1.45, 0.03, 0.03]);
    options.flaws = vec![flaw.clone()];
    let words = refused(&["t-shirt"], &options);
    assert!(words.contains("several: jersey, lining"), "{words}");
    let on = |fabric: &str| GivenFlaw {
        fabric: Some(fabric.to_owned()),
        ..flaw.clone()
    };
    options.flaws = vec![on("lining")];
    let words = refused(&["t-shirt"], &options);
    assert!(words.contains("flaw 1 of fabric \"lining\""), "{words}");
    options.flaws = vec![on("denim")];
    let words = refused(&["t-shirt"], &options);
    assert!(words.contains("jersey, lining"), "{words}");
    options.flaws = vec![on("jersey")];
    let made = nest(&["t-shirt"], &options).unwrap();
    let flaws = |name: &str| made.marker(name).fabric.flaws.len();
    assert_eq!((flaws("marker.json"), flaws("marker-2.json")), (1, 0));
    options.cloth.rolls = rolls(&[(2.0, None), (3.0, None)]);
    let words = refused(&["t-shirt"], &options);
    assert!(words.contains("laid on 2 rolls"), "{words}");
}

#[test]
fn what_an_instance_cannot_hold_is_told() {
    let mut options = options();
    options.formats = vec![MarkerFormat::Instance];
    options.cloth.nap = Some(NapRule::PerGarment);
    let made = nest(&["t-shirt"], &options).unwrap();
    let told = "marker-instance.json does not hold: gaps, the nap of each garment";
    let notes = &made.summary[0].notes;
    assert!(notes.iter().any(|note| note == told), "{notes:?}");
}
