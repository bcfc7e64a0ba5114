//! Running a scene: a world stepped in time by a method, or led to rest by one; what its attachments draw
//! together is merged.

use crate::collision::Tally;
use crate::digest::Digest;
use crate::measure::{Measures, measure, self_intersections};
use crate::method::Method;
use crate::methods::whole_energy;
use crate::world::{Edited, MeshVertex, ObjectId, Simulation, Solids, World, WorldEdit};
use crate::{Control, DrapeError, Elastic, MethodKind, MethodSettings, Scene, State, Workspace};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::{Deref, Range};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// How long a scene is stepped and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// Simulated time [s].
    pub duration: f64,
    /// Step in time [s].
    pub step: f64,
    /// How the motion is computed.
    pub method: MethodSettings,
}

/// A scene on its way.
pub struct SceneRun {
    simulation: Simulation,
    settings: TimeSettings,
    workspace: Workspace,
    method: Box<dyn Method>,
    steps: usize,
    split_steps: usize,
    refinements: usize,
    /// What methods counted before the one in hand was built.
    tally: Option<Tally>,
    /// Whether the method was built anew after the last step.
    is_renewed: bool,
    /// Whether the world is not, or no more, the one of a scene.
    is_edited: bool,
}

/// All that a scene's run is between two steps but the scene itself, which it is resumed with: plain data, to be
/// written to a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneCheckpoint {
    /// Digest of the scene.
    scene: u64,
    /// Pairs of vertices that were merged on the way.
    merged: Vec<[MeshVertex; 2]>,
    /// Where the vertices lay when the structure was made [m].
    layout: Vec<Vec3>,
    state: State,
    control: Control,
    steps: usize,
    split_steps: usize,
    refinements: usize,
    tally: Option<Tally>,
}

/// Steps between two looks for cloth that crosses a body between its samples, and how often it may
/// be tested more finely.
const STEPS_TO_REFINE: usize = 4;
const MOST_REFINEMENTS: usize = 24;

impl Deref for SceneRun {
    type Target = Simulation;

    fn deref(&self) -> &Simulation {
        &self.simulation
    }
}

impl SceneRun {
    /// What acts in the next steps beside the world's own: hands on the cloth, for instance. An edit takes it back.
    pub fn control_mut(&mut self) -> &mut Control {
        &mut self.simulation.system.control
    }

    /// The state, to be changed between two steps.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.simulation.state
    }

    /// Of a scene.
    ///
    /// # Errors
    /// Whatever [`Scene::check`] and [`Simulation::new`] refuse, a scene without cloth, and one that asks its
    /// method for what that does not know.
    pub fn new(scene: &Scene) -> Result<Self, DrapeError> {
        let world = World::of_scene(scene)?;
        world.check_features(scene.method.kind)?;
        let settings = TimeSettings {
            duration: scene.duration,
            step: scene.step,
            method: scene.method,
        };
        let run = Self::of_simulation(Simulation::new(world)?, settings)?;
        Ok(Self {
            is_edited: false,
            ..run
        })
    }

    /// Steps a simulation in time from its present state: a garment that was draped, for instance.
    ///
    /// # Errors
    /// A world that asks the method for what that does not know.
    pub fn of_simulation(
        simulation: Simulation,
        settings: TimeSettings,
    ) -> Result<Self, DrapeError> {
        simulation.world().check_features(settings.method.kind)?;
        Ok(Self {
            simulation,
            settings,
            workspace: Workspace::default(),
            method: settings.method.build(),
            steps: 0,
            split_steps: 0,
            refinements: 0,
            tally: None,
            is_renewed: true,
            is_edited: true,
        })
    }

    /// Goes on from a checkpoint of a scene.
    ///
    /// # Errors
    /// A checkpoint of another scene, or one that does not fit itself.
    pub fn resume(scene: &Scene, checkpoint: SceneCheckpoint) -> Result<Self, DrapeError> {
        let refuse = |place: &str, what: String| DrapeError::Scene {
            place: format!("checkpoint, {place}"),
            what,
            remedy: "go on with the scene that it was saved of, or begin anew".to_owned(),
        };
        if checkpoint.scene != digest(scene) {
            return Err(refuse("scene", "it was saved of another scene".to_owned()));
        }
        let mut run = Self::new(scene)?;
        let mut world = run.world().clone();
        for &vertex in checkpoint.merged.iter().flatten() {
            world.check_vertex(vertex)?;
        }
        world.merge(checkpoint.merged);
        let simulation = Simulation::laid_out(world, checkpoint.layout, Solids::new());
        run.simulation = simulation.map_err(|error| refuse("layout", error.to_string()))?;
        run.simulation
            .restore(checkpoint.state, checkpoint.control)?;
        run.steps = checkpoint.steps;
        run.split_steps = checkpoint.split_steps;
        run.refinements = checkpoint.refinements;
        run.tally = checkpoint.tally;
        Ok(run)
    }

    /// Steps to the next checkpoint at the most: where cloth meets cloth there is one each simulated second and
    /// wherever something is merged; else after every step.
    pub fn steps_to_checkpoint(&self) -> usize {
        match self.is_renewed || !self.meets_itself() {
            true => 0,
            false => self.span() - self.steps % self.span(),
        }
    }

    /// All that it takes to go on from here with its scene in another process to the same bytes.
    ///
    /// # Errors
    /// Between two checkpoints, after edits from outside, and for methods that keep what no state has.
    pub fn checkpoint(&self, scene: &Scene) -> Result<SceneCheckpoint, DrapeError> {
        let refuse = |what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place: "checkpoint".to_owned(),
                what,
                remedy: remedy.to_owned(),
            })
        };
        let kind = self.settings.method.kind;
        if kind.is_equilibrium() || kind == MethodKind::ImplicitMidpoint {
            let what = format!("a run by \"{}\" has none", kind.name());
            return refuse(what, "run it to its end, or use another method");
        }
        if self.is_edited {
            let what = "the world was edited, and is not the scene's";
            return refuse(what.to_owned(), "save a run of a scene before edits");
        }
        if self.steps_to_checkpoint() > 0 {
            let what = format!("the next one is {} steps off", self.steps_to_checkpoint());
            return refuse(what, "take these steps first");
        }
        Ok(SceneCheckpoint {
            scene: digest(scene),
            merged: self.world().merged().collect(),
            layout: self.system.topology.layout.clone(),
            state: self.state.clone(),
            control: self.system.control.clone(),
            steps: self.steps,
            split_steps: self.split_steps,
            refinements: self.refinements,
            tally: self.cloth_tally(),
        })
    }

    /// Whether contact of cloth with cloth is looked for: what was found at one look changes which of several right
    /// answers is found at the next.
    fn meets_itself(&self) -> bool {
        self.system.contact.cloth_offset > 0.0
    }

    /// Steps of a simulated second.
    fn span(&self) -> usize {
        ((1.0 / self.settings.step).round() as usize).max(1)
    }

    /// Builds the method anew; what it has to remember is in the state.
    fn renew(&mut self) {
        self.tally = self.cloth_tally();
        self.method = self.settings.method.build();
        self.workspace = Workspace::default();
        self.is_renewed = true;
    }

    /// How long it is stepped and how.
    pub fn settings(&self) -> &TimeSettings {
        &self.settings
    }

    /// Whether the duration is over, or rest is reached.
    pub fn finished(&self) -> bool {
        let TimeSettings {
            duration,
            step,
            method,
        } = self.settings;
        if method.kind.is_equilibrium() {
            return self.method.finished();
        }
        self.steps as f64 * step >= duration - 1e-9 * step
    }

    /// Share of the way, 0..=1.
    pub fn share(&self) -> f64 {
        let TimeSettings { duration, step, .. } = self.settings;
        match self.method.residual() {
            Some(residual) => ((1.0 / residual.max(1e-3)).log10() / 3.0).clamp(0.0, 1.0),
            None if duration > 0.0 => (self.steps as f64 * step / duration).min(1.0),
            None => 1.0,
        }
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Steps that had to be cut into smaller ones.
    pub fn split_steps(&self) -> usize {
        self.split_steps
    }

    /// Takes one step, then merges what attachments have drawn together.
    ///
    /// # Errors
    /// When a step fails at every size; the state is the last good one.
    pub fn advance(&mut self) -> Result<(), DrapeError> {
        let Simulation { system, state, .. } = &mut self.simulation;
        let report = self.method.advance(system, state, self.settings.step)?;
        self.split_steps += usize::from(report.pieces > 1);
        self.steps += 1;
        self.is_renewed = false;
        if self.steps.is_multiple_of(STEPS_TO_REFINE) {
            self.refine();
        }
        let closed = self.simulation.closed_pairs();
        if !closed.is_empty() {
            self.simulation.edit(WorldEdit::Merge(closed))?;
            self.refinements = 0;
            self.renew();
        }
        let in_time = !self.settings.method.kind.is_equilibrium();
        if in_time && self.meets_itself() && self.steps.is_multiple_of(self.span()) {
            self.renew();
        }
        Ok(())
    }

    /// Changes the world between two steps and goes on from its present state.
    ///
    /// # Errors
    /// What does not fit, by name, and what the method does not know; all is then as it was.
    pub fn edit(&mut self, edit: WorldEdit) -> Result<Edited, DrapeError> {
        let before = self.simulation.clone();
        let edited = self.simulation.edit(edit)?;
        if let Err(error) = self.world().check_features(self.settings.method.kind) {
            self.simulation = before;
            return Err(error);
        }
        self.is_edited = true;
        if edited.is_restructured {
            self.refinements = 0;
        }
        // Solids and policies that were looked up may be others now.
        self.renew();
        Ok(edited)
    }

    /// Tests contact more finely where cloth crosses a body although its corners keep off: where a
    /// body is too sharp for the triangles on it.
    fn refine(&mut self) {
        let Simulation { system, state, .. } = &mut self.simulation;
        if system.colliders.is_empty() || self.refinements >= MOST_REFINEMENTS {
            return;
        }
        let mesh = system.mesh(&state.positions);
        let mut found: Vec<u32> = Vec::new();
        for (number, collider) in system.colliders.iter().enumerate() {
            let pose = collider.pose(state.time);
            let meets = |&t: &u32| {
                let object = system
                    .policies
                    .object_of_sample(&mesh.triangles[t as usize]);
                !system.policies.ignores_solid(object, number)
            };
            let clear = |&v: &u32| {
                let place = state.positions[v as usize];
                let off = 0.5 * system.contact.offset;
                collider.exact_distance(pose.as_ref(), place) > off
            };
            let pairs = collider.crossings(state.time, &mesh);
            let crossing = pairs.iter().map(|pair| pair[0]).filter(meets);
            found.extend(crossing.filter(|&t| mesh.triangles[t as usize].iter().all(clear)));
        }
        found.sort_unstable();
        found.dedup();
        self.refinements += usize::from(!found.is_empty());
        for triangle in found {
            state.refine_contact(system, triangle);
        }
    }

    /// What contact of cloth with cloth found and did, where the method counts it.
    pub fn cloth_tally(&self) -> Option<Tally> {
        match (self.tally, self.method.cloth_tally()) {
            (Some(before), Some(now)) => Some(before.then(now)),
            (before, now) => before.or(now),
        }
    }

    /// Surface of every object as it lies now, in order.
    pub fn meshes(&self) -> Vec<TriangleMesh> {
        let ids = self.world().objects().map(|(id, _)| id);
        ids.filter_map(|id| self.mesh_of(id)).collect()
    }

    /// Some objects as one surface, whose merged vertices are common.
    pub fn surface(&self, objects: &[ObjectId]) -> Surface {
        let mut surface = Surface::default();
        let mut number: BTreeMap<u32, u32> = BTreeMap::new();
        for &id in objects {
            let Some(mesh) = self.mesh_of(id) else {
                continue;
            };
            let first = surface.mesh.triangles.len();
            let own = self.map().vertices_of(id);
            let places = &mut surface.mesh.positions;
            let mut numbers = Vec::with_capacity(mesh.positions.len());
            for (k, place) in mesh.positions.iter().enumerate() {
                let fresh = places.len() as u32;
                let at = own.map_or(fresh, |own| *number.entry(own[k]).or_insert(fresh));
                if at == fresh {
                    places.push(*place);
                }
                numbers.push(at);
            }
            let triangles = mesh.triangles.iter();
            let renumbered = triangles.map(|t| t.map(|v| numbers[v as usize]));
            let distinct = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
            (surface.mesh.triangles).extend(renumbered.filter(distinct));
            let range = first..surface.mesh.triangles.len();
            surface.objects.push((id, range));
        }
        surface
    }

    /// Largest gap of an elastic that still acts [m].
    pub fn elastic_gap(&self) -> f64 {
        let gap = |elastic: Elastic| elastic.gap(&self.state.positions).norm();
        let frames = self.system.control.frames.iter().map(|one| {
            let place = one.target(self.state.time);
            (self.state.positions[one.vertex as usize] - place).norm()
        });
        let all = self.system.elastics().map(gap).chain(frames);
        all.fold(0.0, f64::max)
    }

    /// Energy of motion, strain, weight, elastics and contact [J]; heights count from the origin.
    pub fn energy(&mut self) -> f64 {
        let Simulation { system, state, .. } = &self.simulation;
        whole_energy(system, state, &mut self.workspace)
    }

    /// Pairs of cloth triangles that intersect and share no vertex, exactly, but for those of objects that ignore
    /// each other.
    pub fn crossings(&self) -> usize {
        let mesh = self.system.mesh(&self.state.positions);
        self_intersections(&self.system, &SurfaceTree::new(mesh)).len()
    }

    /// Net force over weight of a state measured, where that says how far from rest it is.
    pub fn residual_of(&self, measures: &Measures) -> Option<f64> {
        let balances = self.settings.method.kind.balances_forces();
        balances.then_some(measures.residual)
    }

    /// Measures the present state.
    pub fn measure(&mut self) -> Measures {
        let Simulation { system, state, .. } = &self.simulation;
        measure(system, state, &mut self.workspace, &[])
    }
}

/// Of all that a scene says: numbers are told apart to the last bit.
fn digest(scene: &Scene) -> u64 {
    let mut digest = Digest::new();
    digest.text(&format!("{scene:?}"));
    digest.value()
}

/// Some objects as one surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The objects, each with its triangles.
    pub objects: Vec<(ObjectId, Range<usize>)>,
    /// Vertices [m] and triangles.
    pub mesh: TriangleMesh,
}
