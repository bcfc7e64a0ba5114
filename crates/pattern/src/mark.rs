//! Marks: positions on a line of a panel that survive edits, given by its corners and notches, and by
//! distances from these.

use crate::{CornerName, Name, Number, PointId};
use serde::{Deserialize, Serialize};
use strum::EnumIter;

/// A mark: a position on a line of a panel.
#[derive(Clone, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
pub enum Mark {
    /// The mark is at a notch of the panel.
    Notch(crate::NotchId),
    /// The mark is at a distance from a corner along the line.
    Along {
        /// The corner.
        from: CornerName,
        /// Distance from the corner (m); negative against the direction of the line.
        distance: Number,
    },
    /// The mark is at a share of the way along the line from a corner to a later corner.
    Between {
        /// The corners.
        ends: [CornerName; 2],
        /// Share of the arc length between the corners (1).
        share: Number,
    },
    /// The mark is at a corner.
    Corner(CornerName),
}

impl Default for Mark {
    fn default() -> Self {
        Self::Corner(CornerName::default())
    }
}

impl Mark {
    /// The mark at a drawn point.
    pub fn corner(point: PointId) -> Self {
        Self::Corner(Name::Drawn(point))
    }

    /// The mark at a share of the way between two drawn points.
    pub fn between(ends: [PointId; 2], share: impl Into<Number>) -> Self {
        Self::Between {
            ends: ends.map(Name::Drawn),
            share: share.into(),
        }
    }

    /// The corners by which the mark is placed.
    pub fn corners(&self) -> Vec<CornerName> {
        match self {
            Self::Corner(corner) | Self::Along { from: corner, .. } => vec![*corner],
            Self::Between { ends, .. } => ends.to_vec(),
            Self::Notch(_) => Vec::new(),
        }
    }

    /// The distance or share of the mark. `None`: the mark is a corner or a notch.
    pub fn number(&self) -> Option<&Number> {
        match self {
            Self::Along { distance, .. } => Some(distance),
            Self::Between { share, .. } => Some(share),
            Self::Corner(_) | Self::Notch(_) => None,
        }
    }
}
