//! The particles: prediction of their free motion, bending filter, contact with solids, and velocities.

use super::bending::{BendingForce, Filter};
use super::contact::{ContactStep, Solid};
use super::contact_block::{ContactBlock, solve_block};
use super::several_solids::solve_several;
use crate::lane_arithmetic::{F32s, Number, Triple};
use crate::lanes::{LANES, Point, PointLanes, lane_groups, load, store};
use pulp::bytemuck::cast_slice;
use pulp::{Simd, WithSimd};

/// Largest displacement of a vertex in one substep (m): beyond it the substep counts as unstable and is repeated
/// in pieces.
const MAX_DISPLACEMENT: f32 = 10.0;

/// Particles by slot. The fourth component is the inverse mass (1/kg) in `start` and `now`.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Positions at the start of the substep (m).
    pub start: Vec<Point>,
    /// Positions extrapolated by the lead, at which the bending force is evaluated (m); see
    /// [`super::bending::LEAD`].
    pub ahead: Vec<Point>,
    /// Present positions (m).
    pub now: Vec<Point>,
    /// Positions predicted by free motion, before constraints (m).
    pub free: Vec<Point>,
    /// Rounding errors of `now` in the prediction (m), added in the next one (compensated summation).
    pub low: Vec<Point>,
    /// Velocities (m/s).
    pub velocity: Vec<Point>,
    /// Velocities without the contact impulses of the substep (m/s); only where cloth has restitution.
    pub velocity_without_contact: Vec<Point>,
    /// Impulses of the air in the substep (N s); only where there is air.
    pub air_impulses: Vec<Point>,
    /// Contact of each vertex with each solid: for sixteen vertices a block for every solid.
    pub contacts: Vec<ContactBlock>,
    /// Displacement by the unfiltered bending force, h^2 W K x (m).
    pub unfiltered: Vec<Point>,
    /// Displacement d of the bending filter after two successive stages (m).
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
    /// Substep h (s).
    pub step: f32,
    /// Acceleration of gravity (m/s2).
    pub gravity: Point,
    /// 1 / (1 + drag h).
    pub drag_factor: f32,
    /// Largest speed of a vertex; faster ones are slowed down to it (m/s).
    pub speed_limit: f32,
    /// Time theta h by which positions are extrapolated for the bending force (s).
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
                let start = load(simd, &starts[first + b], lane_group);
                if let Some(impulses) = impulses.get(first + b) {
                    let (impulse, _) = load(simd, impulses, lane_group);
                    gain = gain.add_scaled(impulse, start.1);
                }
                self.step.predict(simd, start, block, lane_group, gain);
            }
        }
    }
}

impl FreeBending<'_> {
    /// The velocity change by bending of one lane group of a block in a substep of h (s).
    #[inline(always)]
    fn gain<S: Simd>(&self, simd: S, block: usize, lane_group: usize, h: f32) -> Triple<F32s<S>> {
        match self {
            Self::None => Triple::repeat(F32s::splat(simd, 0.0)),
            Self::Force(force, ahead) => {
                let (positions, _) = ahead.as_chunks::<LANES>();
                let (here, weight) = load(simd, &positions[block], lane_group);
                let sum = force.times(simd, LANES * block, ahead, here, lane_group);
                sum * (weight * -h)
            }
            Self::Filtered(filtered, factor) => {
                let (filtered, _) = filtered.as_chunks::<LANES>();
                let (displacement, _) = load(simd, &filtered[block], lane_group);
                displacement * F32s::splat(simd, factor / h)
            }
        }
    }
}

impl MotionStep {
    /// Predicts one lane group from the points at the start; `gain` is the velocity change by bending (m/s).
    #[inline(always)]
    fn predict<S: Simd>(
        &self,
        simd: S,
        (here, weight): PointLanes<S>,
        block: [&mut [Point; LANES]; 4],
        lane_group: usize,
        gain: Triple<F32s<S>>,
    ) {
        let [now, free, low, velocity] = block;
        let h = F32s::splat(simd, self.step);
        let is_free = F32s::splat(simd, 0.0).less_than(weight);
        let (speed, fourth) = load(simd, velocity, lane_group);
        let (error, rest) = load(simd, low, lane_group);
        let fall = Triple([
            F32s::splat(simd, self.step * self.gravity[0]),
            F32s::splat(simd, self.step * self.gravity[1]),
            F32s::splat(simd, self.step * self.gravity[2]),
        ]);
        let drag_factor = F32s::splat(simd, self.drag_factor);
        let gained = speed + fall + gain;
        let speed = is_free.select_triple(gained * drag_factor, speed);
        // The sum and its rounding error (Knuth's two-sum).
        let d = error.add_scaled(speed, h);
        let there = here + d;
        let added = there - here;
        let lost = here - (there - added);
        let error = lost + (d - added);
        store(now, lane_group, (there, weight));
        store(free, lane_group, (there, weight));
        store(low, lane_group, (error, rest));
        store(velocity, lane_group, (speed, fourth));
    }
}

/// The arrays that a stage of the bending filter writes in a domain.
pub struct FilterSlices<'a> {
    /// Displacement by the unfiltered force, h^2 W K x (m).
    pub unfiltered: &'a mut [Point],
    /// Displacements of the stage before the last; overwritten by those of the new stage (m).
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
    /// h^2 (s2).
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
        let [mu, nu, kappa] = self.coefficients;
        let (mu, nu) = (F32s::splat(simd, mu), F32s::splat(simd, nu));
        let kappa = F32s::splat(simd, kappa);
        let zero = F32s::splat(simd, 0.0);
        for b in 0..unfiltered.len() {
            let slot = LANES * (first + b);
            for lane_group in 0..lane_groups::<S>() {
                let (here, weight) = load(simd, &positions[first + b], lane_group);
                let scale = weight * self.step2;
                let new = match self.last {
                    None => {
                        let sum = self.force.times(simd, slot, self.ahead, here, lane_group);
                        let all = sum * scale;
                        store(&mut unfiltered[b], lane_group, (all, zero));
                        all * (zero - kappa)
                    }
                    Some(last) => {
                        let (lasts, _) = last.as_chunks::<LANES>();
                        let (d, _) = load(simd, &lasts[first + b], lane_group);
                        let (before, _) = load(simd, &filtered[b], lane_group);
                        let (constant, _) = load(simd, &unfiltered[b], lane_group);
                        let sum = self.force.times(simd, slot, last, d, lane_group);
                        let all = constant.add_scaled(sum, scale);
                        (d * mu)
                            .subtract_scaled(before, nu)
                            .subtract_scaled(all, kappa)
                    }
                };
                store(&mut filtered[b], lane_group, (new, zero));
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
    let zero = F32s::splat(simd, 0.0);
    let mut any = zero.less_than(zero);
    let mut several = any;
    for contact in &mut *contacts {
        if contact.is_stale(simd, now, lane_group) {
            contact.query_surfaces(solid, now, lanes.clone());
        }
        let touches = contact.touches(simd, now, lane_group);
        several = several | (any & touches);
        any = any | touches;
    }
    if several.any() {
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
        let per_step = F32s::splat(simd, 1.0 / self.step);
        let (now, _) = S::as_simd_f32s(cast_slice(&now[..]));
        let (free, _) = S::as_simd_f32s(cast_slice(&free[..]));
        let mut largest = F32s::splat(simd, 0.0);
        {
            let flat = pulp::bytemuck::cast_slice_mut(&mut velocity[..]);
            let (velocity, _) = S::as_mut_simd_f32s(flat);
            for k in 0..velocity.len() {
                let (now, free) = (F32s::new(simd, now[k]), F32s::new(simd, free[k]));
                let v = (now - free).mul_add(per_step, F32s::new(simd, velocity[k]));
                velocity[k] = v.vector;
                largest = largest.max(v * v);
            }
        }
        // Only a component beyond limit / 2 can belong to a speed beyond the limit.
        let limit = self.speed_limit.min(MAX_DISPLACEMENT / self.step);
        if largest.reduce_max() > 0.25 * limit * limit {
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
