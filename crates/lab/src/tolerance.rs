//! Tolerances of laws: how near a measured number must be to the expected one.

use serde::Serialize;

/// How near a measured number must be. A law declares all it allows
/// ([`Law::tolerances`](crate::Law::tolerances)), so that they can be read without measuring; its
/// checks take theirs from there, and one with another tolerance fails.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// The quantity measured, with its unit.
    pub quantity: &'static str,
    /// The cases it holds for; empty where it holds for all of the quantity.
    pub cases: &'static str,
    /// What errors are a share of: the expected value, or what stands for it where that is zero.
    pub of: &'static str,
    /// Largest error allowed, as that share.
    pub share: f64,
}

impl Tolerance {
    /// Of a value that is not zero: a share of itself.
    pub const fn value(quantity: &'static str, share: f64) -> Self {
        Self {
            quantity,
            cases: "",
            of: "the expected value",
            share,
        }
    }

    /// Of what must vanish: a share of a scale.
    pub const fn zero(quantity: &'static str, of: &'static str, share: f64) -> Self {
        Self {
            quantity,
            cases: "",
            of,
            share,
        }
    }

    /// The same for some cases alone.
    pub const fn only(self, cases: &'static str) -> Self {
        Self { cases, ..self }
    }
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            quantity,
            cases,
            of,
            share,
        } = self;
        write!(f, "{quantity}: within {share:.1e} of {of}")?;
        if cases.is_empty() {
            return Ok(());
        }
        write!(f, " ({cases})")
    }
}
