//! Corners of edges: how their cut line turns, and how far it may reach.

use crate::fields;
use crate::fields::{Choice, ITSELF, Told, group, key};
use serde::{Deserialize, Serialize};
use strum::{EnumIter, VariantArray, VariantNames};

impl Choice for Corner {}

/// What is asked of a corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "WrittenCorner")]
pub struct EdgeCorner {
    /// How the cut line turns it.
    pub kind: Corner,
    /// How far the cut line may reach there.
    pub limit: MitreLimit,
    /// Whether a kink of the line that goes on there across a seam is meant.
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

/// A corner as a journal has it: of earlier versions its kind alone, or nothing.
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

/// How far from a corner its cut line may reach.
#[derive(Clone, Copy, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MitreLimit {
    /// So many times the wider of both allowances; beyond, it is cut off.
    Widths(f64),
    /// As far as both lines run.
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
    /// What is asked where nothing is: mitres down to 47 degrees are whole.
    pub const USUAL: f64 = 2.5;
    /// The least and the most that may be asked.
    pub const RANGE: [f64; 2] = [1.0, 100.0];
}

impl Default for MitreLimit {
    fn default() -> Self {
        Self::Widths(Self::USUAL)
    }
}

/// How a cut line turns a corner.
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
    /// Both lines run on until they meet.
    #[default]
    Mitre,
    /// Cut off straight.
    Bevel,
    /// Square to the edge after the corner.
    Square,
    /// The seam lines run on into the allowances.
    Extended,
    /// The neighbour's cut line mirrored in the edge after the corner, as a hem needs.
    Mirrored,
}
