//! Writes one panel of a pattern file.

use super::json::Value;
use super::words::{FACINGS, PARTS, word};
use super::write::{Fields, Writer, distinct, list, plain_value, text};
use crate::FormatError;
use std::collections::BTreeMap;
use toile_pattern::{
    Along, Cut, Dart, DartShape, DartTip, Edge, EdgeCurve, EdgeId, InternalLine, Number, Panel,
    PointId, PointPlace, WornRule,
};

/// Names of one panel's parts.
struct Names<'a> {
    panel: &'a Panel,
    points: BTreeMap<PointId, &'a str>,
    edges: BTreeMap<EdgeId, &'a str>,
}

impl<'a> Names<'a> {
    fn new(panel: &'a Panel) -> Self {
        Self {
            panel,
            points: panel.points.iter().map(|p| (p.id, &*p.name)).collect(),
            edges: panel.edges().map(|e| (e.id, &*e.name)).collect(),
        }
    }

    fn missing(&self, what: String) -> FormatError {
        FormatError::new(
            format!("panels.{}", self.panel.name),
            format!("{what} is named but not there"),
            "remove what names it, or add it",
        )
    }

    fn point(&self, id: PointId) -> Result<Value, FormatError> {
        let name = self.points.get(&id);
        Ok(text(name.ok_or_else(|| self.missing(id.to_string()))?))
    }

    fn points(&self, ids: &[PointId]) -> Result<Value, FormatError> {
        let names: Result<Vec<_>, _> = ids.iter().map(|id| self.point(*id)).collect();
        Ok(list(names?))
    }

    fn edge(&self, id: EdgeId) -> Result<Value, FormatError> {
        let name = self.edges.get(&id);
        Ok(text(name.ok_or_else(|| self.missing(id.to_string()))?))
    }
}

/// Writes a panel.
pub fn panel(writer: &mut Writer<'_>, panel: &Panel) -> Result<Value, FormatError> {
    let path = format!("panels.{}", panel.name);
    distinct(&path, panel.points.iter().map(|p| &*p.name))?;
    distinct(&path, panel.edges().map(|e| &*e.name))?;
    distinct(&path, panel.internal_lines.iter().map(|l| &*l.name))?;
    distinct(&path, panel.darts.iter().map(|d| &*d.name))?;
    distinct(&path, panel.notches.iter().map(|n| &*n.name))?;
    let names = Names::new(panel);
    let mut fields = Fields::default();
    fields.put_if("id", writer.panel_id(panel.id));
    let fabric = writer.pattern.fabric(panel.fabric);
    let fabric = fabric.ok_or_else(|| names.missing(panel.fabric.to_string()))?;
    fields.put("fabric", text(&fabric.name));
    if panel.cut != Cut::default() {
        fields.put("cut", cut(panel.cut));
    }
    if let Some(fold) = panel.fold {
        fields.put("fold", names.edge(fold)?);
    }
    if panel.grain != Number::Value(std::f64::consts::FRAC_PI_2) {
        fields.put("grain", writer.angle(&panel.grain, &path)?);
    }
    if panel.seam_allowance != Number::ZERO {
        fields.put(
            "seam_allowance",
            writer.length(&panel.seam_allowance, &path)?,
        );
    }
    if panel.worn != WornRule::Automatic {
        fields.put("worn", worn(writer, &panel.worn, &path)?);
    }
    let mut points = Fields::default();
    for point in &panel.points {
        let id = writer.point_id(point.id);
        let path = format!("{path}.points.{}", point.name);
        points.put(
            &point.name,
            place(writer, &names, &point.place, (id, &path))?,
        );
    }
    fields.put("points", points.done());
    fields.put("outline", edges(writer, &names, &panel.outline)?);
    let holes: Result<Vec<_>, _> = panel
        .holes
        .iter()
        .map(|hole| edges(writer, &names, hole))
        .collect();
    let holes = holes?;
    if !holes.is_empty() {
        fields.put("holes", list(holes));
    }
    parts(writer, &names, &mut fields)?;
    Ok(fields.done())
}

fn parts(
    writer: &mut Writer<'_>,
    names: &Names<'_>,
    fields: &mut Fields,
) -> Result<(), FormatError> {
    let panel = names.panel;
    let mut lines = Fields::default();
    for item in &panel.internal_lines {
        lines.put(&item.name, line(writer, names, item)?);
    }
    fields.put_unless_empty("lines", lines);
    let mut darts = Fields::default();
    for item in &panel.darts {
        darts.put(&item.name, dart(writer, names, item)?);
    }
    fields.put_unless_empty("darts", darts);
    let mut notches = Fields::default();
    for notch in &panel.notches {
        let path = format!("panels.{}.notches.{}", panel.name, notch.name);
        let mut item = Fields::default();
        item.put_if("id", writer.notch_id(notch.id));
        item.put("edge", names.edge(notch.edge)?);
        match &notch.at {
            Along::Fraction(at) => item.put("at", writer.plain(at, &path)?),
            Along::Distance(at) => item.put("distance", writer.length(at, &path)?),
        }
        notches.put(&notch.name, item.done());
    }
    fields.put_unless_empty("notches", notches);
    Ok(())
}

fn cut(cut: Cut) -> Value {
    match cut {
        Cut {
            quantity: 2,
            mirrored: true,
        } => text("pair"),
        Cut {
            quantity,
            mirrored: false,
        } => Value::Number(quantity.to_string()),
        Cut { quantity, .. } => {
            let mut fields = Fields::default();
            fields.put("quantity", Value::Number(quantity.to_string()));
            fields.put("mirrored", Value::Flag(true));
            fields.done()
        }
    }
}

fn worn(writer: &Writer<'_>, worn: &WornRule, path: &str) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    match worn {
        WornRule::Automatic => return Ok(text("automatic")),
        WornRule::Wrapped {
            part,
            facing,
            level,
        } => {
            fields.put("part", text(word(PARTS, part)));
            fields.put("facing", text(word(FACINGS, facing)));
            if let Some(level) = level {
                fields.put("level", writer.length(level, path)?);
            }
        }
        WornRule::Placed {
            translation,
            rotation,
        } => {
            if !translation.iter().chain(rotation).all(|v| v.is_finite()) {
                return Err(FormatError::new(
                    path,
                    "the place of the panel is not finite",
                    "place it again",
                ));
            }
            let values = |values: &[f64]| list(values.iter().map(|v| plain_value(*v)));
            fields.put("translation_m", values(translation));
            fields.put("rotation_xyzw", values(rotation));
        }
    }
    Ok(fields.done())
}

fn place(
    writer: &Writer<'_>,
    names: &Names<'_>,
    place: &PointPlace,
    (id, path): (Option<Value>, &str),
) -> Result<Value, FormatError> {
    let pair = |x: &Number, y: &Number| -> Result<Value, FormatError> {
        Ok(list([writer.length(x, path)?, writer.length(y, path)?]))
    };
    let mut fields = Fields::default();
    let plain_place = id.is_none();
    fields.put_if("id", id);
    match place {
        PointPlace::At { x, y } if plain_place => return pair(x, y),
        PointPlace::At { x, y } => fields.put("at", pair(x, y)?),
        PointPlace::Offset { base, x, y } => {
            fields.put("from", names.point(*base)?);
            fields.put("offset", pair(x, y)?);
        }
        PointPlace::Polar {
            base,
            angle,
            distance,
        } => {
            fields.put("from", names.point(*base)?);
            fields.put("angle", writer.angle(angle, path)?);
            fields.put("distance", writer.length(distance, path)?);
        }
        PointPlace::Between {
            base,
            tip,
            along,
            aside,
        } => {
            fields.put("from", names.point(*base)?);
            fields.put("to", names.point(*tip)?);
            fields.put("along", writer.plain(along, path)?);
            if *aside != Number::ZERO {
                fields.put("aside", writer.plain(aside, path)?);
            }
        }
        PointPlace::Toward {
            base,
            tip,
            distance,
        } => {
            fields.put("from", names.point(*base)?);
            fields.put("toward", names.point(*tip)?);
            fields.put("distance", writer.length(distance, path)?);
        }
        PointPlace::OnEdge { edge, at } => {
            fields.put("edge", names.edge(*edge)?);
            fields.put("at", writer.plain(at, path)?);
        }
        PointPlace::Crossing { first, second } => {
            let lines = [names.points(first)?, names.points(second)?];
            fields.put("crossing", list(lines));
        }
        PointPlace::Mirrored { base, line } => {
            fields.put("mirror", names.point(*base)?);
            fields.put("in", names.points(line)?);
        }
    }
    Ok(fields.done())
}

fn put_curve(
    writer: &Writer<'_>,
    names: &Names<'_>,
    curve: &EdgeCurve,
    fields: &mut Fields,
) -> Result<(), FormatError> {
    match curve {
        EdgeCurve::Line => {}
        EdgeCurve::Arc { bulge } => {
            let path = format!("panels.{}", names.panel.name);
            fields.put("bulge", writer.plain(bulge, &path)?);
        }
        EdgeCurve::Quadratic { control } => fields.put("quadratic", names.point(*control)?),
        EdgeCurve::Cubic { controls } => fields.put("cubic", names.points(controls)?),
    }
    Ok(())
}

fn edges(writer: &mut Writer<'_>, names: &Names<'_>, edges: &[Edge]) -> Result<Value, FormatError> {
    let mut items = Vec::with_capacity(edges.len());
    for (k, edge) in edges.iter().enumerate() {
        let mut fields = Fields::default();
        fields.put("edge", text(&edge.name));
        fields.put_if("id", writer.edge_id(edge.id));
        fields.put("from", names.point(edge.ends[0])?);
        if edge.ends[1] != edges[(k + 1) % edges.len()].ends[0] {
            fields.put("to", names.point(edge.ends[1])?);
        }
        put_curve(writer, names, &edge.curve, &mut fields)?;
        if let Some(allowance) = &edge.seam_allowance {
            let path = format!("panels.{}, edge {:?}", names.panel.name, edge.name);
            fields.put("seam_allowance", writer.length(allowance, &path)?);
        }
        items.push(fields.done());
    }
    Ok(list(items))
}

fn line(
    writer: &mut Writer<'_>,
    names: &Names<'_>,
    line: &InternalLine,
) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    fields.put_if("id", writer.line_id(line.id));
    let straight = line.segments.iter().all(|s| s.curve == EdgeCurve::Line);
    let joined = line
        .segments
        .windows(2)
        .all(|w| w[0].ends[1] == w[1].ends[0]);
    match line.segments.first() {
        Some(first) if straight && joined => {
            let rest = line.segments.iter().map(|segment| segment.ends[1]);
            let path: Vec<PointId> = std::iter::once(first.ends[0]).chain(rest).collect();
            fields.put("path", names.points(&path)?);
        }
        _ => {
            let mut segments = Vec::new();
            for segment in &line.segments {
                let mut item = Fields::default();
                item.put("from", names.point(segment.ends[0])?);
                item.put("to", names.point(segment.ends[1])?);
                put_curve(writer, names, &segment.curve, &mut item)?;
                segments.push(item.done());
            }
            fields.put("segments", list(segments));
        }
    }
    Ok(fields.done())
}

fn dart(writer: &mut Writer<'_>, names: &Names<'_>, dart: &Dart) -> Result<Value, FormatError> {
    let path = format!("panels.{}.darts.{}", names.panel.name, dart.name);
    let mut fields = Fields::default();
    fields.put_if("id", writer.dart_id(dart.id));
    match &dart.shape {
        DartShape::Edge {
            edge,
            at,
            width,
            tip,
        } => {
            fields.put("edge", names.edge(*edge)?);
            fields.put("at", writer.plain(at, &path)?);
            fields.put("width", writer.length(width, &path)?);
            match tip {
                DartTip::Depth(depth) => fields.put("depth", writer.length(depth, &path)?),
                DartTip::Apex(apex) => fields.put("apex", names.point(*apex)?),
            }
        }
        DartShape::Diamond { ends, at, width } => {
            fields.put("ends", names.points(ends)?);
            fields.put("at", writer.plain(at, &path)?);
            fields.put("width", writer.length(width, &path)?);
        }
    }
    Ok(fields.done())
}
