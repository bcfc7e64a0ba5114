//! Panels traced by corners, by curves, and round a place; their holes and internal lines.

use super::*;
use crate::sample::{formula, point, sample};
use toile_pattern::plan::{Chain, CurveShape, FirstCorner, Holes, NewPanel};

/// A rectangle of `bust / 2` by 0.4 with a horizontal line at 0.3 from side to side; points at
/// both its ends lie on the sides.
fn block() -> (Pattern, SheetId, Vec<PointId>) {
    let (pattern, sheet) = blank();
    let corner = FirstCorner::At([Number::ZERO, Number::ZERO]);
    let wish = (corner, [formula("bust / 2"), 0.4.into()]);
    let (edits, figure) = plan::add_rectangle(&evaluated(&pattern), sheet, wish, None).unwrap();
    let mut pattern = done(&pattern, &edits);
    let on = |curve, share: f64| PointRule::OnCurve {
        curve,
        share: share.into(),
    };
    let right = dot(&mut pattern, sheet, on(figure.curves[1], 0.75));
    let left = dot(&mut pattern, sheet, on(figure.curves[3], 0.25));
    straight(&mut pattern, sheet, [left, right]);
    let mut points = figure.points;
    points.extend([right, left]);
    (pattern, sheet, points)
}

fn edge_names(pattern: &Pattern, panel: PanelId) -> Vec<&str> {
    pattern
        .panel(panel)
        .unwrap()
        .edges()
        .map(|e| &*e.name)
        .collect()
}

#[test]
fn corners_follow_stretches_of_curves_either_way() {
    let (pattern, sheet, p) = block();
    let corners = [p[4], p[5], p[0], p[1]];
    for clockwise in [false, true] {
        let mut corners = corners.to_vec();
        if clockwise {
            corners.reverse();
        }
        let chain = Chain::Points(&corners);
        let (edits, panel) =
            plan::trace_panel(&evaluated(&pattern), sheet, chain, NewPanel::default()).unwrap();
        let after = done(&pattern, &edits);
        let mut names = edge_names(&after, panel);
        names.sort_unstable();
        assert_eq!(names, ["FE", "bottom", "left", "right"]);
        for body in bodies() {
            let wanted = body.get("bust").unwrap() / 2.0 * 0.3;
            assert!((area(&after, &body, panel) - wanted).abs() < 1e-9);
        }
        let evaluation = evaluated(&after);
        assert!(evaluation.diagnostics().is_empty());
    }
}

#[test]
fn chains_that_lead_nowhere_are_refused() {
    let (mut pattern, sheet, p) = block();
    let bow = CurveShape::Rule(CurveRule::Arc { bulge: 0.2.into() });
    let (edits, bow) = plan::add_curve(
        &evaluated(&pattern),
        (sheet, Some("bow")),
        [p[0], p[1]],
        bow,
    )
    .unwrap();
    pattern = done(&pattern, &edits);
    let curves: Vec<CurveId> = pattern.sheets[0].curves.iter().map(|c| c.id).collect();
    let evaluation = evaluated(&pattern);
    for (chain, says) in [
        (
            Chain::Points(&[p[0], p[2], p[3]]),
            "no curve leads from point \"A\" to point \"C\"",
        ),
        (
            Chain::Points(&[p[0], p[1], p[2], p[3]]),
            "\"bottom\" and \"bow\" both lead",
        ),
        (
            Chain::Points(&[p[3], p[2], p[4], p[2]]),
            "comes to point \"C\" twice",
        ),
        (Chain::Points(&[p[2]]), "fewer than two points"),
        (Chain::Points(&[p[4], p[2]]), "encloses nothing"),
        (Chain::Points(&[PointId(9999), p[2]]), "point 9999 on sheet"),
        (Chain::Curves(&[]), "has no curves"),
        (
            Chain::Curves(&curves[..3]),
            "\"top\" and \"bottom\" share no end",
        ),
        (
            Chain::Curves(&[curves[0], curves[2]]),
            "\"bottom\" and \"top\" share no end",
        ),
        (
            Chain::Curves(&[curves[0], bow, curves[0]]),
            "in the line twice",
        ),
    ] {
        let found = plan::trace_panel(&evaluation, sheet, chain, NewPanel::default());
        let told = refusal(found);
        assert!(told.contains(says), "{told}");
    }
    // Two curves between the same points enclose a panel all the same.
    let chain = Chain::Curves(&[bow, curves[0]]);
    let (edits, panel) = plan::trace_panel(&evaluation, sheet, chain, NewPanel::default()).unwrap();
    let after = done(&pattern, &edits);
    assert!(area(&after, &Measurements::adult(), panel) > 0.0);
    for (new, says) in [
        (
            NewPanel {
                name: Some("a'b"),
                fabric: None,
            },
            "cannot be a name",
        ),
        (
            NewPanel {
                name: Some("sheet"),
                fabric: None,
            },
            "which panel \"sheet\" has",
        ),
        (
            NewPanel {
                name: None,
                fabric: Some(FabricId(9999)),
            },
            "fabric 9999 is not there",
        ),
    ] {
        let chain = Chain::Curves(&[bow, curves[0]]);
        let told = refusal(plan::trace_panel(&evaluated(&after), sheet, chain, new));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn a_tap_inside_traces_the_face() {
    let (pattern, sheet, _) = block();
    for (place, share, names) in [
        (v(0.2, 0.1), 0.3, ["FE", "bottom", "left", "right"]),
        (v(0.2, 0.35), 0.1, ["FE", "left", "right", "top"]),
    ] {
        let (edits, panel) = plan::trace_face(
            &evaluated(&pattern),
            sheet,
            (place, Holes::Cut),
            NewPanel::default(),
        )
        .unwrap();
        let after = done(&pattern, &edits);
        let mut found = edge_names(&after, panel);
        found.sort_unstable();
        assert_eq!(found, names);
        for body in bodies() {
            let wanted = body.get("bust").unwrap() / 2.0 * share;
            assert!((area(&after, &body, panel) - wanted).abs() < 1e-9);
        }
    }
    let evaluation = evaluated(&pattern);
    for (place, says) in [
        (v(-0.1, 0.1), "no closed line of curves goes round"),
        (v(0.2, 0.3), "lies on curve \"FE\""),
        (v(f64::NAN, 0.3), "not finite"),
    ] {
        let wish = (place, Holes::Cut);
        let told = refusal(plan::trace_face(
            &evaluation,
            sheet,
            wish,
            NewPanel::default(),
        ));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn loose_lines_and_bridges_bound_nothing() {
    let (mut pattern, sheet, p) = block();
    // A loose line into the lower face, and an island tied to it by a bridge.
    let loose = dot(&mut pattern, sheet, PointRule::at(0.1, 0.05));
    straight(&mut pattern, sheet, [p[0], loose]);
    let island = [(0.2, 0.1), (0.3, 0.1), (0.3, 0.2)].map(|(x, y)| PointRule::at(x, y));
    let q = island.map(|rule| dot(&mut pattern, sheet, rule));
    for k in 0..3 {
        straight(&mut pattern, sheet, [q[k], q[(k + 1) % 3]]);
    }
    straight(&mut pattern, sheet, [loose, q[0]]);
    let wide = Measurements::adult().get("bust").unwrap() / 2.0 * 0.3;
    for (place, holes, wanted) in [
        (v(0.05, 0.2), Holes::Cut, wide - 0.005),
        (v(0.05, 0.2), Holes::Ignored, wide),
        (v(0.28, 0.13), Holes::Cut, 0.005),
    ] {
        let (edits, panel) = plan::trace_face(
            &evaluated(&pattern),
            sheet,
            (place, holes),
            NewPanel::default(),
        )
        .unwrap();
        let after = done(&pattern, &edits);
        let found = area(&after, &Measurements::adult(), panel);
        assert!((found - wanted).abs() < 1e-9, "{found} is not {wanted}");
        let lines = &after.panel(panel).unwrap().lines;
        assert_eq!(lines.len() == 2, wanted == wide - 0.005);
        assert!(
            evaluated(&after)
                .check()
                .iter()
                .all(|d| d.severity < Severity::Error)
        );
    }
}

#[test]
fn an_island_in_an_island_is_no_hole() {
    let (pattern, sheet) = blank();
    let mut pattern = pattern;
    for size in [0.6, 0.4, 0.2] {
        let corner = (1.0 - size) / 2.0;
        let corner = FirstCorner::At([corner.into(), corner.into()]);
        let wish = (corner, [size.into(), size.into()]);
        let (edits, _) = plan::add_rectangle(&evaluated(&pattern), sheet, wish, None).unwrap();
        pattern = done(&pattern, &edits);
    }
    for (place, wanted) in [
        (v(0.25, 0.5), 0.36 - 0.16),
        (v(0.35, 0.5), 0.16 - 0.04),
        (v(0.5, 0.5), 0.04),
    ] {
        let wish = (place, Holes::Cut);
        let new = NewPanel::default();
        let (edits, panel) = plan::trace_face(&evaluated(&pattern), sheet, wish, new).unwrap();
        let after = done(&pattern, &edits);
        for body in bodies() {
            assert!((area(&after, &body, panel) - wanted).abs() < 1e-9);
        }
    }
}

#[test]
fn a_closed_curve_alone_is_a_face() {
    let (mut pattern, sheet) = blank();
    let a = dot(&mut pattern, sheet, PointRule::at(0.0, 0.0));
    let shape = CurveShape::Spline {
        handles: [v(0.2, 0.1), v(-0.2, 0.1)],
        knots: vec![[v(0.1, 0.2), v(0.0, 0.2), v(-0.1, 0.2)]],
    };
    let (edits, drop) =
        plan::add_curve(&evaluated(&pattern), (sheet, None), [a, a], shape).unwrap();
    pattern = done(&pattern, &edits);
    let evaluation = evaluated(&pattern);
    let wish = (v(0.0, 0.1), Holes::Cut);
    let (edits, one) = plan::trace_face(&evaluation, sheet, wish, NewPanel::default()).unwrap();
    let by_place = done(&pattern, &edits);
    let chain = Chain::Curves(&[drop]);
    let (edits, two) = plan::trace_panel(&evaluation, sheet, chain, NewPanel::default()).unwrap();
    let by_curve = done(&pattern, &edits);
    let body = Measurements::adult();
    let found = area(&by_place, &body, one);
    assert!(found > 0.0 && (found - area(&by_curve, &body, two)).abs() < 1e-12);
    assert_eq!(edge_names(&by_place, one).len(), 1);
    let wish = (LineKind::Hole, None);
    let told = refusal(plan::add_line(&evaluated(&by_place), one, wish, chain));
    assert!(
        told.contains("runs the wrong way round for this line"),
        "{told}"
    );
}

#[test]
fn curves_that_cross_without_a_point_are_named() {
    let (mut pattern, sheet, p) = block();
    let cross = straight(&mut pattern, sheet, [p[0], p[2]]);
    let wish = (v(0.2, 0.05), Holes::Cut);
    let told = refusal(plan::trace_face(
        &evaluated(&pattern),
        sheet,
        wish,
        NewPanel::default(),
    ));
    assert!(
        told.contains("\"FE\" and \"AC\" cross where there is no point: put a point"),
        "{told}"
    );
    let level = pattern.sheets[0].curve_named("FE").unwrap().id;
    let (edits, made) = plan::mark_crossings(&evaluated(&pattern), sheet, [level, cross]).unwrap();
    pattern = done(&pattern, &edits);
    assert_eq!(made.len(), 1);
    let bottom = pattern.sheets[0].curve_named("bottom").unwrap().id;
    let top = pattern.sheets[0].curve_named("top").unwrap().id;
    for (curves, says) in [
        (
            [level, cross],
            "every crossing of curves \"FE\" and \"AC\" has a point",
        ),
        ([bottom, cross], "has a point"),
        ([bottom, top], "\"bottom\" and \"top\" do not cross"),
        ([top, top], "\"top\" and \"top\" do not cross"),
        ([top, CurveId(9999)], "curve 9999 is not there"),
    ] {
        let told = refusal(plan::mark_crossings(&evaluated(&pattern), sheet, curves));
        assert!(told.contains(says), "{told}");
    }
    let (edits, panel) =
        plan::trace_face(&evaluated(&pattern), sheet, wish, NewPanel::default()).unwrap();
    let after = done(&pattern, &edits);
    for body in bodies() {
        // Under the diagonal and under the level line.
        let width = body.get("bust").unwrap() / 2.0;
        let wanted = width * 0.4 / 2.0 - width / 4.0 * 0.1 / 2.0;
        same_place(places(&after, &body, &made)[0], v(0.75 * width, 0.3));
        assert!((area(&after, &body, panel) - wanted).abs() < 1e-9);
    }
}

#[test]
fn holes_and_internal_lines_come_and_go() {
    let mut pattern = sample();
    let sheet = pattern.sheets[0].id;
    let front = pattern.panels[0].id;
    let corner = FirstCorner::At([0.1.into(), 0.1.into()]);
    let wish = (corner, [0.1.into(), 0.2.into()]);
    let (edits, figure) = plan::add_rectangle(&evaluated(&pattern), sheet, wish, None).unwrap();
    pattern = done(&pattern, &edits);
    let before = pattern.clone();
    let chain = Chain::Points(&figure.points);
    let (edits, hole) =
        plan::add_line(&evaluated(&pattern), front, (LineKind::Hole, None), chain).unwrap();
    pattern = done(&pattern, &edits);
    let p0 = point(&pattern, "front", "p0");
    let slash = straight(&mut pattern, sheet, [p0, figure.points[0]]);
    let chain = Chain::Curves(&[slash]);
    let wish = (LineKind::Internal, Some("slash"));
    let (edits, line) = plan::add_line(&evaluated(&pattern), front, wish, chain).unwrap();
    pattern = done(&pattern, &edits);
    for body in bodies() {
        assert!((area(&pattern, &body, front) - 0.22).abs() < 1e-12);
    }
    let names: Vec<&str> = pattern.panels[0].lines.iter().map(|l| &*l.name).collect();
    assert_eq!(names, ["outline", "hole", "slash"]);
    assert!(
        evaluated(&pattern)
            .check()
            .iter()
            .all(|d| d.severity < Severity::Error)
    );
    let evaluation = evaluated(&pattern);
    let outline = pattern.panels[0].lines[0].id;
    for (wish, says) in [
        ((LineKind::Outline, None), "has an outline"),
        (
            (LineKind::Internal, Some("slash")),
            "line \"slash\" of panel \"front\"",
        ),
        ((LineKind::Hole, None), "share no end"),
    ] {
        let told = refusal(plan::add_line(&evaluation, front, wish, chain));
        assert!(told.contains(says), "{told}");
    }
    let told = refusal(plan::remove_line(&evaluation, (front, outline)));
    assert!(
        told.contains("would have no outline: remove the panel"),
        "{told}"
    );
    assert!(plan::remove_line(&evaluation, (front, LineId(9999))).is_err());
    for gone in [line, hole] {
        let edits = plan::remove_line(&evaluated(&pattern), (front, gone)).unwrap();
        pattern = done(&pattern, &edits);
    }
    pattern = done(&pattern, &[Edit::Remove(slash.into())]);
    assert!(pattern.says_the_same(&before));
}

#[test]
fn lines_that_cross_inside_a_face_are_named_though_they_are_loose() {
    let (mut pattern, sheet, _) = block();
    let bars = [
        [(0.05, 0.1), (0.25, 0.1)],
        [(0.05, 0.2), (0.25, 0.2)],
        [(0.1, 0.05), (0.1, 0.25)],
        [(0.2, 0.05), (0.2, 0.25)],
    ];
    for bar in bars {
        let ends = bar.map(|(x, y)| dot(&mut pattern, sheet, PointRule::at(x, y)));
        straight(&mut pattern, sheet, ends);
    }
    let evaluation = evaluated(&pattern);
    for place in [v(0.15, 0.15), v(0.02, 0.02)] {
        let wish = (place, Holes::Cut);
        let told = refusal(plan::trace_face(
            &evaluation,
            sheet,
            wish,
            NewPanel::default(),
        ));
        assert!(told.contains("cross where there is no point"), "{told}");
    }
    // Above the level line nothing crosses.
    let wish = (v(0.2, 0.35), Holes::Cut);
    assert!(plan::trace_face(&evaluation, sheet, wish, NewPanel::default()).is_ok());
}
