//! The world: objects with stable numbers and meshes of their own, merged vertices, attachments and the environment.
//! The simulated system is compiled from it. After an edit of the world the system is compiled again and the state is
//! transferred to it.
//!
//! # Decided with
//! - [`crate::world::object::Object`], [`crate::world::attachment::ObjectAttachment`]: objects and
//!   attachments, and their checks;
//! - [`crate::world::edit::WorldEdit`]: what can be changed, and what each change asks for;
//! - [`crate::world::World::compile`] (`compile.rs`): the system made of the world; boundary conditions,
//!   solids, layers, policies;
//! - [`crate::world::present::Present`], [`crate::world::vertex_map::VertexMap`]: where objects are now;
//!   their vertices in the merged cloth;
//! - [`crate::world::simulation::Simulation`], [`crate::world::transfer::Transfer`]: edits between steps; the
//!   state carried over;
//! - [`crate::world::saved::SavedWorld`]: the world in a checkpoint;
//! - [`crate::scene::Scene::check`]: a scene is checked before a world is made of it;
//! - [`crate::scene_run::SceneRun::edit`], [`crate::garment`] (`edit.rs`): edits while a scene runs; edits of
//!   the pattern of a worn garment.

mod attachment;
mod compile;
mod edit;
mod gaps;
mod object;
mod present;
mod saved;
mod simulation;
mod transfer;
mod vertex_map;
mod written_mesh;

pub use attachment::{AttachmentEnd, AttachmentId, ObjectAttachment};
pub(crate) use compile::Solids;
pub use edit::{Edited, WorldEdit};
pub use gaps::OpenAttachment;
pub use object::{Kind, Layers, MeshVertex, Object, ObjectId, VertexGrip};
pub(crate) use saved::SavedWorld;
pub use simulation::Simulation;
pub(crate) use transfer::MeetingPoint;
pub use vertex_map::VertexMap;

use crate::scene::{SceneEnd, SceneObject};
use crate::{Cloth, DrapeError, Environment, Scene};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Whether contact acts between two objects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PairPolicy {
    /// Contact acts.
    #[default]
    Meet,
    /// They pass through each other.
    Ignore,
}

/// Objects, attachments and environment: all that a system is compiled from.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Name in messages.
    name: &'static str,
    environment: Environment,
    objects: BTreeMap<ObjectId, Arc<Object>>,
    attachments: BTreeMap<AttachmentId, ObjectAttachment>,
    /// Pairs of merged vertices.
    merged: BTreeSet<[MeshVertex; 2]>,
    /// Pairs of objects that ignore each other, the smaller number first.
    ignored: BTreeSet<[ObjectId; 2]>,
    next_object: u32,
    next_attachment: u32,
}

impl World {
    /// A world without objects; messages use `name`.
    pub fn new(name: &'static str, environment: Environment) -> Self {
        Self {
            name,
            environment,
            objects: BTreeMap::new(),
            attachments: BTreeMap::new(),
            merged: BTreeSet::new(),
            ignored: BTreeSet::new(),
            next_object: 0,
            next_attachment: 0,
        }
    }

    /// The world of a scene, whose objects get the numbers 0, 1, ... in their order.
    ///
    /// # Errors
    /// Those of [`Scene::check`].
    pub fn of_scene(scene: &Scene) -> Result<Self, DrapeError> {
        scene.check()?;
        let mut world = Self::new("scene", scene.environment());
        for (index, object) in scene.objects.iter().enumerate() {
            let grips = scene.grips.iter().filter(|grip| grip.object == index);
            let grips = grips.map(|grip| VertexGrip {
                vertices: grip.vertices.clone(),
                motion: Arc::new(grip.motion.clone()),
            });
            let object = Object {
                grips: grips.collect(),
                ..Object::of_scene(object)?
            };
            object.check()?;
            world.insert(object);
        }
        for pair in &scene.ignored {
            let [a, b] = pair.map(SceneObject::id);
            world.ignored.insert([a.min(b), a.max(b)]);
        }
        for elastic in &scene.elastics {
            let ends = [elastic.from, elastic.to].map(|end| match end {
                SceneEnd::Point(point) => AttachmentEnd::Point(point),
                SceneEnd::Vertex { object, vertex } => AttachmentEnd::Vertex(MeshVertex {
                    object: ObjectId(object as u32),
                    vertex,
                }),
            });
            let attachment = ObjectAttachment {
                ends,
                stiffness: elastic.stiffness,
                merge_within: elastic.merge_within,
            };
            world.check_attachment(&attachment)?;
            world.attach(attachment);
        }
        Ok(world)
    }

    /// Adds an object, which the caller has checked.
    pub(crate) fn insert(&mut self, object: Object) -> ObjectId {
        let id = ObjectId(self.next_object);
        self.next_object += 1;
        self.objects.insert(id, Arc::new(object));
        id
    }

    /// Adds an attachment.
    fn attach(&mut self, attachment: ObjectAttachment) -> AttachmentId {
        let id = AttachmentId(self.next_attachment);
        self.next_attachment += 1;
        self.attachments.insert(id, attachment);
        id
    }

    /// Replaces the environment.
    pub(crate) fn set_environment(&mut self, environment: Environment) {
        self.environment = environment;
    }

    /// Merges the two vertices of each pair.
    pub(crate) fn merge(&mut self, pairs: impl IntoIterator<Item = [MeshVertex; 2]>) {
        let pairs = pairs.into_iter().map(MeshVertex::pair);
        self.merged.extend(pairs);
    }

    /// Refuses an environment out of range, contact that reaches too far for a fabric, and layers without contact of
    /// cloth with cloth.
    fn check(&self) -> Result<(), DrapeError> {
        self.environment.check()?;
        let contact = self.environment.contact;
        let cloths = self.objects().map(|(_, object)| object);
        let cloths: Vec<&Object> = cloths.filter(|o| o.kind == Kind::Deformable).collect();
        for object in &cloths {
            let materials = object.cloth.iter().flat_map(|cloth| &cloth.materials);
            let own = contact.for_cloth(materials);
            own.check_reach(&format!("thickness of \"{}\"", object.name))?;
        }
        let first = cloths.first().map(|object| &object.layers);
        let other = cloths.iter().find(|object| Some(&object.layers) != first);
        let passes = contact.cloth_offset <= 0.0 && self.environment.layers_apart.is_none();
        match other.filter(|_| passes) {
            None => Ok(()),
            Some(object) => {
                let what = "cloth passes through cloth, so layers have no order";
                Err(object.refuse(what, "keep cloth off cloth, or put it in one layer"))
            }
        }
    }

    /// Gravity, air, damping and contact, the same for all objects.
    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// The objects in order of their numbers.
    pub fn objects(&self) -> impl Iterator<Item = (ObjectId, &Object)> {
        self.objects.iter().map(|(&id, object)| (id, &**object))
    }

    /// An object; none after its removal.
    pub fn object(&self, id: ObjectId) -> Option<&Object> {
        self.objects.get(&id).map(|object| &**object)
    }

    /// An object, or the error of an edit that names a missing one.
    pub(crate) fn existing(&self, id: ObjectId) -> Result<&Object, DrapeError> {
        self.object(id).ok_or_else(|| id.missing())
    }

    /// [`Self::existing`], mutable.
    fn existing_mut(&mut self, id: ObjectId) -> Result<&mut Object, DrapeError> {
        let found = self.objects.get_mut(&id).map(Arc::make_mut);
        found.ok_or_else(|| id.missing())
    }

    pub(crate) fn check_vertex(&self, vertex: MeshVertex) -> Result<(), DrapeError> {
        let object = self.existing(vertex.object)?;
        match (vertex.vertex as usize) < object.vertex_count() {
            true => Ok(()),
            false => {
                let what = format!("it has no vertex {}", vertex.vertex);
                Err(object.refuse(&what, "name a vertex below its vertex count"))
            }
        }
    }

    /// The attachments in order of their numbers.
    pub fn attachments(&self) -> impl Iterator<Item = (AttachmentId, &ObjectAttachment)> {
        self.attachments
            .iter()
            .map(|(&id, attachment)| (id, attachment))
    }

    /// Pairs of merged vertices.
    pub fn merged(&self) -> impl Iterator<Item = [MeshVertex; 2]> + '_ {
        self.merged.iter().copied()
    }

    /// Whether contact acts between two objects, or of a cloth with itself where both are the same.
    pub fn policy(&self, [a, b]: [ObjectId; 2]) -> PairPolicy {
        match self.ignored.contains(&[a.min(b), a.max(b)]) {
            true => PairPolicy::Ignore,
            false => PairPolicy::Meet,
        }
    }

    /// The deformable objects with their cloths, in order.
    pub fn cloths(&self) -> impl Iterator<Item = (ObjectId, &Cloth)> {
        let all = self.objects();
        all.filter_map(|(id, object)| Some((id, object.deformable_cloth()?)))
    }

    /// Groups of objects that merged vertices or attachments that merge connect, in order of their first objects; any
    /// other object is a group of one.
    pub fn groups(&self) -> Vec<Vec<ObjectId>> {
        let ids: Vec<ObjectId> = self.objects.keys().copied().collect();
        let number = |id: ObjectId| ids.binary_search(&id).ok().map(|at| at as u32);
        let to_merge = self.attachments.values().filter_map(|attachment| {
            attachment.merge_within?;
            self.cloth_ends(attachment)
        });
        let pairs = self.merged().chain(to_merge).filter_map(|pair| {
            let [a, b] = pair.map(|vertex| number(vertex.object));
            Some([a?, b?])
        });
        let (group, count) = crate::merge_map(ids.len(), pairs);
        let mut groups = vec![Vec::new(); count];
        for (id, group) in ids.into_iter().zip(group) {
            groups[group as usize].push(id);
        }
        groups
    }
}

impl ObjectId {
    /// The error of an edit that names a missing object.
    pub(crate) fn missing(self) -> DrapeError {
        DrapeError::Scene {
            place: format!("object {}", self.0),
            what: "it is not there".to_owned(),
            remedy: "name an object of the world".to_owned(),
        }
    }
}

impl SceneObject {
    /// The number of the object at an index of a scene.
    pub fn id(index: usize) -> ObjectId {
        ObjectId(index as u32)
    }
}
