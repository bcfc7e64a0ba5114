//! The moving solids in a step: their surfaces, straight from its start to its end.

use crate::Collider;
use std::sync::Arc;
use toile_geometry::{MovingSurface, SurfaceTree, Vec3};

/// Largest distance of a surface from its true way in the middle of a step, over the contact offset: beyond it the step
/// is taken in parts, in each of which the surface moves straight on.
const BEND: f64 = 0.25;

/// The surfaces of the moving colliders of a system, by collider.
#[derive(Default)]
pub struct MovingSolids {
    solids: Vec<Option<MovingSolid>>,
    /// Start and end of the step, or of the part of it that is taken now [s].
    times: [f64; 2],
}

struct MovingSolid {
    /// The surface that it was built of.
    of: Arc<SurfaceTree>,
    surface: MovingSurface,
}

impl MovingSolids {
    /// Sets the surfaces for a step between two times [s]; does nothing where every solid is at rest.
    pub fn set_step(&mut self, colliders: &[Collider], times: [f64; 2]) {
        self.times = times;
        self.solids.truncate(colliders.len());
        self.solids.resize_with(colliders.len(), || None);
        for (solid, collider) in self.solids.iter_mut().zip(colliders) {
            if !collider.is_moving() {
                *solid = None;
                continue;
            }
            let known = solid
                .take()
                .filter(|known| Arc::ptr_eq(&known.of, &collider.surface));
            let mut moving = known.unwrap_or_else(|| MovingSolid {
                of: collider.surface.clone(),
                surface: MovingSurface::new(collider.surface.mesh()),
            });
            let [from, to] = times.map(|time| collider.positions(time));
            moving.surface.set_step(&from, &to);
            *solid = Some(moving);
        }
    }

    /// Into how many parts a step between two times [s] has to be divided, at most `most`, so that surfaces that move
    /// straight on in each stay near their true ways: a quarter of the contact offset [m] away at most. The distance
    /// from the way falls with the square of the time.
    pub fn parts(colliders: &[Collider], times: [f64; 2], offset: f64, most: u32) -> u32 {
        let middle = 0.5 * (times[0] + times[1]);
        let mut bend2 = 0.0_f64;
        for collider in colliders.iter().filter(|collider| collider.is_moving()) {
            let [from, between, to] =
                [times[0], middle, times[1]].map(|time| collider.positions(time));
            let off = |((a, b), c): ((&Vec3, &Vec3), &Vec3)| (b - (a + c) * 0.5).norm_squared();
            let all = from.iter().zip(&between).zip(&to).map(off);
            bend2 = all.fold(bend2, f64::max);
        }
        let parts = (bend2.sqrt() / (BEND * offset.abs().max(1e-6)))
            .sqrt()
            .ceil();
        (parts as u32).clamp(1, most.max(1))
    }

    /// The surface of a collider; none where it is at rest.
    pub fn surface(&self, collider: u32) -> Option<&MovingSurface> {
        let solid = self.solids.get(collider as usize)?.as_ref()?;
        Some(&solid.surface)
    }

    /// Whether any solid moves.
    pub fn any(&self) -> bool {
        self.solids.iter().any(Option::is_some)
    }

    /// A time [s] as a share of the step.
    pub fn share(&self, time: f64) -> f64 {
        let [from, to] = self.times;
        match to > from {
            true => ((time - from) / (to - from)).clamp(0.0, 1.0),
            false => 1.0,
        }
    }

    /// Speed of the fastest vertex in the step [m/s].
    pub fn speed(&self) -> f64 {
        let moved = |surface: &MovingSurface| {
            let ways = surface.starts().iter().zip(surface.ends());
            ways.map(|(a, b)| (b - a).norm_squared())
                .fold(0.0, f64::max)
        };
        let solids = self.solids.iter().flatten();
        let most = solids
            .map(|solid| moved(&solid.surface))
            .fold(0.0, f64::max);
        match self.times[1] > self.times[0] {
            true => most.sqrt() / (self.times[1] - self.times[0]),
            false => 0.0,
        }
    }
}
