//! Sparse Cholesky factorisation on any number of threads with the same bytes: nested dissection,
//! dense fronts in a tree (multifrontal method), independent subtrees and fixed tiles as tasks.
//!
//! The matrix is symmetric and positive definite, of blocks of `D` by `D` numbers over a [`Graph`]
//! of vertices: 3 by 3 for Newton's method, 1 by 1 where x, y and z share one matrix.

mod dense;
mod dissection;
mod graph;
mod layout;
mod numeric;
mod panel;
mod separator;
mod solve;
mod subgraph;
mod symbolic;

pub use dense::Number;
pub use graph::Graph;

use faer::MatMut;
use layout::Layout;
use symbolic::Symbolic;
use toile_geometry::Vec3;

/// An entry of the matrix: what one vertex does to another, by rows.
pub type Block<const D: usize> = [[f64; D]; D];

/// The matrix is not positive definite, or not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite at vertex {vertex}")]
pub struct NotPositive {
    /// Where elimination failed; the cause may be a vertex eliminated before it.
    pub vertex: usize,
}

/// A factorisation whose structure and memory are worked out once for a graph. Cost for a sheet
/// of n vertices: O(n^1.5) operations and O(n log n) numbers.
pub struct Factor<const D: usize, T = f64> {
    graph: Graph,
    symbolic: Symbolic,
    layout: Layout,
    panels: Vec<T>,
    arena: Vec<T>,
    rows: Vec<Block<D>>,
    longest_row: usize,
    unknowns: Vec<T>,
    boundary: Vec<T>,
}

/// Numbers added to a memory so that it can start at a cache line.
const SLACK: usize = 16;

/// The part of a memory that starts at a cache line.
fn aligned<T>(memory: &mut [T], length: usize) -> &mut [T] {
    let skip = memory.as_ptr().align_offset(64).min(SLACK);
    &mut memory[skip..skip + length]
}

impl<const D: usize, T: Number> Factor<D, T> {
    /// Works out the structure of the factor. `places` is any layout of the vertices in space
    /// (where they are, say): it only guides the order of elimination.
    ///
    /// # Panics
    /// When there are not as many places as vertices.
    pub fn new(graph: Graph, places: &[Vec3]) -> Self {
        assert_eq!(
            places.len(),
            graph.vertex_count(),
            "a place for each vertex"
        );
        let nodes = dissection::dissect(&graph, places);
        let symbolic = Symbolic::new(&graph, nodes, D);
        let layout = Layout::new(&symbolic, D);
        let longest_row = graph.longest_row();
        let zeros = |length: usize| vec![T::rounded(0.0); length + SLACK];
        Self {
            panels: zeros(layout.panel.last().copied().unwrap_or(0)),
            arena: zeros(layout.arena),
            rows: vec![[[0.0; D]; D]; longest_row * layout.units.len()],
            longest_row,
            unknowns: Vec::new(),
            boundary: Vec::new(),
            graph,
            symbolic,
            layout,
        }
    }

    /// The graph it was made for.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Operations of one factorisation (flop).
    pub fn operations(&self) -> f64 {
        self.layout.operations
    }

    /// Numbers held: in the factor, and in the memory to compute it.
    pub fn size(&self) -> [usize; 2] {
        [self.panels.len(), self.arena.len()]
    }

    /// Factorises. `fill(v, columns, row)` writes the entries of vertex v's row; `columns` are the
    /// vertices they couple it with, those of `graph().row(v)`. The matrix must be symmetric.
    ///
    /// # Errors
    /// When the matrix is not positive definite or not finite; the factor must not be used then.
    pub fn factorise(
        &mut self,
        fill: impl Fn(usize, &[u32], &mut [Block<D>]) + Sync,
    ) -> Result<(), NotPositive> {
        let elimination = numeric::Elimination {
            graph: &self.graph,
            symbolic: &self.symbolic,
            layout: &self.layout,
            fill: &fill,
            longest_row: self.longest_row,
        };
        let length = self.layout.panel.last().copied().unwrap_or(0);
        elimination.run(numeric::Part {
            panels: aligned(&mut self.panels, length),
            first_panel: 0,
            arena: aligned(&mut self.arena, self.layout.arena),
            first_arena: 0,
            rows: &mut self.rows,
            first_unit: 0,
        })
    }

    /// Solves A x = b for `columns` right-hand sides. A vertex has `D` numbers for the first
    /// right-hand side, then `D` for the second, and so on.
    ///
    /// # Panics
    /// When `b` or `x` is not that long.
    pub fn solve_columns(&mut self, columns: usize, b: &[f64], x: &mut [f64]) {
        let width = D * columns;
        let length = self.graph.vertex_count() * width;
        assert_eq!([b.len(), x.len()], [length; 2], "numbers for each vertex");
        let get = |v: usize, at: usize| b[v * width + at];
        self.solve_with(columns, get, |v, at, value| x[v * width + at] = value);
    }

    /// Solves A x = b for vectors at the vertices: one right-hand side for D = 3; for D = 1 the
    /// three coordinates, each with the same matrix.
    ///
    /// # Panics
    /// When there are not as many vectors as vertices.
    pub fn solve(&mut self, b: &[Vec3], x: &mut [Vec3]) {
        const { assert!(D == 1 || D == 3, "a vector has three numbers") };
        let count = self.graph.vertex_count();
        assert_eq!([b.len(), x.len()], [count; 2], "a vector for each vertex");
        self.solve_with(3 / D, |v, at| b[v][at], |v, at, value| x[v][at] = value);
    }

    fn solve_with(
        &mut self,
        columns: usize,
        get: impl Fn(usize, usize) -> f64,
        mut set: impl FnMut(usize, usize, f64),
    ) {
        let n = self.graph.vertex_count();
        let Some(root) = self.layout.units.len().checked_sub(1) else {
            return;
        };
        if columns == 0 {
            return;
        }
        let zero = T::rounded(0.0);
        self.unknowns.resize(n * D * columns, zero);
        self.boundary
            .resize(self.symbolic.boundary.len() * D * columns, zero);
        for (place, &v) in self.symbolic.order.iter().enumerate() {
            for k in 0..columns {
                for d in 0..D {
                    let value = get(v as usize, k * D + d);
                    self.unknowns[(k * n + place) * D + d] = T::rounded(value);
                }
            }
        }
        let length = self.layout.panel.last().copied().unwrap_or(0);
        let substitution = solve::Substitution {
            symbolic: &self.symbolic,
            layout: &self.layout,
            panels: aligned(&mut self.panels, length),
            unknowns: D,
            columns,
        };
        for backward in [false, true] {
            let part = solve::Part {
                x: MatMut::from_column_major_slice_mut(&mut self.unknowns, n * D, columns),
                first: 0,
                boundary: &mut self.boundary,
                first_boundary: 0,
            };
            if backward {
                substitution.backward(root, part);
            } else {
                substitution.forward(root, part);
            }
        }
        for (place, &v) in self.symbolic.order.iter().enumerate() {
            for k in 0..columns {
                for d in 0..D {
                    let value = self.unknowns[(k * n + place) * D + d];
                    set(v as usize, k * D + d, value.wide());
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
