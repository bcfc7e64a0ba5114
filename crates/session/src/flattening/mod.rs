//! A surface flattened to a panel: pattern, report and strain map.
//!
//! # Decided with
//! - [`toile_flatten::flatten`], [`toile_flatten::flatten_surface`]: the shape of least energy, darts; of a whole mesh, of a
//!   region of one;
//! - [`crate::flattening`] (`surface.rs`, `loop_file.rs`): meshes and bodies; places on them;
//! - [`crate::flattening`] (`panel.rs`): the panel as a document;
//! - [`crate::mesh_file`], [`crate::fabrics`]: meshes and fabrics of files.

mod loop_file;
mod panel;
mod surface;

use crate::output::cannot;
use crate::product::body_obj;
use crate::tools::check_ending;
use crate::{SessionError, fabrics};
use loop_file::open_loop;
use panel::panel_pattern;
use serde::Serialize;
use std::path::{Path, PathBuf};
use toile_drape::MaterialLaws;
use toile_fabric::Material;
use toile_flatten::{
    FlattenError, Flattened, Options, SurfaceRegion, cut_out, flatten, flatten_surface,
    panel_outline,
};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{FormatError, write_all_atomically, write_document, write_obj};
use toile_pattern::{Fabric, Pattern};
use toile_picture::{ColourMap, ColourScale, Finish, Legend, Paint, Scene, Sheet, Surface, View};

pub use surface::SurfaceSource;

/// Largest distance of the panel's curves from the vertices of the outline (m).
pub const TOLERANCE: f64 = 1e-4;

/// Distance of a place from the surface that is not told (m).
const NEAR: f64 = 1e-3;

/// Largest ease of a surface (m).
pub const MAX_EASE: f64 = 0.5;

/// What is asked of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct FlattenOptions {
    /// Direction of the grain in space; `None`: upwards, or along z where the surface lies flat.
    pub grain: Option<[f64; 3]>,
    /// Name of a fabric of the library, or a fabric file; `None`: poplin.
    pub fabric: Option<String>,
    /// Limit of the stretch on 99 % of the area (1).
    pub strain: f64,
    /// Most darts.
    pub darts: usize,
    /// Distance by which the surface is moved out to its front (m).
    pub ease: f64,
    /// File of a loop round the region to flatten; `None`: the whole surface.
    pub loop_file: Option<PathBuf>,
    /// Length of the edges that a region is meshed with (m); `None`: one that suits its size.
    pub edge: Option<f64>,
}

/// A dart of the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DartReport {
    /// Distance from the middle of the mouth to the apex on the surface (m).
    pub length_m: f64,
    /// Width of the mouth (m).
    pub intake_m: f64,
    /// Largest distance of its legs from straight (m).
    pub bow_m: f64,
}

/// What became of a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlattenReport {
    /// Files that were written, the pattern first.
    pub files: Vec<PathBuf>,
    /// Name of the fabric.
    pub fabric: String,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Area of the surface, moved out by the ease (m2).
    pub surface_area_m2: f64,
    /// Length of the edges that the region of a loop was meshed with (m).
    pub edge_m: Option<f64>,
    /// Area of the panel (m2).
    pub panel_area_m2: f64,
    /// Energy of the fabric on the surface (J).
    pub energy_j: f64,
    /// Stretch that is not exceeded on 99 % of the area, either way (1).
    pub stretch_99: f64,
    /// Limit asked for (1).
    pub stretch_limit: f64,
    /// Whether the limit is kept.
    pub within_limit: bool,
    /// Energy (J) and stretch (1) before each dart.
    pub before_darts: Vec<[f64; 2]>,
    /// Darts of the panel.
    pub darts: Vec<DartReport>,
    /// Cuts whose sides overlap: each asks for a gusset.
    pub gussets: usize,
    /// Steps of the last descent.
    pub steps: usize,
    /// Whether the last descent came to rest.
    pub at_rest: bool,
    /// Notes in words.
    pub notes: Vec<String>,
}

/// Flattens a surface, or the region of it within a loop, to a panel, and writes it as a pattern, with a report and a
/// strain map beside it; of a region the surface, too.
///
/// # Errors
/// The surface or the loop cannot be read, the region is no disk, a number or the fabric cannot be used, or a file cannot be
/// written.
pub fn flatten_to_panel(
    source: &SurfaceSource,
    options: &FlattenOptions,
    to: &Path,
) -> Result<FlattenReport, SessionError> {
    check_ending(
        to,
        &[".toile.json"],
        "a panel is written as a pattern, NAME.toile.json",
    )?;
    check_ease(options.ease)?;
    let opened = source.open()?;
    let mut notes = opened.notes.clone();
    let fabric = chosen_fabric(options.fabric.as_deref(), &mut notes)?;
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let stem = name[..name.len() - ".toile.json".len()].to_owned();
    let target = match &options.loop_file {
        None => Target::Whole(moved_out(&opened.mesh, options.ease)),
        Some(path) => {
            let (asked, found) = open_loop(path, opened.mannequin.as_ref())?;
            notes.extend(found);
            let region = cut_out(&opened.mesh, &asked)
                .map_err(|error| format_error(path, "the loop", &error.to_string()))?;
            if region.farthest > NEAR {
                notes.push(format!(
                    "a place of the loop was {:.1} mm off the surface; its nearest point was taken",
                    region.farthest * 1e3
                ));
            }
            let moved = region.moved_out(options.ease);
            let edge = options.edge.unwrap_or_else(|| moved.default_edge());
            Target::Region(Box::new(moved), edge)
        }
    };
    let place = match (&options.loop_file, &target) {
        (Some(path), Target::Region(..)) => path.clone(),
        (Some(_) | None, _) => source.place(),
    };
    let flat = flattened(&target, options, &fabric.material, &place, &mut notes)?;
    let outline = panel_outline(&flat, TOLERANCE);
    let panel_name = if stem.is_empty() { "panel" } else { &stem };
    let pattern = panel_pattern(panel_name, fabric.clone(), &outline);
    let folder = to.parent().unwrap_or(Path::new("")).to_owned();
    let mut names = vec![
        name.clone().into_owned(),
        format!("{stem}-flatten.json"),
        format!("{stem}-strain.png"),
    ];
    if matches!(target, Target::Region(..)) {
        names.push(format!("{stem}-surface.obj"));
    }
    let places = &flat.places;
    let panel_area: f64 = (flat.region.mesh().triangles.iter())
        .map(|t| {
            let [a, b, c] = t.map(|v| places[v as usize]);
            0.5 * (b - a).perp(&(c - a))
        })
        .sum();
    let within = flat.strain <= options.strain;
    if !within {
        notes.push(format!(
            "the cloth is stretched or pressed by {:.1} % where {:.1} % is asked: allow more darts (--darts), cut the \
             surface into more panels, or take a softer fabric",
            100.0 * flat.strain,
            100.0 * options.strain
        ));
    }
    for gusset in &outline.gussets {
        notes.push(format!(
            "the sides of cut {} overlap: the surface is a saddle there and asks for a gusset, no dart",
            gusset + 1
        ));
    }
    let report = FlattenReport {
        files: names.iter().map(|name| folder.join(name)).collect(),
        fabric: fabric.name.clone(),
        triangles: flat.region.mesh().triangles.len(),
        surface_area_m2: flat.region.area(),
        edge_m: match &target {
            Target::Region(_, edge) => Some(*edge),
            Target::Whole(_) => None,
        },
        panel_area_m2: panel_area,
        energy_j: flat.minimum.energy,
        stretch_99: flat.strain,
        stretch_limit: options.strain,
        within_limit: within,
        before_darts: flat.before.clone(),
        darts: (outline.darts.iter())
            .map(|dart| DartReport {
                length_m: length_on(&flat, dart.dart),
                intake_m: dart.intake,
                bow_m: dart.bow,
            })
            .collect(),
        gussets: outline.gussets.len(),
        steps: flat.minimum.steps,
        at_rest: flat.minimum.is_converged,
        notes,
    };
    let document = write_document(&pattern, &Default::default()).map_err(cannot("the pattern"))?;
    let words = serde_json::to_string_pretty(&report)
        .map_err(|error| FormatError::new("the report", error.to_string(), "report this fault"))
        .map_err(cannot("the report"))?;
    let mut contents = vec![
        document.into_bytes(),
        words.into_bytes(),
        strain_map(&flat, options.strain)?,
    ];
    if matches!(target, Target::Region(..)) {
        let obj = write_obj(&body_obj(flat.region.mesh())).map_err(cannot("the surface"))?;
        contents.push(obj.into_bytes());
    }
    let files: Vec<(String, Vec<u8>)> = names.into_iter().zip(contents).collect();
    write_all_atomically(&folder, &files)?;
    Ok(report)
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
enum Target {
    /// A whole mesh.
    Whole(TriangleMesh),
    /// A region, and the length of the edges it is meshed with (m).
    Region(Box<SurfaceRegion>, f64),
}

fn check_ease(ease: f64) -> Result<(), SessionError> {
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
    material: &Material,
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
    result.map_err(|error| format_error(path, "the surface", &error.to_string()))
}

/// An error of words with the remedy after a semicolon.
fn format_error(path: &Path, place: &str, words: &str) -> SessionError {
    let (what, hint) = words
        .split_once("; ")
        .unwrap_or((words, "give another surface"));
    SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new(place, what, hint),
    }
}

/// Length of a dart along its left leg on the surface (m).
fn length_on(flat: &Flattened, dart: usize) -> f64 {
    let place = |v: u32| flat.region.mesh().positions[v as usize];
    (flat.darts[dart].left.windows(2))
        .map(|pair| (place(pair[1]) - place(pair[0])).norm())
        .sum()
}

/// The panel with the stretch of its cloth in colour, as PNG.
fn strain_map(flat: &Flattened, limit: f64) -> Result<Vec<u8>, SessionError> {
    let high = 100.0 * limit.min(1.0);
    let scale = ColourScale {
        map: ColourMap::Heat,
        low: 0.0,
        high,
        over: Some(ColourScale::OVER),
    };
    let mesh = TriangleMesh {
        positions: (flat.places.iter())
            .map(|p| Vec3::new(p.x, p.y, 0.0))
            .collect(),
        triangles: flat.region.mesh().triangles.clone(),
    };
    let values = flat.stretch.iter().map(|s| 100.0 * s.size()).collect();
    let scene = Scene {
        surfaces: vec![Surface {
            paint: Paint::TriangleScalar(values, scale),
            ..Surface::plain(mesh, [0.8; 3], Finish::Smooth)
        }],
    };
    let legend = Legend {
        title: "Stretch of the cloth on the surface, either way".into(),
        unit: "%".into(),
        scale,
        ends: ["as cut".into(), "at the limit".into()],
        over: format!("over {high} %"),
    };
    let sheet = Sheet {
        views: vec![View::Front],
        ..Sheet::chart("Panel")
    };
    Ok(toile_picture::fit_picture(&scene, &legend, &sheet)?.to_png()?)
}
