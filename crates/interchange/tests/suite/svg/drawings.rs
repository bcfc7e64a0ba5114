//! Drawings of any program: units, transformations, what is hidden, which lines are pieces.

use crate::svg::{drafted, read, read_with};
use std::f64::consts::{FRAC_PI_2, PI};
use toile_geometry::Curve;
use toile_interchange::{ReadOptions, Reading};
use toile_pattern::{DisplayUnit, LineKind, Number, Pattern};

/// A drawing of 1 m x 1 m, 1,000 units each way.
fn drawing(inside: &str) -> String {
    with_root(
        "width=\"1000mm\" height=\"1000mm\" viewBox=\"0 0 1000 1000\"",
        inside,
    )
}

fn with_root(root: &str, inside: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" {root}>{inside}</svg>"
    )
}

/// Area (m2) and length (m) of the outline of each panel, by name.
pub(crate) fn shapes(pattern: &Pattern) -> Vec<(String, f64, f64)> {
    let draft = drafted(pattern, None);
    let of = |piece: &toile_pattern::Piece| {
        let curves: Vec<Curve> = piece.outline.iter().map(|edge| edge.curve).collect();
        let area = 0.5 * curves.iter().map(Curve::swept_area).sum::<f64>();
        let length = curves.iter().map(Curve::length).sum();
        (piece.name.clone(), area, length)
    };
    draft.pieces.iter().map(of).collect()
}

pub(crate) fn one(reading: &Reading) -> (String, f64, f64) {
    let shapes = shapes(&reading.pattern);
    assert_eq!(shapes.len(), 1, "{shapes:?}");
    shapes.into_iter().next().unwrap()
}

pub(crate) fn is_near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

#[test]
fn every_shape_is_its_own_area_and_length() {
    let (arc, quarter) = (PI * 0.2 * 0.2, 0.25 * 0.08 * (4.0 - PI) * 0.08 * 4.0);
    let ellipse = PI * 0.3 * 0.1;
    for (element, area) in [
        ("<rect x='10' y='20' width='400' height='300'/>", 0.12),
        (
            "<rect x='10' y='20' width='400' height='300' rx='80'/>",
            0.12 - quarter,
        ),
        ("<circle cx='300' cy='300' r='200'/>", arc),
        ("<ellipse cx='400' cy='300' rx='300' ry='100'/>", ellipse),
        ("<polygon points='0,0 400,0 400,300'/>", 0.06),
        (
            "<path d='M100 300a200 200 0 1 1 400 0a200 200 0 1 1 -400 0z'/>",
            arc,
        ),
        (
            "<path d='M100 300A300 100 0 1 1 700 300A300 100 0 1 1 100 300z'/>",
            ellipse,
        ),
        ("<path d='M0 0h400v300z'/>", 0.06),
        ("<path d='M0 0H400V300L0 0'/>", 0.06),
        // A parabola: two thirds of the rectangle round it.
        ("<path d='M0 0Q200 -300 400 0z'/>", 0.4 * 0.15 * 2.0 / 3.0),
        ("<path d='M0 0Q200 -300 400 0T800 0V400H0z'/>", 0.32),
    ] {
        let reading = read(&drawing(element)).unwrap();
        let (_, found, _) = one(&reading);
        is_near(found, area, 1e-6);
        assert!(reading.guesses.iter().all(|guess| guess.what == "sew line"));
    }
    let (_, _, length) = one(&read(&drawing("<circle cx='300' cy='300' r='200'/>")).unwrap());
    is_near(length, 0.4 * PI, 1e-6);
}

#[test]
fn curves_and_lines_stay_what_they_are() {
    let path = "<path d='M0 0L400 0C400 100 450 200 400 300L200 300L0 300z'/>";
    let reading = read(&drawing(path)).unwrap();
    let draft = drafted(&reading.pattern, None);
    let kinds: Vec<bool> = draft.pieces[0]
        .outline
        .iter()
        .map(|edge| matches!(edge.curve, Curve::Cubic { .. }))
        .collect();
    assert_eq!(kinds.iter().filter(|is_cubic| **is_cubic).count(), 1);
    assert_eq!(kinds.len(), 5);
}

#[test]
fn units_are_stated_or_guessed_and_may_be_asked_for() {
    let path = "<path d='M0 0H378V378H0z'/>";
    let side = |text: &str, options: &ReadOptions| {
        let reading = read_with(text, options).unwrap();
        let guess = reading
            .guesses
            .iter()
            .find(|guess| guess.what == "unit")
            .cloned();
        (one(&reading).2 / 4.0, guess)
    };
    let usual = ReadOptions::default();
    for (root, metres) in [
        ("width='500mm' height='500mm' viewBox='0 0 500 500'", 0.378),
        ("width='50cm' height='50cm' viewBox='0 0 500 500'", 0.378),
        (
            "width='10in' height='10in' viewBox='0 0 500 500'",
            0.378 * 0.508,
        ),
        ("width='500mm' height='1000mm' viewBox='0 0 500 500'", 0.378),
        (
            "width='720pt' height='720pt' viewBox='0 0 500 500'",
            0.378 * 0.508,
        ),
    ] {
        let (found, guess) = side(&with_root(root, path), &usual);
        is_near(found, metres, 1e-9);
        assert_eq!(guess, None, "{root}");
    }
    let large = "<path d='M0 0H1890V1890H0z'/>";
    for (root, pixels) in [
        ("", 96.0),
        ("width='2000' height='2000'", 96.0),
        ("inkscape:version='0.91 r13725'", 90.0),
        ("xmlns:i='http://ns.adobe.com/AdobeIllustrator/10.0/'", 72.0),
    ] {
        let (found, guess) = side(&with_root(root, large), &usual);
        is_near(found, 1890.0 * 0.0254 / pixels, 1e-9);
        assert_eq!(guess.unwrap().option.word(), "--unit");
    }
    // 378 pixels would be 10 cm: only millimetres make that a piece of a garment.
    let (found, guess) = side(&with_root("", path), &usual);
    is_near(found, 0.378, 1e-9);
    assert_eq!(guess.unwrap().chosen, "mm");
    let asked = ReadOptions {
        unit: Some(DisplayUnit::Inch),
        ..ReadOptions::default()
    };
    let (found, guess) = side(&with_root("", "<path d='M0 0H10V10H0z'/>"), &asked);
    is_near(found, 0.254, 1e-9);
    assert_eq!(guess, None);
}

#[test]
fn transformations_and_what_is_put_in_are_followed() {
    let inside = "<defs><g id='half'><path id='p' d='M0 0H100V200H0z'/></g><symbol id='s' viewBox='0 0 10 10'><path d='M0 0H10V10H0z'/></symbol></defs>\
        <g id='front' transform='translate(50 60) rotate(30) scale(2)'><use href='#p' x='3'/></g>\
        <g id='back' transform='matrix(0 1 -1 0 700 0)'><use xlink:href='#half'/></g>\
        <g id='pocket'><use href='#s' x='800' y='800' width='150' height='150'/></g>\
        <g id='cuff'><svg x='800' y='10' width='100' height='50' viewBox='0 0 10 5'><path d='M0 0H10V5H0z'/></svg></g>";
    let reading = read(&drawing(inside)).unwrap();
    let shapes = shapes(&reading.pattern);
    let names: Vec<&str> = shapes.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(names, ["front", "back", "pocket", "cuff"]);
    for ((_, area, _), expected) in shapes.iter().zip([0.08, 0.02, 0.0225, 0.005]) {
        is_near(*area, expected, 1e-9);
    }
}

#[test]
fn what_is_hidden_is_not_drawn() {
    let seen = "<path d='M0 0H300V300H0z'/>";
    for hidden in [
        "<path style='display:none' d='M400 0H700V300H400z'/>",
        "<g style='display:none'><path d='M400 0H700V300H400z'/></g>",
        "<path visibility='hidden' d='M400 0H700V300H400z'/>",
        "<path fill='none' d='M400 0H700V300H400z'/>",
        "<path fill='none' stroke='red' stroke-opacity='0' d='M400 0H700V300H400z'/>",
        "<g opacity='0'><path d='M400 0H700V300H400z'/></g>",
        "<defs><path d='M400 0H700V300H400z'/></defs>",
        "<clipPath><path d='M400 0H700V300H400z'/></clipPath>",
        "<style>.note { display: none }</style><path class='a note' d='M400 0H700V300H400z'/>",
        "<style>g > .x { fill: none; stroke: none !important }</style><g><path class='x' stroke='red' d='M400 0H700V300H400z'/></g>",
        "<svg width='0' height='10'><path d='M400 0H700V300H400z'/></svg>",
    ] {
        let reading = read(&drawing(&format!("{seen}{hidden}"))).unwrap();
        assert_eq!(reading.pattern.panels.len(), 1, "{hidden}");
    }
    let shown = "<g visibility='hidden'><path visibility='visible' d='M400 0H700V300H400z'/></g>";
    let reading = read(&drawing(&format!("{seen}{shown}"))).unwrap();
    assert_eq!(reading.pattern.panels.len(), 2);
}

#[test]
fn pieces_are_layers_groups_or_outermost_lines_and_have_their_names() {
    let inside = "<g inkscape:groupmode='layer' inkscape:label='Front' id='layer1'><path d='M0 0H300V300H0z'/><path d='M10 10H290V290H10z'/><path d='M100 50V250'/></g>\
        <g inkscape:groupmode='layer' inkscape:label='Back' id='layer2'><path d='M20 20H320V320H20z'/></g>\
        <g id='g7'><path id='collar' d='M400 0H700V100H400z'/><path d='M700 200V300H400V200z'/><text x='500' y='250'><tspan>Cuff</tspan> left</text></g>\
        <path id='path9' d='M400 400H700V500H400z'/>";
    let reading = read(&drawing(inside)).unwrap();
    let pattern = &reading.pattern;
    let names: Vec<&str> = pattern
        .panels
        .iter()
        .map(|panel| panel.name.as_str())
        .collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, ["Back", "Cuff left", "Front", "collar", "piece 5"]);
    let front = pattern.panel_named("Front").unwrap();
    // The line evenly inside is the sew line; the other one is drawn inside.
    assert_eq!(front.allowance, Number::from(0.01));
    let kinds: Vec<LineKind> = front.lines.iter().map(|line| line.kind).collect();
    assert_eq!(kinds, [LineKind::Outline, LineKind::Internal]);
    let guess = reading
        .guesses
        .iter()
        .find(|guess| guess.what == "sew line")
        .unwrap();
    assert!(guess.because.starts_with("4 of 5"), "{guess}");
    assert!(reading.losses.iter().any(|loss| loss.what == "texts"));
}

#[test]
fn open_lines_that_meet_are_an_outline_and_a_frame_is_none() {
    let inside = "<rect width='1000' height='1000' fill='white'/>\
        <g id='sleeve'><path fill='none' stroke='black' d='M0 0H300'/><path fill='none' stroke='black' d='M300 300V0'/><path fill='none' stroke='black' d='M0 0C0 100 200 300 300 300'/></g>";
    let reading = read(&drawing(inside)).unwrap();
    let (name, ..) = one(&reading);
    assert_eq!(name, "sleeve");
    assert!(
        reading
            .losses
            .iter()
            .any(|loss| loss.what.contains("frames"))
    );
}

#[test]
fn grain_fold_and_an_allowance_inside_are_taken() {
    let inside = "<g id='front'><path d='M0 0H300V500H0z'/><path id='grain' d='M100 400L100 100'/><path inkscape:label='on fold' d='M0 100V400'/></g>";
    let asked = ReadOptions {
        allowance_inside: Some(0.01),
        ..ReadOptions::default()
    };
    let reading = read_with(&drawing(inside), &asked).unwrap();
    let panel = &reading.pattern.panels[0];
    assert_eq!(panel.operations.len(), 1);
    let draft = drafted(&reading.pattern, None);
    is_near(draft.pieces[0].grain, FRAC_PI_2, 1e-9);
    // Moved in by 10 mm on three sides, and unfolded.
    let (_, area, _) = one(&reading);
    is_near(area, 2.0 * 0.29 * 0.48, 1e-9);
    assert!(reading.guesses.is_empty(), "{:?}", reading.guesses);
}

#[test]
fn chords_of_a_curve_become_one_edge() {
    let points: Vec<String> = (0..=24)
        .map(|k| {
            let turn = f64::from(k) / 24.0 * PI;
            format!(
                "{} {}",
                300.0 + 200.0 * turn.cos(),
                300.0 - 200.0 * turn.sin()
            )
        })
        .collect();
    let path = format!("<path d='M{}L100 500H500z'/>", points.join("L"));
    let reading = read(&drawing(&path)).unwrap();
    let edges = reading.pattern.panels[0].edges().count();
    assert!(edges <= 6, "{edges}");
    let (_, area, _) = one(&reading);
    is_near(area, 0.5 * PI * 0.04 + 0.4 * 0.2, 2e-4);
}
