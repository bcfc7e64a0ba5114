//! Contacts of sixteen vertices with a solid, solved side by side in vector registers.

use super::carried_plane::CarriedPlane;
use super::contact::{ContactConstraint, ContactStep, NO_SAMPLE, Solid, TANGENTIAL_SOFTNESS};
use crate::State;
use crate::lane_arithmetic::{F32s, Mask, Number, Triple};
use crate::lanes::{LANES, Point, Row, lane_group_of, load, set_lane_group_of, store};
use pulp::Simd;

/// The contacts of sixteen vertices with one solid, a lane each; fields as in [`ContactConstraint`].
#[derive(Clone, Debug)]
pub struct ContactBlock {
    normal: [Row; 3],
    level: Row,
    queried_at: [Row; 3],
    radius2: Row,
    compliance: Row,
    friction: Row,
    offset: Row,
    lambda_normal: Row,
    lambda_tangent: [Row; 3],
    slip: [Row; 3],
    surface_displacement: [Row; 3],
    sample: [u32; LANES],
    solid: u32,
    /// The planes of a solid that moves.
    carried: Option<Box<[CarriedPlane; LANES]>>,
}

impl ContactBlock {
    /// Contacts with no surface.
    pub fn none() -> Self {
        let zero = Row::splat(0.0);
        let mut block = Self {
            normal: [zero; 3],
            level: zero,
            queried_at: [zero; 3],
            radius2: zero,
            compliance: zero,
            friction: zero,
            offset: zero,
            lambda_normal: zero,
            lambda_tangent: [zero; 3],
            slip: [zero; 3],
            surface_displacement: [zero; 3],
            sample: [NO_SAMPLE; LANES],
            solid: 0,
            carried: None,
        };
        for lane in 0..LANES {
            block.set(lane, &ContactConstraint::none());
        }
        block
    }

    /// The contact of a lane.
    pub fn get(&self, lane: usize) -> ContactConstraint {
        let three = |rows: &[Row; 3]| rows.map(|row| row.0[lane]);
        ContactConstraint {
            normal: three(&self.normal),
            level: self.level.0[lane],
            queried_at: three(&self.queried_at),
            radius2: self.radius2.0[lane],
            compliance: self.compliance.0[lane],
            tangential_compliance: TANGENTIAL_SOFTNESS * self.compliance.0[lane],
            hard_from: f32::INFINITY,
            friction: self.friction.0[lane],
            offset: self.offset.0[lane],
            sample: self.sample[lane],
            solid: self.solid,
            lambda_normal: self.lambda_normal.0[lane],
            lambda_tangent: three(&self.lambda_tangent),
            slip: three(&self.slip),
            surface_displacement: three(&self.surface_displacement),
        }
    }

    /// [`ContactConstraint::recall`] for all lanes.
    pub fn recall(&mut self, state: &State, points: &[Point], step: &ContactStep) {
        for (lane, point) in points.iter().enumerate() {
            let mut contact = self.get(lane);
            contact.recall(state, point[3], step);
            self.set(lane, &contact);
        }
    }

    /// Lanes whose contacts have a normal multiplier in the substep.
    pub fn loaded(&self) -> impl Iterator<Item = usize> + '_ {
        (0..LANES).filter(|&lane| self.lambda_normal.0[lane] > 0.0)
    }

    /// Sets the contact of a lane.
    pub fn set(&mut self, lane: usize, contact: &ContactConstraint) {
        for k in 0..3 {
            self.normal[k].0[lane] = contact.normal[k];
            self.queried_at[k].0[lane] = contact.queried_at[k];
            self.lambda_tangent[k].0[lane] = contact.lambda_tangent[k];
            self.slip[k].0[lane] = contact.slip[k];
            self.surface_displacement[k].0[lane] = contact.surface_displacement[k];
        }
        self.level.0[lane] = contact.level;
        self.radius2.0[lane] = contact.radius2;
        self.compliance.0[lane] = contact.compliance;
        self.friction.0[lane] = contact.friction;
        self.offset.0[lane] = contact.offset;
        self.sample[lane] = contact.sample;
        if contact.sample != NO_SAMPLE {
            self.solid = contact.solid;
        }
        self.lambda_normal.0[lane] = contact.lambda_normal;
    }

    /// [`ContactConstraint::invalidate`] for all lanes.
    pub fn invalidate(&mut self) {
        for (radius2, &sample) in self.radius2.0.iter_mut().zip(&self.sample) {
            if sample != NO_SAMPLE {
                *radius2 = -1.0;
            }
        }
    }

    /// [`ContactConstraint::carry`] for all lanes.
    pub fn carry(&mut self, solid: &Solid) {
        let Some(carried) = self.carried.take() else {
            return;
        };
        let is_near = |block: &Self, lane: usize| block.normal.iter().any(|row| row.0[lane] != 0.0);
        for lane in 0..LANES {
            if self.sample[lane] != NO_SAMPLE && is_near(self, lane) {
                let mut contact = self.get(lane);
                contact.carry(solid, &carried[lane]);
                self.set(lane, &contact);
            }
        }
        self.carried = Some(carried);
    }

    /// Sets the multipliers to zero.
    pub fn clear(&mut self) {
        self.lambda_normal = Row::splat(0.0);
        self.lambda_tangent = [Row::splat(0.0); 3];
    }

    /// Whether a point of a lane group is below the surface or was pushed by it.
    #[inline(always)]
    pub fn touches<S: Simd>(&self, simd: S, points: &[Point; LANES], lane_group: usize) -> Mask<S> {
        let (point, weight) = load(simd, points, lane_group);
        let n = Triple(lane_group_of(simd, &self.normal, lane_group));
        let zero = F32s::splat(simd, 0.0);
        let lambda_normal = self.lambda_normal.lane_group(simd, lane_group);
        let depth = n.dot(point) - self.level.lane_group(simd, lane_group);
        (depth.less_than(zero) | zero.less_than(lambda_normal)) & zero.less_than(weight)
    }

    /// [`ContactConstraint::end_substep`] for all lanes.
    #[inline(always)]
    pub fn end_substep(
        &mut self,
        points: &[Point; LANES],
        starts: &[Point; LANES],
        step: &ContactStep,
    ) {
        if self.lambda_normal.0.iter().all(|&lambda| lambda == 0.0) {
            self.slip = [Row::splat(0.0); 3];
            return;
        }
        for lane in 0..LANES {
            let (point, start) = (points[lane], starts[lane]);
            let moved =
                [0, 1, 2].map(|k| point[k] - start[k] - self.surface_displacement[k].0[lane]);
            let n = [0, 1, 2].map(|k| self.normal[k].0[lane]);
            let slip = [0, 1, 2].map(|k| self.slip[k].0[lane] + moved[k]);
            let along = n[0] * slip[0] + n[1] * slip[1] + n[2] * slip[2];
            let slip = [0, 1, 2].map(|k| slip[k] - n[k] * along);
            let length = (slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2]).sqrt();
            let compliance =
                step.tangential(TANGENTIAL_SOFTNESS * self.compliance.0[lane], point[3]);
            let limit = compliance * self.friction.0[lane] * self.lambda_normal.0[lane];
            let share = if length > limit { limit / length } else { 1.0 };
            for k in 0..3 {
                self.slip[k].0[lane] = slip[k] * share;
            }
        }
    }

    /// Whether the surface has to be queried again for one of the points of a lane group.
    #[inline(always)]
    pub fn is_stale<S: Simd>(&self, simd: S, points: &[Point; LANES], lane_group: usize) -> bool {
        let (point, _) = load(simd, points, lane_group);
        let d = point - Triple(lane_group_of(simd, &self.queried_at, lane_group));
        let beyond = d.dot(d) - self.radius2.lane_group(simd, lane_group);
        beyond.reduce_max() > 0.0
    }

    /// Queries the surfaces again for the lanes of a range whose planes are stale.
    #[inline(never)]
    pub fn query_surfaces(
        &mut self,
        solid: &Solid,
        points: &[Point; LANES],
        lanes: std::ops::Range<usize>,
    ) {
        let mut carried = self.carried.take();
        if carried.is_none() && solid.moving.surface(self.solid).is_some() {
            carried = Some(Box::default());
        }
        for lane in lanes {
            let [x, y, z, _] = points[lane];
            let mut contact = self.get(lane);
            if contact.is_stale([x, y, z]) {
                let plane = carried.as_mut().map(|carried| &mut carried[lane]);
                contact.query_surface(solid, [x, y, z], plane);
                self.set(lane, &contact);
            }
        }
        self.carried = carried;
    }
}

/// [`ContactConstraint::solve`] for one lane group of a block; moves the points. The two compute the same and are
/// edited together.
#[inline(always)]
pub fn solve_block<S: Simd>(
    simd: S,
    contact: &mut ContactBlock,
    points: &mut [Point; LANES],
    starts: &[Point; LANES],
    step: &ContactStep,
    lane_group: usize,
) {
    let (point, weight) = load(simd, points, lane_group);
    let (start, _) = load(simd, starts, lane_group);
    let n = Triple(lane_group_of(simd, &contact.normal, lane_group));
    let zero = F32s::splat(simd, 0.0);
    let lambda_normal = contact.lambda_normal.lane_group(simd, lane_group);
    let depth = n.dot(point) - contact.level.lane_group(simd, lane_group);
    let active = contact.touches(simd, points, lane_group);
    if !active.any() {
        return;
    }
    let surface_displacement = lane_group_of(simd, &contact.surface_displacement, lane_group);
    let moved = (point - start) - Triple(surface_displacement);
    let compliance = contact.compliance.lane_group(simd, lane_group) * step.kappa;
    let per_weight = 1.0 / weight;
    let violation = compliance.mul_add(lambda_normal, depth);
    let change = (zero - violation) / (weight + compliance);
    let limit = (step.outward - n.dot(moved)).max(zero) * per_weight;
    let change = change.min(limit).max(zero - lambda_normal);
    let change = active.select(change, zero);
    let lambda_normal = lambda_normal + change;
    contact
        .lambda_normal
        .set_lane_group(lane_group, lambda_normal);
    let slip = Triple(lane_group_of(simd, &contact.slip, lane_group)) + moved;
    let slip = slip.add_scaled(n, zero - n.dot(slip));
    let lambda_tangent = Triple(lane_group_of(simd, &contact.lambda_tangent, lane_group));
    let compliance = (compliance * TANGENTIAL_SOFTNESS).min(weight);
    let violation = slip.add_scaled(lambda_tangent, compliance);
    let free = lambda_tangent.add_scaled(violation, -1.0 / (weight + compliance));
    let length = free.norm();
    let limit = contact.friction.lane_group(simd, lane_group) * lambda_normal;
    let share = limit
        .less_than(length)
        .select(limit / length, F32s::splat(simd, 1.0));
    let new = active.select_triple(free * share, lambda_tangent);
    set_lane_group_of(&mut contact.lambda_tangent, lane_group, new);
    let total = (new - lambda_tangent).add_scaled(n, change);
    let point = point.add_scaled(total, weight);
    store(points, lane_group, (point, weight));
}
