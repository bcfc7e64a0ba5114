//! The data of a cloth that do not depend on rest shapes: triangles and the sparsity patterns of its matrices.

use crate::bending_structure::BendingStructure;
use crate::caps::Exchange;
use crate::laws::bending::BendingStencil;
use crate::laws::rest_sheet::RestSheet;
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec2, Vec3};
use toile_sparse::BlockPattern;

/// Triangles of a cloth and the data that follow from them alone.
#[derive(Clone)]
pub struct Topology {
    /// Corners of the triangles, after the exchange of the long edges of caps (an angle near 180 degrees).
    pub triangles: Vec<[u32; 3]>,
    /// Triangles of the surface before the exchange; none without caps.
    pub(crate) surface: Option<Vec<[u32; 3]>>,
    /// Positions of the vertices at compilation (m), by which nested dissection orders the unknowns.
    pub layout: Vec<Vec3>,
    /// Sparsity pattern of a matrix that couples the corners of each triangle.
    pub pattern: BlockPattern,
    /// First index into `corners` of each vertex, and the end.
    pub(crate) corner_start: Vec<u32>,
    /// Corners (3 t + k) of each vertex, ascending.
    pub(crate) corners: Vec<u32>,
    /// The exchanges of caps, in order.
    pub(crate) exchanges: Vec<Exchange>,
    /// The structure of bending that all rest shapes share after the first change of them; none before.
    pub(crate) bending: Option<Arc<BendingStructure>>,
}

impl Topology {
    /// The topology of triangles between vertices at the positions `layout` (m).
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

    /// Records the surface before the exchange of caps, and the exchanges.
    pub(crate) fn with_exchanges(self, surface: Vec<[u32; 3]>, exchanges: Vec<Exchange>) -> Self {
        Self {
            surface: (!exchanges.is_empty()).then_some(surface),
            exchanges,
            ..self
        }
    }

    /// The curvature stencils of all triangles, with the neighbours that suit these rest shapes.
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
    #[inline]
    pub fn corners_of(&self, vertex: usize) -> &[u32] {
        let uses = self.corner_start[vertex] as usize..self.corner_start[vertex + 1] as usize;
        &self.corners[uses]
    }

    /// Triangles of the surface before the exchange of caps.
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

/// For each vertex its corners (3 t + k), ascending, as start indices and a list.
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
