//! Solids whose vertices move one by one.

#![allow(clippy::unwrap_used)]

#[path = "support/sheets.rs"]
mod sheets;
#[path = "support/solids.rs"]
mod solids;

use toile_drape::{
    Material, MethodKind, Motion, MotionKey, ObjectKind, Scene, SceneObject, SceneRun, SharedTrack,
    State, Track,
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
    let mut run = SceneRun::new(scene).unwrap();
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
    let mut run = SceneRun::new(&scene).unwrap();
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
        SceneRun::new(&scene).err().unwrap().to_string()
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
    let mut run = SceneRun::new(&scene).unwrap();
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
