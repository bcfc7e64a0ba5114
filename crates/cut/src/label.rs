//! The roomiest place of a piece.

use toile_geometry::{Polygon, Vec2, point_segment_distance};

/// Number of cells of the grid along each side of a polygon's box.
const CELLS: u32 = 24;

/// A place far inside a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spot {
    /// Position (m).
    pub at: Vec2,
    /// Distance to the nearest line (m); 0 if there is no room.
    pub room: f64,
}

/// Centres of the cells of a grid over a polygon's box (m), as far as they lie inside the polygon.
pub(crate) fn cells(polygon: &Polygon) -> Vec<Vec2> {
    let bounds = polygon.bounds();
    let all = (0..CELLS * CELLS).map(|k| {
        let cell = Vec2::new(f64::from(k % CELLS) + 0.5, f64::from(k / CELLS) + 0.5);
        bounds.min + bounds.size().component_mul(&cell) / f64::from(CELLS)
    });
    all.filter(|&point| polygon.contains(point)).collect()
}

/// The best place among `cells`: far from all `lines`, and near the middle of the polygon's box.
pub(crate) fn roomiest_of(polygon: &Polygon, cells: &[Vec2], lines: &[[Vec2; 2]]) -> Spot {
    let bounds = polygon.bounds();
    let centre = bounds.centre();
    let mut best = (0.0, centre, 0.0);
    for &point in cells {
        let room = lines
            .iter()
            .map(|&line| point_segment_distance(point, line))
            .fold(f64::INFINITY, f64::min);
        let score = room / (1.0 + (point - centre).norm() / bounds.size().norm());
        if score > best.0 {
            best = (score, point, room);
        }
    }
    let (_, at, room) = best;
    Spot { at, room }
}
