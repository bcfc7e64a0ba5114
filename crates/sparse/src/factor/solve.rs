//! Solving with the factor: L y = b from the leaves to the root, L^T x = y back from the root.
//!
//! Each front has its own short vector for what it hands on to (forward) or takes from (backward)
//! the vertices of its boundary, so that subtrees are independent and sums have one order.

use super::dense::Number;
use super::layout::Layout;
use super::panel::Panel;
use super::symbolic::{FrontalMatrix, Symbolic};
use faer::MatMut;
use faer::prelude::ReborrowMut;

/// What a task needs to read.
pub struct Substitution<'a, T> {
    pub symbolic: &'a Symbolic,
    pub layout: &'a Layout,
    pub panels: &'a [T],
    /// Unknowns of a vertex.
    pub unknowns: usize,
    /// Right-hand sides.
    pub columns: usize,
}

/// What a task may write: its own part, and where that starts in vertices.
pub struct Part<'a, T> {
    /// The unknowns in the order of elimination, a column for each right-hand side.
    pub x: MatMut<'a, T>,
    pub first: usize,
    /// The fronts' own vectors, one after the other.
    pub boundary: &'a mut [T],
    pub first_boundary: usize,
}

impl<'a, T: Number> Part<'a, T> {
    fn borrow(&mut self) -> Part<'_, T> {
        Part {
            x: self.x.rb_mut(),
            first: self.first,
            boundary: self.boundary,
            first_boundary: self.first_boundary,
        }
    }
}

impl<T: Number> Substitution<'_, T> {
    /// Numbers per vertex in the fronts' own vectors.
    fn width(&self) -> usize {
        self.unknowns * self.columns
    }

    /// Cut where the subtree of a unit starts.
    fn split<'b>(&self, part: Part<'b, T>, unit: usize) -> (Part<'b, T>, Part<'b, T>) {
        let units = &self.layout.units;
        let front = &self.symbolic.fronts[units[units[unit].first_unit].fronts.start];
        let (first, boundary) = (front.first as usize, front.boundary_start);
        let (x, more_x) = part
            .x
            .split_at_row_mut((first - part.first) * self.unknowns);
        let (low, high) = part
            .boundary
            .split_at_mut((boundary - part.first_boundary) * self.width());
        (
            Part {
                x,
                first: part.first,
                boundary: low,
                first_boundary: part.first_boundary,
            },
            Part {
                x: more_x,
                first,
                boundary: high,
                first_boundary: boundary,
            },
        )
    }

    /// Columns of the factor that belong to a front.
    fn panel(&self, f: usize) -> Panel<'_, T> {
        let front = &self.symbolic.fronts[f];
        Panel::new(
            &self.panels[self.layout.panel[f]..self.layout.panel[f + 1]],
            front.pivots as usize * self.unknowns,
            front.boundary as usize * self.unknowns,
        )
    }

    /// L y = b for a unit and all below it, in place.
    pub fn forward(&self, unit: usize, mut part: Part<'_, T>) {
        let unit = &self.layout.units[unit];
        self.forward_all(&unit.children, part.borrow());
        for f in unit.fronts.clone() {
            self.forward_front(f, &mut part);
        }
    }

    fn forward_all(&self, units: &[usize], part: Part<'_, T>) {
        match units {
            [] => {}
            [unit] => self.forward(*unit, part),
            _ => {
                let (head, tail) = units.split_at(units.len() / 2);
                let (low, high) = self.split(part, tail[0]);
                rayon::join(
                    || self.forward_all(head, low),
                    || self.forward_all(tail, high),
                );
            }
        }
    }

    fn own<'b>(
        &self,
        front: &FrontalMatrix,
        boundary: &'b mut [T],
        first: usize,
    ) -> (&'b [T], &'b mut [T]) {
        let at = (front.boundary_start - first) * self.width();
        let (before, own) = boundary.split_at_mut(at);
        (before, &mut own[..front.boundary as usize * self.width()])
    }

    fn forward_front(&self, f: usize, part: &mut Part<'_, T>) {
        let front = &self.symbolic.fronts[f];
        let (d, pivots) = (self.unknowns, front.pivots as usize);
        let rows = front.boundary as usize * d;
        let (before, own) = self.own(front, part.boundary, part.first_boundary);
        own.fill(T::rounded(0.0));
        let mut pivot_rows = part
            .x
            .rb_mut()
            .subrows_mut((front.first as usize - part.first) * d, pivots * d);
        for &c in &front.children {
            let child = &self.symbolic.fronts[c as usize];
            let child_rows = child.boundary as usize * d;
            let at = (child.boundary_start - part.first_boundary) * self.width();
            for k in 0..self.columns {
                let source = &before[at + k * child_rows..][..child_rows];
                for run in &child.runs {
                    for i in 0..run.length as usize * d {
                        let value = source[run.from as usize * d + i];
                        let to = run.to as usize * d + i;
                        if to < pivots * d {
                            pivot_rows[(to, k)] += value;
                        } else {
                            own[k * rows + to - pivots * d] += value;
                        }
                    }
                }
            }
        }
        if pivots == 0 {
            return;
        }
        self.panel(f).forward(pivot_rows, own);
    }

    /// L^T x = y for a unit and all below it, in place; `above` holds what follows its part.
    pub fn backward(&self, unit: usize, mut part: Part<'_, T>) {
        let unit = &self.layout.units[unit];
        for f in unit.fronts.clone().rev() {
            self.backward_front(f, &mut part);
        }
        self.backward_all(&unit.children, part);
    }

    fn backward_all(&self, units: &[usize], part: Part<'_, T>) {
        match units {
            [] => {}
            [unit] => self.backward(*unit, part),
            _ => {
                let (head, tail) = units.split_at(units.len() / 2);
                let (low, high) = self.split(part, tail[0]);
                rayon::join(
                    || self.backward_all(head, low),
                    || self.backward_all(tail, high),
                );
            }
        }
    }

    /// Own boundary is already filled by the parent; solves for the pivots and fills the
    /// boundaries of the children.
    fn backward_front(&self, f: usize, part: &mut Part<'_, T>) {
        let front = &self.symbolic.fronts[f];
        let (d, pivots) = (self.unknowns, front.pivots as usize);
        let rows = front.boundary as usize * d;
        let at = (front.boundary_start - part.first_boundary) * self.width();
        let (before, own) = part.boundary.split_at_mut(at);
        let own = &own[..rows * self.columns];
        let mut pivot_rows = part
            .x
            .rb_mut()
            .subrows_mut((front.first as usize - part.first) * d, pivots * d);
        if pivots > 0 {
            self.panel(f).backward(pivot_rows.rb_mut(), own);
        }
        for &c in &front.children {
            let child = &self.symbolic.fronts[c as usize];
            let child_rows = child.boundary as usize * d;
            let at = (child.boundary_start - part.first_boundary) * self.width();
            for k in 0..self.columns {
                let target = &mut before[at + k * child_rows..][..child_rows];
                for run in &child.runs {
                    for i in 0..run.length as usize * d {
                        let to = run.to as usize * d + i;
                        target[run.from as usize * d + i] = if to < pivots * d {
                            pivot_rows[(to, k)]
                        } else {
                            own[k * rows + to - pivots * d]
                        };
                    }
                }
            }
        }
    }
}
