//! Points moved, turned, mirrored, scaled, lined up and spread.

use super::*;
use crate::sample::{ends, formula, point, put_point, sample};
use std::f64::consts::FRAC_PI_6;
use toile_pattern::plan::{Affine, Alignment, Axis, CurveShape};

/// A sheet with a point of every free rule, a spline and an arc, all constructed from A and B.
fn constructions() -> (Pattern, SheetId, Vec<PointId>) {
    let (mut pattern, sheet) = blank();
    let p = &mut pattern;
    let a = dot(p, sheet, PointRule::at(0.1, 0.05));
    let b = dot(
        p,
        sheet,
        PointRule::Offset {
            base: a,
            x: formula("bust / 3"),
            y: 0.02.into(),
        },
    );
    let polar = PointRule::Polar {
        base: a,
        angle: formula("30deg"),
        distance: formula("bust / 5"),
    };
    let c = dot(p, sheet, polar);
    let between = PointRule::Between {
        base: a,
        tip: b,
        along: 0.5.into(),
        aside: 0.3.into(),
    };
    let d = dot(p, sheet, between);
    let toward = PointRule::Toward {
        base: c,
        tip: d,
        distance: 0.04.into(),
    };
    let e = dot(p, sheet, toward);
    let foot = PointRule::Foot {
        base: d,
        line: [a, b],
    };
    let f = dot(p, sheet, foot);
    let mirrored = PointRule::Mirrored {
        base: e,
        line: [a, b],
    };
    let g = dot(p, sheet, mirrored);
    let crossing = PointRule::Crossing {
        first: [a, d],
        second: [b, c],
    };
    let h = dot(p, sheet, crossing);
    let shape = CurveShape::Spline {
        handles: [v(0.12, 0.2), v(0.3, 0.2)],
        knots: vec![],
    };
    let (edits, curve) = plan::add_curve(&evaluated(p), (sheet, None), [a, b], shape).unwrap();
    *p = done(p, &edits);
    let on = PointRule::OnCurve {
        curve,
        share: 0.3.into(),
    };
    let i = dot(p, sheet, on);
    let along = PointRule::AlongCurve {
        curve,
        distance: (-0.05).into(),
    };
    let j = dot(p, sheet, along);
    let handles = ["h1", "h2"].map(|name| p.sheets[0].point_named(name).unwrap().id);
    let points = [&[a, b, c, d, e, f, g, h, i, j][..], &handles].concat();
    (pattern, sheet, points)
}

#[test]
fn every_construction_follows_rigid_maps_exactly() {
    let (pattern, _, points) = constructions();
    let adult = Measurements::adult();
    let before = places(&pattern, &adult, &points);
    for map in [
        Affine::translation(v(0.03, -0.2)),
        Affine::rotation(v(0.2, 0.1), 1.1),
        Affine::reflection([v(0.0, 0.1), v(0.5, 0.3)]),
    ] {
        let moved = plan::transform_points(&evaluated(&pattern), &points, &map).unwrap();
        let after = done(&pattern, &moved.edits);
        assert!(moved.held.is_empty(), "{map:?}: {:?}", moved.held);
        let found = places(&after, &adult, &points);
        for (k, at) in found.iter().enumerate() {
            same_place(*at, map.apply(before[k]));
        }
    }
}

/// A translation changes one point here, so that it is the same shift in every size.
#[test]
fn what_follows_along_is_not_moved_twice() {
    let (pattern, _, points) = constructions();
    let by = v(0.03, -0.2);
    let map = Affine::translation(by);
    let moved = plan::transform_points(&evaluated(&pattern), &points, &map).unwrap();
    assert_eq!(moved.edits.len(), 1, "{:?}", moved.edits);
    let after = done(&pattern, &moved.edits);
    for body in bodies() {
        let before = places(&pattern, &body, &points);
        let found = places(&after, &body, &points);
        for (a, b) in before.iter().zip(found) {
            same_place(a + by, b);
        }
    }
    // A polar point that is turned with its base turns in every size.
    let pair = [points[0], points[2]];
    let map = Affine::rotation(v(0.1, 0.05), FRAC_PI_6);
    let moved = plan::transform_points(&evaluated(&pattern), &pair, &map).unwrap();
    let after = done(&pattern, &moved.edits);
    for body in bodies() {
        let before = places(&pattern, &body, &pair);
        same_place(places(&after, &body, &pair)[1], map.apply(before[1]));
    }
}

#[test]
fn scaling_goes_where_it_can_and_tells_what_is_held() {
    let (pattern, _, points) = constructions();
    let adult = Measurements::adult();
    let before = places(&pattern, &adult, &points);
    let map = Affine::scaling(v(0.1, 0.05), [1.5, 1.5]);
    let moved = plan::transform_points(&evaluated(&pattern), &points, &map).unwrap();
    assert!(moved.held.is_empty());
    let after = done(&pattern, &moved.edits);
    for (k, at) in places(&after, &adult, &points).iter().enumerate() {
        same_place(*at, map.apply(before[k]));
    }
    // A foot cannot be sheared away from its line; the rest goes.
    let map = Affine::scaling(v(0.1, 0.05), [1.5, 0.7]);
    let moved = plan::transform_points(&evaluated(&pattern), &points, &map).unwrap();
    let after = done(&pattern, &moved.edits);
    assert!(moved.held.contains(&points[5]));
    let found = places(&after, &adult, &points);
    for k in (0..points.len()).filter(|&k| !moved.held.contains(&points[k])) {
        same_place(found[k], map.apply(before[k]));
    }
    assert!(moved.held.len() < 5, "{:?}", moved.held);
}

#[test]
fn points_that_cannot_move_are_listed_or_refused() {
    let mut pattern = sample();
    let line = ends(&pattern, "front", "bottom");
    let rule = PointRule::Foot {
        base: point(&pattern, "front", "p2"),
        line,
    };
    let foot = put_point(&mut pattern, 0, "foot", rule);
    let lost = put_point(&mut pattern, 0, "lost", PointRule::at(0.0, 0.0));
    let rule = PointRule::At {
        x: formula("bsut"),
        y: Number::ZERO,
    };
    crate::sample::place(&mut pattern, 0, "lost", rule);
    let map = Affine::translation(v(0.1, 0.1));
    let free = point(&pattern, "front", "p3");
    let evaluation = evaluated(&pattern);
    let moved = plan::transform_points(&evaluation, &[free, foot], &map).unwrap();
    assert_eq!(moved.held, [foot]);
    same_place(
        places(&done(&pattern, &moved.edits), &bodies()[0], &[free])[0],
        v(0.1, 0.7),
    );
    for (points, map, says) in [
        (vec![foot], map, "the foot of a perpendicular"),
        (vec![lost], map, "point \"lost\" cannot be drawn"),
        (vec![PointId(9999)], map, "point 9999 is not there"),
        (
            vec![free],
            Affine::reflection([v(0.0, 0.0); 2]),
            "not finite",
        ),
    ] {
        let told = refusal(plan::transform_points(&evaluation, &points, &map));
        assert!(told.contains(says), "{told}");
    }
    let none = plan::transform_points(&evaluation, &[], &map).unwrap();
    assert!(none.edits.is_empty() && none.held.is_empty());
}

#[test]
fn parts_line_up_and_spread() {
    let (mut pattern, sheet) = blank();
    let at = [(0.0, 0.0), (0.1, 0.5), (0.7, 0.2), (1.0, 0.1)];
    let p = at.map(|(x, y)| dot(&mut pattern, sheet, PointRule::at(x, y)));
    let groups = vec![vec![p[0]], vec![p[1], p[2]], vec![p[3]]];
    let evaluation = evaluated(&pattern);
    let body = Measurements::adult();
    for (alignment, wanted) in [
        (
            Alignment::Left,
            [(0.0, 0.0), (0.0, 0.5), (0.6, 0.2), (0.0, 0.1)],
        ),
        (
            Alignment::Right,
            [(1.0, 0.0), (0.4, 0.5), (1.0, 0.2), (1.0, 0.1)],
        ),
        (
            Alignment::Top,
            [(0.0, 0.5), (0.1, 0.5), (0.7, 0.2), (1.0, 0.5)],
        ),
        (
            Alignment::Bottom,
            [(0.0, 0.0), (0.1, 0.3), (0.7, 0.0), (1.0, 0.0)],
        ),
        (
            Alignment::Middle,
            [(0.5, 0.0), (0.2, 0.5), (0.8, 0.2), (0.5, 0.1)],
        ),
        (
            Alignment::Level,
            [(0.0, 0.25), (0.1, 0.4), (0.7, 0.1), (1.0, 0.25)],
        ),
    ] {
        let moved = plan::align(&evaluation, &groups, alignment).unwrap();
        let after = done(&pattern, &moved.edits);
        for (k, at) in places(&after, &body, &p).iter().enumerate() {
            same_place(*at, v(wanted[k].0, wanted[k].1));
        }
    }
    let moved = plan::distribute(&evaluation, &groups, Axis::X).unwrap();
    let after = done(&pattern, &moved.edits);
    let found = places(&after, &body, &p);
    same_place(found[1], v(0.2, 0.5));
    same_place(found[2], v(0.8, 0.2));
    let moved = plan::distribute(&evaluation, &groups, Axis::Y).unwrap();
    let found = places(&done(&pattern, &moved.edits), &body, &p);
    same_place(found[3], v(1.0, 0.175));
    assert!(
        refusal(plan::align(&evaluation, &groups[..1], Alignment::Left)).contains("at least 2")
    );
    assert!(refusal(plan::distribute(&evaluation, &groups[..2], Axis::X)).contains("at least 3"));
    assert!(plan::align(&evaluation, &[vec![], vec![p[0]]], Alignment::Left).is_err());
}

#[test]
fn parts_are_drawn_by_their_points() {
    let (pattern, sheet, points) = constructions();
    let evaluation = evaluated(&pattern);
    let curve = pattern.sheets[0].curves[0].id;
    let of_curve = plan::points_of(&evaluation, &[curve.into()]);
    assert_eq!(of_curve, [points[0], points[1], points[10], points[11]]);
    let all = plan::points_of(&evaluation, &[sheet.into(), points[0].into()]);
    assert_eq!(all.len(), points.len());
    let pattern = sample();
    let front = pattern.panels[0].id;
    let outline = pattern.panels[0].lines[0].clone();
    let evaluation = evaluated(&pattern);
    let of = |part: PartId| plan::points_of(&evaluation, &[part]);
    let corners: Vec<PointId> = pattern.sheets[0].points.iter().map(|p| p.id).collect();
    assert_eq!(of(front.into()), corners);
    assert_eq!(of(outline.id.into()), corners);
    assert_eq!(of(outline.edges[0].id.into()), corners[..2]);
    assert!(of(pattern.seams[0].id.into()).is_empty());
}
