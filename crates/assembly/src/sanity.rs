//! Checks of the sewn mesh: topology after stitched vertices are merged.

use crate::Garment;
use crate::links::Links;
use std::collections::BTreeMap;
use toile_pattern::Draft;

/// Topology of a garment after stitched vertices are merged.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sanity {
    /// Number of connected components.
    pub components: usize,
    /// Number of vertices after sewing.
    pub vertices: usize,
    /// Edges of more than two triangles, as pairs of merged vertices, without those that a multi-ply seam
    /// allows.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges that both triangles traverse in the same direction: the cloth would turn inside out.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Number of triangles with two corners sewn together.
    pub collapsed_triangles: usize,
}

impl Sanity {
    /// Whether there are no faults, apart from possibly several components.
    pub fn is_sound(&self) -> bool {
        self.non_manifold_edges.is_empty()
            && self.inconsistent_edges.is_empty()
            && self.collapsed_triangles == 0
    }
}

/// Merges stitched vertices by union-find and checks the result.
pub fn sanity(draft: &Draft, garment: &Garment) -> Sanity {
    let mut links = Links::new(garment.flat.len());
    for stitch in &garment.stitches {
        links.join(stitch.vertices[0] as usize, stitch.vertices[1] as usize);
    }
    let merged: Vec<u32> = (0..garment.flat.len())
        .map(|v| links.root(v) as u32)
        .collect();
    let mut many_plies = vec![false; garment.flat.len()];
    for stitch in &garment.stitches {
        if draft
            .seams
            .get(stitch.draft_seam)
            .is_some_and(|s| s.multi_ply)
        {
            many_plies[merged[stitch.vertices[0] as usize] as usize] = true;
        }
    }
    let mut report = Sanity::default();
    // For each edge, the number of traversals in either direction.
    let mut walks: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    let mut hang = Links::new(garment.flat.len());
    for triangle in &garment.triangles {
        let t = triangle.map(|v| merged[v as usize]);
        hang.join(t[0] as usize, t[1] as usize);
        hang.join(t[0] as usize, t[2] as usize);
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            report.collapsed_triangles += 1;
            continue;
        }
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            walks.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    for (&edge, &[up, down]) in &walks {
        let plies = edge.iter().all(|&v| many_plies[v as usize]);
        if up + down > 2 && !plies {
            report.non_manifold_edges.push(edge);
        } else if up + down == 2 && up != down {
            report.inconsistent_edges.push(edge);
        }
    }
    let mut used: Vec<u32> = garment
        .triangles
        .iter()
        .flatten()
        .map(|&v| merged[v as usize])
        .collect();
    used.sort_unstable();
    used.dedup();
    report.vertices = used.len();
    let mut roots: Vec<usize> = used.iter().map(|&v| hang.root(v as usize)).collect();
    roots.sort_unstable();
    roots.dedup();
    report.components = roots.len();
    report
}
