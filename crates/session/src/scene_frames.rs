//! Recorded frames in a scene: as the course of an animated object, or as the start of a cloth.

use crate::SessionError;
use crate::input::read_file;
use crate::recorded_surface::{RecordedSurface, open_frames};
use crate::scene_place::ScenePlace;
use std::path::Path;
use toile_body::Stance;
use toile_drape::{Cloth, DrapeError, RecordedTrack, SharedTrack};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{FormatError, Frames, ObjectFile, read_pc2};

/// Recorded frames that an object of a scene uses.
pub(crate) enum Recorded {
    /// A cloth in its initial position.
    Cloth(Cloth),
    /// The surface of a solid at the first frame (m) with its course.
    Moving(TriangleMesh, RecordedCourse),
}

/// Motion of a recorded surface: times (s), each with the positions of all vertices (m).
#[derive(Default)]
pub(crate) struct RecordedCourse(Vec<(f64, Vec<Vec3>)>);

/// Reads the recorded frames of an object; `None` if the object names no frames. `cached` is the mesh that
/// the object's point cache moves, with the stance of the scene's meshes.
///
/// # Errors
/// Frames that cannot be read or do not fit the object, and fields that need frames. `at` is the place of the
/// object in the scene file.
pub(crate) fn recorded(
    (scene, at): (ScenePlace, &str),
    object: &ObjectFile,
    cached: Option<(TriangleMesh, Stance)>,
) -> Result<Option<Recorded>, SessionError> {
    let wrong = |what: &str, remedy: &str| Err(scene.wrong(at.to_owned(), what.to_owned(), remedy));
    let Some(frames) = &object.frames else {
        let fields = [
            object.object.is_some(),
            object.frame.is_some(),
            object.rate.is_some(),
        ];
        return match fields.contains(&true) {
            false => Ok(None),
            true => wrong(
                "it has object, frame or rate, but no frames",
                "name a file of frames, or leave them out",
            ),
        };
    };
    let path = scene.beside(frames);
    let sources = (&object.mesh, &object.pattern, &object.body);
    match (object.kind.as_str(), sources, cached) {
        ("static", ..) => wrong(
            "it is static but has frames",
            "write animated or deformable",
        ),
        ("deformable", (None, None, None), _) => {
            Ok(Some(Recorded::Cloth(recorded_cloth(&path, object)?)))
        }
        ("animated", (None, None, None), _) => recorded_object(&path, object).map(Some),
        ("animated", (Some(_), None, None), Some((mesh, stance))) => {
            cached_object(&path, mesh, object.rate, |p| stance.place(p)).map(Some)
        }
        _ => wrong(
            "frames have a surface of their own; only a point cache (PC2) of an animated object goes with a mesh",
            "name one file",
        ),
    }
}

impl RecordedCourse {
    /// Track of the course; `place` gives the position of each point in the scene.
    ///
    /// # Errors
    /// Those of [`RecordedTrack::new`].
    pub fn track(self, place: impl Fn(Vec3) -> Vec3) -> Result<SharedTrack, DrapeError> {
        let placed = self.0.into_iter().map(|(time, mut positions)| {
            positions.iter_mut().for_each(|p| *p = place(*p));
            (time, positions)
        });
        Ok(SharedTrack::new(RecordedTrack::new(placed.collect())?))
    }

    /// The moving surface of the course, with its triangles.
    fn object(self, triangles: Vec<[u32; 3]>) -> Recorded {
        let positions = self.0.first().map(|(_, first)| first.clone());
        let mesh = TriangleMesh {
            positions: positions.unwrap_or_default(),
            triangles,
        };
        Recorded::Moving(mesh, self)
    }
}

fn wrong(
    path: &Path,
    place: impl Into<String>,
    what: impl Into<String>,
    hint: &str,
) -> SessionError {
    SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new(place, what, hint),
    }
}

/// Reads the recording of an animated object. The recorded object is the one that `object` names; else the
/// one with its own name; else the only one that moves.
///
/// # Errors
/// Frames that cannot be read, an object that is not among them, or whose triangles change from frame to
/// frame.
fn recorded_object(path: &Path, object: &ObjectFile) -> Result<Recorded, SessionError> {
    let frames = open_frames(path)?;
    let mut triangles: Option<Vec<[u32; 3]>> = None;
    let mut course = RecordedCourse::default();
    for section in &frames.sections {
        if section.frames.is_empty() {
            continue;
        }
        let surface = named(section, object)?;
        if triangles
            .as_ref()
            .is_some_and(|known| *known != surface.triangles)
        {
            let what = format!(
                "the triangles of {:?} change at frame {}",
                surface.name,
                course.0.len()
            );
            let hint = "record it again in a run that starts after its seams are closed";
            return Err(wrong(path, "frames", what, hint));
        }
        for frame in &section.frames {
            course.0.push((frame.time, surface.mesh(frame).positions));
        }
        triangles = Some(surface.triangles);
    }
    Ok(course.object(triangles.unwrap_or_default()))
}

fn named(
    section: &toile_interchange::FrameSection,
    object: &ObjectFile,
) -> Result<RecordedSurface, SessionError> {
    let own = RecordedSurface::named(section, Some(&object.name));
    match (&object.object, own) {
        (Some(name), _) => RecordedSurface::named(section, Some(name)),
        (None, Ok(own)) => Ok(own),
        // The object need not have the same name in this scene as in the recording.
        (None, Err(_)) => RecordedSurface::named(section, None),
    }
}

/// A mesh that moves by a point cache (PC2) of its vertices, whose samples follow at a rate (1/s) from time
/// 0; `place` turns a point as the mesh was turned.
///
/// # Errors
/// A cache that cannot be read, or has other vertices than the mesh; no rate.
fn cached_object(
    path: &Path,
    mesh: TriangleMesh,
    rate: Option<f64>,
    place: impl Fn(Vec3) -> Vec3,
) -> Result<Recorded, SessionError> {
    let bytes = read_file(path)?;
    let cache = read_pc2(&bytes).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })?;
    let Some(rate) = rate.filter(|rate| rate.is_finite() && *rate > 0.0) else {
        let what = "it holds samples but no times";
        return Err(wrong(
            path,
            "rate",
            what,
            "give the object its rate: frames a second, above 0",
        ));
    };
    let points = cache.samples.first().map_or(0, Vec::len);
    if points != mesh.positions.len() {
        let what = format!(
            "it has {points} points, the mesh {} vertices",
            mesh.positions.len()
        );
        return Err(wrong(path, "points", what, "write both of the same mesh"));
    }
    let spacing = f64::from(cache.step) / rate;
    let course = cache.samples.into_iter().enumerate().map(|(k, sample)| {
        let positions = sample.iter().map(|p| place(Vec3::from(p.map(f64::from))));
        (k as f64 * spacing, positions.collect())
    });
    Ok(RecordedCourse(course.collect()).object(mesh.triangles))
}

/// A cloth that starts in the position of a recorded frame, with its rest shape: in the last frame unless one
/// is named.
///
/// # Errors
/// Frames that cannot be read, a frame or an object that is not there, an object that is no cloth.
fn recorded_cloth(path: &Path, object: &ObjectFile) -> Result<Cloth, SessionError> {
    let frames = open_frames(path)?;
    let (section, frame) = frame_of(&frames, object.frame).ok_or_else(|| {
        let count: usize = frames.sections.iter().map(|s| s.frames.len()).sum();
        SessionError::Unknown {
            kind: "frame",
            name: object.frame.unwrap_or_default().to_string(),
            hint: format!("{} has {count}, counted from 0", path.display()),
        }
    })?;
    let surface = named(section, object)?;
    let Some(rest) = &surface.rest else {
        let what = format!("{:?} is no cloth there", surface.name);
        return Err(wrong(
            path,
            "frames",
            what,
            "name an object that was recorded as cloth",
        ));
    };
    Ok(rest.on(&surface.mesh(frame)))
}

/// A frame by its number in the file, else the last.
fn frame_of(
    frames: &Frames,
    number: Option<usize>,
) -> Option<(&toile_interchange::FrameSection, &toile_interchange::Frame)> {
    let sections = frames.sections.iter();
    let mut all = sections.flat_map(|s| s.frames.iter().map(move |frame| (s, frame)));
    match number {
        Some(number) => all.nth(number),
        None => all.last(),
    }
}
