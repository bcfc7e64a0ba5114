//! Finding where the cloth touches solid surfaces: recomputed as it moves.

use crate::laws::contact::{ContactLaw, ContactPlane};
use crate::{Model, State};
use rayon::prelude::*;
use toile_geometry::{ClosestPoint, SurfaceTree, Vec3, closest_point_on_triangle};

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

/// A second surface closer than the offset is kept when its normal is turned by more than 60
/// degrees (cosine 0.5) from the first: the sample lies in a crease.
const CREASE_COSINE: f64 = 0.5;

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
    let normal = model.contact.stiffness * sample.area;
    let law = ContactLaw {
        normal,
        tangential: 0.5 * normal,
        friction: if model.contact.friction {
            sample.friction
        } else {
            0.0
        },
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
    if closest.signed_distance.abs() < model.contact.offset
        && let Some(second) = crease(
            &model.colliders[surface],
            place,
            &closest,
            model.contact.offset,
        )
    {
        out.push(Contact {
            sample: at as u32,
            plane: plane(&second, 0.0),
            law,
            primary: false,
        });
    }
}

/// The nearest part of the surface within `reach` that faces another way than `first`.
fn crease(
    tree: &SurfaceTree,
    place: Vec3,
    first: &ClosestPoint,
    reach: f64,
) -> Option<ClosestPoint> {
    let mut best: Option<ClosestPoint> = None;
    for triangle in tree.near_box(place, place, reach) {
        let corners = tree.mesh().corners(triangle as usize);
        let (weights, _) = closest_point_on_triangle(place, corners);
        let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        let offset = place - point;
        let distance = offset.norm();
        let face = (corners[1] - corners[0])
            .cross(&(corners[2] - corners[0]))
            .normalize();
        if distance >= reach || distance < 1e-9 || offset.dot(&face) <= 0.0 {
            continue;
        }
        let normal = offset / distance;
        if normal.dot(&first.normal) < CREASE_COSINE
            && best.is_none_or(|b| distance < b.signed_distance)
        {
            best = Some(ClosestPoint {
                point,
                signed_distance: distance,
                normal,
                triangle,
                weights,
            });
        }
    }
    best
}
