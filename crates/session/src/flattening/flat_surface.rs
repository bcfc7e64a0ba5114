//! A surface, or the region of one inside a loop, flattened to a panel of a fabric.

use super::panel::panel_pattern;
use super::report::{FlattenOptions, FlattenReport, report_on};
use super::strain_map::strain_scale;
use crate::{SessionError, fabrics};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use toile_drape::MaterialLaws;
use toile_fabric::Material;
use toile_flatten::{
    FlattenError, Flattened, Options, SurfaceLoop, SurfaceRegion, cut_out, flatten,
    flatten_surface, panel_outline,
};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::FormatError;
use toile_pattern::{Fabric, Pattern};

/// Largest distance of the panel's curves from the vertices of the outline (m).
pub const TOLERANCE: f64 = 1e-4;
/// Distance of a place from the surface that is not told (m).
const NEAR: f64 = 1e-3;
/// Largest ease of a surface (m).
pub const MAX_EASE: f64 = 0.5;

/// A surface flattened to a panel.
#[derive(Clone, Debug)]
pub struct FlatSurface {
    /// The panel as a pattern.
    pub pattern: Pattern,
    /// The report; no file is written.
    pub report: FlattenReport,
    pub(super) flat: Flattened,
}

impl FlatSurface {
    /// Flattens a mesh in memory: vertices (m) and triangles; of it the region inside a loop of places (m), if there
    /// is one. The panel gets a name.
    ///
    /// # Errors
    /// The mesh or the region is no disk, or a number or the fabric cannot be used.
    pub fn of_arrays(
        vertices: &[[f64; 3]],
        triangles: Vec<[u32; 3]>,
        places: Option<&[[f64; 3]]>,
        (name, options): (&str, &FlattenOptions),
    ) -> Result<Self, SessionError> {
        let mut mesh = TriangleMesh {
            positions: vertices.iter().map(|&place| Vec3::from(place)).collect(),
            triangles,
        };
        check_ease(options.ease)?;
        let path = Path::new("the mesh");
        mesh.check().map_err(|defect| SessionError::Format {
            path: path.to_owned(),
            error: FormatError::new("the mesh", defect.to_string(), "correct the arrays"),
        })?;
        mesh.orient();
        let mut notes = Vec::new();
        let target = match places {
            None => Target::whole(&mesh, options.ease),
            Some(places) => {
                let asked = SurfaceLoop {
                    places: places.iter().map(|&place| place.into()).collect(),
                    ..SurfaceLoop::default()
                };
                Target::inside((&mesh, false), &asked, options, &mut notes)
                    .map_err(|words| format_error(path, "the loop", &words))?
            }
        };
        Self::of(&target, (path, name), (options, notes))
    }

    /// Flattens the region of a skin inside a loop of places (m) to a panel of a fabric; that of the options is not read.
    ///
    /// # Errors
    /// The region is no disk, or a number cannot be used.
    pub(super) fn of_skin(
        (skin, places): (&TriangleMesh, &[Vec3]),
        fabric: Fabric,
        (name, options): (&str, &FlattenOptions),
        stop: Option<Arc<AtomicBool>>,
    ) -> Result<Self, SessionError> {
        check_ease(options.ease)?;
        let path = Path::new("the mannequin");
        let mut notes = Vec::new();
        let asked = SurfaceLoop {
            places: places.to_vec(),
            ..SurfaceLoop::default()
        };
        let target = Target::inside((skin, true), &asked, options, &mut notes)
            .map_err(|words| format_error(path, "the loop", &words))?;
        Self::of_fabric(&target, (path, name), (options, notes), (fabric, stop))
    }

    /// Flattens a mesh or a region of one, which `path` names in errors.
    pub(super) fn of(
        target: &Target,
        names: (&Path, &str),
        (options, mut notes): (&FlattenOptions, Vec<String>),
    ) -> Result<Self, SessionError> {
        let fabric = chosen_fabric(options.fabric.as_deref(), &mut notes)?;
        Self::of_fabric(target, names, (options, notes), (fabric, None))
    }

    fn of_fabric(
        target: &Target,
        (path, name): (&Path, &str),
        (options, mut notes): (&FlattenOptions, Vec<String>),
        (fabric, stop): (Fabric, Option<Arc<AtomicBool>>),
    ) -> Result<Self, SessionError> {
        let of = (&fabric.material, stop);
        let flat = flattened(target, options, of, path, &mut notes)?;
        let outline = panel_outline(&flat, TOLERANCE);
        let pattern = panel_pattern(name, fabric.clone(), &outline);
        let about = (options, fabric.name, target.edge(), notes);
        let report = report_on(&flat, &outline, about);
        Ok(Self {
            pattern,
            report,
            flat,
        })
    }

    /// Places of the vertices on the panel, the grain along +y (m). A vertex on a dart is there twice.
    pub fn places(&self) -> Vec<[f64; 2]> {
        self.flat.places.iter().map(|&place| place.into()).collect()
    }

    /// Places of the same vertices on the surface (m).
    pub fn surface(&self) -> Vec<[f64; 3]> {
        let places = &self.flat.region.mesh().positions;
        places.iter().map(|&place| place.into()).collect()
    }

    /// Triangles of the panel and of the surface.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.flat.region.mesh().triangles
    }

    /// Colour of the stretch of each triangle.
    pub fn colours(&self) -> Vec<[f64; 3]> {
        let limit = self.report.stretch_limit;
        let each = self.flat.stretch.iter();
        each.map(|stretch| Self::colour_of(stretch.size(), limit))
            .collect()
    }

    /// Colour of a stretch (1), sRGB, 0..=1: lightest as cut, darkest at the limit (1), another above.
    pub fn colour_of(stretch: f64, limit: f64) -> [f64; 3] {
        strain_scale(limit).colour(100.0 * stretch)
    }

    /// Relative change of length of each triangle from the panel to the surface, where it is most and where it is
    /// least (1).
    pub fn stretch(&self) -> Vec<[f64; 2]> {
        let each = self.flat.stretch.iter();
        each.map(|stretch| [stretch.most, stretch.least]).collect()
    }
}

fn chosen_fabric(asked: Option<&str>, notes: &mut Vec<String>) -> Result<Fabric, SessionError> {
    let asked = asked.unwrap_or("poplin");
    let nothing = Pattern::new("");
    let (choice, found) = fabrics::chosen(&nothing, asked)?;
    notes.extend(found);
    choice
        .fabric(&nothing)
        .ok_or_else(|| SessionError::Unknown {
            kind: "fabric",
            name: asked.to_owned(),
            hint: "name a fabric of the library, or a fabric file".to_owned(),
        })
}

/// What is flattened.
pub(super) enum Target {
    /// A whole mesh.
    Whole(TriangleMesh),
    /// A region, and the length of the edges it is meshed with (m).
    Region(Box<SurfaceRegion>, f64),
}

impl Target {
    /// A whole mesh, moved out by an ease that was checked (m).
    pub fn whole(mesh: &TriangleMesh, ease: f64) -> Self {
        Self::Whole(moved_out(mesh, ease))
    }

    /// The region inside a loop of a surface, which may be its own mirror image, moved out by the ease.
    ///
    /// # Errors
    /// The words of the fault of the loop.
    pub fn inside(
        (mesh, is_symmetrical): (&TriangleMesh, bool),
        asked: &SurfaceLoop,
        options: &FlattenOptions,
        notes: &mut Vec<String>,
    ) -> Result<Self, String> {
        let region = cut_out(mesh, asked).map_err(|error| error.to_string())?;
        if region.farthest > NEAR {
            notes.push(format!(
                "a place of the loop was {:.1} mm off the surface; its nearest point was taken",
                region.farthest * 1e3
            ));
        }
        let edge = options.edge.unwrap_or_else(|| region.default_edge());
        if options.follows_hollows {
            return Ok(Self::Region(Box::new(region.moved_out(options.ease)), edge));
        }
        let spanning = region
            .spanning_hollows(options.ease, edge, is_symmetrical)
            .map_err(|error| error.to_string())?;
        if spanning.farthest > NEAR {
            notes.push(format!(
                "the cloth spans hollows of the surface, up to {:.0} mm deep",
                spanning.farthest * 1e3
            ));
        }
        if !spanning.at_rest {
            notes.push(
                "the cloth over the hollows had not come to rest: mesh it more coarsely".to_owned(),
            );
        }
        Ok(Self::Region(Box::new(spanning.region), edge))
    }

    /// Length of the edges that a region is meshed with (m).
    pub fn edge(&self) -> Option<f64> {
        match self {
            Self::Region(_, edge) => Some(*edge),
            Self::Whole(_) => None,
        }
    }
}

pub(super) fn check_ease(ease: f64) -> Result<(), SessionError> {
    if ease.is_finite() && ease.abs() <= MAX_EASE {
        return Ok(());
    }
    Err(SessionError::Number {
        what: "the ease (m)",
        value: ease,
        hint: "give a length of at most 50cm",
    })
}

/// The surface with every vertex moved along its normal.
fn moved_out(mesh: &TriangleMesh, ease: f64) -> TriangleMesh {
    let mut moved = mesh.clone();
    if ease != 0.0 && mesh.check().is_ok() {
        for (place, normal) in moved.positions.iter_mut().zip(mesh.vertex_normals()) {
            *place += normal * ease;
        }
    }
    moved
}

fn flattened(
    target: &Target,
    options: &FlattenOptions,
    (material, stop): (&Material, Option<Arc<AtomicBool>>),
    path: &Path,
    notes: &mut Vec<String>,
) -> Result<Flattened, SessionError> {
    let asked = |grain: Vec3| {
        let options = Options {
            law: material.membrane(),
            grain,
            strain: options.strain,
            darts: options.darts,
            cuts: Vec::new(),
            stop: stop.clone(),
        };
        match target {
            Target::Whole(mesh) => flatten(mesh, &options),
            Target::Region(region, edge) => flatten_surface(region, *edge, &options),
        }
    };
    let result = match options.grain {
        Some([x, y, z]) => asked(Vec3::new(x, y, z)),
        None => match asked(Vec3::y()) {
            Err(FlattenError::Grain) => {
                notes.push(
                    "the surface lies flat, so the grain runs along z; --grain says otherwise"
                        .to_owned(),
                );
                asked(Vec3::z())
            }
            result => result,
        },
    };
    result.map_err(|error| {
        let is_stopped = matches!(error, FlattenError::Stopped);
        match is_stopped {
            true => SessionError::Cancelled,
            false => format_error(path, "the surface", &error.to_string()),
        }
    })
}

/// An error of words with the remedy after a semicolon.
pub(super) fn format_error(path: &Path, place: &str, words: &str) -> SessionError {
    let (what, hint) = words
        .split_once("; ")
        .unwrap_or((words, "give another surface"));
    SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new(place, what, hint),
    }
}
