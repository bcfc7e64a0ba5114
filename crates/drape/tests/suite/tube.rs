//! Two panels are sewn into a tube round a ball and hang on it.

use std::sync::Arc;
use toile_drape::{
    Cloth, ContactSettings, GarmentLevel, GarmentRun, GarmentSetup, Kind, Material, MeshVertex,
    MethodKind, MethodSettings, Motion, MotionKey, ObjectId, RestSettings, SceneRun, SewSettings,
    Stage, TimeSettings, WorldEdit,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// A ball standing on its south pole, as a latitude and longitude mesh.
fn ball(radius: f64, centre: Vec3, rings: usize) -> TriangleMesh {
    let around = 2 * rings;
    let mut mesh = TriangleMesh::default();
    mesh.positions.push(centre + Vec3::y() * radius);
    for i in 1..rings {
        let polar = std::f64::consts::PI * i as f64 / rings as f64;
        for j in 0..around {
            let turn = std::f64::consts::TAU * j as f64 / around as f64;
            let p = Vec3::new(
                polar.sin() * turn.sin(),
                polar.cos(),
                polar.sin() * turn.cos(),
            );
            mesh.positions.push(centre + p * radius);
        }
    }
    mesh.positions.push(centre - Vec3::y() * radius);
    let at = |i: usize, j: usize| (1 + (i - 1) * around + j % around) as u32;
    let south = mesh.positions.len() as u32 - 1;
    for j in 0..around {
        mesh.triangles.push([0, at(1, j), at(1, j + 1)]);
        mesh.triangles
            .push([south, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            mesh.triangles
                .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles
                .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// Front and back rectangles 0.2 m from the ball, sewn along both sides and on the shoulders but
/// for a neck.
fn setup(n: usize) -> GarmentSetup {
    let (width, height) = (0.56, 0.5);
    let mut cloth = Cloth {
        materials: vec![Material::default()],
        ..Cloth::default()
    };
    let mut stitches = Vec::new();
    let rows = (n as f64 * height / width).round() as usize;
    let per_panel = ((n + 1) * (rows + 1)) as u32;
    for (panel, side) in [1.0, -1.0].into_iter().enumerate() {
        let first = cloth.positions.len() as u32;
        let flat = |i: usize, j: usize| {
            Vec2::new(
                width * (i as f64 / n as f64 - 0.5),
                height * j as f64 / rows as f64,
            )
        };
        for j in 0..=rows {
            for i in 0..=n {
                let p = flat(i, j);
                cloth
                    .positions
                    .push(Vec3::new(p.x * side, p.y + 0.85, 0.25 * side));
            }
        }
        let at = |i: usize, j: usize| first + (j * (n + 1) + i) as u32;
        for j in 0..rows {
            for i in 0..n {
                let quads = if (i + j) % 2 == 0 {
                    [
                        [(i, j), (i + 1, j), (i + 1, j + 1)],
                        [(i, j), (i + 1, j + 1), (i, j + 1)],
                    ]
                } else {
                    [
                        [(i, j), (i + 1, j), (i, j + 1)],
                        [(i + 1, j), (i + 1, j + 1), (i, j + 1)],
                    ]
                };
                for corners in quads {
                    cloth.triangles.push(corners.map(|(i, j)| at(i, j)));
                    cloth.rest.push(corners.map(|(i, j)| flat(i, j)));
                    cloth.material.push(0);
                    cloth.panel.push(panel as u32);
                }
            }
        }
        if panel == 0 {
            for j in 0..=rows {
                stitches.push([at(0, j), at(n, j) + per_panel]);
                stitches.push([at(n, j), at(0, j) + per_panel]);
            }
            for i in 0..=n {
                if i * 3 <= n || (n - i) * 3 <= n {
                    stitches.push([at(i, rows), at(n - i, rows) + per_panel]);
                }
            }
        }
    }
    let body = SurfaceTree::new(ball(0.16, Vec3::new(0.0, 1.1, 0.0), 32));
    GarmentSetup {
        levels: vec![GarmentLevel {
            cloth,
            stitches,
            layer: Vec::new(),
        }],
        counted: Vec::new(),
        colliders: vec![Arc::new(body)],
        contact: ContactSettings::default(),
        gravity: Vec3::new(0.0, -9.81, 0.0),
        sew: SewSettings::default(),
        rest: RestSettings::default(),
    }
}

#[test]
fn a_tube_is_sewn_and_comes_to_rest_on_a_ball() {
    let mut run = GarmentRun::new(setup(24)).expect("sound input");
    while run.progress().stage != Stage::Finished {
        run.advance().expect("no failure");
    }
    let measures = run.measure();
    assert!(run.gap_before_merging() <= 1e-3);
    assert!(measures.residual < 1e-2, "{}", measures.residual);
    assert_eq!(measures.body_intersections, 0);
    assert!(
        measures.strain_p99.iter().all(|&s| s < 0.05),
        "{measures:?}"
    );
    assert_eq!(run.system.mesh(&run.state.positions).component_count(), 1);
}

/// A body that stands, rises by 0.1 m within half a second and stands again.
fn rising(start: f64) -> Motion {
    let key = |time, height| MotionKey {
        time,
        translation: Vec3::y() * height,
        rotation: Vec3::zeros(),
    };
    Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(start, 0.0), key(start + 0.5, 0.1)],
    }
}

#[test]
fn a_draped_tube_goes_along_with_its_ball_and_falls_when_its_seams_are_opened() {
    let mut run = GarmentRun::new(setup(12)).expect("sound input");
    while run.progress().stage != Stage::Finished {
        run.advance().expect("no failure");
    }
    let simulation = run.into_simulation();
    let settings = TimeSettings {
        lead_in: 0.0,
        duration: f64::INFINITY,
        step: 1.0 / 60.0,
        method: MethodKind::Xpbd.into(),
    };
    let start = simulation.state.time;
    let ids: Vec<(ObjectId, Kind)> = (simulation.world().objects())
        .map(|(id, object)| (id, object.kind))
        .collect();
    let of = |kind| {
        ids.iter()
            .find(|(_, k)| *k == kind)
            .expect("both are there")
            .0
    };
    let (ball, tube) = (of(Kind::Static), of(Kind::Deformable));
    let mut run =
        SceneRun::of_simulation(simulation, settings, MethodSettings::build).expect("sound");
    let height = |run: &SceneRun| {
        let places = &run.state.positions;
        places.iter().map(|p| p.y).sum::<f64>() / places.len() as f64
    };
    // Another step may come between, so the ball starts later.
    run.edit(WorldEdit::SetMotion(ball, rising(start + 0.1)))
        .expect("sound");
    run.edit(WorldEdit::ChangeKind(ball, Kind::Animated))
        .expect("sound");
    let before = height(&run);
    for _ in 0..60 {
        run.advance().expect("sound");
    }
    let lifted = height(&run) - before;
    assert!((lifted - 0.1).abs() < 0.02, "it was lifted by {lifted} m");
    assert_eq!(run.measure().body_intersections, 0);

    let pairs: Vec<[MeshVertex; 2]> = run.world().merged().collect();
    let (count, seams) = (run.state.positions.len(), pairs.len());
    assert!(pairs.iter().flatten().all(|vertex| vertex.object == tube));
    run.edit(WorldEdit::Open(pairs)).expect("sound");
    assert_eq!(run.state.positions.len(), count + seams);
    let before = height(&run);
    for _ in 0..40 {
        run.advance().expect("sound");
    }
    let fallen = before - height(&run);
    assert!(fallen > 0.3, "it fell by {fallen} m");
}
