//! Contact of a point with a plane: normal push and Coulomb friction.

use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The laws of contact: a stiff one-sided spring along the normal, and a tangential spring to an
/// anchor that gives way at the friction cone (Coulomb friction by return mapping, Wriggers 2006,
/// section 5.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Normal stiffness [N/m].
    pub normal: f64,
    /// Tangential stiffness while sticking [N/m].
    pub tangential: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Depth from which it is [`HARDER`] [m]; infinite for surfaces that cloth may sink into.
    pub hard_from: f64,
}

/// Factor of the stiffness of a contact beyond its hard depth. A linear spring between two cloths has its
/// largest force when they touch: a greater load would be stopped by the truncation of steps alone, and no
/// method would come to rest there.
pub const HARDER: f64 = 100.0;

/// A point near a surface, and the surface as seen from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPlane {
    /// The point [m].
    pub point: Vec3,
    /// How deep it lies below the offset surface, negative above it [m].
    pub depth: f64,
    /// Gradient of the distance there \[1\]. Its length is 1 but where two walls are equally near.
    pub gradient: Vec3,
    /// Outward unit normal: the gradient's direction \[1\].
    pub normal: Vec3,
    /// Second derivative of the distance there, its negative eigenvalues alone, sign turned: how
    /// hollow the surface is [1/m].
    pub hollow: Matrix3<f64>,
    /// Its positive eigenvalues: how the surface bulges [1/m].
    pub bulge: Matrix3<f64>,
    /// Where the point stuck to the surface [m].
    pub anchor: Vec3,
    /// Normal force that limits friction [N], taken from the last iteration.
    pub lagged_normal_force: f64,
    /// Whether a point at the limit of friction counts as sticking for the Hessian, because it is
    /// about to come back.
    pub returning: bool,
    /// Whether a point above the surface counts as touching for the Hessian, because it is about to
    /// land.
    pub landing: bool,
}

impl ContactPlane {
    /// Depth of a point below the offset surface, to first order [m].
    pub fn depth_of(&self, point: Vec3) -> f64 {
        self.depth - self.gradient.dot(&(point - self.point))
    }
}

/// Share of critical damping in the push of a surface on cloth that moves, for methods that damp
/// nothing themselves. Without it contact and friction together feed a flutter of cloth at rest.
pub const RESTITUTION_DAMPING: f64 = 0.2;

/// Speed [m/s] at which a surface that was put over cloth lets it go: faster, a push that no motion
/// has stored would throw it.
const LEAVING: f64 = 1.0;

/// The most push [N] on cloth of a mass [kg] that a surface was put over, for a substep [s].
#[inline(always)]
pub fn gentle_push(mass: f64, leaving: f64, substep: f64) -> f64 {
    (mass / substep * (LEAVING - leaving)).max(0.0)
}

/// Push of a surface [N] that stiffness and damping make together: max(0, k d - c v), with k d the
/// `elastic` part [N], v the `leaving` speed along the normal [m/s] and c = 2 zeta sqrt(k m) for
/// the `mass` [kg] on the spring `normal` [N/m]. It never pulls (Wriggers 2006, section 5.1).
#[inline(always)]
pub fn damped_push(elastic: f64, normal: f64, mass: f64, leaving: f64) -> f64 {
    (elastic - 2.0 * RESTITUTION_DAMPING * (normal * mass).sqrt() * leaving).max(0.0)
}

/// From this share of the friction limit on a point counts as sliding for the Hessian: a point
/// that slid in the last step lies just at the limit, and must not be held there as if it stuck.
const AT_LIMIT: f64 = 0.99;

impl ContactLaw {
    /// Energy [J], force [N] and stiffness [N/m] of the push at some depth [m].
    fn push(&self, depth: f64) -> [f64; 3] {
        let (soft, hard) = (depth.max(0.0), (depth - self.hard_from).max(0.0));
        let harder = HARDER * self.normal;
        [
            0.5 * (self.normal * soft * soft + harder * hard * hard),
            self.normal * soft + harder * hard,
            self.normal + if hard > 0.0 { harder } else { 0.0 },
        ]
    }

    /// Energy [J], gradient [N] and a positive semidefinite Hessian [N/m] at a point.
    ///
    /// Normal part: k d^2 / 2 for depth d > 0, and [`HARDER`] k (d - h)^2 / 2 more beyond the hard depth h.
    /// Its Hessian has k g g' and, where the surface is
    /// hollow, the turning of the normal as the point slides along: without that Newton's steps in
    /// an armpit are too long by several times and never settle. Tangential part: the Huber function of the slip
    /// from the anchor with limit mu N, N lagged, so that it has an energy.
    pub fn evaluate(&self, plane: &ContactPlane, point: Vec3) -> (f64, Vec3, Matrix3<f64>) {
        let n = plane.normal;
        let depth = plane.depth_of(point);
        let (mut energy, mut gradient, mut hessian) = (0.0, Vec3::zeros(), Matrix3::zeros());
        let [pushed, force, stiffness] = self.push(depth);
        if depth > 0.0 {
            energy += pushed;
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
                hessian += tangent * self.tangential;
            } else {
                // Friction is constant along the slip, so nothing holds the point back there.
                let along = slip / length;
                let across = self.tangential.min(limit / length);
                hessian += (tangent - along * along.transpose()) * across;
            }
        }
        (energy, gradient, hessian)
    }

    /// What the exact Hessian lacks against the one of [`Self::evaluate`]: a point on a bulge is
    /// pushed off it the more the farther it slides down [N/m].
    pub fn missing_curvature(&self, plane: &ContactPlane, point: Vec3) -> Matrix3<f64> {
        let [_, force, _] = self.push(plane.depth_of(point));
        plane.bulge * force
    }

    /// Energy that a point at the limit of friction finds on a `step` back into the cone, and that
    /// the Hessian of [`Self::evaluate`] does not foresee [J].
    pub fn unforeseen_return(&self, plane: &ContactPlane, point: Vec3, step: Vec3) -> f64 {
        let limit = self.friction * plane.lagged_normal_force;
        let n = plane.normal;
        let offset = point - plane.anchor;
        let slip = offset - n * offset.dot(&n);
        let length = slip.norm();
        if limit <= 0.0 || plane.returning || self.tangential * length <= AT_LIMIT * limit {
            return 0.0;
        }
        let back = -step.dot(&slip) / length;
        // Beyond the far side of the cone it slides the other way.
        let most = 2.0 * limit / self.tangential;
        let spring = back.clamp(0.0, most);
        self.tangential * spring * (back - 0.5 * spring).max(0.0)
    }

    /// Energy that a point above a surface finds when a `step` takes it in [J].
    pub fn unforeseen_landing(&self, plane: &ContactPlane, point: Vec3, step: Vec3) -> f64 {
        if plane.depth_of(point) > 0.0 || plane.landing {
            return 0.0;
        }
        let [energy, ..] = self.push(plane.depth_of(point + step));
        energy
    }

    /// Force that draws a point about to land down to the surface, so that the Newton step ends
    /// there: that of the spring of the surface if it could pull \[N\].
    pub fn pull_down(&self, plane: &ContactPlane, point: Vec3) -> Option<Vec3> {
        let depth = plane.depth_of(point);
        (plane.landing && depth < 0.0).then(|| plane.gradient * (self.normal * depth))
    }

    /// Energy alone [J].
    pub fn energy(&self, plane: &ContactPlane, point: Vec3) -> f64 {
        let n = plane.normal;
        let [mut energy, ..] = self.push(plane.depth_of(point));
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

    /// Normal force at a point [N].
    pub fn normal_force(&self, plane: &ContactPlane, point: Vec3) -> f64 {
        let [_, force, _] = self.push(plane.depth_of(point));
        force * plane.gradient.norm()
    }

    /// The anchor after a step: it stays while the tangential spring is inside the friction cone
    /// of `normal_force`, and slides after the point otherwise [m].
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
    fn what_the_hessian_does_not_foresee_of_a_return_is_told() {
        let (plane, point, along) = at_limit();
        let (energy, gradient, hessian) = LAW.evaluate(&plane, point);
        for step in [-1e-4, -5e-4, -2.5e-3, 0.0, 3e-4].map(|s| along * s) {
            let quadratic = energy + gradient.dot(&step) + 0.5 * step.dot(&(hessian * step));
            let more = LAW.energy(&plane, point + step) - quadratic;
            let told = LAW.unforeseen_return(&plane, point, step);
            assert!((more - told).abs() < 1e-12, "{step:?}: {more} {told}");
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
    fn what_the_hessian_does_not_foresee_of_a_landing_is_told_and_drawn_to_the_surface() {
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
