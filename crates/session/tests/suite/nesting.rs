//! What a marker maker asks for, from a pattern file and settings to the files written.

use crate::marker_settings::{pattern, rolls, settings};
use std::path::PathBuf;
use toile_interchange::{MarkerFile, MarkerSettings, read_marker_json};
use toile_session::{
    Budget, MarkerFormat, MarkerSummary, NestOptions, SessionError, Silent, SizeSelection, Spread,
    nest_patterns,
};

fn options() -> NestOptions {
    NestOptions {
        budget: Budget::Evaluations(200_000),
        ..NestOptions::default()
    }
}

struct Made {
    folder: tempfile::TempDir,
    summary: Vec<MarkerSummary>,
    files: Vec<PathBuf>,
}

impl Made {
    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.path().join(name)).unwrap()
    }

    fn marker(&self, name: &str) -> MarkerFile {
        read_marker_json(&self.text(name)).unwrap()
    }
}

fn nest(name: &str, options: &NestOptions) -> Result<Made, SessionError> {
    let folder = tempfile::tempdir().unwrap();
    let place = (folder.path(), &mut Silent as _);
    let (summary, files) = nest_patterns(&[pattern(name)], options, place)?;
    assert!(summary.iter().all(|n| n.sound));
    Ok(Made {
        folder,
        summary,
        files,
    })
}

fn refused(name: &str, options: &NestOptions) -> String {
    match nest(name, options) {
        Err(error) => {
            assert!(error.is_bad_input(), "{error}");
            error.to_string()
        }
        Ok(made) => panic!("laid: {:?}", made.summary),
    }
}

/// Least and greatest y of a piece's outline (m).
fn sides(file: &MarkerFile, name: &str) -> [f64; 2] {
    let piece = file.pieces.iter().find(|p| p.name == name).unwrap();
    let y = || piece.outline.iter().map(|p| p[1]);
    [
        y().fold(f64::INFINITY, f64::min),
        y().fold(f64::NEG_INFINITY, f64::max),
    ]
}

#[test]
fn on_folded_fabric_halves_lie_on_the_fold_and_pairs_are_cut_at_once() {
    let mut options = options();
    options.cloth.spread = Some(Spread::Folded);
    let made = nest("t-shirt", &options).unwrap();
    let file = made.marker("marker.json");
    assert_eq!(file.fabric.width, 0.8);
    assert_eq!(file.pieces.len(), 3, "half front, half back, one sleeve");
    for name in ["front", "back"] {
        assert_eq!(sides(&file, name)[0], 0.0, "{name} on the fold");
    }
    let whole = nest("t-shirt", &self::options()).unwrap();
    let widest = sides(&whole.marker("marker.json"), "front");
    let half = sides(&file, "front");
    let off = (half[1] - half[0]) - 0.5 * (widest[1] - widest[0]);
    assert!(off.abs() < 2e-6, "{off}");
    // A tube has a fold for each.
    options.cloth.spread = Some(Spread::Tubular);
    let made = nest("t-shirt", &options).unwrap();
    let file = made.marker("marker.json");
    for name in ["front", "back"] {
        let [lower, upper] = sides(&file, name);
        assert!(lower == 0.0 || upper == 0.8, "{name} {lower} {upper}");
    }
    // Unless it is not to lie there.
    options.settings = settings(r#""pieces": { "front": { "on_fold": false } }"#);
    let made = nest("t-shirt", &options).unwrap();
    let note = &made.summary[0].notes[0];
    assert!(note.starts_with("front: two plies"), "{note}");
}

#[test]
fn face_to_face_pairs_lie_either_way_and_single_pieces_are_refused() {
    let mut options = options();
    options.cloth.spread = Some(Spread::FaceToFace);
    options.cloth.price_per_metre = Some(8.0);
    let made = nest("trousers", &options).unwrap();
    let one = &made.summary[0];
    assert_eq!((one.pieces, one.plies), (5, 2));
    assert!((one.yardage - 2.0 * one.length).abs() < 1e-12);
    assert!((one.cost.unwrap() - 8.0 * one.yardage).abs() < 1e-12);
    let file = made.marker("marker.json");
    assert!(file.face_to_face && file.plies == 2);
    options.cloth.plies = Some(3);
    assert!(refused("trousers", &options).contains("even number"));
    options.cloth.plies = None;
    options.settings = settings(
        r#""fabrics": { "lining": { "width": "140cm" } },
           "pieces": { "front mirrored": { "fabric": "lining" } }"#,
    );
    let words = refused("trousers", &options);
    assert!(
        words.contains("\"front\" is neither symmetrical"),
        "{words}"
    );
}

#[test]
fn every_fabric_has_its_own_marker_yardage_and_cost() {
    let mut options = options();
    options.settings = settings(
        r#""currency": "EUR",
           "fabrics": { "*": { "price_per_metre": 10 },
                        "interfacing": { "width": "90cm", "price_per_metre": 3 } },
           "pieces": { "front": { "also": { "interfacing": 1 } },
                       "waistband": { "also": { "interfacing": 2 } } }"#,
    );
    options.sizes = SizeSelection::Named(vec![("S".into(), 1), ("M".into(), 2)]);
    let made = nest("trousers", &options).unwrap();
    let found: Vec<_> = made
        .summary
        .iter()
        .map(|n| (n.fabric.as_str(), n.pieces))
        .collect();
    assert_eq!(found, [("twill", 15), ("interfacing", 9)]);
    for (one, price) in made.summary.iter().zip([10.0, 3.0]) {
        assert!((one.cost.unwrap() - price * one.length).abs() < 1e-12);
        assert_eq!(one.currency, "EUR");
    }
    let file = made.marker("marker-2.json");
    assert_eq!(file.fabric.width, 0.9);
    assert!(file.pieces.iter().any(|p| p.name == "waistband M"));
    options.settings.fabrics.remove("interfacing");
    options.settings.fabrics.remove("*");
    let words = refused("trousers", &options);
    assert!(
        words.contains("\"interfacing\"") && words.contains("width"),
        "{words}"
    );
}

#[test]
fn rolls_are_filled_in_turn_and_what_fits_none_is_named() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "twill": { "rolls": [
             { "name": "remnant", "length": "1.2m", "width": "45cm", "price_per_metre": 2 },
             { "name": "bolt", "length": "1.15m", "price_per_metre": 9 } ] } }"#,
    );
    let made = nest("trousers", &options).unwrap();
    let names: Vec<_> = made
        .summary
        .iter()
        .map(|n| n.roll.as_deref().unwrap())
        .collect();
    assert_eq!(names, ["remnant", "bolt"]);
    let laid: usize = made.summary.iter().map(|n| n.pieces).sum();
    assert_eq!(laid + made.summary[1].missing.len(), 5);
    assert!((made.summary[0].cost.unwrap() - 2.0 * made.summary[0].length).abs() < 1e-12);
    assert_eq!(made.marker("marker.json").roll.as_deref(), Some("remnant"));
    // On the command line.
    options.settings = MarkerSettings::default();
    options.cloth.rolls = rolls(&[(1.2, Some(0.3)), (1.1, Some(0.8))]);
    let made = nest("trousers", &options).unwrap();
    let missing = &made.summary.last().unwrap().missing;
    let left =
        |[_, why]: &[String; 2]| why.contains("roll 1: it is") && why.contains("roll 2: no room");
    assert!(missing.iter().any(left), "{missing:?}");
    options.cloth.rolls = rolls(&[(0.2, None), (0.1, None)]);
    let words = refused("trousers", &options);
    assert!(words.contains("no piece fits any roll"), "{words}");
    assert!(words.contains("roll 2: it is"), "{words}");
}

/// Places of a path (mm).
fn places(path: &str) -> Vec<[f64; 2]> {
    let corners = path.split(['M', 'L', 'Z']).filter(|c| !c.is_empty());
    let place = |corner: &str| {
        let (x, y) = corner.split_once(' ')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    corners.filter_map(place).collect()
}

/// Where the first notch of every piece lies on the seam line, along the fabric (mm), from the
/// drawing: at a corner of the seam line, 10 mm within the slit that is cut for it.
fn first_notches(svg: &str) -> Vec<(String, f64)> {
    let after = |text: &str, mark: &str| {
        let rest = text.split(mark).nth(1)?;
        Some(rest.split('"').next()?.to_owned())
    };
    svg.split("<g class=\"piece\"")
        .skip(1)
        .filter_map(|piece| {
            let name = after(piece, "data-name=\"")?;
            let slit = places(&after(piece, "class=\"notch\" d=\"")?);
            let way = [0, 1].map(|k| (slit[1][k] - slit[0][k]) / 6.0);
            let goal = [0, 1].map(|k| slit[0][k] + 10.0 * way[k]);
            let off = |p: &[f64; 2]| (p[0] - goal[0]).hypot(p[1] - goal[1]);
            let sewn = places(&after(piece, "class=\"sew\" d=\"")?);
            let corner = sewn.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
            (off(&corner) < 0.2).then_some((name, corner[0]))
        })
        .collect()
}

#[test]
fn marks_of_a_garment_meet_on_the_print() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "twill": { "print": { "repeat": ["70mm", "0mm"] } } },
           "match": [["front.hip", "back.hip"]]"#,
    );
    options.sizes = SizeSelection::Named(vec![("M".into(), 2)]);
    let made = nest("trousers", &options).unwrap();
    let mut hips = first_notches(&made.text("marker.svg"));
    hips.retain(|(name, _)| name != "waistband");
    assert_eq!(hips.len(), 8, "{hips:?}");
    // Items stand garment by garment, two fronts and two backs each.
    for garment in [&hips[..4], &hips[4..]] {
        for (name, x) in garment {
            let off = (x - garment[0].1).rem_euclid(70.0);
            assert!(off.min(70.0 - off) < 2e-3, "{name} {x} {garment:?}");
        }
    }
    options.settings.matched[0][1] = "back.hop".into();
    let words = refused("trousers", &options);
    assert!(
        words.contains("\"back.hop\"") && words.contains("back.knee"),
        "{words}"
    );
    // Two marks that cannot both meet.
    options.settings.matched = vec![
        vec!["front.hip".into(), "back.hip".into()],
        vec!["front.knee inner".into(), "back.hip".into()],
    ];
    let words = refused("trousers", &options);
    assert!(words.contains("cannot meet"), "{words}");
}

#[test]
fn chained_marks_make_a_garment_run_one_way() {
    let mut options = options();
    options.settings = settings(
        r#""fabrics": { "jersey": { "print": { "repeat": ["40mm", "0mm"] } } },
           "match": [["front.waist", "back.waist"], ["front.sleeve", "sleeve.front"]]"#,
    );
    let made = nest("t-shirt", &options).unwrap();
    let file = made.marker("marker.json");
    assert!(file.fabric.one_way_per_garment);
    let turns: Vec<f64> = file.pieces.iter().map(|p| p.turn).collect();
    assert!(turns.iter().all(|t| *t == turns[0]), "{turns:?}");
}

#[test]
fn blocks_gaps_locks_and_turns_of_single_pieces_hold() {
    let plain = nest("trousers", &options()).unwrap().marker("marker.json");
    let mut options = options();
    options.settings = settings(
        r#""pieces": { "waistband": { "block": "2cm", "turns": [90],
             "locked": [ { "at": ["40cm", "60cm"], "turn": 90 } ] } }"#,
    );
    let made = nest("trousers", &options).unwrap();
    let file = made.marker("marker.json");
    let of = |file: &MarkerFile| {
        let piece = file.pieces.iter().find(|p| p.name == "waistband");
        piece.unwrap().clone()
    };
    let (band, before) = (of(&file), of(&plain));
    assert_eq!((band.at, band.turn), ([0.4, 0.6], 90.0));
    let extent = |axis: usize, piece: &toile_interchange::MarkerFilePiece| {
        let all = || piece.outline.iter().map(move |p| p[axis]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    assert!((extent(1, &band) - extent(0, &before) - 0.04).abs() < 2e-6);
    assert!((extent(0, &band) - extent(1, &before) - 0.04).abs() < 2e-6);
    options.settings = settings(r#""pieces": { "bnad": { "gap": "1cm" } }"#);
    let words = refused("trousers", &options);
    assert!(
        words.contains("\"bnad\"") && words.contains("waistband"),
        "{words}"
    );
    options.settings = settings(r#""fabrics": { "denim": { "gap": "1cm" } }"#);
    let words = refused("trousers", &options);
    assert!(
        words.contains("\"denim\"") && words.contains("twill"),
        "{words}"
    );
}

#[test]
fn all_formats_are_written() {
    use MarkerFormat::{Dxf, Hpgl, Json, Pdf, Report, Svg};
    let mut options = options();
    options.formats = vec![Svg, Json, Dxf, Pdf, Report, Hpgl];
    let made = nest("poncho", &options).unwrap();
    let names: Vec<_> = made
        .files
        .iter()
        .map(|f| f.file_name().unwrap().to_str().unwrap())
        .collect();
    assert_eq!(
        names,
        [
            "marker.svg",
            "marker.json",
            "marker.dxf",
            "marker.pdf",
            "marker.plt",
            "marker-report.pdf"
        ]
    );
    assert!(made.files.iter().all(|f| f.is_file()));
}
