//! Surfaces that are no disk, each refused by name.

use crate::common::{grid, options};
use std::f64::consts::TAU;
use toile_flatten::{FlattenError, Options, flatten};
use toile_geometry::{TriangleMesh, Vec3};

fn why(mesh: &TriangleMesh) -> FlattenError {
    flatten(mesh, &options()).unwrap_err()
}

fn sheet() -> TriangleMesh {
    grid(4, 4, |u, v| Vec3::new(0.1 * u, 0.1 * v, 0.0))
}

/// A strip whose ends are joined, with a half turn or without.
fn band(half_turn: bool) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let count = 12u32;
    for k in 0..count {
        let angle = TAU * f64::from(k) / f64::from(count);
        let turn = if half_turn { 0.5 * angle } else { 0.0 };
        let out = Vec3::new(angle.cos(), 0.0, angle.sin());
        let side = out * turn.sin() + Vec3::y() * turn.cos();
        mesh.positions.push(out * 0.1 - side * 0.02);
        mesh.positions.push(out * 0.1 + side * 0.02);
    }
    for k in 0..count {
        let (a, b) = (2 * k, 2 * k + 1);
        let (c, d) = match (k + 1 == count, half_turn) {
            (false, _) => (a + 2, b + 2),
            (true, false) => (0, 1),
            (true, true) => (1, 0),
        };
        mesh.triangles.extend([[a, b, c], [b, d, c]]);
    }
    mesh
}

#[test]
fn what_is_no_disk_is_refused_by_name() {
    assert_eq!(why(&TriangleMesh::default()), FlattenError::Empty);
    let cube = TriangleMesh::cuboid(Vec3::zeros(), Vec3::repeat(0.1));
    assert_eq!(why(&cube), FlattenError::Closed);
    let two = FlattenError::Holes {
        outlines: 2,
        holes: 1,
    };
    assert_eq!(why(&band(false)), two);
    assert_eq!(why(&band(true)), FlattenError::OneSided);
    let mut holes = sheet();
    holes
        .triangles
        .retain(|t| !t.contains(&6) && !t.contains(&18));
    assert!(matches!(
        why(&holes),
        FlattenError::Holes { .. } | FlattenError::Branches { .. }
    ));
    let mut pieces = sheet();
    let mut other = sheet();
    other.positions.iter_mut().for_each(|p| p.z += 1.0);
    pieces.append(&other);
    assert_eq!(why(&pieces), FlattenError::Pieces(2));
}

#[test]
fn damaged_meshes_are_refused_by_name() {
    let mut fin = sheet();
    fin.positions.push(Vec3::new(0.05, 0.05, 0.1));
    fin.triangles.push([12, 13, 25]);
    assert!(matches!(why(&fin), FlattenError::Branches { .. }));
    // Two triangles that touch in a vertex alone.
    let bow = TriangleMesh {
        positions: vec![
            Vec3::zeros(),
            Vec3::new(0.1, 0.0, 0.0),
            Vec3::new(0.1, 0.1, 0.0),
            Vec3::new(-0.1, 0.0, 0.0),
            Vec3::new(-0.1, -0.1, 0.0),
        ],
        triangles: vec![[0, 1, 2], [0, 3, 4]],
    };
    assert!(matches!(why(&bow), FlattenError::Branches { .. }));
    let mut nan = sheet();
    nan.positions[3].y = f64::NAN;
    assert!(matches!(why(&nan), FlattenError::Mesh(_)));
    let mut huge = sheet();
    huge.positions[3].y = 1e200;
    assert!(matches!(why(&huge), FlattenError::NoArea { .. }));
    let mut sliver = sheet();
    sliver.positions[12] = sliver.positions[11];
    assert!(matches!(why(&sliver), FlattenError::NoArea { .. }));
    let mut missing = sheet();
    missing.triangles[0][1] = 99;
    assert!(matches!(why(&missing), FlattenError::Mesh(_)));
}

#[test]
fn grains_numbers_and_cuts_are_refused_by_name() {
    let with = |asked: Options| flatten(&sheet(), &asked).unwrap_err();
    for grain in [Vec3::zeros(), Vec3::z(), Vec3::repeat(f64::NAN)] {
        let asked = Options { grain, ..options() };
        assert_eq!(with(asked), FlattenError::Grain);
    }
    for strain in [0.0, -1.0, f64::NAN] {
        let asked = Options {
            strain,
            ..options()
        };
        assert!(matches!(with(asked), FlattenError::Number { .. }));
    }
    let mut soft = options();
    soft.law.stiffness[3] = 0.0;
    assert!(matches!(with(soft), FlattenError::Number { .. }));
    for cut in [
        vec![],
        vec![12],
        vec![12, 7],
        vec![2, 3],
        vec![2, 12],
        vec![2, 7, 12, 7],
        vec![2, 99],
        vec![2, 7, 12, 17, 22],
    ] {
        let asked = Options {
            cuts: vec![cut],
            ..options()
        };
        assert!(matches!(with(asked), FlattenError::Cut { cut: 0, .. }));
    }
}

#[test]
fn a_flat_sheet_stays_as_it_is() {
    let mut mesh = sheet();
    mesh.positions.push(Vec3::repeat(7.0));
    let flat = flatten(&mesh, &options()).unwrap();
    assert_eq!(flat.region.vertex_count(), 25);
    assert!(flat.minimum.energy < 1e-15 && flat.strain < 1e-7);
}
