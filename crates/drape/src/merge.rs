//! Merging of vertices by union-find.
//!
//! # Decided with
//! - [`crate::world::World::check_pairs`] (`edit.rs`), [`crate::world`] (`present.rs`, `check_joinable`):
//!   whether a pair may be merged;
//! - [`crate::world`] (`present.rs`, `closed_pairs`), [`crate::sew::SewRun::closed`]: which pairs have come
//!   together;
//! - [`crate::world::World::merge`], [`crate::world::VertexMap`]: merged pairs of a world; numbers of the
//!   merged vertices;
//! - [`crate::world::World::merged_cloth`] (`compile.rs`), [`crate::cloth::Cloth::merged_triangles`]: the
//!   cloth of merged vertices;
//! - [`crate::world`] (`transfer.rs`, `motion`): place and velocity where two vertices meet;
//! - [`crate::garment::GarmentRun::merge`]: a garment: sewn vertices meet half-way and rest;
//! - [`crate::scene_run::SceneRun::surface`]: a written surface drops the same triangles.

use crate::collision::layer_order::BETWEEN_LAYERS;

/// Union-find: sets of vertices, each with its smallest vertex as root.
struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    fn root(&mut self, mut v: u32) -> u32 {
        let parent = &mut self.parent;
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }

    /// Unites two sets, given by their roots. The smaller root remains, so that the result does not depend on the order
    /// of pairs.
    fn join(&mut self, [a, b]: [u32; 2]) {
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

/// Whether a triangle still has three corners when vertices are merged by `target`.
pub fn keeps_corners(triangle: [u32; 3], target: &[u32]) -> bool {
    let [a, b, c] = triangle.map(|v| target[v as usize]);
    a != b && b != c && c != a
}

/// Merges `count` vertices by pairs. Returns the new index of each vertex and the number of new vertices; new indices
/// are in the order of the smallest old vertex.
pub fn merge_map(count: usize, pairs: impl IntoIterator<Item = [u32; 2]>) -> (Vec<u32>, usize) {
    let mut sets = Sets::new(count);
    for pair in pairs {
        let roots = pair.map(|v| sets.root(v));
        sets.join(roots);
    }
    let mut target = vec![0; count];
    let mut next = 0;
    for v in 0..count as u32 {
        let r = sets.root(v);
        if r == v {
            target[v as usize] = next;
            next += 1;
        } else {
            target[v as usize] = target[r as usize];
        }
    }
    (target, next as usize)
}

/// For each pair in order whether it may merge after those before it: not one that would merge two different prescribed
/// vertices unless `together` allows it, and not a missing one.
pub(crate) fn joinable(
    pairs: impl IntoIterator<Item = Option<[u32; 2]>>,
    prescribed: &[bool],
    together: impl Fn(u32, u32) -> bool,
) -> Vec<bool> {
    let mut sets = Sets::new(prescribed.len());
    // A prescribed vertex of each set, at its root.
    let marks = prescribed.iter().enumerate();
    let leaders = marks.map(|(v, &prescribed)| prescribed.then_some(v as u32));
    let mut leader: Vec<Option<u32>> = leaders.collect();
    let mut may = |pair: [u32; 2]| {
        let roots = pair.map(|v| sets.root(v));
        let [a, b] = roots.map(|root| leader[root as usize]);
        if let (Some(a), Some(b)) = (a, b)
            && a != b
            && !together(a, b)
        {
            return false;
        }
        sets.join(roots);
        leader[roots[0].min(roots[1]) as usize] = a.or(b);
        true
    };
    (pairs.into_iter().map(|pair| pair.is_some_and(&mut may))).collect()
}

/// Layer of each merged vertex; [`BETWEEN_LAYERS`] where those of its vertices differ, and empty without layers.
pub(crate) fn merged_layers(layer: &[u16], target: &[u32], count: usize) -> Vec<u16> {
    let mut merged: Vec<Option<u16>> = vec![None; if layer.is_empty() { 0 } else { count }];
    for (&layer, &to) in layer.iter().zip(target) {
        let entry = &mut merged[to as usize];
        *entry = Some(match *entry {
            Some(other) if other != layer => BETWEEN_LAYERS,
            _ => layer,
        });
    }
    let each = merged.into_iter();
    each.map(|layer| layer.unwrap_or(BETWEEN_LAYERS)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_kept_where_they_agree() {
        let merged = merged_layers(&[4, 4, 7, 7, 4], &[0, 0, 1, 2, 2], 3);
        assert_eq!(merged, [4, 7, BETWEEN_LAYERS]);
        assert!(merged_layers(&[], &[0, 0], 1).is_empty());
    }

    #[test]
    fn chains_and_rings_of_pairs_become_one_vertex_each() {
        let (target, count) = merge_map(7, [[5, 1], [3, 5], [1, 3], [6, 2]]);
        assert_eq!(count, 4);
        assert_eq!(target, [0, 1, 2, 1, 3, 1, 2]);
        assert_eq!(merge_map(3, []).0, [0, 1, 2]);
    }
}
