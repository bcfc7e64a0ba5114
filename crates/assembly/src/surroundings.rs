//! Obstacles for a row of pieces: the skin of the body part that it is worn on, the arms beside it, and
//! pieces placed before.

use crate::PlacementBody;
use crate::part_frames::PartFrame;
use toile_geometry::{Vec2, Vec3};
use toile_pattern::BodyPart;

/// Skin up to this distance above and below a row is also an obstacle (m).
pub(crate) const BAND: f64 = 0.03;
/// Distance that rings round the trunk keep from the arms (m).
const ARM_CLEARANCE: f64 = 0.015;

/// The body and the pieces that a row goes round.
pub(crate) struct Surroundings<'a> {
    pub body: &'a PlacementBody<'a>,
    /// Body part of each vertex of the skin.
    pub labels: &'a [BodyPart],
    /// Vertices of the pieces placed before.
    pub placed: &'a [Vec3],
}

/// Parameters of a wrapped row, varied by the search for a clear position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fit {
    /// Extra distance from the skin (m).
    pub distance: f64,
    /// Extra height (m).
    pub lift: f64,
}

/// Obstacles of a row on a body part between two heights: skin vertices that `keep` accepts, and for the
/// trunk pieces placed before.
pub(crate) fn obstacles(
    part: BodyPart,
    around: &Surroundings,
    frame: &PartFrame,
    [low, high]: [f64; 2],
    keep: impl Fn(Vec3, BodyPart) -> bool,
) -> Vec<Vec3> {
    let skin = &around.body.skin.mesh().positions;
    let mut found: Vec<Vec3> = Vec::new();
    for (&p, &label) in skin.iter().zip(around.labels) {
        let height = frame.height(p);
        if height >= low && height <= high && keep(p, label) {
            found.push(p);
        }
    }
    if matches!(part, BodyPart::Trunk) {
        let near = |p: &&Vec3| (low..=high).contains(&frame.height(**p));
        found.extend(around.placed.iter().filter(near));
    }
    found
}

/// Coordinates across a part's axis of the part's skin, between two heights and a little above and below (m).
/// The skin of the trunk includes head and legs.
pub(crate) fn skin_outline(
    part: BodyPart,
    around: &Surroundings,
    frame: &PartFrame,
    [low, high]: [f64; 2],
) -> Vec<Vec2> {
    let own = |label: BodyPart| match part {
        BodyPart::Trunk => !is_arm(label),
        part => label == part,
    };
    let skin_only = Surroundings {
        placed: &[],
        ..*around
    };
    obstacles(
        part,
        &skin_only,
        frame,
        [low - BAND, high + BAND],
        |_, l| own(l),
    )
    .into_iter()
    .map(|p| frame.across(p, 0))
    .collect()
}

/// Distance from the axis of the trunk within which cloth keeps clear of the arms, between two heights (m).
pub(crate) fn arm_distance(
    part: BodyPart,
    around: &Surroundings,
    frame: &PartFrame,
    [low, high]: [f64; 2],
) -> f64 {
    let skin_only = Surroundings {
        placed: &[],
        ..*around
    };
    let arms = obstacles(
        part,
        &skin_only,
        frame,
        [low - BAND, high + BAND],
        |_, l| is_arm(l),
    );
    let nearest = arms.into_iter().map(|p| frame.across(p, 0).norm());
    nearest.fold(f64::INFINITY, f64::min) - ARM_CLEARANCE
}

fn is_arm(label: BodyPart) -> bool {
    matches!(label, BodyPart::LeftArm | BodyPart::RightArm)
}
