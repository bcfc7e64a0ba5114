//! A surface that can be flattened: one piece, two sides, one outline, no handle.

use crate::FlattenError;
use toile_geometry::{Topology, TriangleMesh, Vec2, Vec3};

/// Most vertices of a surface.
pub const MAX_VERTICES: usize = 1_000_000;

/// Least height of a triangle as a share of its longest side (1).
pub const MIN_HEIGHT: f64 = 1e-6;

/// A disk of triangles in space.
#[derive(Clone, Debug)]
pub struct Region {
    mesh: TriangleMesh,
    outline: Vec<u32>,
    flat: Vec<[Vec2; 3]>,
}

impl Region {
    /// Takes a surface that is a disk. Vertices that no triangle uses are left out, triangles that face another way than
    /// most are turned round.
    ///
    /// # Errors
    /// The surface is empty, damaged, in pieces, branched, one-sided, closed, or has holes or handles.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, FlattenError> {
        if mesh.triangles.is_empty() {
            return Err(FlattenError::Empty);
        }
        if mesh.positions.len() > MAX_VERTICES {
            return Err(FlattenError::TooLarge {
                count: mesh.positions.len(),
                most: MAX_VERTICES,
            });
        }
        mesh.check()?;
        let mut mesh = without_lone_vertices(mesh);
        let topology = mesh.topology();
        with_area(&mesh)?;
        let pieces = mesh.component_count();
        if pieces > 1 {
            return Err(FlattenError::Pieces(pieces));
        }
        unbranched(&mesh, &topology)?;
        mesh.orient();
        if !two_sided(&mesh) {
            return Err(FlattenError::OneSided);
        }
        let outlines = outlines(&mesh);
        let outline = match outlines.len() {
            0 => return Err(FlattenError::Closed),
            1 => outlines.into_iter().flatten().collect(),
            count => {
                return Err(FlattenError::Holes {
                    outlines: count,
                    holes: count - 1,
                });
            }
        };
        if mesh.euler_characteristic() != 1 {
            return Err(FlattenError::Handle);
        }
        let flat = (0..mesh.triangles.len())
            .map(|t| flat_triangle(mesh.corners(t)))
            .collect();
        Ok(Self {
            mesh,
            outline,
            flat,
        })
    }

    /// The surface.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Vertices of the outline in order, the surface on the left seen from the front.
    pub fn outline(&self) -> &[u32] {
        &self.outline
    }

    /// Each triangle in its own plane, counter-clockwise, its first corner at the origin and its second on +x (m).
    pub fn flat(&self) -> &[[Vec2; 3]] {
        &self.flat
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Area of the surface (m2).
    pub fn area(&self) -> f64 {
        self.mesh.area()
    }
}

/// A triangle of space in its own plane: the first corner at the origin, the second on +x (m).
pub fn flat_triangle([a, b, c]: [Vec3; 3]) -> [Vec2; 3] {
    let (ab, ac) = (b - a, c - a);
    let length = ab.norm();
    let x = ac.dot(&ab) / length;
    let y = ab.cross(&ac).norm() / length;
    [Vec2::zeros(), Vec2::new(length, 0.0), Vec2::new(x, y)]
}

fn without_lone_vertices(mesh: &TriangleMesh) -> TriangleMesh {
    let mut used = vec![false; mesh.positions.len()];
    for &v in mesh.triangles.iter().flatten() {
        used[v as usize] = true;
    }
    let mut numbers = vec![0; mesh.positions.len()];
    let mut positions = Vec::new();
    for (v, position) in mesh.positions.iter().enumerate().filter(|(v, _)| used[*v]) {
        numbers[v] = positions.len() as u32;
        positions.push(*position);
    }
    TriangleMesh {
        positions,
        triangles: (mesh.triangles.iter())
            .map(|t| t.map(|v| numbers[v as usize]))
            .collect(),
    }
}

fn with_area(mesh: &TriangleMesh) -> Result<(), FlattenError> {
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let twice = (b - a).cross(&(c - a)).norm();
        let longest = [a - b, b - c, c - a]
            .iter()
            .map(Vec3::norm_squared)
            .fold(0.0, f64::max);
        // Sides so long that their squares overflow are no surface either.
        if twice.is_nan() || twice.is_infinite() || twice <= MIN_HEIGHT * longest {
            let middle = (a + b + c) / 3.0;
            return Err(FlattenError::NoArea {
                triangle,
                x: middle.x,
                y: middle.y,
                z: middle.z,
            });
        }
    }
    Ok(())
}

/// Refuses edges of more than two triangles and vertices where two fans meet.
fn unbranched(mesh: &TriangleMesh, topology: &Topology) -> Result<(), FlattenError> {
    let branches = |v: u32, what| {
        let p = mesh.positions[v as usize];
        let (x, y, z) = (p.x, p.y, p.z);
        Err(FlattenError::Branches { what, x, y, z })
    };
    if let Some(edge) = topology.non_manifold().next() {
        return branches(
            topology.edges[edge][0],
            "more than two triangles meet at an edge",
        );
    }
    // A fan of triangles has as many edges at its vertex as triangles, or one more if it is open.
    let mut triangles = vec![0u32; mesh.positions.len()];
    let mut open = vec![0u32; mesh.positions.len()];
    for &v in mesh.triangles.iter().flatten() {
        triangles[v as usize] += 1;
    }
    for edge in topology.boundary() {
        for v in topology.edges[edge] {
            open[v as usize] += 1;
        }
    }
    let mut fans = vec![0u32; mesh.positions.len()];
    count_fans(mesh, topology, &mut fans);
    let two = |v: &usize| open[*v] > 2 || fans[*v] > 1;
    match (0..mesh.positions.len()).find(two) {
        Some(v) => branches(v as u32, "two parts touch in one vertex alone"),
        None => Ok(()),
    }
}

/// The number of fans of triangles at each vertex.
fn count_fans(mesh: &TriangleMesh, topology: &Topology, fans: &mut [u32]) {
    // Corners of triangles, joined across edges; each set of joined corners is a fan.
    let mut parent: Vec<u32> = (0..3 * mesh.triangles.len() as u32).collect();
    fn root(parent: &mut [u32], mut at: u32) -> u32 {
        while parent[at as usize] != at {
            parent[at as usize] = parent[parent[at as usize] as usize];
            at = parent[at as usize];
        }
        at
    }
    let corner = |t: u32, v: u32| {
        let k = mesh.triangles[t as usize].iter().position(|&w| w == v);
        3 * t + k.unwrap_or(0) as u32
    };
    for (edge, sides) in topology.edge_triangles.iter().enumerate() {
        let [one, two] = sides[..] else {
            continue;
        };
        for v in topology.edges[edge] {
            let a = root(&mut parent, corner(one, v));
            let b = root(&mut parent, corner(two, v));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    for at in 0..parent.len() as u32 {
        if root(&mut parent, at) == at {
            fans[mesh.triangles[at as usize / 3][at as usize % 3] as usize] += 1;
        }
    }
}

fn directed(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let mut all: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(sides).collect();
    all.sort_unstable();
    all
}

fn two_sided(mesh: &TriangleMesh) -> bool {
    directed(mesh).windows(2).all(|pair| pair[0] != pair[1])
}

/// Rings of edges with a triangle on the left alone, in order.
pub(crate) fn outlines(mesh: &TriangleMesh) -> Vec<Vec<u32>> {
    let all = directed(mesh);
    let mut next: Vec<Option<u32>> = vec![None; mesh.positions.len()];
    for &[a, b] in &all {
        if all.binary_search(&[b, a]).is_err() {
            next[a as usize] = Some(b);
        }
    }
    let mut rings = Vec::new();
    for start in 0..next.len() {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(b) = next[at].take() {
            ring.push(at as u32);
            at = b as usize;
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}
