//! Writes operations of panels.

use super::json::Value;
use super::words::{BRIDGES, PLEATS, PRESSED, SIDES, TURNED, word};
use super::write::{Fields, Measure, Writer, count, counts, list, named, text};
use super::write_seam::{mark, name};
use crate::FormatError;
use toile_pattern::{
    Apex, Bridge, Number, Operation, OperationKind, Pressed, Side, SpreadCut, Turned,
};

/// Writes an operation.
pub fn operation(writer: &Writer<'_>, operation: &Operation) -> Result<Value, FormatError> {
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
            trued,
            keeps_length,
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
            put_pressed(&mut own, *pressed);
            if *trued {
                own.put("trued", Value::Flag(true));
            }
            if *keeps_length {
                own.put("keeps_length", Value::Flag(true));
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
        OperationKind::Pivot {
            dart,
            line,
            mouth,
            share,
            back,
            turned,
            pressed,
        } => {
            own.put("dart", count(dart.0));
            own.put("line", name(*line));
            own.put("mouth", mark(writer, mouth, &what)?);
            own.put("share", writer.number(share, Measure::Plain, &what)?);
            if *back != Number::ZERO {
                own.put("back", writer.number(back, Measure::Length, &what)?);
            }
            if *turned != Turned::default() {
                own.put("turned", text(word(TURNED, turned)));
            }
            put_pressed(&mut own, *pressed);
            "pivot"
        }
        OperationKind::Spread {
            line,
            held,
            cuts,
            bridge,
        } => {
            own.put("line", name(*line));
            own.put("held", mark(writer, held, &what)?);
            let cuts: Result<Vec<_>, _> = cuts.iter().map(|c| cut(writer, c, &what)).collect();
            own.put_list("cuts", cuts?);
            if *bridge != Bridge::default() {
                own.put("bridge", text(word(BRIDGES, bridge)));
            }
            "spread"
        }
        OperationKind::Split { line, curve } => {
            own.put("line", name(*line));
            own.put("curve", count(curve.0));
            "split"
        }
        OperationKind::Pleat {
            line,
            held,
            pleats,
            depth,
            kind,
            pressed,
            trued,
        } => {
            own.put("line", name(*line));
            own.put("held", mark(writer, held, &what)?);
            let mut all = Vec::with_capacity(pleats.len());
            for pleat in pleats {
                let mut fields = Fields::default();
                fields.put("number", count(u32::from(pleat.number)));
                fields.put("from", mark(writer, &pleat.ends[0], &what)?);
                fields.put("to", mark(writer, &pleat.ends[1], &what)?);
                all.push(fields.done());
            }
            own.put_list("pleats", all);
            own.put("depth", writer.number(depth, Measure::Length, &what)?);
            own.put("kind", text(word(PLEATS, kind)));
            if *pressed != Side::Left {
                own.put("pressed", text(word(SIDES, pressed)));
            }
            if !*trued {
                own.put("trued", Value::Flag(false));
            }
            "pleat"
        }
        OperationKind::Insert { sheet } => {
            own.put("sheet", count(sheet.0));
            "insert"
        }
    };
    fields.put(kind, own.done());
    if operation.meant {
        fields.put("meant", Value::Flag(true));
    }
    Ok(fields.done())
}

fn put_pressed(fields: &mut Fields, pressed: Pressed) {
    if pressed != Pressed::default() {
        fields.put("pressed", text(word(PRESSED, &pressed)));
    }
}

fn cut(writer: &Writer<'_>, cut: &SpreadCut, what: &str) -> Result<Value, FormatError> {
    let mut fields = Fields::default();
    fields.put("number", count(u32::from(cut.number)));
    fields.put("from", mark(writer, &cut.ends[0], what)?);
    fields.put("to", mark(writer, &cut.ends[1], what)?);
    let openings = cut.openings.iter();
    let openings: Result<Vec<_>, _> = openings
        .map(|n| writer.number(n, Measure::Length, what))
        .collect();
    fields.put("openings", list(openings?));
    Ok(fields.done())
}
