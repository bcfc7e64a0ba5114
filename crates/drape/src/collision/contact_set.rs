//! Contacts of cloth with cloth from one detection. Forces, impact resolution, step truncation and the memory of the
//! state read this value.

use super::cloth_contact::ClothContact;
use super::exemptions::ContactExemptions;
use super::friction_memory;
use super::recovery::Recovery;
use super::tally::Tally;
use crate::{Model, State};

/// Contacts, exempt pairs and recovery forces of one detection.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The contacts, in order of their features.
    pub contacts: Vec<ClothContact>,
    /// Pairs exempt from contact, and pairs exempt from impacts.
    pub exemptions: ContactExemptions,
    /// Recovery forces on cloth that has crossed or is on the wrong side of a layer.
    pub recovery: Recovery,
    /// Number of pairs of an edge and a face that cross.
    pub crossings: usize,
    /// Number of vertices of outer layers on the wrong side of inner ones.
    pub violations: usize,
    /// Distance within which the next detection searches for vertices on the wrong side of a layer (m); none without
    /// a detection.
    pub layer_reach: Option<f64>,
    /// Counts over all detections so far.
    pub tally: Tally,
}

impl ContactSet {
    /// The contacts, then the recovery forces.
    pub fn all(&self) -> impl Iterator<Item = &ClothContact> {
        self.contacts.iter().chain(&self.recovery.pulls)
    }

    /// [`Self::all`], mutable.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut ClothContact> {
        self.contacts.iter_mut().chain(&mut self.recovery.pulls)
    }

    /// Whether there is neither a contact nor a recovery force.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty() && self.recovery.pulls.is_empty()
    }

    /// Whether no cloth crosses and no vertex is on the wrong side of a layer.
    pub fn is_in_order(&self) -> bool {
        self.crossings == 0 && self.violations == 0
    }

    /// Pairs of vertices that contacts and recovery forces couple.
    pub fn couples(&self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for contact in self.all() {
            let v = contact.vertices;
            pairs.extend((0..4).flat_map(|i| (0..i).map(move |j| [v[i], v[j]])));
        }
        pairs
    }

    /// Stores the recovery directions, crossing counts and layer reach in the state, for the next detection.
    pub fn remember_crossings(&self, state: &mut State) {
        (state.cloth.recovery_directions).clone_from(&self.recovery.directions);
        (state.cloth.crossing_counts).clone_from(&self.exemptions.crossing_counts);
        state.cloth.layer_reach = self.layer_reach.or(state.cloth.layer_reach);
    }

    /// Stores the end of a step in the state: positions, friction of the contacts that press, and
    /// [`Self::remember_crossings`].
    pub fn remember_step(&self, model: &Model, state: &mut State) {
        state.cloth.friction = friction_memory::after_step(&self.contacts, &state.positions);
        self.remember_crossings(state);
        if model.contact.cloth_offset > 0.0 {
            state.cloth.positions.clone_from(&state.positions);
        }
    }
}
