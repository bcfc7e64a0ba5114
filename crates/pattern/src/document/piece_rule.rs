//! Rules of a marker for single pieces, and marks that lie on the same place of its print.

use crate::fields::{Told, group, key};
use crate::{FabricId, NotchId, PanelId, fields};
use serde::{Deserialize, Serialize};
use strum::EnumIter;

/// Declares [`LayingRule`], and the methods that treat all its fields alike.
macro_rules! laying_rule {
    ($($(#[$about:meta])* $field:ident: $type:ty,)*) => {
        /// Rule for laying a piece, in addition to the settings of its fabric. A field that is not given is
        /// taken from a rule that covers more pieces; if no such rule gives it, the default holds.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        #[serde(default)]
        pub struct LayingRule {
            $($(#[$about])* #[serde(skip_serializing_if = "Option::is_none")] pub $field: Option<$type>,)*
        }

        impl LayingRule {
            /// This rule, with fields that are left open taken from `below`, a rule that covers more pieces.
            #[must_use]
            pub fn over(self, below: &Self) -> Self {
                let below = below.clone();
                Self { $($field: self.$field.or(below.$field),)* }
            }

            /// Copies from `now` the fields in which it differs from `before`, an earlier state of the same
            /// rule.
            pub fn take_changes(&mut self, before: &Self, now: &Self) {
                $(if before.$field != now.$field {
                    self.$field.clone_from(&now.$field);
                })*
            }
        }
    };
}

laying_rule! {
    /// Least distance of the piece from any other (m).
    gap: f64,
    /// Extra fabric cut all round the piece, to be cut to shape later (m).
    block: f64,
    /// Greatest angle between the grain of the piece and the warp (rad).
    tilt: f64,
    /// Allowed angles from the warp to the grain of the piece (rad).
    turns: Vec<Turn>,
    /// Whether the piece may be turned over.
    turn_over: bool,
    /// Whether half of the piece lies on the fold, if both the fabric and the panel are folded.
    on_fold: bool,
    /// Whether the piece may be cut from flawed fabric, as a pocket bag, which nobody sees.
    over_flaws: bool,
    /// Whether the hem and the middle of the piece are aligned with the print.
    on_print: bool,
}

/// A flag of a rule that the window shows.
#[derive(Clone, Copy, Debug)]
pub struct RuleFlag {
    /// Label in the window.
    pub label: &'static str,
    /// Returns the flag in a rule.
    pub of: fn(&mut LayingRule) -> &mut Option<bool>,
    /// Value of the flag if no rule gives it; `has_marks`: the marker has matched marks.
    pub usual: fn(has_marks: bool) -> bool,
}

/// The flags of a rule that the window shows, in its order.
pub const RULE_FLAGS: &[RuleFlag] = &[
    RuleFlag {
        label: "May be turned over",
        of: |rule| &mut rule.turn_over,
        usual: |_| false,
    },
    RuleFlag {
        label: "May hide flaws",
        of: |rule| &mut rule.over_flaws,
        usual: |_| false,
    },
    RuleFlag {
        label: "Lies on the print",
        of: |rule| &mut rule.on_print,
        usual: |has_marks| !has_marks,
    },
];

/// An angle from the warp to a piece's grain (rad).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Turn(pub f64);

fields!(Turn, |self, v| {
    let Self(angle) = self;
    v.value(key(crate::fields::ITSELF).angle(), angle);
});

fields!(LayingRule, |self, v| {
    let Self {
        gap,
        block,
        tilt,
        turns,
        turn_over,
        on_fold,
        over_flaws,
        on_print,
    } = self;
    given!(v, gap, key("gap").length());
    given!(v, block, key("block").length());
    given!(v, tilt, key("tilt").angle());
    given_list!(v, turns);
    given!(v, turn_over);
    given!(v, on_fold);
    given!(v, over_flaws);
    given!(v, on_print);
});

impl LayingRule {
    /// Fault of the first field whose value is not allowed: its description, and advice.
    pub fn fault(&self) -> Option<(String, &'static str)> {
        let lengths = [
            ("gap", self.gap),
            ("block", self.block),
            ("tilt", self.tilt),
        ];
        let wrong = lengths.into_iter().find_map(|(name, value)| {
            let value = value.filter(|value| !(value.is_finite() && *value >= 0.0))?;
            Some((
                format!("the {name} of its rule is {value}"),
                "give 0 or more",
            ))
        });
        let turns = self.turns.as_deref();
        wrong.or_else(|| match turns {
            Some([]) => Some((
                "it may lie in no direction".to_owned(),
                "give at least one turn, as in [0]",
            )),
            Some(turns) if turns.iter().any(|turn| !turn.0.is_finite()) => Some((
                "a turn of its rule is not finite".to_owned(),
                "give degrees",
            )),
            _ => None,
        })
    }
}

/// The pieces that a rule applies to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumIter, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RuledPieces {
    /// One copy of a panel; copies are numbered from 0.
    Copy(PanelId, u32),
    /// All copies of a panel.
    Panel(PanelId),
    /// All pieces.
    #[default]
    All,
}

fields!(
    RuledPieces,
    |self, v| {
        match self {
            Self::Copy(panel, copy) => {
                v.id("panel", panel);
                v.value(key("copy"), copy);
            }
            Self::Panel(panel) => v.id("panel", panel),
            Self::All => {}
        }
    },
    kinds: |pieces| Told::By(match pieces {
        RuledPieces::Copy(..) => &["panel", "copy"],
        RuledPieces::Panel(_) => &["panel"],
        RuledPieces::All => &[],
    })
);

/// A rule of a marker for some of its pieces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceRule {
    /// The pieces that the rule is for.
    pub pieces: RuledPieces,
    /// Rule for laying the pieces.
    #[serde(flatten)]
    pub rule: LayingRule,
    /// The fabric that the pieces are cut from instead of the fabric of their panel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fabric: Option<FabricId>,
    /// Further fabrics that the pieces are cut from too, such as a lining.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub also: Option<Vec<FurtherFabric>>,
}

fields!(PieceRule, |self, v| {
    let Self {
        pieces,
        rule,
        fabric,
        also,
    } = self;
    v.flat(pieces);
    v.flat(rule);
    v.optional("fabric", fabric);
    if let Some(fabric) = fabric {
        v.id("fabric", fabric);
    }
    given_list!(v, also);
});

/// A further fabric that pieces are cut from too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FurtherFabric {
    /// The fabric.
    pub fabric: FabricId,
    /// Number of copies cut from this fabric for each piece of a garment.
    pub quantity: u32,
}

fields!(FurtherFabric, |self, v| {
    let Self { fabric, quantity } = self;
    v.id("fabric", fabric);
    v.value(key("quantity"), quantity);
});

/// A notch that must lie on the same place of the print as other notches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MarkRef {
    /// The panel.
    pub panel: PanelId,
    /// The notch of the panel.
    pub notch: NotchId,
}

fields!(MarkRef, |self, v| {
    let Self { panel, notch } = self;
    v.id("panel", panel);
    v.id("notch", notch);
});

/// Marks that must lie on the same place of the print in every garment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MatchedMarks(pub Vec<MarkRef>);

fields!(MatchedMarks, |self, v| {
    let Self(marks) = self;
    v.each(group(crate::fields::ITSELF), marks);
});
