//! Tables of body measurements of other programs: Seamly and Valentina (XML), FreeSewing (JSON).

use crate::FormatError;
use toile_measure::{FREESEWING, Measurements, Origin, SEAMLY, UnitKind, definition, translated};

/// Reads a measurement file of Seamly2D or Valentina: individual (`.vit`, `.smis`) or multisize
/// (`.vst`, `.smms`), of which the base size is taken. A value of zero means that nobody measured
/// it. Names are the catalogue's where it has the same measurement, else the file's own.
///
/// # Errors
/// A unit other than mm, cm and inch, a value that is not a number (a formula), or no value at
/// all.
pub fn read_seamly(text: &str) -> Result<Measurements, FormatError> {
    let unit = between(text, "<unit>", "</unit>").unwrap_or("cm").trim();
    let scale = match unit {
        "mm" => 1e-3,
        "cm" => 1e-2,
        "inch" | "in" => 0.0254,
        other => {
            return Err(FormatError::new(
                "unit",
                format!("{other:?} is not a unit this program knows"),
                "save the file in mm, cm or inch",
            ));
        }
    };
    let mut table = Measurements::new();
    for (start, _) in text.match_indices("<m ") {
        let tag = text[start..].split('>').next().unwrap_or_default();
        let line = text[..start].matches('\n').count() + 1;
        let place = format!("line {line}");
        let Some(name) = attribute(tag, "name").filter(|name| !name.is_empty()) else {
            return Err(FormatError::new(
                place,
                "a measurement without a name",
                "name it",
            ));
        };
        let Some(value) = attribute(tag, "value").or_else(|| attribute(tag, "base")) else {
            return Err(FormatError::new(
                place,
                format!("{name:?} has no value"),
                "give it a number",
            ));
        };
        let number: f64 = value.trim().parse().map_err(|_| {
            FormatError::new(
                place.clone(),
                format!("the value of {name:?} is {value:?}, not a number"),
                "replace the formula by the number it gives",
            )
        })?;
        if number == 0.0 {
            continue;
        }
        let own = match translated(SEAMLY, name) {
            Some(own) => own.to_owned(),
            None => name.trim_start_matches('@').to_ascii_lowercase(),
        };
        put(&mut table, &own, number, scale)
            .map_err(|what| FormatError::new(place, what, "correct the line"))?;
    }
    refuse_empty(table)
}

/// Reads measurements as FreeSewing keeps them, a JSON object of names to millimetres (slopes in
/// degrees), alone or under `measurements` or `measies`.
///
/// # Errors
/// What is wrong, where, and the remedy.
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

/// Whether a JSON text is a set of FreeSewing's: no native file, and its names.
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

/// Puts a value into a table; the first of two names for one measurement stands.
fn put(table: &mut Measurements, name: &str, number: f64, scale: f64) -> Result<(), String> {
    let angle = definition(name).is_some_and(|known| known.kind == UnitKind::Angle);
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

fn refuse_empty(table: Measurements) -> Result<Measurements, FormatError> {
    if table.is_empty() {
        return Err(FormatError::new(
            "the file",
            "there is no measurement in it",
            "give a measurement file with values",
        ));
    }
    Ok(table)
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> Option<&'a str> {
    let rest = &text[text.find(from)? + from.len()..];
    Some(&rest[..rest.find(to)?])
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = tag;
    while let Some(at) = rest.find(name) {
        let before = rest[..at].chars().next_back();
        let after = rest[at + name.len()..].trim_start();
        if before.is_some_and(char::is_whitespace)
            && let Some(value) = after.strip_prefix('=')
        {
            let value = value.trim_start();
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            return value[1..].split(quote).next();
        }
        rest = &rest[at + name.len()..];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_measurements;
    use proptest::prelude::*;

    #[test]
    fn individual_and_multisize_files_become_si() {
        let file = |unit: &str, rows: &str| {
            format!(
                "<?xml version='1.0'?>\n<vit>\n<unit>{unit}</unit>\n<body-measurements>\n{rows}</body-measurements></vit>"
            )
        };
        let rows = "<m name=\"height\" value=\"173\"/>\n<m value='24 ' name='hand_circ'/>\n\
                    <m name=\"neck_circ\" value=\"0\"/>\n<m name=\"waist_circ\" value=\"92\"/>\n\
                    <m name=\"shoulder_slope_neck_side_angle\" value=\"22\"/>";
        let table = read_measurements(&file("cm", rows)).unwrap();
        assert_eq!(table.get("height"), Some(1.73));
        assert_eq!(table.get("waist"), Some(0.92));
        assert_eq!(table.get("hand_circ"), Some(0.24));
        assert_eq!(table.get("shoulder_incl"), Some(22f64.to_radians()));
        assert!(!table.contains("neck_base"), "zero is not measured");
        let rows = "<m base=\"1760\" height_increase=\"60\" name=\"height\" size_increase=\"0\"/>";
        assert_eq!(
            read_seamly(&file("mm", rows)).unwrap().get("height"),
            Some(1.76)
        );
        let place = |text: &str| read_seamly(text).unwrap_err().place;
        assert_eq!(place(&file("ell", rows)), "unit");
        assert_eq!(
            place(&file("cm", "<m name=\"height\" value=\"waist*2\"/>")),
            "line 5"
        );
        assert_eq!(place(&file("cm", "<m value=\"1\"/>")), "line 5");
        assert_eq!(place(&file("cm", "")), "the file");
    }

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

    #[test]
    fn files_of_both_programs_are_read() {
        let start = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let found = start
            .ancestors()
            .map(|f| f.join("shared/data"))
            .find(|f| f.is_dir());
        let Some(folder) = found else {
            return;
        };
        for (file, least) in [
            ("valentina/MaleShirt.vit", 8),
            ("valentina/GOST_man_ru.vst", 60),
            ("seamly/male_shirt.smis", 8),
            ("seamly/trousers.smis", 8),
            ("seamly/gost_man_ru.smms", 60),
        ] {
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            let table = read_measurements(&text).unwrap();
            assert!(table.len() >= least, "{file}: {}", table.len());
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "<(m name=\"[a-z_]{0,9}\" (value|base)=\"[0-9.e-]{0,5}\"/>|[a-z <>/=\"']{0,30})*") {
            if let Ok(table) = read_seamly(&text) {
                prop_assert!(table.iter().all(|(_, m)| m.value.is_finite()));
            }
        }
    }
}
