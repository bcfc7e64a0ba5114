//! Writes panels: lines and notches.

use super::json::Value;
use super::words::{CORNERS, FACINGS, LINES, NOTCHES, PARTS, SIDES, word};
use super::write::{Fields, Measure, Writer, count, list, named, plain_value, text};
use super::write_operation::operation;
use super::write_seam::mark;
use crate::FormatError;
use toile_pattern::{
    Corner, Cut, Edge, EdgeCorner, Line, MitreLimit, Notch, NotchKind, Number, Panel, Source,
    WornRule,
};

/// Writes a panel.
pub fn panel(writer: &Writer<'_>, panel: &Panel) -> Result<Value, FormatError> {
    let what = format!("panel {:?}", panel.name);
    let mut fields = named(panel.id.0, &panel.name)?;
    match panel.source {
        Source::Traced(sheet) => fields.put("sheet", count(sheet.0)),
        Source::Side { of, split, side } => {
            let mut own = Fields::default();
            own.put("of", count(of.0));
            own.put("split", count(split.0));
            own.put("is", text(word(SIDES, &side)));
            fields.put("side", own.done());
        }
    }
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
    fields.put_if("by", line.by.map(|by| count(by.0)));
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
    let EdgeCorner { kind, limit, meant } = edge.corner;
    if kind != Corner::default() {
        fields.put("corner", text(word(CORNERS, &kind)));
    }
    match limit {
        limit if limit == MitreLimit::default() => {}
        MitreLimit::Widths(widths) => {
            let what = format!("edge {:?}, limit of its corner", edge.name);
            let widths = Number::Value(widths);
            fields.put("limit", writer.number(&widths, Measure::Plain, &what)?);
        }
        MitreLimit::None => fields.put("limit", text("none")),
    }
    if meant {
        fields.put("meant", Value::Flag(true));
    }
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
