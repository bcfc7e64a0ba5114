//! A piece in one orientation.

use crate::{Fold, FoldEdge, Item, Pose, Strip};
use toile_geometry::{Polygon, Vec2};

/// Rounding tolerance for a piece exactly as wide as the fabric (m).
pub(crate) const SNUG: f64 = 1e-9;

/// A piece in one orientation.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    /// Index of the item, or of the flaw after all items.
    pub kind: usize,
    /// Index of the outline, which other items may share.
    pub ring: usize,
    /// The first shape with the same outline and orientation.
    pub look: usize,
    /// Angle from the warp to the grain (rad).
    pub turn: f64,
    pub mirrored: bool,
    /// Lower left corner of the bounding box of the posed outline, relative to its origin (m).
    pub offset: Vec2,
    /// Size of the bounding box (m).
    pub size: Vec2,
    /// Whether the grain points along +x rather than -x.
    pub forward: bool,
    /// Match point relative to the corner of the bounding box (m).
    pub anchor: Option<Vec2>,
    /// The only allowed y (m), for a piece on a fold.
    pub on_fold: Option<f64>,
}

impl Shape {
    /// `None` if the orientation does not bring the fold edge to a fold.
    pub fn new(
        kind: usize,
        item: &Item,
        (turn, mirrored): (f64, bool),
        strip: &Strip,
    ) -> Option<Self> {
        let pose = Pose {
            grain: item.grain,
            turn,
            mirrored,
            translation: Vec2::zeros(),
        };
        let bounds = pose.lay(&item.outline).bounds();
        let forward = turn.cos() >= 0.0;
        let on_fold = match folds_up(item, strip, (turn, mirrored)) {
            None => None,
            Some(None) => return None,
            Some(Some(FoldEdge::Lower)) => Some(0.0),
            Some(Some(FoldEdge::Upper)) => Some(strip.usable_width() - bounds.size().y),
        };
        Some(Self {
            kind,
            ring: 0,
            look: 0,
            turn,
            mirrored,
            offset: bounds.min,
            size: bounds.size(),
            forward,
            anchor: item.match_point.map(|m| pose.apply(m.point) - bounds.min),
            on_fold,
        })
    }

    /// The outline relative to the corner of the bounding box (m).
    pub fn outline(&self, item: &Item) -> Polygon {
        let pose = Pose {
            grain: item.grain,
            turn: self.turn,
            mirrored: self.mirrored,
            translation: -self.offset,
        };
        pose.lay(&item.outline)
    }
}

/// Size of an item's bounding box in an orientation (m).
pub(crate) fn extent(item: &Item, (turn, mirrored): (f64, bool)) -> Vec2 {
    let pose = Pose {
        grain: item.grain,
        turn,
        mirrored,
        translation: Vec2::zeros(),
    };
    pose.lay(&item.outline).bounds().size()
}

/// The fold, lower or upper, on which an orientation puts the fold edge of a piece: `None` for a piece
/// without fold edge, `Some(None)` if there is no such fold.
pub(crate) fn folds_up(
    item: &Item,
    strip: &Strip,
    (turn, mirrored): (f64, bool),
) -> Option<Option<FoldEdge>> {
    let flipped = mirrored != (turn.cos() < 0.0);
    let lower = (item.fold_edge? == FoldEdge::Lower) != flipped;
    let along = turn.sin().abs() < 1e-9;
    Some(match (strip.fold, lower) {
        (Fold::Lower | Fold::Both, true) if along => Some(FoldEdge::Lower),
        (Fold::Both, false) if along => Some(FoldEdge::Upper),
        _ => None,
    })
}

/// Whether two rings have the same corners, in any order, to a tolerance (m).
pub(crate) fn coincide(a: &[Vec2], b: &[Vec2], tolerance: f64) -> bool {
    let found = |p: &Vec2| b.iter().any(|q| (p - q).amax() <= tolerance);
    a.len() == b.len() && a.iter().all(found)
}
