//! Rules of a marker for single pieces, and marks that lie on the same place of its print.

use crate::fields::{Told, group, key};
use crate::{FabricId, NotchId, PanelId, fields};
use serde::{Deserialize, Serialize};
use strum::EnumIter;

/// What is asked of a piece beside the settings of its fabric. What is not given is that of a rule for more pieces, else
/// the default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LayingRule {
    /// Free fabric it needs to any other (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
    /// Extra fabric cut all round it, to be cut to shape later (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<f64>,
    /// How far its grain may lie off the warp (rad).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt: Option<f64>,
    /// Angles its grain may have to the warp (rad).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns: Option<Vec<Turn>>,
    /// Whether it may be turned over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_over: Option<bool>,
    /// Where the fabric is folded and the panel too: whether half of it lies on the fold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on_fold: Option<bool>,
    /// Whether it may hide flaws.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_flaws: Option<bool>,
    /// Whether its hem and middle lie on the print.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on_print: Option<bool>,
}

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
    /// This rule over one for more pieces: what it leaves open is that of the other.
    #[must_use]
    pub fn over(self, below: &Self) -> Self {
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
        Self {
            gap: gap.or(below.gap),
            block: block.or(below.block),
            tilt: tilt.or(below.tilt),
            turns: turns.or_else(|| below.turns.clone()),
            turn_over: turn_over.or(below.turn_over),
            on_fold: on_fold.or(below.on_fold),
            over_flaws: over_flaws.or(below.over_flaws),
            on_print: on_print.or(below.on_print),
        }
    }

    /// What no piece can be laid by: what is wrong, and what to do.
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

/// Which pieces a rule is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumIter, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RuledPieces {
    /// One copy of a panel, from 0.
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
    /// The pieces.
    pub pieces: RuledPieces,
    /// What is asked of them.
    #[serde(flatten)]
    pub rule: LayingRule,
    /// The fabric they are cut from instead of their panel's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fabric: Option<FabricId>,
    /// Further fabrics they are cut from too.
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

/// A fabric that pieces are cut from too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FurtherFabric {
    /// The fabric.
    pub fabric: FabricId,
    /// How often each garment's piece is cut from it.
    pub quantity: u32,
}

fields!(FurtherFabric, |self, v| {
    let Self { fabric, quantity } = self;
    v.id("fabric", fabric);
    v.value(key("quantity"), quantity);
});

/// A notch that lies on the same place of the print as others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MarkRef {
    /// The panel.
    pub panel: PanelId,
    /// Its notch.
    pub notch: NotchId,
}

fields!(MarkRef, |self, v| {
    let Self { panel, notch } = self;
    v.id("panel", panel);
    v.id("notch", notch);
});

/// Marks that lie on the same place of the print in every garment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MatchedMarks(pub Vec<MarkRef>);

fields!(MatchedMarks, |self, v| {
    let Self(marks) = self;
    v.each(group(crate::fields::ITSELF), marks);
});
