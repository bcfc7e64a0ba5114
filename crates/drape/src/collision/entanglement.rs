//! Search for entanglement: crossings of cloth with cloth, and vertices on the wrong side of a layer.
//!
//! # Decided with
//! - [`crate::collision::intersections`], [`crate::collision::layers::layer_crossings`]: crossings within a
//!   layer and between layers;
//! - [`crate::collision`] (`recovery.rs`): direction that is not turned back, and the pull;
//! - [`crate::collision::contact_set::ContactSet::is_in_order`],
//!   [`crate::collision::contact_set::ContactSet::remember_crossings`]: tangled or not; remembered;
//! - [`crate::kinetic_damping::KineticDamping::watch_crossings`],
//!   [`crate::garment::GarmentRun::swing_again`]: the swing ends for a tangle and is taken again;
//! - [`crate::newton`] (`chord.rs`, `elimination.rs`): not used while there is a tangle;
//! - [`crate::xpbd::ClothContacts::min_substeps`]: XPBD looks sooner;
//! - [`crate::methods::implicit`]: the bound on energy does not hold;
//! - [`crate::collision::Tally`], [`crate::world`] (`transfer.rs`, `crossing_counts`): counted over a run,
//!   carried over an edit.
//!
//! Told by crate `session`, `verdict.rs`, `crossings.rs`.

use super::candidate_search::Near;
use super::intersections::crossings;
use super::layer_order::layer_order;
use super::layers::{LayerViolation, layer_violations};
use super::surface::ClothSurface;
use crate::PairPolicies;
use std::cmp::Ordering;
use toile_geometry::Vec3;

/// Largest distance searched for vertices on the wrong side of a layer (m): the ease of a wide garment.
const MAX_REACH: f64 = 0.15;

/// Distance added to the deepest violation for the search of the next detection (m).
const REACH_SLACK: f64 = 0.02;

/// Edges and faces that cross, and vertices on the wrong side of a layer, without pairs of objects that ignore each
/// other.
#[derive(Debug, Default)]
pub(super) struct Entanglement {
    /// Pairs of an edge and a face that cross within a layer, or without an order of layers.
    pub within: Vec<[u32; 2]>,
    /// Pairs of an edge and a face of two layers that cross.
    pub of_layers: Vec<[u32; 2]>,
    /// Vertices on the wrong side of a layer.
    pub violations: Vec<LayerViolation>,
    /// Distance within which the next detection searches for vertices on the wrong side of a layer (m). Zero once no
    /// layers cross and no vertex is on a wrong side: sides change only through a crossing.
    pub layer_reach: f64,
}

impl Entanglement {
    /// The entanglement at positions `x` of the features in the surface's neighbour lists. `reach` is the
    /// [`Self::layer_reach`] of the last detection, none at the first.
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
        found.find_violations(violations, reach.unwrap_or(MAX_REACH));
        found
    }

    /// Finds the vertices on the wrong side of a layer within `reach` (m), unless there can be none.
    fn find_violations(&mut self, within: impl Fn(f64) -> Vec<LayerViolation>, reach: f64) {
        let crossed = !self.of_layers.is_empty();
        if reach == 0.0 && !crossed {
            return;
        }
        self.violations = within(reach.max(REACH_SLACK));
        if crossed || !self.violations.is_empty() {
            let deepest = self.violations.iter().map(|violation| violation.depth);
            let deepest = deepest.fold(0.0, f64::max);
            self.layer_reach = (deepest + REACH_SLACK).min(MAX_REACH);
        }
    }

    /// Number of pairs of an edge and a face that cross.
    pub fn crossing_count(&self) -> usize {
        self.within.len() + self.of_layers.len()
    }
}
