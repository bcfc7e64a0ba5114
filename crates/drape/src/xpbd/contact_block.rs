//! Contacts of sixteen vertices with a solid, solved side by side in vector registers.

use super::carried_plane::CarriedPlane;
use super::contact::{ContactConstraint, ContactStep, NO_SAMPLE, Solid, TANGENTIAL_SOFTNESS};
use crate::State;
use crate::lanes::{LANES, Point, Row, add_scaled, dot, load, store, sub};
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
    pub fn touches<S: Simd>(&self, simd: S, points: &[Point; LANES], lane_group: usize) -> S::m32s {
        let [x, y, z, weight] = load(simd, points, lane_group);
        let n = [
            self.normal[0].lane_group::<S>(lane_group),
            self.normal[1].lane_group::<S>(lane_group),
            self.normal[2].lane_group::<S>(lane_group),
        ];
        let zero = simd.splat_f32s(0.0);
        let lambda_normal = self.lambda_normal.lane_group::<S>(lane_group);
        let level = self.level.lane_group::<S>(lane_group);
        let depth = simd.sub_f32s(dot(simd, n, [x, y, z]), level);
        let touching = simd.or_m32s(
            simd.less_than_f32s(depth, zero),
            simd.less_than_f32s(zero, lambda_normal),
        );
        simd.and_m32s(touching, simd.less_than_f32s(zero, weight))
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
        let [x, y, z, _] = load(simd, points, lane_group);
        let queried_at = [
            self.queried_at[0].lane_group::<S>(lane_group),
            self.queried_at[1].lane_group::<S>(lane_group),
            self.queried_at[2].lane_group::<S>(lane_group),
        ];
        let d = sub(simd, [x, y, z], queried_at);
        let beyond = simd.sub_f32s(dot(simd, d, d), self.radius2.lane_group::<S>(lane_group));
        simd.reduce_max_f32s(beyond) > 0.0
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
    let [x, y, z, weight] = load(simd, points, lane_group);
    let [x0, y0, z0, _] = load(simd, starts, lane_group);
    let n = [
        contact.normal[0].lane_group::<S>(lane_group),
        contact.normal[1].lane_group::<S>(lane_group),
        contact.normal[2].lane_group::<S>(lane_group),
    ];
    let zero = simd.splat_f32s(0.0);
    let lambda_normal = contact.lambda_normal.lane_group::<S>(lane_group);
    let depth = simd.sub_f32s(
        dot(simd, n, [x, y, z]),
        contact.level.lane_group::<S>(lane_group),
    );
    let active = contact.touches(simd, points, lane_group);
    let flag = simd.select_f32s(active, simd.splat_f32s(1.0), zero);
    if simd.reduce_max_f32s(flag) == 0.0 {
        return;
    }
    let surface_displacement = [
        contact.surface_displacement[0].lane_group::<S>(lane_group),
        contact.surface_displacement[1].lane_group::<S>(lane_group),
        contact.surface_displacement[2].lane_group::<S>(lane_group),
    ];
    let moved = sub(
        simd,
        sub(simd, [x, y, z], [x0, y0, z0]),
        surface_displacement,
    );
    let compliance = simd.mul_f32s(
        contact.compliance.lane_group::<S>(lane_group),
        simd.splat_f32s(step.kappa),
    );
    let per_weight = simd.div_f32s(simd.splat_f32s(1.0), weight);
    let violation = simd.mul_add_e_f32s(compliance, lambda_normal, depth);
    let change = simd.div_f32s(
        simd.sub_f32s(zero, violation),
        simd.add_f32s(weight, compliance),
    );
    let outward = dot(simd, n, moved);
    let limit = simd.sub_f32s(simd.splat_f32s(step.outward), outward);
    let limit = simd.mul_f32s(simd.max_f32s(limit, zero), per_weight);
    let change = simd.max_f32s(
        simd.min_f32s(change, limit),
        simd.sub_f32s(zero, lambda_normal),
    );
    let change = simd.select_f32s(active, change, zero);
    let lambda_normal = simd.add_f32s(lambda_normal, change);
    contact
        .lambda_normal
        .set_lane_group::<S>(lane_group, lambda_normal);
    let slip =
        [0, 1, 2].map(|k| simd.add_f32s(contact.slip[k].lane_group::<S>(lane_group), moved[k]));
    let along = dot(simd, n, slip);
    let slip = add_scaled(simd, slip, n, simd.sub_f32s(zero, along));
    let lambda_tangent = [
        contact.lambda_tangent[0].lane_group::<S>(lane_group),
        contact.lambda_tangent[1].lane_group::<S>(lane_group),
        contact.lambda_tangent[2].lane_group::<S>(lane_group),
    ];
    let compliance = simd.mul_f32s(compliance, simd.splat_f32s(TANGENTIAL_SOFTNESS));
    let compliance = simd.min_f32s(compliance, weight);
    let violation = add_scaled(simd, slip, lambda_tangent, compliance);
    let softness = simd.add_f32s(weight, compliance);
    let per_softness = simd.div_f32s(simd.splat_f32s(-1.0), softness);
    let free = add_scaled(simd, lambda_tangent, violation, per_softness);
    let length = simd.sqrt_f32s(dot(simd, free, free));
    let limit = simd.mul_f32s(contact.friction.lane_group::<S>(lane_group), lambda_normal);
    let share = simd.select_f32s(
        simd.less_than_f32s(limit, length),
        simd.div_f32s(limit, length),
        simd.splat_f32s(1.0),
    );
    let mut out = [x, y, z];
    for k in 0..3 {
        let new = simd.mul_f32s(free[k], share);
        let new = simd.select_f32s(active, new, lambda_tangent[k]);
        contact.lambda_tangent[k].set_lane_group::<S>(lane_group, new);
        let total = simd.mul_add_e_f32s(n[k], change, simd.sub_f32s(new, lambda_tangent[k]));
        out[k] = simd.mul_add_e_f32s(weight, total, out[k]);
    }
    store(simd, points, lane_group, [out[0], out[1], out[2], weight]);
}
