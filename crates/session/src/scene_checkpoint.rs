//! The checkpoint file from which an interrupted run of a scene is resumed.
//!
//! # Decided with
//! - [`crate::scene::run_scene`], [`crate::scene_checkpoint::RunOptions`]: the options that ask for it;
//! - [`crate::scene_checkpoint::CheckpointTimes::due`], [`toile_drape::SceneRun::steps_to_checkpoint`]: at
//!   which steps it is due;
//! - [`toile_interchange::write_checkpoint`]: the checkpoint as text; damage and other versions refused;
//! - [`toile_drape::SceneRun::resume`]: another scene is refused;
//! - [`crate::scene`] (`keep_landmark`), [`crate::scene_checkpoint::SavedRun::before`]: checkpoints kept
//!   beside frames; the one before a time found again;
//! - [`crate::frame_counts::FrameCounts`], [`crate::recorder::Recorder::resume`]: counts and frames that go
//!   on.

use crate::frame_counts::FrameCounts;
use crate::state_picture::Ways;
use crate::{PictureOptions, SessionError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toile_drape::{DrapeError, SceneCheckpoint, SceneRun};
use toile_interchange::{
    CheckpointFormat, FileError, read_checkpoint, read_text, write_all_atomically, write_checkpoint,
};

/// Options of a run, in addition to the scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunOptions {
    /// Simulated time between two checkpoints (s); `None` for no checkpoints.
    pub checkpoint_step: Option<f64>,
    /// Continues from the checkpoint in the folder of the results.
    pub resume: bool,
    /// Continues from this frame, counted from 0: from the newest checkpoint beside the frames that is not
    /// later than the frame.
    pub restart: Option<usize>,
    /// Processor time of a simulated second beyond which the run is ended with a checkpoint (s); `None` for
    /// no limit.
    pub give_up: Option<f64>,
    /// Pictures to paint of the run.
    pub pictures: PictureOptions,
}

/// Name of the checkpoint file in the folder of the results.
pub(crate) const NAME: &str = "checkpoint.json";

/// Folder and name for the results of a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// The folder.
    pub folder: PathBuf,
    /// Name of the scene.
    pub name: String,
}

impl Place {
    /// The file of frames.
    pub fn frames(&self) -> PathBuf {
        self.folder.join(format!("{}.frames", self.name))
    }

    /// The folder of the checkpoints beside the frames.
    pub fn checkpoints(&self) -> PathBuf {
        self.folder.join(format!("{}.checkpoints", self.name))
    }

    /// File name of the checkpoint after a number of steps.
    pub fn checkpoint(steps: usize) -> String {
        format!("{steps:08}.json")
    }

    /// Paths of the checkpoints beside the frames, the newest first.
    fn kept(&self) -> Vec<PathBuf> {
        let files = std::fs::read_dir(self.checkpoints()).into_iter().flatten();
        let is_ours = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let number = name.strip_suffix(".json").unwrap_or_default();
            number.len() >= 8 && number.bytes().all(|byte| byte.is_ascii_digit())
        };
        let files = files.filter_map(|file| Some(file.ok()?.path()));
        let mut kept: Vec<PathBuf> = files.filter(is_ours).collect();
        kept.sort_by(|a, b| b.as_os_str().len().cmp(&a.as_os_str().len()).then(b.cmp(a)));
        kept
    }

    /// Removes the checkpoints of an earlier run.
    ///
    /// # Errors
    /// One of them cannot be removed.
    pub fn clear(&self) -> Result<(), SessionError> {
        for path in self.kept() {
            std::fs::remove_file(&path)
                .map_err(|error| FileError::from_io("remove", &path, &error))?;
        }
        Ok(())
    }
}

/// A run of a scene between two steps, with the counts of its report so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SavedRun {
    /// Counts over the frames written.
    pub frames: FrameCounts,
    /// Length of the file of frames (bytes).
    pub frame_bytes: u64,
    /// Crossings of cloth with cloth: before the first step, the most at one count, and at the last count.
    pub crossings: [usize; 3],
    /// Boxes that the objects have been in, if pictures are painted.
    #[serde(default, skip_serializing_if = "Ways::is_empty")]
    pub ways: Ways,
    /// State of the run.
    pub run: SceneCheckpoint,
}

impl CheckpointFormat for SavedRun {
    const FORMAT: &'static str = "toile-run-checkpoint";
}

impl SavedRun {
    /// Reads the checkpoint in the folder of the results.
    ///
    /// # Errors
    /// There is no checkpoint, or it cannot be read.
    pub fn read(folder: &Path) -> Result<Self, SessionError> {
        let path = folder.join(NAME);
        if !path.exists() {
            return Err(SessionError::Nothing {
                action: "resume",
                hint: "the folder has no checkpoint.json; run the scene with --checkpoint first",
            });
        }
        let text = read_text(&path)?;
        read_checkpoint(&text).map_err(|error| SessionError::Format { path, error })
    }

    /// Reads the newest checkpoint beside the frames that is not later than a frame.
    ///
    /// # Errors
    /// There is no such checkpoint, or it cannot be read.
    pub fn before(place: &Place, frame: usize) -> Result<Self, SessionError> {
        for path in place.kept() {
            let text = read_text(&path)?;
            let saved: Self =
                read_checkpoint(&text).map_err(|error| SessionError::Format { path, error })?;
            if saved.frames.frames() <= frame {
                return Ok(saved);
            }
        }
        Err(SessionError::Nothing {
            action: "restart from",
            hint: "no checkpoint beside the frames is before that frame: run the scene anew",
        })
    }

    /// Writes the checkpoint into a folder, which is made if need be.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &Path, name: &str) -> Result<(), SessionError> {
        let text =
            write_checkpoint(self).map_err(|error| SessionError::Write { file: NAME, error })?;
        let file = (name.to_owned(), text.into_bytes());
        Ok(write_all_atomically(folder, &[file])?)
    }
}

/// Times at which a run saves checkpoints.
pub(crate) struct CheckpointTimes {
    /// Simulated time between two checkpoints (s). `None`: no checkpoints are saved.
    step: Option<f64>,
    /// Simulated time of the next checkpoint (s).
    next: f64,
}

impl CheckpointTimes {
    /// Checkpoints at intervals of simulated time (s), counted from the present time of the run.
    ///
    /// # Errors
    /// A step that is not a positive time; a method of which no checkpoint can be taken.
    pub fn new(options: &RunOptions, run: &SceneRun) -> Result<Self, SessionError> {
        if let Some(step) = options.checkpoint_step {
            if !(step.is_finite() && step > 0.0) {
                return Err(SessionError::Number {
                    what: "the time between checkpoints",
                    value: step,
                    hint: "give a number of simulated seconds above zero",
                });
            }
            run.checkpoint()?;
        }
        Ok(Self {
            step: options.checkpoint_step,
            next: run.state.time + options.checkpoint_step.unwrap_or_default(),
        })
    }

    /// The checkpoint to be saved now, if one is due and the run can be saved.
    ///
    /// # Errors
    /// The run cannot be saved at all.
    pub fn due(&mut self, run: &SceneRun) -> Result<Option<SceneCheckpoint>, DrapeError> {
        let Some(step) = self.step else {
            return Ok(None);
        };
        if run.state.time + 1e-9 < self.next || run.steps_to_checkpoint() > 0 || run.finished() {
            return Ok(None);
        }
        while self.next <= run.state.time + 1e-9 {
            self.next += step;
        }
        run.checkpoint().map(Some)
    }
}
