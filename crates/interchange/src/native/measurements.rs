//! Tables of measurements.

use super::item::Item;
use super::json::Value;
use crate::FormatError;
use toile_measure::{Measurements, Origin, is_angle};
use toile_pattern::{Diagnostic, DisplayUnit};

/// Reads a table of measurements.
pub fn measurements(
    item: &Item<'_>,
    unit: DisplayUnit,
    notes: &mut Vec<Diagnostic>,
) -> Result<Measurements, FormatError> {
    let mut table = Measurements::new();
    for (name, entry) in item.entries()? {
        let predicted = match &entry.node.value {
            Value::Object(fields) => fields.iter().any(|(name, _)| name == "predicted"),
            Value::Null | Value::Flag(_) | Value::Number(_) | Value::Text(_) | Value::List(_) => {
                false
            }
        };
        let (entry, origin) = if predicted {
            let fields = entry.object(&["predicted"], notes)?;
            (fields.need("predicted")?, Origin::Predicted)
        } else {
            (entry, Origin::Asked)
        };
        let is_angle = is_angle(name);
        let number = if is_angle {
            entry.angle()?
        } else {
            entry.length(unit)?
        };
        let value = entry.fixed(&number)?;
        if table.contains(name) {
            return Err(entry.error(
                format!("the measurement {name:?} is given twice, once under another name"),
                "remove one of them",
            ));
        }
        table
            .set(name, value, origin)
            .map_err(|error| entry.error(error.to_string(), "change it"))?;
    }
    Ok(table)
}
