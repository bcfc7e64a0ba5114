//! The circle through three points.

use toile_geometry::Vec2;

/// Centre and radius of the circle through three points (m).
pub(crate) fn circumcircle(a: Vec2, b: Vec2, c: Vec2) -> Option<(Vec2, f64)> {
    let (u, v) = (b - a, c - a);
    let d = 2.0 * u.perp(&v);
    if d == 0.0 {
        return None;
    }
    let (uu, vv) = (u.norm_squared(), v.norm_squared());
    let offset = Vec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / d;
    let centre = a + offset;
    centre
        .iter()
        .all(|x| x.is_finite())
        .then(|| (centre, offset.norm()))
}
