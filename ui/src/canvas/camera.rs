//! The camera of the table: maps its plane to the screen and back. View state: not in the document.

use egui::{Pos2, Rect, Vec2 as ScreenVector};
use toile_geometry::{Bounds2, Vec2};

/// A point of the table (m), Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablePoint(pub Vec2);

/// A point of the screen (logical pixels), Y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenPoint(pub Pos2);

/// Smallest and largest enlargement (logical pixels per metre): from a whole marker on the screen
/// to a millimetre as wide as a finger.
const SCALES: [f64; 2] = [20.0, 40_000.0];
/// Least size of a part that is enlarged to fill the view; smaller parts fill less (m).
const MIN_FITTED_SIZE: f64 = 0.1;
/// Empty border when everything is shown (share of the view).
const BORDER: f64 = 0.06;

/// Position and enlargement of the view on the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableCamera {
    /// Table point in the middle of the view (m).
    pub centre: Vec2,
    /// Enlargement (logical pixels per metre).
    pub scale: f64,
}

impl Default for TableCamera {
    fn default() -> Self {
        Self {
            centre: Vec2::new(0.2, 0.25),
            scale: 800.0,
        }
    }
}

impl TableCamera {
    /// Screen point of a table point.
    pub fn screen(&self, view: Rect, point: TablePoint) -> ScreenPoint {
        let from_centre = (point.0 - self.centre) * self.scale;
        ScreenPoint(middle(view) + ScreenVector::new(from_centre.x as f32, -from_centre.y as f32))
    }

    /// Table point of a screen point.
    pub fn table(&self, view: Rect, point: ScreenPoint) -> TablePoint {
        TablePoint(self.centre + self.table_vector(point.0 - middle(view)))
    }

    /// A vector on the screen as a vector on the table (m).
    pub fn table_vector(&self, on_screen: ScreenVector) -> Vec2 {
        Vec2::new(f64::from(on_screen.x), -f64::from(on_screen.y)) / self.scale
    }

    /// Moves the table along with the pointer.
    pub fn pan(&mut self, on_screen: ScreenVector) {
        self.centre -= self.table_vector(on_screen);
    }

    /// Zooms by a factor; the table point under the screen point `fixed` stays there.
    pub fn zoom(&mut self, view: Rect, fixed: ScreenPoint, factor: f64) {
        let before = self.table(view, fixed);
        self.scale = (self.scale * factor).clamp(SCALES[0], SCALES[1]);
        let after = self.table(view, fixed);
        self.centre += before.0 - after.0;
    }

    /// Level of detail of curves: exponent of the next power of two above the enlargement (pixels per
    /// metre).
    pub fn octave(&self) -> i32 {
        self.scale.log2().floor() as i32 + 1
    }

    /// Shows a whole rectangle of the table.
    pub fn fit(&mut self, view: Rect, bounds: &Bounds2) {
        if let Some(scale) = fitting(view, bounds) {
            self.scale = scale;
            self.centre = (bounds.min + bounds.max) * 0.5;
        }
    }

    /// Shows a whole rectangle of the table in a part of the view.
    pub fn fit_into(&mut self, view: Rect, room: Rect, bounds: &Bounds2) {
        self.fit(room, bounds);
        self.centre += self.table_vector(middle(view) - middle(room));
    }

    /// Moves the table, and zooms out if necessary, by just enough to show a whole rectangle.
    pub fn reveal(&mut self, view: Rect, bounds: &Bounds2) {
        // Parts that touch the edge of the view are hard to see.
        let clear = view.shrink(0.5 * BORDER as f32 * view.size().min_elem());
        let is_seen = |at: Vec2| clear.contains(self.screen(view, TablePoint(at)).0);
        let Some(scale) = fitting(view, bounds) else {
            return;
        };
        if [bounds.min, bounds.max].into_iter().all(is_seen) {
            return;
        }
        self.scale = self.scale.min(scale);
        let half = view.size() * (0.5 - BORDER as f32);
        let half = Vec2::new(f64::from(half.x), f64::from(half.y)) / self.scale;
        self.centre = self.centre.sup(&(bounds.max - half));
        self.centre = self.centre.inf(&(bounds.min + half));
    }
}

/// Middle of a view on a whole pixel, so that lines of the table are sharp and a click gives round
/// coordinates.
fn middle(view: Rect) -> Pos2 {
    view.center().round()
}

/// Enlargement at which a rectangle of the table fills the view up to its border.
fn fitting(view: Rect, bounds: &Bounds2) -> Option<f64> {
    let size = bounds.max - bounds.min;
    let room = 1.0 - 2.0 * BORDER;
    let scale = (f64::from(view.width()) * room / size.x.max(MIN_FITTED_SIZE))
        .min(f64::from(view.height()) * room / size.y.max(MIN_FITTED_SIZE));
    let is_one = scale.is_finite() && scale > 0.0;
    is_one.then(|| scale.clamp(SCALES[0], SCALES[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    fn view() -> Rect {
        Rect::from_min_max(pos2(100.0, 50.0), pos2(900.0, 650.0))
    }

    #[test]
    fn screen_and_table_are_inverse_and_up_is_up() {
        let camera = TableCamera {
            centre: Vec2::new(0.3, -0.2),
            scale: 750.0,
        };
        let there = TablePoint(Vec2::new(0.41, 0.13));
        let seen = camera.screen(view(), there);
        assert!((camera.table(view(), seen).0 - there.0).norm() < 1e-6);
        let above = camera.screen(view(), TablePoint(there.0 + Vec2::new(0.0, 0.1)));
        assert!(above.0.y < seen.0.y);
    }

    #[test]
    fn zooming_keeps_the_point_under_the_cursor() {
        let mut camera = TableCamera::default();
        let cursor = ScreenPoint(pos2(230.0, 410.0));
        for factor in [1.7, 0.2, 9.0, 1e9, 1e-9] {
            let before = camera.table(view(), cursor);
            camera.zoom(view(), cursor, factor);
            let after = camera.table(view(), cursor);
            assert!((before.0 - after.0).norm() < 1e-9);
        }
    }

    #[test]
    fn everything_is_seen_after_fitting() {
        let mut camera = TableCamera::default();
        let bounds = Bounds2 {
            min: Vec2::new(-0.4, 1.0),
            max: Vec2::new(1.6, 1.5),
        };
        camera.fit(view(), &bounds);
        for corner in [bounds.min, bounds.max] {
            assert!(view().contains(camera.screen(view(), TablePoint(corner)).0));
        }
    }

    #[test]
    fn what_is_revealed_is_seen_and_what_was_seen_stays() {
        let small = Bounds2 {
            min: Vec2::new(2.0, 1.0),
            max: Vec2::new(2.1, 1.2),
        };
        let large = Bounds2 {
            min: Vec2::new(-3.0, 1.0),
            max: Vec2::new(-1.0, 1.2),
        };
        let mut camera = TableCamera::default();
        for (bounds, stays) in [(small, true), (small, true), (large, false)] {
            let before = camera;
            camera.reveal(view(), &bounds);
            for corner in [bounds.min, bounds.max] {
                assert!(view().contains(camera.screen(view(), TablePoint(corner)).0));
            }
            assert_eq!(camera.scale == before.scale, stays);
            let now = camera;
            camera.reveal(view(), &bounds);
            assert_eq!(camera, now);
        }
    }
}
