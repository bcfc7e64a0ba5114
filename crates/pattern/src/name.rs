//! Names of places that survive edits: corners and lines by the part that was drawn, or by the
//! operation that made them; places along a line by these.

use crate::{CurveId, EdgeId, LineId, Number, OperationId, PanelId, PartId, PointId};
use serde::{Deserialize, Serialize};

/// A corner, edge or line of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Name<Id> {
    /// Drawn: a point, an edge or a line of the document.
    Drawn(Id),
    /// Made by an operation.
    Made {
        /// The operation.
        by: OperationId,
        /// What it is in that operation.
        role: Role,
        /// Which of several, from 0 in the order of the outline.
        index: u16,
    },
}

impl<Id> Name<Id> {
    /// The operation that made it; nothing if it was drawn.
    pub fn maker(&self) -> Option<OperationId> {
        match self {
            Self::Drawn(_) => None,
            Self::Made { by, .. } => Some(*by),
        }
    }

    /// What it is in the operation that made it; nothing if it was drawn.
    pub fn role(&self) -> Option<Role> {
        match self {
            Self::Drawn(_) => None,
            Self::Made { role, .. } => Some(*role),
        }
    }
}

/// A corner of a panel.
pub type CornerName = Name<PointId>;
/// An edge of a panel.
pub type EdgeName = Name<EdgeId>;
/// A line of a panel.
pub type LineName = Name<LineId>;

/// What a made corner, edge or line is in its operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A leg of a dart: 0 before the apex along the outline, 1 after it; of a diamond 0 to 3.
    Leg,
    /// The apex of a dart.
    Apex,
    /// An end of a dart's mouth: 0 before the apex, 1 after it.
    Mouth,
    /// The hole of a diamond dart.
    Diamond,
    /// What bridges an opening of a spread panel: that of cut n is 2n where the cut starts and
    /// 2n + 1 where it ends. Opening k has the corners 2k and 2k + 1.
    Opening,
    /// Where a panel was split: corners 0 and 1 at the start and the end of the cut, which is edge
    /// 0 of one side and, the other way, edge 1 of the other.
    Split,
    /// The underlay of a pleat where its line starts or ends: of pleat n edges 8n to 8n + 3 from
    /// one part to the other where it starts, 8n + 4 to 8n + 7 where it ends, and likewise corners
    /// 10n to 10n + 4 and 10n + 5 to 10n + 9.
    Underlay,
    /// A line a pleat is folded in: of pleat n lines 5n to 5n + 4 from one part to the other.
    Crease,
    /// A line that a fold of a pleat is laid to, numbered as creases are.
    Placement,
}

impl Role {
    const WORDS: [(Self, &'static str); 9] = [
        (Self::Leg, "leg"),
        (Self::Apex, "apex"),
        (Self::Mouth, "mouth"),
        (Self::Diamond, "diamond"),
        (Self::Opening, "opening"),
        (Self::Split, "split"),
        (Self::Underlay, "underlay"),
        (Self::Crease, "crease"),
        (Self::Placement, "placement"),
    ];

    /// What it is called.
    pub fn word(self) -> &'static str {
        let found = Self::WORDS.iter().find(|(role, _)| *role == self);
        found.map_or("", |(_, word)| word)
    }

    /// The role that is called so.
    pub fn of_word(word: &str) -> Option<Self> {
        let found = Self::WORDS.iter().find(|(_, known)| *known == word);
        found.map(|(role, _)| *role)
    }
}

/// A place on a line of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Mark {
    /// A corner.
    Corner(CornerName),
    /// Where a notch of the panel is.
    Notch(crate::NotchId),
    /// At a distance from a corner along the line, against it if negative [m].
    Along {
        /// The corner.
        from: CornerName,
        /// How far [m].
        distance: Number,
    },
    /// A share of the way along the line from a corner to one that follows.
    Between {
        /// The corners.
        ends: [CornerName; 2],
        /// Plain share of the arc length.
        share: Number,
    },
}

impl Mark {
    /// At a drawn point.
    pub fn corner(point: PointId) -> Self {
        Self::Corner(Name::Drawn(point))
    }

    /// A share of the way between two drawn points.
    pub fn between(ends: [PointId; 2], share: impl Into<Number>) -> Self {
        Self::Between {
            ends: ends.map(Name::Drawn),
            share: share.into(),
        }
    }

    /// The corners it is placed by.
    pub fn corners(&self) -> Vec<CornerName> {
        match self {
            Self::Corner(corner) | Self::Along { from: corner, .. } => vec![*corner],
            Self::Between { ends, .. } => ends.to_vec(),
            Self::Notch(_) => Vec::new(),
        }
    }

    /// Its number, if it has one.
    pub fn number(&self) -> Option<&Number> {
        match self {
            Self::Along { distance, .. } => Some(distance),
            Self::Between { share, .. } => Some(share),
            Self::Corner(_) | Self::Notch(_) => None,
        }
    }
}

/// A part that a formula measures.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum PartReference {
    /// A point of a sheet.
    Point(PointId),
    /// A curve of a sheet.
    Curve(CurveId),
    /// The stretch of a panel's line from a corner to one that follows it.
    Stretch {
        /// The panel.
        panel: PanelId,
        /// Its corners.
        ends: [CornerName; 2],
    },
    /// A seam.
    Seam(crate::SeamId),
    /// A text that names nothing.
    Unknown(Box<str>),
}

impl PartReference {
    /// The part itself; of a stretch its panel and what its corners are named by.
    pub fn parts(&self) -> Vec<PartId> {
        match self {
            Self::Point(id) => vec![(*id).into()],
            Self::Curve(id) => vec![(*id).into()],
            Self::Seam(id) => vec![(*id).into()],
            Self::Unknown(_) => Vec::new(),
            Self::Stretch { panel, ends } => {
                let corners = ends.iter().map(|end| match end {
                    Name::Drawn(id) => PartId::from(*id),
                    Name::Made { by, .. } => (*by).into(),
                });
                std::iter::once((*panel).into()).chain(corners).collect()
            }
        }
    }
}
