//! Edits of a world: each is checked, gives another world, and says what of the system is made anew.

use super::attachment::{AttachmentId, ObjectAttachment};
use super::object::{Kind, Layers, MeshVertex, Object, ObjectId};
use super::present::Present;
use super::transfer::StartingMotion;
use super::{Environment, PairPolicy, World};
use crate::{Carry, Cloth, DrapeError, Motion};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{Vec2, Vec3};

/// A change of a world between two steps.
#[derive(Clone, Debug, PartialEq)]
pub enum WorldEdit {
    /// Adds an object.
    Add(Box<Object>),
    /// Removes an object with its attachments and opens its seams with others.
    Remove(ObjectId),
    /// Lets another rule move an object. What becomes solid stays as it lies, its seams open; what becomes cloth
    /// starts where it stands, without velocity.
    ChangeKind(ObjectId, Kind),
    /// Gives an object a motion for while it is animated; it starts from where the mesh lay when it was added.
    SetMotion(ObjectId, Motion),
    /// Adds an attachment.
    Attach(ObjectAttachment),
    /// Removes an attachment.
    Detach(AttachmentId),
    /// Makes the vertices of each pair one.
    Merge(Vec<[MeshVertex; 2]>),
    /// Takes merged pairs apart again; attachments between them hold them, but merge them no more.
    Open(Vec<[MeshVertex; 2]>),
    /// Holds these vertices of an object and no others.
    Pin(ObjectId, Vec<u32>),
    /// Gives the triangles of a cloth other rest shapes [m].
    Reshape(ObjectId, Vec<[Vec2; 3]>),
    /// Puts another mesh of the same panels in the place of a cloth, with its layers. It takes over shape and
    /// velocity by place in the panels; its seams open, its pins, grips and attachments are removed.
    ReplaceMesh(ObjectId, Box<Cloth>, Layers),
    /// Says whether two objects meet, or a cloth itself.
    SetPolicy([ObjectId; 2], PairPolicy),
    /// Changes what acts on every object alike.
    SetEnvironment(Box<Environment>),
}

/// What an edit made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edited {
    /// The object that was added.
    pub object: Option<ObjectId>,
    /// The attachment that was added.
    pub attachment: Option<AttachmentId>,
    /// Whether the merged cloth has other vertices or triangles than before.
    pub is_restructured: bool,
}

/// What of a system an edit makes anew.
pub(super) enum Change {
    /// Vertices or triangles; some objects begin anew where they are told to.
    Structure(BTreeMap<ObjectId, StartingMotion>),
    /// Rest shapes alone.
    Shapes,
    /// What holds and moves the cloth, what it meets and what acts on it.
    Furnishing,
}

impl Change {
    fn of_structure() -> Self {
        Self::Structure(BTreeMap::new())
    }

    /// What has to be made anew for two changes, one after the other.
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
            (Self::Furnishing, Self::Furnishing) => Self::Furnishing,
            (Self::Shapes, Self::Furnishing) | (Self::Furnishing, Self::Shapes) => {
                Self::of_structure()
            }
        }
    }
}

impl World {
    /// Changes it as an edit says.
    ///
    /// # Errors
    /// The first thing that does not fit; the world may then be changed in part.
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
                    false => Change::Furnishing,
                }
            }
            WorldEdit::Remove(id) => {
                let was = self.existing(id)?.kind;
                self.let_go(id);
                self.attachments
                    .retain(|_, attachment| !attachment.names(id));
                self.ignored.retain(|pair| !pair.contains(&id));
                self.objects.remove(&id);
                match was {
                    Kind::Deformable => Change::of_structure(),
                    _ => Change::Furnishing,
                }
            }
            WorldEdit::ChangeKind(id, kind) => self.change_kind(id, kind, before)?,
            WorldEdit::SetMotion(id, motion) => {
                let object = self.existing_mut(id)?;
                object.motion = Some(Arc::new(motion));
                object.check()?;
                Change::Furnishing
            }
            WorldEdit::Attach(attachment) => {
                self.check_attachment(&attachment)?;
                edited.attachment = Some(self.attach(attachment));
                Change::Furnishing
            }
            WorldEdit::Detach(id) => match self.attachments.remove(&id) {
                Some(_) => Change::Furnishing,
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
                before.check_held(&pairs)?;
                self.merge(pairs);
                Change::of_structure()
            }
            WorldEdit::Open(pairs) => {
                self.check_pairs(&pairs)?;
                self.open(pairs)?;
                Change::of_structure()
            }
            WorldEdit::Pin(id, pins) => {
                let object = self.existing_mut(id)?;
                object.pins = pins;
                object.check()?;
                Change::Furnishing
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
                Change::Furnishing
            }
            WorldEdit::SetEnvironment(environment) => {
                self.set_environment(*environment);
                Change::Furnishing
            }
        };
        Ok((edited, change))
    }

    /// Opens the seams of an object.
    fn let_go(&mut self, id: ObjectId) {
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

    fn open(&mut self, pairs: Vec<[MeshVertex; 2]>) -> Result<(), DrapeError> {
        for pair in pairs.into_iter().map(MeshVertex::pair) {
            if !self.merged.remove(&pair) {
                let [a, b] = pair.map(|vertex| vertex.vertex);
                let object = self.existing(pair[0].object)?;
                let what = format!("its vertex {a} is not merged with vertex {b} there");
                return Err(object.refuse(&what, "open pairs as they were merged"));
            }
            let between = |attachment: &ObjectAttachment, world: &Self| {
                world.cloth_ends(attachment).map(MeshVertex::pair) == Some(pair)
            };
            let held: Vec<AttachmentId> = (self.attachments.iter())
                .filter(|(_, attachment)| between(attachment, self))
                .map(|(&id, _)| id)
                .collect();
            for id in held {
                if let Some(attachment) = self.attachments.get_mut(&id) {
                    attachment.merge_within = None;
                }
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
        let lies = before.mesh_of(id);
        if kind == was {
            return Ok(Change::Furnishing);
        }
        let object = self.existing_mut(id)?;
        object.kind = kind;
        let mut starting = BTreeMap::new();
        if kind == Kind::Deformable {
            object.ensure_cloth()?;
            let places = lies.map_or_else(Vec::new, |mesh| mesh.positions);
            let velocities = vec![Vec3::zeros(); places.len()];
            starting.insert(id, StartingMotion { places, velocities });
        } else if let Some(mesh) = lies {
            // The rest shape of what has been cloth outlives that it is solid.
            object.mesh = Arc::new(mesh);
        }
        object.check()?;
        if was == Kind::Deformable {
            self.let_go(id);
        }
        Ok(match [was, kind].contains(&Kind::Deformable) {
            true => Change::Structure(starting),
            false => Change::Furnishing,
        })
    }

    fn reshape(&mut self, id: ObjectId, rest: Vec<[Vec2; 3]>) -> Result<(), DrapeError> {
        let object = self.existing_mut(id)?;
        let count = object.mesh.triangles.len();
        if rest.len() != count {
            let what = format!("{} rest shapes are given for {count} triangles", rest.len());
            return Err(object.refuse(&what, "give one for each"));
        }
        let Some(cloth) = &mut object.cloth else {
            return Err(object.refuse("it is no cloth", "make it deformable first"));
        };
        Arc::make_mut(cloth).rest = rest;
        Ok(())
    }

    fn replace_mesh(
        &mut self,
        id: ObjectId,
        (cloth, layers): (Cloth, Layers),
        before: &Present,
    ) -> Result<Change, DrapeError> {
        let object = self.existing_mut(id)?;
        let Some(old) = object.deformable_cloth() else {
            return Err(object.refuse("it is no cloth", "make it deformable first"));
        };
        let carry = Carry::new(old, &cloth)?;
        let mut starting = BTreeMap::new();
        if let Some(lies) = before.merged_surface_of(id) {
            let velocities = &before.state.velocities;
            starting.insert(
                id,
                StartingMotion {
                    places: carry.apply(&lies),
                    velocities: carry.interpolate(&lies.triangles, velocities),
                },
            );
        }
        object.layers = layers;
        object.mesh = Arc::new(cloth.mesh());
        object.cloth = Some(Arc::new(cloth));
        object.pins.clear();
        object.grips.clear();
        object.check()?;
        self.let_go(id);
        self.attachments
            .retain(|_, attachment| !attachment.names(id));
        Ok(Change::Structure(starting))
    }
}

impl ObjectAttachment {
    /// Whether an object is at one of its ends.
    fn names(&self, id: ObjectId) -> bool {
        use super::AttachmentEnd;
        self.ends.iter().any(|end| match end {
            AttachmentEnd::Vertex(vertex) => vertex.object == id,
            AttachmentEnd::Frame { object, .. } => *object == id,
            AttachmentEnd::Point(_) => false,
        })
    }
}
