//! Places where a surface that moves comes close to itself or goes through itself.

use crate::predicates::orient2d;
use crate::tree::ClosestPoint;
use crate::{MovingSurface, Vec2, Vec3, triangles_intersect};
use std::cell::Cell;

/// The room in front of a place of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Room {
    /// No wall that faces it is within reach.
    Free,
    /// Distance to the nearest wall that faces it (m).
    Pinch(f64),
    /// It lies inside another part of the surface.
    Buried,
}

/// Cosine between two normals below which their walls face each other: 120 degrees.
const FACING: f64 = -0.5;
/// Distance in front of a place from where it is told whether it is inside of another part, and from where something is
/// in front of it (m).
const IN_FRONT: f64 = 1e-6;

impl MovingSurface {
    /// The room in front of a place, along its normal, at a time of the step: the nearest wall that faces it within
    /// `reach` (m).
    pub fn room(&self, place: &ClosestPoint, time: f64, reach: f64) -> Room {
        let is_behind = Cell::new(false);
        let distance2 = |triangle: u32| {
            if !self.faces(triangle, place.normal, time) {
                return f64::INFINITY;
            }
            let away = self.away_from_triangle(triangle, place.point, time);
            let (along, distance) = (-away.dot(&place.normal), away.norm());
            // Of a wall that meets this one in a ridge neither is in front of the other.
            if along < -FACING * distance || along < IN_FRONT {
                let is_near = along < -IN_FRONT && distance < reach;
                is_behind.set(is_behind.get() || is_near);
                return f64::INFINITY;
            }
            distance * distance
        };
        let facing = self.closest_by(place.point, reach, distance2);
        if let Some(triangle) = facing {
            return Room::Pinch(self.away_from_triangle(triangle, place.point, time).norm());
        }
        // Behind it is the other side of something thin, or another part that goes through this one.
        match is_behind.get() && self.is_buried(place, time) {
            true => Room::Buried,
            false => Room::Free,
        }
    }

    /// Whether a triangle faces a direction, a unit vector, at a time of the step.
    fn faces(&self, triangle: u32, direction: Vec3, time: f64) -> bool {
        let [a, b, c] = self.corners(triangle, time);
        let across = (b - a).cross(&(c - a));
        let along = across.dot(&direction);
        along < 0.0 && along * along >= FACING * FACING * across.norm_squared()
    }

    /// Whether a place lies inside another part of the surface at a time of the step, by how often the surface winds
    /// round a point just in front of it.
    pub fn is_buried(&self, place: &ClosestPoint, time: f64) -> bool {
        self.is_closed() && self.winding(place.point + place.normal * IN_FRONT, time) > 0
    }

    /// Whether a triangle is partly inside another part of the surface at a time of the step: it crosses a triangle that it
    /// shares no corner with, or a corner or its middle lies inside.
    pub fn has_buried(&self, triangle: u32, time: f64) -> bool {
        let (own, corners) = (
            self.triangles()[triangle as usize],
            self.corners(triangle, time),
        );
        let [a, b, c] = corners;
        let mut crosses = false;
        self.near_box(a.inf(&b).inf(&c), a.sup(&b).sup(&c), 0.0, |other| {
            let meets = self.triangles()[other as usize]
                .iter()
                .any(|v| own.contains(v));
            crosses |= !meets && triangles_intersect(corners, self.corners(other, time));
        });
        let middle = self.place(
            triangle,
            [1.0 / 3.0; 3],
            self.face_normal(triangle, time),
            time,
        );
        let mut corners = own.iter().filter_map(|&v| self.at_vertex(v, time));
        crosses
            || self.is_buried(&middle, time)
            || corners.any(|corner| self.is_buried(&corner, time))
    }

    /// How often the surface winds round a point at a time of the step: 0 outside, 1 inside, 2 where two parts of it are.
    pub fn winding(&self, point: Vec3, time: f64) -> i32 {
        let far = Vec3::new(f64::INFINITY, point.y, point.z);
        let mut winding = 0;
        let flat = |p: Vec3| Vec2::new(p.y, p.z);
        // A side that two triangles share is measured in the same order for both, so that no ray slips between them.
        let side = |(i, a): (u32, Vec3), (j, b): (u32, Vec3)| match i < j {
            true => orient2d(flat(a), flat(b), flat(point)) > 0.0,
            false => orient2d(flat(b), flat(a), flat(point)) <= 0.0,
        };
        self.near_box(point, far, 0.0, |triangle| {
            let corners = self.corners(triangle, time);
            let [a, b, c] = [0, 1, 2].map(|k| (self.triangles()[triangle as usize][k], corners[k]));
            let sides = [side(a, b), side(b, c), side(c, a)];
            if sides != [true; 3] && sides != [false; 3] {
                return;
            }
            let across = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            let ahead = (corners[0] - point).dot(&across) * across.x.signum();
            if ahead > 0.0 {
                winding += if sides[0] { 1 } else { -1 };
            }
        });
        winding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleMesh;

    /// Boxes between corners (m), as one surface.
    fn boxes(all: &[[[f64; 3]; 2]]) -> MovingSurface {
        let mut mesh = TriangleMesh::default();
        for [low, high] in all {
            mesh.append(&TriangleMesh::cuboid(Vec3::from(*low), Vec3::from(*high)));
        }
        MovingSurface::new(&mesh)
    }

    /// What is in front of the point of a surface that is nearest to a point (m).
    fn room(surface: &MovingSurface, point: [f64; 3]) -> Room {
        let point = Vec3::from(point);
        let place = surface
            .closest_point(point, 0.5, f64::INFINITY, None)
            .unwrap();
        surface.room(&place, 0.5, 0.05)
    }

    const TRUNK: [[f64; 3]; 2] = [[0.0; 3], [1.0; 3]];

    #[test]
    fn two_walls_are_a_pinch_where_they_face_each_other_within_reach() {
        for gap in [0.001, 0.02, 0.049] {
            let surface = boxes(&[TRUNK, [[1.0 + gap, 0.2, 0.2], [1.5, 0.8, 0.8]]]);
            let Room::Pinch(found) = room(&surface, [1.0 + 0.3 * gap, 0.5, 0.43]) else {
                panic!("a gap of {gap} is no pinch");
            };
            assert!((found - gap).abs() < 1e-12);
            assert_eq!(room(&surface, [1.0 + 0.3 * gap, 0.05, 0.5]), Room::Free);
        }
        let far = boxes(&[TRUNK, [[1.06, 0.2, 0.2], [1.5, 0.8, 0.8]]]);
        assert_eq!(room(&far, [1.01, 0.5, 0.43]), Room::Free);
    }

    #[test]
    fn the_two_sides_of_a_ridge_are_no_pinch() {
        let plate = boxes(&[[[0.0; 3], [0.01, 1.0, 1.0]]]);
        for point in [
            [0.011, 1.0, 0.4],
            [0.012, 1.002, 0.4],
            [-0.001, 1.001, 1.001],
        ] {
            assert_eq!(room(&plate, point), Room::Free);
        }
    }

    #[test]
    fn what_is_thin_is_not_buried_but_what_another_part_goes_through_is() {
        let plate = boxes(&[[[0.0; 3], [0.02, 1.0, 1.0]]]);
        assert_eq!(room(&plate, [0.021, 0.5, 0.43]), Room::Free);
        assert_eq!(plate.winding(Vec3::new(0.01, 0.5, 0.43), 0.0), 1);
        let overlapping = boxes(&[TRUNK, [[0.98, 0.2, 0.2], [1.5, 0.8, 0.8]]]);
        assert_eq!(room(&overlapping, [0.999, 0.5, 0.43]), Room::Buried);
        assert_eq!(room(&overlapping, [0.999, 0.05, 0.43]), Room::Free);
        // The side of the trunk that the other box goes through, and all of that box but its end outside.
        let buried = (0..24)
            .filter(|&t| overlapping.has_buried(t, 0.0))
            .collect::<Vec<_>>();
        let is_on = |t: u32, x: f64| overlapping.corners(t, 0.0).iter().all(|p| p.x == x);
        let expected = (0..24).filter(|&t| is_on(t, 1.0) || t >= 12 && !is_on(t, 1.5));
        assert_eq!(buried, expected.collect::<Vec<_>>());
        for (x, expected) in [(0.5, 1), (0.99, 2), (1.2, 1), (1.6, 0), (-0.1, 0)] {
            // Rays along diagonals, too.
            for (y, z) in [(0.5, 0.43), (0.5, 0.5), (0.3, 0.3)] {
                let found = overlapping.winding(Vec3::new(x, y, z), 0.0);
                assert_eq!(found, expected, "at {x} {y} {z}");
            }
        }
    }
}
