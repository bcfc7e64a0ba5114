//! Numbers of the document: a value or a formula.

use crate::formula::{Formula, FormulaError};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number of the document. What it measures is decided by where it stands: lengths are metres,
/// angles radians, fractions plain.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A value [m], [rad] or plain.
    Value(f64),
    /// A formula of measurements and variables.
    Formula(Formula),
}

impl Number {
    /// Zero.
    pub const ZERO: Self = Self::Value(0.0);

    /// Reads a formula.
    pub fn formula(text: &str) -> Result<Self, FormulaError> {
        Formula::parse(text).map(Self::Formula)
    }

    /// The value, if the number is not a formula [m], [rad] or plain.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Formula(_) => None,
        }
    }
}

impl Default for Number {
    fn default() -> Self {
        Self::ZERO
    }
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Value(value) => serializer.serialize_f64(*value),
            Self::Formula(formula) => serializer.serialize_str(formula.text()),
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Raw {
            Value(f64),
            Text(String),
        }
        match Raw::deserialize(deserializer)? {
            Raw::Value(value) => Ok(Self::Value(value)),
            Raw::Text(text) => Self::formula(&text).map_err(serde::de::Error::custom),
        }
    }
}
