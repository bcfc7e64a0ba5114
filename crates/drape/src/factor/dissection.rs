//! Nested dissection (George 1973): the graph is cut in two by as few vertices as will do, both
//! sides are cut again, and so on. Eliminating the separators last keeps the factor sparse.

use super::Graph;
use super::separator::{SEPARATOR, separate};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// A set of vertices that are eliminated together, after those of its children.
#[derive(Clone, Debug, Default)]
pub struct Node {
    pub pivots: Vec<u32>,
    pub children: Vec<u32>,
}

/// Vertices left together: below this a separator would be a large part of what it cuts.
const LEAF: usize = 16;

/// Vertices above which the two sides of a cut are worth a task each.
const TASK: usize = 1000;

/// A part of the graph, with vertices numbered anew and itself left out of its rows.
pub struct Piece {
    vertices: Vec<u32>,
    /// Where each vertex is [m].
    pub places: Vec<Vec3>,
    start: Vec<u32>,
    adjacent: Vec<u32>,
}

impl Piece {
    fn whole(graph: &Graph, places: &[Vec3]) -> Self {
        let mut piece = Self {
            vertices: (0..places.len() as u32).collect(),
            places: places.to_vec(),
            start: vec![0],
            adjacent: Vec::new(),
        };
        for v in 0..places.len() {
            let others = graph.row(v).iter().filter(|&&u| u as usize != v);
            piece.adjacent.extend(others);
            piece.start.push(piece.adjacent.len() as u32);
        }
        piece
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Number of pairs of neighbours, both ways.
    pub fn entries(&self) -> usize {
        self.adjacent.len()
    }

    /// Neighbours of a vertex.
    pub fn neighbours(&self, v: usize) -> &[u32] {
        &self.adjacent[self.start[v] as usize..self.start[v + 1] as usize]
    }

    /// The parts with labels 0 to `count`; vertices with other labels are left out.
    fn parts(&self, label: &[u32], count: usize) -> Vec<Self> {
        let mut members = vec![Vec::new(); count];
        let mut local = vec![u32::MAX; self.len()];
        for (v, &l) in label.iter().enumerate() {
            if let Some(list) = members.get_mut(l as usize) {
                local[v] = list.len() as u32;
                list.push(v);
            }
        }
        members
            .into_iter()
            .enumerate()
            .map(|(l, list)| {
                let mut part = Self {
                    vertices: list.iter().map(|&v| self.vertices[v]).collect(),
                    places: list.iter().map(|&v| self.places[v]).collect(),
                    start: vec![0],
                    adjacent: Vec::new(),
                };
                for &v in &list {
                    let inside = self.neighbours(v).iter().map(|&u| u as usize);
                    part.adjacent
                        .extend(inside.filter(|&u| label[u] == l as u32).map(|u| local[u]));
                    part.start.push(part.adjacent.len() as u32);
                }
                part
            })
            .collect()
    }

    /// A label for every vertex: which connected component it is in; and how many there are.
    fn components(&self) -> (Vec<u32>, usize) {
        let mut label = vec![u32::MAX; self.len()];
        let (mut count, mut stack) = (0, Vec::new());
        for first in 0..self.len() {
            if label[first] != u32::MAX {
                continue;
            }
            label[first] = count;
            stack.push(first);
            while let Some(v) = stack.pop() {
                for &u in self.neighbours(v) {
                    if label[u as usize] == u32::MAX {
                        label[u as usize] = count;
                        stack.push(u as usize);
                    }
                }
            }
            count += 1;
        }
        (label, count as usize)
    }
}

/// The tree of separators of a graph; children stand before their parents, the root is last.
/// `places` is any layout of the vertices in space.
pub fn dissect(graph: &Graph, places: &[Vec3]) -> Vec<Node> {
    tree(Piece::whole(graph, places))
}

fn tree(piece: Piece) -> Vec<Node> {
    let leaf = |piece: Piece| {
        vec![Node {
            pivots: piece.vertices,
            children: Vec::new(),
        }]
    };
    if piece.len() <= LEAF {
        return leaf(piece);
    }
    let (component, count) = piece.components();
    let (parts, pivots) = if count > 1 {
        (piece.parts(&component, count), Vec::new())
    } else if let Some((side, separator)) = separate(&piece) {
        debug_assert!(separator.iter().all(|&v| side[v as usize] == SEPARATOR));
        let pivots = separator.iter().map(|&v| piece.vertices[v as usize]);
        (piece.parts(&side, 2), pivots.collect())
    } else {
        return leaf(piece);
    };
    let large = piece.len() > TASK;
    drop(piece);
    let trees: Vec<Vec<Node>> = if large {
        parts.into_par_iter().map(tree).collect()
    } else {
        parts.into_iter().map(tree).collect()
    };
    let mut all = Vec::new();
    let mut root = Node {
        pivots,
        children: Vec::new(),
    };
    for mut nodes in trees {
        let first = all.len() as u32;
        for node in &mut nodes {
            for child in &mut node.children {
                *child += first;
            }
        }
        all.append(&mut nodes);
        root.children.push(all.len() as u32 - 1);
    }
    all.push(root);
    all
}
