//! Writes a pattern file: the pattern by its fields, and the fitting of its garment.

use super::VERSION;
use super::json::{self, Value};
use super::part_writer::write_part;
use super::writer::{Object, Writer, count, text};
use crate::FormatError;
use toile_pattern::Pattern;

/// Writes a pattern, and the fitting of its garment that the function `fitting` returns.
pub fn write(
    pattern: &Pattern,
    fitting: impl FnOnce(&Writer) -> Result<Option<Value>, FormatError>,
) -> Result<String, FormatError> {
    let writer = Writer::new(pattern);
    let tried_on = fitting(&writer)?;
    Ok(json::write(&document(&writer, pattern, tried_on)?))
}

fn document(
    writer: &Writer,
    pattern: &Pattern,
    tried_on: Option<Value>,
) -> Result<Value, FormatError> {
    let mut root = Object::default();
    root.put("toile", count(VERSION));
    root.put("kind", text("pattern"));
    if let Value::Object(fields) = write_part(writer, pattern)? {
        root.0.extend(fields);
    }
    // The fitting is written before the next id, which comes last.
    let next_id = root.0.pop();
    root.put_if("fitting", tried_on);
    root.0.extend(next_id);
    Ok(root.done())
}
