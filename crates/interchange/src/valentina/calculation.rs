//! The drawing of a file, tool by tool.

use super::build::{Build, reference};
use super::contacts;
use super::curves;
use super::cuts;
use super::operations;
use super::points;
use super::rounds;
use super::splines;
use super::things::{Made, PointThing, Thing};
use crate::xml::Xml;
use roxmltree::Node;

/// Reads the tools of a drawing into the sheet that is built.
pub(super) fn read(build: &mut Build, xml: &Xml<'_>, drawing: Node<'_, '_>) {
    for node in drawing.children().filter(Node::is_element) {
        let tag = node.tag_name().name();
        let tool = node.attribute("type").unwrap_or_default();
        let place = format!("line {}", xml.line(node));
        let made = match tag {
            "point" if tool == "trueDarts" => Some(contacts::true_darts(build, node)),
            "point" => {
                let made = points::point(build, node, tool);
                let made = made.or_else(|| cuts::point(build, node, tool));
                let made = made.or_else(|| contacts::point(build, node, tool));
                made.map(|made| keep_point(build, node, made))
            }
            "spline" => curves::curve(build, node, tool).map(|made| keep_curve(build, node, made)),
            "elArc" => Some({
                let made = rounds::elliptic(build, node);
                keep_curve(build, node, made)
            }),
            "arc" => {
                let made = match tool {
                    "simple" => Some(curves::arc(build, node)),
                    _ => curves::curve(build, node, tool),
                };
                made.map(|made| keep_curve(build, node, made))
            }
            "line" => Some(line(build, node)),
            "operation" => operations::operation(build, node, tool),
            _ => None,
        };
        let what = || match node.attribute("name") {
            Some(name) => format!("{tag} {name:?} ({tool})"),
            None if tool.is_empty() => tag.to_owned(),
            None => format!("{tag} ({tool})"),
        };
        match made {
            None => build.left_out(place, what(), "the tool is not known".to_owned()),
            Some(Err(why)) => build.left_out(place, what(), why),
            Some(Ok(())) => {}
        }
    }
}

fn line(build: &mut Build, node: Node<'_, '_>) -> Result<(), String> {
    let ends = [
        build.point(node, "firstPoint")?,
        build.point(node, "secondPoint")?,
    ];
    let names = ends.map(|end| build.point_name(end));
    let name = format!("{} to {}", names[0], names[1]);
    build.join(ends);
    // A line between points that are copies has its curve all the same.
    build.line_between(&name, ends);
    Ok(())
}

fn keep_point(build: &mut Build, node: Node<'_, '_>, made: Made) -> Result<(), String> {
    let id = reference(node, "id")?;
    let made = made?;
    build.things.insert(id, Thing::Point(made));
    let name = node.attribute("name").unwrap_or_default();
    build.name_point(name.to_owned(), made);
    build.file_names.insert(made.id, name.to_owned());
    join(build, node, made);
    Ok(())
}

/// Names the lines that join a new point to those it is made from; each runs the way that formulas call it.
fn join(build: &mut Build, node: Node<'_, '_>, made: PointThing) {
    let (from, to): (&[&str], &[&str]) = match node.attribute("type").unwrap_or_default() {
        "endLine" | "curveIntersectAxis" => (&["basePoint"], &[]),
        "alongLine" => (&["firstPoint"], &["secondPoint"]),
        "normal" => (&["firstPoint"], &[]),
        "bisector" => (&["secondPoint"], &[]),
        "height" | "lineIntersectAxis" => (&["basePoint", "p1Line"], &["p2Line"]),
        "lineIntersect" => (&["p1Line1", "p1Line2"], &["p2Line1", "p2Line2"]),
        "shoulder" => (&["p1Line", "p2Line", "pShoulder"], &[]),
        "pointOfContact" => (&["firstPoint", "secondPoint", "center"], &[]),
        _ => (&[], &[]),
    };
    let other = |build: &Build, attribute: &str| match build
        .things
        .get(&reference(node, attribute).ok()?)?
    {
        Thing::Point(point) => Some(*point),
        Thing::Curve(_) => None,
    };
    for (attributes, is_start) in [(from, true), (to, false)] {
        for attribute in attributes {
            if let Some(other) = other(build, attribute) {
                build.join(if is_start {
                    [other, made]
                } else {
                    [made, other]
                });
            }
        }
    }
}

fn keep_curve(build: &mut Build, node: Node<'_, '_>, made: splines::Made) -> Result<(), String> {
    let id = reference(node, "id")?;
    let made = made?;
    if let Some(alias) = node.attribute("alias") {
        build.name_also(&made.name.clone(), alias);
    }
    build.things.insert(id, Thing::Curve(made));
    Ok(())
}
