//! Notches: their places on the seam line and the cut line, and the lines cut or drawn for them.

use toile_geometry::Vec2;
use toile_pattern::{EdgeOrigin, NotchId, NotchKind};

/// Depth of a notch (m): visible at arm's length, and well within an allowance of 10 mm.
pub const NOTCH_DEPTH: f64 = 0.006;

/// A notch of a cut piece. A notch at a corner of the seam line is listed once for each cut line that meets
/// there.
#[derive(Clone, Debug, PartialEq)]
pub struct CutNotch {
    /// The notch of the panel.
    pub id: NotchId,
    /// The edge that the notch is on.
    pub edge: EdgeOrigin,
    /// Shape of the notch.
    pub kind: NotchKind,
    /// Place on the seam line (m).
    pub point: Vec2,
    /// Unit vector into the piece.
    pub inward: Vec2,
    /// Place on the cut line of the edge (m): straight out from the seam line, or, at a corner, the point
    /// where the other edge's extended seam line meets the cut line. Equal to `point` if no such place
    /// exists.
    pub on_cut: Vec2,
    /// Unit vector along the edge as drawn: a check mark slopes to this side.
    pub along: Vec2,
    /// Depth of the cut (m); 0 where the notch is drawn, as there is no allowance to cut.
    pub depth: f64,
    /// The lines to cut along, each through points (m), from the cut line into the allowance.
    pub cut: Vec<Vec<Vec2>>,
}

impl CutNotch {
    /// The lines of the notch drawn on the seam line, each through points (m).
    pub fn on_seam_line(&self) -> Vec<Vec<Vec2>> {
        let place = |[along, inward]: [f64; 2]| {
            self.point + (self.along * along + self.inward * inward) * NOTCH_DEPTH
        };
        let line = |line: &Vec<[f64; 2]>| line.iter().map(|p| place(*p)).collect();
        shape(self.kind).iter().map(line).collect()
    }

    /// Whether the notch looks the same as another at the same place. This happens at an inner corner, where
    /// two edges continue straight into each other, and on a fold.
    pub(crate) fn looks_like(&self, other: &Self) -> bool {
        const SAME: f64 = 1e-6;
        let same = |a: Vec2, b: Vec2| (a - b).norm() < SAME;
        let drawn = [self, other].map(|notch| notch.cut.is_empty());
        self.id == other.id
            && same(self.point, other.point)
            && match drawn {
                [true, true] => true,
                [false, false] => same(self.on_cut, other.on_cut),
                _ => false,
            }
    }
}

/// The lines of a kind of notch for depth 1: coordinates along the edge and inwards from the edge.
pub(crate) fn shape(kind: NotchKind) -> Vec<Vec<[f64; 2]>> {
    match kind {
        NotchKind::Slit => vec![vec![[0.0, 0.0], [0.0, 1.0]]],
        NotchKind::V => vec![vec![[-0.5, 0.0], [0.0, 1.0], [0.5, 0.0]]],
        NotchKind::Castle => vec![vec![[-0.5, 0.0], [-0.5, 1.0], [0.5, 1.0], [0.5, 0.0]]],
        NotchKind::T => vec![vec![[0.0, 0.0], [0.0, 1.0]], vec![[-0.5, 1.0], [0.5, 1.0]]],
        NotchKind::Check => vec![vec![[0.0, 0.0], [0.0, 1.0], [0.5, 0.0]]],
    }
}
