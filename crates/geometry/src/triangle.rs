//! One triangle: area, volume under it, and its closest point with the feature it lies on.

use crate::Vec3;

/// The part of a triangle a point lies on. Corners and edges are counted from 0; edge `k` runs
/// from corner `k` to corner `(k + 1) % 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A corner.
    Corner(usize),
    /// The inside of an edge.
    Edge(usize),
    /// The inside of the face.
    Face,
}

/// Area of the triangle (m2).
pub fn triangle_area(corners: [Vec3; 3]) -> f64 {
    0.5 * (corners[1] - corners[0])
        .cross(&(corners[2] - corners[0]))
        .norm()
}

/// Distance at which a ray enters a triangle from its front, the side from which its corners run counter-clockwise, in
/// lengths of the direction; `None` where it misses (Möller and Trumbore 1997).
pub fn ray_into_triangle(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(&ac);
    let volume = ab.dot(&across);
    if volume <= 0.0 {
        return None;
    }
    let from = origin - a;
    let u = from.dot(&across);
    let turned = from.cross(&ab);
    let v = direction.dot(&turned);
    let distance = ac.dot(&turned) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= volume && distance >= 0.0).then_some(distance)
}

/// Signed volume of the tetrahedron from the origin to the triangle (m3).
pub fn tetrahedron_volume(corners: [Vec3; 3]) -> f64 {
    corners[0].dot(&corners[1].cross(&corners[2])) / 6.0
}

/// Closest point of a triangle as barycentric weights, with the feature it lies on.
///
/// Exact up to rounding, by the Voronoi regions of corners, edges and face
/// (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
pub fn closest_point_on_triangle(point: Vec3, corners: [Vec3; 3]) -> ([f64; 3], Feature) {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], Feature::Corner(0));
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return ([1.0 - v, v, 0.0], Feature::Edge(0));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return ([1.0 - w, 0.0, w], Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - w, w], Feature::Edge(1));
    }
    let denominator = 1.0 / (va + vb + vc);
    let (v, w) = (vb * denominator, vc * denominator);
    ([1.0 - v - w, v, w], Feature::Face)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closest_point_beats_every_sampled_point() {
        let corners = [
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(1.0, 0.1, 0.0),
            Vec3::new(0.2, 0.9, 0.3),
        ];
        let at = |w: [f64; 3]| corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
        for k in 0..200 {
            let phase = f64::from(k) * 0.7;
            let point = Vec3::new(
                phase.sin() * 1.5,
                (phase * 1.3).cos() * 1.5,
                (phase * 0.37).sin(),
            );
            let (weights, _) = closest_point_on_triangle(point, corners);
            let got = (at(weights) - point).norm();
            for i in 0..=20 {
                for j in 0..=(20 - i) {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let other = (at([1.0 - u - v, u, v]) - point).norm();
                    assert!(got <= other + 1e-12, "point {k}: {got} > {other}");
                }
            }
        }
    }

    #[test]
    fn rays_enter_a_triangle_from_its_front_alone() {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let from = Vec3::new(0.25, 0.25, 2.0);
        let down = -Vec3::z() * 0.5;
        assert_eq!(ray_into_triangle(from, down, corners), Some(4.0));
        let behind = Vec3::new(0.25, 0.25, -2.0);
        assert_eq!(ray_into_triangle(behind, -down, corners), None);
        assert_eq!(ray_into_triangle(from, -down, corners), None);
        assert_eq!(ray_into_triangle(from + Vec3::x(), down, corners), None);
        assert_eq!(ray_into_triangle(from, Vec3::x(), corners), None);
    }
}
