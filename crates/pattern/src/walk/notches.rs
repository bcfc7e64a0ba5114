//! Notches along a seam, and whether they meet when it is sewn.

use super::Walk;
use crate::NotchId;
use toile_geometry::Vec2;

/// A notch has its partner within this distance along the seam [m].
pub const NOTCH_REACH: f64 = 0.01;
/// Notches that are no farther apart meet [m]: the width of a notch as it is cut.
pub const NOTCHES_MEET: f64 = 0.001;
/// A notch this near to a seam line lies on it [m].
const ON_LINE: f64 = 1e-6;

/// A notch on a side of a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkedNotch {
    /// The side: 0 or 1.
    pub side: usize,
    /// The piece, by its index in the draft.
    pub piece: usize,
    /// Which notch.
    pub id: NotchId,
    /// Where it lies in the plane of its piece [m].
    pub at: Vec2,
    /// Arc length from the start of its side [m].
    pub along: f64,
    /// How far its partner on the other side lies beyond the place opposite it, along that side [m];
    /// nothing if none lies within [`NOTCH_REACH`] that is not nearer to another notch. The ends of
    /// the other side are partners too.
    pub partner: Option<f64>,
}

impl WalkedNotch {
    /// Whether it meets its partner.
    pub fn meets(&self) -> bool {
        self.partner
            .is_some_and(|apart| apart.abs() <= NOTCHES_MEET)
    }
}

impl Walk<'_> {
    /// The notches of both sides in walking order, those of the first side first.
    pub fn notches(&self) -> Vec<WalkedNotch> {
        let [first, second] = [0, 1].map(|side| self.notches_of(side));
        let lengths = self.lengths();
        let partnered = |side: usize, own: &[WalkedNotch], others: &[WalkedNotch]| {
            let scale = lengths[1 - side] / lengths[side];
            let nearest = |from: f64, among: &[WalkedNotch], scale: f64| {
                let distance = |k: &usize| (among[*k].along - from * scale).abs();
                (0..among.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
            };
            let partner = |k: usize| {
                let goal = own[k].along * scale;
                let end = if goal < 0.5 * lengths[1 - side] {
                    0.0
                } else {
                    lengths[1 - side]
                };
                let other = nearest(own[k].along, others, scale);
                let mutual = other.filter(|&j| {
                    nearest(others[j].along, own, 1.0 / scale).is_some_and(|back| back == k)
                });
                let apart = mutual.map(|j| others[j].along - goal);
                let ends = (end - goal).abs() <= NOTCHES_MEET;
                let apart = apart.or_else(|| ends.then_some(end - goal));
                apart.filter(|apart| apart.abs() <= NOTCH_REACH)
            };
            let found = (0..own.len()).map(|k| WalkedNotch {
                partner: partner(k),
                ..own[k]
            });
            found.collect::<Vec<_>>()
        };
        let mut all = partnered(0, &first, &second);
        all.extend(partnered(1, &second, &first));
        all
    }

    /// The notches of one side, each once.
    fn notches_of(&self, side: usize) -> Vec<WalkedNotch> {
        let mut found: Vec<WalkedNotch> = Vec::new();
        for run in &self.sides[side].runs {
            let Some(piece) = self.draft.pieces.get(run.span.piece) else {
                continue;
            };
            for notch in &piece.notches {
                let Some(place) = run.path.nearest(notch.point) else {
                    continue;
                };
                let is_on = (run.path.point(place) - notch.point).norm() <= ON_LINE;
                let along = run.start + place.along;
                let is_known = found.iter().any(|known| {
                    known.id == notch.id
                        && known.piece == run.span.piece
                        && (known.along - along).abs() <= ON_LINE
                });
                if is_on && !is_known {
                    found.push(WalkedNotch {
                        side,
                        piece: run.span.piece,
                        id: notch.id,
                        at: notch.point,
                        along,
                        partner: None,
                    });
                }
            }
        }
        found.sort_by(|a, b| a.along.total_cmp(&b.along));
        found
    }
}
