//! Outlines in DXF: sew lines and allowances, halves, lines inside, curves, drawings of other programs.

use crate::dxf_file::{File, Truth, blocks, default_held, line, off, point, tag, words, written};
use toile_interchange::{Format, ReadOptions, read};

#[test]
fn a_sew_line_at_even_distances_gives_the_cut_line_again_with_its_corners() {
    use toile_pattern::Corner;
    // The cut line lies 10 mm outside, at the hem 40 mm; there the corners are mirrored, above they are mitred.
    let sew = [[0.0, 0.0], [300.0, 0.0], [260.0, 500.0], [40.0, 500.0]];
    let slope = (40.0_f64 / 500.0).atan();
    let (out, run) = (10.0 / slope.cos(), slope.tan());
    let right = |y: f64| 300.0 + out - y * run;
    let left = |y: f64| -out + y * run;
    // Turned up along the hem, the allowance lies on the side above it.
    let cut = [
        [left(40.0), -40.0],
        [left(0.0), 0.0],
        [left(510.0), 510.0],
        [right(510.0), 510.0],
        [right(0.0), 0.0],
        [right(40.0), -40.0],
    ];
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    let turns = cut.map(|p| point(2, p, &[]));
    let parts = [
        &[line(1, &cut, true, &[]), line(14, &sew, true, &[])],
        turns.as_slice(),
    ]
    .concat();
    file.block("SKIRT", &parts);
    let truth = Truth {
        piece: "SKIRT".to_owned(),
        size: String::new(),
        ring: cut[1..5].to_vec(),
        notches: Vec::new(),
        fold: None,
    };
    let reading = default_held(&file.text(), &[truth]);
    let edges = &reading.pattern.panels[0].lines[0].edges;
    assert_eq!(edges.len(), 4);
    assert!(
        edges
            .iter()
            .any(|edge| edge.corner.kind == Corner::Mirrored),
        "{edges:?}"
    );
    assert_eq!(
        edges.iter().filter(|edge| edge.allowance.is_some()).count(),
        1
    );
}

#[test]
fn the_sew_line_of_a_half_may_be_open_at_the_fold() {
    let cut = [[0.0, -10.0], [310.0, -10.0], [310.0, 510.0], [0.0, 510.0]];
    let sew = [[0.0, 0.0], [300.0, 0.0], [300.0, 500.0], [0.0, 500.0]];
    for closed in [true, false] {
        let mut file = File::default();
        file.style += &words("Units: METRIC");
        let parts = [
            line(1, &cut, true, &[]),
            line(14, &sew, closed, &[]),
            line(6, &[cut[0], cut[3]], false, &[]),
        ];
        file.block("BACK", &parts);
        let truth = Truth {
            piece: "BACK".to_owned(),
            size: String::new(),
            ring: cut.to_vec(),
            notches: Vec::new(),
            fold: Some(0.0),
        };
        let reading = default_held(&file.text(), &[truth]);
        let panel = &reading.pattern.panels[0];
        assert_eq!((panel.lines.len(), panel.operations.len()), (1, 1));
        let own: Vec<f64> = panel.lines[0]
            .edges
            .iter()
            .map(|edge| {
                edge.allowance
                    .as_ref()
                    .and_then(toile_pattern::Number::value)
            })
            .map(|own| own.unwrap_or(0.01))
            .collect();
        assert_eq!(panel.allowance, toile_pattern::Number::Value(0.01));
        assert_eq!(own, [0.01, 0.01, 0.01, 0.0]);
        assert_eq!(reading.losses, []);
    }
}

#[test]
fn turn_points_in_one_place_of_the_sample_are_two_corners() {
    // A dart mouth at the hem that is closed in the sample size.
    let ring = |mouth: f64| {
        [
            [0.0, 0.0],
            [150.0, 0.0],
            [150.0 + mouth, 0.0],
            [300.0, 0.0],
            [300.0, 400.0],
            [0.0, 400.0],
        ]
    };
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    file.style += &words("Sample Size: 8");
    for (size, mouth) in [("8", 0.0), ("10", 12.0)] {
        let mut parts = vec![
            line(1, &ring(mouth), true, &[]),
            words("Piece Name: SKIRT"),
            words(&format!("Size: {size}")),
        ];
        if size == "8" {
            parts.extend(ring(mouth).map(|p| point(2, p, &[])));
        }
        file.block(&format!("SKIRT_{size}"), &parts);
    }
    let pattern = read(file.text().as_bytes(), &ReadOptions::default(), &[])
        .unwrap()
        .pattern;
    assert_eq!(pattern.panels[0].lines[0].edges.len(), 6);
}

#[test]
fn a_closed_line_inside_a_narrow_piece_is_no_sew_line() {
    let band = [[0.0, 0.0], [700.0, 0.0], [700.0, 60.0], [0.0, 60.0]];
    let button = [[20.0, 20.0], [40.0, 20.0], [40.0, 40.0], [20.0, 40.0]];
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    file.block(
        "BAND",
        &[line(1, &band, true, &[]), line(8, &button, true, &[])],
    );
    let reading = read(file.text().as_bytes(), &ReadOptions::default(), &[]).unwrap();
    let panel = &reading.pattern.panels[0];
    assert_eq!((panel.lines.len(), panel.lines[0].edges.len()), (2, 4));
    assert_eq!(panel.allowance, toile_pattern::Number::ZERO);
}

#[test]
fn a_sew_line_that_no_allowance_explains_is_a_line_inside() {
    let cut = [[0.0, 0.0], [400.0, 0.0], [400.0, 600.0], [0.0, 600.0]];
    let sew = [[5.0, 40.0], [360.0, 5.0], [390.0, 540.0], [60.0, 590.0]];
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    file.block(
        "BACK",
        &[line(1, &cut, true, &[]), line(14, &sew, true, &[])],
    );
    let truth = Truth {
        piece: "BACK".to_owned(),
        size: String::new(),
        ring: cut.to_vec(),
        notches: Vec::new(),
        fold: None,
    };
    let reading = default_held(&file.text(), &[truth]);
    assert_eq!(reading.pattern.panels[0].lines.len(), 2);
    assert!(
        reading.losses.iter().any(|loss| loss.what == "a sew line"),
        "{:?}",
        reading.losses
    );
}

#[test]
fn smooth_curves_that_would_cross_give_way_to_chords() {
    // A slit between a curve, which bulges beyond its vertices, and a straight edge 0.02 mm beside these.
    let ring = vec![
        [0.0, 0.0],
        [0.0, 300.0],
        [200.0, 300.0],
        [203.0, 210.0],
        [203.0, 190.0],
        [200.0, 100.0],
        [201.0, 0.0],
        [203.02, 10.0],
        [203.02, 300.0],
        [400.0, 300.0],
        [400.0, -50.0],
        [0.0, -50.0],
    ];
    let turns = [0, 1, 2, 6, 7, 8, 9, 10, 11].map(|k: usize| point(2, ring[k], &[]));
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    let parts = [&[line(1, &ring, true, &[])], turns.as_slice()].concat();
    file.block("SLIT", &parts);
    let truth = Truth {
        piece: "SLIT".to_owned(),
        size: String::new(),
        ring,
        notches: Vec::new(),
        fold: None,
    };
    let reading = read(file.text().as_bytes(), &ReadOptions::default(), &[]).unwrap();
    let told = |what: &str| reading.losses.iter().any(|loss| loss.what == what);
    assert!(told("smoothness of an outline"), "{:?}", reading.losses);
    default_held(&file.text(), &[truth]);
}

#[test]
fn drawings_of_other_programs_are_read_by_their_outlines() {
    let mut file = File::default();
    // A pocket of lines and an arc below, out of order; units in the header.
    let entities: [&[(i32, &str)]; 4] = [
        &[
            (0, "LINE"),
            (8, "cut"),
            (10, "0"),
            (20, "0"),
            (11, "0"),
            (21, "150"),
        ],
        &[
            (0, "ARC"),
            (8, "cut"),
            (10, "100"),
            (20, "0"),
            (40, "100"),
            (50, "180"),
            (51, "360"),
        ],
        &[
            (0, "LINE"),
            (8, "cut"),
            (10, "200"),
            (20, "150"),
            (11, "200"),
            (21, "0"),
        ],
        &[
            (0, "LINE"),
            (8, "cut"),
            (10, "0"),
            (20, "150"),
            (11, "200"),
            (21, "150"),
        ],
    ];
    for (code, value) in entities.into_iter().flatten() {
        tag(&mut file.style, *code, value);
    }
    let header = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";
    let text = header.to_owned() + &file.text();
    let reading = read(text.as_bytes(), &ReadOptions::default(), &[]).unwrap();
    let panel = &reading.pattern.panels[0];
    assert_eq!(
        panel.lines[0].edges.len(),
        2,
        "the sides run on into the arc"
    );
    let told: Vec<&str> = reading
        .losses
        .iter()
        .map(|loss| loss.what.as_str())
        .collect();
    assert_eq!(told, ["exact shapes of ARC"]);
    let blocks = blocks(&written(&reading.pattern, Format::DxfAama));
    let outline = blocks[0].layer(1).next().unwrap();
    for k in 0..=100 {
        let turn = std::f64::consts::PI * (1.0 + f64::from(k) / 100.0);
        let p = [100.0 + 100.0 * turn.cos(), 100.0 * turn.sin()];
        assert!(off(p, outline) < 0.06, "{p:?}: {}", off(p, outline));
    }
}
