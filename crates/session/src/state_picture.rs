//! A picture of the state of a scene, and the camera that all pictures of one run have.

use crate::SessionError;
use crate::pictures::{SKIN, darker, seam_lines};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{TriangleMesh, Vec3};
use toile_picture::{Finish, Rgb, Scene, Sheet, Surface, drape_picture};

/// A surface of a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ShownSurface {
    /// Name of the surface.
    pub name: String,
    /// Mesh at its present position.
    pub mesh: TriangleMesh,
    /// The panel of each triangle of a cloth; `None` for a solid.
    pub panels: Option<Vec<u32>>,
    /// Whether the surface is a solid at rest.
    pub is_still: bool,
}

/// Box that a surface has been in during the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Visited {
    /// Smallest and largest coordinates (m).
    bounds: [Vec3; 2],
    /// Largest size along each axis at one time (m).
    size: Vec3,
}

impl Visited {
    fn and(self, other: Self) -> Self {
        Self {
            bounds: united(self.bounds, other.bounds),
            size: self.size.sup(&other.size),
        }
    }
}

/// Boxes that surfaces have been in, by name.
pub(crate) type Ways = BTreeMap<String, Visited>;

/// The camera of the pictures of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RunCamera {
    /// Boxes that the camera has to take in.
    pub ways: Ways,
    /// Surface that the camera follows; `None` if the camera stands still.
    pub followed: Option<String>,
}

/// Largest size of a solid at rest that the camera takes in, over the size of all that moves (1): a body is
/// taken in, ground is not.
const MAX_STILL: f64 = 2.0;

/// Soft colours of cloths in the order of the surfaces.
const CLOTH: [Rgb; 6] = [
    [0.42, 0.55, 0.68],
    [0.76, 0.52, 0.42],
    [0.50, 0.62, 0.46],
    [0.72, 0.62, 0.38],
    [0.58, 0.48, 0.64],
    [0.40, 0.60, 0.60],
];

impl RunCamera {
    /// Refuses to follow an unknown surface.
    ///
    /// # Errors
    /// An unknown name, with those that are known.
    pub fn check<'a>(&self, mut names: impl Iterator<Item = &'a str>) -> Result<(), SessionError> {
        let Some(name) = &self.followed else {
            return Ok(());
        };
        let mut known = Vec::new();
        match names.any(|other| {
            known.push(format!("{other:?}"));
            other == name
        }) {
            true => Ok(()),
            false => Err(SessionError::Unknown {
                kind: "object",
                name: name.clone(),
                hint: format!("choose from {}", known.join(", ")),
            }),
        }
    }

    /// Takes in the present positions of surfaces.
    pub fn take_in(&mut self, surfaces: &[ShownSurface]) {
        for surface in surfaces {
            if let Some(bounds) = surface.mesh.bounds() {
                let size = bounds[1] - bounds[0];
                self.unite(&surface.name, Visited { bounds, size });
            }
        }
    }

    /// Takes in boxes that surfaces have been in before.
    pub fn take_in_ways(&mut self, ways: &Ways) {
        for (name, way) in ways {
            self.unite(name, *way);
        }
    }

    fn unite(&mut self, name: &str, way: Visited) {
        match self.ways.get_mut(name) {
            Some(known) => *known = known.and(way),
            None => {
                self.ways.insert(name.to_owned(), way);
            }
        }
    }

    /// Picture of a state from four sides, as PNG.
    ///
    /// # Errors
    /// A picture that cannot be drawn.
    pub fn picture(
        &self,
        surfaces: &[ShownSurface],
        [title, warning]: [String; 2],
    ) -> Result<Vec<u8>, SessionError> {
        let sheet = Sheet {
            warning,
            room: self.room(surfaces),
            ..Sheet::studio(title)
        };
        Ok(drape_picture(&scene(surfaces), &sheet)?.to_png()?)
    }

    /// The box that a picture shows (m): all surfaces that move and the solids at rest beside them, or the
    /// followed surface.
    fn room(&self, surfaces: &[ShownSurface]) -> Option<[Vec3; 2]> {
        if let Some(name) = &self.followed {
            let surface = surfaces.iter().find(|surface| surface.name == *name)?;
            let [low, high] = surface.mesh.bounds()?;
            let (middle, half) = (0.5 * (low + high), 0.5 * self.ways.get(name)?.size);
            return Some([middle - half, middle + half]);
        }
        let ways = |is_still: bool| {
            let wanted = surfaces.iter().filter(move |s| s.is_still == is_still);
            wanted.filter_map(|s| Some(self.ways.get(&s.name)?.bounds))
        };
        let moving = ways(false).reduce(united)?;
        let size = |[low, high]: [Vec3; 2]| (high - low).norm();
        let near = ways(true).filter(|&still| size(still) <= MAX_STILL * size(moving));
        Some(near.fold(moving, united))
    }
}

/// The smallest box round two boxes.
fn united(a: [Vec3; 2], b: [Vec3; 2]) -> [Vec3; 2] {
    [a[0].inf(&b[0]), a[1].sup(&b[1])]
}

/// A state as a scene to paint: solids in the colour of skin, each cloth in its own.
fn scene(surfaces: &[ShownSurface]) -> Scene {
    let mut cloths = 0;
    let mut painted = Vec::with_capacity(surfaces.len());
    for surface in surfaces {
        let mesh = surface.mesh.clone();
        let Some(panels) = &surface.panels else {
            painted.push(Surface::plain(mesh, SKIN, Finish::Smooth));
            continue;
        };
        let colour = CLOTH[cloths % CLOTH.len()];
        cloths += 1;
        painted.push(Surface {
            lines: seam_lines(panel_borders(&mesh, panels), darker(colour)),
            ..Surface::plain(mesh, colour, Finish::Cloth)
        });
    }
    Scene { surfaces: painted }
}

/// Edges between triangles of two panels, as pairs of vertices. A mesh that is its own rest shape has a panel
/// for each triangle, and is drawn without borders.
fn panel_borders(mesh: &TriangleMesh, panels: &[u32]) -> Vec<[u32; 2]> {
    let count = panels.iter().collect::<BTreeSet<_>>().len();
    if count == panels.len() {
        return Vec::new();
    }
    let topology = mesh.topology();
    let edges = topology.edges.iter().zip(&topology.edge_triangles);
    let is_border = |sides: &[u32]| {
        let mut of = sides.iter().map(|&t| panels.get(t as usize));
        let first = of.next();
        of.any(|other| Some(other) != first)
    };
    let borders = edges.filter(|(_, sides)| is_border(sides));
    borders.map(|(&edge, _)| edge).collect()
}
