//! What can be done to a running scene, and when it was done.
//!
//! # Decided with
//! - [`crate::scene_run::SceneRun::give`]: an action is done, stamped and logged;
//! - [`crate::scene_run::SceneRun::advance_by`], [`crate::scene_run::SceneRun::pull`]: logged actions done
//!   again; hands pull;
//! - [`crate::world::WorldEdit`], [`crate::environment::Parameter`]: edits and loads that an action may
//!   carry;
//! - [`crate::scene_checkpoint::SceneCheckpoint`]: hands in a checkpoint.
//!
//! No command and no window gives an action to a scene yet.

use crate::laws::elastic::ElasticLaw;
use crate::world::{MeshVertex, ObjectId, World, WorldEdit};
use crate::{Attachment, DrapeError, Parameter, Simulation};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Something done to a scene or a garment between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Another structure.
    Edit(WorldEdit),
    /// Another value of a load or a setting; the others stay as they are.
    Set(Parameter),
    /// A hand draws a spot from now on; one that it holds already, to this place.
    Pull {
        /// Where it holds the cloth.
        spot: Spot,
        /// Where it draws it to (m).
        to: Vec3,
        /// Its largest force (N).
        force: f64,
    },
    /// The hand lets go of a spot; one that is not held stays as it is.
    LetGo(Spot),
}

/// A place on an object's own mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Spot {
    /// A vertex.
    Vertex(MeshVertex),
    /// A place within a triangle.
    Triangle {
        /// The object.
        object: ObjectId,
        /// The triangle of its mesh.
        triangle: u32,
        /// Weights of its corners, none below 0, their sum 1.
        weights: [f64; 3],
    },
}

/// An action with its time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Steps taken before it.
    pub step: u64,
    /// What is done.
    pub action: Action,
}

/// Stiffness of a hand (N/m): its usual force over 5 cm.
pub const HAND_STIFFNESS: f64 = 100.0;

/// Usual largest force of a hand (N): some times the weight of a garment, so that cloth is drawn and not torn.
pub const HAND_FORCE: f64 = 5.0;

/// Farthest place cloth may be drawn to, along each axis (m): no room is larger.
pub const FARTHEST_PULL: f64 = 100.0;

impl Spot {
    /// The object that it is on.
    pub fn object(&self) -> ObjectId {
        match self {
            Self::Vertex(vertex) => vertex.object,
            Self::Triangle { object, .. } => *object,
        }
    }

    /// Vertices of the mesh of its object, with their weights.
    ///
    /// # Errors
    /// An object, a vertex or a triangle that is not there, an object that is no cloth, weights that are none.
    fn corners(&self, world: &World) -> Result<Vec<(u32, f64)>, DrapeError> {
        let object = world.existing(self.object())?;
        if object.deformable_cloth().is_none() {
            return Err(object.refuse("it is no cloth to take hold of", "name a cloth"));
        }
        let (triangle, weights) = match self {
            Self::Vertex(vertex) => {
                world.check_vertex(*vertex)?;
                return Ok(vec![(vertex.vertex, 1.0)]);
            }
            Self::Triangle {
                triangle, weights, ..
            } => (*triangle, weights),
        };
        let Some(corners) = object.mesh.triangles.get(triangle as usize) else {
            let what = format!("it has no triangle {triangle}");
            return Err(object.refuse(&what, "name a triangle below its triangle count"));
        };
        let sum: f64 = weights.iter().sum();
        let are_weights = weights.iter().all(|w| *w >= 0.0) && (sum - 1.0).abs() < 1e-9;
        match are_weights {
            true => Ok(corners.iter().copied().zip(*weights).collect()),
            false => {
                let what = format!("{weights:?} are no weights of three corners");
                Err(object.refuse(&what, "give numbers of 0 or more whose sum is 1"))
            }
        }
    }

    /// Vertices of the merged cloth, with their weights.
    fn vertices(&self, simulation: &Simulation) -> Result<Vec<(u32, f64)>, DrapeError> {
        let corners = self.corners(simulation.world())?;
        let own = simulation.map().vertices_of(self.object());
        let own = own.ok_or_else(|| self.object().missing())?;
        let merged = corners.into_iter().map(|(v, w)| (own[v as usize], w));
        Ok(merged.collect())
    }
}

/// A hand on the cloth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Hand {
    /// Where it holds the cloth.
    pub spot: Spot,
    /// Where it is (m).
    pub to: Vec3,
    /// Its largest force (N).
    pub force: f64,
    /// Vertices of the spot seen from it when the hand took hold of it (m).
    corners: Vec<Vec3>,
}

impl Hand {
    /// A hand that takes hold of a spot where it is.
    ///
    /// # Errors
    /// A spot that is not there, a place or a force out of range.
    pub fn new(
        simulation: &Simulation,
        (spot, to, force): (Spot, Vec3, f64),
    ) -> Result<Self, DrapeError> {
        let refuse = |what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place: "a hand".to_owned(),
                what,
                remedy: remedy.to_owned(),
            })
        };
        if let Some(x) = to.iter().find(|x| x.is_nan() || x.abs() > FARTHEST_PULL) {
            let what = format!("a coordinate of the place it draws to is {x} m");
            return refuse(what, "give a place within 100 m");
        }
        if force.is_nan() || force < 0.0 {
            return refuse(format!("its force is {force} N"), "give 0 N or more");
        }
        let vertices = spot.vertices(simulation)?;
        let at = |v: u32| simulation.state.positions[v as usize];
        let place: Vec3 = vertices.iter().map(|&(v, w)| at(v) * w).sum();
        Ok(Self {
            spot,
            to,
            force,
            corners: vertices.iter().map(|&(v, _)| at(v) - place).collect(),
        })
    }

    /// Holds the cloth as another hand on the same spot did.
    pub fn take_over(&mut self, other: &Self) {
        self.corners.clone_from(&other.corners);
    }

    /// Its springs on the corners of the triangle, by their weights: together they pull at the spot alone and do not
    /// deform the triangle.
    ///
    /// # Errors
    /// A spot that is no longer there.
    pub fn attachments(&self, simulation: &Simulation) -> Result<Vec<Attachment>, DrapeError> {
        let vertices = self.spot.vertices(simulation)?;
        let corners = vertices.into_iter().zip(&self.corners);
        let pulled = corners.filter(|((_, weight), _)| *weight > 0.0);
        let springs = pulled.map(|((vertex, weight), from)| Attachment {
            vertex,
            place: self.to + from,
            law: ElasticLaw {
                stiffness: weight * HAND_STIFFNESS,
                largest_force: weight * self.force,
            },
        });
        Ok(springs.collect())
    }
}
