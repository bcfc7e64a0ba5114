//! A simulated world: the compiled system, its state, and edits between steps.

use super::compile::Solids;
use super::edit::{Change, Edited, WorldEdit};
use super::object::{MeshVertex, ObjectId};
use super::present::Present;
use super::transfer::{MeetingPoint, StartingMotion, Transfer};
use super::{VertexMap, World};
use crate::tie::Tie;
use crate::{Control, DrapeError, State, System};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};

/// A world with its system and its state.
#[derive(Clone)]
pub struct Simulation {
    /// The system compiled from the world. Callers may change its control only; all else changes by
    /// [`Simulation::edit`].
    pub system: System,
    /// Positions, velocities and memories.
    pub state: State,
    world: World,
    map: VertexMap,
    solids: Solids,
}

impl Simulation {
    /// A world at rest at the starting positions of its cloths.
    ///
    /// # Errors
    /// A world without cloth, bad meshes, materials that cannot be simulated.
    pub fn new(world: World) -> Result<Self, DrapeError> {
        Self::with_solids(world, Solids::new())
    }

    /// [`Simulation::new`] with colliders made before.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub(crate) fn with_solids(world: World, solids: Solids) -> Result<Self, DrapeError> {
        let map = VertexMap::new(&world);
        let panels = world.panels();
        let mut positions = vec![Vec3::zeros(); map.count];
        for (&position, &to) in panels.positions.iter().zip(&map.target).rev() {
            positions[to as usize] = position;
        }
        Self::laid_out(world, positions, solids)
    }

    /// A world at rest with its merged vertices at `positions` (m), which also decide the elimination orders.
    ///
    /// # Errors
    /// Those of [`Simulation::new`]; a wrong number of positions.
    pub(crate) fn laid_out(
        world: World,
        positions: Vec<Vec3>,
        mut solids: Solids,
    ) -> Result<Self, DrapeError> {
        let map = VertexMap::new(&world);
        if positions.len() != map.count {
            return Err(DrapeError::Scene {
                place: "layout".to_owned(),
                what: format!("{} places for {} vertices", positions.len(), map.count),
                remedy: "give one for each vertex once seams are merged".to_owned(),
            });
        }
        let system = world.compile(&map, positions.clone(), &mut solids)?;
        Ok(Self {
            state: State::at_rest(&system, positions),
            system,
            world,
            map,
            solids,
        })
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The map from the vertices of the objects' meshes to those of the merged cloth.
    pub fn map(&self) -> &VertexMap {
        &self.map
    }

    /// The present surface of an object; none after its removal.
    pub fn mesh_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        self.present().mesh_of(id)
    }

    pub(super) fn present(&self) -> Present<'_> {
        Present {
            world: &self.world,
            map: &self.map,
            system: &self.system,
            state: &self.state,
        }
    }

    /// Applies an edit and transfers the present state: the state of untouched objects stays the same to the bit.
    /// Vertices that merge meet at their centre of mass and keep their total momentum. The control is reset to that of
    /// the world: callers that set attachments or wind in it set them again.
    ///
    /// # Errors
    /// The property that does not fit; world and state are then unchanged.
    pub fn edit(&mut self, edit: WorldEdit) -> Result<Edited, DrapeError> {
        self.edit_all(vec![edit], MeetingPoint::CentreOfMass)
    }

    /// Applies several edits as one; merged vertices meet as `meeting` says.
    ///
    /// # Errors
    /// Those of [`Simulation::edit`].
    pub(crate) fn edit_all(
        &mut self,
        edits: Vec<WorldEdit>,
        meeting: MeetingPoint,
    ) -> Result<Edited, DrapeError> {
        let mut world = self.world.clone();
        let (mut edited, mut change) = (Edited::default(), None::<Change>);
        for edit in edits {
            let (result, next) = world.apply(edit, &self.present())?;
            edited.object = result.object.or(edited.object);
            edited.attachment = result.attachment.or(edited.attachment);
            change = Some(match change {
                Some(change) => change.and(next),
                None => next,
            });
        }
        world.check()?;
        match change {
            None => {}
            Some(Change::Structure(starting)) => {
                self.restructure(world, &starting, meeting)?;
                edited.is_restructured = true;
            }
            Some(Change::Shapes) => edited.is_restructured = self.reshape(world)?,
            Some(Change::BoundaryConditions) => {
                self.system = world.furnish(&self.map, self.system.edit(), &mut self.solids);
                self.world = world;
                self.state.clear_equilibrium_memory();
                let (prescribed, gripped) = self.present().prescribed();
                let velocities = self.state.velocities.iter_mut();
                let marks = prescribed.into_iter().zip(gripped);
                for (velocity, (is_prescribed, is_gripped)) in velocities.zip(marks) {
                    if is_prescribed && !is_gripped {
                        *velocity = Vec3::zeros();
                    }
                }
            }
        }
        Ok(edited)
    }

    /// Replaces state and control by saved ones.
    ///
    /// # Errors
    /// The field that does not fit the system.
    pub(crate) fn restore(&mut self, state: State, control: Control) -> Result<(), DrapeError> {
        let count = self.system.vertex_count() as u32;
        let attachments = (control.attachments.all().iter()).map(|attachment| attachment.vertex);
        let frames = control.frames.iter().map(|frame| frame.vertex);
        let misses = |tie: &Tie| !self.system.has_ends_of(tie);
        if attachments.chain(frames).any(|vertex| vertex >= count)
            || control.ties.iter().any(misses)
        {
            return Err(DrapeError::Scene {
                place: "checkpoint, control.attachments".to_owned(),
                what: "there are fewer vertices".to_owned(),
                remedy: "take another checkpoint: this one is damaged".to_owned(),
            });
        }
        state.check(&self.system)?;
        self.system.control = control;
        self.state = state;
        if *self.state.samples == *self.system.rest.samples {
            self.state.samples = Arc::clone(&self.system.rest.samples);
        }
        Ok(())
    }

    /// Sets all velocities to zero and clears the memories of contacts and methods.
    pub(crate) fn reset_motion(&mut self) {
        let positions = std::mem::take(&mut self.state.positions);
        self.state = State {
            time: self.state.time,
            ..State::at_rest(&self.system, positions)
        };
    }

    /// Compiles another world and transfers the state.
    fn restructure(
        &mut self,
        world: World,
        starting: &BTreeMap<ObjectId, StartingMotion>,
        meeting: MeetingPoint,
    ) -> Result<(), DrapeError> {
        let map = VertexMap::new(&world);
        let (prescribed, _) = self.present().prescribed();
        let transfer = Transfer::new(&world, [&self.map, &map], &prescribed, starting);
        let mass = self.system.cloth_mass();
        let motion = transfer.motion(&self.state, &mass, meeting);
        let mut solids = self.solids.clone();
        let system = world.compile(&map, motion.0.clone(), &mut solids)?;
        self.state = transfer.state((&self.state, &self.system), &system, motion);
        (self.system, self.world, self.map, self.solids) = (system, world, map, solids);
        Ok(())
    }

    /// Replaces the rest shapes of the same triangles; returns whether the structure was compiled again.
    fn reshape(&mut self, world: World) -> Result<bool, DrapeError> {
        let panels = world.panels();
        let merged = self.map.triangles.iter();
        let rest = merged.map(|&t| panels.rest[t as usize]).collect();
        match self.system.reshaped(world.name, rest) {
            Ok(system) => {
                self.state.follow_shapes(&system);
                self.system = system;
                self.world = world;
                Ok(false)
            }
            // The triangles are sound, but the neighbours chosen for their curvatures no longer are.
            Err(DrapeError::NeedsRemesh { .. }) => {
                self.restructure(world, &BTreeMap::new(), MeetingPoint::CentreOfMass)?;
                Ok(true)
            }
            Err(error) => Err(error),
        }
    }

    /// Pairs of vertices that may merge and are within the merging distance of their attachment.
    pub(crate) fn closed_pairs(&self) -> Vec<[MeshVertex; 2]> {
        self.present().closed_pairs()
    }
}
