//! Finding where the cloth touches solid surfaces: recomputed as it moves.

use crate::laws::contact::{ContactLaw, ContactPlane};
use crate::{Model, State};
use rayon::prelude::*;
use toile_geometry::{ClosestPoint, Feature, SurfaceTree, Vec3, closest_point_on_triangle};

/// One sample near one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the sample.
    pub sample: u32,
    /// The surface, linearised there.
    pub plane: ContactPlane,
    /// Its laws.
    pub law: ContactLaw,
    /// Whether friction is kept for this contact (a sample between two surfaces sticks to one).
    pub primary: bool,
}

/// Contacts of the present positions, and what makes finding them again cheap.
#[derive(Default)]
pub struct Contacts {
    /// Contacts in order of their samples.
    pub active: Vec<Contact>,
    memory: Vec<Memory>,
}

/// Where a sample was last measured and how far from every surface it was: until it has moved
/// by that much less the contact distance, it cannot touch anything.
#[derive(Clone, Copy)]
struct Memory {
    place: Vec3,
    clearance: f64,
}

/// Planes are kept from this many offsets away, so that a step is stopped before it lands.
const REACH_IN_OFFSETS: f64 = 2.5;

/// Two places of a surface are told apart when the directions to them differ by more than 15
/// degrees (cosine 0.966): nearer ones are the same place seen through two facets.
const SAME_PLACE_COSINE: f64 = 0.966;

/// Places of one surface that may hold a sample: a corner of three walls.
const MOST_PLACES: usize = 4;

impl Contacts {
    /// Finds the contacts of the present positions. Exact: a sample is skipped only when the
    /// distance it moved proves that it is out of reach.
    pub fn refresh(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        let unknown = Memory {
            place: Vec3::repeat(f64::INFINITY),
            clearance: 0.0,
        };
        self.memory.resize(model.samples.len(), unknown);
        let found: Vec<Vec<Contact>> = self
            .memory
            .par_chunks_mut(128)
            .enumerate()
            .map(|(chunk, memory)| {
                let mut contacts = Vec::new();
                for (k, memory) in memory.iter_mut().enumerate() {
                    find(
                        model,
                        state,
                        positions,
                        chunk * 128 + k,
                        memory,
                        &mut contacts,
                    );
                }
                contacts
            })
            .collect();
        self.active.clear();
        self.active.extend(found.into_iter().flatten());
    }

    /// Moves the friction anchors after a step, and remembers the normal forces.
    pub fn settle(&self, model: &Model, state: &mut State) {
        let mut anchors = vec![None; model.samples.len()];
        let mut forces = vec![0.0; model.samples.len()];
        for contact in &self.active {
            let at = contact.sample as usize;
            let place = model.samples[at].place(&state.positions);
            let force = contact.law.normal_force(&contact.plane, place);
            if contact.primary && force > 0.0 {
                anchors[at] = Some(contact.law.slide(&contact.plane, place, force));
                forces[at] = force;
            }
        }
        state.anchors = anchors;
        state.normal_forces = forces;
    }
}

fn find(
    model: &Model,
    state: &State,
    positions: &[Vec3],
    at: usize,
    memory: &mut Memory,
    out: &mut Vec<Contact>,
) {
    let sample = &model.samples[at];
    let place = sample.place(positions);
    let reach = model.contact.offset * REACH_IN_OFFSETS;
    let moved = (place - memory.place).norm();
    if moved.is_finite() && memory.clearance - moved > reach {
        return;
    }
    // Look farther than needed, so that the next looks can be skipped.
    let far = reach + 0.05;
    let mut nearest: Option<(ClosestPoint, usize)> = None;
    for (surface, tree) in model.colliders.iter().enumerate() {
        if let Some(closest) = tree.closest_point(place, far)
            && nearest.is_none_or(|(n, _)| closest.signed_distance < n.signed_distance)
        {
            nearest = Some((closest, surface));
        }
    }
    let Some((closest, surface)) = nearest else {
        *memory = Memory {
            place,
            clearance: far,
        };
        return;
    };
    *memory = Memory {
        place,
        clearance: closest.signed_distance.max(0.0),
    };
    if closest.signed_distance > reach {
        return;
    }
    let others = if closest.signed_distance.abs() < model.contact.offset {
        crease(
            &model.colliders[surface],
            place,
            &closest,
            model.contact.offset,
        )
    } else {
        Vec::new()
    };
    let normal = model.contact.stiffness * sample.area;
    // In a crease the walls hold the sample; friction on a wall that changes from look to look
    // would only make it chatter.
    let friction = if model.contact.friction && others.is_empty() {
        sample.friction
    } else {
        0.0
    };
    let law = ContactLaw {
        normal,
        tangential: 0.5 * normal,
        friction,
    };
    let plane = |c: &ClosestPoint, force: f64| ContactPlane {
        origin: c.point + c.normal * model.contact.offset,
        normal: c.normal,
        anchor: state.anchors[at].unwrap_or(place),
        lagged_normal_force: force,
    };
    let first = plane(&closest, state.normal_forces[at]);
    out.push(Contact {
        sample: at as u32,
        plane: first,
        law,
        primary: true,
    });
    for other in &others {
        out.push(Contact {
            sample: at as u32,
            plane: plane(other, 0.0),
            law,
            primary: false,
        });
    }
}

/// Places of the surface besides `first` where its distance to `place` is least among their
/// surroundings and below `reach`: the other walls of a crease the sample lies in.
///
/// Seen from outside, a least distance lies inside a face, or on an edge or corner that is the
/// closest point of all its triangles.
fn crease(tree: &SurfaceTree, place: Vec3, first: &ClosestPoint, reach: f64) -> Vec<ClosestPoint> {
    let mut candidates: Vec<(ClosestPoint, Feature)> = Vec::new();
    for triangle in tree.near_box(place, place, reach) {
        let corners = tree.mesh().corners(triangle as usize);
        let (weights, feature) = closest_point_on_triangle(place, corners);
        let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        let offset = place - point;
        let distance = offset.norm();
        let face = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        if distance < reach && distance > 1e-9 && offset.dot(&face) > 0.0 {
            let normal = offset / distance;
            let near = ClosestPoint {
                point,
                signed_distance: distance,
                normal,
                triangle,
                weights,
            };
            candidates.push((near, feature));
        }
    }
    candidates.sort_by(|(a, _), (b, _)| {
        a.signed_distance
            .total_cmp(&b.signed_distance)
            .then(a.triangle.cmp(&b.triangle))
    });
    let mut walls: Vec<ClosestPoint> = Vec::new();
    for (near, feature) in &candidates {
        let sharing = candidates
            .iter()
            .filter(|(c, _)| (c.point - near.point).norm() < 1e-9)
            .count();
        let least = match feature {
            Feature::Face => true,
            Feature::Edge(_) => sharing >= 2,
            Feature::Corner(_) => sharing >= 3,
        };
        let known = std::iter::once(first)
            .chain(&walls)
            .any(|w| w.normal.dot(&near.normal) > SAME_PLACE_COSINE);
        if least && !known && walls.len() + 1 < MOST_PLACES {
            walls.push(*near);
        }
    }
    walls
}
