//! Operations: kept steps of a panel.

use crate::{LineName, Mark, Number, OperationId, PointId};
use serde::{Deserialize, Serialize};

/// A kept step of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// Its id.
    pub id: OperationId,
    /// Name to show.
    pub name: String,
    /// What is done.
    pub kind: OperationKind,
}

/// What an operation does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum OperationKind {
    /// A dart taken out of a line, which is drawn with the dart's mouth in it.
    Dart {
        /// The line.
        line: LineName,
        /// Where the middle of the mouth is.
        mouth: Mark,
        /// Width of the mouth along the line [m].
        intake: Number,
        /// Where it ends.
        apex: Apex,
        /// The leg it is pressed towards once it is sewn.
        pressed: Pressed,
    },
    /// A dart inside the panel, pointed at both ends.
    Diamond {
        /// Its two ends.
        ends: [PointId; 2],
        /// Plain share of the way where it is widest.
        widest: Number,
        /// Width there [m].
        intake: Number,
    },
    /// The other half: a straight stretch lies on the fold of the cloth, and the piece is the
    /// panel and its mirror image, unfolded.
    Fold {
        /// The line.
        line: LineName,
        /// Both ends of the stretch, in the order of the line.
        ends: [Mark; 2],
    },
}

/// The leg a dart is pressed towards once it is sewn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pressed {
    /// The leg before the apex along the outline as drawn.
    #[default]
    Before,
    /// The leg after it.
    After,
}

impl Pressed {
    /// The leg's number among those the dart makes.
    pub fn leg(self) -> u16 {
        match self {
            Self::Before => 0,
            Self::After => 1,
        }
    }
}

/// Where a dart ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Apex {
    /// So far from the middle of the mouth, square to it [m].
    Depth(Number),
    /// At a point of the panel's sheet.
    Point(PointId),
}

impl OperationKind {
    /// Its numbers.
    pub fn numbers(&self) -> Vec<&Number> {
        match self {
            Self::Dart {
                mouth,
                intake,
                apex,
                ..
            } => {
                let depth = match apex {
                    Apex::Depth(depth) => Some(depth),
                    Apex::Point(_) => None,
                };
                mouth
                    .number()
                    .into_iter()
                    .chain([intake])
                    .chain(depth)
                    .collect()
            }
            Self::Diamond { widest, intake, .. } => vec![widest, intake],
            Self::Fold { ends, .. } => ends.iter().filter_map(Mark::number).collect(),
        }
    }

    /// Places of lines it uses.
    pub fn marks(&self) -> Vec<&Mark> {
        match self {
            Self::Dart { mouth, .. } => vec![mouth],
            Self::Diamond { .. } => Vec::new(),
            Self::Fold { ends, .. } => ends.iter().collect(),
        }
    }

    /// Points of the sheet it uses.
    pub fn points(&self) -> Vec<PointId> {
        match self {
            Self::Dart {
                apex: Apex::Point(point),
                ..
            } => vec![*point],
            Self::Diamond { ends, .. } => ends.to_vec(),
            _ => Vec::new(),
        }
    }
}

impl OperationKind {
    /// What it is called.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Dart { .. } | Self::Diamond { .. } => "dart",
            Self::Fold { .. } => "fold",
        }
    }
}
