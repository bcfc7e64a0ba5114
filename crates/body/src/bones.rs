//! Positions of joints on a template and on the body grown from it, and the joint that carries each
//! primitive.

use crate::template::{Joints, Template};
use crate::warp::{Follow, Warp};
use crate::{Joint, Part, Primitive, Skeleton};
use toile_geometry::Vec3;

/// The skeleton of the body that a template is mapped to by `warp`.
pub(crate) fn skeleton(template: &Template, warp: &Warp) -> Skeleton {
    let carried = |joint: Joint| {
        let follow = match joint {
            Joint::LShoulder | Joint::LElbow | Joint::LWrist => Follow::ARM,
            Joint::LHip | Joint::LKnee | Joint::LAnkle | Joint::LMidtarsal => Follow::LEG,
            _ => Follow::default(),
        };
        warp.apply(place(&template.joints, joint), follow)
    };
    Skeleton::new(Joint::ALL.map(|joint| {
        let left = joint.min(joint.mirrored());
        let at = match joint {
            // Half-way between the hip joints of this body, which are moved with the legs and not with the
            // trunk.
            Joint::HumanoidRoot => {
                let hip = carried(Joint::LHip);
                Vec3::new(0.0, hip.y, hip.z)
            }
            _ => carried(left),
        };
        if joint == left {
            at
        } else {
            Vec3::new(-at.x, at.y, at.z)
        }
    }))
}

/// Position on a template of a joint of the left side or the median plane (m).
pub(crate) fn place(joints: &Joints, joint: Joint) -> Vec3 {
    let [hip, pelvis, chest, neck, head] = [
        joints.hip,
        joints.pelvis,
        joints.chest,
        joints.neck,
        joints.head,
    ]
    .map(Vec3::from);
    let [ankle, toe, shoulder] = [joints.ankle, joints.toe, joints.shoulder].map(Vec3::from);
    match joint {
        Joint::HumanoidRoot => Vec3::new(0.0, hip.y, hip.z),
        Joint::Sacroiliac => pelvis,
        Joint::LHip | Joint::RHip => hip,
        Joint::LKnee | Joint::RKnee => Vec3::from(joints.knee),
        Joint::LAnkle | Joint::RAnkle => ankle,
        Joint::LMidtarsal | Joint::RMidtarsal => {
            let instep = ankle + (toe - ankle) * INSTEP;
            Vec3::new(instep.x, 0.5 * ankle.y, instep.z)
        }
        Joint::Vl5 => pelvis + (chest - pelvis) * LUMBAR,
        Joint::Vt6 => chest,
        Joint::Vc4 => 0.5 * (neck + head),
        Joint::Skullbase => head,
        Joint::LSternoclavicular | Joint::RSternoclavicular => {
            Vec3::new(COLLAR * shoulder.x, shoulder.y, shoulder.z)
        }
        Joint::LShoulder | Joint::RShoulder => shoulder,
        Joint::LElbow | Joint::RElbow => Vec3::from(joints.elbow),
        Joint::LWrist | Joint::RWrist => Vec3::from(joints.wrist),
    }
}

/// Position of the lowest joint of the spine, as a share of the way from the pelvis to the joint of the
/// chest: above the crests of the hips and below the waist.
const LUMBAR: f64 = 1.0 / 3.0;
/// Position of the instep's joint, as a share of the way from ankle to toes; its height is half the ankle's.
const INSTEP: f64 = 0.4;
/// Distance of a collar's inner end from the median plane, as a share of the shoulder joint's distance from
/// it.
const COLLAR: f64 = 0.15;

/// The joint that a primitive of a template is fixed to: the start of a bone. Of the bones that may carry the
/// primitive's part, the nearest to its centre is taken; of equally near ones, the nearest to the root.
pub(crate) fn joint_of(template: &Template, primitive: &Primitive) -> Joint {
    if primitive.is_right() {
        return joint_of(template, &primitive.mirrored()).mirrored();
    }
    let (joints, height) = (&template.joints, template.height);
    let at = |joint: Joint| place(joints, joint);
    let crown = Vec3::new(0.0, height, at(Joint::Skullbase).z);
    let wrist = at(Joint::LWrist);
    let finger_tips = wrist + (wrist - at(Joint::LElbow)).normalize() * HAND * height;
    let bones: Vec<(Joint, Vec3)> = match primitive.part {
        Part::Trunk => vec![
            (Joint::Sacroiliac, at(Joint::Vl5)),
            (Joint::Vl5, at(Joint::Vt6)),
            (Joint::Vt6, at(Joint::Vc4)),
            (Joint::LSternoclavicular, at(Joint::LShoulder)),
        ],
        Part::Head => vec![
            (Joint::Vt6, at(Joint::Vc4)),
            (Joint::Vc4, at(Joint::Skullbase)),
            (Joint::Skullbase, crown),
        ],
        Part::LeftArm | Part::RightArm => vec![
            (Joint::LShoulder, at(Joint::LElbow)),
            (Joint::LElbow, wrist),
            (Joint::LWrist, finger_tips),
        ],
        Part::LeftLeg | Part::RightLeg => vec![
            (Joint::LHip, at(Joint::LKnee)),
            (Joint::LKnee, at(Joint::LAnkle)),
            (Joint::LAnkle, at(Joint::LMidtarsal)),
            (Joint::LMidtarsal, Vec3::from(joints.toe)),
        ],
    };
    let centre = Vec3::from(primitive.centre);
    let mut best = (Joint::HumanoidRoot, f64::INFINITY);
    for (joint, end) in bones {
        // A primitive in the median plane of the trunk moves with neither collar.
        let middle = primitive.part == Part::Trunk && primitive.centre[0] == 0.0;
        if middle && joint.mirrored() != joint {
            continue;
        }
        let distance = distance_to_bone(centre, [at(joint), end]);
        if distance < best.1 {
            best = (joint, distance);
        }
    }
    best.0
}

/// Length of a hand as a share of stature.
const HAND: f64 = 0.1;

/// Distance of a point from a straight bone (m).
fn distance_to_bone(point: Vec3, [from, to]: [Vec3; 2]) -> f64 {
    let along = to - from;
    let length = along.norm_squared();
    let share = if length > 0.0 {
        ((point - from).dot(&along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - from - along * share).norm()
}
