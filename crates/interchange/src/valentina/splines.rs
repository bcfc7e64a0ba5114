//! Splines of a file: points with their handles.

use super::build::{Build, Slot};
use super::kinds::Quantity;
use super::points::direction;
use super::things::{CurveThing, PointThing};
use std::f64::consts::TAU;
use std::sync::Arc;
use toile_geometry::Curve as Piece;
use toile_pattern::{CurveRule, Knot, Number, PointRule};

/// Answer of a tool: the curve, or the reason in words why it cannot be made.
pub(super) type Made = Result<Arc<CurveThing>, String>;

/// A point with the handles of a spline before and after it.
pub(super) struct Handled {
    pub point: PointThing,
    pub before: PointThing,
    pub after: PointThing,
}

/// A handle of a spline: a point in a direction and at a distance from a point.
pub(super) fn handle(
    build: &mut Build,
    name: &str,
    base: PointThing,
    angle: &Slot,
    distance: (Number, f64),
) -> PointThing {
    let rule = PointRule::Polar {
        base: base.id,
        angle: angle.number.clone(),
        distance: distance.0,
    };
    let at = base.at + direction(angle.value) * distance.1;
    build.add_point(name, rule, at)
}

/// Makes a spline through points; the first handle of the first point and the last of the last are not used.
pub(super) fn spline(build: &mut Build, name: &str, points: &[Handled]) -> Made {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Err("it has no points".to_owned());
    };
    if points.len() < 2 {
        return Err("it has a single point".to_owned());
    }
    let ends = [first.point, last.point];
    let handles = [first.after.id, last.before.id];
    let inner = &points[1..points.len() - 1];
    let knots = inner.iter().map(|one| Knot {
        before: one.before.id,
        point: one.point.id,
        after: one.after.id,
    });
    let rule = CurveRule::Spline {
        handles,
        knots: knots.collect(),
        to_length: None,
    };
    let pieces = points.windows(2).map(piece).collect();
    let made = build.add_curve(name, ends, rule, pieces);
    build.name_length(name.to_owned(), &made.length.clone(), made.path.length());
    name_handles(build, name, [first, last]);
    if points.len() > 2 {
        name_segments(build, name, points);
    }
    Ok(made)
}

/// The course between two points of a spline for the base size.
fn piece(pair: &[Handled]) -> Piece {
    Piece::Cubic {
        start: pair[0].point.at,
        controls: [pair[0].after.at, pair[1].before.at],
        end: pair[1].point.at,
    }
}

/// Names directions and lengths of the handles at both ends of a curve, where formulas use them.
fn name_handles(build: &mut Build, name: &str, [first, last]: [&Handled; 2]) {
    let ends = [(1, first.point, first.after), (2, last.point, last.before)];
    for (number, point, handle) in ends {
        let way = handle.at - point.at;
        let between = format!("?{}, ?{}", point.id.0, handle.id.0);
        let of_angle = format!("Angle{number}{name}");
        if build.is_wanted(&of_angle) {
            let angle = format!("angle({between})");
            let text = format!("if({angle} < 0, {angle} + 360deg, {angle})");
            let value = way.y.atan2(way.x).rem_euclid(TAU);
            build.name_value(of_angle, &text, Quantity::Angle, value);
        }
        let of_length = format!("C{number}Length{name}");
        if build.is_wanted(&of_length) {
            build.name_length(of_length, &format!("distance({between})"), way.norm());
        }
    }
}

/// Names the segments of a path and their handles, where formulas use them.
fn name_segments(build: &mut Build, name: &str, points: &[Handled]) {
    for (k, pair) in points.windows(2).enumerate() {
        let segment = format!("{name}_Seg_{}", k + 1);
        name_handles(build, &segment, [&pair[0], &pair[1]]);
        if !build.is_wanted(&segment) {
            continue;
        }
        let rule = CurveRule::Spline {
            handles: [pair[0].after.id, pair[1].before.id],
            knots: Vec::new(),
            to_length: None,
        };
        let ends = [pair[0].point, pair[1].point];
        let made = build.add_curve(&segment, ends, rule, vec![piece(pair)]);
        build.name_length(segment, &made.length.clone(), made.path.length());
    }
}
