//! Motions from BVH files (Biovision hierarchy), mapped to the joints of `toile-body`.

use crate::FormatError;
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;
use toile_body::{Clip, Joint, Pose, Skeleton};
use toile_geometry::Vec3;

/// One channel of a joint: a number in every frame, along or about the axis x (0), y (1) or z (2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Channel {
    Position(usize),
    Rotation(usize),
}

/// A joint of the file.
#[derive(Debug)]
pub(crate) struct Bone {
    pub(crate) name: String,
    pub(crate) parent: Option<usize>,
    /// Offset from the parent's origin at rest, in the file's unit.
    pub(crate) offset: Vec3,
    /// Offset of the bone's end from its origin, in the file's unit; `None` if the file gives no end.
    pub(crate) end: Option<Vec3>,
    pub(crate) channels: Vec<Channel>,
}

/// The words of a file that are not yet read, each with its line.
struct Words<'a> {
    rest: std::vec::IntoIter<(usize, &'a str)>,
    /// Line of the last word that was read, from 1.
    line: usize,
}

impl<'a> Words<'a> {
    fn new(text: &'a str) -> Self {
        let words: Vec<(usize, &str)> = text
            .lines()
            .enumerate()
            .flat_map(|(k, line)| line.split_whitespace().map(move |word| (k + 1, word)))
            .collect();
        Self {
            rest: words.into_iter(),
            line: 1,
        }
    }

    fn problem(&self, what: impl Into<String>) -> FormatError {
        FormatError::new(
            format!("line {}", self.line),
            what,
            "export the motion again as BVH",
        )
    }

    fn word(&mut self) -> Result<&'a str, FormatError> {
        match self.rest.next() {
            Some((line, word)) => {
                self.line = line;
                Ok(word)
            }
            None => Err(self.problem("the file ends too early")),
        }
    }

    fn number(&mut self) -> Result<f64, FormatError> {
        let word = self.word()?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() && number.abs() < 1e9 => Ok(number),
            _ => Err(self.problem(format!("{:?} is not a number", shortened(word)))),
        }
    }

    fn expect(&mut self, wanted: &str) -> Result<(), FormatError> {
        let word = self.word()?;
        match word.eq_ignore_ascii_case(wanted) {
            true => Ok(()),
            false => Err(self.problem(format!(
                "{:?} stands where {wanted} should",
                shortened(word)
            ))),
        }
    }

    fn triple(&mut self) -> Result<Vec3, FormatError> {
        Ok(Vec3::new(self.number()?, self.number()?, self.number()?))
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Largest accepted number of joints (first) and of frames (second): a file with more is damaged.
const MOST: [usize; 2] = [1000, 200_000];

/// Reads a BVH file and maps its motion to a skeleton. Joints are recognised by their usual names (CMU's,
/// MakeHuman's, H-Anim's, left and right in words or letters). Every bone points in the direction that it has
/// in the file, whatever the rest poses of the file and of the skeleton are. Displacements of the root are
/// divided by the leg length of the file's figure. Joints that the file does not have keep their rest pose
/// relative to their parent.
///
/// # Errors
/// The text is not BVH, or it names no hips, knees and shoulders: the fault, its place and a remedy.
pub fn read_bvh(text: &str, skeleton: &Skeleton) -> Result<Clip, FormatError> {
    let mut words = Words::new(text);
    words.expect("HIERARCHY")?;
    let mut bones = hierarchy(&mut words)?;
    words.expect("Frames:")?;
    let frames = words.number()?;
    if frames.fract() != 0.0 || !(1.0..=MOST[1] as f64).contains(&frames) {
        return Err(words.problem(format!("{frames} is not a number of frames")));
    }
    words.expect("Frame")?;
    words.expect("Time:")?;
    let step = words.number()?;
    if step <= 0.0 {
        return Err(words.problem("the time from frame to frame is not above zero"));
    }
    let upright = upright(&bones);
    for bone in &mut bones {
        bone.offset = upright * bone.offset;
        bone.end = bone.end.map(|end| upright * end);
    }
    let carrier = Carrier::new(&bones, skeleton)?;
    let mut poses = Vec::new();
    for _ in 0..frames as usize {
        let mut local = vec![UnitQuaternion::identity(); bones.len()];
        let mut shift = Vec3::zeros();
        for (k, bone) in bones.iter().enumerate() {
            for channel in &bone.channels {
                let value = words.number()?;
                match *channel {
                    Channel::Position(axis) if bone.parent.is_none() => shift[axis] = value,
                    Channel::Position(_) => {}
                    Channel::Rotation(axis) => {
                        let turn = upright * Vec3::ith(axis, value.to_radians());
                        local[k] *= UnitQuaternion::new(turn);
                    }
                }
            }
        }
        poses.push(carrier.pose(&bones, &local, upright * shift));
    }
    Ok(Clip {
        step,
        poses,
        is_loop: false,
        advance: Vec3::zeros(),
    })
}

/// Rotation from the file's axes to axes with Y up. A BVH file does not say which axis is up: it is taken to
/// be the axis along which the shoulders lie highest over the knees at rest.
fn upright(bones: &[Bone]) -> UnitQuaternion<f64> {
    let places = places_at_rest(bones);
    let middle = |pair: [Joint; 2]| {
        let named =
            |k: &usize| joint_named(&bones[*k].name).is_some_and(|joint| pair.contains(&joint));
        let found: Vec<Vec3> = (0..bones.len()).filter(named).map(|k| places[k]).collect();
        found.iter().sum::<Vec3>() / found.len().max(1) as f64
    };
    let up = middle([Joint::LShoulder, Joint::RShoulder]) - middle([Joint::LKnee, Joint::RKnee]);
    let axis = up.iamax();
    let up = Vec3::ith(axis, up[axis].signum());
    match axis {
        1 if up.y > 0.0 => UnitQuaternion::identity(),
        // The figure stands on its head; turned about z, it still faces forward.
        1 => UnitQuaternion::new(Vec3::z() * PI),
        _ => UnitQuaternion::rotation_between(&up, &Vec3::y()).unwrap_or_default(),
    }
}

/// Origins of the bones at rest, in the file's unit.
fn places_at_rest(bones: &[Bone]) -> Vec<Vec3> {
    let mut places = vec![Vec3::zeros(); bones.len()];
    for (k, bone) in bones.iter().enumerate() {
        places[k] = bone.offset + bone.parent.map_or(Vec3::zeros(), |parent| places[parent]);
    }
    places
}

fn hierarchy(words: &mut Words) -> Result<Vec<Bone>, FormatError> {
    let mut bones: Vec<Bone> = Vec::new();
    let mut open: Vec<Option<usize>> = Vec::new();
    loop {
        let word = words.word()?;
        match word.to_ascii_uppercase().as_str() {
            "ROOT" | "JOINT" => {
                if bones.len() >= MOST[0] {
                    return Err(words.problem("there are too many joints"));
                }
                let name = words.word()?.to_owned();
                words.expect("{")?;
                let parent = open.last().copied().flatten();
                if parent.is_none() && !bones.is_empty() {
                    return Err(words.problem("there is a second root"));
                }
                bones.push(Bone {
                    name,
                    parent,
                    offset: Vec3::zeros(),
                    end: None,
                    channels: Vec::new(),
                });
                open.push(Some(bones.len() - 1));
            }
            "END" => {
                words.word()?;
                words.expect("{")?;
                open.push(None);
            }
            "OFFSET" => {
                let offset = words.triple()?;
                match open.as_slice() {
                    [.., Some(bone)] => bones[*bone].offset = offset,
                    [.., Some(bone), None] => bones[*bone].end = Some(offset),
                    _ => {}
                }
            }
            "CHANNELS" => {
                let count = words.number()? as usize;
                for _ in 0..count.min(12) {
                    let channel = channel(words)?;
                    if let Some(Some(bone)) = open.last() {
                        bones[*bone].channels.push(channel);
                    }
                }
            }
            "}" => {
                if open.pop().is_none() {
                    return Err(words.problem("a bracket closes what is not open"));
                }
            }
            "MOTION" if open.is_empty() && !bones.is_empty() => return Ok(bones),
            other => {
                let what = format!("{:?} stands in the hierarchy", shortened(other));
                return Err(words.problem(what));
            }
        }
    }
}

fn channel(words: &mut Words) -> Result<Channel, FormatError> {
    let word = words.word()?;
    let lower = word.to_ascii_lowercase();
    let axis = ["x", "y", "z"]
        .iter()
        .position(|axis| lower.starts_with(axis));
    match (axis, &lower[lower.len().min(1)..]) {
        (Some(axis), "position") => Ok(Channel::Position(axis)),
        (Some(axis), "rotation") => Ok(Channel::Rotation(axis)),
        _ => Err(words.problem(format!("{:?} is not a channel", shortened(word)))),
    }
}

/// The joint that a bone of the file stands for, by the bone's name.
fn joint_named(name: &str) -> Option<Joint> {
    if let Some(joint) = Joint::named(name) {
        return Some(joint);
    }
    let lower = name.to_ascii_lowercase();
    let side = |start: &str, short: &str, end: &str| {
        lower
            .strip_prefix(start)
            .or_else(|| lower.strip_suffix(end))
            .or_else(|| {
                let letter = name.starts_with(short);
                let next = name.chars().nth(1).is_some_and(char::is_uppercase);
                (letter && next).then(|| &lower[1..])
            })
            .map(str::to_owned)
    };
    use Joint::*;
    let pair = |word: &str| -> Option<[Joint; 2]> {
        Some(match word.trim_matches('_') {
            "collar" | "clavicle" => [LSternoclavicular, RSternoclavicular],
            "shldr" | "shoulder" | "uparm" | "upperarm" | "arm" => [LShoulder, RShoulder],
            "forearm" | "elbow" | "loarm" | "lowerarm" => [LElbow, RElbow],
            "hand" | "wrist" => [LWrist, RWrist],
            "thigh" | "hip" | "upleg" | "upperleg" => [LHip, RHip],
            "shin" | "knee" | "loleg" | "lowerleg" | "leg" => [LKnee, RKnee],
            "foot" | "ankle" => [LAnkle, RAnkle],
            "toe" | "toebase" => [LMidtarsal, RMidtarsal],
            _ => return None,
        })
    };
    if let Some([left, _]) = side("left", "l", "_l").and_then(|word| pair(&word)) {
        return Some(left);
    }
    if let Some([_, right]) = side("right", "r", "_r").and_then(|word| pair(&word)) {
        return Some(right);
    }
    Some(match lower.as_str() {
        "abdomen" | "spine" | "spine1" => Vl5,
        "chest" | "spine2" => Vt6,
        "neck" => Vc4,
        "head" => Skullbase,
        _ => return None,
    })
}

/// The joint at the far end of the bone that begins at `joint`; it gives the direction of the bone.
fn end_of(joint: Joint) -> Option<Joint> {
    use Joint::*;
    let limbs = [
        [LHip, LKnee, LAnkle],
        [RHip, RKnee, RAnkle],
        [LShoulder, LElbow, LWrist],
        [RShoulder, RElbow, RWrist],
    ];
    let mut bones = limbs.iter().flat_map(|limb| limb.windows(2));
    bones.find(|bone| bone[0] == joint).map(|bone| bone[1])
}

/// Carries poses of the file's bones over to a skeleton's joints.
pub(crate) struct Carrier {
    /// For each joint, the index of its bone in the file; `None` if the file does not have the joint.
    bone: [Option<usize>; Joint::COUNT],
    /// For each joint, the rotation that turns the direction of its bone at rest in the skeleton into the
    /// direction of the same bone at rest in the file.
    align: [UnitQuaternion<f64>; Joint::COUNT],
    /// Height of the left hip above the lowest point of the file's figure at rest, in the file's unit.
    leg: f64,
    /// Position of the root at rest, with its height above the same lowest point, in the file's unit.
    root: Vec3,
}

impl Carrier {
    pub(crate) fn new(bones: &[Bone], skeleton: &Skeleton) -> Result<Self, FormatError> {
        let mut bone = [None; Joint::COUNT];
        for (k, b) in bones.iter().enumerate() {
            match joint_named(&b.name) {
                Some(joint) if b.parent.is_some() => {
                    bone[joint as usize].get_or_insert(k);
                }
                _ => {}
            }
        }
        let has = |joint: Joint| bone[joint as usize].is_some();
        if ![Joint::LHip, Joint::RHip, Joint::LKnee, Joint::LShoulder]
            .into_iter()
            .all(has)
        {
            return Err(FormatError::new(
                "the hierarchy",
                "hips, knees and shoulders are not found by their names",
                "name the joints as CMU or H-Anim do, such as lThigh or l_hip",
            ));
        }
        let rest = places_at_rest(bones);
        let mut align = [UnitQuaternion::identity(); Joint::COUNT];
        for joint in Joint::ALL {
            let Some(end) = end_of(joint) else {
                // Hands and feet take the rest rotation of the bone that they are attached to.
                if let Some(parent) = joint.parent()
                    && end_of(parent).is_some()
                {
                    align[joint as usize] = align[parent as usize];
                }
                continue;
            };
            if let (Some(from), Some(to)) = (bone[joint as usize], bone[end as usize]) {
                let theirs = rest[to] - rest[from];
                let own = skeleton.centre(end) - skeleton.centre(joint);
                align[joint as usize] =
                    UnitQuaternion::rotation_between(&own, &theirs).unwrap_or_default();
            }
        }
        // Feet stand flat at rest both in the file and in the skeleton, so they are not turned.
        for joint in [
            Joint::LAnkle,
            Joint::RAnkle,
            Joint::LMidtarsal,
            Joint::RMidtarsal,
        ] {
            align[joint as usize] = UnitQuaternion::identity();
        }
        let hip = bone[Joint::LHip as usize].unwrap_or_default();
        let low = bones
            .iter()
            .zip(&rest)
            .map(|(bone, p)| p.y + bone.end.map_or(0.0, |end| end.y.min(0.0)))
            .fold(f64::INFINITY, f64::min);
        Ok(Self {
            bone,
            align,
            leg: (rest[hip].y - low).abs().max(1e-9),
            root: Vec3::new(0.0, rest[0].y - low, 0.0),
        })
    }

    pub(crate) fn pose(&self, bones: &[Bone], local: &[UnitQuaternion<f64>], place: Vec3) -> Pose {
        let mut global = local.to_vec();
        for (k, bone) in bones.iter().enumerate() {
            if let Some(parent) = bone.parent {
                global[k] = global[parent] * local[k];
            }
        }
        let mut pose = Pose::rest();
        let mut own = [UnitQuaternion::identity(); Joint::COUNT];
        for joint in Joint::ALL {
            let above = joint
                .parent()
                .map_or(UnitQuaternion::identity(), |parent| own[parent as usize]);
            own[joint as usize] = match (joint, self.bone[joint as usize]) {
                (Joint::HumanoidRoot, _) => global[0],
                (_, Some(bone)) => global[bone] * self.align[joint as usize],
                (_, None) => above,
            };
            pose.set(joint, above.inverse() * own[joint as usize]);
        }
        pose.shift = (place - self.root) / self.leg;
        pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toile_body::{Figure, Mannequin};
    use toile_measure::Measurements;

    const SMALL: &str = "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
        JOINT lThigh\n{\nOFFSET 1 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT lShin\n{\nOFFSET 0 -5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 -5 0\n}\n}\n}\n\
        JOINT rThigh\n{\nOFFSET -1 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 -5 0\n}\n}\n\
        JOINT lShldr\n{\nOFFSET 1 5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 2 0 0\n}\n}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.5\n0 10 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n10 10 0 0 0 90 0 -90 0 0 90 0 0 0 0 0 0 0\n";

    fn skeleton() -> Skeleton {
        let table = Measurements::adult_woman();
        Mannequin::new(&table, Figure::Woman)
            .unwrap()
            .skeleton()
            .clone()
    }

    #[test]
    fn whichever_axis_is_up_becomes_y() {
        for up in [0, 1, 2].map(|axis| Vec3::ith(axis, 1.0)) {
            for up in [up, -up] {
                let bone = |name: &str, offset| Bone {
                    name: name.to_owned(),
                    parent: Some(0),
                    offset,
                    end: None,
                    channels: Vec::new(),
                };
                let mut bones = vec![bone("lShldr", up * 5.0), bone("lShin", up * -5.0)];
                bones.insert(
                    0,
                    Bone {
                        parent: None,
                        ..bone("hip", Vec3::zeros())
                    },
                );
                let turned = upright(&bones) * up;
                assert!((turned - Vec3::y()).norm() < 1e-12, "{up:?} {turned:?}");
            }
        }
    }

    #[test]
    fn a_file_whose_z_is_up_gives_the_same_clip() {
        let lying = SMALL
            .replace("0 -5 0", "0 0 -5")
            .replace("1 5 0", "1 0 5")
            .replace("Yposition Zposition", "Zposition Yposition")
            .replace(
                "Zrotation Xrotation Yrotation",
                "Yrotation Xrotation Zrotation",
            );
        let skeleton = skeleton();
        let [upright, lying] = [SMALL, &lying].map(|text| read_bvh(text, &skeleton).unwrap());
        for (a, b) in upright.poses.iter().zip(&lying.poses) {
            assert!((a.shift - b.shift).norm() < 1e-12);
            let [a, b] = [a, b].map(|pose| skeleton.frames(pose));
            for joint in Joint::ALL {
                assert!(
                    (a.centre(joint) - b.centre(joint)).norm() < 1e-12,
                    "{joint:?}"
                );
            }
        }
    }

    #[test]
    fn bones_point_as_in_the_file() {
        let skeleton = skeleton();
        let motion = read_bvh(SMALL, &skeleton).unwrap();
        assert_eq!((motion.poses.len(), motion.step), (2, 0.5));
        let thigh = |pose: &Pose| {
            let frames = skeleton.frames(pose);
            (frames.centre(Joint::LKnee) - frames.centre(Joint::LHip)).normalize()
        };
        assert!(
            (thigh(&motion.poses[0]) + Vec3::y()).norm() < 1e-9,
            "straight down"
        );
        // A quarter turn to the left about the vertical axis, then the thigh lifted forward by 90 degrees: it
        // points forward from the body.
        assert!((thigh(&motion.poses[1]) - Vec3::x()).norm() < 1e-9);
        // The root moves by one leg length: 10 units, and the legs are 10 units long.
        assert!((motion.poses[1].shift - Vec3::x()).norm() < 1e-9);
    }

    #[test]
    fn damage_is_refused_with_its_place() {
        let skeleton = skeleton();
        let place = |text: &str| read_bvh(text, &skeleton).unwrap_err().place;
        assert_eq!(place(""), "line 1");
        assert_eq!(place("HIERARCHY\nROOT hip\n{\nOFFSET 0 0 x\n"), "line 4");
        assert_eq!(place(&SMALL.replace("Frames: 2", "Frames: -2")), "line 40");
        assert!(read_bvh(&SMALL[..SMALL.len() - 9], &skeleton).is_err());
        assert_eq!(place(&SMALL.replace("Thigh", "Tail")), "the hierarchy");
    }

    #[test]
    fn recorded_motions_are_read() {
        let start = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let found = start
            .ancestors()
            .map(|f| f.join("shared/data/body/bvh"))
            .find(|f| f.is_dir());
        let Some(folder) = found else {
            return;
        };
        let skeleton = skeleton();
        let read = |file: &str| {
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            read_bvh(&text, &skeleton).unwrap()
        };
        let motions = [
            ("makehuman_hist_cmu_02_02_walk.bvh", 299),
            ("kevinxie_walk.bvh", 299),
            ("kevinxie_cmu_run_filtered.bvh", 174),
            ("makehuman_walk1.bvh", 14),
        ]
        .map(|(file, frames)| {
            let motion = read(file);
            assert_eq!(motion.poses.len(), frames, "{file}");
            motion
        });
        // One motion on two skeletons: the joints come to nearly the same positions, relative to the root.
        let mut worst: f64 = 0.0;
        for (a, b) in motions[0].poses.iter().zip(&motions[1].poses).step_by(20) {
            let [a, b] = [a, b].map(|pose| skeleton.frames(pose));
            let root = a.centre(Joint::HumanoidRoot) - b.centre(Joint::HumanoidRoot);
            for joint in [
                Joint::LKnee,
                Joint::RKnee,
                Joint::LAnkle,
                Joint::RAnkle,
                Joint::LElbow,
            ] {
                worst = worst.max((a.centre(joint) - b.centre(joint) - root).norm());
            }
        }
        assert!(worst < 0.12, "{worst}");
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(cut in 0..SMALL.len(), add in "[A-Za-z0-9 {}:.-]{0,20}") {
            let text = format!("{}{add}{}", &SMALL[..cut], &SMALL[cut..]);
            if let Ok(motion) = read_bvh(&text, &skeleton()) {
                prop_assert!(!motion.poses.is_empty());
            }
        }
    }
}
