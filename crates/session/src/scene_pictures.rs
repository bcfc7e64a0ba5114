//! Pictures of a scene's run: states at chosen times, all seen by one camera that takes in whatever has moved.

use crate::SessionError;
use crate::output::File;
use crate::pictures::{SKIN, darker, seam_lines};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;
use toile_drape::{Kind, Object, ObjectId, SceneRun, Verdict, World};
use toile_geometry::{Duration, TriangleMesh, Vec3};
use toile_picture::{Finish, Rgb, Scene as Picture, Sheet, Surface, drape_picture};

/// The state of a run that a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureTime {
    /// Before the first step.
    First,
    /// After the last.
    Last,
    /// After the first step that reaches a simulated time [s].
    At(f64),
    /// Every frame that is saved.
    Frames,
}

impl FromStr for PictureTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "first" => Ok(Self::First),
            "last" => Ok(Self::Last),
            "frames" => Ok(Self::Frames),
            _ => {
                let time: Result<Duration, _> = text.parse();
                let time = time.map(|time| Self::At(time.as_seconds()));
                time.map_err(|_| {
                    format!("{text:?} is no time; write first, last, frames, or a time as in 0.5s")
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
            Self::Frames => write!(f, "frames"),
        }
    }
}

/// The pictures asked of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureOptions {
    /// The states shown; none for no pictures.
    pub times: Vec<PictureTime>,
    /// The object that the camera follows; none for all that moves.
    pub of: Option<String>,
}

/// Where an object has been.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Visited {
    /// Smallest and largest coordinates [m].
    bounds: [Vec3; 2],
    /// Largest size along each axis at one time [m].
    size: Vec3,
}

impl Visited {
    fn new([low, high]: [Vec3; 2]) -> Self {
        Self {
            bounds: [low, high],
            size: high - low,
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            bounds: united(self.bounds, other.bounds),
            size: self.size.sup(&other.size),
        }
    }
}

/// Where each object has been.
pub(crate) type Ways = BTreeMap<ObjectId, Visited>;

/// A state to be shown.
struct Shown {
    /// Name of the picture's file.
    file: String,
    /// Simulated time [s].
    time: f64,
    /// Vertices of each object [m].
    positions: BTreeMap<ObjectId, Vec<Vec3>>,
}

/// The pictures of a run in the making.
pub(crate) struct SceneAlbum {
    /// The states to come, but frames.
    times: Vec<PictureTime>,
    /// Whether frames are shown.
    has_frames: bool,
    /// The object followed.
    followed: Option<ObjectId>,
    ways: Ways,
    shown: Vec<Shown>,
}

/// How many times the size of what moves a solid at rest may have to be taken in by the camera: a body is, ground is
/// not.
const LARGEST_STILL: f64 = 2.0;

/// Soft colours of cloths in the order of the objects.
const CLOTH: [Rgb; 6] = [
    [0.42, 0.55, 0.68],
    [0.76, 0.52, 0.42],
    [0.50, 0.62, 0.46],
    [0.72, 0.62, 0.38],
    [0.58, 0.48, 0.64],
    [0.40, 0.60, 0.60],
];

impl SceneAlbum {
    /// The pictures of a run at its start.
    ///
    /// # Errors
    /// A time outside the run, frames of a scene that saves none, an object that is not there.
    pub fn new(
        options: &PictureOptions,
        run: &SceneRun,
        has_frame_step: bool,
    ) -> Result<Self, SessionError> {
        let times = &options.times;
        for time in times {
            check_time(*time, run)?;
        }
        let has_frames = times.contains(&PictureTime::Frames);
        if has_frames && !has_frame_step {
            let what = "pictures of frames are asked for, but the scene saves none; give its frame_step a time";
            return Err(SessionError::Conflict(what.to_owned()));
        }
        let mut followed = None;
        if let Some(name) = &options.of {
            let found = run.world().objects().find(|(_, o)| o.name == *name);
            followed = Some(found.map(|(id, _)| id).ok_or_else(|| {
                let names = run.world().objects().map(|(_, o)| format!("{:?}", o.name));
                SessionError::Unknown {
                    kind: "object",
                    name: name.clone(),
                    hint: format!("choose from {}", names.collect::<Vec<_>>().join(", ")),
                }
            })?);
        }
        let mut album = Self {
            times: times.clone(),
            has_frames,
            followed,
            ways: Ways::new(),
            shown: Vec::new(),
        };
        album.follow(run);
        Ok(album)
    }

    /// Whether nothing is shown.
    fn is_idle(&self) -> bool {
        self.times.is_empty()
    }

    /// Where objects have been, for a checkpoint.
    pub fn ways(&self) -> &Ways {
        &self.ways
    }

    /// Goes on with a run that is resumed, and with the ways up to there.
    ///
    /// # Errors
    /// A picture of a time that has passed.
    pub fn resume(&mut self, run: &SceneRun, ways: Ways) -> Result<(), SessionError> {
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
        for (id, way) in ways {
            let own = self.ways.entry(id).or_insert(way);
            *own = own.and(way);
        }
        Ok(())
    }

    /// Follows the objects, and keeps the state if it is time: after each step.
    pub fn follow(&mut self, run: &SceneRun) {
        if self.is_idle() {
            return;
        }
        for (id, mesh) in meshes(run) {
            if let Some(bounds) = mesh.bounds() {
                let now = Visited::new(bounds);
                let way = self.ways.entry(id).or_insert(now);
                *way = way.and(now);
            }
        }
        let now = run.state.time;
        let is_due = |time: &PictureTime| match time {
            PictureTime::First => run.steps() == 0,
            PictureTime::At(time) => now + 1e-9 >= *time,
            PictureTime::Last | PictureTime::Frames => false,
        };
        let (due, later) = self.times.iter().partition(|time| is_due(time));
        self.times = later;
        let due: Vec<PictureTime> = due;
        for time in due {
            self.keep(run, format!("picture-{time}.png"));
        }
    }

    /// Keeps a frame, if frames are shown.
    pub fn frame(&mut self, run: &SceneRun, number: usize) {
        if self.has_frames {
            self.keep(run, format!("picture-{number:05}.png"));
        }
    }

    fn keep(&mut self, run: &SceneRun, file: String) {
        self.shown.push(Shown {
            file,
            time: run.state.time,
            positions: meshes(run).map(|(id, mesh)| (id, mesh.positions)).collect(),
        });
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
            self.keep(run, format!("picture-{}.png", PictureTime::Last));
        }
        let mut files = Vec::with_capacity(self.shown.len());
        for shown in &self.shown {
            let sheet = Sheet {
                warning: verdict.headline(),
                room: self.room(shown, run.world()),
                ..Sheet::studio(format!("{name} at {:.3} s", shown.time))
            };
            let picture = drape_picture(&scene(run, shown), &sheet)?;
            files.push((shown.file.clone(), picture.to_png()?));
        }
        Ok(files)
    }

    /// The box that a picture shows [m]: all that moves with the solids at rest beside it, or the object followed.
    fn room(&self, shown: &Shown, world: &World) -> Option<[Vec3; 2]> {
        if let Some(id) = self.followed {
            let mesh = TriangleMesh {
                positions: shown.positions.get(&id)?.clone(),
                triangles: Vec::new(),
            };
            let [low, high] = mesh.bounds()?;
            let (middle, half) = (0.5 * (low + high), 0.5 * self.ways.get(&id)?.size);
            return Some([middle - half, middle + half]);
        }
        let of_kind = |is_still: bool| {
            let way = move |(id, object): (ObjectId, &Object)| {
                let is_wanted = (object.kind == Kind::Static) == is_still;
                self.ways.get(&id).filter(|_| is_wanted).map(|w| w.bounds)
            };
            world.objects().filter_map(way)
        };
        let moving = of_kind(false).reduce(united)?;
        let size = |[low, high]: [Vec3; 2]| (high - low).norm();
        let near = of_kind(true).filter(|&still| size(still) <= LARGEST_STILL * size(moving));
        Some(near.fold(moving, united))
    }
}

/// The smallest box round two.
fn united(a: [Vec3; 2], b: [Vec3; 2]) -> [Vec3; 2] {
    [a[0].inf(&b[0]), a[1].sup(&b[1])]
}

/// Refuses a time that the run does not come to.
fn check_time(time: PictureTime, run: &SceneRun) -> Result<(), SessionError> {
    let what = "the time of a picture [s]";
    let PictureTime::At(value) = time else {
        if time == PictureTime::First && run.steps() > 0 {
            let what =
                "the first state is asked for of a run that goes on from later; give later times";
            return Err(SessionError::Conflict(what.to_owned()));
        }
        return Ok(());
    };
    let refuse = |hint| Err(SessionError::Number { what, value, hint });
    if run.settings().method.kind.is_equilibrium() {
        return refuse("a run to rest has no times: write first, last or frames");
    }
    match value >= 0.0 && value <= run.settings().duration + 1e-9 {
        true => Ok(()),
        false => refuse("give a time from 0 to the scene's duration"),
    }
}

/// The present surfaces of the objects.
fn meshes(run: &SceneRun) -> impl Iterator<Item = (ObjectId, TriangleMesh)> + '_ {
    let ids = run.world().objects().map(|(id, _)| id);
    ids.filter_map(|id| Some((id, run.mesh_of(id)?)))
}

/// A state as the painter takes it: solids in the colour of skin, each cloth in its own.
fn scene(run: &SceneRun, shown: &Shown) -> Picture {
    let mut cloths = 0;
    let mut surfaces = Vec::new();
    for (id, mut mesh) in meshes(run) {
        let Some(positions) = shown.positions.get(&id) else {
            continue;
        };
        mesh.positions.clone_from(positions);
        let cloth = run.world().object(id).and_then(Object::deformable_cloth);
        let Some(cloth) = cloth else {
            surfaces.push(Surface::plain(mesh, SKIN, Finish::Smooth));
            continue;
        };
        let colour = CLOTH[cloths % CLOTH.len()];
        cloths += 1;
        surfaces.push(Surface {
            lines: seam_lines(panel_borders(&mesh, &cloth.panel), darker(colour)),
            ..Surface::plain(mesh, colour, Finish::Cloth)
        });
    }
    Picture { surfaces }
}

/// Pairs of vertices between triangles of two panels. A mesh that is its own rest shape has a panel a triangle, and no
/// borders.
fn panel_borders(mesh: &TriangleMesh, panels: &[u32]) -> Vec<[u32; 2]> {
    let count = panels.iter().collect::<BTreeSet<_>>().len();
    if count == panels.len() {
        return Vec::new();
    }
    let topology = mesh.topology();
    let edges = topology.edges.iter().zip(&topology.edge_triangles);
    let is_border = |sides: &[u32]| {
        let mut of = sides.iter().map(|&t| panels.get(t as usize));
        let first = of.next();
        of.any(|other| Some(other) != first)
    };
    let borders = edges.filter(|(_, sides)| is_border(sides));
    borders.map(|(&edge, _)| edge).collect()
}
