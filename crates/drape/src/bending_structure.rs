//! The structure of bending, which is reused when rest shapes change: the neighbours of each curvature estimate, and
//! the matrix entries of their products.

use crate::Material;
use crate::laws::bending::{BendingMatrix, BendingStencil};
use crate::laws::membrane::MembraneElement;
use crate::laws::rest_sheet::{IllConditioned, RestSheet};
use crate::materials::Materials;
use nalgebra::Vector3;
use std::sync::Arc;
use toile_geometry::{Topology, TriangleMesh, Vec2, Vec3};
use toile_sparse::ScalarMatrix;

/// Structure of the bending of a cloth.
pub(crate) struct BendingStructure {
    triangles: Vec<[u32; 3]>,
    edges: Topology,
    /// Number of rings of neighbours in the estimate across each edge; none for an edge without an estimate.
    rings: Vec<Option<u8>>,
    /// A matrix with the sparsity pattern.
    pattern: ScalarMatrix,
    /// Indices in the matrix of the products of each triangle's stencil, row by row of the stencil.
    entries: Vec<u32>,
    /// First index into `entries` of each triangle, and the end.
    start: Vec<usize>,
}

/// The stencils of a cloth; unchanged ones are shared with those of the rest shapes before.
pub(crate) type Stencils = Vec<Arc<BendingStencil>>;

impl BendingStructure {
    /// The structure for some rest shapes on triangles of `count` vertices, and their stencils.
    ///
    /// # Errors
    /// A triangle whose curvature cannot be estimated.
    pub fn new(
        count: usize,
        triangles: &[[u32; 3]],
        rest: &[[Vec2; 3]],
    ) -> Result<(Self, Stencils), IllConditioned> {
        let edges = TriangleMesh {
            positions: vec![Vec3::zeros(); count],
            triangles: triangles.to_vec(),
        }
        .topology();
        let sheet = RestSheet {
            triangles,
            rest,
            topology: &edges,
        };
        let rings = sheet.rings();
        let all: Vec<u32> = (0..triangles.len() as u32).collect();
        let stencils = sheet.stencils_with(&rings, &all)?;
        let pairs = |stencil: &BendingStencil| {
            let vertices = stencil.vertices.clone();
            let row = move |i: u32| {
                let columns = vertices.clone();
                columns.into_iter().map(move |j| (i, j, 0.0))
            };
            stencil.vertices.clone().into_iter().flat_map(row)
        };
        let entries: Vec<(u32, u32, f64)> = stencils.iter().flat_map(pairs).collect();
        let pattern = ScalarMatrix::from_entries(count, &entries);
        let index =
            |&(i, j, _): &(u32, u32, f64)| pattern.index_of(i, j).unwrap_or_default() as u32;
        let mut start = vec![0];
        for stencil in &stencils {
            start.push(start[start.len() - 1] + stencil.vertices.len().pow(2));
        }
        let structure = Self {
            entries: entries.iter().map(index).collect(),
            start,
            triangles: triangles.to_vec(),
            rings,
            pattern,
            edges,
        };
        Ok((structure, stencils.into_iter().map(Arc::new).collect()))
    }

    /// The stencils for new rest shapes; `before` are the last rest shapes with their stencils, which are reused where
    /// no shape in their neighbourhood changed.
    ///
    /// # Errors
    /// A triangle whose rings are ill-conditioned for the new shapes.
    pub fn stencils(
        &self,
        before: (&[[Vec2; 3]], &Stencils),
        rest: &[[Vec2; 3]],
    ) -> Result<Stencils, IllConditioned> {
        let changed: Vec<bool> = before.0.iter().zip(rest).map(|(a, b)| a != b).collect();
        let near: Vec<u32> = (0..)
            .zip(self.near(changed))
            .filter(|(_, near)| *near)
            .map(|(t, _)| t)
            .collect();
        let sheet = RestSheet {
            triangles: &self.triangles,
            rest,
            topology: &self.edges,
        };
        let mut stencils = before.1.clone();
        let found = sheet.stencils_with(&self.rings, &near)?;
        for (&t, stencil) in near.iter().zip(found) {
            stencils[t as usize] = Arc::new(stencil);
        }
        Ok(stencils)
    }

    /// Triangles whose stencils depend on any of the marked triangles: within one edge more than the rings of them.
    fn near(&self, mut near: Vec<bool>) -> Vec<bool> {
        let rings = self.rings.iter().flatten().copied().max().unwrap_or(0);
        for _ in 0..=rings {
            let before = near.clone();
            for triangles in &self.edges.edge_triangles {
                if triangles.iter().any(|&t| before[t as usize]) {
                    for &t in triangles {
                        near[t as usize] = true;
                    }
                }
            }
        }
        near
    }

    /// The bending matrix of some stencils, with the stiffness or viscosity matrix `law` of each material.
    pub fn matrix(
        &self,
        stencils: &Stencils,
        materials: &Materials,
        law: fn(&Material) -> BendingMatrix,
        elements: &[MembraneElement],
    ) -> ScalarMatrix {
        let laws: Vec<BendingMatrix> = materials.list.iter().map(law).collect();
        self.pattern.filled(|values| {
            for (t, stencil) in stencils.iter().enumerate() {
                let law = laws[materials.of_triangle[t] as usize];
                let stiffness = stencil.stiffness(law) * elements[t].area;
                let mut indices = self.entries[self.start[t]..self.start[t + 1]].iter();
                for p in &stencil.weights {
                    let moment = stiffness * Vector3::from(*p);
                    for (q, &at) in stencil.weights.iter().zip(&mut indices) {
                        values[at as usize] += moment.dot(&Vector3::from(*q));
                    }
                }
            }
        })
    }
}
