//! What of a cloth stays the same whatever its rest shapes: triangles and the structure of its matrices.

use crate::bending_structure::BendingStructure;
use crate::caps::Exchange;
use crate::laws::bending::BendingStencil;
use crate::laws::rest_sheet::RestSheet;
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec2, Vec3};
use toile_sparse::BlockPattern;

/// Triangles of a cloth and what follows from them alone.
#[derive(Clone)]
pub struct Topology {
    /// Corners of the triangles: those of the cloth, but that caps (an angle near 180 degrees)
    /// have exchanged their long edge for the other diagonal of their pair.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles of the surface as it was given, where caps were exchanged.
    pub(crate) surface: Option<Vec<[u32; 3]>>,
    /// Where the vertices lay when the structure was made [m]: what orders of elimination follow.
    pub layout: Vec<Vec3>,
    /// Blocks of a matrix that couples the corners of each triangle.
    pub(crate) pattern: BlockPattern,
    /// Where the corners of each vertex begin in `corners`, and the end.
    pub(crate) corner_start: Vec<u32>,
    /// For each vertex the corners (3 t + k) that use it, ascending.
    pub(crate) corners: Vec<u32>,
    /// The long edges of caps that were exchanged, in order.
    pub(crate) exchanges: Vec<Exchange>,
    /// The structure of bending, once it is not chosen by the rest shapes any more.
    pub(crate) bending: Option<Arc<BendingStructure>>,
}

impl Topology {
    /// Of triangles between the vertices of a layout.
    pub(crate) fn new(layout: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let (corner_start, corners) = corner_lists(layout.len(), &triangles);
        Self {
            pattern: BlockPattern::new(layout.len(), &triangles),
            corner_start,
            corners,
            layout,
            triangles,
            surface: None,
            exchanges: Vec::new(),
            bending: None,
        }
    }

    /// Of a surface whose caps were exchanged to give `triangles`.
    pub(crate) fn with_exchanges(self, surface: Vec<[u32; 3]>, exchanges: Vec<Exchange>) -> Self {
        Self {
            surface: (!exchanges.is_empty()).then_some(surface),
            exchanges,
            ..self
        }
    }

    /// The curvatures of every triangle for some rest shapes, which choose the neighbours that each is
    /// estimated from.
    pub(crate) fn stencils(&self, rest: &[[Vec2; 3]]) -> Vec<BendingStencil> {
        let mesh = TriangleMesh {
            positions: vec![Vec3::zeros(); self.layout.len()],
            triangles: self.triangles.clone(),
        };
        let sheet = RestSheet {
            triangles: &self.triangles,
            rest,
            topology: &mesh.topology(),
        };
        sheet.stencils()
    }

    /// Corners (3 t + k) that use a vertex.
    pub(crate) fn corners_of(&self, vertex: usize) -> &[u32] {
        let uses = self.corner_start[vertex] as usize..self.corner_start[vertex + 1] as usize;
        &self.corners[uses]
    }

    /// Triangles of the surface as it was given.
    pub fn surface_triangles(&self) -> &[[u32; 3]] {
        self.surface.as_ref().unwrap_or(&self.triangles)
    }

    /// The surface at some positions.
    pub fn mesh(&self, positions: &[Vec3]) -> TriangleMesh {
        TriangleMesh {
            positions: positions.to_vec(),
            triangles: self.surface_triangles().to_vec(),
        }
    }
}

/// For each vertex the corners (3 t + k) that use it, in order.
fn corner_lists(count: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; count + 1];
    for &v in triangles.iter().flatten() {
        start[v as usize + 1] += 1;
    }
    for v in 0..count {
        start[v + 1] += start[v];
    }
    let mut next = start.clone();
    let mut corners = vec![0u32; 3 * triangles.len()];
    for (at, &v) in triangles.iter().flatten().enumerate() {
        corners[next[v as usize] as usize] = at as u32;
        next[v as usize] += 1;
    }
    (start, corners)
}
