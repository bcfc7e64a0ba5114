//! Parts of the body that panels are worn on.

use crate::fields::Choice;
use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};

/// The part of the body a piece is worn on.
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
pub enum BodyPart {
    /// Chest, waist and hips.
    #[default]
    Trunk,
    /// Neck and head (collars, hoods).
    Head,
    /// The wearer's left arm (at +x).
    LeftArm,
    /// The wearer's right arm (at -x).
    RightArm,
    /// The wearer's left leg (at +x).
    LeftLeg,
    /// The wearer's right leg (at -x).
    RightLeg,
}

/// The side of the body part that a panel faces.
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
pub enum Facing {
    /// In front of the body part (+z).
    #[default]
    Front,
    /// Behind the body part (-z).
    Back,
    /// On the wearer's left of the body part (+x; above an arm).
    Left,
    /// On the wearer's right of the body part (-x; below an arm).
    Right,
    /// All round the body part, closed by a seam that joins the panel to itself at the back (under the arm;
    /// inside the leg).
    Around,
    /// Over the top of the body part: laid on horizontally, as a poncho is.
    Over,
}

impl Choice for BodyPart {}
impl Choice for Facing {}
