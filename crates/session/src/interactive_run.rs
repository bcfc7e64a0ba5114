//! A garment's run with vertices dragged by the user; each input carries the number of its step.

use crate::rest_change::RestChange;
use crate::{GarmentJob, SessionError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_drape::laws::elastic::ElasticLaw;
use toile_drape::{Attachment, Carry, Cloth, DrapeError, GarmentRun, Progress, Stage};
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// Something done to cloth while it is draped. Vertices are those of the job's garment, before
/// seams are merged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "input")]
pub enum LiveInput {
    /// An elastic draws a vertex to a place from now on; one that is held already, to this place.
    Drag {
        /// The vertex.
        vertex: u32,
        /// The place [m].
        to: [f64; 3],
    },
    /// The vertex is let go.
    Release {
        /// The vertex.
        vertex: u32,
    },
}

/// An input and when it applies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StampedInput {
    /// Steps taken before it.
    pub step: u64,
    /// What is done.
    #[serde(flatten)]
    pub input: LiveInput,
}

/// The pull of a hand: 5 N, some times the weight of a garment, from 5 cm on.
const HAND: ElasticLaw = ElasticLaw {
    stiffness: 100.0,
    largest_force: 5.0,
};

/// Farthest place cloth may be drawn to, along each axis [m]: no room is larger.
const FARTHEST: f64 = 100.0;

impl LiveInput {
    /// The vertex it concerns.
    pub fn vertex(&self) -> u32 {
        match *self {
            Self::Drag { vertex, .. } | Self::Release { vertex } => vertex,
        }
    }

    /// Refuses vertices and places that are not there.
    pub(crate) fn check(&self, job: &GarmentJob) -> Result<(), SessionError> {
        let count = job.garment.positions.len();
        let vertex = self.vertex();
        if vertex as usize >= count {
            return Err(SessionError::Unknown {
                kind: "vertex",
                name: vertex.to_string(),
                hint: format!("the garment has {count}, counted from 0"),
            });
        }
        let corners = job.garment.triangles.iter().flatten();
        if !corners.into_iter().any(|&corner| corner == vertex) {
            return Err(SessionError::Unknown {
                kind: "vertex",
                name: vertex.to_string(),
                hint: "it is in no triangle; take hold of one of the cloth".to_owned(),
            });
        }
        let places = match self {
            Self::Drag { to, .. } => to.as_slice(),
            Self::Release { .. } => &[],
        };
        match places.iter().find(|x| x.is_nan() || x.abs() > FARTHEST) {
            Some(&value) => Err(SessionError::Number {
                what: "a coordinate of the place cloth is drawn to [m]",
                value,
                hint: "give a place within 100 m",
            }),
            None => Ok(()),
        }
    }
}

/// A garment being sewn and draped, with inputs applied at their steps.
pub(crate) struct InteractiveRun {
    job: GarmentJob,
    run: GarmentRun,
    /// From the mesh of a level to the garment's.
    carry: Option<(usize, Carry)>,
    /// Where each held vertex is drawn to.
    held: BTreeMap<u32, Vec3>,
    /// Inputs to come, by step; those of one step in the order given.
    waiting: BTreeMap<u64, Vec<LiveInput>>,
    /// Inputs that were applied.
    applied: Vec<StampedInput>,
    steps: u64,
}

impl InteractiveRun {
    /// Prepares the first step.
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

    /// Takes an input for after `step` steps; for the next step if that is past or not said.
    pub fn give(&mut self, input: LiveInput, step: Option<u64>) {
        let step = step.unwrap_or(0).max(self.steps);
        self.waiting.entry(step).or_default().push(input);
    }

    /// What it is made from, and the garment.
    pub fn parts(&mut self) -> (&GarmentJob, &mut GarmentRun) {
        (&self.job, &mut self.run)
    }

    /// Whether an edit of the pattern can be taken.
    pub fn takes_edits(&self) -> bool {
        self.run.takes_edits()
    }

    /// Goes on to what an edit of the pattern asks for, from where it hangs. On a new mesh the hands let
    /// go.
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

    /// The inputs applied so far.
    pub fn applied(&self) -> &[StampedInput] {
        &self.applied
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Whether it hangs at rest and nothing is to come.
    pub fn at_rest(&self) -> bool {
        self.run.progress().stage == Stage::Finished && self.waiting.is_empty()
    }

    /// Whether a hand is on the cloth.
    pub fn is_held(&self) -> bool {
        !self.held.is_empty()
    }

    /// Applies the inputs that are due and takes one step. At rest no time passes: what is to
    /// come next is due then.
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

    /// Applies inputs of one step: of each vertex only the newest, as if the others had not been.
    /// Says whether anything changed.
    fn apply(&mut self, inputs: Vec<LiveInput>) -> bool {
        let newest: BTreeMap<u32, LiveInput> = inputs
            .into_iter()
            .map(|input| (input.vertex(), input))
            .collect();
        let mut changed = false;
        for (vertex, input) in newest {
            let before = self.held.get(&vertex).copied();
            let after = match input {
                LiveInput::Drag { to, .. } => Some(Vec3::from(to)),
                LiveInput::Release { .. } => None,
            };
            if before == after {
                continue;
            }
            match after {
                Some(place) => self.held.insert(vertex, place),
                None => self.held.remove(&vertex),
            };
            let step = self.steps;
            self.applied.push(StampedInput { step, input });
            changed = true;
        }
        changed
    }

    /// Draws the held vertices where the hands are.
    fn pull(&mut self) -> Result<(), DrapeError> {
        let mut attachments = Vec::with_capacity(self.held.len());
        for (&vertex, &place) in &self.held {
            let handle = self.handle(vertex)?;
            attachments.push(Attachment {
                vertex: self.run.target()[handle as usize],
                place,
                law: HAND,
            });
        }
        self.run.control_mut().attachments = attachments.into_iter().collect();
        Ok(())
    }

    /// The vertex of the mesh in hand that stands for one of the garment: the same on the finest
    /// mesh, the nearest of its panel on a coarser one.
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

    /// The garment as it lies: positions [m] and, for every vertex of the job's garment, its
    /// index among them. While a coarser mesh is in hand, its shape carried to the garment's.
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

/// Every corner of every triangle of a cloth: its vertex, panel and place at rest [m].
fn corners(cloth: &Cloth) -> impl Iterator<Item = (u32, u32, Vec2)> + '_ {
    let triangles = cloth.triangles.iter().zip(&cloth.panel).zip(&cloth.rest);
    triangles.flat_map(|((vertices, &panel), rest)| {
        vertices
            .iter()
            .zip(rest)
            .map(move |(&v, &at)| (v, panel, at))
    })
}
