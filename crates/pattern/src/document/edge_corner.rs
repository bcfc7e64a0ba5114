//! Corners of edges: how the cut line turns at a corner of the seam line, and how far it may reach there.

use crate::fields;
use crate::fields::{Choice, ITSELF, Told, group, key};
use serde::{Deserialize, Serialize};
use strum::{EnumIter, VariantArray, VariantNames};

impl Choice for Corner {}

/// Settings of the corner at the start of an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "WrittenCorner")]
pub struct EdgeCorner {
    /// Shape of the cut line at the corner.
    pub kind: Corner,
    /// Limit of the cut line's distance from the corner.
    pub limit: MitreLimit,
    /// Whether a kink at this corner is intended, where the line continues on another panel across a seam.
    pub meant: bool,
}

fields!(EdgeCorner, |self, v| {
    let Self { kind, limit, meant } = self;
    v.value(key("corner").left_out_if(*kind == Corner::default()), kind);
    let refusal = [
        "it is no limit of a corner",
        "give a number of widths from 1 to 100, or \"none\"",
    ];
    let own = group("limit").refusal(refusal[0], refusal[1]);
    v.part(own.left_out_if(*limit == MitreLimit::default()), limit);
    v.value(key("meant").left_out_if(!*meant), meant);
});

/// A corner as a journal stores it: earlier versions wrote only its kind, or left it out.
#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenCorner {
    Whole {
        kind: Corner,
        limit: MitreLimit,
        meant: bool,
    },
    Kind(Option<Corner>),
}

impl From<WrittenCorner> for EdgeCorner {
    fn from(written: WrittenCorner) -> Self {
        match written {
            WrittenCorner::Whole { kind, limit, meant } => Self { kind, limit, meant },
            WrittenCorner::Kind(kind) => Self {
                kind: kind.unwrap_or_default(),
                ..Self::default()
            },
        }
    }
}

/// Limit of the distance of the cut line from a corner of the seam line.
#[derive(Clone, Copy, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MitreLimit {
    /// This many times the wider of the two allowances (1); a longer mitre is cut off.
    Widths(f64),
    /// No limit: both cut lines are extended until they meet.
    None,
}

fields!(
    MitreLimit,
    |self, v| {
        match self {
            Self::Widths(widths) => v.value(key(ITSELF).within(Self::RANGE), widths),
            Self::None => v.word("none"),
        }
    },
    kinds: |limit| match limit {
        MitreLimit::Widths(_) => Told::Number,
        MitreLimit::None => Told::Text,
    }
);

impl MitreLimit {
    /// Default limit (1): mitres of corners down to 47 degrees stay whole.
    pub const USUAL: f64 = 2.5;
    /// Least and greatest limit that may be set (1).
    pub const RANGE: [f64; 2] = [1.0, 100.0];
}

impl Default for MitreLimit {
    fn default() -> Self {
        Self::Widths(Self::USUAL)
    }
}

/// Shape of the cut line at a corner.
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
pub enum Corner {
    /// Both cut lines are extended until they meet.
    #[default]
    Mitre,
    /// The mitre is cut off straight.
    Bevel,
    /// The cut line is square to the edge after the corner.
    Square,
    /// Both seam lines are extended into the allowances, up to the cut lines.
    Extended,
    /// The cut line of the edge before, mirrored in the edge after the corner, so that a hem lies flush when
    /// turned up.
    Mirrored,
}
