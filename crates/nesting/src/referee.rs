//! The referee: an independent check whether a marker can be cut.
//!
//! It works on the original outlines with exact predicates and uses nothing of the placing.
//!
//! # Decided with
//! - [`crate::rules::check_rules`]: rules of the trade: grain, nap, fold, print, flaws, locks;
//! - [`toile_geometry::PreparedPolygon`]: overlap and its depth;
//! - [`crate::violation::PENETRATION_LIMIT`]: how deep counts;
//! - [`crate::clashes`](mod@crate::clashes) (`is_deep`): the same limit for pieces laid by hand;
//! - [`crate::job::SAFE`], [`crate::job::SIMPLIFY`]: margins by which the search keeps apart;
//! - [`crate::words`]: violations in words.

use crate::rules::{Laid, check_rules};
use crate::violation::{PENETRATION_LIMIT, Side, Violation, beyond_limit};
use crate::{Item, Marker, Strip};
use toile_geometry::{Bounds2, Polygon, PreparedPolygon, intersection, total_area};

/// The result of a check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// All violations; empty for a valid marker.
    pub violations: Vec<Violation>,
    /// Deepest overlap, even if below the limit (m).
    pub deepest: f64,
    /// Area of fabric that would be cut twice (m2).
    pub overlap_area: f64,
    /// Regions that would be cut twice, with the pairs of placements that share them.
    pub overlaps: Vec<([usize; 2], Vec<Polygon>)>,
    /// Smallest distance between two pieces (m); infinite for one piece.
    pub nearest: f64,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
}

impl Verdict {
    /// Whether the marker can be cut.
    pub fn is_sound(&self) -> bool {
        self.violations.is_empty()
    }
}

/// Checks every piece and every pair of a marker: no penetration deeper than [`PENETRATION_LIMIT`], gaps
/// kept, pieces between selvedges and end margins, orientations allowed, every copy laid or listed once,
/// length as stated.
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

/// Distance by which bounds extend beyond each side of the usable fabric (m); negative if they do not.
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
