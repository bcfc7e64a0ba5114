//! Curves of a file: splines with handles, arcs.

use super::build::{Build, Slot, reference};
use super::kinds::{LENGTH, PLAIN, Quantity};
use super::rounds::{Round, full_circle, name_round};
use super::splines::{Handled, Made, handle, spline};
use super::things::{CurveThing, PointThing};
use roxmltree::Node;
use std::f64::consts::{PI, SQRT_2, TAU};
use toile_geometry::Curve as Piece;
use toile_pattern::{CurveRule, Number};

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

/// Name of a curve from its first and last point, as in `Spl_A_B`; several of one name are numbered.
fn name_of(build: &Build, node: Node<'_, '_>, kind: &str, ends: [PointThing; 2]) -> String {
    let [a, b] = ends.map(|end| build.file_name(end));
    match node.attribute("duplicate").map(str::trim) {
        None | Some("" | "0") => format!("{kind}_{a}_{b}"),
        Some(number) => format!("{kind}_{a}_{b}_{number}"),
    }
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
    spline(build, &name, &made)
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
    spline(build, &name, &handled)
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
    spline(build, &name, &points)
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
    let knots: Vec<Handled> = knots.collect();
    spline(build, &name, &knots)
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
    // An arc that runs clockwise has a negative length there.
    let (text, length) = match value < 0.0 {
        true => (format!("(-{})", made.length), -made.path.length()),
        false => (made.length.clone(), made.path.length()),
    };
    build.name_length(name.clone(), &text, length);
    name_round(build, &name, radius, [start, &sweep.end]);
    build.circles.insert(made.id, (centre, radius.clone()));
    Ok(made)
}

/// Makes an arc by both directions from its centre, counter-clockwise.
pub(super) fn arc(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "center")?;
    let radius = build.number(node, "radius", LENGTH)?;
    let start = build.number(node, "angle1", Quantity::Angle)?;
    let end = build.number(node, "angle2", Quantity::Angle)?;
    let swept = (end.value - start.value).rem_euclid(TAU);
    if !(1e-9..=TAU - 1e-9).contains(&swept) {
        let round = Round {
            centre,
            radius: &radius,
            start: &start,
            turn: TAU,
        };
        return full_circle(build, node, &round);
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
    if !swept.is_finite() {
        return Err("its radius is 0".to_owned());
    }
    if swept.abs() >= TAU - 1e-9 {
        let round = Round {
            centre,
            radius: &radius,
            start: &start,
            turn: TAU.copysign(swept),
        };
        return full_circle(build, node, &round);
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

/// Places of a curve moved by a function, for the base size.
pub(super) fn moved(curve: &CurveThing, by: impl Fn(Piece) -> Piece) -> Vec<Piece> {
    curve.path.curves().iter().map(|piece| by(*piece)).collect()
}
