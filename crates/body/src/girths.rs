//! The girths that a body is solved for, and values stored by girth.

use crate::landmark_level::Level;
use std::ops::{Index, IndexMut};
use strum::{EnumCount, VariantArray};

/// A girth, from the head down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray)]
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
    pub(crate) const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

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

    /// The level whose scale is set by a girth round the trunk; `None` for other girths.
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

/// A value for each girth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PerGirth<T>([T; Girth::COUNT]);

impl<T> PerGirth<T> {
    /// The values that a function gives for each girth.
    pub(crate) fn of(value: impl FnMut(Girth) -> T) -> Self {
        Self(Girth::ALL.map(value))
    }

    /// The values for modification, in the order of [`Girth::ALL`].
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.iter_mut()
    }
}

impl<T> Index<Girth> for PerGirth<T> {
    type Output = T;

    fn index(&self, girth: Girth) -> &T {
        &self.0[girth as usize]
    }
}

impl<T> IndexMut<Girth> for PerGirth<T> {
    fn index_mut(&mut self, girth: Girth) -> &mut T {
        &mut self.0[girth as usize]
    }
}
