//! The points: where they go by themselves, and what the constraints did to their velocities.

use super::bending::BendingForce;
use super::contact::{ContactStep, Touch};
use super::lanes::Point;
use crate::Model;
use toile_geometry::Vec3;

/// Times the speed limit at which a substep has failed: a fall stops at the limit and stays there,
/// only what is thrown goes so far beyond it at once.
const RUNAWAY: f32 = 1.2;

/// Points by slot. Fourth numbers: inverse mass in `start` and `now`, zero elsewhere.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Where they were when the substep began [m].
    pub start: Vec<Point>,
    /// Where they are [m].
    pub now: Vec<Point>,
    /// Where they went by themselves [m].
    pub free: Vec<Point>,
    /// What single precision left out of `now` [m].
    pub low: Vec<Point>,
    /// Velocities [m/s].
    pub velocity: Vec<Point>,
    /// Contact of each vertex with the surfaces.
    pub touch: Vec<Touch>,
}

impl Particles {
    /// Room for some slots.
    pub fn new(count: usize) -> Self {
        let points = vec![[0.0; 4]; count];
        Self {
            start: points.clone(),
            now: points.clone(),
            free: points.clone(),
            low: points.clone(),
            velocity: points,
            touch: vec![Touch::none(); count],
        }
    }

    /// Forgets contacts.
    pub fn forget_touches(&mut self) {
        for touch in &mut self.touch {
            touch.forget();
        }
    }
}

/// The numbers of a substep that free motion needs.
#[derive(Clone, Copy)]
pub struct MotionStep {
    /// Substep h [s].
    pub step: f32,
    /// Acceleration of gravity [m/s2].
    pub gravity: Point,
    /// 1 / (1 + drag h).
    pub kept: f32,
    /// Largest speed a vertex keeps [m/s].
    pub speed_limit: f32,
}

/// Slices of the points of a domain that its core alone may change while all read `start`.
pub struct Free<'a> {
    /// As in [`Particles`].
    pub now: &'a mut [Point],
    /// As in [`Particles`].
    pub free: &'a mut [Point],
    /// As in [`Particles`].
    pub low: &'a mut [Point],
    /// As in [`Particles`].
    pub velocity: &'a mut [Point],
}

impl Free<'_> {
    /// Free motion: v = (v + h (g - W K x)) / (1 + drag h), x = x + h v. `first` is the slot of
    /// the first point; `bending` is nothing where bending is a constraint.
    pub fn predict(
        &mut self,
        first: usize,
        start: &[Point],
        bending: Option<&BendingForce>,
        step: &MotionStep,
    ) {
        let h = step.step;
        for i in 0..self.now.len() {
            let here = start[first + i];
            let weight = here[3];
            let mut velocity = self.velocity[i];
            if weight > 0.0 {
                let force = bending.map_or([0.0; 4], |b| b.row(first + i, start));
                for k in 0..4 {
                    let gain = step.gravity[k] - weight * force[k];
                    velocity[k] = (velocity[k] + h * gain) * step.kept;
                }
                velocity[3] = 0.0;
            } else {
                velocity = [0.0; 4];
            }
            let mut now = here;
            for k in 0..3 {
                // The sum and what rounding leaves out of it (Knuth's two-sum).
                let d = h * velocity[k] + self.low[i][k];
                let sum = here[k] + d;
                let part = sum - here[k];
                self.low[i][k] = (here[k] - (sum - part)) + (d - part);
                now[k] = sum;
            }
            self.velocity[i] = velocity;
            self.free[i] = now;
            self.now[i] = now;
        }
    }
}

/// Slices of the points of a domain at the end of a substep.
pub struct Bound<'a> {
    /// As in [`Particles`].
    pub start: &'a mut [Point],
    /// As in [`Particles`].
    pub now: &'a mut [Point],
    /// As in [`Particles`].
    pub free: &'a [Point],
    /// As in [`Particles`].
    pub velocity: &'a mut [Point],
    /// As in [`Particles`].
    pub touch: &'a mut [Touch],
}

impl Bound<'_> {
    /// Keeps vertices outside the surfaces.
    pub fn touch(&mut self, model: &Model, origin: Vec3, step: &ContactStep) {
        for ((now, start), touch) in self.now.iter_mut().zip(&*self.start).zip(&mut *self.touch) {
            let point = [now[0], now[1], now[2]];
            if touch.is_stale(point) {
                touch.look(model, origin, point);
            }
            let change = touch.respond(now[3], point, [start[0], start[1], start[2]], step);
            for k in 0..3 {
                now[k] += now[3] * change[k];
            }
        }
    }

    /// Contact impulses start from zero.
    pub fn clear_touches(&mut self) {
        for touch in &mut *self.touch {
            touch.push = 0.0;
            touch.rub = [0.0; 3];
        }
    }

    /// Velocities from what the constraints moved: v = v + (x - free) / h, so that rounding of
    /// positions does not reach points that nothing touches.
    pub fn finish(&mut self, step: &MotionStep) {
        let per_step = 1.0 / step.step;
        let most2 = step.speed_limit * step.speed_limit;
        let points = self.now.iter().zip(self.free);
        for ((now, free), (start, velocity)) in
            points.zip(self.start.iter_mut().zip(&mut *self.velocity))
        {
            for k in 0..4 {
                velocity[k] += (now[k] - free[k]) * per_step;
            }
            let speed2 =
                velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2];
            if speed2 > RUNAWAY * RUNAWAY * most2 {
                *velocity = [f32::NAN; 4];
            } else if speed2 > most2 {
                let share = step.speed_limit / speed2.sqrt();
                for part in &mut *velocity {
                    *part *= share;
                }
            }
            *start = *now;
        }
    }
}
