//! The landmarks of a standing body that have a height.

/// Landmarks with a height to solve for, from the top down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    Crown,
    Nape,
    NeckSide,
    Tip,
    Armpit,
    HighBust,
    Bust,
    Underbust,
    Waist,
    HighHips,
    Hips,
    Crotch,
    Knee,
}
