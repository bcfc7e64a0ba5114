//! Rest shapes that change under a system whose triangles stay.

use std::sync::Arc;
use toile_drape::{
    Cloth, DrapeError, Material, PseudoTransientContinuation, RestSettings, State, System,
    SystemBuilder, Workspace, residual, whole_energy,
};
use toile_geometry::{Vec2, Vec3};

/// Cells of a sheet along each side, and their edge (m).
const CELLS: u32 = 24;
const EDGE: f64 = 0.015;

/// A sheet in the plane whose points are moved by up to `jitter` edges, the same for the same seed; the warp
/// along the first axis.
fn sheet(seed: u32, jitter: f64) -> Cloth {
    let side = CELLS + 1;
    let place = |v: u32| {
        let k = f64::from(v + 97 * seed);
        let off = Vec2::new((12.9 * k).sin(), (78.2 * k).cos()) * jitter;
        (Vec2::new(f64::from(v % side), f64::from(v / side)) + off) * EDGE
    };
    let points: Vec<Vec2> = (0..side * side).map(place).collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..CELLS * CELLS).map(|q| (q % CELLS, q / CELLS)) {
        let a = j * side + i;
        triangles.extend([[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]);
    }
    Cloth {
        positions: points.iter().map(|p| Vec3::new(p.x, -p.y, 0.0)).collect(),
        rest: rest_of(&points, &triangles),
        material: vec![0; triangles.len()],
        panel: vec![0; triangles.len()],
        materials: vec![Material::default()],
        triangles,
    }
}

fn rest_of(points: &[Vec2], triangles: &[[u32; 3]]) -> Vec<[Vec2; 3]> {
    let corners = |t: &[u32; 3]| t.map(|v| points[v as usize]);
    triangles.iter().map(corners).collect()
}

/// A sheet hung by its upper edge.
fn hung(cloth: &Cloth) -> System {
    let mut builder = SystemBuilder::new("sheet", cloth).unwrap();
    builder.pinned[..=CELLS as usize].fill(true);
    builder.build()
}

/// Somewhat bent places of a sheet.
fn bent(cloth: &Cloth) -> Vec<Vec3> {
    let wave = |p: &Vec3| Vec3::new(p.x, p.y, 0.004 * (30.0 * p.x).sin() * (20.0 * p.y).cos());
    cloth.positions.iter().map(wave).collect()
}

fn energy(system: &System, places: &[Vec3]) -> f64 {
    let state = State::at_rest(system, places.to_vec());
    whole_energy(system, &state, &mut Workspace::default())
}

#[test]
fn the_same_shapes_give_the_same_energy_and_forces() {
    let cloth = sheet(1, 0.15);
    let system = hung(&cloth);
    let same = system.reshaped("sheet", cloth.rest.clone()).unwrap();
    let places = bent(&cloth);
    let [before, after] = [&system, &same].map(|system| energy(system, &places));
    assert!(
        (before - after).abs() < 1e-12 * before.abs(),
        "{before} {after}"
    );
    let state = State::at_rest(&system, places);
    let [mut one, mut two] = [Workspace::default(), Workspace::default()];
    let (before, after) = (one.net_force(&system, &state), two.net_force(&same, &state));
    let largest = before.iter().map(Vec3::norm).fold(0.0, f64::max);
    for (a, b) in before.iter().zip(after) {
        assert!((a - b).norm() < 1e-12 * largest, "{a:?} {b:?}");
    }
}

#[test]
fn what_hangs_on_the_triangles_is_shared_and_the_way_to_a_shape_does_not_matter() {
    let cloth = sheet(0, 0.1);
    let system = hung(&cloth);
    let first = system.reshaped("sheet", cloth.rest.clone()).unwrap();
    let places = bent(&cloth);
    let mut now = first.clone();
    for seed in 1..=100 {
        let shapes = sheet(seed, 0.1).rest;
        now = now.reshaped("sheet", shapes.clone()).unwrap();
        assert!(Arc::ptr_eq(&now.topology, &first.topology));
        assert!(!Arc::ptr_eq(&now.rest, &first.rest));
        let afresh = first.reshaped("sheet", shapes).unwrap();
        assert_eq!(energy(&now, &places), energy(&afresh, &places), "{seed}");
        assert_eq!(now.rest.mass, afresh.rest.mass);
    }
    // A lattice has curvatures without some vertices that another shape needs: they were not left out.
    let lattice = sheet(0, 0.0);
    let regular = hung(&lattice)
        .reshaped("sheet", lattice.rest.clone())
        .unwrap();
    let wanted = sheet(3, 0.1);
    let [edited, made] = [
        regular.reshaped("sheet", wanted.rest.clone()).unwrap(),
        hung(&wanted),
    ]
    .map(|system| energy(&system, &places));
    assert!(
        (edited - made).abs() < 1e-12 * made.abs(),
        "{edited} {made}"
    );
}

#[test]
fn shapes_that_do_not_serve_are_refused_by_name() {
    let cloth = sheet(0, 0.1);
    let system = hung(&cloth);
    let few = system.reshaped("sheet", cloth.rest[1..].to_vec());
    let words = few.err().unwrap().to_string();
    assert!(
        words.contains("1151 rest shapes") && words.contains("1152"),
        "{words}"
    );
    let mut flat = cloth.rest.clone();
    flat[7] = [Vec2::zeros(), Vec2::x(), Vec2::x() * 2.0];
    let refused = system.reshaped("sheet", flat).err().unwrap();
    assert!(
        matches!(refused, DrapeError::EmptyTriangle { triangle: 7, .. }),
        "{refused}"
    );
    let mut none = cloth.rest.clone();
    none[9][1].x = f64::NAN;
    assert!(system.reshaped("sheet", none).is_err());
    // All points on two lines: no parabola is told from another.
    let mut lines = cloth.clone();
    let squeezed = |p: Vec2| Vec2::new(p.x, if p.y > 0.5 * EDGE { EDGE } else { 0.0 } + 1e-9 * p.y);
    for corners in &mut lines.rest {
        *corners = corners.map(squeezed);
    }
    let refused = system.reshaped("sheet", lines.rest).err().unwrap();
    assert!(
        matches!(
            refused,
            DrapeError::NeedsRemesh { .. } | DrapeError::EmptyTriangle { .. }
        ),
        "{refused}"
    );
}

#[test]
fn a_sheet_at_rest_goes_on_to_the_rest_of_its_other_shape() {
    let cloth = sheet(0, 0.1);
    let system = hung(&cloth);
    let settings = RestSettings {
        residual: 1e-4,
        ..RestSettings::default()
    };
    let to_rest = |system: &System, state: &mut State| {
        let mut workspace = Workspace::default();
        let mut rest = PseudoTransientContinuation::near(settings);
        while !rest.finished() {
            rest.advance(system, state, &mut workspace).unwrap();
        }
        rest.steps()
    };
    let mut state = State::at_rest(&system, bent(&cloth));
    to_rest(&system, &mut state);
    // Three per cent longer along the weft: the lower edge comes down as much.
    let longer = |corners: &[Vec2; 3]| corners.map(|p| Vec2::new(p.x, 1.03 * p.y));
    let edited = system
        .reshaped("sheet", cloth.rest.iter().map(longer).collect())
        .unwrap();
    let before = residual(&edited, &state, &mut Workspace::default());
    let lowest = |state: &State| state.positions.iter().map(|p| p.y).fold(0.0, f64::min);
    let hem = lowest(&state);
    let steps = to_rest(&edited, &mut state);
    let after = residual(&edited, &state, &mut Workspace::default());
    assert!(
        before > 100.0 * after && after < 1e-4,
        "{before} {after} {steps}"
    );
    let drop = hem - lowest(&state);
    assert!((drop - 0.03 * 0.36).abs() < 1e-3, "{drop}");
}
