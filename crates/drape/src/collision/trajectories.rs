//! Straight trajectories of the vertices between two looks.

use toile_geometry::Vec3;

/// Straight trajectories of all vertices.
#[derive(Clone, Copy, Debug)]
pub struct LinearTrajectories<'a> {
    /// Where they begin [m].
    pub from: &'a [Vec3],
    /// Where they end [m].
    pub to: &'a [Vec3],
    /// Whether all go at one pace; else each may end anywhere on its way.
    pub together: bool,
}

impl<'a> LinearTrajectories<'a> {
    /// LinearTrajectories that all go at one pace.
    pub fn together(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: true,
        }
    }

    /// LinearTrajectories on which each vertex may stop where it likes.
    pub fn each(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: false,
        }
    }

    /// Nothing moves.
    pub fn still(x: &'a [Vec3]) -> Self {
        Self::together(x, x)
    }

    /// Whether nothing moves.
    pub fn are_still(&self) -> bool {
        std::ptr::eq(self.from, self.to)
    }
}
