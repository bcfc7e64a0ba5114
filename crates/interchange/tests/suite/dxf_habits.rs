//! Habits of other programs' DXF that are easily lost: edges that vanish in a size, outlines that are left open, texts
//! in one block alone, marks that are drawn twice.

use crate::dxf_file::{File, blocks, draft_of, line, off, point, words, written};
use toile_geometry::Vec2;
use toile_interchange::{Format, ReadOptions, read};
use toile_pattern::OperationKind;

const RING: [[f64; 2]; 4] = [[0.0, 0.0], [400.0, 0.0], [400.0, 600.0], [0.0, 600.0]];

fn scaled(by: f64) -> Vec<[f64; 2]> {
    RING.iter().map(|p| p.map(|x| x * by)).collect()
}

fn metric() -> File {
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    file.style += &words("Sample Size: M");
    file
}

/// The corners of the outline of a piece (mm).
fn ring(file: &File, size: Option<&str>) -> Vec<[f64; 2]> {
    let draft = draft_of(&file.read().pattern, size);
    let edges = draft.pieces[0].outline.iter();
    edges
        .map(|edge| (edge.curve.start() * 1e3).into())
        .collect()
}

#[test]
fn edges_that_vanish_in_some_sizes_are_drafted_in_all() {
    for closed_in in [["S"].as_slice(), &["M"], &["S", "M"]] {
        let outline = |size: &str| {
            let mouth = if closed_in.contains(&size) { 0.0 } else { 6.0 };
            let [a, b, c, d] = RING;
            // Two mouths beside each other, and one at the start.
            let at = |x: f64| [x * mouth, 0.0];
            vec![
                a,
                at(1.0),
                [200.0, 0.0],
                [200.0 + mouth, 0.0],
                [200.0 + 2.0 * mouth, 0.0],
                b,
                c,
                d,
            ]
        };
        let mut file = metric();
        for size in ["S", "M", "L"] {
            let mut parts = vec![line(1, &outline(size), true, &[])];
            parts.extend([words("Piece Name: SKIRT"), words(&format!("Size: {size}"))]);
            if size == "M" {
                parts.extend(outline(size).into_iter().map(|p| point(2, p, &[])));
            }
            file.block(&format!("SKIRT_{size}"), &parts);
        }
        for size in ["S", "M", "L"] {
            let own = ring(&file, Some(size));
            assert_eq!(own.len(), 8);
            let next = own.iter().cycle().skip(1);
            let lengths = own
                .iter()
                .zip(next)
                .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
            let shortest = lengths.fold(f64::INFINITY, f64::min);
            assert!(shortest > 0.005, "{size}: {shortest} mm");
            let far = outline(size)
                .iter()
                .map(|p| off(*p, &own))
                .fold(0.0, f64::max);
            assert!(far < 0.03, "{size}: {far} mm");
        }
    }
}

#[test]
fn outlines_that_are_left_open_are_closed() {
    let fold = line(6, &[[0.0, 600.0], [0.0, 0.0]], false, &[]);
    let open = |by: f64| line(1, &scaled(by), false, &[]);
    // Open at the fold; not closed at all, but named as a piece.
    for (further, is_half) in [(fold, true), (words("Piece Name: BACK"), false)] {
        let mut file = metric();
        file.block("BACK", &[open(1.0), further]);
        let reading = file.read();
        let panel = &reading.pattern.panels[0];
        assert_eq!(panel.lines[0].edges.len(), 4);
        let is_fold = |kind: &OperationKind| matches!(kind, OperationKind::Fold { .. });
        assert_eq!(panel.operations.iter().any(|o| is_fold(&o.kind)), is_half);
        let told = reading.losses.iter().any(|loss| loss.what == "cut lines");
        assert_eq!(told, !is_half);
    }
}

#[test]
fn a_size_that_the_sample_alone_tells_is_one_of_those_of_the_names() {
    let mut file = metric();
    for (size, by) in [("S", 0.9), ("M", 1.0), ("L", 1.1)] {
        for piece in ["FRONT", "BACK"] {
            let mut parts = vec![line(1, &scaled(by), true, &[])];
            if size == "M" {
                parts.extend([
                    words(&format!("Piece Name: {piece} OF IT")),
                    words("Size: M"),
                ]);
            }
            file.block(&format!("{piece}_{size}"), &parts);
        }
    }
    let pattern = file.read().pattern;
    assert_eq!((pattern.panels.len(), pattern.sizes.len()), (2, 3));
    assert_eq!(pattern.panels[1].name, "BACK OF IT");
}

#[test]
fn grain_with_arrows_and_a_fold_that_is_drawn_twice_are_known() {
    let fold = line(6, &[[0.0, 0.0], [0.0, 600.0]], false, &[]);
    let arrow = |x: f64| line(7, &[[200.0, 500.0], [200.0 + x, 490.0]], false, &[]);
    let parts = [
        line(1, &RING, true, &[]),
        line(7, &[[200.0, 100.0], [200.0, 500.0]], false, &[]),
        arrow(5.0),
        arrow(-5.0),
        fold.clone(),
        fold,
    ];
    let mut file = metric();
    file.block("BACK", &parts);
    let pattern = file.read().pattern;
    assert_eq!(pattern.panels[0].operations.len(), 1);
    let grain = draft_of(&pattern, None).pieces[0].grain;
    let along = Vec2::new(grain.cos(), grain.sin());
    assert!(along.x.abs() < 1e-9, "{along}");
}

#[test]
fn values_of_notches_that_are_none_are_missing_ones() {
    let mut file = metric();
    let notch = point(4, [200.0, 0.0], &[(30, ""), (39, "1.#QNAN"), (50, "")]);
    file.block("BACK", &[line(1, &RING, true, &[]), notch]);
    let reading = read(file.text().as_bytes(), &ReadOptions::default(), &[]).unwrap();
    assert_eq!(reading.pattern.panels[0].notches.len(), 1);
}

#[test]
fn the_cut_line_of_a_coarse_sew_line_comes_back_with_its_corners() {
    const WIDTH: f64 = 15.0;
    // Segments of circles by few vertices, which meet their chord at right angles, and at one so acute that the mitre is
    // longer than usual.
    for (angle, steps) in [(90.0_f64, 7), (38.0, 3)] {
        let angle = angle.to_radians();
        let arc = |radius: f64, k: usize| {
            let turn = angle * (1.0 - 2.0 * k as f64 / f64::from(steps));
            [radius * turn.sin(), radius * turn.cos()]
        };
        let mut file = metric();
        let mut drawn = Vec::new();
        for (size, radius) in [("M", 200.0), ("L", 230.0)] {
            let chord = radius * angle.cos() - WIDTH;
            let corner = ((radius + WIDTH).powi(2) - chord * chord).sqrt();
            let mut cut: Vec<[f64; 2]> = (0..=steps as usize)
                .map(|k| arc(radius + WIDTH, k))
                .collect();
            cut[0] = [corner, chord];
            cut[steps as usize] = [-corner, chord];
            let sew: Vec<[f64; 2]> = (0..=steps as usize).map(|k| arc(radius, k)).collect();
            let mut parts = vec![line(1, &cut, true, &[]), line(14, &sew, true, &[])];
            parts.extend([words("Piece Name: YOKE"), words(&format!("Size: {size}"))]);
            parts.extend([cut[0], cut[steps as usize]].map(|p| point(2, p, &[])));
            parts.extend((1..steps as usize).map(|k| point(3, cut[k], &[])));
            file.block(&format!("YOKE_{size}"), &parts);
            drawn.push(cut);
        }
        let text = written(&file.read().pattern, Format::DxfAama);
        let pieces = blocks(&text);
        assert_eq!(pieces.len(), 2);
        for (piece, drawn) in pieces.iter().zip(drawn) {
            let again = piece.layer(1).next().unwrap();
            let worst = drawn.iter().map(|&p| off(p, again)).fold(0.0, f64::max);
            assert!(worst < 0.05, "{angle}: {worst} mm");
            for corner in [drawn[0], drawn[steps as usize]] {
                let away = |p: &[f64; 2]| (p[0] - corner[0]).hypot(p[1] - corner[1]);
                let nearest = again.iter().map(away).fold(f64::INFINITY, f64::min);
                assert!(nearest < 0.05, "{angle}: {nearest} mm");
            }
        }
    }
}
