//! One pair of shapes: the transformation of its no-fit polygon from a shared one, and distance queries.

use crate::nofit::{NoFit, Probe};
use toile_geometry::Vec2;

/// The transformation that gives the no-fit polygon of two shapes from a shared one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub no_fit: u32,
    /// Number of its depth raster.
    pub raster: u32,
    /// Columns of the map from the shared polygon's plane.
    pub axes: [Vec2; 2],
    pub shift: Vec2,
    /// Distance the shapes keep (m); minus infinity if they may overlap.
    pub gap: f64,
}

/// The data of a query of one pair of shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairQuery<'a> {
    pub no_fit: &'a NoFit,
    pub axes: [Vec2; 2],
    pub shift: Vec2,
    pub gap: f64,
}

impl PairQuery<'_> {
    /// Where the moving shape lies to the fixed one at a move from it, and the gap they need;
    /// nothing if they are farther apart than the window.
    #[inline]
    pub fn probe(&self, apart: Vec2) -> Option<(Probe, f64)> {
        let [x, y] = self.axes;
        let at = Vec2::new(apart.dot(&x), apart.dot(&y)) + self.shift;
        let mut probe = self.no_fit.probe(at)?;
        probe.normal = x * probe.normal.x + y * probe.normal.y;
        Some((probe, self.gap))
    }

    /// How much nearer than allowed the moving shape lies to the fixed one (m), 0 or more.
    #[inline]
    pub fn loss(&self, apart: Vec2) -> f64 {
        let [x, y] = self.axes;
        let at = Vec2::new(apart.dot(&x), apart.dot(&y)) + self.shift;
        match self.no_fit.probe(at) {
            Some(probe) => (probe.depth + self.gap).max(0.0),
            None => 0.0,
        }
    }
}
