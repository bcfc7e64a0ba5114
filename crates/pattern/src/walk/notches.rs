//! Notches along a seam, and their distances once it is sewn.

use super::{Run, Walk, WalkedSide};
use crate::NotchId;
use toile_geometry::{Curve, Vec2};

/// Greatest distance, along the seam, between a notch and its partner on the other side (m).
pub const NOTCH_REACH: f64 = 0.01;
/// Greatest distance at which a notch and its partner meet (m): the width of a cut notch.
pub const NOTCHES_MEET: f64 = 0.001;
/// Largest distance from a seam line at which a notch counts as on it (m).
const ON_LINE: f64 = 1e-6;

/// A notch on a side of a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkedNotch {
    /// Side of the seam: 0 or 1.
    pub side: usize,
    /// Index of the piece in the draft.
    pub piece: usize,
    /// The notch of the panel.
    pub id: NotchId,
    /// Position in the plane of the piece (m).
    pub at: Vec2,
    /// Arc length from the start of the side (m).
    pub along: f64,
    /// Distance along the other side, from the place opposite this notch to its partner (m); positive if the
    /// partner lies further on. The partner is the nearest notch of the other side, if this notch is also the
    /// nearest to it and both are within [`NOTCH_REACH`]. If there is no such notch, it is an end of the
    /// other side within [`NOTCHES_MEET`] or, if there is none, a closed dart or a joint between two pieces
    /// within [`NOTCH_REACH`]. `None`: the notch has no partner.
    pub partner: Option<f64>,
    /// The piece of the partner, if the partner is a notch.
    pub partner_piece: Option<usize>,
}

impl WalkedNotch {
    /// Whether the notch meets its partner when the seam is sewn.
    pub fn meets(&self) -> bool {
        self.partner
            .is_some_and(|apart| apart.abs() <= NOTCHES_MEET)
    }
}

impl Walk<'_> {
    /// The notches of both sides in walking order, the first side first.
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
                let other = nearest(own[k].along, others, scale);
                let mutual = other.filter(|&j| {
                    nearest(others[j].along, own, 1.0 / scale).is_some_and(|back| back == k)
                });
                let within = |apart: Option<f64>, reach: f64| apart.filter(|a| a.abs() <= reach);
                let notch = mutual.and_then(|j| {
                    let apart = within(Some(others[j].along - goal), NOTCH_REACH)?;
                    Some((apart, Some(others[j].piece)))
                });
                notch.or_else(|| {
                    within(least(&[0.0, lengths[1 - side]], goal), NOTCHES_MEET)
                        .or_else(|| {
                            within(least(&self.sides.0[1 - side].joins(), goal), NOTCH_REACH)
                        })
                        .map(|apart| (apart, None))
                })
            };
            let found = (0..own.len()).map(|k| {
                let partner = partner(k);
                WalkedNotch {
                    partner: partner.map(|(apart, _)| apart),
                    partner_piece: partner.and_then(|(_, piece)| piece),
                    ..own[k]
                }
            });
            found.collect::<Vec<_>>()
        };
        let mut all = partnered(0, &first, &second);
        all.extend(partnered(1, &second, &first));
        all
    }

    /// The notches of one side; each is listed once.
    fn notches_of(&self, side: usize) -> Vec<WalkedNotch> {
        let mut found: Vec<WalkedNotch> = Vec::new();
        for run in &self.sides.0[side].runs {
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
                        partner_piece: None,
                    });
                }
            }
        }
        found.sort_by(|a, b| a.along.total_cmp(&b.along));
        found
    }
}

impl WalkedSide {
    /// Arc lengths at which darts in the side are closed, or at which one piece ends and the next begins (m).
    fn joins(&self) -> Vec<f64> {
        let is_join = |pair: &&[Run]| {
            let [before, after] = [&pair[0], &pair[1]];
            let ends = before.path.curves().last().map(Curve::end);
            let starts = after.path.curves().first().map(Curve::start);
            let gap = ends.zip(starts).map(|(a, b)| (b - a).norm());
            before.span.piece != after.span.piece || gap.is_some_and(|gap| gap > ON_LINE)
        };
        let pairs = self.runs.windows(2).filter(is_join);
        pairs.map(|pair| pair[1].start).collect()
    }
}

/// Signed distance from a goal to the nearest of some places (m). `None`: there are no places.
fn least(places: &[f64], goal: f64) -> Option<f64> {
    let away = places.iter().map(|place| place - goal);
    away.min_by(|a, b| a.abs().total_cmp(&b.abs()))
}
