//! One pair of shapes: the transform from a shared no-fit polygon to that of the pair, and distance queries.

use crate::nofit::{NoFit, Probe};
use toile_geometry::Vec2;

/// The transform from a shared no-fit polygon to that of two shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub no_fit: u32,
    /// Index of the pair's depth raster.
    pub raster: u32,
    /// Columns of the linear map from the plane of the shared polygon.
    pub axes: [Vec2; 2],
    pub shift: Vec2,
    /// Distance that the shapes must keep (m); minus infinity if they may overlap.
    pub gap: f64,
}

/// The data for queries of one pair of shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairQuery<'a> {
    pub no_fit: &'a NoFit,
    pub axes: [Vec2; 2],
    pub shift: Vec2,
    pub gap: f64,
}

impl PairQuery<'_> {
    /// Probes the moving shape at an offset from the fixed one, and returns the gap that they need; `None` if
    /// they are farther apart than the window.
    #[inline]
    pub fn probe(&self, apart: Vec2) -> Option<(Probe, f64)> {
        let [x, y] = self.axes;
        let at = Vec2::new(apart.dot(&x), apart.dot(&y)) + self.shift;
        let mut probe = self.no_fit.probe(at)?;
        probe.normal = x * probe.normal.x + y * probe.normal.y;
        Some((probe, self.gap))
    }

    /// Amount by which the moving shape is nearer to the fixed one than allowed (m), 0 or more.
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
