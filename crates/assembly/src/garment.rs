//! The garment: the triangle mesh of all sewn pieces, with the map back to them.

use std::ops::Range;
use toile_geometry::{Vec2, Vec3};
use toile_pattern::{PieceId, SeamOrigin};

/// All sewn pieces as one triangle mesh, not yet merged: every piece has its own vertices.
#[derive(Clone, Debug, Default)]
pub struct Garment {
    /// Placed round the body (m).
    pub positions: Vec<Vec3>,
    /// Place of each vertex in its piece's plane (m).
    pub flat: Vec<Vec2>,
    /// Corners; wound like the piece's outline, so that normals point to the right side.
    pub triangles: Vec<[u32; 3]>,
    /// One entry a sewn piece, in draft order; vertices and triangles are contiguous.
    pub panels: Vec<GarmentPanel>,
    /// Vertex pairs that a seam draws together, one to one along each seam.
    pub stitches: Vec<Stitch>,
}

/// One piece inside a garment.
#[derive(Clone, Debug)]
pub struct GarmentPanel {
    /// Which piece it is.
    pub piece: PieceId,
    /// Index into the draft's pieces.
    pub draft_piece: usize,
    /// Name to show.
    pub name: String,
    /// Its vertices.
    pub vertices: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Direction of the warp in the piece's plane (rad).
    pub grain: f64,
    /// Index into the draft's fabrics.
    pub fabric: usize,
}

/// Two vertices that are sewn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stitch {
    /// Vertices of both sides; equal where a seam closes on itself (a dart's apex is left out).
    pub vertices: [u32; 2],
    /// The seam.
    pub seam: SeamOrigin,
    /// Index into the draft's seams.
    pub draft_seam: usize,
}
