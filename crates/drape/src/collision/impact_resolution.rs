//! Resolution of collisions in a motion. Impulses along the normal, pair by pair, remove the approach of colliding
//! features and conserve momentum (Provot 1997; Bridson, Fedkiw and Anderson 2002). Features that still collide after
//! some rounds join rigid impact zones. If collisions remain after those, moves are truncated.

use super::candidate_search::Near;
use super::curvature::Clearance;
use super::exemptions::ContactExemptions;
use super::feature_pair::FeaturePair;
use super::impact_pair::{IMPACT_REACH, ImpactPair};
use super::motions::Motions;
use super::nearness::closest;
use super::reach::Reach;
use super::separation_filter::SeparationFilter;
use super::step_truncation::truncate_moves;
use super::surface::ClothSurface;
use super::trajectories::LinearTrajectories;
use super::zones::ImpactZones;
use toile_geometry::Vec3;

/// Rounds of impulses.
const IMPULSE_ROUNDS: usize = 10;

/// Impulses leave a pair its gap and this share of it more.
const EXCESS: f64 = 0.05;

/// Rounds in which rigid impact zones grow by the features that collide.
const ZONE_ROUNDS: usize = 12;

/// Numbers of corrections to a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImpactStats {
    /// Impulses applied.
    pub impulses: usize,
    /// Vertices in rigid zones, where impulses did not resolve the collisions.
    pub zoned: usize,
    /// Vertices whose moves were truncated.
    pub cut: usize,
}

/// Corrects a motion so that no two features of the cloth pass through each other. Exempt pairs may, and regions that
/// keep their `clearance` in the motion as given are not searched.
pub fn resolve_impacts(
    surface: &mut ClothSurface,
    exemptions: &ContactExemptions,
    motion: &mut Motions,
    clearance: Clearance,
) -> ImpactStats {
    let mut stats = ImpactStats::default();
    let mut zones = ImpactZones::new(motion.x.len());
    // Vertices whose moves changed in the last round; none in the first, which tests all pairs.
    let mut changed: Option<Vec<bool>> = None;
    for round in 0..IMPULSE_ROUNDS + ZONE_ROUNDS {
        let target = ends(motion.x, motion.moves);
        let trajectories = LinearTrajectories::together(motion.x, &target);
        surface.query_marked(
            trajectories,
            &Reach::uniform(IMPACT_REACH),
            clearance,
            changed.as_deref(),
        );
        let impacts = find_impacts(surface, exemptions, motion, (&target, changed.as_deref()));
        if impacts.is_empty() {
            stats.zoned = zones.count();
            return stats;
        }
        let changed = changed.insert(vec![false; motion.x.len()]);
        for (impact, _) in &impacts {
            for v in impact.pair.vertices() {
                changed[v as usize] = true;
            }
        }
        if round < IMPULSE_ROUNDS {
            for &(impact, time) in &impacts {
                stats.impulses += usize::from(apply_impulse(&impact, time, motion));
            }
            continue;
        }
        for (impact, _) in &impacts {
            zones.join(impact.pair.vertices(), motion.inverse_mass);
        }
        zones.make_rigid(motion);
        for &v in zones.members() {
            changed[v as usize] = true;
        }
    }
    stats.zoned = zones.count();
    stats.cut = truncate_relative_moves(surface, exemptions, motion);
    stats
}

/// Truncates moves relative to the mean motion, by which nothing collides, and velocities in the same proportion.
/// Where vertices are pinned the mean counts as zero. Returns the number of vertices whose moves were shortened.
fn truncate_relative_moves(
    surface: &mut ClothSurface,
    exemptions: &ContactExemptions,
    motion: &mut Motions,
) -> usize {
    let any_pinned = motion.inverse_mass.contains(&0.0);
    let count = motion.moves.len().max(1) as f64;
    let divisor = if any_pinned { f64::INFINITY } else { count };
    let mean = |all: &[Vec3]| all.iter().sum::<Vec3>() / divisor;
    let (mean_move, mean_velocity) = (mean(motion.moves), mean(motion.velocities));
    for d in motion.moves.iter_mut() {
        *d -= mean_move;
    }
    let before = motion.moves.to_vec();
    let shortened = truncate_moves(surface, exemptions, motion.x, motion.moves);
    let moved = motion.moves.iter_mut().zip(motion.velocities.iter_mut());
    for ((d, v), before) in moved.zip(&before) {
        if d != before {
            let share = d.norm() / before.norm();
            *v = mean_velocity + (*v - mean_velocity) * share;
        }
        *d += mean_move;
    }
    shortened
}

/// Positions at the ends of some moves (m).
fn ends(x: &[Vec3], moves: &[Vec3]) -> Vec<Vec3> {
    x.iter().zip(moves).map(|(x, d)| x + d).collect()
}

/// Pairs that collide in a motion to `target` (m), sorted, with the times of impact in 0..=1. Where vertices are marked
/// as `changed`, only pairs with one of them.
fn find_impacts(
    surface: &ClothSurface,
    exemptions: &ContactExemptions,
    motion: &Motions,
    (target, changed): (&[Vec3], Option<&[bool]>),
) -> Vec<(ImpactPair, f64)> {
    let (x, moves) = (motion.x, &*motion.moves);
    let approach = |pair: FeaturePair| {
        let of_vertices = pair.vertices().map(|v| moves[v as usize]);
        let mean = of_vertices.iter().sum::<Vec3>() / 4.0;
        2.0 * of_vertices
            .map(|d| (d - mean).norm_squared())
            .into_iter()
            .fold(0.0, f64::max)
            .sqrt()
    };
    let filter = SeparationFilter::together(x, target, IMPACT_REACH);
    let mut impacts = surface.filtered(Near::Listed, Some(&filter), |pair, _, found| {
        let is_changed = |flags: &[bool]| pair.vertices().iter().any(|&v| flags[v as usize]);
        if !changed.is_none_or(is_changed) {
            return;
        }
        if let Some(impact) = ImpactPair::new(pair, x, approach(pair))
            && !exemptions.exempts_impact(pair)
            && let Some(time) = impact.time(x, moves)
        {
            found.push((impact, time));
        }
    });
    impacts.sort_unstable_by_key(|(impact, _): &(ImpactPair, f64)| impact.pair);
    impacts
}

/// Applies the impulse at the time of impact that leaves two features their gap at the end of the motion. Returns
/// whether one was needed.
fn apply_impulse(impact: &ImpactPair, time: f64, motion: &mut Motions) -> bool {
    let vertices = impact.pair.vertices().map(|v| v as usize);
    let positions = |time: f64| vertices.map(|v| motion.x[v] + motion.moves[v] * time);
    let at_impact = positions(time);
    let w = closest(impact.pair, &at_impact);
    let weighted = |p: &[Vec3; 4]| p.iter().zip(w).map(|(p, w)| p * w).sum::<Vec3>();
    let Some(n) = weighted(&at_impact).try_normalize(0.0) else {
        return false;
    };
    // Impulses of other pairs, applied since the time was found, may have reversed the order of the features.
    let n = if n.dot(&weighted(&positions(0.0))) < 0.0 {
        -n
    } else {
        n
    };
    let inverse_mass = vertices.map(|v| motion.inverse_mass[v]);
    let effective_inverse_mass: f64 = inverse_mass.iter().zip(w).map(|(l, w)| l * w * w).sum();
    let lacking = (1.0 + EXCESS) * impact.gap - n.dot(&weighted(&positions(1.0)));
    if effective_inverse_mass <= 0.0 || lacking <= 0.0 {
        return false;
    }
    let velocity = |k: usize| {
        if inverse_mass[k] > 0.0 {
            motion.velocities[vertices[k]]
        } else {
            motion.moves[vertices[k]] / motion.span
        }
    };
    let separation_speed = n.dot(&weighted(&[
        velocity(0),
        velocity(1),
        velocity(2),
        velocity(3),
    ]));
    for k in 0..4 {
        let share = n * (w[k] * inverse_mass[k] / effective_inverse_mass);
        motion.moves[vertices[k]] += share * lacking;
        motion.velocities[vertices[k]] += share * (-separation_speed).max(0.0);
    }
    true
}
