//! A surface whose triangles are split at places and where paths cross their edges; its shape stays the same.

use crate::LoopError;
use std::collections::HashMap;
use toile_geometry::{TriangleMesh, Vec3};

/// Share of an edge or weight of a corner below which a place falls on a corner or an edge (1).
pub const SNAP: f64 = 1e-4;

/// A surface with two sides, of at most two triangles at an edge.
#[derive(Clone, Debug)]
pub struct SplitMesh {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// The triangle on the left of each directed edge.
    sides: HashMap<[u32; 2], u32>,
    /// A triangle at each vertex.
    near: Vec<Option<u32>>,
}

/// The triangles about a vertex, counter-clockwise.
#[derive(Clone, Debug)]
pub struct Fan {
    /// The triangles.
    pub triangles: Vec<u32>,
    /// Whether they go all the way round.
    pub closed: bool,
}

impl SplitMesh {
    /// Takes a mesh whose triangles agree about its front.
    ///
    /// # Errors
    /// The mesh is damaged, empty, or more than two triangles meet at an edge.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, LoopError> {
        mesh.check()?;
        Self::with_normals(mesh, mesh.vertex_normals())
    }

    /// The same with given normals of the vertices.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_normals(mesh: &TriangleMesh, normals: Vec<Vec3>) -> Result<Self, LoopError> {
        let mut split = Self {
            positions: mesh.positions.clone(),
            normals,
            triangles: Vec::with_capacity(mesh.triangles.len()),
            sides: HashMap::with_capacity(3 * mesh.triangles.len()),
            near: vec![None; mesh.positions.len()],
        };
        if mesh.triangles.is_empty() {
            return Err(LoopError::Empty);
        }
        for (t, &corners) in mesh.triangles.iter().enumerate() {
            for k in 0..3 {
                let side = [corners[k], corners[(k + 1) % 3]];
                if split.sides.contains_key(&side) {
                    let place = mesh.positions[side[0] as usize];
                    return Err(LoopError::Branches(place.x, place.y, place.z));
                }
            }
            split.triangles.push(corners);
            split.put(t as u32, corners);
        }
        Ok(split)
    }

    /// Places of the vertices (m).
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Unit normals of the vertices.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Moves the vertices to other places (m).
    pub fn set_positions(&mut self, positions: Vec<Vec3>) {
        self.positions = positions;
    }

    /// Corners of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The surface as a mesh.
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
        }
    }

    /// Places of a triangle's corners (m).
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// The triangle on the left of an edge from one vertex to another.
    pub fn left_of(&self, from: u32, to: u32) -> Option<u32> {
        self.sides.get(&[from, to]).copied()
    }

    /// Whether two vertices share an edge.
    pub fn is_edge(&self, a: u32, b: u32) -> bool {
        self.left_of(a, b).is_some() || self.left_of(b, a).is_some()
    }

    /// The corner of a triangle that lies opposite an edge of it.
    pub fn opposite(&self, triangle: u32, [a, b]: [u32; 2]) -> u32 {
        let corners = self.triangles[triangle as usize];
        let other = corners.into_iter().find(|&v| v != a && v != b);
        other.unwrap_or(corners[0])
    }

    /// The triangles about a vertex; none for one that no triangle uses.
    pub fn fan(&self, v: u32) -> Option<Fan> {
        let start = self.near[v as usize]?;
        let around = |t: u32| {
            let corners = self.triangles[t as usize];
            let k = corners.iter().position(|&w| w == v).unwrap_or(0);
            [corners[(k + 1) % 3], corners[(k + 2) % 3]]
        };
        // Clockwise to where the fan begins, if it does.
        let mut first = start;
        let mut closed = false;
        for _ in 0..self.triangles.len() {
            match self.left_of(around(first)[0], v) {
                Some(before) if before == start => {
                    closed = true;
                    first = start;
                    break;
                }
                Some(before) => first = before,
                None => break,
            }
        }
        let mut triangles = vec![first];
        let mut at = first;
        while let Some(next) = self.left_of(v, around(at)[1]) {
            if next == first || triangles.len() > self.triangles.len() {
                break;
            }
            triangles.push(next);
            at = next;
        }
        Some(Fan { triangles, closed })
    }

    /// The angle of a triangle at one of its corners (rad).
    pub fn angle_at(&self, triangle: u32, v: u32) -> f64 {
        let corners = self.triangles[triangle as usize];
        let k = corners.iter().position(|&w| w == v).unwrap_or(0);
        let at = |k: usize| self.positions[corners[k % 3] as usize];
        (at(k + 1) - at(k)).angle(&(at(k + 2) - at(k)))
    }

    /// A vertex at a place of a triangle by its weights: a corner if it is one, else a new one.
    pub fn vertex_at(&mut self, triangle: u32, weights: [f64; 3]) -> u32 {
        let corners = self.triangles[triangle as usize];
        for (v, weight) in corners.into_iter().zip(weights) {
            if weight > 1.0 - SNAP {
                return v;
            }
        }
        for k in 0..3 {
            if weights[k] < SNAP {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                let share = weights[b] / (weights[a] + weights[b]);
                return self.vertex_on([corners[a], corners[b]], share);
            }
        }
        let [a, b, c] = corners;
        let sum = |values: &[Vec3]| {
            (corners.iter().zip(weights))
                .map(|(&v, weight)| values[v as usize] * weight)
                .sum::<Vec3>()
        };
        let m = self.add(sum(&self.positions), sum(&self.normals));
        self.put(triangle, [a, b, m]);
        self.append([b, c, m]);
        self.append([c, a, m]);
        m
    }

    /// A vertex on an edge at a share of the way: an end if it is one, else a new one.
    pub fn vertex_on(&mut self, [a, b]: [u32; 2], share: f64) -> u32 {
        if share < SNAP {
            return a;
        }
        if share > 1.0 - SNAP {
            return b;
        }
        let between = |values: &[Vec3]| values[a as usize].lerp(&values[b as usize], share);
        let m = self.add(between(&self.positions), between(&self.normals));
        for [from, to] in [[a, b], [b, a]] {
            if let Some(t) = self.sides.remove(&[from, to]) {
                let third = self.opposite(t, [a, b]);
                self.put(t, [from, m, third]);
                self.append([m, to, third]);
            }
        }
        m
    }

    fn add(&mut self, position: Vec3, normal: Vec3) -> u32 {
        self.positions.push(position);
        self.normals
            .push(normal.try_normalize(0.0).unwrap_or(normal));
        self.near.push(None);
        self.positions.len() as u32 - 1
    }

    fn append(&mut self, corners: [u32; 3]) {
        self.triangles.push(corners);
        self.put(self.triangles.len() as u32 - 1, corners);
    }

    fn put(&mut self, triangle: u32, corners: [u32; 3]) {
        self.triangles[triangle as usize] = corners;
        for k in 0..3 {
            self.sides
                .insert([corners[k], corners[(k + 1) % 3]], triangle);
            self.near[corners[k] as usize] = Some(triangle);
        }
    }
}
