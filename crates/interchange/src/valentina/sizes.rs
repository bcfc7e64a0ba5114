//! Sizes of a pattern from a table of measurements for several sizes.

use crate::FormatError;
use crate::exchange::{Companion, Guess, ReadOption};
use crate::measurements_seamly::{
    HEIGHT_STEP, SIZE_STEP, SeamlyRows, SizeChoice, seamly_base, seamly_rows,
};

/// Number of sizes below and above the base of a table that a pattern gets.
const SIZES_EACH_WAY: i32 = 3;
/// Number of heights below and above the base that the base size gets.
const HEIGHTS_EACH_WAY: i32 = 1;

/// The measurements of a file, for each size that a pattern gets.
pub(super) struct Tables {
    /// Name of the base size.
    pub base: String,
    /// Rows of the base size.
    pub rows: SeamlyRows,
    /// Names and rows of the other sizes.
    pub others: Vec<(String, SeamlyRows)>,
    /// The choice of sizes, if there was one.
    pub guess: Option<Guess>,
}

/// A file's name without folders and ending.
fn stem(name: &str) -> &str {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    name.split('.').next().unwrap_or(name)
}

/// A length in whole centimetres, or with its fraction.
fn in_cm(metres: f64) -> String {
    ((metres * 1e4).round() / 1e2).to_string()
}

/// Reads the measurements of a file: of one body, or of a table for several sizes the sizes round its base.
///
/// # Errors
/// The file is damaged: the fault, with the name of the file in its place.
pub(super) fn tables_of(companion: &Companion) -> Result<Tables, FormatError> {
    let fault = |error: FormatError| FormatError {
        place: format!("{}, {}", companion.name, error.place),
        ..error
    };
    let text = std::str::from_utf8(&companion.bytes).map_err(|_| {
        fault(FormatError::new(
            "the whole file",
            "the text is not UTF-8",
            "save it as UTF-8",
        ))
    })?;
    let rows = seamly_rows(text, SizeChoice::default()).map_err(fault)?;
    let Some([size, height]) = seamly_base(text).map_err(fault)? else {
        return Ok(Tables {
            base: stem(&companion.name).to_owned(),
            rows,
            others: Vec::new(),
            guess: None,
        });
    };
    let choose = |size: f64, height: f64| {
        let choice = SizeChoice {
            size: Some(size),
            height: Some(height),
        };
        seamly_rows(text, choice).ok()
    };
    let mut others = Vec::new();
    for step in (-SIZES_EACH_WAY..=SIZES_EACH_WAY).filter(|step| *step != 0) {
        let other = size + SIZE_STEP * f64::from(step);
        if let Some(rows) = choose(other, height) {
            others.push((in_cm(other), rows));
        }
    }
    for step in (-HEIGHTS_EACH_WAY..=HEIGHTS_EACH_WAY).filter(|step| *step != 0) {
        let other = height + HEIGHT_STEP * f64::from(step);
        if let Some(rows) = choose(size, other) {
            others.push((format!("{} height {}", in_cm(size), in_cm(other)), rows));
        }
    }
    let names: Vec<&str> = others.iter().map(|(name, _)| name.as_str()).collect();
    let guess = Guess {
        what: "sizes",
        chosen: format!("{} as base, {}", in_cm(size), names.join(", ")),
        because: format!(
            "{} gives steps from its base, size {} of height {} cm, and no list of sizes",
            companion.name,
            in_cm(size),
            in_cm(height)
        ),
        option: ReadOption::With,
    };
    Ok(Tables {
        base: in_cm(size),
        rows,
        others,
        guess: Some(guess),
    })
}
