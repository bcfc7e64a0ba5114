//! Surfaces whose vertices move by a rule of time: the skin of a figure, recorded frames.

use crate::{Motion, Pose};
use std::fmt;
use std::sync::Arc;
use toile_geometry::Vec3;

/// Places of the vertices of a surface over time.
pub trait Track: Send + Sync {
    /// Places of the vertices at a time (s), as many at every time (m).
    fn positions(&self, time: f64) -> Vec<Vec3>;

    /// Poses of the frames that move with the surface at a time (s), as many at every time: the bones of a figure. At
    /// first none.
    fn frames(&self, _time: f64) -> Vec<Pose> {
        Vec::new()
    }

    /// A digest of all that the places depend on: two tracks of one digest are the same.
    fn digest(&self) -> u64;
}

/// A track that several scenes, worlds and runs have.
#[derive(Clone)]
pub struct SharedTrack(Arc<dyn Track>);

impl SharedTrack {
    /// Shares a track.
    pub fn new(track: impl Track + 'static) -> Self {
        Self(Arc::new(track))
    }

    /// [`Track::positions`].
    pub fn positions(&self, time: f64) -> Vec<Vec3> {
        self.0.positions(time)
    }

    /// [`Track::frames`].
    pub fn frames(&self, time: f64) -> Vec<Pose> {
        self.0.frames(time)
    }

    /// [`Track::digest`].
    pub fn digest(&self) -> u64 {
        self.0.digest()
    }
}

/// Places of the vertices of an animated surface at a time (s): those of its track, or as it was loaded, moved as a
/// whole (m).
pub(crate) fn animated_positions(
    loaded: &[Vec3],
    track: Option<&SharedTrack>,
    motion: Option<&Motion>,
    time: f64,
) -> Vec<Vec3> {
    let mut positions = track.map_or_else(|| loaded.to_vec(), |track| track.positions(time));
    if let Some(motion) = motion {
        let pose = motion.pose(time);
        positions.iter_mut().for_each(|p| *p = pose.apply(*p));
    }
    positions
}

impl PartialEq for SharedTrack {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.digest() == other.0.digest()
    }
}

impl fmt::Debug for SharedTrack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SharedTrack")
    }
}
