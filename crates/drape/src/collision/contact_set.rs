//! Contacts of cloth with cloth as one detection found them: a value that is handed to forces, to
//! impacts, to the truncation of steps and to the memory of a state.

use super::cloth_contact::ClothContact;
use super::exemptions::ContactExemptions;
use super::friction_memory;
use super::recovery::Recovery;
use super::tally::Tally;
use crate::{Model, State};

/// Contacts, what is exempt from them, and the pulls on what has crossed.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The contacts, in order of their features.
    pub contacts: Vec<ClothContact>,
    /// Pairs that make no contact, or may pass through each other.
    pub exemptions: ContactExemptions,
    /// The pulls on what has crossed or is on the wrong side of a layer.
    pub recovery: Recovery,
    /// Pairs of an edge and a face that cross.
    pub crossings: usize,
    /// Vertices of outer layers on the wrong side of inner ones.
    pub violations: usize,
    /// How far from a layer the next detection is to search for vertices on its wrong side [m]; none where
    /// none was made.
    pub layer_reach: Option<f64>,
    /// Counts over the detections so far.
    pub tally: Tally,
}

impl ContactSet {
    /// The contacts, then the pulls.
    pub fn all(&self) -> impl Iterator<Item = &ClothContact> {
        self.contacts.iter().chain(&self.recovery.pulls)
    }

    /// [`Self::all`], to be changed.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut ClothContact> {
        self.contacts.iter_mut().chain(&mut self.recovery.pulls)
    }

    /// Whether there is neither a contact nor a pull.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty() && self.recovery.pulls.is_empty()
    }

    /// Whether nothing crosses and nothing is on the wrong side of a layer.
    pub fn is_in_order(&self) -> bool {
        self.crossings == 0 && self.violations == 0
    }

    /// Pairs of vertices that contacts and pulls couple.
    pub fn couples(&self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for contact in self.all() {
            let v = contact.vertices;
            pairs.extend((0..4).flat_map(|i| (0..i).map(move |j| [v[i], v[j]])));
        }
        pairs
    }

    /// Has a state remember crossings and layers for the next detection.
    pub fn remember(&self, state: &mut State) {
        state.cloth.drawn.clone_from(&self.recovery.directions);
        (state.cloth.crossed_for).clone_from(&self.exemptions.crossed_for);
        state.cloth.layer_reach = self.layer_reach.or(state.cloth.layer_reach);
    }

    /// Has a state remember, after a step, the friction of what presses, crossings and layers.
    pub fn settle(&self, model: &Model, state: &mut State) {
        state.cloth.held = friction_memory::after_step(&self.contacts, &state.positions);
        self.remember(state);
        if model.contact.cloth_offset > 0.0 {
            state.cloth.places.clone_from(&state.positions);
        }
    }
}
