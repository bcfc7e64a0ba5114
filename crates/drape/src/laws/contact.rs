//! Contact of a point with a plane: normal force and Coulomb friction.
//!
//! # Decided with
//! - [`crate::contacts`] (`find`): contacts with solids, and the stiffness of each;
//! - [`crate::collision::ContactDetector::contact`]: contacts of cloth: the mean friction of both sides;
//! - [`crate::collision`] (`mollifier.rs`): weaker between edges that are nearly parallel;
//! - [`crate::contacts::Contacts::begin_step`]: friction in the first step of a contact;
//! - [`crate::contacts::Contacts::damp`]: explicit methods damp the push;
//! - [`crate::xpbd`] (`contact.rs`, `solve`, `several_solids.rs`, `solve_together`): the same in XPBD;
//! - [`crate::xpbd`] (`contact_block.rs`): the same for several vertices at once;
//! - crate `reference` (`patches/`: `patch_contacts.rs`, `update_force`): the same in patches;
//! - [`toile_fabric::FIGURES`]: the coefficient of friction: default, domain, names in files.
//!
//! By hand: the copies in XPBD and in patches follow this law.

use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The laws of contact: a stiff one-sided spring along the normal, and a tangential spring to an
/// anchor that gives way at the friction cone (Coulomb friction by return mapping, Wriggers 2006,
/// section 5.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Normal stiffness (N/m).
    pub normal: f64,
    /// Tangential stiffness while sticking (N/m).
    pub tangential: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Depth beyond which the normal stiffness is [`HARDER`] times larger (m); infinite for solids.
    pub hard_from: f64,
}

/// Ratio of the tangential to the normal stiffness of a contact.
pub const TANGENTIAL_RATIO: f64 = 0.5;

/// Factor of the additional stiffness of a contact beyond its hard depth. A linear spring between two cloths has its
/// largest force when they touch: under a greater load only step truncation would keep them apart, and no method would
/// reach equilibrium.
pub const HARDER: f64 = 100.0;

/// A point near a surface, with a second-order model of the surface at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPlane {
    /// The point (m).
    pub point: Vec3,
    /// Depth of the point below the offset surface, negative above it (m).
    pub depth: f64,
    /// Gradient of the smooth distance at the point (1), of length 1 except near the medial axis.
    pub gradient: Vec3,
    /// Outward unit normal, the direction of the gradient (1).
    pub normal: Vec3,
    /// Negative part of the Hessian of the distance, with positive sign: concave curvature of the surface (1/m).
    pub hollow: Matrix3<f64>,
    /// Positive part of the Hessian of the distance: convex curvature of the surface (1/m).
    pub bulge: Matrix3<f64>,
    /// Friction anchor: the position at which the point stuck (m).
    pub anchor: Vec3,
    /// Lagged normal force, which limits friction (N).
    pub lagged_normal_force: f64,
    /// Whether the Hessian treats a point at the limit of friction as sticking, because the step moves it back into the
    /// cone.
    pub returning: bool,
    /// Whether the Hessian treats a point above the surface as in contact, because the step makes it land.
    pub landing: bool,
}

impl ContactPlane {
    /// Depth of a point below the offset surface, to first order (m).
    #[inline]
    pub fn depth_of(&self, point: Vec3) -> f64 {
        self.depth - self.gradient.dot(&(point - self.point))
    }
}

/// Share of critical damping of the normal force on moving cloth, for methods without numerical damping. Without it
/// contact and friction together excite a flutter of cloth at rest.
pub const RESTITUTION_DAMPING: f64 = 0.2;

/// Largest speed (m/s) at which a solid ejects buried cloth: the energy of its depth was not stored by motion and would
/// throw it.
const EJECTION_SPEED: f64 = 1.0;

/// Largest normal force (N) on buried cloth of a mass (kg) with a speed `leaving` (m/s), in a substep (s).
#[inline(always)]
pub fn gentle_push(mass: f64, leaving: f64, substep: f64) -> f64 {
    (mass / substep * (EJECTION_SPEED - leaving)).max(0.0)
}

/// Normal force (N) of stiffness and damping together: max(0, k d - c v), with k d the
/// `elastic` part (N), v the `leaving` speed along the normal (m/s) and c = 2 zeta sqrt(k m) for
/// the `mass` (kg) on the spring `normal` (N/m). It is never attractive (Wriggers 2006, section 5.1).
#[inline(always)]
pub fn damped_push(elastic: f64, normal: f64, mass: f64, leaving: f64) -> f64 {
    (elastic - 2.0 * RESTITUTION_DAMPING * (normal * mass).sqrt() * leaving).max(0.0)
}

/// Share of the friction limit from which the Hessian treats a point as sliding: a point that slid in the last step is
/// just at the limit and must not be treated as sticking.
const AT_LIMIT: f64 = 0.99;

impl ContactLaw {
    /// Energy (J), force (N) and stiffness (N/m) of the normal spring at a depth (m).
    #[inline]
    pub fn normal_spring(&self, depth: f64) -> [f64; 3] {
        let normal = self.normal;
        let (soft, hard) = (depth.max(0.0), (depth - self.hard_from).max(0.0));
        let harder = HARDER * normal;
        [
            0.5 * (normal * soft * soft + harder * hard * hard),
            normal * soft + harder * hard,
            normal + if hard > 0.0 { harder } else { 0.0 },
        ]
    }

    /// Energy (J), gradient (N) and a positive semidefinite Hessian (N/m) at a point.
    ///
    /// Normal part: k d^2 / 2 for depth d > 0, and [`HARDER`] k (d - h)^2 / 2 more beyond the hard depth h. Its Hessian
    /// has k g g' and, where the surface is concave, the change of the normal along the surface: without it Newton's
    /// steps in an armpit are several times too long and do not converge. Tangential part: the Huber function of the
    /// slip from the anchor with limit mu N; N is lagged, so that friction has a potential.
    pub fn evaluate(&self, plane: &ContactPlane, point: Vec3) -> (f64, Vec3, Matrix3<f64>) {
        let n = plane.normal;
        let depth = plane.depth_of(point);
        let (mut energy, mut gradient, mut hessian) = (0.0, Vec3::zeros(), Matrix3::zeros());
        let [normal_energy, force, stiffness] = self.normal_spring(depth);
        if depth > 0.0 {
            energy += normal_energy;
            gradient -= plane.gradient * force;
            hessian += plane.hollow * force;
        }
        if depth > 0.0 || plane.landing {
            hessian += plane.gradient * plane.gradient.transpose() * stiffness;
        }
        let limit = self.friction * plane.lagged_normal_force;
        if limit > 0.0 {
            let offset = point - plane.anchor;
            let slip = offset - n * offset.dot(&n);
            let length = slip.norm();
            let tangent = Matrix3::identity() - n * n.transpose();
            if self.tangential * length <= limit {
                energy += 0.5 * self.tangential * length * length;
                gradient += slip * self.tangential;
            } else {
                energy += limit * length - 0.5 * limit * limit / self.tangential;
                gradient += slip * (limit / length);
            }
            if plane.returning || self.tangential * length <= AT_LIMIT * limit {
                // Of a point that slid beyond the limit the secant, which majorises the energy on the way back.
                let sticks = self.tangential * length <= limit;
                let stiffness = if sticks {
                    self.tangential
                } else {
                    limit / length
                };
                hessian += tangent * stiffness;
            } else {
                // Friction is constant along the slip, so it has no stiffness in that direction.
                let along = slip / length;
                let across = self.tangential.min(limit / length);
                hessian += (tangent - along * along.transpose()) * across;
            }
        }
        (energy, gradient, hessian)
    }

    /// The Hessian of [`Self::evaluate`] minus the exact one, from the convex curvature of the surface, which
    /// destabilises sliding (N/m).
    pub fn missing_curvature(&self, plane: &ContactPlane, point: Vec3) -> Matrix3<f64> {
        let [_, force, _] = self.normal_spring(plane.depth_of(point));
        plane.bulge * force
    }

    /// Energy that a `step` of a point at the limit of friction back into the cone adds to the quadratic model of
    /// [`Self::evaluate`] (J).
    pub fn unforeseen_return(&self, plane: &ContactPlane, point: Vec3, step: Vec3) -> f64 {
        let limit = self.friction * plane.lagged_normal_force;
        let n = plane.normal;
        let offset = point - plane.anchor;
        let slip = offset - n * offset.dot(&n);
        let length = slip.norm();
        if limit <= 0.0 || plane.returning || self.tangential * length <= AT_LIMIT * limit {
            return 0.0;
        }
        // A point beyond the limit enters the cone only after the way back to it.
        let beyond = (length - limit / self.tangential).max(0.0);
        let back = -step.dot(&slip) / length - beyond;
        // Beyond the far side of the cone it slides in the opposite direction.
        let width = 2.0 * limit / self.tangential;
        let spring = back.clamp(0.0, width);
        self.tangential * spring * (back - 0.5 * spring).max(0.0)
    }

    /// Contact energy of a point above a surface after a `step` into it (J).
    pub fn unforeseen_landing(&self, plane: &ContactPlane, point: Vec3, step: Vec3) -> f64 {
        if plane.depth_of(point) > 0.0 || plane.landing {
            return 0.0;
        }
        let [energy, ..] = self.normal_spring(plane.depth_of(point + step));
        energy
    }

    /// Force on a landing point above the surface with which the Newton step ends at the surface: that of the normal
    /// spring extended to negative depths (N). None for other points.
    pub fn pull_down(&self, plane: &ContactPlane, point: Vec3) -> Option<Vec3> {
        let depth = plane.depth_of(point);
        (plane.landing && depth < 0.0).then(|| plane.gradient * (self.normal * depth))
    }

    /// The energy of [`Self::evaluate`] (J).
    pub fn energy(&self, plane: &ContactPlane, point: Vec3) -> f64 {
        let n = plane.normal;
        let [mut energy, ..] = self.normal_spring(plane.depth_of(point));
        let limit = self.friction * plane.lagged_normal_force;
        if limit > 0.0 {
            let offset = point - plane.anchor;
            let length = (offset - n * offset.dot(&n)).norm();
            energy += if self.tangential * length <= limit {
                0.5 * self.tangential * length * length
            } else {
                limit * length - 0.5 * limit * limit / self.tangential
            };
        }
        energy
    }

    /// Normal force at a point (N).
    pub fn normal_force(&self, plane: &ContactPlane, point: Vec3) -> f64 {
        let [_, force, _] = self.normal_spring(plane.depth_of(point));
        force * plane.gradient.norm()
    }

    /// The anchor after a step (m): unchanged inside the friction cone of `normal_force`, else moved to the boundary of
    /// the cone (return mapping).
    pub fn slide(&self, plane: &ContactPlane, point: Vec3, normal_force: f64) -> Vec3 {
        let n = plane.normal;
        let offset = point - plane.anchor;
        let slip = offset - n * offset.dot(&n);
        let length = slip.norm();
        let reach = self.friction * normal_force / self.tangential;
        if length <= reach {
            plane.anchor
        } else {
            point - n * offset.dot(&n) - slip * (reach / length)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: ContactLaw = ContactLaw {
        normal: 300.0,
        tangential: 150.0,
        friction: 0.4,
        hard_from: f64::INFINITY,
    };

    fn plane() -> ContactPlane {
        let normal = Vec3::new(0.48, 0.6, 0.64);
        ContactPlane {
            point: Vec3::new(0.1, 0.2, 0.3),
            depth: 0.0,
            gradient: normal,
            normal,
            hollow: Matrix3::zeros(),
            bulge: Matrix3::zeros(),
            anchor: Vec3::new(0.101, 0.2, 0.299),
            lagged_normal_force: 0.3,
            returning: false,
            landing: false,
        }
    }

    #[test]
    fn gradient_is_the_slope_of_the_energy_stuck_and_sliding_soft_and_hard() {
        let hard = ContactLaw {
            hard_from: 1e-3,
            ..LAW
        };
        for (law, offset) in [
            (LAW, Vec3::new(-1e-4, 0.0, -2e-4)),
            (LAW, Vec3::new(-4e-3, 2e-3, -1e-3)),
            (LAW, Vec3::new(0.01, 0.01, 0.0)),
            (hard, Vec3::new(-1e-4, 0.0, -2e-4)),
            (hard, Vec3::new(-4e-3, 2e-3, -1e-3)),
        ] {
            let point = plane().point + offset;
            let (_, gradient, hessian) = law.evaluate(&plane(), point);
            for axis in 0..3 {
                let step = Vec3::ith(axis, 1e-8);
                let slope = (law.energy(&plane(), point + step)
                    - law.energy(&plane(), point - step))
                    / 2e-8;
                assert!(
                    (slope - gradient[axis]).abs() < 1e-6,
                    "{slope} {}",
                    gradient[axis]
                );
            }
            assert!(hessian.symmetric_eigenvalues().min() > -1e-9);
        }
        let point = plane().point - plane().normal * 1.5e-3;
        let force = hard.normal * (1.5e-3 + HARDER * 0.5e-3);
        assert!((hard.normal_force(&plane(), point) - force).abs() < 1e-9);
    }

    #[test]
    fn friction_stays_in_its_cone_and_the_anchor_follows() {
        let plane = plane();
        let along = Vec3::new(0.02, -0.01, 0.0);
        let tangent = along - plane.normal * along.dot(&plane.normal);
        let point = plane.point + tangent - plane.normal * 1e-3;
        let force = LAW.normal_force(&plane, point);
        assert!((force - LAW.normal * 1e-3).abs() < 1e-12);
        let anchor = LAW.slide(&plane, point, force);
        let offset = point - anchor;
        let slip = offset - plane.normal * offset.dot(&plane.normal);
        assert!((slip.norm() * LAW.tangential - LAW.friction * force).abs() < 1e-12);
        let stuck = LAW.slide(&plane, plane.anchor + plane.normal * 0.01, 1.0);
        assert_eq!(stuck, plane.anchor);
    }

    /// A point at the limit of friction, touching and pressed, with the slip's direction.
    fn at_limit() -> (ContactPlane, Vec3, Vec3) {
        let plane = plane();
        let along = Vec3::new(0.8, 0.0, -0.6);
        let reach = LAW.friction * plane.lagged_normal_force / LAW.tangential;
        let point = plane.anchor + along * reach;
        assert!(along.dot(&plane.normal).abs() < 1e-12);
        (plane, point, along)
    }

    #[test]
    fn the_energy_of_a_return_that_the_hessian_lacks_is_exact() {
        let (plane, point, along) = at_limit();
        let (energy, gradient, hessian) = LAW.evaluate(&plane, point);
        for step in [-1e-4, -5e-4, -2.5e-3, 0.0, 3e-4].map(|s| along * s) {
            let quadratic = energy + gradient.dot(&step) + 0.5 * step.dot(&(hessian * step));
            let more = LAW.energy(&plane, point + step) - quadratic;
            let predicted = LAW.unforeseen_return(&plane, point, step);
            assert!(
                (more - predicted).abs() < 1e-12,
                "{step:?}: {more} {predicted}"
            );
        }
        let returning = ContactPlane {
            returning: true,
            ..plane
        };
        assert_eq!(LAW.unforeseen_return(&returning, point, -along * 1e-4), 0.0);
        let stuck = LAW.evaluate(&returning, point).2;
        assert!((along.dot(&(stuck * along)) - LAW.tangential).abs() < 1e-9);
    }

    #[test]
    fn the_energy_of_a_landing_that_the_hessian_lacks_is_exact_and_the_force_ends_at_the_surface() {
        let law = ContactLaw {
            friction: 0.0,
            ..LAW
        };
        let plane = plane();
        let (above, step) = (
            plane.point + plane.normal * 2e-3,
            plane.normal * -5e-3 + Vec3::x() * 1e-3,
        );
        let told = law.unforeseen_landing(&plane, above, step);
        assert!((told - law.energy(&plane, above + step)).abs() < 1e-15 && told > 0.0);
        assert_eq!(law.unforeseen_landing(&plane, above, step * 0.1), 0.0);
        assert_eq!(law.pull_down(&plane, above), None);
        let landing = ContactPlane {
            landing: true,
            ..plane
        };
        let pull = law.pull_down(&landing, above).unwrap();
        let (_, gradient, hessian) = law.evaluate(&landing, above);
        assert_eq!(gradient, Vec3::zeros());
        // The spring alone ends on the surface.
        let fall = plane.normal * (plane.normal.dot(&pull) / law.normal);
        assert!((hessian * fall - pull).norm() < 1e-9);
        assert!(landing.depth_of(above + fall).abs() < 1e-12);
    }
}
