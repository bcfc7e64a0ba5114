//! What the Hessian cannot tell a Newton step about contact: that a point at the limit of friction
//! sticks as soon as it turns back, and that a point above a surface is stopped by it. Either kink,
//! at a single point, would make the line search cut the step of all the cloth.

use crate::System;
use crate::contacts::Contacts;
use crate::laws::contact::{ContactLaw, ContactPlane};
use toile_geometry::Vec3;

/// Unforeseen energy, over the fall a step promises, from which it is seen to.
const MATTERS: f64 = 0.1;

impl Contacts {
    /// Marks the points that a step would bring back from the limit of friction as sticking and
    /// those it would take into a surface as touching, where what they find there is not small
    /// beside the fall of the potential that the step `promises` [J]. Returns whether the direction
    /// has to be found anew.
    pub fn foresee(&mut self, x: &[Vec3], step: &[Vec3], promises: f64) -> bool {
        let mut energy = 0.0;
        self.for_each(x, step, |plane, law, at, by| {
            energy += law.unforeseen_return(plane, at, by);
            energy += law.unforeseen_landing(plane, at, by);
        });
        if energy <= MATTERS * promises {
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
        mut see: impl FnMut(&mut ContactPlane, &ContactLaw, Vec3, Vec3),
    ) {
        for contact in &mut self.active {
            let sample = &contact.point;
            let (at, by) = (sample.position(x), sample.position(step));
            see(&mut contact.plane, &contact.law, at, by);
        }
        for contact in self.cloth.all_mut() {
            let (at, by) = (contact.between(x), contact.between(step));
            see(&mut contact.plane, &contact.law, at, by);
        }
    }

    /// Adds to a force what draws points down that are about to land [N].
    pub fn pull_down(&self, system: &System, x: &[Vec3], force: &mut [Vec3]) {
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
                point: system.rest.samples[0],
                plane: plane(0, 2e-4),
                law,
            },
            Contact {
                sample: 1,
                point: system.rest.samples[1],
                plane: plane(1, -1e-3),
                law,
            },
        ];
        (system, contacts, mesh.positions)
    }

    #[test]
    fn kinks_are_seen_to_only_where_they_matter() {
        let (system, mut contacts, x) = scene();
        let back_and_down = [Vec3::x() * -1e-4, Vec3::y() * -3e-3, Vec3::zeros()];
        // 2.5e-7 J for the return, 2e-4 J for the landing.
        assert!(!contacts.foresee(&x, &back_and_down, 1.0));
        assert!(
            contacts
                .active
                .iter()
                .all(|c| !c.plane.returning && !c.plane.landing)
        );
        assert!(contacts.foresee(&x, &back_and_down, 1e-3));
        assert!(contacts.active[0].plane.returning && !contacts.active[0].plane.landing);
        assert!(!contacts.active[1].plane.returning && contacts.active[1].plane.landing);
        // Once seen they are foreseen.
        assert!(!contacts.foresee(&x, &back_and_down, 1e-9));
        let mut force = vec![Vec3::zeros(); 3];
        contacts.pull_down(&system, &x, &mut force);
        assert!((force[1] - Vec3::y() * -0.1).norm() < 1e-12 && force[0] == Vec3::zeros());
    }

    #[test]
    fn a_step_on_or_up_meets_no_kink() {
        let (_, mut contacts, x) = scene();
        let on_and_up = [Vec3::x() * 1e-4, Vec3::y() * 3e-3, Vec3::zeros()];
        assert!(!contacts.foresee(&x, &on_and_up, 1e-12));
    }
}
