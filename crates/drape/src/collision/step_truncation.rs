//! Step truncation: the displacements of single vertices are shortened until no two features of the cloth collide.

use super::curvature::Clearance;
use super::exemptions::ContactExemptions;
use super::feature_pair::FeaturePair;
use super::impact_pair::{IMPACT_REACH, ImpactPair};
use super::surface::ClothSurface;
use super::trajectories::LinearTrajectories;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Moves are shortened to this share of the time of impact, so that rounding does not find the same impact again.
const SHARE_OF_IMPACT_TIME: f64 = 1.0 - 1e-6;

/// Rounds in which the moves of colliding features are shortened; after these they are set to zero.
const SHORTENING_ROUNDS: usize = 6;

/// Shortens `moves` from positions `x` so that no two features of the cloth collide; exempt pairs may. Returns the
/// number of vertices whose moves were shortened.
pub fn truncate_moves(
    surface: &mut ClothSurface,
    exemptions: &ContactExemptions,
    x: &[Vec3],
    moves: &mut [Vec3],
) -> usize {
    let target: Vec<Vec3> = x.iter().zip(&*moves).map(|(x, d)| x + d).collect();
    let clearance = Clearance {
        offset: 0.0,
        max_drift: longest(moves.iter().map(|d| d.norm())),
    };
    let near = surface.near_leaves_unless_clear(
        LinearTrajectories::each(x, &target),
        IMPACT_REACH,
        clearance,
    );
    truncate_pairs(surface, &near, exemptions, x, moves)
}

/// Largest of some lengths (m); infinite where one is NaN.
fn longest(lengths: impl Iterator<Item = f64>) -> f64 {
    lengths.fold(0.0, |longest, length| {
        if length.is_nan() {
            f64::INFINITY
        } else {
            length.max(longest)
        }
    })
}

/// [`truncate_moves`] where all features that may collide are in the pairs of leaves `near`.
fn truncate_pairs(
    surface: &ClothSurface,
    near: &[[u32; 2]],
    exemptions: &ContactExemptions,
    x: &[Vec3],
    moves: &mut [Vec3],
) -> usize {
    // A collision with a third feature may stop either of two that move together, so common motion counts too.
    let approach = |pair: FeaturePair| {
        let longest = |range: std::ops::Range<usize>| {
            let vertices = pair.vertices();
            let lengths = vertices[range].iter().map(|&v| moves[v as usize].norm());
            lengths.fold(0.0, f64::max)
        };
        let first = pair.first();
        longest(0..first) + longest(first..4)
    };
    let mut pairs = surface.features(near, |pair, _, found| {
        let impact = ImpactPair::new(pair, x, approach(pair));
        found.extend(impact.filter(|_| !exemptions.exempts_impact(pair)));
    });
    let mut is_shortened = vec![false; x.len()];
    let mut round = 0;
    while !pairs.is_empty() {
        let times: Vec<Option<f64>> = pairs.par_iter().map(|p| p.time(x, moves)).collect();
        let mut share = vec![1.0f64; x.len()];
        let mut any_impact = false;
        for (impact, time) in pairs.iter().zip(&times) {
            let Some(time) = *time else { continue };
            any_impact = true;
            let share_of_pair = if round < SHORTENING_ROUNDS {
                SHARE_OF_IMPACT_TIME * time
            } else {
                0.0
            };
            for v in impact.pair.vertices() {
                share[v as usize] = share[v as usize].min(share_of_pair);
            }
        }
        if !any_impact {
            break;
        }
        for (v, &share) in share.iter().enumerate() {
            if share < 1.0 {
                moves[v] *= share;
                is_shortened[v] = true;
            }
        }
        pairs.retain(|impact| {
            let vertices = impact.pair.vertices();
            (vertices.iter()).any(|&v| moves[v as usize] != Vec3::zeros())
        });
        round += 1;
    }
    is_shortened.iter().filter(|&&shortened| shortened).count()
}
