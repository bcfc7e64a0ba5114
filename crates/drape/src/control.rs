//! The control of a simulation: loads and attachments, which may change with each step without a new structure.

use crate::Motion;
use crate::laws::air::Air;
use crate::laws::elastic::ElasticLaw;
use crate::tie::Tie;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_geometry::Vec3;

/// A spring from a vertex to a point in space: a hand, or an elastic with one end fixed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// The vertex.
    pub vertex: u32,
    /// The point it is pulled to (m).
    pub place: Vec3,
    /// Its force law.
    pub law: ElasticLaw,
}

/// A spring from a vertex to a point of a moving solid. Only XPBD supports it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameAttachment {
    /// The vertex.
    pub vertex: u32,
    /// The point in the frame of the solid (m).
    pub point: Vec3,
    /// The motion of the solid.
    pub motion: Arc<Motion>,
    /// Its force law.
    pub law: ElasticLaw,
}

impl FrameAttachment {
    /// The point that the vertex is pulled to at a time (s), in metres.
    pub fn target(&self, time: f64) -> Vec3 {
        self.motion.pose(time).apply(self.point)
    }
}

/// Attachments in the order of their vertices. Copies share the list.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<Attachment>", into = "Vec<Attachment>")]
pub struct Attachments(Arc<[Attachment]>);

impl Attachments {
    /// The attachments at a vertex, with the index of the first.
    pub(crate) fn at(&self, vertex: usize) -> (usize, &[Attachment]) {
        if self.0.is_empty() {
            return (0, &[]);
        }
        let first = (self.0).partition_point(|attachment| (attachment.vertex as usize) < vertex);
        let rest = &self.0[first..];
        let count = rest.partition_point(|attachment| attachment.vertex as usize == vertex);
        (first, &rest[..count])
    }

    /// Whether two lists share their memory, not only equal contents.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// All attachments.
    pub fn all(&self) -> &[Attachment] {
        &self.0
    }
}

impl From<Vec<Attachment>> for Attachments {
    fn from(all: Vec<Attachment>) -> Self {
        all.into_iter().collect()
    }
}

impl From<Attachments> for Vec<Attachment> {
    fn from(attachments: Attachments) -> Self {
        attachments.0.to_vec()
    }
}

impl FromIterator<Attachment> for Attachments {
    fn from_iter<I: IntoIterator<Item = Attachment>>(all: I) -> Self {
        let mut all: Vec<Attachment> = all.into_iter().collect();
        all.sort_by_key(|attachment| attachment.vertex);
        Self(all.into())
    }
}

/// Loads and attachments of the present step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3,
    /// Drag per mass, of the air and of Rayleigh damping together (1/s): a free velocity falls by
    /// exp(-drag t).
    pub air_drag: f64,
    /// Drag of the air on triangles; its own `drag` is part of [`Control::air_drag`].
    pub air: Air,
    /// Springs to points in space.
    pub attachments: Attachments,
    /// Springs to points of moving solids.
    #[serde(default)]
    pub frames: Vec<FrameAttachment>,
    /// Springs from points within triangles, and to points of surfaces that bend. Only XPBD supports them.
    #[serde(default)]
    pub ties: Vec<Tie>,
}

impl Default for Control {
    /// Gravity on earth, no drag, no attachments.
    fn default() -> Self {
        Self {
            gravity: Vec3::new(0.0, -9.81, 0.0),
            air_drag: 0.0,
            air: Air::default(),
            attachments: Attachments::default(),
            frames: Vec::new(),
            ties: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attachments_are_found_by_their_vertex_in_the_order_given() {
        let law = ElasticLaw {
            stiffness: 1.0,
            largest_force: 1.0,
        };
        let one = |vertex, x| Attachment {
            vertex,
            place: Vec3::new(x, 0.0, 0.0),
            law,
        };
        let some: Attachments = [one(7, 1.0), one(2, 2.0), one(7, 3.0)]
            .into_iter()
            .collect();
        assert_eq!(some.at(7), (1, &[one(7, 1.0), one(7, 3.0)][..]));
        assert_eq!(some.at(2), (0, &[one(2, 2.0)][..]));
        assert!(some.at(3).1.is_empty() && Attachments::default().at(0).1.is_empty());
    }
}
