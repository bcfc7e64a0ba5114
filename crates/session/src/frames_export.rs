//! Recorded frames written for other programs: an animated GLB, point caches with their mesh, OBJ files,
//! pictures.

use crate::SessionError;
use crate::output::{File, cannot};
use crate::recorded_surface::{RecordedSurface, open_frames};
use crate::state_picture::{RunCamera, ShownSurface};
use std::path::{Path, PathBuf};
use toile_interchange::{
    Frame, FrameSection, Frames, MovingGlbMesh, ObjGroup, ObjMesh, PointCache,
    write_all_atomically, write_frames_glb, write_obj, write_pc2,
};

/// Selection of recorded frames to write.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FramesExport {
    /// Object to write; in pictures, the object that the camera follows. `None` for all objects.
    pub object: Option<String>,
    /// Frame to write, counted from 0; `None` for all frames.
    pub frame: Option<usize>,
}

/// Result of writing recorded frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FramesOutcome {
    /// Files written.
    pub files: Vec<PathBuf>,
    /// Frames read.
    pub frames: usize,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A frame with its number in the file and the surfaces written of it.
struct Chosen<'a> {
    number: usize,
    frame: &'a Frame,
    surfaces: &'a [RecordedSurface],
}

/// Writes frames in the format of the file's ending: `.glb` (morph targets), `.pc2` (a point cache for each
/// surface that moves, with its first frame as OBJ), `.obj` and `.png` (a file for each frame).
///
/// # Errors
/// The frames cannot be read; an unknown ending, object or frame; a file that cannot be written.
pub fn export_frames(
    path: &Path,
    out: &Path,
    export: &FramesExport,
) -> Result<FramesOutcome, SessionError> {
    let frames = open_frames(path)?;
    let count = frames.sections.iter().map(|s| s.frames.len()).sum();
    let mut notes = Vec::new();
    if frames.left_out > 0 {
        notes.push(format!(
            "{}: it was cut short: {} bytes after its last whole frame were left out",
            path.display(),
            frames.left_out
        ));
    }
    let ending = out.extension().unwrap_or_default().to_string_lossy();
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let files = match &*ending {
        "glb" => glb_files(&frames, export, &stem)?,
        "pc2" => point_caches(&frames, export, &stem)?,
        "obj" | "png" => {
            let surfaces = section_surfaces(&frames, export)?;
            let chosen = chosen(&frames, &surfaces, export.frame)?;
            match &*ending {
                "obj" => obj_files(&chosen, export, &stem)?,
                _ => {
                    let name = path.file_stem().unwrap_or_default().to_string_lossy();
                    pictures(&frames, &chosen, export, [&stem, &name])?
                }
            }
        }
        _ => {
            return Err(SessionError::Unknown {
                kind: "format of frames",
                name: ending.into_owned(),
                hint: "end the name of --out in .glb, .pc2, .obj or .png".to_owned(),
            });
        }
    };
    let folder = out.parent().unwrap_or(Path::new("."));
    write_all_atomically(folder, &files)?;
    Ok(FramesOutcome {
        files: files.iter().map(|(name, _)| folder.join(name)).collect(),
        frames: count,
        notes,
    })
}

/// The surfaces of each section: all, or the one object asked for.
fn section_surfaces(
    frames: &Frames,
    export: &FramesExport,
) -> Result<Vec<Vec<RecordedSurface>>, SessionError> {
    let of = |section: &FrameSection| match &export.object {
        None => Ok(RecordedSurface::all(section)),
        Some(name) => Ok(vec![RecordedSurface::named(section, Some(name))?]),
    };
    frames.sections.iter().map(of).collect()
}

/// The frames of the file in their order, or one of them.
fn chosen<'a>(
    frames: &'a Frames,
    surfaces: &'a [Vec<RecordedSurface>],
    only: Option<usize>,
) -> Result<Vec<Chosen<'a>>, SessionError> {
    let sections = frames.sections.iter().zip(surfaces);
    let all =
        sections.flat_map(|(section, surfaces)| section.frames.iter().map(move |f| (f, surfaces)));
    let numbered = all.enumerate().map(|(number, (frame, surfaces))| Chosen {
        number,
        frame,
        surfaces,
    });
    let chosen: Vec<Chosen> = numbered
        .filter(|chosen| only.is_none_or(|only| only == chosen.number))
        .collect();
    match (only, chosen.is_empty()) {
        (Some(frame), true) => Err(SessionError::Unknown {
            kind: "frame",
            name: frame.to_string(),
            hint: {
                let count: usize = frames.sections.iter().map(|s| s.frames.len()).sum();
                format!("the file has {count}, counted from 0")
            },
        }),
        _ => Ok(chosen),
    }
}

/// Name of the file of a section, counted from 0; from the second section on with a number.
fn numbered(stem: &str, section: usize) -> String {
    match section {
        0 => stem.to_owned(),
        _ => format!("{stem}-{}", section + 1),
    }
}

/// Refuses a single frame in a format that holds motion.
fn refuse_one_frame(export: &FramesExport) -> Result<(), SessionError> {
    match export.frame {
        None => Ok(()),
        Some(_) => {
            let what = "one frame is no motion; write it as .obj or .png, or leave out --frame";
            Err(SessionError::Conflict(what.to_owned()))
        }
    }
}

/// One animated GLB for each section that has frames.
fn glb_files(
    frames: &Frames,
    export: &FramesExport,
    stem: &str,
) -> Result<Vec<File>, SessionError> {
    refuse_one_frame(export)?;
    let surfaces = section_surfaces(frames, export)?;
    let mut files = Vec::new();
    let sections = frames.sections.iter().zip(&surfaces);
    for (section, surfaces) in sections.filter(|(section, _)| !section.frames.is_empty()) {
        let meshes = surfaces.iter().filter(|s| !s.triangles.is_empty());
        let meshes = meshes.map(|surface| MovingGlbMesh {
            name: surface.name.clone(),
            triangles: surface.triangles.clone(),
            frames: match surface.is_still() {
                true => vec![surface.positions(&section.frames[0])],
                false => section
                    .frames
                    .iter()
                    .map(|f| surface.positions(f))
                    .collect(),
            },
            colour: match surface.rest {
                Some(_) => [0.25, 0.4, 0.6],
                None => [0.62, 0.58, 0.55],
            },
        });
        let meshes: Vec<MovingGlbMesh> = meshes.collect();
        let times: Vec<f64> = section.frames.iter().map(|frame| frame.time).collect();
        let bytes = write_frames_glb(&meshes, &times).map_err(cannot("the animation"))?;
        files.push((format!("{}.glb", numbered(stem, files.len())), bytes));
    }
    Ok(files)
}

/// A point cache for each surface that moves and each section, with its first frame as OBJ.
fn point_caches(
    frames: &Frames,
    export: &FramesExport,
    stem: &str,
) -> Result<Vec<File>, SessionError> {
    refuse_one_frame(export)?;
    let surfaces = section_surfaces(frames, export)?;
    let mut files = Vec::new();
    let mut number = 0;
    for (section, surfaces) in frames.sections.iter().zip(&surfaces) {
        let Some(first) = section.frames.first() else {
            continue;
        };
        let moving: Vec<_> = surfaces.iter().filter(|s| !s.is_still()).collect();
        for surface in &moving {
            let name = match moving.len() {
                1 => stem.to_owned(),
                _ => format!("{stem}-{}", surface.name),
            };
            let name = numbered(&name, number);
            let cache = PointCache {
                start: 0.0,
                step: 1.0,
                samples: section
                    .frames
                    .iter()
                    .map(|f| surface.positions(f))
                    .collect(),
            };
            let bytes = write_pc2(&cache).map_err(cannot("the point cache"))?;
            files.push((format!("{name}.pc2"), bytes));
            files.push((format!("{name}.obj"), obj(&[(*surface).clone()], first)?));
        }
        number += 1;
    }
    Ok(files)
}

/// Surfaces in a frame as one OBJ file with a group for each.
fn obj(surfaces: &[RecordedSurface], frame: &Frame) -> Result<Vec<u8>, SessionError> {
    let mut whole = ObjMesh::default();
    for surface in surfaces {
        let mesh = surface.mesh(frame);
        let (base, first) = (whole.positions.len() as u32, whole.triangles.len());
        whole.positions.extend(mesh.positions);
        let triangles = mesh.triangles.iter().map(|t| t.map(|v| v + base));
        whole.triangles.extend(triangles);
        if surfaces.len() > 1 {
            whole.groups.push(ObjGroup {
                name: surface.name.clone(),
                triangles: first..whole.triangles.len(),
            });
        }
    }
    Ok(write_obj(&whole).map_err(cannot("the frame"))?.into_bytes())
}

/// Name of the file of a frame.
fn frame_name(stem: &str, number: usize, export: &FramesExport, ending: &str) -> String {
    match export.frame {
        Some(_) => format!("{stem}.{ending}"),
        None => format!("{stem}-{number:05}.{ending}"),
    }
}

fn obj_files(
    chosen: &[Chosen],
    export: &FramesExport,
    stem: &str,
) -> Result<Vec<File>, SessionError> {
    let file = |chosen: &Chosen| {
        let name = frame_name(stem, chosen.number, export, "obj");
        Ok((name, obj(chosen.surfaces, chosen.frame)?))
    };
    chosen.iter().map(file).collect()
}

/// Pictures of all surfaces by one camera, which follows the object asked for.
fn pictures(
    frames: &Frames,
    chosen: &[Chosen],
    export: &FramesExport,
    [stem, name]: [&str; 2],
) -> Result<Vec<File>, SessionError> {
    let shown = |section: &FrameSection, frame: &Frame| -> Vec<ShownSurface> {
        let surfaces = RecordedSurface::all(section).into_iter();
        let surfaces = surfaces.map(|surface| ShownSurface {
            mesh: surface.mesh(frame),
            panels: surface.rest.as_ref().map(|rest| rest.panel.clone()),
            is_still: surface.is_still(),
            name: surface.name,
        });
        surfaces.collect()
    };
    let mut camera = RunCamera {
        followed: export.object.clone(),
        ..RunCamera::default()
    };
    let names = frames.sections.iter().flat_map(|s| &s.head.surfaces);
    camera.check(names.map(|surface| &*surface.name))?;
    let all = frames
        .sections
        .iter()
        .flat_map(|s| s.frames.iter().map(move |f| (s, f)));
    for (section, frame) in all.clone() {
        camera.take_in(&shown(section, frame));
    }
    let mut files = Vec::with_capacity(chosen.len());
    for (number, (section, frame)) in all.enumerate() {
        if chosen.iter().any(|chosen| chosen.number == number) {
            let title = format!("{name} at {:.3} s", frame.time);
            let picture = camera.picture(&shown(section, frame), [title, String::new()])?;
            files.push((frame_name(stem, number, export, "png"), picture));
        }
    }
    Ok(files)
}
