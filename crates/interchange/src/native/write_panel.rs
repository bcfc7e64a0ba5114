//! Writes panels and seams.

use super::json::Value;
use super::words::{CORNERS, FACINGS, LINES, NOTCHES, PARTS, PRESSED, ROLES, word};
use super::write::{Fields, Measure, Writer, count, counts, list, named, plain_value, text};
use crate::FormatError;
use toile_pattern::{
    Apex, Cut, Edge, Line, Mark, Name, Notch, NotchKind, Number, Operation, OperationKind, Panel,
    PartId, Pressed, Seam, Span, WornRule,
};

/// Writes a panel.
pub fn panel(writer: &Writer<'_>, panel: &Panel) -> Result<Value, FormatError> {
    let what = format!("panel {:?}", panel.name);
    let mut fields = named(panel.id.0, &panel.name)?;
    fields.put("sheet", count(panel.sheet().0));
    fields.put("fabric", count(panel.fabric.0));
    if panel.cut != Cut::default() {
        fields.put("cut", cut(panel.cut));
    }
    if panel.grain != Number::Value(std::f64::consts::FRAC_PI_2) {
        fields.put("grain", writer.number(&panel.grain, Measure::Angle, &what)?);
    }
    if panel.allowance != Number::ZERO {
        fields.put(
            "allowance",
            writer.number(&panel.allowance, Measure::Length, &what)?,
        );
    }
    if panel.worn != WornRule::Automatic {
        fields.put("worn", worn(writer, &panel.worn, &what)?);
    }
    if let Some(place) = panel.on_table {
        fields.put("table", writer.place(place, &what)?);
    }
    let lines: Result<Vec<_>, _> = panel.lines.iter().map(|l| line(writer, l)).collect();
    fields.put_list("lines", lines?);
    let notches: Result<Vec<_>, _> = panel.notches.iter().map(|n| notch(writer, n)).collect();
    fields.put_list("notches", notches?);
    let operations = panel.operations.iter().map(|o| operation(writer, o));
    let operations: Result<Vec<_>, _> = operations.collect();
    fields.put_list("operations", operations?);
    Ok(fields.done())
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
        } => count(quantity),
        Cut { quantity, .. } => {
            let mut fields = Fields::default();
            fields.put("quantity", count(quantity));
            fields.put("mirrored", Value::Flag(true));
            fields.done()
        }
    }
}

fn worn(writer: &Writer<'_>, worn: &WornRule, what: &str) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    match worn {
        WornRule::Automatic => {}
        WornRule::Wrapped {
            part,
            facing,
            level,
        } => {
            fields.put("part", text(word(PARTS, part)));
            fields.put("facing", text(word(FACINGS, facing)));
            if let Some(level) = level {
                fields.put("level", writer.number(level, Measure::Length, what)?);
            }
        }
        WornRule::Placed {
            translation,
            rotation,
        } => {
            if !translation.iter().chain(rotation).all(|v| v.is_finite()) {
                return Err(FormatError::new(
                    what,
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

fn line(writer: &Writer<'_>, line: &Line) -> Result<Value, FormatError> {
    let mut fields = named(line.id.0, &line.name)?;
    fields.put("kind", text(word(LINES, &line.kind)));
    let edges: Result<Vec<_>, _> = line.edges.iter().map(|e| edge(writer, e)).collect();
    fields.put_list("edges", edges?);
    Ok(fields.done())
}

fn edge(writer: &Writer<'_>, edge: &Edge) -> Result<Value, FormatError> {
    let mut fields = named(edge.id.0, &edge.name)?;
    fields.put("curve", count(edge.curve.0));
    fields.put("from", count(edge.ends[0].0));
    fields.put("to", count(edge.ends[1].0));
    if let Some(allowance) = &edge.allowance {
        let what = format!("edge {:?}", edge.name);
        fields.put(
            "allowance",
            writer.number(allowance, Measure::Length, &what)?,
        );
    }
    fields.put_if(
        "corner",
        edge.corner.map(|corner| text(word(CORNERS, &corner))),
    );
    Ok(fields.done())
}

fn notch(writer: &Writer<'_>, notch: &Notch) -> Result<Value, FormatError> {
    let what = format!("notch {:?}", notch.name);
    let mut fields = named(notch.id.0, &notch.name)?;
    fields.put("line", count(notch.line.0));
    fields.put("at", mark(writer, &notch.at, &what)?);
    if notch.kind != NotchKind::Slit {
        fields.put("kind", text(word(NOTCHES, &notch.kind)));
    }
    Ok(fields.done())
}

fn name<T: Copy + Into<PartId>>(name: Name<T>) -> Value {
    match name {
        Name::Drawn(id) => count(id.into().number()),
        Name::Made { by, role, index } => {
            let mut fields = Fields::default();
            fields.put("by", count(by.0));
            fields.put("role", text(word(ROLES, &role)));
            fields.put("index", count(u32::from(index)));
            fields.done()
        }
    }
}

fn mark(writer: &Writer<'_>, mark: &Mark, what: &str) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    match mark {
        Mark::Corner(corner) => return Ok(name(*corner)),
        Mark::Notch(id) => fields.put("notch", count(id.0)),
        Mark::Along { from, distance } => {
            fields.put("from", name(*from));
            fields.put("distance", writer.number(distance, Measure::Length, what)?);
        }
        Mark::Between { ends, share } => {
            fields.put("between", list(ends.map(name)));
            fields.put("share", writer.number(share, Measure::Plain, what)?);
        }
    }
    Ok(fields.done())
}

fn operation(writer: &Writer<'_>, operation: &Operation) -> Result<Value, FormatError> {
    let what = format!("operation {:?}", operation.name);
    let mut fields = named(operation.id.0, &operation.name)?;
    let mut own = Fields::default();
    let kind = match &operation.kind {
        OperationKind::Dart {
            line,
            mouth,
            intake,
            apex,
            pressed,
        } => {
            own.put("line", name(*line));
            own.put("mouth", mark(writer, mouth, &what)?);
            own.put("intake", writer.number(intake, Measure::Length, &what)?);
            match apex {
                Apex::Depth(depth) => {
                    own.put("depth", writer.number(depth, Measure::Length, &what)?);
                }
                Apex::Point(point) => own.put("apex", count(point.0)),
            }
            if *pressed != Pressed::default() {
                own.put("pressed", text(word(PRESSED, pressed)));
            }
            "dart"
        }
        OperationKind::Diamond {
            ends,
            widest,
            intake,
        } => {
            own.put("ends", counts(ends.map(|id| id.0)));
            own.put("widest", writer.number(widest, Measure::Plain, &what)?);
            own.put("intake", writer.number(intake, Measure::Length, &what)?);
            "diamond"
        }
        OperationKind::Fold { line, ends } => {
            own.put("line", name(*line));
            own.put("from", mark(writer, &ends[0], &what)?);
            own.put("to", mark(writer, &ends[1], &what)?);
            "fold"
        }
    };
    fields.put(kind, own.done());
    Ok(fields.done())
}

/// Writes a seam.
pub fn seam(writer: &Writer<'_>, seam: &Seam) -> Result<Value, FormatError> {
    let what = format!("seam {:?}", seam.name);
    let mut fields = named(seam.id.0, &seam.name)?;
    let mut sides = Vec::new();
    for side in &seam.sides {
        let spans: Result<Vec<_>, _> = side.iter().map(|s| span(writer, s, &what)).collect();
        sides.push(list(spans?));
    }
    fields.put("sides", list(sides));
    if seam.ease != Number::ZERO {
        fields.put("ease", writer.number(&seam.ease, Measure::Length, &what)?);
    }
    if seam.gathered {
        fields.put("gathered", Value::Flag(true));
    }
    if !seam.right_sides_together {
        fields.put("right_sides_together", Value::Flag(false));
    }
    if seam.multi_ply {
        fields.put("multi_ply", Value::Flag(true));
    }
    Ok(fields.done())
}

fn span(writer: &Writer<'_>, span: &Span, what: &str) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    fields.put("panel", count(span.panel.0));
    fields.put("line", name(span.line));
    fields.put("from", mark(writer, &span.from, what)?);
    fields.put("to", mark(writer, &span.to, what)?);
    if span.copy != 0 {
        fields.put("copy", count(span.copy));
    }
    if span.half != 0 {
        fields.put("half", count(u32::from(span.half)));
    }
    if span.backwards {
        fields.put("backwards", Value::Flag(true));
    }
    Ok(fields.done())
}
