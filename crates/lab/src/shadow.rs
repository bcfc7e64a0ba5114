//! The shadow that a cloth throws straight down: its area and the folds of its outline.

use toile_geometry::{Polygon, Vec2, Vec3, total_area, wound_region};

/// The shadow of a surface on the ground, exact: the union of its triangles seen from above, in
/// the plane of x and z (m).
pub fn shadow(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Polygon> {
    let flat = |v: u32| Vec2::new(positions[v as usize].x, positions[v as usize].z);
    let loops: Vec<Vec<Vec2>> = triangles
        .iter()
        .map(|t| t.map(flat).to_vec())
        .map(|mut ring| {
            // All of one hand, so that overlaps do not cancel.
            if (ring[1] - ring[0]).perp(&(ring[2] - ring[0])) < 0.0 {
                ring.swap(1, 2);
            }
            ring
        })
        .collect();
    wound_region(&loops)
}

/// Area of the shadow (m2).
pub fn shadow_area(positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    total_area(&shadow(positions, triangles))
}

/// Directions in which the outline is looked at.
const DIRECTIONS: usize = 720;

/// Folds of a shadow about the origin: maxima of its radius by direction that rise above the
/// minima beside them by at least `depth` (m).
pub fn fold_count(shadow: &[Polygon], depth: f64) -> usize {
    let radius: Vec<f64> = (0..DIRECTIONS)
        .map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            let along = Vec2::new(angle.cos(), angle.sin());
            let edges = shadow.iter().flat_map(Polygon::edges);
            edges
                .filter_map(|[a, b]| crossing(along, a, b))
                .fold(0.0, f64::max)
        })
        .collect();
    // Walk round from the lowest place, so that no fold is cut in two.
    let lowest = (0..DIRECTIONS)
        .min_by(|&a, &b| radius[a].total_cmp(&radius[b]))
        .unwrap_or(0);
    let (mut folds, mut low, mut high, mut rising) = (0, radius[lowest], radius[lowest], true);
    for k in 1..=DIRECTIONS {
        let r = radius[(lowest + k) % DIRECTIONS];
        if rising {
            high = high.max(r);
            if high - low >= depth && high - r >= depth {
                folds += 1;
                rising = false;
                low = r;
            } else {
                low = low.min(r);
                if r <= low {
                    high = r;
                }
            }
        } else {
            low = low.min(r);
            if r - low >= depth {
                rising = true;
                high = r;
            }
        }
    }
    folds
}

/// How far along a ray from the origin an edge is crossed (m).
fn crossing(along: Vec2, a: Vec2, b: Vec2) -> Option<f64> {
    let (sa, sb) = (along.perp(&a), along.perp(&b));
    if (sa > 0.0) == (sb > 0.0) {
        return None;
    }
    let t = sa / (sa - sb);
    let reach = along.dot(&(a + (b - a) * t));
    (reach > 0.0).then_some(reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn star(folds: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let count = 200u32;
        let mut points = vec![Vec3::zeros()];
        for k in 0..count {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            let r = 0.12 + 0.02 * (folds * angle).cos();
            points.push(Vec3::new(r * angle.cos(), 0.3 * angle, r * angle.sin()));
        }
        let triangles = (0..count)
            .map(|k| [0, 1 + k, 1 + (k + 1) % count])
            .collect();
        (points, triangles)
    }

    #[test]
    fn folds_of_a_star_are_counted() {
        for folds in [3, 6, 9] {
            let (points, triangles) = star(f64::from(folds));
            let shadow = shadow(&points, &triangles);
            assert_eq!(fold_count(&shadow, 5e-3), folds as usize);
            // Too shallow to count.
            assert_eq!(fold_count(&shadow, 0.06), 0);
        }
    }

    #[test]
    fn overlapping_triangles_count_once() {
        let points: Vec<Vec3> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .iter()
            .map(|p| Vec3::new(p[0], 0.3, p[1]))
            .collect();
        let area = shadow_area(&points, &[[0, 1, 2], [2, 1, 0], [1, 3, 2], [0, 1, 3]]);
        assert!((area - 1.0).abs() < 1e-12, "{area}");
    }
}
