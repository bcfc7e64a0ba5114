//! Triangles over points of the plane and over polygons in space.

use crate::{Vec2, Vec3, orient2d};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};
use std::collections::{HashMap, HashSet};

/// Why points or a polygon have no triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangulationError {
    /// Two points lie in one place.
    Duplicate,
    /// Two fixed segments cross; the ends of one of them.
    Conflict([usize; 2]),
    /// A coordinate is too large or too small.
    Coordinate,
    /// All corners lie on a line.
    Flat,
}

#[derive(Clone, Copy)]
struct Numbered(Vec2);

impl HasPosition for Numbered {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        // Coordinates too small for exact predicates are zero for any garment.
        let clean = |x: f64| if x.abs() < 1e-20 { 0.0 } else { x };
        Point2::new(clean(self.0.x), clean(self.0.y))
    }
}

/// The constrained Delaunay triangulation of the hull of points (m) (Delaunay 1934, Chew 1989): every segment is an
/// edge. Triangles are counter-clockwise, in ascending order.
///
/// # Errors
/// Points that coincide, segments that cross, a coordinate that cannot be used.
pub fn delaunay_triangles(
    points: &[Vec2],
    segments: Vec<[usize; 2]>,
) -> Result<Vec<[usize; 3]>, TriangulationError> {
    let mut conflict = None;
    let numbered = points.iter().map(|&p| Numbered(p)).collect();
    let cdt: ConstrainedDelaunayTriangulation<Numbered> =
        ConstrainedDelaunayTriangulation::try_bulk_load_cdt(numbered, segments, |edge| {
            conflict.get_or_insert(edge);
        })
        .map_err(|_| TriangulationError::Coordinate)?;
    if cdt.num_vertices() != points.len() {
        return Err(TriangulationError::Duplicate);
    }
    if let Some(edge) = conflict {
        return Err(TriangulationError::Conflict(edge));
    }
    let faces = cdt.inner_faces();
    let mut all: Vec<[usize; 3]> = faces
        .map(|face| face.vertices().map(|v| v.fix().index()))
        .collect();
    all.sort_unstable();
    Ok(all)
}

/// A polygon whose smaller part along its first diagonal has less than this of the area is cut along the other.
const SLIVER: f64 = 1e-3;
/// An area below this of the square of the extent is none.
const NO_AREA: f64 = 1e-12;

/// Triangles of one polygon in space (m), as indices of its corners, two fewer than these and turning as it does.
/// It may be concave, have corners on a straight side, and be bent a little out of its plane, which is that of its
/// vector area (Newell). A quad is cut along its first diagonal where that is sound, larger ones by Delaunay.
///
/// # Errors
/// It has no area, a corner stands in two places of it, or it crosses itself.
pub fn polygon_triangles(corners: &[Vec3]) -> Result<Vec<[usize; 3]>, TriangulationError> {
    match corners.len() {
        0..3 => return Err(TriangulationError::Flat),
        3 => return Ok(vec![[0, 1, 2]]),
        _ => {}
    }
    let ring = in_its_plane(corners)?;
    if ring.len() == 4
        && let Some(triangles) = quad(&ring)
    {
        return Ok(triangles);
    }
    let count = ring.len();
    let sides: Vec<[usize; 2]> = (0..count).map(|k| [k, (k + 1) % count]).collect();
    let all = delaunay_triangles(&ring, sides.clone())?;
    let inside = inside(all, &sides);
    // A simple polygon has two triangles fewer than corners.
    match inside.len() == count - 2 {
        true => Ok(inside),
        false => Err(TriangulationError::Conflict([0, 1])),
    }
}

/// The corners in the plane of the polygon, counter-clockwise, about their middle and in units of their extent.
fn in_its_plane(corners: &[Vec3]) -> Result<Vec<Vec2>, TriangulationError> {
    let middle = corners.iter().sum::<Vec3>() / corners.len() as f64;
    let extent = corners
        .iter()
        .map(|p| (p - middle).norm())
        .fold(0.0, f64::max);
    if extent == 0.0 || !extent.is_finite() {
        return Err(TriangulationError::Flat);
    }
    let points: Vec<Vec3> = corners.iter().map(|p| (p - middle) / extent).collect();
    let next = points.iter().cycle().skip(1);
    let area: Vec3 = points.iter().zip(next).map(|(a, b)| a.cross(b)).sum();
    if area.norm() <= NO_AREA {
        let along = points.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let off = |p: &Vec3| along.is_some_and(|along| along.cross(p).norm() > NO_AREA.sqrt());
        // Parts that turn against each other have no area together.
        return Err(match points.iter().any(off) {
            true => TriangulationError::Conflict([0, 1]),
            false => TriangulationError::Flat,
        });
    }
    let normal = area.normalize();
    // The axis that lies most across the normal gives the first of the plane.
    let axis = Vec3::ith(normal.iamin(), 1.0);
    let first = (axis - normal * normal.dot(&axis)).normalize();
    let second = normal.cross(&first);
    let flat = |p: &Vec3| Vec2::new(p.dot(&first), p.dot(&second));
    Ok(points.iter().map(flat).collect())
}

/// The two triangles of a quad, or nothing where neither diagonal lies inside.
fn quad(ring: &[Vec2]) -> Option<Vec<[usize; 3]>> {
    let area = |[a, b, c]: [usize; 3]| 0.5 * orient2d(ring[a], ring[b], ring[c]);
    let ways = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let [first, other] = ways.map(|way| area(way[0]).min(area(way[1])));
    let whole = area(ways[0][0]) + area(ways[0][1]);
    let chosen = match first >= SLIVER * whole || first >= other {
        true => (ways[0], first),
        false => (ways[1], other),
    };
    (chosen.1 > NO_AREA).then(|| chosen.0.to_vec())
}

/// Those of the triangles that lie on the left of the sides of a ring.
fn inside(triangles: Vec<[usize; 3]>, sides: &[[usize; 2]]) -> Vec<[usize; 3]> {
    let edges = |[a, b, c]: [usize; 3]| [[a, b], [b, c], [c, a]];
    let sides: HashSet<[usize; 2]> = sides.iter().copied().collect();
    let mut left_of = HashMap::new();
    for (t, &triangle) in triangles.iter().enumerate() {
        left_of.extend(edges(triangle).map(|edge| (edge, t)));
    }
    let mut is_inside = vec![false; triangles.len()];
    let mut queue: Vec<usize> = sides
        .iter()
        .filter_map(|side| left_of.get(side).copied())
        .collect();
    while let Some(t) = queue.pop() {
        if std::mem::replace(&mut is_inside[t], true) {
            continue;
        }
        let across = edges(triangles[t])
            .into_iter()
            .filter(|edge| !sides.contains(edge));
        queue.extend(across.filter_map(|[a, b]| left_of.get(&[b, a]).copied()));
    }
    let mut inside = is_inside.into_iter();
    let mut triangles = triangles;
    triangles.retain(|_| inside.next() == Some(true));
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ring_area, triangle_area};
    use proptest::prelude::*;

    /// The polygon leaning in space.
    fn in_space(ring: &[Vec2]) -> Vec<Vec3> {
        let (first, second) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.48, 0.8, -0.36));
        let place = |p: &Vec2| Vec3::new(3.0, -1.0, 2.0) + first * p.x + second * p.y;
        ring.iter().map(place).collect()
    }

    fn ring(points: &[[f64; 2]]) -> Vec<Vec2> {
        points.iter().map(|&[x, y]| Vec2::new(x, y)).collect()
    }

    /// The area of the triangles, each of which has some and turns as the polygon does.
    fn covered(ring: &[Vec2]) -> f64 {
        let corners = in_space(ring);
        let triangles = polygon_triangles(&corners).unwrap();
        assert_eq!(triangles.len(), ring.len() - 2);
        for t in &triangles {
            let [a, b, c] = t.map(|k| ring[k]);
            assert!(orient2d(a, b, c) * ring_area(ring) > 0.0, "{t:?}");
        }
        triangles
            .iter()
            .map(|t| triangle_area(t.map(|k| corners[k])))
            .sum()
    }

    #[test]
    fn concave_ones_and_straight_corners_have_their_own_area() {
        let l = ring(&[
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ]);
        let octagon = ring(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [2.0, 2.0],
            [1.0, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ]);
        let arrow = ring(&[[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]]);
        let straight = ring(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 1.0]]);
        for (shape, area) in [(l, 3.0), (octagon, 4.0), (arrow, 0.5), (straight, 1.0)] {
            for turn in 0..shape.len() {
                let mut shape = shape.clone();
                shape.rotate_left(turn);
                assert!((covered(&shape) - area).abs() < 1e-12);
                shape.reverse();
                assert!((covered(&shape) - area).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_is_no_polygon_is_told_apart() {
        let fault = |points: &[[f64; 2]]| polygon_triangles(&in_space(&ring(points))).unwrap_err();
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
        assert_eq!(fault(&line), TriangulationError::Flat);
        let twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(fault(&twice), TriangulationError::Duplicate);
        let crossing = [[0.0, 0.0], [3.0, 3.0], [3.0, 0.0], [0.0, 2.0], [-1.0, 1.0]];
        assert!(matches!(fault(&crossing), TriangulationError::Conflict(_)));
        let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]];
        assert!(matches!(fault(&bow), TriangulationError::Conflict(_)));
    }

    proptest! {
        #[test]
        fn stars_are_covered_once(radii in prop::collection::vec(0.1f64..1.0, 4..40)) {
            let turn = std::f64::consts::TAU / radii.len() as f64;
            let star: Vec<Vec2> = radii
                .iter()
                .enumerate()
                .map(|(k, r)| Vec2::new((turn * k as f64).cos(), (turn * k as f64).sin()) * *r)
                .collect();
            prop_assert!((covered(&star) - ring_area(&star).abs()).abs() < 1e-12);
        }
    }
}
