//! Numbers of the document: a value, a formula, a formula with an adjustment, or a number with own values for
//! some sizes.
//!
//! # Decided with
//! - [`crate::evaluate`] (`numbers.rs`, `quantity`), [`crate::evaluate::Wearer`]: the value for a wearer and
//!   a size;
//! - [`crate::plan`] (`formula_change.rs`, `in_this_size`), [`crate::plan::set_number_in_size`]: a value of
//!   its own in a size;
//! - [`crate::plan`] (`moving.rs`, `added`): a drag shifts all sizes;
//! - [`crate::plan::number_text`], [`crate::plan::read_number`]: numbers shown and typed;
//! - [`crate::grade_rule`], [`crate::plan`] (`grade.rs`): rules that shift points by size;
//! - [`crate::plan::add_size`]: sizes added.
//!
//! Sizes in the window: `tables.rs` (`FIRST` lists what a new one begins with), `canvas/grading.rs`. Chosen
//! by crate `session`, `perform.rs`, `project.rs`. Sizes differ by measurements, by values of their own, or by grade
//! rules, which are variables with values of their own.

use crate::SizeId;
use crate::formula::Formula;
use serde::{Deserialize, Serialize};

/// A number of the document. Its field decides the quantity: lengths are in metres, angles in radians, shares
/// are plain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Number {
    /// A value (m), (rad) or plain.
    Value(f64),
    /// A formula.
    Formula(Formula),
    /// A formula and an adjustment, made by hand, that is added to its value.
    Adjusted {
        /// The formula.
        formula: Formula,
        /// The adjustment (m), (rad) or plain.
        by: f64,
    },
    /// A number that has other values for some sizes.
    PerSize {
        /// The number for all other sizes.
        usual: Box<Number>,
        /// Sizes and their values (m), (rad) or plain.
        sizes: Vec<(SizeId, f64)>,
    },
}

impl Number {
    /// Zero.
    pub const ZERO: Self = Self::Value(0.0);

    /// The value (m), (rad) or plain. `None`: it may depend on measurements or on the size.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Formula(_) | Self::Adjusted { .. } | Self::PerSize { .. } => None,
        }
    }

    /// The formula in the number, if there is one.
    pub fn as_formula(&self) -> Option<&Formula> {
        match self {
            Self::Value(_) => None,
            Self::Formula(formula) | Self::Adjusted { formula, .. } => Some(formula),
            Self::PerSize { usual, .. } => usual.as_formula(),
        }
    }

    /// Whether all values in the number are finite; formulas count as finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Value(value) => value.is_finite(),
            Self::Formula(_) => true,
            Self::Adjusted { by, .. } => by.is_finite(),
            Self::PerSize { usual, sizes } => {
                usual.is_finite() && sizes.iter().all(|(_, value)| value.is_finite())
            }
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

impl From<Formula> for Number {
    fn from(formula: Formula) -> Self {
        Self::Formula(formula)
    }
}
