//! Nonlinear elimination (Lanzkron, Rose and Wilkes 1996; Cai and Li 2011): where few vertices hold
//! most of the net force, they and what lies round them are brought to rest first, the rest of the
//! cloth held.
//!
//! Near rest cloth buckles in one spot after the other, and a spot that buckles takes Newton's
//! method several steps, each a factorisation of the whole matrix cut short by a line search over
//! all the cloth. Here they are steps of a submodel, and the cloth elsewhere does not wait for them.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, Workspace};
use crate::laws::membrane::Curvature;
use crate::merge::merge_map;
use crate::submodel::SubModel;
use crate::{PcgLimits, State, System};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Share of the sum of squared forces that regions grow round.
const HELD: f64 = 0.8;
/// Edges that regions grow by.
const RINGS: usize = 6;
/// Share of all vertices that regions may take; beyond it the force counts as spread.
const SPREAD: f64 = 0.5;
/// Times that regions are looked for, since one that comes to rest moves its rim's forces.
const PASSES: usize = 3;
/// A region is at rest at this share of its first force, of the force outside all regions, or of what
/// is enough.
const CALM: f64 = 0.05;
const CALM_OUTSIDE: f64 = 0.3;
const CALM_ENOUGH: f64 = 0.5;
/// Newton iterations of a region at the most, and its longest move in them all [m].
const ITERATIONS: usize = 25;
const LONGEST_MOVE: f64 = 5e-3;

impl Workspace {
    /// Brings regions to rest that hold most of the net force, until it is `enough` [N] or spread
    /// over the cloth. The contacts in hand must be those of the state. Cloth that is tangled is left
    /// alone: what draws it out is found anew after every move. Returns whether anything moved;
    /// contacts are then to be found anew.
    pub(crate) fn eliminate(&mut self, system: &System, state: &mut State, enough: f64) -> bool {
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
            if total.is_nan() || total <= enough * enough {
                break;
            }
            let regions = self.regions(system, total);
            let held = regions.iter().flatten().map(|&v| self.gradient[v as usize]);
            let outside = (total - held.map(|g| g.norm_squared()).sum::<f64>()).max(0.0);
            let calm = (CALM_OUTSIDE * outside.sqrt()).max(CALM_ENOUGH * enough);
            let calm = calm / (regions.len() as f64).sqrt();
            // Cloth in order has no pulls.
            let touching = &self.contacts.cloth.contacts;
            let submodels: Vec<SubModel> = regions
                .par_iter()
                .filter_map(|own| {
                    let mut submodel = SubModel::new(system, state, touching, own);
                    bring_to_rest(&mut submodel, calm).then_some(submodel)
                })
                .collect();
            if submodels.is_empty() {
                break;
            }
            moved = true;
            for (v, place) in submodels.iter().flat_map(SubModel::own_positions) {
                state.positions[v as usize] = place;
            }
        }
        moved && self.hold_back(system, state, start)
    }

    /// Bounds what was moved so that no cloth passes through cloth, and takes it all back where the
    /// potential is then higher than before. Returns whether anything stays moved.
    pub(super) fn hold_back(
        &mut self,
        system: &System,
        state: &mut State,
        start: Vec<Vec3>,
    ) -> bool {
        let ways = state.positions.iter().zip(&start).map(|(x, s)| x - s);
        let mut ways: Vec<Vec3> = ways.collect();
        if (self.contacts).truncate_moves(system, &start, &mut ways) == 0 {
            return true;
        }
        for ((x, s), d) in state.positions.iter_mut().zip(&start).zip(&ways) {
            *x = s + d;
        }
        self.contacts.refresh_surfaces(system, state, &start);
        let inertia = Inertia {
            weight: &vec![0.0; start.len()],
            target: &start,
        };
        let [before, after] =
            [&start, &state.positions].map(|x| self.potential(system, x, &inertia));
        let lower = after < before;
        if !lower {
            state.positions = start;
        }
        lower
    }

    /// Regions of free vertices, each ascending, round those that hold most of the force; `total`
    /// is the sum of its squares. No two share a term of the potential. None where the force is
    /// spread over the cloth.
    fn regions(&self, system: &System, total: f64) -> Vec<Vec<u32>> {
        let squares: Vec<f64> = self.gradient.iter().map(Vec3::norm_squared).collect();
        let mut ring: Vec<u32> = (0..squares.len() as u32).collect();
        ring.sort_by(|&a, &b| squares[b as usize].total_cmp(&squares[a as usize]));
        let mut held = 0.0;
        let count = ring.iter().take_while(|&&v| {
            let more = held < HELD * total;
            held += squares[v as usize];
            more
        });
        ring.truncate(count.count());
        let most = (SPREAD * squares.len() as f64) as usize;
        let mut inside = vec![false; squares.len()];
        let mut all = Vec::new();
        for _ in 0..=RINGS {
            ring.retain(|&v| !std::mem::replace(&mut inside[v as usize], true));
            all.extend_from_slice(&ring);
            if all.len() > most {
                return Vec::new();
            }
            let next = (ring.iter()).flat_map(|&v| system.topology.pattern.row_columns(v as usize));
            ring = next.copied().collect();
        }
        let bent = all.iter().flat_map(|&v| {
            let columns = system.rest.bending.row_entries(v as usize).0;
            columns.iter().map(move |&u| [v, u])
        });
        let sewn = system.couplings.ends();
        let touching = self.contacts.cloth.couples();
        let edges = all.iter().flat_map(|&v| {
            let columns = system.topology.pattern.row_columns(v as usize);
            columns.iter().map(move |&u| [v, u])
        });
        let pairs = bent.chain(edges).chain(sewn).chain(touching);
        let coupled = pairs.filter(|pair| pair.iter().all(|&v| inside[v as usize]));
        let (region_of, _) = merge_map(squares.len(), coupled);
        all.retain(|&v| !system.prescribed.pinned[v as usize]);
        all.sort_unstable();
        let mut regions: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for v in all {
            let region = regions.entry(region_of[v as usize]).or_default();
            region.push(v);
        }
        regions.into_values().collect()
    }
}

/// Lowers the potential of a submodel until its net force is `calm` [N] or a small share of the first.
/// Contacts of cloth with cloth stay as they were found. Returns whether anything moved.
fn bring_to_rest(submodel: &mut SubModel, calm: f64) -> bool {
    let SubModel {
        system,
        state,
        touching,
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
        tolerance: calm,
        longest_move: LONGEST_MOVE,
        curvature: Curvature::EXACT,
        linear: LinearSolver::Direct {
            otherwise: PcgLimits {
                tolerance: 1e-3,
                iterations: 200,
            },
        },
    };
    let mut report = NewtonReport::default();
    while report.iterations < ITERATIONS && settings.longest_move > 0.0 {
        workspace
            .contacts
            .refresh_surfaces(system, state, &state.positions);
        workspace.contacts.cloth.contacts.clone_from(touching);
        if !workspace.iterate(system, state, &inertia, &settings, &mut report) {
            break;
        }
        if report.iterations == 1 {
            settings.tolerance = calm.max(CALM * report.gradient);
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

    /// Pushes the vertices within 20 mm of one out of the sheet and together.
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
    fn dents_are_brought_to_rest_and_the_cloth_round_them_stays() {
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
        // What is enough is left alone.
        let enough = 2.0 * left * crate::measure::weight_norm(&system);
        assert!(!workspace.eliminate(&system, &mut state, enough));
    }

    #[test]
    fn force_spread_over_the_cloth_is_left_to_newton_and_so_are_numbers_that_are_none() {
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
