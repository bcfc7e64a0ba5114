//! Attachments whose ends have not come together.

use super::Simulation;
use super::attachment::ResolvedEnd;
use crate::tie::{TieEnd, TrianglePoint};

/// An attachment that was to draw its ends together, and has not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenAttachment {
    /// Its place in the order of the world's attachments.
    pub index: usize,
    /// Distance of its ends (m).
    pub gap: f64,
    /// Speed at which the gap closes, negative where it opens (m/s).
    pub closing: f64,
    /// Whether both ends are held where they are: pinned, led or of a solid.
    pub is_held: bool,
}

/// Distance up to which two held ends are at one place (m): rounding.
const SAME_PLACE: f64 = 1e-9;

impl Simulation {
    /// Attachments whose ends are farther apart than they merge within, and those whose two ends are held apart, which
    /// no force can close. A spring that never merges and has an end free is not among them: it is open as far as it
    /// is under tension.
    pub fn open_attachments(&self) -> Vec<OpenAttachment> {
        let (prescribed, _) = self.present().prescribed();
        let zero = toile_geometry::Vec3::zeros();
        let of_cloth = |point: &TrianglePoint| {
            let [x, velocity] = [&self.state.positions, &self.state.velocities];
            let weighed = point.vertices.iter().zip(point.weights);
            let is_held = weighed
                .filter(|(_, weight)| *weight != 0.0)
                .all(|(&v, _)| prescribed[v as usize]);
            (point.of(x), point.of(velocity), is_held)
        };
        let place = |end: &ResolvedEnd| match end {
            ResolvedEnd::Vertex(v) => of_cloth(&TrianglePoint::vertex(*v)),
            ResolvedEnd::Point(point) => (*point, zero, true),
            ResolvedEnd::Moving(object, point) => {
                let motion = self.world().object(*object).and_then(|o| o.motion.as_ref());
                let pose = motion.map(|motion| motion.pose(self.state.time));
                (pose.map_or(*point, |pose| pose.apply(*point)), zero, true)
            }
            ResolvedEnd::Tied(TieEnd::Cloth(point)) => of_cloth(point),
            ResolvedEnd::Tied(end) => (self.system.place_of(end, &self.state), zero, true),
        };
        let open = |(index, attachment): (usize, &super::ObjectAttachment)| {
            let [a, b] = attachment
                .ends
                .map(|end| self.world().resolve_end(self.map(), end));
            let [a, b] = [place(&a?), place(&b?)];
            let (apart, is_held) = (a.0 - b.0, a.2 && b.2);
            let gap = apart.norm();
            let limit = match attachment.merge_within {
                _ if is_held => SAME_PLACE,
                Some(within) => within,
                None => return None,
            };
            (gap > limit).then(|| OpenAttachment {
                index,
                gap,
                closing: -(a.1 - b.1).dot(&apart) / gap,
                is_held,
            })
        };
        let all = self.world().attachments().map(|(_, attachment)| attachment);
        all.enumerate().filter_map(open).collect()
    }
}
