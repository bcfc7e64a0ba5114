//! Reasons why a marker is not valid, and the tolerance of the check.

use toile_geometry::Vec2;

/// Tolerance of the check (m): depth of an overlap, distance below the gap, and distance beyond the fabric
/// that still count as valid.
pub const PENETRATION_LIMIT: f64 = 1e-6;

/// Whether an excess (m) is beyond the limit; a value that is not a number is.
pub(crate) fn beyond_limit(excess: f64) -> bool {
    excess.is_nan() || excess > PENETRATION_LIMIT
}

/// A side of the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// In the end margin at the start.
    Start,
    /// In the end margin at the end of the marker or of the fabric.
    End,
    /// In the selvedge at y = 0.
    Lower,
    /// In the selvedge at y = width.
    Upper,
}

/// A reason why a marker is not valid. Placements are given by their index in the marker.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// Two pieces overlap.
    Overlap {
        /// The placements.
        pair: [usize; 2],
        /// Length of the shortest translation that ends the overlap (m).
        depth: f64,
        /// Area that would be cut twice (m2).
        area: f64,
        /// A point of the overlap (m).
        at: Vec2,
    },
    /// Two pieces are nearer to each other than their gap.
    Gap {
        /// The placements.
        pair: [usize; 2],
        /// Distance of the pieces (m).
        distance: f64,
        /// Gap that the pieces need (m).
        needed: f64,
    },
    /// A piece extends beyond the usable fabric.
    Outside {
        /// The placement.
        placement: usize,
        /// Side of the fabric at which it extends beyond.
        side: Side,
        /// Distance by which it extends beyond (m).
        by: f64,
    },
    /// A piece has an orientation that is not allowed.
    Orientation {
        /// The placement.
        placement: usize,
        /// Turn of the piece (rad).
        turn: f64,
        /// Whether the piece lies face down.
        mirrored: bool,
    },
    /// Two pieces of one garment run in opposite directions on fabric with a nap.
    Nap {
        /// The placements.
        pair: [usize; 2],
        /// Number of the garment.
        bundle: u32,
    },
    /// A piece that must lie on a fold does not.
    OffFold {
        /// The placement.
        placement: usize,
        /// Distance from the nearest fold (m); infinite if there is none.
        by: f64,
    },
    /// A match point does not lie at its place of the print.
    OffPrint {
        /// The placement.
        placement: usize,
        /// Deviation along the warp and across it (m).
        by: Vec2,
    },
    /// A piece overlaps a flaw, or is nearer to it than its clearance.
    OnFlaw {
        /// The placement.
        placement: usize,
        /// Index of the flaw.
        flaw: usize,
        /// Area of the flaw inside the piece (m2).
        area: f64,
    },
    /// A locked copy does not have its locked position.
    Moved {
        /// The placement.
        placement: usize,
    },
    /// A copy is laid twice, or neither laid nor listed as unplaced, or does not exist.
    Copy {
        /// Index of the item.
        item: usize,
        /// Number of the copy.
        copy: u32,
        /// Number of times that it is laid or listed.
        count: usize,
    },
    /// A placement names an unknown item, or its position is not finite.
    Nonsense {
        /// The placement.
        placement: usize,
    },
    /// The stated length is not the length used.
    Length {
        /// Stated length (m).
        stated: f64,
        /// Length used, end margins included (m).
        found: f64,
    },
}
