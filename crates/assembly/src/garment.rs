//! The garment: one triangle mesh of all sewn pieces, with the map back to the pieces.
//!
//! # Decided with
//! - [`crate::seam_match`], [`crate::sampling`]: points that both sides of a seam share; how many between
//!   them;
//! - [`crate::mesh::mesh_pieces`]: pieces meshed;
//! - [`crate::role::roles`]: the part of the body that a piece goes round;
//! - [`crate::placement::place`]: pieces placed round the body;
//! - [`crate::assemble::assemble`]: all these steps in order;
//! - [`crate::morph::morph`]: meshes that follow an edit;
//! - [`crate::sanity::sanity`], [`crate::quality::MeshQuality`]: checks of the mesh;
//! - [`crate::error::AssemblyError`]: what is refused, and what is told.

use std::ops::Range;
use toile_geometry::{Vec2, Vec3};
use toile_pattern::{PieceId, SeamOrigin};

/// All sewn pieces as one triangle mesh. Seams are not merged: every piece has its own vertices.
#[derive(Clone, Debug, Default)]
pub struct Garment {
    /// Vertex positions round the body (m).
    pub positions: Vec<Vec3>,
    /// Position of each vertex in the plane of its piece (m).
    pub flat: Vec<Vec2>,
    /// Vertex indices of each triangle, wound like the outline of the piece, so that normals point to the
    /// right side.
    pub triangles: Vec<[u32; 3]>,
    /// One entry per sewn piece, in the order of the draft; the vertices and triangles of a piece are
    /// contiguous.
    pub panels: Vec<GarmentPanel>,
    /// Vertex pairs that seams draw together, one to one along each seam.
    pub stitches: Vec<Stitch>,
}

/// One piece inside a garment.
#[derive(Clone, Debug)]
pub struct GarmentPanel {
    /// Identity of the piece.
    pub piece: PieceId,
    /// Index into the draft's pieces.
    pub draft_piece: usize,
    /// Name displayed.
    pub name: String,
    /// Index range of the piece's vertices.
    pub vertices: Range<usize>,
    /// Index range of the piece's triangles.
    pub triangles: Range<usize>,
    /// Direction of the warp in the piece's plane (rad).
    pub grain: f64,
    /// Index into the draft's fabrics.
    pub fabric: usize,
}

/// Two vertices that are sewn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stitch {
    /// One vertex of each side; both are equal if a seam closes on itself (a dart's apex is left out).
    pub vertices: [u32; 2],
    /// The seam that the stitch belongs to.
    pub seam: SeamOrigin,
    /// Index into the draft's seams.
    pub draft_seam: usize,
}
