//! Contact within substeps: planes measured every few of them, the laws of
//! [`crate::laws::contact`] at every one.

use super::Lane;
use crate::contact_settings::FIELD_REACH;
use crate::laws::contact::{damped_push, gentle_push};
use crate::memory::Memory;
use crate::{State, System};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// A vertex near a surface for some substeps.
#[derive(Clone, Copy)]
pub struct Touching {
    /// The vertex.
    pub vertex: u32,
    /// Its place among those watched, and among those near.
    place: u32,
    entry: u32,
    /// Outward unit normal of the surface.
    normal: Lane,
    /// Where the offset surface lies along the normal [m].
    level: f64,
    /// Normal stiffness [N/m]; along the surface half of it.
    stiffness: f64,
    friction: f64,
    /// Where it sticks to the surface [m]; meaningless while no force presses it.
    anchor: Lane,
    /// Normal force [N].
    force: f64,
    /// Depth [m] that only a surface which was put there reaches: the offset, so that the cloth
    /// lies inside it.
    inside: f64,
    /// Whether it was that deep and has not come out since.
    buried: bool,
}

/// Stiffness along a surface by that across it, as for every other method.
const TANGENTIAL: f64 = 0.5;

impl Touching {
    /// The force of push and friction at a place [N]; its anchor slides after it.
    ///
    /// Push: N = k d of depth d. Friction: a spring to the anchor, k_t s, held to mu N by sliding
    /// the anchor (return mapping, Wriggers 2006, section 5.2).
    ///
    /// Cloth that a surface was put over is pushed out at 1 m/s at the most. Its `mass` is
    /// in kg, the substep `h` in s.
    #[inline(always)]
    pub fn press(&mut self, place: Lane, velocity: Lane, mass: f64, h: f64) -> Lane {
        let depth = self.level - self.normal.dot(place);
        if depth <= 0.0 {
            self.force = 0.0;
            self.buried = false;
            return Lane::default();
        }
        if self.force == 0.0 {
            self.anchor = place;
        }
        let leaving = self.normal.dot(velocity);
        self.force = self.stiffness * depth;
        let mut push = damped_push(self.force, self.stiffness, mass, leaving);
        self.buried |= depth > self.inside;
        if self.buried {
            push = push.min(gentle_push(mass, leaving, h));
            self.force = push;
        }
        let away = place.minus(self.anchor);
        let slip = away.add_scaled(self.normal, -away.dot(self.normal));
        let length = slip.dot(slip).sqrt();
        let (tangential, most) = (TANGENTIAL * self.stiffness, self.friction * self.force);
        let kept = if tangential * length > most {
            most / (tangential * length)
        } else {
            1.0
        };
        self.anchor = place.add_scaled(slip, -kept);
        self.normal
            .scaled(push)
            .add_scaled(slip, -tangential * kept)
    }

    /// Takes over what it has become elsewhere, of all contacts.
    pub fn renew(&mut self, all: &[Self]) {
        let now = &all[self.entry as usize];
        (self.anchor, self.force, self.buried) = (now.anchor, now.force, now.buried);
    }

    /// Whether anything presses it.
    #[cfg(test)]
    pub fn presses(&self) -> bool {
        self.force > 0.0
    }

    /// Energy of its push and friction [J].
    fn energy(&self, place: Lane) -> f64 {
        let depth = (self.level - self.normal.dot(place)).max(0.0);
        let slip = self.friction * self.stiffness * depth;
        0.5 * self.stiffness * depth * depth + 0.5 * slip * slip / (TANGENTIAL * self.stiffness)
    }
}

/// Vertices that may meet a surface, and how far each was when last measured.
#[derive(Default)]
pub struct Touch {
    places: Vec<Sample>,
    /// Those near enough to meet it before the next look.
    pub near: Vec<Touching>,
    /// How long to go until the next look [s].
    pub interval: f64,
    chunks: Vec<Chunk>,
}

/// What one task finds.
#[derive(Default)]
struct Chunk {
    near: Vec<Touching>,
    /// How far off planes that pressed were at the most when measured anew, by the way gone \[1\]; none
    /// where none was.
    off: Option<f64>,
}

#[derive(Clone, Copy)]
struct Sample {
    vertex: u32,
    number: u32,
    stiffness: f64,
    friction: f64,
    offset: f64,
    last: Vec3,
    /// Distance beyond the offset at `last` [m]: until the vertex has moved that far it is free.
    clearance: f64,
    /// Distance [m] and outward normal at `last`; nothing where there is none.
    plane: Option<(f64, Vec3)>,
    /// Where it sticks to a surface [m] and how much presses it there [N].
    anchor: Lane,
    force: f64,
    /// Whether a surface was put over it and it has not come out since.
    buried: bool,
    /// Its object, where any object ignores a surface.
    object: Option<u16>,
}

/// Below this slope of the distance no direction leads out.
const FLAT_SLOPE: f64 = 0.05;

/// How far a vertex may move [m] before its surface is measured again: on a limb of 30 mm radius
/// the plane is then 1 um off.
const PLANE_REACH: f64 = 0.25e-3;

/// Nearer than this to the offset a vertex is watched however slow it is [m].
const WATCHED: f64 = 1e-3;

/// Nearer than this to a surface its smooth distance is asked, not the exact one [m].
const SMOOTH_WITHIN: f64 = 0.012;

/// Shortest and longest time between two looks [s]: at 3 m/s cloth goes 1.5 and 3 mm.
const INTERVAL: [f64; 2] = [5e-4, 1e-3];

/// Looks are nearer where planes that pressed were off by more than this share of the way when measured
/// anew, and farther apart where they were off by less than a quarter of it, since twice the way
/// turns the plane twice as far: contact errs by that share of the speed. Over a radius R it is v t / 2 R,
/// 0.017 on a limb of 30 mm at 2 m/s in 0.5 ms.
const OFF: f64 = 0.02;
const SURE: f64 = 0.25;

/// Vertices looked at by one task: few, for some must lay the distance field.
const CHUNK: usize = 256;

impl Touch {
    /// Takes over the vertices of a model and what a state remembers of their contacts.
    pub fn start(&mut self, system: &System, state: &State) {
        // Nothing but the state may decide what comes of it.
        self.interval = INTERVAL[0];
        self.places.clear();
        if system.colliders.is_empty() {
            self.near.clear();
            return;
        }
        let buried = state.memory.buried();
        for (number, sample) in state.samples.iter().enumerate() {
            let vertex = sample.vertices[0];
            if sample.triangle.is_some() || system.prescribed.pinned[vertex as usize] {
                continue;
            }
            let anchor = state.anchors[number];
            self.places.push(Sample {
                vertex,
                number: number as u32,
                stiffness: system.contact.stiffness * sample.area,
                friction: if system.contact.friction {
                    sample.friction
                } else {
                    0.0
                },
                offset: system.contact.offset + sample.extra_offset,
                last: Vec3::repeat(f64::INFINITY),
                clearance: 0.0,
                plane: None,
                anchor: anchor.map_or(Lane::default(), Lane::from),
                force: if anchor.is_some() {
                    state.normal_forces[number]
                } else {
                    0.0
                },
                buried: buried.binary_search(&(number as u32)).is_ok(),
                object: system.policies.object_of_sample(&sample.vertices),
            });
        }
    }

    /// Hands over what a state remembers of its contacts.
    pub fn finish(&self, state: &mut State) {
        state.anchors.fill(None);
        state.normal_forces.fill(0.0);
        let buried = self.places.iter().filter(|sample| sample.buried);
        state.memory = Memory::of_buried(buried.map(|sample| sample.number));
        for sample in self.places.iter().filter(|sample| sample.force > 0.0) {
            state.anchors[sample.number as usize] = Some(sample.anchor.into());
            state.normal_forces[sample.number as usize] = sample.force;
        }
    }

    /// Finds the vertices that can meet a surface within `time` [s].
    pub fn look(&mut self, system: &System, positions: &[Lane], velocities: &[Lane], time: f64) {
        if self.places.is_empty() {
            return;
        }
        self.chunks
            .resize_with(self.places.len().div_ceil(CHUNK), Chunk::default);
        self.places
            .par_chunks_mut(CHUNK)
            .zip(&mut self.chunks)
            .enumerate()
            .for_each(|(chunk, (samples, found))| {
                found.near.clear();
                found.off = None;
                for (k, sample) in samples.iter_mut().enumerate() {
                    let at = sample.vertex as usize;
                    let (place, velocity) = (positions[at], velocities[at]);
                    if let Some(contact) =
                        sample.near(system, place, velocity, time, &mut found.off)
                    {
                        found.near.push(Touching {
                            place: (chunk * CHUNK + k) as u32,
                            ..contact
                        });
                    }
                }
            });
        self.near.clear();
        let mut off: Option<f64> = None;
        for chunk in &self.chunks {
            self.near.extend_from_slice(&chunk.near);
            off = match (off, chunk.off) {
                (Some(a), Some(b)) => Some(a.max(b)),
                (a, b) => a.or(b),
            };
        }
        for (entry, contact) in (0..).zip(&mut self.near) {
            contact.entry = entry;
        }
        let [shortest, longest] = INTERVAL;
        match off {
            Some(off) if off > OFF => self.interval = (0.5 * self.interval).max(shortest),
            Some(off) if off < SURE * OFF => self.interval = (2.0 * self.interval).min(longest),
            _ => {}
        }
    }

    /// Takes back what a contact has become after some substeps.
    pub fn take_back(&mut self, contact: &Touching) {
        let sample = &mut self.places[contact.place as usize];
        (sample.anchor, sample.force) = (contact.anchor, contact.force);
        sample.buried = contact.buried;
        self.show(contact);
    }

    /// The same for those who look at the contact alone.
    pub fn show(&mut self, contact: &Touching) {
        let near = &mut self.near[contact.entry as usize];
        (near.anchor, near.force) = (contact.anchor, contact.force);
        near.buried = contact.buried;
    }

    /// Energy of the contacts [J].
    pub fn energy(&self, positions: &[Lane]) -> f64 {
        let energies = self
            .near
            .iter()
            .map(|c| c.energy(positions[c.vertex as usize]));
        energies.sum()
    }

    /// What a step undone must put back.
    pub fn remember(&self, into: &mut Vec<(Lane, f64, bool)>) {
        into.clear();
        into.extend(self.places.iter().map(|s| (s.anchor, s.force, s.buried)));
    }

    /// Puts it back. Planes measured at places that are undone still say what they say of those.
    pub fn recall(&mut self, from: &[(Lane, f64, bool)]) {
        for (sample, &(anchor, force, buried)) in self.places.iter_mut().zip(from) {
            (sample.anchor, sample.force, sample.buried) = (anchor, force, buried);
        }
    }
}

impl Sample {
    /// The contact that it may have within `time` [s]; `off` grows to how far off its plane was, by the way.
    fn near(
        &mut self,
        system: &System,
        place: Lane,
        velocity: Lane,
        time: f64,
        off: &mut Option<f64>,
    ) -> Option<Touching> {
        let place = Vec3::from(place);
        let moved = (place - self.last).norm();
        // Twice the way at its present speed: it may be pushed on meanwhile.
        let way = 2.0 * time * Vec3::from(velocity).norm() + WATCHED;
        if moved.is_finite() && moved + way < self.clearance {
            self.force = 0.0;
            return None;
        }
        if !moved.is_finite() || moved >= PLANE_REACH {
            let before = self
                .plane
                .map(|(level, n)| level + (place - self.last).dot(&n));
            self.measure(system, place);
            if let (Some(before), Some((now, _))) = (before, self.plane)
                && before < self.offset
            {
                *off = Some(off.unwrap_or(0.0).max((before - now).abs() / moved));
            }
        }
        let Some((distance, n)) = self.plane else {
            self.force = 0.0;
            return None;
        };
        let above = distance - self.offset + (place - self.last).dot(&n);
        if above > way {
            self.force = 0.0;
            return None;
        }
        Some(Touching {
            vertex: self.vertex,
            place: 0,
            entry: 0,
            normal: n.into(),
            level: place.dot(&n) - above,
            stiffness: self.stiffness,
            friction: self.friction,
            anchor: self.anchor,
            force: self.force,
            inside: self.offset,
            buried: self.buried,
        })
    }

    /// Measures the nearest surface at a place.
    fn measure(&mut self, system: &System, place: Vec3) {
        let was_near = self.plane.is_some();
        (self.last, self.plane, self.clearance) = (place, None, FIELD_REACH);
        let policies = &system.policies;
        for (k, collider) in system.colliders.iter().enumerate() {
            if policies.ignores_solid(self.object, k) {
                continue;
            }
            // Far away the exact distance is enough, and spares sampling the smooth one there.
            if !was_near {
                let exact = collider.surface.closest_point(place, FIELD_REACH);
                let distance = exact.map_or(FIELD_REACH, |found| found.signed_distance);
                if distance > self.offset + SMOOTH_WITHIN {
                    self.clearance = self.clearance.min(0.9 * (distance - self.offset));
                    continue;
                }
            }
            let Some((distance, slope)) = collider.field.distance(place) else {
                continue;
            };
            // The smooth distance may exceed the exact one by a fraction of a millimetre.
            let beyond = 0.9 * (distance - self.offset);
            self.clearance = self.clearance.min(beyond.max(0.0));
            if distance < self.offset + SMOOTH_WITHIN
                && self.plane.is_none_or(|(nearest, _)| distance < nearest)
                && let Some(normal) = slope.try_normalize(FLAT_SLOPE)
            {
                self.plane = Some((distance, normal));
            }
        }
    }
}
