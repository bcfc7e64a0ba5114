//! Friction of contacts with solids between steps: taken from a state, and stored in it.

use super::Xpbd;
use super::contact::ContactStep;
use super::contact_block::ContactBlock;
use crate::lanes::LANES;
use crate::{SolidFriction, State};

impl Xpbd {
    /// Takes the slips of the contacts from the state that the particles have, for substeps of the size of `step`.
    pub(super) fn recall_friction(&mut self, state: &State, step: &ContactStep) {
        let points = &self.particles.start;
        for (partition, region) in self.partition.partitions().zip(self.regions.all_mut()) {
            let points = &points[self.partition.start(partition)..];
            for contact in &mut region.contacts {
                let weight = contact.weight(points);
                contact.constraint.recall(state, weight, step);
            }
        }
        let solids = self.built_for.model.colliders.len().max(1);
        let contacts = self.particles.contacts.chunks_exact_mut(solids);
        for (blocks, points) in contacts.zip(points.chunks_exact(LANES)) {
            for block in blocks {
                block.recall(state, points, step);
            }
        }
    }

    /// Stores the friction of the contacts in a state with the positions of the particles.
    pub(super) fn store_friction(&mut self, state: &mut State) {
        let points = &self.particles.start;
        let step = ContactStep::new(self.kappa as f32, 0.0);
        for (partition, region) in self.partition.partitions().zip(self.regions.all_mut()) {
            region.end_substep(&points[self.partition.start(partition)..], &step);
        }
        let regions = self.partition.partitions().zip(self.regions.all());
        let in_triangles = regions.flat_map(|(partition, region)| {
            let points = &points[self.partition.start(partition)..];
            let contacts = region.contacts.iter();
            contacts.map(move |stencil| (stencil.constraint, stencil.weight(points)))
        });
        let solids = self.built_for.model.colliders.len().max(1);
        let blocks = self.particles.contacts.iter().enumerate();
        let vertices = blocks.flat_map(|(index, block): (usize, &ContactBlock)| {
            let first = index / solids * LANES;
            let lanes = block.loaded();
            lanes.map(move |lane| (block.get(lane), points[first + lane][3]))
        });
        let contacts = vertices.chain(in_triangles);
        let found = contacts.filter_map(|(contact, weight)| contact.remember(state, weight, &step));
        let mut found: Vec<SolidFriction> = found.collect();
        found.sort_unstable_by_key(SolidFriction::key);
        state.solid_friction = found;
    }
}
