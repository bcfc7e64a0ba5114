//! The run of a scene: a method steps its world in time or to equilibrium, and vertices that attachments have brought
//! together are merged.

use crate::action::{Action, Hand, Input};
use crate::collision::Tally;
use crate::measure::{Measures, measure, self_intersections};
use crate::merge::keeps_corners;
use crate::method::{Method, MethodBuilder};
use crate::methods::whole_energy;
use crate::scene_checkpoint::{SceneCheckpoint, scene_digest};
use crate::world::{Edited, ObjectId, Simulation, Solids, World, WorldEdit};
use crate::{
    Attachments, Cloth, Control, DrapeError, Elastic, MethodKind, Scene, State, TimeSettings,
    Workspace,
};
use std::collections::BTreeMap;
use std::ops::{Deref, Range};
use toile_geometry::{SurfaceTree, TriangleMesh};

/// The run of a scene.
pub struct SceneRun {
    simulation: Simulation,
    settings: TimeSettings,
    workspace: Workspace,
    method: Box<dyn Method>,
    /// Makes the method, at the start and after edits.
    builder: MethodBuilder,
    steps: usize,
    split_steps: usize,
    refinements: usize,
    /// Counts of the methods before the present one.
    tally: Option<Tally>,
    /// Whether the method was rebuilt after the last step.
    is_renewed: bool,
    /// The scene that it began with, if any.
    origin: Option<Origin>,
    /// Whether rest shapes are others than those that the structure was compiled for.
    is_reshaped: bool,
    /// Hands on the cloth.
    hands: Vec<Hand>,
    /// Attachments of the world, without the hands.
    own_attachments: Attachments,
    /// All that was done to it.
    inputs: Vec<Input>,
}

/// The beginning of a run of a scene.
struct Origin {
    digest: u64,
    world: World,
}

/// Steps between two searches for triangles that cross a solid between their contact samples.
const STEPS_TO_REFINE: usize = 4;
/// Most rounds of refined contact samples.
const MAX_REFINEMENTS: usize = 24;

impl Deref for SceneRun {
    type Target = Simulation;

    fn deref(&self) -> &Simulation {
        &self.simulation
    }
}

impl SceneRun {
    /// The control of the next steps: attachments of hands on the cloth, gravity, air. An edit resets it.
    pub fn control_mut(&mut self) -> &mut Control {
        &mut self.simulation.system.control
    }

    /// The state, mutable between two steps.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.simulation.state
    }

    /// The run of a scene by a method that `builder` makes.
    ///
    /// # Errors
    /// Those of [`Scene::check`] and [`Simulation::new`], a scene without cloth, a feature that the method does not
    /// support, and a method that the builder does not have.
    pub fn new(scene: &Scene, builder: MethodBuilder) -> Result<Self, DrapeError> {
        let world = World::of_scene(scene)?;
        world.check_features(scene.method.kind)?;
        let settings = TimeSettings {
            lead_in: scene.lead_in,
            duration: scene.duration,
            step: scene.step,
            method: scene.method,
        };
        let origin = Origin {
            digest: scene_digest(scene),
            world: world.clone(),
        };
        let mut simulation = Simulation::new(world)?;
        simulation.state.time = -scene.lead_in;
        let run = Self::of_simulation(simulation, settings, builder)?;
        Ok(Self {
            origin: Some(origin),
            ..run
        })
    }

    /// A run from the present state of a simulation, for instance of a draped garment, by a method that `builder`
    /// makes.
    ///
    /// # Errors
    /// A feature of the world that the method does not support, and a method that the builder does not have.
    pub fn of_simulation(
        simulation: Simulation,
        settings: TimeSettings,
        builder: MethodBuilder,
    ) -> Result<Self, DrapeError> {
        simulation.world().check_features(settings.method.kind)?;
        Ok(Self {
            own_attachments: simulation.system.control.attachments.clone(),
            simulation,
            settings,
            workspace: Workspace::default(),
            method: builder(&settings.method)?,
            builder,
            steps: 0,
            split_steps: 0,
            refinements: 0,
            tally: None,
            is_renewed: true,
            origin: None,
            is_reshaped: false,
            hands: Vec::new(),
            inputs: Vec::new(),
        })
    }

    /// Resumes a checkpoint of a scene.
    ///
    /// # Errors
    /// Those of [`Self::new`], a checkpoint of another scene, or one whose fields contradict each other.
    pub fn resume(
        scene: &Scene,
        checkpoint: SceneCheckpoint,
        builder: MethodBuilder,
    ) -> Result<Self, DrapeError> {
        let refuse = |place: &str, what: String| DrapeError::Scene {
            place: format!("checkpoint, {place}"),
            what,
            remedy: "go on with the scene that it was saved of, or begin anew".to_owned(),
        };
        let mut run = Self::new(scene, builder)?;
        if checkpoint.scene != run.digest() {
            return Err(refuse("scene", "it was saved of another scene".to_owned()));
        }
        let world = checkpoint.world.world(run.world())?;
        world.check_features(scene.method.kind)?;
        let simulation = Simulation::laid_out(world, checkpoint.layout, Solids::new());
        run.simulation = simulation.map_err(|error| refuse("layout", error.to_string()))?;
        run.own_attachments = run.system.control.attachments.clone();
        run.simulation
            .restore(checkpoint.state, checkpoint.control)?;
        run.hands = checkpoint.hands;
        for hand in &run.hands {
            hand.attachments(&run.simulation)?;
        }
        run.steps = checkpoint.steps;
        run.split_steps = checkpoint.split_steps;
        run.refinements = checkpoint.refinements;
        run.tally = checkpoint.tally;
        Ok(run)
    }

    /// Digest of its scene; 0 where it began elsewhere.
    pub fn digest(&self) -> u64 {
        self.origin.as_ref().map_or(0, |origin| origin.digest)
    }

    /// Most steps to the next checkpoint. With contact of cloth with cloth there is one after each simulated second and
    /// after each merge or edit; without it after each step.
    pub fn steps_to_checkpoint(&self) -> usize {
        match self.is_renewed || !self.has_cloth_contact() {
            true => 0,
            false => self.span() - self.steps % self.span(),
        }
    }

    /// Whether a run that is recorded keeps a checkpoint here: at the start, once a simulated second, and after each
    /// merge or edit.
    pub fn is_landmark(&self) -> bool {
        self.is_renewed || self.steps.is_multiple_of(self.span())
    }

    /// Whether checkpoints of its method can be taken: one without memory outside the state.
    pub fn has_checkpoints(&self) -> bool {
        let kind = self.settings.method.kind;
        !kind.is_equilibrium() && kind != MethodKind::ImplicitMidpoint
    }

    /// A checkpoint from which another process with the same scene goes on to the same bytes.
    ///
    /// # Errors
    /// Between two checkpoints, for a run that did not begin with a scene, after rest shapes were changed, and for
    /// methods with a memory outside the state.
    pub fn checkpoint(&self) -> Result<SceneCheckpoint, DrapeError> {
        let refuse = |what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place: "checkpoint".to_owned(),
                what,
                remedy: remedy.to_owned(),
            })
        };
        if !self.has_checkpoints() {
            let name = self.settings.method.kind.name();
            let what = format!("a run by \"{name}\" has none");
            return refuse(what, "run it to its end, or use another method");
        }
        let Some(origin) = &self.origin else {
            let what = "the run did not begin with a scene".to_owned();
            return refuse(what, "save a run of a scene");
        };
        if self.is_reshaped {
            let what = "rest shapes were changed and the structure was not made anew".to_owned();
            return refuse(what, "save the run before, or replace the mesh instead");
        }
        if self.steps_to_checkpoint() > 0 {
            let what = format!("the next one is {} steps off", self.steps_to_checkpoint());
            return refuse(what, "take these steps first");
        }
        Ok(SceneCheckpoint {
            scene: origin.digest,
            world: self.world().saved(&origin.world)?,
            hands: self.hands.clone(),
            layout: self.system.topology.layout.clone(),
            state: self.state.clone(),
            control: self.system.control.clone(),
            steps: self.steps,
            split_steps: self.split_steps,
            refinements: self.refinements,
            tally: self.cloth_tally(),
        })
    }

    /// Whether there is contact of cloth with cloth, whose search structures influence the order of later results.
    fn has_cloth_contact(&self) -> bool {
        self.system.contact.cloth_offset > 0.0
    }

    /// Steps of a simulated second.
    fn span(&self) -> usize {
        ((1.0 / self.settings.step).round() as usize).max(1)
    }

    /// Rebuilds the method; its memory is in the state.
    fn rebuild_method(&mut self) -> Result<(), DrapeError> {
        let method = (self.builder)(&self.settings.method)?;
        self.tally = self.cloth_tally();
        self.method = method;
        self.workspace = Workspace::default();
        self.is_renewed = true;
        Ok(())
    }

    /// Duration, step and method.
    pub fn settings(&self) -> &TimeSettings {
        &self.settings
    }

    /// Whether the duration is over or equilibrium is reached.
    pub fn finished(&self) -> bool {
        let TimeSettings { step, method, .. } = self.settings;
        let duration = self.settings.whole();
        if method.kind.is_equilibrium() {
            return self.method.finished();
        }
        self.steps as f64 * step >= duration - 1e-9 * step
    }

    /// Share of the run that is done, 0..=1.
    pub fn share(&self) -> f64 {
        let step = self.settings.step;
        let duration = self.settings.whole();
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

    /// Steps that were divided after a failure.
    pub fn split_steps(&self) -> usize {
        self.split_steps
    }

    /// Takes one step, then merges vertices that attachments have brought together.
    ///
    /// # Errors
    /// A step that fails at every size; the state is then the last good one.
    pub fn advance(&mut self) -> Result<(), DrapeError> {
        let Simulation { system, state, .. } = &mut self.simulation;
        let report = self.method.advance(system, state, self.settings.step)?;
        self.split_steps += usize::from(report.pieces > 1);
        self.steps += 1;
        tracing::debug!(step = self.steps, ?report, "step of the scene");
        self.is_renewed = false;
        if self.steps.is_multiple_of(STEPS_TO_REFINE) {
            self.refine();
        }
        let closed = self.simulation.closed_pairs();
        if !closed.is_empty() {
            self.simulation.edit(WorldEdit::Merge(closed))?;
            self.refinements = 0;
            self.is_reshaped = false;
            self.own_attachments = self.system.control.attachments.clone();
            self.pull()?;
            self.rebuild_method()?;
        }
        let in_time = !self.settings.method.kind.is_equilibrium();
        if in_time && self.has_cloth_contact() && self.steps.is_multiple_of(self.span()) {
            self.rebuild_method()?;
        }
        Ok(())
    }

    /// Does something between two steps and stamps it; the run goes on from the present state. The scene with its
    /// inputs is the run: see [`Self::advance_by`].
    ///
    /// # Errors
    /// An action that does not fit, and a feature that the method does not support; the run is then unchanged.
    pub fn give(&mut self, action: Action) -> Result<Edited, DrapeError> {
        let edited = match action.clone() {
            Action::Edit(edit) => self.apply_edit(edit)?,
            Action::Set(parameter) => {
                let environment = self.world().environment().with(parameter);
                self.apply_edit(WorldEdit::SetEnvironment(Box::new(environment)))?
            }
            Action::Pull { spot, to, force } => {
                let held = self.hands.iter().position(|hand| hand.spot == spot);
                let mut hand = Hand::new(&self.simulation, (spot, to, force))?;
                match held {
                    Some(k) => {
                        hand.take_over(&self.hands[k]);
                        self.hands[k] = hand;
                    }
                    None => self.hands.push(hand),
                }
                self.pull()?;
                Edited::default()
            }
            Action::LetGo(spot) => {
                self.hands.retain(|hand| hand.spot != spot);
                self.pull()?;
                Edited::default()
            }
        };
        let step = self.steps as u64;
        self.inputs.push(Input { step, action });
        Ok(edited)
    }

    /// All that was done to it since its start or its checkpoint.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// Does what some inputs have for the present step, in their order, then takes one step: a run of the same scene
    /// with the inputs of another comes to the same bytes.
    ///
    /// # Errors
    /// Those of [`Self::give`] and [`Self::advance`].
    pub fn advance_by(&mut self, inputs: &[Input]) -> Result<(), DrapeError> {
        for input in inputs {
            if input.step == self.steps as u64 {
                self.give(input.action.clone())?;
            }
        }
        self.advance()
    }

    /// [`Self::give`] with an edit.
    ///
    /// # Errors
    /// Those of [`Self::give`].
    pub fn edit(&mut self, edit: WorldEdit) -> Result<Edited, DrapeError> {
        self.give(Action::Edit(edit))
    }

    fn apply_edit(&mut self, edit: WorldEdit) -> Result<Edited, DrapeError> {
        let before = self.simulation.clone();
        let shapes = matches!(edit, WorldEdit::Reshape(..));
        let gone = match &edit {
            WorldEdit::Remove(id)
            | WorldEdit::ReplaceMesh(id, ..)
            | WorldEdit::ChangeKind(id, _) => Some(*id),
            _ => None,
        };
        let edited = self.simulation.edit(edit)?;
        if let Err(error) = self.world().check_features(self.settings.method.kind) {
            self.simulation = before;
            return Err(error);
        }
        self.is_reshaped = (self.is_reshaped || shapes) && !edited.is_restructured;
        if edited.is_restructured {
            self.refinements = 0;
        }
        // Of what is gone or has another mesh hands let go.
        self.hands.retain(|hand| Some(hand.spot.object()) != gone);
        self.own_attachments = self.system.control.attachments.clone();
        self.pull()?;
        // The method may have cached solids and policies.
        self.rebuild_method()?;
        Ok(edited)
    }

    /// Lets the hands pull beside the attachments of the world.
    fn pull(&mut self) -> Result<(), DrapeError> {
        let control = &mut self.simulation.system.control;
        control.attachments = self.own_attachments.clone();
        if self.hands.is_empty() {
            return Ok(());
        }
        let mut all = self.own_attachments.all().to_vec();
        for hand in &self.hands {
            all.extend(hand.attachments(&self.simulation)?);
        }
        self.simulation.system.control.attachments = all.into_iter().collect();
        Ok(())
    }

    /// Refines contact samples of triangles that cross a solid although their corners are clear of it: where the solid
    /// is too sharp for the mesh.
    fn refine(&mut self) {
        let Simulation { system, state, .. } = &mut self.simulation;
        if system.colliders.is_empty() || self.refinements >= MAX_REFINEMENTS {
            return;
        }
        let mesh = system.mesh(&state.positions);
        let mut found: Vec<u32> = Vec::new();
        for (number, collider) in system.colliders.iter().enumerate() {
            let solid = collider.at(state.time);
            let meets = |&t: &u32| {
                let object = system
                    .policies
                    .object_of_sample(&mesh.triangles[t as usize]);
                !system.policies.ignores_solid(object, number)
            };
            let clear = |&v: &u32| {
                let position = state.positions[v as usize];
                let clearance = 0.5 * system.contact.offset;
                solid.exact_distance(position) > clearance
            };
            let pairs = solid.crossings(&mesh);
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

    /// Counts of contact of cloth with cloth so far; none where the method has no such counts.
    pub fn cloth_tally(&self) -> Option<Tally> {
        match (self.tally, self.method.cloth_tally()) {
            (Some(before), Some(now)) => Some(before.then(now)),
            (before, now) => before.or(now),
        }
    }

    /// The present surfaces of all objects, in order.
    pub fn meshes(&self) -> Vec<TriangleMesh> {
        let ids = self.world().objects().map(|(id, _)| id);
        ids.filter_map(|id| self.mesh_of(id)).collect()
    }

    /// Some objects as one surface with shared merged vertices.
    pub fn surface(&self, objects: &[ObjectId]) -> Surface {
        let mut surface = Surface::default();
        let mut number: BTreeMap<u32, u32> = BTreeMap::new();
        for &id in objects {
            let Some(mesh) = self.mesh_of(id) else {
                continue;
            };
            let first = surface.mesh.triangles.len();
            let own = self.map().vertices_of(id);
            let positions = &mut surface.mesh.positions;
            let mut numbers = Vec::with_capacity(mesh.positions.len());
            for (k, position) in mesh.positions.iter().enumerate() {
                let fresh = positions.len() as u32;
                let at = own.map_or(fresh, |own| *number.entry(own[k]).or_insert(fresh));
                if at == fresh {
                    positions.push(*position);
                }
                numbers.push(at);
            }
            let triangles = mesh.triangles.iter();
            for (number, triangle) in triangles.enumerate() {
                if keeps_corners(*triangle, &numbers) {
                    let corners = triangle.map(|v| numbers[v as usize]);
                    surface.mesh.triangles.push(corners);
                    surface.origin.push(number as u32);
                }
            }
            let range = first..surface.mesh.triangles.len();
            surface.objects.push((id, range));
        }
        surface
    }

    /// A surface as a cloth: rest shapes and materials of its triangles at their present places. None unless all its
    /// objects are cloth.
    pub fn cloth(&self, surface: &Surface) -> Option<Cloth> {
        let mut whole = Cloth {
            positions: surface.mesh.positions.clone(),
            triangles: surface.mesh.triangles.clone(),
            ..Cloth::default()
        };
        let mut panels = 0;
        for (id, range) in &surface.objects {
            let own = self.world().object(*id)?.deformable_cloth()?;
            let first = whole.materials.len() as u16;
            for &t in &surface.origin[range.clone()] {
                let t = t as usize;
                whole.rest.push(own.rest[t]);
                whole.material.push(first + own.material[t]);
                whole.panel.push(panels + own.panel[t]);
            }
            whole.materials.extend_from_slice(&own.materials);
            panels += own.panel.iter().max().map_or(0, |most| most + 1);
        }
        Some(whole)
    }

    /// Largest gap of an elastic or of an attachment (m).
    pub fn elastic_gap(&self) -> f64 {
        let gap = |elastic: Elastic| elastic.gap(&self.state.positions).norm();
        let frames = self.system.control.frames.iter().map(|frame| {
            let target = frame.target(self.state.time);
            (self.state.positions[frame.vertex as usize] - target).norm()
        });
        let ties = self.system.control.ties.iter().map(|tie| {
            let target = self.system.place_of(&tie.to, &self.state);
            (tie.from.of(&self.state.positions) - target).norm()
        });
        let all = (self.system.elastics().map(gap)).chain(frames).chain(ties);
        all.fold(0.0, f64::max)
    }

    /// Energy of motion, strain, weight, elastics and contact (J); heights count from the origin.
    pub fn energy(&mut self) -> f64 {
        let Simulation { system, state, .. } = &self.simulation;
        whole_energy(system, state, &mut self.workspace)
    }

    /// Number of pairs of cloth triangles that intersect and share no vertex, by exact predicates, without pairs of
    /// objects that ignore each other.
    pub fn crossings(&self) -> usize {
        let mesh = self.system.mesh(&self.state.positions);
        self_intersections(&self.system, &SurfaceTree::new(mesh)).len()
    }

    /// Net force over weight after the last step, where the method computes it; infinite where it has failed to.
    pub fn residual(&self) -> Option<f64> {
        self.method.residual()
    }

    /// Net force over weight in some measures; none where the method does not balance forces.
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

/// Some objects as one surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The objects with their ranges of triangles.
    pub objects: Vec<(ObjectId, Range<usize>)>,
    /// Vertices (m) and triangles.
    pub mesh: TriangleMesh,
    /// The triangle of its object's own mesh that each triangle is.
    pub origin: Vec<u32>,
}
