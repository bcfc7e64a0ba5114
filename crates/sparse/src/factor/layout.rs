//! Where the numbers of a factorisation live, and which parts of the tree are tasks.
//!
//! What a front hands on stands in an arena until its parent has taken it. Fronts of even depth
//! fill a region from its low end, those of odd depth from its high end, so a front never
//! overlaps its children and a stack serves a whole subtree.

use super::symbolic::{Symbolic, operations};
use std::ops::Range;

/// A part of the tree that one task works through: a small subtree, or one large front.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Its fronts; the last is its root.
    pub fronts: Range<usize>,
    /// Units that hand on to it; none for a subtree.
    pub children: Vec<usize>,
    /// First unit of those that end with this one.
    pub first_unit: usize,
    /// Part of the arena for it and all below it.
    pub region: Range<usize>,
}

/// Offsets of everything, in numbers.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Where each front's columns of the factor start, and where the last ends.
    pub panel: Vec<usize>,
    /// Where in the arena each front hands on.
    pub update: Vec<usize>,
    /// Length of the arena.
    pub arena: usize,
    pub units: Vec<Unit>,
    /// Operations of one factorisation (flop).
    pub operations: f64,
}

/// Numbers in a cache line: columns start at whole lines.
const LINE: usize = 8;
/// Column strides in multiples of this many numbers fall on the same cache sets.
const ALIAS: usize = 512;

/// Subtrees are cut into tasks of at most this share of all operations ...
const TASK_SHARE: f64 = 1.0 / 32.0;
/// ... but not below this many (flop): about 25 microseconds.
const TASK_LEAST: f64 = 1e6;

/// Distance between columns of a dense matrix of so many rows.
pub fn stride(rows: usize) -> usize {
    let stride = rows.next_multiple_of(LINE);
    if stride > 0 && stride.is_multiple_of(ALIAS) {
        stride + LINE
    } else {
        stride
    }
}

impl Layout {
    /// Lays out the fronts of a tree for so many unknowns a vertex.
    pub fn new(symbolic: &Symbolic, unknowns: usize) -> Self {
        let fronts = &symbolic.fronts;
        let mut layout = Self {
            panel: vec![0],
            update: vec![0; fronts.len()],
            ..Self::default()
        };
        let mut below = vec![0.0; fronts.len()];
        for (f, front) in fronts.iter().enumerate() {
            let columns = front.pivots as usize * unknowns;
            let size = stride(front.rows() * unknowns) * columns;
            layout.panel.push(layout.panel[f] + size);
            below[f] = operations(front.pivots as usize, front.boundary as usize, unknowns)
                + front
                    .children
                    .iter()
                    .map(|&c| below[c as usize])
                    .sum::<f64>();
        }
        layout.operations = below.last().copied().unwrap_or(0.0);
        let most = (layout.operations * TASK_SHARE).max(TASK_LEAST);
        layout.find_units(symbolic, &below, most);
        layout.place_updates(symbolic, unknowns);
        layout
    }

    fn find_units(&mut self, symbolic: &Symbolic, below: &[f64], most: f64) {
        let fronts = &symbolic.fronts;
        let mut parent_small = vec![false; fronts.len()];
        for f in (0..fronts.len()).rev() {
            let small = below[f] <= most;
            for &c in &fronts[f].children {
                parent_small[c as usize] = small;
            }
        }
        let mut unit_of = vec![usize::MAX; fronts.len()];
        for (f, front) in fronts.iter().enumerate() {
            if parent_small[f] {
                continue;
            }
            unit_of[f] = self.units.len();
            let small = below[f] <= most;
            let children: Vec<usize> = if small {
                Vec::new()
            } else {
                front
                    .children
                    .iter()
                    .map(|&c| unit_of[c as usize])
                    .collect()
            };
            let first_unit = children
                .first()
                .map_or(self.units.len(), |&c| self.units[c].first_unit);
            self.units.push(Unit {
                fronts: if small { front.first_front as usize } else { f }..f + 1,
                children,
                first_unit,
                region: 0..0,
            });
        }
    }

    /// First the length of each unit's region, then, from the root down, where it starts.
    fn place_updates(&mut self, symbolic: &Symbolic, unknowns: usize) {
        let size: Vec<usize> = symbolic
            .fronts
            .iter()
            .map(|front| {
                let rows = front.boundary as usize * unknowns;
                stride(rows) * rows
            })
            .collect();
        let mut length = vec![0; self.units.len()];
        let mut padding = vec![0; self.units.len()];
        for u in 0..self.units.len() {
            let unit = &self.units[u];
            let root = unit.fronts.end - 1;
            if unit.fronts.len() > 1 || unit.children.is_empty() {
                length[u] = self.stack(symbolic, &size, unit.fronts.clone());
                continue;
            }
            let even = symbolic.fronts[root].depth.is_multiple_of(2);
            // The child beside which the root's own part lies.
            let beside = if even {
                unit.children.first()
            } else {
                unit.children.last()
            };
            if let Some(&c) = beside {
                let free = length[c] - size[self.units[c].fronts.end - 1];
                padding[c] = size[root].saturating_sub(free);
            }
            length[u] = unit.children.iter().map(|&c| length[c] + padding[c]).sum();
        }
        let Some(last) = self.units.len().checked_sub(1) else {
            return;
        };
        self.units[last].region = 0..length[last];
        self.arena = length[last];
        for u in (0..self.units.len()).rev() {
            let unit = self.units[u].clone();
            let root = unit.fronts.end - 1;
            if unit.children.is_empty() {
                self.place_stack(symbolic, &size, &unit);
                continue;
            }
            let even = symbolic.fronts[root].depth.is_multiple_of(2);
            self.update[root] = if even {
                unit.region.start
            } else {
                unit.region.end - size[root]
            };
            let mut at = unit.region.start;
            for &c in &unit.children {
                let start = if even { at + padding[c] } else { at };
                self.units[c].region = start..start + length[c];
                at += length[c] + padding[c];
            }
        }
    }

    /// Length of a region in which a subtree can be worked through.
    fn stack(&mut self, symbolic: &Symbolic, size: &[usize], fronts: Range<usize>) -> usize {
        let (mut top, mut most) = ([0, 0], 0);
        for f in fronts {
            let end = (symbolic.fronts[f].depth % 2) as usize;
            // Counted from the low end or from the high end; made absolute in `place_stack`.
            self.update[f] = top[end];
            top[end] += size[f];
            most = most.max(top[0] + top[1]);
            let children = symbolic.fronts[f].children.iter();
            top[1 - end] -= children.map(|&c| size[c as usize]).sum::<usize>();
        }
        most
    }

    fn place_stack(&mut self, symbolic: &Symbolic, size: &[usize], unit: &Unit) {
        for f in unit.fronts.clone() {
            self.update[f] = if symbolic.fronts[f].depth.is_multiple_of(2) {
                unit.region.start + self.update[f]
            } else {
                unit.region.end - self.update[f] - size[f]
            };
        }
    }
}
