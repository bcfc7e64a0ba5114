//! Writes seams, and the places on lines they and operations name.

use super::json::Value;
use super::words::{ROLES, word};
use super::write::{Fields, Measure, Writer, count, list, named, text};
use crate::FormatError;
use toile_pattern::{Mark, Name, Number, PartId, Seam, Span};

/// A part by its id, or by what an operation made.
pub fn name<T: Copy + Into<PartId>>(name: Name<T>) -> Value {
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

/// A place on a line.
pub fn mark(writer: &Writer<'_>, mark: &Mark, what: &str) -> Result<Value, FormatError> {
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
