//! Pairs of features that may collide in a motion, the gap that each must keep, and the time of impact.

use super::feature_pair::FeaturePair;
use super::impact::{edge_edge_impact, vertex_face_impact};
use super::nearness::{Nearness, is_far};
use toile_geometry::Vec3;

/// Two features keep this share of their distance in one motion, up to `MAX_GAP` (m).
const GAP_PER_DISTANCE: f64 = 0.2;
const MAX_GAP: f64 = 5e-4;

/// Distance (m) up to which features keep `SMALL_GAP_PER_DISTANCE` of it. With the share above, features pressed
/// together for long would come nearer than rounding can tell, and pass.
const SMALL_DISTANCE: f64 = 1e-4;
const SMALL_GAP_PER_DISTANCE: f64 = 0.9;

/// Distance (m) up to which features keep `TINY_GAP_PER_DISTANCE` of it. Features come so near only in more than two
/// hundred motions under pressure; with this share cloth pressed for a minute does not touch.
const TINY_DISTANCE: f64 = 1e-7;
const TINY_GAP_PER_DISTANCE: f64 = 0.999;

/// Features nearer than this touch already (m): recovery leads them apart, not impulses or truncation.
const TOUCHING: f64 = 1e-12;

/// Distance within which the trajectories of two features must come for an impact (m): the largest gap of any pair.
pub const IMPACT_REACH: f64 = MAX_GAP;

/// Two features that may collide, and the gap that they must keep.
#[derive(Clone, Copy, Debug)]
pub struct ImpactPair {
    /// The features.
    pub pair: FeaturePair,
    /// Distance that they must keep (m).
    pub gap: f64,
}

impl ImpactPair {
    /// The pair, unless its features are so far apart at positions `x` that they keep their gap even when they approach
    /// each other by `approach` (m), or touch already.
    pub fn new(pair: FeaturePair, x: &[Vec3], approach: f64) -> Option<Self> {
        let reach = (approach / (1.0 - GAP_PER_DISTANCE))
            .min(MAX_GAP + approach)
            .max((SMALL_DISTANCE + approach).min(approach / (1.0 - SMALL_GAP_PER_DISTANCE)))
            .max((TINY_DISTANCE + approach).min(approach / (1.0 - TINY_GAP_PER_DISTANCE)));
        if is_far(pair, &pair.vertices().map(|v| x[v as usize]), reach) {
            return None;
        }
        let distance = Nearness::distance(pair, x);
        if distance > reach || distance < TOUCHING {
            return None;
        }
        let gap = (GAP_PER_DISTANCE * distance)
            .min(MAX_GAP)
            .max(SMALL_GAP_PER_DISTANCE * distance.min(SMALL_DISTANCE));
        Some(Self {
            pair,
            gap: gap.max(TINY_GAP_PER_DISTANCE * distance.min(TINY_DISTANCE)),
        })
    }

    /// Time in 0..=1 at which the features come to their gap on the moves from `x` (m); none where they keep it.
    pub fn time(&self, x: &[Vec3], moves: &[Vec3]) -> Option<f64> {
        let vertices = self.pair.vertices().map(|v| v as usize);
        let start = vertices.map(|v| x[v]);
        let end = vertices.map(|v| x[v] + moves[v]);
        match self.pair {
            FeaturePair::VertexFace(_) => vertex_face_impact(&start, &end, self.gap),
            FeaturePair::EdgeEdge(_) => edge_edge_impact(&start, &end, self.gap),
        }
    }
}
