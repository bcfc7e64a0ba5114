//! Rigid impact zones, for collisions that pairwise impulses do not resolve: all vertices of features that keep
//! meeting move as one rigid body (Provot 1997; Harmon et al. 2008).
//!
//! Let m be the masses, c the centre of mass, d the displacements and r = x - c. With mass M, momentum P = sum m d,
//! inertia J = sum m (|r|^2 - r r') and moment of momentum L = sum m r x d, a vertex moves in a straight line by
//! ```text
//! d' = P / M + w x r,   J w = L
//! ```
//! Both momenta are conserved exactly. At time t this is the linear map `1 + t [w]`, whose determinant is
//! 1 + t^2 |w|^2 and whose least singular value is 1. So no two points of a zone come nearer to each other and
//! nothing in it collides. It grows by at most |w|^2 / 2, to second order in a small angle.

use super::motions::Motions;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// Largest rotation of a zone in one motion (rad). A zone that would rotate farther would grow too much; it is left
/// to the truncation of moves.
const MAX_ROTATION: f64 = 0.1;

/// Principal moments below this share of the largest count as zero: the zone is a line, and does not rotate about
/// itself.
const ZERO_MOMENT: f64 = 1e-9;

/// A partition of vertices into zones, as a union-find forest.
#[derive(Clone, Debug)]
pub struct ImpactZones {
    parent: Vec<u32>,
    /// Vertices in any zone, in the order in which they joined.
    members: Vec<u32>,
    is_member: Vec<bool>,
}

impl ImpactZones {
    /// No zones among `count` vertices.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            members: Vec::new(),
            is_member: vec![false; count],
        }
    }

    /// Number of vertices in zones.
    pub fn count(&self) -> usize {
        self.members.len()
    }

    /// Vertices in zones.
    pub fn members(&self) -> &[u32] {
        &self.members
    }

    fn root(&mut self, mut v: u32) -> u32 {
        while self.parent[v as usize] != v {
            self.parent[v as usize] = self.parent[self.parent[v as usize] as usize];
            v = self.parent[v as usize];
        }
        v
    }

    /// Joins the vertices of a collision, and the zones that they are in, into one zone. `inverse_mass` is the inverse
    /// mass of each vertex (1/kg). Vertices of infinite mass join no zone: all zones at them would become one.
    pub fn join(&mut self, vertices: [u32; 4], inverse_mass: &[f64]) {
        let mut first = None;
        for v in vertices {
            if inverse_mass[v as usize] <= 0.0 {
                continue;
            }
            if !std::mem::replace(&mut self.is_member[v as usize], true) {
                self.members.push(v);
            }
            let root = self.root(v);
            match first {
                None => first = Some(root),
                Some(other) => {
                    // The smaller index becomes the root, so that the order of pairs does not matter.
                    self.parent[root.max(other) as usize] = root.min(other);
                    first = Some(root.min(other));
                }
            }
        }
    }

    /// Vertices of each zone, sorted.
    fn groups(&mut self) -> Vec<Vec<u32>> {
        let mut members = self.members.clone();
        members.sort_unstable();
        let mut rooted: Vec<(u32, u32)> = members.iter().map(|&v| (self.root(v), v)).collect();
        rooted.sort_unstable();
        let runs = rooted.chunk_by(|a, b| a.0 == b.0);
        runs.map(|run| run.iter().map(|&(_, v)| v).collect())
            .collect()
    }

    /// Replaces the moves and velocities in every zone by the rigid motion of the same momenta. Zones that would
    /// rotate too far are not changed.
    pub fn make_rigid(&mut self, motion: &mut Motions) {
        for zone in self.groups() {
            let zone = ImpactZone::new(&zone, motion.x, motion.inverse_mass);
            let [shift, rotation] = zone.rigid_motion(motion.moves);
            if rotation.norm() > MAX_ROTATION {
                continue;
            }
            let [velocity, spin] = zone.rigid_motion(motion.velocities);
            for &v in zone.vertices {
                let arm = motion.x[v as usize] - zone.centre;
                motion.moves[v as usize] = shift + rotation.cross(&arm);
                motion.velocities[v as usize] = velocity + spin.cross(&arm);
            }
        }
    }
}

/// Mass properties of one zone at the start of the motion.
struct ImpactZone<'a> {
    vertices: &'a [u32],
    x: &'a [Vec3],
    /// Inverse masses of all vertices (1/kg).
    inverse_mass: &'a [f64],
    /// Mass of the zone (kg).
    mass: f64,
    /// Centre of mass (m).
    centre: Vec3,
    /// Pseudo-inverse of the inertia about the centre (1/(kg m2)).
    inverse_inertia: Matrix3<f64>,
}

impl<'a> ImpactZone<'a> {
    fn new(vertices: &'a [u32], x: &'a [Vec3], inverse_mass: &'a [f64]) -> Self {
        let mut mass = 0.0;
        let mut centre = Vec3::zeros();
        for &v in vertices {
            mass += 1.0 / inverse_mass[v as usize];
            centre += x[v as usize] / inverse_mass[v as usize];
        }
        centre /= mass;
        let mut inertia = Matrix3::zeros();
        for &v in vertices {
            let arm = x[v as usize] - centre;
            let square = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            inertia += square / inverse_mass[v as usize];
        }
        let mut principal = inertia.symmetric_eigen();
        let largest = principal.eigenvalues.max();
        for moment in principal.eigenvalues.iter_mut() {
            *moment = if *moment > ZERO_MOMENT * largest {
                1.0 / *moment
            } else {
                0.0
            };
        }
        Self {
            vertices,
            x,
            inverse_mass,
            mass,
            centre,
            inverse_inertia: principal.recompose(),
        }
    }

    /// Shift and rotation (or velocity and spin) with the momenta of these displacements (or velocities).
    fn rigid_motion(&self, moves: &[Vec3]) -> [Vec3; 2] {
        let (mut momentum, mut moment) = (Vec3::zeros(), Vec3::zeros());
        for &v in self.vertices {
            let of_vertex = moves[v as usize] / self.inverse_mass[v as usize];
            momentum += of_vertex;
            moment += (self.x[v as usize] - self.centre).cross(&of_vertex);
        }
        [momentum / self.mass, self.inverse_inertia * moment]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Both momenta are conserved, and no two points of a zone come nearer to each other.
        #[test]
        fn zones_conserve_momenta_and_never_shrink(
            numbers in prop::array::uniform32(-1.0..1.0f64),
            masses in prop::array::uniform5(0.1..3.0f64),
            flat in any::<bool>(),
        ) {
            let v = |k: usize| Vec3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
            // The inertia of points on a line is singular.
            let x: Vec<Vec3> = (0..5).map(|k| if flat { Vec3::x() * v(k).x } else { v(k) }).collect();
            let mut moves: Vec<Vec3> = (5..10).map(|k| v(k) * 0.005).collect();
            let mut velocities: Vec<Vec3> = moves.iter().map(|d| d * 7.0).collect();
            let inverse_mass: Vec<f64> = masses.iter().map(|m| 1.0 / m).collect();
            let momenta = |moves: &[Vec3]| {
                let each = || moves.iter().zip(&masses).zip(&x);
                let shift: Vec3 = each().map(|((d, m), _)| d * *m).sum();
                let turn: Vec3 = each().map(|((d, m), x)| x.cross(d) * *m).sum();
                [shift, turn]
            };
            let before = momenta(&moves);
            let start = moves.clone();
            let mut zones = ImpactZones::new(5);
            zones.join([0, 1, 2, 3], &inverse_mass);
            zones.join([3, 4, 3, 4], &inverse_mass);
            prop_assert_eq!(zones.count(), 5);
            zones.make_rigid(&mut Motions {
                x: &x,
                moves: &mut moves,
                velocities: &mut velocities,
                inverse_mass: &inverse_mass,
                span: 1.0,
            });
            if moves == start {
                return Ok(());
            }
            let after = momenta(&moves);
            for k in 0..2 {
                prop_assert!((after[k] - before[k]).norm() < 1e-12, "{:?} {:?}", after, before);
                prop_assert!((momenta(&velocities)[k] - before[k] * 7.0).norm() < 1e-11);
            }
            for i in 0..5 {
                for j in 0..i {
                    let before = (x[i] - x[j]).norm();
                    let after = (x[i] + moves[i] - x[j] - moves[j]).norm();
                    prop_assert!(after >= before * (1.0 - 1e-12) && after <= before * 1.006);
                }
            }
        }
    }

    #[test]
    fn collisions_join_zones_but_not_through_pinned_vertices() {
        let inverse_mass = [1.0, 1.0, 1.0, 0.0, 1.0, 1.0];
        let mut zones = ImpactZones::new(6);
        zones.join([5, 3, 4, 5], &inverse_mass);
        zones.join([0, 1, 3, 3], &inverse_mass);
        assert_eq!(zones.groups(), vec![vec![0, 1], vec![4, 5]]);
        zones.join([1, 4, 2, 2], &inverse_mass);
        assert_eq!(zones.groups(), vec![vec![0, 1, 2, 4, 5]]);
    }
}
