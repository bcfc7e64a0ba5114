//! Numbering of a patch's edges: the edges of consecutive vertices get consecutive numbers wherever the mesh
//! allows it, so that eight of them are loaded at once.

use super::octets::WIDTH;
use std::collections::BTreeMap;

/// A chain is a sequence of edges {v, v + stride} of one stride with increasing v. Chains of at least so many
/// edges are numbered by their vertices, edge {v, v + stride} as start + v, with unused numbers at the gaps;
/// the edges of shorter chains are numbered singly.
const MIN_CHAIN_LENGTH: usize = WIDTH;

/// Largest difference between the first vertices of two consecutive edges of a chain.
const MAX_CHAIN_GAP: u32 = WIDTH as u32;

/// Edges by their numbers. Within a chain consecutive vertices have edges of consecutive numbers.
#[derive(Default)]
pub struct Edges {
    /// The vertices of each edge, the lower first; none where the number is unused.
    pub ends: Vec<Option<[u32; 2]>>,
    numbers: BTreeMap<[u32; 2], u32>,
}

impl Edges {
    /// The edges of triangles.
    pub fn new(triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let mut sorted: Vec<(u32, u32)> = triangles
            .flat_map(|[a, b, c]| [[a, b], [a, c], [b, c]])
            .map(|[a, b]| (a.abs_diff(b), a.min(b)))
            .collect();
        sorted.sort_unstable();
        sorted.dedup();
        let follows = |a: &(u32, u32), b: &(u32, u32)| a.0 == b.0 && b.1 - a.1 <= MAX_CHAIN_GAP;
        let mut edges = Self::default();
        let mut single = Vec::new();
        for chain in sorted.chunk_by(follows) {
            if chain.len() < MIN_CHAIN_LENGTH {
                single.extend_from_slice(chain);
                continue;
            }
            let start = edges.ends.len().next_multiple_of(WIDTH) as u32;
            for &(stride, low) in chain {
                edges.insert(start + low - chain[0].1, [low, low + stride]);
            }
        }
        single.sort_unstable_by_key(|&(stride, low)| (low, stride));
        let start = edges.ends.len().next_multiple_of(WIDTH) as u32;
        for (&(stride, low), number) in single.iter().zip(start..) {
            edges.insert(number, [low, low + stride]);
        }
        edges
    }

    fn insert(&mut self, number: u32, ends: [u32; 2]) {
        self.ends.resize(number as usize, None);
        self.ends.push(Some(ends));
        self.numbers.insert(ends, number);
    }

    /// The number of the edge between two vertices; none where no triangle has that edge.
    pub fn number(&self, a: u32, b: u32) -> Option<u32> {
        self.numbers.get(&[a.min(b), a.max(b)]).copied()
    }

    /// The edges with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (u32, [u32; 2])> {
        (0u32..)
            .zip(&self.ends)
            .filter_map(|(n, ends)| Some((n, (*ends)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_has_one_number_and_chains_run_with_their_vertices() {
        // A strip of 40 squares and a triangle of its own.
        let strip = (0..40u32).flat_map(|k| [[k, k + 1, k + 42], [k, k + 42, k + 41]]);
        let edges = Edges::new(strip.chain([[90, 95, 97]]));
        assert_eq!(edges.iter().count(), 40 + 40 + 41 + 40 + 3);
        for (number, [a, b]) in edges.iter() {
            assert_eq!(edges.number(b, a), Some(number));
        }
        let along = edges.number(0, 1).expect("an edge");
        assert!(along.is_multiple_of(WIDTH as u32));
        assert_eq!(edges.number(20, 21), Some(along + 20));
        assert_eq!(edges.number(0, 2), None);
    }
}
