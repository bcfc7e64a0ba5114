//! Solids whose vertices move one by one.

use crate::support::sheets;
use crate::support::solids;
use toile_drape::{
    Material, MethodKind, MethodSettings, Motion, MotionKey, ObjectKind, Scene, SceneObject,
    SceneRun, SharedTrack, State, Track,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A track by a rule.
struct Rule<F>(F);

impl<F: Fn(f64) -> Vec<Vec3> + Send + Sync> Track for Rule<F> {
    fn positions(&self, time: f64) -> Vec<Vec3> {
        (self.0)(time)
    }

    fn digest(&self) -> u64 {
        self.positions(0.1)
            .iter()
            .map(|p| p.x.to_bits())
            .fold(1, |sum, bits| sum ^ bits)
    }
}

fn tracked(rule: impl Fn(f64) -> Vec<Vec3> + Send + Sync + 'static) -> ObjectKind {
    ObjectKind::tracked(SharedTrack::new(Rule(rule)))
}

/// A sheet over a solid.
fn over(solid: TriangleMesh, kind: ObjectKind, [wide, high]: [f64; 2]) -> Scene {
    let cells = (wide / 0.02).round() as usize;
    let middle = 0.5 * wide;
    let sheet = sheets::sheet([cells; 2], [wide; 2], |x, z| {
        Vec3::new(x - middle, high, z - middle)
    });
    let object = |name: &str, kind, mesh| SceneObject {
        name: name.to_owned(),
        kind,
        mesh,
        cloth: None,
        layer: 0,
    };
    let cloth = ObjectKind::Deformable {
        material: Material::default(),
        pins: vec![],
    };
    Scene {
        duration: 1.5,
        step: 1.0 / 60.0,
        method: MethodKind::Xpbd.into(),
        objects: vec![object("sheet", cloth, sheet), object("solid", kind, solid)],
        ..Scene::default()
    }
}

fn end_of(scene: &Scene) -> State {
    let mut run = SceneRun::new(scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    run.state.clone()
}

#[test]
fn vertices_that_move_together_move_cloth_as_the_whole_does() {
    let ball = solids::sphere(0.15, Vec3::zeros());
    let way = Vec3::new(0.2, 0.05, -0.1);
    let motion = Motion {
        pivot: Vec3::zeros(),
        keys: [0.2, 1.0]
            .map(|time| MotionKey {
                time,
                translation: if time > 0.5 { way } else { Vec3::zeros() },
                rotation: Vec3::zeros(),
            })
            .to_vec(),
    };
    let whole = over(
        ball.clone(),
        ObjectKind::moving(motion.clone()),
        [0.4, 0.16],
    );
    let places = ball.positions.clone();
    let one_by_one = tracked(move |time| {
        let pose = motion.pose(time);
        places.iter().map(|&p| pose.apply(p)).collect()
    });
    let each = over(ball, one_by_one, [0.4, 0.16]);
    let [whole, each] = [whole, each].map(|scene| end_of(&scene));
    assert_eq!(whole.positions, each.positions);
    assert_eq!(whole.solid_friction, each.solid_friction);
    assert!(!whole.solid_friction.is_empty());
}

#[test]
fn cloth_stays_on_a_ball_that_breathes_and_sways() {
    let ball = solids::sphere(0.15, Vec3::zeros());
    let places = ball.positions.clone();
    let kind = tracked(move |time| {
        let grown = 1.0 + 0.15 * (6.0 * time).sin();
        let shift = Vec3::new(0.1 * (4.0 * time).sin(), 0.0, 0.0);
        let sway = |p: &Vec3| Vec3::new(0.3 * p.y * (5.0 * time).sin(), 0.0, 0.0);
        places
            .iter()
            .map(|p| (p + sway(p)) * grown + shift)
            .collect()
    });
    let scene = over(ball, kind, [0.6, 0.165]);
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    let mut touched = 0;
    while !run.finished() {
        run.advance().unwrap();
        let measures = run.measure();
        assert_eq!(measures.body_intersections, 0, "at {} s", run.state.time);
        assert!(measures.penetration_max <= 0.0, "at {} s", run.state.time);
        touched += usize::from(!run.state.solid_friction.is_empty());
    }
    assert!(touched > 60, "it hardly touched: {touched}");
    // Not thrown off: the middle of the sheet lies on top.
    let top = run
        .state
        .positions
        .iter()
        .map(|p| p.y)
        .fold(f64::MIN, f64::max);
    assert!(top > 0.1 && top < 0.25, "{top}");
}

#[test]
fn a_track_that_does_not_fit_is_refused() {
    let ball = solids::sphere(0.1, Vec3::zeros());
    let count = ball.positions.len();
    let refused = |kind: ObjectKind| {
        let scene = over(ball.clone(), kind, [0.1, 0.2]);
        SceneRun::new(&scene, MethodSettings::build)
            .err()
            .unwrap()
            .to_string()
    };
    let said = refused(tracked(move |_| vec![Vec3::zeros(); count - 1]));
    assert!(
        said.contains("vertices") && said.contains("solid"),
        "{said}"
    );
    let said = refused(tracked(move |_| vec![Vec3::repeat(f64::NAN); count]));
    assert!(said.contains("no number for vertex 0"), "{said}");
}

/// A flat pyramid with its tip at a height, beside the vertices of the sheet over it.
fn spire(tip: f64) -> TriangleMesh {
    let foot = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut positions: Vec<Vec3> = foot
        .iter()
        .map(|[x, z]| Vec3::new(0.15 * x, tip - 0.06, 0.15 * z))
        .collect();
    positions.push(Vec3::new(0.0, tip, 0.0));
    positions
        .iter_mut()
        .for_each(|p| *p += Vec3::new(0.007, 0.0, 0.013));
    TriangleMesh {
        positions,
        triangles: vec![
            [0, 4, 1],
            [1, 4, 2],
            [2, 4, 3],
            [3, 4, 0],
            [0, 1, 2],
            [0, 2, 3],
        ],
    }
}

#[test]
fn a_tip_that_rises_under_the_middle_of_a_face_lifts_it() {
    let at = |time: f64| 0.094 + 0.5 * time;
    let kind = tracked(move |time| spire(at(time)).positions);
    let mut scene = over(spire(at(0.0)), kind, [0.2, 0.1]);
    scene.duration = 0.3;
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
        let measures = run.measure();
        let time = run.state.time;
        assert_eq!(measures.body_intersections, 0, "at {time:.3} s");
    }
    // It is carried by the tip, and not thrown off.
    let highest = run.state.positions.iter().map(|p| p.y).fold(0.0, f64::max);
    let tip = at(run.state.time);
    assert!(
        (tip - 0.01..tip + 0.02).contains(&highest),
        "{highest} {tip}"
    );
}

/// A roof 30 cm long with slopes of 84 degrees, its ridge at a height, turned by 25 degrees about the vertical.
fn roof(ridge: f64) -> TriangleMesh {
    let section = [[-0.022, ridge - 0.2], [0.0, ridge], [0.022, ridge - 0.2]];
    let (sin, cos) = 25.0_f64.to_radians().sin_cos();
    let ends = [-0.15, 0.15].map(|z| {
        section.map(|[x, y]| Vec3::new(cos * x + sin * z + 0.003, y, cos * z - sin * x + 0.007))
    });
    TriangleMesh {
        positions: ends.concat(),
        triangles: vec![
            [0, 3, 1],
            [3, 4, 1],
            [1, 4, 2],
            [4, 5, 2],
            [0, 2, 5],
            [0, 5, 3],
            [0, 1, 2],
            [3, 5, 4],
        ],
    }
}

#[test]
fn a_ridge_that_rises_lifts_the_edges_that_lie_across_it() {
    let at = |time: f64| 0.094 + 0.25 * time;
    let kind = tracked(move |time| roof(at(time)).positions);
    let mut scene = over(roof(at(0.0)), kind, [0.2, 0.1]);
    scene.duration = 0.4;
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
        let crossings = run.measure().body_intersections;
        assert_eq!(crossings, 0, "at {:.3} s", run.state.time);
    }
    let highest = run.state.positions.iter().map(|p| p.y).fold(0.0, f64::max);
    let ridge = at(run.state.time);
    assert!(highest > ridge, "{highest} {ridge}");
}

/// Two balls beside an upright sheet, as one surface, with so much room between them (m).
fn jaws(room: f64) -> TriangleMesh {
    let mut both = TriangleMesh::default();
    for side in [-1.0, 1.0] {
        let middle = Vec3::new(side * (0.1 + 0.5 * room), 0.01, 0.003);
        both.append(&solids::sphere(0.1, middle));
    }
    both
}

#[test]
fn cloth_between_two_parts_of_a_skin_keeps_between_them_and_is_let_go_where_they_go_through_each_other()
 {
    // Down to 2 mm of room, 2 mm into each other, and apart again.
    let room = |time: f64| match time {
        t if t < 0.3 => 0.02 - 0.06 * t,
        t if t < 0.6 => 0.002,
        t if t < 0.7 => 0.002 - 0.04 * (t - 0.6),
        t if t < 0.8 => -0.002,
        t => -0.002 + 0.06 * (t - 0.8),
    };
    let mut scene = over(
        jaws(room(0.0)),
        tracked(move |time| jaws(room(time)).positions),
        [0.2, 0.0],
    );
    let sheet = sheets::sheet([10; 2], [0.2; 2], |u, v| Vec3::new(0.0, u - 0.1, v - 0.1));
    let pins = (0..sheet.positions.len() as u32).filter(|&v| sheet.positions[v as usize].y > 0.09);
    scene.objects[0].kind = ObjectKind::Deformable {
        material: Material::default(),
        pins: pins.collect(),
    };
    scene.objects[0].mesh = sheet;
    scene.duration = 1.2;
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    let mut buried = 0;
    while !run.finished() {
        run.advance().unwrap();
        let (time, measures) = (run.state.time, run.measure());
        if room(time) >= 0.002 {
            assert_eq!(measures.body_intersections, 0, "at {time:.3} s");
        }
        buried += measures.buried_intersections;
        // Contact lets cloth out at 1 m/s over the surface.
        let fastest = run
            .state
            .velocities
            .iter()
            .map(Vec3::norm)
            .fold(0.0, f64::max);
        assert!(fastest < 1.5, "{fastest} m/s at {time:.3} s");
    }
    assert!(
        buried > 0,
        "nothing was met where they go through each other"
    );
}
