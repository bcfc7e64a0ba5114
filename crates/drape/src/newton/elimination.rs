//! Nonlinear elimination (Lanzkron, Rose and Wilkes 1996; Cai and Li 2011): where few vertices bear most of the
//! net force, the regions around them are brought to equilibrium first, with the remaining cloth fixed.
//!
//! Near equilibrium cloth buckles in one spot after the other. Each takes Newton's method several steps, and on
//! the whole cloth each of these costs a factorisation of the whole matrix, with a line search that shortens the
//! step everywhere. Here they are steps of a submodel.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, Workspace};
use crate::laws::membrane::Curvature;
use crate::merge::merge_map;
use crate::submodel::SubModel;
use crate::{PcgLimits, State, System};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Share of the sum of squared net forces that the seed vertices of the regions bear.
const SEED_FORCE_SHARE: f64 = 0.8;
/// Rings of neighbours by which regions grow around their seeds.
const REGION_RINGS: usize = 6;
/// Largest share of all vertices in regions; beyond it the force is not localised and nothing is eliminated.
const MAX_REGION_SHARE: f64 = 0.5;
/// Passes of elimination: a region at equilibrium changes the forces on its rim, so that regions are determined
/// anew.
const PASSES: usize = 3;
/// Tolerances of a region: the largest of these shares of its own first net force, of the net force outside all
/// regions, and of the tolerance for the whole cloth.
const OF_FIRST_FORCE: f64 = 0.05;
const OF_FORCE_OUTSIDE: f64 = 0.3;
const OF_TOLERANCE: f64 = 0.5;
/// Most Newton iterations of a region, and its longest displacement in all of them (m).
const MAX_ITERATIONS: usize = 25;
const MAX_MOVE: f64 = 5e-3;

impl Workspace {
    /// Brings the regions that bear most of the net force to equilibrium, until the net force is below
    /// `tolerance` (N) or not localised. The contacts must have been detected at the state. Tangled cloth is left
    /// as it is: its recovery direction has to be computed anew after every displacement. Returns whether a vertex
    /// moved; contacts must then be detected again.
    pub(crate) fn eliminate(&mut self, system: &System, state: &mut State, tolerance: f64) -> bool {
        if !self.increment.are_of_stretch() || !self.contacts.cloth.is_in_order() {
            return false;
        }
        let start = state.positions.clone();
        let mut moved = false;
        for _ in 0..PASSES {
            let x = &state.positions;
            self.contacts.refresh_surfaces(system, state, x);
            self.fill_gradient(system, x, None);
            let total = dot(&self.gradient, &self.gradient);
            if total.is_nan() || total <= tolerance * tolerance {
                break;
            }
            let regions = self.regions(system, total);
            let inside = regions.iter().flatten().map(|&v| self.gradient[v as usize]);
            let outside = (total - inside.map(|g| g.norm_squared()).sum::<f64>()).max(0.0);
            let region_tolerance =
                (OF_FORCE_OUTSIDE * outside.sqrt()).max(OF_TOLERANCE * tolerance);
            let region_tolerance = region_tolerance / (regions.len() as f64).sqrt();
            // Cloth without tangles has no recovery forces besides its contacts.
            let cloth_contacts = &self.contacts.cloth.contacts;
            let submodels: Vec<SubModel> = regions
                .par_iter()
                .filter_map(|own| {
                    let mut submodel = SubModel::new(system, state, cloth_contacts, own);
                    solve_region(&mut submodel, region_tolerance).then_some(submodel)
                })
                .collect();
            if submodels.is_empty() {
                break;
            }
            moved = true;
            for (v, position) in submodels.iter().flat_map(SubModel::own_positions) {
                state.positions[v as usize] = position;
            }
        }
        moved && self.truncate_or_undo(system, state, start)
    }

    /// Truncates the displacements since `start` so that no cloth passes through cloth, and undoes all of them
    /// where the potential is then not lower than at `start`. Returns whether the displacements stand.
    pub(super) fn truncate_or_undo(
        &mut self,
        system: &System,
        state: &mut State,
        start: Vec<Vec3>,
    ) -> bool {
        let displacements = state.positions.iter().zip(&start).map(|(x, s)| x - s);
        let mut displacements: Vec<Vec3> = displacements.collect();
        if (self.contacts).truncate_moves(system, &start, &mut displacements) == 0 {
            return true;
        }
        for ((x, s), d) in state.positions.iter_mut().zip(&start).zip(&displacements) {
            *x = s + d;
        }
        self.contacts.refresh_surfaces(system, state, &start);
        let inertia = Inertia {
            weight: &vec![0.0; start.len()],
            target: &start,
        };
        let [before, after] =
            [&start, &state.positions].map(|x| self.potential(system, x, &inertia));
        let decreased = after < before;
        if !decreased {
            state.positions = start;
        }
        decreased
    }

    /// Regions of free vertices around those that bear most of the net force; `total` is the sum of its squares
    /// (N2). Vertices of a region are in ascending order, and no two regions share a term of the potential. Empty
    /// where the force is not localised.
    fn regions(&self, system: &System, total: f64) -> Vec<Vec<u32>> {
        let squares: Vec<f64> = self.gradient.iter().map(Vec3::norm_squared).collect();
        let mut ring: Vec<u32> = (0..squares.len() as u32).collect();
        ring.sort_by(|&a, &b| squares[b as usize].total_cmp(&squares[a as usize]));
        let mut borne = 0.0;
        let count = ring.iter().take_while(|&&v| {
            let is_seed = borne < SEED_FORCE_SHARE * total;
            borne += squares[v as usize];
            is_seed
        });
        ring.truncate(count.count());
        let limit = (MAX_REGION_SHARE * squares.len() as f64) as usize;
        let mut inside = vec![false; squares.len()];
        let mut members = Vec::new();
        for _ in 0..=REGION_RINGS {
            ring.retain(|&v| !std::mem::replace(&mut inside[v as usize], true));
            members.extend_from_slice(&ring);
            if members.len() > limit {
                return Vec::new();
            }
            let next = (ring.iter()).flat_map(|&v| system.topology.pattern.row_columns(v as usize));
            ring = next.copied().collect();
        }
        let bending_pairs = members.iter().flat_map(|&v| {
            let columns = system.rest.bending.row_entries(v as usize).0;
            columns.iter().map(move |&u| [v, u])
        });
        let coupling_pairs = system.couplings.ends();
        let contact_pairs = self.contacts.cloth.couples();
        let edges = members.iter().flat_map(|&v| {
            let columns = system.topology.pattern.row_columns(v as usize);
            columns.iter().map(move |&u| [v, u])
        });
        let pairs = bending_pairs
            .chain(edges)
            .chain(coupling_pairs)
            .chain(contact_pairs);
        let coupled = pairs.filter(|pair| pair.iter().all(|&v| inside[v as usize]));
        let (region_of, _) = merge_map(squares.len(), coupled);
        members.retain(|&v| !system.prescribed.pinned[v as usize]);
        members.sort_unstable();
        let mut regions: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for v in members {
            let region = regions.entry(region_of[v as usize]).or_default();
            region.push(v);
        }
        regions.into_values().collect()
    }
}

/// Minimises the potential of a region until its net force is below `tolerance` (N) or a small share of its first
/// one. Contacts of cloth with cloth are those of the whole cloth and are not detected anew. Returns whether a
/// vertex moved.
fn solve_region(submodel: &mut SubModel, tolerance: f64) -> bool {
    let SubModel {
        system,
        state,
        touching: cloth_contacts,
        ..
    } = submodel;
    let mut workspace = Workspace::default();
    workspace.fit(system);
    workspace.increment.begin_static(system, state);
    let start = state.positions.clone();
    let inertia = Inertia {
        weight: &vec![0.0; system.vertex_count()],
        target: &start,
    };
    let mut settings = NewtonSettings {
        iterations: 1,
        tolerance,
        longest_move: MAX_MOVE,
        curvature: Curvature::EXACT,
        linear: LinearSolver::Direct {
            otherwise: PcgLimits {
                tolerance: 1e-3,
                iterations: 200,
            },
        },
    };
    let mut report = NewtonReport::default();
    while report.iterations < MAX_ITERATIONS && settings.longest_move > 0.0 {
        workspace
            .contacts
            .refresh_surfaces(system, state, &state.positions);
        workspace.contacts.cloth.contacts.clone_from(cloth_contacts);
        if !workspace.iterate(system, state, &inertia, &settings, &mut report) {
            break;
        }
        if report.iterations == 1 {
            settings.tolerance = tolerance.max(OF_FIRST_FORCE * report.gradient);
        }
        settings.curvature = report.next_curvature();
        settings.longest_move -= report.moved;
    }
    state.positions != start
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::SystemBuilder;
    use crate::measure::residual;
    use crate::{Cloth, Material, PseudoTransientContinuation, RestSettings};
    use toile_geometry::TriangleMesh;

    /// A sheet of 40 x 40 squares of 10 mm at rest, hung by its upper edge.
    pub fn hung() -> (System, State, Workspace) {
        let mut mesh = TriangleMesh::default();
        for v in 0..41 * 41u32 {
            let (x, y) = (0.01 * f64::from(v % 41), -0.01 * f64::from(v / 41));
            let z = 1e-3 * (20.0 * x).sin() * y;
            mesh.positions.push(Vec3::new(x, y, z));
        }
        for q in 0..1600u32 {
            let a = q / 40 * 41 + q % 40;
            mesh.triangles
                .extend([[a, a + 41, a + 1], [a + 1, a + 41, a + 42]]);
        }
        let cloth = Cloth::from_mesh("sheet", &mesh, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("sheet", &cloth).unwrap();
        builder.pinned[..41].fill(true);
        let system = builder.build();
        let mut state = State::at_rest(&system, mesh.positions);
        let mut workspace = Workspace::default();
        let mut rest = PseudoTransientContinuation::near(RestSettings {
            residual: 1e-6,
            ..RestSettings::default()
        });
        while !rest.finished() {
            rest.advance(&system, &mut state, &mut workspace).unwrap();
        }
        (system, state, workspace)
    }

    /// Moves the vertices within 20 mm of one out of the sheet and towards each other.
    fn dent(state: &mut State, vertex: usize) {
        let centre = state.positions[vertex];
        for x in &mut state.positions {
            let off = *x - centre;
            if off.norm() < 0.02 {
                *x += Vec3::z() * 4e-3 - off * 0.2;
            }
        }
    }

    #[test]
    fn dents_reach_equilibrium_and_the_cloth_elsewhere_does_not_move() {
        let (system, rest, mut workspace) = hung();
        let mut state = rest.clone();
        let spots = [10 * 41 + 8, 28 * 41 + 32];
        for spot in spots {
            dent(&mut state, spot);
        }
        let start = state.clone();
        let dented = residual(&system, &state, &mut workspace);
        let total = dot(&workspace.gradient, &workspace.gradient);
        let regions = workspace.regions(&system, total);
        assert_eq!(regions.len(), 2);
        for (region, spot) in regions.iter().zip(spots) {
            assert!(region.contains(&(spot as u32)) && region.is_sorted());
        }
        assert!(workspace.eliminate(&system, &mut state, 0.0));
        let left = residual(&system, &state, &mut workspace);
        assert!(left < 0.03 * dented, "{left} of {dented}");
        for ((now, before), rest) in state
            .positions
            .iter()
            .zip(&start.positions)
            .zip(&rest.positions)
        {
            let near = spots.map(|spot| (before - start.positions[spot]).norm());
            assert!(near[0].min(near[1]) < 0.25 || now == before);
            assert!((now - rest).norm() < 1e-3);
        }
        // Below the tolerance nothing is done.
        let tolerance = 2.0 * left * crate::measure::weight_norm(&system);
        assert!(!workspace.eliminate(&system, &mut state, tolerance));
    }

    #[test]
    fn a_force_that_is_not_localised_and_nan_states_are_left_as_they_are() {
        let (system, rest, mut workspace) = hung();
        let mut state = rest.clone();
        for (v, x) in state.positions.iter_mut().enumerate().skip(41) {
            x.z += 1e-4 * (v as f64 * 1.7).sin();
        }
        let start = state.clone();
        workspace.net_force(&system, &state);
        assert!(!workspace.eliminate(&system, &mut state, 0.0));
        assert_eq!(state, start);
        state.positions[800].x = f64::NAN;
        workspace.net_force(&system, &state);
        assert!(!workspace.eliminate(&system, &mut state, 0.0));
    }
}
