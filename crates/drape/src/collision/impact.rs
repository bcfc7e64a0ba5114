//! Continuous collision detection of a vertex and a face and of two edges, with vertices on straight trajectories.
//!
//! The method is directional advancement. At time t the closest points of the two features give a unit direction n.
//! The features cannot collide while every vertex of one lies beyond every vertex of the other along n, and each of
//! these gaps is linear in time:
//! ```text
//! g_ij(t) = n . (b_j(t) - a_i(t)) > gap + error,  all i, j
//! ```
//! So the motion is safe up to the first root t', where the closest points are computed again. Where n separates no
//! longer, or the distance is within rounding, the features collide. This is conservative advancement (Mirtich 1996;
//! additive: Li et al. 2021) with a bound by direction instead of by the largest speed: a head-on collision takes two
//! iterations, not dozens. Only the gaps decide, so the result is safe whatever the rounding of the closest points.

use toile_geometry::{Vec3, closest_on_face, closest_on_segments};

/// Number of iterations after which a motion, as of features that graze each other, is taken as a collision.
const MAX_ITERATIONS: usize = 256;

/// Bound of the rounding error of a gap, as a multiple of the largest coordinate times the 1-norm of the direction:
/// twenty roundings.
const ROUNDING: f64 = 20.0 * f64::EPSILON / 2.0;

/// First time in 0..=1 at which a vertex (the first of the four) comes within `gap` (m) of a face (the other three);
/// none where it certainly does not. The time is never late, and early only by rounding.
pub fn vertex_face_impact(start: &[Vec3; 4], end: &[Vec3; 4], gap: f64) -> Option<f64> {
    advance(
        start,
        end,
        gap,
        |[p, a, b, c]| {
            let w = closest_on_face(*p, [*a, *b, *c]);
            a * w[0] + b * w[1] + c * w[2] - p
        },
        &[[0, 1], [0, 2], [0, 3]],
    )
}

/// [`vertex_face_impact`] for an edge (the first two vertices) and another (the last two).
pub fn edge_edge_impact(start: &[Vec3; 4], end: &[Vec3; 4], gap: f64) -> Option<f64> {
    advance(
        start,
        end,
        gap,
        |[a, b, c, d]| {
            let [s, t] = closest_on_segments([*a, *b], [*c, *d]);
            c + (d - c) * t - (a + (b - a) * s)
        },
        &[[0, 2], [0, 3], [1, 2], [1, 3]],
    )
}

/// Advances to the time of impact. `between` gives the vector between the closest points of the two features, `pairs`
/// the vertices of one with those of the other.
#[inline(always)]
fn advance<const N: usize>(
    start: &[Vec3; 4],
    end: &[Vec3; 4],
    gap: f64,
    between: impl Fn(&[Vec3; 4]) -> Vec3,
    pairs: &[[usize; 2]; N],
) -> Option<f64> {
    let largest = |points: &[Vec3; 4]| points.iter().map(Vec3::amax).fold(0.0, f64::max);
    let scale = largest(start).max(largest(end));
    if !scale.is_finite() {
        return Some(0.0);
    }
    let mut time = 0.0;
    let mut now = *start;
    for _ in 0..MAX_ITERATIONS {
        let vector = between(&now);
        let distance = vector.norm();
        let n = vector / distance;
        let least_gap = gap + ROUNDING * scale * (n.x.abs() + n.y.abs() + n.z.abs());
        // NaN: the distance is zero, and n undefined.
        if distance <= least_gap || distance.is_nan() || least_gap.is_nan() {
            return Some(time);
        }
        let mut safe = f64::INFINITY;
        for &[i, j] in pairs {
            let at_start = n.dot(&(start[j] - start[i]));
            let at_end = n.dot(&(end[j] - end[i]));
            if at_start + (at_end - at_start) * time <= least_gap {
                return Some(time);
            }
            if at_end <= least_gap {
                safe = f64::min(safe, (at_start - least_gap) / (at_start - at_end));
            }
        }
        if safe > 1.0 {
            return None;
        }
        if safe <= time {
            return Some(time);
        }
        time = safe;
        for (p, (a, b)) in now.iter_mut().zip(start.iter().zip(end)) {
            *p = a + (b - a) * time;
        }
    }
    Some(time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FACE: [Vec3; 3] = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(0.0, 0.0, 1.0),
    ];

    fn over(p: Vec3) -> [Vec3; 4] {
        [p, FACE[0], FACE[1], FACE[2]]
    }

    #[test]
    fn a_vertex_that_falls_onto_a_face_and_one_that_falls_past_it() {
        let fall = |x: f64, gap: f64| {
            let (from, to) = (Vec3::new(x, 1.0, 0.2), Vec3::new(x, -1.0, 0.2));
            vertex_face_impact(&over(from), &over(to), gap)
        };
        assert!((fall(0.2, 0.0).unwrap() - 0.5).abs() < 1e-12);
        assert!((fall(0.2, 0.1).unwrap() - 0.45).abs() < 1e-12);
        assert_eq!(fall(-1e-9, 0.0), None);
        assert!(fall(-1e-9, 1e-8).is_some());
    }

    #[test]
    fn degenerate_features_and_nan_collide_at_once() {
        let p = Vec3::new(0.3, 0.4, 0.5);
        let same = [p; 4];
        assert_eq!(vertex_face_impact(&same, &same, 0.0), Some(0.0));
        assert_eq!(edge_edge_impact(&same, &same, 0.0), Some(0.0));
        let nan = [Vec3::repeat(f64::NAN); 4];
        assert_eq!(vertex_face_impact(&nan, &same, 0.0), Some(0.0));
        // Parallel edges that pass by each other, then two that collide.
        let rod = |y: f64, x: f64| [Vec3::new(x, y, 0.0), Vec3::new(x, y, 1.0)];
        let both = |a: [Vec3; 2], b: [Vec3; 2]| [a[0], a[1], b[0], b[1]];
        let start = both(rod(0.0, 0.0), rod(0.1, -1.0));
        assert_eq!(
            edge_edge_impact(&start, &both(rod(0.0, 0.0), rod(0.1, 1.0)), 0.0),
            None
        );
        let hit = edge_edge_impact(&start, &both(rod(0.0, 0.0), rod(-0.1, 1.0)), 0.0).unwrap();
        assert!((hit - 0.5).abs() < 1e-9, "{hit}");
    }

    proptest! {
        /// A collision constructed at a known time is found, and not later than that.
        #[test]
        fn a_collision_at_a_known_time_is_found(
            numbers in prop::array::uniform24(-1.0..1.0f64),
            w in [0.0..1.0f64, 0.0..1.0],
            when in 0.0..1.0f64,
            edges in any::<bool>(),
        ) {
            let v = |k: usize| Vec3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
            let mut start = [v(0), v(1), v(2), v(3)];
            let mut end = [v(4), v(5), v(6), v(7)];
            let at = |k: usize, start: &[Vec3; 4], end: &[Vec3; 4]| start[k] + (end[k] - start[k]) * when;
            let x = [0, 1, 2, 3].map(|k| at(k, &start, &end));
            let miss = if edges {
                x[2] + (x[3] - x[2]) * w[1] - (x[0] + (x[1] - x[0]) * w[0])
            } else {
                x[1] + (x[2] - x[1]) * w[0] + (x[3] - x[2]) * (w[0] * w[1]) - x[0]
            };
            let first = if edges { 0..2 } else { 0..1 };
            for k in first {
                start[k] += miss;
                end[k] += miss;
            }
            // Rounding of the construction.
            let gap = 1e-14;
            let found = if edges {
                edge_edge_impact(&start, &end, gap)
            } else {
                vertex_face_impact(&start, &end, gap)
            };
            prop_assert!(found.is_some_and(|t| t <= when + 1e-9), "{found:?} {when}");
        }
    }
}
