//! Single jobs that need no session: panel meshes, bodies.
//!
//! # Decided with
//! - [`toile_body::Mannequin`]: bodies made;
//! - [`toile_body::Fit`], [`toile_body::Scan`]: our body fitted to a mesh; a mesh measured;
//! - [`crate::mesh_file::open_person`]: meshes of persons;
//! - [`crate::clips::open_clip`], [`toile_interchange::read_bvh`], [`toile_interchange::read_x3d`]: motions,
//!   by name and of files;
//! - [`crate::bodies::edit_body`], [`toile_body::Scaling`], [`toile_interchange::read_proportions`]: changed
//!   beside measurements;
//! - [`crate::tools::sound_draft`], [`crate::tools::check_ending`]: faults and endings that are refused;
//! - [`toile_interchange::write_body_glb`], [`toile_interchange::write_mannequin`]: files that are written.
//!
//! Options: crate `cli`, `body_options.rs`, `tool_commands.rs`.

use crate::clips::{open_clip, own_clip};
use crate::mesh_file::{OpenedMesh, open_person};
use crate::open::read_input;
use crate::output::cannot;
use crate::product::body_obj;
use crate::realtime::character_with;
use crate::{FabricChoice, Project, SessionError};
use std::path::Path;
use toile_assembly::{MeshQuality, combine, mesh_pieces};
use toile_body::{
    AskedStance, BodyError, Clip, Conflict, Description, Deviation, Figure, Fit, Mannequin,
    ProportionBox, Scaling, Scan, ScanLandmarks,
};
use toile_geometry::{Bounds2, Vec2, Vec3};
use toile_interchange::{
    ExpectedKind, FormatError, ObjGroup, ObjMesh, write_atomically, write_body_glb,
    write_character, write_mannequin, write_measurements, write_obj,
};
use toile_measure::Measurements;
use toile_pattern::Draft;

/// Refuses an output file whose name does not have one of the `known` endings.
///
/// # Errors
/// Another ending, or no ending.
pub(crate) fn check_ending(to: &Path, known: &[&str], remedy: &str) -> Result<(), SessionError> {
    let name = to
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    if known.iter().any(|ending| name.ends_with(ending)) {
        return Ok(());
    }
    let ending = match name.rsplit_once('.') {
        Some((_, ending)) => format!("a name that ends in .{ending}"),
        None => "a name without an ending".to_owned(),
    };
    Err(SessionError::Conflict(format!(
        "{}: nothing is written under {ending}; {remedy}",
        to.display()
    )))
}

/// Opens a pattern file as a project, in a named size if there is one.
pub(crate) fn project_of(
    path: &Path,
    size: Option<&str>,
) -> Result<(Project, Vec<String>), SessionError> {
    let (mut project, notes) = Project::open(path)?;
    if let Some(size) = size {
        project.size = Some(size.to_owned());
        project.check_size()?;
    }
    Ok((project, notes))
}

/// The draft of a project, or every fault that keeps it from being made.
pub(crate) fn sound_draft(project: &Project) -> Result<Draft, SessionError> {
    let measurements = project.drafted_to();
    project.refuse_faults(&project.pattern.check(&measurements))?;
    let (mut draft, _) = project.pattern.resolve(&measurements);
    let chosen = project.fabric.as_ref();
    if let Some(fabric) = chosen.and_then(|choice| choice.fabric(&project.pattern)) {
        FabricChoice::cut(fabric, &mut draft);
    }
    Ok(draft)
}

/// Writes the triangulated panels of a pattern side by side as OBJ, one group for each panel; texture
/// coordinates are positions in the planes of the panels (m). Returns the quality of the triangles, and notes
/// on parts that were left out or are missing.
///
/// # Errors
/// The pattern cannot be read or meshed, or the file cannot be written.
pub fn mesh_panels(
    pattern: &Path,
    size: Option<&str>,
    edge_length: f64,
    to: &Path,
) -> Result<(MeshQuality, Vec<String>), SessionError> {
    /// Room between panels (m).
    const ROOM: f64 = 0.05;
    check_ending(to, &[".obj"], "panels are written as NAME.obj")?;
    let (project, notes) = project_of(pattern, size)?;
    let draft = sound_draft(&project)?;
    let meshes = mesh_pieces(&draft, edge_length)?;
    let mut obj = ObjMesh::default();
    let mut left = 0.0;
    for mesh in &meshes.pieces {
        let bounds = Bounds2::of(mesh.points.iter().copied());
        let shift = Vec2::new(left - bounds.min.x, -bounds.min.y);
        left += bounds.size().x + ROOM;
        let (vertex, triangle) = (obj.positions.len() as u32, obj.triangles.len());
        obj.positions.extend(
            mesh.points
                .iter()
                .map(|p| Vec3::new(p.x + shift.x, p.y + shift.y, 0.0)),
        );
        obj.texture.extend(&mesh.points);
        obj.triangles
            .extend(mesh.triangles.iter().map(|t| t.map(|v| v + vertex)));
        obj.groups.push(ObjGroup {
            name: draft.pieces[mesh.draft_piece].name.clone(),
            triangles: triangle..obj.triangles.len(),
        });
    }
    obj.texture_triangles = obj.triangles.clone();
    let text = write_obj(&obj).map_err(cannot("the mesh"))?;
    write_atomically(to, text.as_bytes())?;
    let parts: Vec<MeshQuality> = meshes.pieces.iter().map(|mesh| mesh.quality()).collect();
    Ok((combine(&parts), notes))
}

/// Measurements of a mannequin as they were asked for and as the tape takes them on the body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyReport {
    /// Measurements that were asked for, then those that were predicted.
    pub rows: Vec<Deviation>,
    /// Measurements that were asked for but that no tape takes from a standing body.
    pub untaken: Vec<String>,
    /// Measurements that were asked for and contradict each other.
    pub conflicts: Vec<Conflict>,
    /// Notes on parts of the motion's file that were left out.
    pub notes: Vec<String>,
    /// Proportions of the body in head lengths.
    pub proportions: ProportionBox,
}

/// A moment of a motion: the motion (`walk`, `run`, a BVH, VRML or X3D file) and the time (s).
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Name of the motion, or its file.
    pub motion: String,
    /// A second gait mixed in at equal phase, and its share, 0 to 1.
    pub blend: Option<(String, f64)>,
    /// Time within the motion (s).
    pub time: f64,
}

impl Moment {
    /// Name of the motion: the gait, or the file's name without folders and ending.
    fn name(&self) -> String {
        let stem = Path::new(&self.motion).file_stem();
        stem.map_or_else(
            || self.motion.clone(),
            |stem| stem.to_string_lossy().into_owned(),
        )
    }

    /// The clip of the whole motion for a mannequin, with notes on parts of the motion's file that were left
    /// out.
    fn motion_for(&self, mannequin: &Mannequin) -> Result<(Clip, Vec<String>), SessionError> {
        let skeleton = mannequin.skeleton();
        let (own, blend) = (own_clip(&self.motion, skeleton), &self.blend);
        let second = blend
            .as_ref()
            .map(|(name, share)| (own_clip(name, skeleton).filter(|clip| clip.is_loop), share));
        match (own, second) {
            (Some(own), None) => return Ok((own, Vec::new())),
            (Some(own), Some((Some(other), &share))) if own.is_loop => {
                return Ok((own.between(&other, share), Vec::new()));
            }
            (_, Some(_)) => {
                return Err(SessionError::Conflict(
                    "only walk and run are blended: the phases of other motions are not known; give one of them alone".to_owned(),
                ));
            }
            (None, None) => {}
        }
        open_clip(Path::new(&self.motion), skeleton)
    }
}

/// Measurements taken on the mesh of a person.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMeasured {
    /// The measurements (m).
    pub measurements: Measurements,
    /// Landmarks at which they were taken.
    pub landmarks: ScanLandmarks,
    /// Notes on corrections of the mesh.
    pub notes: Vec<String>,
}

/// A file with the mesh of a person, its landmarks and its stance.
#[derive(Clone, Copy, Debug)]
pub struct PersonFile<'a> {
    /// The mesh (OBJ or PLY): closed, of a standing person.
    pub mesh: &'a Path,
    /// File of landmarks (JSON); those left out are detected.
    pub landmarks: Option<&'a Path>,
    /// Stance of the mesh in its file; parts left out are detected.
    pub stance: AskedStance,
}

impl PersonFile<'_> {
    /// Opens the scan, with notes on corrections. Points among the landmarks are given in coordinates of the
    /// mesh file.
    fn open(&self) -> Result<(Scan, Vec<String>), SessionError> {
        let mut given = match self.landmarks {
            None => ScanLandmarks::default(),
            Some(path) => open_landmarks(path)?,
        };
        let (OpenedMesh { mesh, notes }, stance) = open_person(self.mesh, &self.stance)?;
        let points = [
            &mut given.nape,
            &mut given.shoulder_tip,
            &mut given.neck_side,
            &mut given.wrist,
        ];
        for point in points.into_iter().flatten() {
            *point = stance.place(Vec3::from(*point)).into();
        }
        let scan = Scan::new(mesh, given).map_err(|error| scan_error(self.mesh, &error))?;
        Ok((scan, notes))
    }
}

fn open_landmarks(path: &Path) -> Result<ScanLandmarks, SessionError> {
    serde_json::from_str(&read_input(path, ExpectedKind::SmallJson)?).map_err(|error| {
        let remedy = "give heights such as \"waist\": 1.05 and points such as \"nape\": [0, 1.4, -0.05] in metres";
        SessionError::Format {
            path: path.to_owned(),
            error: FormatError::new("the landmarks", error.to_string(), remedy),
        }
    })
}

fn scan_error(mesh: &Path, error: &BodyError) -> SessionError {
    SessionError::Format {
        path: mesh.to_owned(),
        error: FormatError::new("the mesh", error.to_string(), "correct it"),
    }
}

/// Measures a closed mesh of a standing person with the tape that measures mannequins, and writes the table
/// of measurements.
///
/// # Errors
/// A file that cannot be read, a mesh that is not closed, or the table cannot be written.
pub fn measure_mesh(person: &PersonFile, to: &Path) -> Result<MeshMeasured, SessionError> {
    check_ending(to, &[".json"], "measurements are written as NAME.json")?;
    let (scan, notes) = person.open()?;
    let measurements = scan.measurements();
    let text = write_measurements(&measurements).map_err(cannot("the measurements"))?;
    write_atomically(to, text.as_bytes())?;
    Ok(MeshMeasured {
        measurements,
        landmarks: scan.landmarks().clone(),
        notes,
    })
}

/// Fits a mannequin to a closed mesh of a standing person; also returns notes on corrections of the mesh.
///
/// # Errors
/// As [`measure_mesh`]; and a limb or a landmark that cannot be found.
pub fn fit_mesh(person: &PersonFile, figure: Figure) -> Result<(Fit, Vec<String>), SessionError> {
    let (scan, notes) = person.open()?;
    let fit = scan
        .fit(figure)
        .map_err(|error| scan_error(person.mesh, &error))?;
    Ok((fit, notes))
}

/// Scaling asked of a body: proportions, stature and the five scaling parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyStretch {
    /// Proportions that the body is first brought to, at the stature that it has.
    pub proportions: Option<ProportionBox>,
    /// Stature that the body is brought to (m).
    pub stature: Option<f64>,
    /// The scaling parameters; the global one multiplies the scale to the stature.
    pub ratios: Scaling,
}

/// Scales the body in `described`, which has a frame of its own; without it, the body of `figure`.
///
/// # Errors
/// A body grown to measurements, or ratios no body has.
pub fn stretch_body(
    described: Option<Description>,
    figure: Figure,
    stretch: &BodyStretch,
) -> Result<Description, SessionError> {
    let body = match described {
        Some(body) => body,
        None => Mannequin::framed(figure)?,
    };
    let body = match &stretch.proportions {
        Some(proportions) => proportions.apply(&body)?,
        None => body,
    };
    let mut ratios = stretch.ratios;
    if let (Some(stature), Some(frame)) = (stretch.stature, &body.frame) {
        ratios.global *= Scaling::to_stature(frame, stature * 1e3).global;
    }
    Ok(ratios.apply(&body)?)
}

/// Source of a body.
#[derive(Clone, Copy, Debug)]
pub enum BodySource<'a> {
    /// The wearer of a project.
    Wearer(&'a Project),
    /// The description in a mannequin file.
    Described(&'a Description),
}

/// Makes a mannequin and writes it in the format of the file's ending: `.glb` with skeleton and the whole
/// clip of the motion; `.character.json` with ellipsoids and clips for real time; other `.json` as a
/// mannequin file; else its skin as OBJ, at rest or at a moment of a motion. Returns every measurement as
/// asked or predicted and as taken at rest.
///
/// # Errors
/// Measurements no body can have, a motion that cannot be read, a file of another kind or one that
/// holds no pose, or the file cannot be written.
pub fn make_body(
    source: BodySource,
    moment: Option<&Moment>,
    to: &Path,
) -> Result<BodyReport, SessionError> {
    let remedy = "bodies are written as NAME.obj (skin), NAME.glb (with skeleton and motion), NAME.json (mannequin file) and NAME.character.json (ellipsoids and clips for real time)";
    check_ending(to, &[".obj", ".glb", ".json"], remedy)?;
    let extension = to
        .extension()
        .and_then(|end| end.to_str())
        .unwrap_or_default();
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let is_character = name.to_lowercase().ends_with(".character.json");
    if moment.is_some() && extension.eq_ignore_ascii_case("json") && !is_character {
        return Err(SessionError::Conflict(format!(
            "{}: a mannequin file holds no pose; write a posed body as NAME.obj or NAME.glb",
            to.display()
        )));
    }
    let is_whole = is_character || extension.eq_ignore_ascii_case("glb");
    if moment.is_some_and(|m| m.time != 0.0) && is_whole {
        return Err(SessionError::Conflict(format!(
            "{}: this file holds the whole motion; leave --time out, or write the pose as NAME.obj",
            to.display()
        )));
    }
    let mannequin = match source {
        BodySource::Wearer(project) => {
            Mannequin::new(&project.body_measurements(), project.figure())?
        }
        BodySource::Described(description) => Mannequin::from_description(description)?,
    };
    let motion = moment.map(|m| m.motion_for(&mannequin)).transpose()?;
    let (motion, notes) = match motion {
        Some((motion, notes)) => (moment.map(|m| (m, motion)), notes),
        None => (None, Vec::new()),
    };
    let bytes = match extension.to_ascii_lowercase().as_str() {
        "glb" => {
            let named = motion.as_ref().map(|(m, motion)| (m.name(), motion));
            let named = named.as_ref().map(|(name, motion)| (&**name, *motion));
            write_body_glb(&mannequin, named)
        }
        "json" if is_character => {
            let named = motion.as_ref().map(|(m, motion)| (m.name(), motion));
            let named = named.as_ref().map(|(name, motion)| (&**name, *motion));
            write_character(&character_with(&mannequin, named)?).map(String::into_bytes)
        }
        "json" => write_mannequin(&mannequin.description()).map(String::into_bytes),
        _ => {
            let obj = match &motion {
                None => body_obj(mannequin.skin()),
                Some((moment, motion)) => {
                    let pose = motion.pose_for(mannequin.skeleton(), moment.time);
                    body_obj(&mannequin.posed_skin(&pose))
                }
            };
            write_obj(&obj).map(String::into_bytes)
        }
    };
    write_atomically(to, &bytes.map_err(cannot("the body"))?)?;
    Ok(BodyReport {
        rows: mannequin.measure(),
        untaken: mannequin.untaken(),
        conflicts: mannequin.conflicts(),
        notes,
        proportions: ProportionBox::of_body(&mannequin),
    })
}
