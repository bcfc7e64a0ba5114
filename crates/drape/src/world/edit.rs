//! Edits of a world. Each is checked, changes the world, and returns which level of the system has to be compiled
//! again.
//!
//! # Decided with
//! - [`crate::world::edit::Change`]: structure, shapes or boundary conditions: what is compiled again;
//! - [`crate::world::simulation::Simulation::edit_all`],
//!   [`crate::world::simulation::Simulation::restructure`]: edits done on a copy; another structure;
//! - [`crate::world::transfer::Transfer::state`]: what the state keeps;
//! - [`crate::scene_run::SceneRun::edit`]: features checked, method built anew;
//! - [`crate::world::object::Object::check`], [`crate::world::present::Present::mesh_of`]: checks; the shape
//!   of cloth that becomes solid.
//!
//! By hand: `Remove` must take away all that names the object: merged pairs, attachments, policies.

use super::attachment::{AttachmentEnd, AttachmentId, ObjectAttachment};
use super::object::{Kind, Layers, MeshVertex, Object, ObjectId};
use super::present::Present;
use super::transfer::StartingMotion;
use super::{PairPolicy, VertexMap, World};
use crate::{Carry, Cloth, DrapeError, Environment, Motion};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{Vec2, Vec3};

/// A change of a world between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WorldEdit {
    /// Adds an object.
    Add(Box<Object>),
    /// Removes an object with its attachments and opens its seams with others.
    Remove(ObjectId),
    /// Changes the kind of an object. A cloth that becomes solid keeps its present shape and loses its seams; a solid
    /// that becomes cloth starts at its present position without velocity.
    ChangeKind(ObjectId, Kind),
    /// Sets the motion of an object while it is animated: its position is that of its mesh under the pose of the
    /// motion.
    SetMotion(ObjectId, Motion),
    /// Adds an attachment.
    Attach(ObjectAttachment),
    /// Removes an attachment.
    Detach(AttachmentId),
    /// Merges the two vertices of each pair.
    Merge(Vec<[MeshVertex; 2]>),
    /// Separates merged pairs again. Attachments between them act on, but no longer merge them.
    Open(Vec<[MeshVertex; 2]>),
    /// Pins these vertices of an object and no others.
    Pin(ObjectId, Vec<u32>),
    /// Replaces the rest shapes of a cloth's triangles (m).
    Reshape(ObjectId, Vec<[Vec2; 3]>),
    /// Replaces the mesh of a cloth by another one of the same panels, with its layers. Positions and velocities are
    /// interpolated at the same points of the panels; seams open, pins, grips and attachments are removed.
    ReplaceMesh(ObjectId, Box<Cloth>, Layers),
    /// Sets whether contact acts between two objects, or of a cloth with itself.
    SetPolicy([ObjectId; 2], PairPolicy),
    /// Replaces gravity, air, damping and contact.
    SetEnvironment(Box<Environment>),
}

/// The result of an edit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edited {
    /// The added object.
    pub object: Option<ObjectId>,
    /// The added attachment.
    pub attachment: Option<AttachmentId>,
    /// Whether the structure was compiled again, so that merged vertices and triangles may have other numbers.
    pub is_restructured: bool,
}

/// The level of a system that an edit compiles again.
pub(super) enum Change {
    /// Vertices or triangles, with the starting motion of objects that do not go on from the state.
    Structure(BTreeMap<ObjectId, StartingMotion>),
    /// Rest shapes only.
    Shapes,
    /// Pins, grips, attachments, solids and loads; the cloth keeps its structure.
    BoundaryConditions,
}

impl Change {
    fn of_structure() -> Self {
        Self::Structure(BTreeMap::new())
    }

    /// The level to compile again after two changes.
    pub fn and(self, next: Self) -> Self {
        match (self, next) {
            (Self::Structure(mut first), Self::Structure(second)) => {
                first.extend(second);
                Self::Structure(first)
            }
            (Self::Structure(starting), _) | (_, Self::Structure(starting)) => {
                Self::Structure(starting)
            }
            (Self::Shapes, Self::Shapes) => Self::Shapes,
            (Self::BoundaryConditions, Self::BoundaryConditions) => Self::BoundaryConditions,
            (Self::Shapes, Self::BoundaryConditions) | (Self::BoundaryConditions, Self::Shapes) => {
                Self::of_structure()
            }
        }
    }
}

impl World {
    /// Applies an edit; `before` is the simulated world with its state.
    ///
    /// # Errors
    /// The first property that does not fit. The world may then be partly changed: the caller edits a copy.
    pub(super) fn apply(
        &mut self,
        edit: WorldEdit,
        before: &Present,
    ) -> Result<(Edited, Change), DrapeError> {
        let mut edited = Edited::default();
        let change = match edit {
            WorldEdit::Add(mut object) => {
                if object.kind == Kind::Deformable {
                    object.ensure_cloth()?;
                }
                object.check()?;
                if self.objects().any(|(_, other)| other.name == object.name) {
                    return Err(object.refuse("another object has its name", "give it its own"));
                }
                let is_cloth = object.kind == Kind::Deformable;
                edited.object = Some(self.insert(*object));
                match is_cloth {
                    true => Change::of_structure(),
                    false => Change::BoundaryConditions,
                }
            }
            WorldEdit::Remove(id) => {
                let was = self.existing(id)?.kind;
                self.open_seams_of(id);
                self.attachments
                    .retain(|_, attachment| !attachment.names(id));
                self.ignored.retain(|pair| !pair.contains(&id));
                self.objects.remove(&id);
                match was {
                    Kind::Deformable => Change::of_structure(),
                    _ => Change::BoundaryConditions,
                }
            }
            WorldEdit::ChangeKind(id, kind) => self.change_kind(id, kind, before)?,
            WorldEdit::SetMotion(id, motion) => {
                let object = self.existing_mut(id)?;
                object.motion = Some(Arc::new(motion));
                object.check()?;
                Change::BoundaryConditions
            }
            WorldEdit::Attach(attachment) => {
                self.check_attachment(&attachment)?;
                edited.attachment = Some(self.attach(attachment));
                Change::BoundaryConditions
            }
            WorldEdit::Detach(id) => match self.attachments.remove(&id) {
                Some(_) => Change::BoundaryConditions,
                None => {
                    return Err(DrapeError::Scene {
                        place: format!("attachment {}", id.0),
                        what: "it is not there".to_owned(),
                        remedy: "name an attachment of the world".to_owned(),
                    });
                }
            },
            WorldEdit::Merge(pairs) => {
                self.check_pairs(&pairs)?;
                before.check_joinable(&pairs)?;
                self.merge(pairs);
                Change::of_structure()
            }
            WorldEdit::Open(pairs) => {
                self.check_pairs(&pairs)?;
                self.open(pairs, before.map)?;
                Change::of_structure()
            }
            WorldEdit::Pin(id, pins) => {
                let object = self.existing_mut(id)?;
                object.pins = pins;
                object.check()?;
                Change::BoundaryConditions
            }
            WorldEdit::Reshape(id, rest) => {
                self.reshape(id, rest)?;
                Change::Shapes
            }
            WorldEdit::ReplaceMesh(id, cloth, layers) => {
                self.replace_mesh(id, (*cloth, layers), before)?
            }
            WorldEdit::SetPolicy(pair, policy) => {
                self.set_policy(pair, policy)?;
                Change::BoundaryConditions
            }
            WorldEdit::SetEnvironment(environment) => {
                let before = self.environment().damping.stiffness;
                let is_same = before == environment.damping.stiffness;
                self.set_environment(*environment);
                match is_same {
                    true => Change::BoundaryConditions,
                    // Stiffness damping is compiled into the materials.
                    false => Change::of_structure(),
                }
            }
        };
        Ok((edited, change))
    }

    /// Opens the seams of an object.
    fn open_seams_of(&mut self, id: ObjectId) {
        self.merged
            .retain(|pair| pair.iter().all(|vertex| vertex.object != id));
    }

    fn set_policy(&mut self, [a, b]: [ObjectId; 2], policy: PairPolicy) -> Result<(), DrapeError> {
        for id in [a, b] {
            self.existing(id)?;
        }
        let pair = [a.min(b), a.max(b)];
        match policy {
            PairPolicy::Ignore => self.ignored.insert(pair),
            PairPolicy::Meet => self.ignored.remove(&pair),
        };
        Ok(())
    }

    fn check_pairs(&self, pairs: &[[MeshVertex; 2]]) -> Result<(), DrapeError> {
        for &vertex in pairs.iter().flatten() {
            self.check_vertex(vertex)?;
            let object = self.existing(vertex.object)?;
            if object.kind != Kind::Deformable {
                return Err(object.refuse("it is no cloth", "merge vertices of cloth"));
            }
        }
        Ok(())
    }

    fn open(&mut self, pairs: Vec<[MeshVertex; 2]>, before: &VertexMap) -> Result<(), DrapeError> {
        let said = |pair: [MeshVertex; 2], what: &str| {
            let [a, b] = pair.map(|vertex| vertex.vertex);
            format!("its vertex {a} is {what} vertex {b} there")
        };
        let pairs: Vec<_> = pairs.into_iter().map(MeshVertex::pair).collect();
        for pair in &pairs {
            if !self.merged.remove(pair) {
                let object = self.existing(pair[0].object)?;
                let what = said(*pair, "not merged with");
                return Err(object.refuse(&what, "open pairs as they were merged"));
            }
        }
        let after = VertexMap::new(self);
        let are_one = |map: &VertexMap, [a, b]: [MeshVertex; 2]| map.vertex(a) == map.vertex(b);
        if let Some(&pair) = pairs.iter().find(|&&pair| are_one(&after, pair)) {
            let object = self.existing(pair[0].object)?;
            let what = said(pair, "still one, by way of others, with");
            return Err(object.refuse(&what, "open these pairs, too"));
        }
        // An attachment would merge the opened pair again at once.
        let opened = self.attachments.iter().filter(|(_, attachment)| {
            let ends = self.cloth_ends(attachment);
            ends.is_some_and(|ends| are_one(before, ends) && !are_one(&after, ends))
        });
        for id in opened.map(|(&id, _)| id).collect::<Vec<_>>() {
            if let Some(attachment) = self.attachments.get_mut(&id) {
                attachment.merge_within = None;
            }
        }
        Ok(())
    }

    fn change_kind(
        &mut self,
        id: ObjectId,
        kind: Kind,
        before: &Present,
    ) -> Result<Change, DrapeError> {
        let was = self.existing(id)?.kind;
        if kind == was {
            return Ok(Change::BoundaryConditions);
        }
        let present_mesh = before.mesh_of(id);
        let time = before.state.time;
        if kind == Kind::Deformable && self.attachments.values().any(|a| a.has_frame_of(id)) {
            let object = self.existing(id)?;
            let remedy = "remove what is attached to points of it, or attach it to vertices";
            return Err(object.refuse("cloth has no frame to be attached to", remedy));
        }
        if kind != Kind::Animated && self.attachments.values().any(|a| a.has_track_frame_of(id)) {
            let object = self.existing(id)?;
            let remedy = "remove what is attached to them first";
            return Err(object.refuse("the frames of its track would stand still", remedy));
        }
        let object = self.existing_mut(id)?;
        let moves = |kind: Kind| object.motion.as_ref().filter(|_| kind == Kind::Animated);
        let [old_pose, new_pose] = [was, kind].map(|kind| moves(kind).map(|m| m.pose(time)));
        let world_from_old =
            |point: Vec3| old_pose.as_ref().map_or(point, |pose| pose.apply(point));
        let new_from_world = |point: Vec3| new_pose.as_ref().map_or(point, |pose| pose.undo(point));
        object.kind = kind;
        let mut starting = BTreeMap::new();
        if let Some(mut mesh) = present_mesh {
            if kind == Kind::Deformable {
                let positions = mesh.positions.clone();
                let velocities = vec![Vec3::zeros(); positions.len()];
                let motion = StartingMotion {
                    positions,
                    velocities,
                };
                starting.insert(id, motion);
                // The motion of a grip takes its vertices from the mesh to their present positions.
                for grip in &object.grips {
                    let pose = grip.motion.pose(time);
                    for &v in &grip.vertices {
                        if let Some(at) = mesh.positions.get_mut(v as usize) {
                            *at = pose.undo(*at);
                        }
                    }
                }
            }
            mesh.positions
                .iter_mut()
                .for_each(|p| *p = new_from_world(*p));
            object.mesh = Arc::new(mesh);
        }
        if kind == Kind::Deformable {
            object.ensure_cloth()?;
        }
        object.check()?;
        for attachment in self.attachments.values_mut() {
            attachment.move_frames(id, |point| new_from_world(world_from_old(point)));
        }
        if was == Kind::Deformable {
            self.open_seams_of(id);
        }
        Ok(match [was, kind].contains(&Kind::Deformable) {
            true => Change::Structure(starting),
            false => Change::BoundaryConditions,
        })
    }

    fn reshape(&mut self, id: ObjectId, rest: Vec<[Vec2; 3]>) -> Result<(), DrapeError> {
        let object = self.existing_mut(id)?;
        let count = object.mesh.triangles.len();
        if rest.len() != count {
            let what = format!("{} rest shapes are given for {count} triangles", rest.len());
            return Err(object.refuse(&what, "give one for each"));
        }
        match &mut object.cloth {
            Some(cloth) if object.kind == Kind::Deformable => Arc::make_mut(cloth).rest = rest,
            _ => return Err(object.refuse("it is no cloth", "make it deformable first")),
        }
        object.check()
    }

    fn replace_mesh(
        &mut self,
        id: ObjectId,
        (cloth, layers): (Cloth, Layers),
        before: &Present,
    ) -> Result<Change, DrapeError> {
        let object = self.existing_mut(id)?;
        let old = object.deformable_cloth();
        let Some(old) = old.filter(|old| !old.triangles.is_empty()) else {
            return Err(object.refuse("it is no cloth", "make it deformable first"));
        };
        let replaced = Object {
            layers,
            mesh: Arc::new(cloth.mesh()),
            cloth: Some(Arc::new(cloth)),
            pins: Vec::new(),
            grips: Vec::new(),
            ..object.clone()
        };
        replaced.check()?;
        let mut starting = BTreeMap::new();
        if let (Some(cloth), Some(surface)) = (&replaced.cloth, before.merged_surface_of(id)) {
            let carry = Carry::new(old, cloth)?;
            let velocities = &before.state.velocities;
            starting.insert(
                id,
                StartingMotion {
                    positions: carry.apply(&surface),
                    velocities: carry.interpolate(&surface.triangles, velocities),
                },
            );
        }
        *object = replaced;
        self.open_seams_of(id);
        self.attachments
            .retain(|_, attachment| !attachment.names(id));
        Ok(Change::Structure(starting))
    }
}

impl ObjectAttachment {
    /// Whether an end is a point in the frame of an object.
    fn has_frame_of(&self, id: ObjectId) -> bool {
        let of = |end: &AttachmentEnd| matches!(end, AttachmentEnd::Frame { object, .. } if *object == id);
        self.ends.iter().any(of)
    }

    /// Whether an end is a point in a frame of an object's track.
    fn has_track_frame_of(&self, id: ObjectId) -> bool {
        let of = |end: &AttachmentEnd| matches!(end, AttachmentEnd::TrackFrame { object, .. } if *object == id);
        self.ends.iter().any(of)
    }

    /// Maps those of its ends that are points in the frame of an object.
    fn move_frames(&mut self, id: ObjectId, change: impl Fn(Vec3) -> Vec3) {
        for end in &mut self.ends {
            if let AttachmentEnd::Frame { object, point } = end
                && *object == id
            {
                *point = change(*point);
            }
        }
    }

    /// Whether an end belongs to an object.
    fn names(&self, id: ObjectId) -> bool {
        self.ends.iter().any(|end| match end {
            AttachmentEnd::Vertex(vertex) => vertex.object == id,
            AttachmentEnd::Frame { object, .. }
            | AttachmentEnd::Surface { object, .. }
            | AttachmentEnd::TrackFrame { object, .. } => *object == id,
            AttachmentEnd::Point(_) => false,
        })
    }
}
