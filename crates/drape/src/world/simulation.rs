//! A world that is simulated: the system compiled from it, its state, and edits between steps.

use super::compile::Solids;
use super::edit::{Change, Edited, WorldEdit};
use super::object::{MeshVertex, ObjectId};
use super::present::Present;
use super::transfer::{MeetingPlace, StartingMotion, Transfer};
use super::{VertexMap, World};
use crate::{Control, DrapeError, State, System};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};

/// A world with its system and its state.
#[derive(Clone)]
pub struct Simulation {
    /// Compiled from the world. From outside its control may be changed, no more: another structure comes by
    /// [`Simulation::edit`].
    pub system: System,
    /// Places, velocities and what is remembered.
    pub state: State,
    world: World,
    map: VertexMap,
    solids: Solids,
}

impl Simulation {
    /// At rest where the cloths of a world lie.
    ///
    /// # Errors
    /// A world without cloth, bad meshes, materials that cannot be simulated.
    pub fn new(world: World) -> Result<Self, DrapeError> {
        Self::with_solids(world, Solids::new())
    }

    /// The same with solid surfaces that are there already.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub(crate) fn with_solids(world: World, solids: Solids) -> Result<Self, DrapeError> {
        let map = VertexMap::new(&world);
        let panels = world.panels();
        let mut places = vec![Vec3::zeros(); map.count];
        for (&place, &to) in panels.positions.iter().zip(&map.target).rev() {
            places[to as usize] = place;
        }
        Self::laid_out(world, places, solids)
    }

    /// Of a world whose structure is laid out at some places of the merged vertices [m].
    ///
    /// # Errors
    /// As [`Simulation::new`]; another number of places.
    pub(crate) fn laid_out(
        world: World,
        places: Vec<Vec3>,
        mut solids: Solids,
    ) -> Result<Self, DrapeError> {
        let map = VertexMap::new(&world);
        if places.len() != map.count {
            return Err(DrapeError::Scene {
                place: "layout".to_owned(),
                what: format!("{} places for {} vertices", places.len(), map.count),
                remedy: "give one for each vertex once seams are merged".to_owned(),
            });
        }
        let system = world.compile(&map, places.clone(), &mut solids)?;
        Ok(Self {
            state: State::at_rest(&system, places),
            system,
            world,
            map,
            solids,
        })
    }

    /// What is simulated.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Where the vertices of the objects' own meshes are in the merged cloth.
    pub fn map(&self) -> &VertexMap {
        &self.map
    }

    /// The surface of an object as it lies now; none where it was removed.
    pub fn mesh_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        self.present().mesh_of(id)
    }

    fn present(&self) -> Present<'_> {
        Present {
            world: &self.world,
            map: &self.map,
            system: &self.system,
            state: &self.state,
        }
    }

    /// Changes the world and goes on from its present state: what an edit does not touch keeps its numbers to the
    /// bit. Vertices that become one meet at their centre of mass with their common momentum. The control becomes the
    /// world's: hands and winds that were put into it from outside are given again.
    ///
    /// # Errors
    /// What does not fit, by name; world and state are then as they were.
    pub fn edit(&mut self, edit: WorldEdit) -> Result<Edited, DrapeError> {
        self.edit_all(vec![edit], MeetingPlace::CentreOfMass)
    }

    /// Several edits as one, and where vertices that become one meet.
    ///
    /// # Errors
    /// As [`Simulation::edit`].
    pub(crate) fn edit_all(
        &mut self,
        edits: Vec<WorldEdit>,
        meeting: MeetingPlace,
    ) -> Result<Edited, DrapeError> {
        let mut world = self.world.clone();
        let (mut edited, mut change) = (Edited::default(), None::<Change>);
        for edit in edits {
            let (one, made_anew) = world.apply(edit, &self.present())?;
            edited.object = one.object.or(edited.object);
            edited.attachment = one.attachment.or(edited.attachment);
            change = Some(match change {
                Some(change) => change.and(made_anew),
                None => made_anew,
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
                self.state.begin_rest_anew();
                let (held, gripped) = self.present().held();
                let velocities = self.state.velocities.iter_mut();
                for (velocity, (held, gripped)) in velocities.zip(held.into_iter().zip(gripped)) {
                    if held && !gripped {
                        *velocity = Vec3::zeros();
                    }
                }
            }
        }
        Ok(edited)
    }

    /// Goes on from a state and a control that were saved.
    ///
    /// # Errors
    /// Those of another system, by the field.
    pub(crate) fn go_on_from(&mut self, state: State, control: Control) -> Result<(), DrapeError> {
        let count = self.system.vertex_count() as u32;
        let attachments = control.attachments.all().iter().map(|one| one.vertex);
        let frames = control.frames.iter().map(|one| one.vertex);
        if attachments.chain(frames).any(|vertex| vertex >= count) {
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

    /// Brings everything to rest where it is; contacts and methods remember nothing.
    pub(crate) fn let_rest(&mut self) {
        let places = std::mem::take(&mut self.state.positions);
        self.state = State {
            time: self.state.time,
            ..State::at_rest(&self.system, places)
        };
    }

    /// Compiles another world and carries the state over.
    fn restructure(
        &mut self,
        world: World,
        starting: &BTreeMap<ObjectId, StartingMotion>,
        meeting: MeetingPlace,
    ) -> Result<(), DrapeError> {
        let map = VertexMap::new(&world);
        let (held, _) = self.present().held();
        let transfer = Transfer::new(&world, [&self.map, &map], &held, starting);
        let mass = self.system.cloth_mass();
        let motion = transfer.motion(&self.state, &mass, meeting);
        let mut solids = self.solids.clone();
        let system = world.compile(&map, motion.0.clone(), &mut solids)?;
        self.state = transfer.state((&self.state, &self.system), &system, motion);
        (self.system, self.world, self.map, self.solids) = (system, world, map, solids);
        Ok(())
    }

    /// Takes up other rest shapes of the same triangles; whether the structure had to be made anew.
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
            // The triangles serve, but not with what curvatures were estimated from.
            Err(DrapeError::NeedsRemesh { .. }) => {
                self.restructure(world, &BTreeMap::new(), MeetingPlace::CentreOfMass)?;
                Ok(true)
            }
            Err(error) => Err(error),
        }
    }

    /// Pairs of vertices that attachments have drawn close enough to become one, and may.
    pub(crate) fn closed_pairs(&self) -> Vec<[MeshVertex; 2]> {
        self.present().closed_pairs()
    }
}
