//! Markers for machines and paper, read back: scale to a hundredth of a millimetre, layers, words.

use crate::cut_piece::cut_piece;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use toile_geometry::{Polygon, Vec2};
use toile_interchange::{
    MarkerDrawing, MarkerFacts, MarkerPiece, write_marker_dxf, write_marker_hpgl, write_marker_pdf,
    write_marker_report,
};
use toile_nesting::{Fold, Pose, Strip};

/// A marker of odd measures, a metre wide and seven long: longer than a page of PDF may be.
fn drawing() -> MarkerDrawing {
    let ring = [
        [0.0, 0.0],
        [0.312_345_6, 0.0],
        [0.41, 0.35],
        [0.013, 0.512_345_6],
    ];
    let cut = Polygon::new(ring.map(Vec2::from).to_vec());
    let sew = Polygon::new(ring.map(|p| Vec2::from(p) * 0.9).to_vec());
    let piece = |name: &str, turn: f64, mirrored: bool, at: [f64; 2]| MarkerPiece {
        name: name.into(),
        item: 0,
        piece: cut_piece(name, (&cut, &sew), ([0.1, 0.0], [0.0, 1.0])),
        pose: Pose {
            grain: FRAC_PI_2,
            turn,
            mirrored,
            translation: Vec2::from(at),
        },
    };
    MarkerDrawing {
        title: "Hemd, Köper".into(),
        strip: Strip {
            selvedge: 0.012,
            end_margin: 0.01,
            fold: Fold::Lower,
            ..Strip::of_width(1.0)
        },
        length: 7.012_345_67,
        efficiency: 0.8,
        pieces: vec![
            piece("front", 0.0, false, [0.01, 0.52]),
            piece("Rücken", 0.03, true, [6.3, 0.2]),
        ],
        unplaced: vec![["collar".into(), "no room is left".into()]],
        overlaps: Vec::new(),
        facts: MarkerFacts {
            fabric: "twill".into(),
            roll: Some("roll 1".into()),
            plies: 4,
            price_per_metre: Some(12.5),
            currency: "EUR".into(),
            ..MarkerFacts::default()
        },
    }
}

/// The cut lines as laid (m).
fn cut_lines(drawing: &MarkerDrawing) -> Vec<Vec<Vec2>> {
    let laid = drawing
        .pieces
        .iter()
        .map(|p| p.pose.lay(&p.piece.outer()).outer);
    laid.collect()
}

fn same(found: &[Vec2], wanted: &[Vec2], within: f64) -> bool {
    found.len() == wanted.len()
        && found
            .iter()
            .zip(wanted)
            .all(|(a, b)| (a - b).amax() <= within)
}

/// The closed polylines and the texts of a DXF by layer (mm).
#[allow(clippy::type_complexity)]
fn read_dxf(text: &str) -> (BTreeMap<String, Vec<Vec<Vec2>>>, Vec<(String, String)>) {
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0, "groups are pairs of lines");
    let groups: Vec<(i32, &str)> = lines
        .chunks(2)
        .map(|pair| (pair[0].trim().parse().unwrap(), pair[1]))
        .collect();
    assert_eq!(groups.last(), Some(&(0, "EOF")));
    let mut polylines: BTreeMap<String, Vec<Vec<Vec2>>> = BTreeMap::new();
    let mut words = Vec::new();
    let (mut kind, mut layer, mut at) = ("", String::new(), Vec2::zeros());
    for &(code, value) in &groups {
        match code {
            0 => kind = value,
            8 => layer = value.to_owned(),
            66 => polylines.entry(layer.clone()).or_default().push(Vec::new()),
            10 => at.x = value.parse().unwrap(),
            20 if kind == "VERTEX" => {
                at.y = value.parse().unwrap();
                let all = polylines.get_mut(&layer).unwrap();
                all.last_mut().unwrap().push(at);
            }
            1 if kind == "TEXT" => words.push((layer.clone(), value.to_owned())),
            _ => {}
        }
    }
    (polylines, words)
}

#[test]
fn a_dxf_read_back_is_the_marker() {
    let drawing = drawing();
    let text = write_marker_dxf(&drawing).unwrap();
    assert_eq!(text, write_marker_dxf(&drawing).unwrap());
    assert!(text.is_ascii());
    let (polylines, words) = read_dxf(&text);
    for (found, wanted) in polylines["CUT"].iter().zip(cut_lines(&drawing)) {
        let wanted: Vec<Vec2> = wanted.iter().map(|p| p * 1e3).collect();
        assert!(same(found, &wanted, 1e-4), "{found:?} {wanted:?}");
    }
    let counts = ["CUT", "SEW", "NOTCH", "LINE", "GRAIN", "FOLD", "MARGIN"];
    let counts = counts.map(|layer| polylines[layer].len());
    assert_eq!(counts, [2, 2, 2, 2, 4, 1, 3]);
    let texts: Vec<&str> = words.iter().map(|w| w.1.as_str()).collect();
    let (title, on_pieces) = texts.split_last().unwrap();
    assert_eq!(on_pieces, ["front", "R\\U+00FCcken", "face down"]);
    assert_eq!(*title, "Hemd, K\\U+00F6per");
    assert!(words.iter().all(|w| w.0 == "TEXT"));
}

#[test]
fn the_title_of_a_dxf_is_no_longer_than_the_fabric() {
    let mut drawing = drawing();
    drawing.title = "Shirt, own, made to measure for anna (bust 121 cm, waist 101 cm)".into();
    for (length, expected) in [
        (7.0, 20.0),
        (0.4, 400.0 / toile_lettering::width(&drawing.title)),
    ] {
        drawing.length = length;
        let text = write_marker_dxf(&drawing).unwrap();
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        let at = lines
            .iter()
            .position(|line| *line == drawing.title)
            .unwrap();
        let height: f64 = lines[at - 2].parse().unwrap();
        assert!((height - expected).abs() < 1e-3, "{height} {expected}");
    }
}

/// The lines drawn with a pen (m).
fn read_hpgl(text: &str, pen: &str) -> Vec<Vec<Vec2>> {
    let (mut lines, mut now, mut unit) = (Vec::new(), "", 0.0);
    for command in text.split(';').map(str::trim).filter(|c| !c.is_empty()) {
        let (name, rest) = command.split_at(2);
        let numbers = || -> Vec<f64> { rest.split(',').map(|n| n.parse().unwrap()).collect() };
        match name {
            "IP" => unit = (numbers()[2] - numbers()[0]) * 25e-6,
            "SC" => unit /= numbers()[1] - numbers()[0],
            "SP" => now = rest,
            "PU" if !rest.is_empty() && now == pen => {
                lines.push(vec![Vec2::new(numbers()[0], numbers()[1]) * unit]);
            }
            "PD" if now == pen => {
                let points = numbers();
                let points = points.chunks(2).map(|p| Vec2::new(p[0], p[1]) * unit);
                lines.last_mut().unwrap().extend(points);
            }
            _ => {}
        }
    }
    lines
}

#[test]
fn a_plot_read_back_is_within_a_hundredth_of_a_millimetre() {
    let drawing = drawing();
    let text = write_marker_hpgl(&drawing).unwrap();
    assert!(text.starts_with("IN;PS280494,40000;"), "{}", &text[..40]);
    let cut = read_hpgl(&text, "1");
    for mut wanted in cut_lines(&drawing) {
        wanted.push(wanted[0]);
        let found = cut.iter().any(|line| same(line, &wanted, 5.1e-6));
        assert!(found, "{wanted:?} is not among {cut:?}");
    }
    assert!(text.contains("LBfront\u{3};"));
    // Plotters know ASCII alone: other words are drawn by their outlines.
    assert!(text.is_ascii() && !text.contains("LBR") && !text.contains('?'));
    let drawn = |text: &str| read_hpgl(text, "2").len();
    let mut ascii = drawing.clone();
    ascii.pieces[1].name = "Ruecken".into();
    let labelled = write_marker_hpgl(&ascii).unwrap();
    assert!(labelled.contains("LBRuecken\u{3};"));
    // Seven letters, some of two or three lines; the place of a label is a line of one point.
    assert!(drawn(&text) >= drawn(&labelled) + 7);
    assert!(text.trim_end().ends_with("SP0;"));
}

/// Closed paths of the page content (m), by the unit of the page.
fn read_pdf(bytes: &[u8], unit: f64) -> Vec<Vec<Vec2>> {
    let text = String::from_utf8_lossy(bytes);
    let metres = |word: &str| word.parse::<f64>().unwrap() * unit * 0.0254 / 72.0;
    let mut paths = vec![];
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [x, y, "m"] => paths.push(vec![Vec2::new(metres(x), metres(y))]),
            [x, y, "l"] => {
                let path: &mut Vec<Vec2> = paths.last_mut().unwrap();
                path.push(Vec2::new(metres(x), metres(y)));
            }
            _ => {}
        }
    }
    paths
}

#[test]
fn a_pdf_is_at_true_size_whatever_its_length() {
    let mut drawing = drawing();
    for (length, unit) in [(7.012_345_67, 2.0), (2.5, 1.0)] {
        drawing.length = length;
        let bytes = write_marker_pdf(&drawing).unwrap();
        assert_eq!(bytes, write_marker_pdf(&drawing).unwrap());
        assert!(bytes.starts_with(b"%PDF-1.7"));
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!(text.contains("/UserUnit 2"), unit > 1.0);
        let paths = read_pdf(&bytes, unit);
        for wanted in cut_lines(&drawing) {
            let wanted: Vec<Vec2> = wanted.iter().map(|p| p.add_scalar(0.02)).collect();
            let found = paths.iter().any(|path| same(path, &wanted, 1e-5));
            assert!(found, "{wanted:?}");
        }
    }
}

#[test]
fn a_report_has_numbers_cost_and_what_is_missing() {
    let drawing = drawing();
    let bytes = write_marker_report("Hemd", &[drawing.clone(), drawing.clone()]).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    for words in [
        "(28.049 m (30.68 yd))",
        "(350.62 EUR at 12.50 EUR a metre)",
        "(collar: no room is left)",
        "(4 plies folded, the fold below)",
        "(front)",
        "(80.0 %)",
        "(701.23 EUR)",
    ] {
        assert!(text.contains(words), "{words} is missing in {text}");
    }
    assert_eq!(
        text.matches("/Type /Page\n").count(),
        3,
        "two markers, totals"
    );
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    let mut drawing = drawing();
    drawing.pieces[1].pose.translation.x = f64::NAN;
    let refused = [
        write_marker_dxf(&drawing).map(|_| ()),
        write_marker_hpgl(&drawing).map(|_| ()),
        write_marker_pdf(&drawing).map(|_| ()),
        write_marker_report("Hemd", std::slice::from_ref(&drawing)).map(|_| ()),
    ];
    for error in refused {
        assert!(error.unwrap_err().place.contains("Rücken"));
    }
}
