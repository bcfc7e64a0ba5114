//! Units and domains of figures.

/// Unit of a figure: in SI, and as the trade tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Sign of the SI unit; empty for a plain number.
    pub si: &'static str,
    /// Sign of the unit shown in the window.
    pub shown: &'static str,
    /// Value of one shown unit in the SI unit.
    pub factor: f64,
}

impl Unit {
    /// A plain number.
    pub const NONE: Self = Self::si("");

    /// A unit that is shown as it is.
    pub const fn si(si: &'static str) -> Self {
        Self {
            si,
            shown: si,
            factor: 1.0,
        }
    }

    /// An SI unit with the unit of the trade and its value in it.
    pub const fn shown_as(si: &'static str, shown: &'static str, factor: f64) -> Self {
        Self { si, shown, factor }
    }
}

/// Numbers for which the laws of cloth are defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// Finite numbers above zero.
    Positive,
    /// Zero and finite numbers above it.
    NotNegative,
    /// Numbers from 0 to 0.95.
    Ratio,
    /// Numbers above zero; infinity stands for no limit.
    Limit,
    /// Numbers from 0 to 1.
    Share,
}

impl Domain {
    /// Whether a number lies in it.
    pub fn contains(self, value: f64) -> bool {
        match self {
            Self::Positive => value > 0.0 && value.is_finite(),
            Self::NotNegative => value >= 0.0 && value.is_finite(),
            Self::Ratio => (0.0..=0.95).contains(&value),
            Self::Limit => value > 0.0,
            Self::Share => (0.0..=1.0).contains(&value),
        }
    }

    /// The remedy for a number outside.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::Positive => "give a number above zero",
            Self::NotNegative => "give zero or a number above it",
            Self::Ratio => "give a number from 0 to 0.95",
            Self::Limit => "give a share above zero as in 0.05, or none",
            Self::Share => "give a share from 0 to 1",
        }
    }
}
