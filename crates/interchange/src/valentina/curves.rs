//! Curves of a file: splines with handles, arcs.

use super::build::{Build, Slot, reference};
use super::kinds::{LENGTH, PLAIN, Quantity};
use super::points::direction;
use super::things::{CurveThing, PointThing};
use crate::exchange::Loss;
use roxmltree::Node;
use std::f64::consts::{PI, SQRT_2, TAU};
use std::sync::Arc;
use toile_geometry::{Curve as Piece, Vec2};
use toile_pattern::{CurveRule, Knot, Number, PointRule};

/// Answer of a tool: the curve, or the reason in words why it cannot be made.
pub(super) type Made = Result<Arc<CurveThing>, String>;

/// Makes the curve of a tool. `None`: the tool is none of these.
pub(super) fn curve(build: &mut Build, node: Node<'_, '_>, tool: &str) -> Option<Made> {
    Some(match tool {
        "simple" => simple(build, node),
        "simpleInteractive" => simple_interactive(build, node),
        "path" => path(build, node, old_knot),
        "pathInteractive" => path(build, node, knot),
        "cubicBezier" => cubic(build, node),
        "cubicBezierPath" => cubic_path(build, node),
        "arcWithLength" => arc_with_length(build, node),
        _ => return None,
    })
}

/// Distance of the handles of old splines, as a part of the chord: that of a quarter of a circle.
fn old_share() -> f64 {
    4.0 / 3.0 * (PI / 8.0).tan() / SQRT_2
}

/// A point with the handles of a spline before and after it.
struct Handled {
    point: PointThing,
    before: PointThing,
    after: PointThing,
}

/// Name of a curve from its first and last point, as in `Spl_A_B`; several of one name are numbered.
fn name_of(build: &Build, node: Node<'_, '_>, kind: &str, ends: [PointThing; 2]) -> String {
    let [a, b] = ends.map(|end| build.file_name(end));
    match node.attribute("duplicate").map(str::trim) {
        None | Some("" | "0") => format!("{kind}_{a}_{b}"),
        Some(number) => format!("{kind}_{a}_{b}_{number}"),
    }
}

/// A handle of a spline: a point in a direction and at a distance from a point.
fn handle(
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

/// A spline through points; the first handle of the first point and the last of the last are not used.
fn spline(build: &mut Build, name: &str, points: Vec<Handled>) -> Made {
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
    let pieces = points.windows(2).map(|pair| Piece::Cubic {
        start: pair[0].point.at,
        controls: [pair[0].after.at, pair[1].before.at],
        end: pair[1].point.at,
    });
    let pieces = pieces.collect();
    let made = build.add_curve(name, ends, rule, pieces);
    build.name_length(name.to_owned(), &made.length.clone(), made.path.length());
    Ok(made)
}

fn two_ends(build: &mut Build, node: Node<'_, '_>) -> Result<[PointThing; 2], String> {
    Ok([build.point(node, "point1")?, build.point(node, "point4")?])
}

/// Makes a spline of two points, with names for its angles and distances.
fn between(
    build: &mut Build,
    node: Node<'_, '_>,
    ends: [PointThing; 2],
    angles: [Slot; 2],
    distances: [(Number, String, f64); 2],
) -> Made {
    let name = name_of(build, node, "Spl", ends);
    let mut made = Vec::new();
    for k in 0..2 {
        let number = k + 1;
        let (distance, text, value) = &distances[k];
        let told = format!("{name} handle {number}");
        let point = handle(
            build,
            &told,
            ends[k],
            &angles[k],
            (distance.clone(), *value),
        );
        let angle = &angles[k];
        let of_angle = format!("Angle{number}{name}");
        build.name_value(of_angle, &angle.text, Quantity::Angle, angle.value);
        build.name_length(format!("C{number}Length{name}"), text, *value);
        made.push(Handled {
            point: ends[k],
            before: point,
            after: point,
        });
    }
    spline(build, &name, made)
}

fn simple(build: &mut Build, node: Node<'_, '_>) -> Made {
    let ends = two_ends(build, node)?;
    let angles = [
        build.number(node, "angle1", Quantity::Angle)?,
        build.number(node, "angle2", Quantity::Angle)?,
    ];
    let all = build.number(node, "kCurve", PLAIN)?.value;
    let own = [
        build.number(node, "kAsm1", PLAIN)?.value,
        build.number(node, "kAsm2", PLAIN)?.value,
    ];
    let mut distances = Vec::new();
    for own in own {
        distances.push(old_distance(build, ends, all * own)?);
    }
    let Ok(distances) = <[_; 2]>::try_from(distances) else {
        return Err("it has no handles".to_owned());
    };
    between(build, node, ends, angles, distances)
}

/// Distance of a handle of an old spline, which follows the chord.
fn old_distance(
    build: &Build,
    [a, b]: [PointThing; 2],
    factor: f64,
) -> Result<(Number, String, f64), String> {
    let share = factor * old_share();
    let text = format!("(distance(?{}, ?{}) * {share})", a.id.0, b.id.0);
    let value = (b.at - a.at).norm() * share;
    Ok((build.formula(&text)?, text, value))
}

fn simple_interactive(build: &mut Build, node: Node<'_, '_>) -> Made {
    let ends = two_ends(build, node)?;
    let angles = [
        build.number(node, "angle1", Quantity::Angle)?,
        build.number(node, "angle2", Quantity::Angle)?,
    ];
    let distances = [
        build.number(node, "length1", LENGTH)?,
        build.number(node, "length2", LENGTH)?,
    ];
    let distances = distances.map(|slot| (slot.number, slot.text, slot.value));
    between(build, node, ends, angles, distances)
}

/// The points of a path in a file.
fn path_points<'a, 'i>(node: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let all = node.children().filter(|one| one.has_tag_name("pathPoint"));
    all.collect()
}

type MakeKnot = fn(
    &mut Build,
    &str,
    (Node<'_, '_>, f64),
    [Option<PointThing>; 2],
    PointThing,
) -> Result<Handled, String>;

fn path(build: &mut Build, node: Node<'_, '_>, make: MakeKnot) -> Made {
    let nodes = path_points(node);
    let mut points = Vec::new();
    for one in &nodes {
        points.push(build.point(*one, "pSpline")?);
    }
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Err("it has no points".to_owned());
    };
    let name = name_of(build, node, "SplPath", [*first, *last]);
    let all = super::build::plain(build, node, "kCurve").unwrap_or(1.0);
    let mut handled = Vec::new();
    for (k, one) in nodes.iter().enumerate() {
        let neighbours = [k.checked_sub(1), k.checked_add(1)];
        let neighbours = neighbours.map(|at| points.get(at?).copied());
        let told = format!("{name} {}", k + 1);
        handled.push(make(build, &told, (*one, all), neighbours, points[k])?);
    }
    spline(build, &name, handled)
}

fn knot(
    build: &mut Build,
    name: &str,
    (node, _): (Node<'_, '_>, f64),
    neighbours: [Option<PointThing>; 2],
    point: PointThing,
) -> Result<Handled, String> {
    let mut handles = [point; 2];
    for (k, number) in [(0, "1"), (1, "2")] {
        if neighbours[k].is_none() {
            continue;
        }
        let angle = build.number(node, &format!("angle{number}"), Quantity::Angle)?;
        let distance = build.number(node, &format!("length{number}"), LENGTH)?;
        let told = format!("{name} handle {number}");
        handles[k] = handle(
            build,
            &told,
            point,
            &angle,
            (distance.number, distance.value),
        );
    }
    let [before, after] = handles;
    Ok(Handled {
        point,
        before,
        after,
    })
}

/// A point of an old path: one direction, and distances that follow the chords to its neighbours.
fn old_knot(
    build: &mut Build,
    name: &str,
    (node, all): (Node<'_, '_>, f64),
    neighbours: [Option<PointThing>; 2],
    point: PointThing,
) -> Result<Handled, String> {
    let ahead = build.number(node, "angle", Quantity::Angle)?;
    let behind = Slot {
        number: match &ahead.number {
            Number::Value(value) => Number::Value(value + PI),
            Number::Formula(_) | Number::Adjusted { .. } | Number::PerSize { .. } => {
                build.formula(&format!("{} + 180deg", ahead.text))?
            }
        },
        text: format!("({} + 180deg)", ahead.text),
        value: ahead.value + PI,
    };
    let mut handles = [point; 2];
    for (k, (angle, factor)) in [(&behind, "kAsm1"), (&ahead, "kAsm2")]
        .into_iter()
        .enumerate()
    {
        let Some(neighbour) = neighbours[k] else {
            continue;
        };
        let own = super::build::plain(build, node, factor).unwrap_or(1.0);
        let (distance, _, value) = old_distance(build, [point, neighbour], all * own)?;
        let told = format!("{name} handle {}", k + 1);
        handles[k] = handle(build, &told, point, angle, (distance, value));
    }
    let [before, after] = handles;
    Ok(Handled {
        point,
        before,
        after,
    })
}

fn cubic(build: &mut Build, node: Node<'_, '_>) -> Made {
    let ends = two_ends(build, node)?;
    let handles = [build.point(node, "point2")?, build.point(node, "point3")?];
    let name = name_of(build, node, "Spl", ends);
    let points = [0, 1].map(|k| Handled {
        point: ends[k],
        before: handles[k],
        after: handles[k],
    });
    spline(build, &name, points.into())
}

/// A path whose points are in turn a point, two handles, and the next point.
fn cubic_path(build: &mut Build, node: Node<'_, '_>) -> Made {
    let mut points = Vec::new();
    for one in path_points(node) {
        points.push(build.point(one, "pSpline")?);
    }
    // Points at the end that make no whole curve are not drawn there either.
    let whole = points.len().saturating_sub(1) / 3 * 3 + 1;
    points.truncate(whole);
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Err("it has no points".to_owned());
    };
    let name = name_of(build, node, "SplPath", [*first, *last]);
    let knots = (0..points.len()).step_by(3).map(|k| Handled {
        point: points[k],
        before: points[k.saturating_sub(1)],
        after: points[(k + 1).min(points.len() - 1)],
    });
    let knots = knots.collect();
    spline(build, &name, knots)
}

/// An arc from a start, as far round its centre as it sweeps.
struct Sweep {
    /// Direction of its end from the centre.
    end: Slot,
    /// Tangent of a quarter of the swept angle.
    bulge: (Number, f64),
}

/// Makes an arc.
fn make_arc(
    build: &mut Build,
    node: Node<'_, '_>,
    (centre, radius, start): (PointThing, &Slot, &Slot),
    sweep: Sweep,
) -> Made {
    let id = reference(node, "id")?;
    let name = format!("Arc_{}_{id}", build.file_name(centre));
    let (bulge, value) = sweep.bulge;
    if !(value.is_finite() && value.abs() < 1e6) {
        return Err("it is a full circle".to_owned());
    }
    let distance = (radius.number.clone(), radius.value);
    let from = handle(
        build,
        &format!("{name} start"),
        centre,
        start,
        distance.clone(),
    );
    let to = handle(build, &format!("{name} end"), centre, &sweep.end, distance);
    let piece = Piece::Arc {
        start: from.at,
        end: to.at,
        bulge: value,
    };
    let made = build.add_curve(&name, [from, to], CurveRule::Arc { bulge }, vec![piece]);
    build.name_length(name.clone(), &made.length.clone(), made.path.length());
    build.name_length(format!("Radius{name}"), &radius.text, radius.value);
    build.name_value(
        format!("Angle1{name}"),
        &start.text,
        Quantity::Angle,
        start.value,
    );
    build.circles.insert(made.id, (centre, radius.clone()));
    let end = &sweep.end;
    build.name_value(
        format!("Angle2{name}"),
        &end.text,
        Quantity::Angle,
        end.value,
    );
    Ok(made)
}

/// Makes an arc by both directions from its centre, counter-clockwise.
pub(super) fn arc(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "center")?;
    let radius = build.number(node, "radius", LENGTH)?;
    let start = build.number(node, "angle1", Quantity::Angle)?;
    let end = build.number(node, "angle2", Quantity::Angle)?;
    let mut swept = (end.value - start.value).rem_euclid(TAU);
    if swept <= 1e-9 {
        swept += TAU;
    }
    let value = (swept / 4.0).tan();
    let is_fixed = start.number.value().is_some() && end.number.value().is_some();
    let bulge = match is_fixed {
        true => Number::Value(value),
        false => {
            let (from, to) = (&start.text, &end.text);
            let turn = format!("{to} - {from}");
            // Whole turns that the base size has are taken off in all sizes.
            let turns = ((end.value - start.value - swept) / TAU).round();
            let text = match turns {
                0.0 => format!("tan(({turn}) / 4)"),
                -1.0 => format!("tan(if({to} > {from}, {turn}, {turn} + 360deg) / 4)"),
                turns => format!("tan(({turn} - {}deg) / 4)", turns * 360.0),
            };
            build.formula(&text)?
        }
    };
    let sweep = Sweep {
        end,
        bulge: (bulge, value),
    };
    make_arc(build, node, (centre, &radius, &start), sweep)
}

fn arc_with_length(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "center")?;
    let radius = build.number(node, "radius", LENGTH)?;
    let start = build.number(node, "angle1", Quantity::Angle)?;
    let length = build.number(node, "length", LENGTH)?;
    let swept = length.value / radius.value;
    if !(swept.is_finite() && swept.abs() < TAU) {
        return Err("it is longer than its circle".to_owned());
    }
    let turn = format!("{} / {}", length.text, radius.text);
    let text = format!("{} + {turn}", start.text);
    let end = Slot {
        number: build.formula(&text)?,
        text: format!("({text})"),
        value: start.value + swept,
    };
    let bulge = build.formula(&format!("tan({turn} / 4)"))?;
    let sweep = Sweep {
        end,
        bulge: (bulge, (swept / 4.0).tan()),
    };
    make_arc(build, node, (centre, &radius, &start), sweep)
}

/// Number of cubic curves that stand for an elliptic arc.
const PIECES: usize = 8;

/// Makes an elliptic arc as a spline that keeps its shape in the base size.
pub(super) fn elliptic(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "center")?;
    let [a, b] = [
        build.number(node, "radius1", LENGTH)?.value,
        build.number(node, "radius2", LENGTH)?.value,
    ];
    let [start, end] = [
        build.number(node, "angle1", Quantity::Angle)?.value,
        build.number(node, "angle2", Quantity::Angle)?.value,
    ];
    let turned = match node.attribute("rotationAngle") {
        Some(_) => build.number(node, "rotationAngle", Quantity::Angle)?.value,
        None => 0.0,
    };
    if !(a > 0.0 && b > 0.0) {
        return Err("its radius is not above 0".to_owned());
    }
    // Directions of points, and the angle whose cosine and sine give them on the ellipse.
    let parameter = |angle: f64| (angle.sin() / b).atan2(angle.cos() / a);
    let from = parameter(start);
    let swept = (parameter(end) - from).rem_euclid(TAU);
    let swept = if swept <= 1e-9 { swept + TAU } else { swept };
    let (sin, cos) = turned.sin_cos();
    let out = |x: f64, y: f64| Vec2::new(x * cos - y * sin, x * sin + y * cos);
    let step = swept / PIECES as f64;
    let reach = 4.0 / 3.0 * (step / 4.0).tan();
    let id = reference(node, "id")?;
    let name = format!("ElArc_{}_{id}", build.file_name(centre));
    let mut points = Vec::new();
    for k in 0..=PIECES {
        let (sin, cos) = (from + step * k as f64).sin_cos();
        let at = centre.at + out(a * cos, b * sin);
        let way = out(-a * sin, b * cos) * reach;
        let mut add = |what: &str, at: Vec2| {
            let told = format!("{name} {what}{k}");
            build.add_point(&told, PointRule::at(at.x, at.y), at)
        };
        points.push(Handled {
            point: add("", at),
            before: add("before ", at - way),
            after: add("after ", at + way),
        });
    }
    build.losses.push(Loss::at(
        name.clone(),
        "an elliptic arc",
        "a spline stands for it, as it is in the base size",
    ));
    spline(build, &name, points)
}

/// Places of a curve moved by a function, for the base size.
pub(super) fn moved(curve: &CurveThing, by: impl Fn(Piece) -> Piece) -> Vec<Piece> {
    curve.path.curves().iter().map(|piece| by(*piece)).collect()
}
