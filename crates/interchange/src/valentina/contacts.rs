//! Points at distances from others: on lines and circles, and where curves cross.

use super::build::{Build, Slot, attribute_of, reference};
use super::kinds::LENGTH;
use super::points::unit;
use super::things::{CurveThing, Made, PointThing, Thing};
use crate::exchange::Loss;
use roxmltree::Node;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{Number, PointRule};

/// Share of the square of a radius by which a line or circle that touches a circle may miss it (1).
const TOUCHING: f64 = 1e-12;

/// Makes the point of a tool. `None`: the tool is none of these.
pub(super) fn point(build: &mut Build, node: Node<'_, '_>, tool: &str) -> Option<Made> {
    Some(match tool {
        "pointOfContact" => of_contact(build, node),
        "shoulder" => shoulder(build, node),
        "triangle" => triangle(build, node),
        "pointOfIntersectionCircles" => of_circles(build, node),
        "pointOfIntersectionArcs" => of_arcs(build, node),
        "pointOfIntersectionCurves" => of_curves(build, node),
        "pointFromCircleAndTangent" => tangent_of_circle(build, node),
        "pointFromArcAndTangent" => tangent_of_arc(build, node),
        _ => return None,
    })
}

fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("name").unwrap_or_default()
}

/// A point that stays where it is in the base size, which is said.
pub(super) fn fixed(build: &mut Build, name: &str, at: Vec2) -> PointThing {
    build.losses.push(Loss::at(
        name,
        "a construction",
        "the point stays where the base size has it",
    ));
    build.add_point(name, PointRule::at(at.x, at.y), at)
}

/// The second leg of a right triangle (m). `None`: its hypotenuse is shorter than its first leg.
fn leg(hypotenuse: f64, first: f64) -> Option<f64> {
    let square = (hypotenuse - first) * (hypotenuse + first);
    // Where a line or a circle only touches a circle, rounding may leave a square just below zero.
    (square >= -TOUCHING * hypotenuse * hypotenuse).then(|| square.max(0.0).sqrt())
}

/// Distances from the start of a line to both places at a distance from a centre, the nearer one first (m).
fn on_line(line: [Vec2; 2], centre: Vec2, distance: f64) -> Result<[f64; 2], String> {
    let way = unit(line[1] - line[0])?;
    let middle = way.dot(&(centre - line[0]));
    let aside = way.perp(&(centre - line[0]));
    let half = leg(distance, aside).ok_or("the line is farther away than the distance")?;
    Ok([middle - half, middle + half])
}

fn line_ends(
    build: &mut Build,
    node: Node<'_, '_>,
    attributes: [&str; 2],
) -> Result<[PointThing; 2], String> {
    Ok([
        build.point(node, attributes[0])?,
        build.point(node, attributes[1])?,
    ])
}

fn of_contact(build: &mut Build, node: Node<'_, '_>) -> Made {
    let line = line_ends(build, node, ["firstPoint", "secondPoint"])?;
    let centre = build.point(node, "center")?;
    let radius = build.number(node, "radius", LENGTH)?;
    let places = line.map(|end| end.at);
    let reach = match on_line(places, centre.at, radius.value) {
        Ok(reach) => reach,
        Err(why) => return Ok(build.at_origin(name(node), &why)),
    };
    let total = (places[1] - places[0]).norm();
    let within = reach.map(|along| (-1e-9..=total + 1e-9).contains(&along));
    let far = match within {
        [false, true] => true,
        [true, false] => false,
        // Both or neither lie between the ends: the one nearer to the start.
        [true, true] | [false, false] => reach[1].abs() < reach[0].abs(),
    };
    at_on_line(build, node, line, (centre, radius.number), (reach, far))
}

/// The nearer or farther point of a line at a distance from a centre; `reach` are their distances from its
/// start (m).
fn at_on_line(
    build: &mut Build,
    node: Node<'_, '_>,
    line: [PointThing; 2],
    (centre, distance): (PointThing, Number),
    (reach, far): ([f64; 2], bool),
) -> Made {
    let way = unit(line[1].at - line[0].at)?;
    let rule = PointRule::OnLineAt {
        line: line.map(|end| end.id),
        centre: centre.id,
        distance,
        far,
    };
    let at = line[0].at + way * reach[usize::from(far)];
    Ok(build.add_point(name(node), rule, at))
}

fn shoulder(build: &mut Build, node: Node<'_, '_>) -> Made {
    let line = line_ends(build, node, ["p1Line", "p2Line"])?;
    let centre = build.point(node, "pShoulder")?;
    let distance = build.number(node, "length", LENGTH)?;
    let places = line.map(|end| end.at);
    let total = (places[1] - places[0]).norm();
    let reach = on_line(places, centre.at, distance.value);
    let Some(reach) = reach.ok().filter(|[_, far]| *far >= total - 1e-9) else {
        let why = "its length does not reach beyond the end of the line, so it lies at that end";
        return Ok(build.at_place_of(name(node), line[1], why));
    };
    at_on_line(build, node, line, (centre, distance.number), (reach, true))
}

/// The corner of a right angle on an axis, over the line between two points.
fn triangle(build: &mut Build, node: Node<'_, '_>) -> Made {
    let axis = line_ends(build, node, ["axisP1", "axisP2"])?;
    let ends = line_ends(build, node, ["firstPoint", "secondPoint"])?;
    let rule = PointRule::Between {
        base: ends[0].id,
        tip: ends[1].id,
        along: 0.5.into(),
        aside: 0.0.into(),
    };
    let middle = (ends[0].at + ends[1].at) / 2.0;
    let radius = (ends[1].at - ends[0].at).norm() / 2.0;
    if !separates(axis.map(|end| end.at), ends.map(|end| end.at)) {
        let why =
            "its axis does not pass between its points: it lies where the axis meets their line";
        return match super::points::cross(build, name(node), axis, ends) {
            Ok(made) => {
                build
                    .losses
                    .push(Loss::at(name(node), "a construction", why));
                Ok(made)
            }
            Err(parallel) => Ok(build.at_origin(name(node), &parallel)),
        };
    }
    let reach = on_line(axis.map(|end| end.at), middle, radius)?;
    let centre = build.add_point(&format!("{} middle", name(node)), rule, middle);
    let text = format!("distance(?{}, ?{}) / 2", ends[0].id.0, ends[1].id.0);
    let distance = build.formula(&text)?;
    at_on_line(build, node, axis, (centre, distance), (reach, true))
}

/// Whether a line passes between two places, or through one.
fn separates(line: [Vec2; 2], [a, b]: [Vec2; 2]) -> bool {
    let way = line[1] - line[0];
    let side = |at: Vec2| way.perp(&(at - line[0]));
    side(a) * side(b) <= 1e-18
}

/// Both places at two distances from two centres: left of the way from the first to the second, and right.
fn of_two_distances(centres: [Vec2; 2], distances: [f64; 2]) -> Result<[Vec2; 2], String> {
    let way = centres[1] - centres[0];
    let between = way.norm();
    let unit = unit(way)?;
    let [r, s] = distances;
    let along = (between * between + r * r - s * s) / (2.0 * between);
    let aside = leg(r, along).ok_or("the two circles do not meet")?;
    let left = Vec2::new(-unit.y, unit.x) * aside;
    let foot = centres[0] + unit * along;
    Ok([foot + left, foot - left])
}

/// Whether an attribute asks for the second of two crossings.
fn is_second(node: Node<'_, '_>, attribute: &str) -> bool {
    node.attribute(attribute).map(str::trim) == Some("2")
}

fn of_circles(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centres = line_ends(build, node, ["c1Center", "c2Center"])?;
    let first = build.number(node, "c1Radius", LENGTH)?;
    let second = build.number(node, "c2Radius", LENGTH)?;
    let values = [first.value, second.value];
    let found = match of_two_distances(centres.map(|one| one.at), values) {
        Ok(found) => found,
        Err(why) => return Ok(build.at_origin(name(node), &why)),
    };
    // The first of the two lies to the right there.
    let left = is_second(node, "crossPoint");
    let at = if left { found[0] } else { found[1] };
    let rule = PointRule::TwoDistances {
        centres: centres.map(|one| one.id),
        distances: [first.number, second.number],
        left,
    };
    Ok(build.add_point(name(node), rule, at))
}

/// The point where two curves cross at a place.
fn crossing_at(
    build: &mut Build,
    node: Node<'_, '_>,
    curves: [Arc<CurveThing>; 2],
    choose: impl Fn(&[Vec2]) -> Option<usize>,
) -> Made {
    let wholes = [0, 1].map(|k| super::points::whole_path(build, &curves[k]));
    let found = wholes[0].crossings(&wholes[1]);
    let places: Vec<Vec2> = found.iter().map(|one| one.point).collect();
    let is_on = |curve: &CurveThing, at: Vec2| {
        let place = curve.path.nearest(at);
        place.is_some_and(|place| (curve.path.point(place) - at).norm() <= 1e-7)
    };
    let kept: Vec<usize> = (0..places.len())
        .filter(|&k| curves.iter().all(|curve| is_on(curve, places[k])))
        .collect();
    let candidates: Vec<Vec2> = kept.iter().map(|&k| places[k]).collect();
    let chosen = choose(&candidates).and_then(|k| kept.get(k).copied());
    let Some(index) = chosen else {
        let name = attribute_of(node, "name")?;
        return Ok(build.at_origin(name, "its curves do not cross"));
    };
    let rule = PointRule::CurveCrossing {
        curves: [curves[0].id, curves[1].id],
        index: u16::try_from(index).unwrap_or_default(),
    };
    Ok(build.add_point(attribute_of(node, "name")?, rule, places[index]))
}

fn of_arcs(build: &mut Build, node: Node<'_, '_>) -> Made {
    let arcs = [
        build.curve(node, "firstArc")?,
        build.curve(node, "secondArc")?,
    ];
    let centres = [0, 1].map(|k| circle_of(&arcs[k]).map(|(centre, _)| centre));
    let [Some(a), Some(b)] = centres else {
        return Err("its curves are no arcs".to_owned());
    };
    let second = is_second(node, "crossPoint");
    crossing_at(build, node, arcs, |places| {
        let is_left = |at: &Vec2| (b - a).perp(&(at - a)) > 0.0;
        let wanted = places.iter().position(|at| is_left(at) == second);
        wanted.or((!places.is_empty()).then_some(0))
    })
}

/// The crossing of two curves that is highest or lowest, and among these leftmost or rightmost.
fn of_curves(build: &mut Build, node: Node<'_, '_>) -> Made {
    let curves = [build.curve(node, "curve1")?, build.curve(node, "curve2")?];
    let lowest = is_second(node, "vCrossPoint");
    let rightmost = is_second(node, "hCrossPoint");
    crossing_at(build, node, curves, |places| {
        let key = |at: &Vec2| {
            let up = if lowest { at.y } else { -at.y };
            let across = if rightmost { -at.x } else { at.x };
            // Crossings of one height within 1 micrometre are told apart across.
            [(up * 1e6).round(), across]
        };
        let each = places.iter().enumerate();
        let best = each.min_by(|(_, a), (_, b)| {
            let (a, b) = (key(a), key(b));
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
        });
        best.map(|(k, _)| k)
    })
}

/// Centre and radius of an arc for the base size (m).
fn circle_of(curve: &CurveThing) -> Option<(Vec2, f64)> {
    let path = &curve.path;
    let total = path.length();
    let at = |share: f64| {
        let place = path.at_length(total * share)?;
        Some(path.point(place))
    };
    // Both ends of a full circle are in one place.
    let (a, b, c) = (at(0.0)?, at(1.0 / 3.0)?, at(2.0 / 3.0)?);
    let (p, q) = (b - a, c - a);
    let turn = 2.0 * p.perp(&q);
    if turn.abs() < 1e-15 {
        return None;
    }
    let (pp, qq) = (p.norm_squared(), q.norm_squared());
    let offset = Vec2::new(q.y * pp - p.y * qq, p.x * qq - q.x * pp) / turn;
    Some((a + offset, offset.norm()))
}

/// The place where a tangent from a point touches a circle.
fn tangent(from: Vec2, centre: Vec2, radius: f64, second: bool) -> Result<Vec2, String> {
    let distance = (from - centre).norm();
    let reach = distance * distance - radius * radius;
    if reach < 0.0 {
        return Err("its point lies within the circle".to_owned());
    }
    let found = of_two_distances([from, centre], [reach.sqrt(), radius])?;
    Ok(if second { found[0] } else { found[1] })
}

/// The point where a tangent from a point touches a circle, by two distances.
fn tangent_point(
    build: &mut Build,
    name: &str,
    [from, centre]: [PointThing; 2],
    radius: &Slot,
    (at, left): (Vec2, bool),
) -> Made {
    let way = format!("distance(?{}, ?{})", from.id.0, centre.id.0);
    let text = format!("sqrt({way} * {way} - {} * {})", radius.text, radius.text);
    let rule = PointRule::TwoDistances {
        centres: [from.id, centre.id],
        distances: [build.formula(&text)?, radius.number.clone()],
        left,
    };
    Ok(build.add_point(name, rule, at))
}

fn tangent_of_circle(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "cCenter")?;
    let radius = build.number(node, "cRadius", LENGTH)?;
    let from = build.point(node, "tangent")?;
    let left = is_second(node, "crossPoint");
    let at = match tangent(from.at, centre.at, radius.value, left) {
        Ok(at) => at,
        Err(why) => return Ok(build.at_origin(name(node), &why)),
    };
    tangent_point(build, name(node), [from, centre], &radius, (at, left))
}

fn tangent_of_arc(build: &mut Build, node: Node<'_, '_>) -> Made {
    let arc = build.curve(node, "arc")?;
    let from = build.point(node, "tangent")?;
    let (centre, radius) = circle_of(&arc).ok_or("its curve is no arc")?;
    let wanted = is_second(node, "crossPoint");
    let on_arc = |at: Vec2| {
        let place = arc.path.nearest(at);
        place.is_some_and(|place| (arc.path.point(place) - at).norm() <= 1e-6)
    };
    let both = [
        (tangent(from.at, centre, radius, wanted)?, wanted),
        (tangent(from.at, centre, radius, !wanted)?, !wanted),
    ];
    let found = both.into_iter().find(|(at, _)| on_arc(*at));
    let (at, left) = found.ok_or("the tangent touches the circle beside the arc")?;
    match build.circles.get(&arc.id).cloned() {
        Some((centre, radius)) => {
            let centre = build.on_this_sheet(centre);
            tangent_point(build, name(node), [from, centre], &radius, (at, left))
        }
        None => Ok(fixed(build, name(node), at)),
    }
}

/// Both ends of a dart drawn so that the line is straight where the dart is closed.
pub(super) fn true_darts(build: &mut Build, node: Node<'_, '_>) -> Result<(), String> {
    let line = line_ends(build, node, ["baseLineP1", "baseLineP2"])?;
    let legs = line_ends(build, node, ["dartP1", "dartP3"])?;
    let tip = build.point(node, "dartP2")?;
    let names = [attribute_of(node, "name1")?, attribute_of(node, "name2")?];
    let ids = [reference(node, "point1")?, reference(node, "point2")?];
    let ways = legs.map(|leg| leg.at - tip.at);
    let turn = ways[1].perp(&ways[0]).atan2(ways[1].dot(&ways[0]));
    let [first, second] = legs.map(|leg| format!("angle(?{}, ?{})", tip.id.0, leg.id.0));
    let turned = |at: Vec2, by: f64| {
        let (sin, cos) = by.sin_cos();
        let way = at - tip.at;
        tip.at + Vec2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos)
    };
    let polar = |build: &Build, of: PointThing, by: String| -> Result<PointRule, String> {
        let (o, p) = (tip.id.0, of.id.0);
        Ok(PointRule::Polar {
            base: tip.id,
            angle: build.formula(&format!("angle(?{o}, ?{p}) + {by}"))?,
            distance: build.formula(&format!("distance(?{o}, ?{p})"))?,
        })
    };
    let rule = polar(build, line[1], format!("{first} - {second}"))?;
    let closed = build.add_point(
        &format!("{} closed", names[0]),
        rule,
        turned(line[1].at, turn),
    );
    let made = super::points::cross(build, names[0], [line[0], closed], [tip, legs[0]])?;
    let rule = polar(build, made, format!("{second} - {first}"))?;
    let other = build.add_point(names[1], rule, turned(made.at, -turn));
    for ((id, name), point) in ids.into_iter().zip(names).zip([made, other]) {
        build.things.insert(id, Thing::Point(point));
        build.name_point(name.to_owned(), point);
        build.file_names.insert(point.id, name.to_owned());
    }
    Ok(())
}
