//! Closest points and distance of two features, and cheap conservative tests that discard distant pairs.

use super::feature_pair::FeaturePair;
use toile_geometry::{Vec3, closest_on_face, closest_on_segments};

/// The closest points of two features: their distance is n . sum w_i x_i, and the weights sum to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearness {
    /// The features.
    pub pair: FeaturePair,
    /// Weight of each of the four vertices, negative for those of the second feature.
    pub weights: [f64; 4],
    /// Unit vector from the second feature to the first.
    pub normal: Vec3,
    /// Distance (m).
    pub distance: f64,
    /// Whether the features belong to triangles that share a vertex and are not folded against each other by more
    /// than a right angle.
    pub neighbours: bool,
}

/// Barycentric weights of the closest points of two features, negative for the second feature; `p` are the positions
/// of the four vertices (m).
pub fn closest(pair: FeaturePair, p: &[Vec3; 4]) -> [f64; 4] {
    match pair {
        FeaturePair::VertexFace(_) => {
            let w = closest_on_face(p[0], [p[1], p[2], p[3]]);
            [1.0, -w[0], -w[1], -w[2]]
        }
        FeaturePair::EdgeEdge(_) => {
            let [s, t] = closest_on_segments([p[0], p[1]], [p[2], p[3]]);
            [1.0 - s, s, t - 1.0, -t]
        }
    }
}

/// Distance below which the unit vector between the features is not defined (m): it would be rounding.
const TOUCHING: f64 = 1e-12;

impl Nearness {
    /// Displacement of the first feature relative to the second at the closest points, between two positions (m).
    pub fn slid(&self, from: &[Vec3], to: &[Vec3]) -> Vec3 {
        let four = self.pair.vertices().into_iter().zip(self.weights);
        four.map(|(v, w)| (to[v as usize] - from[v as usize]) * w)
            .sum()
    }

    /// The closest points of two features at positions `x`; none where they are farther apart than `reach` (m) or
    /// touch, or where the closest point of an edge is one of its ends: vertex-face pairs cover those.
    pub fn measure(pair: FeaturePair, x: &[Vec3], reach: f64) -> Option<Self> {
        let p = pair.vertices().map(|v| x[v as usize]);
        match passes_by(pair, &p) {
            true => None,
            false => Self::measured(pair, &p, reach),
        }
    }

    /// [`Self::measure`] for a pair that fails `passes_by`, at the positions `p` of its vertices (m).
    pub fn measured(pair: FeaturePair, p: &[Vec3; 4], reach: f64) -> Option<Self> {
        if is_far(pair, p, reach) {
            return None;
        }
        let weights = closest(pair, p);
        if let FeaturePair::EdgeEdge(_) = pair
            && weights.contains(&0.0)
        {
            return None;
        }
        let between: Vec3 = p.iter().zip(weights).map(|(p, w)| p * w).sum();
        let distance = between.norm();
        (distance <= reach && distance > TOUCHING).then(|| Self {
            pair,
            weights,
            normal: between / distance,
            distance,
            neighbours: false,
        })
    }

    /// Distance of two features at positions `x` (m).
    pub fn distance(pair: FeaturePair, x: &[Vec3]) -> f64 {
        let p = pair.vertices().map(|v| x[v as usize]);
        match pair {
            FeaturePair::VertexFace(_) => {
                let w = closest_on_face(p[0], [p[1], p[2], p[3]]);
                (p[1] * w[0] + p[2] * w[1] + p[3] * w[2] - p[0]).norm()
            }
            FeaturePair::EdgeEdge(_) => {
                let [s, t] = closest_on_segments([p[0], p[1]], [p[2], p[3]]);
                (p[2] + (p[3] - p[2]) * t - p[0] - (p[1] - p[0]) * s).norm()
            }
        }
    }
}

/// Squared sine of the angle below which two edges, or two sides of a face, count as parallel: their cross product
/// is then rounding.
pub const PARALLEL: f64 = 1e-8;

/// Bound of the relative rounding error of the distance between two lines, or of a vertex from a plane, as a share
/// of the distance of the vertices it is computed from.
const ROUNDING: f64 = 1e-10;

/// Whether two features are certainly farther apart than `reach` (m): their axis-aligned boxes are, or the plane of
/// the face is from the vertex, or the lines of the two edges are from each other. False proves nothing.
#[inline(always)]
pub fn is_far(pair: FeaturePair, p: &[Vec3; 4], reach: f64) -> bool {
    let (low, high, other_low, other_high) = match pair {
        FeaturePair::VertexFace(_) => (
            p[0],
            p[0],
            p[1].inf(&p[2]).inf(&p[3]),
            p[1].sup(&p[2]).sup(&p[3]),
        ),
        FeaturePair::EdgeEdge(_) => (
            p[0].inf(&p[1]),
            p[0].sup(&p[1]),
            p[2].inf(&p[3]),
            p[2].sup(&p[3]),
        ),
    };
    if (0..3).any(|k| low[k] > other_high[k] + reach || other_low[k] > high[k] + reach) {
        return true;
    }
    let (sides, between) = match pair {
        FeaturePair::VertexFace(_) => ([p[2] - p[1], p[3] - p[1]], p[1] - p[0]),
        FeaturePair::EdgeEdge(_) => ([p[1] - p[0], p[3] - p[2]], p[2] - p[0]),
    };
    let across = sides[0].cross(&sides[1]);
    let square = across.norm_squared();
    let along = between.dot(&across);
    let reach = reach + ROUNDING * (between.x.abs() + between.y.abs() + between.z.abs());
    along * along > reach * reach * square
        && square > PARALLEL * sides[0].norm_squared() * sides[1].norm_squared()
}

/// Whether two edges that are not parallel have the closest point of their lines outside one of the edges. They then
/// make no contact. Nearly all neighbouring edges of a smooth sheet are such a pair.
#[inline(always)]
pub fn passes_by(pair: FeaturePair, p: &[Vec3; 4]) -> bool {
    let FeaturePair::EdgeEdge(_) = pair else {
        return false;
    };
    let (u, v, w) = (p[1] - p[0], p[3] - p[2], p[0] - p[2]);
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    let (uw, vw) = (u.dot(&w), v.dot(&w));
    let square = uu * vv - uv * uv;
    let (s, t) = (uv * vw - uw * vv, uu * vw - uv * uw);
    let inside = s > 0.0 && s < square && t > 0.0 && t < square;
    !inside && square > PARALLEL * uu * vv
}

#[cfg(test)]
mod tests {
    use super::super::numbers::Numbers;
    use super::*;

    #[test]
    fn far_pairs_are_far_even_where_edges_and_slivers_are_nearly_parallel() {
        let mut numbers = Numbers(1);
        let mut vector = |size: f64| numbers.vector(0.5 * size);
        let mut far = 0;
        for turn in [0.0, 1e-15, 1e-14, 1e-12, 1e-7, 1e-5, 1e-2] {
            for distance in [5e-6, 5e-5, 5e-4] {
                for _ in 0..2000 {
                    let (start, along) = (vector(2.0), vector(1.0).normalize() * 0.01);
                    let off = along.cross(&vector(1.0)).normalize() * distance;
                    let other = start + off + along * 0.3;
                    let end = other + along + vector(0.02 * turn);
                    let edges = [start, start + along, other, end];
                    let sliver = [start + along * 0.7 + off, start, end, other];
                    for (pair, p) in [
                        (FeaturePair::EdgeEdge([0, 1, 2, 3]), edges),
                        (FeaturePair::VertexFace([0, 1, 2, 3]), sliver),
                    ] {
                        let exact = Nearness::distance(pair, &p);
                        assert!(
                            !is_far(pair, &p, 1.000_001 * exact),
                            "{turn} {distance} {pair:?}"
                        );
                        far += usize::from(is_far(pair, &p, 0.5 * exact));
                    }
                }
            }
        }
        assert!(far > 1000, "{far}");
    }

    #[test]
    fn edges_pass_by_each_other_where_the_closest_point_is_an_end() {
        let mut numbers = Numbers(1);
        let mut vector = |size: f64| numbers.vector(0.5 * size);
        let pair = FeaturePair::EdgeEdge([0, 1, 2, 3]);
        let mut counts = [0; 2];
        for turn in [0.0, 1e-15, 1e-7, 1e-3, 1.0] {
            for _ in 0..2000 {
                let (start, along, other) = (vector(2.0), vector(1.0), vector(2.0));
                let end = other + along + vector(turn);
                let p = [start, start + along, other, end];
                let weights = closest(pair, &p);
                let least = weights.iter().fold(1.0, |least: f64, w| least.min(w.abs()));
                let passes = passes_by(pair, &p);
                assert!(least < 1e-7 || !passes, "{turn} {weights:?}");
                counts[usize::from(passes)] += 1;
            }
        }
        assert!(counts[0] > 2000 && counts[1] > 2000, "{counts:?}");
    }
}
