//! Reads formulas: a recursive-descent parser of bounded depth that writes postfix steps.

use super::by_id::part_of_ids;
use super::cursor::Cursor;
use super::written::{Kind, Written, id};
use super::{
    Comparison, FORMULA_DEPTH, FORMULA_LENGTH, Formula, FormulaError, Function, Names, Operation,
    PI, Quantity, Step, Token,
};
use crate::PartReference;
use std::f64::consts;

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

pub(super) const FUNCTION_NAMES: &str = "min, max, abs, sqrt, sin, cos, tan, atan2, hypot, round, if, \
                              length, finished, angle, distance, x, y";

const COMPARISONS: &[(&str, Comparison)] = &[
    ("<=", Comparison::LessOrEqual),
    (">=", Comparison::MoreOrEqual),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    ("<", Comparison::Less),
    (">", Comparison::More),
    ("=", Comparison::Equal),
];

/// Greatest length of the text that names one part in a formula (bytes): four names of 80 characters each,
/// and quotes.
const MAX_NAME_LENGTH: usize = 1500;

struct Parser<'a> {
    cursor: Cursor<'a>,
    names: &'a Names,
    depth: usize,
    steps: Vec<Step>,
    tokens: Vec<Token>,
    /// Position from which on the text is in no token yet (bytes).
    pending: usize,
}

pub(super) fn parse(text: &str, names: &Names) -> Result<Formula, FormulaError> {
    let too_long = || FormulaError {
        column: FORMULA_LENGTH + 1,
        message: format!("the formula is longer than {FORMULA_LENGTH} characters"),
        hint: "split it with variables".into(),
    };
    if text.len() > FORMULA_LENGTH * MAX_NAME_LENGTH {
        return Err(too_long());
    }
    let mut parser = Parser {
        cursor: Cursor::new(text),
        names,
        depth: 0,
        steps: Vec::new(),
        tokens: Vec::new(),
        pending: 0,
    };
    parser.either()?;
    parser.cursor.skip_space();
    if parser.cursor.at < text.len() {
        return Err(parser.cursor.error_here(
            "is not expected here",
            "put an operator between values, or remove it",
        ));
    }
    parser.flush(text.len());
    let lengths = parser.tokens.iter().map(|token| match token {
        Token::Text(text) => text.len(),
        Token::Variable(_) | Token::Word(_) | Token::Part(_) => 1,
    });
    if lengths.sum::<usize>() > FORMULA_LENGTH {
        return Err(too_long());
    }
    Ok(Formula {
        tokens: parser.tokens.into(),
        steps: parser.steps.into(),
    })
}

impl Parser<'_> {
    fn push(&mut self, column: usize, operation: Operation) {
        self.steps.push(Step { column, operation });
    }

    /// Makes a token of the text between `pending` and `end`.
    fn flush(&mut self, end: usize) {
        if self.pending < end {
            let text = &self.cursor.text[self.pending..end];
            self.tokens.push(Token::Text(text.into()));
        }
        self.pending = end;
    }

    /// Makes a token of the name between `start` and the current position.
    fn name_token(&mut self, start: usize, token: Token) {
        self.flush(start);
        self.tokens.push(token);
        self.pending = self.cursor.at;
    }

    fn enter(&mut self) -> Result<(), FormulaError> {
        self.depth += 1;
        if self.depth > FORMULA_DEPTH {
            return Err(self.cursor.error(
                format!("nested deeper than {FORMULA_DEPTH} levels"),
                "split it with variables",
            ));
        }
        Ok(())
    }

    fn either(&mut self) -> Result<(), FormulaError> {
        self.both()?;
        loop {
            self.cursor.skip_space();
            let column = self.cursor.column();
            if !self.cursor.take_word("or") {
                return Ok(());
            }
            self.both()?;
            self.push(column, Operation::Or);
        }
    }

    fn both(&mut self) -> Result<(), FormulaError> {
        self.negated()?;
        loop {
            self.cursor.skip_space();
            let column = self.cursor.column();
            if !self.cursor.take_word("and") {
                return Ok(());
            }
            self.negated()?;
            self.push(column, Operation::And);
        }
    }

    fn negated(&mut self) -> Result<(), FormulaError> {
        self.cursor.skip_space();
        let column = self.cursor.column();
        if !self.cursor.take_word("not") {
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
        self.cursor.skip_space();
        let column = self.cursor.column();
        let found = COMPARISONS
            .iter()
            .find(|c| self.cursor.rest().starts_with(c.0));
        if let Some(&(text, comparison)) = found {
            self.cursor.at += text.len();
            self.sum()?;
            self.push(column, Operation::Compare(comparison));
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<(), FormulaError> {
        self.product()?;
        while let Some(sign @ ('+' | '-')) = self.cursor.peek() {
            let column = self.cursor.column();
            self.cursor.at += 1;
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
        while let Some(sign @ ('*' | '/')) = self.cursor.peek() {
            let column = self.cursor.column();
            self.cursor.at += 1;
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
        match self.cursor.peek() {
            Some('-') => {
                let column = self.cursor.column();
                self.cursor.at += 1;
                self.unary()?;
                self.push(column, Operation::Negate);
            }
            Some('+') => {
                self.cursor.at += 1;
                self.unary()?;
            }
            _ => self.primary()?,
        }
        self.depth -= 1;
        Ok(())
    }

    fn primary(&mut self) -> Result<(), FormulaError> {
        match self.cursor.peek() {
            Some('(') => {
                self.cursor.at += 1;
                self.either()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => {
                let column = self.cursor.column();
                let constant = self.cursor.constant()?;
                self.push(column, Operation::Constant(constant));
                Ok(())
            }
            Some('?') => self.lost(),
            Some('@') if self.names.by_id => self.variable_by_id(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' || c == '\'' => self.name_or_call(),
            _ => Err(self.cursor.error_here(
                "is not a value",
                "write a number, a measurement, a variable or ( here",
            )),
        }
    }

    fn close(&mut self) -> Result<(), FormulaError> {
        if self.cursor.take(')') {
            Ok(())
        } else {
            Err(self
                .cursor
                .error_here("stands where ) is missing", "close the parenthesis"))
        }
    }

    /// Reads `?47`: a variable that was removed, or whose name stands for another variable.
    fn lost(&mut self) -> Result<(), FormulaError> {
        let (column, start) = (self.cursor.column(), self.cursor.at);
        let variable = id(&mut self.cursor)?.into();
        self.name_token(start, Token::Variable(variable));
        self.push(column, Operation::Variable(variable));
        Ok(())
    }

    /// Reads `@12`: a variable by its id.
    fn variable_by_id(&mut self) -> Result<(), FormulaError> {
        let (column, start) = (self.cursor.column(), self.cursor.at);
        let length = self.cursor.digits(1);
        let number: Option<u32> = self.cursor.rest()[1..1 + length].parse().ok();
        let number =
            number.ok_or_else(|| self.cursor.error_here("is no id", "write @ and a number"))?;
        self.cursor.at += 1 + length;
        self.name_token(start, Token::Variable(number.into()));
        self.push(column, Operation::Variable(number.into()));
        Ok(())
    }

    fn name_or_call(&mut self) -> Result<(), FormulaError> {
        self.cursor.skip_space();
        let (column, start) = (self.cursor.column(), self.cursor.at);
        if self.cursor.take_prefix("measurement") {
            let (name, _) = self.cursor.word()?;
            self.name_token(start, Token::Word(name.clone()));
            self.push(column, Operation::Word(name));
            return Ok(());
        }
        let (name, is_quoted) = self.cursor.word()?;
        let end = self.cursor.at;
        if self.cursor.peek() != Some('(') || is_quoted {
            self.cursor.at = end;
            let (token, operation) = match self.names.variable(&name) {
                Some(id) => (Token::Variable(id), Operation::Variable(id)),
                // `pi` stays part of the text, as numbers do: it names no part.
                None if &*name == PI && !is_quoted => {
                    self.push(column, Operation::Constant(Quantity::plain(consts::PI)));
                    return Ok(());
                }
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
                self.cursor.at += 1;
                let part = self.part(Kind::StretchOrSeam)?;
                match &*name {
                    "length" => Operation::Length(part),
                    _ => Operation::Finished(part),
                }
            }
            "x" | "y" => {
                self.cursor.at += 1;
                Operation::Coordinate(self.part(Kind::Point)?, usize::from(&*name == "y"))
            }
            "distance" => {
                self.cursor.at += 1;
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

    /// Reads the arguments of `angle`: an edge, or two points.
    fn angle(&mut self) -> Result<Operation, FormulaError> {
        self.cursor.at += 1;
        let start = self.cursor.at;
        let state = (self.tokens.len(), self.pending);
        if let Ok(first) = self.part(Kind::Point)
            && self.cursor.take(',')
        {
            return Ok(Operation::AngleBetween(first, self.part(Kind::Point)?));
        }
        self.cursor.at = start;
        self.tokens.truncate(state.0);
        self.pending = state.1;
        Ok(Operation::Angle(self.part(Kind::Stretch)?))
    }

    fn comma(&mut self, hint: &str) -> Result<(), FormulaError> {
        if self.cursor.take(',') {
            return Ok(());
        }
        Err(self
            .cursor
            .error_here("stands where a comma is missing", hint))
    }

    /// Reads `if(condition, value, otherwise)`: only the chosen value will be computed.
    fn condition(&mut self, column: usize) -> Result<(), FormulaError> {
        const HINT: &str = "write if(condition, value, otherwise)";
        self.enter()?;
        self.cursor.at += 1;
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
            self.cursor.at = start;
            let message = format!("{name:?} is not a function");
            return Err(self
                .cursor
                .error(message, format!("use one of {FUNCTION_NAMES}")));
        };
        self.cursor.at += 1;
        let mut count = 1;
        self.either()?;
        while self.cursor.take(',') {
            self.either()?;
            count += 1;
        }
        self.close()?;
        if count < least || count > most {
            self.cursor.at = start;
            let message = format!("{name} is given {count} values");
            let hint = if least == most {
                format!("give it {least}")
            } else {
                format!("give it {least} to {most}")
            };
            return Err(self.cursor.error(message, hint));
        }
        self.push(column, Operation::Call(function, count));
        Ok(())
    }

    /// Reads a part, by its names or ids.
    fn part(&mut self, kind: Kind) -> Result<PartReference, FormulaError> {
        self.cursor.skip_space();
        let start = self.cursor.at;
        let found = if self.names.by_id && self.cursor.rest().starts_with('@') {
            let rest = &self.cursor.rest()[1..];
            let length = rest
                .find(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, ':' | '.' | '_')))
                .unwrap_or(rest.len());
            let part = part_of_ids(&rest[..length])
                .ok_or_else(|| self.cursor.error_here("is no id", "write @ and an id"))?;
            self.cursor.at = start + 1 + length;
            part
        } else {
            let written = Written::read(&mut self.cursor, kind)?;
            let text = &self.cursor.text[start..self.cursor.at];
            let found = self.names.part_of(&written, kind);
            found.unwrap_or_else(|| PartReference::Unknown(text.into()))
        };
        self.name_token(start, Token::Part(found.clone()));
        Ok(found)
    }
}

#[cfg(test)]
mod tests;
