//! Continuous collision of a vertex with a face and of two edges, all corners moving straight.
//!
//! Directional advancement. At a time t the closest points of the two features give a unit
//! direction n. While every corner of one lies beyond every corner of the other along n they cannot
//! meet, and as the corners move straight, each of these gaps is linear in time:
//! ```text
//! g_ij(t) = n . (b_j(t) - a_i(t)) > gap + error,  all i, j
//! ```
//! So the motion is safe up to the first root t', where the closest points are looked up again. Where
//! nothing separates any more, or features are closer than rounding can tell, they have met.
//! Conservative advancement (Mirtich 1996; additive: Li et al. 2021) with the bound of the
//! direction instead of that of the largest speed: a head-on collision takes two looks, not dozens,
//! and the answer is safe whatever the rounding of the closest points, since only the gaps decide.

use toile_geometry::{Vec3, closest_on_face, closest_on_segments};

/// Looks before a motion that goes on grazing is called a collision.
const MOST_LOOKS: usize = 256;

/// Rounding of a gap, as a multiple of the largest coordinate times the 1-norm of the direction:
/// twenty roundings.
const ROUNDING: f64 = 20.0 * f64::EPSILON / 2.0;

/// First time in 0..=1 at which a vertex (the first of the four) may come within `gap` [m] of a face
/// (the others); none when it certainly does not. Never too late, and early by rounding only.
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

/// The same for an edge (the first two) and another (the last two).
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

/// Advances in time; `between` is the vector from one feature to the closest point of the other.
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
    for _ in 0..MOST_LOOKS {
        let vector = between(&now);
        let distance = vector.norm();
        let n = vector / distance;
        let kept = gap + ROUNDING * scale * (n.x.abs() + n.y.abs() + n.z.abs());
        // Also where the distance is zero and n no number.
        if distance <= kept || distance.is_nan() || kept.is_nan() {
            return Some(time);
        }
        let mut safe = f64::INFINITY;
        for &[i, j] in pairs {
            let first = n.dot(&(start[j] - start[i]));
            let last = n.dot(&(end[j] - end[i]));
            if first + (last - first) * time <= kept {
                return Some(time);
            }
            if last <= kept {
                safe = f64::min(safe, (first - kept) / (first - last));
            }
        }
        if safe > 1.0 {
            return None;
        }
        if safe <= time {
            return Some(time);
        }
        time = safe;
        for (now, (a, b)) in now.iter_mut().zip(start.iter().zip(end)) {
            *now = a + (b - a) * time;
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
    fn time_of_a_fall_onto_a_face_and_past_it() {
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
    fn degenerate_features_are_decided() {
        let p = Vec3::new(0.3, 0.4, 0.5);
        let same = [p; 4];
        assert_eq!(vertex_face_impact(&same, &same, 0.0), Some(0.0));
        assert_eq!(edge_edge_impact(&same, &same, 0.0), Some(0.0));
        let nan = [Vec3::repeat(f64::NAN); 4];
        assert_eq!(vertex_face_impact(&nan, &same, 0.0), Some(0.0));
        // Parallel edges that pass each other and that meet.
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
        /// A motion made to meet at a known time is never missed, and what is found is not later.
        #[test]
        fn what_is_made_to_meet_is_found(
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
            // Rounding of the construction itself.
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
