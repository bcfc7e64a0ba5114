//! Contact and friction as constraints on single points of the cloth.
//!
//! A contact is the inequality C = n . sum a_i x_i - d >= 0 with compliance 1/k. Friction is the constraint that the
//! displacement along the surface since the point stuck, its slip, is zero, with the compliance of the law's
//! tangential spring and a multiplier of at most mu times the normal one. Where the multiplier is at that limit the
//! slip follows (return mapping, Wriggers 2006, section 5.2). The slip lasts from substep to substep, so that a sticking
//! point does not creep, whatever moves it between its constraint and the end of the substep. Contacts of cloth with
//! cloth are stencils of the same form with other weights.

use super::carried_plane::{CarriedMotion, CarriedPlane, kept_offset};
use super::moving_solids::MovingSolids;
use crate::lanes::Point;
use crate::laws::contact::{HARDER, TANGENTIAL_RATIO};
use crate::{ContactSample, SolidFriction, State, System};
use toile_geometry::{MovingSurface, Vec3};

/// The contact of a point with the tangent plane of a surface, and its multipliers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct ContactConstraint {
    /// Outward unit normal; zero while the surface is not near.
    pub normal: [f32; 3],
    /// The plane n . x = d of the offset surface: d (m).
    pub level: f32,
    /// Position of the point at the last query of the surface (m).
    pub queried_at: [f32; 3],
    /// Square of the distance from there within which the plane is still valid (m2); negative: query again.
    pub radius2: f32,
    /// 1 / k (m/N).
    pub compliance: f32,
    /// Compliance of the spring that holds a sticking point (m/N).
    pub tangential_compliance: f32,
    /// Depth from which the normal stiffness is [`HARDER`] times larger (m).
    pub hard_from: f32,
    /// Friction coefficient.
    pub friction: f32,
    /// Distance between cloth and surface at rest (m).
    pub offset: f32,
    /// The sample of the model, or [`NO_SAMPLE`].
    pub sample: u32,
    /// The solid, where there is a sample.
    pub solid: u32,
    /// XPBD multiplier of the normal constraint over the substep: force times h^2 (N s2).
    pub lambda_normal: f32,
    /// Multiplier of friction in the plane over the substep (N s2), at most `friction` times the normal one.
    pub lambda_tangent: [f32; 3],
    /// Displacement along the surface since the point stuck, at the start of the substep (m).
    pub slip: [f32; 3],
    /// Displacement of the surface at the point in the substep (m).
    pub surface_displacement: [f32; 3],
}

/// In place of a sample's number: the contact does not belong to a sample of the model.
pub const NO_SAMPLE: u32 = u32::MAX;

/// Ratio of the tangential to the normal compliance of contact with solids.
pub const TANGENTIAL_SOFTNESS: f32 = (1.0 / TANGENTIAL_RATIO) as f32;

/// How many times stiffer contact is with a solid that moves. Tight cloth of 200 N/m over a bent knee of 40 mm presses with
/// 5 kPa, more than the stiffness of contact at rest bears within the offset.
const MOVING_STIFFNESS: f32 = 10.0;

/// Largest speed at which a contact moves cloth out of a solid (m/s).
const MAX_OUTWARD_SPEED: f32 = 1.0;

/// Least distance within which a plane is valid, over the offset: two millimetres along a limb of 30 mm radius
/// the surface is 0.07 mm off the plane.
const PLANE_REACH: f64 = 0.5;

/// A plane is set where the surface is nearer than this many offsets.
const REACH_IN_OFFSETS: f64 = 2.0;

/// Least norm of the distance gradient: below it the point lies between two sides of a solid and the gradient is no
/// outward normal.
const FLAT_SLOPE: f64 = 0.05;

/// The compliance of a spring of a stiffness (N/m) in single precision, finite without stiffness (m/N).
pub fn compliance_of(stiffness: f64) -> f32 {
    (1.0 / stiffness).min(1e30) as f32
}

impl ContactConstraint {
    /// The contact of a sample with a solid, to be queried before its first use; with no surface where the two ignore
    /// each other.
    pub fn of_sample(
        system: &System,
        (number, found): (usize, &ContactSample),
        solid: usize,
    ) -> Self {
        let object = system.policies.object_of_sample(&found.vertices);
        if system.policies.ignores_solid(object, solid) {
            return Self::none();
        }
        let law = system.contact.law(found.area, found.friction);
        let soft = compliance_of(law.normal);
        let compliance = match system.colliders[solid].is_moving() {
            true => soft / MOVING_STIFFNESS,
            false => soft,
        };
        Self {
            compliance,
            tangential_compliance: TANGENTIAL_SOFTNESS * soft,
            friction: law.friction as f32,
            offset: (system.contact.offset + found.extra_offset) as f32,
            sample: number as u32,
            solid: solid as u32,
            ..Self::none()
        }
    }

    /// A contact with no surface, never queried.
    pub fn none() -> Self {
        Self {
            normal: [0.0; 3],
            level: -1.0,
            queried_at: [0.0; 3],
            radius2: f32::INFINITY,
            compliance: 1.0,
            tangential_compliance: 1.0,
            hard_from: f32::INFINITY,
            friction: 0.0,
            offset: 0.0,
            sample: NO_SAMPLE,
            solid: 0,
            lambda_normal: 0.0,
            lambda_tangent: [0.0; 3],
            slip: [0.0; 3],
            surface_displacement: [0.0; 3],
        }
    }

    /// Marks the plane as invalid: the surface is queried again before the next use.
    pub fn invalidate(&mut self) {
        if self.sample != NO_SAMPLE {
            self.radius2 = -1.0;
        }
    }

    /// Moves the plane of a near surface that moves to the end of the coming substep, and turns the slip with it. The
    /// distance to a far one is valid for the whole step; an invalid plane is found anew before its next use.
    pub fn carry(&mut self, solid: &Solid, carried: &CarriedPlane) {
        if self.normal == [0.0; 3] || self.radius2 < 0.0 {
            return;
        }
        if solid.moving.surface(self.solid).is_none() {
            return;
        }
        let motion = carried.at(solid.shares);
        self.set_plane(&motion, solid.origin);
        for k in 0..3 {
            self.queried_at[k] += self.surface_displacement[k];
        }
        if self.slip != [0.0; 3] {
            let slip = Vec3::from(self.slip.map(f64::from));
            let slip = slip + motion.turn.cross(&slip);
            self.slip = [slip.x as f32, slip.y as f32, slip.z as f32];
        }
    }

    /// Sets the plane to that of a moving surface, and the displacement of the surface in the substep.
    fn set_plane(&mut self, motion: &CarriedMotion, origin: Vec3) {
        let (n, moved) = (motion.normal, motion.displacement);
        self.normal = [n.x as f32, n.y as f32, n.z as f32];
        self.level = (n.dot(&(motion.point - origin)) + motion.offset) as f32;
        self.surface_displacement = [moved.x as f32, moved.y as f32, moved.z as f32];
    }

    /// Whether the surface has to be queried again for a point.
    #[inline(always)]
    pub fn is_stale(&self, point: [f32; 3]) -> bool {
        let d = [0, 1, 2].map(|k| point[k] - self.queried_at[k]);
        let distance2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        // The comparison is false for NaN, so that no surface is queried there.
        distance2 > self.radius2
    }

    /// Queries the surface at a point and sets its tangent plane.
    #[inline(never)]
    pub fn query_surface(
        &mut self,
        solid: &Solid,
        point: [f32; 3],
        carried: Option<&mut CarriedPlane>,
    ) {
        let position = solid.origin + Vec3::from(point.map(f64::from));
        self.queried_at = point;
        self.normal = [0.0; 3];
        self.level = -1.0;
        self.surface_displacement = [0.0; 3];
        if let (Some(surface), Some(carried)) = (solid.moving.surface(self.solid), carried) {
            return self.query_moving_surface(surface, solid, position, carried);
        }
        let offset = f64::from(self.offset);
        let reach = crate::contact_settings::FIELD_REACH;
        let collider = &solid.system.colliders[self.solid as usize];
        let found = collider.field.distance(position);
        let (distance, slope) = found.unwrap_or((reach, Vec3::zeros()));
        // The smooth distance may exceed the exact one by a fraction of a millimetre.
        let gap = 0.9 * distance - offset;
        let radius = (0.5 * gap).max(PLANE_REACH * offset).max(1e-5);
        self.radius2 = (radius * radius) as f32;
        if distance > REACH_IN_OFFSETS * offset && gap > 0.0 {
            // The point reaches the offset surface only after a displacement by the whole gap.
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

    /// Queries a moving surface at a position (m) and the end of the substep, exactly.
    fn query_moving_surface(
        &mut self,
        surface: &MovingSurface,
        solid: &Solid,
        position: Vec3,
        carried: &mut CarriedPlane,
    ) {
        let offset = f64::from(self.offset);
        let reach = crate::contact_settings::FIELD_REACH;
        let clearance = surface.clearance(position, reach);
        let gap = clearance - offset;
        if clearance > REACH_IN_OFFSETS * offset && gap > 0.0 {
            // The surface stays that far away until the step ends.
            self.radius2 = (gap * gap) as f32;
            return;
        }
        let [_, now] = solid.shares;
        let closest = surface.closest_point(position, now, f64::INFINITY, carried.known_triangle());
        let Some(closest) = closest else {
            self.radius2 = f32::INFINITY;
            return;
        };
        let thickness = solid.system.contact.cloth_offset;
        let kept = kept_offset(surface, (&closest, now), offset, thickness);
        *carried = CarriedPlane::new(surface, (&closest, now), kept.unwrap_or(0.0));
        if kept.is_some() {
            self.set_plane(&carried.at(solid.shares), solid.origin);
        }
        let gap = closest.signed_distance - offset;
        let mut radius = (0.5 * gap).max(PLANE_REACH * offset);
        if let Some(kept) = kept.filter(|&kept| kept < offset) {
            // Soon the other wall of the pinch is the nearer one.
            radius = PLANE_REACH * kept;
        }
        let radius = radius.max(1e-5);
        self.radius2 = (radius * radius) as f32;
    }

    /// Solves the contact for a point of inverse mass `weight` (1/kg) at `point`, whose position at the start of
    /// the substep was `start`. Returns the change of the multipliers; the caller moves the point by `weight` times
    /// it.
    #[inline(always)]
    pub fn solve(
        &mut self,
        weight: f32,
        point: [f32; 3],
        start: [f32; 3],
        step: &ContactStep,
    ) -> [f32; 3] {
        let n = self.normal;
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let depth = dot(n, point) - self.level;
        if (depth >= 0.0 && self.lambda_normal == 0.0) || weight <= 0.0 {
            return [0.0; 3];
        }
        let moved = [0, 1, 2].map(|k| point[k] - start[k] - self.surface_displacement[k]);
        let compliance = self.compliance * step.kappa;
        let mut change = -(depth + compliance * self.lambda_normal) / (weight + compliance);
        if -depth - weight * change > self.hard_from {
            // The stiffer part of the law: c lambda = (1 + H) d - H h at the depth d after the change.
            let free = weight * self.lambda_normal - depth;
            let harder = HARDER as f32;
            let sum = (1.0 + harder) * free - harder * self.hard_from;
            change = sum / (compliance + (1.0 + harder) * weight) - self.lambda_normal;
        }
        let outward = dot(n, moved);
        let limit = (step.outward - outward).max(0.0) / weight;
        change = change.min(limit).max(-self.lambda_normal);
        self.lambda_normal += change;
        let tangent = self.rub(weight, moved, step);
        [0, 1, 2].map(|k| n[k] * change + tangent[k])
    }

    /// Solves friction under the present normal multiplier; `moved` is the displacement relative to the surface since
    /// the start of the substep. Returns the change of the multiplier.
    #[inline(always)]
    pub fn rub(&mut self, weight: f32, moved: [f32; 3], step: &ContactStep) -> [f32; 3] {
        let slip = self.slip_after(moved);
        let compliance = step.tangential(self.tangential_compliance, weight);
        let free = [0, 1, 2].map(|k| {
            let old = self.lambda_tangent[k];
            old - (slip[k] + compliance * old) / (weight + compliance)
        });
        let length = (free[0] * free[0] + free[1] * free[1] + free[2] * free[2]).sqrt();
        let limit = self.friction * self.lambda_normal;
        let share = if length > limit { limit / length } else { 1.0 };
        let mut change = [0.0; 3];
        for k in 0..3 {
            let lambda_tangent = free[k] * share;
            change[k] = lambda_tangent - self.lambda_tangent[k];
            self.lambda_tangent[k] = lambda_tangent;
        }
        change
    }

    /// The slip in the plane after a displacement relative to the surface since the start of the substep.
    #[inline(always)]
    fn slip_after(&self, moved: [f32; 3]) -> [f32; 3] {
        let n = self.normal;
        let slip = [0, 1, 2].map(|k| self.slip[k] + moved[k]);
        let along = n[0] * slip[0] + n[1] * slip[1] + n[2] * slip[2];
        [0, 1, 2].map(|k| slip[k] - n[k] * along)
    }

    /// Ends a substep in which the point moved by `moved` relative to the surface: the slip becomes that at its end, at
    /// most the one at which the spring has the limit of friction, and zero where nothing presses.
    #[inline(always)]
    pub fn end_substep(&mut self, weight: f32, moved: [f32; 3], step: &ContactStep) {
        let slip = self.slip_after(moved);
        let length = (slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2]).sqrt();
        let compliance = step.tangential(self.tangential_compliance, weight);
        let limit = compliance * self.friction * self.lambda_normal;
        let share = if length > limit { limit / length } else { 1.0 };
        self.slip = slip.map(|x| x * share);
    }

    /// The slip at which the spring of the law, which every other method has, bears as much as this one (m).
    fn law_slip(&self, weight: f32, step: &ContactStep) -> Vec3 {
        Vec3::from(self.slip.map(f64::from)) * step.softness(self.tangential_compliance, weight)
    }

    /// Takes the slip of a sample, of inverse mass `weight` (1/kg), from a state.
    pub fn recall(&mut self, state: &State, weight: f32, step: &ContactStep) {
        self.slip = [0.0; 3];
        if self.sample == NO_SAMPLE {
            return;
        }
        let memory = SolidFriction::find(&state.solid_friction, self.sample, self.solid);
        if let Some(memory) = memory {
            let position = state.samples[self.sample as usize].position(&state.positions);
            let slip = position - memory.anchor;
            let slip = slip / step.softness(self.tangential_compliance, weight);
            self.slip = [slip.x as f32, slip.y as f32, slip.z as f32];
        }
    }

    /// The friction of a sample that presses, of inverse mass `weight` (1/kg), for a state after the last substep.
    pub fn remember(
        &self,
        state: &State,
        weight: f32,
        step: &ContactStep,
    ) -> Option<SolidFriction> {
        if self.sample == NO_SAMPLE || self.lambda_normal <= 0.0 {
            return None;
        }
        let position = state.samples[self.sample as usize].position(&state.positions);
        Some(SolidFriction {
            sample: self.sample,
            solid: self.solid,
            anchor: position - self.law_slip(weight, step),
            force: f64::from(step.kappa) * f64::from(self.lambda_normal),
        })
    }
}

/// The solids in a substep.
#[derive(Clone, Copy)]
pub struct Solid<'a> {
    /// The model.
    pub system: &'a System,
    /// Origin of the points' coordinates (m).
    pub origin: Vec3,
    /// The surfaces of those that move.
    pub moving: &'a MovingSolids,
    /// Start and end of the substep, as shares of the step that the surfaces are given for.
    pub shares: [f64; 2],
}

impl Solid<'_> {
    /// Whether there are any solids.
    pub fn has_surfaces(&self) -> bool {
        !self.system.colliders.is_empty()
    }
}

/// Parameters of a substep for contacts.
#[derive(Clone, Copy, Debug)]
pub struct ContactStep {
    /// (1 + drag h) / h^2 (1/s2).
    pub kappa: f32,
    /// Largest displacement out of a solid in the substep (m).
    pub outward: f32,
}

impl ContactStep {
    /// For a substep (s).
    pub fn new(kappa: f32, step: f32) -> Self {
        Self {
            kappa,
            outward: MAX_OUTWARD_SPEED * step,
        }
    }

    /// The compliance of the spring that holds a sticking point of inverse mass `weight` (1/kg), times kappa: the law's,
    /// and at most the inverse mass. A point on a softer spring would vibrate for many substeps, undamped, and slide
    /// under less than its friction, for a slip of that length is lost wherever the normal force falls for a moment.
    #[inline(always)]
    pub fn tangential(&self, compliance: f32, weight: f32) -> f32 {
        (compliance * self.kappa).min(weight)
    }

    /// How many times softer the spring of the law is than the one of [`Self::tangential`].
    pub fn softness(&self, compliance: f32, weight: f32) -> f64 {
        match weight > 0.0 {
            true => f64::from((compliance * self.kappa / weight).max(1.0)),
            false => 1.0,
        }
    }
}

/// A contact of a point sum a_i x_i of up to four vertices: a sample within a triangle, or a contact of cloth with
/// cloth (vertex and face, or two edges), whose weights sum to zero.
#[derive(Clone, Copy, Debug)]
pub struct ContactStencil {
    /// The vertices, as indices into the points of the region.
    pub vertices: [u32; 4],
    /// Their weights.
    pub weights: [f32; 4],
    /// The plane and its multipliers.
    pub constraint: ContactConstraint,
    /// The point at the start of the substep (m).
    pub begun_at: [f32; 3],
    /// Its number among the contacts of cloth with cloth; none for a sample.
    pub number: u32,
    /// Coefficient of restitution of a contact without a sample of the model.
    pub restitution: Option<f32>,
}

impl ContactStencil {
    /// The point sum a_i x_i.
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

    /// Inverse mass of the point (1/kg).
    #[inline(always)]
    pub fn weight(&self, points: &[Point]) -> f32 {
        (self.vertices.iter().zip(self.weights))
            .map(|(&v, a)| a * a * points[v as usize][3])
            .sum()
    }

    /// [`ContactConstraint::end_substep`] at the points at the end of the substep.
    pub fn end_substep(&mut self, points: &[Point], step: &ContactStep) {
        let (point, from) = (self.point(points), self.begun_at);
        let moved = [0, 1, 2].map(|k| point[k] - from[k] - self.constraint.surface_displacement[k]);
        let weight = self.weight(points);
        self.constraint.end_substep(weight, moved, step);
    }
}

/// Solves contact stencils one after the other; `points` are the vertices.
pub fn solve_stencils<'a>(
    stencils: impl Iterator<Item = &'a mut ContactStencil>,
    points: &mut [Point],
    step: &ContactStep,
) {
    for stencil in stencils {
        let weight = stencil.weight(points);
        let (point, start) = (stencil.point(points), stencil.begun_at);
        let change = stencil.constraint.solve(weight, point, start, step);
        for (&v, a) in stencil.vertices.iter().zip(stencil.weights) {
            let point = &mut points[v as usize];
            let share = a * point[3];
            for k in 0..3 {
                point[k] += share * change[k];
            }
        }
    }
}
