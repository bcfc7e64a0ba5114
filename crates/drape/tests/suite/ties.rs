//! Attachments within triangles of cloth, on surfaces that bend and in frames of tracks.

use crate::support::sheets::{object, sheet};
use crate::support::solids;
use toile_drape::{
    AttachmentEnd, Kind, MeshVertex, MethodKind, MethodSettings, Motion, MotionKey,
    ObjectAttachment, ObjectId, ObjectKind, Pose, Scene, SceneObject, SceneRun, SharedTrack, Track,
    WorldEdit,
};
use toile_geometry::Vec3;

/// The way of a solid: it glides and turns, evenly in time.
fn motion(turn: f64) -> Motion {
    let key = |time: f64| MotionKey {
        time,
        translation: Vec3::new(0.3, 0.1, 0.0) * time,
        rotation: Vec3::new(0.0, turn, 0.2 * turn) * time,
    };
    Motion {
        pivot: Vec3::new(0.55, 0.05, 0.0),
        keys: vec![key(0.0), key(2.0)],
    }
}

/// The same way, vertex by vertex, with one frame that goes along.
struct Along {
    home: Vec<Vec3>,
    motion: Motion,
}

impl Track for Along {
    fn positions(&self, time: f64) -> Vec<Vec3> {
        let pose = self.motion.pose(time);
        self.home.iter().map(|p| pose.apply(*p)).collect()
    }

    fn frames(&self, time: f64) -> Vec<Pose> {
        vec![self.motion.pose(time)]
    }

    fn digest(&self) -> u64 {
        7
    }
}

/// A block that moves as a whole, or vertex by vertex.
fn block(motion: Motion, bends: bool) -> SceneObject {
    let mesh = solids::block(Vec3::new(0.5, 0.0, -0.1), Vec3::new(0.6, 0.1, 0.1));
    let home = mesh.positions.clone();
    let kind = match bends {
        true => ObjectKind::tracked(SharedTrack::new(Along { home, motion })),
        false => ObjectKind::moving(motion),
    };
    SceneObject {
        kind,
        ..object("block", mesh, vec![])
    }
}

/// A free sheet of 10 cm beside it, in weightless drag.
fn beside(block: SceneObject) -> Scene {
    let mesh = sheet([4, 4], [0.1; 2], |u, v| Vec3::new(u, 0.3 - v, 0.0));
    let mut scene = Scene {
        objects: vec![object("sheet", mesh, vec![]), block],
        duration: 9.0,
        step: 1.0 / 60.0,
        method: MethodKind::Xpbd.into(),
        gravity: Vec3::zeros(),
        ..Scene::default()
    };
    scene.air.drag = 3.0;
    scene
}

fn attached(scene: &Scene, ends: [AttachmentEnd; 2], stiffness: f64) -> SceneRun {
    let mut run = SceneRun::new(scene, MethodSettings::build).unwrap();
    let attachment = ObjectAttachment {
        ends,
        stiffness,
        merge_within: None,
    };
    run.edit(WorldEdit::Attach(attachment)).unwrap();
    run
}

fn after(mut run: SceneRun, steps: usize) -> Vec<Vec3> {
    for _ in 0..steps {
        run.advance().unwrap();
    }
    run.state.positions.clone()
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).norm());
    apart.fold(0.0, f64::max)
}

fn ids() -> [ObjectId; 2] {
    [0, 1].map(SceneObject::id)
}

fn vertex(object: ObjectId, vertex: u32) -> AttachmentEnd {
    AttachmentEnd::Vertex(MeshVertex { object, vertex })
}

const WEIGHTS: [f64; 3] = [0.2, 0.5, 0.3];

/// The ends on the block that name one point of its triangle 3: of its surface, of its frame, of the track's frame.
fn ends_on(block: &SceneObject) -> [AttachmentEnd; 3] {
    let [_, object] = ids();
    let corners = block.mesh.triangles[3].map(|v| block.mesh.positions[v as usize]);
    let terms = corners.iter().zip(WEIGHTS);
    let point: Vec3 = terms.map(|(x, w)| x * w).sum();
    [
        AttachmentEnd::Surface {
            object,
            triangle: 3,
            weights: WEIGHTS,
        },
        AttachmentEnd::Frame { object, point },
        AttachmentEnd::TrackFrame {
            object,
            frame: 0,
            point,
        },
    ]
}

#[test]
fn a_triangle_that_moves_rigidly_leads_as_the_rigid_body_does_and_so_does_a_frame() {
    let [sheet, _] = ids();
    // Straight on both are the same way; in a turn a track is straight within a step.
    for (turn, share) in [(0.0, 1e-5), (1.5, 2e-3)] {
        let [rigid, bending] = [false, true].map(|bends| block(motion(turn), bends));
        let [surface, frame, of_track] = ends_on(&rigid);
        let led = |block: &SceneObject, end| {
            let run = attached(&beside(block.clone()), [vertex(sheet, 12), end], 0.02);
            after(run, 30)
        };
        let expected = led(&rigid, frame);
        let moved = farthest(&expected, &beside(rigid.clone()).objects[0].mesh.positions);
        assert!(moved > 0.05, "{moved}");
        assert_eq!(led(&rigid, surface), expected);
        for end in [surface, of_track] {
            let apart = farthest(&led(&bending, end), &expected) / moved;
            assert!(apart < share, "turn {turn}: {apart}");
        }
    }
}

#[test]
fn a_sheet_hangs_by_a_point_within_a_triangle_as_low_as_its_weight_draws_it() {
    let [sheet, _] = ids();
    let mut scene = beside(block(motion(0.0), false));
    scene.gravity = Vec3::new(0.0, -9.81, 0.0);
    let place = Vec3::new(0.05, 0.4, 0.0);
    let (stiffness, triangle) = (2.0, 9);
    let end = AttachmentEnd::Surface {
        object: sheet,
        triangle,
        weights: WEIGHTS,
    };
    let mut run = attached(&scene, [AttachmentEnd::Point(place), end], stiffness);
    for _ in 0..600 {
        run.advance().unwrap();
    }
    let mass: f64 = run.system.rest.mass.iter().sum();
    let corners = run.world().object(sheet).unwrap().mesh.triangles[triangle as usize];
    let terms = corners.iter().zip(WEIGHTS);
    let point: Vec3 = terms
        .map(|(&v, w)| run.state.positions[v as usize] * w)
        .sum();
    let low = mass * 9.81 / stiffness;
    assert!(
        (place - point - Vec3::y() * low).norm() < 0.01 * low,
        "{point} {low}"
    );
    assert!((run.elastic_gap() - low).abs() < 0.01 * low);
}

#[test]
fn a_corner_with_the_whole_weight_is_the_vertex() {
    let [sheet, _] = ids();
    let scene = beside(block(motion(0.0), false));
    let mesh = &scene.objects[0].mesh;
    let corner = mesh.triangles[5][1];
    let place = AttachmentEnd::Point(mesh.positions[corner as usize] + Vec3::new(0.0, 0.1, 0.05));
    let within = AttachmentEnd::Surface {
        object: sheet,
        triangle: 5,
        weights: [0.0, 1.0, 0.0],
    };
    let [a, b] =
        [within, vertex(sheet, corner)].map(|end| after(attached(&scene, [end, place], 3.0), 40));
    assert!(farthest(&a, &b) < 1e-6);
}

#[test]
fn cloth_tied_to_cloth_keeps_its_momentum() {
    let mut scene = beside(block(motion(0.0), false));
    scene.air.drag = 0.0;
    let other = sheet([4, 4], [0.1; 2], |u, v| Vec3::new(u + 0.03, 0.3 - v, 0.1));
    scene.objects.push(object("other", other, vec![]));
    let end = |object: usize, triangle: u32| AttachmentEnd::Surface {
        object: SceneObject::id(object),
        triangle,
        weights: WEIGHTS,
    };
    let mut run = attached(&scene, [end(0, 4), end(2, 20)], 4.0);
    let gap = run.elastic_gap();
    assert!(gap > 0.09);
    let mut closest = gap;
    let (mut most, mut sum) = (0f64, 0f64);
    for _ in 0..60 {
        run.advance().unwrap();
        closest = closest.min(run.elastic_gap());
        let terms = || run.state.velocities.iter().zip(&run.system.rest.mass);
        sum = sum.max(terms().map(|(v, m)| v * *m).sum::<Vec3>().norm());
        most = most.max(terms().map(|(v, m)| v.norm() * m).sum());
    }
    assert!(closest < 0.3 * gap, "{closest}");
    assert!(sum < 1e-3 * most, "{sum} {most}");
}

#[test]
fn what_is_not_there_is_refused_and_so_are_methods_and_kinds_that_cannot_follow() {
    let [sheet, solid] = ids();
    let bending = beside(block(motion(0.5), true));
    let surface = |object, triangle, weights| AttachmentEnd::Surface {
        object,
        triangle,
        weights,
    };
    let of_track = |frame, point| AttachmentEnd::TrackFrame {
        object: solid,
        frame,
        point,
    };
    let frame = AttachmentEnd::Frame {
        object: solid,
        point: Vec3::zeros(),
    };
    for (end, said) in [
        (surface(solid, 900, WEIGHTS), "no triangle 900"),
        (surface(sheet, 0, [0.5, 0.6, 0.1]), "weights"),
        (surface(sheet, 0, [f64::NAN, 0.5, 0.5]), "weights"),
        (surface(sheet, 0, [1.5, -0.5, 0.0]), "weights"),
        (of_track(1, Vec3::zeros()), "no frame 1"),
        (of_track(0, Vec3::repeat(f64::NAN)), "not finite"),
        (frame, "has no frame of its own"),
    ] {
        let mut run = SceneRun::new(&bending, MethodSettings::build).unwrap();
        let attachment = ObjectAttachment {
            ends: [vertex(sheet, 0), end],
            stiffness: 1.0,
            merge_within: None,
        };
        let got = run.edit(WorldEdit::Attach(attachment)).unwrap_err();
        assert!(got.to_string().contains(said), "{got}");
    }
    // A frame of a track that stands still, and a method that follows none.
    let end = of_track(0, Vec3::zeros());
    let mut run = attached(&bending, [vertex(sheet, 0), end], 1.0);
    let got = run.edit(WorldEdit::ChangeKind(solid, Kind::Static));
    assert!(got.unwrap_err().to_string().contains("frames of its track"));
    let mut still = beside(SceneObject {
        kind: ObjectKind::Static,
        ..block(motion(0.0), false)
    });
    still.method = MethodKind::ImplicitEuler.into();
    let place = AttachmentEnd::Point(Vec3::zeros());
    let mut run = attached(&still, [surface(sheet, 0, WEIGHTS), place], 1.0);
    let got = run.advance().unwrap_err().to_string();
    assert!(
        got.contains("within triangles") && got.contains("xpbd"),
        "{got}"
    );
}
