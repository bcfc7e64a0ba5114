//! Parts of the graph that nested dissection cuts.

use super::Graph;
use toile_geometry::Vec3;

/// A part of the graph, with vertices numbered anew and itself left out of its rows.
pub struct Subgraph {
    /// Number in the whole graph of each vertex.
    pub vertices: Vec<u32>,
    /// Where each vertex is (m).
    pub places: Vec<Vec3>,
    start: Vec<u32>,
    adjacent: Vec<u32>,
}

impl Subgraph {
    /// All of a graph, its vertices at some places (m).
    pub fn whole(graph: &Graph, places: &[Vec3]) -> Self {
        let mut subgraph = Self {
            vertices: (0..places.len() as u32).collect(),
            places: places.to_vec(),
            start: vec![0],
            adjacent: Vec::new(),
        };
        for v in 0..places.len() {
            let others = graph.row(v).iter().filter(|&&u| u as usize != v);
            subgraph.adjacent.extend(others);
            subgraph.start.push(subgraph.adjacent.len() as u32);
        }
        subgraph
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
    pub fn parts(&self, label: &[u32], count: usize) -> Vec<Self> {
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
    pub fn components(&self) -> (Vec<u32>, usize) {
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
