//! The particles: prediction of their free motion, bending filter, contact with solids, and velocities.

use super::bending::{BendingForce, Filter};
use super::contact::{ContactStep, Solid};
use super::contact_block::{ContactBlock, solve_block};
use super::several_solids::solve_several;
use crate::lanes::{LANES, Point, Triple, add_scaled, lane_groups, load, store};
use pulp::bytemuck::cast_slice;
use pulp::{Simd, WithSimd};

/// Largest displacement of a vertex in one substep [m]: beyond it the substep counts as unstable and is repeated
/// in pieces.
const MAX_DISPLACEMENT: f32 = 10.0;

/// Particles by slot. The fourth component is the inverse mass [1/kg] in `start` and `now`.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Positions at the start of the substep [m].
    pub start: Vec<Point>,
    /// Positions extrapolated by the lead, at which the bending force is evaluated [m]; see
    /// [`super::bending::LEAD`].
    pub ahead: Vec<Point>,
    /// Present positions [m].
    pub now: Vec<Point>,
    /// Positions predicted by free motion, before constraints [m].
    pub free: Vec<Point>,
    /// Rounding errors of `now` in the prediction [m], added in the next one (compensated summation).
    pub low: Vec<Point>,
    /// Velocities [m/s].
    pub velocity: Vec<Point>,
    /// Velocities without the contact impulses of the substep [m/s]; only where cloth has restitution.
    pub velocity_without_contact: Vec<Point>,
    /// Impulses of the air in the substep [N s]; only where there is air.
    pub air_impulses: Vec<Point>,
    /// Contact of each vertex with each solid: for sixteen vertices a block for every solid.
    pub contacts: Vec<ContactBlock>,
    /// Displacement by the unfiltered bending force, h^2 W K x [m].
    pub unfiltered: Vec<Point>,
    /// Displacement d of the bending filter after two successive stages [m].
    pub filtered: [Vec<Point>; 2],
}

impl Particles {
    /// Zero particles in `count` slots, a multiple of sixteen, without contact with any of `solids` solids.
    pub fn new(count: usize, solids: usize) -> Self {
        let points = vec![[0.0; 4]; count];
        Self {
            start: points.clone(),
            ahead: points.clone(),
            now: points.clone(),
            free: points.clone(),
            low: points.clone(),
            unfiltered: points.clone(),
            filtered: [points.clone(), points.clone()],
            velocity: points,
            velocity_without_contact: Vec::new(),
            air_impulses: Vec::new(),
            contacts: vec![ContactBlock::none(); count / LANES * solids],
        }
    }
}

/// Parameters of a substep for free motion.
#[derive(Clone, Copy)]
pub struct MotionStep {
    /// Substep h [s].
    pub step: f32,
    /// Acceleration of gravity [m/s2].
    pub gravity: Point,
    /// 1 / (1 + drag h).
    pub drag_factor: f32,
    /// Largest speed of a vertex; faster ones are slowed down to it [m/s].
    pub speed_limit: f32,
    /// Time theta h by which positions are extrapolated for the bending force [s].
    pub lead: f32,
}

/// Bending in free motion.
#[derive(Clone, Copy)]
pub enum FreeBending<'a> {
    /// None: bending is constraints.
    None,
    /// The force at positions, [`Particles::ahead`].
    Force(&'a BendingForce, &'a [Point]),
    /// Displacements of the filter, times its factor.
    Filtered(&'a [Point], f32),
}

/// The arrays of [`Particles`] that the prediction of a domain writes, while all domains read `start`.
pub struct PredictSlices<'a> {
    /// As in [`Particles`].
    pub now: &'a mut [Point],
    /// As in [`Particles`].
    pub free: &'a mut [Point],
    /// As in [`Particles`].
    pub low: &'a mut [Point],
    /// As in [`Particles`].
    pub velocity: &'a mut [Point],
}

/// Prediction by free motion in a domain: v = (v + h (g - W K x)) / (1 + drag h), x = x + h v; pinned points move at
/// their prescribed velocity.
pub struct Predict<'a, 'b> {
    /// The domain.
    pub fields: &'b mut PredictSlices<'a>,
    /// Slot of its first point.
    pub first: usize,
    /// All points at the start of the substep.
    pub start: &'a [Point],
    /// Bending.
    pub bending: FreeBending<'a>,
    /// Impulses of the air on all points; empty where there is none.
    pub air_impulses: &'a [Point],
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
        let (impulses, _) = self.air_impulses.as_chunks::<LANES>();
        for b in 0..now.len() {
            for lane_group in 0..lane_groups::<S>() {
                let block = [&mut now[b], &mut free[b], &mut low[b], &mut velocity[b]];
                let mut gain = self
                    .bending
                    .gain(simd, first + b, lane_group, self.step.step);
                if let Some(impulses) = impulses.get(first + b) {
                    let [x, y, z, _] = load(simd, impulses, lane_group);
                    let weight = load(simd, &starts[first + b], lane_group)[3];
                    gain = add_scaled(simd, gain, [x, y, z], weight);
                }
                self.step
                    .predict(simd, &starts[first + b], block, lane_group, gain);
            }
        }
    }
}

impl FreeBending<'_> {
    /// The velocity change by bending of one lane group of a block in a substep of h [s].
    #[inline(always)]
    fn gain<S: Simd>(&self, simd: S, block: usize, lane_group: usize, h: f32) -> Triple<S::f32s> {
        match self {
            Self::None => [simd.splat_f32s(0.0); 3],
            Self::Force(force, ahead) => {
                let (positions, _) = ahead.as_chunks::<LANES>();
                let here = load(simd, &positions[block], lane_group);
                let sum = force.times(simd, LANES * block, ahead, here, lane_group);
                let scale = simd.mul_f32s(here[3], simd.splat_f32s(-h));
                scaled(simd, sum, scale)
            }
            Self::Filtered(filtered, factor) => {
                let (filtered, _) = filtered.as_chunks::<LANES>();
                let [x, y, z, _] = load(simd, &filtered[block], lane_group);
                scaled(simd, [x, y, z], simd.splat_f32s(factor / h))
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
    /// Predicts one lane group; `gain` is the velocity change by bending [m/s].
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
        let (h, drag_factor) = (
            simd.splat_f32s(self.step),
            simd.splat_f32s(self.drag_factor),
        );
        let zero = simd.splat_f32s(0.0);
        let here = load(simd, start, lane_group);
        let weight = here[3];
        let is_free = simd.less_than_f32s(zero, weight);
        let mut speed = load(simd, velocity, lane_group);
        let mut error = load(simd, low, lane_group);
        let mut there = here;
        for k in 0..3 {
            let fall = simd.splat_f32s(self.step * self.gravity[k]);
            let gained = simd.add_f32s(simd.add_f32s(speed[k], fall), gain[k]);
            let v = simd.select_f32s(is_free, simd.mul_f32s(gained, drag_factor), speed[k]);
            // The sum and its rounding error (Knuth's two-sum).
            let d = simd.mul_add_e_f32s(h, v, error[k]);
            let sum = simd.add_f32s(here[k], d);
            let added = simd.sub_f32s(sum, here[k]);
            let lost = simd.sub_f32s(here[k], simd.sub_f32s(sum, added));
            error[k] = simd.add_f32s(lost, simd.sub_f32s(d, added));
            speed[k] = v;
            there[k] = sum;
        }
        store(simd, now, lane_group, there);
        store(simd, free, lane_group, there);
        store(simd, low, lane_group, error);
        store(simd, velocity, lane_group, speed);
    }
}

/// The arrays that a stage of the bending filter writes in a domain.
pub struct FilterSlices<'a> {
    /// Displacement by the unfiltered force, h^2 W K x [m].
    pub unfiltered: &'a mut [Point],
    /// Displacements of the stage before the last; overwritten by those of the new stage [m].
    pub filtered: &'a mut [Point],
}

/// One stage of the bending filter in a domain; see [`Filter`].
pub struct FilterStage<'a, 'b> {
    /// The domain.
    pub fields: &'b mut FilterSlices<'a>,
    /// Slot of its first point.
    pub first: usize,
    /// As in [`Particles`].
    pub ahead: &'a [Point],
    /// Displacements of the last stage; none before the first.
    pub last: Option<&'a [Point]>,
    /// The bending matrix K.
    pub force: &'a BendingForce,
    /// The coefficients of the stage: mu, nu, kappa.
    pub coefficients: [f32; 3],
    /// h^2 [s2].
    pub step2: f32,
}

impl WithSimd for FilterStage<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let first = self.first / LANES;
        let (positions, _) = self.ahead.as_chunks::<LANES>();
        let (unfiltered, _) = self.fields.unfiltered.as_chunks_mut::<LANES>();
        let (filtered, _) = self.fields.filtered.as_chunks_mut::<LANES>();
        let [mu, nu, kappa] = self.coefficients.map(|x| simd.splat_f32s(x));
        let zero = simd.splat_f32s(0.0);
        for b in 0..unfiltered.len() {
            let slot = LANES * (first + b);
            for lane_group in 0..lane_groups::<S>() {
                let here = load(simd, &positions[first + b], lane_group);
                let scale = simd.mul_f32s(here[3], simd.splat_f32s(self.step2));
                let new = match self.last {
                    None => {
                        let sum = self.force.times(simd, slot, self.ahead, here, lane_group);
                        let [x, y, z] = scaled(simd, sum, scale);
                        store(simd, &mut unfiltered[b], lane_group, [x, y, z, zero]);
                        scaled(simd, [x, y, z], simd.sub_f32s(zero, kappa))
                    }
                    Some(last) => {
                        let (lasts, _) = last.as_chunks::<LANES>();
                        let d = load(simd, &lasts[first + b], lane_group);
                        let before = load(simd, &filtered[b], lane_group);
                        let constant = load(simd, &unfiltered[b], lane_group);
                        let sum = self.force.times(simd, slot, last, d, lane_group);
                        let mut new = [zero; 3];
                        for k in 0..3 {
                            let all = simd.mul_add_e_f32s(sum[k], scale, constant[k]);
                            let recursion = simd.mul_f32s(mu, d[k]);
                            let recursion = simd.negate_mul_add_e_f32s(nu, before[k], recursion);
                            new[k] = simd.negate_mul_add_e_f32s(kappa, all, recursion);
                        }
                        new
                    }
                };
                store(
                    simd,
                    &mut filtered[b],
                    lane_group,
                    [new[0], new[1], new[2], zero],
                );
            }
        }
    }
}

impl Filter {
    /// Whether the force is used without a filter.
    pub fn is_identity(&self) -> bool {
        self.stages.is_empty()
    }
}

/// The arrays of [`Particles`] that the end of an iteration reads or writes in a domain.
pub struct FinishSlices<'a> {
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

/// The end of an iteration in a domain: contacts of vertices with solids are solved. After the last iteration
/// velocities are updated by the displacement due to constraints, v = v + (x - x_free) / h, so that rounding of
/// positions does not enter the velocities of points without constraints.
pub struct FinishIteration<'a, 'b> {
    /// The domain.
    pub fields: &'b mut FinishSlices<'a>,
    /// The solids, where there are any.
    pub solid: Option<Solid<'a>>,
    /// Parameters for contacts.
    pub contact: &'a ContactStep,
    /// Parameters of the substep in its last iteration, else none.
    pub finish: Option<&'a MotionStep>,
}

impl WithSimd for FinishIteration<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (start, _) = self.fields.start.as_chunks_mut::<LANES>();
        let (ahead, _) = self.fields.ahead.as_chunks_mut::<LANES>();
        let (now, _) = self.fields.now.as_chunks_mut::<LANES>();
        let (free, _) = self.fields.free.as_chunks::<LANES>();
        let (velocity, _) = self.fields.velocity.as_chunks_mut::<LANES>();
        let solids = self.fields.contacts.len() / now.len().max(1);
        for b in 0..now.len() {
            let contacts = &mut self.fields.contacts[b * solids..(b + 1) * solids];
            if let Some(solid) = &self.solid {
                for lane_group in 0..lane_groups::<S>() {
                    let (now, start) = (&mut now[b], &start[b]);
                    solve_contacts(
                        simd,
                        contacts,
                        (now, start),
                        (solid, self.contact),
                        lane_group,
                    );
                }
            }
            if let Some(step) = self.finish {
                for contact in contacts {
                    contact.end_substep(&now[b], &start[b], self.contact);
                }
                step.finish(simd, &now[b], &free[b], &mut velocity[b]);
                start[b] = now[b];
                step.extrapolate(&start[b], &velocity[b], &mut ahead[b]);
            }
        }
    }
}

/// Queries the surfaces anew where planes are stale, and solves the contacts of the points of a lane group with all
/// solids.
#[inline(always)]
fn solve_contacts<S: Simd>(
    simd: S,
    contacts: &mut [ContactBlock],
    (now, start): (&mut [Point; LANES], &[Point; LANES]),
    (solid, step): (&Solid, &ContactStep),
    lane_group: usize,
) {
    let first = lane_group * S::F32_LANES;
    let lanes = first..first + S::F32_LANES;
    let mut any = simd.less_than_f32s(simd.splat_f32s(0.0), simd.splat_f32s(0.0));
    let mut several = any;
    for contact in &mut *contacts {
        if contact.is_stale(simd, now, lane_group) {
            contact.query_surfaces(solid, now, lanes.clone());
        }
        let touches = contact.touches(simd, now, lane_group);
        several = simd.or_m32s(several, simd.and_m32s(any, touches));
        any = simd.or_m32s(any, touches);
    }
    let [zero, one] = [0.0, 1.0].map(|x| simd.splat_f32s(x));
    if simd.reduce_max_f32s(simd.select_f32s(several, one, zero)) > 0.0 {
        return solve_several(contacts, now, start, step, lanes);
    }
    for contact in contacts {
        solve_block(simd, contact, now, start, step, lane_group);
    }
}

impl MotionStep {
    /// Extrapolates positions by the lead of the bending force.
    #[inline(always)]
    pub fn extrapolate(&self, start: &[Point], velocity: &[Point], ahead: &mut [Point]) {
        for ((ahead, x), v) in ahead.iter_mut().zip(start).zip(velocity) {
            for k in 0..4 {
                ahead[k] = x[k] + self.lead * v[k];
            }
        }
    }

    /// Updates the velocities of a block.
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
        let limit = self.speed_limit.min(MAX_DISPLACEMENT / self.step);
        if simd.reduce_max_f32s(largest) > 0.25 * limit * limit {
            self.limit(velocity);
        }
    }

    /// Limits speeds, and sets the velocity of an unstable particle to NaN, by which the substep is rejected.
    #[inline(never)]
    fn limit(&self, velocity: &mut [Point; LANES]) {
        let limit2 = self.speed_limit * self.speed_limit;
        for v in velocity {
            let speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            if speed2 * self.step * self.step > MAX_DISPLACEMENT * MAX_DISPLACEMENT {
                *v = [f32::NAN; 4];
            } else if speed2 > limit2 {
                let share = self.speed_limit / speed2.sqrt();
                *v = v.map(|component| component * share);
            }
        }
    }
}
