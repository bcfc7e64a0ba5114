//! The drawing of a marker: true to size, well formed, the same every time.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{FRAC_PI_2, PI};
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_interchange::{MarkerDrawing, MarkerFacts, MarkerPiece, write_marker_svg};
use toile_nesting::{Fold, Nap, Pose, Strip};

fn drawing() -> MarkerDrawing {
    let cut = Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: Vec2::new(0.3, 0.5),
    });
    let sew = Polygon::rectangle(Bounds2 {
        min: Vec2::new(0.01, 0.01),
        max: Vec2::new(0.29, 0.49),
    });
    let piece = |name: &str, turn: f64, mirrored: bool, translation: Vec2| MarkerPiece {
        name: name.into(),
        item: 0,
        cut: cut.clone(),
        sew: sew.clone(),
        grain: Some([Vec2::new(0.15, 0.1), Vec2::new(0.15, 0.4)]),
        notches: vec![[Vec2::new(0.3, 0.2), Vec2::new(0.295, 0.2)]],
        lines: vec![vec![Vec2::new(0.1, 0.3), Vec2::new(0.2, 0.3)]],
        pose: Pose {
            grain: FRAC_PI_2,
            turn,
            mirrored,
            translation,
        },
    };
    MarkerDrawing {
        title: "Shirt <1> & \"2\"".into(),
        strip: Strip {
            selvedge: 0.02,
            end_margin: 0.01,
            nap: Nap::OneWay,
            ..Strip::of_width(0.7)
        },
        length: 1.02,
        efficiency: 0.4284,
        pieces: vec![
            piece("front", 0.0, false, Vec2::new(0.01, 0.32)),
            piece("back", PI, true, Vec2::new(1.01, 0.62)),
        ],
        unplaced: vec![["collar".into(), "no room is left".into()]],
        overlaps: Vec::new(),
        facts: MarkerFacts::default(),
    }
}

/// Every tag closed, in order; no bare ampersand.
fn check_well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    let body = text.split_once("?>").unwrap().1;
    for part in body.split('<').skip(1) {
        let (tag, words) = part.split_once('>').unwrap();
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap());
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        for entity in words.split('&').skip(1) {
            let known = ["amp;", "lt;", "gt;", "quot;"];
            assert!(known.iter().any(|k| entity.starts_with(k)), "{words}");
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_drawing_is_true_to_size_and_says_what_it_is() {
    let text = write_marker_svg(&drawing()).unwrap();
    check_well_formed(&text);
    for part in [
        "width=\"1060mm\" height=\"830mm\" viewBox=\"-20 -110 1060 830\"",
        "<title>Shirt &lt;1&gt; &amp; &quot;2&quot;: 2 pieces on 1.020 m of fabric 0.700 m wide, efficiency 42.8 %</title>",
        "nap: all pieces point one way",
        "Not on this marker: collar.",
        "class=\"fabric\" x=\"0\" y=\"0\" width=\"1020\" height=\"700\"",
        "class=\"selvedge\" x=\"0\" y=\"680\" width=\"1020\" height=\"20\"",
        "data-name=\"back\" data-turn=\"180\" data-face-down=\"true\"",
        ">face down</text>",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    assert_eq!(text.matches("<g class=\"piece\"").count(), 2);
    // The front's grain, up its own plane, points along the fabric; its corner (0, 0) lies 320 mm
    // from the lower selvedge.
    assert!(text.contains("M10 380L10 680L510 680L510 380Z"), "{text}");
    assert!(text.contains("class=\"grain\" d=\"M110 530L410 530"));
    assert!(text.contains("class=\"notch\" d=\"M210 680L210 675\""));
}

#[test]
fn the_same_drawing_gives_the_same_bytes() {
    assert_eq!(write_marker_svg(&drawing()), write_marker_svg(&drawing()));
    assert!(!write_marker_svg(&drawing()).unwrap().contains("-0 "));
}

#[test]
fn empty_and_broken_drawings() {
    let mut empty = drawing();
    empty.pieces.clear();
    empty.unplaced.clear();
    check_well_formed(&write_marker_svg(&empty).unwrap());
    let mut bare = drawing();
    bare.pieces[0].cut = Polygon::default();
    bare.pieces[0].sew = Polygon::default();
    bare.pieces[0].grain = None;
    check_well_formed(&write_marker_svg(&bare).unwrap());
    let mut broken = drawing();
    broken.pieces[1].notches[0][0].x = f64::NAN;
    assert!(
        write_marker_svg(&broken)
            .unwrap_err()
            .place
            .contains("back")
    );
    broken.length = f64::INFINITY;
    assert_eq!(write_marker_svg(&broken).unwrap_err().place, "marker");
}

#[test]
fn folds_and_what_is_cut_twice_are_drawn() {
    let mut drawing = drawing();
    drawing.strip.fold = Fold::Lower;
    let corners = [[0.1, 0.1], [0.2, 0.1], [0.2, 0.3]].map(Vec2::from);
    drawing.overlaps = vec![Polygon::new(corners.to_vec())];
    let text = write_marker_svg(&drawing).unwrap();
    check_well_formed(&text);
    assert!(text.contains("class=\"fold\" d=\"M0 700H1020\""), "{text}");
    assert_eq!(text.matches("class=\"selvedge\"").count(), 1);
    let overlap = "class=\"overlap\" d=\"M100 600L200 600L200 400Z\"";
    assert!(text.contains(overlap), "{text}");
    assert!(text.contains("cut twice is red"));
    drawing.strip.fold = Fold::Both;
    let text = write_marker_svg(&drawing).unwrap();
    assert_eq!(text.matches("class=\"fold\"").count(), 2);
    assert_eq!(text.matches("class=\"selvedge\"").count(), 0);
}
