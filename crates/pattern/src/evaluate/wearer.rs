//! The wearer that a pattern is drafted for: measurements, and the size if it is one of the pattern's.

use crate::{Size, SizeId};
use std::sync::Arc;
use toile_measure::Measurements;

/// The wearer that a pattern is drafted for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wearer {
    /// Measurements of the wearer: lengths (m) and angles (rad).
    pub measurements: Measurements,
    /// The size of the pattern whose measurements the wearer has: numbers take the values that they have for
    /// this size. `None`: the measurements are those of no size.
    pub size: Option<SizeId>,
}

impl From<&Measurements> for Wearer {
    fn from(measurements: &Measurements) -> Self {
        Self {
            measurements: measurements.clone(),
            size: None,
        }
    }
}

impl From<&Size> for Wearer {
    fn from(size: &Size) -> Self {
        Self {
            measurements: size.measurements.clone(),
            size: Some(size.id),
        }
    }
}

impl From<&Arc<Size>> for Wearer {
    fn from(size: &Arc<Size>) -> Self {
        (&**size).into()
    }
}

impl From<&Self> for Wearer {
    fn from(wearer: &Self) -> Self {
        wearer.clone()
    }
}
