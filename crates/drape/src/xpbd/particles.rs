//! The points: where they go by themselves, and what the constraints did to their velocities.

use super::bending::{BendingForce, Filter};
use super::contact::{ContactStep, Solid};
use super::contact_block::{ContactBlock, solve_block};
use crate::lanes::{LANES, Point, lane_groups, load, store};
use pulp::bytemuck::cast_slice;
use pulp::{Simd, WithSimd};

/// Farthest that a vertex may go in one substep [m]: what goes farther was thrown by a substep that
/// is too large.
const FARTHEST_MOVE: f32 = 10.0;

/// Points by slot. Fourth numbers: inverse mass in `start` and `now`, zero elsewhere.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Where they were when the substep began [m].
    pub start: Vec<Point>,
    /// Where they would be a little later [m]: bending is felt from there, see [`super::bending::LEAD`].
    pub ahead: Vec<Point>,
    /// Where they are [m].
    pub now: Vec<Point>,
    /// Where they went by themselves [m].
    pub free: Vec<Point>,
    /// What single precision left out of `now` [m].
    pub low: Vec<Point>,
    /// Velocities [m/s].
    pub velocity: Vec<Point>,
    /// Velocities without what contacts did in the substep [m/s]; only where cloth bounces.
    pub without: Vec<Point>,
    /// Contact of each vertex with the surfaces, sixteen a block.
    pub contacts: Vec<ContactBlock>,
    /// h^2 W K x [m].
    pub pull: Vec<Point>,
    /// How far bending moves them in the substep, by the present stage of its filter and the last
    /// one [m].
    pub bend: [Vec<Point>; 2],
}

impl Particles {
    /// Room for some slots, a multiple of sixteen.
    pub fn new(count: usize) -> Self {
        let points = vec![[0.0; 4]; count];
        Self {
            start: points.clone(),
            ahead: points.clone(),
            now: points.clone(),
            free: points.clone(),
            low: points.clone(),
            pull: points.clone(),
            bend: [points.clone(), points.clone()],
            velocity: points,
            without: Vec::new(),
            contacts: vec![ContactBlock::none(); count / LANES],
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
    /// How long after a substep's start bending is felt as it would be then [s].
    pub lead: f32,
}

/// How bending enters free motion.
#[derive(Clone, Copy)]
pub enum Bend<'a> {
    /// It does not.
    None,
    /// As the force at some places, [`Particles::ahead`].
    Force(&'a BendingForce, &'a [Point]),
    /// As moves found before, times a factor.
    Moves(&'a [Point], f32),
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

/// Free motion of a domain: v = (v + h (g - W K x)) / (1 + drag h), x = x + h v; pinned points go on
/// at the velocity they have.
pub struct Predict<'a, 'b> {
    /// The domain.
    pub fields: &'b mut Free<'a>,
    /// Slot of its first point.
    pub first: usize,
    /// All points at the start of the substep.
    pub start: &'a [Point],
    /// Bending.
    pub bend: Bend<'a>,
    /// The substep.
    pub step: &'a MotionStep,
}

impl WithSimd for Predict<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let first = self.first / LANES;
        let (starts, _) = self.start.as_chunks::<LANES>();
        let (now, _) = self.fields.now.as_chunks_mut::<LANES>();
        let (free, _) = self.fields.free.as_chunks_mut::<LANES>();
        let (low, _) = self.fields.low.as_chunks_mut::<LANES>();
        let (velocity, _) = self.fields.velocity.as_chunks_mut::<LANES>();
        for b in 0..now.len() {
            for lane_group in 0..lane_groups::<S>() {
                let block = [&mut now[b], &mut free[b], &mut low[b], &mut velocity[b]];
                self.step
                    .predict(simd, &starts[first + b], block, lane_group, {
                        let slot = LANES * (first + b);
                        match self.bend {
                            Bend::None => [simd.splat_f32s(0.0); 3],
                            Bend::Force(force, ahead) => {
                                let (places, _) = ahead.as_chunks::<LANES>();
                                let here = load(simd, &places[first + b], lane_group);
                                let sum = force.times(simd, slot, ahead, here, lane_group);
                                let scale =
                                    simd.mul_f32s(here[3], simd.splat_f32s(-self.step.step));
                                scaled(simd, sum, scale)
                            }
                            Bend::Moves(moves, factor) => {
                                let (moves, _) = moves.as_chunks::<LANES>();
                                let [x, y, z, _] = load(simd, &moves[first + b], lane_group);
                                let factor = simd.splat_f32s(factor / self.step.step);
                                scaled(simd, [x, y, z], factor)
                            }
                        }
                    });
            }
        }
    }
}

#[inline(always)]
fn scaled<S: Simd>(simd: S, a: [S::f32s; 3], s: S::f32s) -> [S::f32s; 3] {
    [
        simd.mul_f32s(a[0], s),
        simd.mul_f32s(a[1], s),
        simd.mul_f32s(a[2], s),
    ]
}

impl MotionStep {
    /// `gain` is the velocity that bending adds.
    #[inline(always)]
    fn predict<S: Simd>(
        &self,
        simd: S,
        start: &[Point; LANES],
        block: [&mut [Point; LANES]; 4],
        lane_group: usize,
        gain: [S::f32s; 3],
    ) {
        let [now, free, low, velocity] = block;
        let (h, kept) = (simd.splat_f32s(self.step), simd.splat_f32s(self.kept));
        let zero = simd.splat_f32s(0.0);
        let here = load(simd, start, lane_group);
        let weight = here[3];
        let moves = simd.less_than_f32s(zero, weight);
        let mut speed = load(simd, velocity, lane_group);
        let mut rest = load(simd, low, lane_group);
        let mut there = here;
        for k in 0..3 {
            let fall = simd.splat_f32s(self.step * self.gravity[k]);
            let gained = simd.add_f32s(simd.add_f32s(speed[k], fall), gain[k]);
            let v = simd.select_f32s(moves, simd.mul_f32s(gained, kept), speed[k]);
            // The sum and what rounding leaves out of it (Knuth's two-sum).
            let d = simd.mul_add_e_f32s(h, v, rest[k]);
            let sum = simd.add_f32s(here[k], d);
            let share = simd.sub_f32s(sum, here[k]);
            let lost = simd.sub_f32s(here[k], simd.sub_f32s(sum, share));
            rest[k] = simd.add_f32s(lost, simd.sub_f32s(d, share));
            speed[k] = v;
            there[k] = sum;
        }
        store(simd, now, lane_group, there);
        store(simd, free, lane_group, there);
        store(simd, low, lane_group, rest);
        store(simd, velocity, lane_group, speed);
    }
}

/// Slices of a domain that a stage of the bending filter writes.
pub struct Stage<'a> {
    /// h^2 W K x.
    pub pull: &'a mut [Point],
    /// The stage before the last; overwritten by the new one.
    pub moves: &'a mut [Point],
}

/// One stage of the bending filter on a domain; see [`Filter`].
pub struct RunStage<'a, 'b> {
    /// The domain.
    pub fields: &'b mut Stage<'a>,
    /// Slot of its first point.
    pub first: usize,
    /// As in [`Particles`].
    pub ahead: &'a [Point],
    /// The moves of the last stage; none before the first.
    pub last: Option<&'a [Point]>,
    /// K.
    pub force: &'a BendingForce,
    /// The filter's numbers for the stage: mu, nu, kappa.
    pub numbers: [f32; 3],
    /// h^2 [s2].
    pub step2: f32,
}

impl WithSimd for RunStage<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let first = self.first / LANES;
        let (places, _) = self.ahead.as_chunks::<LANES>();
        let (pull, _) = self.fields.pull.as_chunks_mut::<LANES>();
        let (moves, _) = self.fields.moves.as_chunks_mut::<LANES>();
        let [mu, nu, kappa] = self.numbers.map(|x| simd.splat_f32s(x));
        let zero = simd.splat_f32s(0.0);
        for b in 0..pull.len() {
            let slot = LANES * (first + b);
            for lane_group in 0..lane_groups::<S>() {
                let here = load(simd, &places[first + b], lane_group);
                let scale = simd.mul_f32s(here[3], simd.splat_f32s(self.step2));
                let new = match self.last {
                    None => {
                        let sum = self.force.times(simd, slot, self.ahead, here, lane_group);
                        let [x, y, z] = scaled(simd, sum, scale);
                        store(simd, &mut pull[b], lane_group, [x, y, z, zero]);
                        scaled(simd, [x, y, z], simd.sub_f32s(zero, kappa))
                    }
                    Some(last) => {
                        let (lasts, _) = last.as_chunks::<LANES>();
                        let moved = load(simd, &lasts[first + b], lane_group);
                        let before = load(simd, &moves[b], lane_group);
                        let pulled = load(simd, &pull[b], lane_group);
                        let sum = self.force.times(simd, slot, last, moved, lane_group);
                        let mut new = [zero; 3];
                        for k in 0..3 {
                            let all = simd.mul_add_e_f32s(sum[k], scale, pulled[k]);
                            let kept = simd.mul_f32s(mu, moved[k]);
                            let kept = simd.negate_mul_add_e_f32s(nu, before[k], kept);
                            new[k] = simd.negate_mul_add_e_f32s(kappa, all, kept);
                        }
                        new
                    }
                };
                store(
                    simd,
                    &mut moves[b],
                    lane_group,
                    [new[0], new[1], new[2], zero],
                );
            }
        }
    }
}

impl Filter {
    /// Whether the force alone is stable.
    pub fn is_plain(&self) -> bool {
        self.stages.is_empty()
    }
}

/// Slices of the points of a domain at the end of a substep.
pub struct Bound<'a> {
    /// As in [`Particles`].
    pub start: &'a mut [Point],
    /// As in [`Particles`].
    pub ahead: &'a mut [Point],
    /// As in [`Particles`].
    pub now: &'a mut [Point],
    /// As in [`Particles`].
    pub free: &'a [Point],
    /// As in [`Particles`].
    pub velocity: &'a mut [Point],
    /// As in [`Particles`].
    pub contacts: &'a mut [ContactBlock],
}

/// The end of an iteration on a domain: vertices are kept outside the surfaces; after the last one
/// velocities follow from what the constraints moved, v = v + (x - free) / h, so that rounding of
/// positions does not reach points that nothing touches.
pub struct Settle<'a, 'b> {
    /// The domain.
    pub fields: &'b mut Bound<'a>,
    /// The surfaces, where there are any.
    pub solid: Option<Solid<'a>>,
    /// Contact's numbers.
    pub contact: &'a ContactStep,
    /// The substep, at its end.
    pub finish: Option<&'a MotionStep>,
}

impl WithSimd for Settle<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (start, _) = self.fields.start.as_chunks_mut::<LANES>();
        let (ahead, _) = self.fields.ahead.as_chunks_mut::<LANES>();
        let (now, _) = self.fields.now.as_chunks_mut::<LANES>();
        let (free, _) = self.fields.free.as_chunks::<LANES>();
        let (velocity, _) = self.fields.velocity.as_chunks_mut::<LANES>();
        for b in 0..now.len() {
            if let Some(solid) = &self.solid {
                for lane_group in 0..lane_groups::<S>() {
                    let contact = &mut self.fields.contacts[b];
                    let now = &mut now[b];
                    if contact.is_stale(simd, now, lane_group) {
                        let first = lane_group * S::F32_LANES;
                        contact.query_surfaces(solid, now, first..first + S::F32_LANES);
                    }
                    solve_block(simd, contact, now, &start[b], self.contact, lane_group);
                }
            }
            if let Some(step) = self.finish {
                step.finish(simd, &now[b], &free[b], &mut velocity[b]);
                start[b] = now[b];
                step.look_ahead(&start[b], &velocity[b], &mut ahead[b]);
            }
        }
    }
}

impl MotionStep {
    /// Where points would be when bending is felt.
    #[inline(always)]
    pub fn look_ahead(&self, start: &[Point], velocity: &[Point], ahead: &mut [Point]) {
        for ((ahead, x), v) in ahead.iter_mut().zip(start).zip(velocity) {
            for k in 0..4 {
                ahead[k] = x[k] + self.lead * v[k];
            }
        }
    }

    #[inline(always)]
    fn finish<S: Simd>(
        &self,
        simd: S,
        now: &[Point; LANES],
        free: &[Point; LANES],
        velocity: &mut [Point; LANES],
    ) {
        let per_step = simd.splat_f32s(1.0 / self.step);
        let (now, _) = S::as_simd_f32s(cast_slice(&now[..]));
        let (free, _) = S::as_simd_f32s(cast_slice(&free[..]));
        let mut largest = simd.splat_f32s(0.0);
        {
            let flat = pulp::bytemuck::cast_slice_mut(&mut velocity[..]);
            let (velocity, _) = S::as_mut_simd_f32s(flat);
            for k in 0..velocity.len() {
                let moved = simd.sub_f32s(now[k], free[k]);
                velocity[k] = simd.mul_add_e_f32s(moved, per_step, velocity[k]);
                largest = simd.max_f32s(largest, simd.mul_f32s(velocity[k], velocity[k]));
            }
        }
        // Only a component beyond limit / 2 can belong to a speed beyond the limit.
        let limit = self.speed_limit.min(FARTHEST_MOVE / self.step);
        if simd.reduce_max_f32s(largest) > 0.25 * limit * limit {
            self.limit(velocity);
        }
    }

    #[inline(never)]
    fn limit(&self, velocity: &mut [Point; LANES]) {
        let most2 = self.speed_limit * self.speed_limit;
        for v in velocity {
            let speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            if speed2 * self.step * self.step > FARTHEST_MOVE * FARTHEST_MOVE {
                *v = [f32::NAN; 4];
            } else if speed2 > most2 {
                let share = self.speed_limit / speed2.sqrt();
                *v = v.map(|component| component * share);
            }
        }
    }
}
