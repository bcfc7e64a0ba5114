//! The camera that orbits the garment.

use toile_geometry::Vec3;

/// Vertical angle of view (rad).
const FIELD: f64 = 0.5;
/// Distances of the near and the far clipping plane (m).
const DEPTHS: [f64; 2] = [0.05, 30.0];
/// Least and greatest distance of the eye (m).
const DISTANCES: [f64; 2] = [0.3, 12.0];
/// Largest pitch up or down (rad): less than vertical, at which "up" is undefined.
const STEEPEST: f64 = 1.5;
/// Rotation per logical pixel of a drag (rad).
const TURN: f64 = 0.008;

/// Position of the eye: view state, not in the document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Point that the eye looks at (m).
    pub target: Vec3,
    /// Azimuth of the eye from the target, from +z toward +x (rad).
    pub yaw: f64,
    /// Elevation of the eye above the level of the target (rad).
    pub pitch: f64,
    /// Distance from the eye to the target (m).
    pub distance: f64,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            target: Vec3::new(0.0, 0.9, 0.0),
            yaw: 0.35,
            pitch: 0.1,
            distance: 4.2,
        }
    }
}

impl Orbit {
    /// Position of the eye (m).
    pub fn eye(&self) -> Vec3 {
        self.target + self.backward() * self.distance
    }

    /// Unit direction from the target to the eye.
    fn backward(&self) -> Vec3 {
        let (sine, cosine) = self.pitch.sin_cos();
        Vec3::new(self.yaw.sin() * cosine, sine, self.yaw.cos() * cosine)
    }

    /// Unit directions right and up on the screen.
    pub fn axes(&self) -> [Vec3; 2] {
        let right = Vec3::new(self.yaw.cos(), 0.0, -self.yaw.sin());
        [right, self.backward().cross(&right)]
    }

    /// Turns the eye about the target, by a drag (logical pixels).
    pub fn turn(&mut self, drag: egui::Vec2) {
        self.yaw -= f64::from(drag.x) * TURN;
        self.pitch = (self.pitch + f64::from(drag.y) * TURN).clamp(-STEEPEST, STEEPEST);
    }

    /// Moves the eye and the target parallel to the screen, by a drag in a view `height` high (logical
    /// pixels).
    pub fn pan(&mut self, drag: egui::Vec2, height: f32) {
        let scale = 2.0 * self.distance * (FIELD / 2.0).tan() / f64::from(height.max(1.0));
        let [right, up] = self.axes();
        self.target += (up * f64::from(drag.y) - right * f64::from(drag.x)) * scale;
    }

    /// Moves the eye closer to the target by a factor.
    pub fn zoom(&mut self, factor: f64) {
        self.distance = (self.distance / factor).clamp(DISTANCES[0], DISTANCES[1]);
    }

    /// Moves the eye so that a whole box (m) is visible from the present direction, in a view of an aspect
    /// ratio (width over height).
    pub fn fit(&mut self, bounds: [Vec3; 2], aspect: f64) {
        self.target = (bounds[0] + bounds[1]) * 0.5;
        let size = bounds[1] - bounds[0];
        let half = (size.y * 0.5).max(0.5 * size.x.max(size.z) / aspect.max(0.1));
        let depth = 0.5 * size.x.hypot(size.z);
        self.distance =
            (1.12 * half / (FIELD / 2.0).tan() + depth).clamp(DISTANCES[0], DISTANCES[1]);
    }

    /// Direction from the eye through a place of the screen, both axes -1..=1 with y up, for a view of an aspect ratio.
    pub fn toward(&self, [x, y]: [f64; 2], aspect: f64) -> Vec3 {
        let [right, up] = self.axes();
        let reach = (FIELD / 2.0).tan();
        right * (x * reach * aspect) + up * (y * reach) - self.backward()
    }

    /// The place of the screen at which a point is seen, both axes -1..=1 with y up where it is in the view; `None` behind
    /// the eye.
    pub fn seen(&self, point: Vec3, aspect: f64) -> Option<[f64; 2]> {
        let off = point - self.eye();
        let [right, up] = self.axes();
        let depth = -off.dot(&self.backward());
        let reach = depth * (FIELD / 2.0).tan();
        (depth > DEPTHS[0]).then(|| [off.dot(&right) / (reach * aspect), off.dot(&up) / reach])
    }

    /// Matrix from world to clip space, column-major, depth 0 to 1, for a view of an aspect ratio (width
    /// over height).
    pub fn clip_from_world(&self, aspect: f64) -> [[f32; 4]; 4] {
        let eye = self.eye();
        let [right, up] = self.axes();
        let back = self.backward();
        let focal = 1.0 / (FIELD / 2.0).tan();
        let [near, far] = DEPTHS;
        let depth = far / (near - far);
        // Rows of projection * view; the view's rows are right, up and back.
        let row = |axis: Vec3, scale: f64| {
            let axis = axis * scale;
            [axis.x, axis.y, axis.z, -axis.dot(&eye)]
        };
        let toward = row(back, 1.0);
        let mut depth_row = row(back, depth);
        depth_row[3] += near * depth;
        let rows = [
            row(right, focal / aspect.max(1e-3)),
            row(up, focal),
            depth_row,
            toward.map(|x| -x),
        ];
        std::array::from_fn(|column| std::array::from_fn(|k| rows[k][column] as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(orbit: &Orbit, point: Vec3) -> [f64; 3] {
        let m = orbit.clip_from_world(1.5);
        let p = [point.x, point.y, point.z, 1.0];
        let row = |k: usize| -> f64 { (0..4).map(|c| f64::from(m[c][k]) * p[c]).sum() };
        [row(0) / row(3), row(1) / row(3), row(2) / row(3)]
    }

    #[test]
    fn the_target_is_in_the_middle_and_axes_point_right_and_up() {
        let orbit = Orbit {
            yaw: 0.8,
            pitch: -0.4,
            ..Orbit::default()
        };
        let [right, up] = orbit.axes();
        let middle = clip(&orbit, orbit.target);
        assert!(middle[0].abs() < 1e-6 && middle[1].abs() < 1e-6);
        assert!((0.0..1.0).contains(&middle[2]));
        let aside = clip(&orbit, orbit.target + right * 0.1);
        assert!(aside[0] > 0.01 && aside[1].abs() < 1e-6);
        let above = clip(&orbit, orbit.target + up * 0.1);
        assert!(above[1] > 0.01 && above[0].abs() < 1e-6);
        let nearer = clip(&orbit, orbit.target + (orbit.eye() - orbit.target) * 0.5);
        assert!(nearer[2] < middle[2]);
    }

    #[test]
    fn places_on_the_screen_and_rays_agree_with_the_picture() {
        let orbit = Orbit {
            yaw: 0.8,
            pitch: -0.4,
            ..Orbit::default()
        };
        let point = orbit.target + Vec3::new(0.2, -0.1, 0.3);
        let [x, y, _] = clip(&orbit, point);
        let seen = orbit.seen(point, 1.5).unwrap();
        assert!((seen[0] - x).abs() < 1e-6 && (seen[1] - y).abs() < 1e-6);
        let toward = orbit.toward(seen, 1.5);
        assert!(toward.cross(&(point - orbit.eye())).norm() < 1e-9);
        let behind = orbit.eye() * 2.0 - orbit.target;
        assert_eq!(orbit.seen(behind, 1.5), None);
    }

    #[test]
    fn a_box_is_seen_whole_after_fitting() {
        let bounds = [Vec3::new(-0.8, 0.0, -0.2), Vec3::new(0.8, 1.8, 0.2)];
        let mut orbit = Orbit::default();
        orbit.fit(bounds, 1.5);
        for k in 0..8 {
            let corner = Vec3::from_fn(|axis, _| bounds[(k >> axis) & 1][axis]);
            let seen = clip(&orbit, corner);
            assert!(seen[0].abs() < 1.0 && seen[1].abs() < 1.0, "{seen:?}");
        }
    }

    #[test]
    fn panning_moves_the_target_with_the_pointer() {
        let mut orbit = Orbit::default();
        let point = orbit.target;
        orbit.pan(egui::vec2(40.0, 30.0), 600.0);
        let seen = clip(&orbit, point);
        assert!((seen[0] * 1.5 * 300.0 - 40.0).abs() < 0.5, "{seen:?}");
        assert!((seen[1] * 300.0 + 30.0).abs() < 0.5, "{seen:?}");
    }
}
