//! Operations: steps that alter a panel (dart, fold, pleat, split), stored in order.
//!
//! # Decided with
//! - [`crate::stage`]: the geometry, a file for each operation;
//! - [`crate::evaluate`] (`operations.rs`, `done`, `reshape.rs`): numbers evaluated and handed to the
//!   geometry, with faults;
//! - [`crate::drafting`] (`closing`): edges that a seam of the draft closes;
//! - [`crate::document::panel::Panel::is_altered`] (`lineage.rs`),
//!   [`crate::document::panel::Panel::is_split`] (`lineage.rs`): whether it moves parts of the panel or
//!   divides it;
//! - [`crate::evaluate`] (`operations.rs`, `keeps_outline`): whether it leaves the outline as it was;
//! - [`crate::plan::add_operation`]: operations put, moved and removed; folds come last;
//! - [`crate::plan`] (`reshape.rs`, `split.rs`, `on_panel.rs`): wishes turned into operations;
//! - [`crate::press::press_arrows`], [`crate::kinks`]: arrows of what is pressed; kinks that it leaves.
//!
//! The compiler asks in all of these but `is_altered` and `is_split`, which name kinds by hand. By hand, too:
//! a tool of the window, its choices in the inspector, `interchange/tests/suite/operation_table.rs`,
//! `pattern/tests/suite/plans`.

use crate::fields::{Choice, Clash, Told, ValueField, group, key, length, plain};
use crate::{CurveId, LineName, Mark, Number, OperationId, PointId, SheetId, fields};
use serde::{Deserialize, Serialize};
use strum::{EnumIter, IntoStaticStr, VariantArray, VariantNames};

/// One operation of a panel, as the document stores it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// Identifier of the operation.
    pub id: OperationId,
    /// Name to show.
    pub name: String,
    /// Kind of operation, with its settings.
    pub kind: OperationKind,
    /// Whether a kink is intended in the edge that continues across the dart, pleat or split.
    #[serde(default)]
    pub meant: bool,
}

fields!(Operation, |self, v| {
    let Self {
        id,
        name,
        kind,
        meant,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.flat(kind);
    v.value(key("meant").left_out_if(!*meant), meant);
});

/// The kinds of operations.
#[derive(
    Clone, Debug, PartialEq, EnumIter, IntoStaticStr, VariantNames, Serialize, Deserialize,
)]
#[strum(serialize_all = "snake_case")]
pub enum OperationKind {
    /// A dart that opens in a line of the panel. The line as drawn includes the mouth of the dart.
    Dart {
        /// The line that the dart opens in.
        line: LineName,
        /// Position of the middle of the mouth.
        mouth: Mark,
        /// Width of the mouth along the line (m).
        intake: Number,
        /// The end of the dart inside the panel.
        apex: Apex,
        /// The leg towards which the dart is pressed once it is sewn.
        pressed: Pressed,
        /// Whether the dart is trued: the edge is redrawn so that it is smooth across the mouth of the closed
        /// dart, and the legs become equally long.
        #[serde(default)]
        trued: bool,
        /// Whether truing keeps the length: the finished edge is then shorter by the intake alone, as the
        /// mouth is made narrower by the length that truing takes in addition.
        #[serde(default)]
        keeps_length: bool,
    },
    /// A dart inside the panel, pointed at both ends (fish-eye dart).
    Diamond {
        /// Both ends of the dart.
        ends: [PointId; 2],
        /// Place at which the dart is widest, as a share of the way between its ends (1).
        widest: Number,
        /// Width of the dart at its widest place (m).
        intake: Number,
    },
    /// The panel is half of its piece: a straight stretch of a line lies on the fold of the cloth, and the
    /// piece is the panel together with its mirror image.
    Fold {
        /// The line that the stretch is on.
        line: LineName,
        /// Both ends of the stretch, in the order of the line.
        ends: [Mark; 2],
    },
    /// Part of a dart's intake is moved to a second dart at another place, by the pivot method: the panel is
    /// cut from the new mouth to the dart's pivot point, and one part of the panel is turned about that
    /// point.
    Pivot {
        /// The operation that made the dart to be made smaller: an earlier dart or pivot.
        dart: OperationId,
        /// The line that the new mouth opens in.
        line: LineName,
        /// Position of the new mouth.
        mouth: Mark,
        /// Share of the dart's angle that is moved to the new dart, from 0 to 1.
        share: Number,
        /// Distance from the pivot point at which both darts end after the pivot (m).
        back: Number,
        /// The part of the panel that is turned.
        turned: Turned,
        /// The leg towards which the new dart is pressed.
        pressed: Pressed,
    },
    /// The panel is cut along straight cuts and spread; the openings are filled with cloth.
    Spread {
        /// The line that the cuts cross.
        line: LineName,
        /// A place on the line that stays fixed, with the part of the panel connected to that place.
        held: Mark,
        /// The cuts along which the panel is opened.
        cuts: Vec<SpreadCut>,
        /// Shape of the line across each opening.
        bridge: Bridge,
    },
    /// The panel is cut in two along a curve. Two other panels, its sides, are then cut from cloth instead of
    /// the panel.
    Split {
        /// The line on which the cut starts and ends.
        line: LineName,
        /// The curve of the cut, which starts and ends on the line.
        curve: CurveId,
    },
    /// Holes and internal lines are inserted into the panel. They are drawn on a sheet that lies on the panel
    /// as it is before this operation, and each names this operation.
    Insert {
        /// The sheet with the lines.
        sheet: SheetId,
    },
    /// Pleats: the panel is cut along straight lines, and cloth is inserted there that folds under the panel.
    Pleat {
        /// The line that the cuts cross.
        line: LineName,
        /// A place on the line that stays fixed, with the part of the panel connected to that place.
        held: Mark,
        /// The lines along which the panel is pleated.
        pleats: Vec<PleatLine>,
        /// Depth of a fold under the cloth (m): a knife pleat takes twice that length of cloth, other pleats
        /// take four times that length.
        depth: Number,
        /// Kind of pleat.
        kind: PleatKind,
        /// For a knife pleat, the side of its pleat line to which it is pressed: the underlay lies under that
        /// side.
        pressed: Side,
        /// Whether the pleats are trued: the end of each underlay is cut along the edge that it lies under
        /// when folded. If they are not trued, it is cut straight across.
        #[serde(default = "is_trued")]
        trued: bool,
    },
}

impl Default for OperationKind {
    fn default() -> Self {
        Self::Insert {
            sheet: SheetId::default(),
        }
    }
}

fields!(
    OperationKind,
    |self, v| {
        let own = group(self.key());
        match self {
            Self::Dart { line, mouth, intake, apex, pressed, trued, keeps_length } => v.object(own, &mut |v| {
                v.part(group("line"), line);
                v.mark(group("mouth"), mouth);
                v.number(length("intake"), intake);
                v.flat(apex);
                v.value(key("pressed").left_out_if(*pressed == Pressed::default()), pressed);
                v.value(key("trued").left_out_if(!*trued), trued);
                v.value(key("keeps_length").left_out_if(!*keeps_length), keeps_length);
            }),
            Self::Diamond { ends: [from, to], widest, intake } => v.object(own, &mut |v| {
                v.list(group("ends"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
                v.number(plain("widest").label("widest at").shown_last(), widest);
                v.number(length("intake"), intake);
            }),
            Self::Fold { line, ends: [from, to] } => v.object(own, &mut |v| {
                v.part(group("line"), line);
                v.mark(group("from").label("start"), from);
                v.mark(group("to").label("end"), to);
            }),
            Self::Pivot { dart, line, mouth, share, back, turned, pressed } => v.object(own, &mut |v| {
                v.id("dart", dart);
                v.part(group("line"), line);
                v.mark(group("mouth"), mouth);
                v.number(plain("share").label("part moved").means(1.0), share);
                v.number(length("back").label("set back").left_out_at(0.0), back);
                v.value(key("turned").left_out_if(*turned == Turned::default()), turned);
                v.value(key("pressed").left_out_if(*pressed == Pressed::default()), pressed);
            }),
            Self::Spread { line, held, cuts, bridge } => v.object(own, &mut |v| {
                v.part(group("line"), line);
                v.mark(group("held").label("held at"), held);
                v.each(group("cuts"), cuts);
                v.value(key("bridge").left_out_if(*bridge == Bridge::default()), bridge);
            }),
            Self::Split { line, curve } => v.object(own, &mut |v| {
                v.part(group("line"), line);
                v.id("curve", curve);
            }),
            Self::Insert { sheet } => v.object(own, &mut |v| v.id("sheet", sheet)),
            Self::Pleat { line, held, pleats, depth, kind, pressed, trued } => v.object(own, &mut |v| {
                v.part(group("line"), line);
                v.mark(group("held").label("held at"), held);
                v.each(group("pleats"), pleats);
                v.number(length("depth").shown_first(), depth);
                v.value(key("kind"), kind);
                v.value(key("pressed").left_out_if(*pressed == Side::default()), pressed);
                v.value(key("trued").left_out_if(*trued).flag_if_absent(true), trued);
            }),
        }
    },
    kinds: |kind| Told::Field(kind.key()),
    clash: Clash {
        none: Some([
            "the operation is none that this version knows".into(),
            format!("give it one of {}, or use a newer version", OperationKind::VARIANTS.join(", ")),
        ]),
        ..Clash::default()
    },
);

/// Value of `trued` for pleats in journals that lack this field.
fn is_trued() -> bool {
    true
}

/// The part of a panel that a pivot turns.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Turned {
    /// The part along the outline, as drawn, from the dart to the new mouth.
    #[default]
    FromDart,
    /// The part along the outline, as drawn, from the new mouth to the dart.
    ToDart,
}

/// A cut along which a panel is spread.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SpreadCut {
    /// Number of the cut, unique in the operation; names of the edges and corners that the cut makes contain
    /// it.
    pub number: u16,
    /// Start and end of the cut, both on the line.
    pub ends: [Mark; 2],
    /// Opening of the cut at its start and at its end (m); an end with opening 0 is a hinge.
    pub openings: [Number; 2],
}

fields!(SpreadCut, |self, v| {
    let Self {
        number,
        ends: [from, to],
        openings: [start, end],
    } = self;
    v.value(key("number").at_most(SpreadCut::LARGEST), number);
    v.mark(group("from").label("cut from"), from);
    v.mark(group("to").label("cut to"), to);
    v.list(group("openings"), &mut |v| {
        v.number(length("start").label("opening at start"), start);
        v.number(length("end").label("opening at end"), end);
    });
});

/// A line along which a panel is pleated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PleatLine {
    /// Number of the pleat, unique in the operation; names of the edges and corners that the pleat makes
    /// contain it.
    pub number: u16,
    /// Start and end of the pleat, both on the line.
    pub ends: [Mark; 2],
}

fields!(PleatLine, |self, v| {
    let Self {
        number,
        ends: [from, to],
    } = self;
    v.value(key("number").at_most(PleatLine::LARGEST), number);
    v.mark(group("from").label("cut from"), from);
    v.mark(group("to").label("cut to"), to);
});

impl PleatLine {
    /// The largest number that a pleat may have: the corners of its underlay are numbered from ten times this
    /// number.
    pub const LARGEST: u16 = u16::MAX / 10 - 1;
}

/// Kind of pleat: the number and the direction of its folds.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
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
    /// The largest number that a cut may have: the corners at its openings are numbered from four times this
    /// number.
    pub const LARGEST: u16 = u16::MAX / 4;
}

/// Shape of a line across an opening of a spread panel.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Bridge {
    /// Straight.
    #[default]
    Straight,
    /// A curve that continues the line on both sides.
    Smooth,
}

/// A side of a curve or line that divides a panel.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Side {
    /// Left of the curve, seen along it.
    #[default]
    Left,
    /// Right of the curve, seen along it.
    Right,
}

/// The leg towards which a dart is pressed once it is sewn.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Pressed {
    /// The leg before the apex along the outline as drawn.
    #[default]
    Before,
    /// The leg after the apex.
    After,
}

impl Pressed {
    /// Number of the leg among the legs of the dart.
    pub fn leg(self) -> u16 {
        match self {
            Self::Before => 0,
            Self::After => 1,
        }
    }
}

/// The end of a dart inside the panel (its point).
#[derive(Clone, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
pub enum Apex {
    /// The apex is a point drawn on the panel's sheet.
    Point(PointId),
    /// The apex lies at this distance from the middle of the mouth, square to the mouth (m).
    Depth(Number),
}

impl Default for Apex {
    fn default() -> Self {
        Self::Depth(Number::ZERO)
    }
}

fields!(
    Apex,
    |self, v| {
        match self {
            Self::Point(point) => v.id("apex", point),
            Self::Depth(depth) => v.number(length("depth"), depth),
        }
    },
    kinds: |apex| match apex {
        Apex::Point(_) => Told::Field("apex"),
        Apex::Depth(_) => Told::Field("depth"),
    }
);

impl Choice for Turned {}
impl Choice for PleatKind {}
impl Choice for Bridge {}
impl Choice for Side {}
impl Choice for Pressed {}

impl OperationKind {
    /// The line that the operation cuts or folds. `None`: the operation is inside the panel.
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

    /// Both ends of the stretch that a fold lays on the fold of the cloth. `None`: the operation is no fold.
    pub fn fold_ends(&self) -> Option<&[Mark; 2]> {
        let Self::Fold { ends, .. } = self else {
            return None;
        };
        Some(ends)
    }

    /// The sheet whose lines the operation inserts. `None`: the operation inserts no lines.
    pub fn sheet(&self) -> Option<SheetId> {
        let Self::Insert { sheet } = self else {
            return None;
        };
        Some(*sheet)
    }
}

impl OperationKind {
    /// Name of the file field that holds this kind of operation.
    fn key(&self) -> &'static str {
        self.into()
    }

    /// Whether the operation moves parts of the panel from where they were drawn.
    pub(crate) fn moves_parts(&self) -> bool {
        match self {
            Self::Pivot { .. } | Self::Spread { .. } | Self::Pleat { .. } => true,
            Self::Dart { .. }
            | Self::Diamond { .. }
            | Self::Fold { .. }
            | Self::Split { .. }
            | Self::Insert { .. } => false,
        }
    }

    /// Whether the operation may redraw an edge to true darts: it is a trued dart, or a pivot.
    pub fn may_true(&self) -> bool {
        matches!(self, Self::Dart { trued: true, .. } | Self::Pivot { .. })
    }

    /// Name of the kind of operation for messages.
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
