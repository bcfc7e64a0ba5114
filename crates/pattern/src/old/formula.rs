//! Formulas: arithmetic on measurements, variables and drafted lengths.
//!
//! A recursive-descent parser of bounded depth writes the formula in postfix order, so that
//! evaluating it needs no recursion whatever its length.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Longest formula that is read [bytes].
pub const FORMULA_LENGTH: usize = 2000;
/// Deepest nesting of parentheses, signs and calls that is read.
pub const FORMULA_DEPTH: usize = 50;

/// A formula that has been read. Two are equal when their texts are.
#[derive(Clone)]
pub struct Formula {
    text: Arc<str>,
    steps: Arc<[Step]>,
    mentions: Arc<[Mention]>,
}

/// Why a text is not a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}; {hint}")]
pub struct FormulaError {
    /// Column of the offending character, from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

/// One step of a formula in postfix order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    /// Where it stands in the text, from 1.
    pub column: usize,
    pub operation: Operation,
}

/// What a step does to the stack.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Operation {
    /// Pushes a number; `power` 1 is a length.
    Constant {
        value: f64,
        power: i8,
    },
    /// Pushes a variable or measurement.
    Name(Box<str>),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    /// Takes that many values and pushes one.
    Call(Function, usize),
    /// Pushes the length of an edge.
    EdgeLength(Reference),
    /// Pushes a coordinate of a point: 0 is x, 1 is y.
    Coordinate(Reference, usize),
    /// Pushes the distance between two points.
    Distance(Reference, Reference),
}

/// A part of a panel, by names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Reference {
    pub panel: Box<str>,
    pub part: Box<str>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Minimum,
    Maximum,
    Absolute,
    SquareRoot,
    Sine,
    Cosine,
    Tangent,
    ArcTangent2,
    Hypotenuse,
}

/// What a name in a formula names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Mentioned {
    /// A variable or measurement.
    Name(Box<str>),
    /// A panel.
    Panel(Box<str>),
    /// An edge of the panel named first.
    Edge(Box<str>, Box<str>),
    /// A point of the panel named first.
    Point(Box<str>, Box<str>),
}

#[derive(Clone, Debug, PartialEq)]
struct Mention {
    range: Range<usize>,
    what: Mentioned,
}

const FUNCTIONS: &[(&str, Function, usize, usize)] = &[
    ("min", Function::Minimum, 1, 64),
    ("max", Function::Maximum, 1, 64),
    ("abs", Function::Absolute, 1, 1),
    ("sqrt", Function::SquareRoot, 1, 1),
    ("sin", Function::Sine, 1, 1),
    ("cos", Function::Cosine, 1, 1),
    ("tan", Function::Tangent, 1, 1),
    ("atan2", Function::ArcTangent2, 2, 2),
    ("hypot", Function::Hypotenuse, 2, 2),
];

const FUNCTION_NAMES: &str =
    "min, max, abs, sqrt, sin, cos, tan, atan2, hypot, length, distance, x, y";

impl Formula {
    /// Reads a formula.
    ///
    /// Numbers may carry a unit (`mm cm m in deg rad`); names are variables or measurements;
    /// `length(front.armhole)` is the length of an edge, `distance(front.a, front.b)`, `x(front.a)`
    /// and `y(front.a)` speak of points. Names that are not plain words stand in single quotes.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        if text.len() > FORMULA_LENGTH {
            return Err(FormulaError {
                column: FORMULA_LENGTH + 1,
                message: format!("the formula is longer than {FORMULA_LENGTH} characters"),
                hint: "split it with variables".into(),
            });
        }
        let mut parser = Parser {
            text,
            at: 0,
            depth: 0,
            steps: Vec::new(),
            mentions: Vec::new(),
        };
        parser.expression()?;
        parser.skip_space();
        if parser.at < text.len() {
            return Err(parser.error_here(
                "is not expected here",
                "put an operator between values, or remove it",
            ));
        }
        Ok(Self {
            text: text.into(),
            steps: parser.steps.into(),
            mentions: parser.mentions.into(),
        })
    }

    /// The text as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Everything the formula names, in the order of the text.
    pub(crate) fn mentions(&self) -> impl Iterator<Item = &Mentioned> {
        self.mentions.iter().map(|mention| &mention.what)
    }

    /// The formula with every mention of `old` written as `new`; nothing if there is none.
    pub(crate) fn renamed(&self, old: &Mentioned, new: &str) -> Option<Self> {
        let mut text = String::new();
        let mut at = 0;
        for mention in self.mentions.iter().filter(|m| m.what == *old) {
            text.push_str(&self.text[at..mention.range.start]);
            text.push_str(&quoted(new));
            at = mention.range.end;
        }
        if at == 0 {
            return None;
        }
        text.push_str(&self.text[at..]);
        Self::parse(&text).ok()
    }
}

/// A name as a formula writes it: in quotes unless it is a plain word.
pub(crate) fn quoted(name: &str) -> String {
    let plain = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if plain {
        name.to_owned()
    } else {
        format!("'{name}'")
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Formula({:?})", self.text)
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    steps: Vec<Step>,
    mentions: Vec<Mention>,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn skip_space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn peek(&mut self) -> Option<char> {
        self.skip_space();
        self.rest().chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn column(&self) -> usize {
        self.text[..self.at].chars().count() + 1
    }

    fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> FormulaError {
        FormulaError {
            column: self.column(),
            message: message.into(),
            hint: hint.into(),
        }
    }

    fn error_here(&self, message: &str, hint: &str) -> FormulaError {
        match self.rest().chars().next() {
            Some(c) => self.error(format!("{:?} {message}", c.to_string()), hint),
            None => self.error("the formula ends too early", hint),
        }
    }

    fn push(&mut self, column: usize, operation: Operation) {
        self.steps.push(Step { column, operation });
    }

    fn enter(&mut self) -> Result<(), FormulaError> {
        self.depth += 1;
        if self.depth > FORMULA_DEPTH {
            return Err(self.error(
                format!("nested deeper than {FORMULA_DEPTH} levels"),
                "split it with variables",
            ));
        }
        Ok(())
    }

    fn expression(&mut self) -> Result<(), FormulaError> {
        self.term()?;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            let column = self.column();
            self.at += 1;
            self.term()?;
            let operation = if sign == '+' {
                Operation::Add
            } else {
                Operation::Subtract
            };
            self.push(column, operation);
        }
        Ok(())
    }

    fn term(&mut self) -> Result<(), FormulaError> {
        self.unary()?;
        while let Some(sign @ ('*' | '/')) = self.peek() {
            let column = self.column();
            self.at += 1;
            self.unary()?;
            let operation = if sign == '*' {
                Operation::Multiply
            } else {
                Operation::Divide
            };
            self.push(column, operation);
        }
        Ok(())
    }

    fn unary(&mut self) -> Result<(), FormulaError> {
        self.enter()?;
        match self.peek() {
            Some('-') => {
                let column = self.column();
                self.at += 1;
                self.unary()?;
                self.push(column, Operation::Negate);
            }
            Some('+') => {
                self.at += 1;
                self.unary()?;
            }
            _ => self.primary()?,
        }
        self.depth -= 1;
        Ok(())
    }

    fn primary(&mut self) -> Result<(), FormulaError> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.expression()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.constant(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' || c == '\'' => self.name_or_call(),
            _ => Err(self.error_here(
                "is not a value",
                "write a number, a measurement, a variable or ( here",
            )),
        }
    }

    fn close(&mut self) -> Result<(), FormulaError> {
        if self.take(')') {
            Ok(())
        } else {
            Err(self.error_here("stands where ) is missing", "close the parenthesis"))
        }
    }

    fn constant(&mut self) -> Result<(), FormulaError> {
        let column = self.column();
        let bytes = self.rest().as_bytes();
        let digits = |from: usize| {
            bytes[from..]
                .iter()
                .take_while(|b| b.is_ascii_digit())
                .count()
        };
        let mut end = digits(0);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits((end + 1 + sign).min(bytes.len()));
            if exponent > 0 {
                end += 1 + sign + exponent;
            }
        }
        let number: f64 = self.rest()[..end]
            .parse()
            .map_err(|_| self.error_here("is not a number", "write digits, for example 2.5cm"))?;
        self.at += end;
        let (value, power) = self.unit(number)?;
        if !value.is_finite() {
            return Err(self.error("the number is too large", "write a smaller one"));
        }
        self.push(column, Operation::Constant { value, power });
        Ok(())
    }

    /// Applies the unit that follows a number, if one does.
    fn unit(&mut self, number: f64) -> Result<(f64, i8), FormulaError> {
        self.skip_space();
        let end = word_length(self.rest());
        let (value, power) = match &self.rest()[..end] {
            "" => (number, 0),
            "m" => (number, 1),
            "cm" => (number / 100.0, 1),
            "mm" => (number / 1000.0, 1),
            "in" => (number * 0.0254, 1),
            "deg" => (number.to_radians(), 0),
            "rad" => (number, 0),
            other => {
                let message = format!("{other:?} is not a unit");
                return Err(
                    self.error(message, "use mm, cm, m, in, deg or rad, or write * between")
                );
            }
        };
        self.at += end;
        Ok((value, power))
    }

    fn word(&mut self) -> Result<(Box<str>, Range<usize>), FormulaError> {
        let first = self.peek();
        let start = self.at;
        if first == Some('\'') {
            let inner = &self.text[start + 1..];
            let Some(length) = inner.find('\'') else {
                return Err(self.error("the quoted name does not end", "close it with '"));
            };
            self.at = start + length + 2;
            return Ok((inner[..length].into(), start..self.at));
        }
        let length = word_length(self.rest());
        if length == 0 {
            return Err(self.error_here("is not a name", "write a name here"));
        }
        self.at += length;
        Ok((self.text[start..self.at].into(), start..self.at))
    }

    fn name_or_call(&mut self) -> Result<(), FormulaError> {
        let column = self.column();
        let (name, range) = self.word()?;
        if self.peek() != Some('(') || range.len() != name.len() {
            self.mentions.push(Mention {
                range,
                what: Mentioned::Name(name.clone()),
            });
            self.push(column, Operation::Name(name));
            return Ok(());
        }
        let operation = match &*name {
            "length" => {
                self.at += 1;
                Operation::EdgeLength(self.reference(Mentioned::Edge)?)
            }
            "x" | "y" => {
                self.at += 1;
                Operation::Coordinate(
                    self.reference(Mentioned::Point)?,
                    usize::from(&*name == "y"),
                )
            }
            "distance" => {
                self.at += 1;
                let first = self.reference(Mentioned::Point)?;
                if !self.take(',') {
                    return Err(self.error_here(
                        "stands where a comma is missing",
                        "write distance(panel.point, panel.point)",
                    ));
                }
                Operation::Distance(first, self.reference(Mentioned::Point)?)
            }
            _ => return self.call(&name, range.start, column),
        };
        self.close()?;
        self.push(column, operation);
        Ok(())
    }

    fn call(&mut self, name: &str, start: usize, column: usize) -> Result<(), FormulaError> {
        let Some(&(_, function, least, most)) = FUNCTIONS.iter().find(|known| known.0 == name)
        else {
            self.at = start;
            let message = format!("{name:?} is not a function");
            return Err(self.error(message, format!("use one of {FUNCTION_NAMES}")));
        };
        self.at += 1;
        let mut count = 1;
        self.expression()?;
        while self.take(',') {
            self.expression()?;
            count += 1;
        }
        self.close()?;
        if count < least || count > most {
            self.at = start;
            let message = format!("{name} is given {count} values");
            let hint = if least == most {
                format!("give it {least}")
            } else {
                format!("give it {least} to {most}")
            };
            return Err(self.error(message, hint));
        }
        self.push(column, Operation::Call(function, count));
        Ok(())
    }

    /// `panel.part`, both plain words or quoted.
    fn reference(
        &mut self,
        part_kind: fn(Box<str>, Box<str>) -> Mentioned,
    ) -> Result<Reference, FormulaError> {
        let (panel, panel_range) = self.word()?;
        if !self.take('.') {
            return Err(self.error_here(
                "stands where a dot is missing",
                "write panel.name, for example front.armhole",
            ));
        }
        let (part, part_range) = self.word()?;
        self.mentions.push(Mention {
            range: panel_range,
            what: Mentioned::Panel(panel.clone()),
        });
        self.mentions.push(Mention {
            range: part_range,
            what: part_kind(panel.clone(), part.clone()),
        });
        Ok(Reference { panel, part })
    }
}

fn word_length(text: &str) -> usize {
    if !text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        return 0;
    }
    text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_name_column_and_remedy() {
        for (text, column, says) in [
            ("", 1, "ends too early"),
            ("bust +", 7, "ends too early"),
            ("bust 4", 6, "not expected"),
            ("2 elephants", 3, "not a unit"),
            ("(bust", 6, "ends too early"),
            ("bust)", 5, "not expected"),
            ("sqroot(2)", 1, "not a function"),
            ("sqrt(1,2)", 1, "given 2 values"),
            ("length(front)", 13, "dot is missing"),
            ("length('front)", 8, "does not end"),
            ("1e999", 6, "too large"),
            (".", 1, "not a number"),
            ("bust # 2", 6, "not expected"),
            ("größe", 3, "not expected"),
        ] {
            let error = Formula::parse(text).unwrap_err();
            assert_eq!(error.column, column, "{text}: {error}");
            assert!(error.to_string().contains(says), "{text}: {error}");
            assert!(!error.hint.is_empty());
        }
    }

    #[test]
    fn nesting_and_length_are_bounded() {
        let deep = "(".repeat(900) + "1" + &")".repeat(900);
        assert!(
            Formula::parse(&deep)
                .unwrap_err()
                .message
                .contains("deeper")
        );
        assert!(Formula::parse(&"-".repeat(1900)).is_err());
        assert!(Formula::parse(&"1+".repeat(1001)).is_err());
        assert!(Formula::parse(&("1+".repeat(900) + "1")).is_ok());
    }

    #[test]
    fn renaming_touches_the_right_names_only() {
        let formula =
            Formula::parse("front + length(front.front) + x('back piece'.front)").unwrap();
        let edge = Mentioned::Edge("front".into(), "front".into());
        assert_eq!(
            formula.renamed(&edge, "side seam").unwrap().text(),
            "front + length(front.'side seam') + x('back piece'.front)"
        );
        let panel = Mentioned::Panel("back piece".into());
        assert_eq!(
            formula.renamed(&panel, "back").unwrap().text(),
            "front + length(front.front) + x(back.front)"
        );
        assert_eq!(formula.renamed(&Mentioned::Name("bust".into()), "x"), None);
        assert_eq!(formula.mentions().count(), 5);
    }
}
