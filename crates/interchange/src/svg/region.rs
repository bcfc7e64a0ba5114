//! Which lines lie in a closed line.

use crate::drawn::allowance::distance;
use crate::drawn::piece::DrawnLine;
use toile_geometry::{Bounds2, Polygon, Vec2, ring_area};

/// Largest number of chords by which places are told to lie inside or outside.
const MAX_RING: usize = 2_000;
/// Largest number of places of a line that are looked at.
const MAX_PLACES: usize = 64;

/// The area that a closed line encloses.
#[derive(Clone, Debug)]
pub(super) struct Region {
    polygon: Polygon,
    bounds: Bounds2,
    /// Size of the area (units2).
    pub area: f64,
}

impl Region {
    /// The region of a closed line.
    pub fn of(line: &DrawnLine) -> Self {
        let ring = line.chords(0).points;
        let area = ring_area(&ring).abs();
        let bounds = Bounds2::of(ring.iter().copied());
        Self {
            polygon: Polygon::new(thinned(&ring, MAX_RING)),
            bounds,
            area,
        }
    }

    /// The larger side of its bounds (units).
    pub fn extent(&self) -> f64 {
        let size = self.bounds.size();
        size.x.max(size.y)
    }

    /// Bounds of the region.
    pub fn bounds(&self) -> Bounds2 {
        self.bounds
    }

    /// Whether a place lies in it.
    pub fn contains(&self, p: Vec2) -> bool {
        self.bounds.contains(p) && self.polygon.contains(p)
    }

    /// Whether places of a line lie in it, or beyond its edge by no more than a gap (units).
    pub fn holds(&self, places: &[Vec2], gap: f64) -> bool {
        let ring = &self.polygon.outer;
        let grown = self.bounds.grown(gap);
        let is_in = |p: &Vec2| {
            grown.contains(*p) && (self.polygon.contains(*p) || distance(*p, ring) <= gap)
        };
        places.iter().all(is_in)
    }

    /// Whether places of a closed line lie in it evenly: everywhere inside, and nowhere farther from its edge than a
    /// distance (units).
    pub fn holds_evenly(&self, places: &[Vec2], most: f64) -> bool {
        let ring = &self.polygon.outer;
        places.len() > 2
            && places
                .iter()
                .all(|&p| self.contains(p) && distance(p, ring) <= most)
    }
}

/// The places of a line by which it is told to lie inside or outside.
pub(super) fn places(line: &DrawnLine) -> Vec<Vec2> {
    thinned(&line.chords(0).points, MAX_PLACES)
}

/// At most so many points of a row, at even steps.
fn thinned(points: &[Vec2], most: usize) -> Vec<Vec2> {
    let step = points.len().div_ceil(most).max(1);
    points.iter().copied().step_by(step).collect()
}
