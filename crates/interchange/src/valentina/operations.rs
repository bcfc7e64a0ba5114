//! Operations of a file: points and curves turned, moved and mirrored, each with a name of its own.

use super::build::{Build, Slot, reference};
use super::curves::moved;
use super::kinds::{LENGTH, Quantity};
use super::points::{direction, unit};
use super::things::{CurveThing, PointThing, Thing};
use roxmltree::Node;
use std::collections::HashMap;
use std::sync::Arc;
use toile_geometry::{Bounds2, Curve as Piece, Path, Vec2};
use toile_pattern::{CurveId, CurveRule, Number, PointId, PointRule};

/// Distance of the second point of a mirror line from the first (m).
const AXIS: f64 = 0.1;

/// A motion of points and curves.
pub(super) enum Motion {
    /// Turned round a point.
    Turned { centre: PointThing, angle: Slot },
    /// Moved in a direction.
    Moved { angle: Slot, distance: Slot },
    /// Moved, then turned.
    Both(Box<[Moving; 2]>),
    /// Mirrored in a line.
    Mirrored { line: [PointThing; 2] },
}

impl Motion {
    /// One motion, then the other.
    pub fn both(first: Self, second: Self) -> Self {
        let both = [first, second].map(|motion| Moving::new(motion, String::new()));
        Self::Both(Box::new(both))
    }
}

/// A motion, its suffix for names, and what it has moved so far.
pub(super) struct Moving {
    motion: Motion,
    suffix: String,
    points: HashMap<PointId, PointThing>,
    curves: HashMap<CurveId, Arc<CurveThing>>,
}

/// Does an operation. `None`: the tool is none of these.
pub(super) fn operation(
    build: &mut Build,
    node: Node<'_, '_>,
    tool: &str,
) -> Option<Result<(), String>> {
    let motion = match tool {
        "rotation" => turned(build, node),
        "moving" => shifted(build, node),
        "flippingByLine" => by_line(build, node),
        "flippingByAxis" => by_axis(build, node),
        _ => return None,
    };
    Some(motion.and_then(|motion| carry_out(build, node, motion)))
}

fn turned(build: &mut Build, node: Node<'_, '_>) -> Result<Motion, String> {
    Ok(Motion::Turned {
        centre: build.point(node, "center")?,
        angle: build.number(node, "angle", Quantity::Angle)?,
    })
}

fn shifted(build: &mut Build, node: Node<'_, '_>) -> Result<Motion, String> {
    let moved = Motion::Moved {
        angle: build.number(node, "angle", Quantity::Angle)?,
        distance: build.number(node, "length", LENGTH)?,
    };
    if node.attribute("rotationAngle").is_none() {
        return Ok(moved);
    }
    let angle = build.number(node, "rotationAngle", Quantity::Angle)?;
    if angle.number == Number::ZERO {
        return Ok(moved);
    }
    let centre = match reference(node, "center") {
        Ok(number) if number > 0 => build.point(node, "center")?,
        Ok(_) | Err(_) => middle(build, node, &moved)?,
    };
    Ok(Motion::both(moved, Motion::Turned { centre, angle }))
}

/// The middle of what an operation moves, after that; it is kept as the base size has it.
fn middle(build: &mut Build, node: Node<'_, '_>, motion: &Motion) -> Result<PointThing, String> {
    let mut places = Vec::new();
    for item in items(node, "source") {
        match build.things.get(&reference(item, "idObject")?) {
            Some(Thing::Point(point)) => places.push(point.at),
            Some(Thing::Curve(curve)) => places.extend(curve.path.flatten(1e-4)),
            None => {}
        }
    }
    let places = places.into_iter().map(|at| place(motion, at));
    let bounds = Bounds2::of(places);
    let at = (bounds.min + bounds.max) / 2.0;
    if !(at.x.is_finite() && at.y.is_finite()) {
        return Err("none of its parts is there".to_owned());
    }
    let name = format!("middle{}", node.attribute("suffix").unwrap_or_default());
    Ok(super::contacts::fixed(build, &name, at))
}

fn by_line(build: &mut Build, node: Node<'_, '_>) -> Result<Motion, String> {
    let line = [build.point(node, "p1Line")?, build.point(node, "p2Line")?];
    unit(line[1].at - line[0].at)?;
    Ok(Motion::Mirrored { line })
}

fn by_axis(build: &mut Build, node: Node<'_, '_>) -> Result<Motion, String> {
    let centre = build.point(node, "center")?;
    let way = match node.attribute("axisType") {
        Some("1") => Vec2::new(0.0, AXIS),
        Some("2") => Vec2::new(AXIS, 0.0),
        other => return Err(format!("its axisType is {other:?}, neither 1 nor 2")),
    };
    let rule = PointRule::Offset {
        base: centre.id,
        x: way.x.into(),
        y: way.y.into(),
    };
    let name = format!("{} axis", build.point_name(centre));
    let tip = build.add_point(&name, rule, centre.at + way);
    Ok(Motion::Mirrored {
        line: [centre, tip],
    })
}

/// The items of a list of an operation, each with its number.
fn items<'a, 'i>(node: Node<'a, 'i>, list: &str) -> Vec<Node<'a, 'i>> {
    let lists = node.children().filter(|child| child.has_tag_name(list));
    let all = lists.flat_map(|list| list.children());
    all.filter(|item| item.has_tag_name("item")).collect()
}

fn carry_out(build: &mut Build, node: Node<'_, '_>, motion: Motion) -> Result<(), String> {
    let suffix = node.attribute("suffix").unwrap_or_default().to_owned();
    let mut moving = Moving::new(motion, suffix);
    let sources = items(node, "source");
    let destinations = items(node, "destination");
    if sources.len() != destinations.len() {
        return Err("its lists of sources and results differ in length".to_owned());
    }
    let mut faults = Vec::new();
    for (from, to) in sources.into_iter().zip(destinations) {
        let names = ["name", "alias"].map(|attribute| from.attribute(attribute));
        let names = names.into_iter().flatten().filter(|name| !name.is_empty());
        let names: Vec<&str> = names.collect();
        let numbers =
            reference(from, "idObject").and_then(|from| Ok((from, reference(to, "idObject")?)));
        if let Err(why) = numbers.and_then(|(from, to)| carry(build, &mut moving, from, to, &names))
        {
            faults.push(why);
        }
    }
    match faults.first() {
        None => Ok(()),
        Some(first) => Err(format!("{} of its parts: {first}", faults.len())),
    }
}

/// Moves the part of a number, and gives its image another number and further names.
pub(super) fn carry(
    build: &mut Build,
    moving: &mut Moving,
    from: u32,
    to: u32,
    names: &[&str],
) -> Result<(), String> {
    let thing = build.things.get(&from).cloned();
    let thing = thing.ok_or_else(|| format!("part {from} is not there or was left out"))?;
    let made = match thing {
        Thing::Point(point) => {
            let point = build.on_this_sheet(point);
            let made = moving.point(build, point)?;
            let name = format!("{}{}", build.file_name(point), moving.suffix);
            build.name_point(name, made);
            for name in names {
                build.name_point((*name).to_owned(), made);
            }
            Thing::Point(made)
        }
        Thing::Curve(curve) => {
            let curve = build.curve_on_this_sheet(&curve)?;
            let made = moving.curve(build, &curve, to)?;
            for name in names {
                build.name_also(&made.name, name);
            }
            Thing::Curve(made)
        }
    };
    build.things.insert(to, made);
    Ok(())
}

/// The image of a place for the base size (m).
fn place(motion: &Motion, at: Vec2) -> Vec2 {
    match motion {
        Motion::Turned { centre, angle } => {
            let (sin, cos) = angle.value.sin_cos();
            let way = at - centre.at;
            centre.at + Vec2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos)
        }
        Motion::Moved { angle, distance } => at + direction(angle.value) * distance.value,
        Motion::Both(both) => {
            let moved = both.iter();
            moved.fold(at, |at, moving| place(&moving.motion, at))
        }
        Motion::Mirrored { line } => {
            let way = (line[1].at - line[0].at).normalize();
            let offset = at - line[0].at;
            line[0].at + way * (2.0 * offset.dot(&way)) - offset
        }
    }
}

/// The image of a curve for the base size.
fn image(motion: &Motion, piece: Piece) -> Piece {
    match motion {
        Motion::Turned { centre, angle } => piece
            .translated(-centre.at)
            .rotated(angle.value)
            .translated(centre.at),
        Motion::Moved { angle, distance } => {
            piece.translated(direction(angle.value) * distance.value)
        }
        Motion::Both(both) => {
            let moved = both.iter();
            moved.fold(piece, |piece, moving| image(&moving.motion, piece))
        }
        Motion::Mirrored { line } => piece.reflected(line[0].at, line[1].at - line[0].at),
    }
}

impl Moving {
    pub fn new(motion: Motion, suffix: String) -> Self {
        Self {
            motion,
            suffix,
            points: HashMap::new(),
            curves: HashMap::new(),
        }
    }

    fn rule(&mut self, build: &mut Build, point: PointThing) -> Result<PointRule, String> {
        if let Motion::Both(both) = &mut self.motion {
            let [first, second] = &mut **both;
            let moved = first.point(build, point)?;
            return second.rule(build, moved);
        }
        Ok(match &self.motion {
            Motion::Both(_) => return Err("it moves twice".to_owned()),
            Motion::Turned { centre, .. } if (point.at - centre.at).norm() <= 1e-9 => {
                PointRule::Offset {
                    base: point.id,
                    x: 0.0.into(),
                    y: 0.0.into(),
                }
            }
            Motion::Turned { centre, angle } => {
                let (o, p) = (centre.id.0, point.id.0);
                PointRule::Polar {
                    base: centre.id,
                    angle: build.formula(&format!("angle(?{o}, ?{p}) + {}", angle.text))?,
                    distance: build.formula(&format!("distance(?{o}, ?{p})"))?,
                }
            }
            Motion::Moved { angle, distance } => PointRule::Polar {
                base: point.id,
                angle: angle.number.clone(),
                distance: distance.number.clone(),
            },
            Motion::Mirrored { line } => PointRule::Mirrored {
                base: point.id,
                line: line.map(|end| end.id),
            },
        })
    }

    fn point(&mut self, build: &mut Build, point: PointThing) -> Result<PointThing, String> {
        if let Some(known) = self.points.get(&point.id) {
            return Ok(*known);
        }
        let rule = self.rule(build, point)?;
        let name = format!("{}{}", build.file_name(point), self.suffix);
        let made = build.add_point(&name, rule, place(&self.motion, point.at));
        build.file_names.insert(made.id, name);
        self.points.insert(point.id, made);
        Ok(made)
    }

    /// The image of a whole curve of the document.
    fn whole(&mut self, build: &mut Build, of: &CurveThing) -> Result<Arc<CurveThing>, String> {
        if let Some(known) = self.curves.get(&of.id) {
            return Ok(known.clone());
        }
        let whole = build.wholes.get(&of.id).cloned();
        let whole = whole.ok_or("its curve is not there")?;
        let ends = [
            self.point(build, whole.ends[0])?,
            self.point(build, whole.ends[1])?,
        ];
        if let (Motion::Mirrored { .. }, Some(bulge)) = (&self.motion, build.bulge_of(of.id)) {
            // A mirrored arc runs counter-clockwise again: from the image of its end.
            let pieces: Vec<Piece> = moved(&whole, |piece| image(&self.motion, piece));
            let pieces = Path::new(pieces).reversed().curves().to_vec();
            let name = self.name_of(build, &whole, ends);
            let rule = CurveRule::Arc { bulge };
            let made = build.add_curve(&name, [ends[1], ends[0]], rule, pieces);
            self.curves.insert(of.id, made.clone());
            return Ok(made);
        }
        let rule = match &self.motion {
            Motion::Mirrored { line } => CurveRule::Mirrored {
                of: of.id,
                line: line.map(|end| end.id),
            },
            Motion::Turned { .. } | Motion::Moved { .. } | Motion::Both(_) => {
                if (ends[1].at - ends[0].at).norm() <= 1e-9 {
                    return Err(format!("{} begins where it ends", of.name));
                }
                CurveRule::Copy { of: of.id }
            }
        };
        let pieces = moved(&whole, |piece| image(&self.motion, piece));
        let name = self.name_of(build, &whole, ends);
        let made = build.add_curve(&name, ends, rule, pieces);
        self.curves.insert(of.id, made.clone());
        Ok(made)
    }

    fn name_of(&self, build: &Build, curve: &CurveThing, ends: [PointThing; 2]) -> String {
        let kind = curve.name.split('_').next().unwrap_or("Spl");
        match kind {
            "Arc" => format!("{}{}", curve.name, self.suffix),
            kind => {
                let [a, b] = ends.map(|end| build.file_name(end));
                format!("{kind}_{a}_{b}")
            }
        }
    }

    /// Names in formulas of the image of a curve, in newer and older files.
    fn names_of(
        &self,
        build: &Build,
        made: &CurveThing,
        of: &CurveThing,
        number: u32,
    ) -> Vec<String> {
        let mut names = vec![made.name.clone(), format!("{}{}", of.name, self.suffix)];
        // An image of an image has its name from each name that the first image has.
        let all = build.names_of_length(&of.length);
        names.extend(all.map(|name| format!("{name}{}", self.suffix)));
        if let Some((start, _)) = of
            .name
            .rsplit_once('_')
            .filter(|_| of.name.contains("Arc_"))
        {
            names.push(format!("{start}_{number}"));
        }
        names
    }

    /// The image of a curve under a number.
    fn curve(
        &mut self,
        build: &mut Build,
        curve: &CurveThing,
        number: u32,
    ) -> Result<Arc<CurveThing>, String> {
        let whole = self.whole(build, curve)?;
        let made = match curve.is_whole {
            true => whole,
            false => {
                let ends = [
                    self.point(build, curve.ends[0])?,
                    self.point(build, curve.ends[1])?,
                ];
                Arc::new(CurveThing {
                    id: whole.id,
                    name: self.name_of(build, curve, ends),
                    path: Path::new(moved(curve, |piece| image(&self.motion, piece))),
                    ends,
                    ..curve.clone()
                })
            }
        };
        let text = made.length.clone();
        for name in self.names_of(build, &made, curve, number) {
            build.name_length(name, &text, made.path.length());
        }
        Ok(made)
    }
}
