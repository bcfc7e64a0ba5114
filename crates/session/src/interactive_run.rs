//! A garment's run with vertices dragged by the user; each input carries the number of its step.
//!
//! # Decided with
//! - [`crate::live::LiveRun::give`], [`crate::command::Command`]: hands given live, and by a journal;
//! - [`crate::interactive_run::check_action`], [`crate::interactive_run::InteractiveRun::apply`],
//!   [`crate::interactive_run::InteractiveRun::pull`]: checked, applied, held;
//! - [`toile_drape::Attachments`], [`toile_drape::Action`]: how a hand pulls; what can be done;
//! - [`toile_drape::GarmentRun::control_mut`]: settling begun again.
//!
//! Attachments pull in crate `drape`: `system.rs`, `xpbd/region.rs`, `patches/patch.rs`, `submodel.rs`. The
//! window gives no hand yet.

use crate::rest_change::RestChange;
use crate::{GarmentJob, SessionError};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use toile_drape::laws::elastic::ElasticLaw;
use toile_drape::{
    Action, Attachment, Carry, Cloth, DrapeError, FARTHEST_PULL, GarmentRun, HAND_FORCE,
    HAND_STIFFNESS, Input, MeshVertex, ObjectId, Progress, SceneObject, Spot, Stage,
};
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// Id of the garment, which is the only cloth among the objects.
fn garment() -> ObjectId {
    SceneObject::id(0)
}

/// Action of a hand that draws a vertex of a garment to a place (m) with the usual force. Vertices are
/// numbered before seams are merged.
pub fn pull_vertex(vertex: u32, to: [f64; 3]) -> Action {
    Action::Pull {
        spot: vertex_spot(vertex),
        to: Vec3::from(to),
        force: HAND_FORCE,
    }
}

/// Action of a hand that lets go of a vertex of a garment.
pub fn let_go_of_vertex(vertex: u32) -> Action {
    Action::LetGo(vertex_spot(vertex))
}

fn vertex_spot(vertex: u32) -> Spot {
    Spot::Vertex(MeshVertex {
        object: garment(),
        vertex,
    })
}

/// Action of a hand on a garment: the vertex held, and place (m) and force (N) of the pull; `None` to let go.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HandInput {
    vertex: u32,
    pull: Option<(Vec3, f64)>,
}

impl HandInput {
    /// Reads an action; `None` if a garment does not take such an action.
    fn of(action: &Action) -> Option<Self> {
        let (spot, pull) = match action {
            Action::Pull { spot, to, force } => (spot, Some((*to, *force))),
            Action::LetGo(spot) => (spot, None),
            Action::Edit(_) | Action::Set(_) => return None,
        };
        match spot {
            Spot::Vertex(vertex) if vertex.object == garment() => Some(Self {
                vertex: vertex.vertex,
                pull,
            }),
            Spot::Vertex(_) | Spot::Triangle { .. } => None,
        }
    }
}

/// Refuses actions that a garment does not take, unknown vertices, and places and forces out of range.
///
/// # Errors
/// The fault and its remedy.
pub(crate) fn check_action(action: &Action, job: &GarmentJob) -> Result<(), SessionError> {
    let Some(HandInput { vertex, pull }) = HandInput::of(action) else {
        let what = "a garment takes hands on its vertices alone; edit its pattern for all else";
        return Err(SessionError::Conflict(what.to_owned()));
    };
    let unknown = |hint: String| {
        Err(SessionError::Unknown {
            kind: "vertex",
            name: vertex.to_string(),
            hint,
        })
    };
    let count = job.garment.positions.len();
    if vertex as usize >= count {
        return unknown(format!("the garment has {count}, counted from 0"));
    }
    let mut corners = job.garment.triangles.iter().flatten();
    if !corners.any(|&corner| corner == vertex) {
        return unknown("it is in no triangle; take hold of one of the cloth".to_owned());
    }
    let Some((to, force)) = pull else {
        return Ok(());
    };
    if let Some(&value) = to.iter().find(|x| x.is_nan() || x.abs() > FARTHEST_PULL) {
        return Err(SessionError::Number {
            what: "a coordinate of the place cloth is drawn to [m]",
            value,
            hint: "give a place within 100 m",
        });
    }
    match force >= 0.0 {
        true => Ok(()),
        false => Err(SessionError::Number {
            what: "the force of a hand [N]",
            value: force,
            hint: "give 0 N or more",
        }),
    }
}

/// Reads the inputs of a journal: in the present form, or by vertex as in the older form without actions.
///
/// # Errors
/// An input of neither form.
pub(crate) fn read_inputs<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Input>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Input(Input),
        Vertex(VertexInput),
    }
    #[derive(Deserialize)]
    #[serde(rename_all = "snake_case", tag = "input")]
    enum VertexInput {
        Drag {
            step: u64,
            vertex: u32,
            to: [f64; 3],
        },
        Release {
            step: u64,
            vertex: u32,
        },
    }
    let written = Vec::<Written>::deserialize(from)?;
    let read = written.into_iter().map(|written| match written {
        Written::Input(input) => input,
        Written::Vertex(VertexInput::Drag { step, vertex, to }) => Input {
            step,
            action: pull_vertex(vertex, to),
        },
        Written::Vertex(VertexInput::Release { step, vertex }) => Input {
            step,
            action: let_go_of_vertex(vertex),
        },
    });
    Ok(read.collect())
}

/// A garment being sewn and draped, with inputs applied at their steps.
pub(crate) struct InteractiveRun {
    job: GarmentJob,
    run: GarmentRun,
    /// Number of a coarse mesh level, and the map that carries its shape over to the mesh of the garment;
    /// kept for the next frame.
    carry: Option<(usize, Carry)>,
    /// Place (m) and force (N) of the pull on each held vertex.
    held: BTreeMap<u32, (Vec3, f64)>,
    /// Pending actions by step; actions of one step are in the order given.
    waiting: BTreeMap<u64, Vec<Action>>,
    /// Inputs that were applied.
    applied: Vec<Input>,
    steps: u64,
}

impl InteractiveRun {
    /// A run before its first step.
    pub fn new(job: GarmentJob) -> Result<Self, DrapeError> {
        Ok(Self {
            run: GarmentRun::new(job.setup.clone())?,
            job,
            carry: None,
            held: BTreeMap::new(),
            waiting: BTreeMap::new(),
            applied: Vec::new(),
            steps: 0,
        })
    }

    /// Queues an action to be applied after `step` steps; before the next step if `step` is past or `None`.
    pub fn give(&mut self, action: Action, step: Option<u64>) {
        let step = step.unwrap_or(0).max(self.steps);
        self.waiting.entry(step).or_default().push(action);
    }

    /// The job that the run is made from, and the run of the garment.
    pub fn parts(&mut self) -> (&GarmentJob, &mut GarmentRun) {
        (&self.job, &mut self.run)
    }

    /// Whether an edit of the pattern can be taken.
    pub fn takes_edits(&self) -> bool {
        self.run.takes_edits()
    }

    /// Goes on with the garment after an edit, from its present position. On a new mesh the hands let go.
    pub fn edit(&mut self, job: GarmentJob, change: RestChange) -> Result<Progress, DrapeError> {
        let finest = |job: &GarmentJob| job.setup.levels.last().cloned().unwrap_or_default();
        let (old, new) = (finest(&self.job), finest(&job));
        let counted = job.setup.counted.clone();
        match change {
            RestChange::Nothing => {}
            // Only lines drawn on the cloth or allowances changed: the rest shapes are the same.
            RestChange::Shapes if old.cloth.rest == new.cloth.rest => {}
            RestChange::Shapes => self.run.reshape(new.cloth.rest, counted)?,
            RestChange::Mesh => {
                self.run.remesh(new, counted)?;
                self.held.clear();
                self.waiting.clear();
            }
        }
        self.job = job;
        if self.is_held() {
            self.pull()?;
        }
        Ok(self.run.progress())
    }

    /// The inputs applied so far, each with its step.
    pub fn applied(&self) -> &[Input] {
        &self.applied
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Whether the garment hangs at rest and no action is pending.
    pub fn at_rest(&self) -> bool {
        self.run.progress().stage == Stage::Finished && self.waiting.is_empty()
    }

    /// Whether a hand is on the cloth.
    pub fn is_held(&self) -> bool {
        !self.held.is_empty()
    }

    /// Applies the actions that are due and takes one step. At rest no time passes: the next
    /// pending actions are due at once.
    pub fn advance(&mut self) -> Result<Progress, DrapeError> {
        let at_rest = self.run.progress().stage == Stage::Finished;
        let first = self.waiting.keys().next().copied();
        let due = first.filter(|&step| step <= self.steps || at_rest);
        let inputs = due.and_then(|step| self.waiting.remove(&step));
        let changed = self.apply(inputs.unwrap_or_default());
        if changed {
            self.run.unsettle();
        } else if at_rest {
            return Ok(self.run.progress());
        }
        if changed || self.is_held() {
            self.pull()?;
        }
        let progress = self.run.advance()?;
        self.steps += 1;
        Ok(progress)
    }

    /// Applies actions of one step: for each vertex only the newest, as if the others had not been given.
    /// Returns whether anything changed.
    fn apply(&mut self, actions: Vec<Action>) -> bool {
        let hands = actions
            .into_iter()
            .filter_map(|action| Some((HandInput::of(&action)?, action)));
        let newest: BTreeMap<u32, (HandInput, Action)> =
            hands.map(|hand| (hand.0.vertex, hand)).collect();
        let mut changed = false;
        for (vertex, (HandInput { pull, .. }, action)) in newest {
            let before = match pull {
                Some(pull) => self.held.insert(vertex, pull),
                None => self.held.remove(&vertex),
            };
            if before == pull {
                continue;
            }
            let step = self.steps;
            self.applied.push(Input { step, action });
            changed = true;
        }
        changed
    }

    /// Attaches the held vertices to the places of the hands.
    fn pull(&mut self) -> Result<(), DrapeError> {
        let mut attachments = Vec::with_capacity(self.held.len());
        for (&vertex, &(place, largest_force)) in &self.held {
            let handle = self.handle(vertex)?;
            attachments.push(Attachment {
                vertex: self.run.target()[handle as usize],
                place,
                law: ElasticLaw {
                    stiffness: HAND_STIFFNESS,
                    largest_force,
                },
            });
        }
        self.run.control_mut().attachments = attachments.into_iter().collect();
        Ok(())
    }

    /// The vertex of the present mesh that stands for a vertex of the garment: the same on the
    /// finest mesh, the nearest of its panel on a coarser one.
    fn handle(&self, vertex: u32) -> Result<u32, DrapeError> {
        let levels = &self.job.setup.levels;
        let [level, count] = self.run.level();
        if level + 1 == count {
            return Ok(vertex);
        }
        let unknown = || DrapeError::Scene {
            place: format!("the hand on vertex {vertex}"),
            what: "the mesh in hand has no cloth there".to_owned(),
            remedy: "take hold of a vertex of a panel's cloth".to_owned(),
        };
        let (coarse, fine) = (&levels[level].cloth, &levels[count - 1].cloth);
        let (_, panel, at) = corners(fine).find(|c| c.0 == vertex).ok_or_else(unknown)?;
        let near = corners(coarse)
            .filter(|corner| corner.1 == panel)
            .min_by(|a, b| {
                (a.2 - at)
                    .norm_squared()
                    .total_cmp(&(b.2 - at).norm_squared())
            });
        near.map(|corner| corner.0).ok_or_else(unknown)
    }

    /// Present shape of the garment: positions (m) and, for every vertex of the job's garment, its
    /// index among them. The shape of a coarser mesh is carried over to the mesh of the garment.
    pub fn shape(&mut self) -> Result<(Vec<Vec3>, Vec<u32>), DrapeError> {
        let levels = &self.job.setup.levels;
        let [level, count] = self.run.level();
        if level + 1 == count {
            return Ok((self.run.state.positions.clone(), self.run.target().to_vec()));
        }
        let (coarse, fine) = (&levels[level].cloth, &levels[count - 1].cloth);
        let joined = |t: &[u32; 3]| t.map(|v| self.run.target()[v as usize]);
        let shape = TriangleMesh {
            positions: self.run.state.positions.clone(),
            triangles: coarse.triangles.iter().map(joined).collect(),
        };
        let carry = match self.carry.take() {
            Some((of, carry)) if of == level => carry,
            _ => Carry::new(coarse, fine)?,
        };
        let positions = carry.apply(&shape);
        self.carry = Some((level, carry));
        let target = (0..positions.len() as u32).collect();
        Ok((positions, target))
    }
}

/// Every corner of every triangle of a cloth: its vertex, panel and place at rest (m).
fn corners(cloth: &Cloth) -> impl Iterator<Item = (u32, u32, Vec2)> + '_ {
    let triangles = cloth.triangles.iter().zip(&cloth.panel).zip(&cloth.rest);
    triangles.flat_map(|((vertices, &panel), rest)| {
        vertices
            .iter()
            .zip(rest)
            .map(move |(&v, &at)| (v, panel, at))
    })
}
