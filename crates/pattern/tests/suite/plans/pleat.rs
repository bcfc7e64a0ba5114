//! Pleats: cloth under a panel that lies on its edges when it is folded.

use super::*;
use crate::sample::{self, sample};

/// Pleats of the front from its bottom to its top.
fn pleated(kind: PleatKind, pressed: Side, count: u16, depth: f64) -> (Pattern, OperationId) {
    let pattern = sample();
    let panel = pattern.panels[0].id;
    let edges = ["bottom", "top"].map(|name| sample::edge(&pattern, "front", name));
    let evaluation = evaluated(&pattern);
    let (line, lines) = plan::even_cuts(&evaluation, panel, edges, count).unwrap();
    let wish = plan::PleatWish {
        line,
        lines,
        depth: depth.into(),
        kind,
        pressed,
        held: None,
    };
    let (edits, id) = plan::pleat_panel(&evaluation, panel, wish).unwrap();
    (done(&pattern, &edits), id)
}

#[test]
fn a_pleat_takes_the_cloth_of_its_folds_and_no_length_of_a_seam() {
    let cases = [
        (PleatKind::Knife, Side::Left, 2.0),
        (PleatKind::Knife, Side::Right, 2.0),
        (PleatKind::Box, Side::Left, 4.0),
        (PleatKind::Inverted, Side::Left, 4.0),
    ];
    for (kind, pressed, times) in cases {
        let (pattern, id) = pleated(kind, pressed, 3, 0.02);
        let evaluation = evaluated(&pattern);
        assert!(evaluation.diagnostics().is_empty());
        let stage = evaluation.stage(pattern.panels[0].id, Some(id)).unwrap();
        let area: f64 = stage
            .outline()
            .iter()
            .map(|e| 0.5 * e.curve.swept_area())
            .sum();
        let wanted = 0.6 * (0.4 + 3.0 * times * 0.02);
        assert!((area - wanted).abs() < 1e-12, "{kind:?}: {area}");
        for name in ["bottom", "top", "left", "right"] {
            let edge = Name::Drawn(sample::edge(&pattern, "front", name));
            let own = stage.outline().iter().filter(|known| known.name == edge);
            let length: f64 = own.map(|edge| edge.curve.length()).sum();
            let drawn = if matches!(name, "bottom" | "top") {
                0.4
            } else {
                0.6
            };
            assert!((length - drawn).abs() < 1e-12, "{kind:?} {name}");
        }
        // Three creases and placements a fold, less the one that box folds share.
        let made = stage
            .lines
            .iter()
            .filter(|line| line.kind == LineKind::Internal);
        let lines: usize = 3 * if times > 3.0 { 5 } else { 3 };
        assert_eq!(made.clone().count(), lines);
        let placements = made.filter(|line| line.name.role() == Some(Role::Placement));
        assert_eq!(placements.count(), 3);
        let draft = evaluation.draft().0;
        assert_eq!(draft.pieces[0].internal_lines.len(), lines);
        let notes = evaluation.check();
        assert!(
            notes.iter().any(|note| note.code == Code::NotPressed),
            "{notes:?}"
        );
        assert!(
            notes.iter().all(|note| note.code == Code::NotPressed),
            "{notes:?}"
        );
    }
}

#[test]
fn the_underlay_of_a_pleat_lies_on_the_edge_beside_it_when_it_is_folded() {
    let mut pattern = sample();
    sample::bend(
        &mut pattern,
        0,
        "bottom",
        CurveRule::Arc { bulge: 0.15.into() },
    );
    let panel = pattern.panels[0].id;
    let edges = ["bottom", "top"].map(|name| sample::edge(&pattern, "front", name));
    let (line, lines) = plan::even_cuts(&evaluated(&pattern), panel, edges, 1).unwrap();
    let depth = 0.03;
    let wish = plan::PleatWish {
        line,
        lines,
        depth: depth.into(),
        kind: PleatKind::Knife,
        pressed: Side::Left,
        held: None,
    };
    let (edits, id) = plan::pleat_panel(&evaluated(&pattern), panel, wish).unwrap();
    pattern = done(&pattern, &edits);
    let evaluation = evaluated(&pattern);
    let stage = evaluation.stage(panel, Some(id)).unwrap();
    let drawn = evaluation
        .edge(sample::edge(&pattern, "front", "bottom"))
        .unwrap();
    let layer = |index: u16| {
        let name = Name::Made {
            by: id,
            role: Role::Underlay,
            index,
        };
        let found = stage.outline().iter().find(|edge| edge.name == name);
        found.unwrap().curve
    };
    // Pressed left: the first layer is the mirror image of the edge left of the line, the second
    // that edge as far to the right as the pleat takes.
    let fold = layer(0).start();
    for k in 0..=10 {
        let t = f64::from(k) / 10.0;
        let mirrored = layer(0).point(t);
        let under = v(2.0 * fold.x - mirrored.x, mirrored.y);
        let back = layer(1).point(t) - v(2.0 * depth, 0.0);
        for place in [under, back] {
            let near = drawn.point(drawn.nearest(place).unwrap());
            assert!((near - place).norm() < 1e-9, "{place}");
            assert!(place.x < fold.x + 1e-9 && place.x > fold.x - depth - 1e-9);
        }
    }
    assert!((layer(1).end() - fold - v(2.0 * depth, 0.0)).norm() < 1e-12);
}

#[test]
fn pleats_that_reach_beyond_their_edge_are_refused() {
    let pattern = sample();
    let panel = pattern.panels[0].id;
    let edges = ["bottom", "top"].map(|name| sample::edge(&pattern, "front", name));
    let evaluation = evaluated(&pattern);
    let (line, lines) = plan::even_cuts(&evaluation, panel, edges, 1).unwrap();
    for (depth, words) in [
        (0.25, "does not reach as far"),
        (-0.01, "less than nothing deep"),
    ] {
        let wish = plan::PleatWish {
            line,
            lines: lines.clone(),
            depth: depth.into(),
            kind: PleatKind::Inverted,
            pressed: Side::Left,
            held: None,
        };
        let error = plan::pleat_panel(&evaluation, panel, wish).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn a_number_too_large_for_its_corners_is_refused() {
    let (pattern, id) = pleated(PleatKind::Knife, Side::Left, 1, 0.02);
    let panel = &pattern.panels[0];
    let mut kind = panel.operations[0].kind.clone();
    if let OperationKind::Pleat { pleats, .. } = &mut kind {
        pleats[0].number = u16::MAX;
    }
    let evaluation = evaluated(&pattern);
    let error = plan::set_operation(&evaluation, (panel.id, id), kind).unwrap_err();
    assert!(error.to_string().contains("too large a number"), "{error}");
}

#[test]
fn pleats_follow_measurements_and_leave_every_drawn_length() {
    let mut pattern = sample();
    let panel = pattern.panels[0].id;
    let edges = ["bottom", "top"].map(|name| sample::edge(&pattern, "front", name));
    let (line, lines) = plan::even_cuts(&evaluated(&pattern), panel, edges, 2).unwrap();
    let wish = plan::PleatWish {
        line,
        lines,
        depth: sample::formula("bust / 40"),
        kind: PleatKind::Box,
        pressed: Side::Left,
        held: None,
    };
    let (edits, id) = plan::pleat_panel(&evaluated(&pattern), panel, wish).unwrap();
    pattern = done(&pattern, &edits);
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, wearer(&pattern, &body));
        let stage = evaluation.stage(panel, Some(id)).unwrap();
        let ends = stage.outline().iter().map(|edge| edge.curve.end().x);
        let width = ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min);
        let bust = evaluation
            .number(&sample::formula("bust"), Want::Length)
            .unwrap();
        assert!((width - 0.4 - 8.0 * bust / 40.0).abs() < 1e-9, "{width}");
    }
}
