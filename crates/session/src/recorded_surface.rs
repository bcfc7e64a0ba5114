//! Surfaces of recorded frames: all of a section, or one object of them.

use crate::SessionError;
use crate::input::read_file;
use crate::output::file_name;
use std::collections::BTreeMap;
use std::path::Path;
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{Frame, FrameSection, Frames, RestShape, read_frames};

/// A surface of a section of recorded frames.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RecordedSurface {
    /// Name of the surface.
    pub name: String,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Rest shape of a cloth.
    pub rest: Option<RestShape>,
    places: Places,
}

/// Places of the vertices of a surface.
#[derive(Clone, Debug, PartialEq)]
enum Places {
    /// Positions of a surface that does not move (m).
    Still(Vec<[f32; 3]>),
    /// Indices of the vertices of a moving surface among the positions of a frame.
    Moving(Vec<u32>),
}

impl RecordedSurface {
    /// The surfaces of a section, in its order.
    pub fn all(section: &FrameSection) -> Vec<Self> {
        let mut first = 0;
        let surfaces = section.head.surfaces.iter().map(|surface| {
            let places = match &surface.still {
                Some(still) => Places::Still(still.clone()),
                None => {
                    let range = first..first + surface.vertices as u32;
                    first = range.end;
                    Places::Moving(range.collect())
                }
            };
            Self {
                name: surface.name.clone(),
                triangles: surface.triangles.clone(),
                rest: surface.rest.clone(),
                places,
            }
        });
        surfaces.collect()
    }

    /// Finds a surface of a section by its name, or one object of a surface by the name of the object;
    /// without a name, the only surface that moves.
    ///
    /// # Errors
    /// An unknown name, or no name unless exactly one surface moves.
    pub fn named(section: &FrameSection, name: Option<&str>) -> Result<Self, SessionError> {
        let all = Self::all(section);
        let unknown = |name: &str| {
            let objects = section.head.surfaces.iter().flat_map(|s| &s.objects);
            let known: Vec<String> = objects.map(|(name, _)| format!("{name:?}")).collect();
            SessionError::Unknown {
                kind: "recorded object",
                name: name.to_owned(),
                hint: format!("choose from {}", known.join(", ")),
            }
        };
        let Some(name) = name else {
            let mut moving = all.into_iter().filter(|s| !s.is_still());
            let first = moving.next();
            return match (first, moving.next()) {
                (Some(only), None) => Ok(only),
                _ => Err(unknown("")),
            };
        };
        if let Some(found) = all.iter().find(|surface| surface.name == name) {
            return Ok(found.clone());
        }
        for (surface, recorded) in section.head.surfaces.iter().zip(&all) {
            let named = |(own, _): &&(String, [usize; 2])| own == name || file_name(own) == name;
            if let Some((own, [from, to])) = surface.objects.iter().find(named) {
                return Ok(recorded.part(own, *from..*to));
            }
        }
        Err(unknown(name))
    }

    /// A range of the triangles as a surface with its own vertices.
    fn part(&self, name: &str, range: std::ops::Range<usize>) -> Self {
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let mut old = Vec::new();
        let mut renumber = |v: u32| {
            *numbers.entry(v).or_insert_with(|| {
                old.push(v);
                old.len() as u32 - 1
            })
        };
        let triangles = self.triangles[range.clone()].iter();
        let triangles = triangles.map(|t| t.map(&mut renumber)).collect();
        let of = |v: &u32| *v as usize;
        Self {
            name: name.to_owned(),
            triangles,
            rest: self.rest.as_ref().map(|rest| RestShape {
                rest: rest.rest[range.clone()].to_vec(),
                material: rest.material[range.clone()].to_vec(),
                panel: rest.panel[range].to_vec(),
                materials: rest.materials.clone(),
            }),
            places: match &self.places {
                Places::Still(all) => Places::Still(old.iter().map(|v| all[of(v)]).collect()),
                Places::Moving(all) => Places::Moving(old.iter().map(|v| all[of(v)]).collect()),
            },
        }
    }

    /// Whether the surface does not move in its section.
    pub fn is_still(&self) -> bool {
        matches!(self.places, Places::Still(_))
    }

    /// Positions of the vertices in a frame of the section (m).
    pub fn positions(&self, frame: &Frame) -> Vec<[f32; 3]> {
        match &self.places {
            Places::Still(places) => places.clone(),
            Places::Moving(all) => all.iter().map(|&v| frame.positions[v as usize]).collect(),
        }
    }

    /// Mesh of the surface in a frame of the section.
    pub fn mesh(&self, frame: &Frame) -> TriangleMesh {
        let positions = self.positions(frame);
        TriangleMesh {
            positions: positions
                .iter()
                .map(|p| Vec3::from(p.map(f64::from)))
                .collect(),
            triangles: self.triangles.clone(),
        }
    }
}

/// Reads a file of frames.
///
/// # Errors
/// The file cannot be read, or is no file of frames.
pub(crate) fn open_frames(path: &Path) -> Result<Frames, SessionError> {
    let bytes = read_file(path)?;
    read_frames(&bytes).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })
}
