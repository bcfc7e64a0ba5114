//! The edges of a patch in an order in which neighbours of neighbours lie side by side.

use super::octets::WIDTH;
use std::collections::BTreeMap;

/// Edges between vertices that lie as far apart in the patch, one after the other, are a chain;
/// from so many on it keeps a place for every vertex it passes.
const CHAIN: usize = WIDTH;

/// Vertices without such an edge that a chain passes over.
const GAP: u32 = WIDTH as u32;

/// Edges by their numbers. In a chain the numbers run with the vertices, so that what is side by
/// side for vertices is so for edges too.
#[derive(Default)]
pub struct Edges {
    /// The ends of each, the lower first; nothing where no edge is.
    pub ends: Vec<Option<[u32; 2]>>,
    numbers: BTreeMap<[u32; 2], u32>,
}

impl Edges {
    /// Of triangles.
    pub fn new(triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let mut sorted: Vec<(u32, u32)> = triangles
            .flat_map(|[a, b, c]| [[a, b], [a, c], [b, c]])
            .map(|[a, b]| (a.abs_diff(b), a.min(b)))
            .collect();
        sorted.sort_unstable();
        sorted.dedup();
        let follows = |a: &(u32, u32), b: &(u32, u32)| a.0 == b.0 && b.1 - a.1 <= GAP;
        let mut edges = Self::default();
        let mut single = Vec::new();
        for chain in sorted.chunk_by(follows) {
            if chain.len() < CHAIN {
                single.extend_from_slice(chain);
                continue;
            }
            let start = edges.ends.len().next_multiple_of(WIDTH) as u32;
            for &(apart, low) in chain {
                edges.put(start + low - chain[0].1, [low, low + apart]);
            }
        }
        single.sort_unstable_by_key(|&(apart, low)| (low, apart));
        let start = edges.ends.len().next_multiple_of(WIDTH) as u32;
        for (&(apart, low), number) in single.iter().zip(start..) {
            edges.put(number, [low, low + apart]);
        }
        edges
    }

    fn put(&mut self, number: u32, ends: [u32; 2]) {
        self.ends.resize(number as usize, None);
        self.ends.push(Some(ends));
        self.numbers.insert(ends, number);
    }

    /// The number of the edge between two vertices; every side of a triangle has one.
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
