//! The error of this crate.

use std::fmt;

/// Something a character or a garment cannot be made of: where, what, and the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RealtimeError {
    /// Where, as in "ellipsoids\[3\]" or "clip walk, keys\[2\]".
    pub place: String,
    /// What is wrong there.
    pub what: String,
    /// What the person can do.
    pub hint: &'static str,
}

impl RealtimeError {
    pub(crate) fn new(
        place: impl Into<String>,
        what: impl Into<String>,
        hint: &'static str,
    ) -> Self {
        Self {
            place: place.into(),
            what: what.into(),
            hint,
        }
    }
}

impl fmt::Display for RealtimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.place, self.what, self.hint)
    }
}

impl std::error::Error for RealtimeError {}
