//! Operations: steps that alter a panel (dart, fold, pleat, split), stored in order.

use crate::{CurveId, LineName, Mark, Number, OperationId, PointId, SheetId};
use serde::{Deserialize, Serialize};

/// A kept step of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// Its id.
    pub id: OperationId,
    /// Name to show.
    pub name: String,
    /// Its kind.
    pub kind: OperationKind,
    /// Whether a kink of the edge that runs on across what it makes is meant.
    #[serde(default)]
    pub meant: bool,
}

/// The kinds of operations.
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
        /// Whether it is trued: the edge redrawn so that it runs on smoothly across the mouth once
        /// the dart is closed, its legs equally long.
        #[serde(default)]
        trued: bool,
        /// Whether, trued, it takes just its width from the finished edge: the mouth is narrower by
        /// what truing takes besides.
        #[serde(default)]
        keeps_length: bool,
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
    /// A dart that takes in less, and another that takes in the rest elsewhere: the panel is cut
    /// from the new mouth to where the dart pivots, and one part is turned about that.
    Pivot {
        /// The dart: a dart or a pivot before this operation.
        dart: OperationId,
        /// The line.
        line: LineName,
        /// Where the new mouth opens.
        mouth: Mark,
        /// Plain share of the dart's angle that is moved there, from 0 to 1.
        share: Number,
        /// How far both darts then end before the place they pivot about [m].
        back: Number,
        /// Which part is turned.
        turned: Turned,
        /// The leg the new dart is pressed towards.
        pressed: Pressed,
    },
    /// The panel cut apart along straight cuts and spread: the openings are cloth.
    Spread {
        /// The line.
        line: LineName,
        /// A place on it that stays where it is, and all that hangs together with it.
        held: Mark,
        /// Where it is cut.
        cuts: Vec<SpreadCut>,
        /// How the line goes across an opening.
        bridge: Bridge,
    },
    /// The panel cut in two along a curve: it is not cut itself then, the panels that are its
    /// sides are.
    Split {
        /// The line.
        line: LineName,
        /// The curve, from the line to the line.
        curve: CurveId,
    },
    /// Pleats: the panel is cut along straight lines and cloth is put between that folds under it.
    Pleat {
        /// The line.
        line: LineName,
        /// A place on it that stays where it is, and all that hangs together with it.
        held: Mark,
        /// Where it is folded.
        pleats: Vec<PleatLine>,
        /// How deep a fold goes under [m]: a knife pleat takes twice that of cloth, others four
        /// times.
        depth: Number,
        /// How it is folded.
        kind: PleatKind,
        /// The side of its line that a knife pleat is pressed to: its underlay lies under that.
        pressed: Side,
        /// Whether it is trued: what lies under is cut along the edge that it lies on when it is
        /// folded, else straight across.
        #[serde(default = "is_trued")]
        trued: bool,
    },
    /// Lines of the panel that were drawn on a sheet which lies on the stage before this: holes and
    /// internal lines that name this operation.
    Insert {
        /// The sheet.
        sheet: SheetId,
    },
}

/// Pleats of journals that do not say it are trued.
fn is_trued() -> bool {
    true
}

/// Which part of a panel a pivot turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turned {
    /// The part from the dart along the outline as drawn to the new mouth.
    #[default]
    FromDart,
    /// The part from the new mouth along the outline to the dart.
    ToDart,
}

/// A cut along which a panel is spread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpreadCut {
    /// Its number in the operation, by which what it makes is named: no two have the same.
    pub number: u16,
    /// Where it starts and ends, both on the line.
    pub ends: [Mark; 2],
    /// How far it opens at its start and its end [m]: where that is nothing it is a hinge.
    pub openings: [Number; 2],
}

/// A line along which a panel is pleated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PleatLine {
    /// Its number in the operation, by which what it makes is named: no two have the same.
    pub number: u16,
    /// Where it starts and ends, both on the line.
    pub ends: [Mark; 2],
}

impl PleatLine {
    /// The largest number a pleat may have: the corners of its underlay are counted from ten times
    /// it.
    pub const LARGEST: u16 = u16::MAX / 10 - 1;
}

/// How a pleat is folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PleatKind {
    /// One fold, pressed to one side.
    #[default]
    Knife,
    /// Two folds pressed away from each other: a box stands on the right side.
    Box,
    /// Two folds that meet on the right side.
    Inverted,
}

impl SpreadCut {
    /// The largest number a cut may have: the corners at its openings are counted from four times
    /// it.
    pub const LARGEST: u16 = u16::MAX / 4;
}

/// How an outline goes across an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bridge {
    /// Straight.
    #[default]
    Straight,
    /// In a curve that goes on from both sides.
    Smooth,
}

/// A side of a split panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Left of the curve.
    Left,
    /// Right of it.
    Right,
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
            Self::Pivot {
                mouth, share, back, ..
            } => mouth.number().into_iter().chain([share, back]).collect(),
            Self::Spread { held, cuts, .. } => {
                let of_cuts = cuts.iter().flat_map(|cut| {
                    let marks = cut.ends.iter().filter_map(Mark::number);
                    marks.chain(&cut.openings)
                });
                held.number().into_iter().chain(of_cuts).collect()
            }
            Self::Pleat {
                held,
                pleats,
                depth,
                ..
            } => {
                let marks = pleats.iter().flat_map(|pleat| &pleat.ends);
                let of_pleats = marks.filter_map(Mark::number);
                held.number()
                    .into_iter()
                    .chain(of_pleats)
                    .chain([depth])
                    .collect()
            }
            Self::Split { .. } | Self::Insert { .. } => Vec::new(),
        }
    }

    /// Places of lines it uses.
    pub fn marks(&self) -> Vec<&Mark> {
        match self {
            Self::Dart { mouth, .. } => vec![mouth],
            Self::Diamond { .. } => Vec::new(),
            Self::Fold { ends, .. } => ends.iter().collect(),
            Self::Pivot { mouth, .. } => vec![mouth],
            Self::Spread { held, cuts, .. } => {
                let of_cuts = cuts.iter().flat_map(|cut| &cut.ends);
                std::iter::once(held).chain(of_cuts).collect()
            }
            Self::Pleat { held, pleats, .. } => {
                let of_pleats = pleats.iter().flat_map(|pleat| &pleat.ends);
                std::iter::once(held).chain(of_pleats).collect()
            }
            Self::Split { .. } | Self::Insert { .. } => Vec::new(),
        }
    }

    /// The line it is done on; nothing if it is inside.
    pub fn line(&self) -> Option<LineName> {
        match self {
            Self::Dart { line, .. }
            | Self::Fold { line, .. }
            | Self::Pivot { line, .. }
            | Self::Spread { line, .. }
            | Self::Pleat { line, .. }
            | Self::Split { line, .. } => Some(*line),
            Self::Diamond { .. } | Self::Insert { .. } => None,
        }
    }

    /// The operation whose work it alters.
    pub fn altered(&self) -> Option<OperationId> {
        match self {
            Self::Pivot { dart, .. } => Some(*dart),
            _ => None,
        }
    }

    /// The curve it follows.
    pub fn curve(&self) -> Option<CurveId> {
        match self {
            Self::Split { curve, .. } => Some(*curve),
            _ => None,
        }
    }

    /// The sheet whose lines it brings in.
    pub fn sheet(&self) -> Option<SheetId> {
        match self {
            Self::Insert { sheet } => Some(*sheet),
            _ => None,
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
    /// Whether it redraws an edge across darts that are trued: a dart, or the pivot of one.
    pub fn may_true(&self) -> bool {
        matches!(self, Self::Dart { trued: true, .. } | Self::Pivot { .. })
    }

    /// What it is called.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Dart { .. } | Self::Diamond { .. } => "dart",
            Self::Fold { .. } => "fold",
            Self::Pivot { .. } => "pivot",
            Self::Spread { .. } => "spread",
            Self::Split { .. } => "split",
            Self::Insert { .. } => "insert",
            Self::Pleat { .. } => "pleat",
        }
    }
}
