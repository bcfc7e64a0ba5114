//! The scene to draw: surfaces with their paint.
//!
//! # Decided with
//! - [`crate::prepare`], [`crate::camera::View`]: surfaces made ready for any view; views;
//! - [`crate::raster`], [`crate::ink`]: triangles as pixels;
//! - [`crate::shade`], [`crate::occlusion`], [`crate::depth_map`], [`crate::floor`]: light, light of the sky,
//!   shadows, the ground;
//! - [`crate::colour_map::ColourMap`], [`crate::legend::Legend`]: colours of numbers and their key;
//! - [`crate::backdrop::Backdrop`], [`crate::text::TextStyle`], [`crate::font`]: background, words and their
//!   letters;
//! - [`crate::sheet::drape_picture`], [`crate::sheet::fit_picture`]: finished pages;
//! - [`crate::chart::Chart`], [`crate::outline::outline_picture`]: charts; pieces;
//! - [`crate::error::PictureError`]: what is refused.

use crate::PictureError;
use crate::colour::Rgb;
use crate::colour_map::ColourScale;
use toile_geometry::{TriangleMesh, Vec3};

/// Surfaces that are seen together.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// In any order.
    pub surfaces: Vec<Surface>,
}

/// One triangle mesh with its paint.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Places (m) and triangles, counter-clockwise seen from the right side.
    pub mesh: TriangleMesh,
    /// Unit normal of each vertex; empty to have them computed.
    pub normals: Vec<Vec3>,
    /// Its colours.
    pub paint: Paint,
    /// How it takes the light.
    pub finish: Finish,
    /// Lines drawn on it.
    pub lines: Lines,
    /// Whether the picture is framed on it. If no surface is, all count.
    pub framed: bool,
}

impl Surface {
    /// A surface of one colour, framed, with computed normals and no lines.
    pub fn plain(mesh: TriangleMesh, colour: Rgb, finish: Finish) -> Self {
        Self {
            mesh,
            normals: Vec::new(),
            paint: Paint::Plain(colour),
            finish,
            lines: Lines::default(),
            framed: true,
        }
    }

    /// Places of all corners of triangles (m): vertices without a triangle show nowhere.
    pub(crate) fn corners(&self) -> impl Iterator<Item = Vec3> {
        let positions = &self.mesh.positions;
        self.mesh
            .triangles
            .iter()
            .flatten()
            .filter_map(|&v| positions.get(v as usize).copied())
    }

    fn bounds(&self) -> Option<[Vec3; 2]> {
        self.corners()
            .map(|p| [p, p])
            .reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])])
    }
}

/// The source of a surface's colours.
#[derive(Clone, Debug)]
pub enum Paint {
    /// One colour.
    Plain(Rgb),
    /// A colour for each triangle.
    PerTriangle(Vec<Rgb>),
    /// A number for each vertex, interpolated, then coloured.
    VertexScalar(Vec<f64>, ColourScale),
    /// A number for each triangle.
    TriangleScalar(Vec<f64>, ColourScale),
}

/// How a surface takes the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Matt with a soft edge light; the wrong side is darker.
    Cloth,
    /// Matt and even, for a mannequin; both sides alike.
    Smooth,
}

/// Lines along edges of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// Which edges.
    pub edges: Edges,
    /// Their colour.
    pub colour: Rgb,
    /// Their width (pixel).
    pub width: f64,
    /// How much of the paint they cover, 0..=1.
    pub opacity: f64,
}

/// Which edges of a mesh carry a line.
#[derive(Clone, Debug, Default)]
pub enum Edges {
    /// None.
    #[default]
    None,
    /// All of them: the triangulation shows.
    All,
    /// Those between the given pairs of vertices, such as seams.
    Pairs(Vec<[u32; 2]>),
}

impl Scene {
    /// Smallest and largest coordinates of the framed surfaces (m); nothing when empty.
    pub fn framed_bounds(&self) -> Option<[Vec3; 2]> {
        let any = self.surfaces.iter().any(|s| s.framed);
        self.surfaces
            .iter()
            .filter(|s| s.framed || !any)
            .filter_map(Surface::bounds)
            .reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])])
    }

    /// Smallest and largest coordinates of everything (m); nothing when empty.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.surfaces
            .iter()
            .filter_map(Surface::bounds)
            .reduce(|a, b| [a[0].inf(&b[0]), a[1].sup(&b[1])])
    }

    /// Checks indices, coordinates and the lengths of all lists.
    ///
    /// # Errors
    /// The first surface that cannot be drawn, and why.
    pub fn check(&self) -> Result<(), PictureError> {
        for (surface, s) in self.surfaces.iter().enumerate() {
            // A triangle with a corner twice has no area and draws nothing.
            match s.mesh.check() {
                Ok(()) | Err(toile_geometry::MeshDefect::RepeatedVertex(_)) => {}
                Err(defect) => return Err(PictureError::Mesh { surface, defect }),
            }
            let (vertices, triangles) = (s.mesh.positions.len(), s.mesh.triangles.len());
            let (list, got, expected) = match &s.paint {
                Paint::Plain(_) => ("colours", 0, 0),
                Paint::PerTriangle(colours) => ("colours", colours.len(), triangles),
                Paint::VertexScalar(values, _) => ("vertex values", values.len(), vertices),
                Paint::TriangleScalar(values, _) => ("triangle values", values.len(), triangles),
            };
            let normals = ("normals", s.normals.len(), vertices);
            let lists = [(list, got, expected), normals];
            for (list, got, expected) in &lists[..2 - usize::from(s.normals.is_empty())] {
                if got != expected {
                    return Err(PictureError::List {
                        surface,
                        list,
                        got: *got,
                        expected: *expected,
                    });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColourMap;

    fn triangle() -> TriangleMesh {
        TriangleMesh {
            positions: vec![Vec3::zeros(), Vec3::x(), Vec3::y()],
            triangles: vec![[0, 1, 2]],
        }
    }

    #[test]
    fn unfit_surfaces_are_named() {
        let good = Surface::plain(triangle(), [0.5; 3], Finish::Cloth);
        let mut scene = Scene {
            surfaces: vec![good.clone(), good],
        };
        assert!(scene.check().is_ok());
        scene.surfaces[1].normals = vec![Vec3::z()];
        assert_eq!(
            scene.check().unwrap_err().to_string(),
            "surface 1 has 1 normals where 3 are needed"
        );
        scene.surfaces[1].normals.clear();
        let scale = ColourScale {
            map: ColourMap::Heat,
            low: 0.0,
            high: 1.0,
            over: None,
        };
        scene.surfaces[1].paint = Paint::TriangleScalar(vec![], scale);
        assert!(
            scene
                .check()
                .unwrap_err()
                .to_string()
                .contains("triangle values")
        );
        scene.surfaces[1].paint = Paint::Plain([0.0; 3]);
        scene.surfaces[1].mesh.positions[0].x = f64::NAN;
        assert!(scene.check().unwrap_err().to_string().contains("surface 1"));
    }

    #[test]
    fn the_frame_follows_what_is_framed() {
        let mut far = triangle();
        far.positions[1].x = 9.0;
        let mut scene = Scene {
            surfaces: vec![
                Surface::plain(triangle(), [0.5; 3], Finish::Cloth),
                Surface::plain(far, [0.5; 3], Finish::Smooth),
            ],
        };
        scene.surfaces[1].framed = false;
        assert_eq!(scene.framed_bounds().unwrap()[1].x, 1.0);
        assert_eq!(scene.bounds().unwrap()[1].x, 9.0);
        scene.surfaces[0].framed = false;
        assert_eq!(scene.framed_bounds().unwrap()[1].x, 9.0);
        assert_eq!(Scene::default().bounds(), None);
    }
}
