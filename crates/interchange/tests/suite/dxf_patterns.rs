//! Patterns in DXF, one small file for each trap that real files hold.

use crate::dxf_file::{File, draft_of, line, point, tag, words};
use std::f64::consts::FRAC_PI_2;
use toile_interchange::{Format, ReadOptions, read};
use toile_pattern::{Cut, Draft, LineKind, NotchKind, Number, OperationKind};

/// A skirt panel of 400 x 600 mm, its hem below.
const SKIRT: [[f64; 2]; 4] = [[0.0, 0.0], [400.0, 0.0], [400.0, 600.0], [0.0, 600.0]];

fn metric(file: &mut File) {
    file.style += &words("Units: METRIC");
}

/// Corners of the first piece of a draft (m).
fn corners(draft: &Draft) -> Vec<toile_geometry::Vec2> {
    let edges = draft.pieces[0].outline.iter();
    edges.map(|edge| edge.curve.start()).collect()
}

/// Area of the first piece of a draft, whose edges are straight (m²).
fn area(draft: &Draft) -> f64 {
    let corners = corners(draft);
    let next = corners.iter().cycle().skip(1);
    0.5 * corners
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp(b))
        .sum::<f64>()
}

#[track_caller]
fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

#[test]
fn a_closed_outline_in_millimetres_is_a_panel() {
    let mut file = File::default();
    metric(&mut file);
    let texts = [
        "Piece Name: FRONT",
        "Size: M",
        "Quantity: 2",
        "Material: SHELL",
    ]
    .map(words);
    let parts = [
        line(1, &SKIRT, true, &[]),
        line(7, &[[200.0, 100.0], [200.0, 500.0]], false, &[]),
    ];
    file.block("FRONT_M", &[parts.as_slice(), &texts].concat());
    let reading = file.read();
    assert_eq!(reading.format, Format::DxfAama);
    let pattern = &reading.pattern;
    let panel = &pattern.panels[0];
    assert_eq!(
        (panel.name.as_str(), pattern.fabrics[0].name.as_str()),
        ("FRONT", "SHELL")
    );
    assert_eq!(
        panel.cut,
        Cut {
            quantity: 2,
            mirrored: false
        }
    );
    assert_eq!(panel.grain, Number::Value(FRAC_PI_2));
    assert_eq!(panel.lines[0].edges.len(), 4);
    assert_near(area(&draft_of(pattern, None)), 0.24);
    // The file says nothing of a sew line.
    let guesses: Vec<&str> = reading
        .guesses
        .iter()
        .map(|guess| guess.option.word())
        .collect();
    assert_eq!(guesses, ["--inside"]);
}

#[test]
fn chains_out_of_order_and_turned_are_one_outline() {
    let [a, b, c, d] = SKIRT;
    let chain = [
        line(1, &[a, b], false, &[]),
        line(1, &[d, c], false, &[]),
        line(1, &[b, c], false, &[]),
        line(1, &[d, a], false, &[]),
    ];
    let mut file = File::default();
    metric(&mut file);
    file.block("BACK", &chain);
    let reading = file.read();
    assert_near(area(&draft_of(&reading.pattern, None)), 0.24);
    assert_eq!(reading.pattern.panels[0].name, "BACK");
}

#[test]
fn a_start_that_is_repeated_and_group_250_change_nothing() {
    let mut points = SKIRT.to_vec();
    points.push(SKIRT[0]);
    for (closed, further) in [(true, vec![]), (false, vec![]), (true, vec![(250, "2")])] {
        let mut file = File::default();
        metric(&mut file);
        file.block("BACK", &[line(1, &points, closed, &further)]);
        let pattern = file.read().pattern;
        assert_eq!(pattern.panels[0].lines[0].edges.len(), 4);
        assert_near(area(&draft_of(&pattern, None)), 0.24);
    }
}

#[test]
fn inches_are_read_and_a_wrong_unit_is_guessed() {
    let inches = SKIRT.map(|p| p.map(|x| x / 25.4));
    let mut file = File::default();
    file.style += &words("UNITS:ENGLISH");
    file.block("BACK", &[line(1, &inches, true, &[])]);
    let reading = file.read();
    assert_near(area(&draft_of(&reading.pattern, None)), 0.24);
    assert!(reading.guesses.iter().all(|guess| guess.what != "unit"));
    // METRIC, but in centimetres.
    let mut file = File::default();
    metric(&mut file);
    file.block(
        "BACK",
        &[line(1, &SKIRT.map(|p| p.map(|x| x / 10.0)), true, &[])],
    );
    let reading = file.read();
    assert_near(area(&draft_of(&reading.pattern, None)), 0.24);
    let guess = reading
        .guesses
        .iter()
        .find(|guess| guess.what == "unit")
        .unwrap();
    assert_eq!(
        (guess.chosen.as_str(), guess.option.word()),
        ("cm", "--unit")
    );
    let asked = ReadOptions {
        unit: Some(toile_pattern::DisplayUnit::Inch),
        ..ReadOptions::default()
    };
    let other = read(file.text().as_bytes(), &asked, &[]).unwrap();
    assert_near(area(&draft_of(&other.pattern, None)), 0.24 * 2.54 * 2.54);
    assert!(other.guesses.iter().all(|guess| guess.what != "unit"));
}

#[test]
fn names_in_gbk_are_read() {
    let mut file = File::default();
    metric(&mut file);
    file.block(
        "A",
        &[line(1, &SKIRT, true, &[]), words("Piece Name: NAME")],
    );
    let text = file.text();
    let at = text.find("NAME\r").unwrap();
    // 后片: the back.
    let bytes = [
        &text.as_bytes()[..at],
        b"\xba\xf3\xc6\xac",
        &text.as_bytes()[at + 4..],
    ]
    .concat();
    let reading = read(&bytes, &ReadOptions::default(), &[]).unwrap();
    assert_eq!(reading.pattern.panels[0].name, "后片");
}

/// A nest of three sizes; notches and corners stand in the middle one.
fn nest() -> File {
    let mut file = File::default();
    metric(&mut file);
    file.style += &words("Sample Size: M");
    for (size, wider) in [("S", -20.0), ("M", 0.0), ("L", 30.0)] {
        let right = 400.0 + wider;
        let ring = [
            [0.0, 0.0],
            [0.5 * right, -10.0],
            [right, 0.0],
            [right, 300.0],
            [right, 600.0],
            [0.0, 600.0],
        ];
        let mut parts = vec![
            line(1, &ring, true, &[]),
            words("Piece Name: FRONT"),
            words(&format!("Size: {size}")),
        ];
        if size == "M" {
            let corners = [ring[0], ring[2], ring[4], ring[5]];
            parts.extend(corners.map(|at| point(2, at, &[])));
            parts.push(point(3, ring[1], &[]));
            parts.push(point(4, ring[3], &[(30, "-4"), (39, "0")]));
            parts.push(point(4, ring[1], &[(39, "3")]));
            parts.push(point(80, [200.0, 600.0], &[(30, "5")]));
            parts.push(words("Quantity: 1,1"));
        }
        file.block(&format!("FRONT_{size}"), &parts);
    }
    file
}

#[test]
fn sizes_of_a_nest_take_marks_by_the_number_of_their_vertex() {
    let reading = nest().read();
    let pattern = &reading.pattern;
    let names: Vec<&str> = pattern
        .sizes
        .iter()
        .map(|size| size.name.as_str())
        .collect();
    assert_eq!(names, ["S", "M", "L"]);
    assert_eq!(pattern.base_size, Some(pattern.sizes[1].id));
    assert_eq!(pattern.panels.len(), 1);
    let panel = &pattern.panels[0];
    assert_eq!(
        panel.cut,
        Cut {
            quantity: 2,
            mirrored: true
        }
    );
    let edges = &panel.lines[0].edges;
    assert_eq!(edges.len(), 4, "hem, side, waist, side");
    let kinds: Vec<NotchKind> = panel.notches.iter().map(|notch| notch.kind).collect();
    assert_eq!(kinds, [NotchKind::Slit, NotchKind::V, NotchKind::T]);
    for (size, width) in [("S", 0.38), ("M", 0.4), ("L", 0.43)] {
        let draft = draft_of(pattern, Some(size));
        let piece = &draft.pieces[0];
        // The notch half-way up the right side stays there, and the one on the hem is at its lowest point.
        let places: Vec<_> = piece.notches.iter().map(|notch| notch.point).collect();
        assert_near(places[0].x, width);
        assert_near(places[0].y, 0.3);
        assert!(
            (places[1] - toile_geometry::Vec2::new(0.5 * width, -0.01)).norm() < 1e-6,
            "{:?}",
            places[1]
        );
    }
    let told = reading
        .losses
        .iter()
        .map(|loss| (loss.what.as_str(), loss.count));
    assert_eq!(told.collect::<Vec<_>>(), [("depths of notches", 2)]);
}

#[test]
fn a_half_piece_is_put_on_the_fold() {
    let mut file = File::default();
    metric(&mut file);
    let mirror = line(6, &[SKIRT[3], SKIRT[0]], false, &[]);
    file.block("BACK", &[line(1, &SKIRT, true, &[]), mirror]);
    let pattern = file.read().pattern;
    let kind = &pattern.panels[0].operations[0].kind;
    assert!(matches!(kind, OperationKind::Fold { .. }));
    assert_near(area(&draft_of(&pattern, None)), 0.48);
}

#[test]
fn a_fold_line_away_from_the_outline_is_a_loss() {
    let mut file = File::default();
    metric(&mut file);
    let mirror = line(6, &[[200.0, 0.0], [200.0, 600.0]], false, &[]);
    file.block("BACK", &[line(1, &SKIRT, true, &[]), mirror]);
    let reading = file.read();
    assert!(reading.pattern.panels[0].operations.is_empty());
    assert_eq!(reading.losses[0].what, "the fold line");
}

#[test]
fn two_outlines_in_a_block_are_two_pieces_and_a_third_within_one_is_cut_out() {
    let far = SKIRT.map(|[x, y]| [x + 500.0, 0.5 * y]);
    let hole = [[50.0, 50.0], [100.0, 50.0], [100.0, 100.0]];
    let mut file = File::default();
    metric(&mut file);
    let parts = [
        line(1, &SKIRT, true, &[]),
        line(1, &far, true, &[]),
        line(1, &hole, true, &[]),
    ];
    file.block(
        "POCKET",
        &[parts.as_slice(), &[words("Piece Name: POCKET")]].concat(),
    );
    let pattern = file.read().pattern;
    let names: Vec<&str> = pattern
        .panels
        .iter()
        .map(|panel| panel.name.as_str())
        .collect();
    assert_eq!(names, ["POCKET", "POCKET 2"]);
    let kinds = pattern.panels[0].lines.iter().map(|line| line.kind);
    assert_eq!(
        kinds.collect::<Vec<_>>(),
        [LineKind::Outline, LineKind::Hole]
    );
}

#[test]
fn a_sew_line_on_its_layer_or_evenly_inside_gives_allowances() {
    // 10 mm all round, 40 mm at the hem.
    let cut = [
        [-10.0, -40.0],
        [410.0, -40.0],
        [410.0, 610.0],
        [-10.0, 610.0],
    ];
    for layer in [14, 8] {
        let mut file = File::default();
        metric(&mut file);
        file.block(
            "BACK",
            &[line(1, &cut, true, &[]), line(layer, &SKIRT, true, &[])],
        );
        let reading = file.read();
        let panel = &reading.pattern.panels[0];
        assert_eq!(panel.allowance, Number::Value(0.01));
        let own: Vec<Option<f64>> = panel.lines[0]
            .edges
            .iter()
            .map(|edge| edge.allowance.as_ref().and_then(Number::value))
            .collect();
        assert_eq!(own, [Some(0.04), None, None, None]);
        assert_near(area(&draft_of(&reading.pattern, None)), 0.24);
        assert!(
            panel
                .lines
                .iter()
                .all(|line| line.kind == LineKind::Outline)
        );
        assert_eq!(reading.guesses, []);
    }
}

#[test]
fn an_allowance_that_is_asked_for_lies_inside_the_cut_line_but_on_the_fold() {
    let mut file = File::default();
    metric(&mut file);
    let mirror = line(6, &[SKIRT[3], SKIRT[0]], false, &[]);
    file.block("BACK", &[line(1, &SKIRT, true, &[]), mirror]);
    let asked = ReadOptions {
        allowance_inside: Some(0.01),
        ..ReadOptions::default()
    };
    let reading = read(file.text().as_bytes(), &asked, &[]).unwrap();
    assert_eq!(reading.guesses, []);
    let panel = &reading.pattern.panels[0];
    assert_eq!(panel.allowance, Number::Value(0.01));
    assert_near(area(&draft_of(&reading.pattern, None)), 2.0 * 0.39 * 0.58);
    let asked = ReadOptions {
        allowance_inside: Some(0.3),
        ..ReadOptions::default()
    };
    let reading = read(file.text().as_bytes(), &asked, &[]).unwrap();
    assert_eq!(reading.losses[0].what, "the allowance that was asked for");
}

#[test]
fn a_block_that_is_put_in_elsewhere_is_moved_turned_and_mirrored() {
    let mut file = File::default();
    metric(&mut file);
    file.block("BACK", &[line(1, &SKIRT, true, &[])]);
    file.inserts.clear();
    file.insert("BACK", &[(10, "1000"), (20, "0"), (50, "90"), (41, "-1")]);
    let pattern = file.read().pattern;
    let draft = draft_of(&pattern, None);
    assert_near(area(&draft), 0.24);
    let bounds = toile_geometry::Bounds2::of(corners(&draft));
    // x goes to -x by the mirror image, then by a quarter turn to y.
    assert_near(bounds.min.y, -0.4);
    assert_near(bounds.max.x, 1.0);
    assert_near(bounds.min.x, 0.4);
}

#[test]
fn twins_of_lines_make_it_astm_and_drills_and_texts_are_told() {
    let mut file = File::default();
    metric(&mut file);
    let parts = [
        line(1, &SKIRT, true, &[]),
        line(84, &SKIRT, true, &[]),
        point(13, [100.0, 100.0], &[]),
        words("NM"),
    ];
    file.block("BACK", &parts);
    let reading = file.read();
    assert_eq!(reading.format, Format::DxfAstm);
    let told: Vec<(&str, usize)> = reading
        .losses
        .iter()
        .map(|l| (l.what.as_str(), l.count))
        .collect();
    assert_eq!(told, [("texts", 1)]);
    let lines = &reading.pattern.panels[0].lines;
    let drill = lines.last().unwrap();
    assert_eq!(
        (drill.name.as_str(), drill.kind),
        ("drill 1", LineKind::Internal)
    );
}

#[test]
fn what_lies_nowhere_is_told() {
    let mut file = File::default();
    metric(&mut file);
    let open = line(1, &[[900.0, 0.0], [950.0, 0.0], [990.0, 90.0]], false, &[]);
    let parts = [
        line(1, &SKIRT, true, &[]),
        open,
        point(4, [200.0, 300.0], &[]),
        line(9, &[[0.0, 50.0], [400.0, 50.0]], false, &[]),
    ];
    file.block("BACK", &parts);
    file.insert("BACK", &[(10, "900")]);
    file.insert("SLEEVE", &[]);
    let reading = file.read();
    let told: Vec<&str> = reading
        .losses
        .iter()
        .map(|loss| loss.what.as_str())
        .collect();
    let expected = [
        "a further place of a piece",
        "a piece put in",
        "cut lines",
        "reference lines",
        "a notch",
    ];
    assert_eq!(told, expected);
    assert!(reading.pattern.panels[0].notches.is_empty());
}

#[test]
fn outlines_without_blocks_are_pieces_and_a_drawing_without_any_is_refused() {
    let mut file = File::default();
    let mut loose = String::new();
    tag(&mut loose, 0, "LWPOLYLINE");
    tag(&mut loose, 8, "pattern");
    tag(&mut loose, 70, 1);
    for [x, y] in SKIRT {
        tag(&mut loose, 10, x);
        tag(&mut loose, 20, y);
    }
    file.style = loose;
    let reading = file.read();
    assert_near(area(&draft_of(&reading.pattern, None)), 0.24);
    assert!(reading.guesses.iter().any(|guess| guess.what == "pieces"));
    let empty = read(
        File::default().text().as_bytes(),
        &ReadOptions::default(),
        &[],
    )
    .unwrap_err();
    assert!(empty.what.contains("no closed line"), "{empty}");
}

#[test]
fn files_that_hold_no_pattern_in_text_are_refused_by_name_with_a_remedy() {
    let mut marker = File::default();
    for (code, value) in [
        (0, "POLYLINE"),
        (8, "CUT"),
        (70, "1"),
        (0, "SEQEND"),
        (0, "TEXT"),
        (8, "TEXT"),
        (1, "Shirt, poplin"),
    ] {
        tag(&mut marker.style, code, value);
    }
    let marker = marker.text();
    let cases: [(&[u8], &str, &str); 4] = [
        (b"AutoCAD Binary DXF\r\n\x1a\0", "binary", "DXF in text"),
        (b"AC1032\0\0\0\0", "a DWG drawing", "save it as DXF"),
        (
            marker.as_bytes(),
            "a marker that `toile nest` wrote (Shirt, poplin)",
            "NAME.toile.json",
        ),
        (b"%PDF-1.7\n", "a PDF", "patterns are read from"),
    ];
    for (bytes, what, remedy) in cases {
        let error = read(bytes, &ReadOptions::default(), &[]).unwrap_err();
        assert!(
            error.what.contains(what) && error.hint.contains(remedy),
            "{error}"
        );
    }
}

#[test]
fn cut_outs_that_cannot_be_cut_out_and_lines_without_area_are_told() {
    let mut file = File::default();
    metric(&mut file);
    let across = [[350.0, 50.0], [450.0, 50.0], [450.0, 90.0]];
    let flat = [[10.0, 10.0], [20.0, 10.0], [30.0, 10.0]];
    let parts = [
        line(1, &SKIRT, true, &[]),
        line(11, &across, true, &[]),
        line(11, &[[20.0, 500.0], [60.0, 500.0]], false, &[]),
        line(1, &flat, true, &[]),
    ];
    file.block("BACK", &parts);
    file.block("EMPTY", &[words("NOTE")]);
    let reading = file.read();
    let told = reading.losses.iter().map(|loss| loss.what.as_str());
    assert_eq!(
        told.collect::<Vec<_>>(),
        ["blocks", "cut-outs", "closed cut lines", "a cut-out"]
    );
    let kinds = reading.pattern.panels[0].lines.iter().map(|line| line.kind);
    assert!(kinds.eq([LineKind::Outline, LineKind::Internal, LineKind::Internal]));
}
