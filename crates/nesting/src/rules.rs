//! The referee's rules of the trade: grain, nap, pairs, folds, print, flaws, locked pieces.

use crate::marker::Phase;
use crate::violation::{PENETRATION_LIMIT, Violation, beyond_limit};
use crate::{Fold, FoldEdge, Item, Marker, Mirror, Nap, Placement, Strip};
use std::collections::BTreeMap;
use toile_geometry::{PreparedPolygon, Vec2, intersection, total_area};

/// Angles that differ by less than this count as equal (rad).
const SAME_ANGLE: f64 = 1e-9;

/// Index of a placement, with its item and its outline on the strip.
pub(crate) type Laid<'a> = (usize, &'a Item, PreparedPolygon);

/// Checks all rules for single pieces, the print, and garments that run one way.
pub(crate) fn check_rules(
    strip: &Strip,
    laid: &[Laid<'_>],
    marker: &Marker,
    violations: &mut Vec<Violation>,
) {
    let flaws = strip.flaws.iter().map(|d| PreparedPolygon::new(&d.outline));
    let flaws: Vec<PreparedPolygon> = flaws.collect();
    for (k, item, outline) in laid {
        let placement = &marker.placements[*k];
        violations.extend(check_orientation(*k, placement, item, strip));
        violations.extend(check_fold(*k, placement, (item, outline), strip));
        violations.extend(check_locked(*k, placement, item));
        for (number, flaw) in flaws.iter().enumerate() {
            let clearance = strip.flaws[number].clearance;
            if !item.over_flaws && too_near(outline, flaw, clearance) {
                violations.push(Violation::OnFlaw {
                    placement: *k,
                    flaw: number,
                    area: total_area(&intersection(outline.polygon(), flaw.polygon())),
                });
            }
        }
    }
    check_nap(strip, laid, marker, violations);
    check_print(strip, laid, marker, violations);
}

fn too_near(outline: &PreparedPolygon, flaw: &PreparedPolygon, clearance: f64) -> bool {
    if outline.overlaps(flaw) {
        return outline.penetration_depth(flaw) > PENETRATION_LIMIT || clearance > 0.0;
    }
    outline.distance(flaw) < clearance - PENETRATION_LIMIT
}

fn check_orientation(
    index: usize,
    placement: &Placement,
    item: &Item,
    strip: &Strip,
) -> Option<Violation> {
    let tilt = item.allowed.tilt + SAME_ANGLE;
    let near = |turn: f64| {
        let apart = (placement.turn - turn).rem_euclid(std::f64::consts::TAU);
        apart.min(std::f64::consts::TAU - apart) < tilt
    };
    let turned = item.allowed.turns.iter().any(|&t| near(t));
    let with_nap = match strip.nap {
        Nap::None => true,
        Nap::OneWay => near(0.0),
        Nap::PerBundle => near(0.0) || near(std::f64::consts::PI),
    };
    let sided = match item.allowed.mirror {
        Mirror::Never => !placement.mirrored,
        Mirror::Pairs => placement.mirrored == (placement.copy % 2 == 1),
        Mirror::Always => placement.mirrored,
        Mirror::Free => true,
    };
    (!turned || !with_nap || !sided).then_some(Violation::Orientation {
        placement: index,
        turn: placement.turn,
        mirrored: placement.mirrored,
    })
}

/// Checks that the straight edge of a piece lies on the fold, with the piece on the inner side.
fn check_fold(
    index: usize,
    placement: &Placement,
    (item, outline): (&Item, &PreparedPolygon),
    strip: &Strip,
) -> Option<Violation> {
    let edge = item.fold_edge?;
    let bounds = outline.bounds();
    // Half a turn and turning over each bring the upper side down.
    let flipped = placement.mirrored != (placement.turn.cos() < 0.0);
    let lower = (edge == FoldEdge::Lower) != flipped;
    let along = placement.turn.sin().abs() < SAME_ANGLE;
    let by = match (strip.fold, lower) {
        _ if !along => f64::INFINITY,
        (Fold::Lower | Fold::Both, true) => bounds.min.y.abs(),
        (Fold::Both, false) => (bounds.max.y - strip.width).abs(),
        _ => f64::INFINITY,
    };
    beyond_limit(by).then_some(Violation::OffFold {
        placement: index,
        by,
    })
}

fn check_locked(index: usize, placement: &Placement, item: &Item) -> Option<Violation> {
    let lock = item.locked.iter().find(|l| l.copy == placement.copy)?;
    let moved = (lock.translation - placement.translation).norm();
    let apart = (lock.turn - placement.turn).rem_euclid(std::f64::consts::TAU);
    let same = !beyond_limit(moved)
        && apart.min(std::f64::consts::TAU - apart) < SAME_ANGLE
        && lock.mirrored == placement.mirrored;
    (!same).then_some(Violation::Moved { placement: index })
}

fn check_nap(strip: &Strip, laid: &[Laid<'_>], marker: &Marker, violations: &mut Vec<Violation>) {
    if strip.nap != Nap::PerBundle {
        return;
    }
    let mut ways: BTreeMap<u32, (usize, bool)> = BTreeMap::new();
    for (k, item, _) in laid {
        let placement = &marker.placements[*k];
        let bundle = item.bundle(placement.copy);
        let forward = placement.turn.cos() >= 0.0;
        let (first, way) = *ways.entry(bundle).or_insert((*k, forward));
        if way != forward {
            violations.push(Violation::Nap {
                pair: [first, *k],
                bundle,
            });
        }
    }
}

fn check_print(strip: &Strip, laid: &[Laid<'_>], marker: &Marker, violations: &mut Vec<Violation>) {
    let Some(stripes) = strip.stripes else {
        return;
    };
    let mut sets: BTreeMap<u32, Vec2> = BTreeMap::new();
    for (k, item, _) in laid {
        let Some(point) = item.match_point else {
            continue;
        };
        let at = marker.placements[*k].pose(item).apply(point.point);
        let wanted = match point.phase {
            Phase::At(phase) => stripes.origin + phase,
            Phase::Set(set) => *sets.entry(set).or_insert(at),
        };
        let off = |axis: usize| match stripes.repeat[axis] {
            repeat if repeat > 0.0 => {
                let apart = (at[axis] - wanted[axis]).rem_euclid(repeat);
                apart.min(repeat - apart)
            }
            _ => 0.0,
        };
        let by = Vec2::new(off(0), off(1));
        if beyond_limit(by.x) || beyond_limit(by.y) {
            violations.push(Violation::OffPrint { placement: *k, by });
        }
    }
}
