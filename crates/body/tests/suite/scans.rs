//! The tape on closed meshes that are none of our own bodies.

use crate::common::{obj, shared};
use std::f64::consts::{PI, TAU};
use toile_body::{Figure, Mannequin, Scan, ScanLandmarks};
use toile_geometry::{TriangleMesh, Vec3};
use toile_measure::Origin;

/// A closed tube of height 1.7 m with half-axes `a` and `b` (m), turned about Y.
fn tube([a, b]: [f64; 2], sides: usize, turn: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let rings = 34;
    let (sin, cos) = turn.sin_cos();
    for ring in 0..=rings {
        for k in 0..sides {
            let t = TAU * k as f64 / sides as f64;
            let (x, z) = (a * t.cos(), b * t.sin());
            let y = 1.7 * ring as f64 / rings as f64;
            mesh.positions
                .push(Vec3::new(x * cos + z * sin, y, z * cos - x * sin));
        }
    }
    let low = mesh.positions.len() as u32;
    mesh.positions.push(Vec3::zeros());
    mesh.positions.push(Vec3::y() * 1.7);
    let at = |ring: usize, k: usize| (ring * sides + k % sides) as u32;
    for ring in 0..rings {
        for k in 0..sides {
            let [p, q] = [at(ring, k), at(ring, k + 1)];
            let [r, s] = [at(ring + 1, k), at(ring + 1, k + 1)];
            mesh.triangles.push([p, r, q]);
            mesh.triangles.push([q, r, s]);
        }
    }
    for k in 0..sides {
        mesh.triangles.push([at(0, k), at(0, k + 1), low]);
        mesh.triangles
            .push([at(rings, k + 1), at(rings, k), low + 1]);
    }
    mesh
}

/// Perimeter of an ellipse (Ramanujan 1914, second formula: to 1e-9 at these axes).
fn perimeter(a: f64, b: f64) -> f64 {
    let h = ((a - b) / (a + b)).powi(2);
    PI * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()))
}

#[test]
fn cylinders_and_ellipses_within_a_tenth_of_a_millimetre() {
    for axes in [[0.15, 0.15], [0.19, 0.12], [0.05, 0.05]] {
        for sides in [300, 700] {
            for turn in [0.0, 0.4] {
                let scan = Scan::new(tube(axes, sides, turn), ScanLandmarks::default()).unwrap();
                let loops = scan.level(0.777);
                assert_eq!(loops.len(), 1);
                let gap = loops[0].girth() - perimeter(axes[0], axes[1]);
                assert!(gap.abs() < 1e-4, "{axes:?} {sides}: {gap}");
                assert!((loops[0].length() - loops[0].girth()).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn what_is_no_closed_body_is_refused_with_a_remedy() {
    let good = tube([0.15, 0.1], 24, 0.0);
    let mut open = good.clone();
    open.triangles.pop();
    let mut inside_out = good.clone();
    for t in &mut inside_out.triangles {
        t.swap(1, 2);
    }
    let mut millimetres = good.clone();
    for p in &mut millimetres.positions {
        *p *= 1000.0;
    }
    let mut broken = good.clone();
    broken.positions[3].x = f64::NAN;
    for (mesh, word) in [
        (open, "closed"),
        (inside_out, "inside out"),
        (millimetres, "metres"),
        (broken, "repair"),
        (TriangleMesh::default(), "empty"),
    ] {
        let error = Scan::new(mesh, ScanLandmarks::default()).err().unwrap();
        assert!(error.to_string().contains(word), "{error}");
    }
    let above = ScanLandmarks {
        waist: Some(9.0),
        ..ScanLandmarks::default()
    };
    assert!(Scan::new(good, above).is_err());
}

#[test]
fn our_own_body_measured_as_a_mesh_has_its_measurements() {
    for figure in [Figure::Woman, Figure::Man, Figure::Child8] {
        let body = Mannequin::new(&figure.average(), figure).unwrap();
        let levels = body.levels();
        let marks = ScanLandmarks {
            crotch: Some(levels.crotch),
            nape: Some(body.landmarks().nape.into()),
            shoulder_tip: Some(body.landmarks().shoulder_tips[0].into()),
            ..ScanLandmarks::default()
        };
        let scan = Scan::new(body.skin().clone(), marks).unwrap();
        let table = scan.measurements();
        for name in ["height", "bust", "waist", "hips", "shoulder_w", "leg_circ"] {
            let gap = table.get(name).unwrap() - body.taken(name).unwrap();
            // A child's bust lies at the upper end of its range, which the armpit found on the mesh sets.
            let may = match (figure, name) {
                (Figure::Child8, "bust") => 2e-3,
                _ => 1e-3,
            };
            assert!(gap.abs() < may, "{figure:?} {name}: {gap}");
        }
        // Levels that are found lie near those that are known.
        let found = Scan::new(body.skin().clone(), ScanLandmarks::default()).unwrap();
        let gap = found.landmarks().crotch.unwrap() - levels.crotch;
        assert!(gap.abs() < 0.004 * levels.crown, "{figure:?}: {gap}");
        // And a body can be grown from what was measured.
        assert!(Mannequin::new(&found.measurements(), figure).is_ok());
    }
}

#[test]
fn published_sections_of_eight_bodies_within_a_millimetre() {
    let Some(path) = shared("body/makehuman/sections.json") else {
        return;
    };
    let file: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let (mut worst, mut count): (f64, usize) = (0.0, 0);
    for (name, body) in file.as_object().unwrap() {
        let mesh = path.with_file_name(format!("{name}.obj"));
        let scan = Scan::new(
            obj(&std::fs::read_to_string(mesh).unwrap()),
            ScanLandmarks::default(),
        )
        .unwrap();
        let [low, high] = scan.mesh().bounds().unwrap();
        let height = high.y - low.y;
        for row in body["slices"].as_array().unwrap() {
            let row: Vec<f64> = row
                .as_array()
                .unwrap()
                .iter()
                .map(|x| x.as_f64().unwrap())
                .collect();
            let loops = scan.level(row[0] * height);
            let near = loops
                .iter()
                .map(|l| (l.length() * 1e3 - row[3]).abs() + (l.girth() * 1e3 - row[4]).abs())
                .fold(f64::INFINITY, f64::min);
            worst = worst.max(near);
            count += 1;
            assert!(near < 1.0, "{name} {row:?}: {near}");
        }
        let table = scan.measurements();
        let asked = table.iter().filter(|(_, m)| m.origin == Origin::Asked);
        assert!(asked.count() >= 15, "{name}: {table:?}");
        let figure = match name {
            _ if name.contains("child") => Figure::Child8,
            _ if name.starts_with("female") => Figure::Woman,
            _ => Figure::Man,
        };
        let error = Mannequin::new(&table, figure).err();
        assert!(
            error.is_none(),
            "{name}: {error:?} {:?} {table:?}",
            scan.landmarks()
        );
    }
    println!("{count} sections, worst {worst:.3} mm");
    assert!(count > 1000);
}
