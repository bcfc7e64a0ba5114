//! The nodes of a piece, and the stretches of curves that its outline follows.

use super::build::{Build, reference};
use super::kinds::LENGTH;
use super::things::{CurveThing, PointThing, Thing};
use roxmltree::Node;
use std::collections::HashMap;
use std::sync::Arc;
use toile_geometry::{Curve as Piece, Path};
use toile_pattern::{CurveId, NotchKind, Number, PointId};

/// Places nearer to each other than this are one corner of an outline (m).
const SAME_CORNER: f64 = 2e-5;
/// A point within this distance of a curve cuts it where it is a neighbour in an outline (m).
const ON_CURVE: f64 = 1e-6;

/// A notch of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passmark {
    /// Shape of the notch.
    pub kind: NotchKind,
    /// Whether the shape in the file is another.
    pub is_other: bool,
}

/// A node of an outline.
enum PieceNode {
    Point {
        point: PointThing,
        before: Option<(Number, f64)>,
        after: Option<(Number, f64)>,
        passmark: Option<Passmark>,
    },
    Curve {
        curve: Arc<CurveThing>,
        reverse: bool,
    },
}

/// A stretch of an outline between two corners.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub curve: CurveId,
    pub ends: [PointThing; 2],
    /// Name of the curve of the file; empty for straight stretches.
    pub name: String,
    /// The course for the base size (m).
    pub path: Path,
    /// Allowance of its own, where nodes give one.
    pub allowance: Option<Number>,
    /// Whether the allowance changes along it.
    pub is_uneven: bool,
}

/// An outline, or a line inside a piece.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub stretches: Vec<Stretch>,
    /// Notches, each with the corner that it is at.
    pub passmarks: Vec<(PointId, Passmark)>,
    /// Nodes that were left out, with the reasons in words.
    pub lost: Vec<String>,
    /// Nodes that were taken otherwise, in words.
    pub told: Vec<String>,
    /// Number of nodes.
    pub count: usize,
}

/// A yes in any of the words of the files.
pub(super) fn is_yes(node: Node<'_, '_>, attribute: &str) -> bool {
    matches!(node.attribute(attribute), Some("1" | "true"))
}

/// Follows the nodes among the children of an element; `is_closed` joins the last to the first.
pub(super) fn outline(
    build: &mut Build,
    parent: Node<'_, '_>,
    modeling: &HashMap<u32, u32>,
    is_closed: bool,
) -> Outline {
    let mut outline = Outline::default();
    let mut nodes = Vec::new();
    for node in parent.children().filter(|node| node.has_tag_name("node")) {
        outline.count += 1;
        if is_yes(node, "excluded") {
            continue;
        }
        for attribute in ["before", "after"] {
            let width = node.attribute(attribute);
            if let Some(Err(why)) = width.map(|text| build.slot(text, LENGTH)) {
                outline
                    .told
                    .push(format!("the width {attribute} a node: {why}"));
            }
        }
        match piece_node(build, node, modeling) {
            Ok(node) => nodes.push(node),
            Err(why) => outline.lost.push(why),
        }
    }
    follow(build, &nodes, is_closed, &mut outline);
    outline
}

fn piece_node(
    build: &mut Build,
    node: Node<'_, '_>,
    modeling: &HashMap<u32, u32>,
) -> Result<PieceNode, String> {
    let id = reference(node, "idObject")?;
    let object = modeling.get(&id).copied().unwrap_or(id);
    let thing = build.things.get(&object).cloned();
    let gone = || format!("node {id}: its object {object} is not there or was left out");
    match thing.ok_or_else(gone)? {
        Thing::Curve(curve) => Ok(PieceNode::Curve {
            curve: build.curve_on_this_sheet(&curve)?,
            reverse: is_yes(node, "reverse"),
        }),
        Thing::Point(point) => {
            let point = build.on_this_sheet(point);
            let width = |attribute: &str| -> Option<(Number, f64)> {
                let text = node.attribute(attribute)?;
                let slot = build.slot(text, LENGTH).ok()?;
                // A negative width there means the width of the piece.
                (slot.value >= 0.0).then_some((slot.number, slot.value))
            };
            Ok(PieceNode::Point {
                point,
                before: width("before"),
                after: width("after"),
                passmark: passmark(node),
            })
        }
    }
}

fn passmark(node: Node<'_, '_>) -> Option<Passmark> {
    let is_one = ["passmark", "passMark", "notch"]
        .iter()
        .any(|attribute| is_yes(node, attribute));
    if !is_one {
        return None;
    }
    let shape = node
        .attribute("passmarkLine")
        .or(node.attribute("notchType"))
        .unwrap_or("one");
    let (kind, is_other) = match shape {
        "one" | "slit" => (NotchKind::Slit, false),
        "tMark" | "tNotch" => (NotchKind::T, false),
        "vMark" | "vMark2" | "vInternal" | "vExternal" => (NotchKind::V, false),
        "boxMark" | "castle" | "castleInternal" | "castleExternal" => (NotchKind::Castle, false),
        "checkMark" | "diamond" => (NotchKind::Check, shape == "diamond"),
        "uMark" => (NotchKind::V, true),
        _ => (NotchKind::Slit, true),
    };
    Some(Passmark { kind, is_other })
}

/// The point in which a neighbour of a curve meets it: the neighbour itself, or the nearer end of a curve.
fn neighbour(nodes: &[PieceNode], at: usize, step: isize, is_closed: bool) -> Option<PointThing> {
    let count = nodes.len() as isize;
    let next = at as isize + step;
    let next = if is_closed {
        next.rem_euclid(count)
    } else {
        next
    };
    match nodes.get(usize::try_from(next).ok()?)? {
        PieceNode::Point { point, .. } => Some(*point),
        PieceNode::Curve { curve, reverse } => {
            let is_end = (step < 0) != *reverse;
            Some(curve.ends[usize::from(is_end)])
        }
    }
}

/// A curve's stretch between the neighbours that lie on it, else between its own ends, in the direction of
/// the outline. No course: the curve ends where it is reached.
fn cut(
    curve: &CurveThing,
    reverse: bool,
    neighbours: [Option<PointThing>; 2],
) -> ([PointThing; 2], Option<Path>) {
    let total = curve.path.length();
    let on = |point: Option<PointThing>| {
        let point = point?;
        let place = curve.path.nearest(point.at)?;
        let distance = (curve.path.point(place) - point.at).norm();
        (distance <= ON_CURVE).then_some((point, place.along))
    };
    let own = match reverse {
        false => [(curve.ends[0], 0.0), (curve.ends[1], total)],
        true => [(curve.ends[1], total), (curve.ends[0], 0.0)],
    };
    let mut ends = [
        on(neighbours[0]).unwrap_or(own[0]),
        on(neighbours[1]).unwrap_or(own[1]),
    ];
    for (end, own) in ends.iter_mut().zip(own) {
        if (end.1 - own.1).abs() <= SAME_CORNER {
            *end = own;
        }
    }
    let runs_on = |ends: &[(PointThing, f64); 2]| match reverse {
        false => ends[1].1 - ends[0].1 > SAME_CORNER,
        true => ends[0].1 - ends[1].1 > SAME_CORNER,
    };
    if !runs_on(&ends) {
        // The next neighbour lies behind: the curve runs on to its own end, and the outline back from there.
        ends[1] = own[1];
    }
    if !runs_on(&ends) {
        return (ends.map(|end| end.0), None);
    }
    let (from, to) = (ends[0].1.min(ends[1].1), ends[0].1.max(ends[1].1));
    let path = curve.path.between(from, to);
    let path = if reverse { path.reversed() } else { path };
    (ends.map(|end| end.0), Some(path))
}

/// A corner that the outline has reached, with the width that begins there.
struct Reached {
    point: PointThing,
    after: Option<(Number, f64)>,
}

fn follow(build: &mut Build, nodes: &[PieceNode], is_closed: bool, outline: &mut Outline) {
    let mut reached: Option<Reached> = None;
    let mut first: Option<PointThing> = None;
    for (k, node) in nodes.iter().enumerate() {
        match node {
            PieceNode::Point {
                point,
                before,
                after,
                passmark,
            } => {
                let corner = go_to(build, outline, &mut reached, *point, before.clone());
                first.get_or_insert(corner);
                if let Some(reached) = &mut reached {
                    reached.after = after.clone().or(reached.after.take());
                }
                if let Some(passmark) = passmark {
                    outline.passmarks.push((corner.id, *passmark));
                }
            }
            PieceNode::Curve { curve, reverse } => {
                let neighbours = [-1, 1].map(|step| neighbour(nodes, k, step, is_closed));
                let (ends, path) = cut(curve, *reverse, neighbours);
                let start = go_to(build, outline, &mut reached, ends[0], None);
                first.get_or_insert(start);
                let Some(path) = path else {
                    let why = format!(
                        "curve {:?} runs against the outline: it goes straight, as there",
                        curve.name
                    );
                    outline.told.push(why);
                    go_to(build, outline, &mut reached, ends[1], None);
                    continue;
                };
                let after = reached.as_ref().and_then(|reached| reached.after.clone());
                let next = nodes.get(k + 1).or(nodes.first().filter(|_| is_closed));
                let before = match next {
                    Some(PieceNode::Point { before, .. }) => before.clone(),
                    Some(PieceNode::Curve { .. }) | None => None,
                };
                outline.stretches.push(Stretch {
                    curve: curve.id,
                    ends: [start, ends[1]],
                    name: curve.name.clone(),
                    path,
                    is_uneven: is_uneven(&after, &before),
                    allowance: after.or(before).map(|(number, _)| number),
                });
                reached = Some(Reached {
                    point: ends[1],
                    after: None,
                });
            }
        }
    }
    let (true, Some(first)) = (is_closed, first) else {
        return;
    };
    let before = nodes.first().and_then(|node| match node {
        PieceNode::Point { before, .. } => before.clone(),
        PieceNode::Curve { .. } => None,
    });
    let last = go_to(build, outline, &mut reached, first, before);
    if last.id != first.id {
        // Both ends are one place: the outline closes at its first corner.
        if let Some(stretch) = outline.stretches.last_mut() {
            stretch.ends[1] = first;
        }
        for (corner, _) in &mut outline.passmarks {
            if *corner == last.id {
                *corner = first.id;
            }
        }
    }
}

fn is_uneven(after: &Option<(Number, f64)>, before: &Option<(Number, f64)>) -> bool {
    match (after, before) {
        (Some((_, after)), Some((_, before))) => (after - before).abs() > 1e-6,
        _ => false,
    }
}

/// Goes straight to a point, unless it is reached already. Returns the corner that stands for it.
fn go_to(
    build: &mut Build,
    outline: &mut Outline,
    reached: &mut Option<Reached>,
    point: PointThing,
    before: Option<(Number, f64)>,
) -> PointThing {
    let Some(from) = reached.take() else {
        *reached = Some(Reached { point, after: None });
        return point;
    };
    let is_same = from.point.id == point.id || (from.point.at - point.at).norm() <= SAME_CORNER;
    if is_same {
        let corner = from.point;
        *reached = Some(from);
        return corner;
    }
    let ends = [from.point, point];
    let names = ends.map(|end| build.point_name(end));
    let curve = build.line_between(&format!("{} to {}", names[0], names[1]), ends);
    outline.stretches.push(Stretch {
        curve,
        ends,
        name: String::new(),
        path: Path::new(vec![Piece::Line {
            start: ends[0].at,
            end: ends[1].at,
        }]),
        is_uneven: is_uneven(&from.after, &before),
        allowance: from.after.or(before).map(|(number, _)| number),
    });
    *reached = Some(Reached { point, after: None });
    point
}
