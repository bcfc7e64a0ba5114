//! Kinks of the contact potential, which no Hessian contains: a point at the limit of friction sticks as soon as it
//! moves back, and a point above a surface touches it further on. Either kink, at a single point, would make the
//! line search shorten the step of the whole cloth. A step is therefore tested for kinks before it is taken, and the
//! points that cross one count as sticking or touching: an active set found by prediction.

use crate::System;
use crate::contacts::Contacts;
use crate::laws::contact::{ContactLaw, ContactPlane};
use toile_geometry::Vec3;

/// Kinks are taken into account where the energy that the quadratic model misses because of them exceeds this share
/// of the predicted decrease.
const MIN_ENERGY_SHARE: f64 = 0.1;

impl Contacts {
    /// Marks the points that a step would move back from the limit of friction as sticking and those that it
    /// would move into a surface as touching, where the energy of these kinks is not small against the decrease
    /// of the potential that the quadratic model predicts, `predicted_decrease` (J). Returns whether points were
    /// marked, and the direction has to be computed anew.
    pub fn predict_kinks(&mut self, x: &[Vec3], step: &[Vec3], predicted_decrease: f64) -> bool {
        let mut energy = 0.0;
        self.for_each(x, step, |plane, law, at, by| {
            energy += law.unforeseen_return(plane, at, by);
            energy += law.unforeseen_landing(plane, at, by);
        });
        if energy <= MIN_ENERGY_SHARE * predicted_decrease {
            return false;
        }
        self.for_each(x, step, |plane, law, at, by| {
            plane.returning |= law.unforeseen_return(plane, at, by) > 0.0;
            plane.landing |= law.unforeseen_landing(plane, at, by) > 0.0;
        });
        true
    }

    fn for_each(
        &mut self,
        x: &[Vec3],
        step: &[Vec3],
        mut visit: impl FnMut(&mut ContactPlane, &ContactLaw, Vec3, Vec3),
    ) {
        for contact in &mut self.active {
            let sample = &contact.point;
            let (at, by) = (sample.position(x), sample.position(step));
            visit(&mut contact.plane, &contact.law, at, by);
        }
        for contact in self.cloth.all_mut() {
            let (at, by) = (contact.between(x), contact.between(step));
            visit(&mut contact.plane, &contact.law, at, by);
        }
    }

    /// Adds to a force (N) the pull of the surfaces on the points marked as touching that are still above them.
    pub fn add_landing_pull(&self, system: &System, x: &[Vec3], force: &mut [Vec3]) {
        for contact in &self.active {
            let sample = &contact.point;
            let pull = contact.law.pull_down(&contact.plane, sample.position(x));
            let Some(pull) = pull else { continue };
            for (&v, &w) in sample.vertices.iter().zip(&sample.weights) {
                if !system.prescribed.pinned[v as usize] {
                    force[v as usize] += pull * w;
                }
            }
        }
        for contact in self.cloth.all() {
            let pull = contact.law.pull_down(&contact.plane, contact.between(x));
            let Some(pull) = pull else { continue };
            for (v, w) in contact.vertices.into_iter().zip(contact.weights) {
                if !system.prescribed.pinned[v as usize] {
                    force[v as usize] += pull * w;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::Contact;
    use crate::{Cloth, Material, System};
    use nalgebra::Matrix3;
    use toile_geometry::TriangleMesh;

    /// One triangle; its first vertex slides along x at the limit of friction on a level floor, the
    /// second hovers 1 mm above it.
    fn scene() -> (System, Contacts, Vec<Vec3>) {
        let mesh = TriangleMesh {
            positions: vec![Vec3::zeros(), Vec3::new(0.1, 1e-3, 0.0), Vec3::z() * 0.1],
            triangles: vec![[0, 1, 2]],
        };
        let cloth = Cloth::from_mesh("triangle", &mesh, Material::default()).unwrap();
        let system = System::new("triangle", &cloth).unwrap();
        let law = ContactLaw {
            normal: 100.0,
            tangential: 50.0,
            friction: 0.5,
            hard_from: f64::INFINITY,
        };
        let plane = |v: usize, depth: f64| ContactPlane {
            point: mesh.positions[v],
            depth,
            gradient: Vec3::y(),
            normal: Vec3::y(),
            hollow: Matrix3::zeros(),
            bulge: Matrix3::zeros(),
            anchor: mesh.positions[v] - Vec3::x() * (0.5 * 0.02 / 50.0),
            lagged_normal_force: if depth > 0.0 { 0.02 } else { 0.0 },
            returning: false,
            landing: false,
        };
        let mut contacts = Contacts::default();
        contacts.active = vec![
            Contact {
                sample: 0,
                solid: 0,
                point: system.rest.samples[0],
                plane: plane(0, 2e-4),
                law,
            },
            Contact {
                sample: 1,
                solid: 0,
                point: system.rest.samples[1],
                plane: plane(1, -1e-3),
                law,
            },
        ];
        (system, contacts, mesh.positions)
    }

    #[test]
    fn kinks_are_predicted_only_where_their_energy_is_not_small() {
        let (system, mut contacts, x) = scene();
        let back_and_down = [Vec3::x() * -1e-4, Vec3::y() * -3e-3, Vec3::zeros()];
        // 2.5e-7 J for the return, 2e-4 J for the landing.
        assert!(!contacts.predict_kinks(&x, &back_and_down, 1.0));
        assert!(
            contacts
                .active
                .iter()
                .all(|c| !c.plane.returning && !c.plane.landing)
        );
        assert!(contacts.predict_kinks(&x, &back_and_down, 1e-3));
        assert!(contacts.active[0].plane.returning && !contacts.active[0].plane.landing);
        assert!(!contacts.active[1].plane.returning && contacts.active[1].plane.landing);
        // Marked points are not predicted again.
        assert!(!contacts.predict_kinks(&x, &back_and_down, 1e-9));
        let mut force = vec![Vec3::zeros(); 3];
        contacts.add_landing_pull(&system, &x, &mut force);
        assert!((force[1] - Vec3::y() * -0.1).norm() < 1e-12 && force[0] == Vec3::zeros());
    }

    #[test]
    fn a_step_on_or_up_meets_no_kink() {
        let (_, mut contacts, x) = scene();
        let on_and_up = [Vec3::x() * 1e-4, Vec3::y() * 3e-3, Vec3::zeros()];
        assert!(!contacts.predict_kinks(&x, &on_and_up, 1e-12));
    }
}
