//! Several numbers typed into one field: places in the unit of the document, formulas too.

use super::number;
use toile_pattern::{Evaluation, Number, Want, is_unit};

/// Operators: a space beside an operator does not separate two numbers.
const GOES_ON: [char; 5] = ['+', '-', '*', '/', '^'];

/// Content of a field for one plain number or several lengths.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Listed {
    /// One plain number.
    One(Number),
    /// Lengths (m).
    Lengths(Vec<Number>),
}

/// Reads one plain number, or several lengths; a single length must have a unit.
///
/// # Errors
/// Which number is wrong, the reason, and the remedy.
pub(super) fn parse(text: &str, evaluation: &Evaluation) -> Result<Listed, String> {
    let parts = parts(text);
    if let [one] = &parts[..] {
        let plain = number::parse(one, Want::Plain, evaluation);
        return match (plain, number::parse(one, Want::Length, evaluation)) {
            (Ok(plain), _) => Ok(Listed::One(plain)),
            (Err(_), Ok(length)) => Ok(Listed::Lengths(vec![length])),
            (Err(fault), Err(_)) => Err(fault),
        };
    }
    let lengths = parts.iter().enumerate().map(|(k, part)| {
        let number = number::parse(part, Want::Length, evaluation);
        number.map_err(|fault| format!("{part:?}, the {}: {fault}", ordinal(k + 1)))
    });
    Ok(Listed::Lengths(lengths.collect::<Result<_, _>>()?))
}

fn ordinal(number: usize) -> String {
    let end = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{end}")
}

/// Splits a text into numbers. Separators are spaces, semicolons and commas before a space. In a text without
/// these a comma separates if there are several commas or a decimal point. Other commas are decimal commas.
fn parts(text: &str) -> Vec<String> {
    let text = text.trim().trim_start_matches('=').trim();
    let is_close = !text.contains(char::is_whitespace) && !text.contains(';');
    let divides_all = is_close && (text.matches(',').count() > 1 || text.contains('.'));
    let mut words: Vec<String> = vec![String::new()];
    let mut ends: Vec<bool> = Vec::new();
    let mut depth = 0_usize;
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        depth = match c {
            '(' => depth + 1,
            ')' => depth.saturating_sub(1),
            _ => depth,
        };
        let is_end = rest.peek().is_none_or(|next| next.is_whitespace());
        let divides = c == ';' || c == ',' && (divides_all || is_end);
        match depth {
            0 if divides || c.is_whitespace() => {
                words.push(String::new());
                ends.push(divides);
            }
            _ => {
                if let Some(word) = words.last_mut() {
                    word.push(c);
                }
            }
        }
    }
    let mut parts: Vec<String> = Vec::new();
    let mut is_divided = true;
    for (k, word) in words.into_iter().enumerate() {
        is_divided |= k > 0 && ends[k - 1];
        if word.is_empty() {
            continue;
        }
        match parts.last_mut() {
            Some(before) if !is_divided && goes_on(before, &word) => {
                before.push(' ');
                before.push_str(&word);
            }
            _ => parts.push(word),
        }
        is_divided = false;
    }
    parts
}

/// Whether a word continues the number before it.
fn goes_on(before: &str, word: &str) -> bool {
    before.ends_with(GOES_ON) || word.starts_with(GOES_ON) || is_unit(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_divided_as_they_are_meant() {
        for (text, wanted) in [
            ("4 8 12.5", &["4", "8", "12.5"][..]),
            ("4, 8, 12.5", &["4", "8", "12.5"]),
            ("4,8,12.5", &["4", "8", "12.5"]),
            ("4,5 8,25", &["4,5", "8,25"]),
            ("4,5; 8,25", &["4,5", "8,25"]),
            ("4,5", &["4,5"]),
            ("=waist / 4 8cm", &["waist / 4", "8cm"]),
            ("4 cm 8 cm", &["4 cm", "8 cm"]),
            ("max(4cm, 5cm) 9 + 1cm", &["max(4cm, 5cm)", "9 + 1cm"]),
            (" 6 ", &["6"]),
            ("7 =4cm + 6cm 12", &["7", "=4cm + 6cm", "12"]),
            ("4;", &["4"]),
            ("", &[]),
        ] {
            assert_eq!(parts(text), wanted, "{text:?}");
        }
    }
}
