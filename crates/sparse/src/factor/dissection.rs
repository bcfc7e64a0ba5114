//! Nested dissection (George 1973): the graph is cut in two by as few vertices as will do, both
//! sides are cut again, and so on. Eliminating the separators last keeps the factor sparse.

use super::Graph;
use super::separator::{SEPARATOR, separate};
use super::subgraph::Subgraph;
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

/// The tree of separators of a graph; children stand before their parents, the root is last.
/// `places` is any layout of the vertices in space.
pub fn dissect(graph: &Graph, places: &[Vec3]) -> Vec<Node> {
    tree(Subgraph::whole(graph, places))
}

fn tree(graph: Subgraph) -> Vec<Node> {
    let leaf = |graph: Subgraph| {
        vec![Node {
            pivots: graph.vertices,
            children: Vec::new(),
        }]
    };
    if graph.len() <= LEAF {
        return leaf(graph);
    }
    let (component, count) = graph.components();
    let (parts, pivots) = if count > 1 {
        (graph.parts(&component, count), Vec::new())
    } else if let Some((side, separator)) = separate(&graph) {
        debug_assert!(separator.iter().all(|&v| side[v as usize] == SEPARATOR));
        let pivots = separator.iter().map(|&v| graph.vertices[v as usize]);
        (graph.parts(&side, 2), pivots.collect())
    } else {
        return leaf(graph);
    };
    let large = graph.len() > TASK;
    drop(graph);
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
