//! Cameras: the projection of points in space to places on a picture.

use toile_geometry::Vec3;

/// Where the camera stands, seen from an object that faces +Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From +Z.
    Front,
    /// From -Z.
    Back,
    /// From +X, the wearer's left.
    Side,
    /// Half-way between front and side.
    ThreeQuarter,
}

impl View {
    /// Angle of the camera round the vertical from the front (rad).
    pub fn turn(self) -> f64 {
        use std::f64::consts::{FRAC_PI_2, PI};
        match self {
            Self::Front => 0.0,
            Self::ThreeQuarter => 0.22 * PI,
            Self::Side => FRAC_PI_2,
            Self::Back => PI,
        }
    }

    /// A caption.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Back => "Back",
            Self::Side => "Side",
            Self::ThreeQuarter => "Three-quarter",
        }
    }
}

/// Perspective or parallel projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Not at all.
    Orthographic,
    /// In proportion to the distance.
    Perspective,
}

/// A camera: an orthonormal frame at a point, and the rectangle it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands (m).
    pub eye: Vec3,
    /// Unit vector to the right of the picture.
    pub right: Vec3,
    /// Unit vector to the top of the picture.
    pub up: Vec3,
    /// Unit vector into the picture.
    pub forward: Vec3,
    /// The projection.
    pub projection: Projection,
    /// Left, right, bottom and top of the seen rectangle: in metres for an orthographic camera,
    /// in tangents of the angle from `forward` for a perspective one.
    pub window: [f64; 4],
}

/// Things nearer than this to a perspective camera are not drawn (m).
pub(crate) const NEAREST: f64 = 0.01;

/// A point as a camera sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Seen {
    /// Column (pixel), to the right.
    pub x: f64,
    /// Row (pixel), downwards.
    pub y: f64,
    /// Larger is nearer, and linear over the picture of a plane.
    pub near: f64,
    /// Weight that makes interpolation over the picture right in space; 0 is behind the camera.
    pub weight: f64,
}

/// The corners of a box given by its smallest and largest coordinates (m).
pub(crate) fn box_corners(bounds: [Vec3; 2]) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        Vec3::new(
            bounds[corner & 1].x,
            bounds[corner >> 1 & 1].y,
            bounds[corner >> 2].z,
        )
    })
}

impl Camera {
    /// A camera that looks from an eye to a target, with a window round the middle: half its
    /// width and half its height, in the unit of [`Camera::window`]. A view straight up or down
    /// has +Z at the bottom of the picture.
    pub fn look_at(eye: Vec3, target: Vec3, projection: Projection, half: [f64; 2]) -> Self {
        let forward = (target - eye).try_normalize(0.0).unwrap_or(-Vec3::z());
        let right = forward
            .cross(&Vec3::y())
            .try_normalize(1e-9)
            .unwrap_or(Vec3::x());
        let up = right.cross(&forward);
        Self {
            eye,
            right,
            up,
            forward,
            projection,
            window: [-half[0], half[0], -half[1], half[1]],
        }
    }

    /// A camera that sees a whole box from a side, with a margin of 4 %.
    ///
    /// `aspect` is width over height of the picture. A perspective camera stands four box
    /// diagonals away and slightly above the middle.
    pub fn fit_to(bounds: [Vec3; 2], view: View, aspect: f64, projection: Projection) -> Self {
        let middle = 0.5 * (bounds[0] + bounds[1]);
        let distance = 4.0 * (bounds[1] - bounds[0]).norm().max(1e-6);
        let rise: f64 = match projection {
            Projection::Orthographic => 0.0,
            Projection::Perspective => 0.07,
        };
        let mut camera = Self::around(middle, distance, view.turn(), rise, projection);
        let mut half = [0.0_f64; 2];
        for p in box_corners(bounds) {
            let [x, y] = camera.tangent(p).unwrap_or_default();
            half = [half[0].max(x.abs()), half[1].max(y.abs())];
        }
        let height = 1.04 * half[1].max(half[0] / aspect).max(1e-9);
        camera.window = [-height * aspect, height * aspect, -height, height];
        camera
    }

    /// A camera on a circle round a point. `turn` is the angle round the vertical from +Z, `rise`
    /// the angle above the horizon (rad); the window is one unit each way.
    pub(crate) fn around(
        middle: Vec3,
        distance: f64,
        turn: f64,
        rise: f64,
        projection: Projection,
    ) -> Self {
        let out = Vec3::new(turn.sin() * rise.cos(), rise.sin(), turn.cos() * rise.cos());
        Self::look_at(middle + distance * out, middle, projection, [1.0, 1.0])
    }

    /// Place of a point in the unit of the window; nothing if it is behind the camera.
    pub(crate) fn tangent(&self, p: Vec3) -> Option<[f64; 2]> {
        let d = p - self.eye;
        let (x, y, z) = (d.dot(&self.right), d.dot(&self.up), d.dot(&self.forward));
        match self.projection {
            Projection::Orthographic => Some([x, y]),
            Projection::Perspective if z > NEAREST => Some([x / z, y / z]),
            Projection::Perspective => None,
        }
    }

    pub(crate) fn see(&self, p: Vec3, size: [usize; 2]) -> Seen {
        let z = (p - self.eye).dot(&self.forward);
        let Some([x, y]) = self.tangent(p) else {
            return Seen::default();
        };
        let [left, right, bottom, top] = self.window;
        let (near, weight) = match self.projection {
            Projection::Orthographic => (-z, 1.0),
            Projection::Perspective => (1.0 / z, 1.0 / z),
        };
        Seen {
            x: (x - left) / (right - left) * size[0] as f64,
            y: (top - y) / (top - bottom) * size[1] as f64,
            near,
            weight,
        }
    }

    /// The line of sight through a place of the picture: its start and its unit direction.
    pub(crate) fn ray(&self, x: f64, y: f64, size: [usize; 2]) -> (Vec3, Vec3) {
        let [left, right, bottom, top] = self.window;
        let u = left + x / size[0] as f64 * (right - left);
        let v = top - y / size[1] as f64 * (top - bottom);
        let across = u * self.right + v * self.up;
        match self.projection {
            Projection::Orthographic => (self.eye + across, self.forward),
            Projection::Perspective => (self.eye, (self.forward + across).normalize()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [Vec3; 2] = [Vec3::new(-0.3, 0.0, -0.1), Vec3::new(0.3, 1.7, 0.2)];

    #[test]
    fn every_view_sees_the_whole_box_and_fills_the_picture() {
        for view in [View::Front, View::Back, View::Side, View::ThreeQuarter] {
            for projection in [Projection::Orthographic, Projection::Perspective] {
                let camera = Camera::fit_to(BOX, view, 0.5, projection);
                let mut rows = [f64::INFINITY, f64::NEG_INFINITY];
                for p in box_corners(BOX) {
                    let seen = camera.see(p, [500, 1000]);
                    assert!((0.0..500.0).contains(&seen.x) && (0.0..1000.0).contains(&seen.y));
                    rows = [rows[0].min(seen.y), rows[1].max(seen.y)];
                }
                assert!(
                    rows[1] - rows[0] > 900.0,
                    "{view:?} {projection:?} {rows:?}"
                );
            }
        }
    }

    #[test]
    fn left_and_right_as_a_photographer_sees_them() {
        let size = [100, 100];
        let x_of = |view, p| {
            Camera::fit_to(BOX, view, 1.0, Projection::Perspective)
                .see(p, size)
                .x
        };
        let (east, front) = (Vec3::new(0.3, 0.8, 0.0), Vec3::new(0.0, 0.8, 0.2));
        assert!(x_of(View::Front, east) > 55.0);
        assert!(x_of(View::Back, east) < 45.0);
        // From the wearer's left, the face looks to the left of the picture.
        assert!(x_of(View::Side, front) < 50.0);
    }

    #[test]
    fn rays_pass_through_the_points_they_came_from() {
        let p = Vec3::new(0.1, 1.2, 0.15);
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let camera = Camera::fit_to(BOX, View::ThreeQuarter, 0.7, projection);
            let seen = camera.see(p, [700, 1000]);
            let (start, direction) = camera.ray(seen.x, seen.y, [700, 1000]);
            let d = p - start;
            assert!((d - d.dot(&direction) * direction).norm() < 1e-9);
        }
    }

    #[test]
    fn points_behind_the_eye_are_not_seen() {
        let camera = Camera::look_at(Vec3::z(), Vec3::zeros(), Projection::Perspective, [1.0; 2]);
        assert_eq!(camera.see(Vec3::new(0.0, 0.0, 2.0), [10, 10]).weight, 0.0);
        assert!(camera.see(Vec3::zeros(), [10, 10]).weight > 0.0);
    }

    #[test]
    fn a_view_straight_down_has_a_frame() {
        let camera = Camera::look_at(Vec3::y(), Vec3::zeros(), Projection::Orthographic, [1.0; 2]);
        assert!((camera.up.norm() - 1.0).abs() < 1e-12 && camera.up.z < 0.0);
    }
}
