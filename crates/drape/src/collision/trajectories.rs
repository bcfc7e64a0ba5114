//! Straight trajectories of the vertices between two queries.

use toile_geometry::Vec3;

/// Straight trajectories of all vertices.
#[derive(Clone, Copy, Debug)]
pub struct LinearTrajectories<'a> {
    /// Positions at the start (m).
    pub from: &'a [Vec3],
    /// Positions at the end (m).
    pub to: &'a [Vec3],
    /// Whether all vertices move in step, each at `from + t (to - from)` at time t. Else each may stop anywhere on
    /// its segment.
    pub together: bool,
}

impl<'a> LinearTrajectories<'a> {
    /// Trajectories on which all vertices move in step.
    pub fn together(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: true,
        }
    }

    /// Trajectories on which each vertex may stop anywhere.
    pub fn each(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: false,
        }
    }

    /// Vertices at rest at positions `x` (m).
    pub fn still(x: &'a [Vec3]) -> Self {
        Self::together(x, x)
    }

    /// Whether nothing moves.
    pub fn are_still(&self) -> bool {
        std::ptr::eq(self.from, self.to)
    }
}
