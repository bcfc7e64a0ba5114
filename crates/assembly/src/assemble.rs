//! Makes a placed garment from a draft.

use crate::mesh::{PieceMeshes, mesh_pieces};
use crate::placement::{crossing_triangles, place};
use crate::{AssemblyError, Diagnostic, Garment, GarmentPanel, PlacementBody};
use std::sync::Arc;
use toile_geometry::TriangleMesh;
use toile_pattern::Draft;

/// Options for assembling a garment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyOptions {
    /// Mean edge length of the triangles (m); 10 mm resolves folds, 20 mm is a preview.
    pub edge_length: f64,
}

impl Default for AssemblyOptions {
    fn default() -> Self {
        Self { edge_length: 0.01 }
    }
}

/// A garment ready to be sewn.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The placed, unsewn garment.
    pub garment: Garment,
    /// The meshes that the garment was made from, which can follow an edit of the draft: see
    /// [`crate::morph()`].
    pub meshes: Arc<PieceMeshes>,
    /// Notes for the user.
    pub diagnostics: Vec<Diagnostic>,
    /// Number of pairs of cloth and skin triangles that intersect: 0 unless a diagnostic gives the reason.
    pub body_intersections: usize,
    /// Number of pairs of triangles of different panels that intersect: 0 unless a diagnostic gives the
    /// reason.
    pub panel_intersections: usize,
}

/// Meshes the sewn pieces of a draft and places them round a body, at least 5 mm outside the skin if
/// possible. The same input gives the same garment.
///
/// # Errors
/// Those of [`mesh_pieces`]; and [`AssemblyError::NoPart`].
pub fn assemble(
    draft: &Draft,
    body: &PlacementBody,
    options: &AssemblyOptions,
) -> Result<Assembled, AssemblyError> {
    let meshes = mesh_pieces(draft, options.edge_length)?;
    let mut diagnostics = meshes.diagnostics.clone();
    let placement = place(draft, &meshes, body, &mut diagnostics)?;
    let crossings = crossing_triangles(&meshes, &placement.positions);
    let mut named: Vec<[usize; 2]> = crossings.iter().map(|c| c.0).collect();
    named.sort_unstable();
    named.dedup();
    let name = |k: usize| draft.pieces[meshes.pieces[k].draft_piece].name.as_str();
    for [a, b] in named {
        diagnostics.push(Diagnostic::warning(
            name(a),
            format!("it crosses piece \"{}\" before sewing", name(b)),
            "place them farther apart",
        ));
    }
    let mut body_intersections = 0;
    for (k, positions) in placement.positions.iter().enumerate() {
        let mesh = TriangleMesh {
            positions: positions.clone(),
            triangles: meshes.pieces[k].triangles.clone(),
        };
        let count = body.skin.intersections_with(&mesh).len();
        if count > 0 {
            diagnostics.push(Diagnostic::warning(
                name(k),
                format!("{count} pairs of its triangles and the skin's cross before sewing"),
                "say where it is worn, or place it farther out",
            ));
        }
        body_intersections += count;
    }
    Ok(Assembled {
        garment: garment(draft, &meshes, placement.positions.concat()),
        diagnostics,
        body_intersections,
        panel_intersections: crossings.len(),
        meshes: Arc::new(meshes),
    })
}

impl Garment {
    /// The garment with the shapes of an edited draft: panels and seams of `draft`, the same triangles with
    /// the points of `meshes`, and the same placement.
    ///
    /// # Panics
    /// If `meshes` has other triangles: it must be made from this garment's meshes by [`crate::morph()`] to
    /// `draft`.
    #[must_use]
    pub fn with_shapes(&self, draft: &Draft, meshes: &PieceMeshes) -> Self {
        let shaped = garment(draft, meshes, self.positions.clone());
        assert_eq!(shaped.flat.len(), self.flat.len(), "as many vertices");
        assert!(shaped.triangles == self.triangles, "the same triangles");
        shaped
    }
}

fn garment(draft: &Draft, meshes: &PieceMeshes, positions: Vec<toile_geometry::Vec3>) -> Garment {
    let mut garment = Garment {
        positions,
        stitches: meshes.stitches.clone(),
        ..Garment::default()
    };
    for mesh in &meshes.pieces {
        let piece = &draft.pieces[mesh.draft_piece];
        let (vertex, triangle) = (garment.flat.len(), garment.triangles.len());
        garment.flat.extend(&mesh.points);
        garment
            .triangles
            .extend(mesh.triangles.iter().map(|t| t.map(|v| v + vertex as u32)));
        garment.panels.push(GarmentPanel {
            piece: piece.id,
            draft_piece: mesh.draft_piece,
            name: piece.name.clone(),
            vertices: vertex..garment.flat.len(),
            triangles: triangle..garment.triangles.len(),
            grain: piece.grain,
            fabric: piece.fabric,
        });
    }
    garment
}
