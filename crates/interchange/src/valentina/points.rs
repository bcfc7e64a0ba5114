//! Points of a file: each tool becomes a construction.

use super::build::{Build, attribute_of};
use super::cuts::parts;
use super::kinds::{LENGTH, Quantity};
use super::things::{Made, PointThing};
use roxmltree::Node;
use std::f64::consts::FRAC_PI_2;
use toile_geometry::{Curve as Piece, Path, Vec2};
use toile_pattern::{Number, PointRule};

/// Length of the line that stands for an axis (m).
const AXIS: f64 = 0.1;
/// A crossing within this distance of the start of its axis is no crossing beyond it (m).
const SAME_PLACE: f64 = 1e-9;
/// Sine of an angle from which a corner is no straight line (1).
const STRAIGHT: f64 = 1e-9;
/// Reason for a point that lies where its line begins.
const NO_DIRECTION: &str =
    "both points of its line are in one place in the base size, so it lies there too";

/// Makes the point of a tool. `None`: the tool is none of these.
pub(super) fn point(build: &mut Build, node: Node<'_, '_>, tool: &str) -> Option<Made> {
    Some(match tool {
        "single" => single(build, node),
        "endLine" => end_line(build, node),
        "alongLine" => along_line(build, node),
        "normal" => normal(build, node),
        "pointOfIntersection" | "intersectXY" => of_both(build, node),
        "lineIntersect" => line_intersect(build, node),
        "lineIntersectAxis" => line_intersect_axis(build, node),
        "height" => height(build, node),
        "bisector" => bisector(build, node),
        "curveIntersectAxis" => curve_intersect_axis(build, node),
        _ => return None,
    })
}

pub(super) fn direction(angle: f64) -> Vec2 {
    Vec2::new(angle.cos(), angle.sin())
}

fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("name").unwrap_or_default()
}

/// A plain coordinate of the file (m).
fn coordinate(build: &Build, node: Node<'_, '_>, attribute: &str) -> Result<f64, String> {
    Ok(build.number(node, attribute, LENGTH)?.value)
}

fn single(build: &mut Build, node: Node<'_, '_>) -> Made {
    let at = Vec2::new(
        coordinate(build, node, "x")?,
        -coordinate(build, node, "y")?,
    );
    Ok(build.add_point(name(node), PointRule::at(at.x, at.y), at))
}

fn end_line(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "basePoint")?;
    let angle = build.number(node, "angle", Quantity::Angle)?;
    let distance = build.number(node, "length", LENGTH)?;
    let at = base.at + direction(angle.value) * distance.value;
    let rule = PointRule::Polar {
        base: base.id,
        angle: angle.number,
        distance: distance.number,
    };
    Ok(build.add_point(name(node), rule, at))
}

/// Names the distance of two points `CurrentLength` for the number that is read.
fn with_current_length<T>(
    build: &mut Build,
    [a, b]: [PointThing; 2],
    read: impl FnOnce(&mut Build) -> T,
) -> T {
    const NAME: &str = "CurrentLength";
    let text = format!("distance(?{}, ?{})", a.id.0, b.id.0);
    build.name_length(NAME.to_owned(), &text, (b.at - a.at).norm());
    let result = read(build);
    build.symbols.remove(NAME);
    result
}

fn along_line(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "firstPoint")?;
    let tip = build.point(node, "secondPoint")?;
    let read = |build: &mut Build| build.number(node, "length", LENGTH);
    let distance = with_current_length(build, [base, tip], read)?;
    if (tip.at - base.at).norm() <= 1e-12 {
        return Ok(build.at_place_of(name(node), base, NO_DIRECTION));
    }
    let way = unit(tip.at - base.at)?;
    let rule = PointRule::Toward {
        base: base.id,
        tip: tip.id,
        distance: distance.number,
    };
    Ok(build.add_point(name(node), rule, base.at + way * distance.value))
}

pub(super) fn unit(way: Vec2) -> Result<Vec2, String> {
    let same = || "its two points are in the same place".to_owned();
    way.try_normalize(1e-12).ok_or_else(same)
}

fn normal(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "firstPoint")?;
    let tip = build.point(node, "secondPoint")?;
    let read = |build: &mut Build| build.number(node, "length", LENGTH);
    let distance = with_current_length(build, [base, tip], read)?;
    let further = match node.attribute("angle") {
        Some(_) => Some(build.number(node, "angle", Quantity::Angle)?),
        None => None,
    };
    let further = further.filter(|angle| angle.number != Number::ZERO);
    let added = further.as_ref().map_or(0.0, |angle| angle.value);
    let Ok(way) = unit(tip.at - base.at) else {
        return Ok(build.at_place_of(name(node), base, NO_DIRECTION));
    };
    let angle = way.y.atan2(way.x) + FRAC_PI_2 + added;
    let mut text = format!("angle(?{}, ?{}) + 90deg", base.id.0, tip.id.0);
    if let Some(further) = further {
        text = format!("{text} + {}", further.text);
    }
    let rule = PointRule::Polar {
        base: base.id,
        angle: build.formula(&text)?,
        distance: distance.number,
    };
    let at = base.at + direction(angle) * distance.value;
    Ok(build.add_point(name(node), rule, at))
}

/// A point below or above one point, at the height of another.
fn of_both(build: &mut Build, node: Node<'_, '_>) -> Made {
    let first = build.point(node, "firstPoint")?;
    let second = build.point(node, "secondPoint")?;
    let rule = PointRule::At {
        x: build.formula(&format!("x(?{})", first.id.0))?,
        y: build.formula(&format!("y(?{})", second.id.0))?,
    };
    Ok(build.add_point(name(node), rule, Vec2::new(first.at.x, second.at.y)))
}

/// The crossing of two lines, each through two places.
fn crossing([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> Result<Vec2, String> {
    let (along, other) = (b - a, d - c);
    let turn = along.perp(&other);
    if turn.abs() <= 1e-12 * along.norm() * other.norm() {
        return Err("its two lines are parallel".to_owned());
    }
    Ok(a + along * ((c - a).perp(&other) / turn))
}

pub(super) fn cross(
    build: &mut Build,
    name: &str,
    first: [PointThing; 2],
    second: [PointThing; 2],
) -> Made {
    let at = crossing(first.map(|p| p.at), second.map(|p| p.at))?;
    let rule = PointRule::Crossing {
        first: first.map(|p| p.id),
        second: second.map(|p| p.id),
    };
    Ok(build.add_point(name, rule, at))
}

fn line_intersect(build: &mut Build, node: Node<'_, '_>) -> Made {
    let first = [build.point(node, "p1Line1")?, build.point(node, "p2Line1")?];
    let second = [build.point(node, "p1Line2")?, build.point(node, "p2Line2")?];
    Ok(crossing_or_origin(build, name(node), first, second))
}

/// The crossing of two lines; parallel ones have theirs at the origin there.
fn crossing_or_origin(
    build: &mut Build,
    name: &str,
    first: [PointThing; 2],
    second: [PointThing; 2],
) -> PointThing {
    match cross(build, name, first, second) {
        Ok(made) => made,
        Err(why) => build.at_origin(name, &why),
    }
}

/// A point on the axis through a point, in the direction of the attribute `angle`.
fn axis(build: &mut Build, node: Node<'_, '_>, base: PointThing) -> Made {
    let angle = build.number(node, "angle", Quantity::Angle)?;
    let rule = PointRule::Polar {
        base: base.id,
        angle: angle.number,
        distance: AXIS.into(),
    };
    let at = base.at + direction(angle.value) * AXIS;
    Ok(build.add_point(&format!("{} axis", name(node)), rule, at))
}

fn line_intersect_axis(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "basePoint")?;
    let line = [build.point(node, "p1Line")?, build.point(node, "p2Line")?];
    let tip = axis(build, node, base)?;
    Ok(crossing_or_origin(build, name(node), [base, tip], line))
}

fn height(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "basePoint")?;
    let line = [build.point(node, "p1Line")?, build.point(node, "p2Line")?];
    let way = unit(line[1].at - line[0].at)?;
    let at = line[0].at + way * way.dot(&(base.at - line[0].at));
    let rule = PointRule::Foot {
        base: base.id,
        line: line.map(|p| p.id),
    };
    Ok(build.add_point(name(node), rule, at))
}

fn bisector(build: &mut Build, node: Node<'_, '_>) -> Made {
    let first = build.point(node, "firstPoint")?;
    let corner = build.point(node, "secondPoint")?;
    let third = build.point(node, "thirdPoint")?;
    let read = |build: &mut Build| build.number(node, "length", LENGTH);
    let distance = with_current_length(build, [corner, first], read)?;
    let (a, b) = (unit(first.at - corner.at)?, unit(third.at - corner.at)?);
    let start = format!("angle(?{}, ?{})", corner.id.0, first.id.0);
    // A straight angle has two halves: the one to the left of its first leg is taken.
    let is_straight = a.dot(&b) < 0.0 && a.perp(&b).abs() <= STRAIGHT;
    let (half, text) = match is_straight {
        true => (FRAC_PI_2, format!("{start} + 90deg")),
        false => {
            let turn = format!("angle(?{}, ?{}) - {start}", corner.id.0, third.id.0);
            let half = a.perp(&b).atan2(a.dot(&b)) / 2.0;
            (
                half,
                format!("{start} + atan2(sin({turn}), cos({turn})) / 2"),
            )
        }
    };
    let rule = PointRule::Polar {
        base: corner.id,
        angle: build.formula(&text)?,
        distance: distance.number,
    };
    let at = corner.at + direction(a.y.atan2(a.x) + half) * distance.value;
    Ok(build.add_point(name(node), rule, at))
}

/// Crossings of a curve with the line through two places, along the curve, as the document counts them.
pub(super) fn line_crossings(path: &Path, start: Vec2, way: Vec2) -> Vec<Vec2> {
    let points = path.curves().iter().flat_map(Piece::defining_points);
    let reach = points.map(|p| (p - start).norm()).fold(0.0, f64::max);
    let ray = Path::new(vec![Piece::Line {
        start: start - way * (2.0 * reach),
        end: start + way * (2.0 * reach),
    }]);
    path.crossings(&ray).iter().map(|one| one.point).collect()
}

/// The crossing of a curve with an axis: the nearest one ahead of its start, else the nearest behind.
fn curve_intersect_axis(build: &mut Build, node: Node<'_, '_>) -> Made {
    let base = build.point(node, "basePoint")?;
    let curve = build.curve(node, "curve")?;
    let tip = axis(build, node, base)?;
    let way = unit(tip.at - base.at)?;
    let whole = whole_path(build, &curve);
    let found = line_crossings(&whole, base.at, way);
    let ahead = |p: &Vec2| way.dot(&(*p - base.at));
    let on_part = |p: &Vec2| {
        let nearest = curve.path.nearest(*p);
        nearest.is_some_and(|place| (curve.path.point(place) - *p).norm() <= 1e-7)
    };
    let candidates = found.iter().enumerate().filter(|(_, p)| on_part(p));
    let best = candidates.min_by(|(_, a), (_, b)| {
        let key = |p: &Vec2| {
            let along = ahead(p);
            (along <= SAME_PLACE, along.abs())
        };
        let (a, b) = (key(a), key(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let Some((index, at)) = best else {
        let name = attribute_of(node, "name")?;
        return Ok(build.at_origin(name, "the axis does not meet the curve"));
    };
    let rule = PointRule::LineCrossing {
        line: [base.id, tip.id],
        curve: curve.id,
        index: u16::try_from(index).unwrap_or_default(),
    };
    let made = build.add_point(attribute_of(node, "name")?, rule, *at);
    parts(build, node, &curve, made, None)?;
    Ok(made)
}

/// The course of the whole curve that a curve is part of.
pub(super) fn whole_path(build: &Build, curve: &super::things::CurveThing) -> Path {
    match curve.is_whole {
        true => curve.path.clone(),
        false => match build.wholes.get(&curve.id) {
            Some(whole) => whole.path.clone(),
            None => curve.path.clone(),
        },
    }
}
