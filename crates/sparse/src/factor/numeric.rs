//! The numbers of the factor: fronts are assembled and eliminated from the leaves to the root,
//! independent subtrees at the same time.

use super::dense::{self, Number};
use super::layout::{Layout, stride};
use super::symbolic::Symbolic;
use super::{Block, Graph, NotPositive};
use faer::prelude::Reborrow;
use faer::prelude::ReborrowMut;
use faer::{Accum, MatMut};

/// What a task needs to read.
pub struct Elimination<'a, F, const D: usize> {
    pub graph: &'a Graph,
    pub symbolic: &'a Symbolic,
    pub layout: &'a Layout,
    /// Writes the entries of a vertex's row.
    pub fill: &'a F,
    /// Length of the longest row.
    pub longest_row: usize,
}

/// What a task may write: its own part of each memory, and where that part starts.
pub struct Part<'a, T, const D: usize> {
    pub panels: &'a mut [T],
    pub first_panel: usize,
    pub arena: &'a mut [T],
    pub first_arena: usize,
    /// A row of entries for every unit.
    pub rows: &'a mut [Block<D>],
    pub first_unit: usize,
}

impl<'a, T, const D: usize> Part<'a, T, D> {
    fn borrow(&mut self) -> Part<'_, T, D> {
        Part {
            panels: self.panels,
            first_panel: self.first_panel,
            arena: self.arena,
            first_arena: self.first_arena,
            rows: self.rows,
            first_unit: self.first_unit,
        }
    }

    /// Cut where a unit and all below it start.
    fn split(self, panel: usize, arena: usize, unit: usize, longest_row: usize) -> (Self, Self) {
        let (panels, more_panels) = self.panels.split_at_mut(panel - self.first_panel);
        let (low, high) = self.arena.split_at_mut(arena - self.first_arena);
        let (rows, more_rows) = self
            .rows
            .split_at_mut((unit - self.first_unit) * longest_row);
        let head = Self {
            panels,
            first_panel: self.first_panel,
            arena: low,
            first_arena: self.first_arena,
            rows,
            first_unit: self.first_unit,
        };
        let tail = Self {
            panels: more_panels,
            first_panel: panel,
            arena: high,
            first_arena: arena,
            rows: more_rows,
            first_unit: unit,
        };
        (head, tail)
    }
}

/// Entries of a front assembled by one task.
const ASSEMBLY: usize = 1 << 16;

/// A square that a front hands on, by columns.
struct Handed<'a, T> {
    front: usize,
    values: &'a [T],
}

/// Some columns of a front: those of `first..` with rows from `top` on, both counted in vertices.
struct Columns<'a, T> {
    first: usize,
    top: usize,
    stride: usize,
    values: &'a mut [T],
}

/// The earlier of two failures, so that the same one is named at any number of threads.
fn both(a: Result<(), u32>, b: Result<(), u32>) -> Result<(), u32> {
    match (a, b) {
        (Err(a), Err(b)) => Err(a.min(b)),
        (a, b) => a.and(b),
    }
}

impl<F: Fn(usize, &[u32], &mut [Block<D>]) + Sync, const D: usize> Elimination<'_, F, D> {
    /// Factorises the whole tree.
    pub fn run<T: Number>(&self, part: Part<'_, T, D>) -> Result<(), NotPositive> {
        let Some(root) = self.layout.units.len().checked_sub(1) else {
            return Ok(());
        };
        self.unit(root, part).map_err(|place| NotPositive {
            vertex: self.symbolic.order[place as usize] as usize,
        })
    }

    fn unit<T: Number>(&self, unit: usize, mut part: Part<'_, T, D>) -> Result<(), u32> {
        let unit = &self.layout.units[unit];
        self.units(&unit.children, part.borrow())?;
        for f in unit.fronts.clone() {
            self.front(f, &mut part)?;
        }
        Ok(())
    }

    fn units<T: Number>(&self, units: &[usize], part: Part<'_, T, D>) -> Result<(), u32> {
        match units {
            [] => Ok(()),
            [unit] => self.unit(*unit, part),
            _ => {
                let (head, tail) = units.split_at(units.len() / 2);
                let next = &self.layout.units[tail[0]];
                let first = &self.layout.units[next.first_unit];
                let panel = self.layout.panel[first.fronts.start];
                let (low, high) =
                    part.split(panel, next.region.start, next.first_unit, self.longest_row);
                let (a, b) = rayon::join(|| self.units(head, low), || self.units(tail, high));
                both(a, b)
            }
        }
    }

    fn front<T: Number>(&self, f: usize, part: &mut Part<'_, T, D>) -> Result<(), u32> {
        let (symbolic, layout) = (self.symbolic, self.layout);
        let front = &symbolic.fronts[f];
        let pivots = front.pivots as usize * D;
        let boundary = front.boundary as usize * D;
        let panel = &mut part.panels
            [layout.panel[f] - part.first_panel..layout.panel[f + 1] - part.first_panel];
        let size = stride(boundary) * boundary;
        let at = layout.update[f] - part.first_arena;
        let even = front.depth.is_multiple_of(2);
        let (own, rest, rest_first) = if even {
            let (own, rest) = part.arena.split_at_mut(at + size);
            (&mut own[at..], rest, part.first_arena + at + size)
        } else {
            let (rest, own) = part.arena.split_at_mut(at);
            (&mut own[..size], rest, part.first_arena)
        };
        let rest = &*rest;
        let handed = |c: u32| {
            let rows = symbolic.fronts[c as usize].boundary as usize * D;
            let at = layout.update[c as usize] - rest_first;
            Handed {
                front: c as usize,
                values: &rest[at..at + stride(rows) * rows],
            }
        };
        let panel_stride = stride(pivots + boundary);
        self.assemble(
            f,
            Columns {
                first: 0,
                top: 0,
                stride: panel_stride,
                values: panel,
            },
            &handed,
        );
        let rows = &mut part.rows[..self.longest_row];
        self.enter(f, panel, rows);
        // Nothing is handed on to a leaf: its own part is written, not added to.
        let leaf = front.children.is_empty();
        if !leaf {
            self.assemble(
                f,
                Columns {
                    first: front.pivots as usize,
                    top: front.pivots as usize,
                    stride: stride(boundary),
                    values: own,
                },
                &handed,
            );
        }
        if pivots == 0 {
            return Ok(());
        }
        let mut panel = MatMut::from_column_major_slice_with_stride_mut(
            panel,
            pivots + boundary,
            pivots,
            panel_stride,
        );
        dense::factorise(panel.rb_mut()).map_err(|column| front.first + (column / D) as u32)?;
        if boundary > 0 {
            let own = MatMut::from_column_major_slice_with_stride_mut(
                own,
                boundary,
                boundary,
                stride(boundary),
            );
            let into = if leaf { Accum::Replace } else { Accum::Add };
            dense::subtract_square(own, panel.rb().split_at_row(pivots).1, into);
        }
        Ok(())
    }

    /// Adds the entries of the matrix in the columns of a front's pivots.
    fn enter<T: Number>(&self, f: usize, panel: &mut [T], rows: &mut [Block<D>]) {
        let symbolic = self.symbolic;
        let front = &symbolic.fronts[f];
        let stride = stride(front.rows() * D);
        for (at, place) in (front.first..front.first + front.pivots).enumerate() {
            let place = place as usize;
            let vertex = symbolic.order[place] as usize;
            let columns = self.graph.row(vertex);
            let row = &mut rows[..columns.len()];
            (self.fill)(vertex, columns, row);
            for slot in &symbolic.slots[symbolic.slot_start[place]..symbolic.slot_start[place + 1]]
            {
                // By symmetry the column of a vertex is its row.
                for (c, values) in row[slot.entry as usize].iter().enumerate() {
                    let first = (at * D + c) * stride + slot.row as usize * D;
                    for (out, &value) in panel[first..first + D].iter_mut().zip(values) {
                        *out += T::rounded(value);
                    }
                }
            }
        }
    }

    /// Clears some columns of a front and adds what its children hand on to them.
    fn assemble<'h, T: Number>(
        &self,
        f: usize,
        columns: Columns<'_, T>,
        handed: &(impl Fn(u32) -> Handed<'h, T> + Sync),
    ) {
        let count = columns.values.len() / columns.stride.max(1) / D;
        if count > 1 && columns.values.len() > ASSEMBLY {
            let half = count / 2;
            let (left, right) = columns.values.split_at_mut(half * D * columns.stride);
            let part = |first, values| Columns {
                first,
                values,
                ..columns
            };
            let left = part(columns.first, left);
            let right = part(columns.first + half, right);
            rayon::join(
                || self.assemble(f, left, handed),
                || self.assemble(f, right, handed),
            );
            return;
        }
        let Columns {
            first,
            top,
            stride,
            values,
        } = columns;
        for (k, column) in values.chunks_exact_mut(stride.max(1)).enumerate() {
            let diagonal = (first + k / D - top) * D;
            column[diagonal..].fill(T::rounded(0.0));
        }
        for &c in &self.symbolic.fronts[f].children {
            let part = Columns {
                first,
                top,
                stride,
                values: &mut *values,
            };
            self.extend_add(part, &handed(c), count);
        }
    }

    fn extend_add<T: Number>(&self, columns: Columns<'_, T>, handed: &Handed<'_, T>, count: usize) {
        let child = &self.symbolic.fronts[handed.front];
        let child_stride = stride(child.boundary as usize * D);
        let (first, last) = (columns.first, columns.first + count);
        for (at, run) in child.runs.iter().enumerate() {
            let (from, to, length) = (run.from as usize, run.to as usize, run.length as usize);
            for k in first.saturating_sub(to)..length.min(last.saturating_sub(to)) {
                for d in 0..D {
                    let source =
                        &handed.values[((from + k) * D + d) * child_stride..][..child_stride];
                    let target = &mut columns.values[((to + k - first) * D + d) * columns.stride..]
                        [..columns.stride];
                    let mut add = |from: usize, to: usize, length: usize| {
                        let source = &source[from * D..(from + length) * D];
                        let to = to - columns.top;
                        let target = &mut target[to * D..(to + length) * D];
                        for (t, s) in target.iter_mut().zip(source) {
                            *t += *s;
                        }
                    };
                    add(from + k, to + k, length - k);
                    for run in &child.runs[at + 1..] {
                        add(run.from as usize, run.to as usize, run.length as usize);
                    }
                }
            }
        }
    }
}
