//! A table of measurements: names to values, each asked for or predicted.

use crate::catalogue::definition;
use crate::measurement::UnitKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The origin of a value in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Someone measured it or asked for it.
    #[default]
    Asked,
    /// The program filled it in from the others.
    Predicted,
}

/// One value of a table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The value (m) or (rad).
    pub value: f64,
    /// Asked for or predicted.
    pub origin: Origin,
}

/// Why a value was not taken into a table. The table is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeasureError {
    /// The name is not snake_case.
    #[error(
        "measurement name {0:?} is not lower-case letters, digits and underscores starting with a letter: rename it, for example to waist_line"
    )]
    Name(String),
    /// The value is infinite or not a number.
    #[error("measurement {name} is {value}: give a finite number")]
    NotFinite {
        /// The measurement.
        name: String,
        /// The value refused.
        value: f64,
    },
}

/// An ordered table of measurements in SI units: metres, and radians for angles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(
    try_from = "BTreeMap<String, Measured>",
    into = "BTreeMap<String, Measured>"
)]
pub struct Measurements {
    entries: BTreeMap<String, Measured>,
}

impl TryFrom<BTreeMap<String, Measured>> for Measurements {
    type Error = MeasureError;

    fn try_from(entries: BTreeMap<String, Measured>) -> Result<Self, MeasureError> {
        let mut table = Self::new();
        for (name, measured) in entries {
            table.set(&name, measured.value, measured.origin)?;
        }
        Ok(table)
    }
}

impl From<Measurements> for BTreeMap<String, Measured> {
    fn from(table: Measurements) -> Self {
        table.entries
    }
}

impl Measurements {
    /// An empty table.
    pub fn new() -> Self {
        Self::default()
    }

    /// The value of a measurement (m) or (rad), by its own name or by an alias of the catalogue.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.measured(name).map(|measured| measured.value)
    }

    /// Value and origin of a measurement, by its own name or by an alias of the catalogue.
    pub fn measured(&self, name: &str) -> Option<Measured> {
        self.entries
            .get(name)
            .or_else(|| self.entries.get(definition(name)?.name))
            .copied()
    }

    /// Whether the table has the measurement.
    pub fn contains(&self, name: &str) -> bool {
        self.measured(name).is_some()
    }

    /// Puts a value (m) or (rad) into the table, in place of the one with the same name. An alias
    /// of the catalogue is stored under the catalogue's name.
    pub fn set(&mut self, name: &str, value: f64, origin: Origin) -> Result<(), MeasureError> {
        if !is_name(name) {
            return Err(MeasureError::Name(name.chars().take(80).collect()));
        }
        if !value.is_finite() {
            return Err(MeasureError::NotFinite {
                name: name.to_owned(),
                value,
            });
        }
        let name = definition(name).map_or(name, |known| known.name);
        self.entries
            .insert(name.to_owned(), Measured { value, origin });
        Ok(())
    }

    /// Takes a value out of the table and returns it.
    pub fn remove(&mut self, name: &str) -> Option<Measured> {
        self.entries.remove(name)
    }

    /// Every entry, in the order of names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Measured)> {
        self.entries
            .iter()
            .map(|(name, &measured)| (name.as_str(), measured))
    }

    /// The first entry that nobody measures: a length of zero or less (m).
    pub fn impossible(&self) -> Option<(&str, f64)> {
        let is_length = |name: &str| definition(name).is_none_or(|d| d.kind == UnitKind::Length);
        let mut all = self.iter();
        all.find(|(name, measured)| is_length(name) && measured.value <= 0.0)
            .map(|(name, measured)| (name, measured.value))
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is no entry.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// This table with every entry of `other` put over it.
    pub fn overlaid(&self, other: &Self) -> Self {
        let mut result = self.clone();
        result
            .entries
            .extend(other.entries.iter().map(|(k, &v)| (k.clone(), v)));
        result
    }
}

/// Whether `name` may name a measurement: snake_case, at most 64 characters.
fn is_name(name: &str) -> bool {
    name.len() <= 64
        && name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_bad_names_and_values_and_stays_unchanged() {
        let mut table = Measurements::new();
        assert!(table.set("Waist", 0.8, Origin::Asked).is_err());
        assert!(table.set("", 0.8, Origin::Asked).is_err());
        assert!(table.set("1st", 0.8, Origin::Asked).is_err());
        assert!(table.set(&"a".repeat(65), 0.8, Origin::Asked).is_err());
        assert!(table.set("waist", f64::NAN, Origin::Asked).is_err());
        assert!(table.set("waist", f64::INFINITY, Origin::Asked).is_err());
        assert!(table.is_empty());
        table.set("waist", 0.8, Origin::Asked).unwrap();
        assert_eq!(table.get("waist"), Some(0.8));
    }

    #[test]
    fn a_length_is_above_zero_and_an_angle_may_be_anything() {
        let mut table = Measurements::adult();
        table.set("shoulder_incl", -0.1, Origin::Asked).unwrap();
        assert_eq!(table.impossible(), None);
        table.set("waist", -0.7, Origin::Asked).unwrap();
        assert_eq!(table.impossible(), Some(("waist", -0.7)));
        table.set("collar", 0.0, Origin::Asked).unwrap();
        assert_eq!(table.impossible(), Some(("collar", 0.0)));
    }

    #[test]
    fn aliases_reach_the_same_entry() {
        let mut table = Measurements::new();
        table.set("waist_circ", 0.8, Origin::Predicted).unwrap();
        assert_eq!(table.get("waist"), Some(0.8));
        assert_eq!(table.get("waist_circ"), Some(0.8));
        assert_eq!(table.len(), 1);
    }

    #[test]
    fn an_overlay_wins_and_keeps_the_rest() {
        let base = Measurements::adult();
        let mut over = Measurements::new();
        over.set("bust", 1.1, Origin::Asked).unwrap();
        let both = base.overlaid(&over);
        assert_eq!(both.get("bust"), Some(1.1));
        assert_eq!(both.get("hips"), base.get("hips"));
        assert_eq!(both.len(), base.len());
    }
}
