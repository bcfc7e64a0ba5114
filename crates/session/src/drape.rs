//! Drapes a garment from its setup to rest, and summarises the result.

use crate::interactive_run::{InteractiveRun, check_action};
use crate::stuck::stuck;
use crate::watcher::report_progress;
use crate::{Draped, Event, GarmentJob, SessionError, Watcher, verdict};
use std::sync::Arc;
use toile_drape::collision::Tally;
use toile_drape::{
    DrapeError, Input, Measures, Stage, Verdict, keeps_corners, stretch_per_triangle,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A garment sewn and draped.
pub(crate) struct Drape {
    /// Job that the drape was made from.
    pub job: GarmentJob,
    /// Mesh of the garment as it hangs, with merged seams.
    pub mesh: TriangleMesh,
    /// Vertex of `mesh` for every vertex of the job's garment.
    pub target: Vec<u32>,
    /// Triangle of the job's garment for every triangle of `mesh`.
    pub origin: Vec<u32>,
    /// Stretch of every triangle of `mesh`: the larger of its stretch along warp and along weft (1).
    pub stretch: Vec<f64>,
    pub measures: Measures,
    /// Number of steps of sewing and of settling.
    pub steps: [usize; 2],
    /// Largest seam gap in the step before merging (m).
    pub seam_gap: f64,
    /// Counts of the contact of cloth with cloth.
    pub tally: Tally,
    /// Verdict on the drape.
    pub verdict: Verdict,
    /// Warnings: the words of the verdict, and whether a hand is still on the cloth.
    pub warnings: Vec<String>,
    /// Actions on the cloth, each with the step at which it was applied.
    pub inputs: Vec<Input>,
}

impl Drape {
    /// Result of a run, at rest or where the run stopped.
    pub fn of(handled: &mut InteractiveRun) -> Self {
        let held = handled.is_held();
        let inputs = handled.applied().to_vec();
        let (job, run) = handled.parts();
        let measures = run.measure();
        let stuck = stuck(job, run);
        let mesh = run.system.mesh(&run.state.positions);
        let origin = (0..job.garment.triangles.len() as u32)
            .filter(|&t| keeps_corners(job.garment.triangles[t as usize], run.target()))
            .collect();
        let mut verdict = verdict::of_garment(job, run, &measures);
        verdict.extend(stuck);
        let mut warnings: Vec<String> = verdict.words().map(str::to_owned).collect();
        if held {
            warnings.push("the cloth is still held; let go of it to see how it hangs".to_owned());
        }
        Self {
            stretch: stretch_per_triangle(&run.system, &run.state.positions),
            steps: run.steps(),
            seam_gap: match run.progress().stage {
                Stage::Sewing => run.progress().gap,
                Stage::Swinging | Stage::Settling | Stage::Finished => run.gap_before_merging(),
            },
            tally: run.cloth_tally(),
            target: run.target().to_vec(),
            job: job.clone(),
            mesh,
            origin,
            measures,
            verdict,
            warnings,
            inputs,
        }
    }

    /// Unit normals of the merged vertices.
    pub fn normals(&self) -> Vec<Vec3> {
        self.mesh.vertex_normals()
    }

    /// Pairs of merged vertices that lie on a seam: edges of the outline of a piece that have cloth
    /// on both sides now.
    pub fn seam_edges(&self) -> Vec<[u32; 2]> {
        let apart = TriangleMesh {
            positions: self.job.garment.positions.clone(),
            triangles: self.job.garment.triangles.clone(),
        };
        let (before, after) = (apart.topology(), self.mesh.topology());
        let mut pairs: Vec<[u32; 2]> = before
            .boundary()
            .filter_map(|edge| {
                let [a, b] = before.edges[edge].map(|v| self.target[v as usize]);
                let merged = after.edge(a, b)?;
                (after.edge_triangles[merged].len() > 1).then_some([a.min(b), a.max(b)])
            })
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Events that report the drape: its summary and its warnings.
    pub fn events(&self) -> Vec<Event> {
        let mut events = vec![Event::Draped(self.summary())];
        events.extend(Event::warnings(&self.warnings));
        events
    }

    /// Summary of the drape in a few numbers.
    pub fn summary(&self) -> Draped {
        Draped {
            steps: self.steps,
            residual: self.measures.residual,
            seam_gap: self.seam_gap,
            components: self.mesh.component_count(),
            body_intersections: self.measures.body_intersections,
            strain_max: self.measures.strain_max,
            strain_p99: self.measures.strain_p99,
            verdict: self.verdict.clone(),
        }
    }
}

/// A garment draped by a [`crate::LiveRun`], for the session it came from:
/// [`crate::Session::adopt_drape`].
#[derive(Clone)]
pub struct DrapeResult {
    pub(crate) drape: Arc<Drape>,
    /// Wall time of its steps, without pauses (s).
    pub(crate) seconds: f64,
}

impl DrapeResult {
    /// Revision of the session that the garment was made from.
    pub fn revision(&self) -> u64 {
        self.drape.job.revision
    }

    /// Summary of the drape in a few numbers.
    pub fn summary(&self) -> Draped {
        self.drape.summary()
    }

    /// Mesh of the garment as it hangs, with merged seams.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.drape.mesh
    }

    /// Actions on the cloth, each with the step at which it was applied.
    pub fn inputs(&self) -> &[Input] {
        &self.drape.inputs
    }
}

/// Sews, merges and drapes a garment to rest.
pub(crate) fn drape(
    job: GarmentJob,
    inputs: &[Input],
    watcher: &mut dyn Watcher,
) -> Result<Drape, SessionError> {
    report_progress(watcher, "sewing", 0.0, "")?;
    for input in inputs {
        check_action(&input.action, &job)?;
    }
    let mut run = InteractiveRun::new(job)?;
    for input in inputs {
        run.give(input.action.clone(), Some(input.step));
    }
    loop {
        let progress = match run.advance() {
            // The state so far helps to see why the seams stay open.
            Err(DrapeError::SeamsOpen { .. }) => break,
            advanced => advanced?,
        };
        let (stage, detail) = match progress.stage {
            Stage::Sewing => ("sewing", format!("gap {:.1} mm", progress.gap * 1e3)),
            Stage::Swinging => ("draping", "swinging".to_owned()),
            Stage::Settling => ("draping", format!("net force {:.1e}", progress.residual)),
            Stage::Finished => ("measuring", String::new()),
        };
        report_progress(watcher, stage, 0.98 * progress.share, &detail)?;
        if run.at_rest() {
            break;
        }
    }
    Ok(Drape::of(&mut run))
}
