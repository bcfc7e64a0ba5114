//! How fabric is spread to be cut: layers, nap, prints, flaws.

use crate::fields;
use crate::fields::{Choice, group, key};
use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};

/// Which way pieces may point along the warp.
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
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum NapRule {
    /// Each either way.
    #[default]
    None,
    /// All one way.
    OneWay,
    /// All pieces of a garment one way.
    PerGarment,
}

/// How fabric is spread on the table.
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
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Spread {
    /// Open, all plies with the right side up.
    #[default]
    Open,
    /// Folded in two along the warp, selvedge on selvedge.
    Folded,
    /// A tube laid flat: a fold at both sides.
    Tubular,
    /// Open, every second ply turned over: what is cut comes in pairs.
    FaceToFace,
}

impl Spread {
    /// The numbers of plies that are right.
    pub const PLIES: &'static str = "give 1 or more, face to face an even number";

    /// Layers cut at once where nothing is said.
    pub fn usual_plies(self) -> u32 {
        match self {
            Self::FaceToFace => 2,
            Self::Open | Self::Folded | Self::Tubular => 1,
        }
    }

    /// Whether fabric can be spread so in so many plies.
    pub fn allows(self, plies: u32) -> bool {
        plies > 0 && (self != Self::FaceToFace || plies.is_multiple_of(2))
    }
}

impl Choice for NapRule {}
impl Choice for Spread {}

/// A print that repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Print {
    /// Length of a repeat along the warp and across [m]; 0 where it does not repeat.
    pub repeat: [f64; 2],
    /// A point where lines of the print cross [m].
    pub origin: [f64; 2],
}

fields!(Print, |self, v| {
    let Self {
        repeat: [along, across],
        origin: [x, y],
    } = self;
    v.list(group("repeat"), &mut |v| {
        v.value(key("along").length(), along);
        v.value(key("across").length(), across);
    });
    let is_zero = [*x, *y].map(f64::to_bits) == [0; 2];
    v.list(group("origin").left_out_if(is_zero), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
});

/// A flaw: a rectangle of the fabric laid open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flaw {
    /// Its corner nearest to the start: along the warp and across [m].
    pub at: [f64; 2],
    /// Its length and width [m].
    pub size: [f64; 2],
    /// Distance pieces keep from it [m].
    pub clearance: f64,
}

fields!(Flaw, |self, v| {
    let Self {
        at: [x, y],
        size: [long, wide],
        clearance,
    } = self;
    v.list(group("at"), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
    v.list(group("size"), &mut |v| {
        v.value(key("length").length(), long);
        v.value(key("width").length(), wide);
    });
    v.value(
        key("clearance")
            .length()
            .left_out_if(clearance.to_bits() == 0),
        clearance,
    );
});
