//! Contact of vertices with solids within the substeps of patches: tangent planes of the surfaces are
//! detected every few substeps, the penalty law of [`toile_drape::laws::contact`] acts in every one.

use super::Lane;
use rayon::prelude::*;
use toile_drape::FIELD_REACH;
use toile_drape::Memory;
use toile_drape::laws::contact::{TANGENTIAL_RATIO, damped_push, gentle_push};
use toile_drape::{SolidFriction, State, System};
use toile_geometry::Vec3;

/// The contact of a vertex with the tangent plane of a near surface, valid until the next detection.
#[derive(Clone, Copy)]
pub struct PatchContact {
    /// The vertex: its number in the model, or within a patch its index there.
    pub vertex: u32,
    /// Index of its sample in [`PatchContacts`].
    sample: u32,
    /// Its index in [`PatchContacts::near`].
    near_index: u32,
    /// Outward unit normal of the surface.
    normal: Lane,
    /// The plane n . x = level of the offset surface (m).
    level: f64,
    /// Normal stiffness k (N/m); the tangential one is [`TANGENTIAL_RATIO`] of it.
    stiffness: f64,
    /// Friction coefficient.
    friction: f64,
    /// Friction anchor: the point of the surface to which the vertex sticks (m). Undefined while the normal
    /// force is zero.
    anchor: Lane,
    /// Normal force (N).
    force: f64,
    /// Depth below the offset surface from which on the vertex lies inside the solid itself (m): the
    /// offset. Cloth only gets there when a solid is put over it.
    buried_depth: f64,
    /// Whether the vertex was that deep and has not left the offset surface since.
    buried: bool,
}

impl PatchContact {
    /// The contact force on the vertex at `position` (m) and `velocity` (m/s): normal force and friction (N).
    /// Updates the friction anchor.
    ///
    /// Normal force: N = k d for the depth d, with a dashpot. Friction: a spring k_t s to the anchor, limited
    /// to mu N by sliding the anchor (return mapping, Wriggers 2006, section 5.2).
    ///
    /// Cloth that a solid was put over is pushed out at 1 m/s at the most. `mass` is in kg, the substep
    /// `h` in s.
    #[inline(always)]
    pub fn update_force(&mut self, position: Lane, velocity: Lane, mass: f64, h: f64) -> Lane {
        let depth = self.level - self.normal.dot(position);
        if depth <= 0.0 {
            self.force = 0.0;
            self.buried = false;
            return Lane::default();
        }
        if self.force == 0.0 {
            self.anchor = position;
        }
        let leaving = self.normal.dot(velocity);
        self.force = self.stiffness * depth;
        let mut push = damped_push(self.force, self.stiffness, mass, leaving);
        self.buried |= depth > self.buried_depth;
        if self.buried {
            push = push.min(gentle_push(mass, leaving, h));
            self.force = push;
        }
        let displacement = position.minus(self.anchor);
        let slip = displacement.add_scaled(self.normal, -displacement.dot(self.normal));
        let length = slip.dot(slip).sqrt();
        let (tangential, limit) = (
            TANGENTIAL_RATIO * self.stiffness,
            self.friction * self.force,
        );
        let share = if tangential * length > limit {
            limit / (tangential * length)
        } else {
            1.0
        };
        self.anchor = position.add_scaled(slip, -share);
        self.normal
            .scaled(push)
            .add_scaled(slip, -tangential * share)
    }

    /// Copies the friction state from its entry in [`PatchContacts::near`], which another patch has advanced.
    pub fn refresh_from(&mut self, near: &[Self]) {
        let current = &near[self.near_index as usize];
        (self.anchor, self.force, self.buried) = (current.anchor, current.force, current.buried);
    }

    /// Whether its normal force is positive.
    #[cfg(test)]
    pub fn is_pressed(&self) -> bool {
        self.force > 0.0
    }

    /// Energy of the normal spring, and the most that the friction spring can store at this depth (J).
    fn energy(&self, position: Lane) -> f64 {
        let depth = (self.level - self.normal.dot(position)).max(0.0);
        let slip = self.friction * self.stiffness * depth;
        0.5 * self.stiffness * depth * depth
            + 0.5 * slip * slip / (TANGENTIAL_RATIO * self.stiffness)
    }
}

/// The contact samples of a cloth that is cut into patches, with the surface distance of each as last
/// queried, and the active contacts.
#[derive(Default)]
pub struct PatchContacts {
    samples: Vec<SurfaceSample>,
    /// Contacts of the vertices that can reach a surface before the next detection.
    pub near: Vec<PatchContact>,
    /// Time between two detections (s).
    pub interval: f64,
    chunks: Vec<Chunk>,
}

/// The result of one task of the detection.
#[derive(Default)]
struct Chunk {
    near: Vec<PatchContact>,
    /// Largest error of a loaded plane when its surface was queried again: error of the distance over the
    /// displacement since the last query (1); none where no loaded plane was queried.
    plane_error: Option<f64>,
}

/// A vertex that can meet the surface of a solid, and that surface as last queried.
#[derive(Clone, Copy)]
struct SurfaceSample {
    vertex: u32,
    /// Index of the contact sample in the state.
    number: u32,
    /// Index of the solid.
    solid: u32,
    /// Normal stiffness (N/m).
    stiffness: f64,
    /// Friction coefficient.
    friction: f64,
    /// Distance between cloth and surface at rest (m).
    offset: f64,
    /// Position at the last query (m).
    last: Vec3,
    /// Distance to the offset surface at `last` (m): a vertex that has moved less touches nothing.
    clearance: f64,
    /// Distance (m) and outward normal of the surface at `last`; none where no surface is near.
    plane: Option<(f64, Vec3)>,
    /// Friction anchor (m) and normal force (N).
    anchor: Lane,
    force: f64,
    /// Whether a solid was put over it and it has not come out since.
    buried: bool,
}

/// Least norm of the distance gradient: below it the point lies between two sides of a solid and the
/// gradient is no outward normal.
const FLAT_SLOPE: f64 = 0.05;

/// Displacement after which the surface is queried again (m): on a limb of 30 mm radius the tangent plane
/// is 1 um off by then.
const PLANE_REACH: f64 = 0.25e-3;

/// Least detection range beyond the offset (m), for vertices at rest, which may be accelerated meanwhile.
const MIN_RANGE: f64 = 1e-3;

/// Distance beyond the offset within which the smooth distance field is sampled instead of the exact
/// distance (m).
const FIELD_RANGE: f64 = 0.012;

/// Shortest and longest time between two detections (s): at 3 m/s cloth moves 1.5 and 3 mm meanwhile.
const INTERVALS: [f64; 2] = [5e-4, 1e-3];

/// Bound on the plane error: the error of the distance over the displacement since the plane was set, which
/// is also the error of the contact velocity over the speed. Above it the detection interval is halved. Over
/// a radius R the error is v t / 2 R: 0.017 on a limb of 30 mm at 2 m/s in 0.5 ms.
const MAX_PLANE_ERROR: f64 = 0.02;

/// Share of the bound below which the detection interval is doubled: the error grows with the interval, so
/// a quarter leaves half of the bound free.
const DOUBLING_SHARE: f64 = 0.25;

/// Vertices of one task of the detection: few, since those of some tasks have to build the distance field.
const CHUNK: usize = 256;

impl PatchContacts {
    /// Loads the contact samples of a model and the friction state from `state`.
    pub fn start(&mut self, system: &System, state: &State) {
        // The interval is not part of the state: it starts anew, so that the result depends on the state alone.
        self.interval = INTERVALS[0];
        self.samples.clear();
        if system.colliders.is_empty() {
            self.near.clear();
            return;
        }
        let buried = state.memory.buried();
        let solids = 0..system.colliders.len() as u32;
        let pairs = (0..)
            .zip(state.samples.iter())
            .flat_map(|sample| solids.clone().map(move |solid| (sample, solid)));
        for ((number, sample), solid) in pairs {
            let vertex = sample.vertices[0];
            let object = system.policies.object_of_sample(&sample.vertices);
            if sample.triangle.is_some()
                || system.prescribed.pinned[vertex as usize]
                || system.policies.ignores_solid(object, solid as usize)
            {
                continue;
            }
            let memory = SolidFriction::find(&state.solid_friction, number, solid);
            let law = system.contact.law(sample.area, sample.friction);
            self.samples.push(SurfaceSample {
                vertex,
                number,
                solid,
                stiffness: law.normal,
                friction: law.friction,
                offset: system.contact.offset + sample.extra_offset,
                last: Vec3::repeat(f64::INFINITY),
                clearance: 0.0,
                plane: None,
                anchor: memory.map_or(Lane::default(), |memory| memory.anchor.into()),
                force: memory.map_or(0.0, |memory| memory.force),
                buried: buried.binary_search(&number).is_ok(),
            });
        }
    }

    /// Stores the friction state in `state`.
    pub fn finish(&self, state: &mut State) {
        let buried = self.samples.iter().filter(|sample| sample.buried);
        let mut buried: Vec<u32> = buried.map(|sample| sample.number).collect();
        buried.dedup();
        state.memory = Memory::of_buried(buried.into_iter());
        let pressing = self.samples.iter().filter(|sample| sample.force > 0.0);
        state.solid_friction.clear();
        state
            .solid_friction
            .extend(pressing.map(|sample| SolidFriction {
                sample: sample.number,
                solid: sample.solid,
                anchor: sample.anchor.into(),
                force: sample.force,
            }));
    }

    /// Detects the contacts of all vertices that can reach a surface within `time` (s), and adapts the
    /// detection interval to the error of the planes.
    pub fn detect(&mut self, system: &System, positions: &[Lane], velocities: &[Lane], time: f64) {
        if self.samples.is_empty() {
            return;
        }
        self.chunks
            .resize_with(self.samples.len().div_ceil(CHUNK), Chunk::default);
        self.samples
            .par_chunks_mut(CHUNK)
            .zip(&mut self.chunks)
            .enumerate()
            .for_each(|(chunk, (samples, found))| {
                found.near.clear();
                found.plane_error = None;
                for (k, sample) in samples.iter_mut().enumerate() {
                    let at = sample.vertex as usize;
                    let (position, velocity) = (positions[at], velocities[at]);
                    let error = &mut found.plane_error;
                    if let Some(contact) = sample.detect(system, position, velocity, time, error) {
                        found.near.push(PatchContact {
                            sample: (chunk * CHUNK + k) as u32,
                            ..contact
                        });
                    }
                }
            });
        self.near.clear();
        let mut plane_error: Option<f64> = None;
        for chunk in &self.chunks {
            self.near.extend_from_slice(&chunk.near);
            plane_error = match (plane_error, chunk.plane_error) {
                (Some(a), Some(b)) => Some(a.max(b)),
                (a, b) => a.or(b),
            };
        }
        for (index, contact) in (0..).zip(&mut self.near) {
            contact.near_index = index;
        }
        let [shortest, longest] = INTERVALS;
        match plane_error {
            Some(error) if error > MAX_PLANE_ERROR => {
                self.interval = (0.5 * self.interval).max(shortest);
            }
            Some(error) if error < DOUBLING_SHARE * MAX_PLANE_ERROR => {
                self.interval = (2.0 * self.interval).min(longest);
            }
            _ => {}
        }
    }

    /// Stores the friction state of a contact after some substeps, in its sample and in the list of near
    /// contacts.
    pub fn store(&mut self, contact: &PatchContact) {
        let sample = &mut self.samples[contact.sample as usize];
        (sample.anchor, sample.force) = (contact.anchor, contact.force);
        sample.buried = contact.buried;
        self.store_near(contact);
    }

    /// Stores the friction state of a contact in the list of near contacts alone, from which the patches
    /// that have the vertex in their halos read it.
    pub fn store_near(&mut self, contact: &PatchContact) {
        let near = &mut self.near[contact.near_index as usize];
        (near.anchor, near.force) = (contact.anchor, contact.force);
        near.buried = contact.buried;
    }

    /// Energy of the contacts (J).
    pub fn energy(&self, positions: &[Lane]) -> f64 {
        let energies = self
            .near
            .iter()
            .map(|c| c.energy(positions[c.vertex as usize]));
        energies.sum()
    }

    /// Saves the friction state of all samples, for [`Self::restore`].
    pub fn save(&self, into: &mut Vec<(Lane, f64, bool)>) {
        into.clear();
        into.extend(self.samples.iter().map(|s| (s.anchor, s.force, s.buried)));
    }

    /// Restores a saved friction state. Planes stay: each is valid about the position it was queried at.
    pub fn restore(&mut self, from: &[(Lane, f64, bool)]) {
        for (sample, &(anchor, force, buried)) in self.samples.iter_mut().zip(from) {
            (sample.anchor, sample.force, sample.buried) = (anchor, force, buried);
        }
    }
}

impl SurfaceSample {
    /// The contact that the vertex can have within `time` (s). Raises `plane_error` to the error of the
    /// plane where a loaded one is queried again.
    fn detect(
        &mut self,
        system: &System,
        position: Lane,
        velocity: Lane,
        time: f64,
        plane_error: &mut Option<f64>,
    ) -> Option<PatchContact> {
        let position = Vec3::from(position);
        let moved = (position - self.last).norm();
        // Twice the displacement at the present speed: the vertex may be accelerated meanwhile.
        let range = 2.0 * time * Vec3::from(velocity).norm() + MIN_RANGE;
        if moved.is_finite() && moved + range < self.clearance {
            self.force = 0.0;
            return None;
        }
        if !moved.is_finite() || moved >= PLANE_REACH {
            let extrapolated = self
                .plane
                .map(|(distance, n)| distance + (position - self.last).dot(&n));
            self.query_surface(system, position);
            if let (Some(extrapolated), Some((distance, _))) = (extrapolated, self.plane)
                && extrapolated < self.offset
            {
                let error = (extrapolated - distance).abs() / moved;
                *plane_error = Some(plane_error.unwrap_or(0.0).max(error));
            }
        }
        let Some((distance, n)) = self.plane else {
            self.force = 0.0;
            return None;
        };
        let gap = distance - self.offset + (position - self.last).dot(&n);
        if gap > range {
            self.force = 0.0;
            return None;
        }
        Some(PatchContact {
            vertex: self.vertex,
            sample: 0,
            near_index: 0,
            normal: n.into(),
            level: position.dot(&n) - gap,
            stiffness: self.stiffness,
            friction: self.friction,
            anchor: self.anchor,
            force: self.force,
            buried_depth: self.offset,
            buried: self.buried,
        })
    }

    /// Queries the surface: sets its plane at `position` (m) and the clearance there.
    fn query_surface(&mut self, system: &System, position: Vec3) {
        let was_near = self.plane.is_some();
        (self.last, self.plane, self.clearance) = (position, None, FIELD_REACH);
        let collider = &system.colliders[self.solid as usize];
        // Far from the solid the exact distance is enough, and the distance field need not be sampled there.
        if !was_near {
            let exact = collider.surface.closest_point(position, FIELD_REACH);
            let distance = exact.map_or(FIELD_REACH, |found| found.signed_distance);
            if distance > self.offset + FIELD_RANGE {
                self.clearance = self.clearance.min(0.9 * (distance - self.offset));
                return;
            }
        }
        let Some((distance, slope)) = collider.field.distance(position) else {
            return;
        };
        // The smooth distance may exceed the exact one by a fraction of a millimetre.
        let beyond = 0.9 * (distance - self.offset);
        self.clearance = self.clearance.min(beyond.max(0.0));
        if distance < self.offset + FIELD_RANGE {
            let normal = slope.try_normalize(FLAT_SLOPE);
            self.plane = normal.map(|normal| (distance, normal));
        }
    }
}
