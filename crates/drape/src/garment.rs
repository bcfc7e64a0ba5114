//! A garment's whole way: sewn, merged, draped to rest, from the coarsest mesh of its panels to
//! the finest. One `advance` is one step, so that a command line, a window and a test drive it
//! alike.

use crate::collision::{ClothMemory, Tally};
use crate::kinetic_damping::KineticDamping;
use crate::measure::{Measures, measure};
use crate::merge::merged_layers;
use crate::{
    Carry, Cloth, Collider, ContactSettings, DrapeError, Equilibrium, PseudoTransientContinuation,
    RestSettings, SewRun, SewSettings, State, System, SystemBuilder, Workspace, merge_map,
};
use std::sync::Arc;
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// One mesh of a garment's panels and how it is sewn.
#[derive(Clone, Debug, Default)]
pub struct GarmentLevel {
    /// Panels, not yet merged; the coarsest is placed round the body.
    pub cloth: Cloth,
    /// Vertex pairs the seams join.
    pub stitches: Vec<[u32; 2]>,
    /// Layer of each vertex where several garments are worn, larger numbers farther out; empty for one.
    pub layer: Vec<u16>,
}

/// What a garment's drape is made from.
#[derive(Clone)]
pub struct GarmentSetup {
    /// The same panels ever finer; the last is the garment wanted. Only the first needs to be
    /// placed: the others take over the shape of the one before.
    pub levels: Vec<GarmentLevel>,
    /// Triangles of the last level (one flag each) where strain counts: away from gathers.
    pub counted: Vec<bool>,
    /// The body and other solid surfaces.
    pub colliders: Vec<Arc<SurfaceTree>>,
    /// Contact.
    pub contact: ContactSettings,
    /// Acceleration of gravity [m/s2].
    pub gravity: Vec3,
    /// Sewing.
    pub sew: SewSettings,
    /// The way to rest.
    pub rest: RestSettings,
}

/// Where a garment is on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Elastics draw the panels together.
    Sewing,
    /// The merged garment swings under gravity until it is calm.
    Swinging,
    /// It settles to rest.
    Settling,
    /// At rest.
    Finished,
}

/// How far a garment is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The stage.
    pub stage: Stage,
    /// Steps taken in it.
    pub step: usize,
    /// Largest seam gap [m].
    pub gap: f64,
    /// Net force over weight.
    pub residual: f64,
    /// Rough share of the whole way, 0..=1; only an edit makes it fall.
    pub share: f64,
}

/// A garment being sewn and draped.
pub struct GarmentRun {
    /// The model of the present stage and what acts on it.
    pub system: System,
    /// The state of the present stage.
    pub state: State,
    /// New index of every vertex of the present level's cloth; the identity until merged.
    pub target: Vec<u32>,
    level: usize,
    workspace: Workspace,
    setup: GarmentSetup,
    sew: SewRun,
    swing: Option<KineticDamping>,
    /// Whether crossings of cloth ended the swing before the cloth was calm.
    cut_short: bool,
    /// Swings of this level that are over.
    swings: usize,
    rest: PseudoTransientContinuation,
    stage: Stage,
    gap_before_merging: f64,
    refinements: usize,
    /// Residual below which crossings of the body are looked for next.
    look_below: f64,
    share: f64,
    warnings: Vec<String>,
    /// Steps of sewing and of settling on the levels left behind.
    steps: [usize; 2],
    tally: Tally,
}

/// Net force over weight at which a coarser level is left.
const COARSE_RESIDUAL: f64 = 2e-2;

/// Rounds of finer contact testing before crossings of the body are left and reported.
const MOST_REFINEMENTS: usize = 12;

/// Swings of a level at the most: each begins anew where crossings that had ended one are undone.
const MOST_SWINGS: usize = 3;

/// Residual below which crossings of the body are first looked for, and what the next such residual
/// is of the last: what is found early is cured on the way.
const FIRST_LOOK: f64 = 2.0;
const NEXT_LOOK: f64 = 0.1;

impl GarmentRun {
    /// Prepares the first step.
    ///
    /// # Errors
    /// Meshes and materials that cannot be simulated, a setup without any level.
    pub fn new(mut setup: GarmentSetup) -> Result<Self, DrapeError> {
        let Some(first) = setup.levels.first() else {
            return Err(DrapeError::Scene {
                place: "garment".to_owned(),
                what: "it has no mesh".to_owned(),
                remedy: "give at least one level".to_owned(),
            });
        };
        setup.contact = setup.contact.for_cloth(&first.cloth.materials);
        setup.contact.check_reach("thickness of the fabrics")?;
        let mut builder = SystemBuilder::new("garment", &first.cloth)?;
        builder.colliders = setup.colliders.iter().cloned().map(Collider::new).collect();
        let mut system = builder.build();
        let mut run = Self {
            target: Vec::new(),
            level: 0,
            state: State::default(),
            swing: None,
            cut_short: false,
            swings: 0,
            rest: PseudoTransientContinuation::new(setup.rest),
            sew: SewRun::new(&mut system, Vec::new(), setup.sew),
            workspace: Workspace::default(),
            stage: Stage::Sewing,
            gap_before_merging: 0.0,
            refinements: 0,
            look_below: FIRST_LOOK,
            share: 0.0,
            warnings: Vec::new(),
            steps: [0; 2],
            tally: Tally::default(),
            system,
            setup,
        };
        let placed = run.setup.levels[0].cloth.positions.clone();
        run.begin(0, placed)?;
        Ok(run)
    }

    /// Starts on a level with its panels at some positions; seams that are closed there already
    /// are merged at once.
    fn begin(&mut self, level: usize, positions: Vec<Vec3>) -> Result<(), DrapeError> {
        let GarmentLevel {
            cloth,
            stitches,
            layer,
        } = &self.setup.levels[level];
        let mut builder = SystemBuilder::new("garment", cloth)?;
        builder.colliders = self.system.colliders.to_vec();
        builder.contact = ContactSettings {
            friction: false,
            cloth_offset: 0.0,
            ..self.setup.contact
        };
        builder.control.gravity = Vec3::zeros();
        // Layers pass through each other meanwhile; so most of each comes to lie where it belongs.
        builder.keep_layers_off(layer, self.setup.contact.cloth_offset);
        let mut system = builder.build();
        self.target = (0..positions.len() as u32).collect();
        self.state = State::at_rest(&system, positions);
        self.sew = SewRun::new(&mut system, stitches.clone(), self.setup.sew);
        self.sew.look(&self.state);
        self.level = level;
        self.system = system;
        self.tally = self.cloth_tally();
        self.workspace = Workspace::default();
        self.stage = Stage::Sewing;
        self.rest = PseudoTransientContinuation::new(self.rest_settings());
        self.refinements = 0;
        self.swings = 0;
        self.look_below = FIRST_LOOK;
        if self.sew.closed() {
            self.merge()?;
        }
        Ok(())
    }

    /// Whether the present level is the garment wanted.
    fn is_finest(&self) -> bool {
        self.level + 1 == self.setup.levels.len()
    }

    /// Level of the mesh in hand, and how many there are.
    pub fn level(&self) -> [usize; 2] {
        [self.level, self.setup.levels.len()]
    }

    /// Where it is.
    pub fn progress(&self) -> Progress {
        let sewing = self.stage == Stage::Sewing;
        Progress {
            stage: self.stage,
            step: if sewing {
                self.sew.steps()
            } else {
                self.rest.steps()
            },
            gap: if sewing { self.sew.last_gap() } else { 0.0 },
            residual: self.rest.residual(),
            share: self.share,
        }
    }

    /// Lets a merged garment settle anew, with all the steps of its setup again: for when the
    /// elastics of [`GarmentRun::system`] were changed from outside. While it is sewn nothing
    /// changes.
    pub fn unsettle(&mut self) {
        if matches!(self.stage, Stage::Settling | Stage::Finished) {
            self.stage = Stage::Settling;
            self.warnings.clear();
            let settings = self.rest_settings();
            self.rest.go_on(settings.residual, settings.steps);
        }
    }

    /// Largest seam gap in the step before merging [m].
    pub fn gap_before_merging(&self) -> f64 {
        self.gap_before_merging
    }

    /// Steps of sewing and of settling; the swing is not counted.
    pub fn steps(&self) -> [usize; 2] {
        [
            self.steps[0] + self.sew.steps(),
            self.steps[1] + self.rest.steps(),
        ]
    }

    /// What contact of cloth with cloth found and did in the swings that are over and in settling.
    pub fn cloth_tally(&self) -> Tally {
        self.tally.then(self.workspace.contacts.cloth.tally)
    }

    /// How often the structure of what is solved was worked out for the present stage: once a stage, and for
    /// every other model.
    pub fn structures(&self) -> usize {
        let swing = self.swing.as_ref().map_or(0, KineticDamping::builds);
        swing + self.workspace.structures()
    }

    /// What went less than well, in plain words.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Takes one step.
    ///
    /// # Errors
    /// Seams that do not close, numbers that leave the finite ones, no progress: always with the
    /// last good state kept.
    pub fn advance(&mut self) -> Result<Progress, DrapeError> {
        match self.stage {
            Stage::Sewing => {
                self.sew
                    .advance(&mut self.system, &mut self.state, &mut self.workspace)?;
                let start = 0.3;
                let shown = 0.5 * (1.0 - (self.sew.last_gap() / start).min(1.0));
                self.show(shown);
                if self.sew.closed() {
                    self.merge()?;
                }
            }
            Stage::Swinging => self.swing()?,
            Stage::Settling => self.settle()?,
            Stage::Finished => {}
        }
        Ok(self.progress())
    }

    /// Shows a share of the way on the present level. A level takes about a quarter of the time of the
    /// next.
    fn show(&mut self, share: f64) {
        let after = 4f64.powi(self.level as i32 + 1 - self.setup.levels.len() as i32);
        let before = if self.level == 0 { 0.0 } else { 0.25 * after };
        self.share = self.share.max(before + (after - before) * share);
    }

    fn swing(&mut self) -> Result<(), DrapeError> {
        let system = &self.system;
        let swing = (self.swing).get_or_insert_with(|| match self.level {
            0 => KineticDamping::new(system),
            _ => KineticDamping::carried(system),
        });
        swing.advance(&self.system, &mut self.state)?;
        let shown = 0.5 + 0.2 * swing.share();
        if swing.finished() {
            self.cut_short = swing.left_crossings();
            self.tally = self.tally.then(swing.cloth_tally());
            self.swing = None;
            self.swings += 1;
            self.stage = Stage::Settling;
        }
        self.show(shown);
        Ok(())
    }

    fn settle(&mut self) -> Result<(), DrapeError> {
        self.rest
            .advance(&self.system, &mut self.state, &mut self.workspace)?;
        if self.cut_short && self.workspace.contacts.cloth.is_in_order() {
            self.cut_short = false;
            if self.swings < MOST_SWINGS {
                self.steps[1] += self.rest.steps();
                self.rest = PseudoTransientContinuation::near(self.rest_settings());
                let cloth = &mut self.workspace.contacts.cloth;
                self.tally = self.tally.then(std::mem::take(&mut cloth.tally));
                self.state.cloth = ClothMemory::default();
                self.stage = Stage::Swinging;
                return Ok(());
            }
        }
        let decades = (1.0 / self.rest.residual().max(1e-9)).log10() / 3.0;
        self.show((0.7 + 0.3 * decades.clamp(0.0, 1.0)).min(0.99));
        let finished = self.rest.finished();
        if !self.is_finest() {
            return if finished { self.refine() } else { Ok(()) };
        }
        if finished || self.rest.residual() < self.look_below {
            self.look_below = NEXT_LOOK * self.rest.residual();
            if self.keep_off_the_body() && finished {
                self.rest
                    .go_on(self.setup.rest.residual, self.setup.rest.steps / 4);
                return Ok(());
            }
        }
        if !finished {
            return Ok(());
        }
        if self.rest.residual() > self.setup.rest.residual {
            self.warnings.push(format!(
                "the drape stopped after {} steps with net force {:.1e} of the weight, above the {:.1e} asked for",
                self.rest.steps(),
                self.rest.residual(),
                self.setup.rest.residual
            ));
        }
        self.stage = Stage::Finished;
        self.share = 1.0;
        Ok(())
    }

    /// Tests contact more finely where cloth crosses the body; whether it does so anywhere.
    fn keep_off_the_body(&mut self) -> bool {
        let offenders = self.body_crossings();
        if offenders.is_empty() || self.refinements >= MOST_REFINEMENTS {
            return false;
        }
        self.refinements += 1;
        for triangle in offenders {
            self.state.refine_contact(&self.system, triangle);
        }
        true
    }

    /// Goes on to the next finer level with the shape reached.
    fn refine(&mut self) -> Result<(), DrapeError> {
        let [coarse, fine] = [0, 1].map(|k| &self.setup.levels[self.level + k].cloth);
        let shape = TriangleMesh {
            positions: self.state.positions.clone(),
            triangles: coarse
                .triangles
                .iter()
                .map(|t| t.map(|v| self.target[v as usize]))
                .collect(),
        };
        let carried = Carry::new(coarse, fine)?.apply(&shape);
        self.steps = self.steps();
        self.begin(self.level + 1, carried)
    }

    /// Cloth triangles that cross a solid surface, exactly.
    fn body_crossings(&self) -> Vec<u32> {
        let mesh = self.system.mesh(&self.state.positions);
        let mut crossing: Vec<u32> = Vec::new();
        for collider in self.system.colliders.iter() {
            let pairs = collider.crossings(self.state.time, &mesh);
            crossing.extend(pairs.iter().map(|pair| pair[0]));
        }
        crossing.sort_unstable();
        crossing.dedup();
        crossing
    }

    /// Joins the stitched vertices; gravity and friction act from here on.
    fn merge(&mut self) -> Result<(), DrapeError> {
        let GarmentLevel {
            cloth,
            stitches,
            layer,
        } = &self.setup.levels[self.level];
        let placed = Cloth {
            positions: self.state.positions.clone(),
            ..cloth.clone()
        };
        let pairs = stitches.iter().copied();
        let (target, count) = merge_map(placed.positions.len(), pairs);
        let merged = placed.merged(&target, count);
        let mut builder = SystemBuilder::new("garment", &merged)?;
        builder.colliders = self.system.colliders.to_vec();
        builder.contact = self.setup.contact;
        builder.control.gravity = self.setup.gravity;
        builder.layer = merged_layers(layer, &target, count);
        let system = builder.build();
        self.state = State::at_rest(&system, merged.positions);
        self.system = system;
        self.target = target;
        self.workspace = Workspace::default();
        self.gap_before_merging = self.sew.last_gap();
        self.swing = None;
        self.rest = PseudoTransientContinuation::near(self.rest_settings());
        self.stage = Stage::Swinging;
        self.show(0.5);
        Ok(())
    }

    /// The garment at rest, to be predicted and corrected under other rest shapes; nothing before it is
    /// [`Stage::Finished`].
    pub fn into_equilibrium(self) -> Option<Equilibrium> {
        let finished = self.stage == Stage::Finished;
        finished.then(|| {
            let cloth = &self.setup.levels[self.level].cloth;
            Equilibrium {
                merged: cloth.merged_triangles(&self.target),
                settings: self.setup.rest,
                system: self.system,
                state: self.state,
                workspace: self.workspace,
                continuation: self.rest,
            }
        })
    }

    /// The way to rest on the present level: a coarser one is left when its large motion is over.
    fn rest_settings(&self) -> RestSettings {
        let settings = self.setup.rest;
        if self.is_finest() {
            settings
        } else {
            RestSettings {
                residual: settings.residual.max(COARSE_RESIDUAL),
                ..settings
            }
        }
    }

    /// Measures the present state. Strain counts only where the setup says so.
    pub fn measure(&mut self) -> Measures {
        let counted = if self.system.topology.triangles.len() == self.setup.counted.len() {
            self.setup.counted.clone()
        } else {
            Vec::new()
        };
        measure(&self.system, &self.state, &mut self.workspace, &counted)
    }

    /// Whether an edit of the pattern can be taken: the finest mesh is in hand and its seams are closed.
    pub fn takes_edits(&self) -> bool {
        self.is_finest() && self.stage != Stage::Sewing
    }

    /// Gives the triangles of the finest mesh other rest shapes, and those where strain counts. The cloth
    /// goes on from where it hangs, without velocity; contact samples keep where they stick.
    ///
    /// # Errors
    /// While it is sewn or on a coarser mesh; shapes that are too few, too many or without area. The garment
    /// is then as it was.
    pub fn reshape(&mut self, rest: Vec<[Vec2; 3]>, counted: Vec<bool>) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        let level = &self.setup.levels[self.level];
        let [given, wanted] = [rest.len(), level.cloth.triangles.len()];
        if given != wanted {
            return Err(DrapeError::Scene {
                place: "the edited garment".to_owned(),
                what: format!("it has {given} rest shapes for {wanted} triangles"),
                remedy: "give one for each, or mesh it again".to_owned(),
            });
        }
        let merged = level.cloth.merged_triangles(&self.target);
        let merged = merged.into_iter().map(|t| rest[t]).collect();
        match self.system.reshaped("garment", merged) {
            Ok(system) => {
                self.state.follow_shapes(&system);
                self.system = system;
            }
            // The triangles serve, but not with what curvatures were estimated from.
            Err(DrapeError::NeedsRemesh { .. }) => self.rebuild(rest.clone())?,
            Err(error) => return Err(error),
        }
        self.setup.levels[self.level].cloth.rest = rest;
        self.setup.counted = counted;
        self.steps[1] += self.rest.steps();
        self.rest = PseudoTransientContinuation::near(self.rest_settings());
        self.swing = None;
        self.go_on_from_here();
        Ok(())
    }

    /// Makes the system of the merged cloth anew with other rest shapes for its panels, where it lies.
    fn rebuild(&mut self, rest: Vec<[Vec2; 3]>) -> Result<(), DrapeError> {
        let count = self.state.positions.len();
        let place = |&v: &u32| self.state.positions[v as usize];
        let cloth = Cloth {
            positions: self.target.iter().map(place).collect(),
            rest,
            ..self.setup.levels[self.level].cloth.clone()
        };
        let mut builder = SystemBuilder::new("garment", &cloth.merged(&self.target, count))?;
        builder.colliders = self.system.colliders.to_vec();
        builder.contact = self.system.contact;
        builder.control = self.system.control.clone();
        builder.layer = self.system.layer.to_vec();
        let system = builder.build();
        let state = State::at_rest(&system, std::mem::take(&mut self.state.positions));
        self.state = State {
            time: self.state.time,
            ..state
        };
        self.tally = self.cloth_tally();
        self.workspace = Workspace::default();
        self.system = system;
        Ok(())
    }

    /// Puts another mesh of the same panels in the place of the finest one, and those of its triangles where
    /// strain counts. It takes over the shape by place in the panels; seams that are closed there are merged
    /// at once, others are sewn from there. Where cloth stuck and what strain it kept is let go.
    ///
    /// # Errors
    /// While it is sewn or on a coarser mesh; a mesh that cannot be simulated or has other panels. The
    /// garment is then as it was.
    pub fn remesh(&mut self, level: GarmentLevel, counted: Vec<bool>) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        System::new("garment", &level.cloth)?;
        let old = &self.setup.levels[self.level].cloth;
        let merged = |t: &[u32; 3]| t.map(|v| self.target[v as usize]);
        let shape = TriangleMesh {
            positions: self.state.positions.clone(),
            triangles: old.triangles.iter().map(merged).collect(),
        };
        let carried = Carry::new(old, &level.cloth)?.apply(&shape);
        self.steps = self.steps();
        self.setup.levels[self.level] = level;
        self.setup.counted = counted;
        self.begin(self.level, carried)?;
        self.go_on_from_here();
        Ok(())
    }

    fn refuse_edit(&self) -> Result<(), DrapeError> {
        let what = match self.stage {
            _ if self.takes_edits() => return Ok(()),
            Stage::Sewing => "it is still being sewn",
            _ => "it still hangs on a coarser mesh",
        };
        Err(DrapeError::Scene {
            place: "the edited garment".to_owned(),
            what: what.to_owned(),
            remedy: "edit it once the seams of its finest mesh are closed".to_owned(),
        })
    }

    /// What was done to bring the garment to rest is to be done again; the share of the way falls.
    fn go_on_from_here(&mut self) {
        if matches!(self.stage, Stage::Finished) {
            self.stage = Stage::Settling;
        }
        self.cut_short = false;
        (self.swings, self.refinements) = (0, 0);
        self.look_below = FIRST_LOOK;
        self.warnings.clear();
        self.share = match self.stage {
            Stage::Sewing => 0.0,
            Stage::Swinging => 0.5,
            Stage::Settling | Stage::Finished => 0.7,
        };
    }
}
