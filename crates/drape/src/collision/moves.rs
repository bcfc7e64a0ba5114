//! Deviation of the vertices of a region from their common rigid motion.
//!
//! The common motion is the linear map x -> x + t + w x (x - c) of a shift t and a turn w, fitted to the
//! displacements in the mean of squares. All singular values of `1 + [w]` are 1 or more, on any share of the motion
//! too: the map brings no two points nearer. It has an inverse, so nothing crosses by it. Two vertices that deviate
//! from it by at most r therefore come nearer to each other by at most 2 r.

use super::boxes::{Bounds, Region};
use super::surface_view::SurfaceView;
use super::trajectories::LinearTrajectories;
use toile_geometry::Vec3;

/// A region whose displacements deviate from a common shift by no more than this (m) is used with that deviation,
/// without a turn. Where the displacements of all the cloth together deviate from one shift by no more than
/// `NEGLIGIBLE_IN_ALL` (m), no turns are fitted at all.
const NEGLIGIBLE: f64 = 3e-4;
const NEGLIGIBLE_IN_ALL: f64 = 2e-3;

/// Points count as collinear, and no turn is fitted to them, where the determinant of their inertia is below this
/// share of the cube of its trace.
const COLLINEAR: f64 = 1e-9;

/// Displacements of the vertices below every node of the tree, as bounds and as a common rigid motion.
#[derive(Debug)]
pub struct Moves {
    /// Bounds of the displacements below each node (m).
    bounds: Vec<Bounds>,
    /// Common motion of each node; empty where only shifts are taken out.
    common: Vec<CommonMotion>,
}

/// Sums over some vertices that a rigid motion is fitted from.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    /// Sum of the positions x (m).
    positions: Vec3,
    /// Sum of the displacements d (m).
    displacements: Vec3,
    /// Sums of the squares x^2, y^2, z^2 and of the products yz, zx, xy of the positions (m2).
    squares: [Vec3; 2],
    /// Sum of the cross products x x d (m2).
    moments: Vec3,
}

impl Sums {
    fn add(&mut self, x: Vec3, d: Vec3) {
        self.count += 1.0;
        self.positions += x;
        self.displacements += d;
        self.squares[0] += x.component_mul(&x);
        self.squares[1] += Vec3::new(x.y * x.z, x.z * x.x, x.x * x.y);
        self.moments += x.cross(&d);
    }

    fn join(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            positions: self.positions + other.positions,
            displacements: self.displacements + other.displacements,
            squares: [0, 1].map(|k| self.squares[k] + other.squares[k]),
            moments: self.moments + other.moments,
        }
    }

    /// The shift and turn that fit the displacements best in the mean of squares; no turn for collinear points.
    fn motion(&self) -> RigidMotion {
        let (centre, shift) = (self.positions / self.count, self.displacements / self.count);
        let positions = self.positions;
        let spread = self.squares[0] - centre.component_mul(&positions);
        let [a, b, c] = [
            spread.y + spread.z,
            spread.z + spread.x,
            spread.x + spread.y,
        ];
        let products = Vec3::new(
            positions.y * centre.z,
            positions.z * centre.x,
            positions.x * centre.y,
        );
        let [d, e, f] = (products - self.squares[1]).into();
        let moment = self.moments - centre.cross(&self.displacements);
        // The inertia [[a, f, e], [f, b, d], [e, d, c]] is inverted by its cofactors.
        let rows = [
            Vec3::new(b * c - d * d, d * e - c * f, f * d - b * e),
            Vec3::new(d * e - c * f, a * c - e * e, e * f - a * d),
            Vec3::new(f * d - b * e, e * f - a * d, a * b - f * f),
        ];
        let determinant = a * rows[0].x + f * rows[0].y + e * rows[0].z;
        let turn = Vec3::from(rows.map(|row| row.dot(&moment))) / determinant;
        let known = determinant > COLLINEAR * (a + b + c).powi(3) && turn.norm().is_finite();
        RigidMotion {
            centre,
            shift,
            turn: if known { turn } else { Vec3::zeros() },
        }
    }
}

/// Rigid motion to first order in the turn: x -> x + shift + turn x (x - centre).
#[derive(Clone, Copy, Debug)]
struct RigidMotion {
    centre: Vec3,
    shift: Vec3,
    turn: Vec3,
}

impl RigidMotion {
    /// Displacement of a point (m).
    fn at(&self, x: Vec3) -> Vec3 {
        self.shift + self.turn.cross(&(x - self.centre))
    }
}

/// Common rigid motion of the vertices below a node.
#[derive(Clone, Copy, Debug)]
struct CommonMotion {
    sums: Sums,
    motion: RigidMotion,
    /// Largest distance of a vertex from the centre of the motion (m).
    radius: f64,
    /// Largest deviation of a displacement from the motion (m).
    deviation: f64,
}

impl CommonMotion {
    /// Upper bound of the deviation from another motion (m). Two motions differ at a point by their difference at
    /// the centre and the difference of their turns times the distance from it.
    fn deviation_from(&self, motion: &RigidMotion) -> f64 {
        let centre = self.motion.centre;
        let shifted = (motion.at(centre) - self.motion.shift).norm();
        let turned = (motion.turn - self.motion.turn).norm();
        self.deviation + shifted + turned * self.radius
    }

    /// Common motion of the vertices of both nodes.
    fn join(&self, other: &Self) -> Self {
        let sums = self.sums.join(&other.sums);
        let motion = sums.motion();
        let both = [self, other];
        let radius_of = |c: &Self| (c.motion.centre - motion.centre).norm() + c.radius;
        Self {
            sums,
            motion,
            radius: both.map(radius_of).into_iter().fold(0.0, f64::max),
            deviation: both
                .map(|c| c.deviation_from(&motion))
                .into_iter()
                .fold(0.0, f64::max),
        }
    }
}

impl Moves {
    /// Displacements on some trajectories; none where nothing moves.
    pub fn of(trajectories: &LinearTrajectories, cloth: &SurfaceView) -> Option<Self> {
        let (from, to) = (trajectories.from, trajectories.to);
        let displacement = |v: u32| to[v as usize] - from[v as usize];
        (!trajectories.are_still()).then(|| match trajectories.together {
            true => Self::new(cloth, from, displacement),
            false => Self::shifts(cloth, displacement).with_stops(),
        })
    }

    /// Displacements from positions `x`, in a straight line and all in step.
    pub fn new(cloth: &SurfaceView, x: &[Vec3], displacement: impl Fn(u32) -> Vec3 + Sync) -> Self {
        let mut moves = Self::shifts(cloth, &displacement);
        let is_large = |bounds: &Bounds| bounds.radius() > NEGLIGIBLE_IN_ALL;
        if !moves.bounds.first().is_some_and(is_large) {
            return moves;
        }
        let of_leaf = |leaf: usize| {
            let vertices = || {
                let leaf = cloth.leaf(leaf).iter();
                leaf.map(|&v| (x[v as usize], displacement(v)))
            };
            let mut sums = Sums::default();
            vertices().for_each(|(x, d)| sums.add(x, d));
            let motion = sums.motion();
            let (mut radius, mut deviation) = (0.0, 0.0);
            for (x, d) in vertices() {
                radius = (x - motion.centre).norm_squared().max(radius);
                deviation = (d - motion.at(x)).norm_squared().max(deviation);
            }
            CommonMotion {
                sums,
                motion,
                radius: f64::sqrt(radius),
                deviation: f64::sqrt(deviation),
            }
        };
        moves.common = cloth.tree.reduced(of_leaf, CommonMotion::join);
        moves
    }

    /// Vectors of the vertices (displacements, or velocities) of which only a common shift is taken out.
    pub fn shifts(cloth: &SurfaceView, vector: impl Fn(u32) -> Vec3 + Sync) -> Self {
        let of_leaf = |leaf: usize| Bounds::of_all(cloth.leaf(leaf).iter().map(|&v| vector(v)));
        Self {
            bounds: cloth.tree.reduced(of_leaf, Bounds::join),
            common: Vec::new(),
        }
    }

    /// The same displacements where any vertex may stop before its end.
    fn with_stops(mut self) -> Self {
        let zero = Bounds::of(&[Vec3::zeros()], 0.0);
        for bounds in &mut self.bounds {
            *bounds = bounds.join(&zero);
        }
        self.common.clear();
        self
    }

    /// Largest deviation of the vertices of a region from a common rigid motion (m); infinite where a displacement
    /// is not finite.
    pub fn deviation(&self, region: &Region) -> f64 {
        let bounds = |index: u32| &self.bounds[index as usize];
        let from_shift = match *region {
            Region::Own(a) => bounds(a.index).radius(),
            Region::Two(a, b) => bounds(a.index).join(bounds(b.index)).radius(),
        };
        if from_shift <= NEGLIGIBLE || self.common.is_empty() || !from_shift.is_finite() {
            return from_shift;
        }
        let common = |index: u32| &self.common[index as usize];
        let from_turn = match *region {
            Region::Own(a) => common(a.index).deviation,
            Region::Two(a, b) => {
                let motion = common(a.index).sums.join(&common(b.index).sums).motion();
                let deviation = |index: u32| common(index).deviation_from(&motion);
                deviation(a.index).max(deviation(b.index))
            }
        };
        from_turn.min(from_shift)
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::Numbers;
    use super::*;

    fn motion_of(points: &[Vec3], displacement: impl Fn(Vec3) -> Vec3) -> RigidMotion {
        let mut sums = Sums::default();
        points.iter().for_each(|&x| sums.add(x, displacement(x)));
        sums.motion()
    }

    #[test]
    fn a_rigid_motion_is_recovered_and_collinear_points_give_no_turn() {
        let mut numbers = Numbers(1);
        let mut vector = |size: f64| numbers.vector(0.5 * size);
        for _ in 0..100 {
            let (centre, shift, turn) = (vector(2.0), vector(0.01), vector(0.1));
            let rigid = |x: Vec3| shift + turn.cross(&(x - centre));
            let points: Vec<Vec3> = (0..12).map(|_| centre + vector(0.02)).collect();
            let motion = motion_of(&points, rigid);
            for x in points {
                assert!((motion.at(x) - rigid(x)).norm() < 1e-9);
            }
            let along = vector(1.0);
            let line: Vec<Vec3> = (0..12).map(|k| centre + along * f64::from(k)).collect();
            assert_eq!(motion_of(&line, rigid).turn, Vec3::zeros());
        }
        let unknown = motion_of(&[Vec3::repeat(f64::NAN)], |x| x);
        assert_eq!(unknown.turn, Vec3::zeros());
    }
}
