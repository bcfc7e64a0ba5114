//! The moving solids in a step: their surfaces, straight from its start to its end.

use crate::{Collider, Pose};
use std::sync::Arc;
use toile_geometry::{MovingSurface, Vec3};

/// Largest distance of a surface from its true way in the middle of a step, over the contact offset: beyond it the step
/// is taken in parts, in each of which the surface moves straight on.
const BEND: f64 = 0.25;

/// The surfaces of the moving colliders of a system, by collider.
#[derive(Default)]
pub struct MovingSolids {
    solids: Vec<Option<MovingSolid>>,
    /// Start and end of the step, or of the part of it that is taken now (s).
    times: [f64; 2],
    /// Speed of the fastest vertex in it (m/s).
    speed: f64,
}

struct MovingSolid {
    /// The collider that it was built of.
    of: Collider,
    surface: MovingSurface,
    /// Places of the vertices at the times asked for last (s), (m).
    known: Vec<(f64, Arc<Vec<Vec3>>)>,
    /// Poses of the frames of its track at both ends of the step.
    frames: [Vec<Pose>; 2],
}

/// Times whose places are kept: start, middle and end of a step, and the end of one part of it.
const KNOWN: usize = 4;

impl MovingSolid {
    fn new(of: &Collider) -> Self {
        Self {
            of: of.clone(),
            surface: of.moving_surface(),
            known: Vec::new(),
            frames: Default::default(),
        }
    }

    /// Places of the vertices at a time (s).
    fn positions(&mut self, time: f64) -> Arc<Vec<Vec3>> {
        if let Some((_, positions)) = self.known.iter().find(|(at, _)| *at == time) {
            return positions.clone();
        }
        let positions = Arc::new(self.of.positions(time));
        if self.known.len() == KNOWN {
            self.known.remove(0);
        }
        self.known.push((time, positions.clone()));
        positions
    }

    /// Square of the largest distance of a vertex from the straight way between two times (s), in the middle (m2).
    fn bend2(&mut self, [start, end]: [f64; 2]) -> f64 {
        let [from, between, to] =
            [start, 0.5 * (start + end), end].map(|time| self.positions(time));
        let off = |((a, b), c): ((&Vec3, &Vec3), &Vec3)| (b - (a + c) * 0.5).norm_squared();
        let all = from.iter().zip(&*between).zip(&*to).map(off);
        all.fold(0.0, f64::max)
    }

    /// Sets the surface for a step between two times (s); gives the square of the longest way of a vertex (m2).
    fn set_step(&mut self, times: [f64; 2]) -> f64 {
        let [from, to] = times.map(|time| self.positions(time));
        self.surface.set_step(&from, &to);
        self.frames = times.map(|time| self.of.frames(time));
        let ways = from.iter().zip(&*to).map(|(a, b)| (b - a).norm_squared());
        ways.fold(0.0, f64::max)
    }
}

impl MovingSolids {
    /// Takes over the colliders of a system and says into how many parts a step between two times (s) has to be divided,
    /// at most `most`, so that surfaces that move straight on in each stay near their true ways: a quarter of the contact
    /// offset (m) away at most. The distance from the way falls with the square of the time.
    pub fn parts(
        &mut self,
        colliders: &[Collider],
        times: [f64; 2],
        (offset, most): (f64, u32),
    ) -> u32 {
        self.solids.truncate(colliders.len());
        self.solids.resize_with(colliders.len(), || None);
        for (solid, collider) in self.solids.iter_mut().zip(colliders) {
            let known = solid.take().filter(|known| known.of.is_same(collider));
            *solid = match collider.is_moving() {
                true => Some(known.unwrap_or_else(|| MovingSolid::new(collider))),
                false => None,
            };
        }
        let moving = self.solids.iter_mut().flatten();
        let bend2 = moving.map(|solid| solid.bend2(times)).fold(0.0, f64::max);
        let parts = (bend2.sqrt() / (BEND * offset.abs().max(1e-6)))
            .sqrt()
            .ceil();
        (parts as u32).clamp(1, most.max(1))
    }

    /// Sets the surfaces for a step between two times (s), or for a part of one.
    pub fn set_step(&mut self, times: [f64; 2]) {
        self.times = times;
        let moving = self.solids.iter_mut().flatten();
        let longest2 = moving
            .map(|solid| solid.set_step(times))
            .fold(0.0, f64::max);
        let [from, to] = times;
        self.speed = match to > from {
            true => longest2.sqrt() / (to - from),
            false => 0.0,
        };
    }

    /// The surface of a collider; none where it is at rest.
    pub fn surface(&self, collider: u32) -> Option<&MovingSurface> {
        let solid = self.solids.get(collider as usize)?.as_ref()?;
        Some(&solid.surface)
    }

    /// Where a point in a frame of a collider's track is at a share of the step, straight on between its ends (m); none
    /// where there is no such frame.
    pub fn in_frame(&self, collider: u32, (frame, point): (u16, Vec3), share: f64) -> Option<Vec3> {
        let solid = self.solids.get(collider as usize)?.as_ref()?;
        let [from, to] = &solid.frames;
        let [from, to] = [from, to].map(|poses| poses.get(usize::from(frame)));
        Some(from?.apply(point).lerp(&to?.apply(point), share))
    }

    /// Whether any solid moves.
    pub fn any(&self) -> bool {
        self.solids.iter().any(Option::is_some)
    }

    /// A time (s) as a share of the step.
    pub fn share(&self, time: f64) -> f64 {
        let [from, to] = self.times;
        match to > from {
            true => ((time - from) / (to - from)).clamp(0.0, 1.0),
            false => 1.0,
        }
    }

    /// Speed of the fastest vertex in the step (m/s).
    pub fn speed(&self) -> f64 {
        self.speed
    }
}
