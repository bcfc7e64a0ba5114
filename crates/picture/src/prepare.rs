//! A scene made ready for any number of views: one list of triangles, normals, light of the sky.

use crate::PictureError;
use crate::colour::linear_from_srgb;
use crate::floor::Floor;
use crate::occlusion::ambient;
use crate::scene::{Edges, Finish, Paint, Scene, Surface};
use toile_geometry::Vec3;

/// A checked scene with everything that does not depend on the camera.
pub(crate) struct Prepared<'a> {
    pub scene: &'a Scene,
    /// Vertices of all surfaces (m).
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Light of the sky on both sides of each vertex, 0..=1.
    pub ambient: Vec<[f32; 2]>,
    /// Corners as indices into the lists above.
    pub triangles: Vec<[u32; 3]>,
    /// Surface of each triangle.
    pub owner: Vec<u32>,
    /// First vertex and first triangle of each surface.
    pub first: Vec<[usize; 2]>,
    /// Bit k is set where the edge opposite corner k carries a line.
    pub lined: Vec<u8>,
    pub floor: Option<Floor>,
    /// Linear light of each surface: one colour for all, one a triangle, or none where it must
    /// be found from the vertices.
    paint: Vec<Vec<[f64; 3]>>,
    /// Linear light of each surface's lines.
    line: Vec<[f64; 3]>,
}

impl<'a> Prepared<'a> {
    /// Makes a scene ready; the ground lies under a box (m), else under the scene.
    pub(crate) fn new(scene: &'a Scene, room: Option<[Vec3; 2]>) -> Result<Self, PictureError> {
        scene.check()?;
        let mut all = Self {
            scene,
            positions: Vec::new(),
            normals: Vec::new(),
            ambient: Vec::new(),
            triangles: Vec::new(),
            owner: Vec::new(),
            first: Vec::new(),
            lined: Vec::new(),
            floor: None,
            paint: Vec::new(),
            line: Vec::new(),
        };
        for (s, surface) in scene.surfaces.iter().enumerate() {
            all.first.push([all.positions.len(), all.triangles.len()]);
            let base = all.positions.len() as u32;
            all.positions.extend(&surface.mesh.positions);
            if surface.normals.is_empty() {
                all.normals.extend(surface.mesh.vertex_normals());
            } else {
                all.normals.extend(&surface.normals);
            }
            all.triangles
                .extend(surface.mesh.triangles.iter().map(|t| t.map(|v| v + base)));
            all.owner.resize(all.triangles.len(), s as u32);
            all.lined.extend(lined_edges(surface));
            all.paint.push(linear_paint(&surface.paint));
            all.line.push(linear_from_srgb(surface.lines.colour));
        }
        all.ambient = ambient(&all.positions, &all.normals, &all.triangles);
        all.floor = room
            .or_else(|| scene.bounds())
            .map(|bounds| Floor::under(bounds, &all.positions, &all.triangles));
        Ok(all)
    }

    /// Colour in linear light of a place on a triangle, given its weights of the corners.
    pub(crate) fn colour(&self, triangle: usize, weights: [f64; 3]) -> [f64; 3] {
        let s = self.owner[triangle] as usize;
        let [first_vertex, first_triangle] = self.first[s];
        let own = triangle - first_triangle;
        if let Paint::VertexScalar(values, scale) = &self.scene.surfaces[s].paint {
            let corners = self.triangles[triangle];
            let value = (0..3)
                .map(|k| weights[k] * values[corners[k] as usize - first_vertex])
                .sum();
            return linear_from_srgb(scale.colour(value));
        }
        let paint = &self.paint[s];
        paint[own.min(paint.len() - 1)]
    }

    /// Colour in linear light of the lines on a triangle.
    pub(crate) fn line_colour(&self, triangle: usize) -> [f64; 3] {
        self.line[self.owner[triangle] as usize]
    }

    /// Whether the colour is a measured value, which light must not hide.
    pub(crate) fn is_scalar(&self, triangle: usize) -> bool {
        matches!(
            self.scene.surfaces[self.owner[triangle] as usize].paint,
            Paint::VertexScalar(..) | Paint::TriangleScalar(..)
        )
    }

    pub(crate) fn finish(&self, triangle: usize) -> Finish {
        self.scene.surfaces[self.owner[triangle] as usize].finish
    }
}

/// What can be said of a surface's colours before any place on it is asked for.
fn linear_paint(paint: &Paint) -> Vec<[f64; 3]> {
    match paint {
        Paint::Plain(colour) => vec![linear_from_srgb(*colour)],
        Paint::PerTriangle(colours) => colours.iter().map(|c| linear_from_srgb(*c)).collect(),
        Paint::TriangleScalar(values, scale) => values
            .iter()
            .map(|v| linear_from_srgb(scale.colour(*v)))
            .collect(),
        Paint::VertexScalar(..) => Vec::new(),
    }
}

/// For each triangle, the edges that carry a line.
fn lined_edges(surface: &Surface) -> Vec<u8> {
    let triangles = &surface.mesh.triangles;
    match &surface.lines.edges {
        Edges::None => vec![0; triangles.len()],
        Edges::All => vec![7; triangles.len()],
        Edges::Pairs(pairs) => {
            let mut wanted: Vec<[u32; 2]> =
                pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
            wanted.sort_unstable();
            triangles
                .iter()
                .map(|t| {
                    (0..3).fold(0, |bits, k| {
                        let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                        let found = wanted.binary_search(&[a.min(b), a.max(b)]).is_ok();
                        bits | u8::from(found) << k
                    })
                })
                .collect()
        }
    }
}
