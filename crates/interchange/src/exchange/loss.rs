//! Contents that a format cannot carry.

use super::Content;
use serde::Serialize;
use std::fmt;

/// Contents of one kind that were left out, because the format has no place for them or this program does not
/// know them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Loss {
    /// The kind of contents, as in "notches".
    pub what: String,
    /// The part of the pattern or the place in the file; empty for the whole of it.
    pub place: String,
    /// Number of things that were left out.
    pub count: usize,
    /// The reason, or what stands in their stead.
    pub why: String,
}

impl Loss {
    /// Why sizes are left out that the format holds: they were not asked for.
    pub const NOT_ASKED_FOR: &str = "not asked for, and not written";

    /// Contents of a whole document that a format has no place for.
    pub fn of(content: Content, count: usize, why: impl Into<String>) -> Self {
        Self {
            what: content.words().to_owned(),
            place: String::new(),
            count,
            why: why.into(),
        }
    }

    /// Something at a place.
    pub fn at(place: impl Into<String>, what: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            place: place.into(),
            count: 1,
            why: why.into(),
        }
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            what,
            place,
            count,
            why,
        } = self;
        if !place.is_empty() {
            write!(f, "{place}: ")?;
        }
        match count {
            1 => write!(f, "{what}")?,
            _ => write!(f, "{what} ({count})")?,
        }
        match why.is_empty() {
            true => Ok(()),
            false => write!(f, ": {why}"),
        }
    }
}
