//! Names of corners and lines that survive edits: by the drawn part, or by the operation that made them.

use crate::{CurveId, EdgeId, LineId, OperationId, PanelId, PartId, PointId};
use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray, VariantNames};

/// Name of a corner, edge or line of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Name<Id> {
    /// The part is drawn: a point, an edge or a line of the document.
    Drawn(Id),
    /// The part was made by an operation.
    Made {
        /// The operation.
        by: OperationId,
        /// Role of the part in that operation.
        role: Role,
        /// Number among the parts that have this role in the operation, from 0 in the order of the outline.
        index: u16,
    },
}

impl<Id: Default> Default for Name<Id> {
    fn default() -> Self {
        Self::Drawn(Id::default())
    }
}

impl<Id> Name<Id> {
    /// The operation that made the part. `None`: the part is drawn.
    pub fn maker(&self) -> Option<OperationId> {
        match self {
            Self::Drawn(_) => None,
            Self::Made { by, .. } => Some(*by),
        }
    }

    /// Role of the part in the operation that made it. `None`: the part is drawn.
    pub fn role(&self) -> Option<Role> {
        match self {
            Self::Drawn(_) => None,
            Self::Made { role, .. } => Some(*role),
        }
    }
}

/// Name of a corner of a panel.
pub type CornerName = Name<PointId>;
/// Name of an edge of a panel.
pub type EdgeName = Name<EdgeId>;
/// Name of a line of a panel.
pub type LineName = Name<LineId>;

/// Role of a corner, edge or line in the operation that made it.
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
    /// A leg of a dart: 0 before the apex along the outline, 1 after it; 0 to 3 round a diamond dart.
    #[default]
    Leg,
    /// The apex of a dart.
    Apex,
    /// An end of a dart's mouth: 0 before the apex, 1 after it.
    Mouth,
    /// The hole of a diamond dart.
    Diamond,
    /// Edges that bridge the openings of a spread panel: cut n has opening 2n at its start and 2n + 1 at its
    /// end. Opening k has the corners 2k and 2k + 1.
    Opening,
    /// The cut of a split panel, with corners 0 and 1 at its start and end. On one side panel the cut is edge
    /// 0; on the other side panel it runs in the other direction and is edge 1.
    Split,
    /// Edges and corners of the underlay of a pleat, at the ends of the pleat line. Pleat n has edges 8n to
    /// 8n + 3 at the start of its line, from one part of the panel to the other, and 8n + 4 to 8n + 7 at the
    /// end; and corners 10n to 10n + 4 at the start and 10n + 5 to 10n + 9 at the end.
    Underlay,
    /// A line along which a pleat is folded. Pleat n has lines 5n to 5n + 4, from one part of the panel to
    /// the other.
    Crease,
    /// A line to which a fold of a pleat is laid; numbered like creases.
    Placement,
}

impl Role {
    /// Word of the role in files and formulas.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// The role with this word.
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
    /// The stretch of a panel's line from one corner to a later one.
    Stretch {
        /// The panel.
        panel: PanelId,
        /// Corners at the ends of the stretch.
        ends: [CornerName; 2],
    },
    /// A seam.
    Seam(crate::SeamId),
    /// A text that names no part of the document as it was read.
    Unknown(Box<str>),
}

impl PartReference {
    /// The part itself; for a stretch, its panel and the parts that the names of its corners contain.
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
