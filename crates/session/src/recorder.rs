//! Records the frames of a scene's run into a file, which grows frame by frame.
//!
//! # Decided with
//! - [`toile_interchange::FrameWriter`]: the file;
//! - [`crate::scene`] (`write_frame`): when a frame is recorded;
//! - [`crate::recorded_surface::RecordedSurface`], [`crate::scene_frames`] (`recorded_object`): surfaces of
//!   recorded frames; recorded frames in a scene;
//! - [`toile_drape::RecordedTrack`]: the way of recorded positions;
//! - [`crate::frames_export::export_frames`]: written for other programs.

use crate::SessionError;
use crate::output::{cannot, file_name};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, create_dir_all};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toile_drape::{Kind, Object, ObjectId, SceneRun, Surface, World};
use toile_geometry::Vec3;
use toile_interchange::{
    FileError, FormatError, Frame, FrameHead, FrameSurface, FrameWriter, RestShape, read_frames,
};

/// A file of frames that is being written. It is written in place: a run that is stopped leaves the frames
/// recorded so far.
pub(crate) struct Recorder {
    path: PathBuf,
    /// Length of the part of the file that holds frames of this run (bytes).
    length: u64,
    /// Section of the file that frames are added to: its surfaces and its writer. `None`: none has begun.
    section: Option<(Vec<FrameSurface>, FrameWriter)>,
    /// The open file; `None` before the first frame.
    file: Option<File>,
}

impl Recorder {
    /// A recorder that replaces a file of the same path.
    pub fn new(path: PathBuf) -> Self {
        Self {
            path,
            length: 0,
            section: None,
            file: None,
        }
    }

    /// A recorder that continues after the first `length` bytes of its file and cuts the rest off.
    ///
    /// # Errors
    /// The file cannot be read, or does not have these bytes.
    pub fn resume(path: PathBuf, length: u64) -> Result<Self, SessionError> {
        let mut recorder = Self::new(path);
        if length == 0 {
            return Ok(recorder);
        }
        let path = &recorder.path;
        let wrong = |error| SessionError::Format {
            path: path.clone(),
            error,
        };
        let bytes = std::fs::read(path).map_err(|e| FileError::from_io("read", path, &e))?;
        let known = usize::try_from(length)
            .ok()
            .and_then(|end| bytes.get(..end));
        let known = known.ok_or_else(|| {
            let what = "it has fewer frames than the checkpoint knows";
            wrong(FormatError::new("the end", what, "begin the run anew"))
        })?;
        let mut frames = read_frames(known).map_err(wrong)?;
        if let Some(section) = frames.sections.pop() {
            let (writer, _) = FrameWriter::begin(&section.head).map_err(wrong)?;
            recorder.section = Some((section.head.surfaces, writer));
        }
        recorder.length = length;
        Ok(recorder)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes recorded so far.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Records the present state; `groups` are its surfaces with their names.
    ///
    /// # Errors
    /// The file cannot be written; a coordinate that is not finite.
    pub fn record(
        &mut self,
        run: &SceneRun,
        groups: &[(Vec<ObjectId>, String)],
    ) -> Result<(), SessionError> {
        let (surfaces, positions) = surfaces(run, groups);
        let mut bytes = Vec::new();
        let wrong = cannot("the frames");
        let section = match self.section.take() {
            Some(section) if section.0 == surfaces => section,
            _ => {
                let head = FrameHead::new(run.digest(), surfaces);
                let (writer, line) = FrameWriter::begin(&head).map_err(&wrong)?;
                bytes = line;
                (head.surfaces, writer)
            }
        };
        let frame = Frame {
            step: run.steps() as u64,
            time: run.state.time,
            positions,
        };
        bytes.extend(section.1.record(&frame).map_err(wrong)?);
        self.section = Some(section);
        self.append(&bytes)?;
        Ok(())
    }

    fn append(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        let path = &self.path;
        let failed = |error: std::io::Error| FileError::from_io("write", path, &error);
        if self.file.is_none() {
            if let Some(folder) = path.parent() {
                create_dir_all(folder).map_err(failed)?;
            }
            let mut options = OpenOptions::new();
            options.create(true).truncate(false).write(true);
            let mut file = options.open(path).map_err(failed)?;
            file.set_len(self.length).map_err(failed)?;
            std::io::Seek::seek(&mut file, std::io::SeekFrom::End(0)).map_err(failed)?;
            self.file = Some(file);
        }
        if let Some(file) = &mut self.file {
            file.write_all(bytes).map_err(failed)?;
        }
        self.length += bytes.len() as u64;
        Ok(())
    }
}

/// The surfaces of a state, and the positions of the moving surfaces, one surface after the other (m).
fn surfaces(
    run: &SceneRun,
    groups: &[(Vec<ObjectId>, String)],
) -> (Vec<FrameSurface>, Vec<[f32; 3]>) {
    let objects: BTreeMap<ObjectId, &Object> = run.world().objects().collect();
    let single = |p: &Vec3| [p.x as f32, p.y as f32, p.z as f32];
    let (mut surfaces, mut moving) = (Vec::new(), Vec::new());
    for (group, name) in groups {
        let surface = run.surface(group);
        let cloth = run.cloth(&surface);
        let Surface { objects, mesh, .. } = surface;
        moving.extend(mesh.positions.iter().map(single));
        let named = |(id, range): (ObjectId, Range<usize>)| {
            let name = run.world().object(id)?.name.clone();
            Some((name, [range.start, range.end]))
        };
        surfaces.push(FrameSurface {
            name: name.clone(),
            objects: objects.into_iter().filter_map(named).collect(),
            vertices: mesh.positions.len(),
            triangles: mesh.triangles,
            still: None,
            rest: cloth.as_ref().map(RestShape::of),
        });
    }
    let is_known = |id: &ObjectId| groups.iter().any(|(group, _)| group.contains(id));
    for (id, object) in objects {
        let Some(mesh) = run.mesh_of(id).filter(|_| !is_known(&id)) else {
            continue;
        };
        surfaces.push(FrameSurface {
            name: file_name(&object.name),
            objects: vec![(object.name.clone(), [0, mesh.triangles.len()])],
            vertices: mesh.positions.len(),
            still: Some(mesh.positions.iter().map(single).collect()),
            triangles: mesh.triangles,
            rest: None,
        });
    }
    (surfaces, moving)
}

/// Longest name of a surface's file (bytes); a longer one is replaced by the first object and the number of
/// the other objects.
const MAX_NAME_LENGTH: usize = 160;

/// The surfaces that move: for each, the objects that are or will be sewn together in it, and the name of its
/// file. Two surfaces of one name are refused.
///
/// # Errors
/// Two surfaces of one name.
pub(crate) fn moving_surfaces(world: &World) -> Result<Vec<(Vec<ObjectId>, String)>, FormatError> {
    let mut names: Vec<(Vec<ObjectId>, String)> = Vec::new();
    let objects: BTreeMap<ObjectId, &Object> = world.objects().collect();
    for group in world.groups() {
        let of_group: Vec<&Object> = group.iter().map(|id| objects[id]).collect();
        if of_group.iter().all(|object| object.kind == Kind::Static) {
            continue;
        }
        let each: Vec<&str> = of_group.iter().map(|o| o.name.as_str()).collect();
        let whole = each.join("+");
        let files: Vec<String> = each.iter().map(|name| file_name(name)).collect();
        let mut name = files.join("+");
        if name.len() > MAX_NAME_LENGTH {
            name = format!("{}+{}", files[0], files.len() - 1);
        }
        let same = |(_, known): &&(_, String)| known.to_lowercase() == name.to_lowercase();
        if let Some((other, _)) = names.iter().find(same) {
            let other: Vec<&str> = other.iter().map(|id| objects[id].name.as_str()).collect();
            let other = other.join("+");
            let index = objects.keys().position(|id| *id == group[0]).unwrap_or(0);
            return Err(FormatError::new(
                format!("objects[{index}]"),
                format!("{whole:?} and {other:?} would be written to one file"),
                "give one of them another name",
            ));
        }
        names.push((group, name));
    }
    Ok(names)
}
