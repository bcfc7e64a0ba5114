//! Reads formulas: a recursive-descent parser of bounded depth that writes postfix steps.

use super::names::part_of_ids;
use super::{
    Comparison, FORMULA_DEPTH, FORMULA_LENGTH, Formula, FormulaError, Function, Names, Operation,
    Step, Token,
};
use crate::PartReference;

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
    ("round", Function::Round, 2, 2),
];

const FUNCTION_NAMES: &str = "min, max, abs, sqrt, sin, cos, tan, atan2, hypot, round, if, \
                              length, finished, angle, distance, x, y";

/// Words that are operators, so that parts called so stand in quotes.
pub(super) const RESERVED: &[&str] = &["and", "or", "not"];

const COMPARISONS: &[(&str, Comparison)] = &[
    ("<=", Comparison::LessOrEqual),
    (">=", Comparison::MoreOrEqual),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    ("<", Comparison::Less),
    (">", Comparison::More),
    ("=", Comparison::Equal),
];

struct Parser<'a> {
    text: &'a str,
    names: &'a Names,
    at: usize,
    depth: usize,
    steps: Vec<Step>,
    tokens: Vec<Token>,
    /// Where the text that is in no token yet begins.
    pending: usize,
}

/// The kinds of part a function measures.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Point,
    /// An edge, a stretch, a curve or a seam.
    Stretch,
}

pub(super) fn parse(text: &str, names: &Names) -> Result<Formula, FormulaError> {
    if text.len() > FORMULA_LENGTH {
        return Err(FormulaError {
            column: FORMULA_LENGTH + 1,
            message: format!("the formula is longer than {FORMULA_LENGTH} characters"),
            hint: "split it with variables".into(),
        });
    }
    let mut parser = Parser {
        text,
        names,
        at: 0,
        depth: 0,
        steps: Vec::new(),
        tokens: Vec::new(),
        pending: 0,
    };
    parser.either()?;
    parser.skip_space();
    if parser.at < text.len() {
        return Err(parser.error_here(
            "is not expected here",
            "put an operator between values, or remove it",
        ));
    }
    parser.flush(text.len());
    Ok(Formula {
        tokens: parser.tokens.into(),
        steps: parser.steps.into(),
    })
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

    fn take_word(&mut self, wanted: &str) -> bool {
        self.skip_space();
        let found = &self.rest()[..word_length(self.rest())] == wanted;
        if found {
            self.at += wanted.len();
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

    /// Puts the text up to a place into a token.
    fn flush(&mut self, end: usize) {
        if self.pending < end {
            let text = &self.text[self.pending..end];
            self.tokens.push(Token::Text(text.into()));
        }
        self.pending = end;
    }

    /// A name from `start` to here becomes a token of its own.
    fn name_token(&mut self, start: usize, token: Token) {
        self.flush(start);
        self.tokens.push(token);
        self.pending = self.at;
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

    fn either(&mut self) -> Result<(), FormulaError> {
        self.both()?;
        loop {
            self.skip_space();
            let column = self.column();
            if !self.take_word("or") {
                return Ok(());
            }
            self.both()?;
            self.push(column, Operation::Or);
        }
    }

    fn both(&mut self) -> Result<(), FormulaError> {
        self.negated()?;
        loop {
            self.skip_space();
            let column = self.column();
            if !self.take_word("and") {
                return Ok(());
            }
            self.negated()?;
            self.push(column, Operation::And);
        }
    }

    fn negated(&mut self) -> Result<(), FormulaError> {
        self.skip_space();
        let column = self.column();
        if !self.take_word("not") {
            return self.comparison();
        }
        self.enter()?;
        self.negated()?;
        self.depth -= 1;
        self.push(column, Operation::Not);
        Ok(())
    }

    fn comparison(&mut self) -> Result<(), FormulaError> {
        self.sum()?;
        self.skip_space();
        let column = self.column();
        let found = COMPARISONS.iter().find(|c| self.rest().starts_with(c.0));
        if let Some(&(text, comparison)) = found {
            self.at += text.len();
            self.sum()?;
            self.push(column, Operation::Compare(comparison));
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<(), FormulaError> {
        self.product()?;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            let column = self.column();
            self.at += 1;
            self.product()?;
            let operation = match sign {
                '+' => Operation::Add,
                _ => Operation::Subtract,
            };
            self.push(column, operation);
        }
        Ok(())
    }

    fn product(&mut self) -> Result<(), FormulaError> {
        self.unary()?;
        while let Some(sign @ ('*' | '/')) = self.peek() {
            let column = self.column();
            self.at += 1;
            self.unary()?;
            let operation = match sign {
                '*' => Operation::Multiply,
                _ => Operation::Divide,
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
                self.either()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.constant(),
            Some('?') => self.lost(),
            Some('@') if self.names.are_ids() => self.variable_by_id(),
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

    fn digits(&self, from: usize) -> usize {
        let bytes = self.rest().as_bytes();
        let rest = bytes.get(from..).unwrap_or_default();
        rest.iter().take_while(|b| b.is_ascii_digit()).count()
    }

    fn constant(&mut self) -> Result<(), FormulaError> {
        let column = self.column();
        if let Some((value, end)) = self.inch_fraction() {
            self.at += end;
            let value = value * 0.0254;
            self.push(column, Operation::Constant { value, power: 1 });
            return Ok(());
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
        let (value, power) = self.unit(number)?;
        if !value.is_finite() {
            return Err(self.error("the number is too large", "write a smaller one"));
        }
        self.push(column, Operation::Constant { value, power });
        Ok(())
    }

    /// `5/8in` or `1 5/8in`: inches, and the bytes it takes. Anything else is no such number.
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

    /// Applies the unit that follows a number, if one does.
    fn unit(&mut self, number: f64) -> Result<(f64, i8), FormulaError> {
        let before = self.at;
        self.skip_space();
        let end = word_length(self.rest());
        let (value, power) = match &self.rest()[..end] {
            "" | "and" | "or" => {
                self.at = before;
                return Ok((number, 0));
            }
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

    /// A name, plain or quoted, and whether it was quoted.
    fn word(&mut self) -> Result<(Box<str>, bool), FormulaError> {
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

    /// `?47`: a part that was removed.
    fn lost(&mut self) -> Result<(), FormulaError> {
        let (column, start) = (self.column(), self.at);
        let length = self.digits(1);
        self.at += 1 + length;
        let word: Box<str> = self.text[start..self.at].into();
        self.name_token(start, Token::Text(word.clone()));
        self.push(column, Operation::Word(word));
        Ok(())
    }

    /// `@12`: a variable by its id.
    fn variable_by_id(&mut self) -> Result<(), FormulaError> {
        let (column, start) = (self.column(), self.at);
        let length = self.digits(1);
        let number: Option<u32> = self.rest()[1..1 + length].parse().ok();
        let number = number.ok_or_else(|| self.error_here("is no id", "write @ and a number"))?;
        self.at += 1 + length;
        self.name_token(start, Token::Variable(number.into()));
        self.push(column, Operation::Variable(number.into()));
        Ok(())
    }

    fn name_or_call(&mut self) -> Result<(), FormulaError> {
        self.skip_space();
        let (column, start) = (self.column(), self.at);
        let (name, is_quoted) = self.word()?;
        let end = self.at;
        if self.peek() != Some('(') || is_quoted {
            self.at = end;
            let (token, operation) = match self.names.variable(&name) {
                Some(id) => (Token::Variable(id), Operation::Variable(id)),
                None => (Token::Word(name.clone()), Operation::Word(name)),
            };
            self.name_token(start, token);
            self.push(column, operation);
            return Ok(());
        }
        if &*name == "if" {
            return self.condition(column);
        }
        let operation = match &*name {
            "length" | "finished" => {
                self.at += 1;
                let part = self.part(Kind::Stretch)?;
                match &*name {
                    "length" => Operation::Length(part),
                    _ => Operation::Finished(part),
                }
            }
            "x" | "y" => {
                self.at += 1;
                Operation::Coordinate(self.part(Kind::Point)?, usize::from(&*name == "y"))
            }
            "distance" => {
                self.at += 1;
                let first = self.part(Kind::Point)?;
                self.comma("write distance(panel.point, panel.point)")?;
                Operation::Distance(first, self.part(Kind::Point)?)
            }
            "angle" => self.angle()?,
            _ => return self.call(&name, start, column),
        };
        self.close()?;
        self.push(column, operation);
        Ok(())
    }

    /// The direction of an edge, or from a point to another.
    fn angle(&mut self) -> Result<Operation, FormulaError> {
        self.at += 1;
        let start = self.at;
        let state = (self.tokens.len(), self.pending);
        let first = self.part(Kind::Point)?;
        if self.peek() == Some(',') {
            self.at += 1;
            return Ok(Operation::AngleBetween(first, self.part(Kind::Point)?));
        }
        self.at = start;
        self.tokens.truncate(state.0);
        self.pending = state.1;
        Ok(Operation::Angle(self.part(Kind::Stretch)?))
    }

    fn comma(&mut self, hint: &str) -> Result<(), FormulaError> {
        if self.take(',') {
            return Ok(());
        }
        Err(self.error_here("stands where a comma is missing", hint))
    }

    /// `if(condition, value, otherwise)`: only the value that is chosen is computed.
    fn condition(&mut self, column: usize) -> Result<(), FormulaError> {
        const HINT: &str = "write if(condition, value, otherwise)";
        self.enter()?;
        self.at += 1;
        self.either()?;
        self.comma(HINT)?;
        let unless = self.steps.len();
        self.push(column, Operation::JumpUnless(0));
        self.either()?;
        self.comma(HINT)?;
        let jump = self.steps.len();
        self.push(column, Operation::Jump(0));
        self.steps[unless].operation = Operation::JumpUnless(jump + 1);
        self.either()?;
        self.steps[jump].operation = Operation::Jump(self.steps.len());
        self.depth -= 1;
        self.close()
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
        self.either()?;
        while self.take(',') {
            self.either()?;
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

    /// `panel.part`, `panel.from..panel.to`, or the name of a seam; plain words or quoted.
    fn part(&mut self, kind: Kind) -> Result<PartReference, FormulaError> {
        const HINT: &str = "write panel.name, for example front.armhole";
        if self.peek() == Some('?') {
            let start = self.at;
            self.at += 1 + self.digits(1);
            let part = PartReference::Unknown(self.text[start..self.at].into());
            self.name_token(start, Token::Part(part.clone()));
            return Ok(part);
        }
        if self.peek() == Some('@') && self.names.are_ids() {
            let start = self.at;
            let rest = &self.text[start + 1..];
            let length = rest
                .find(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, ':' | '.' | '_')))
                .unwrap_or(rest.len());
            let part = part_of_ids(&rest[..length])
                .ok_or_else(|| self.error_here("is no id", "write @ and an id"))?;
            self.at = start + 1 + length;
            self.name_token(start, Token::Part(part.clone()));
            return Ok(part);
        }
        self.skip_space();
        let start = self.at;
        let (owner, _) = self.word()?;
        if !self.take('.') {
            if kind == Kind::Stretch && self.peek() == Some(')') {
                self.at = start;
                self.word()?;
                let part = match self.names.seam(&owner) {
                    Some(id) => PartReference::Seam(id),
                    None => PartReference::Unknown(self.text[start..self.at].into()),
                };
                self.name_token(start, Token::Part(part.clone()));
                return Ok(part);
            }
            return Err(self.error_here("stands where a dot is missing", HINT));
        }
        let (part, _) = self.word()?;
        let found = if self.rest().starts_with("..") && kind == Kind::Stretch {
            self.at += 2;
            self.word()?;
            if !self.take('.') {
                return Err(self.error_here("stands where a dot is missing", HINT));
            }
            let (to, _) = self.word()?;
            self.names.between(&owner, [&part, &to])
        } else if kind == Kind::Point {
            self.names.point(&owner, &part).map(PartReference::Point)
        } else {
            self.names.stretch(&owner, &part)
        };
        let text = &self.text[start..self.at];
        let found = found.unwrap_or_else(|| PartReference::Unknown(text.into()));
        self.name_token(start, Token::Part(found.clone()));
        Ok(found)
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
mod tests;
