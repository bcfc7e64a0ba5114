//! Restitution: what hits a body or another cloth comes back with a share of its speed.

use crate::support::sheets::{object, sheet};
use crate::support::solids::block;
use toile_drape::{
    ContactSettings, Damping, DrapeError, Material, MethodKind, MethodSettings, Motion, MotionKey,
    ObjectKind, Scene, SceneObject, SceneRun,
};
use toile_geometry::Vec3;

fn bouncing(name: &str, height: f64, restitution: f64) -> SceneObject {
    let mesh = sheet([4, 4], [0.1; 2], |x, z| Vec3::new(x, height, z));
    let mut object = object(name, mesh, vec![]);
    object.kind = ObjectKind::Deformable {
        material: Material {
            restitution: Some(restitution),
            friction: 0.0,
            ..Material::default()
        },
        pins: vec![],
    };
    object
}

fn board(kind: ObjectKind) -> SceneObject {
    let corner = Vec3::new(1.0, 0.0, 1.0);
    SceneObject {
        kind,
        ..object("board", block(-corner - Vec3::y() * 0.2, corner), vec![])
    }
}

fn scene(objects: Vec<SceneObject>) -> Scene {
    Scene {
        duration: 0.7,
        step: 1.0 / 480.0,
        method: MethodKind::Xpbd.into(),
        damping: Damping::default(),
        objects,
        ..Scene::default()
    }
}

fn mean_speed(run: &SceneRun, vertices: std::ops::Range<usize>) -> f64 {
    let count = vertices.len() as f64;
    let speeds = run.state.velocities[vertices].iter();
    speeds.map(|v| v.y).sum::<f64>() / count
}

#[test]
fn a_sheet_dropped_from_h_comes_back_to_e_squared_h() {
    let (offset, height) = (ContactSettings::default().offset, 0.3f64);
    let step = 1.0 / 480.0 / 20.0;
    let speed = (2.0 * 9.81 * height).sqrt();
    for e in [0.0, 0.4, 0.8] {
        let cloth = bouncing("cloth", offset + height, e);
        let mut run = SceneRun::new(
            &scene(vec![cloth, board(ObjectKind::Static)]),
            MethodSettings::build,
        )
        .unwrap();
        let (mut down, mut highest) = (false, 0.0f64);
        while !run.finished() {
            let before = run.energy();
            run.advance().unwrap();
            assert!(run.energy() <= before + 1e-4 * before.abs(), "energy grew");
            let heights = run.state.positions.iter().map(|p| p.y - offset);
            let mean = heights.sum::<f64>() / run.state.positions.len() as f64;
            down |= mean < 0.01;
            if down && mean_speed(&run, 0..25) > -0.05 {
                highest = highest.max(mean);
            }
        }
        // A substep's way at the impact, down and up, and a substep of falling in the speed.
        let tolerance = 2.0 * speed * step + 2.0 * e * e * speed * step;
        let off = (highest - e * e * height).abs();
        assert!(down && off < tolerance, "{e}: {highest} {off} {tolerance}");
    }
}

#[test]
fn a_board_that_comes_up_throws_by_its_own_speed_too() {
    // At rest against a board at 1 m/s: (1 + e) times that.
    for e in [0.0, 0.5] {
        let keys = [(0.0, 0.0), (1.0, 1.0)];
        let motion = Motion {
            pivot: Vec3::zeros(),
            keys: keys
                .map(|(time, y)| MotionKey {
                    time,
                    translation: Vec3::new(0.0, y, 0.0),
                    rotation: Vec3::zeros(),
                })
                .to_vec(),
        };
        let mut still = scene(vec![
            bouncing("cloth", 0.1, e),
            board(ObjectKind::moving(motion)),
        ]);
        still.gravity = Vec3::zeros();
        still.duration = 0.15;
        let mut run = SceneRun::new(&still, MethodSettings::build).unwrap();
        while !run.finished() {
            run.advance().unwrap();
        }
        let speed = mean_speed(&run, 0..25);
        assert!((speed - (1.0 + e)).abs() < 0.02, "{e}: {speed}");
    }
}

#[test]
fn sheets_that_meet_part_with_a_share_of_their_speed_and_keep_momentum() {
    for e in [0.3, 1.0] {
        let mut meeting = scene(vec![bouncing("low", 0.0, e), bouncing("high", 0.03, e)]);
        meeting.gravity = Vec3::zeros();
        meeting.duration = 0.1;
        meeting.contact.cloth_offset = 2e-3;
        let mut run = SceneRun::new(&meeting, MethodSettings::build).unwrap();
        for (k, v) in run.state_mut().velocities.iter_mut().enumerate() {
            *v = Vec3::y() * if k < 25 { 0.25 } else { -0.75 };
        }
        while !run.finished() {
            run.advance().unwrap();
        }
        let [low, high] = [mean_speed(&run, 0..25), mean_speed(&run, 25..50)];
        assert!((high - low - e).abs() < 0.03, "{e}: {low} {high}");
        assert!((high + low + 0.5).abs() < 5e-3, "{e}: {low} {high}");
        assert_eq!(run.crossings(), 0);
    }
}

#[test]
fn restitution_out_of_range_or_unknown_to_the_method_is_refused() {
    for wrong in [-0.1, 1.5, f64::NAN] {
        let error = SceneRun::new(
            &scene(vec![bouncing("ball", 0.1, wrong)]),
            MethodSettings::build,
        )
        .err();
        let said = error.unwrap().to_string();
        assert!(
            said.contains("restitution") && said.contains("0 to 1"),
            "{said}"
        );
    }
    let mut blind = scene(vec![bouncing("ball", 0.1, 0.5)]);
    blind.method = MethodKind::ImplicitEuler.into();
    match SceneRun::new(&blind, MethodSettings::build) {
        Err(error @ DrapeError::Scene { .. }) => {
            let said = error.to_string();
            assert!(said.contains("\"ball\"") && said.contains("xpbd"), "{said}");
        }
        _ => panic!("not refused"),
    }
}
