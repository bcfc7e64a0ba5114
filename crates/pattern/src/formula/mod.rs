//! Formulas: arithmetic on measurements, variables and drafted lengths.
//!
//! A formula holds the ids of the parts that it names and is printed with their current names, so that
//! renaming a part leaves all formulas unchanged. It is kept in postfix order with jumps, so that computing
//! it needs no recursion, however long it is.
//!
//! # Decided with
//! - [`crate::formula::parse::parse`], [`crate::formula::cursor`]: text read;
//! - [`crate::formula::names::Names`], [`crate::formula::written::Written`], [`crate::formula::by_id`]: names
//!   turned into ids; names of lost parts; ids in journals;
//! - [`crate::formula::compute::compute`]: computed, with lengths kept apart from plain numbers;
//! - [`crate::formula::print`], [`crate::formula::complete`], [`crate::suggest::nearest`]: shown with the
//!   names of the day, completed, suggested;
//! - [`crate::plan`] (`bare.rs`, `bind.rs`): units of bare numbers; names bound once parts exist;
//! - [`crate::evaluate`] (`needs.rs`, `part`): parts that a formula needs;
//! - [`crate::plan`] (`formula_change.rs`, `moving.rs`): what becomes of a formula when its point is dragged.
//!
//! The compiler asks for a new function in `call` of `compute` and `bare`. By hand: `FUNCTIONS` and
//! `FUNCTION_NAMES` in `parse`, `docs/GUIDE.md`, `docs/methods/pattern.md`.

mod by_id;
mod complete;
mod compute;
mod cursor;
mod names;
mod of_variable;
mod parse;
mod plain;
mod print;
mod written;

pub use complete::Completion;
pub(crate) use compute::{Environment, Failure, Quantity, compute, kind};
pub use cursor::is_unit;
pub use names::Names;
pub(crate) use written::Kind;

use crate::{PartId, PartReference, VariableId};
use std::fmt;
use std::sync::Arc;

/// Words that are operators; a part with such a name is written in quotes.
const RESERVED: &[&str] = &["and", "or", "not"];
/// Name of the constant 3.14159..., unless a variable has this name.
pub(crate) const PI: &str = "pi";
/// Longest formula that is accepted (bytes); the name of a part counts as one byte.
pub const FORMULA_LENGTH: usize = 2000;
/// Deepest nesting of parentheses, signs and calls that is accepted.
pub const FORMULA_DEPTH: usize = 50;

/// A parsed formula. Two formulas are equal if they compute the same from the same parts.
#[derive(Clone)]
pub struct Formula {
    tokens: Arc<[Token]>,
    steps: Arc<[Step]>,
}

/// Reason why a text is not a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}; {hint}")]
pub struct FormulaError {
    /// Column of the offending character, from 1.
    pub column: usize,
    /// Description of the fault.
    pub message: String,
    /// Advice on how to remedy the fault.
    pub hint: String,
}

/// A piece of the formula's text, or a name in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Token {
    /// Text as it was written.
    Text(Box<str>),
    /// A variable.
    Variable(VariableId),
    /// A measurement, or a word that was neither a variable nor a measurement when the formula was read.
    Word(Box<str>),
    /// A part that the formula measures.
    Part(PartReference),
}

/// A value that a formula depends on.
pub(crate) enum Use<'f> {
    Variable(VariableId),
    /// A measurement or, if no measurement has this name, a variable that got the name after the formula was
    /// read.
    Word(&'f str),
    Part {
        part: &'f PartReference,
        kind: Kind,
        /// Whether the part is measured after all operations, not as drawn.
        finished: bool,
    },
}

/// One step of a formula in postfix order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    /// Column of the step in the text of the formula, from 1.
    pub column: usize,
    pub operation: Operation,
}

/// Effect of a step on the stack.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Operation {
    /// Pushes a number.
    Constant(Quantity),
    /// Pushes the value of a variable.
    Variable(VariableId),
    /// Pushes the value of a measurement.
    Word(Box<str>),
    Negate,
    Not,
    Add,
    Subtract,
    Multiply,
    Divide,
    Compare(Comparison),
    And,
    Or,
    /// Pops this many arguments and pushes the result of the function.
    Call(Function, usize),
    /// Pushes the length of a part.
    Length(PartReference),
    /// Pushes the length of a stretch after all operations, dart legs left out.
    Finished(PartReference),
    /// Pushes the direction from the start of a part to its end (rad), from +x counter-clockwise.
    Angle(PartReference),
    /// Pushes the direction from one point to another (rad), from +x counter-clockwise.
    AngleBetween(PartReference, PartReference),
    /// Pushes a coordinate of a point: 0 is x, 1 is y.
    Coordinate(PartReference, usize),
    /// Pushes the distance between two points.
    Distance(PartReference, PartReference),
    /// Pops a value; if it is 0, continues at the step with this index.
    JumpUnless(usize),
    /// Continues at the step with this index.
    Jump(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    Less,
    LessOrEqual,
    More,
    MoreOrEqual,
    Equal,
    Unequal,
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
    Round,
}

impl Formula {
    /// Parses a formula and looks up its names in a document.
    ///
    /// Numbers may carry a unit (`mm cm m in deg rad`, and `1 5/8in`); `pi` is 3.14159...; names are
    /// variables or measurements; `length(front.armhole)`, `length(front.side..front.hem)`, `angle`,
    /// `distance`, `x`, `y` measure parts as drawn, `finished` an edge after all operations;
    /// `length('side seam')` measures a seam. `if(a < b, c, d)` chooses, `round(x, 5mm)` rounds. Names that
    /// are not plain words stand in single quotes. `?47` is the part with the id 47, whatever its name is, even
    /// if it was removed.
    ///
    /// # Errors
    /// The text is not a formula. An unknown name is no error: it is kept, and the formula has no value until
    /// a part gets that name.
    pub fn parse(text: &str, names: &Names) -> Result<Self, FormulaError> {
        parse::parse(text, names)
    }

    /// Parses a formula of measurements and numbers alone, without names of parts.
    ///
    /// # Errors
    /// The text is not a formula.
    pub fn of_measurements(text: &str) -> Result<Self, FormulaError> {
        parse::parse(text, &Names::default())
    }

    /// The text of the formula with the current names of its parts.
    pub fn text(&self, names: &Names) -> String {
        self.tokens.iter().map(|token| names.print(token)).collect()
    }

    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The text of the formula as pieces of text and names, in order.
    pub fn tokens(&self) -> &[Token] {
        &self.tokens
    }

    /// All parts that the formula names by their ids.
    pub fn references(&self) -> Vec<PartId> {
        let mut found: Vec<PartId> = Vec::new();
        for token in self.tokens.iter() {
            match token {
                Token::Text(_) | Token::Word(_) => {}
                Token::Variable(id) => found.push((*id).into()),
                Token::Part(part) => found.extend(part.parts()),
            }
        }
        found
    }

    /// All values that the formula depends on.
    pub(crate) fn uses(&self) -> Vec<Use<'_>> {
        let part = |part, kind| Use::Part {
            part,
            kind,
            finished: false,
        };
        let mut uses = Vec::new();
        for step in self.steps.iter() {
            match &step.operation {
                Operation::Variable(id) => uses.push(Use::Variable(*id)),
                Operation::Word(word) => uses.push(Use::Word(word)),
                Operation::Length(a) => uses.push(part(a, Kind::StretchOrSeam)),
                Operation::Finished(part) => uses.push(Use::Part {
                    part,
                    kind: Kind::StretchOrSeam,
                    finished: true,
                }),
                Operation::Angle(a) => uses.push(part(a, Kind::Stretch)),
                Operation::Coordinate(a, _) => uses.push(part(a, Kind::Point)),
                Operation::AngleBetween(a, b) | Operation::Distance(a, b) => {
                    uses.extend([part(a, Kind::Point), part(b, Kind::Point)]);
                }
                Operation::Constant(_)
                | Operation::Negate
                | Operation::Not
                | Operation::Add
                | Operation::Subtract
                | Operation::Multiply
                | Operation::Divide
                | Operation::Compare(_)
                | Operation::And
                | Operation::Or
                | Operation::Call(..)
                | Operation::JumpUnless(_)
                | Operation::Jump(_) => {}
            }
        }
        uses
    }

    /// Parts that names in the formula now stand for, although no part had these names when the formula was
    /// read.
    pub(crate) fn found_by_name(&self, names: &Names) -> Vec<PartId> {
        let found = self.uses().into_iter().flat_map(|used| match used {
            Use::Word(word) if !names.is_measurement(word) => {
                names.variable(word).into_iter().map(PartId::from).collect()
            }
            Use::Part {
                part: PartReference::Unknown(text),
                kind,
                ..
            } => names.part(text, kind).map_or(Vec::new(), |p| p.parts()),
            Use::Variable(_) | Use::Word(_) | Use::Part { .. } => Vec::new(),
        });
        found.collect()
    }

    /// The formula with every name replaced by the result of `map`, for pasting it elsewhere.
    #[must_use]
    pub fn mapped(&self, map: &mut impl FnMut(&Token) -> Token) -> Self {
        let tokens: Arc<[Token]> = self.tokens.iter().map(&mut *map).collect();
        let mut part = |reference: &PartReference| match map(&Token::Part(reference.clone())) {
            Token::Part(part) => part,
            other @ (Token::Text(_) | Token::Variable(_) | Token::Word(_)) => {
                PartReference::Unknown(format!("{other:?}").into())
            }
        };
        let mut steps: Vec<Step> = self.steps.to_vec();
        for step in &mut steps {
            match &mut step.operation {
                Operation::Length(r)
                | Operation::Finished(r)
                | Operation::Angle(r)
                | Operation::Coordinate(r, _) => *r = part(r),
                Operation::Distance(a, b) | Operation::AngleBetween(a, b) => {
                    *a = part(a);
                    *b = part(b);
                }
                Operation::Variable(_)
                | Operation::Word(_)
                | Operation::Constant(_)
                | Operation::Negate
                | Operation::Not
                | Operation::Add
                | Operation::Subtract
                | Operation::Multiply
                | Operation::Divide
                | Operation::Compare(_)
                | Operation::And
                | Operation::Or
                | Operation::Call(..)
                | Operation::JumpUnless(_)
                | Operation::Jump(_) => {}
            }
        }
        for step in &mut steps {
            if let Operation::Variable(id) = step.operation
                && let Token::Variable(new) = map(&Token::Variable(id))
            {
                step.operation = Operation::Variable(new);
            }
        }
        Self {
            tokens,
            steps: steps.into(),
        }
    }
}

/// A name as it is written in formulas: in quotes unless it is a plain word.
pub(crate) fn quoted(name: &str) -> String {
    let plain = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !RESERVED.contains(&name);
    if plain {
        name.to_owned()
    } else {
        format!("'{name}'")
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.tokens, &other.tokens) || self.tokens == other.tokens
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Formula({:?})", self.tokens)
    }
}

impl serde::Serialize for Formula {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text(&Names::by_id()))
    }
}

impl<'de> serde::Deserialize<'de> for Formula {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text, &Names::by_id()).map_err(serde::de::Error::custom)
    }
}
