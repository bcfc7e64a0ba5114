//! The drawing of a marker: true to size, well formed, the same every time.

use crate::cut_piece::cut_piece;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use toile_cut::CutPiece;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_interchange::{MarkerDrawing, MarkerFacts, MarkerPiece, write_marker_svg};
use toile_nesting::{Flaw, Fold, Nap, Pose, Strip};

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
        piece: cut_piece(name, (&cut, &sew), ([0.3, 0.2], [-1.0, 0.0])),
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
        "width=\"1060mm\" height=\"848mm\" viewBox=\"-20 -128 1060 848\"",
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
    // Its middle is that of the seam line's box across the fabric; it stands above the words.
    assert!(text.contains("class=\"grain\" d=\"M169.375 509L370.625 509"));
    assert!(text.contains("class=\"notch\" d=\"M210 680L210 674\""));
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
    let nothing = Polygon::default();
    bare.pieces[0].piece = Arc::new(CutPiece::of_outline("nothing", &nothing, 0.0));
    check_well_formed(&write_marker_svg(&bare).unwrap());
    let mut broken = drawing();
    let mut back = (*broken.pieces[1].piece).clone();
    back.notches[0].point.x = f64::NAN;
    broken.pieces[1].piece = Arc::new(back);
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

#[test]
fn what_is_drawn_lies_on_layers_that_inkscape_shows() {
    let mut drawing = drawing();
    let corners = [[0.1, 0.1], [0.2, 0.1], [0.2, 0.3]].map(Vec2::from);
    drawing.overlaps = vec![Polygon::new(corners.to_vec())];
    drawing.strip.flaws = vec![Flaw {
        outline: drawing.overlaps[0].clone(),
        clearance: 0.0,
    }];
    let text = write_marker_svg(&drawing).unwrap();
    check_well_formed(&text);
    assert!(text.contains("xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\""));
    let layers: Vec<&str> = text
        .lines()
        .filter(|line| line.contains("inkscape:groupmode=\"layer\""))
        .map(|line| {
            let label = line.split_once("inkscape:label=\"").unwrap().1;
            label.split_once('"').unwrap().0
        })
        .collect();
    let all = ["Heading", "Fabric", "Print and flaws", "Pieces", "Overlaps"];
    assert_eq!(layers, all);
    // Nothing that is drawn lies outside of them.
    let mut depth = 0;
    for line in text.lines().skip(2) {
        let drawn = ["<rect", "<path", "<text"]
            .iter()
            .any(|t| line.starts_with(t));
        assert!(!drawn || depth > 0, "{line}");
        depth += line.matches("<g").count();
        depth -= line.matches("</g>").count();
    }
    let pieces = text.matches("<g class=\"piece\"").count();
    assert_eq!(pieces, 2);
    // What a marker does not have is no empty layer.
    drawing.overlaps.clear();
    drawing.strip.flaws.clear();
    let text = write_marker_svg(&drawing).unwrap();
    assert_eq!(text.matches("inkscape:groupmode=\"layer\"").count(), 3);
}

/// The texts of a heading: where each begins, its height and its letters.
fn heading(text: &str) -> Vec<([f64; 2], f64, String)> {
    let number = |line: &str, name: &str| -> f64 {
        let rest = line.split_once(&format!("{name}=\"")).unwrap().1;
        rest.split_once('"').unwrap().0.parse().unwrap()
    };
    let inside = text.split_once("id=\"heading\"").unwrap().1;
    let inside = inside.split_once("id=\"scale\"").unwrap().0;
    inside
        .lines()
        .filter(|line| line.starts_with("<text"))
        .map(|line| {
            let words = line.split_once('>').unwrap().1;
            let words = words.split_once('<').unwrap().0.to_owned();
            let at = [number(line, " x"), number(line, " y")];
            (at, number(line, "font-size"), words)
        })
        .collect()
}

#[test]
fn the_heading_lies_on_the_sheet_however_short_the_fabric_and_long_the_words() {
    let long = "a-name-of-a-piece-without-any-space-".repeat(9);
    for (length, title) in [
        (0.682, "T-shirt, jersey"),
        (0.1, "T-shirt, jersey"),
        (2.0, &*long),
    ] {
        let mut drawing = drawing();
        drawing.length = length;
        drawing.pieces.clear();
        drawing.title = title.into();
        drawing.unplaced = vec![[long.clone(), "no room is left".into()]];
        let text = write_marker_svg(&drawing).unwrap();
        let right = 1e3 * length.max(0.4) + 20.0;
        let lines = heading(&text);
        assert!(lines.len() >= 4, "{lines:?}");
        for ([x, y], size, words) in &lines {
            // Wide sans-serif fonts, DejaVu Sans and Verdana, take about 0.56 of their size a letter.
            let end = x + 0.57 * size * words.chars().count() as f64;
            assert!(end <= right, "{length}: {words} ends at {end} of {right}");
            assert!(
                *y < -30.0,
                "{words} lies on the bar of known length or the fabric"
            );
        }
        for pair in lines.windows(2) {
            assert!(pair[1].0[1] - pair[0].0[1] >= pair[1].1, "{pair:?}");
        }
        // No letter is lost.
        let letters = |text: &str| text.replace(' ', "");
        let all: String = lines.iter().map(|line| letters(&line.2)).collect();
        assert!(
            all.contains(&letters(title)) && all.contains(&letters(&long)),
            "{all}"
        );
        let top = text.split_once("viewBox=\"-20 ").unwrap().1;
        let top: f64 = top.split_once(' ').unwrap().0.parse().unwrap();
        assert!(lines[0].0[1] - lines[0].1 > top);
    }
}
