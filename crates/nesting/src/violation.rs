//! Reasons why a marker is not sound, and how far off still counts as sound.

use toile_geometry::Vec2;

/// Deepest overlap of two pieces, nearest they may come below their gap, and furthest they may
/// stick out, that still counts as sound (m).
pub const PENETRATION_LIMIT: f64 = 1e-6;

/// What is not a number counts as beyond.
pub(crate) fn beyond_limit(excess: f64) -> bool {
    excess.is_nan() || excess > PENETRATION_LIMIT
}

/// A side of the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Before the first end margin.
    Start,
    /// Beyond the marker's length, or the fabric's, less the end margin.
    End,
    /// In the selvedge at y = 0.
    Lower,
    /// In the selvedge at y = width.
    Upper,
}

/// One reason why a marker is not sound. Placements are named by their index in the marker.
#[derive(Clone, Debug, PartialEq)]
pub enum Violation {
    /// Two pieces overlap.
    Overlap {
        /// The placements.
        pair: [usize; 2],
        /// Length of the shortest move that ends it (m).
        depth: f64,
        /// Fabric used twice (m2).
        area: f64,
        /// A point of the overlap (m).
        at: Vec2,
    },
    /// Two pieces lie nearer than their gap.
    Gap {
        /// The placements.
        pair: [usize; 2],
        /// Their distance (m).
        distance: f64,
        /// The gap they need (m).
        needed: f64,
    },
    /// A piece sticks out.
    Outside {
        /// The placement.
        placement: usize,
        /// Where.
        side: Side,
        /// By how much (m).
        by: f64,
    },
    /// A piece lies in an orientation it may not take.
    Orientation {
        /// The placement.
        placement: usize,
        /// Its turn (rad).
        turn: f64,
        /// Whether it lies face down.
        mirrored: bool,
    },
    /// Two pieces of one garment run opposite ways on fabric with a nap.
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
        /// How far it is from the nearest fold (m); infinite if there is none.
        by: f64,
    },
    /// A match point lies beside the print.
    OffPrint {
        /// The placement.
        placement: usize,
        /// How far along the warp and across (m).
        by: Vec2,
    },
    /// A piece lies on a flaw, or nearer to it than it may.
    OnFlaw {
        /// The placement.
        placement: usize,
        /// Number of the flaw.
        flaw: usize,
        /// Flawed area in the piece (m2).
        area: f64,
    },
    /// A locked copy does not lie where it must.
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
        /// How often it is laid or listed.
        count: usize,
    },
    /// A placement names no item, or its place is not a finite number.
    Nonsense {
        /// The placement.
        placement: usize,
    },
    /// The stated length is not the length used.
    Length {
        /// As stated (m).
        stated: f64,
        /// As found, end margins included (m).
        found: f64,
    },
}
