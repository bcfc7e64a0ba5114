//! Contact planes that go with a triangle of a moving surface.
//!
//! The closest point of the surface is found once a step and where a point of the cloth has slipped far against it. In
//! between the closest point stays at the same place of its triangle, which moves straight on, and the normal turns
//! evenly from its direction at the start of the step, in the frame of the triangle, to that at its end.

use nalgebra::Matrix3;
use toile_geometry::{ClosestPoint, MovingSurface, Room, Vec3};

/// A plane at a place of a triangle, through a step.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPlane {
    /// The triangle of the surface, or [`NO_TRIANGLE`].
    pub triangle: u32,
    /// Distance from the surface that it keeps the cloth at (m).
    offset: f32,
    /// Barycentric weights of the first two corners of the triangle.
    weights: [f32; 2],
    /// The place at the start of the step, and its displacement until the end (m).
    start: Vec3,
    way: Vec3,
    /// The normal at both ends of the step, and the vector by which the triangle turns in it (rad).
    normals: [[f32; 3]; 2],
    turn: [f32; 3],
}

/// In place of a triangle's number: no point of the surface was asked for yet.
const NO_TRIANGLE: u32 = u32::MAX;

/// A plane at two times of a step.
pub struct CarriedMotion {
    /// A point of the surface at the second time (m).
    pub point: Vec3,
    /// The normal at the second time.
    pub normal: Vec3,
    /// Distance from the surface that the cloth is kept at (m).
    pub offset: f64,
    /// Displacement of the point from the first time to the second (m).
    pub displacement: Vec3,
    /// The vector by which the triangle turns from the first time to the second (rad).
    pub turn: Vec3,
}

impl Default for CarriedPlane {
    fn default() -> Self {
        Self {
            triangle: NO_TRIANGLE,
            offset: 0.0,
            weights: [0.0; 2],
            start: Vec3::zeros(),
            way: Vec3::zeros(),
            normals: [[0.0; 3]; 2],
            turn: [0.0; 3],
        }
    }
}

impl CarriedPlane {
    /// The plane at a closest point that was found at a time of the step, and how far it keeps the cloth off (m).
    pub fn new(
        surface: &MovingSurface,
        (closest, time): (&ClosestPoint, f64),
        offset: f64,
    ) -> Self {
        let frames = [0.0, 1.0].map(|time| frame(surface.corners(closest.triangle, time)));
        let now = match time {
            0.0 => frames[0],
            1.0 => frames[1],
            _ => frame(surface.corners(closest.triangle, time)),
        };
        let own = now.tr_mul(&closest.normal);
        // Half the skew part of a rotation is its axis times the sine of its angle, which is small.
        let rotation = frames[1] * frames[0].transpose();
        let turn = Vec3::new(
            rotation.m32 - rotation.m23,
            rotation.m13 - rotation.m31,
            rotation.m21 - rotation.m12,
        ) * 0.5;
        let mut plane = Self {
            triangle: closest.triangle,
            offset: offset as f32,
            normals: frames.map(|frame| single(frame * own)),
            turn: single(turn),
            ..Self::default()
        };
        plane.set_place(surface, closest.weights);
        plane
    }

    fn set_place(&mut self, surface: &MovingSurface, weights: [f64; 3]) {
        let [start, end] = [0.0, 1.0].map(|time| {
            let [p, q, r] = surface.corners(self.triangle, time);
            p * weights[0] + q * weights[1] + r * weights[2]
        });
        self.weights = [0, 1].map(|k| weights[k] as f32);
        (self.start, self.way) = (start, end - start);
    }

    /// Moves it to another place of its triangle, with a normal at a time of the step.
    pub fn shift(
        &mut self,
        surface: &MovingSurface,
        weights: [f64; 3],
        (normal, time): (Vec3, f64),
    ) {
        self.set_place(surface, weights);
        let across = Vec3::from(self.turn.map(f64::from)).cross(&normal);
        self.normals = [-time, 1.0 - time].map(|share| single(normal + across * share));
    }

    /// Goes on at the start of the next part of the step, for which the surface is set.
    pub fn go_on(&mut self, surface: &MovingSurface) {
        let [a, b] = self.weights.map(f64::from);
        let weights = [a, b, 1.0 - a - b];
        let normal = self.at([1.0; 2]).normal;
        let place = surface.place(self.triangle, weights, normal, 0.0);
        *self = Self::new(surface, (&place, 0.0), f64::from(self.offset));
    }

    /// The triangle of the surface that was closest before; none before the first query.
    pub fn known_triangle(&self) -> Option<u32> {
        (self.triangle != NO_TRIANGLE).then_some(self.triangle)
    }

    /// The plane at two times of the step.
    pub fn at(&self, [from, to]: [f64; 2]) -> CarriedMotion {
        let [first, last] = self.normals.map(|n| Vec3::from(n.map(f64::from)));
        let normal = first + (last - first) * to;
        CarriedMotion {
            point: self.start + self.way * to,
            normal: normal.try_normalize(0.0).unwrap_or_default(),
            offset: f64::from(self.offset),
            displacement: self.way * (to - from),
            turn: Vec3::from(self.turn.map(f64::from)) * (to - from),
        }
    }
}

fn single(v: Vec3) -> [f32; 3] {
    [0, 1, 2].map(|k| v[k] as f32)
}

/// Share of the room in a pinch that is used: between two walls that each took its half a point would never rest.
const OF_PINCH: f64 = 0.9;

/// How far from a place of a surface cloth is kept that would lie at `offset` from it (m): where another wall faces it so
/// near that cloths of a thickness (m) on both find no room, nearly half of what there is. None where the place lies inside
/// another part of the surface: nothing can be kept off both (Baraff, Witkin and Kass 2003).
pub fn kept_offset(
    surface: &MovingSurface,
    (place, time): (&ClosestPoint, f64),
    offset: f64,
    thickness: f64,
) -> Option<f64> {
    match surface.room(place, time, 2.0 * offset + thickness) {
        Room::Free => Some(offset),
        Room::Pinch(gap) => {
            // The walls may come nearer until the step ends.
            let later = surface.place(place.triangle, place.weights, place.normal, 1.0);
            let gap = match surface.room(&later, 1.0, gap) {
                Room::Pinch(later) => gap.min(later),
                Room::Free | Room::Buried => gap,
            };
            let half = (0.5 * (gap - thickness)).max(0.25 * gap);
            Some(offset.min(OF_PINCH * half))
        }
        Room::Buried => None,
    }
}

/// Unit axes of a triangle: along its first side, across it in the plane, and its normal; the axes of the world where
/// it has no area.
fn frame([a, b, c]: [Vec3; 3]) -> Matrix3<f64> {
    let along = (b - a).try_normalize(0.0);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
    match (along, normal) {
        (Some(along), Some(normal)) => {
            Matrix3::from_columns(&[along, normal.cross(&along), normal])
        }
        _ => Matrix3::identity(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use toile_geometry::TriangleMesh;

    /// A cube in the first or the second half of a step in which it turns by 0.2 rad.
    fn halves() -> [MovingSurface; 2] {
        let cube = TriangleMesh::cuboid(Vec3::zeros(), Vec3::repeat(0.1));
        let turned = |angle: f64| -> Vec<Vec3> {
            let turn = UnitQuaternion::new(Vec3::z() * angle);
            cube.positions.iter().map(|p| turn * p).collect()
        };
        [[0.0, 0.1], [0.1, 0.2]].map(|angles| {
            let mut surface = MovingSurface::new(&cube);
            let [from, to] = angles.map(turned);
            surface.set_step(&from, &to);
            surface
        })
    }

    #[test]
    fn a_plane_goes_with_its_triangle_through_the_parts_of_a_step() {
        let [first, second] = halves();
        let home = Vec3::new(0.1, 0.03, 0.04);
        let found = first.closest_point(home, 0.0, 1.0, None).unwrap();
        let mut plane = CarriedPlane::new(&first, (&found, 0.0), 0.002);
        let turned = |angle: f64, v: Vec3| UnitQuaternion::new(Vec3::z() * angle) * v;
        let is_at = |plane: &CarriedPlane, share: f64, angle: f64| {
            let motion = plane.at([share; 2]);
            // Straight on it is off the arc by the square of a tenth over eight, of 0.1 m.
            assert!(
                (motion.point - turned(angle, home)).norm() < 1.5e-4,
                "{share}"
            );
            assert!(
                (motion.normal - turned(angle, found.normal)).norm() < 2e-3,
                "{share}"
            );
        };
        is_at(&plane, 0.0, 0.0);
        is_at(&plane, 0.5, 0.05);
        is_at(&plane, 1.0, 0.1);
        plane.go_on(&second);
        is_at(&plane, 0.0, 0.1);
        is_at(&plane, 1.0, 0.2);
        let turn = plane.at([0.0, 1.0]).turn;
        assert!((turn - Vec3::z() * 0.1).norm() < 2e-4);
        // Elsewhere on its triangle, with a normal that is given for the middle.
        let weights = [0.5, 0.25, 0.25];
        let normal = turned(0.15, found.normal);
        plane.shift(&second, weights, (normal, 0.5));
        let [from, to] = [0.0, 1.0].map(|share| plane.at([share; 2]));
        let [p, q, r] = second.corners(found.triangle, 0.0);
        assert!((from.point - (p * 0.5 + q * 0.25 + r * 0.25)).norm() < 1e-12);
        assert!((from.normal - turned(0.1, found.normal)).norm() < 2e-3);
        assert!((to.normal - turned(0.2, found.normal)).norm() < 2e-3);
    }
}
