//! What can be done to a running scene, and when it was done.

use crate::laws::elastic::ElasticLaw;
use crate::world::{ObjectId, World, WorldEdit};
use crate::{Attachment, DrapeError, Parameter, Simulation};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Something done to a scene between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Action {
    /// Another structure.
    Edit(WorldEdit),
    /// Another value of a load or a setting; the others stay as they are.
    Set(Parameter),
    /// A hand draws a spot from now on; one that it holds already, to this place.
    Pull {
        /// Where it holds the cloth.
        spot: Spot,
        /// Where it draws it to [m].
        to: Vec3,
        /// Its largest force [N].
        force: f64,
    },
    /// The hand lets go of a spot; one that is not held stays as it is.
    LetGo(Spot),
}

/// A place within a triangle of an object's own mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spot {
    /// The object.
    pub object: ObjectId,
    /// The triangle of its mesh.
    pub triangle: u32,
    /// Weights of its corners, none below 0, their sum 1.
    pub weights: [f64; 3],
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

/// Stiffness of a hand [N/m]: 5 N, some times the weight of a garment, over 5 cm.
pub const HAND_STIFFNESS: f64 = 100.0;

/// Farthest place cloth may be drawn to, along each axis [m]: no room is larger.
const FARTHEST: f64 = 100.0;

impl Spot {
    /// Corners of its triangle in the mesh of its object.
    ///
    /// # Errors
    /// An object or a triangle that is not there, an object that is no cloth, weights that are none.
    fn corners(&self, world: &World) -> Result<[u32; 3], DrapeError> {
        let object = world.existing(self.object)?;
        if object.deformable_cloth().is_none() {
            return Err(object.refuse("it is no cloth to take hold of", "name a cloth"));
        }
        let Some(corners) = object.mesh.triangles.get(self.triangle as usize) else {
            let what = format!("it has no triangle {}", self.triangle);
            return Err(object.refuse(&what, "name a triangle below its triangle count"));
        };
        let sum: f64 = self.weights.iter().sum();
        let are_weights = self.weights.iter().all(|w| *w >= 0.0) && (sum - 1.0).abs() < 1e-9;
        match are_weights {
            true => Ok(*corners),
            false => {
                let what = format!("{:?} are no weights of three corners", self.weights);
                Err(object.refuse(&what, "give numbers of 0 or more whose sum is 1"))
            }
        }
    }
}

/// A hand on the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Hand {
    /// Where it holds the cloth.
    pub spot: Spot,
    /// Where it is [m].
    pub to: Vec3,
    /// Its largest force [N].
    pub force: f64,
    /// Corners of the triangle seen from the spot when it took hold of it [m].
    corners: [Vec3; 3],
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
        if let Some(x) = to.iter().find(|x| x.is_nan() || x.abs() > FARTHEST) {
            let what = format!("a coordinate of the place it draws to is {x} m");
            return refuse(what, "give a place within 100 m");
        }
        if force.is_nan() || force < 0.0 {
            return refuse(format!("its force is {force} N"), "give 0 N or more");
        }
        let vertices = spot.vertices(simulation)?;
        let at = vertices.map(|v| simulation.state.positions[v as usize]);
        let place: Vec3 = at.iter().zip(spot.weights).map(|(p, w)| p * w).sum();
        Ok(Self {
            spot,
            to,
            force,
            corners: at.map(|p| p - place),
        })
    }

    /// Holds the cloth as another hand on the same spot did.
    pub fn take_over(&mut self, other: &Self) {
        self.corners = other.corners;
    }

    /// Its springs on the corners of the triangle, by their weights: together they pull at the spot alone and do not
    /// deform the triangle.
    ///
    /// # Errors
    /// A spot that is no longer there.
    pub fn attachments(&self, simulation: &Simulation) -> Result<Vec<Attachment>, DrapeError> {
        let vertices = self.spot.vertices(simulation)?;
        let corners = vertices.into_iter().zip(self.corners);
        let weighted = corners.zip(self.spot.weights).filter(|(_, w)| *w > 0.0);
        let springs = weighted.map(|((vertex, from), weight)| Attachment {
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

impl Spot {
    /// Vertices of the merged cloth at the corners of its triangle.
    fn vertices(&self, simulation: &Simulation) -> Result<[u32; 3], DrapeError> {
        let corners = self.corners(simulation.world())?;
        let own = simulation.map().vertices_of(self.object);
        let own = own.ok_or_else(|| self.object.missing())?;
        Ok(corners.map(|corner| own[corner as usize]))
    }
}
