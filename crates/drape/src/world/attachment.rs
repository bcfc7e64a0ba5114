//! Attachments between objects: springs between vertices of cloth, points in space and points of solids, which may
//! move.

use super::MeshVertex;
use super::World;
use super::object::{Kind, ObjectId};
use super::vertex_map::VertexMap;
use crate::control::FrameAttachment;
use crate::laws::elastic::ElasticLaw;
use crate::tie::{Tie, TieEnd, TrianglePoint};
use crate::{DrapeError, Elastic, ElasticEnd};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// The number of an attachment: in order of creation, never given twice in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct AttachmentId(pub(super) u32);

/// One end of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum AttachmentEnd {
    /// A vertex of an object. Of a solid it moves with the solid.
    Vertex(MeshVertex),
    /// A point in space (m).
    Point(Vec3),
    /// A point that moves with a solid, in the coordinates of the object's mesh (m).
    Frame {
        /// The object.
        object: ObjectId,
        /// The point.
        point: Vec3,
    },
    /// A point within a triangle of an object's mesh. It goes along with the triangle: of cloth, of a solid that moves,
    /// of a surface that bends.
    Surface {
        /// The object.
        object: ObjectId,
        /// The triangle.
        triangle: u32,
        /// The weights of its corners, of sum 1.
        weights: [f64; 3],
    },
    /// A point that moves with a frame of an animated object's track, such as a bone, in the coordinates of the frame (m).
    TrackFrame {
        /// The object.
        object: ObjectId,
        /// The frame.
        frame: u16,
        /// The point.
        point: Vec3,
    },
}

/// A spring of rest length zero between two ends, at least one of them on a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectAttachment {
    /// The ends.
    pub ends: [AttachmentEnd; 2],
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Distance below which the two vertices are merged (m); none where they never are.
    pub merge_within: Option<f64>,
}

/// An end in terms of the merged cloth.
pub(super) enum ResolvedEnd {
    Vertex(u32),
    Point(Vec3),
    Moving(ObjectId, Vec3),
    /// A point within a triangle of cloth, of a surface that bends, or in a frame of a track.
    Tied(TieEnd),
}

/// The attachments of a world in terms of the merged cloth.
#[derive(Default)]
pub(super) struct ResolvedAttachments {
    /// Attachments between vertices, and of vertices to points at rest.
    pub elastics: Vec<Elastic>,
    /// Attachments of vertices to moving objects.
    pub frames: Vec<FrameAttachment>,
    /// Attachments with an end within a triangle or on a surface that bends.
    pub ties: Vec<Tie>,
}

impl World {
    pub(super) fn resolve_end(&self, map: &VertexMap, end: AttachmentEnd) -> Option<ResolvedEnd> {
        let (object, point) = match end {
            AttachmentEnd::Point(point) => return Some(ResolvedEnd::Point(point)),
            AttachmentEnd::Vertex(vertex) => match map.vertex(vertex) {
                Some(v) => return Some(ResolvedEnd::Vertex(v)),
                None => {
                    let point = TrianglePoint::vertex(vertex.vertex);
                    if let Some(solid) = self.bending_solid(vertex.object) {
                        return Some(ResolvedEnd::Tied(TieEnd::Surface { solid, point }));
                    }
                    let mesh = &self.object(vertex.object)?.mesh;
                    (vertex.object, *mesh.positions.get(vertex.vertex as usize)?)
                }
            },
            AttachmentEnd::Frame { object, point } => (object, point),
            AttachmentEnd::TrackFrame {
                object,
                frame,
                point,
            } => {
                let solid = self.bending_solid(object)?;
                return Some(ResolvedEnd::Tied(TieEnd::TrackFrame {
                    solid,
                    frame,
                    point,
                }));
            }
            AttachmentEnd::Surface {
                object,
                triangle,
                weights,
            } => {
                let mesh = &self.object(object)?.mesh;
                let vertices = *mesh.triangles.get(triangle as usize)?;
                let point = TrianglePoint { vertices, weights };
                if let Some(solid) = self.bending_solid(object) {
                    return Some(ResolvedEnd::Tied(TieEnd::Surface { solid, point }));
                }
                let [a, b, c] = vertices.map(|vertex| map.vertex(MeshVertex { object, vertex }));
                if let (Some(a), Some(b), Some(c)) = (a, b, c) {
                    let vertices = [a, b, c];
                    let point = TrianglePoint { vertices, weights };
                    return Some(ResolvedEnd::Tied(TieEnd::Cloth(point)));
                }
                (object, point.of(&mesh.positions))
            }
        };
        Some(match self.object(object)?.kind {
            Kind::Animated => ResolvedEnd::Moving(object, point),
            _ => ResolvedEnd::Point(point),
        })
    }

    /// The number of a solid whose vertices move one by one, among the colliders.
    fn bending_solid(&self, id: ObjectId) -> Option<u32> {
        self.object(id).filter(|object| object.bends())?;
        let mut solids = (self.objects()).filter(|(_, object)| object.kind != Kind::Deformable);
        let at = solids.position(|(other, _)| other == id)?;
        Some(at as u32)
    }

    /// A tie between two ends, one of which is within a triangle of cloth or not of a single point of cloth; none where
    /// no force can move either end.
    fn tie(&self, from: ResolvedEnd, to: ResolvedEnd, law: ElasticLaw) -> Option<Tie> {
        let end = |end: ResolvedEnd| {
            Some(match end {
                ResolvedEnd::Vertex(v) => TieEnd::Cloth(TrianglePoint::vertex(v)),
                ResolvedEnd::Point(place) => TieEnd::Place(place),
                ResolvedEnd::Moving(object, point) => {
                    let motion = self.object(object)?.motion.clone()?;
                    TieEnd::Frame { point, motion }
                }
                ResolvedEnd::Tied(end) => end,
            })
        };
        match (end(from)?, end(to)?) {
            (TieEnd::Cloth(from), to) | (to, TieEnd::Cloth(from)) => Some(Tie { from, to, law }),
            _ => None,
        }
    }

    /// The attachments in terms of the merged cloth, without those between a merged vertex and itself and those that
    /// move no cloth.
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
                (ResolvedEnd::Vertex(from), ResolvedEnd::Point(point))
                | (ResolvedEnd::Point(point), ResolvedEnd::Vertex(from)) => {
                    let to = ElasticEnd::Point(point);
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
                (from @ ResolvedEnd::Tied(_), to) | (from, to @ ResolvedEnd::Tied(_)) => {
                    resolved.ties.extend(self.tie(from, to, law));
                }
                // No force can move either end.
                _ => {}
            }
        }
        resolved
    }

    /// The two mesh vertices of an attachment between cloths; none where an end is not of cloth.
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

    /// Refuses an attachment with a stiffness or a point that is no finite number, or with a missing object or vertex.
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
                AttachmentEnd::Point(point) if !point.iter().all(|x| x.is_finite()) => {
                    return refuse(
                        "a place is not finite".to_owned(),
                        "give finite numbers in m",
                    );
                }
                AttachmentEnd::Point(_) => {}
                AttachmentEnd::Vertex(vertex) => {
                    self.check_vertex(vertex)?;
                }
                AttachmentEnd::Surface {
                    object,
                    triangle,
                    weights,
                } => self.existing(object)?.check_place(triangle, weights)?,
                AttachmentEnd::TrackFrame {
                    object,
                    frame,
                    point,
                } => self.existing(object)?.check_track_frame(frame, point)?,
                AttachmentEnd::Frame { object, point } => {
                    let solid = self.existing(object)?;
                    if solid.kind == Kind::Deformable {
                        let remedy = "name one of its vertices";
                        return Err(solid.refuse("cloth has no frame to be attached to", remedy));
                    }
                    solid.check_frame()?;
                    if !point.iter().all(|x| x.is_finite()) {
                        return Err(solid.refuse("the point is not finite", "give numbers in m"));
                    }
                }
            }
        }
        Ok(())
    }
}
