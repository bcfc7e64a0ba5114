//! Pieces that were joined along an edge each: the second is moved and turned onto the edge of the first, and
//! the united piece refers to the images of the nodes of both by numbers of their own.

use super::build::{Build, Slot, reference};
use super::operations::{Motion, Moving, carry};
use super::pieces::child;
use super::things::{PointThing, Thing};
use crate::exchange::Loss;
use crate::xml::Xml;
use roxmltree::Node;
use std::collections::HashMap;

/// Places nearer to each other than this need no motion (m).
const SAME_PLACE: f64 = 1e-9;

/// A node of a piece that was joined: the object of the drawing, and whether it is a point.
#[derive(Clone, Copy)]
struct JoinedNode {
    object: u32,
    is_point: bool,
}

/// Moves what joined pieces of a drawing need.
pub(super) fn read(
    build: &mut Build,
    xml: &Xml<'_>,
    drawing: Node<'_, '_>,
    modeling: &HashMap<u32, u32>,
) {
    let lists = drawing
        .children()
        .filter(|node| node.has_tag_name("modeling"));
    let tools = lists.flat_map(|list| list.children());
    for tool in tools.filter(|node| node.has_tag_name("tools")) {
        if let Err(why) = join(build, tool, modeling) {
            let place = format!("line {}", xml.line(tool));
            build.losses.push(Loss::at(place, "joined pieces", why));
        }
    }
}

fn join(build: &mut Build, tool: Node<'_, '_>, modeling: &HashMap<u32, u32>) -> Result<(), String> {
    let images = images(tool)?;
    if images.is_empty() {
        // Nothing of the file can refer to it.
        return Ok(());
    }
    let mut pieces = tool.children().filter(|node| node.has_tag_name("det"));
    let mut next = |index: &str| -> Result<Sewn, String> {
        let nodes = nodes(
            pieces.next().ok_or("it joins fewer than two pieces")?,
            modeling,
        )?;
        Sewn::new(nodes, reference(tool, index)? as usize)
    };
    let (first, second) = (next("indexD1")?, next("indexD2")?);
    let [to, along] = first.ends(build)?;
    let [back, from] = second.ends(build)?;
    let mut moving = Moving::new(motion(build, [from, back], [to, along])?, String::new());
    let moved = second.after_edge();
    let count = first.nodes.len() + moved.len();
    // Older files keep the nodes of the first piece, and leave out the node that meets the end of its edge.
    let kept = match images.len() {
        all if all == count => {
            let (before, after) = first.nodes.split_at(first.start + 1);
            let still = before.iter().map(|node| (node, false));
            let moved = moved.iter().map(|node| (node, true));
            let all = still
                .chain(moved)
                .chain(after.iter().map(|node| (node, false)));
            all.collect::<Vec<_>>()
        }
        some if some == moved.len() || some + 1 == moved.len() => {
            let moved = moved.iter().take(some);
            moved.map(|node| (node, true)).collect()
        }
        other => return Err(format!("it has {other} images of {count} nodes")),
    };
    for ((node, is_moved), image) in kept.into_iter().zip(images) {
        if is_moved {
            carry(build, &mut moving, node.object, image, &[])?;
        } else if let Some(thing) = build.things.get(&node.object).cloned() {
            build.things.insert(image, thing);
        }
    }
    Ok(())
}

/// Numbers of the images of nodes, in the order of the united outline.
fn images(tool: Node<'_, '_>) -> Result<Vec<u32>, String> {
    let Some(children) = child(tool, "children") else {
        return Ok(Vec::new());
    };
    let children = child(children, "nodes").unwrap_or(children);
    let texts = children
        .children()
        .filter(|node| node.has_tag_name("child"));
    let number = |node: Node<'_, '_>| {
        let text = node.text().unwrap_or_default().trim();
        text.parse()
            .map_err(|_| format!("its child {text:?} is no number of a part"))
    };
    texts.map(number).collect()
}

fn nodes(piece: Node<'_, '_>, modeling: &HashMap<u32, u32>) -> Result<Vec<JoinedNode>, String> {
    let nodes = child(piece, "nodes").unwrap_or(piece).children();
    let read = |node: Node<'_, '_>| {
        let id = reference(node, "idObject")?;
        Ok(JoinedNode {
            object: modeling.get(&id).copied().unwrap_or(id),
            is_point: node.attribute("type") == Some("NodePoint"),
        })
    };
    nodes
        .filter(|node| node.has_tag_name("node"))
        .map(read)
        .collect()
}

/// The nodes of a piece without the curves along the edge by which it is joined.
struct Sewn {
    nodes: Vec<JoinedNode>,
    /// Indices of the points at the start and the end of the edge.
    start: usize,
    end: usize,
}

impl Sewn {
    fn new(nodes: Vec<JoinedNode>, edge: usize) -> Result<Self, String> {
        let points: Vec<usize> = (0..nodes.len()).filter(|&k| nodes[k].is_point).collect();
        let (Some(&start), true) = (points.get(edge), points.len() > 1) else {
            return Err(format!(
                "a piece of {} points has no edge {edge}",
                points.len()
            ));
        };
        let end = points[(edge + 1) % points.len()];
        let is_along = |k: usize| match start < end {
            true => start < k && k < end,
            false => k > start || k < end,
        };
        let before = |index: usize| (0..index).filter(|&k| !is_along(k)).count();
        let (start, end) = (before(start), before(end));
        let kept = nodes.iter().enumerate().filter(|(k, _)| !is_along(*k));
        let nodes = kept.map(|(_, node)| *node).collect();
        Ok(Self { nodes, start, end })
    }

    fn ends(&self, build: &mut Build) -> Result<[PointThing; 2], String> {
        let mut point = |k: usize| match build.things.get(&self.nodes[k].object) {
            Some(Thing::Point(point)) => Ok(build.on_this_sheet(*point)),
            Some(Thing::Curve(_)) | None => {
                Err("an end of the joined edge is not there".to_owned())
            }
        };
        Ok([point(self.start)?, point(self.end)?])
    }

    /// The nodes after the end of the edge, round to its start.
    fn after_edge(&self) -> Vec<JoinedNode> {
        let count = self.nodes.len();
        let after = (1..count).map(|k| self.nodes[(self.end + k) % count]);
        after.collect()
    }
}

/// The motion that takes the first place to the second one's start, and turns what begins there onto it.
fn motion(
    build: &Build,
    [from, back]: [PointThing; 2],
    [to, along]: [PointThing; 2],
) -> Result<Motion, String> {
    let direction = |a: PointThing, b: PointThing| {
        let way = b.at - a.at;
        let text = format!("angle(?{}, ?{})", a.id.0, b.id.0);
        (text, way.y.atan2(way.x))
    };
    let slot = |text: String, value: f64| -> Result<Slot, String> {
        Ok(Slot {
            number: build.formula(&text)?,
            text: format!("({text})"),
            value,
        })
    };
    let (wanted, own) = (direction(to, along), direction(from, back));
    let angle = slot(format!("{} - {}", wanted.0, own.0), wanted.1 - own.1)?;
    let turned = Motion::Turned { centre: to, angle };
    let distance = (to.at - from.at).norm();
    if distance <= SAME_PLACE {
        return Ok(turned);
    }
    let (text, value) = direction(from, to);
    let moved = Motion::Moved {
        angle: slot(text, value)?,
        distance: slot(format!("distance(?{}, ?{})", from.id.0, to.id.0), distance)?,
    };
    Ok(Motion::both(moved, turned))
}
