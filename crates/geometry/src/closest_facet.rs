//! Which of some triangles is closest to each of eight points, found for all eight at once.

use crate::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// Points worked on at once.
pub const LANES: usize = 8;

/// Coordinates of eight points, axis by axis (m).
pub type Points = [[f64; LANES]; 3];

/// Height of a triangle by its longest side below which it counts as its sides alone: its normal is
/// not well known, and above its middle the sides are hardly farther.
const NEEDLE: f64 = 1e-6;

/// A triangle, prepared for measuring distances from it.
#[derive(Clone, Copy)]
pub struct Facet {
    corners: [Vec3; 3],
    /// From each corner to the next, and one over their squared lengths, zero where there is none.
    sides: [Vec3; 3],
    shares: [f64; 3],
    /// Along the face from each side to its inside.
    inward: [Vec3; 3],
    normal: Vec3,
    /// Whether it counts as more than its sides: 1 or 0.
    has_face: f64,
}

impl Facet {
    /// Prepares a triangle.
    pub fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        let sides = [b - a, c - b, a - c];
        let squares = sides.map(|side| side.norm_squared());
        let longest = squares.into_iter().fold(0.0, f64::max);
        let across = sides[0].cross(&sides[1]);
        let normal = across.try_normalize(NEEDLE * longest);
        let direction = normal.unwrap_or_default();
        Self {
            corners,
            sides,
            shares: squares.map(|square| if square > 0.0 { 1.0 / square } else { 0.0 }),
            inward: sides.map(|side| direction.cross(&side)),
            normal: direction,
            has_face: f64::from(u8::from(normal.is_some())),
        }
    }

    /// Squared distances of eight points (m2): that from the plane where a point lies over the
    /// face, else that from the nearest side.
    #[inline(always)]
    fn squared_distances(&self, points: &Points) -> [f64; LANES] {
        let mut squares = [0.0; LANES];
        for (lane, square) in squares.iter_mut().enumerate() {
            let point = [points[0][lane], points[1][lane], points[2][lane]];
            let mut least = f64::INFINITY;
            let mut over = self.has_face;
            for k in 0..3 {
                let (corner, side) = (self.corners[k], self.sides[k]);
                let (x, y, z) = (
                    point[0] - corner.x,
                    point[1] - corner.y,
                    point[2] - corner.z,
                );
                let along = (side.x * x + side.y * y + side.z * z) * self.shares[k];
                let along = if along > 0.0 { along } else { 0.0 };
                let along = if along < 1.0 { along } else { 1.0 };
                let (u, v, w) = (x - side.x * along, y - side.y * along, z - side.z * along);
                let from_side = u * u + v * v + w * w;
                least = if from_side < least { from_side } else { least };
                let inward = self.inward[k];
                let inside = inward.x * x + inward.y * y + inward.z * z;
                over = if inside >= 0.0 { over } else { 0.0 };
            }
            let (corner, n) = (self.corners[0], self.normal);
            let height = n.x * (point[0] - corner.x)
                + n.y * (point[1] - corner.y)
                + n.z * (point[2] - corner.z);
            *square = if over > 0.0 { height * height } else { least };
        }
        squares
    }
}

/// The number of the closest of some triangles for each point, the first where several are equally
/// close; 0 where there is none.
pub fn closest_facets(facets: &[Facet], among: &[u32], points: &Points) -> [u32; LANES] {
    struct Search<'a>(&'a [Facet], &'a [u32], &'a Points);
    impl WithSimd for Search<'_> {
        type Output = [u32; LANES];
        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) -> Self::Output {
            let Search(facets, among, points) = self;
            let mut least = [f64::INFINITY; LANES];
            let mut closest = [0; LANES];
            for &at in among {
                let squares = facets[at as usize].squared_distances(points);
                for lane in 0..LANES {
                    let closer = squares[lane] < least[lane];
                    least[lane] = if closer { squares[lane] } else { least[lane] };
                    closest[lane] = if closer { at } else { closest[lane] };
                }
            }
            closest
        }
    }
    Arch::new().dispatch(Search(facets, among, points))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closest_point_on_triangle;

    /// Numbers from -1 to 1 that look random.
    fn number(seed: usize) -> f64 {
        (seed as f64 * 12.9898).sin() * 43758.5453 % 1.0
    }

    fn place(seed: usize) -> Vec3 {
        Vec3::new(number(seed), number(seed + 1), number(seed + 2))
    }

    #[test]
    fn distances_are_those_of_the_closest_points() {
        let mut facets: Vec<[Vec3; 3]> = (0..200)
            .map(|k| [0, 3, 6].map(|at| place(9 * k + at)))
            .collect();
        let (a, b) = (place(5000), place(5003));
        facets.push([a, b, a + (b - a) * 0.3]);
        facets.push([a, b, b]);
        facets.push([a; 3]);
        facets.push([a, b, a + (b - a) * 0.4 + Vec3::x() * 1e-9]);
        for (k, corners) in facets.into_iter().enumerate() {
            let mut points = [[0.0; LANES]; 3];
            let all: [Vec3; LANES] = std::array::from_fn(|lane| 1.5 * place(7001 + 31 * k + lane));
            for (lane, point) in all.iter().enumerate() {
                (0..3).for_each(|axis| points[axis][lane] = point[axis]);
            }
            let found = Facet::new(corners).squared_distances(&points);
            for (point, square) in all.iter().zip(found) {
                let (w, _) = closest_point_on_triangle(*point, corners);
                let at = corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
                let exact = (point - at).norm();
                assert!((square.sqrt() - exact).abs() < 1e-9, "{corners:?} {point}");
            }
        }
    }

    #[test]
    fn the_closest_is_found_for_each_point_and_the_first_of_equals() {
        let low = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let high = low.map(|p| p + Vec3::z());
        let facets = [low, high, low, high].map(Facet::new);
        let mut points = [[0.2; LANES]; 3];
        points[2] = std::array::from_fn(|lane| 0.2 * lane as f64 - 0.2);
        let expected = points[2].map(|z| u32::from(z > 0.5));
        assert_eq!(closest_facets(&facets, &[0, 1, 2, 3], &points), expected);
        assert_eq!(
            closest_facets(&facets, &[2, 3], &points),
            expected.map(|k| k + 2)
        );
        assert_eq!(closest_facets(&facets, &[], &points), [0; LANES]);
    }
}
