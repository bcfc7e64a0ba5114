//! Skeletons: a tree inside the body, forward kinematics, primitives that go with their joints.

use nalgebra::{Point3, UnitQuaternion};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;
use toile_body::{Figure, Joint, Mannequin, Part, Pose, Primitive};
use toile_geometry::Vec3;
use toile_measure::Measurements;

static WOMAN: LazyLock<Mannequin> =
    LazyLock::new(|| Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap());

fn figures() -> [(Figure, Measurements); 3] {
    [
        (Figure::Woman, Measurements::adult_woman()),
        (Figure::Man, Measurements::adult_man()),
        (Figure::Mean, Measurements::adult()),
    ]
}

/// Largest difference of any number of two primitives (m), (rad).
fn difference(a: &Primitive, b: &Primitive) -> f64 {
    assert_eq!((a.part, a.radii), (b.part, b.radii));
    let centre = (Vec3::from(a.centre) - Vec3::from(b.centre)).amax();
    let turn = (a.rotation().matrix() - b.rotation().matrix()).amax();
    centre.max(turn)
}

#[test]
fn joints_lie_in_the_body_in_order_and_in_two_equal_halves() {
    for (figure, table) in figures() {
        let body = Mannequin::new(&table, figure).unwrap();
        let skeleton = body.skeleton();
        assert_eq!(skeleton.joints().count(), Joint::COUNT);
        for (joint, centre) in skeleton.joints() {
            assert!(body.contains(centre), "{figure:?} {joint:?} {centre:?}");
            let mirror = skeleton.centre(joint.mirrored());
            assert_eq!(mirror, Vec3::new(-centre.x, centre.y, centre.z));
            assert_eq!(joint.name().starts_with("l_"), centre.x > 0.0, "{joint:?}");
        }
        for chain in [
            [Joint::LHip, Joint::LKnee, Joint::LAnkle, Joint::LMidtarsal].as_slice(),
            &[Joint::LShoulder, Joint::LElbow, Joint::LWrist],
            &[
                Joint::Skullbase,
                Joint::Vc4,
                Joint::Vt6,
                Joint::Vl5,
                Joint::HumanoidRoot,
            ],
        ] {
            for pair in chain.windows(2) {
                assert!(
                    skeleton.centre(pair[0]).y > skeleton.centre(pair[1]).y,
                    "{pair:?}"
                );
            }
        }
        // Bones of an adult, over stature: thigh and shin about a quarter each, upper arm and
        // forearm a sixth.
        let bone = |joint: Joint| skeleton.offset(joint).norm() / table.get("height").unwrap();
        assert!((0.20..0.29).contains(&bone(Joint::LKnee)), "{figure:?}");
        assert!((0.20..0.29).contains(&bone(Joint::LAnkle)), "{figure:?}");
        assert!((0.12..0.19).contains(&bone(Joint::LElbow)), "{figure:?}");
        assert!((0.11..0.19).contains(&bone(Joint::LWrist)), "{figure:?}");
    }
}

#[test]
fn the_rest_pose_is_the_identity() {
    let skeleton = WOMAN.skeleton();
    let frames = skeleton.frames(&Pose::rest());
    for (joint, centre) in skeleton.joints() {
        assert!((frames.centre(joint) - centre).amax() < 1e-15);
        assert_eq!(
            frames.body_from_joint(joint).rotation,
            UnitQuaternion::identity()
        );
        assert!((skeleton.rest_frames().centre(joint) - centre).amax() == 0.0);
    }
    assert_eq!(WOMAN.ellipsoids(), WOMAN.posed_ellipsoids(&Pose::rest()));
}

#[test]
fn every_primitive_is_in_the_frame_of_a_joint_of_its_part() {
    for (figure, table) in figures() {
        let body = Mannequin::new(&table, figure).unwrap();
        let skeleton = body.skeleton();
        let ellipsoids = body.ellipsoids();
        for (attached, placed) in body.primitives().iter().zip(&ellipsoids) {
            let centre = skeleton.centre(attached.joint) + Vec3::from(attached.local.centre);
            assert!((centre - Vec3::from(placed.centre)).amax() < 1e-15);
            let root_of_part = match placed.part {
                Part::Trunk => Joint::HumanoidRoot,
                Part::Head => Joint::Vt6,
                Part::LeftArm => Joint::LShoulder,
                Part::RightArm => Joint::RShoulder,
                Part::LeftLeg => Joint::LHip,
                Part::RightLeg => Joint::RHip,
            };
            assert!(attached.joint.follows(root_of_part), "{attached:?}");
        }
        // Every bone of these carries something.
        for joint in [
            Joint::LShoulder,
            Joint::LElbow,
            Joint::LWrist,
            Joint::RHip,
            Joint::RKnee,
            Joint::RAnkle,
            Joint::Sacroiliac,
            Joint::Vl5,
            Joint::Vt6,
            Joint::Skullbase,
        ] {
            assert!(
                body.primitives().iter().any(|p| p.joint == joint),
                "{figure:?} {joint:?}"
            );
        }
        // Mirror images hang on mirrored joints.
        for (attached, placed) in body.primitives().iter().zip(&ellipsoids) {
            let image = placed.mirrored();
            let twin = ellipsoids.iter().position(|other| same(other, &image));
            let twin = &body.primitives()[twin.unwrap()];
            assert_eq!(twin.joint, attached.joint.mirrored(), "{placed:?}");
        }
    }
}

fn same(a: &Primitive, b: &Primitive) -> bool {
    a.part == b.part && a.radii == b.radii && difference(a, b) < 1e-12
}

#[test]
fn turning_an_elbow_moves_forearm_and_hand_rigidly_and_nothing_else() {
    let skeleton = WOMAN.skeleton();
    let elbow = skeleton.centre(Joint::LElbow);
    let turn = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), -FRAC_PI_2);
    let pose = Pose::rest().with(Joint::LElbow, turn);
    let (before, after) = (WOMAN.ellipsoids(), WOMAN.posed_ellipsoids(&pose));
    let mut moved = 0;
    for ((attached, old), new) in WOMAN.primitives().iter().zip(&before).zip(&after) {
        if !matches!(attached.joint, Joint::LElbow | Joint::LWrist) {
            assert_eq!(old, new, "{attached:?}");
            continue;
        }
        moved += 1;
        // A rotation about the elbow, in closed form.
        let centre = elbow + turn * (Vec3::from(old.centre) - elbow);
        assert!((centre - Vec3::from(new.centre)).amax() < 1e-12);
        let rotation = turn.to_rotation_matrix() * old.rotation();
        assert!((rotation.matrix() - new.rotation().matrix()).amax() < 1e-12);
        assert_eq!(old.radii, new.radii);
    }
    let arm = before.iter().filter(|p| p.part == Part::LeftArm).count();
    assert!(moved > 2 && moved < arm, "{moved} of {arm}");
    // The forearm points forwards now, and is as long as before.
    let frames = skeleton.frames(&pose);
    let forearm = frames.centre(Joint::LWrist) - frames.centre(Joint::LElbow);
    assert!(forearm.z > 0.1);
    assert!((forearm.norm() - skeleton.offset(Joint::LWrist).norm()).abs() < 1e-12);
}

#[test]
fn the_root_turns_the_whole_body() {
    let root = WOMAN.skeleton().centre(Joint::HumanoidRoot);
    let turn = UnitQuaternion::from_euler_angles(0.3, -1.1, 0.7);
    let pose = Pose::rest().with(Joint::HumanoidRoot, turn);
    for (old, new) in WOMAN.ellipsoids().iter().zip(WOMAN.posed_ellipsoids(&pose)) {
        let centre = root + turn * (Vec3::from(old.centre) - root);
        assert!((centre - Vec3::from(new.centre)).amax() < 1e-12);
    }
}

fn any_turn() -> impl Strategy<Value = UnitQuaternion<f64>> {
    [-3.0..3.0f64, -3.0..3.0, -3.0..3.0].prop_map(|v| UnitQuaternion::new(Vec3::from(v)))
}

proptest! {
    #[test]
    fn bones_keep_their_lengths_and_a_joint_moves_only_what_hangs_on_it(
        turns in prop::collection::vec(any_turn(), Joint::COUNT),
        which in 0..Joint::COUNT,
        other in any_turn(),
    ) {
        let skeleton = WOMAN.skeleton();
        let mut pose = Pose::rest();
        for (joint, turn) in Joint::ALL.into_iter().zip(&turns) {
            pose.set(joint, *turn);
        }
        let changed = Joint::ALL[which];
        let frames = skeleton.frames(&pose);
        let again = skeleton.frames(&pose.clone().with(changed, other));
        for joint in Joint::ALL {
            if let Some(parent) = joint.parent() {
                let bone = (frames.centre(joint) - frames.centre(parent)).norm();
                prop_assert!((bone - skeleton.offset(joint).norm()).abs() < 1e-12);
            }
            // The chain written out by hand, as seen from the root.
            let mut point = Point3::origin();
            let mut at = Some(joint);
            while let Some(j) = at {
                point = pose.rotation(j) * point + skeleton.offset(j);
                at = j.parent();
            }
            prop_assert!((point.coords - frames.centre(joint)).amax() < 1e-12);
            if !joint.follows(changed) {
                prop_assert_eq!(frames.body_from_joint(joint), again.body_from_joint(joint));
            }
        }
    }
}
