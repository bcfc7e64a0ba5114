//! Notches: their places on the seam line and the cut line, and the lines drawn for them.

use crate::seams::Plane;
use toile_geometry::{Polygon, Vec2};
use toile_pattern::{EdgeOrigin, NotchId, NotchKind, Piece};

/// Depth of a notch \[m\]: seen from an arm's length, and short of a 10 mm seam.
pub const NOTCH_DEPTH: f64 = 0.006;
/// Share of the allowance a notch is cut into at the most: the rest is sewn.
const MOST_OF_ALLOWANCE: f64 = 0.6;
/// How far from the seam line a cut line is looked for \[m\].
const REACH: f64 = 0.5;
/// Cut lines nearer to the seam line are the same line, flattened \[m\].
const ON_SEAM: f64 = 1e-4;

/// A notch of a cut piece.
#[derive(Clone, Debug, PartialEq)]
pub struct CutNotch {
    /// The notch of the panel.
    pub id: NotchId,
    /// The edge it is on.
    pub edge: EdgeOrigin,
    /// Its shape.
    pub kind: NotchKind,
    /// Where on the seam line \[m\].
    pub point: Vec2,
    /// Unit vector into the piece.
    pub inward: Vec2,
    /// Where on the cut line \[m\], straight out from the seam line.
    pub on_cut: Vec2,
    /// Unit vector along the edge as drawn: the side to which a check mark slopes.
    pub along: Vec2,
}

impl CutNotch {
    /// Lines drawn on the seam line, each through points \[m\].
    pub fn on_seam_line(&self) -> Vec<Vec<Vec2>> {
        self.strokes(self.point, NOTCH_DEPTH)
    }

    /// Lines cut, or drawn at the cut line; none where the cut line is the seam line.
    pub fn on_cut_line(&self) -> Vec<Vec<Vec2>> {
        let width = (self.on_cut - self.point).norm();
        match width > ON_SEAM {
            true => self.strokes(self.on_cut, NOTCH_DEPTH.min(MOST_OF_ALLOWANCE * width)),
            false => Vec::new(),
        }
    }

    /// Its shape at a point, so deep \[m\].
    fn strokes(&self, at: Vec2, depth: f64) -> Vec<Vec<Vec2>> {
        let place = |along: f64, inward: f64| {
            at + self.along * (along * depth) + self.inward * (inward * depth)
        };
        let line = |points: &[[f64; 2]]| points.iter().map(|p| place(p[0], p[1])).collect();
        match self.kind {
            NotchKind::Slit => vec![line(&[[0.0, 0.0], [0.0, 1.0]])],
            NotchKind::V => vec![line(&[[-0.5, 0.0], [0.0, 1.0], [0.5, 0.0]])],
            NotchKind::Castle => {
                vec![line(&[[-0.5, 0.0], [-0.5, 1.0], [0.5, 1.0], [0.5, 0.0]])]
            }
            NotchKind::T => vec![
                line(&[[0.0, 0.0], [0.0, 1.0]]),
                line(&[[-0.5, 1.0], [0.5, 1.0]]),
            ],
            NotchKind::Check => vec![line(&[[0.0, 0.0], [0.0, 1.0], [0.5, 0.0]])],
        }
    }
}

/// The notches of a piece that is cut as a polygon.
pub(crate) fn notches_of(piece: &Piece, plane: &Plane, cut: &Polygon) -> Vec<CutNotch> {
    let notch = |notch: &toile_pattern::PieceNotch| {
        let point = plane.vector(notch.point);
        let inward = plane.normal(notch.inward);
        let all = piece.outline.iter().chain(piece.holes.iter().flatten());
        let mut edges = all.filter(|edge| edge.origin == notch.edge);
        let reversed = edges.next().is_some_and(|edge| edge.reversed);
        // The cloth is at the left of the outline as drawn.
        let along = Vec2::new(inward.y, -inward.x) * if reversed { -1.0 } else { 1.0 };
        CutNotch {
            id: notch.id,
            edge: notch.edge,
            kind: notch.kind,
            point,
            inward,
            on_cut: outwards(point, -inward, cut),
            along,
        }
    };
    piece.notches.iter().map(notch).collect()
}

/// Where a ray from a point meets a border first, or the point if it does not.
fn outwards(from: Vec2, way: Vec2, cut: &Polygon) -> Vec2 {
    let mut nearest = REACH;
    let mut found = from;
    for [p, q] in cut.edges() {
        let side = q - p;
        let cross = way.perp(&side);
        let (at, share) = (
            (p - from).perp(&side) / cross,
            (p - from).perp(&way) / cross,
        );
        let meets = (-1e-9..=1.0 + 1e-9).contains(&share) && at > -ON_SEAM;
        if meets && at < nearest {
            nearest = at;
            found = from + way * at.max(0.0);
        }
    }
    found
}
