//! Detection of contacts of cloth with cloth. The laws are those of contact with a solid, applied to the vector between
//! two features instead of the position of a point.
//!
//! # Decided with
//! - [`crate::contact_settings::ContactSettings`]: offset and stiffness;
//! - [`crate::collision`] (`surface.rs`), [`crate::collision::mollifier`]: room for the offset; edges that
//!   are nearly parallel;
//! - [`crate::rest_data`] (`lump`): friction and restitution of a vertex;
//! - [`crate::xpbd`] (`bounce.rs`, `bounce`), [`crate::method::MethodKind::supports`] (`features.rs`): XPBD
//!   alone lets impacts bounce;
//! - [`crate::collision::friction_memory::anchor`], [`crate::collision::friction_memory::after_step`]: where
//!   cloth sticks to cloth;
//! - [`crate::xpbd::ClothContacts`], [`crate::xpbd::Xpbd::store_cloth_friction`] (`cloth.rs`): detection and
//!   friction of cloth in XPBD;
//! - [`crate::collision::contact_set::ContactSet::remember_step`]: what a step leaves to the next.

use super::candidate_search::Near;
use super::cloth_contact::ClothContact;
use super::contact_set::ContactSet;
use super::curvature::Clearance;
use super::entanglement::Entanglement;
use super::exemptions::ContactExemptions;
use super::friction_memory;
use super::impact_resolution::{ImpactStats, resolve_impacts};
use super::memory::ClothMemory;
use super::mollifier::edge_mollifier;
use super::motions::Motions;
use super::nearness::Nearness;
use super::proximity::nearnesses;
use super::reach::Reach;
use super::step_truncation::truncate_moves;
use super::surface::ClothSurface;
use super::trajectories::LinearTrajectories;
use crate::Model;
use crate::laws::contact::{ContactLaw, ContactPlane, TANGENTIAL_RATIO};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec3;

/// The search structures of contact of cloth with cloth. A detection writes its results to a [`ContactSet`]; here only
/// search structures persist between detections, with more pairs than those within reach.
#[derive(Clone, Debug, Default)]
pub struct ContactDetector {
    surface: ClothSurface,
    /// Model that the surface was made for.
    made_for: Option<Model>,
    /// Positions at the start of the present step in time (m): contacts without memory are anchored there.
    pub(crate) step_start: Option<Vec<Vec3>>,
}

/// Reach of [`ContactDetector::refresh`], in contact offsets: pairs are contacts before they press.
const REACH_IN_OFFSETS: f64 = 2.0;

/// Depth at which the hard term of a contact sets in, as a share of the offset.
const HARD_FROM: f64 = 0.75;

/// Drift of a region's vertices from their common rigid motion after which it is given the curvature test again (m). A
/// smaller one has regions tested more often; with a larger one fewer regions pass.
const MAX_DRIFT: f64 = 1e-3;

impl ContactDetector {
    /// Clearance of regions that a search leaves out, for cloth with this contact offset (m).
    pub fn clearance(offset: f64) -> Clearance {
        Clearance {
            offset,
            max_drift: MAX_DRIFT,
        }
    }

    /// Surface of a model's cloth, rebuilt when the model is another one than at the last call.
    fn surface(&mut self, model: &Model) -> &mut ClothSurface {
        let is_same_cloth =
            |of: &Model| of.has_cloth_of(model) && Arc::ptr_eq(&of.layer, &model.layer);
        if !self.made_for.as_ref().is_some_and(is_same_cloth) {
            self.surface = ClothSurface::new(model);
            self.made_for = Some(model.clone());
        }
        &mut self.surface
    }

    /// Makes the next detection search the whole surface, so that it does not depend on earlier ones.
    pub fn forget(&mut self) {
        self.surface.forget();
    }

    /// Finds contacts within `reach` at positions `x`, crossings and layer violations, and from these the exempt pairs
    /// and the recovery forces. `memory` is that of the last step. Replaces the content of `set` and adds to its
    /// tally.
    pub fn detect(
        &mut self,
        model: &Model,
        memory: &ClothMemory,
        x: &[Vec3],
        reach: &Reach,
        set: &mut ContactSet,
    ) {
        set.contacts.clear();
        set.recovery.clear();
        set.exemptions.reset(model);
        (set.crossings, set.violations, set.layer_reach) = (0, 0, None);
        if model.contact.cloth_offset <= 0.0 {
            return;
        }
        let clearance = Self::clearance(model.contact.cloth_offset);
        self.surface(model)
            .query(LinearTrajectories::still(x), reach, clearance);
        let entangled = Entanglement::find(&self.surface, &model.policies, x, memory.layer_reach);
        set.crossings = entangled.crossing_count();
        set.violations = entangled.violations.len();
        set.layer_reach = Some(entangled.layer_reach);
        set.tally.count_detection(set.crossings, set.violations);
        (set.exemptions).mark(&self.surface, &entangled, &memory.crossing_counts);
        let exemptions = &set.exemptions;
        let mut found = nearnesses(&self.surface, Near::Listed, x, reach);
        found.retain(|near| {
            let vertices = near.pair.vertices();
            let fixed = vertices
                .iter()
                .all(|&v| model.prescribed.pinned[v as usize]);
            !fixed && !exemptions.exempts_contact(near.pair)
        });
        let contacts = found.par_iter().with_min_len(256);
        (set.contacts).par_extend(contacts.map(|near| self.contact(model, memory, x, near)));
        (set.recovery).plan(
            &self.surface,
            model,
            &entangled,
            (x, &memory.recovery_directions),
        );
    }

    /// [`Self::detect`] within two offsets, with the stiffness of edge-edge contacts multiplied by their mollifier, so
    /// that the force does not jump where such a contact appears or vanishes.
    pub fn refresh(
        &mut self,
        model: &Model,
        memory: &ClothMemory,
        x: &[Vec3],
        set: &mut ContactSet,
    ) {
        let reach = Reach::uniform(REACH_IN_OFFSETS * model.contact.cloth_offset);
        self.detect(model, memory, x, &reach, set);
        for contact in &mut set.contacts {
            let factor = edge_mollifier(contact, x);
            contact.law.normal *= factor;
            contact.law.tangential *= factor;
            if friction_memory::is_new(memory, contact) {
                contact.plane.lagged_normal_force *= factor;
            }
        }
    }

    fn contact(
        &self,
        model: &Model,
        memory: &ClothMemory,
        x: &[Vec3],
        near: &Nearness,
    ) -> ClothContact {
        let vertices = near.pair.vertices();
        let of = |values: &[f64]| {
            let four = vertices.iter().zip(near.weights);
            0.5 * four
                .map(|(&v, w)| values[v as usize] * w.abs())
                .sum::<f64>()
        };
        let offset = model.contact.cloth_offset;
        let offset = self
            .surface
            .contact_offset(near.pair, near.neighbours, offset);
        // Vertices of both sides make contacts with faces of the other side, so each contact has half of the area.
        let area = 0.5 * of(&self.surface.area);
        let law = ContactLaw {
            hard_from: HARD_FROM * offset,
            ..model.contact.law(area, of(&self.surface.friction))
        };
        let between = near.normal * near.distance;
        let remembered = friction_memory::anchor(memory, near, x);
        let (anchor, force) = remembered.unwrap_or_else(|| match &self.step_start {
            Some(from) => {
                let [_, force, _] = law.normal_spring(offset - near.distance);
                (between - near.slid(from, x), force)
            }
            None => (between, 0.0),
        });
        ClothContact {
            vertices,
            weights: near.weights,
            plane: ContactPlane {
                point: between,
                depth: offset - near.distance,
                gradient: near.normal,
                normal: near.normal,
                hollow: Matrix3::zeros(),
                bulge: Matrix3::zeros(),
                anchor,
                lagged_normal_force: force,
                returning: false,
                landing: false,
            },
            law: ContactLaw {
                // The tangential stiffness grows with the force, so that the slip at which cloth begins to slide is no
                // longer in the hard range of a contact than at the end of the soft range.
                tangential: TANGENTIAL_RATIO * law.normal.max(force / offset),
                ..law
            },
            restitution: self.restitution(vertices, near.weights),
            pair: Some(near.pair),
        }
    }

    /// Mean by weight of the restitution of the vertices that have one; none where no vertex has.
    fn restitution(&self, vertices: [u32; 4], weights: [f64; 4]) -> Option<f64> {
        let (mut sum, mut all) = (0.0, 0.0);
        for (v, w) in vertices.into_iter().zip(weights) {
            if let Some(e) = self.surface.restitution[v as usize] {
                sum += e * w.abs();
                all += w.abs();
            }
        }
        (all > 0.0).then(|| sum / all)
    }

    /// Corrects a motion so that cloth does not pass through cloth, except for exempt pairs.
    pub fn resolve_impacts(
        &mut self,
        model: &Model,
        exemptions: &ContactExemptions,
        motion: &mut Motions,
    ) -> ImpactStats {
        if model.contact.cloth_offset <= 0.0 {
            return ImpactStats::default();
        }
        let clearance = Self::clearance(model.contact.cloth_offset);
        resolve_impacts(self.surface(model), exemptions, motion, clearance)
    }

    /// Shortens displacements from `x` so that cloth does not pass through cloth, except for exempt pairs; returns the
    /// number of vertices whose displacement was shortened.
    pub fn truncate_moves(
        &mut self,
        model: &Model,
        exemptions: &ContactExemptions,
        x: &[Vec3],
        moves: &mut [Vec3],
    ) -> usize {
        if model.contact.cloth_offset <= 0.0 {
            return 0;
        }
        truncate_moves(self.surface(model), exemptions, x, moves)
    }
}
