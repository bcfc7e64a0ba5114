//! Tables of body measurements in the native format.

use crate::measurements_foreign::looks_like_freesewing;
use crate::measurements_seamly::one_size;
use crate::{FormatError, SizeChoice, read_body_yaml, read_freesewing, read_seamly};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_measure::{Measurements, Origin, is_angle};

const KIND: &str = "measurements";
const VERSION: u32 = 1;

/// The native file: lengths in its unit (mm, cm, m or in), angles in degrees.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeasurementsFile {
    toile: u32,
    kind: String,
    unit: String,
    measurements: BTreeMap<String, f64>,
}

/// Reads a table of measurements and recognises the format by its content: native (JSON), GarmentCode (YAML),
/// Seamly and Valentina (XML) or FreeSewing (JSON). A table for several sizes is read in its base size.
///
/// # Errors
/// The text is no table of any of these formats, or has an invalid value: the fault, its place and a remedy.
pub fn read_measurements(text: &str) -> Result<Measurements, FormatError> {
    Ok(read_sized_measurements(text, SizeChoice::default())?.0)
}

/// Reads one size of a multi-size table; also returns notes on the size chosen and on values left out.
///
/// # Errors
/// The faults that [`read_measurements`] refuses; a size that the table does not have, or any size for a table
/// of one body.
pub fn read_sized_measurements(
    text: &str,
    choice: SizeChoice,
) -> Result<(Measurements, Vec<String>), FormatError> {
    let body = text.trim_start_matches('\u{feff}').trim_start();
    let table = match body.chars().next() {
        Some('<') => return read_seamly(text, choice),
        _ if choice.is_given() => return Err(one_size()),
        Some('{') if looks_like_freesewing(text) => read_freesewing(text),
        Some('{') => read_json(text),
        _ => read_body_yaml(text),
    };
    Ok((table?, Vec::new()))
}

fn read_json(text: &str) -> Result<Measurements, FormatError> {
    let hint = "write {\"toile\": 1, \"kind\": \"measurements\", \"unit\": \"cm\", \"measurements\": {\"height\": 170}}";
    let file: MeasurementsFile = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_owned();
        FormatError::new(place, what, hint)
    })?;
    let refuse = |place: &str, what: String| Err(FormatError::new(place, what, hint));
    if file.kind != KIND {
        return refuse(
            "kind",
            format!("{:?} is not a table of measurements", file.kind),
        );
    }
    if file.toile != VERSION {
        return refuse("toile", format!("version {} is not known here", file.toile));
    }
    let metres = match &*file.unit {
        "mm" => 1e-3,
        "cm" => 1e-2,
        "m" => 1.0,
        "in" => 0.0254,
        other => return refuse("unit", format!("{other:?} is none of mm, cm, m, in")),
    };
    let mut table = Measurements::new();
    for (name, number) in file.measurements {
        let angle = is_angle(&name);
        let value = if angle {
            number.to_radians()
        } else {
            number * metres
        };
        table.set(&name, value, Origin::Asked).map_err(|error| {
            FormatError::new(
                format!("measurements.{name}"),
                error.to_string(),
                "correct it",
            )
        })?;
    }
    Ok(table)
}

/// Writes a table in the native format: centimetres and degrees.
///
/// # Errors
/// A value that JSON cannot represent; no table has one, since all its numbers are finite.
pub fn write_measurements(table: &Measurements) -> Result<String, FormatError> {
    let number = |name: &str, value: f64| {
        let angle = is_angle(name);
        let shown = if angle {
            value.to_degrees()
        } else {
            value * 100.0
        };
        // Rounded to 1e-6 cm or 1e-6 degrees, so that round numbers look round.
        (shown * 1e6).round() / 1e6
    };
    let file = MeasurementsFile {
        toile: VERSION,
        kind: KIND.into(),
        unit: "cm".into(),
        measurements: table
            .iter()
            .map(|(name, measured)| (name.to_owned(), number(name, measured.value)))
            .collect(),
    };
    serde_json::to_string_pretty(&file)
        .map(|text| text + "\n")
        .map_err(|error| FormatError::new("measurements", error.to_string(), "check the values"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_table_reads_back() {
        let table = Measurements::adult_woman();
        let again = read_measurements(&write_measurements(&table).unwrap()).unwrap();
        assert_eq!(again.len(), table.len());
        for (name, measured) in table.iter() {
            assert!(
                (again.get(name).unwrap() - measured.value).abs() < 1e-8,
                "{name}"
            );
        }
    }

    #[test]
    fn both_formats_are_recognised() {
        let yaml = read_measurements("body:\n  height: 170\n").unwrap();
        let json = r#"{"toile":1,"kind":"measurements","unit":"in","measurements":{"height":10,"arm_pose_angle":45}}"#;
        let json = read_measurements(json).unwrap();
        assert_eq!(yaml.get("height"), Some(1.7));
        assert_eq!(json.get("height"), Some(0.254));
        assert_eq!(
            json.get("arm_pose_angle"),
            Some(std::f64::consts::FRAC_PI_4)
        );
    }

    #[test]
    fn refusals_name_the_place() {
        let place = |text: &str| read_measurements(text).unwrap_err().place;
        let file = |unit: &str, rest: &str| {
            format!(
                r#"{{"toile":1,"kind":"measurements","unit":"{unit}","measurements":{{{rest}}}}}"#
            )
        };
        assert!(place("{").starts_with("line 1"));
        assert_eq!(place(&file("ell", "")), "unit");
        assert_eq!(place(&file("cm", r#""Hei ght":1"#)), "measurements.Hei ght");
        assert!(place(&file("cm", r#""height":1e999"#)).starts_with("line"));
        assert!(
            place(r#"{"toile":1,"kind":"measurements","unit":"cm","measurements":{},"x":1}"#)
                .starts_with("line")
        );
    }
}
