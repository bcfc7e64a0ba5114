//! Pictures of a scene's run at chosen times.

use crate::SessionError;
use crate::output::File;
use crate::state_picture::{RunCamera, ShownSurface, Ways};
use std::fmt;
use std::str::FromStr;
use toile_drape::{Kind, Object, SceneRun, Verdict};
use toile_geometry::Duration;

/// The state of a run that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureTime {
    /// Before the first step.
    First,
    /// After the last step.
    Last,
    /// After the first step that reaches a simulated time (s).
    At(f64),
}

impl FromStr for PictureTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "first" => Ok(Self::First),
            "last" => Ok(Self::Last),
            _ => {
                let time: Result<Duration, _> = text.parse();
                let time = time.map(|time| Self::At(time.as_seconds()));
                time.map_err(|_| {
                    format!("{text:?} is no time; write first, last, or a time as in 0.5s")
                })
            }
        }
    }
}

impl fmt::Display for PictureTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::First => write!(f, "first"),
            Self::Last => write!(f, "last"),
            Self::At(time) => write!(f, "{time}s"),
        }
    }
}

/// The pictures asked of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureOptions {
    /// The states shown; empty for no pictures.
    pub times: Vec<PictureTime>,
    /// The object that the camera follows; `None` for all objects that move.
    pub of: Option<String>,
}

/// A state to be shown.
struct Shown {
    /// Name of the picture's file.
    file: String,
    /// Simulated time (s).
    time: f64,
    surfaces: Vec<ShownSurface>,
}

/// The states of a run that its pictures show, collected while the run goes on.
pub(crate) struct SceneAlbum {
    /// The states that are still to be painted.
    times: Vec<PictureTime>,
    camera: RunCamera,
    shown: Vec<Shown>,
}

impl SceneAlbum {
    /// The pictures of a run at its start.
    ///
    /// # Errors
    /// A time outside the run, an object that is not there.
    pub fn new(options: &PictureOptions, run: &SceneRun) -> Result<Self, SessionError> {
        for time in &options.times {
            check_time(*time, run)?;
        }
        let camera = RunCamera {
            followed: options.of.clone(),
            ..RunCamera::default()
        };
        camera.check(run.world().objects().map(|(_, object)| &*object.name))?;
        let mut album = Self {
            times: options.times.clone(),
            camera,
            shown: Vec::new(),
        };
        album.follow(run);
        Ok(album)
    }

    /// Boxes that the objects have been in, for a checkpoint.
    pub fn ways(&self) -> &Ways {
        &self.camera.ways
    }

    /// Continues with a run that is resumed, and with the boxes that its objects have been in.
    ///
    /// # Errors
    /// A picture of a time that has passed.
    pub fn resume(&mut self, run: &SceneRun, ways: &Ways) -> Result<(), SessionError> {
        for time in &self.times {
            if let PictureTime::At(value) = *time
                && value + 1e-9 < run.state.time
            {
                return Err(SessionError::Number {
                    what: "the time of a picture [s]",
                    value,
                    hint: "the run goes on from later: give a later time",
                });
            }
        }
        self.camera.take_in_ways(ways);
        Ok(())
    }

    /// Follows the objects, and keeps the state if a picture is due. Call it after each step.
    pub fn follow(&mut self, run: &SceneRun) {
        if self.times.is_empty() {
            return;
        }
        let surfaces = shown_surfaces(run);
        self.camera.take_in(&surfaces);
        let now = run.state.time;
        let is_due = |time: &PictureTime| match time {
            PictureTime::First => run.steps() == 0,
            PictureTime::At(time) => now + 1e-9 >= *time,
            PictureTime::Last => false,
        };
        let due: Vec<PictureTime> = self.times.iter().copied().filter(is_due).collect();
        self.times.retain(|time| !is_due(time));
        for time in due {
            self.shown.push(Shown {
                file: format!("picture-{time}.png"),
                time: now,
                surfaces: surfaces.clone(),
            });
        }
    }

    /// The pictures of a run that is over, as PNG.
    ///
    /// # Errors
    /// A picture that cannot be drawn.
    pub fn paint(
        &mut self,
        run: &SceneRun,
        verdict: &Verdict,
        name: &str,
    ) -> Result<Vec<File>, SessionError> {
        if self.times.contains(&PictureTime::Last) {
            self.shown.push(Shown {
                file: format!("picture-{}.png", PictureTime::Last),
                time: run.state.time,
                surfaces: shown_surfaces(run),
            });
        }
        let mut files = Vec::with_capacity(self.shown.len());
        for shown in &self.shown {
            let title = format!("{name} at {:.3} s", shown.time);
            let picture = (self.camera).picture(&shown.surfaces, [title, verdict.headline()])?;
            files.push((shown.file.clone(), picture));
        }
        Ok(files)
    }
}

/// Refuses a time outside the run.
fn check_time(time: PictureTime, run: &SceneRun) -> Result<(), SessionError> {
    let what = "the time of a picture [s]";
    let PictureTime::At(value) = time else {
        return Ok(());
    };
    let refuse = |hint| Err(SessionError::Number { what, value, hint });
    if run.settings().method.kind.is_equilibrium() {
        return refuse("a run to rest has no times: write first or last");
    }
    match value >= 0.0 && value <= run.settings().duration + 1e-9 {
        true => Ok(()),
        false => refuse("give a time from 0 to the scene's duration"),
    }
}

/// The present surfaces of the objects.
fn shown_surfaces(run: &SceneRun) -> Vec<ShownSurface> {
    let shown = run.world().objects().filter_map(|(id, object)| {
        Some(ShownSurface {
            name: object.name.clone(),
            mesh: run.mesh_of(id)?,
            panels: Object::deformable_cloth(object).map(|cloth| cloth.panel.clone()),
            is_still: object.kind == Kind::Static,
        })
    });
    shown.collect()
}
