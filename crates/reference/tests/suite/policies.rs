//! Objects that ignore each other, or a solid: they pass through, nothing is recovered, and the rest of
//! the world meets as without.

use crate::sheets::sheet;
use crate::solids::block;
use std::sync::Arc;
use toile_drape::{
    Cloth, Collider, Contacts, Material, MethodKind, PairPolicies, State, System, SystemBuilder,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A step (s).
const STEP: f64 = 1.0 / 120.0;

/// Square sheets of one mesh, each with its corner at a place (m) and rising along x by a slope: the mesh and
/// where the vertices of each begin, and the end.
fn sheets_at(places: &[(Vec3, f64)], cells: usize, width: f64) -> (TriangleMesh, Vec<usize>) {
    let (mut mesh, mut starts) = (TriangleMesh::default(), vec![0]);
    for &(place, slope) in places {
        let at = |u: f64, v: f64| place + Vec3::new(u, slope * u, v);
        let part = sheet([cells; 2], [width; 2], at);
        mesh.append(&part);
        starts.push(mesh.positions.len());
    }
    (mesh, starts)
}

/// The number of the sheet of each vertex.
fn objects(starts: &[usize]) -> Vec<u16> {
    let sheets = (0u16..).zip(starts.windows(2));
    let each = sheets.flat_map(|(k, ends)| vec![k; ends[1] - ends[0]]);
    each.collect()
}

/// Lowest and highest vertex of a sheet (m).
fn heights(state: &State, starts: &[usize], sheet: usize) -> [f64; 2] {
    let own = &state.positions[starts[sheet]..starts[sheet + 1]];
    let heights = own.iter().map(|x| x.y);
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
        [low.min(y), high.max(y)]
    })
}

/// A sheet over another that is held: whether it falls through, the most triangles that cross in a step, and
/// the most crossings, layer violations and pulls that contact found in one.
fn fall_on_a_sheet(
    method: MethodKind,
    ignored: &[[u16; 2]],
    layered: bool,
) -> (bool, usize, usize) {
    let places = [(Vec3::zeros(), 0.0), (Vec3::new(0.02, 0.02, 0.03), 0.2)];
    let (mesh, starts) = sheets_at(&places, 6, 0.15);
    let cloth = Cloth::from_mesh("sheets", &mesh, Material::default()).unwrap();
    let mut builder = SystemBuilder::new("sheets", &cloth).unwrap();
    builder.contact.cloth_offset = 2e-3;
    builder.pinned[..starts[1]].fill(true);
    if layered {
        // The faces of the sheets point down: the lower one is worn over the upper one.
        builder.layer = objects(&starts).iter().map(|k| 1 - k).collect();
    }
    builder.policies = PairPolicies::new(objects(&starts), ignored.to_vec(), []);
    let system = builder.build();
    let mut state = State::at_rest(&system, mesh.positions);
    let mut method = toile_reference::build(&method.into()).expect("a method that there is");
    let mut contacts = Contacts::default();
    let (mut crossing, mut recovered) = (0, 0);
    for _ in 0..30 {
        method.advance(&system, &mut state, STEP).unwrap();
        contacts.refresh(&system, &state, &state.positions);
        let found = &contacts.cloth;
        let pulls = found.recovery.pulls.len();
        recovered = recovered.max(found.crossings + found.violations + pulls);
        let surface = SurfaceTree::new(system.mesh(&state.positions));
        crossing = crossing.max(surface.self_intersections().len());
    }
    let fell = heights(&state, &starts, 1)[1] < -0.02;
    (fell, crossing, recovered)
}

#[test]
fn sheets_that_ignore_each_other_pass_and_nothing_is_recovered() {
    for method in [MethodKind::ImplicitEuler, MethodKind::Xpbd] {
        for layered in [false, true] {
            let (fell, crossing, recovered) = fall_on_a_sheet(method, &[[1, 0]], layered);
            assert!(fell && crossing > 0, "{method:?} {layered}");
            assert_eq!(recovered, 0, "{method:?} {layered}");
            // Without a policy, and with one for another object, they meet.
            for others in [&[][..], &[[0, 7]]] {
                let found = fall_on_a_sheet(method, others, layered);
                assert!(
                    !found.0 && found.1 == 0,
                    "{method:?} {layered} {others:?}: {found:?}"
                );
            }
        }
    }
}

/// Surfaces at these heights (m), in order of the colliders.
const FLOORS: [f64; 2] = [0.0, -0.15];

/// Two sheets side by side above two floors.
fn over_floors(policies: PairPolicies) -> (System, State, Vec<usize>) {
    let places = [0.0, 0.3].map(|x| (Vec3::new(x, 0.02, 0.0), 0.0));
    let (mesh, starts) = sheets_at(&places, 5, 0.15);
    let cloth = Cloth::from_mesh("sheets", &mesh, Material::default()).unwrap();
    let mut builder = SystemBuilder::new("sheets", &cloth).unwrap();
    let floors = FLOORS.map(|top| {
        let floor = block(Vec3::new(-0.5, top - 0.05, -0.5), Vec3::new(1.0, top, 0.7));
        Collider::new(Arc::new(SurfaceTree::new(floor)))
    });
    builder.colliders = floors.to_vec();
    builder.policies = policies;
    builder.control.air_drag = 3.0;
    let system = builder.build();
    let state = State::at_rest(&system, mesh.positions);
    (system, state, starts)
}

/// The methods that find contact with solids in different ways.
const WAYS: [MethodKind; 3] = [
    MethodKind::Xpbd,
    MethodKind::ImplicitEuler,
    MethodKind::PatchVerlet,
];

/// Whether a sheet lies on a floor.
fn lies(state: &State, starts: &[usize], sheet: usize, floor: f64) -> bool {
    let [low, high] = heights(state, starts, sheet);
    low > floor && high < floor + 0.01
}

#[test]
fn a_sheet_falls_through_the_floor_that_it_ignores_onto_the_next_one() {
    for kind in WAYS {
        for ignoring in [None, Some(0u16), Some(1)] {
            let (_, _, starts) = over_floors(PairPolicies::default());
            let ignored = ignoring.map(|sheet| (sheet, 0));
            let policies = PairPolicies::new(objects(&starts), [], ignored);
            let (system, mut state, starts) = over_floors(policies);
            let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
            for _ in 0..60 {
                method.advance(&system, &mut state, STEP).unwrap();
            }
            for sheet in 0..2u16 {
                let floor = FLOORS[usize::from(ignoring == Some(sheet))];
                let found = heights(&state, &starts, usize::from(sheet));
                assert!(
                    lies(&state, &starts, usize::from(sheet), floor),
                    "{kind:?}, sheet {ignoring:?} ignores the floor: {sheet} at {found:?}"
                );
            }
        }
    }
}

#[test]
fn a_policy_that_is_taken_back_above_the_floor_is_forgotten() {
    for kind in WAYS {
        let (_, _, starts) = over_floors(PairPolicies::default());
        let both = [(0, 0), (1, 0)];
        let policies = PairPolicies::new(objects(&starts), [], both);
        let (mut system, mut state, starts) = over_floors(policies);
        let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
        for step in 0..40 {
            if step == 3 {
                system = system.with(|builder| builder.policies = PairPolicies::default());
            }
            method.advance(&system, &mut state, STEP).unwrap();
            let lowest = heights(&state, &starts, 0)[0];
            // The offset of 4 mm, less what the impact presses it in by.
            assert!(lowest > FLOORS[0] + 3e-3, "{kind:?}, step {step}: {lowest}");
        }
    }
}
