//! The landmarks of a standing body that have a height.

/// Landmarks with a height to solve for, from the top down. `NeckSide` is where neck and shoulder meet, `Tip`
/// the outer end of the shoulder.
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
