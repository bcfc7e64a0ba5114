//! Body measurements of FreeSewing (JSON), and helpers shared by the readers of other programs' tables.
//!
//! # Decided with
//! - [`crate::measurements_json`], [`crate::measurements_seamly`], [`crate::measurements_garmentcode`]: our
//!   own tables, Seamly, GarmentCode;
//! - [`crate::measurements_formulas::values_of`]: values that are formulas on others;
//! - [`toile_measure::translated`]: names in our words;
//! - [`crate::measurements_seamly`] (`choose`), [`crate::measurements_json::read_sized_measurements`]: one of
//!   several sizes;
//! - [`crate::measurements_garmentcode`] (`DEGREES`): angles, by hand;
//! - [`crate::xml`], [`crate::file_kind::FileKind`]: XML; kinds of files told apart.

use crate::FormatError;
use toile_measure::{FREESEWING, Measurements, Origin, is_angle, translated};

/// Reads a table of FreeSewing: a JSON object of names and values in millimetres (slopes in degrees), at the
/// top or under `measurements` or `measies`.
///
/// # Errors
/// The text is not JSON, a name is unknown, a value is not a number or is refused, or there is no measurement.
pub fn read_freesewing(text: &str) -> Result<Measurements, FormatError> {
    let value: serde_json::Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| {
            FormatError::new(
                format!("line {}", error.line()),
                error.to_string(),
                "give a JSON object of names and numbers",
            )
        })?;
    let inner = ["measurements", "measies"]
        .iter()
        .find_map(|key| value.get(key))
        .unwrap_or(&value);
    let mut table = Measurements::new();
    for (name, value) in inner.as_object().into_iter().flatten() {
        let Some(own) = translated(FREESEWING, name) else {
            return Err(FormatError::new(
                name.clone(),
                "FreeSewing has no measurement of that name",
                "leave it out",
            ));
        };
        if value.is_null() {
            continue;
        }
        let Some(number) = value.as_f64() else {
            return Err(FormatError::new(
                name.clone(),
                "the value is not a number",
                "write millimetres or degrees as a plain number",
            ));
        };
        put(&mut table, own, number, 1e-3)
            .map_err(|what| FormatError::new(name.clone(), what, "correct the value"))?;
    }
    refuse_empty(table)
}

/// Whether a JSON text is a FreeSewing table: it is no native file and has FreeSewing's names.
pub(crate) fn looks_like_freesewing(text: &str) -> bool {
    !text.contains("\"toile\"")
        && [
            "\"waistToFloor\"",
            "\"hpsToWaistBack\"",
            "\"seat\"",
            "\"inseam\"",
            "\"biceps\"",
        ]
        .iter()
        .any(|name| text.contains(name))
}

/// Enters a number into a table: angles are in degrees, `scale` is the unit of lengths (m). If two names of the
/// file mean one measurement, the first value counts.
pub(crate) fn put(
    table: &mut Measurements,
    name: &str,
    number: f64,
    scale: f64,
) -> Result<(), String> {
    let angle = is_angle(name);
    let value = if angle {
        number.to_radians()
    } else {
        number * scale
    };
    if table.contains(name) {
        return Ok(());
    }
    table
        .set(name, value, Origin::Asked)
        .map_err(|error| error.to_string())
}

pub(crate) fn refuse_empty(table: Measurements) -> Result<Measurements, FormatError> {
    if table.is_empty() {
        return Err(FormatError::new(
            "the file",
            "there is no measurement in it",
            "give a measurement file with values",
        ));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_measurements;

    #[test]
    fn freesewing_sets_are_recognised() {
        let text =
            r#"{"measurements":{"chest":925,"waistToFloor":1050,"shoulderSlope":13,"neck":null}}"#;
        let table = read_measurements(text).unwrap();
        assert_eq!(table.get("bust"), Some(0.925));
        assert_eq!(table.get("waist_height"), Some(1.05));
        assert_eq!(table.len(), 3);
        assert_eq!(
            read_freesewing(r#"{"chest":"wide"}"#).unwrap_err().place,
            "chest"
        );
        assert_eq!(read_freesewing(r#"{"tail":9}"#).unwrap_err().place, "tail");
    }
}
