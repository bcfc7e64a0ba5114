//! A surface of a mesh file flattened to a panel: pattern, report and strain map.
//!
//! # Decided with
//! - [`toile_flatten::flatten`]: the shape of least energy, darts;
//! - [`crate::flattening`] (`panel.rs`): the panel as a document;
//! - [`crate::mesh_file`], [`crate::fabrics`]: meshes and fabrics of files.

mod panel;

use crate::mesh_file::open_mesh;
use crate::output::cannot;
use crate::tools::check_ending;
use crate::{SessionError, fabrics};
use panel::panel_pattern;
use serde::Serialize;
use std::path::{Path, PathBuf};
use toile_drape::MaterialLaws;
use toile_fabric::Material;
use toile_flatten::{FlattenError, Flattened, Options, PanelOutline, flatten, panel_outline};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{FormatError, write_all_atomically, write_document};
use toile_pattern::{Fabric, Pattern};
use toile_picture::{ColourMap, ColourScale, Finish, Legend, Paint, Scene, Sheet, Surface, View};

/// Largest distance of the panel's curves from the vertices of the outline (m).
pub const TOLERANCE: f64 = 1e-4;

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
    /// Area of the surface (m2).
    pub surface_area_m2: f64,
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

/// Flattens the surface of a mesh file to a panel, and writes it as a pattern, with a report and a strain map beside it.
///
/// # Errors
/// The mesh cannot be read or is no disk, a number or the fabric cannot be used, or a file cannot be written.
pub fn flatten_mesh(
    mesh: &Path,
    options: &FlattenOptions,
    to: &Path,
) -> Result<FlattenReport, SessionError> {
    check_ending(
        to,
        &[".toile.json"],
        "a panel is written as a pattern, NAME.toile.json",
    )?;
    let opened = open_mesh(mesh)?;
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let stem = name[..name.len() - ".toile.json".len()].to_owned();
    let panel_name = if stem.is_empty() { "panel" } else { &stem };
    let surface = FlatSurface::of(&opened.mesh, (mesh, panel_name), options)?;
    let folder = to.parent().unwrap_or(Path::new("")).to_owned();
    let names = [
        name.clone().into_owned(),
        format!("{stem}-flatten.json"),
        format!("{stem}-strain.png"),
    ];
    let mut report = surface.report;
    report.files = names.iter().map(|name| folder.join(name)).collect();
    report.notes.splice(0..0, opened.notes);
    let document =
        write_document(&surface.pattern, &Default::default()).map_err(cannot("the pattern"))?;
    let words = report.to_json().map_err(cannot("the report"))?;
    let [pattern_name, report_name, picture_name] = names;
    let files = [
        (pattern_name, document.into_bytes()),
        (report_name, words.into_bytes()),
        (picture_name, strain_map(&surface.flat, options.strain)?),
    ];
    write_all_atomically(&folder, &files)?;
    Ok(report)
}

/// A surface flattened to a panel.
#[derive(Clone, Debug)]
pub struct FlatSurface {
    /// The panel as a pattern.
    pub pattern: Pattern,
    /// The report; no file is written.
    pub report: FlattenReport,
    flat: Flattened,
}

impl FlatSurface {
    /// Flattens a mesh in memory: vertices (m) and triangles. The panel gets a name.
    ///
    /// # Errors
    /// The mesh is no disk, or a number or the fabric cannot be used.
    pub fn of_arrays(
        vertices: &[[f64; 3]],
        triangles: Vec<[u32; 3]>,
        (name, options): (&str, &FlattenOptions),
    ) -> Result<Self, SessionError> {
        let mut mesh = TriangleMesh {
            positions: vertices.iter().map(|&place| Vec3::from(place)).collect(),
            triangles,
        };
        let path = Path::new("the mesh");
        mesh.check().map_err(|defect| SessionError::Format {
            path: path.to_owned(),
            error: FormatError::new("the mesh", defect.to_string(), "correct the arrays"),
        })?;
        mesh.orient();
        Self::of(&mesh, (path, name), options)
    }

    /// Flattens a mesh, which `path` names in errors.
    fn of(
        mesh: &TriangleMesh,
        (path, name): (&Path, &str),
        options: &FlattenOptions,
    ) -> Result<Self, SessionError> {
        let mut notes = Vec::new();
        let fabric = chosen_fabric(options.fabric.as_deref(), &mut notes)?;
        let surface = moved_out(mesh, options.ease)?;
        let flat = flattened(&surface, options, &fabric.material, path, &mut notes)?;
        let outline = panel_outline(&flat, TOLERANCE);
        let pattern = panel_pattern(name, fabric.clone(), &outline);
        let report = report_on(&flat, &outline, (options, fabric.name, notes));
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

    /// Relative change of length of each triangle from the panel to the surface, where it is most and where it is
    /// least (1).
    pub fn stretch(&self) -> Vec<[f64; 2]> {
        let each = self.flat.stretch.iter();
        each.map(|stretch| [stretch.most, stretch.least]).collect()
    }
}

impl FlattenReport {
    /// The report as JSON.
    ///
    /// # Errors
    /// Numbers that JSON does not hold.
    pub fn to_json(&self) -> Result<String, FormatError> {
        serde_json::to_string_pretty(self)
            .map_err(|error| FormatError::new("the report", error.to_string(), "report this fault"))
    }
}

fn report_on(
    flat: &Flattened,
    outline: &PanelOutline,
    (options, fabric, mut notes): (&FlattenOptions, String, Vec<String>),
) -> FlattenReport {
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
    FlattenReport {
        files: Vec::new(),
        fabric,
        triangles: flat.region.mesh().triangles.len(),
        surface_area_m2: flat.region.area(),
        panel_area_m2: panel_area,
        energy_j: flat.minimum.energy,
        stretch_99: flat.strain,
        stretch_limit: options.strain,
        within_limit: within,
        before_darts: flat.before.clone(),
        darts: (outline.darts.iter())
            .map(|dart| DartReport {
                length_m: length_on(flat, dart.dart),
                intake_m: dart.intake,
                bow_m: dart.bow,
            })
            .collect(),
        gussets: outline.gussets.len(),
        steps: flat.minimum.steps,
        at_rest: flat.minimum.is_converged,
        notes,
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

/// The surface with every vertex moved along its normal.
fn moved_out(mesh: &TriangleMesh, ease: f64) -> Result<TriangleMesh, SessionError> {
    if !ease.is_finite() || ease.abs() > MAX_EASE {
        return Err(SessionError::Number {
            what: "the ease (m)",
            value: ease,
            hint: "give a length of at most 50cm",
        });
    }
    let mut moved = mesh.clone();
    if ease != 0.0 && mesh.check().is_ok() {
        for (place, normal) in moved.positions.iter_mut().zip(mesh.vertex_normals()) {
            *place += normal * ease;
        }
    }
    Ok(moved)
}

fn flattened(
    surface: &TriangleMesh,
    options: &FlattenOptions,
    material: &Material,
    path: &Path,
    notes: &mut Vec<String>,
) -> Result<Flattened, SessionError> {
    let asked = |grain: Vec3| Options {
        law: material.membrane(),
        grain,
        strain: options.strain,
        darts: options.darts,
        cuts: Vec::new(),
    };
    let result = match options.grain {
        Some([x, y, z]) => flatten(surface, &asked(Vec3::new(x, y, z))),
        None => match flatten(surface, &asked(Vec3::y())) {
            Err(FlattenError::Grain) => {
                notes.push(
                    "the surface lies flat, so the grain runs along z; --grain says otherwise"
                        .to_owned(),
                );
                flatten(surface, &asked(Vec3::z()))
            }
            result => result,
        },
    };
    result.map_err(|error| {
        let words = error.to_string();
        let (what, hint) = words
            .split_once("; ")
            .unwrap_or((&words, "give another surface"));
        SessionError::Format {
            path: path.to_owned(),
            error: FormatError::new("the surface", what, hint),
        }
    })
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
