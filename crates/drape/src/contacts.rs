//! Finding where the cloth touches solid surfaces: recomputed as it moves.

use crate::collision::{ClothContact, ClothContacts, FeaturePair};
use crate::laws::contact::{ContactLaw, ContactPlane, damped_push, gentle_push};
use crate::model::FIELD_REACH;
use crate::state::Memory as StateMemory;
use crate::{Model, Pose, State};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// One sample near one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the sample.
    pub sample: u32,
    /// The surface, linearised there.
    pub plane: ContactPlane,
    /// Its laws.
    pub law: ContactLaw,
}

/// Contacts of the present positions, and what makes finding them again cheap.
#[derive(Default)]
pub struct Contacts {
    /// Contacts in order of their samples.
    pub active: Vec<Contact>,
    /// Contacts of cloth with cloth.
    pub cloth: ClothContacts,
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

/// Below this slope of the distance a sample lies on a ridge between walls that push against each
/// other: no direction leads out.
const FLAT_SLOPE: f64 = 0.05;

impl Contacts {
    /// Finds the contacts of the present positions. A sample is skipped only when the distance it
    /// moved proves that it is out of reach.
    pub fn refresh(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        self.cloth.refresh(model, state, positions);
        for contact in &mut self.cloth.active {
            let fade = fade(contact, positions);
            contact.law.normal *= fade;
            contact.law.tangential *= fade;
        }
        if model.colliders.is_empty() {
            self.active.clear();
            return;
        }
        let unknown = Memory {
            place: Vec3::repeat(f64::INFINITY),
            clearance: 0.0,
        };
        self.memory.resize(model.samples.len(), unknown);
        let poses: Vec<Option<Pose>> = model.colliders.iter().map(|c| c.pose(state.time)).collect();
        if poses.iter().any(Option::is_some) {
            // What was measured holds for a surface that stands still.
            self.memory.fill(unknown);
        }
        let found: Vec<Vec<Contact>> = self
            .memory
            .par_chunks_mut(128)
            .enumerate()
            .map(|(chunk, memory)| {
                let mut contacts = Vec::new();
                for (k, memory) in memory.iter_mut().enumerate() {
                    let at = chunk * 128 + k;
                    let scene = Surfaces {
                        model,
                        state,
                        poses: &poses,
                    };
                    find(&scene, positions, at, memory, &mut contacts);
                }
                contacts
            })
            .collect();
        self.active.clear();
        self.active.extend(found.into_iter().flatten());
    }

    /// Adds what damps the push of the surfaces, for explicit methods in substeps of `h` [s], and
    /// takes from it what would throw cloth that a surface was put over [N].
    pub fn damp(&self, model: &Model, state: &State, h: f64, force: &mut [Vec3]) {
        for contact in &self.active {
            let sample = &model.samples[contact.sample as usize];
            let (plane, law) = (&contact.plane, &contact.law);
            let place = sample.place(&state.positions);
            let elastic = law.normal_force(plane, place);
            if elastic <= 0.0 {
                continue;
            }
            let corners = sample.vertices.iter().zip(sample.weights);
            let [mut leaving, mut mass] = [0.0; 2];
            for (&v, w) in corners.clone() {
                leaving += w * plane.normal.dot(&state.velocities[v as usize]);
                mass += w * model.mass[v as usize];
            }
            let mut push = damped_push(elastic, law.normal, mass, leaving);
            if is_buried(model, state, contact, place) {
                push = push.min(gentle_push(mass, leaving, h));
            }
            for (&v, w) in corners {
                force[v as usize] += plane.normal * (w * (push - elastic));
            }
        }
    }

    /// Remembers which samples a surface was put over, for explicit methods, after
    /// [`Self::settle`]. Methods with a memory of their own remember none.
    pub fn remember_buried(&self, model: &Model, state: &mut State) {
        if !matches!(state.memory, StateMemory::Nothing | StateMemory::Buried(_)) {
            return;
        }
        let buried = self.active.iter().filter(|contact| {
            let sample = &model.samples[contact.sample as usize];
            is_buried(model, state, contact, sample.place(&state.positions))
        });
        state.memory = StateMemory::of_buried(buried.map(|contact| contact.sample));
    }

    /// Moves the friction anchors after a step, and remembers the normal forces.
    pub fn settle(&self, model: &Model, state: &mut State) {
        self.cloth.settle(model, state);
        state.anchors.fill(None);
        state.normal_forces.fill(0.0);
        state.follow_samples(model);
        for contact in &self.active {
            let at = contact.sample as usize;
            let place = model.samples[at].place(&state.positions);
            let force = contact.law.normal_force(&contact.plane, place);
            if force > 0.0 {
                state.anchors[at] = Some(contact.law.slide(&contact.plane, place, force));
                state.normal_forces[at] = force;
            }
        }
    }
}

/// The sine of the angle between two edges from which on they push with all their stiffness, and
/// how far from the ends of both, over their lengths.
const CROSSWISE: f64 = 0.1;
const INSIDE: f64 = 0.25;

/// Share of the stiffness with which two edges push, 1 for other contacts. The closest points of
/// edges that lie along each other run from end to end by less than a micrometre of motion, and
/// past an end the faces there push instead: without fading the force would jump, and a way to
/// rest that meets such a jump goes round for ever. Parallel edges fade as in Li et al. 2020,
/// section 5.
fn fade(contact: &ClothContact, x: &[Vec3]) -> f64 {
    let Some(FeaturePair::EdgeEdge(ends)) = contact.pair else {
        return 1.0;
    };
    let [a, b, c, d] = ends.map(|v| x[v as usize]);
    let (first, second) = (b - a, d - c);
    let lengths = first.norm_squared() * second.norm_squared();
    let sine = first.cross(&second).norm_squared() / (lengths * CROSSWISE * CROSSWISE);
    let across = if sine < 1.0 { sine * (2.0 - sine) } else { 1.0 };
    let inside = |w: [f64; 2]| (w[0].abs().min(w[1].abs()) / INSIDE).min(1.0);
    let [p, q, r, s] = contact.weights;
    across * inside([p, q]) * inside([r, s])
}

/// Whether a sample lies deeper in a surface than the offset, where no motion brings it, or has
/// lain so and not come out since.
fn is_buried(model: &Model, state: &State, contact: &Contact, place: Vec3) -> bool {
    let depth = contact.plane.depth_of(place);
    let offset = model.contact.offset + model.samples[contact.sample as usize].extra_offset;
    let remembered = || state.memory.buried().binary_search(&contact.sample).is_ok();
    depth > offset || (depth > 0.0 && remembered())
}

/// What samples are measured against.
struct Surfaces<'a> {
    model: &'a Model,
    state: &'a State,
    poses: &'a [Option<Pose>],
}

fn find(
    scene: &Surfaces,
    positions: &[Vec3],
    at: usize,
    memory: &mut Memory,
    out: &mut Vec<Contact>,
) {
    let Surfaces {
        model,
        state,
        poses,
    } = scene;
    let sample = &model.samples[at];
    let place = sample.place(positions);
    let offset = model.contact.offset + sample.extra_offset;
    let reach = offset * REACH_IN_OFFSETS;
    let moved = (place - memory.place).norm();
    if moved.is_finite() && memory.clearance - moved > reach {
        return;
    }
    let mut nearest: Option<(f64, Vec3)> = None;
    let mut owner = None;
    for (collider, pose) in model.colliders.iter().zip(*poses) {
        if let Some(found) = collider.distance(pose.as_ref(), place)
            && nearest.is_none_or(|(distance, _)| found.0 < distance)
        {
            nearest = Some(found);
            owner = Some((collider, pose));
        }
    }
    let Some((distance, slope)) = nearest else {
        *memory = Memory {
            place,
            clearance: FIELD_REACH,
        };
        return;
    };
    // The smooth distance may exceed the exact one by a fraction of a millimetre.
    *memory = Memory {
        place,
        clearance: 0.9 * distance.max(0.0),
    };
    if distance > reach || slope.norm() < FLAT_SLOPE {
        return;
    }
    let depth = offset - distance;
    let bent = owner.filter(|_| depth > 0.0);
    let [hollow, bulge] = bent
        .and_then(|(collider, pose)| collider.curvature(pose.as_ref(), place))
        .map_or([Matrix3::zeros(); 2], parts);
    let normal = model.contact.stiffness * sample.area;
    let plane = ContactPlane {
        point: place,
        depth,
        gradient: slope,
        normal: slope.normalize(),
        hollow,
        bulge,
        anchor: state.anchors[at].unwrap_or(place),
        lagged_normal_force: state.normal_forces[at],
        returning: false,
        landing: false,
    };
    let friction = if model.contact.friction {
        sample.friction
    } else {
        0.0
    };
    let law = ContactLaw {
        normal,
        tangential: 0.5 * normal,
        friction,
    };
    out.push(Contact {
        sample: at as u32,
        plane,
        law,
    });
}

/// A symmetric matrix as the difference of two positive semidefinite ones: the one it lacks, the
/// one it has.
fn parts(matrix: Matrix3<f64>) -> [Matrix3<f64>; 2] {
    let eigen = matrix.symmetric_eigen();
    let part = |sign: f64| {
        let kept = eigen.eigenvalues.map(|value| (sign * value).max(0.0));
        eigen.eigenvectors * Matrix3::from_diagonal(&kept) * eigen.eigenvectors.transpose()
    };
    [part(-1.0), part(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cloth, Material, Workspace};
    use toile_geometry::TriangleMesh;

    /// Two folds whose edges of 20 mm lie `gap` above each other, the upper one turned and moved along.
    fn ridges(gap: f64, turned: f64, along: f64) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for side in [-1.0, 1.0] {
            let first = mesh.positions.len() as u32;
            let corners = [
                [-0.01, 0.0, 0.0],
                [0.01, 0.0, 0.0],
                [0.0, 0.02, 0.01],
                [0.0, 0.02, -0.01],
            ];
            for [x, y, z] in corners {
                let (sine, cosine) = if side > 0.0 {
                    turned.sin_cos()
                } else {
                    (0.0, 1.0)
                };
                let (x, z) = (cosine * x + sine * z, cosine * z - sine * x);
                let shift = if side > 0.0 { along } else { 0.0 };
                mesh.positions
                    .push(Vec3::new(x + shift, side * (0.5 * gap + y), z));
            }
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.triangles.push([first + 1, first, first + 3]);
        }
        mesh
    }

    /// Largest jump of the forces between steps of 0.2 um over a motion, and the largest force [N].
    fn jump(place: impl Fn(f64) -> TriangleMesh) -> [f64; 2] {
        let cloth = Cloth::from_mesh("ridges", &place(0.0), Material::default()).unwrap();
        let mut model = Model::new("ridges", &cloth).unwrap();
        model.contact.cloth_offset = 2e-3;
        model.contact.friction = false;
        let mut workspace = Workspace::default();
        let mut push = |share: f64| -> Vec<Vec3> {
            let state = State::at_rest(&model, place(share).positions);
            workspace.contacts.refresh(&model, &state, &state.positions);
            let mut force = vec![Vec3::zeros(); state.positions.len()];
            for contact in &workspace.contacts.cloth.active {
                let (_, gradient, _) = contact.law.evaluate(&contact.plane, contact.plane.point);
                for (v, w) in contact.vertices.into_iter().zip(contact.weights) {
                    force[v as usize] -= gradient * w;
                }
            }
            force
        };
        let (mut jump, mut most) = (0.0f64, 0.0f64);
        let mut last = push(0.0);
        for k in 1..=2000 {
            let now = push(f64::from(k) / 2000.0);
            for (a, b) in now.iter().zip(&last) {
                (jump, most) = (jump.max((a - b).norm()), most.max(a.norm()));
            }
            last = now;
        }
        [jump, most]
    }

    #[test]
    fn the_push_of_edges_that_turn_along_each_other_or_slide_past_does_not_jump() {
        // 0.04 rad over 10 mm and 0.4 mm along in 2000 steps.
        let turning = jump(|t| ridges(1.9e-3, 0.02 - 0.04 * t, 1e-5));
        let passing = jump(|t| ridges(1.9e-3, 0.5, 9.8e-3 + 4e-4 * t));
        for [jump, most] in [turning, passing] {
            assert!(most > 1e-4 && jump < 0.02 * most, "{jump:e} of {most:e}");
        }
    }
}
