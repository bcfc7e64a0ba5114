//! Every girth a body is solved for.

use crate::landmark_level::Level;

/// A girth, from the head down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Girth {
    Head,
    Neck,
    HighBust,
    Bust,
    Underbust,
    Waist,
    HighHips,
    Hips,
    Thigh,
    LowerThigh,
    Knee,
    Calf,
    Ankle,
    Heel,
    UpperArm,
    Elbow,
    Forearm,
    Wrist,
}

impl Girth {
    pub(crate) const COUNT: usize = 18;
    pub(crate) const ALL: [Girth; Self::COUNT] = {
        use Girth::*;
        [
            Head, Neck, HighBust, Bust, Underbust, Waist, HighHips, Hips, Thigh, LowerThigh, Knee,
            Calf, Ankle, Heel, UpperArm, Elbow, Forearm, Wrist,
        ]
    };

    /// The measurement's name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Girth::Head => "head",
            Girth::Neck => "neck",
            Girth::HighBust => "high_bust",
            Girth::Bust => "bust",
            Girth::Underbust => "underbust",
            Girth::Waist => "waist",
            Girth::HighHips => "high_hips",
            Girth::Hips => "hips",
            Girth::Thigh => "leg_circ",
            Girth::LowerThigh => "lower_thigh",
            Girth::Knee => "knee",
            Girth::Calf => "calf",
            Girth::Ankle => "ankle",
            Girth::Heel => "heel",
            Girth::UpperArm => "upper_arm",
            Girth::Elbow => "elbow",
            Girth::Forearm => "forearm",
            Girth::Wrist => "wrist",
        }
    }

    /// The level whose scale it sets, of girths round the trunk.
    pub(crate) fn level(self) -> Option<Level> {
        match self {
            Girth::HighBust => Some(Level::HighBust),
            Girth::Bust => Some(Level::Bust),
            Girth::Underbust => Some(Level::Underbust),
            Girth::Waist => Some(Level::Waist),
            Girth::HighHips => Some(Level::HighHips),
            Girth::Hips => Some(Level::Hips),
            _ => None,
        }
    }
}
