//! A scene made ready for any number of views: one list of triangles, normals, light of the sky.

use crate::PictureError;
use crate::colour::linear_from_srgb;
use crate::occlusion::ambient;
use crate::scene::{Edges, Finish, Paint, Scene, Surface};
use toile_geometry::Vec3;

/// A checked scene with everything that does not depend on the camera.
pub(crate) struct Prepared<'a> {
    pub scene: &'a Scene,
    /// Vertices of all surfaces \[m\].
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
}

/// The ground under the scene and how much sky it sees.
pub(crate) struct Floor {
    /// Its height \[m\].
    pub height: f64,
    corner: [f64; 2],
    /// Distance of grid points \[m\].
    step: f64,
    /// Light of the sky on each grid point, 1 in the open.
    light: Vec<f64>,
}

/// Grid points of the ground a side.
const GRID: usize = 80;

impl<'a> Prepared<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Result<Self, PictureError> {
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
        }
        all.add_ambient();
        Ok(all)
    }

    fn add_ambient(&mut self) {
        let Some([low, high]) = self.scene.bounds() else {
            return;
        };
        let reach = 0.6 * (high - low).norm().max(1e-3);
        let middle = 0.5 * (low + high);
        let corner = [middle.x - reach, middle.z - reach];
        let step = 2.0 * reach / (GRID - 1) as f64;
        let grid = (0..GRID * GRID).map(|k| {
            let (i, j) = (k % GRID, k / GRID);
            Vec3::new(
                corner[0] + step * i as f64,
                low.y,
                corner[1] + step * j as f64,
            )
        });
        let points: Vec<Vec3> = self.positions.iter().copied().chain(grid).collect();
        let mut normals = self.normals.clone();
        normals.resize(points.len(), Vec3::y());
        let mut light = ambient(&points, &normals, (&self.positions, &self.triangles));
        let ground = light.split_off(self.positions.len());
        let open = ground.iter().map(|l| l[0]).fold(1e-6, f32::max);
        self.floor = Some(Floor {
            height: low.y,
            corner,
            step,
            light: ground.iter().map(|l| f64::from(l[0] / open)).collect(),
        });
        self.ambient = light;
    }

    /// Colour in linear light of a place on a triangle, given its weights of the corners.
    pub(crate) fn colour(&self, triangle: usize, weights: [f64; 3]) -> [f64; 3] {
        let s = self.owner[triangle] as usize;
        let [first_vertex, first_triangle] = self.first[s];
        let own = triangle - first_triangle;
        linear_from_srgb(match &self.scene.surfaces[s].paint {
            Paint::Plain(colour) => *colour,
            Paint::PerTriangle(colours) => colours[own],
            Paint::TriangleScalar(values, scale) => scale.colour(values[own]),
            Paint::VertexScalar(values, scale) => {
                let corners = self.triangles[triangle];
                let value = (0..3)
                    .map(|k| weights[k] * values[corners[k] as usize - first_vertex])
                    .sum();
                scale.colour(value)
            }
        })
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

impl Floor {
    /// Light of the sky on the ground, 1 in the open and far away.
    pub(crate) fn light(&self, p: Vec3) -> f64 {
        let u = (p.x - self.corner[0]) / self.step;
        let v = (p.z - self.corner[1]) / self.step;
        let last = (GRID - 1) as f64;
        if !((0.0..last).contains(&u) && (0.0..last).contains(&v)) {
            return 1.0;
        }
        let (i, j) = (u as usize, v as usize);
        let at = |i: usize, j: usize| self.light[j * GRID + i];
        let (a, b) = (smooth(u - i as f64), smooth(v - j as f64));
        let near = at(i, j) * (1.0 - a) + at(i + 1, j) * a;
        let far = at(i, j + 1) * (1.0 - a) + at(i + 1, j + 1) * a;
        let light = near * (1.0 - b) + far * b;
        // Nothing of the grid's border shows.
        let from_middle = (2.0 * u / last - 1.0).hypot(2.0 * v / last - 1.0);
        let fade = ((1.0 - from_middle) / 0.4).clamp(0.0, 1.0);
        1.0 - (1.0 - light) * smooth(fade)
    }
}

/// From 0 to 1 without a kink at the ends.
fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
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
