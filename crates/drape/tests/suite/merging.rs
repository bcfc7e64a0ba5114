//! Ends of elastics that become one vertex: where it lies and what it weighs.

use crate::support::sheets::{object, sheet};
use toile_drape::{
    MethodKind, MethodSettings, Scene, SceneElastic, SceneEnd, SceneObject, SceneRun,
};
use toile_geometry::{TriangleMesh, Vec3};

fn square(at: Vec3) -> TriangleMesh {
    sheet([2, 2], [0.1, 0.1], |u, v| at + Vec3::new(u, 0.0, v))
}

/// An elastic between vertices of the first and the second object, merged at once.
fn merged([from, to]: [u32; 2]) -> SceneElastic {
    let vertex = |object, vertex| SceneEnd::Vertex { object, vertex };
    SceneElastic {
        from: vertex(0, from),
        to: vertex(1, to),
        stiffness: 0.0,
        merge_within: Some(0.02),
    }
}

/// Two objects in space without weight, after a step.
fn run(objects: [SceneObject; 2], elastics: Vec<SceneElastic>) -> SceneRun {
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects: objects.to_vec(),
        elastics,
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    run.advance().unwrap();
    run
}

#[test]
fn a_pinned_vertex_stays_where_it_is_when_a_loose_one_is_merged_with_it() {
    let place = Vec3::new(0.1, 0.0, 0.0);
    let one = object("one", square(Vec3::zeros()), vec![2]);
    let other = object("other", square(place + Vec3::new(0.01, 0.0, 0.0)), vec![]);
    let run = run([one, other], vec![merged([2, 0])]);
    assert_eq!(run.state.positions.len(), 17);
    assert_eq!(run.meshes()[0].positions[2], place);
    assert_eq!(run.meshes()[1].positions[0], place);
    assert_eq!(run.state.velocities[2], Vec3::zeros());
}

#[test]
fn two_pinned_vertices_apart_stay_apart() {
    let place = Vec3::new(0.11, 0.0, 0.0);
    let one = object("one", square(Vec3::zeros()), vec![2]);
    let other = object("other", square(place), vec![0]);
    let apart = run([one.clone(), other], vec![merged([2, 0])]);
    assert_eq!(apart.state.positions.len(), 18);
    assert_eq!(apart.meshes()[0].positions[2], Vec3::new(0.1, 0.0, 0.0));
    assert_eq!(apart.meshes()[1].positions[0], place);

    // Nor do they become one over a third that both are merged with: the first elastic has it.
    let third = object("third", square(Vec3::new(0.105, 0.01, 0.0)), vec![]);
    let mut both = vec![one, object("other", square(place), vec![0]), third];
    both.rotate_left(2);
    let vertex = |object, vertex| SceneEnd::Vertex { object, vertex };
    let elastic = |to| SceneElastic {
        from: vertex(0, 0),
        to,
        stiffness: 0.0,
        merge_within: Some(0.02),
    };
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects: both,
        elastics: vec![elastic(vertex(1, 2)), elastic(vertex(2, 0))],
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    run.advance().unwrap();
    assert_eq!(run.state.positions.len(), 26);
    assert_eq!(run.meshes()[0].positions[0], Vec3::new(0.1, 0.0, 0.0));
    assert_eq!(run.meshes()[2].positions[0], place);

    // At one place they are one.
    let one = object("one", square(Vec3::zeros()), vec![2]);
    let other = object("other", square(Vec3::new(0.1, 0.0, 0.0)), vec![0]);
    let joined = self::run([one, other], vec![merged([2, 0])]);
    assert_eq!(joined.state.positions.len(), 17);
}

#[test]
fn a_vertex_without_cloth_weighs_nothing_when_it_is_merged() {
    let one = object("one", square(Vec3::zeros()), vec![]);
    let mut stray = square(Vec3::new(0.5, 0.0, 0.0));
    stray.positions.push(Vec3::new(0.11, 0.0, 0.0));
    let run = run([one, object("other", stray, vec![])], vec![merged([2, 9])]);
    assert_eq!(run.state.positions.len(), 18);
    let place = run.meshes()[0].positions[2];
    assert!((place - Vec3::new(0.1, 0.0, 0.0)).norm() < 1e-12, "{place}");
}

#[test]
fn crossings_found_before_a_merging_are_told_after_it() {
    let one = object("one", square(Vec3::zeros()), vec![0]);
    let upright = sheet([2, 2], [0.1, 0.1], |u, v| {
        Vec3::new(0.11 + u, v - 0.04, 0.003)
    });
    let through = sheet([2, 2], [0.1, 0.1], |u, v| Vec3::new(u, v - 0.043, 0.03));
    let objects = vec![
        one,
        object("upright", upright, vec![]),
        object("through", through, vec![]),
    ];
    let mut elastic = merged([2, 3]);
    elastic.merge_within = Some(0.05);
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects,
        elastics: vec![elastic],
        contact: toile_drape::ContactSettings {
            cloth_offset: 1e-3,
            ..toile_drape::ContactSettings::default()
        },
        method: MethodKind::Xpbd.into(),
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    run.advance().unwrap();
    assert_eq!(run.state.positions.len(), 26, "nothing was merged");
    let tally = run.cloth_tally().unwrap();
    assert!(tally.looks > 0 && tally.crossings[0] > 0, "{tally:?}");
}
