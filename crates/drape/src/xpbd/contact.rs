//! Contact and friction as constraints on single points of the cloth, and elastics.
//!
//! A contact is the inequality C = n . sum a_i x_i - d >= 0 with compliance 1/k. Friction is
//! position based (Müller et al. 2020, section 3.5): the tangential displacement since the substep
//! began is taken back by an impulse of at most mu times the normal one, so a point that sticks does
//! not creep. Contacts of cloth with cloth are stencils of the same form with other weights.

use crate::lanes::{LANES, Point, Row, add_scaled, dot, load, store, sub};
use crate::laws::elastic::ElasticLaw;
use crate::{ContactSample, Pose, System};
use pulp::Simd;
use toile_geometry::Vec3;

/// A plane that a point may not cross.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Touch {
    /// Outward unit normal; zero while nothing is near.
    pub normal: [f32; 3],
    /// d [m].
    pub level: f32,
    /// Where the surface was looked at [m].
    pub place: [f32; 3],
    /// Square of how far from there the plane still holds [m2]; negative: look again.
    pub radius2: f32,
    /// 1 / k [m/N].
    pub softness: f32,
    /// Friction coefficient.
    pub friction: f32,
    /// Distance kept from the surface [m].
    pub offset: f32,
    /// The sample of the model, or [`NO_SAMPLE`].
    pub sample: u32,
    /// Normal impulse of the substep over its square [N s2].
    pub push: f32,
    /// Tangential impulse likewise.
    pub rub: [f32; 3],
    /// How far the surface moves there in the substep [m].
    pub drift: [f32; 3],
}

/// No sample of the model stands behind a touch.
pub const NO_SAMPLE: u32 = u32::MAX;

/// Fastest that a contact throws cloth out that it found inside a surface [m/s].
const OUTWARD_SPEED: f32 = 1.0;

/// How far a plane holds at the least, as a share of the offset: after two millimetres on a limb of
/// 30 mm radius the surface has left it by 0.07 mm.
const PLANE_REACH: f64 = 0.5;

/// Planes are kept from this many offsets away.
const REACH_IN_OFFSETS: f64 = 2.0;

/// Below this slope of the distance a point lies on a ridge: no direction leads out.
const FLAT_SLOPE: f64 = 0.05;

impl Touch {
    /// That of a sample, still to be looked up.
    pub fn of_sample(system: &System, (number, found): (usize, &ContactSample)) -> Self {
        let friction = if system.contact.friction {
            found.friction
        } else {
            0.0
        };
        Self {
            softness: (1.0 / (system.contact.stiffness * found.area)).min(1e30) as f32,
            friction: friction as f32,
            offset: (system.contact.offset + found.extra_offset) as f32,
            sample: number as u32,
            ..Self::none()
        }
    }

    /// One that touches nothing.
    pub fn none() -> Self {
        Self {
            normal: [0.0; 3],
            level: -1.0,
            place: [0.0; 3],
            radius2: f32::INFINITY,
            softness: 1.0,
            friction: 0.0,
            offset: 0.0,
            sample: NO_SAMPLE,
            push: 0.0,
            rub: [0.0; 3],
            drift: [0.0; 3],
        }
    }

    /// Forgets what was looked up.
    pub fn forget(&mut self) {
        if self.sample != NO_SAMPLE {
            self.radius2 = -1.0;
        }
    }

    /// What a substep in which surfaces move by up to `travel` [m] leaves of a look: nothing near them.
    pub fn age(&mut self, travel: f32) {
        if self.sample != NO_SAMPLE {
            self.radius2 = aged(self.radius2, travel, self.normal != [0.0; 3]);
        }
    }

    /// Whether the surface has to be looked at again for a point.
    #[inline(always)]
    pub fn is_stale(&self, point: [f32; 3]) -> bool {
        let d = [0, 1, 2].map(|k| point[k] - self.place[k]);
        let distance2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        // Not `>=`: a place that is no number must not be looked up.
        distance2 > self.radius2
    }

    /// Looks at the surfaces from a point.
    #[inline(never)]
    pub fn look(&mut self, solid: &Solid, point: [f32; 3]) {
        let origin = solid.origin;
        let place = origin + Vec3::from(point.map(f64::from));
        let offset = f64::from(self.offset);
        let reach = crate::contact_settings::FIELD_REACH;
        let mut nearest: Option<(f64, Vec3)> = None;
        let mut drift = Vec3::zeros();
        let policies = &solid.system.policies;
        let sample = solid.samples.get(self.sample as usize);
        let object = sample.and_then(|sample| policies.object_of_sample(&sample.vertices));
        for (k, collider) in solid.system.colliders.iter().enumerate() {
            if policies.ignores_solid(object, k) {
                continue;
            }
            let poses = solid.poses.get(k).and_then(Option::as_ref);
            if let Some(found) = collider.distance(poses.map(|[_, to]| to), place)
                && nearest.is_none_or(|(distance, _)| found.0 < distance)
            {
                nearest = Some(found);
                drift = poses.map_or(Vec3::zeros(), |[from, to]| {
                    let own = to.undo(place);
                    to.apply(own) - from.apply(own)
                });
            }
        }
        self.drift = [drift.x as f32, drift.y as f32, drift.z as f32];
        self.place = point;
        self.normal = [0.0; 3];
        self.level = -1.0;
        let (distance, slope) = nearest.unwrap_or((reach, Vec3::zeros()));
        // The smooth distance may exceed the exact one by a fraction of a millimetre.
        let gap = 0.9 * distance - offset;
        let radius = (0.5 * gap).max(PLANE_REACH * offset).max(1e-5);
        self.radius2 = (radius * radius) as f32;
        if distance > REACH_IN_OFFSETS * offset && gap > 0.0 {
            // Nothing can touch before the whole gap is crossed.
            self.radius2 = (gap * gap) as f32;
            return;
        }
        if slope.norm() < FLAT_SLOPE {
            return;
        }
        let n = slope.normalize();
        self.normal = [n.x as f32, n.y as f32, n.z as f32];
        let here = Vec3::from(point.map(f64::from));
        self.level = (n.dot(&here) + offset - distance) as f32;
    }

    /// What the touch moves a point by whose inverse mass is `weight`, the point being at `point`
    /// now and at `start` when the substep began: dx = weight times the result.
    #[inline(always)]
    pub fn respond(
        &mut self,
        weight: f32,
        point: [f32; 3],
        start: [f32; 3],
        step: &ContactStep,
    ) -> [f32; 3] {
        let n = self.normal;
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let depth = dot(n, point) - self.level;
        if (depth >= 0.0 && self.push == 0.0) || weight <= 0.0 {
            return [0.0; 3];
        }
        let moved = [0, 1, 2].map(|k| point[k] - start[k] - self.drift[k]);
        let soft = self.softness * step.kappa;
        let mut change = -(depth + soft * self.push) / (weight + soft);
        let outward = dot(n, moved);
        let most = (step.outward - outward).max(0.0) / weight;
        change = change.min(most).max(-self.push);
        self.push += change;
        let slip = [0, 1, 2].map(|k| moved[k] - n[k] * outward);
        let wanted = [0, 1, 2].map(|k| self.rub[k] - slip[k] / weight);
        let length = dot(wanted, wanted).sqrt();
        let limit = self.friction * self.push;
        let share = if length > limit { limit / length } else { 1.0 };
        let mut out = [0.0; 3];
        for k in 0..3 {
            let rub = wanted[k] * share;
            out[k] = n[k] * change + rub - self.rub[k];
            self.rub[k] = rub;
        }
        out
    }
}

/// Square of how far a look still holds [m2] after surfaces moved.
fn aged(radius2: f32, travel: f32, near: bool) -> f32 {
    let left = radius2.max(0.0).sqrt() - travel;
    if near || left <= 0.0 {
        -1.0
    } else {
        left * left
    }
}

/// The solid surfaces as they stand in a substep.
#[derive(Clone, Copy)]
pub struct Solid<'a> {
    /// The model.
    pub system: &'a System,
    /// The samples of the state.
    pub samples: &'a [ContactSample],
    /// What the points' numbers are relative to [m].
    pub origin: Vec3,
    /// Where each collider that moves stands when the substep begins and when it ends; empty where
    /// none moves.
    pub poses: &'a [Option<[Pose; 2]>],
}

impl Solid<'_> {
    /// Whether there are any.
    pub fn stands(&self) -> bool {
        !self.system.colliders.is_empty()
    }
}

/// Touches of sixteen vertices side by side; rows as in [`Touch`].
#[derive(Clone, Debug)]
pub struct TouchBlock {
    normal: [Row; 3],
    level: Row,
    place: [Row; 3],
    radius2: Row,
    softness: Row,
    friction: Row,
    offset: Row,
    push: Row,
    rub: [Row; 3],
    drift: [Row; 3],
    sample: [u32; LANES],
}

impl TouchBlock {
    /// One that touches nothing.
    pub fn none() -> Self {
        let zero = Row::splat(0.0);
        let mut block = Self {
            normal: [zero; 3],
            level: zero,
            place: [zero; 3],
            radius2: zero,
            softness: zero,
            friction: zero,
            offset: zero,
            push: zero,
            rub: [zero; 3],
            drift: [zero; 3],
            sample: [NO_SAMPLE; LANES],
        };
        for lane in 0..LANES {
            block.set(lane, &Touch::none());
        }
        block
    }

    /// The touch of a lane.
    pub fn get(&self, lane: usize) -> Touch {
        let three = |rows: &[Row; 3]| rows.map(|row| row.0[lane]);
        Touch {
            normal: three(&self.normal),
            level: self.level.0[lane],
            place: three(&self.place),
            radius2: self.radius2.0[lane],
            softness: self.softness.0[lane],
            friction: self.friction.0[lane],
            offset: self.offset.0[lane],
            sample: self.sample[lane],
            push: self.push.0[lane],
            rub: three(&self.rub),
            drift: three(&self.drift),
        }
    }

    /// Lanes that were pressed.
    pub fn pressed(&self) -> impl Iterator<Item = usize> + '_ {
        (0..LANES).filter(|&lane| self.push.0[lane] > 0.0)
    }

    /// Sets the touch of a lane.
    pub fn set(&mut self, lane: usize, touch: &Touch) {
        for k in 0..3 {
            self.normal[k].0[lane] = touch.normal[k];
            self.place[k].0[lane] = touch.place[k];
            self.rub[k].0[lane] = touch.rub[k];
            self.drift[k].0[lane] = touch.drift[k];
        }
        self.level.0[lane] = touch.level;
        self.radius2.0[lane] = touch.radius2;
        self.softness.0[lane] = touch.softness;
        self.friction.0[lane] = touch.friction;
        self.offset.0[lane] = touch.offset;
        self.sample[lane] = touch.sample;
        self.push.0[lane] = touch.push;
    }

    /// Forgets what was looked up.
    pub fn forget(&mut self) {
        for (radius2, &sample) in self.radius2.0.iter_mut().zip(&self.sample) {
            if sample != NO_SAMPLE {
                *radius2 = -1.0;
            }
        }
    }

    /// [`Touch::age`] for all lanes.
    pub fn age(&mut self, travel: f32) {
        for lane in 0..LANES {
            if self.sample[lane] != NO_SAMPLE {
                let near = self.normal.iter().any(|row| row.0[lane] != 0.0);
                self.radius2.0[lane] = aged(self.radius2.0[lane], travel, near);
            }
        }
    }

    /// Impulses start from zero.
    pub fn clear(&mut self) {
        self.push = Row::splat(0.0);
        self.rub = [Row::splat(0.0); 3];
    }

    /// Whether the surface has to be looked at again for one of the points of a part.
    #[inline(always)]
    pub fn is_stale<S: Simd>(&self, simd: S, points: &[Point; LANES], part: usize) -> bool {
        let [x, y, z, _] = load(simd, points, part);
        let place = [
            self.place[0].part::<S>(part),
            self.place[1].part::<S>(part),
            self.place[2].part::<S>(part),
        ];
        let d = sub(simd, [x, y, z], place);
        let beyond = simd.sub_f32s(dot(simd, d, d), self.radius2.part::<S>(part));
        simd.reduce_max_f32s(beyond) > 0.0
    }

    /// Looks at the surfaces from those of some lanes that have to.
    #[inline(never)]
    pub fn look(&mut self, solid: &Solid, points: &[Point; LANES], lanes: std::ops::Range<usize>) {
        for lane in lanes {
            let [x, y, z, _] = points[lane];
            let mut touch = self.get(lane);
            if touch.is_stale([x, y, z]) {
                touch.look(solid, [x, y, z]);
                self.set(lane, &touch);
            }
        }
    }
}

/// [`Touch::respond`] for one part of a block; moves the points.
#[inline(always)]
pub fn press<S: Simd>(
    simd: S,
    touch: &mut TouchBlock,
    points: &mut [Point; LANES],
    starts: &[Point; LANES],
    step: &ContactStep,
    part: usize,
) {
    let [x, y, z, weight] = load(simd, points, part);
    let [x0, y0, z0, _] = load(simd, starts, part);
    let n = [
        touch.normal[0].part::<S>(part),
        touch.normal[1].part::<S>(part),
        touch.normal[2].part::<S>(part),
    ];
    let zero = simd.splat_f32s(0.0);
    let push = touch.push.part::<S>(part);
    let depth = simd.sub_f32s(dot(simd, n, [x, y, z]), touch.level.part::<S>(part));
    let touching = simd.or_m32s(
        simd.less_than_f32s(depth, zero),
        simd.less_than_f32s(zero, push),
    );
    let active = simd.and_m32s(touching, simd.less_than_f32s(zero, weight));
    let flag = simd.select_f32s(active, simd.splat_f32s(1.0), zero);
    if simd.reduce_max_f32s(flag) == 0.0 {
        return;
    }
    let drift = [
        touch.drift[0].part::<S>(part),
        touch.drift[1].part::<S>(part),
        touch.drift[2].part::<S>(part),
    ];
    let moved = sub(simd, sub(simd, [x, y, z], [x0, y0, z0]), drift);
    let soft = simd.mul_f32s(touch.softness.part::<S>(part), simd.splat_f32s(step.kappa));
    let per_weight = simd.div_f32s(simd.splat_f32s(1.0), weight);
    let wanted = simd.mul_add_e_f32s(soft, push, depth);
    let change = simd.div_f32s(simd.sub_f32s(zero, wanted), simd.add_f32s(weight, soft));
    let outward = dot(simd, n, moved);
    let most = simd.sub_f32s(simd.splat_f32s(step.outward), outward);
    let most = simd.mul_f32s(simd.max_f32s(most, zero), per_weight);
    let change = simd.max_f32s(simd.min_f32s(change, most), simd.sub_f32s(zero, push));
    let change = simd.select_f32s(active, change, zero);
    let push = simd.add_f32s(push, change);
    touch.push.set_part::<S>(part, push);
    let slip = add_scaled(simd, moved, n, simd.sub_f32s(zero, outward));
    let rub = [
        touch.rub[0].part::<S>(part),
        touch.rub[1].part::<S>(part),
        touch.rub[2].part::<S>(part),
    ];
    let wanted = add_scaled(simd, rub, slip, simd.sub_f32s(zero, per_weight));
    let length = simd.sqrt_f32s(dot(simd, wanted, wanted));
    let limit = simd.mul_f32s(touch.friction.part::<S>(part), push);
    let share = simd.select_f32s(
        simd.less_than_f32s(limit, length),
        simd.div_f32s(limit, length),
        simd.splat_f32s(1.0),
    );
    let mut out = [x, y, z];
    for k in 0..3 {
        let new = simd.mul_f32s(wanted[k], share);
        let new = simd.select_f32s(active, new, rub[k]);
        touch.rub[k].set_part::<S>(part, new);
        let total = simd.mul_add_e_f32s(n[k], change, simd.sub_f32s(new, rub[k]));
        out[k] = simd.mul_add_e_f32s(weight, total, out[k]);
    }
    store(simd, points, part, [out[0], out[1], out[2], weight]);
}

/// The numbers of a substep that contacts need.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep {
    /// (1 + drag h) / h^2 [1/s2].
    pub kappa: f32,
    /// Farthest that a contact throws cloth out in the substep [m].
    pub outward: f32,
}

impl ContactStep {
    /// For a substep [s].
    pub fn new(kappa: f32, step: f32) -> Self {
        Self {
            kappa,
            outward: OUTWARD_SPEED * step,
        }
    }
}

/// A contact of a point that hangs on up to four vertices: a sample within a triangle, and what
/// collision of cloth with cloth finds (a vertex and a face, or two edges, with weights that sum
/// to zero).
#[derive(Clone, Copy, Debug)]
pub struct ContactStencil {
    /// The vertices, as indices into the points of the region.
    pub vertices: [u32; 4],
    /// Their weights.
    pub weights: [f32; 4],
    /// The plane.
    pub touch: Touch,
    /// Share of the speed of an impact that comes back, where no sample of the model says it.
    pub restitution: Option<f32>,
}

impl ContactStencil {
    /// The point.
    #[inline(always)]
    pub fn point(&self, points: &[Point]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for (&v, weight) in self.vertices.iter().zip(self.weights) {
            for k in 0..3 {
                sum[k] += weight * points[v as usize][k];
            }
        }
        sum
    }
}

/// Solves contact stencils in order, `points` being where vertices are and `starts` where they were
/// when the substep began.
pub fn solve_stencils(
    stencils: &mut [ContactStencil],
    points: &mut [Point],
    starts: &[Point],
    step: &ContactStep,
) {
    for stencil in stencils {
        let weight: f32 = (stencil.vertices.iter().zip(stencil.weights))
            .map(|(&v, a)| a * a * points[v as usize][3])
            .sum();
        let (point, start) = (stencil.point(points), stencil.point(starts));
        let change = stencil.touch.respond(weight, point, start, step);
        for (&v, a) in stencil.vertices.iter().zip(stencil.weights) {
            let point = &mut points[v as usize];
            let share = a * point[3];
            for k in 0..3 {
                point[k] += share * change[k];
            }
        }
    }
}

/// An elastic as a constraint: the gap of its ends, three rows at once, with compliance 1/k and a
/// largest force.
#[derive(Clone, Copy, Debug)]
pub struct Tie {
    /// The vertex it pulls, as an index into the points of the region.
    from: u32,
    /// Where its other end is.
    pub to: TieEnd,
    /// Stiffness [N/m].
    stiffness: f32,
    /// Largest force [N].
    most: f32,
    /// Impulse of the substep over its square [N s2].
    pub sum: [f32; 3],
}

/// Where the other end of an elastic is.
#[derive(Clone, Copy, Debug)]
pub enum TieEnd {
    /// A vertex, as an index into the points of the region.
    Point(u32),
    /// A place [m].
    Place([f32; 3]),
}

impl Tie {
    /// An elastic with its law.
    pub fn new(from: u32, to: TieEnd, law: &ElasticLaw) -> Self {
        Self {
            from,
            to,
            stiffness: law.stiffness as f32,
            most: law.largest_force.min(1e30) as f32,
            sum: [0.0; 3],
        }
    }
}

/// Solves elastics in order.
pub fn solve_ties(ties: &mut [Tie], points: &mut [Point], kappa: f32) {
    for tie in ties {
        let a = points[tie.from as usize];
        let b = match tie.to {
            TieEnd::Point(to) => points[to as usize],
            TieEnd::Place([x, y, z]) => [x, y, z, 0.0],
        };
        let soft = kappa / tie.stiffness;
        let weight = a[3] + b[3] + soft;
        let wanted = [0, 1, 2].map(|k| tie.sum[k] - (a[k] - b[k] + soft * tie.sum[k]) / weight);
        let length = (wanted[0] * wanted[0] + wanted[1] * wanted[1] + wanted[2] * wanted[2]).sqrt();
        let most = tie.most / kappa;
        let share = if length > most { most / length } else { 1.0 };
        for k in 0..3 {
            let sum = wanted[k] * share;
            let change = sum - tie.sum[k];
            tie.sum[k] = sum;
            points[tie.from as usize][k] += a[3] * change;
            if let TieEnd::Point(to) = tie.to {
                points[to as usize][k] -= b[3] * change;
            }
        }
    }
}
