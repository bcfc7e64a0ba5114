//! Runs a scene file: loads its meshes, patterns and bodies, simulates them, and writes the results.
//!
//! # Decided with
//! - [`crate::scene_builder::Builder`]: the scene built from its file;
//! - [`toile_drape::SceneRun`]: the run;
//! - [`crate::scene_checkpoint::CheckpointTimes`], [`crate::scene_checkpoint::SavedRun`]: when it is saved,
//!   how it is resumed;
//! - [`crate::pace::Pace`]: progress in words, and when a run is given up;
//! - [`crate::recorder::Recorder`], [`crate::scene_pictures::SceneAlbum`]: frames and pictures;
//! - [`crate::crossings::Crossings`], [`crate::frame_counts::FrameCounts`]: crossings counted in the run and
//!   in saved frames;
//! - [`crate::verdict::of_scene`]: how the run is judged.
//!
//! Options: crate `cli`, `arguments.rs` (`Run`), `tool_commands.rs`.

use crate::crossings::{Crossings, Tangles};
use crate::frame_counts::FrameCounts;
use crate::open::read_input;
use crate::output::{cannot, file_name};
use crate::pace::Pace;
use crate::recorder::{Recorder, moving_surfaces};
use crate::scene_builder::Builder;
use crate::scene_checkpoint::{CheckpointTimes, NAME, Place, RunOptions, SavedRun};
use crate::scene_pictures::SceneAlbum;
use crate::timing::Timing;
use crate::watcher::report_progress;
use crate::{SessionError, Watcher, verdict};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;
use toile_drape::{
    Finding, Kind, Layers, Object, ObjectId, Scene, SceneCheckpoint, SceneRun, Surface, Verdict,
};
use toile_interchange::{
    ExpectedKind, FormatError, ObjGroup, ObjMesh, read_scene, write_all_atomically, write_obj,
};

/// Result of running a scene.
#[derive(Clone, Debug)]
pub struct SceneOutcome {
    /// Files written.
    pub files: Vec<PathBuf>,
    /// The report, as JSON.
    pub report: serde_json::Value,
    /// Verdict on the run; the report holds it, too.
    pub verdict: Verdict,
}

/// Largest number of frames that a scene may save: beyond this the frame step is surely a mistake.
const MAX_FRAMES: f64 = 100_000.0;

/// Runs a scene file and writes its frames, its last state and a report into a folder. A run that continues
/// from a checkpoint writes the same bytes as a run without interruption, at any number of threads.
///
/// # Errors
/// The scene, a file it names or the checkpoint cannot be read, the simulation fails, a file cannot be
/// written, or a checkpoint is asked of a method that has none.
pub fn run_scene(
    path: &Path,
    folder: &Path,
    options: &RunOptions,
    watcher: &mut dyn Watcher,
) -> Result<SceneOutcome, SessionError> {
    let mut timing = Timing::default();
    timing.restart();
    let start = Instant::now();
    let text = read_input(path, ExpectedKind::Scene)?;
    let wrong = |error| SessionError::Format {
        path: path.to_owned(),
        error,
    };
    let (file, unknown) = read_scene(&text).map_err(wrong)?;
    let notes = unknown
        .iter()
        .map(|field| format!("the field {field} is not known and was left out"));
    let mut builder = Builder::new(path, &file, notes.collect());
    let scene = builder.scene(watcher)?;
    timing.add("read", start);
    let start = Instant::now();
    check_frames(&scene).map_err(wrong)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = name.trim_end_matches(".scene").to_owned();
    let place = Place {
        folder: folder.to_owned(),
        name: file_name(&name),
    };
    let begun = Begun::new(&scene, &place, options)?;
    let names = moving_surfaces(begun.run.world()).map_err(wrong)?;
    let mut course = Course {
        scene: &scene,
        counted: &builder.counted,
        checkpoints: CheckpointTimes::new(options, &begun.run)?,
        place,
        pace: Pace::new(options, &begun.run)?,
        names,
        begun,
        written: Vec::new(),
    };
    let given_up = course.follow(watcher)?;
    timing.add("simulate", start);
    let start = Instant::now();
    let mut files = state_files(&course.begun.run, &course.names)?;
    let Begun {
        run,
        crossings,
        album,
        frames,
        ..
    } = &mut course.begun;
    let (report, verdict) = report(run, builder.notes, (crossings, frames), given_up);
    timing.add("measure", start);
    let start = Instant::now();
    files.extend(album.paint(run, &verdict, &name)?);
    timing.add("paint", start);
    let pretty = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
    files.push(("report.json".to_owned(), pretty.into_bytes()));
    files.push(("timing.json".to_owned(), timing.to_json().into_bytes()));
    course.write(&files)?;
    Ok(SceneOutcome {
        files: course.written,
        report,
        verdict,
    })
}

/// A run before its next step, with everything that a checkpoint of it contains.
struct Begun {
    run: SceneRun,
    crossings: Crossings,
    album: SceneAlbum,
    /// Recorder of the frames, if they are saved.
    recorder: Option<Recorder>,
    /// Counts over the frames written.
    frames: FrameCounts,
}

impl Begun {
    /// A run at its start, or where a checkpoint of it was saved.
    fn new(scene: &Scene, place: &Place, options: &RunOptions) -> Result<Self, SessionError> {
        let album = |run: &SceneRun| SceneAlbum::new(&options.pictures, run);
        let records = scene.frame_step.is_some();
        let saved = match (options.restart, options.resume) {
            (Some(frame), _) => {
                check_frame(scene, frame)?;
                SavedRun::before(place, frame)?
            }
            (None, true) => SavedRun::read(&place.folder)?,
            (None, false) => {
                let run = SceneRun::new(scene, toile_reference::build)?;
                return Ok(Self {
                    crossings: Crossings::new(&run),
                    album: album(&run)?,
                    recorder: records.then(|| Recorder::new(place.frames())),
                    run,
                    frames: FrameCounts::default(),
                });
            }
        };
        let run = SceneRun::resume(scene, saved.run, toile_reference::build)?;
        let mut album = album(&SceneRun::new(scene, toile_reference::build)?)?;
        album.resume(&run, &saved.ways)?;
        let recorder = match records {
            true => Some(Recorder::resume(place.frames(), saved.frame_bytes)?),
            false => None,
        };
        let crossings = Crossings::resumed(&run, saved.crossings);
        Ok(Self {
            run,
            crossings,
            album,
            recorder,
            frames: saved.frames,
        })
    }

    /// A checkpoint of the present state.
    fn kept(&self) -> Result<Kept, SessionError> {
        Ok(Kept {
            time: self.run.state.time,
            saved: self.saved(self.run.checkpoint()?),
        })
    }

    /// The state to save, with a checkpoint of the run.
    fn saved(&self, run: SceneCheckpoint) -> SavedRun {
        SavedRun {
            frames: self.frames,
            frame_bytes: self.recorder.as_ref().map_or(0, Recorder::length),
            crossings: self.crossings.counts(),
            ways: self.album.ways().clone(),
            run,
        }
    }
}

/// A checkpoint that is written only if the run is given up.
struct Kept {
    /// Simulated time (s).
    time: f64,
    saved: SavedRun,
}

/// The course of a run from step to step.
struct Course<'a> {
    scene: &'a Scene,
    /// For each triangle of cloth, whether its stretch counts.
    counted: &'a [bool],
    place: Place,
    /// The surfaces that move, with the names of their files.
    names: Vec<(Vec<ObjectId>, String)>,
    begun: Begun,
    checkpoints: CheckpointTimes,
    pace: Pace,
    /// Files written.
    written: Vec<PathBuf>,
}

impl Course<'_> {
    /// Takes all steps; writes frames and checkpoints on the way. Returns a finding if the run was given up.
    fn follow(&mut self, watcher: &mut dyn Watcher) -> Result<Option<Finding>, SessionError> {
        if self.begun.run.steps() == 0 {
            self.place.clear()?;
            self.keep_landmark()?;
        }
        // With contact of cloth with cloth, checkpoints can only be taken at whole seconds. The last one is
        // kept, to be written if the run is given up.
        let mut kept = self.keep(None)?;
        while !self.begun.run.finished() {
            self.write_frame()?;
            self.begun.run.advance()?;
            let Begun {
                run,
                crossings,
                album,
                ..
            } = &mut self.begun;
            crossings.follow(run);
            album.follow(run);
            if let Some(checkpoint) = self.checkpoints.due(run)? {
                self.begun
                    .saved(checkpoint)
                    .write(&self.place.folder, NAME)?;
            }
            self.keep_landmark()?;
            kept = self.keep(kept)?;
            let run = &self.begun.run;
            if let Some(mut finding) = self.pace.follow(run)
                && !run.finished()
            {
                if let Some(Kept { time, saved }) = self.newest_checkpoint(kept)? {
                    saved.write(&self.place.folder, NAME)?;
                    finding.words.push_str(&format!(
                        "; checkpoint.json holds it at {time:.3} s, to go on from it with --resume"
                    ));
                }
                return Ok(Some(finding));
            }
            let words = self.pace.words(run);
            report_progress(watcher, "simulating", run.share(), &words)?;
        }
        Ok(None)
    }

    /// The newest checkpoint of a run that has a limit at which it is given up: `kept`, or a new one after a
    /// simulated second. `None`: there is no such limit, or no checkpoint could be taken yet.
    fn keep(&self, kept: Option<Kept>) -> Result<Option<Kept>, SessionError> {
        let run = &self.begun.run;
        let is_new = kept
            .as_ref()
            .is_none_or(|kept| run.state.time - kept.time > 1.0 - 1e-9);
        if !self.pace.may_give_up() || !is_new || run.steps_to_checkpoint() > 0 {
            return Ok(kept);
        }
        Ok(Some(self.begun.kept()?))
    }

    /// Saves a checkpoint beside the frames if frames are recorded and the run is at a step whose checkpoint
    /// is kept ([`SceneRun::is_landmark`]).
    fn keep_landmark(&self) -> Result<(), SessionError> {
        let run = &self.begun.run;
        if self.begun.recorder.is_none() || !run.is_landmark() || !run.has_checkpoints() {
            return Ok(());
        }
        let saved = self.begun.saved(run.checkpoint()?);
        saved.write(&self.place.checkpoints(), &Place::checkpoint(run.steps()))
    }

    /// A checkpoint of the present state if one can be taken, else `kept`.
    fn newest_checkpoint(&self, kept: Option<Kept>) -> Result<Option<Kept>, SessionError> {
        let run = &self.begun.run;
        match run.steps_to_checkpoint() {
            0 => Ok(Some(self.begun.kept()?)),
            _ => Ok(kept),
        }
    }

    /// Writes a frame if one is due.
    fn write_frame(&mut self) -> Result<(), SessionError> {
        let Begun {
            run,
            frames,
            recorder,
            ..
        } = &mut self.begun;
        let (Some(step), Some(recorder)) = (self.scene.frame_step, recorder) else {
            return Ok(());
        };
        let number = frames.frames();
        if run.state.time + 1e-9 < number as f64 * step {
            return Ok(());
        }
        recorder.record(run, &self.names)?;
        frames.add(run, self.counted);
        if !self.written.iter().any(|path| path == recorder.path()) {
            self.written.push(recorder.path().to_owned());
        }
        Ok(())
    }

    fn write(&mut self, files: &[(String, Vec<u8>)]) -> Result<(), SessionError> {
        let folder = &self.place.folder;
        self.written
            .extend(files.iter().map(|(name, _)| folder.join(name)));
        Ok(write_all_atomically(folder, files)?)
    }
}

/// Refuses a scene that would save more frames than anybody looks at.
fn check_frames(scene: &Scene) -> Result<(), FormatError> {
    let count = scene.frame_step.map_or(0.0, |step| scene.duration / step);
    match count > MAX_FRAMES {
        true => Err(FormatError::new(
            "frame_step",
            format!("{count:.0} frames would be saved; at most {MAX_FRAMES} are"),
            "give a longer frame step, or a shorter duration",
        )),
        false => Ok(()),
    }
}

/// Refuses a frame that the scene does not save.
fn check_frame(scene: &Scene, frame: usize) -> Result<(), SessionError> {
    let time = scene.frame_step.map(|step| step * frame as f64);
    match time {
        Some(time) if time <= scene.duration => Ok(()),
        _ => Err(SessionError::Unknown {
            kind: "frame",
            name: frame.to_string(),
            hint: match scene.frame_step {
                None => "the scene saves none: give its frame_step a time".to_owned(),
                Some(step) => format!("the last one is {:.0}", (scene.duration / step).floor()),
            },
        }),
    }
}

/// The surfaces that move as OBJ files, a group for each object.
fn state_files(
    run: &SceneRun,
    names: &[(Vec<ObjectId>, String)],
) -> Result<Vec<(String, Vec<u8>)>, SessionError> {
    let mut files = Vec::new();
    for (objects, name) in names {
        let Surface { objects, mesh, .. } = run.surface(objects);
        let group = |(id, triangles): (ObjectId, Range<usize>)| {
            let name = run.world().object(id)?.name.clone();
            Some(ObjGroup { name, triangles })
        };
        let obj = ObjMesh {
            positions: mesh.positions,
            triangles: mesh.triangles,
            groups: match objects.len() {
                1 => Vec::new(),
                _ => objects.into_iter().filter_map(group).collect(),
            },
            ..ObjMesh::default()
        };
        let text = write_obj(&obj).map_err(cannot("the state"))?;
        files.push((format!("{name}.obj"), text.into_bytes()));
    }
    Ok(files)
}

/// The report, and the verdict in it.
fn report(
    run: &mut SceneRun,
    notes: Vec<String>,
    (crossings, frames): (&Crossings, &FrameCounts),
    given_up: Option<Finding>,
) -> (serde_json::Value, Verdict) {
    let measures = run.measure();
    let mut verdict = verdict::of_scene(run, &measures, crossings);
    verdict.extend(given_up);
    let mut warnings = notes;
    warnings.extend(verdict.words().map(str::to_owned));
    let layers = measures.layers.iter().map(|layer| {
        let of_layer =
            |o: &&Object| o.kind == Kind::Deformable && o.layers == Layers::One(layer.layer);
        let objects = run.world().objects().map(|(_, object)| object);
        let names = objects.filter(of_layer).map(|o| &o.name);
        serde_json::json!({
            "layer": layer.layer,
            "objects": names.collect::<Vec<_>>(),
            "body_intersections": layer.body_intersections,
            "self_intersections": layer.self_intersections,
            "outer_intersections": layer.outer_intersections,
            "astray": layer.astray,
        })
    });
    let layers: Vec<_> = layers.collect();
    let report = serde_json::json!({
        "method": run.settings().method.kind.name(),
        "vertices": run.state.positions.len(),
        "triangles": run.system.topology.triangles.len(),
        "steps": run.steps(),
        "time_s": run.state.time,
        "residual": run.residual_of(&measures),
        "kinetic_energy_J": measures.kinetic_energy,
        "strain_max": { "warp": measures.strain_max[0], "weft": measures.strain_max[1] },
        "strain_p99": { "warp": measures.strain_p99[0], "weft": measures.strain_p99[1] },
        "seam_gap_max_m": run.elastic_gap(),
        "body_penetration_max_m": measures.penetration_max,
        "body_intersections": measures.body_intersections,
        "edges_through_body": measures.edges_through_body,
        "self_intersections": measures.self_intersections,
        "crossings": crossings,
        "frames": (frames.frames() > 0).then_some(frames),
        "layers": layers,
        "tangles": run.cloth_tally().map(|tally| Tangles::of(&tally)),
        "verdict": verdict,
        "warnings": warnings,
    });
    (report, verdict)
}
