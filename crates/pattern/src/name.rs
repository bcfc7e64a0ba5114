//! Names of corners and lines that survive edits: by the part that was drawn, or by the operation that made them.

use crate::{CurveId, EdgeId, LineId, OperationId, PanelId, PartId, PointId};
use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray, VariantNames};

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

impl<Id: Default> Default for Name<Id> {
    fn default() -> Self {
        Self::Drawn(Id::default())
    }
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
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    EnumString,
    IntoStaticStr,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Role {
    /// A leg of a dart: 0 before the apex along the outline, 1 after it; of a diamond 0 to 3.
    #[default]
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
    /// What it is called.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// The role that is called so.
    pub fn of_word(word: &str) -> Option<Self> {
        word.parse().ok()
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
