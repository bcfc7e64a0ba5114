//! The matrix of a Newton step: membrane, contact and inertia in 3x3 blocks over the mesh's edges,
//! bending as scalars two rings far, elastics between any two vertices. Read row by row, and
//! solved by factorisation.

use crate::factor::{Block, Factor, Graph};
use crate::newton::elastics_of;
use crate::sparse::ScalarMatrix;
use crate::{ElasticEnd, Model};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// A symmetric positive semidefinite Hessian; rows of pinned vertices are those of the identity.
pub struct Hessian<'a> {
    pub model: &'a Model,
    /// Bending, with what viscosity adds to it in a step.
    pub bending: &'a ScalarMatrix,
    /// Blocks over the mesh's pattern, everything on the diagonal but bending included.
    pub blocks: &'a [Matrix3<f64>],
    /// Stiffness of each elastic [N/m].
    pub secants: &'a [f64],
}

/// Vertices that the matrix couples.
fn graph(model: &Model) -> Graph {
    let mesh = (0..model.vertex_count()).flat_map(|v| {
        let edges = model.pattern.row_columns(v);
        let bending = model.bending.row_entries(v).0;
        edges.iter().chain(bending).map(move |&u| [v as u32, u])
    });
    Graph::from_pairs(model.vertex_count(), mesh.chain(couples(model)))
}

/// Vertices coupled by elastics.
fn couples(model: &Model) -> impl Iterator<Item = [u32; 2]> + '_ {
    model
        .elastics
        .iter()
        .filter_map(|elastic| match elastic.to {
            ElasticEnd::Vertex(to) => Some([elastic.from, to]),
            ElasticEnd::Point(_) => None,
        })
}

impl Hessian<'_> {
    /// A row times a vector, pins not heeded.
    pub fn row_times(&self, row: usize, p: &[Vec3]) -> Vec3 {
        let model = self.model;
        let mut sum = model.pattern.row_times(row, self.blocks, p) + self.bending.row_times(row, p);
        for (e, other) in elastics_of(model, row) {
            if let ElasticEnd::Vertex(other) = other {
                sum -= p[other as usize] * self.secants[e];
            }
        }
        sum
    }

    /// The block on the diagonal.
    pub fn diagonal(&self, row: usize) -> Matrix3<f64> {
        self.model.pattern.diagonal_block(row, self.blocks)
            + Matrix3::identity() * self.bending.diagonal(row)
    }

    /// Writes a row as the factorisation wants it; `columns` are all that the row may have.
    fn fill_row(&self, row: usize, columns: &[u32], out: &mut [Block<3>]) {
        let model = self.model;
        out.fill([[0.0; 3]; 3]);
        if model.pinned[row] {
            if let Ok(at) = columns.binary_search(&(row as u32)) {
                out[at] = Matrix3::identity().into();
            }
            return;
        }
        let (edges, blocks) = model.pattern.row_entries(row, self.blocks);
        let mut at = 0;
        for (&column, block) in edges.iter().zip(blocks) {
            at = seek(columns, at, column);
            // Matrix3 holds columns, a block rows.
            out[at] = block.transpose().into();
        }
        let (bent, values) = self.bending.row_entries(row);
        let mut at = 0;
        for (&column, &value) in bent.iter().zip(values) {
            at = seek(columns, at, column);
            (0..3).for_each(|k| out[at][k][k] += value);
        }
        for (e, other) in elastics_of(model, row) {
            if let ElasticEnd::Vertex(other) = other {
                let at = seek(columns, 0, other);
                (0..3).for_each(|k| out[at][k][k] -= self.secants[e]);
            }
        }
        for (out, &column) in out.iter_mut().zip(columns) {
            if model.pinned[column as usize] {
                *out = [[0.0; 3]; 3];
            }
        }
    }
}

/// Where a column stands in an ascending list that holds it, from some place on.
fn seek(columns: &[u32], from: usize, column: u32) -> usize {
    let mut at = from;
    while columns[at] < column {
        at += 1;
    }
    at
}

/// A factorisation of such a matrix, its structure worked out once.
pub struct Direct {
    factor: Factor<3>,
    couples: Vec<[u32; 2]>,
}

impl Direct {
    /// Works out the structure for a model; `places` is any layout of the vertices in space.
    pub fn new(model: &Model, places: &[Vec3]) -> Self {
        Self {
            factor: Factor::new(graph(model), places),
            couples: couples(model).collect(),
        }
    }

    /// Whether the structure is that of a model, made from the same mesh as the one it was made
    /// for but perhaps with other elastics.
    pub fn fits(&self, model: &Model) -> bool {
        self.factor.graph().vertex_count() == model.vertex_count()
            && couples(model).eq(self.couples.iter().copied())
    }

    /// Solves A x = b; b must be zero at pins, and so is x. False when the matrix is not
    /// numerically positive definite; `x` is then of no use.
    pub fn solve(&mut self, hessian: &Hessian, b: &[Vec3], x: &mut [Vec3]) -> bool {
        let fill = |row: usize, columns: &[u32], out: &mut [Block<3>]| {
            hessian.fill_row(row, columns, out);
        };
        if self.factor.factorise(fill).is_err() {
            return false;
        }
        self.factor.solve(b, x);
        x.iter().all(|x| x.iter().all(|x| x.is_finite()))
    }
}
