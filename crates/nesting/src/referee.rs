//! The referee: is this a marker that can be cut?
//!
//! Decided on the original outlines with exact predicates; nothing of the placing is used.

use crate::rules::check_rules;
use crate::{Item, Marker, Strip};
use toile_geometry::{Bounds2, Polygon, PreparedPolygon, Vec2, intersection, total_area};

/// Deepest overlap of two pieces, nearest they may come below their gap, and furthest they may
/// stick out, that still counts as sound \[m\].
pub const PENETRATION_LIMIT: f64 = 1e-6;

/// A side of the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Before the first end margin.
    Start,
    /// Beyond the marker's length, or the fabric's, less the end margin.
    End,
    /// In the selvedge at y = 0.
    Lower,
    /// In the selvedge at y = width.
    Upper,
}

/// One reason why a marker is not sound. Placements are named by their index in the marker.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// Two pieces overlap.
    Overlap {
        /// The placements.
        pair: [usize; 2],
        /// Length of the shortest move that ends it \[m\].
        depth: f64,
        /// Fabric used twice \[m2\].
        area: f64,
        /// A point of the overlap \[m\].
        at: Vec2,
    },
    /// Two pieces lie nearer than their gap.
    Gap {
        /// The placements.
        pair: [usize; 2],
        /// Their distance \[m\].
        distance: f64,
        /// The gap they need \[m\].
        needed: f64,
    },
    /// A piece sticks out.
    Outside {
        /// The placement.
        placement: usize,
        /// Where.
        side: Side,
        /// By how much \[m\].
        by: f64,
    },
    /// A piece lies in an orientation it may not take.
    Orientation {
        /// The placement.
        placement: usize,
        /// Its turn \[rad\].
        turn: f64,
        /// Whether it lies face down.
        mirrored: bool,
    },
    /// Two pieces of one garment run opposite ways on fabric with a nap.
    Nap {
        /// The placements.
        pair: [usize; 2],
        /// Number of the garment.
        bundle: u32,
    },
    /// A piece that must lie on a fold does not.
    OffFold {
        /// The placement.
        placement: usize,
        /// How far it is from the nearest fold \[m\]; infinite if there is none.
        by: f64,
    },
    /// A match point lies beside the print.
    OffPrint {
        /// The placement.
        placement: usize,
        /// How far along the warp and across \[m\].
        by: Vec2,
    },
    /// A piece lies on a flaw, or nearer to it than it may.
    OnFlaw {
        /// The placement.
        placement: usize,
        /// Number of the flaw.
        flaw: usize,
        /// Flawed area in the piece \[m2\].
        area: f64,
    },
    /// A locked copy does not lie where it must.
    Moved {
        /// The placement.
        placement: usize,
    },
    /// A copy is laid twice, or neither laid nor listed as unplaced, or does not exist.
    Copy {
        /// Index of the item.
        item: usize,
        /// Number of the copy.
        copy: u32,
        /// How often it is laid or listed.
        count: usize,
    },
    /// A placement names no item, or its place is not a finite number.
    Nonsense {
        /// The placement.
        placement: usize,
    },
    /// The stated length is not the length used.
    Length {
        /// As stated \[m\].
        stated: f64,
        /// As found, end margins included \[m\].
        found: f64,
    },
}

/// What the referee found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Everything that is wrong; empty for a sound marker.
    pub violations: Vec<Violation>,
    /// Deepest overlap, below the limit too \[m\].
    pub deepest: f64,
    /// Fabric used twice \[m2\].
    pub overlap_area: f64,
    /// What is used twice, by the pairs of placements that share it.
    pub overlaps: Vec<([usize; 2], Vec<Polygon>)>,
    /// Least distance between two pieces \[m\]; infinite for one piece.
    pub nearest: f64,
    /// Fabric used, end margins included \[m\].
    pub length: f64,
}

impl Verdict {
    /// Whether the marker can be cut.
    pub fn is_sound(&self) -> bool {
        self.violations.is_empty()
    }
}

/// Checks every piece and every pair of a marker: no penetration deeper than
/// [`PENETRATION_LIMIT`], gaps kept, between selvedges and end margins, allowed orientations, every
/// copy laid or listed once, length as stated.
pub fn judge(items: &[Item], strip: &Strip, marker: &Marker) -> Verdict {
    let mut verdict = Verdict {
        nearest: f64::INFINITY,
        ..Verdict::default()
    };
    let mut laid = Vec::new();
    for (k, placement) in marker.placements.iter().enumerate() {
        let at = placement.translation;
        let finite = [at.x, at.y, placement.turn].iter().all(|x| x.is_finite());
        match items.get(placement.item) {
            Some(item) if finite => {
                let outline = placement.pose(item).lay(&item.outline);
                laid.push((k, item, PreparedPolygon::new(&outline)));
            }
            _ => verdict
                .violations
                .push(Violation::Nonsense { placement: k }),
        }
    }
    check_copies(items, marker, &mut verdict);
    check_rules(strip, &laid, marker, &mut verdict.violations);
    check_inside(strip, &laid, marker, &mut verdict);
    for (n, one) in laid.iter().enumerate() {
        for other in &laid[n + 1..] {
            check_pair(one, other, strip.gap_between(one.1, other.1), &mut verdict);
        }
    }
    verdict
}

/// Index of a placement, its item, and its outline on the strip.
pub(crate) type Laid<'a> = (usize, &'a Item, PreparedPolygon);

fn check_copies(items: &[Item], marker: &Marker, verdict: &mut Verdict) {
    let laid = marker.placements.iter().map(|p| (p.item, p.copy));
    let listed = marker.unplaced.iter().map(|u| (u.item, u.copy));
    let mut counts = std::collections::BTreeMap::new();
    for copy in laid.chain(listed) {
        *counts.entry(copy).or_insert(0) += 1;
    }
    for (item, what) in items.iter().enumerate() {
        for copy in 0..what.quantity {
            let count = counts.remove(&(item, copy)).unwrap_or(0);
            if count != 1 {
                verdict
                    .violations
                    .push(Violation::Copy { item, copy, count });
            }
        }
    }
    for ((item, copy), count) in counts {
        verdict
            .violations
            .push(Violation::Copy { item, copy, count });
    }
}

/// What is not a number counts as beyond.
pub(crate) fn beyond_limit(excess: f64) -> bool {
    excess.is_nan() || excess > PENETRATION_LIMIT
}

/// How far bounds reach beyond each side of the usable fabric \[m\]; below 0 where they do not.
pub(crate) fn sides(strip: &Strip, bounds: Bounds2) -> [(Side, f64); 4] {
    let end = strip.max_length.unwrap_or(f64::INFINITY) - strip.end_margin;
    [
        (Side::Start, strip.end_margin - bounds.min.x),
        (Side::End, bounds.max.x - end),
        (Side::Lower, strip.lower() - bounds.min.y),
        (Side::Upper, bounds.max.y - strip.upper()),
    ]
}

fn check_inside(strip: &Strip, laid: &[Laid<'_>], marker: &Marker, verdict: &mut Verdict) {
    let reach = laid.iter().map(|(.., p)| p.bounds().max.x);
    verdict.length = reach.fold(strip.end_margin, f64::max) + strip.end_margin;
    if beyond_limit((verdict.length - marker.length).abs()) {
        verdict.violations.push(Violation::Length {
            stated: marker.length,
            found: verdict.length,
        });
    }
    for (placement, _, outline) in laid {
        for (side, by) in sides(strip, outline.bounds()) {
            if beyond_limit(by) {
                verdict.violations.push(Violation::Outside {
                    placement: *placement,
                    side,
                    by,
                });
            }
        }
    }
}

fn check_pair(one: &Laid<'_>, other: &Laid<'_>, needed: f64, verdict: &mut Verdict) {
    let (a, b) = (&one.2, &other.2);
    let apart = a.bounds().distance(&b.bounds());
    if apart > needed.max(PENETRATION_LIMIT) && apart >= verdict.nearest {
        return;
    }
    let pair = [one.0, other.0];
    if !a.overlaps(b) {
        let distance = a.distance(b);
        verdict.nearest = verdict.nearest.min(distance);
        if distance < needed - PENETRATION_LIMIT {
            verdict.violations.push(Violation::Gap {
                pair,
                distance,
                needed,
            });
        }
        return;
    }
    verdict.nearest = 0.0;
    let depth = a.penetration_depth(b);
    let shared = intersection(a.polygon(), b.polygon());
    let area = total_area(&shared);
    verdict.deepest = verdict.deepest.max(depth);
    verdict.overlap_area += area;
    if depth > PENETRATION_LIMIT {
        verdict.overlaps.push((pair, shared.clone()));
        let at = shared.first().and_then(|p| p.outer.first());
        verdict.violations.push(Violation::Overlap {
            pair,
            depth,
            area,
            at: at.copied().unwrap_or_else(|| a.bounds().centre()),
        });
    } else if needed > PENETRATION_LIMIT {
        verdict.violations.push(Violation::Gap {
            pair,
            distance: 0.0,
            needed,
        });
    }
}
