//! How far the vertices of regions stray from a motion that they have in common: a shift and a turn.
//!
//! The common motion is linear, x -> x + t + w x (x - c). With all singular values 1 or more, 1 + [w]
//! brings nothing nearer to anything (nor does any part of the way), and as it can be undone nothing
//! crosses by it: what strays by r from it comes nearer by 2 r at the most.

use super::boxes::{Bounds, Region};
use super::surface_view::SurfaceView;
use super::trajectories::LinearTrajectories;
use toile_geometry::Vec3;

/// Regions that stray less than this are asked for no turn [m], and where all the cloth strays less than
/// that, none is.
const LITTLE: f64 = 3e-4;
const LITTLE_IN_ALL: f64 = 2e-3;

/// Places whose moments of inertia have a product below this share of the cube of their sum lie in a line,
/// and tell no turn.
const STRAIGHT: f64 = 1e-9;

/// Moves of the vertices below every node.
#[derive(Debug)]
pub struct Moves {
    /// Boxes round them.
    round: Vec<Bounds>,
    /// What the nodes have in common; nothing where only a shift counts.
    common: Vec<Common>,
}

/// Sums over some vertices.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    places: Vec3,
    moves: Vec3,
    /// Squares x^2, y^2, z^2 and products yz, zx, xy of the places [m2].
    squares: [Vec3; 2],
    /// Cross products of places and moves [m2].
    moments: Vec3,
}

impl Sums {
    fn add(&mut self, x: Vec3, d: Vec3) {
        self.count += 1.0;
        self.places += x;
        self.moves += d;
        self.squares[0] += x.component_mul(&x);
        self.squares[1] += Vec3::new(x.y * x.z, x.z * x.x, x.x * x.y);
        self.moments += x.cross(&d);
    }

    fn join(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            places: self.places + other.places,
            moves: self.moves + other.moves,
            squares: [0, 1].map(|k| self.squares[k] + other.squares[k]),
            moments: self.moments + other.moments,
        }
    }

    /// The shift and turn nearest to the moves, in the mean of squares.
    fn motion(&self) -> Motion {
        let (centre, shift) = (self.places / self.count, self.moves / self.count);
        let places = self.places;
        let spread = self.squares[0] - centre.component_mul(&places);
        let [a, b, c] = [
            spread.y + spread.z,
            spread.z + spread.x,
            spread.x + spread.y,
        ];
        let products = Vec3::new(
            places.y * centre.z,
            places.z * centre.x,
            places.x * centre.y,
        );
        let [d, e, f] = (products - self.squares[1]).into();
        let moment = self.moments - centre.cross(&self.moves);
        // The inertia [[a, f, e], [f, b, d], [e, d, c]] is undone by its cofactors.
        let rows = [
            Vec3::new(b * c - d * d, d * e - c * f, f * d - b * e),
            Vec3::new(d * e - c * f, a * c - e * e, e * f - a * d),
            Vec3::new(f * d - b * e, e * f - a * d, a * b - f * f),
        ];
        let determinant = a * rows[0].x + f * rows[0].y + e * rows[0].z;
        let turn = Vec3::from(rows.map(|row| row.dot(&moment))) / determinant;
        let known = determinant > STRAIGHT * (a + b + c).powi(3) && turn.norm().is_finite();
        Motion {
            centre,
            shift,
            turn: if known { turn } else { Vec3::zeros() },
        }
    }
}

/// x -> x + shift + turn x (x - centre).
#[derive(Clone, Copy, Debug)]
struct Motion {
    centre: Vec3,
    shift: Vec3,
    turn: Vec3,
}

impl Motion {
    fn at(&self, x: Vec3) -> Vec3 {
        self.shift + self.turn.cross(&(x - self.centre))
    }
}

/// What the vertices below a node have in common.
#[derive(Clone, Copy, Debug)]
struct Common {
    sums: Sums,
    motion: Motion,
    /// How far a vertex is from the centre of the motion at the most [m].
    radius: f64,
    /// How far its move is from that motion at the most [m].
    rest: f64,
}

impl Common {
    /// How far the moves are from another motion at the most [m].
    fn rest_from(&self, motion: &Motion) -> f64 {
        let centre = self.motion.centre;
        let shifted = (motion.at(centre) - self.motion.shift).norm();
        let turned = (motion.turn - self.motion.turn).norm();
        self.rest + shifted + turned * self.radius
    }

    /// What two have in common.
    fn join(&self, other: &Self) -> Self {
        let sums = self.sums.join(&other.sums);
        let motion = sums.motion();
        let both = [self, other];
        let from = |c: &Self| (c.motion.centre - motion.centre).norm() + c.radius;
        Self {
            sums,
            motion,
            radius: both.map(from).into_iter().fold(0.0, f64::max),
            rest: both
                .map(|c| c.rest_from(&motion))
                .into_iter()
                .fold(0.0, f64::max),
        }
    }
}

impl Moves {
    /// The moves of some trajectories; nothing where nothing moves.
    pub fn of(trajectories: &LinearTrajectories, cloth: &SurfaceView) -> Option<Self> {
        let (from, to) = (trajectories.from, trajectories.to);
        let way = |v: u32| to[v as usize] - from[v as usize];
        (!trajectories.are_still()).then(|| match trajectories.together {
            true => Self::new(cloth, from, way),
            false => Self::shifts(cloth, way).or_less(),
        })
    }

    /// From some places by some moves, straight and at one pace.
    pub fn new(cloth: &SurfaceView, x: &[Vec3], of: impl Fn(u32) -> Vec3 + Sync) -> Self {
        let mut moves = Self::shifts(cloth, &of);
        let far = |bounds: &Bounds| bounds.radius() > LITTLE_IN_ALL;
        if !moves.round.first().is_some_and(far) {
            return moves;
        }
        let of_leaf = |leaf: usize| {
            let vertices = || cloth.leaf(leaf).iter().map(|&v| (x[v as usize], of(v)));
            let mut sums = Sums::default();
            vertices().for_each(|(x, d)| sums.add(x, d));
            let motion = sums.motion();
            let (mut radius, mut rest) = (0.0, 0.0);
            for (x, d) in vertices() {
                radius = (x - motion.centre).norm_squared().max(radius);
                rest = (d - motion.at(x)).norm_squared().max(rest);
            }
            Common {
                sums,
                motion,
                radius: f64::sqrt(radius),
                rest: f64::sqrt(rest),
            }
        };
        moves.common = cloth.tree.folded(of_leaf, Common::join);
        moves
    }

    /// Shifts alone.
    pub fn shifts(cloth: &SurfaceView, of: impl Fn(u32) -> Vec3 + Sync) -> Self {
        let of_leaf = |leaf: usize| Bounds::round_all(cloth.leaf(leaf).iter().map(|&v| of(v)));
        Self {
            round: cloth.tree.folded(of_leaf, Bounds::join),
            common: Vec::new(),
        }
    }

    /// The same where any may stop on its way.
    pub fn or_less(mut self) -> Self {
        let still = Bounds::round(&[Vec3::zeros()], 0.0);
        for round in &mut self.round {
            *round = round.join(&still);
        }
        self.common.clear();
        self
    }

    /// How far the vertices of a region stray from a motion that they have in common, at the most [m].
    pub fn stray(&self, region: &Region) -> f64 {
        let round = |at: u32| &self.round[at as usize];
        let shifted = match *region {
            Region::Own(a) => round(a.at).radius(),
            Region::Two(a, b) => round(a.at).join(round(b.at)).radius(),
        };
        // Where moves are no numbers they stray without end.
        if shifted <= LITTLE || self.common.is_empty() || !shifted.is_finite() {
            return shifted;
        }
        let common = |at: u32| &self.common[at as usize];
        let turned = match *region {
            Region::Own(a) => common(a.at).rest,
            Region::Two(a, b) => {
                let motion = common(a.at).sums.join(&common(b.at).sums).motion();
                let rest = |at: u32| common(at).rest_from(&motion);
                rest(a.at).max(rest(b.at))
            }
        };
        turned.min(shifted)
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::Numbers;
    use super::*;

    fn motion_of(places: &[Vec3], of: impl Fn(Vec3) -> Vec3) -> Motion {
        let mut sums = Sums::default();
        places.iter().for_each(|&x| sums.add(x, of(x)));
        sums.motion()
    }

    #[test]
    fn a_shift_and_a_turn_are_found_where_places_tell_them() {
        let mut numbers = Numbers(1);
        let mut vector = |size: f64| numbers.vector(0.5 * size);
        for _ in 0..100 {
            let (centre, shift, turn) = (vector(2.0), vector(0.01), vector(0.1));
            let rigid = |x: Vec3| shift + turn.cross(&(x - centre));
            let places: Vec<Vec3> = (0..12).map(|_| centre + vector(0.02)).collect();
            let motion = motion_of(&places, rigid);
            for x in places {
                assert!((motion.at(x) - rigid(x)).norm() < 1e-9);
            }
            let along = vector(1.0);
            let line: Vec<Vec3> = (0..12).map(|k| centre + along * f64::from(k)).collect();
            assert_eq!(motion_of(&line, rigid).turn, Vec3::zeros());
        }
        let nowhere = motion_of(&[Vec3::repeat(f64::NAN)], |x| x);
        assert_eq!(nowhere.turn, Vec3::zeros());
    }
}
