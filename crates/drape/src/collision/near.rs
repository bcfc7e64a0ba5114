//! Pairs of triangles near each other on the way of the cloth, looked for once and good for all ways
//! close to that one.

use super::curvature::{Clearance, longest};
use super::regions::Ways;
use super::surface::ClothSurface;
use toile_geometry::Vec3;

/// How much farther is looked than asked for, so that what is found serves when a little more is.
const FARTHER: f64 = 1.1;

/// Pairs as they were last looked for.
#[derive(Clone, Debug, Default)]
pub struct Near {
    pairs: Vec<[u32; 2]>,
    /// Where vertices went from and to then [m].
    from: Vec<Vec3>,
    to: Vec<Vec3>,
    /// How near triangles had to come [m], and what those left out keep.
    reach: f64,
    clearance: Option<Clearance>,
}

impl Near {
    /// Looks anew at the next search.
    pub fn forget(&mut self) {
        self.from.clear();
        self.to.clear();
    }

    /// Pairs of triangles that come within `reach` [m] of each other on the way, without those that
    /// keep clear as the clearance says. More than those, but never fewer.
    pub fn along(
        &mut self,
        surface: &mut ClothSurface,
        ways: Ways,
        reach: f64,
        clearance: Clearance,
    ) -> &[[u32; 2]] {
        let fits = self.reach >= reach && self.clearance == Some(clearance);
        if !fits || !self.holds(ways, clearance.stray) {
            self.clearance = Some(clearance);
            self.reach = FARTHER * reach;
            let wider = self.reach + 2.0 * clearance.stray;
            self.pairs = surface.near_unless_clear(ways, wider, clearance);
            self.from.clear();
            self.from.extend_from_slice(ways.from);
            self.to.clear();
            self.to.extend_from_slice(ways.to);
        }
        &self.pairs
    }

    /// Whether every vertex stays within `stray` [m] of the way it was looked for on.
    fn holds(&self, ways: Ways, stray: f64) -> bool {
        let close = |a: &[Vec3], b: &[Vec3]| {
            a.len() == b.len() && longest(a.iter().zip(b).map(|(a, b)| (a - b).norm())) <= stray
        };
        let ends = close(ways.to, &self.to);
        ends && (close(ways.from, &self.from) || close(ways.from, &self.to))
    }
}
