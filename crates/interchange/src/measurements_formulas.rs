//! Evaluates measurements whose values are formulas of other measurements in the table.

use crate::FormatError;
use std::collections::BTreeMap;
use toile_pattern::{Formula, FormulaError};

/// A measurement as written in its file.
pub(crate) struct Written {
    /// Line of the measurement, from 1.
    pub line: usize,
    /// Name in the file.
    pub name: String,
    /// Number or formula, in the file's unit.
    pub text: String,
}

/// Values of numbers and formulas, in the file's unit and order. A formula may name measurements that stand
/// before or after it; an empty text means "not measured" and has the value 0.
///
/// # Errors
/// An invalid formula, a name that the table does not have, formulas that depend on each other.
pub(crate) fn values_of(rows: &[Written]) -> Result<Vec<f64>, FormatError> {
    let mut numbers: Vec<Option<f64>> = Vec::new();
    let mut formulas: BTreeMap<usize, Formula> = BTreeMap::new();
    let mut by_name: BTreeMap<&str, usize> = BTreeMap::new();
    for (k, row) in rows.iter().enumerate() {
        by_name.entry(&row.name).or_insert(k);
        let text = row.text.trim();
        let number = match text {
            "" => Some(0.0),
            _ => text.parse().ok().filter(|number: &f64| number.is_finite()),
        };
        if number.is_none() {
            let read = Formula::of_measurements(&in_our_words(text));
            formulas.insert(k, read.map_err(|error| fault(row, &error))?);
        }
        numbers.push(number);
    }
    // Evaluates formulas whose inputs are known, until all are evaluated or the remaining ones form a cycle.
    while !formulas.is_empty() {
        let is_known = |word: &str| by_name.get(word).is_none_or(|&k| numbers[k].is_some());
        let ready: Vec<usize> = formulas
            .iter()
            .filter(|(_, formula)| formula.words().all(is_known))
            .map(|(&k, _)| k)
            .collect();
        if ready.is_empty() {
            return Err(circle(rows, &formulas, &by_name));
        }
        for k in ready {
            let value = |word: &str| by_name.get(word).and_then(|&k| numbers[k]);
            let Some(formula) = formulas.remove(&k) else {
                continue;
            };
            let computed = formula.plain_value(value);
            numbers[k] = Some(computed.map_err(|error| fault(&rows[k], &error))?);
        }
    }
    Ok(numbers.into_iter().map(Option::unwrap_or_default).collect())
}

/// The formula in Toile's syntax: names with special characters in quotes, commas between arguments.
fn in_our_words(text: &str) -> String {
    let is_of_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '@' | '#');
    let mut made = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match is_of_word(first) {
            true => rest.find(|c| !is_of_word(c)).unwrap_or(rest.len()),
            false => first.len_utf8(),
        };
        let (part, after) = rest.split_at(length);
        rest = after;
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        match first {
            ';' => made.push(','),
            _ if is_of_word(first) && !part.chars().all(is_plain) => {
                made.push_str(&format!("'{part}'"));
            }
            _ => made.push_str(part),
        }
    }
    made
}

fn fault(row: &Written, error: &FormulaError) -> FormatError {
    FormatError::new(
        format!("line {}", row.line),
        format!(
            "the value of {:?} is {:?}, which has no value: {}",
            row.name, row.text, error.message
        ),
        error.hint.clone(),
    )
}

/// The error for formulas that depend on each other; it names one cycle.
fn circle(
    rows: &[Written],
    formulas: &BTreeMap<usize, Formula>,
    by_name: &BTreeMap<&str, usize>,
) -> FormatError {
    let needed = |k: usize| {
        let mut words = formulas[&k].words().filter_map(|word| by_name.get(word));
        words.find(|other| formulas.contains_key(other)).copied()
    };
    let mut way: Vec<usize> = formulas.keys().take(1).copied().collect();
    while let Some(next) = way.last().and_then(|&last| needed(last)) {
        if let Some(start) = way.iter().position(|&k| k == next) {
            way.drain(..start);
            way.push(next);
            break;
        }
        way.push(next);
    }
    let names: Vec<&str> = way.iter().map(|&k| &*rows[k].name).collect();
    let line = way.first().map_or(0, |&k| rows[k].line);
    FormatError::new(
        format!("line {line}"),
        format!("formulas need each other: {}", names.join(" needs ")),
        "give one of them a number",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(texts: &[(&str, &str)]) -> Vec<Written> {
        let row = |(k, (name, text)): (usize, &(&str, &str))| Written {
            line: k + 1,
            name: (*name).to_owned(),
            text: (*text).to_owned(),
        };
        texts.iter().enumerate().map(row).collect()
    }

    #[test]
    fn formulas_name_what_stands_before_and_after() {
        let table = rows(&[
            ("hips", "(waist + 20/2)"),
            ("waist", "bust - 8.25"),
            ("bust", " 36.5 "),
            ("@ease", "2"),
            ("neck", "13 + @ease/2"),
            ("größe", "max(waist; bust) * -1"),
            ("more", "größe + 1e1"),
            ("none", ""),
        ]);
        let found = values_of(&table).unwrap();
        assert_eq!(found, [38.25, 28.25, 36.5, 2.0, 14.0, -36.5, -26.5, 0.0]);
    }

    #[test]
    fn what_has_no_value_is_named() {
        for (texts, place, what) in [
            (&[("a", "b + 1")][..], "line 1", "nothing is called \"b\""),
            (&[("a", "1"), ("b", "a +")], "line 2", "\"a +\""),
            (&[("a", "1 / 0")], "line 1", "\"1 / 0\""),
            (&[("a", "2cm")], "line 1", "a unit of its own"),
            (&[("a", "NaN")], "line 1", "nothing is called \"NaN\""),
            (
                &[("x", "c"), ("a", "b"), ("b", "c * 2"), ("c", "a")],
                "line 4",
                "formulas need each other: c needs a needs b needs c",
            ),
            (&[("a", "a + 1")], "line 1", "a needs a"),
        ] {
            let error = values_of(&rows(texts)).unwrap_err();
            assert_eq!(error.place, place, "{error}");
            assert!(error.what.contains(what), "{error}");
        }
    }
}
