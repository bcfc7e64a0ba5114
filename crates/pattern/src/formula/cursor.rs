//! Reads the words and numbers of a formula's text, one after another.

use super::{FormulaError, Quantity, RESERVED};
use std::cell::Cell;

/// A formula's text, and the byte position that is read next.
pub(super) struct Cursor<'a> {
    pub text: &'a str,
    pub at: usize,
    /// A byte position, and the number of characters before it: columns are counted on from there, not from
    /// the start.
    counted: Cell<(usize, usize)>,
}

/// A number with this unit. `None`: the word is no unit.
fn quantity(number: f64, unit: &str) -> Option<Quantity> {
    Some(match unit {
        "m" => Quantity::length(number),
        "cm" => Quantity::length(number / 100.0),
        "mm" => Quantity::length(number / 1000.0),
        "in" => Quantity::length(number * 0.0254),
        "deg" => Quantity::angle(number.to_radians()),
        "rad" => Quantity::angle(number),
        _ => return None,
    })
}

/// Whether a word is a unit that may follow a number in a formula.
pub fn is_unit(word: &str) -> bool {
    quantity(1.0, word).is_some()
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            text,
            at: 0,
            counted: Cell::default(),
        }
    }

    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    pub fn peek(&mut self) -> Option<char> {
        self.skip_space();
        self.rest().chars().next()
    }

    pub fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    pub fn take_word(&mut self, wanted: &str) -> bool {
        self.skip_space();
        let found = &self.rest()[..word_length(self.rest())] == wanted;
        if found {
            self.at += wanted.len();
        }
        found
    }

    /// Takes a word that stands before a name or an id, such as `curve` in `curve front.side`.
    pub fn take_prefix(&mut self, wanted: &str) -> bool {
        let before = self.at;
        let found = self.take_word(wanted) && {
            let next = self.peek();
            let is_operator = RESERVED.contains(&&self.rest()[..word_length(self.rest())]);
            let begins = |c: char| c.is_ascii_alphabetic() || matches!(c, '_' | '\'' | '?');
            next.is_some_and(begins) && !is_operator
        };
        if !found {
            self.at = before;
        }
        found
    }

    pub fn column(&self) -> usize {
        let (at, before) = match self.counted.get() {
            counted if counted.0 <= self.at => counted,
            _ => (0, 0),
        };
        let count = before + self.text[at..self.at].chars().count();
        self.counted.set((self.at, count));
        count + 1
    }

    pub fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> FormulaError {
        FormulaError {
            column: self.column(),
            message: message.into(),
            hint: hint.into(),
        }
    }

    pub fn error_here(&self, message: &str, hint: &str) -> FormulaError {
        match self.rest().chars().next() {
            Some(c) => self.error(format!("{:?} {message}", c.to_string()), hint),
            None => self.error("the formula ends too early", hint),
        }
    }

    pub fn digits(&self, from: usize) -> usize {
        let bytes = self.rest().as_bytes();
        let rest = bytes.get(from..).unwrap_or_default();
        rest.iter().take_while(|b| b.is_ascii_digit()).count()
    }

    /// A number with its unit, in metres or radians.
    pub fn constant(&mut self) -> Result<Quantity, FormulaError> {
        if let Some((value, end)) = self.inch_fraction() {
            self.at += end;
            return Ok(Quantity::length(value * 0.0254));
        }
        let bytes = self.rest().as_bytes();
        let mut end = self.digits(0);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + self.digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = self.digits(end + 1 + sign);
            if exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        let number: f64 = self.rest()[..end]
            .parse()
            .map_err(|_| self.error_here("is not a number", "write digits, for example 2.5cm"))?;
        self.at += end;
        let constant = self.unit(number)?;
        if !constant.value.is_finite() {
            return Err(self.error("the number is too large", "write a smaller one"));
        }
        Ok(constant)
    }

    /// Reads a length such as `5/8in` or `1 5/8in`: inches, and the number of bytes read. `None`: the text is
    /// no such length.
    fn inch_fraction(&self) -> Option<(f64, usize)> {
        let text = self.rest();
        let number = |from: usize, length: usize| text.get(from..from + length)?.parse().ok();
        let first = self.digits(0);
        let mut whole = 0.0;
        let (mut start, mut length) = (0, first);
        if text.as_bytes().get(first) == Some(&b' ') {
            whole = number(0, first)?;
            start = first + 1;
            length = self.digits(start);
        }
        let above: f64 = number(start, length)?;
        let slash = start + length;
        if text.as_bytes().get(slash) != Some(&b'/') {
            return None;
        }
        let below_length = self.digits(slash + 1);
        let below: f64 = number(slash + 1, below_length)?;
        let end = slash + 1 + below_length;
        let unit = &text[end..];
        let is_inch = word_length(unit) == 2 && unit.starts_with("in");
        (is_inch && below > 0.0).then_some((whole + above / below, end + 2))
    }

    /// Applies the unit that follows the number, if there is one.
    fn unit(&mut self, number: f64) -> Result<Quantity, FormulaError> {
        let before = self.at;
        self.skip_space();
        let end = word_length(self.rest());
        let word = &self.rest()[..end];
        if matches!(word, "" | "and" | "or") {
            self.at = before;
            return Ok(Quantity::plain(number));
        }
        let Some(quantity) = quantity(number, word) else {
            let message = format!("{word:?} is not a unit");
            return Err(self.error(message, "use mm, cm, m, in, deg or rad, or write * between"));
        };
        self.at += end;
        Ok(quantity)
    }

    /// Reads a name, plain or in quotes; returns also whether it was in quotes.
    pub fn word(&mut self) -> Result<(Box<str>, bool), FormulaError> {
        let first = self.peek();
        let start = self.at;
        if first == Some('\'') {
            let inner = &self.text[start + 1..];
            let Some(length) = inner.find('\'') else {
                return Err(self.error("the quoted name does not end", "close it with '"));
            };
            self.at = start + length + 2;
            return Ok((inner[..length].into(), true));
        }
        let length = word_length(self.rest());
        if length == 0 {
            return Err(self.error_here("is not a name", "write a name here"));
        }
        self.at += length;
        Ok((self.text[start..self.at].into(), false))
    }
}

fn word_length(text: &str) -> usize {
    if !text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        return 0;
    }
    text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .unwrap_or(text.len())
}
