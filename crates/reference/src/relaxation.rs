//! Dynamic relaxation: equilibrium by undamped motion that is stopped at every peak of the kinetic energy.

use toile_drape::laws::membrane::Curvature;
use toile_drape::methods::explicit::forces_and_update_friction;
use toile_drape::{
    DrapeError, Inertia, Memory, Method, MethodSettings, RelaxationMemory, State, StepReport,
    System, Workspace, weight_norm,
};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Dynamic relaxation with kinetic damping (Day 1965; Cundall 1976; Barnes 1999, section 3).
///
/// Leapfrog with fictitious masses and a step of one iteration: v' = v + f(x) / m, x' = x + v',
/// from standstill v' = f / (2 m). When the kinetic energy falls, the cloth has passed a
/// minimum of its potential along the path: it is moved back to the peak, x - v'/2 + f / (2 m), and stopped.
/// Masses m_i = sum_j |K_ij| / 4 (rows summed in absolute value, the worst of the three
/// directions) times 1.2: by Gershgorin's theorem every frequency is then under 2 per iteration,
/// and soft regions move as fast as stiff ones. Masses are computed anew at every peak, with the full stiffness of
/// all contacts detected.
///
/// One step is the motion up to a peak, at most 100 iterations. An explicit method: each iteration costs a force
/// evaluation, and it takes thousands, the more the finer the mesh.
pub struct Relaxation {
    tolerance: f64,
    max_iterations: usize,
    run: Option<RelaxationMemory>,
    workspace: Workspace,
    zeros: Vec<f64>,
}

/// Most iterations of one step.
const STEP_ITERATIONS: usize = 100;

/// Most iterations where the settings give none.
const MAX_ITERATIONS: usize = 100_000;

/// Factor of the masses over the stability limit at the present positions: cloth stiffens as it stretches.
const SAFETY: f64 = 1.2;

/// Longest displacement of a vertex in one iteration (m); a faster motion is slowed down as a whole.
const MAX_MOVE: f64 = 5e-3;

impl Relaxation {
    /// With the settings, and its defaults where they give none.
    pub fn new(settings: &MethodSettings) -> Self {
        Self {
            tolerance: settings.rest_residual(),
            max_iterations: settings.iterations.unwrap_or(MAX_ITERATIONS),
            run: None,
            workspace: Workspace::default(),
            zeros: Vec::new(),
        }
    }

    /// The run in the memory of the state, or a new one.
    fn resume(&mut self, system: &System, state: &mut State) -> RelaxationMemory {
        let n = system.vertex_count();
        match std::mem::take(&mut state.memory) {
            Memory::Relaxation(run) if run.moves.len() == n => run,
            _ => RelaxationMemory {
                moves: vec![Vec3::zeros(); n],
                masses: Vec::new(),
                kinetic: 0.0,
                still: true,
                iterations: 0,
                residual: f64::INFINITY,
            },
        }
    }

    /// Computes masses for which every vibration about the state's positions is stable.
    fn update_masses(&mut self, system: &System, state: &State, masses: &mut Vec<f64>) {
        let workspace = &mut self.workspace;
        self.zeros.resize(system.vertex_count(), 0.0);
        let inertia = Inertia {
            weight: &self.zeros,
            target: &state.positions,
        };
        workspace.fit(system);
        workspace.increment.begin_static(system, state);
        workspace.contacts.refresh(system, state, &state.positions);
        workspace.fill_gradient(system, &state.positions, Some(&inertia));
        workspace.fill_hessian(system, &state.positions, &inertia, Curvature::CONVEX);
        masses.clear();
        for v in 0..system.vertex_count() {
            let mut sums = Vec3::repeat(
                system
                    .rest
                    .bending
                    .row_entries(v)
                    .1
                    .iter()
                    .map(|b| b.abs())
                    .sum(),
            );
            for block in workspace.hessian_blocks(system, v).1 {
                sums += block.abs().column_sum();
            }
            // An elastic between vertices adds its secant off the diagonal too.
            let own = system.elastic_stiffness(v);
            masses.push(0.25 * SAFETY * (sums.max() + own));
        }
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            for (&v, &w) in sample.vertices.iter().zip(&sample.weights) {
                masses[v as usize] += 0.25 * SAFETY * w * contact.law.normal;
            }
        }
        for (mass, &real) in masses.iter_mut().zip(&system.rest.mass) {
            *mass = mass.max(f64::MIN_POSITIVE + 1e-9 * real);
        }
    }

    /// One iteration; true where it ended at a peak or the tolerance is satisfied.
    fn iterate(&mut self, system: &System, state: &mut State, run: &mut RelaxationMemory) -> bool {
        if run.still {
            let mut masses = std::mem::take(&mut run.masses);
            self.update_masses(system, state, &mut masses);
            run.masses = masses;
        }
        // Iterations are not steps in time: with h = 0 the push on buried cloth is not limited.
        let force = forces_and_update_friction(system, state, &mut self.workspace, 0.0);
        run.iterations += 1;
        run.residual = dot(force, force).sqrt() / weight_norm(system);
        if run.residual <= self.tolerance {
            return true;
        }
        let fraction = if run.still { 0.5 } else { 1.0 };
        let (mut kinetic, mut longest) = (0.0, 0.0f64);
        for ((v, f), m) in run.moves.iter_mut().zip(force).zip(&run.masses) {
            *v += f * (fraction / m);
            kinetic += 0.5 * m * v.norm_squared();
            longest = longest.max(v.norm_squared());
        }
        if !run.still && kinetic < run.kinetic {
            let moving = state.positions.iter_mut().zip(&mut run.moves);
            for ((x, v), (f, m)) in moving.zip(force.iter().zip(&run.masses)) {
                *x += f * (0.5 / m) - *v * 0.5;
                *v = Vec3::zeros();
            }
            run.kinetic = 0.0;
            run.still = true;
            return true;
        }
        let longest = longest.sqrt();
        if longest > MAX_MOVE {
            let scale = MAX_MOVE / longest;
            kinetic *= scale * scale;
            for v in &mut run.moves {
                *v *= scale;
            }
        }
        for (x, v) in state.positions.iter_mut().zip(&run.moves) {
            *x += v;
        }
        run.kinetic = kinetic;
        run.still = false;
        false
    }
}

impl Method for Relaxation {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        _step: f64,
    ) -> Result<StepReport, DrapeError> {
        state.velocities.fill(Vec3::zeros());
        let mut run = self.resume(system, state);
        let first = run.iterations;
        for _ in 0..STEP_ITERATIONS {
            if self.iterate(system, state, &mut run) {
                break;
            }
        }
        let stage = "dynamic relaxation";
        if let Some(vertex) = state.first_not_finite() {
            return Err(DrapeError::NotFinite { stage, vertex });
        }
        let report = StepReport {
            pieces: 1,
            iterations: run.iterations - first,
            linear_iterations: 0,
        };
        state.memory = Memory::Relaxation(run.clone());
        self.run = Some(run);
        Ok(report)
    }

    fn finished(&self) -> bool {
        self.run.as_ref().is_some_and(|run| {
            run.residual <= self.tolerance || run.iterations >= self.max_iterations
        })
    }

    fn residual(&self) -> Option<f64> {
        Some(self.run.as_ref().map_or(f64::INFINITY, |run| run.residual))
    }
}
