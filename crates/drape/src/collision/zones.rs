//! Rigid impact zones, where impulses pair by pair do not settle: the points of features that go on
//! meeting move as one (Provot 1997; Harmon et al. 2008).
//!
//! With masses m, centre c and moves d, of which M, P = sum m d, J = sum m |r|^2 - r r' and
//! L = sum m r x d (r = x - c) are mass, momentum, inertia and moment of momentum, a point moves by
//! ```text
//! d' = P / M + w x r,   J w = L
//! ```
//! in a straight line: both momenta are kept exactly. That is the affine map 1 + t [w] at a time t, with
//! determinant 1 + t^2 |w|^2 and least singular value 1. So no two points of a zone come nearer to each
//! other, nothing in it meets, and its size grows by |w|^2 / 2 at the most, which is the square of a
//! small angle.

use super::motions::Motions;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// A zone that turns farther than this in one move [rad] is left to be cut: it would grow.
const MOST_TURN: f64 = 0.1;

/// Below this share of its largest principal moment a zone is a line, and turns about itself freely.
const LINE: f64 = 1e-9;

/// Vertices in zones.
#[derive(Clone, Debug)]
pub struct Zones {
    parent: Vec<u32>,
    /// Vertices in any zone, in the order they came.
    members: Vec<u32>,
    is_member: Vec<bool>,
}

impl Zones {
    /// No zones over some vertices.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            members: Vec::new(),
            is_member: vec![false; count],
        }
    }

    /// Vertices in zones.
    pub fn count(&self) -> usize {
        self.members.len()
    }

    /// Those vertices.
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

    /// Makes one zone of some vertices and of the zones they are in. What nothing moves joins none: it
    /// would hold all together.
    pub fn join(&mut self, vertices: [u32; 4], lightness: &[f64]) {
        let mut first = None;
        for v in vertices {
            if lightness[v as usize] <= 0.0 {
                continue;
            }
            if !std::mem::replace(&mut self.is_member[v as usize], true) {
                self.members.push(v);
            }
            let root = self.root(v);
            match first {
                None => first = Some(root),
                Some(other) => {
                    // The smaller index stays root, whatever the order of pairs.
                    self.parent[root.max(other) as usize] = root.min(other);
                    first = Some(root.min(other));
                }
            }
        }
    }

    /// The zones, each in order of its vertices.
    fn groups(&mut self) -> Vec<Vec<u32>> {
        let mut members = self.members.clone();
        members.sort_unstable();
        let mut rooted: Vec<(u32, u32)> = members.iter().map(|&v| (self.root(v), v)).collect();
        rooted.sort_unstable();
        let runs = rooted.chunk_by(|a, b| a.0 == b.0);
        runs.map(|run| run.iter().map(|&(_, v)| v).collect())
            .collect()
    }

    /// Moves every zone as one, its velocities too. Zones that turn too far stay as they are.
    pub fn stiffen(&mut self, motion: &mut Motions) {
        for zone in self.groups() {
            let zone = Zone::new(&zone, motion.x, motion.lightness);
            let way = zone.rigid(motion.moves);
            if way[1].norm() > MOST_TURN {
                continue;
            }
            let speed = zone.rigid(motion.velocities);
            for &v in zone.vertices {
                let arm = motion.x[v as usize] - zone.centre;
                motion.moves[v as usize] = way[0] + way[1].cross(&arm);
                motion.velocities[v as usize] = speed[0] + speed[1].cross(&arm);
            }
        }
    }
}

/// One zone where it is.
struct Zone<'a> {
    vertices: &'a [u32],
    x: &'a [Vec3],
    lightness: &'a [f64],
    mass: f64,
    centre: Vec3,
    /// Inverse of the inertia about the centre [1/(kg m2)].
    inverse: Matrix3<f64>,
}

impl<'a> Zone<'a> {
    fn new(vertices: &'a [u32], x: &'a [Vec3], lightness: &'a [f64]) -> Self {
        let mut mass = 0.0;
        let mut centre = Vec3::zeros();
        for &v in vertices {
            mass += 1.0 / lightness[v as usize];
            centre += x[v as usize] / lightness[v as usize];
        }
        centre /= mass;
        let mut inertia = Matrix3::zeros();
        for &v in vertices {
            let arm = x[v as usize] - centre;
            let square = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            inertia += square / lightness[v as usize];
        }
        let mut principal = inertia.symmetric_eigen();
        let largest = principal.eigenvalues.max();
        for moment in principal.eigenvalues.iter_mut() {
            *moment = if *moment > LINE * largest {
                1.0 / *moment
            } else {
                0.0
            };
        }
        Self {
            vertices,
            x,
            lightness,
            mass,
            centre,
            inverse: principal.recompose(),
        }
    }

    /// Shift and turn with the momenta of some moves.
    fn rigid(&self, moves: &[Vec3]) -> [Vec3; 2] {
        let (mut momentum, mut moment) = (Vec3::zeros(), Vec3::zeros());
        for &v in self.vertices {
            let part = moves[v as usize] / self.lightness[v as usize];
            momentum += part;
            moment += (self.x[v as usize] - self.centre).cross(&part);
        }
        [momentum / self.mass, self.inverse * moment]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Both momenta are kept, and no two points of a zone come nearer.
        #[test]
        fn zones_keep_momentum_and_distance(
            numbers in prop::array::uniform32(-1.0..1.0f64),
            masses in prop::array::uniform5(0.1..3.0f64),
            flat in any::<bool>(),
        ) {
            let v = |k: usize| Vec3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
            // On a line the inertia has no inverse.
            let x: Vec<Vec3> = (0..5).map(|k| if flat { Vec3::x() * v(k).x } else { v(k) }).collect();
            let mut moves: Vec<Vec3> = (5..10).map(|k| v(k) * 0.005).collect();
            let mut velocities: Vec<Vec3> = moves.iter().map(|d| d * 7.0).collect();
            let lightness: Vec<f64> = masses.iter().map(|m| 1.0 / m).collect();
            let momenta = |moves: &[Vec3]| {
                let each = || moves.iter().zip(&masses).zip(&x);
                let shift: Vec3 = each().map(|((d, m), _)| d * *m).sum();
                let turn: Vec3 = each().map(|((d, m), x)| x.cross(d) * *m).sum();
                [shift, turn]
            };
            let before = momenta(&moves);
            let start = moves.clone();
            let mut zones = Zones::new(5);
            zones.join([0, 1, 2, 3], &lightness);
            zones.join([3, 4, 3, 4], &lightness);
            prop_assert_eq!(zones.count(), 5);
            zones.stiffen(&mut Motions {
                x: &x,
                moves: &mut moves,
                velocities: &mut velocities,
                lightness: &lightness,
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
                    let apart = (x[i] - x[j]).norm();
                    let then = (x[i] + moves[i] - x[j] - moves[j]).norm();
                    prop_assert!(then >= apart * (1.0 - 1e-12) && then <= apart * 1.006);
                }
            }
        }
    }

    #[test]
    fn zones_are_joined_and_pins_join_none() {
        let lightness = [1.0, 1.0, 1.0, 0.0, 1.0, 1.0];
        let mut zones = Zones::new(6);
        zones.join([5, 3, 4, 5], &lightness);
        zones.join([0, 1, 3, 3], &lightness);
        assert_eq!(zones.groups(), vec![vec![0, 1], vec![4, 5]]);
        zones.join([1, 4, 2, 2], &lightness);
        assert_eq!(zones.groups(), vec![vec![0, 1, 2, 4, 5]]);
    }
}
