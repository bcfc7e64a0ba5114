//! A world as it is saved: what differs from the scene that it was made from.

use super::World;
use super::attachment::{AttachmentId, ObjectAttachment};
use super::object::{MeshVertex, Object, ObjectId};
use crate::{DrapeError, Environment, SharedTrack};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A world, without the objects that are as in its scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SavedWorld {
    environment: Environment,
    /// The objects; none for one that is as in the scene.
    objects: BTreeMap<ObjectId, Option<SavedObject>>,
    attachments: BTreeMap<AttachmentId, ObjectAttachment>,
    merged: BTreeSet<[MeshVertex; 2]>,
    ignored: BTreeSet<[ObjectId; 2]>,
    next_object: u32,
    next_attachment: u32,
}

/// An object with the digest of its track, which is a rule and is found again in the scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedObject {
    object: Object,
    track: Option<u64>,
}

fn refuse<T>(place: String, what: &str, remedy: &str) -> Result<T, DrapeError> {
    Err(DrapeError::Scene {
        place,
        what: what.to_owned(),
        remedy: remedy.to_owned(),
    })
}

impl World {
    /// The world for a checkpoint, over that of its scene.
    ///
    /// # Errors
    /// An object whose track is not one of the scene's.
    pub(crate) fn saved(&self, scene: &Self) -> Result<SavedWorld, DrapeError> {
        let mut objects = BTreeMap::new();
        for (&id, object) in &self.objects {
            let is_known = scene.objects.get(&id).is_some_and(|known| known == object);
            let saved = match is_known {
                true => None,
                false => Some(object.saved(scene)?),
            };
            objects.insert(id, saved);
        }
        Ok(SavedWorld {
            environment: self.environment.clone(),
            objects,
            attachments: self.attachments.clone(),
            merged: self.merged.clone(),
            ignored: self.ignored.clone(),
            next_object: self.next_object,
            next_attachment: self.next_attachment,
        })
    }

    /// The track of a digest among its objects.
    fn track(&self, digest: u64) -> Option<SharedTrack> {
        let tracks = self.objects.values().filter_map(|o| o.track.as_ref());
        tracks.into_iter().find(|t| t.digest() == digest).cloned()
    }
}

impl Object {
    fn saved(&self, scene: &World) -> Result<SavedObject, DrapeError> {
        let track = self.track.as_ref().map(SharedTrack::digest);
        if track.is_some_and(|digest| scene.track(digest).is_none()) {
            let what = "its track is not one of the scene's, where it would be looked for";
            return Err(self.refuse(what, "give the scene an object with that track"));
        }
        Ok(SavedObject {
            object: Self {
                track: None,
                ..self.clone()
            },
            track,
        })
    }
}

impl SavedWorld {
    /// The world over that of the same scene.
    ///
    /// # Errors
    /// What is not in the scene, and whatever an edit would be refused for.
    pub fn world(self, scene: &World) -> Result<World, DrapeError> {
        let remedy = "take another checkpoint: this one is damaged";
        let mut objects = BTreeMap::new();
        for (id, saved) in self.objects {
            let place = format!("checkpoint, object {}", id.0);
            let object = match saved {
                None => match scene.objects.get(&id) {
                    Some(object) => Arc::clone(object),
                    None => return refuse(place, "it is not in the scene", remedy),
                },
                Some(SavedObject { mut object, track }) => {
                    if let Some(digest) = track {
                        let Some(track) = scene.track(digest) else {
                            let remedy = "go on with the scene that it was saved of";
                            return refuse(place, "its track is not in the scene", remedy);
                        };
                        object.track = Some(track);
                    }
                    object.check()?;
                    Arc::new(object)
                }
            };
            if id.0 >= self.next_object {
                return refuse(place, "its number was not given yet", remedy);
            }
            objects.insert(id, object);
        }
        let world = World {
            name: scene.name,
            environment: self.environment,
            objects,
            attachments: self.attachments,
            merged: self.merged,
            ignored: self.ignored,
            next_object: self.next_object,
            next_attachment: self.next_attachment,
        };
        world.check()?;
        for attachment in world.attachments.values() {
            world.check_attachment(attachment)?;
        }
        for &vertex in world.merged.iter().flatten() {
            world.check_vertex(vertex)?;
        }
        for &id in world.ignored.iter().flatten() {
            world.existing(id)?;
        }
        Ok(world)
    }
}
