//! Sparse Cholesky factorisation of the Newton matrix, by `faer`, on one thread so that the
//! bytes do not depend on how many there are.

use crate::Model;
use crate::sparse::{BlockPattern, ScalarMatrix};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// A factorisation whose structure is worked out once for a model.
pub struct Direct {
    symbolic: SymbolicCholesky<usize>,
    /// Vertex rows at or below the diagonal of each vertex column.
    start: Vec<usize>,
    rows: Vec<u32>,
    column_pointer: Vec<usize>,
    row_index: Vec<usize>,
    values: Vec<f64>,
    factor: Vec<f64>,
    right: Vec<f64>,
    memory: MemBuffer,
}

/// Vertices left together at the end of the dissection: below this a separator saves nothing.
const LEAF: usize = 48;

impl Direct {
    /// Works out the structure for a model; `place` is any layout of the vertices in space, used
    /// to cut the mesh into halves (nested dissection, George 1973). Nothing when the model has
    /// elastics between vertices or its structure cannot be factorised: the caller then iterates.
    pub fn new(model: &Model, place: &[Vec3]) -> Option<Self> {
        if model
            .elastics
            .iter()
            .any(|e| matches!(e.to, crate::ElasticEnd::Vertex(_)))
        {
            return None;
        }
        let n = model.vertex_count();
        let neighbours = neighbours(&model.pattern, &model.bending, n);
        let (mut start, mut rows) = (vec![0], Vec::new());
        for (v, list) in neighbours.iter().enumerate() {
            rows.extend(list.iter().copied().filter(|&u| u as usize >= v));
            start.push(rows.len());
        }
        let (mut column_pointer, mut row_index) = (vec![0], Vec::new());
        for v in 0..n {
            for c in 0..3 {
                for &row in &rows[start[v]..start[v + 1]] {
                    let first = if row as usize == v { c } else { 0 };
                    row_index.extend((first..3).map(|r| 3 * row as usize + r));
                }
                column_pointer.push(row_index.len());
            }
        }
        let order = dissect(place, &neighbours);
        let forward: Vec<usize> = order
            .iter()
            .flat_map(|&v| [3 * v as usize, 3 * v as usize + 1, 3 * v as usize + 2])
            .collect();
        let mut inverse = vec![0; forward.len()];
        for (at, &dof) in forward.iter().enumerate() {
            inverse[dof] = at;
        }
        let structure =
            SymbolicSparseColMatRef::new_checked(3 * n, 3 * n, &column_pointer, None, &row_index);
        let symbolic = factorize_symbolic_cholesky(
            structure,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, 3 * n)),
            CholeskySymbolicParams::default(),
        )
        .ok()?;
        let need = symbolic
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Some(Self {
            values: vec![0.0; row_index.len()],
            factor: vec![0.0; symbolic.len_val()],
            right: vec![0.0; 3 * n],
            memory: MemBuffer::try_new(need).ok()?,
            symbolic,
            start,
            rows,
            column_pointer,
            row_index,
        })
    }

    /// Solves (blocks + bending) x = b, with pinned rows of x zero. False when the matrix is not
    /// numerically positive definite; `x` is then untouched.
    pub fn solve(
        &mut self,
        model: &Model,
        blocks: &[Matrix3<f64>],
        b: &[Vec3],
        x: &mut [Vec3],
    ) -> bool {
        self.fill(model, blocks);
        let n = 3 * b.len();
        let structure =
            SymbolicSparseColMatRef::new_checked(n, n, &self.column_pointer, None, &self.row_index);
        let matrix = SparseColMatRef::new(structure, &self.values);
        let stack = MemStack::new(&mut self.memory);
        let factor = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            stack,
            Spec::default(),
        );
        let Ok(factor) = factor else { return false };
        for ((right, b), &pinned) in self.right.chunks_exact_mut(3).zip(b).zip(&model.pinned) {
            right.copy_from_slice(if pinned { &[0.0; 3] } else { b.as_slice() });
        }
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, 1);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
        if self.right.iter().any(|r| !r.is_finite()) {
            return false;
        }
        for (x, right) in x.iter_mut().zip(self.right.chunks_exact(3)) {
            *x = Vec3::new(right[0], right[1], right[2]);
        }
        true
    }

    fn fill(&mut self, model: &Model, blocks: &[Matrix3<f64>]) {
        let mut tasks = Vec::with_capacity(self.start.len());
        let mut rest = &mut self.values[..];
        for v in 0..self.start.len() - 1 {
            let length = self.column_pointer[3 * v + 3] - self.column_pointer[3 * v];
            let (head, tail) = rest.split_at_mut(length);
            tasks.push((v, head));
            rest = tail;
        }
        let (start, rows, pointer) = (&self.start, &self.rows, &self.column_pointer);
        tasks.into_par_iter().with_min_len(64).for_each(|(v, out)| {
            let (mut block_at, mut bend_at) = (0, 0);
            let (columns, row_blocks) = model.pattern.row_entries(v, blocks);
            let (bend_columns, bend_values) = model.bending.row_entries(v);
            let base = pointer[3 * v];
            let mut next = [0, pointer[3 * v + 1] - base, pointer[3 * v + 2] - base];
            for &row in &rows[start[v]..start[v + 1]] {
                while block_at < columns.len() && columns[block_at] < row {
                    block_at += 1;
                }
                while bend_at < bend_columns.len() && bend_columns[bend_at] < row {
                    bend_at += 1;
                }
                // The matrix is symmetric: block (row, v) is the transpose of block (v, row).
                let mut block = match columns.get(block_at) {
                    Some(&c) if c == row => row_blocks[block_at].transpose(),
                    _ => Matrix3::zeros(),
                };
                if bend_columns.get(bend_at) == Some(&row) {
                    block += Matrix3::identity() * bend_values[bend_at];
                }
                let diagonal = row as usize == v;
                if model.pinned[v] || model.pinned[row as usize] {
                    block = if diagonal {
                        Matrix3::identity()
                    } else {
                        Matrix3::zeros()
                    };
                }
                for (c, next) in next.iter_mut().enumerate() {
                    for r in if diagonal { c } else { 0 }..3 {
                        out[*next] = block[(r, c)];
                        *next += 1;
                    }
                }
            }
        });
    }
}

/// Sorted union of the columns of both matrices in each row.
fn neighbours(pattern: &BlockPattern, bending: &ScalarMatrix, n: usize) -> Vec<Vec<u32>> {
    (0..n)
        .map(|v| {
            let mut list: Vec<u32> = pattern.row_columns(v).to_vec();
            list.extend(bending.row_entries(v).0);
            list.sort_unstable();
            list.dedup();
            list
        })
        .collect()
}

/// Order of elimination: halves first, then the vertices that separate them, recursively.
fn dissect(place: &[Vec3], neighbours: &[Vec<u32>]) -> Vec<u32> {
    let mut side = vec![0u8; place.len()];
    let mut order = Vec::with_capacity(place.len());
    let mut stack = vec![((0..place.len() as u32).collect::<Vec<_>>(), false)];
    while let Some((mut set, done)) = stack.pop() {
        if done || set.len() <= LEAF {
            order.extend(set);
            continue;
        }
        let first = place[set[0] as usize];
        let (low, high) = set.iter().fold((first, first), |(low, high), &v| {
            (low.inf(&place[v as usize]), high.sup(&place[v as usize]))
        });
        let axis = (high - low).imax();
        let key = |v: u32| place[v as usize][axis];
        set.sort_by(|&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let half = set.len() / 2;
        for (at, &v) in set.iter().enumerate() {
            side[v as usize] = if at < half { 1 } else { 2 };
        }
        let (separator, left): (Vec<u32>, Vec<u32>) = set[..half].iter().partition(|&&v| {
            neighbours[v as usize]
                .iter()
                .any(|&u| side[u as usize] == 2)
        });
        for &v in &set {
            side[v as usize] = 0;
        }
        let right = set[half..].to_vec();
        // Last in, first out: left, then right, then the separator.
        stack.push((separator, true));
        stack.push((right, false));
        stack.push((left, false));
    }
    order
}
