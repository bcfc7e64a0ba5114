//! The state of writing a pattern file: unit and names; writes numbers, formulas and tables.

use super::json::{Node, Value};
use super::units::{write_degrees, write_length, write_plain};
use crate::FormatError;
use toile_measure::{Measurements, Origin, is_angle};
use toile_pattern::{DisplayUnit, Names, Number, Pattern, Want};

/// A JSON object being built.
#[derive(Default)]
pub struct Object(pub Vec<(String, Node)>);

/// A value without a position in a text.
pub fn node(value: Value) -> Node {
    Node {
        value,
        line: 0,
        column: 0,
    }
}

impl Object {
    pub fn put(&mut self, name: &str, value: Value) {
        self.0.push((name.to_owned(), node(value)));
    }

    pub fn put_if(&mut self, name: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.put(name, value);
        }
    }

    pub fn done(self) -> Value {
        Value::Object(self.0)
    }

    /// Adds a list, unless it is empty.
    pub fn put_list(&mut self, name: &str, values: Vec<Value>) {
        if !values.is_empty() {
            self.put(name, list(values));
        }
    }
}

pub fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

pub fn list(values: impl IntoIterator<Item = Value>) -> Value {
    Value::List(values.into_iter().map(node).collect())
}

/// A whole number.
pub fn count(number: u32) -> Value {
    Value::Number(number.to_string())
}

/// State of writing a pattern file: everything that the parts of the file share.
pub struct Writer {
    /// Unit of the lengths in the file.
    unit: DisplayUnit,
    /// Names of parts, by which formulas refer to them.
    names: Names,
}

impl Writer {
    /// A writer with the unit and the names of a pattern.
    pub fn new(pattern: &Pattern) -> Self {
        Self {
            unit: pattern.unit,
            names: Names::new(pattern),
        }
    }

    /// A table of measurements.
    pub fn measurements(&self, table: &Measurements) -> Value {
        let mut fields = Object::default();
        for (name, measured) in table.iter() {
            let is_angle = is_angle(name);
            let number = if is_angle {
                angle_value(measured.value)
            } else {
                length_value(measured.value, self.unit)
            };
            if measured.origin == Origin::Predicted {
                let mut predicted = Object::default();
                predicted.put("predicted", number);
                fields.put(name, predicted.done());
            } else {
                fields.put(name, number);
            }
        }
        fields.done()
    }

    /// Writes a number: a value, a formula, an adjusted formula, or one value per size.
    pub fn number(&self, number: &Number, want: Want, place: &str) -> Result<Value, FormatError> {
        let value = |value: f64| -> Result<Value, FormatError> {
            finite(value, place)?;
            Ok(match want {
                Want::Length => length_value(value, self.unit),
                Want::Angle => angle_value(value),
                Want::Plain | Want::Any => plain_value(value),
            })
        };
        Ok(match number {
            Number::Value(own) => value(*own)?,
            Number::Formula(formula) => text(&formula.text(&self.names)),
            Number::Adjusted { formula, by } => {
                let mut fields = Object::default();
                fields.put("formula", text(&formula.text(&self.names)));
                fields.put("by", value(*by)?);
                fields.done()
            }
            Number::PerSize { usual, sizes } => {
                let mut fields = Object::default();
                fields.put("usual", self.number(usual, want, place)?);
                let mut pairs = Vec::new();
                for (size, own) in sizes {
                    pairs.push(list([count(size.0), value(*own)?]));
                }
                fields.put("sizes", list(pairs));
                fields.done()
            }
        })
    }
}

pub fn finite(value: f64, place: &str) -> Result<(), FormatError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(FormatError::new(
        place,
        format!("the number {value} cannot be written"),
        "give it a finite value",
    ))
}

pub fn plain_value(value: f64) -> Value {
    Value::Number(write_plain(value))
}

/// The length in the file's unit if that is exact, else in metres.
fn length_value(value: f64, unit: DisplayUnit) -> Value {
    match write_length(value, unit) {
        Some(raw) => Value::Number(raw),
        None => exactly("m", value),
    }
}

/// The angle in degrees if that is exact, else in radians.
fn angle_value(value: f64) -> Value {
    match write_degrees(value) {
        Some(raw) => Value::Number(raw),
        None => exactly("rad", value),
    }
}

fn exactly(unit: &str, value: f64) -> Value {
    let mut fields = Object::default();
    fields.put(unit, plain_value(value));
    fields.done()
}
