//! Pieces of a file as panels.

use super::build::{Build, plain, reference};
use super::kinds::{LENGTH, Quantity};
use super::loops::leave_out_loops;
use super::nodes::{Outline, Stretch, is_yes, outline};
use super::things::{PointThing, Thing};
use crate::exchange::Loss;
use crate::part_names::part_name;
use crate::xml::Xml;
use roxmltree::Node;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{
    Edge, EdgeCorner, EdgeId, FabricId, Line, LineId, LineKind, LineName, Mark, Name, Notch,
    NotchId, Operation, OperationId, OperationKind, Panel, PanelId, PointId,
};

/// Lengths that differ by less than this part are equal: a stretch from corner to corner is then straight.
const STRAIGHT: f64 = 1e-4;
/// Largest number of steps from the number of a node to the object of the drawing.
const MAX_STEPS: usize = 8;

/// Reads the pieces of a drawing as panels traced from the sheet that is built.
pub(super) fn read(
    build: &mut Build,
    xml: &Xml<'_>,
    drawing: Node<'_, '_>,
    (modeling, fabric): (&HashMap<u32, u32>, FabricId),
    taken: &mut BTreeSet<String>,
) {
    let lists = drawing
        .children()
        .filter(|node| node.has_tag_name("details") || node.has_tag_name("pieces"));
    for node in lists
        .flat_map(|list| list.children())
        .filter(Node::is_element)
    {
        let name = node.attribute("name").unwrap_or("piece");
        let place = format!("line {}, piece {name:?}", xml.line(node));
        if let Err(why) = piece(build, node, (modeling, fabric), taken, &place) {
            build.left_out(place, "the piece".to_owned(), why);
        }
    }
}

/// Objects of the drawings by the numbers under which pieces know them, also through another such number.
pub(super) fn modeling(root: Node<'_, '_>) -> HashMap<u32, u32> {
    let drawings = root.children();
    let lists = drawings
        .flat_map(|drawing| drawing.children())
        .filter(|node| node.has_tag_name("modeling"));
    let all = lists.flat_map(|list| list.children());
    let pair = |node: Node<'_, '_>| {
        Some((
            reference(node, "id").ok()?,
            reference(node, "idObject").ok()?,
        ))
    };
    let direct: HashMap<u32, u32> = all.filter(Node::is_element).filter_map(pair).collect();
    let followed = |object: u32| {
        let steps = std::iter::successors(Some(object), |at| direct.get(at).copied());
        steps.take(MAX_STEPS).last().unwrap_or(object)
    };
    direct
        .iter()
        .map(|(&id, &object)| (id, followed(object)))
        .collect()
}

/// The first child of an element with a tag.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(tag))
}

fn piece(
    build: &mut Build,
    node: Node<'_, '_>,
    (modeling, fabric): (&HashMap<u32, u32>, FabricId),
    taken: &mut BTreeSet<String>,
    place: &str,
) -> Result<(), String> {
    let sheet = build.sheets.last().map(|own| own.sheet.id);
    let sheet = sheet.ok_or("it belongs to no drawing")?;
    let list = child(node, "nodes").unwrap_or(node);
    name_width(build, node);
    let mut found = outline(build, list, modeling, true);
    build.symbols.remove(OWN_WIDTH);
    if !has_allowance(node) {
        for stretch in &mut found.stretches {
            stretch.allowance = None;
            stretch.is_uneven = false;
        }
    }
    for why in std::mem::take(&mut found.lost) {
        build.left_out(place.to_owned(), "a node".to_owned(), why);
    }
    for why in std::mem::take(&mut found.told) {
        build.left_out(place.to_owned(), "a stretch of the outline".to_owned(), why);
    }
    if found.stretches.len() < 2 {
        return Err(format!("its {} nodes make no closed outline", found.count));
    }
    let loops = leave_out_loops(build, &mut found);
    if loops > 0 {
        build.losses.push(Loss {
            what: "loops of the outline".to_owned(),
            place: place.to_owned(),
            count: loops,
            why: "it crosses or touches itself there in the base size, and goes on from there"
                .to_owned(),
        });
    }
    turn(&mut found);
    let name = part_name(node.attribute("name").unwrap_or("piece"), taken);
    let mut panel = Panel::new(build.pattern.ids.take::<PanelId>(), name, sheet, fabric);
    allowance(build, node, &mut panel, place);
    cut_of(build, node, &mut panel);
    grain(build, node, modeling, &mut panel);
    let move_to = |attribute: &str| plain(build, node, attribute).unwrap_or_default();
    let (x, y) = (move_to("mx"), move_to("my"));
    if x != 0.0 || y != 0.0 {
        panel.on_table = Some([build.unit.si(x, LENGTH), -build.unit.si(y, LENGTH)]);
    }
    let mut names = BTreeSet::new();
    let line = line_of(
        build,
        "outline",
        LineKind::Outline,
        &found.stretches,
        &mut names,
    );
    let line_id = line.id;
    panel.lines.push(line);
    notches(build, &found, &mut panel, line_id, place);
    let uneven = found.stretches.iter().filter(|one| one.is_uneven).count();
    if uneven > 0 {
        build.losses.push(Loss {
            what: "allowances that widen along an edge".to_owned(),
            place: place.to_owned(),
            count: uneven,
            why: "the width at the start of each edge is taken".to_owned(),
        });
    }
    internal_lines(build, node, modeling, &mut panel, &mut names, place);
    if let Err(why) = fold(build, node, modeling, &found, &mut panel) {
        build.left_out(place.to_owned(), "the mirror line".to_owned(), why);
    }
    others(build, node, place);
    if child(node, "csa").is_some_and(|csa| csa.children().any(|one| one.is_element())) {
        let why = "allowances belong to edges here".to_owned();
        build.left_out(place.to_owned(), "the drawn allowance".to_owned(), why);
    }
    build.pattern.panels.push(Arc::new(panel));
    Ok(())
}

/// Turns an outline counter-clockwise.
fn turn(outline: &mut Outline) {
    let places: Vec<Vec2> = outline
        .stretches
        .iter()
        .flat_map(|one| one.path.flatten(1e-4))
        .collect();
    let next = places.iter().cycle().skip(1);
    let twice: f64 = places.iter().zip(next).map(|(a, b)| a.perp(b)).sum();
    if twice < 0.0 {
        outline.stretches.reverse();
        for stretch in &mut outline.stretches {
            stretch.ends.reverse();
            stretch.path = stretch.path.reversed();
        }
    }
}

/// Says which lists of a piece have no counterpart.
fn others(build: &mut Build, node: Node<'_, '_>, place: &str) {
    for (list, what) in [
        ("placeLabels", "place labels"),
        ("offsetLines", "offset lines"),
        ("pins", "pins"),
        ("anchors", "anchors"),
    ] {
        let count =
            child(node, list).map_or(0, |list| list.children().filter(Node::is_element).count());
        if count > 0 {
            build.losses.push(Loss {
                what: what.to_owned(),
                place: place.to_owned(),
                count,
                why: "pieces here have none".to_owned(),
            });
        }
    }
}

fn line_of(
    build: &mut Build,
    name: &str,
    kind: LineKind,
    stretches: &[Stretch],
    names: &mut BTreeSet<String>,
) -> Line {
    let id: LineId = build.pattern.ids.take();
    let mut edges = Vec::with_capacity(stretches.len());
    for stretch in stretches {
        let own = match stretch.name.is_empty() {
            false => stretch.name.clone(),
            true => {
                let ends = stretch.ends.map(|end| build.point_name(end));
                format!("{} to {}", ends[0], ends[1])
            }
        };
        edges.push(Edge {
            id: build.pattern.ids.take::<EdgeId>(),
            name: part_name(&own, names),
            curve: stretch.curve,
            ends: stretch.ends.map(|end| end.id),
            allowance: stretch.allowance.clone(),
            corner: EdgeCorner::default(),
        });
    }
    Line {
        id,
        name: name.to_owned(),
        kind,
        by: None,
        edges,
    }
}

/// Whether a piece has a seam allowance outside its outline.
fn has_allowance(node: Node<'_, '_>) -> bool {
    let is_one = is_yes(node, "seamAllowance") || is_yes(node, "supplement");
    is_one && !is_yes(node, "seamAllowanceBuiltIn")
}

/// Name of the allowance of a piece in the formulas of its nodes.
const OWN_WIDTH: &str = "CurrentSeamAllowance";

/// Names the allowance of a piece for the formulas of its nodes.
fn name_width(build: &mut Build, node: Node<'_, '_>) {
    let width = node.attribute("width");
    if let Some(Ok(slot)) = width.map(|text| build.slot(text, LENGTH)) {
        build.name_length(OWN_WIDTH.to_owned(), &slot.text, slot.value);
    }
}

fn allowance(build: &mut Build, node: Node<'_, '_>, panel: &mut Panel, place: &str) {
    let text = node.attribute("width").filter(|_| has_allowance(node));
    let Some(text) = text else {
        return;
    };
    match build.slot(text, LENGTH) {
        Ok(slot) => panel.allowance = slot.number,
        Err(why) => build.left_out(place.to_owned(), "the seam allowance".to_owned(), why),
    }
}

/// Number of copies: of the piece itself, or of the layers of cloth that it is cut from.
fn cut_of(build: &Build, node: Node<'_, '_>, panel: &mut Panel) {
    let Some(data) = child(node, "data") else {
        return;
    };
    let own = plain(build, data, "quantity");
    let layers = data.children().filter(|one| one.has_tag_name("mcp"));
    let layers: f64 = layers
        .filter_map(|one| plain(build, one, "cutNumber"))
        .sum();
    let count = own.or((layers > 0.0).then_some(layers));
    if let Some(count) = count.filter(|count| (1.0..=1000.0).contains(count)) {
        panel.cut.quantity = count.round() as u32;
    }
}

fn named_point(
    build: &Build,
    node: Node<'_, '_>,
    attribute: &str,
    modeling: &HashMap<u32, u32>,
) -> Option<PointThing> {
    let id = reference(node, attribute).ok()?;
    let object = modeling.get(&id).copied().unwrap_or(id);
    match build.things.get(&object)? {
        Thing::Point(point) => Some(*point),
        Thing::Curve(_) => None,
    }
}

fn grain(build: &Build, node: Node<'_, '_>, modeling: &HashMap<u32, u32>, panel: &mut Panel) {
    let line = child(node, "grainline").filter(|line| is_yes(*line, "visible"));
    let Some(line) = line else {
        return;
    };
    let pins = ["bottomPin", "topPin"].map(|pin| named_point(build, line, pin, modeling));
    if let [Some(bottom), Some(top)] = pins {
        let text = format!("angle(?{}, ?{})", bottom.id.0, top.id.0);
        if let Ok(number) = build.formula(&text) {
            panel.grain = number;
            return;
        }
    }
    if let Ok(slot) = build.number(line, "rotation", Quantity::Angle) {
        panel.grain = slot.number;
    }
}

fn notches(build: &mut Build, outline: &Outline, panel: &mut Panel, line: LineId, place: &str) {
    let mut names = BTreeSet::new();
    let mut others = 0;
    for (corner, passmark) in &outline.passmarks {
        others += usize::from(passmark.is_other);
        let name = build.point_names.get(corner).cloned().unwrap_or_default();
        panel.notches.push(Notch {
            id: build.pattern.ids.take::<NotchId>(),
            name: part_name(&name, &mut names),
            line,
            at: Mark::corner(*corner),
            kind: passmark.kind,
        });
    }
    if others > 0 {
        build.losses.push(Loss {
            what: "shapes of passmarks".to_owned(),
            place: place.to_owned(),
            count: others,
            why: "a notch of another shape stands there".to_owned(),
        });
    }
}

/// Paths inside the piece as internal lines.
fn internal_lines(
    build: &mut Build,
    node: Node<'_, '_>,
    modeling: &HashMap<u32, u32>,
    panel: &mut Panel,
    names: &mut BTreeSet<String>,
    place: &str,
) {
    let Some(list) = child(node, "iPaths") else {
        return;
    };
    let drawing = node.parent().and_then(|list| list.parent());
    let paths = drawing.and_then(|drawing| child(drawing, "modeling"));
    for record in list.children().filter(Node::is_element) {
        let wanted = record.attribute("path");
        let all = paths.into_iter().flat_map(|paths| paths.children());
        let mut all = all.filter(|path| path.has_tag_name("path"));
        let path = all.find(|path| wanted.is_some() && path.attribute("id") == wanted);
        let nodes = path.and_then(|path| child(path, "nodes"));
        let found = nodes.map(|nodes| outline(build, nodes, modeling, false));
        match found {
            Some(found) if found.lost.is_empty() && !found.stretches.is_empty() => {
                let name = path.and_then(|path| path.attribute("name"));
                let name = part_name(name.unwrap_or("path"), names);
                let line = line_of(build, &name, LineKind::Internal, &found.stretches, names);
                panel.lines.push(line);
            }
            Some(_) | None => {
                let why = "it follows parts that are not there".to_owned();
                build.left_out(place.to_owned(), "an internal path".to_owned(), why);
            }
        }
    }
}

/// The mirror line as a fold, if it is a straight stretch of the outline.
fn fold(
    build: &mut Build,
    node: Node<'_, '_>,
    modeling: &HashMap<u32, u32>,
    outline: &Outline,
    panel: &mut Panel,
) -> Result<(), String> {
    let Some(line) = child(node, "mirrorLine") else {
        return Ok(());
    };
    if !line.has_attribute("p1") {
        return Ok(());
    }
    let points = ["p1", "p2"].map(|end| named_point(build, line, end, modeling));
    let [Some(a), Some(b)] = points else {
        return Err("its points are not there or were left out".to_owned());
    };
    let ends = [straight(outline, [a, b]), straight(outline, [b, a])];
    let ends = ends.into_iter().flatten().next();
    let ends = ends.ok_or("it is no straight stretch of the outline")?;
    let line = panel.lines.first().map(|line| line.id);
    panel.operations.push(Arc::new(Operation {
        id: build.pattern.ids.take::<OperationId>(),
        name: "fold".to_owned(),
        kind: OperationKind::Fold {
            line: line.map_or_else(LineName::default, Name::Drawn),
            ends: ends.map(Mark::corner),
        },
        meant: false,
    }));
    Ok(())
}

/// The corners at two places, if the outline runs straight from the first to the second.
fn straight(outline: &Outline, [from, to]: [PointThing; 2]) -> Option<[PointId; 2]> {
    let near = |a: Vec2, b: Vec2| (a - b).norm() <= 1e-6;
    let count = outline.stretches.len();
    let starts = |one: &Stretch| near(one.ends[0].at, from.at);
    let first = outline.stretches.iter().position(starts)?;
    let mut length = 0.0;
    for k in 0..count {
        let stretch = &outline.stretches[(first + k) % count];
        length += stretch.path.length();
        if near(stretch.ends[1].at, to.at) {
            let direct = (to.at - from.at).norm();
            let is_straight = length <= direct * (1.0 + STRAIGHT);
            let corners = [outline.stretches[first].ends[0].id, stretch.ends[1].id];
            return is_straight.then_some(corners);
        }
    }
    None
}
