//! Primitives that blend, that do not, that change with a joint, and their edits.

use nalgebra::UnitQuaternion;
use proptest::prelude::*;
use toile_body::{
    Blend, BodyError, Deformation, DeformationKey, Description, Field, Figure, Joint, Mannequin,
    Part, Pose, Primitive, PrimitiveEdit, THRESHOLD, VISIBLE_RATIO,
};
use toile_geometry::Vec3;

fn ball(part: Part, x: f64, radius: f64) -> Primitive {
    Primitive::new(part, [x, 1.0, 0.0], [radius; 3])
}

#[test]
fn blendable_primitives_swell_between_them_and_unblendable_ones_do_not() {
    let radius = 0.2;
    let reach = VISIBLE_RATIO * radius;
    let pair = |blend: Blend| {
        // Their surfaces are a tenth of a radius apart.
        let apart = 2.1 * reach;
        [0.0, apart].map(|x| Primitive {
            blend,
            ..ball(Part::Trunk, x, radius)
        })
    };
    let middle = Vec3::new(1.05 * reach, 1.0, 0.0);
    let [blended, plain] = [Blend::Blendable, Blend::Unblendable].map(|b| Field::new(&pair(b)));
    assert!(blended.contains(middle));
    assert!(!plain.contains(middle));
    // A plain one is the ellipsoid it is visible as, whoever is beside it.
    let one = Field::new(&pair(Blend::Unblendable)[..1]);
    let up = |field: &Field| field.first_exit(&[Part::Trunk], Vec3::new(0.0, 1.0, 0.0), Vec3::y());
    assert!((up(&plain).unwrap() - reach).abs() < 1e-8);
    assert_eq!(up(&plain), up(&one));
    // A ray ends where it leaves the union.
    let mixed = Field::new(&[
        ball(Part::Trunk, 0.0, radius),
        Primitive {
            blend: Blend::Unblendable,
            ..ball(Part::Trunk, reach, radius)
        },
    ]);
    let along = mixed.first_exit(&[Part::Trunk], Vec3::new(0.0, 1.0, 0.0), Vec3::x());
    assert!((along.unwrap() - 2.0 * reach).abs() < 1e-8);
}

#[test]
fn a_primitive_of_two_groups_adds_to_both_and_to_no_other() {
    let shared = Primitive {
        also: Some(Part::LeftLeg),
        ..ball(Part::Trunk, 0.1, 0.2)
    };
    let field = Field::new(&[shared, ball(Part::LeftArm, 0.1, 0.01)]);
    let at = Vec3::new(0.15, 1.0, 0.0);
    assert_eq!(
        field.density(Part::Trunk, at),
        field.density(Part::LeftLeg, at)
    );
    assert!(field.density(Part::Trunk, at) > THRESHOLD);
    assert_eq!(field.density(Part::LeftArm, at), 0.0);
    assert_eq!(shared.mirrored().also, Some(Part::RightLeg));
}

#[test]
fn gradients_are_those_of_the_density() {
    let field = Field::new(&[
        ball(Part::Trunk, 0.0, 0.2),
        ball(Part::Trunk, 0.1, 0.15),
        Primitive {
            blend: Blend::Unblendable,
            ..ball(Part::Trunk, 0.3, 0.2)
        },
    ]);
    let h = 1e-6;
    for x in [0.02, 0.06, 0.12, 0.3, 0.36] {
        let p = Vec3::new(x, 1.03, -0.02);
        let exact = field.gradient(Part::Trunk, p);
        for k in 0..3 {
            let step = Vec3::ith(k, h);
            let ends = [p + step, p - step].map(|p| field.density(Part::Trunk, p));
            let slope = (ends[0] - ends[1]) / (2.0 * h);
            assert!(
                (slope - exact[k]).abs() < 1e-6,
                "{x}, {k}: {slope}, {exact}"
            );
        }
    }
}

/// A calf that grows and rises as the knee bends.
fn bulge() -> Deformation {
    let key = |angle: f64, grown: f64, rise: f64| DeformationKey {
        angle,
        shift: [0.0, rise, 0.0],
        stretch: [grown, 1.0, grown],
        turn: [angle * 0.1, 0.0, 0.0],
    };
    Deformation {
        joint: Joint::LKnee,
        axis: [1.0, 0.0, 0.0],
        keys: vec![key(0.0, 1.0, 0.0), key(1.0, 1.2, 0.01), key(2.0, 1.3, 0.02)],
    }
}

fn bent(joint: Joint, angle: f64) -> Pose {
    Pose::rest().with(joint, UnitQuaternion::new(Vec3::x() * angle))
}

fn calf() -> (Description, usize) {
    let body = Mannequin::framed(Figure::Woman).unwrap();
    let low = |p: &Primitive| p.part == Part::LeftLeg && (0.3..0.4).contains(&p.centre[1]);
    let primitive = body.primitives.iter().position(low).unwrap();
    let edit = PrimitiveEdit::Deform {
        primitive,
        deformation: Some(bulge()),
    };
    (body.edited(&[edit]).unwrap(), primitive)
}

#[test]
fn a_deformable_primitive_goes_with_its_reference_joint_on_both_sides() {
    let (body, which) = calf();
    let body = Mannequin::from_description(&body).unwrap();
    let rest = body.ellipsoids();
    let turned = |pose: &Pose| body.posed_ellipsoids(pose);
    // At rest and with other joints bent it is what it was.
    assert_eq!(
        turned(&bent(Joint::LElbow, 1.0))[which].radii,
        rest[which].radii
    );
    // Between keys evenly, held beyond the last.
    for (angle, grown) in [(0.5, 1.1), (1.0, 1.2), (1.5, 1.25), (2.8, 1.3)] {
        let got = turned(&bent(Joint::LKnee, angle))[which].radii;
        assert!(
            (got[0] / rest[which].radii[0] - grown).abs() < 1e-12,
            "{angle}"
        );
        assert!((got[1] / rest[which].radii[1] - 1.0).abs() < 1e-12);
    }
    // The twist about another axis is none of its business.
    let aside = Pose::rest().with(Joint::LKnee, UnitQuaternion::new(Vec3::y() * 0.4));
    assert!((turned(&aside)[which].radii[0] / rest[which].radii[0] - 1.0).abs() < 1e-9);
    // Its mirror image follows the right knee.
    let image = rest
        .iter()
        .position(|p| *p == rest[which].mirrored())
        .unwrap();
    let [left, right] = [Joint::LKnee, Joint::RKnee].map(|j| turned(&bent(j, 0.7)));
    let mirrored = left[which].mirrored();
    let far = |a: [f64; 3], b: [f64; 3]| (Vec3::from(a) - Vec3::from(b)).norm();
    assert!(far(mirrored.centre, right[image].centre) < 1e-12);
    assert!(far(mirrored.radii, right[image].radii) < 1e-12);
    assert!(far(mirrored.rotation, right[image].rotation) < 1e-9);
    assert_eq!(left[image].radii, rest[image].radii);
}

#[test]
fn a_character_of_ellipsoids_that_change_is_refused() {
    let (mut body, which) = calf();
    // Fixed to the hip: the knee does not carry it, and yet changes it.
    let edit = PrimitiveEdit::Attach {
        primitive: which,
        joint: Joint::LHip,
    };
    body = body.edited(&[edit]).unwrap();
    let body = Mannequin::from_description(&body).unwrap();
    assert_eq!(body.primitives()[which].joint, Joint::LHip);
    let refused = body.character(&[]).unwrap_err();
    assert_eq!(refused, BodyError::NotRigid { primitive: which });
}

#[test]
fn joined_primitives_move_and_turn_as_one_until_they_are_parted() {
    let body = Mannequin::framed(Figure::Man).unwrap();
    let arm: Vec<usize> = (0..body.primitives.len())
        .filter(|&k| body.primitives[k].part == Part::LeftArm)
        .take(3)
        .collect();
    let centre = |d: &Description, k: usize| Vec3::from(d.primitives[k].centre);
    let to = centre(&body, arm[0]) + Vec3::new(0.01, 0.02, -0.005);
    let joined = [
        PrimitiveEdit::Join {
            primitives: vec![arm[0], arm[1]],
        },
        PrimitiveEdit::Join {
            primitives: vec![arm[2], arm[1], arm[1]],
        },
    ];
    let body = body.edited(&joined).unwrap();
    assert_eq!(body.rigging.joined, vec![arm.clone()]);
    let moved = body
        .edited(&[PrimitiveEdit::Move {
            primitive: arm[0],
            centre: to.into(),
        }])
        .unwrap();
    for &k in &arm {
        let by = centre(&moved, k) - centre(&body, k);
        assert!((by - Vec3::new(0.01, 0.02, -0.005)).norm() < 1e-12);
    }
    let turned = body
        .edited(&[PrimitiveEdit::Turn {
            primitive: arm[0],
            rotation: [0.1, 0.0, 0.2],
        }])
        .unwrap();
    let gap = |d: &Description| (centre(d, arm[0]) - centre(d, arm[2])).norm();
    assert!((gap(&turned) - gap(&body)).abs() < 1e-12);
    assert_eq!(turned.primitives[arm[0]].rotation, [0.1, 0.0, 0.2]);
    let parted = body
        .edited(&[PrimitiveEdit::Part {
            primitives: vec![arm[1]],
        }])
        .unwrap();
    assert_eq!(parted.rigging.joined, vec![vec![arm[0], arm[2]]]);
    // A deleted one leaves its set, and numbers follow.
    let fewer = body
        .edited(&[PrimitiveEdit::Delete { primitive: arm[0] }])
        .unwrap();
    assert_eq!(fewer.rigging.joined, vec![vec![arm[1] - 1, arm[2] - 1]]);
}

#[test]
fn edits_that_mean_nothing_are_refused_and_change_nothing() {
    let body = Mannequin::framed(Figure::Mean).unwrap();
    let last = body.primitives.len() - 1;
    let middle = body
        .primitives
        .iter()
        .position(Primitive::is_central)
        .unwrap();
    let mut jerk = bulge();
    jerk.keys[0].stretch = [2.0; 3];
    let mut unsorted = bulge();
    unsorted.keys.swap(1, 2);
    let bad = [
        PrimitiveEdit::Delete {
            primitive: last + 1,
        },
        PrimitiveEdit::Move {
            primitive: 0,
            centre: [f64::NAN, 1.0, 0.0],
        },
        PrimitiveEdit::Move {
            primitive: last,
            centre: [0.1, 1e9, 0.0],
        },
        PrimitiveEdit::Scale {
            primitive: 0,
            radii: [0.0, 0.1, 0.1],
        },
        PrimitiveEdit::Weigh {
            primitive: 0,
            weight: -1.0,
        },
        PrimitiveEdit::Group {
            primitive: last,
            part: Part::RightLeg,
            also: None,
        },
        PrimitiveEdit::Group {
            primitive: middle,
            part: Part::Trunk,
            also: Some(Part::LeftLeg),
        },
        PrimitiveEdit::Turn {
            primitive: middle,
            rotation: [0.0, 0.3, 0.0],
        },
        PrimitiveEdit::Join {
            primitives: vec![3, 3],
        },
        PrimitiveEdit::Deform {
            primitive: 0,
            deformation: Some(jerk),
        },
        PrimitiveEdit::Deform {
            primitive: 0,
            deformation: Some(unsorted),
        },
    ];
    for edit in bad {
        let good = PrimitiveEdit::Weigh {
            primitive: 1,
            weight: 1.1,
        };
        let refused = body.edited(&[good, edit.clone()]);
        assert!(!refused.unwrap_err().to_string().is_empty(), "{edit:?}");
    }
}

fn any_edit() -> impl Strategy<Value = PrimitiveEdit> {
    let which = 0..30_usize;
    prop_oneof![
        (which.clone(), 0.5..2.0_f64)
            .prop_map(|(primitive, weight)| PrimitiveEdit::Weigh { primitive, weight }),
        (which.clone(), prop::array::uniform3(0.02..0.3_f64))
            .prop_map(|(primitive, radii)| PrimitiveEdit::Scale { primitive, radii }),
        (which.clone(), prop::array::uniform3(0.01..1.0_f64))
            .prop_map(|(primitive, centre)| PrimitiveEdit::Move { primitive, centre }),
        which
            .clone()
            .prop_map(|primitive| PrimitiveEdit::Delete { primitive }),
        prop::collection::vec(which.clone(), 2..5)
            .prop_map(|primitives| PrimitiveEdit::Join { primitives }),
        prop::collection::vec(which.clone(), 1..4)
            .prop_map(|primitives| PrimitiveEdit::Part { primitives }),
        which.clone().prop_map(|primitive| PrimitiveEdit::Attach {
            primitive,
            joint: Joint::Vl5
        }),
        which
            .clone()
            .prop_map(|primitive| PrimitiveEdit::Detach { primitive }),
        which.clone().prop_map(|primitive| PrimitiveEdit::Deform {
            primitive,
            deformation: Some(bulge())
        }),
        which.prop_map(|primitive| PrimitiveEdit::Blend {
            primitive,
            blend: Blend::Unblendable
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Whatever is edited, numbers point to primitives, and edits written as text are the same.
    #[test]
    fn edited_bodies_keep_their_order(edits in prop::collection::vec(any_edit(), 1..40)) {
        let text = serde_json::to_string(&edits).unwrap();
        let read: Vec<PrimitiveEdit> = serde_json::from_str(&text).unwrap();
        prop_assert_eq!(&read, &edits);
        let mut body = Mannequin::framed(Figure::Man).unwrap();
        for edit in &edits {
            let before = body.clone();
            match body.edited(std::slice::from_ref(edit)) {
                Ok(next) => body = next,
                Err(_) => prop_assert_eq!(&body, &before),
            }
            let count = body.primitives.len();
            let named = body.rigging.particulars.iter().map(|p| p.primitive);
            let joined = body.rigging.joined.concat();
            prop_assert!(named.chain(joined.iter().copied()).all(|k| k < count));
            let mut once = joined.clone();
            once.sort_unstable();
            once.dedup();
            prop_assert_eq!(once.len(), joined.len());
            prop_assert!(body.rigging.joined.iter().all(|set| set.len() > 1));
        }
    }
}
