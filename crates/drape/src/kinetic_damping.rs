//! The swing, a garment's stage between sewing and settling: small XPBD substeps with kinetic damping (Cundall 1976). A
//! substep costs less than a thousandth of a Newton step, and inertia carries the cloth past saddle points; Newton's
//! method then finishes.

use crate::collision::Tally;
use crate::xpbd::{ClothContacts, Substeps};
use crate::{DrapeError, State, System, Xpbd};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// A run of the swing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KineticDamping {
    /// Substep (s).
    substep: f64,
    /// Rounds of substeps taken.
    rounds: u32,
    time: f64,
    energy: f64,
    calm: bool,
    longest: f64,
    /// Lowest peak of kinetic energy (J), and the number of peaks since.
    #[serde(with = "toile_fabric::exact")]
    lowest: f64,
    waited: u32,
}

/// Workspace of a swing: its constraints and its contacts.
#[derive(Default)]
pub struct SwingWorkspace {
    xpbd: Option<Xpbd>,
    cloth: ClothContacts,
}

impl SwingWorkspace {
    /// Counts of contact of cloth with cloth so far.
    pub fn cloth_tally(&self) -> Tally {
        self.cloth.contacts.tally
    }

    /// Number of times the constraints were built.
    pub fn builds(&self) -> usize {
        self.xpbd.as_ref().map_or(0, Xpbd::builds)
    }

    /// Clears the contacts and their search structures.
    pub fn forget_contacts(&mut self) {
        self.cloth.reset();
    }
}

/// Courant number: edges that a wave in the cloth passes in a substep. The error of one XPBD sweep makes the cloth
/// softer by the square of this number, so it is below 1.
const COURANT: f64 = 0.7;
/// Longest substep (s).
const MAX_SUBSTEP: f64 = 5e-4;
/// Substeps between two measurements of the kinetic energy.
const ROUND: u32 = 20;
/// Drag while swinging (1/s).
const DRAG: f64 = 3.0;
/// Longest simulated time (s) on the coarsest mesh, and on a finer one, which starts from the interpolated shape of a
/// coarser one at rest.
const LONGEST: f64 = 3.0;
const MAX_CARRIED_TIME: f64 = 0.3;
/// Mean speed (m/s) whose kinetic energy a peak must not exceed for the swing to end.
const CALM: f64 = 0.0015;
/// A peak of kinetic energy is a new low below this share of the lowest before. With crossings left, the swing ends
/// after more than `PATIENCE` peaks without a new low.
const LOWER: f64 = 0.8;
const PATIENCE: u32 = 12;

impl KineticDamping {
    /// A swing from the present state.
    pub fn new(system: &System) -> Self {
        Self {
            substep: substep(system),
            rounds: 0,
            time: 0.0,
            energy: 0.0,
            calm: false,
            longest: LONGEST,
            lowest: f64::INFINITY,
            waited: 0,
        }
    }

    /// A swing from the interpolated shape of a coarser mesh at rest.
    pub fn carried(system: &System) -> Self {
        Self {
            longest: MAX_CARRIED_TIME,
            ..Self::new(system)
        }
    }

    /// Rounds of substeps taken.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Whether the motion has died out, or the time is used up.
    pub fn finished(&self) -> bool {
        self.calm || self.stuck() || self.time >= self.longest
    }

    /// Whether the recovery forces of crossings keep the cloth moving: the peaks no longer fall.
    fn stuck(&self) -> bool {
        self.waited > PATIENCE
    }

    /// Whether it ended with crossings of cloth before the motion had died out.
    pub fn left_crossings(&self, workspace: &SwingWorkspace) -> bool {
        !self.calm && !workspace.cloth.contacts.is_in_order()
    }

    /// Share of the longest time that has passed, 0..=1.
    pub fn share(&self) -> f64 {
        self.time / self.longest
    }

    /// One round of substeps. After a peak of the kinetic energy the velocities are set to zero.
    ///
    /// # Errors
    /// A substep that fails at every size; the state is then unchanged.
    pub fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        workspace: &mut SwingWorkspace,
    ) -> Result<(), DrapeError> {
        let substeps = Substeps {
            substep: self.substep,
            count: ROUND,
            drag: DRAG,
        };
        let before = state.clone();
        let SwingWorkspace { xpbd, cloth } = workspace;
        let xpbd = xpbd.get_or_insert_with(|| Xpbd::for_state(system, state));
        let report = match xpbd.advance_with_cloth_contact(system, state, cloth, &substeps) {
            Ok(report) => report,
            Err(error) => {
                *state = before;
                cloth.invalidate();
                return Err(error);
            }
        };
        self.rounds += 1;
        self.time += self.substep * f64::from(ROUND);
        if report.kinetic_energy < self.energy {
            let mass: f64 = system.rest.mass.iter().sum();
            self.calm = self.energy < 0.5 * mass * CALM * CALM;
            self.watch_crossings(cloth.contacts.is_in_order());
            self.energy = 0.0;
            stop(state);
        } else {
            self.energy = report.kinetic_energy;
        }
        if self.finished() {
            stop(state);
            // What friction bears where a swing is stopped came of the swing: rest finds its own.
            state.solid_friction.clear();
        }
        Ok(())
    }
}

impl KineticDamping {
    /// Counts the peaks of kinetic energy since the lowest while cloth crosses cloth or layers are out of order.
    fn watch_crossings(&mut self, in_order: bool) {
        if self.energy < LOWER * self.lowest || in_order {
            self.lowest = self.energy;
            self.waited = 0;
        }
        self.waited += 1;
    }
}

fn stop(state: &mut State) {
    for v in &mut state.velocities {
        *v = Vec3::zeros();
    }
}

/// Substep for the mean edge of a model and the speed of waves in its cloth (s).
fn substep(system: &System) -> f64 {
    let crossing = |t: usize| {
        let material = system.materials.of(t);
        let stiffest = material.stretch[0].max(material.stretch[1]);
        let edge = (2.0 * system.rest.elements[t].area).sqrt();
        edge * (material.density / stiffest).sqrt()
    };
    let count = system.topology.triangles.len().max(1);
    let mean = (0..system.topology.triangles.len())
        .map(crossing)
        .sum::<f64>()
        / count as f64;
    (COURANT * mean).min(MAX_SUBSTEP)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SystemBuilder;
    use crate::{Cloth, Material, PseudoTransientContinuation, RestSettings, Workspace};
    use toile_geometry::TriangleMesh;

    /// A strip of 3 x 20 cells of an edge (m), held level by its first row.
    fn strip(edge: f64) -> (System, State) {
        let mut mesh = TriangleMesh::default();
        for j in 0..=20u32 {
            for i in 0..=3u32 {
                let (x, z) = (edge * f64::from(i), edge * f64::from(j));
                mesh.positions.push(Vec3::new(x, 0.0, z));
                if i < 3 && j < 20 {
                    let a = 4 * j + i;
                    mesh.triangles
                        .extend([[a, a + 1, a + 5], [a, a + 5, a + 4]]);
                }
            }
        }
        let cloth = Cloth::from_mesh("strip", &mesh, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
        builder.pinned[..4].fill(true);
        let system = builder.build();
        let state = State::at_rest(&system, mesh.positions);
        (system, state)
    }

    #[test]
    fn a_strip_let_go_swings_down_and_is_calm_before_its_time_is_up() {
        let (system, mut state) = strip(0.01);
        let mut run = KineticDamping::new(&system);
        let mut caches = SwingWorkspace::default();
        let mut stops = 0;
        while !run.finished() {
            run.advance(&system, &mut state, &mut caches).unwrap();
            stops += usize::from(run.energy == 0.0);
            assert!((0.0..=1.0 + 1e-9).contains(&run.share()));
        }
        assert!(run.calm && run.time < 0.8 * LONGEST, "{}", run.time);
        assert!(stops >= 2, "{stops}");
        assert!(state.velocities.iter().all(|v| *v == Vec3::zeros()));
        assert!(state.positions[83].y < -0.15, "{}", state.positions[83]);
        // Newton's method finds the tip near the same position.
        let tip = state.positions[83];
        let mut rest = PseudoTransientContinuation::near(RestSettings::default());
        let mut workspace = Workspace::default();
        while !rest.finished() {
            rest.advance(&system, &mut state, &mut workspace).unwrap();
        }
        let off = (state.positions[83] - tip).norm();
        assert!(off < 3e-3, "{off}");
    }

    #[test]
    fn finer_cloth_swings_in_shorter_substeps() {
        let [system, finer] = [0.01, 0.0025].map(|edge| strip(edge).0);
        let ratio = substep(&finer) / substep(&system);
        assert!((ratio - 0.25).abs() < 1e-12 || substep(&system) == MAX_SUBSTEP);
        assert!(substep(&finer) < substep(&system));
    }
}
