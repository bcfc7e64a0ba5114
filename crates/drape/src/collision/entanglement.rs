//! Where cloth has crossed cloth, or lies on the wrong side of a layer that it is worn over.

use super::candidate_search::Near;
use super::intersections::crossings;
use super::layer_order::layer_order;
use super::layers::{LayerViolation, layer_violations};
use super::surface::ClothSurface;
use crate::PairPolicies;
use std::cmp::Ordering;
use toile_geometry::Vec3;

/// How far inside an inner layer the cloth of an outer one may start [m]: the ease of a wide garment.
const LONGEST_REACH: f64 = 0.15;

/// How much deeper than the deepest violation found the next detection searches [m].
const REACH_SLACK: f64 = 0.02;

/// Edges and faces that cross, and vertices on the wrong side of a layer; those of objects that ignore each
/// other left out.
#[derive(Debug, Default)]
pub(super) struct Entanglement {
    /// Edges and faces that cross within a layer, or in no order of layers.
    pub within: Vec<[u32; 2]>,
    /// Edges and faces of two layers that cross.
    pub of_layers: Vec<[u32; 2]>,
    /// Vertices on the wrong side of a layer.
    pub violations: Vec<LayerViolation>,
    /// How far from a layer the next detection is to search for vertices on its wrong side [m]: zero where
    /// there can be none, since layers that do not cross do not change sides.
    pub layer_reach: f64,
}

impl Entanglement {
    /// What is entangled at positions `x`, of the features in the surface's lists. `reach` is the
    /// [`Self::layer_reach`] of the detection before; none at the first.
    pub fn find(
        surface: &ClothSurface,
        policies: &PairPolicies,
        x: &[Vec3],
        reach: Option<f64>,
    ) -> Self {
        let is_within = |&[e, t]: &[u32; 2]| {
            let (edge, face) = (surface.edges[e as usize], surface.triangles[t as usize]);
            layer_order(&surface.layer, edge[0], face[0]) == Ordering::Equal
        };
        let mut crossed = crossings(surface, Near::Listed, x);
        crossed.retain(|&[e, t]| {
            let (edge, face) = (surface.edges[e as usize], surface.triangles[t as usize]);
            !policies.ignores(&edge, &face)
        });
        let (within, of_layers): (Vec<_>, Vec<_>) = crossed.into_iter().partition(is_within);
        let mut found = Self {
            within,
            of_layers,
            ..Self::default()
        };
        let violations = |reach| layer_violations(surface, policies, x, reach);
        found.find_violations(violations, reach.unwrap_or(LONGEST_REACH));
        found
    }

    /// Finds vertices on the wrong side of a layer, no farther off than `reach` [m], where there may be any.
    fn find_violations(&mut self, within: impl Fn(f64) -> Vec<LayerViolation>, reach: f64) {
        let crossed = !self.of_layers.is_empty();
        if reach == 0.0 && !crossed {
            return;
        }
        self.violations = within(reach.max(REACH_SLACK));
        if crossed || !self.violations.is_empty() {
            let deepest = self.violations.iter().map(|violation| violation.depth);
            let deepest = deepest.fold(0.0, f64::max);
            self.layer_reach = (deepest + REACH_SLACK).min(LONGEST_REACH);
        }
    }

    /// How many edges cross a face.
    pub fn crossing_count(&self) -> usize {
        self.within.len() + self.of_layers.len()
    }
}
