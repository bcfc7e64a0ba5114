//! Converts a layout to a marker, and a marker to a layout to start from.

use crate::explore::Island;
use crate::job::Job;
use crate::layout::Layout;
use crate::separate::{Limit, Outcome, Patience};
use crate::{Marker, Placement, Unplaced};
use std::f64::consts::TAU;

/// Patience while repairing a start layout.
const REPAIR: Patience = Patience {
    rounds: 60,
    strikes: 3,
};
/// Factor by which the strip grows if the overlaps of a start layout cannot be removed.
const LONGER: f64 = 1.02;
/// Cost per metre of distance from the start of the strip, when a missing piece is laid (m).
const BIAS: f64 = 0.02;
/// Number of repairs tried before a new first layout is made.
const TRIES: usize = 20;

/// The marker of a layout; lists the pieces that were not laid, with the reason.
pub(crate) fn finish(job: &Job<'_>, layout: &Layout) -> Marker {
    let strip = job.strip;
    let (mut placements, mut unplaced) = (Vec::new(), Vec::new());
    let reason = match strip.max_length {
        Some(length) => format!(
            "no room is left on {:.0} mm of fabric; take more fabric or lay it on another marker",
            length * 1e3
        ),
        None => "no place was found between defects, locked pieces and stripes; free some of them"
            .to_owned(),
    };
    for (k, piece) in job.pieces.iter().enumerate() {
        let Some(item) = piece.item else {
            continue;
        };
        if !layout.present[k] {
            unplaced.push(Unplaced {
                item,
                copy: piece.copy,
                reason: reason.clone(),
            });
            continue;
        }
        let shape = &job.shapes[layout.shape[k]];
        placements.push(Placement {
            item,
            copy: piece.copy,
            turn: shape.turn,
            mirrored: shape.mirrored,
            translation: layout.at[k] - shape.offset + job.corner(),
        });
    }
    let mut marker = Marker {
        placements,
        unplaced,
        ..Marker::default()
    };
    marker.measure(job.items, strip);
    marker
}

/// Angle between two directions (rad).
fn between(a: f64, b: f64) -> f64 {
    let apart = (a - b).rem_euclid(TAU);
    apart.min(TAU - apart)
}

/// The layout of a marker: every piece that exists, in the nearest allowed orientation. It may have overlaps
/// or extend beyond the strip.
pub(crate) fn layout_of(job: &Job<'_>, marker: &Marker) -> Layout {
    let mut layout = Layout::new(job, 0.0);
    for placement in &marker.placements {
        let is_it = |p: &crate::job::Piece| {
            p.item == Some(placement.item) && p.copy == placement.copy && p.locked.is_none()
        };
        let finite = placement.translation.iter().all(|v| v.is_finite());
        let Some(piece) = job.pieces.iter().position(is_it).filter(|_| finite) else {
            continue;
        };
        let off = |&s: &usize| {
            let shape = &job.shapes[s];
            let sided = if shape.mirrored == placement.mirrored {
                0.0
            } else {
                TAU
            };
            between(shape.turn, placement.turn) + sided
        };
        let shapes = job.pieces[piece].shapes.iter().copied();
        let Some(shape) = shapes.min_by(|a, b| off(a).total_cmp(&off(b))) else {
            continue;
        };
        let posed = placement.pose(&job.items[placement.item]);
        let bounds = posed.lay(&job.items[placement.item].outline).bounds();
        let size = job.shapes[shape].size;
        let same = off(&shape) < 1e-9;
        let at = match same {
            true => placement.translation + job.shapes[shape].offset,
            false => bounds.centre() - size * 0.5,
        };
        if let Some(bundle) = job.pieces[piece].bundle {
            layout.forward[bundle] = job.shapes[shape].forward;
        }
        layout.put(job, piece, shape, at - job.corner());
        layout.set_phase(job, piece);
    }
    layout.apply_locks(job);
    layout
}

impl Island<'_> {
    /// Starts from a layout: unchanged if it is valid, else repaired on a strip of the same length, or on
    /// longer ones if that fails; from a new first layout if all repairs fail.
    pub fn start_from(&mut self, given: &Layout, limit: &Limit<'_>) {
        let job = self.separator.job;
        let longest = job.longest().min(job.ample());
        let mut length = given.reach(job).max(job.shortest()).min(longest);
        for _ in 0..TRIES {
            if (limit.stop)() {
                return;
            }
            self.load_given(given, length);
            if self.separator.separate(REPAIR, limit) == Outcome::Apart {
                self.keep();
                return;
            }
            if length >= longest {
                break;
            }
            length = (length * LONGER).min(longest);
        }
        self.start(limit);
    }

    /// Loads a layout on a strip of a length (m), with the missing pieces in the positions of least overlap.
    fn load_given(&mut self, given: &Layout, length: f64) {
        let job = self.separator.job;
        let mut layout = given.clone();
        layout.length = length;
        layout.ease_phases(job);
        let movable = |k: &usize| job.pieces[*k].locked.is_none();
        let mut missing = Vec::new();
        for piece in (0..layout.at.len()).filter(movable) {
            let shape = layout.shape[piece];
            let place = layout.nearest_allowed(job, piece, shape, layout.at[piece]);
            let allowed = layout.present[piece] && layout.allows(job, piece, shape);
            match place.filter(|_| allowed) {
                Some(at) => layout.at[piece] = at,
                None => {
                    layout.remove(job, piece);
                    missing.push(piece);
                }
            }
        }
        self.separator.load(layout);
        for piece in missing {
            self.separator.move_piece(piece, BIAS);
        }
    }
}
