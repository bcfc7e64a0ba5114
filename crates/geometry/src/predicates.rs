//! Predicates whose sign is exact whatever the rounding (Shewchuk 1997, through `robust`).

use crate::{Vec2, Vec3};
use robust::{Coord, Coord3D};

/// Twice the signed area of the triangle `abc` (m2): positive when counter-clockwise. Sign exact.
pub fn orient2d(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let coord = |p: Vec2| Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Six times the signed volume of the tetrahedron `abcd` (m3): positive when `d` lies below the
/// plane through `abc` seen counter-clockwise from above. Sign exact.
pub fn orient3d(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f64 {
    let coord = |p: Vec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Whether two closed segments share a point: touching counts. Exact.
pub fn segments_cross(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    let side = |s: [Vec2; 2], p: Vec2| orient2d(s[0], s[1], p).partial_cmp(&0.0);
    let between = |s: [Vec2; 2], p: Vec2| {
        p.x >= s[0].x.min(s[1].x)
            && p.x <= s[0].x.max(s[1].x)
            && p.y >= s[0].y.min(s[1].y)
            && p.y <= s[0].y.max(s[1].y)
    };
    let (a0, a1) = (side(b, a[0]), side(b, a[1]));
    let (b0, b1) = (side(a, b[0]), side(a, b[1]));
    let equal = Some(std::cmp::Ordering::Equal);
    if a0 != a1 && b0 != b1 && a0 != equal && a1 != equal && b0 != equal && b1 != equal {
        return true;
    }
    (a0 == equal && between(b, a[0]))
        || (a1 == equal && between(b, a[1]))
        || (b0 == equal && between(a, b[0]))
        || (b1 == equal && between(a, b[1]))
}

/// Whether a closed segment meets a closed triangle: touching counts. Exact.
///
/// A coplanar pair is decided in the coordinate plane where the triangle is largest.
pub fn segment_intersects_triangle(segment: [Vec3; 2], triangle: [Vec3; 3]) -> bool {
    let [p, q] = segment;
    let [a, b, c] = triangle;
    let (sp, sq) = (orient3d(a, b, c, p), orient3d(a, b, c, q));
    if (sp > 0.0 && sq > 0.0) || (sp < 0.0 && sq < 0.0) {
        return false;
    }
    if sp == 0.0 && sq == 0.0 {
        return coplanar_segment_meets_triangle(segment, triangle);
    }
    let (u, v, w) = (
        orient3d(p, q, a, b),
        orient3d(p, q, b, c),
        orient3d(p, q, c, a),
    );
    (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
}

fn coplanar_segment_meets_triangle(segment: [Vec3; 2], triangle: [Vec3; 3]) -> bool {
    let normal = (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0]));
    let drop = normal.iamax();
    let flat = |p: Vec3| match drop {
        0 => Vec2::new(p.y, p.z),
        1 => Vec2::new(p.z, p.x),
        _ => Vec2::new(p.x, p.y),
    };
    let s = segment.map(flat);
    let t = triangle.map(flat);
    let inside = |p: Vec2| {
        let signs = [
            orient2d(t[0], t[1], p),
            orient2d(t[1], t[2], p),
            orient2d(t[2], t[0], p),
        ];
        signs.iter().all(|&x| x >= 0.0) || signs.iter().all(|&x| x <= 0.0)
    };
    inside(s[0]) || inside(s[1]) || (0..3).any(|k| segments_cross(s, [t[k], t[(k + 1) % 3]]))
}

/// Whether two closed triangles in space share a point: touching counts. Exact.
pub fn triangles_intersect(a: [Vec3; 3], b: [Vec3; 3]) -> bool {
    // Most pairs that are asked for lie apart by the plane of one of them.
    !is_on_one_side(a, b) && !is_on_one_side(b, a) && sides_intersect(a, b)
}

/// Whether a triangle lies strictly on one side of the plane of another.
fn is_on_one_side(triangle: [Vec3; 3], [a, b, c]: [Vec3; 3]) -> bool {
    let sides = triangle.map(|p| orient3d(a, b, c, p));
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// Whether a side of one of two triangles meets the other triangle.
fn sides_intersect(a: [Vec3; 3], b: [Vec3; 3]) -> bool {
    (0..3).any(|k| segment_intersects_triangle([a[k], a[(k + 1) % 3]], b))
        || (0..3).any(|k| segment_intersects_triangle([b[k], b[(k + 1) % 3]], a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> [Vec3; 3] {
        [Vec3::zeros(), Vec3::x(), Vec3::y()]
    }

    #[test]
    fn triangles_that_pierce_touch_or_miss() {
        let shifted = |d: Vec3| unit().map(|p| p + d);
        let upright = [
            Vec3::new(0.2, 0.2, -1.0),
            Vec3::new(0.2, 0.2, 1.0),
            Vec3::new(2.0, 2.0, 0.0),
        ];
        assert!(triangles_intersect(unit(), upright));
        assert!(
            triangles_intersect(unit(), shifted(Vec3::x())),
            "one corner shared"
        );
        assert!(
            triangles_intersect(unit(), shifted(Vec3::new(0.1, 0.1, 0.0))),
            "coplanar"
        );
        assert!(!triangles_intersect(
            unit(),
            shifted(Vec3::new(0.1, 0.1, 1e-300))
        ));
        assert!(!triangles_intersect(
            unit(),
            shifted(Vec3::new(1.1, 1.1, 0.0))
        ));
    }

    #[test]
    fn segments_that_cross_touch_overlap_or_miss() {
        let s = |x0: f64, y0: f64, x1: f64, y1: f64| [Vec2::new(x0, y0), Vec2::new(x1, y1)];
        let base = s(0.0, 0.0, 1.0, 0.0);
        assert!(segments_cross(base, s(0.5, -1.0, 0.5, 1.0)));
        assert!(segments_cross(base, s(0.5, 0.0, 0.5, 1.0)), "touching");
        assert!(segments_cross(base, s(0.5, 0.0, 2.0, 0.0)), "overlapping");
        assert!(!segments_cross(base, s(1.5, 0.0, 2.0, 0.0)));
        assert!(!segments_cross(base, s(0.0, 1e-300, 1.0, 1e-300)));
    }
}
