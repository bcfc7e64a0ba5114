//! Friction of cloth on cloth from step to step: how far each contact has slid since it stuck. It is stored in the
//! state by [`super::ContactSet::remember_step`] and carried over edits by `world/transfer.rs`.

use super::cloth_contact::ClothContact;
use super::feature_pair::FeaturePair;
use super::memory::{ClothMemory, ContactFrictionState};
use super::nearness::Nearness;
use toile_geometry::Vec3;

/// Where friction holds two features that pressed in the last step: the vector between them when they
/// stuck (m), and the normal force then (N). None where they did not press.
pub(super) fn anchor(memory: &ClothMemory, near: &Nearness, x: &[Vec3]) -> Option<(Vec3, f64)> {
    let at = memory
        .friction
        .binary_search_by(|state| state.pair.cmp(&near.pair))
        .ok()?;
    let state = &memory.friction[at];
    let between = near.normal * near.distance;
    let slid = near.slid(&memory.positions, x);
    Some((between - state.slip - slid, state.force))
}

/// Whether the features of a contact did not press in the last step.
pub(super) fn is_new(memory: &ClothMemory, contact: &ClothContact) -> bool {
    let of = |pair: &FeaturePair| memory.friction.binary_search_by(|one| one.pair.cmp(pair));
    contact.pair.is_some_and(|pair| of(&pair).is_err())
}

/// The friction of contacts that press at positions `x`, in order of their features.
pub(super) fn after_step(contacts: &[ClothContact], x: &[Vec3]) -> Vec<ContactFrictionState> {
    let mut held = Vec::new();
    for contact in contacts {
        let Some(pair) = contact.pair else { continue };
        let between = contact.between(x);
        let force = contact.law.normal_force(&contact.plane, between);
        if force > 0.0 && contact.law.friction > 0.0 {
            let anchor = contact.law.slide(&contact.plane, between, force);
            let slip = between - anchor;
            let n = contact.plane.normal;
            held.push(ContactFrictionState {
                pair,
                slip: slip - n * slip.dot(&n),
                force,
            });
        }
    }
    held.sort_unstable_by_key(|held| held.pair);
    held
}
