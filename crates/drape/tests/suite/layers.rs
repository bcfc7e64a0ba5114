//! Cloths worn one over another: the order is kept, what starts in the wrong order is led out, and
//! what cannot be in order is refused by name.

use crate::support::sheets::{self, object, sheet};
use crate::support::solids::sphere;
use toile_drape::{
    ContactSettings, Damping, DrapeError, Material, Measures, MethodKind, MethodSettings,
    ObjectKind, Scene, SceneElastic, SceneEnd, SceneObject, SceneRun, State,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// Size of the sheets and radius of the sphere (m).
const WIDTH: f64 = 0.3;
const RADIUS: f64 = 0.07;

/// A level sheet over the sphere, facing up.
fn level(cells: usize, height: impl Fn(f64, f64) -> f64) -> TriangleMesh {
    sheet([cells, cells], [WIDTH; 2], |u, v| {
        let (x, z) = (u - 0.5 * WIDTH, 0.5 * WIDTH - v);
        Vec3::new(x, height(x, z), z)
    })
}

fn ball() -> SceneObject {
    SceneObject {
        kind: ObjectKind::Static,
        ..object("ball", sphere(RADIUS, Vec3::zeros()), vec![])
    }
}

fn worn(name: &str, mesh: TriangleMesh, layer: u16) -> SceneObject {
    SceneObject {
        layer,
        ..object(name, mesh, vec![])
    }
}

fn scene(cloths: Vec<SceneObject>) -> Scene {
    let mut objects = cloths;
    objects.push(ball());
    Scene {
        duration: 0.8,
        method: MethodKind::Xpbd.into(),
        damping: Damping {
            mass: 3.0,
            stiffness: 0.0,
        },
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects,
        ..Scene::default()
    }
}

fn finish(scene: Scene) -> (SceneRun, Measures) {
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let measures = run.measure();
    (run, measures)
}

/// Least signed distance (m) of the vertices of `outer` from `inner`, those near the border of `inner`
/// left out; and how many count. By the nearest point, not as the simulation decides it.
fn least_distance(outer: &TriangleMesh, inner: &TriangleMesh) -> (f64, usize) {
    let border: Vec<Vec3> = {
        let topology = inner.topology();
        let ends = topology.boundary().flat_map(|e| topology.edges[e]);
        ends.map(|v| inner.positions[v as usize]).collect()
    };
    let tree = SurfaceTree::new(inner.clone());
    let (mut least, mut count) = (f64::INFINITY, 0);
    for &p in &outer.positions {
        let closest = tree.closest_point(p, 0.05);
        let Some(closest) = closest else { continue };
        if border.iter().all(|b| (b - closest.point).norm() > 0.03) {
            least = least.min(closest.signed_distance);
            count += 1;
        }
    }
    (least, count)
}

fn assert_in_order(run: &SceneRun, measures: &Measures, inner: usize, outer: usize) {
    assert_eq!(measures.body_intersections, 0);
    assert_eq!(measures.self_intersections, 0);
    for layer in &measures.layers {
        assert_eq!(
            [layer.astray, layer.outer_intersections],
            [0; 2],
            "{layer:?}"
        );
    }
    let meshes = run.meshes();
    let (least, count) = least_distance(&meshes[outer], &meshes[inner]);
    assert!(least > 0.0 && count > 50, "{least} {count}");
}

#[test]
fn two_sheets_over_a_sphere_keep_their_order() {
    let low = worn("shirt", level(14, |_, _| RADIUS + 0.01), 1);
    let high = worn("coat", level(13, |_, _| RADIUS + 0.02), 2);
    let (run, measures) = finish(scene(vec![low, high]));
    assert_eq!(run.cloth_tally().unwrap().astray, [0; 3]);
    assert_eq!(measures.layers.len(), 2);
    assert_in_order(&run, &measures, 0, 1);
}

#[test]
fn a_coat_that_starts_under_the_shirt_is_led_out_over_it() {
    let low = worn("coat", level(13, |_, _| RADIUS + 0.01), 2);
    let high = worn("shirt", level(14, |_, _| RADIUS + 0.02), 1);
    let (run, measures) = finish(scene(vec![low, high]));
    let tally = run.cloth_tally().unwrap();
    assert!(tally.astray[0] > 100 && tally.astray[2] == 0, "{tally:?}");
    assert_in_order(&run, &measures, 1, 0);
}

#[test]
fn layers_that_start_in_each_other_are_parted_by_their_order() {
    // The borders cross in waves: about half of either lies on the wrong side.
    let wave = |x: f64, z: f64| 0.008 * (40.0 * x).sin() * (30.0 * z).cos();
    let cloths = vec![
        worn("shirt", level(14, |_, _| RADIUS + 0.02), 0),
        worn("coat", level(13, |x, z| RADIUS + 0.02 + wave(x, z)), 7),
    ];
    let (run, measures) = finish(scene(cloths));
    let tally = run.cloth_tally().unwrap();
    assert!(tally.crossings[0] > 20 && tally.astray[0] > 20, "{tally:?}");
    assert_eq!([tally.crossings[2], tally.astray[2]], [0; 2]);
    assert_in_order(&run, &measures, 0, 1);
}

#[test]
fn three_layers_come_to_rest_by_newtons_method_too() {
    let mut cloths = Vec::new();
    for (k, name) in ["skin", "shirt", "coat"].into_iter().enumerate() {
        let height = RADIUS + 0.008 + 0.004 * k as f64;
        cloths.push(worn(name, level(9 + k, |_, _| height), k as u16 + 1));
    }
    let start = scene(cloths);
    let (run, _) = finish(start.clone());
    // From where the motion ended: the shapes at rest are those of the start.
    let mut rest = Scene {
        method: MethodKind::Rest.into(),
        ..start
    };
    for (object, mesh) in rest.objects.iter_mut().zip(run.meshes()) {
        if let ObjectKind::Deformable { material, .. } = &object.kind {
            let cloth = toile_drape::Cloth::from_mesh(&object.name, &object.mesh, material.clone())
                .unwrap();
            object.cloth = Some(toile_drape::Cloth {
                positions: mesh.positions.clone(),
                ..cloth
            });
            object.mesh = mesh;
        }
    }
    rest.method.iterations = Some(60);
    let (run, measures) = finish(rest);
    assert_in_order(&run, &measures, 0, 1);
    assert_in_order(&run, &measures, 1, 2);
}

#[test]
fn the_pull_between_layers_keeps_momentum() {
    // Without body and gravity the middle of both stays where it is.
    let low = worn("coat", level(8, |_, _| 0.0), 2);
    let high = worn("shirt", level(8, |_, _| 0.01), 1);
    let mut free = scene(vec![low, high]);
    free.objects.pop();
    free.gravity = Vec3::zeros();
    free.duration = 0.2;
    let middle = |run: &SceneRun| {
        let masses = run.system.rest.mass.iter().zip(&run.state.positions);
        masses.map(|(m, p)| p * *m).sum::<Vec3>() / run.system.rest.mass.iter().sum::<f64>()
    };
    let start = middle(&SceneRun::new(&free, MethodSettings::build).unwrap());
    let (run, measures) = finish(free);
    let off = (middle(&run) - start).norm();
    let tally = run.cloth_tally().unwrap();
    // Single precision rounds 0.15 m to 4e-9 m, over a substep of 0.4 ms 1e-5 m/s a vertex and pass; over
    // 480 substeps of some ten passes and 162 vertices 5e-5 m/s in the mean, 1e-5 m in 0.2 s.
    assert!(off < 2e-5, "{off} {tally:?}");
    assert_eq!(measures.self_intersections, 0);
    let heights = |k: usize| run.meshes()[k].positions.clone().into_iter().map(|p| p.y);
    let [coat, shirt] = [
        heights(0).fold(f64::INFINITY, f64::min),
        heights(1).fold(f64::NEG_INFINITY, f64::max),
    ];
    assert!(coat > shirt, "{coat} {shirt}");
}

#[test]
fn what_a_saved_state_knows_of_layers_goes_on_to_the_same_bytes() {
    // The outer cloth flies in under the inner one, which it does not cross: nobody asks for its side.
    let mut mesh = sheet([6; 2], [0.2; 2], |u, v| Vec3::new(u, 0.0, -v));
    let half = mesh.positions.len();
    let outer = sheet([6; 2], [0.2; 2], |u, v| {
        Vec3::new(u + 0.4, -0.05, -v - 0.004)
    });
    mesh.positions.extend(outer.positions);
    let shifted = outer.triangles.iter().map(|t| t.map(|v| v + half as u32));
    mesh.triangles.extend(shifted);
    let (mut system, mut state) = sheets::cloth(&mesh, Material::default());
    system.control.gravity = Vec3::zeros();
    system = system.with(|builder| {
        builder.contact.cloth_offset = 2e-3;
        builder.layer = (0..2 * half).map(|v| u16::from(v >= half)).collect();
    });
    for velocity in &mut state.velocities[half..] {
        *velocity = Vec3::new(-3.0, 0.0, 0.0);
    }
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let go = |state: &mut State, steps: usize| {
            let mut method = MethodSettings::from(kind)
                .build()
                .expect("a method that there is");
            for _ in 0..steps {
                method.advance(&system, state, 0.01).unwrap();
            }
        };
        let (mut whole, mut resumed) = (state.clone(), state.clone());
        go(&mut whole, 13);
        go(&mut resumed, 11);
        go(&mut resumed, 2);
        assert!(whole == resumed, "{kind:?}");
        let over = whole.positions[half].x - whole.positions[0].x;
        assert!(
            over.abs() < 0.1,
            "{kind:?}: under the inner one by now, {over}"
        );
    }
}

#[test]
fn layers_that_cannot_be_in_order_are_refused_by_name() {
    let two = || {
        scene(vec![
            worn("shirt", level(4, |_, _| 0.1), 1),
            worn("coat", level(4, |_, _| 0.11), 2),
        ])
    };
    let refused = |scene: Scene| match SceneRun::new(&scene, MethodSettings::build) {
        Err(error @ DrapeError::Scene { .. }) => error.to_string(),
        _ => panic!("not refused"),
    };
    let mut through = two();
    through.contact.cloth_offset = 0.0;
    let said = refused(through);
    assert!(
        said.contains("\"coat\"") && said.contains("cloth_offset"),
        "{said}"
    );
    let mut blind = two();
    blind.method = MethodKind::VelocityVerlet.into();
    let said = refused(blind);
    assert!(
        said.contains("velocity-verlet") && said.contains("implicit-midpoint, rest, xpbd"),
        "{said}"
    );
    let mut body = two();
    body.objects[2].layer = 3;
    let said = refused(body);
    assert!(
        said.contains("\"ball\"") && said.contains("only cloth"),
        "{said}"
    );
    let mut far = two();
    far.objects[1].layer = 1000;
    assert!(refused(far).contains("from 0 to 999"));
    // One layer alone, whatever its number, is none.
    let mut one = two();
    one.objects[1].layer = 1;
    one.contact.cloth_offset = 0.0;
    assert!(SceneRun::new(&one, MethodSettings::build).is_ok());
}

#[test]
fn cloths_sewn_together_are_in_no_order_there() {
    let mut joined = scene(vec![
        worn("shirt", level(6, |_, _| RADIUS + 0.01), 1),
        worn("coat", level(6, |_, _| RADIUS + 0.012), 2),
    ]);
    joined.elastics = vec![SceneElastic {
        from: SceneEnd::Vertex {
            object: 0,
            vertex: 24,
        },
        to: SceneEnd::Vertex {
            object: 1,
            vertex: 24,
        },
        stiffness: 10.0,
        merge_within: Some(0.01),
    }];
    let (run, measures) = finish(joined);
    assert_eq!(run.system.vertex_count(), 2 * 49 - 1);
    assert_eq!(run.system.layer[24], toile_drape::collision::BETWEEN_LAYERS);
    assert_eq!(measures.self_intersections, 0);
    assert!(measures.layers.iter().all(|layer| layer.astray == 0));
}
