//! The file as plain data: panels with curves in metres, placed in space, and stitched pairs.

use super::curves::{Coordinates, read_curve};
use super::json::At;
use super::loops::{LoopEdge, closed_loops};
use crate::FormatError;
use toile_geometry::{Curve, Rigid, Vec2, Vec3};

/// More panels, edges or stitches than this are refused: no garment has them.
const MAX_PARTS: usize = 100_000;

/// The content of a whole file.
#[derive(Debug, Default)]
pub(super) struct Specification {
    pub panels: Vec<SpecPanel>,
    pub stitches: Vec<SpecStitch>,
    /// Whether the file is of the older kind, in which outlines may be wound either way.
    pub older: bool,
    pub notes: Vec<FormatError>,
}

/// A panel.
#[derive(Debug)]
pub(super) struct SpecPanel {
    pub name: String,
    /// Transform from the panel's plane to the world.
    pub place: Rigid,
    /// Edges in the order of the file.
    pub edges: Vec<SpecEdge>,
    /// Closed loops of edges, the outline first.
    pub loops: Vec<Vec<LoopEdge>>,
}

/// An edge.
#[derive(Debug)]
pub(super) struct SpecEdge {
    /// Indices of the panel's vertices at the start and at the end.
    pub ends: [usize; 2],
    pub curve: Curve,
    pub label: Option<String>,
}

/// A stitched pair of edges.
#[derive(Debug)]
pub(super) struct SpecStitch {
    /// Panel and edge of each side.
    pub sides: [(usize, usize); 2],
    /// Whether a right side is sewn onto a wrong side.
    pub right_wrong: bool,
    /// Place of the stitch in the file, for messages.
    pub path: String,
}

/// The unit and the kind of coordinates of a file.
struct Settings {
    /// Size of a file unit (m).
    metres: f64,
    coordinates: Coordinates,
}

/// Reads the JSON text.
pub(super) fn read(text: &str) -> Result<Specification, FormatError> {
    let value: serde_json::Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| {
            FormatError::new(
                format!("line {}, column {}", error.line(), error.column()),
                format!("this is not JSON: {error}"),
                "check that the file is whole and was exported as a specification",
            )
        })?;
    let root = At::root(&value);
    let mut specification = Specification::default();
    let notes = &mut specification.notes;
    root.unknown_fields(
        &[
            "pattern",
            "parameters",
            "parameter_order",
            "properties",
            "constraints",
            "constraint_order",
        ],
        notes,
    );
    for name in ["parameters", "constraints"] {
        let filled = |v: &serde_json::Value| {
            v.as_object().is_some_and(|o| !o.is_empty())
                || v.as_array().is_some_and(|a| !a.is_empty())
        };
        if root.optional(name).is_some_and(|p| filled(p.value)) {
            notes.push(root.error(
                format!("\"{name}\" of the generating program are not carried over"),
                "panels come as they are drawn in the file",
            ));
        }
    }
    let settings = settings(&root, notes)?;
    let pattern = root.field("pattern")?;
    pattern.unknown_fields(&["panels", "stitches", "panel_order"], notes);
    let panels = pattern.field("panels")?;
    let mut entries = panels.entries()?;
    order_panels(&pattern, &mut entries)?;
    if entries.is_empty() {
        return Err(panels.error("the pattern has no panel", "choose a file that has panels"));
    }
    for (name, panel) in entries {
        specification.older |= is_older(&panel);
        let panel = read_panel(name, &panel, &settings, &mut specification.notes)?;
        specification.panels.push(panel);
    }
    specification.older |= settings.coordinates == Coordinates::Absolute;
    read_stitches(&pattern, &mut specification)?;
    Ok(specification)
}

fn settings(root: &At, notes: &mut Vec<FormatError>) -> Result<Settings, FormatError> {
    let mut settings = Settings {
        metres: 0.01,
        coordinates: Coordinates::Relative,
    };
    let Some(properties) = root.optional("properties") else {
        notes.push(root.error(
            "\"properties\" are missing: centimetres and relative curvatures are taken",
            "check the size of the panels",
        ));
        return Ok(settings);
    };
    properties.unknown_fields(
        &[
            "curvature_coords",
            "normalize_panel_translation",
            "normalized_edge_loops",
            "units_in_meter",
        ],
        notes,
    );
    if let Some(units) = properties.optional("units_in_meter") {
        let count = units.number()?;
        if !(1e-3..=1e6).contains(&count) {
            return Err(units.error(
                format!("{count} units in a metre cannot be used"),
                "give 100 for centimetres or 1000 for millimetres",
            ));
        }
        settings.metres = 1.0 / count;
    }
    if let Some(coordinates) = properties.optional("curvature_coords") {
        settings.coordinates = match coordinates.text()? {
            "relative" => Coordinates::Relative,
            "absolute" => Coordinates::Absolute,
            other => {
                return Err(coordinates.error(
                    format!("\"{other}\" is not a kind of coordinates known here"),
                    "use relative or absolute",
                ));
            }
        };
    }
    Ok(settings)
}

/// Sorts panels in the order of `panel_order`; panels that it does not name come last.
fn order_panels(pattern: &At, entries: &mut [(&str, At)]) -> Result<(), FormatError> {
    let Some(order) = pattern.optional("panel_order") else {
        return Ok(());
    };
    let mut names = Vec::new();
    for item in order.items()? {
        names.push(item.text()?);
    }
    let rank: std::collections::BTreeMap<&str, usize> =
        names.iter().enumerate().map(|(k, &n)| (n, k)).collect();
    entries.sort_by_key(|(name, _)| rank.get(name).copied().unwrap_or(usize::MAX));
    Ok(())
}

/// Whether a panel has an edge with a curvature that names no type, as before version 2 of the format.
fn is_older(panel: &At) -> bool {
    let edges = panel.value.get("edges").and_then(|e| e.as_array());
    edges.into_iter().flatten().any(|edge| {
        edge.get("curvature")
            .is_some_and(serde_json::Value::is_array)
    })
}

fn read_panel(
    name: &str,
    panel: &At,
    settings: &Settings,
    notes: &mut Vec<FormatError>,
) -> Result<SpecPanel, FormatError> {
    panel.unknown_fields(
        &["translation", "rotation", "vertices", "edges", "label"],
        notes,
    );
    let mut vertices: Vec<Vec2> = Vec::new();
    for vertex in panel.field("vertices")?.items()? {
        let [x, y] = vertex.numbers::<2>()?;
        vertices.push(Vec2::new(x, y) * settings.metres);
    }
    let listed = panel.field("edges")?;
    let items = listed.items()?;
    if vertices.len() > MAX_PARTS || items.len() > MAX_PARTS {
        return Err(listed.error("there are too many parts", "simplify the panel"));
    }
    let mut edges = Vec::new();
    for item in &items {
        edges.push(read_edge(item, &vertices, settings, notes)?);
    }
    let pairs: Vec<[usize; 2]> = edges.iter().map(|e| e.ends).collect();
    let mut loops = closed_loops(&pairs).map_err(|(edge, reason)| {
        let place = items.get(edge).unwrap_or(&listed);
        place.error(
            format!("the edges form no closed outline: {reason}"),
            "let each edge start where the one before it ends",
        )
    })?;
    let area = |walk: &Vec<LoopEdge>| loop_area(&edges, walk).abs();
    loops.sort_by(|a, b| area(b).total_cmp(&area(a)));
    if loops.is_empty() {
        return Err(listed.error("the panel has no edge", "draw its outline"));
    }
    Ok(SpecPanel {
        name: name.to_owned(),
        place: read_place(panel, settings, notes)?,
        edges,
        loops,
    })
}

/// Signed area of a loop (m2), from eight points on each of its curves; positive if counter-clockwise.
pub(super) fn loop_area(edges: &[SpecEdge], walk: &[LoopEdge]) -> f64 {
    let mut points = Vec::new();
    for &(edge, backwards) in walk {
        let curve = &edges[edge].curve;
        let curve = if backwards { curve.reversed() } else { *curve };
        points.extend((0..8).map(|k| curve.point(f64::from(k) / 8.0)));
    }
    let ring = (0..points.len()).map(|k| (points[k], points[(k + 1) % points.len()]));
    0.5 * ring.map(|(a, b)| a.perp(&b)).sum::<f64>()
}

fn read_edge(
    edge: &At,
    vertices: &[Vec2],
    settings: &Settings,
    notes: &mut Vec<FormatError>,
) -> Result<SpecEdge, FormatError> {
    edge.unknown_fields(&["endpoints", "curvature", "label"], notes);
    let endpoints = edge.field("endpoints")?;
    let items = endpoints.items()?;
    let [first, last] = &items[..] else {
        return Err(endpoints.error("an edge has two endpoints", "give [start, end]"));
    };
    let mut ends = [0; 2];
    for (end, item) in ends.iter_mut().zip([first, last]) {
        *end = item.index()?;
        if *end >= vertices.len() {
            return Err(item.error(
                format!("there is no vertex {end}: the panel has {}", vertices.len()),
                "name a vertex of the panel",
            ));
        }
    }
    let points = ends.map(|v| vertices[v]);
    if points[0] == points[1] {
        return Err(endpoints.error("the edge has no length", "move its ends apart"));
    }
    let curve = read_curve(
        edge.optional("curvature").as_ref(),
        points,
        settings.coordinates,
        settings.metres,
        notes,
    )?;
    let label = match edge.optional("label") {
        Some(label) => Some(label.text()?.to_owned()).filter(|l| !l.is_empty()),
        None => None,
    };
    Ok(SpecEdge { ends, curve, label })
}

/// Transform from the panel's plane to the world: the rotation `R = Rz Ry Rx` of angles in degrees, then the
/// translation, as other readers of the format apply it.
fn read_place(
    panel: &At,
    settings: &Settings,
    notes: &mut Vec<FormatError>,
) -> Result<Rigid, FormatError> {
    let translation = match panel.optional("translation") {
        Some(t) => Vec3::from(t.numbers::<3>()?) * settings.metres,
        None => Vec3::zeros(),
    };
    let mut angles = [0.0; 3];
    if let Some(rotation) = panel.optional("rotation") {
        angles = rotation.numbers::<3>()?;
        let turned = angles.iter().filter(|a| (*a % 360.0).abs() > 1e-6).count();
        if turned > 1 {
            notes.push(rotation.error(
                "two angles are not zero: they are applied as Rz Ry Rx, but some programs write \
                 them as Rx Ry Rz",
                "check the place of this panel in space",
            ));
        }
    }
    let about = |axis: Vec3, degrees: f64| Rigid::rotation(axis * degrees.to_radians());
    let rotation =
        about(Vec3::z(), angles[2]) * about(Vec3::y(), angles[1]) * about(Vec3::x(), angles[0]);
    Ok(Rigid::from_parts(translation.into(), rotation.rotation))
}

fn read_stitches(pattern: &At, specification: &mut Specification) -> Result<(), FormatError> {
    let Some(stitches) = pattern.optional("stitches") else {
        specification.notes.push(pattern.error(
            "there are no stitches",
            "sew the panels before the garment is draped",
        ));
        return Ok(());
    };
    let items = stitches.items()?;
    if items.len() > MAX_PARTS {
        return Err(stitches.error("there are too many stitches", "simplify the pattern"));
    }
    for item in items {
        let parts = item.items()?;
        if parts.len() < 2 {
            return Err(item.error("a stitch has two sides", "name the panel and edge of both"));
        }
        let mut sides = [(0, 0); 2];
        for (side, part) in sides.iter_mut().zip(&parts) {
            *side = read_side(part, specification)?;
        }
        if sides[0] == sides[1] {
            return Err(item.error("an edge is stitched to itself", "name two different edges"));
        }
        let mut right_wrong = false;
        for extra in &parts[2..] {
            if extra.value.as_str() == Some("right_wrong") {
                right_wrong = true;
            } else {
                specification
                    .notes
                    .push(extra.error("this mark is not known and is left out", "check the seam"));
            }
        }
        specification.stitches.push(SpecStitch {
            sides,
            right_wrong,
            path: item.path,
        });
    }
    Ok(())
}

fn read_side(part: &At, specification: &mut Specification) -> Result<(usize, usize), FormatError> {
    part.unknown_fields(&["panel", "edge"], &mut specification.notes);
    let name = part.field("panel")?;
    let text = name.text()?;
    let panel = specification
        .panels
        .iter()
        .position(|p| p.name == text)
        .ok_or_else(|| {
            name.error(
                format!("there is no panel \"{text}\""),
                "name a panel of the pattern",
            )
        })?;
    let edge = part.field("edge")?;
    let index = edge.index()?;
    let count = specification.panels[panel].edges.len();
    if index >= count {
        return Err(edge.error(
            format!("panel \"{text}\" has no edge {index}: it has {count}"),
            "count the edges from 0",
        ));
    }
    Ok((panel, index))
}
