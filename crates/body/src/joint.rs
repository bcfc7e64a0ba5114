//! The joints of the body by their H-Anim names, as a tree.

use serde::{Deserialize, Serialize};
use strum::{EnumCount, VariantArray};

/// A joint, named as in the H-Anim standard (ISO/IEC 19774): the eighteen of its lowest level of
/// articulation, and chest, neck and collars, which motions may leave out.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    EnumCount,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
pub enum Joint {
    /// The whole body, between the hip joints.
    HumanoidRoot,
    /// Pelvis.
    Sacroiliac,
    /// Left hip.
    LHip,
    /// Left knee.
    LKnee,
    /// Left ankle.
    LAnkle,
    /// Left instep.
    LMidtarsal,
    /// Right hip.
    RHip,
    /// Right knee.
    RKnee,
    /// Right ankle.
    RAnkle,
    /// Right instep.
    RMidtarsal,
    /// Lowest joint of the spine.
    Vl5,
    /// Spine at the chest.
    Vt6,
    /// Middle of the neck.
    Vc4,
    /// Base of the skull.
    Skullbase,
    /// Left collar, at the breastbone.
    LSternoclavicular,
    /// Left shoulder.
    LShoulder,
    /// Left elbow.
    LElbow,
    /// Left wrist.
    LWrist,
    /// Right collar, at the breastbone.
    RSternoclavicular,
    /// Right shoulder.
    RShoulder,
    /// Right elbow.
    RElbow,
    /// Right wrist.
    RWrist,
}

/// Name, parent and mirror image of each joint, in the order of [`Joint::ALL`].
const TABLE: [(&str, Option<Joint>, Joint); Joint::COUNT] = {
    use Joint::*;
    [
        ("HumanoidRoot", None, HumanoidRoot),
        ("sacroiliac", Some(HumanoidRoot), Sacroiliac),
        ("l_hip", Some(Sacroiliac), RHip),
        ("l_knee", Some(LHip), RKnee),
        ("l_ankle", Some(LKnee), RAnkle),
        ("l_midtarsal", Some(LAnkle), RMidtarsal),
        ("r_hip", Some(Sacroiliac), LHip),
        ("r_knee", Some(RHip), LKnee),
        ("r_ankle", Some(RKnee), LAnkle),
        ("r_midtarsal", Some(RAnkle), LMidtarsal),
        ("vl5", Some(HumanoidRoot), Vl5),
        ("vt6", Some(Vl5), Vt6),
        ("vc4", Some(Vt6), Vc4),
        ("skullbase", Some(Vc4), Skullbase),
        ("l_sternoclavicular", Some(Vt6), RSternoclavicular),
        ("l_shoulder", Some(LSternoclavicular), RShoulder),
        ("l_elbow", Some(LShoulder), RElbow),
        ("l_wrist", Some(LElbow), RWrist),
        ("r_sternoclavicular", Some(Vt6), LSternoclavicular),
        ("r_shoulder", Some(RSternoclavicular), LShoulder),
        ("r_elbow", Some(RShoulder), LElbow),
        ("r_wrist", Some(RElbow), LWrist),
    ]
};

impl Joint {
    /// Number of joints.
    pub const COUNT: usize = <Self as EnumCount>::COUNT;

    /// All joints, each after its parent.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Name in H-Anim files.
    pub fn name(self) -> &'static str {
        TABLE[self as usize].0
    }

    /// The joint with an H-Anim name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|joint| joint.name() == name)
    }

    /// The parent joint; `None` for the root.
    pub fn parent(self) -> Option<Self> {
        TABLE[self as usize].1
    }

    /// The corresponding joint of the other side; a joint in the median plane corresponds to itself.
    pub fn mirrored(self) -> Self {
        TABLE[self as usize].2
    }

    /// Whether the joint is beyond the lowest level of articulation: a motion may leave it out, and it then
    /// moves rigidly with its parent.
    pub fn is_optional(self) -> bool {
        matches!(
            self,
            Self::Vt6 | Self::Vc4 | Self::LSternoclavicular | Self::RSternoclavicular
        )
    }

    /// Whether a turn of `other` moves primitives that are fixed to this joint: `other` is the joint itself
    /// or lies between it and the root.
    pub fn follows(self, other: Self) -> bool {
        let mut at = Some(self);
        while let Some(joint) = at {
            if joint == other {
                return true;
            }
            at = joint.parent();
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_a_tree_in_order_with_two_equal_sides() {
        for (index, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint as usize, index);
            assert_eq!(Joint::named(joint.name()), Some(joint));
            assert!(joint.parent().is_none_or(|parent| parent < joint));
            assert_eq!(joint.parent().is_none(), joint == Joint::HumanoidRoot);
            assert!(joint.follows(Joint::HumanoidRoot));
            let mirror = joint.mirrored();
            assert_eq!(mirror.mirrored(), joint);
            assert_eq!(mirror.parent(), joint.parent().map(Joint::mirrored));
            let other_side = match joint.name().split_once('_') {
                Some(("l", rest)) => format!("r_{rest}"),
                Some(("r", rest)) => format!("l_{rest}"),
                _ => joint.name().to_owned(),
            };
            assert_eq!(mirror.name(), other_side);
        }
        assert_eq!(Joint::named("l_Hip"), None);
    }

    #[test]
    fn the_lowest_level_of_articulation_has_eighteen_joints() {
        let kept = Joint::ALL.iter().filter(|joint| !joint.is_optional());
        assert_eq!(kept.count(), 18);
    }

    #[test]
    fn what_follows_what() {
        assert!(Joint::LWrist.follows(Joint::LElbow) && Joint::LWrist.follows(Joint::Vt6));
        assert!(!Joint::LElbow.follows(Joint::LWrist));
        assert!(!Joint::RWrist.follows(Joint::LElbow));
        assert!(!Joint::LKnee.follows(Joint::Vl5));
    }
}
