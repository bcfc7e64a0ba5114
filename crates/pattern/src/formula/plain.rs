//! Formulas of plain numbers, such as tables of other programs have: without lengths and parts.

use super::compute::{Environment, Failure, Quantity, compute};
use super::{Formula, FormulaError, Token};
use crate::{Code, PartReference, VariableId};
use toile_geometry::Vec2;

/// Environment in which words have plain values from a table, and no other names have values.
struct Words<F>(F);

impl<F: Fn(&str) -> Option<f64>> Environment for Words<F> {
    fn variable(&self, _: VariableId) -> Result<Quantity, Failure> {
        Err(no_part())
    }

    fn measurement(&self, name: &str) -> Result<Quantity, Failure> {
        (self.0)(name).map(Quantity::plain).ok_or_else(|| {
            Failure::new(
                Code::Formula,
                format!("nothing is called {name:?}"),
                "correct the name, or give it a value",
            )
        })
    }

    fn length(&self, _: &PartReference) -> Result<f64, Failure> {
        Err(no_part())
    }

    fn finished(&self, _: &PartReference) -> Result<f64, Failure> {
        Err(no_part())
    }

    fn ends(&self, _: &PartReference) -> Result<[Vec2; 2], Failure> {
        Err(no_part())
    }

    fn point(&self, _: &PartReference) -> Result<Vec2, Failure> {
        Err(no_part())
    }
}

fn no_part() -> Failure {
    let hint = "write numbers and names of measurements alone";
    Failure::new(Code::Formula, "there are no parts to measure here", hint)
}

impl Formula {
    /// The words that the formula names, in the order of its text.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.tokens().iter().filter_map(|token| match token {
            Token::Word(word) => Some(&**word),
            Token::Text(_) | Token::Variable(_) | Token::Part(_) => None,
        })
    }

    /// The value of the formula with plain numbers as the values of its words, as in a table with a single
    /// unit.
    ///
    /// # Errors
    /// A word has no number; the formula names a part or has a number with a unit of length; the result is
    /// not finite.
    pub fn plain_value(&self, word: impl Fn(&str) -> Option<f64>) -> Result<f64, FormulaError> {
        match compute(self, &Words(word)) {
            Ok(Quantity {
                value, power: 0, ..
            }) => Ok(value),
            Ok(_) => Err(FormulaError {
                column: 1,
                message: "it has a unit of its own".to_owned(),
                hint: "write numbers in the unit of the file, without units".to_owned(),
            }),
            Err(Failure::Fault {
                column,
                message,
                hint,
                ..
            }) => Err(FormulaError {
                column: column.unwrap_or(1),
                message,
                hint,
            }),
            Err(Failure::Reported(_)) => Err(FormulaError {
                column: 1,
                message: "something it needs has no value".to_owned(),
                hint: "correct that first".to_owned(),
            }),
        }
    }
}
