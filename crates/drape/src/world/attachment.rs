//! Attachments between objects: springs whose ends may be vertices of cloth, places in space or points of
//! solids, which may move.

use super::MeshVertex;
use super::World;
use super::object::{Kind, ObjectId};
use super::vertex_map::VertexMap;
use crate::control::FrameAttachment;
use crate::laws::elastic::ElasticLaw;
use crate::{DrapeError, Elastic, ElasticEnd};
use toile_geometry::Vec3;

/// The number of an attachment: in order of creation, never given twice in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AttachmentId(pub(super) u32);

/// One end of an attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttachmentEnd {
    /// A vertex of an object: of a cloth, or of a solid, with which it moves.
    Vertex(MeshVertex),
    /// A place in space [m].
    Point(Vec3),
    /// A point in the frame of a solid object, which moves with it: where it would be were the object as it was
    /// added [m].
    Frame {
        /// The object.
        object: ObjectId,
        /// The point.
        point: Vec3,
    },
}

/// A spring of rest length zero between two ends, at least one of them on a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectAttachment {
    /// The ends.
    pub ends: [AttachmentEnd; 2],
    /// Stiffness [N/m].
    pub stiffness: f64,
    /// The two vertices become one when closer than this [m]; nothing keeps them apart.
    pub merge_within: Option<f64>,
}

/// An end as the system takes it.
enum ResolvedEnd {
    Vertex(u32),
    Point(Vec3),
    Moving(ObjectId, Vec3),
}

/// Attachments as the system takes them.
#[derive(Default)]
pub(super) struct ResolvedAttachments {
    /// Those between vertices and to places at rest.
    pub elastics: Vec<Elastic>,
    /// Those to moving objects.
    pub frames: Vec<FrameAttachment>,
}

impl World {
    fn resolve_end(&self, map: &VertexMap, end: AttachmentEnd) -> Option<ResolvedEnd> {
        let (object, point) = match end {
            AttachmentEnd::Point(place) => return Some(ResolvedEnd::Point(place)),
            AttachmentEnd::Vertex(vertex) => match map.vertex(vertex) {
                Some(v) => return Some(ResolvedEnd::Vertex(v)),
                None => {
                    let mesh = &self.object(vertex.object)?.mesh;
                    (vertex.object, *mesh.positions.get(vertex.vertex as usize)?)
                }
            },
            AttachmentEnd::Frame { object, point } => (object, point),
        };
        Some(match self.object(object)?.kind {
            Kind::Animated => ResolvedEnd::Moving(object, point),
            _ => ResolvedEnd::Point(point),
        })
    }

    /// Its attachments between the vertices of a merged cloth; those whose ends are one are left out.
    pub(super) fn resolve_attachments(&self, map: &VertexMap) -> ResolvedAttachments {
        let mut resolved = ResolvedAttachments::default();
        for attachment in self.attachments.values() {
            let law = ElasticLaw {
                stiffness: attachment.stiffness,
                largest_force: f64::INFINITY,
            };
            let [from, to] = attachment.ends.map(|end| self.resolve_end(map, end));
            let (Some(from), Some(to)) = (from, to) else {
                continue;
            };
            match (from, to) {
                (ResolvedEnd::Vertex(a), ResolvedEnd::Vertex(b)) if a == b => {}
                (ResolvedEnd::Vertex(from), ResolvedEnd::Vertex(to)) => {
                    let to = ElasticEnd::Vertex(to);
                    resolved.elastics.push(Elastic { from, to, law });
                }
                (ResolvedEnd::Vertex(from), ResolvedEnd::Point(place))
                | (ResolvedEnd::Point(place), ResolvedEnd::Vertex(from)) => {
                    let to = ElasticEnd::Point(place);
                    resolved.elastics.push(Elastic { from, to, law });
                }
                (ResolvedEnd::Vertex(vertex), ResolvedEnd::Moving(object, point))
                | (ResolvedEnd::Moving(object, point), ResolvedEnd::Vertex(vertex)) => {
                    let motion = self.object(object).and_then(|o| o.motion.clone());
                    resolved.frames.extend(motion.map(|motion| FrameAttachment {
                        vertex,
                        point,
                        motion,
                        law,
                    }));
                }
                // Two ends that no force can move.
                _ => {}
            }
        }
        resolved
    }

    /// The mesh vertices that an attachment joins, where both its ends are of cloth.
    pub(super) fn cloth_ends(&self, attachment: &ObjectAttachment) -> Option<[MeshVertex; 2]> {
        let [AttachmentEnd::Vertex(a), AttachmentEnd::Vertex(b)] = attachment.ends else {
            return None;
        };
        let is_cloth = |vertex: MeshVertex| {
            let object = self.object(vertex.object);
            object.is_some_and(|object| object.kind == Kind::Deformable)
        };
        (is_cloth(a) && is_cloth(b)).then_some([a, b])
    }

    /// Refuses an attachment that names what is not there.
    pub(super) fn check_attachment(&self, attachment: &ObjectAttachment) -> Result<(), DrapeError> {
        let refuse = |what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place: "attachment".to_owned(),
                what,
                remedy: remedy.to_owned(),
            })
        };
        if !(attachment.stiffness.is_finite() && attachment.stiffness >= 0.0) {
            let what = format!("stiffness {} is out of range", attachment.stiffness);
            return refuse(what, "give a finite number in N/m, zero or above");
        }
        for end in attachment.ends {
            match end {
                AttachmentEnd::Point(place) if !place.iter().all(|x| x.is_finite()) => {
                    return refuse(
                        "a place is not finite".to_owned(),
                        "give finite numbers in m",
                    );
                }
                AttachmentEnd::Point(_) => {}
                AttachmentEnd::Vertex(vertex) => self.check_vertex(vertex)?,
                AttachmentEnd::Frame { object, point } => {
                    let solid = self.existing(object)?;
                    if solid.kind == Kind::Deformable {
                        let remedy = "name one of its vertices";
                        return Err(solid.refuse("cloth has no frame to be attached to", remedy));
                    }
                    if !point.iter().all(|x| x.is_finite()) {
                        return Err(solid.refuse("the point is not finite", "give numbers in m"));
                    }
                }
            }
        }
        Ok(())
    }
}
