//! Operations: steps that alter a panel (dart, fold, pleat, split), stored in order.

use crate::fields::{Choice, Clash, Told, ValueField, group, key, length, plain};
use crate::{CurveId, LineName, Mark, Number, OperationId, PointId, SheetId, fields};
use serde::{Deserialize, Serialize};
use strum::{EnumIter, IntoStaticStr, VariantArray, VariantNames};

/// A kept step of a panel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// A dart taken out of a line, which is drawn with the dart's mouth in it.
    Dart {
        /// The line.
        line: LineName,
        /// Where the middle of the mouth is.
        mouth: Mark,
        /// Width of the mouth along the line (m).
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
        /// Width there (m).
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
        /// How far both darts then end before the place they pivot about (m).
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
    /// Lines of the panel that were drawn on a sheet which lies on the stage before this: holes and
    /// internal lines that name this operation.
    Insert {
        /// The sheet.
        sheet: SheetId,
    },
    /// Pleats: the panel is cut along straight lines and cloth is put between that folds under it.
    Pleat {
        /// The line.
        line: LineName,
        /// A place on it that stays where it is, and all that hangs together with it.
        held: Mark,
        /// Where it is folded.
        pleats: Vec<PleatLine>,
        /// How deep a fold goes under (m): a knife pleat takes twice that of cloth, others four
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

/// Pleats of journals that do not say it are trued.
fn is_trued() -> bool {
    true
}

/// Which part of a panel a pivot turns.
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
    /// The part from the dart along the outline as drawn to the new mouth.
    #[default]
    FromDart,
    /// The part from the new mouth along the outline to the dart.
    ToDart,
}

/// A cut along which a panel is spread.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SpreadCut {
    /// Its number in the operation, by which what it makes is named: no two have the same.
    pub number: u16,
    /// Where it starts and ends, both on the line.
    pub ends: [Mark; 2],
    /// How far it opens at its start and its end (m): where that is nothing it is a hinge.
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
    /// Its number in the operation, by which what it makes is named: no two have the same.
    pub number: u16,
    /// Where it starts and ends, both on the line.
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
    /// The largest number a pleat may have: the corners of its underlay are counted from ten times
    /// it.
    pub const LARGEST: u16 = u16::MAX / 10 - 1;
}

/// How a pleat is folded.
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
    /// The largest number a cut may have: the corners at its openings are counted from four times
    /// it.
    pub const LARGEST: u16 = u16::MAX / 4;
}

/// How an outline goes across an opening.
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
    /// In a curve that goes on from both sides.
    Smooth,
}

/// A side of a split panel.
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
    /// Left of the curve.
    #[default]
    Left,
    /// Right of it.
    Right,
}

/// The leg a dart is pressed towards once it is sewn.
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
#[derive(Clone, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
pub enum Apex {
    /// At a point of the panel's sheet.
    Point(PointId),
    /// So far from the middle of the mouth, square to it (m).
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

    /// Both ends of the stretch that a fold unfolds.
    pub fn fold_ends(&self) -> Option<&[Mark; 2]> {
        let Self::Fold { ends, .. } = self else {
            return None;
        };
        Some(ends)
    }

    /// The sheet whose lines it brings in.
    pub fn sheet(&self) -> Option<SheetId> {
        let Self::Insert { sheet } = self else {
            return None;
        };
        Some(*sheet)
    }
}

impl OperationKind {
    /// The field of files that holds it.
    fn key(&self) -> &'static str {
        self.into()
    }

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
