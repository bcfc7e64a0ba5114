//! Extended position based dynamics: constraints with the stiffness of the material laws, solved
//! one after the other in small steps.
//!
//! A substep of h (Macklin, Müller and Chentanez 2016, algorithm 1; Macklin et al. 2019 for many
//! substeps of one iteration):
//! ```text
//! v = v - q(h W T) v                          where cloth is viscous
//! v = (v + h (g + (f_bend(x0 + theta h v) + f_air(v)) / m)) / (1 + drag h),  x = x0 + h v
//! for every constraint:  dlambda = -(J W J^T + alpha / h^2)^-1 (C + alpha / h^2 lambda)
//!                        x = x + W J^T dlambda
//! contacts and friction: the same with inequalities
//! v = (x - x0) / h
//! ```
//! Iterated to convergence this is implicit Euler of the same potential that [`crate::Workspace`] minimises. Many
//! substeps of one iteration are stable at any stiffness; the error of the single iteration acts as an additional
//! compliance of the order of h^2 / m.
//!
//! Inner loops run in single precision on positions relative to the middle of the cloth, with compensated
//! summation; the state is in double precision. Internal strain is not supported.

// Loops over lanes and axes use indices, so that they unroll into vectors.
#![allow(clippy::needless_range_loop)]

mod air;
mod attachment_constraint;
mod bending;
mod bounce;
mod carried_plane;
mod cloth;
mod contact;
mod contact_block;
mod domains;
mod friction;
mod membrane;
mod moving_solids;
mod particles;
mod region;
mod report;
mod run;
mod settings;
mod several_solids;
mod skin_contacts;
mod skin_edges;
mod skin_look;
mod tie_constraint;
mod triangle_sums;
mod vertex_partition;
mod viscosity;
mod xpbd_method;

use crate::lanes::LANES;
use crate::{ContactSample, DrapeError, Model, State, System};
use bending::{BendingForce, Filter, FilterBounds};
use bounce::BounceStep;
pub(crate) use cloth::{ClothContacts, Substeps};
use contact::{ContactConstraint, ContactStep, Solid};
use membrane::{LawRow, inverse_mass};
use moving_solids::MovingSolids;
use particles::{MotionStep, Particles};
use region::{Regions, SweepStep};
pub use report::{ConstraintCount, XpbdReport};
use run::Run;
pub use settings::{Losses, XpbdSettings};
use skin_contacts::SkinSearch;
use skin_look::StepStart;
use std::sync::Arc;
use toile_geometry::Vec3;
use vertex_partition::VertexPartition;
use viscosity::Viscosity;
pub(crate) use xpbd_method::XpbdMethod;

/// Most halvings of a substep that fails, before it is an error.
const MAX_STEP_HALVINGS: u32 = 6;

/// XPBD on one model: its constraints in the order in which they are solved, and private memory.
pub struct Xpbd {
    settings: XpbdSettings,
    partition: VertexPartition,
    regions: Regions,
    particles: Particles,
    bending: BendingForce,
    has_bending_constraints: bool,
    /// The filter of the bending force; none where bending is constraints.
    filter: Option<Filter>,
    /// The viscosity, and its filter.
    viscosity: Option<(Viscosity, Filter)>,
    laws: Vec<LawRow>,
    /// The substep for which filter and constraints are set up (s), and its (1 + drag h) / h^2 (1/s2).
    step: f64,
    kappa: f64,
    built_for: BuiltFor,
    domain_starts: Vec<usize>,
    contact_starts: Vec<usize>,
    cut_starts: Vec<usize>,
    /// Surfaces of the solids that move, in the present step.
    moving: MovingSolids,
    /// The search for their vertices near the cloth.
    skin: SkinSearch,
    /// Number of times that constraints were built.
    builds: usize,
}

/// The model and the samples from which the constraints were built.
struct BuiltFor {
    model: Model,
    samples: Arc<Vec<ContactSample>>,
}

/// (1 + drag h) / h^2 of a substep h (s) under a drag per mass (1/s), in 1/s2.
fn kappa(h: f64, drag: f64) -> f64 {
    (1.0 + drag * h) / (h * h)
}

impl BuiltFor {
    fn new(model: &Model, samples: &Arc<Vec<ContactSample>>) -> Self {
        Self {
            model: model.clone(),
            samples: samples.clone(),
        }
    }

    fn fits(&self, model: &Model, samples: &Arc<Vec<ContactSample>>) -> bool {
        self.model.has_cloth_of(model)
            && self.model.has_couplings_of(model)
            && self.model.contact == model.contact
            && Arc::ptr_eq(&self.model.policies, &model.policies)
            && self.model.colliders.len() == model.colliders.len()
            && Arc::ptr_eq(&self.samples, samples)
    }
}

impl Xpbd {
    /// Builds the constraints of a model.
    pub fn new(system: &System) -> Self {
        Self::with_settings(system, XpbdSettings::default())
    }

    /// Builds the constraints of a model, with settings.
    pub fn with_settings(system: &System, settings: XpbdSettings) -> Self {
        Self::with_samples(system, &system.rest.samples, settings)
    }

    /// Builds the constraints of a model and of a state's samples, for a way to rest.
    pub(crate) fn for_state(system: &System, state: &State) -> Self {
        let settings = XpbdSettings {
            losses: Losses::DragAlone,
            ..XpbdSettings::default()
        };
        Self::with_samples(system, &state.samples, settings)
    }

    /// Builds the constraints of a model and of contact samples, with settings.
    fn with_samples(
        system: &System,
        samples: &Arc<Vec<ContactSample>>,
        settings: XpbdSettings,
    ) -> Self {
        let partition = VertexPartition::new(system);
        let mut regions = Regions::new(&partition);
        regions.add_membranes(system, &partition);
        regions.add_elastics(system, &partition);
        let viscosity = settings.losses.viscosity(system);
        if viscosity.is_some() {
            regions.add_viscous_bending(system, &partition);
        }
        let solids = system.colliders.len();
        let mut particles = Particles::new(partition.len(), solids);
        if !system.colliders.is_empty() {
            regions.add_samples(system, samples, &partition);
            for (index, sample) in samples.iter().enumerate() {
                if sample.triangle.is_none() {
                    let slot = partition.slot_of[sample.vertices[0] as usize];
                    let (block, lane) = (slot as usize / LANES, slot as usize % LANES);
                    for solid in 0..solids {
                        let contact = ContactConstraint::of_sample(system, (index, sample), solid);
                        particles.contacts[block * solids + solid].set(lane, &contact);
                    }
                }
            }
        }
        Self {
            settings,
            regions,
            particles,
            bending: BendingForce::new(system, &partition.vertex_of, &partition.slot_of),
            has_bending_constraints: false,
            filter: None,
            viscosity: viscosity.map(|viscosity| (viscosity, Filter::default())),
            laws: system.materials.laws.iter().map(LawRow::new).collect(),
            step: f64::NAN,
            kappa: f64::NAN,
            built_for: BuiltFor::new(system, samples),
            domain_starts: partition.domain_starts(),
            contact_starts: partition.contact_starts(),
            cut_starts: partition.cut_starts(),
            partition,
            moving: MovingSolids::default(),
            skin: SkinSearch::default(),
            builds: 1,
        }
    }

    /// Number of times that constraints were built: once, and again after each change of the model.
    pub fn builds(&self) -> usize {
        self.builds
    }

    /// Numbers of constraints of one sweep at the size of the last substep.
    pub fn constraints(&self) -> ConstraintCount {
        let [membrane, bending] = self.regions.counts();
        ConstraintCount {
            membrane,
            bending: if bending == 0 {
                self.bending.count
            } else {
                bending
            },
            elastics: self.regions.elastic_count(),
            contacts: self.built_for.samples.len(),
        }
    }

    /// Advances the state by `count` substeps of `substep` (s) under `drag` per mass (1/s): a free velocity decays as
    /// exp(-drag t). Where the model has changed since the last call, constraints are built anew.
    ///
    /// # Errors
    /// When a number is not finite at any size of substep; the state is then unchanged.
    pub fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        substep: f64,
        count: u32,
        drag: f64,
    ) -> Result<XpbdReport, DrapeError> {
        self.rebuild_if_changed(system, &state.samples);
        let substeps = Substeps {
            substep,
            count,
            drag,
        };
        let origin = middle(&state.positions);
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        let parts: Vec<Substeps> = self.parts(system, state.time, &substeps).collect();
        for (number, part) in parts.iter().enumerate() {
            self.place_solids(system, state, (&parts, number));
            report = self.advance_about(system, state, origin, part)?;
            pieces = pieces.max(report.pieces);
        }
        report.pieces = pieces;
        Ok(report)
    }

    /// Gives the moving solids their places for one of the parts of a step from a state on; every surface is queried again.
    /// Before the first part their vertices and edges near the cloth are looked for, before the others those go on.
    fn place_solids(
        &mut self,
        system: &System,
        state: &State,
        (parts, number): (&[Substeps], usize),
    ) {
        let Substeps { substep, count, .. } = parts[number];
        let part = substep * f64::from(count);
        self.moving.set_step([state.time, state.time + part]);
        self.invalidate_surfaces();
        if number == 0 {
            let start = StepStart {
                positions: &state.positions,
                velocities: &state.velocities,
                part,
                parts: parts.len() as u32,
            };
            return self.set_skin_contacts(system, &start);
        }
        for region in self.regions.all_mut() {
            for contact in &mut region.skin {
                contact.go_on(&self.moving);
            }
        }
    }

    /// Substeps from a time (s) on, divided so that moving solids move straight in each part; one part where all are at
    /// rest.
    fn parts(
        &mut self,
        system: &System,
        time: f64,
        substeps: &Substeps,
    ) -> impl Iterator<Item = Substeps> + use<> {
        let substeps = *substeps;
        let Substeps { substep, count, .. } = substeps;
        let times = [time, time + substep * f64::from(count)];
        let limits = (system.contact.offset, count);
        let parts = self.moving.parts(&system.colliders, times, limits);
        let until = move |part: u32| part * count / parts;
        (0..parts).map(move |part| Substeps {
            count: until(part + 1) - until(part),
            ..substeps
        })
    }

    /// [`Xpbd::advance`] with coordinates relative to `origin` (m), to which the contact planes refer too.
    fn advance_about(
        &mut self,
        system: &System,
        state: &mut State,
        origin: Vec3,
        &Substeps {
            substep,
            count,
            drag,
        }: &Substeps,
    ) -> Result<XpbdReport, DrapeError> {
        if let Some(vertex) = state.first_not_finite() {
            let stage = "XPBD, before the step";
            return Err(DrapeError::NotFinite { stage, vertex });
        }
        let mut failed = 0;
        for halvings in 0..=MAX_STEP_HALVINGS {
            let pieces = 1u32 << halvings;
            if halvings > 0 {
                self.invalidate_surfaces();
                for region in self.regions.all_mut() {
                    region.forget_slips();
                }
            }
            let h = substep / f64::from(pieces);
            self.set_step(system, h, kappa(h, drag))?;
            self.load(system, state, origin);
            self.recall_friction(state, &ContactStep::new(kappa(h, drag) as f32, h as f32));
            self.set_prescribed_velocities(system, state, substep * f64::from(count));
            let motion = SubstepSize {
                h,
                drag,
                time: state.time,
            };
            self.run(system, origin, &motion, count * pieces);
            match self.first_not_finite() {
                Some(vertex) => failed = vertex,
                None => {
                    let mut report = self.store(system, state, origin);
                    report.pieces = pieces;
                    state.time += substep * f64::from(count);
                    return Ok(report);
                }
            }
        }
        Err(DrapeError::NotFinite {
            stage: "XPBD step",
            vertex: failed,
        })
    }

    /// Builds the constraints anew where the model has changed; returns whether it has.
    fn rebuild_if_changed(&mut self, system: &System, samples: &Arc<Vec<ContactSample>>) -> bool {
        let changed = !self.built_for.fits(system, samples);
        if changed {
            let builds = self.builds + 1;
            *self = Self::with_samples(system, samples, self.settings);
            self.builds = builds;
        }
        changed
    }

    /// Marks all contact planes as invalid, so that surfaces are queried again.
    fn invalidate_surfaces(&mut self) {
        for contact in &mut self.particles.contacts {
            contact.invalidate();
        }
        for region in self.regions.all_mut() {
            region.invalidate_surfaces();
        }
    }

    /// Loads a state into the particles, and the attachments of the control.
    fn load(&mut self, system: &System, state: &State, origin: Vec3) {
        let particles = &mut self.particles;
        for (slot, vertex) in self.partition.vertex_of.iter().enumerate() {
            let Some(v) = *vertex else {
                continue;
            };
            let position = state.positions[v as usize] - origin;
            let velocity = state.velocities[v as usize];
            let weight = inverse_mass(system, v);
            let mut start = [0.0, 0.0, 0.0, weight as f32];
            for k in 0..3 {
                start[k] = position[k] as f32;
                particles.low[slot][k] = (position[k] - f64::from(start[k])) as f32;
                particles.velocity[slot][k] = if weight > 0.0 {
                    velocity[k] as f32
                } else {
                    0.0
                };
            }
            particles.start[slot] = start;
            particles.now[slot] = start;
        }
        for displacements in &mut particles.filtered {
            displacements.fill([0.0; 4]);
        }
        self.regions
            .set_attachments(system, &self.partition, origin);
        self.regions.set_ties(system, &self.partition);
        let iterated = self.settings.iterations > 1;
        for region in self.regions.all_mut() {
            region.begin(iterated);
        }
    }

    /// Sets the velocities of pinned vertices with a prescribed motion, such that they reach their prescribed
    /// positions after `span` (s).
    fn set_prescribed_velocities(&mut self, system: &System, state: &State, span: f64) {
        for grip in &system.prescribed.led {
            let v = grip.vertex as usize;
            if !system.prescribed.pinned[v] {
                continue;
            }
            let target = grip.motion.pose(state.time + span).apply(grip.home);
            let velocity = (target - state.positions[v]) / span;
            let slot = self.partition.slot_of[v] as usize;
            for k in 0..3 {
                self.particles.velocity[slot][k] = velocity[k] as f32;
            }
        }
    }

    /// Stores the particles in the state, with the friction of contacts with solids.
    fn store(&mut self, system: &System, state: &mut State, origin: Vec3) -> XpbdReport {
        let particles = &self.particles;
        let mut fastest = 0f64;
        for (slot, vertex) in self.partition.vertex_of.iter().enumerate() {
            let Some(v) = *vertex else {
                continue;
            };
            let (start, low, velocity) = (
                particles.start[slot],
                particles.low[slot],
                particles.velocity[slot],
            );
            let wide = |p: [f32; 4]| Vec3::new(p[0].into(), p[1].into(), p[2].into());
            if system.prescribed.pinned[v as usize] {
                state.velocities[v as usize] = Vec3::zeros();
                if velocity != [0.0; 4] {
                    state.positions[v as usize] = origin + (wide(start) + wide(low));
                }
                continue;
            }
            state.positions[v as usize] = origin + (wide(start) + wide(low));
            state.velocities[v as usize] = wide(velocity);
            fastest = fastest.max(wide(velocity).norm_squared());
        }
        self.store_friction(state);
        XpbdReport {
            pieces: 1,
            kinetic_energy: state.kinetic_energy(system),
            fastest: fastest.sqrt(),
        }
    }

    /// The vertex of the first particle with a position or velocity that is not finite.
    fn first_not_finite(&self) -> Option<usize> {
        let particles = &self.particles;
        let bad = |p: &[f32; 4]| !(p[0] + p[1] + p[2]).is_finite();
        (particles.start.iter().zip(&particles.velocity))
            .zip(&self.partition.vertex_of)
            .filter(|((x, v), _)| bad(x) || bad(v))
            .find_map(|(_, vertex)| vertex.map(|v| v as usize))
    }

    fn run(&mut self, system: &System, origin: Vec3, motion: &SubstepSize, count: u32) {
        let &SubstepSize { h, drag, time } = motion;
        let kappa = kappa(h, drag);
        let g = system.control.gravity;
        let motion = MotionStep {
            step: h as f32,
            gravity: [g.x as f32, g.y as f32, g.z as f32, 0.0],
            drag_factor: (1.0 / (1.0 + drag * h)) as f32,
            speed_limit: self.settings.speed_limit as f32,
            lead: self.lead(h) as f32,
        };
        let run = Run {
            sweep: SweepStep {
                solid: Solid {
                    system,
                    origin,
                    moving: &self.moving,
                    shares: [0.0, 1.0],
                },
                laws: &self.laws,
                contact: ContactStep::new(kappa as f32, h as f32),
                is_first: false,
                iterated: self.settings.iterations > 1,
                has_bending: self.filter.is_none(),
            },
            motion,
            bounces: system.materials.bounce().then_some(BounceStep {
                step: h as f32,
                gravity: g.norm() as f32,
            }),
            air: self.settings.losses.air(system, h),
            viscosity: self.viscosity.as_ref().map(|(own, filter)| (own, filter)),
            bending: &self.bending,
            filter: self.filter.as_ref(),
            time,
            iterations: self.settings.iterations.max(1),
            samples: &self.built_for.samples,
            domain_starts: &self.domain_starts,
            contact_starts: &self.contact_starts,
            cut_starts: &self.cut_starts,
            arch: pulp::Arch::new(),
        };
        let (regions, particles) = (&mut self.regions, &mut self.particles);
        let divides_contacts = run.sweep.solid.has_surfaces() && self.contact_starts.len() > 2;
        if self.domain_starts.len() <= 2 && !divides_contacts {
            run.substeps(regions, particles, count);
        } else {
            // Within the thread pool: entering it once spares waking its threads in every substep.
            rayon::scope(|_| run.substeps(regions, particles, count));
        }
    }

    /// Time by which positions are extrapolated for the bending force in substeps of h (s); what viscosity damps
    /// already is left out.
    fn lead(&self, h: f64) -> f64 {
        let damped = self
            .viscosity
            .as_ref()
            .map_or(0.0, |(own, _)| own.bending_time);
        (bending::LEAD * h - damped).max(0.0)
    }

    /// Sets up filters and constraints for a size of substep.
    ///
    /// # Errors
    /// Viscosity beyond what the filter damps.
    fn set_step(&mut self, system: &System, h: f64, kappa: f64) -> Result<(), DrapeError> {
        let iterated = self.settings.iterations > 1;
        if self.step != h {
            let bounds = match self.viscosity {
                Some(_) => FilterBounds::BESIDE_VISCOSITY,
                None => FilterBounds::ELASTIC,
            };
            self.filter = match iterated {
                true => None,
                false => {
                    let frequency = h * self.bending.frequency;
                    Filter::new(frequency * frequency, bounds)
                }
            };
            if let Some((viscosity, filter)) = &mut self.viscosity {
                *filter = viscosity.filter(h)?;
            }
            self.step = h;
        }
        if self.filter.is_none() && !self.has_bending_constraints {
            self.regions.add_bending(system, &self.partition);
            self.has_bending_constraints = true;
            self.kappa = f64::NAN;
            for region in self.regions.all_mut() {
                region.begin(iterated);
            }
        }
        if self.kappa != kappa {
            self.kappa = kappa;
            for region in self.regions.all_mut() {
                region.set_step(kappa);
            }
        }
        Ok(())
    }
}

/// Middle of the bounding box of some positions, rounded to an eighth of a metre.
fn middle(positions: &[Vec3]) -> Vec3 {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = Vec3::repeat(f64::NEG_INFINITY);
    for position in positions {
        low = low.inf(position);
        high = high.sup(position);
    }
    if positions.is_empty() {
        return Vec3::zeros();
    }
    ((low + high) * 4.0).map(f64::round) / 8.0
}

/// Size and start of some substeps.
struct SubstepSize {
    /// Substep (s).
    h: f64,
    /// Drag per mass (1/s).
    drag: f64,
    /// Time at the start of the first (s).
    time: f64,
}
