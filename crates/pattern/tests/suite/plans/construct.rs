//! Sheets, points, curves and figures.

use super::*;
use crate::sample::{formula, put_point, sample};
use toile_pattern::plan::{CurveShape, FirstCorner, NewPanel};

#[test]
fn points_are_called_by_letters_and_lie_where_their_rules_say() {
    let (mut pattern, sheet) = blank();
    let a = dot(&mut pattern, sheet, PointRule::at(0.1, 0.2));
    let b = dot(
        &mut pattern,
        sheet,
        PointRule::Offset {
            base: a,
            x: formula("bust / 4"),
            y: Number::ZERO,
        },
    );
    let c = dot(
        &mut pattern,
        sheet,
        PointRule::Between {
            base: a,
            tip: b,
            along: 0.5.into(),
            aside: 0.0.into(),
        },
    );
    let names: Vec<&str> = pattern.sheets[0].points.iter().map(|p| &*p.name).collect();
    assert_eq!(names, ["A", "B", "C"]);
    for body in bodies() {
        let quarter = body.get("bust").unwrap() / 4.0;
        let found = places(&pattern, &body, &[a, b, c]);
        same_place(found[0], v(0.1, 0.2));
        same_place(found[1], v(0.1 + quarter, 0.2));
        same_place(found[2], v(0.1 + 0.5 * quarter, 0.2));
    }
    // The letter of a removed point is free again; after Z comes A1.
    pattern = done(&pattern, &[Edit::Remove(c.into())]);
    for _ in 0..25 {
        dot(&mut pattern, sheet, PointRule::at(0.0, 0.0));
    }
    assert_eq!(pattern.sheets[0].points[2].name, "C");
    assert_eq!(pattern.sheets[0].points[26].name, "A1");
}

#[test]
fn points_without_a_place_are_refused() {
    let mut pattern = sample();
    let front = pattern.sheets[0].id;
    let of_back = pattern.sheets[1].points[0].id;
    let p = [0, 1, 2, 3].map(|k| pattern.sheets[0].points[k].id);
    let gone = put_point(&mut pattern, 0, "gone", PointRule::at(0.0, 0.0));
    pattern.apply(&[Edit::Remove(gone.into())]).unwrap();
    let evaluation = evaluated(&pattern);
    let offset = |base, x: Number| PointRule::Offset {
        base,
        x,
        y: Number::ZERO,
    };
    let curves = [0, 2].map(|k| pattern.sheets[0].curves[k].id);
    for (name, rule, says) in [
        (
            None,
            offset(of_back, Number::ZERO),
            "which sheet \"front\" has not",
        ),
        (
            None,
            offset(gone, Number::ZERO),
            "which sheet \"front\" has not",
        ),
        (
            None,
            offset(p[0], formula("bust + 1")),
            "sheet \"front\", point",
        ),
        (None, offset(p[0], formula("bus")), "did you mean \"bust\"?"),
        (None, offset(p[0], f64::INFINITY.into()), "not finite"),
        (
            None,
            PointRule::CurveCrossing { curves, index: 0 },
            "they do not cross",
        ),
        (
            None,
            PointRule::Crossing {
                first: [p[0], p[1]],
                second: [p[3], p[2]],
            },
            "the two lines are parallel",
        ),
        (
            Some("p1"),
            PointRule::at(0.0, 0.0),
            "point \"p1\" of sheet \"front\" has",
        ),
        (Some("it's"), PointRule::at(0.0, 0.0), "cannot be a name"),
    ] {
        let told = refusal(plan::add_point(&evaluation, front, name, rule));
        assert!(told.contains(says), "{told}");
    }
    let nowhere = SheetId(9999);
    let told = refusal(plan::add_point(
        &evaluation,
        nowhere,
        None,
        PointRule::at(0.0, 0.0),
    ));
    assert!(told.contains("sheet 9999 is not there"), "{told}");
}

#[test]
fn curves_run_as_they_are_drawn() {
    let (mut pattern, sheet) = blank();
    let a = dot(&mut pattern, sheet, PointRule::at(0.0, 0.0));
    let b = dot(&mut pattern, sheet, PointRule::at(0.2, 0.0));
    let mut draw = |name, ends, shape| {
        let (edits, curve) =
            plan::add_curve(&evaluated(&pattern), (sheet, name), ends, shape).unwrap();
        pattern = done(&pattern, &edits);
        curve
    };
    let line = draw(None, [a, b], CurveShape::Rule(CurveRule::Line));
    // A half circle below, a flat arc above, a line through the middle.
    let half = draw(Some("half"), [a, b], CurveShape::ArcThrough(v(0.1, -0.1)));
    let flat = draw(None, [a, b], CurveShape::ArcThrough(v(0.05, 0.01)));
    let through = draw(None, [a, b], CurveShape::ArcThrough(v(0.15, 0.0)));
    let shape = CurveShape::Spline {
        handles: [v(0.05, 0.1), v(0.25, -0.1)],
        knots: vec![[v(0.08, 0.05), v(0.1, 0.02), v(0.12, -0.01)]],
    };
    let spline = draw(None, [a, b], shape);
    let evaluation = evaluated(&pattern);
    let names: Vec<&str> = pattern.sheets[0].curves.iter().map(|c| &*c.name).collect();
    assert_eq!(names, ["AB", "half", "AB 2", "AB 3", "AB 4"]);
    let points: Vec<&str> = pattern.sheets[0].points.iter().map(|p| &*p.name).collect();
    assert_eq!(points, ["A", "B", "h1", "C", "h2", "h3", "h4"]);
    let length = |curve| evaluation.curve(curve).unwrap().length();
    assert!((length(line) - 0.2).abs() < 1e-12);
    assert!((length(half) - 0.1 * std::f64::consts::PI).abs() < 1e-9);
    for (curve, on) in [
        (half, v(0.1, -0.1)),
        (flat, v(0.05, 0.01)),
        (through, v(0.15, 0.0)),
        (spline, v(0.1, 0.02)),
    ] {
        let path = evaluation.curve(curve).unwrap();
        same_place(path.point(path.nearest(on).unwrap()), on);
    }
    let pieces = evaluation.curve(spline).unwrap().curves().to_vec();
    let toile_geometry::Curve::Cubic { controls, .. } = pieces[0] else {
        panic!("a spline is cubic");
    };
    same_place(controls[0], v(0.05, 0.1));
    same_place(controls[1], v(0.08, 0.05));
    // Handles follow the point they belong to.
    let edits = plan::move_point(&evaluation, b, v(0.3, 0.1)).unwrap();
    let moved = done(&pattern, &edits);
    let last = pattern.sheets[0].point_named("h4").unwrap().id;
    same_place(evaluated(&moved).point(last).unwrap(), v(0.35, 0.0));
}

#[test]
fn curves_that_lead_nowhere_are_refused() {
    let pattern = sample();
    let sheet = pattern.sheets[0].id;
    let p = [0, 1].map(|k| pattern.sheets[0].points[k].id);
    let foreign = pattern.sheets[1].points[0].id;
    let evaluation = evaluated(&pattern);
    let line = || CurveShape::Rule(CurveRule::Line);
    let to_length = CurveRule::Spline {
        handles: p,
        knots: vec![],
        to_length: Some(9.0.into()),
    };
    for (name, ends, shape, says) in [
        (None, [p[0], p[0]], line(), "would end where it starts"),
        (
            None,
            [p[0], foreign],
            line(),
            "which sheet \"front\" has not",
        ),
        (
            Some("left"),
            p,
            line(),
            "curve \"left\" of sheet \"front\" has",
        ),
        (None, p, CurveShape::ArcThrough(v(0.5, 0.0)), "no arc leads"),
        (
            None,
            p,
            CurveShape::ArcThrough(v(f64::NAN, 0.0)),
            "not finite",
        ),
        (
            None,
            p,
            CurveShape::Rule(to_length),
            "scaling its handles reaches",
        ),
    ] {
        let told = refusal(plan::add_curve(&evaluation, (sheet, name), ends, shape));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn rectangles_keep_their_formulas_and_become_panels() {
    let (pattern, sheet) = blank();
    let size = [formula("bust / 4 + 2cm"), formula("waist / 2")];
    let at = [formula("1cm"), Number::Value(-0.2)];
    let new = NewPanel {
        name: Some("front"),
        fabric: None,
    };
    let (edits, figure) = plan::add_rectangle(
        &evaluated(&pattern),
        sheet,
        (FirstCorner::At(at), size),
        Some(new),
    )
    .unwrap();
    let pattern = done(&pattern, &edits);
    let panel = pattern.panel(figure.panel.unwrap()).unwrap();
    let names: Vec<&str> = panel.edges().map(|e| &*e.name).collect();
    assert_eq!(names, ["bottom", "right", "top", "left"]);
    assert_eq!(pattern.fabric(panel.fabric).unwrap().name, "poplin");
    for body in bodies() {
        let width = body.get("bust").unwrap() / 4.0 + 0.02;
        let height = body.get("waist").unwrap() / 2.0;
        let found = places(&pattern, &body, &figure.points);
        let (x, y) = (0.01, -0.2);
        for (k, corner) in [
            (x, y),
            (x + width, y),
            (x + width, y + height),
            (x, y + height),
        ]
        .into_iter()
        .enumerate()
        {
            same_place(found[k], v(corner.0, corner.1));
        }
        assert!((area(&pattern, &body, panel.id) - width * height).abs() < 1e-9);
    }
    // A second one begins at a corner of the first; its names stay free.
    let corner = FirstCorner::Point(figure.points[2]);
    let size = [Number::Value(-0.1), Number::Value(0.2)];
    let (edits, second) =
        plan::add_rectangle(&evaluated(&pattern), sheet, (corner, size), None).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(second.points[0], figure.points[2]);
    assert_eq!(pattern.sheets[0].curves[4].name, "bottom 2");
    assert_eq!(pattern.panels.len(), 1);
}

#[test]
fn rectangles_without_a_side_are_refused() {
    let (pattern, sheet) = blank();
    let evaluation = evaluated(&pattern);
    for (width, height, says) in [
        (Number::ZERO, formula("1cm"), "has no width"),
        (formula("1cm"), formula("bsut"), "has no height"),
        (formula("1cm"), formula("2"), "has no height"),
        (f64::NAN.into(), formula("2cm"), "not finite"),
    ] {
        let corner = FirstCorner::At([Number::ZERO, Number::ZERO]);
        let wish = (corner, [width, height]);
        let told = refusal(plan::add_rectangle(&evaluation, sheet, wish, None));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn polygons_run_counter_clockwise_as_panels() {
    let (pattern, sheet) = blank();
    let corners = [v(0.0, 0.0), v(0.0, 0.3), v(0.2, 0.4), v(0.2, 0.0)];
    let new = Some(NewPanel::default());
    let (edits, figure) = plan::add_polygon(&evaluated(&pattern), sheet, &corners, new).unwrap();
    let pattern = done(&pattern, &edits);
    let panel = figure.panel.unwrap();
    for body in bodies() {
        let found = places(&pattern, &body, &figure.points);
        found
            .iter()
            .zip(corners)
            .for_each(|(a, b)| same_place(*a, b));
        assert!((area(&pattern, &body, panel) - 0.07).abs() < 1e-12);
    }
    assert_eq!(pattern.panel(panel).unwrap().name, "sheet");
    let evaluation = evaluated(&pattern);
    for (places, says) in [
        (&corners[..2], "fewer than three corners"),
        (
            &[v(0.0, 0.0), v(0.0, 0.0), v(1.0, 0.0)][..],
            "two in one place",
        ),
        (
            &[v(0.0, f64::NAN), v(0.0, 0.0), v(1.0, 0.0)][..],
            "not finite",
        ),
        (
            &[v(0.0, 0.0), v(1.0, 0.0), v(2.0, 0.0)][..],
            "encloses nothing",
        ),
    ] {
        let told = refusal(plan::add_polygon(&evaluation, sheet, places, new));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn sheets_have_names_of_their_own() {
    let (pattern, _) = blank();
    let evaluation = evaluated(&pattern);
    let (edits, second) = plan::add_sheet(&evaluation, None, [0.5, 0.0]).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(pattern.sheet(second).unwrap().name, "sheet 2");
    assert_eq!(pattern.sheet(second).unwrap().on_table, [0.5, 0.0]);
    let told = refusal(plan::add_sheet(&evaluation, Some("sheet"), [0.0, 0.0]));
    assert!(told.contains("which sheet \"sheet\" has"), "{told}");
    assert!(plan::add_sheet(&evaluation, None, [f64::NAN, 0.0]).is_err());
}

#[test]
fn sheets_are_laid_elsewhere_and_nothing_else_changes() {
    let pattern = crate::sample::sample();
    let sheet = pattern.sheets[0].id;
    let edits = plan::move_sheets(&evaluated(&pattern), &[(sheet, [0.5, -0.25])]).unwrap();
    let mut after = done(&pattern, &edits);
    assert_eq!(after.sheets[0].on_table, [0.5, -0.25]);
    let back = plan::move_sheets(&evaluated(&after), &[(sheet, pattern.sheets[0].on_table)]);
    after = done(&after, &back.unwrap());
    assert_eq!(after, pattern);
    let nowhere = plan::move_sheets(&evaluated(&pattern), &[(sheet, [f64::NAN, 0.0])]);
    assert!(refusal(nowhere).contains("finite"));
    let gone = plan::move_sheets(&evaluated(&pattern), &[(SheetId(9999), [0.0, 0.0])]);
    assert!(matches!(gone, Err(EditError::Missing(_))));
}
