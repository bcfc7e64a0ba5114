//! Indexed triangle meshes: measures, topology and defects.

use crate::{Vec3, tetrahedron_volume, triangle_area};
use std::collections::HashMap;

/// An indexed triangle mesh. Triangles are counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertex positions (m).
    pub positions: Vec<Vec3>,
    /// Corners of each triangle, as indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

/// What makes a mesh unusable, with the first place it was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshDefect {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {count}")]
    MissingVertex {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A triangle names one vertex twice.
    #[error("triangle {0} uses one vertex twice")]
    RepeatedVertex(usize),
    /// A coordinate is not finite.
    #[error("vertex {0} has a coordinate that is not finite")]
    NotFinite(usize),
}

/// Edges of a mesh and the triangles on them, in order of their vertex pairs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    /// Vertex pairs, smaller index first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// Triangles on each edge, in ascending order.
    pub edge_triangles: Vec<Vec<u32>>,
    /// The three edges of each triangle, the k-th from its corner k to the next.
    pub triangle_edges: Vec<[u32; 3]>,
}

impl Topology {
    /// Index of the edge between two vertices.
    pub fn edge(&self, a: u32, b: u32) -> Option<usize> {
        self.edges.binary_search(&[a.min(b), a.max(b)]).ok()
    }

    /// Edges on one triangle only.
    pub fn boundary(&self) -> impl Iterator<Item = usize> {
        (0..self.edges.len()).filter(|&e| self.edge_triangles[e].len() == 1)
    }

    /// Edges on more than two triangles.
    pub fn non_manifold(&self) -> impl Iterator<Item = usize> {
        (0..self.edges.len()).filter(|&e| self.edge_triangles[e].len() > 2)
    }
}

impl TriangleMesh {
    /// A closed box along the axes between two corners (m), faces outward.
    pub fn cuboid(low: Vec3, high: Vec3) -> Self {
        let side = |k: usize, axis: usize| [low, high][k >> axis & 1][axis];
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Self {
            positions: (0..8)
                .map(|k| Vec3::new(side(k, 0), side(k, 1), side(k, 2)))
                .collect(),
            triangles: quads
                .iter()
                .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
                .collect(),
        }
    }

    /// Positions of a triangle's corners (m).
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|v| self.positions[v as usize])
    }

    /// Checks indices and coordinates.
    ///
    /// # Errors
    /// The first defect found.
    pub fn check(&self) -> Result<(), MeshDefect> {
        if let Some(at) = self
            .positions
            .iter()
            .position(|p| !p.iter().all(|x| x.is_finite()))
        {
            return Err(MeshDefect::NotFinite(at));
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for &vertex in corners {
                if vertex as usize >= self.positions.len() {
                    let count = self.positions.len();
                    return Err(MeshDefect::MissingVertex {
                        triangle,
                        vertex,
                        count,
                    });
                }
            }
            if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
                return Err(MeshDefect::RepeatedVertex(triangle));
            }
        }
        Ok(())
    }

    /// Adds the vertices and triangles of another mesh, which stay apart from its own.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        let triangles = other.triangles.iter().map(|t| t.map(|v| v + first));
        self.triangles.extend(triangles);
        self.positions.extend_from_slice(&other.positions);
    }

    /// Surface area (m2).
    pub fn area(&self) -> f64 {
        (0..self.triangles.len())
            .map(|t| triangle_area(self.corners(t)))
            .sum()
    }

    /// Signed enclosed volume (m3): positive when closed and facing outward.
    pub fn volume(&self) -> f64 {
        (0..self.triangles.len())
            .map(|t| tetrahedron_volume(self.corners(t)))
            .sum()
    }

    /// Smallest and largest coordinate of all vertices (m); nothing for an empty mesh.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let first = *self.positions.first()?;
        Some(
            self.positions
                .iter()
                .fold([first, first], |[low, high], p| [low.inf(p), high.sup(p)]),
        )
    }

    /// Unit normal of each triangle; zero where a triangle has no area.
    pub fn face_normals(&self) -> Vec<Vec3> {
        (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                (b - a)
                    .cross(&(c - a))
                    .try_normalize(0.0)
                    .unwrap_or_default()
            })
            .collect()
    }

    /// Unit normal of each vertex: face normals weighted by the angle at the vertex
    /// (Thurmer and Wuthrich 1998); zero where no triangle with area meets it.
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::zeros(); self.positions.len()];
        let faces = self.face_normals();
        for (t, triangle) in self.triangles.iter().enumerate() {
            let corners = self.corners(t);
            for k in 0..3 {
                let u = corners[(k + 1) % 3] - corners[k];
                let v = corners[(k + 2) % 3] - corners[k];
                normals[triangle[k] as usize] += faces[t] * u.angle(&v);
            }
        }
        for normal in &mut normals {
            *normal = normal.try_normalize(0.0).unwrap_or_default();
        }
        normals
    }

    /// The edges and the triangles on them.
    pub fn topology(&self) -> Topology {
        let mut uses: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * self.triangles.len());
        for (t, &[a, b, c]) in self.triangles.iter().enumerate() {
            for (k, [p, q]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                uses.push(([p.min(q), p.max(q)], (3 * t + k) as u32));
            }
        }
        uses.sort_unstable();
        let mut topology = Topology {
            triangle_edges: vec![[0; 3]; self.triangles.len()],
            ..Topology::default()
        };
        for (edge, side) in uses {
            let (triangle, k) = (side / 3, side % 3);
            if topology.edges.last() == Some(&edge) {
                if let Some(last) = topology.edge_triangles.last_mut() {
                    last.push(triangle);
                }
            } else {
                topology.edges.push(edge);
                topology.edge_triangles.push(vec![triangle]);
            }
            let index = topology.edges.len() as u32 - 1;
            topology.triangle_edges[triangle as usize][k as usize] = index;
        }
        topology
    }

    /// Number of pieces that hang together by shared vertices; lone vertices are not counted.
    pub fn component_count(&self) -> usize {
        let labels = self.component_labels();
        let most = labels.into_iter().flatten().max();
        most.map_or(0, |most| most as usize + 1)
    }

    /// The number of the piece that each vertex belongs to, pieces in the order of their first vertices; none for lone
    /// vertices.
    pub fn component_labels(&self) -> Vec<Option<u32>> {
        let mut parent: Vec<u32> = (0..self.positions.len() as u32).collect();
        fn root(parent: &mut [u32], mut v: u32) -> u32 {
            while parent[v as usize] != v {
                parent[v as usize] = parent[parent[v as usize] as usize];
                v = parent[v as usize];
            }
            v
        }
        let mut used = vec![false; self.positions.len()];
        for &[a, b, c] in &self.triangles {
            let ra = root(&mut parent, a);
            used[a as usize] = true;
            for other in [b, c] {
                let ro = root(&mut parent, other);
                parent[ro as usize] = ra;
                used[other as usize] = true;
            }
        }
        let mut numbers: Vec<Option<u32>> = vec![None; self.positions.len()];
        let mut count = 0;
        let mut label = |v: u32| {
            let number = &mut numbers[root(&mut parent, v) as usize];
            *number.get_or_insert_with(|| {
                count += 1;
                count - 1
            })
        };
        (0..self.positions.len() as u32)
            .map(|v| used[v as usize].then(|| label(v)))
            .collect()
    }

    /// Vertices minus edges plus triangles, over used vertices: 2 for a closed ball.
    pub fn euler_characteristic(&self) -> i64 {
        let mut used = vec![false; self.positions.len()];
        for &v in self.triangles.iter().flatten() {
            used[v as usize] = true;
        }
        let vertices = used.iter().filter(|&&u| u).count() as i64;
        vertices - self.topology().edges.len() as i64 + self.triangles.len() as i64
    }

    /// Turns triangles round so that neighbours agree, the fewer to the side of the more, and so that a closed mesh faces
    /// outward. Triangles that hang together without two sides, as a band with a half turn, stay. Gives how many were
    /// turned.
    pub fn orient(&mut self) -> usize {
        let mut turned = self.odd_ones();
        let mut trial = self.clone();
        trial.turn(&turned);
        if trial.is_closed_and_oriented() && trial.volume() < 0.0 {
            turned.iter_mut().for_each(|t| *t = !*t);
        }
        self.turn(&turned);
        turned.into_iter().filter(|t| *t).count()
    }

    fn turn(&mut self, turned: &[bool]) {
        for (triangle, _) in self.triangles.iter_mut().zip(turned).filter(|(_, t)| **t) {
            triangle.swap(1, 2);
        }
    }

    /// Triangles that face another way than most of those they hang together with across edges of two triangles.
    fn odd_ones(&self) -> Vec<bool> {
        let topology = self.topology();
        let walks = |t: u32, [a, b]: [u32; 2]| {
            let [p, q, r] = self.triangles[t as usize];
            [[p, q], [q, r], [r, p]].contains(&[a, b])
        };
        let mut side: Vec<Option<bool>> = vec![None; self.triangles.len()];
        for start in 0..self.triangles.len() {
            if side[start].is_some() {
                continue;
            }
            side[start] = Some(false);
            let (mut part, mut has_sides) = (vec![start], true);
            let mut at = 0;
            while let Some(&t) = part.get(at) {
                at += 1;
                for &edge in &topology.triangle_edges[t] {
                    let [one, two] = topology.edge_triangles[edge as usize][..] else {
                        continue;
                    };
                    let ends = topology.edges[edge as usize];
                    let agree = walks(one, ends) != walks(two, ends);
                    let other = if one as usize == t { two } else { one } as usize;
                    let expected = side[t].map(|s| s == agree);
                    match side[other] {
                        None => {
                            side[other] = expected;
                            part.push(other);
                        }
                        known => has_sides &= known == expected,
                    }
                }
            }
            let odd = part.iter().filter(|&&t| side[t] == Some(true)).count();
            for &t in &part {
                let is_odd = side[t] == Some(2 * odd <= part.len());
                side[t] = Some(has_sides && odd > 0 && is_odd);
            }
        }
        side.into_iter().map(|s| s == Some(true)).collect()
    }

    /// Whether every edge has exactly two triangles that walk it in opposite directions.
    pub fn is_closed_and_oriented(&self) -> bool {
        let mut directed: HashMap<[u32; 2], u32> = HashMap::new();
        for &[a, b, c] in &self.triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                *directed.entry(edge).or_default() += 1;
            }
        }
        !directed.is_empty()
            && directed
                .iter()
                .all(|(&[a, b], &count)| count == 1 && directed.get(&[b, a]) == Some(&1))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A unit cube with corners at 0 and 1.
    pub(crate) fn cube() -> TriangleMesh {
        TriangleMesh::cuboid(Vec3::zeros(), Vec3::repeat(1.0))
    }

    #[test]
    fn a_cube_is_measured_exactly() {
        let cube = cube();
        assert_eq!(cube.check(), Ok(()));
        assert!((cube.area() - 6.0).abs() < 1e-14);
        assert!((cube.volume() - 1.0).abs() < 1e-14);
        assert_eq!(cube.euler_characteristic(), 2);
        assert_eq!(cube.component_count(), 1);
        assert!(cube.is_closed_and_oriented());
        assert_eq!(cube.topology().edges.len(), 18);
        let corner = cube.vertex_normals()[7];
        assert!(
            (corner - Vec3::repeat(1.0 / 3f64.sqrt())).norm() < 1e-14,
            "{corner:?}"
        );
    }

    #[test]
    fn a_mesh_is_turned_outward_and_its_odd_triangles_to_the_others() {
        let whole = cube();
        let mut mesh = cube();
        assert_eq!(mesh.orient(), 0);
        mesh.triangles[3].swap(1, 2);
        mesh.triangles[7].swap(1, 2);
        assert_eq!(mesh.orient(), 2);
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        assert_eq!(mesh.orient(), 12);
        assert!(mesh.is_closed_and_oriented());
        assert!((mesh.volume() - whole.volume()).abs() < 1e-15);
        // An open one stays on the side of the more.
        mesh.triangles.truncate(10);
        mesh.triangles[..7].iter_mut().for_each(|t| t.swap(1, 2));
        assert_eq!(mesh.orient(), 3);
        // A band with a half turn has one side.
        let mut band = TriangleMesh {
            positions: (0..6)
                .map(|k| Vec3::new(f64::from(k / 2), f64::from(k % 2), 0.0))
                .collect(),
            triangles: vec![
                [0, 1, 2],
                [1, 3, 2],
                [2, 3, 4],
                [3, 5, 4],
                [4, 5, 1],
                [5, 0, 1],
            ],
        };
        assert_eq!(band.orient(), 0);
    }

    #[test]
    fn defects_are_named() {
        let mut mesh = cube();
        mesh.triangles[3] = [0, 99, 1];
        assert_eq!(
            mesh.check(),
            Err(MeshDefect::MissingVertex {
                triangle: 3,
                vertex: 99,
                count: 8
            })
        );
        mesh.triangles[3] = [0, 1, 1];
        assert_eq!(mesh.check(), Err(MeshDefect::RepeatedVertex(3)));
        mesh.positions[2].y = f64::NAN;
        assert_eq!(mesh.check(), Err(MeshDefect::NotFinite(2)));
    }

    #[test]
    fn an_opened_cube_has_a_boundary() {
        let mut mesh = cube();
        mesh.triangles.truncate(10);
        assert!(!mesh.is_closed_and_oriented());
        assert_eq!(mesh.topology().boundary().count(), 4);
    }
}
