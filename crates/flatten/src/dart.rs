//! Cuts of darts: a surface opened along edges from its outline to a vertex inside.

use crate::ordered::Ordered;
use crate::{FlattenError, Region};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use toile_geometry::{TriangleMesh, Vec3};

/// A surface opened along a path.
pub struct Opened {
    /// The surface; the vertices that were there keep their numbers.
    pub region: Region,
    /// The leg on the left of the path, from the mouth to the apex.
    pub left: Vec<u32>,
    /// The leg on the right, from the mouth to the apex.
    pub right: Vec<u32>,
}

/// Opens a surface along a path of edges from its outline to a vertex inside.
///
/// # Errors
/// The path does not begin at the outline, touches it again, repeats a vertex, or leaves the edges.
pub fn open(region: &Region, path: &[u32], cut: usize) -> Result<Opened, FlattenError> {
    let refuse = |why| Err(FlattenError::Cut { cut, why });
    let count = region.vertex_count();
    let mut on_outline = vec![false; count];
    for &v in region.outline() {
        on_outline[v as usize] = true;
    }
    if path.len() < 2 {
        return refuse("has fewer than two vertices");
    }
    if path.iter().any(|&v| v as usize >= count) {
        return refuse("names a vertex that is not there");
    }
    if !on_outline[path[0] as usize] {
        return refuse("does not begin at the outline");
    }
    if path[1..].iter().any(|&v| on_outline[v as usize]) {
        return refuse("touches the outline again");
    }
    let mut sorted = path.to_vec();
    sorted.sort_unstable();
    if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
        return refuse("repeats a vertex");
    }
    let mesh = region.mesh();
    let topology = mesh.topology();
    let mut is_cut = vec![false; topology.edges.len()];
    for pair in path.windows(2) {
        match topology.edge(pair[0], pair[1]) {
            Some(edge) => is_cut[edge] = true,
            None => return refuse("leaves the edges of the mesh"),
        }
    }
    // The triangles on the right of the path get vertices of their own.
    let mut positions = mesh.positions.clone();
    let mut triangles = mesh.triangles.clone();
    let mut right = Vec::with_capacity(path.len());
    for (k, &v) in path[..path.len() - 1].iter().enumerate() {
        let twin = positions.len() as u32;
        positions.push(positions[v as usize]);
        right.push(twin);
        let next = path[k + 1];
        let is_right = |t: &[u32; 3]| {
            let at = t.iter().position(|&w| w == next);
            at.is_some_and(|at| t[(at + 1) % 3] == v)
        };
        let Some(start) = mesh.triangles.iter().position(is_right) else {
            return refuse("leaves the edges of the mesh");
        };
        // Round the vertex from there, as far as no edge of the cut is crossed.
        let mut found = vec![start];
        let mut at = 0;
        while let Some(&t) = found.get(at) {
            at += 1;
            for &edge in &topology.triangle_edges[t] {
                let edge = edge as usize;
                if is_cut[edge] || !topology.edges[edge].contains(&v) {
                    continue;
                }
                for &other in &topology.edge_triangles[edge] {
                    if !found.contains(&(other as usize)) {
                        found.push(other as usize);
                    }
                }
            }
        }
        for t in found {
            for corner in &mut triangles[t] {
                if *corner == v {
                    *corner = twin;
                }
            }
        }
    }
    right.push(path[path.len() - 1]);
    Ok(Opened {
        region: Region::new(&TriangleMesh {
            positions,
            triangles,
        })?,
        left: path.to_vec(),
        right,
    })
}

/// The shortest ways along edges from starts to all vertices: lengths (m), and the vertex before each.
/// Vertices that are barred are not passed.
pub fn shortest_ways(
    mesh: &TriangleMesh,
    starts: &[u32],
    barred: &[bool],
) -> (Vec<f64>, Vec<Option<u32>>) {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for &[a, b] in &mesh.topology().edges {
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
    }
    let length = |a: u32, b: u32| -> f64 {
        let way: Vec3 = mesh.positions[a as usize] - mesh.positions[b as usize];
        way.norm()
    };
    let mut reached = vec![f64::INFINITY; mesh.positions.len()];
    let mut before = vec![None; mesh.positions.len()];
    let mut open = BinaryHeap::new();
    for &start in starts {
        reached[start as usize] = 0.0;
        open.push(Reverse((Ordered(0.0), start)));
    }
    while let Some(Reverse((Ordered(way), v))) = open.pop() {
        if way > reached[v as usize] {
            continue;
        }
        for &u in &neighbours[v as usize] {
            let longer = way + length(v, u);
            if !barred[u as usize] && longer < reached[u as usize] {
                reached[u as usize] = longer;
                before[u as usize] = Some(v);
                open.push(Reverse((Ordered(longer), u)));
            }
        }
    }
    (reached, before)
}

/// The way that [`shortest_ways`] found to a vertex, from its start on.
pub fn way_to(before: &[Option<u32>], vertex: u32) -> Vec<u32> {
    let mut way = vec![vertex];
    let mut at = vertex;
    while let Some(previous) = before[at as usize] {
        way.push(previous);
        at = previous;
    }
    way.reverse();
    way
}
