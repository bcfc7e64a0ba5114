//! How far a motion may go. Where features would meet on the way, impulses along their normal take
//! back what brings them together, pair by pair, each keeping momentum (Provot 1997; Bridson, Fedkiw
//! and Anderson 2002). What still meets after some rounds of that moves as one; what meets
//! even then is cut, vertex by vertex, until nothing meets any more.

use super::curvature::{Clearance, longest};
use super::exemptions::ContactExemptions;
use super::feature_pair::FeaturePair;
use super::impact::{edge_edge_impact, vertex_face_impact};
use super::motions::Motions;
use super::nearness::{Nearness, closest, is_far};
use super::reach::Reach;
use super::separation_filter::SeparationFilter;
use super::surface::{ClothSurface, Near};
use super::trajectories::LinearTrajectories;
use super::zones::Zones;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Least share of their distance that two features keep in one move, and the most that they have to keep [m].
const KEPT: f64 = 0.2;
const MOST_KEPT: f64 = 5e-4;

/// Features nearer than this touch already [m]: recovery parts them, not the truncation of moves.
const TOUCHING: f64 = 1e-12;

/// Below this distance [m] features keep the share `KEPT_AT_FLOOR` of it: pressed for long, they would else
/// come nearer than rounding can tell, and pass.
const FLOOR: f64 = 1e-4;
const KEPT_AT_FLOOR: f64 = 0.9;

/// Below this distance [m], which features come to in more than two hundred moves under pressure, they keep the
/// share `KEPT_AT_LEAST` of it: cloth pressed for a minute still does not touch.
const LEAST: f64 = 1e-7;
const KEPT_AT_LEAST: f64 = 0.999;

/// Moves are cut to this share of the time of impact, so that rounding does not find the same impact again.
const SHORT: f64 = 1.0 - 1e-6;

/// Rounds of impulses, and how far they aim beyond the distance to be kept, as a share of it.
const IMPULSE_ROUNDS: usize = 10;
const BEYOND: f64 = 0.05;

/// Rounds in which rigid zones grow by the features that they meet.
const ZONE_ROUNDS: usize = 12;

/// Rounds in which moves are shortened; features that meet even then are stopped.
const ROUNDS: usize = 6;

/// Two features that may meet, and the distance they must keep [m].
#[derive(Clone, Copy, Debug)]
struct Meeting {
    pair: FeaturePair,
    gap: f64,
}

impl Meeting {
    fn time(&self, x: &[Vec3], moves: &[Vec3]) -> Option<f64> {
        let vertices = self.pair.vertices().map(|v| v as usize);
        let start = vertices.map(|v| x[v]);
        let end = vertices.map(|v| x[v] + moves[v]);
        match self.pair {
            FeaturePair::VertexFace(_) => vertex_face_impact(&start, &end, self.gap),
            FeaturePair::EdgeEdge(_) => edge_edge_impact(&start, &end, self.gap),
        }
    }
}

/// How a motion was corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImpactStats {
    /// Impulses given.
    pub impulses: usize,
    /// Vertices that moved in rigid zones because impulses did not settle.
    pub zoned: usize,
    /// Vertices whose moves were cut.
    pub cut: usize,
}

/// Corrects a motion so that no two features of the cloth meet on the way; pairs that
/// are exempt are left alone, and so are regions that keep their `clearance` in the motion given.
pub fn resolve_impacts(
    surface: &mut ClothSurface,
    exemptions: &ContactExemptions,
    motion: &mut Motions,
    clearance: Clearance,
) -> ImpactStats {
    let mut kept = ImpactStats::default();
    let mut zones = Zones::new(motion.x.len());
    // Vertices whose moves may not be what they were when nothing else met.
    let mut stirred: Option<Vec<bool>> = None;
    for round in 0..IMPULSE_ROUNDS + ZONE_ROUNDS {
        let target = ends(motion.x, motion.moves);
        let ways = LinearTrajectories::together(motion.x, &target);
        surface.look_again(
            ways,
            &Reach::all(IMPACT_REACH),
            clearance,
            stirred.as_deref(),
        );
        let met = met(surface, exemptions, motion, (&target, stirred.as_deref()));
        if met.is_empty() {
            kept.zoned = zones.count();
            return kept;
        }
        let stirred = stirred.insert(vec![false; motion.x.len()]);
        for (meeting, _) in &met {
            for v in meeting.pair.vertices() {
                stirred[v as usize] = true;
            }
        }
        if round < IMPULSE_ROUNDS {
            for &(meeting, time) in &met {
                kept.impulses += usize::from(apply_impulse(&meeting, time, motion));
            }
            continue;
        }
        for (meeting, _) in &met {
            zones.join(meeting.pair.vertices(), motion.lightness);
        }
        zones.stiffen(motion);
        for &v in zones.members() {
            stirred[v as usize] = true;
        }
    }
    kept.zoned = zones.count();
    // Cut about the mean motion, which nothing can meet by.
    let held = motion.lightness.contains(&0.0);
    let count = motion.moves.len().max(1) as f64;
    let mean = |all: &[Vec3]| all.iter().sum::<Vec3>() / if held { f64::INFINITY } else { count };
    let (drift, speed) = (mean(motion.moves), mean(motion.velocities));
    for d in motion.moves.iter_mut() {
        *d -= drift;
    }
    let before = motion.moves.to_vec();
    kept.cut = truncate_moves(surface, exemptions, motion.x, motion.moves);
    let moved = motion.moves.iter_mut().zip(motion.velocities.iter_mut());
    for ((d, v), before) in moved.zip(&before) {
        if d != before {
            let share = d.norm() / before.norm();
            *v = speed + (*v - speed) * share;
        }
        *d += drift;
    }
    kept
}

/// Where moves lead [m].
fn ends(x: &[Vec3], moves: &[Vec3]) -> Vec<Vec3> {
    x.iter().zip(moves).map(|(x, d)| x + d).collect()
}

/// Features that meet in a motion to `target` [m], sorted, with the times; where some vertices are `stirred`, only those with
/// one of these.
fn met(
    surface: &ClothSurface,
    exemptions: &ContactExemptions,
    motion: &Motions,
    (target, stirred): (&[Vec3], Option<&[bool]>),
) -> Vec<(Meeting, f64)> {
    let (x, moves) = (motion.x, &*motion.moves);
    let way = |pair: FeaturePair| {
        let ways = pair.vertices().map(|v| moves[v as usize]);
        let mean = ways.iter().sum::<Vec3>() / 4.0;
        2.0 * ways
            .map(|d| (d - mean).norm_squared())
            .into_iter()
            .fold(0.0, f64::max)
            .sqrt()
    };
    let filter = SeparationFilter::together(x, target, IMPACT_REACH);
    let mut found = surface.filtered(Near::Listed, Some(&filter), |pair, _, found| {
        let is_stirred = |flags: &[bool]| pair.vertices().iter().any(|&v| flags[v as usize]);
        if !stirred.is_none_or(is_stirred) {
            return;
        }
        if let Some(meeting) = meeting(pair, x, way(pair))
            && !exemptions.exempts_impact(pair)
            && let Some(time) = meeting.time(x, moves)
        {
            found.push((meeting, time));
        }
    });
    found.sort_unstable_by_key(|(meeting, _): &(Meeting, f64)| meeting.pair);
    found
}

/// Applies the impulse that keeps two features apart at the end of the motion; returns whether one was needed.
fn apply_impulse(meeting: &Meeting, time: f64, motion: &mut Motions) -> bool {
    let vertices = meeting.pair.vertices().map(|v| v as usize);
    let place = |share: f64| vertices.map(|v| motion.x[v] + motion.moves[v] * share);
    let then = place(time);
    let w = closest(meeting.pair, &then);
    let sum = |p: &[Vec3; 4]| p.iter().zip(w).map(|(p, w)| p * w).sum::<Vec3>();
    let Some(n) = sum(&then).try_normalize(0.0) else {
        return false;
    };
    // Impulses given since the time was found may have brought them past each other then.
    let n = if n.dot(&sum(&place(0.0))) < 0.0 {
        -n
    } else {
        n
    };
    let lightness = vertices.map(|v| motion.lightness[v]);
    let yielding: f64 = lightness.iter().zip(w).map(|(l, w)| l * w * w).sum();
    let lacking = (1.0 + BEYOND) * meeting.gap - n.dot(&sum(&place(1.0)));
    if yielding <= 0.0 || lacking <= 0.0 {
        return false;
    }
    let velocity = |k: usize| {
        if lightness[k] > 0.0 {
            motion.velocities[vertices[k]]
        } else {
            motion.moves[vertices[k]] / motion.span
        }
    };
    let leaving = n.dot(&sum(&[velocity(0), velocity(1), velocity(2), velocity(3)]));
    for k in 0..4 {
        let share = n * (w[k] * lightness[k] / yielding);
        motion.moves[vertices[k]] += share * lacking;
        motion.velocities[vertices[k]] += share * (-leaving).max(0.0);
    }
    true
}

/// Shortens `moves` so that no two features of the cloth meet on the way; pairs that
/// are exempt are left alone. Returns the number of vertices held back.
pub fn truncate_moves(
    surface: &mut ClothSurface,
    exemptions: &ContactExemptions,
    x: &[Vec3],
    moves: &mut [Vec3],
) -> usize {
    let target = ends(x, moves);
    let clearance = Clearance {
        kept: 0.0,
        beyond: longest(moves.iter().map(|d| d.norm())),
    };
    let near = surface.near_unless_clear(
        LinearTrajectories::each(x, &target),
        IMPACT_REACH,
        clearance,
    );
    truncate_pairs(surface, &near, exemptions, x, moves)
}

/// [`truncate_moves`] for pairs of leaves that hold all features which may meet.
fn truncate_pairs(
    surface: &ClothSurface,
    near: &[[u32; 2]],
    exemptions: &ContactExemptions,
    x: &[Vec3],
    moves: &mut [Vec3],
) -> usize {
    // One of two that go together may be held by a third: each counts with its whole way.
    let way = |pair: FeaturePair| {
        let long = |range: std::ops::Range<usize>| {
            let vertices = pair.vertices();
            let lengths = vertices[range].iter().map(|&v| moves[v as usize].norm());
            lengths.fold(0.0, f64::max)
        };
        let first = pair.first();
        long(0..first) + long(first..4)
    };
    let mut meetings = surface.features(near, |pair, _, found| {
        found.extend(meeting(pair, x, way(pair)).filter(|_| !exemptions.exempts_impact(pair)));
    });
    let mut held = vec![false; x.len()];
    let mut round = 0;
    while !meetings.is_empty() {
        let times: Vec<Option<f64>> = meetings.par_iter().map(|m| m.time(x, moves)).collect();
        let mut share = vec![1.0f64; x.len()];
        let mut met = false;
        for (meeting, time) in meetings.iter().zip(&times) {
            let Some(time) = *time else { continue };
            met = true;
            let share_of = if round < ROUNDS { SHORT * time } else { 0.0 };
            for v in meeting.pair.vertices() {
                share[v as usize] = share[v as usize].min(share_of);
            }
        }
        if !met {
            break;
        }
        for (v, &share) in share.iter().enumerate() {
            if share < 1.0 {
                moves[v] *= share;
                held[v] = true;
            }
        }
        meetings.retain(|m| {
            m.pair
                .vertices()
                .iter()
                .any(|&v| moves[v as usize] != Vec3::zeros())
        });
        round += 1;
    }
    held.iter().filter(|&&h| h).count()
}

/// How near the trajectories of two features must come for an impact [m]: the most that is ever kept.
const IMPACT_REACH: f64 = MOST_KEPT;

/// A pair that may meet when its features come nearer by up to `way` [m]: its distance is less.
fn meeting(pair: FeaturePair, x: &[Vec3], way: f64) -> Option<Meeting> {
    let reach = (way / (1.0 - KEPT))
        .min(MOST_KEPT + way)
        .max((FLOOR + way).min(way / (1.0 - KEPT_AT_FLOOR)))
        .max((LEAST + way).min(way / (1.0 - KEPT_AT_LEAST)));
    if is_far(pair, &pair.vertices().map(|v| x[v as usize]), reach) {
        return None;
    }
    let distance = Nearness::distance(pair, x);
    if distance > reach || distance < TOUCHING {
        return None;
    }
    let gap = (KEPT * distance)
        .min(MOST_KEPT)
        .max(KEPT_AT_FLOOR * distance.min(FLOOR));
    Some(Meeting {
        pair,
        gap: gap.max(KEPT_AT_LEAST * distance.min(LEAST)),
    })
}
