//! Where the ends of ties are in a system.

use crate::tie::{Tie, TieEnd};
use crate::{State, System};
use toile_geometry::Vec3;

impl System {
    /// Whether all that a tie names is there: vertices of cloth, solids, vertices and frames of solids.
    pub(crate) fn has_ends_of(&self, tie: &Tie) -> bool {
        let count = self.vertex_count() as u32;
        let solid = |solid: u32| self.colliders.get(solid as usize);
        let to = match &tie.to {
            TieEnd::Surface { solid: s, point } => solid(*s).is_some_and(|solid| {
                let count = solid.surface.mesh().positions.len();
                point.vertices.iter().all(|&v| (v as usize) < count)
            }),
            TieEnd::TrackFrame {
                solid: s, frame, ..
            } => solid(*s).is_some_and(|solid| solid.frames(0.0).len() > usize::from(*frame)),
            TieEnd::Place(_) | TieEnd::Frame { .. } | TieEnd::Cloth(_) => true,
        };
        to && tie.vertices().all(|v| v < count)
    }

    /// Where an end of a tie is in a state (m).
    pub fn place_of(&self, end: &TieEnd, state: &State) -> Vec3 {
        let time = state.time;
        match end {
            TieEnd::Place(place) => *place,
            TieEnd::Frame { point, motion } => motion.pose(time).apply(*point),
            TieEnd::Surface { solid, point } => {
                point.of(&self.colliders[*solid as usize].positions(time))
            }
            TieEnd::TrackFrame {
                solid,
                frame,
                point,
            } => {
                let poses = self.colliders[*solid as usize].frames(time);
                (poses.get(usize::from(*frame))).map_or(*point, |pose| pose.apply(*point))
            }
            TieEnd::Cloth(point) => point.of(&state.positions),
        }
    }
}
