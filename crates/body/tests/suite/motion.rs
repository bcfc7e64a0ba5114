//! The skin in motion: rest is rest, limbs go rigidly, walk and run stay clean.

use nalgebra::UnitQuaternion;
use std::sync::LazyLock;
use toile_body::{Clip, Figure, Joint, Mannequin, Pose};
use toile_geometry::{SurfaceTree, Vec3};
use toile_measure::{Measurements, Origin};

static WOMAN: LazyLock<Mannequin> =
    LazyLock::new(|| Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap());

/// Sizes from small to large of both figures.
fn sizes() -> Vec<Mannequin> {
    // Twenty with TOILE_ALL set, four else.
    let all = std::env::var("TOILE_ALL").is_ok();
    let heights: &[f64] = if all {
        &[0.92, 0.96, 1.0, 1.04, 1.08]
    } else {
        &[0.96, 1.05]
    };
    let girths: &[f64] = if all { &[0.92, 1.1] } else { &[1.03] };
    let mut bodies = Vec::new();
    for (figure, table) in [
        (Figure::Woman, Measurements::adult_woman()),
        (Figure::Man, Measurements::adult_man()),
    ] {
        for height in heights {
            for girth in girths {
                let mut sized = Measurements::new();
                for (name, share) in [
                    ("height", height),
                    ("bust", girth),
                    ("waist", girth),
                    ("hips", girth),
                ] {
                    sized
                        .set(name, table.get(name).unwrap() * share, Origin::Asked)
                        .unwrap();
                }
                bodies.push(Mannequin::new(&sized, figure).unwrap());
            }
        }
    }
    bodies
}

#[test]
fn at_rest_the_skin_stays_and_shares_add_up() {
    let posed = WOMAN.posed_skin(&Pose::rest());
    for (v, (a, b)) in WOMAN
        .skin()
        .positions
        .iter()
        .zip(&posed.positions)
        .enumerate()
    {
        assert!((a - b).norm() < 1e-12);
        let shares = WOMAN.shares(v);
        let sum: f64 = shares.iter().map(|share| share.1).sum();
        assert!((sum - 1.0).abs() < 1e-12 && shares.iter().all(|share| share.1 > 0.0));
        assert!((1..=6).contains(&shares.len()), "{shares:?}");
    }
}

#[test]
fn the_root_moves_all_of_it_and_an_elbow_only_the_forearm() {
    let turn = UnitQuaternion::new(Vec3::new(0.3, -0.8, 0.2));
    let mut pose = Pose::rest().with(Joint::HumanoidRoot, turn);
    pose.shift = Vec3::new(0.1, 0.2, -0.3);
    let root = WOMAN.skeleton().centre(Joint::HumanoidRoot);
    let posed = WOMAN.posed_skin(&pose);
    for (a, b) in WOMAN.skin().positions.iter().zip(&posed.positions) {
        assert!((turn * (a - root) + root + pose.shift - b).norm() < 1e-9);
    }
    let bend = UnitQuaternion::new(Vec3::new(0.0, -1.2, 0.0));
    let posed = WOMAN.posed_skin(&Pose::rest().with(Joint::LElbow, bend));
    for (v, (a, b)) in WOMAN
        .skin()
        .positions
        .iter()
        .zip(&posed.positions)
        .enumerate()
    {
        let follows = WOMAN
            .shares(v)
            .iter()
            .any(|share| share.0.follows(Joint::LElbow));
        assert!(follows || (a - b).norm() < 1e-12);
    }
}

#[test]
fn poses_are_blended_the_short_way_round() {
    let turn = |angle: f64| UnitQuaternion::new(Vec3::z() * angle);
    let (a, b) = (Pose::rest(), Pose::rest().with(Joint::LKnee, turn(1.0)));
    let middle = a.blended(&b, 0.25).rotation(Joint::LKnee);
    assert!(middle.angle_to(&turn(0.25)) < 1e-12);
    let walk = Clip::walk(WOMAN.skeleton());
    let run = Clip::run(WOMAN.skeleton());
    let [once, again] = [0.3, 0.3 + 2.0 * walk.duration()].map(|time| walk.at(time));
    for joint in Joint::ALL {
        assert!(once.rotation(joint).angle_to(&again.rotation(joint)) < 1e-9);
    }
    for (share, end) in [(0.0, &walk), (1.0, &run)] {
        let blend = walk.between(&run, share);
        for (a, b) in blend.poses.iter().zip(&end.poses) {
            assert!((a.shift - b.shift).norm() < 1e-9);
            for joint in Joint::ALL {
                assert!(a.rotation(joint).angle_to(&b.rotation(joint)) < 1e-9);
            }
        }
    }
    let jog = walk.between(&run, 0.5);
    assert!(jog.duration() < walk.duration() && jog.duration() > run.duration());
    assert!(walk.at(f64::NAN) == walk.poses[0]);
    // Half a stride later left and right have changed places.
    let knee = |phase: f64, joint: Joint| walk.at(phase * walk.duration()).rotation(joint).angle();
    assert!((knee(0.1, Joint::LKnee) - knee(0.6, Joint::RKnee)).abs() < 1e-9);
}

#[test]
fn walk_and_run_are_clean_away_from_creases() {
    let mut worst: f64 = 0.0;
    let mut folds = 0;
    let mut pairs: std::collections::BTreeMap<String, usize> = Default::default();
    for body in sizes() {
        let volume = body.skin().volume();
        for motion in [Clip::walk(body.skeleton()), Clip::run(body.skeleton())] {
            let step = if std::env::var("TOILE_ALL").is_ok() {
                1
            } else {
                4
            };
            for k in (0..motion.poses.len()).step_by(step) {
                let pose = motion.pose_for(body.skeleton(), k as f64 * motion.step);
                let skin = body.posed_skin(&pose);
                assert!(skin.is_closed_and_oriented());
                let change = skin.volume() / volume - 1.0;
                worst = worst.max(change.abs());
                let crossing = SurfaceTree::new(skin).self_intersections();
                for pair in crossing {
                    let creased = pair.iter().all(|&t| body.is_crease(t as usize));
                    if !creased {
                        folds += 1;
                        let parts = pair.map(|t| body.part_of_triangle()[t as usize]);
                        *pairs.entry(format!("{parts:?}")).or_insert(0) += 1;
                    }
                }
            }
        }
    }
    println!(
        "largest change of volume {:.2} %, {folds} crossings away from creases {pairs:?}",
        worst * 100.0
    );
    assert!(worst < 0.03, "{worst}");
    assert_eq!(folds, 0);
}

#[test]
fn slerp_turns_evenly_the_short_way_and_linear_blending_does_not() {
    let joint = Joint::LShoulder;
    let pose = |axis: Vec3, angle: f64| {
        let turn = UnitQuaternion::new(axis.normalize() * angle);
        Pose::rest().with(joint, turn)
    };
    // From hanging forward to reaching up and back.
    let a = pose(Vec3::new(1.0, 0.2, 0.1), 1.2);
    let b = pose(Vec3::new(-0.3, 0.4, 1.0), 2.6);
    let whole = a.rotation(joint).angle_to(&b.rotation(joint));
    let (mut uneven, mut astray) = (0.0_f64, 0.0_f64);
    for k in 0..=20 {
        let share = f64::from(k) / 20.0;
        let even = a.blended(&b, share).rotation(joint);
        let linear = a.blended_linearly(&b, share).rotation(joint);
        let from = a.rotation(joint);
        assert!((from.angle_to(&even) - share * whole).abs() < 1e-9);
        uneven = uneven.max((from.angle_to(&linear) - share * whole).abs());
        astray = astray.max(linear.angle_to(&even));
    }
    println!(
        "turn of {:.0} degrees: linear {:.1} off its share, {:.1} off the shortest way",
        whole.to_degrees(),
        uneven.to_degrees(),
        astray.to_degrees()
    );
    assert!(uneven > 0.01 && astray > 0.2, "{uneven} {astray}");
    // The ends are the same.
    for (share, end) in [(0.0, &a), (1.0, &b)] {
        let got = a.blended_linearly(&b, share).rotation(joint);
        assert!(got.angle_to(&end.rotation(joint)) < 1e-9);
    }
}

/// How far joints lie apart between slerp and linear blending, on frames and between gaits.
#[test]
fn linear_blending_against_slerp_on_our_own_gaits() {
    let skeleton = WOMAN.skeleton();
    let apart = |a: &Pose, b: &Pose| {
        let [a, b] = [a, b].map(|pose| skeleton.frames(pose));
        let far = Joint::ALL.map(|joint| (a.centre(joint) - b.centre(joint)).norm());
        far.into_iter().fold(0.0, f64::max)
    };
    let [walk, run] = [Clip::walk(skeleton), Clip::run(skeleton)];
    // Every fourth frame kept, the others blended from them.
    let mut frames = [0.0_f64; 2];
    let mut gaits = 0.0_f64;
    for k in 0..walk.poses.len() {
        let low = k / 4 * 4;
        let share = (k - low) as f64 / 4.0;
        let ends = [low, (low + 4) % walk.poses.len()];
        let [a, b] = ends.map(|k| &run.poses[k]);
        let blended = [a.blended(b, share), a.blended_linearly(b, share)];
        for (most, pose) in frames.iter_mut().zip(&blended) {
            *most = most.max(apart(pose, &run.poses[k]));
        }
        let [a, b] = [&walk.poses[k], &run.poses[k]];
        gaits = gaits.max(apart(&a.blended(b, 0.5), &a.blended_linearly(b, 0.5)));
    }
    println!(
        "eight frames of a run: slerp {:.2} mm, linear {:.2} mm off; half way from walk to run {:.2} mm apart",
        frames[0] * 1e3,
        frames[1] * 1e3,
        gaits * 1e3
    );
    // Single-axis turns of small angles: both do.
    assert!(frames[0] < 0.08 && frames[1] < 0.08);
    assert!(gaits < 0.02);
}
