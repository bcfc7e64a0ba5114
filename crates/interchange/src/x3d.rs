//! Motions from VRML 97 and X3D files: OrientationInterpolators routed to H-Anim joints, mapped to the joints
//! of `toile-body`.

use crate::bvh::{Bone, Carrier};
use crate::x3d_nodes::{Node, Scene};
use crate::{FormatError, x3d_vrml, x3d_xml};
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;
use toile_body::{Clip, Joint, Skeleton};
use toile_geometry::Vec3;

/// Sampling rate of the poses of a motion (1/s).
const RATE: f64 = 30.0;
/// Longest animation cycle accepted (s): a file with a longer one is damaged.
const LONGEST: f64 = 3600.0;

/// Rotations, each with its time as a fraction of the cycle.
struct Turns(Vec<(f64, UnitQuaternion<f64>)>);

impl Turns {
    /// The rotation at a fraction of the cycle: slerp between keys, constant beyond them.
    fn at(&self, share: f64) -> UnitQuaternion<f64> {
        let next = self.0.partition_point(|key| key.0 <= share);
        match (next.checked_sub(1).map(|k| self.0[k]), self.0.get(next)) {
            (Some((from, a)), Some(&(to, b))) => {
                let share = (share - from) / (to - from);
                a.try_slerp(&b, share, 1e-12).unwrap_or(a)
            }
            (Some((_, a)), None) => a,
            (None, Some(&(_, b))) => b,
            (None, None) => UnitQuaternion::identity(),
        }
    }
}

/// Reads a VRML 97 or X3D (XML) file and maps its motion to a skeleton. Every OrientationInterpolator that a
/// ROUTE connects to a joint rotates that joint. Joints are recognised by their H-Anim names, from the name
/// field of the Joint node or its DEF, with or without `hanim_`. A PositionInterpolator connected to the root
/// moves the body. The TimeSensor gives the duration (one second without it) and whether the clip loops.
/// Bones have the directions of the file if its joints have centres; otherwise a figure with hanging arms is
/// assumed. If several TimeSensors drive interpolators of joints, each is a clip, and the first is taken.
/// Also returns notes on everything left out.
///
/// # Errors
/// The text is neither VRML nor X3D, or it rotates no joint: the fault, its line or node, and a remedy.
pub fn read_x3d(text: &str, skeleton: &Skeleton) -> Result<(Clip, Vec<String>), FormatError> {
    let scene = read_scene(text)?;
    let clip = Animation::of(&scene)?;
    let (length, is_loop) = clip.cycle()?;
    let bones = bones(&joint_nodes(&scene)?, skeleton);
    let carrier = Carrier::new(&bones, skeleton)?;
    let count = ((length * RATE).round() as usize).max(2);
    let rest = rest_of_root(&bones);
    let poses = (0..count)
        .map(|k| {
            let share = match is_loop {
                true => k as f64 / count as f64,
                false => k as f64 / (count - 1) as f64,
            };
            let local: Vec<UnitQuaternion<f64>> = bones
                .iter()
                .map(|bone| {
                    let own = joint_called(&bone.name).and_then(|joint| clip.turns.get(&joint));
                    own.map_or(UnitQuaternion::identity(), |turns: &Turns| turns.at(share))
                })
                .collect();
            let moves = clip.moves.as_ref();
            let moved = moves.map_or(Vec3::zeros(), |m| place_at(m, share));
            carrier.pose(&bones, &local, rest + moved)
        })
        .collect();
    let motion = Clip {
        step: match is_loop {
            true => length / count as f64,
            false => length / (count - 1) as f64,
        },
        poses,
        is_loop,
        advance: Vec3::zeros(),
    };
    Ok((motion, clip.notes))
}

/// Reads XML or the classic encoding, depending on how the file begins.
fn read_scene(text: &str) -> Result<Scene, FormatError> {
    let start = text.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
    if start.starts_with('<') {
        x3d_xml::read(text)
    } else if start.starts_with("#VRML") || start.starts_with("#X3D") {
        x3d_vrml::read(text.trim_start_matches('\u{feff}'))
    } else {
        Err(FormatError::new(
            "line 1",
            "the file begins neither as VRML (#VRML V2.0 utf8) nor as X3D (<X3D>)",
            "export the motion again as VRML 97 or X3D",
        ))
    }
}

/// The rotations and translations of one clip.
struct Animation<'a> {
    /// The TimeSensor of the clip.
    clock: Option<&'a Node>,
    /// Rotations of each joint.
    turns: BTreeMap<Joint, Turns>,
    /// Displacements of the root, each with its time as a fraction of the cycle.
    moves: Option<Vec<(f64, Vec3)>>,
    notes: Vec<String>,
}

impl<'a> Animation<'a> {
    /// The first clip of a scene.
    fn of(scene: &'a Scene) -> Result<Self, FormatError> {
        let joint_routes: Vec<JointRoute<'_>> = joint_routes(scene)?;
        let turning = || joint_routes.iter().filter(|route| route.turns());
        let clocks: Vec<&Node> = scene
            .nodes
            .iter()
            .filter(|node| turning().any(|route| route.has_clock(node)))
            .collect();
        let mut clip = Self {
            clock: clocks.first().copied(),
            turns: BTreeMap::new(),
            moves: None,
            notes: Vec::new(),
        };
        let (mut still, mut strange) = (Vec::new(), Vec::new());
        for route in &joint_routes {
            match clip.clock {
                Some(_) if route.clocks.is_empty() => still.push(route.by.name.as_str()),
                Some(clock) if !route.has_clock(clock) => {}
                _ => match (route.by.kind.as_str(), route.joint) {
                    ("OrientationInterpolator", Some(joint)) => {
                        clip.turns.insert(joint, turns_of(route.by)?);
                    }
                    ("OrientationInterpolator", None) => strange.push(route.to),
                    (_, Some(Joint::HumanoidRoot)) => clip.moves = Some(places_of(route.by)?),
                    _ => {}
                },
            }
        }
        if clip.turns.is_empty() {
            return Err(FormatError::new(
                "the routes",
                "no OrientationInterpolator leads to a joint",
                "give ROUTEs from value_changed to set_rotation of joints with H-Anim names such as l_hip",
            ));
        }
        if clocks.len() > 1 {
            let names: Vec<&str> = clocks.iter().map(|clock| clock.name.as_str()).collect();
            clip.notes.push(format!(
                "the file has {} clips, of the TimeSensors {}: {} is taken",
                names.len(),
                names.join(", "),
                names[0]
            ));
        }
        for (names, why) in [
            (still, "no TimeSensor leads to them"),
            (strange, "the body has no such joints"),
        ] {
            if !names.is_empty() {
                let names = names.join(", ");
                clip.notes.push(format!("left out: {names}; {why}"));
            }
        }
        if clip.clock.is_none() {
            clip.clock = scene.nodes.iter().find(|node| node.kind == "TimeSensor");
        }
        Ok(clip)
    }

    /// Duration of the clip (s), and whether it loops.
    fn cycle(&self) -> Result<(f64, bool), FormatError> {
        let Some(clock) = self.clock else {
            return Ok((1.0, false));
        };
        let length = clock.numbers("cycleInterval")?.first().copied();
        let length = length.unwrap_or(1.0);
        if !(length > 0.0 && length <= LONGEST) {
            return Err(FormatError::new(
                clock.place(),
                format!("cycleInterval {length} is not a length of time"),
                "give seconds from above 0 to 3600",
            ));
        }
        Ok((length, clock.is_true("loop")))
    }
}

/// A route from an interpolator to a node.
struct JointRoute<'a> {
    /// The interpolator.
    by: &'a Node,
    /// The joint that the target node stands for, if the skeleton has it.
    joint: Option<Joint>,
    /// Name of the target node.
    to: &'a str,
    /// Names of the TimeSensors that drive the interpolator.
    clocks: Vec<&'a str>,
}

impl JointRoute<'_> {
    /// Whether the route rotates a joint of the skeleton.
    fn turns(&self) -> bool {
        self.by.kind == "OrientationInterpolator" && self.joint.is_some()
    }

    fn has_clock(&self, clock: &Node) -> bool {
        clock.kind == "TimeSensor" && self.clocks.contains(&clock.name.as_str())
    }
}

/// The routes from interpolators that rotate or translate a node.
fn joint_routes(scene: &Scene) -> Result<Vec<JointRoute<'_>>, FormatError> {
    let mut joint_routes = Vec::new();
    for route in &scene.routes {
        let target = scene.named(&route.to);
        let joint = target
            .and_then(joint_of)
            .or_else(|| joint_called(&route.to));
        let Some(by) = scene.named(&route.from) else {
            match joint {
                Some(_) => return Err(lost(route.line, &route.from)),
                None => continue,
            }
        };
        let field = match by.kind.as_str() {
            "OrientationInterpolator" => "rotation",
            "PositionInterpolator" => "translation",
            _ => continue,
        };
        if route.field != field && !route.field.is_empty() {
            continue;
        }
        let is_clock = |name: &&str| scene.named(name).is_some_and(|n| n.kind == "TimeSensor");
        let into = scene.routes.iter().filter(|r| r.to == by.name);
        joint_routes.push(JointRoute {
            by,
            joint,
            to: &route.to,
            clocks: into.map(|r| r.from.as_str()).filter(is_clock).collect(),
        });
    }
    Ok(joint_routes)
}

fn lost(line: usize, name: &str) -> FormatError {
    FormatError::new(
        format!("line {line}, ROUTE"),
        format!("there is no node {name:?}"),
        "give the node this DEF, or correct the ROUTE",
    )
}

/// The joint of an H-Anim name, or of a DEF such as `hanim_l_hip`.
fn joint_called(name: &str) -> Option<Joint> {
    let name = name.strip_prefix("hanim_").unwrap_or(name);
    let name = name.strip_suffix("_joint").unwrap_or(name);
    match name {
        "humanoid_root" | "humanoidroot" => Some(Joint::HumanoidRoot),
        _ => Joint::named(name),
    }
}

/// The joint that a node stands for: by its name field, else by its DEF.
fn joint_of(node: &Node) -> Option<Joint> {
    let own = node.text("name").and_then(joint_called);
    own.or_else(|| joint_called(&node.name))
}

/// Centres of the joint nodes in the scene.
fn joint_nodes(scene: &Scene) -> Result<BTreeMap<Joint, Vec3>, FormatError> {
    let is_joint = |node: &&Node| matches!(node.kind.as_str(), "Joint" | "HAnimJoint");
    let mut centres = BTreeMap::new();
    for node in scene.nodes.iter().filter(is_joint) {
        if let (Some(joint), [x, y, z]) = (joint_of(node), &node.numbers("center")?[..]) {
            centres.insert(joint, Vec3::new(*x, *y, *z));
        }
    }
    Ok(centres)
}

/// The file's figure as bones: the joints of the file if the needed ones have centres, else the program's own
/// skeleton with hanging arms and legs.
fn bones(centres: &BTreeMap<Joint, Vec3>, skeleton: &Skeleton) -> Vec<Bone> {
    let needed = [
        Joint::HumanoidRoot,
        Joint::LHip,
        Joint::RHip,
        Joint::LKnee,
        Joint::RKnee,
        Joint::LAnkle,
        Joint::LShoulder,
        Joint::LElbow,
    ];
    let whole = needed.iter().all(|joint| centres.contains_key(joint));
    let hang = [
        Joint::LKnee,
        Joint::RKnee,
        Joint::LAnkle,
        Joint::RAnkle,
        Joint::LElbow,
        Joint::RElbow,
        Joint::LWrist,
        Joint::RWrist,
    ];
    let hanging = |joint: Joint| match hang.contains(&joint) {
        true => -Vec3::y() * skeleton.offset(joint).norm(),
        false => skeleton.offset(joint),
    };
    let mut place = BTreeMap::new();
    for joint in Joint::ALL {
        let above = joint.parent().and_then(|p| place.get(&p).copied());
        let own = match whole {
            true => centres.get(&joint).copied(),
            false => None,
        };
        // A joint that the file lacks has the same offset from its parent as in the program's skeleton.
        let at = own.unwrap_or_else(|| above.unwrap_or_default() + hanging(joint));
        place.insert(joint, at);
    }
    let end = |joint: Joint| matches!(joint, Joint::LAnkle | Joint::RAnkle);
    Joint::ALL
        .into_iter()
        .map(|joint| {
            let above = joint.parent().and_then(|p| place.get(&p).copied());
            Bone {
                name: joint.name().to_owned(),
                parent: joint.parent().map(|p| p as usize),
                offset: place[&joint] - above.unwrap_or_default(),
                end: end(joint).then(|| -Vec3::y() * place[&joint].y.max(0.0)),
                channels: Vec::new(),
            }
        })
        .collect()
}

/// Rest position of the root above the soles.
fn rest_of_root(bones: &[Bone]) -> Vec3 {
    let mut place: Vec<Vec3> = Vec::new();
    for bone in bones {
        let above = bone.parent.map_or(Vec3::zeros(), |p| place[p]);
        place.push(above + bone.offset);
    }
    let low = bones
        .iter()
        .zip(&place)
        .map(|(bone, p)| p.y + bone.end.map_or(0.0, |end| end.y.min(0.0)))
        .fold(f64::INFINITY, f64::min);
    Vec3::new(0.0, place[0].y - low, 0.0)
}

/// The keys of an interpolator with their values, in ascending order; `width` is the number of values of a key.
fn keys(node: &Node, width: usize) -> Result<Vec<(f64, Vec<f64>)>, FormatError> {
    let (key, value) = (node.numbers("key")?, node.numbers("keyValue")?);
    if key.is_empty() || key.len() * width != value.len() {
        return Err(FormatError::new(
            node.place(),
            format!(
                "{} keys and {} numbers of keyValue do not go together",
                key.len(),
                value.len()
            ),
            format!("give {width} numbers of keyValue for every key"),
        ));
    }
    if key.windows(2).any(|w| w[1] < w[0]) {
        return Err(FormatError::new(
            node.place(),
            "the keys do not ascend",
            "order them from 0 to 1",
        ));
    }
    let mut rows: Vec<(f64, Vec<f64>)> = key
        .into_iter()
        .zip(value.chunks(width).map(<[f64]>::to_vec))
        .collect();
    // Of keys at the same time the last one counts.
    rows.reverse();
    rows.dedup_by(|a, b| a.0 == b.0);
    rows.reverse();
    Ok(rows)
}

fn turns_of(node: &Node) -> Result<Turns, FormatError> {
    let rows = keys(node, 4)?.into_iter().map(|(key, value)| {
        let axis = Vec3::new(value[0], value[1], value[2]);
        let axis = nalgebra::Unit::try_new(axis, 1e-9);
        let turn = axis.map_or(UnitQuaternion::identity(), |axis| {
            UnitQuaternion::from_axis_angle(&axis, value[3])
        });
        (key, turn)
    });
    Ok(Turns(rows.collect()))
}

fn places_of(node: &Node) -> Result<Vec<(f64, Vec3)>, FormatError> {
    let rows = keys(node, 3)?;
    let place = |v: Vec<f64>| Vec3::new(v[0], v[1], v[2]);
    Ok(rows.into_iter().map(|(key, v)| (key, place(v))).collect())
}

fn place_at(rows: &[(f64, Vec3)], share: f64) -> Vec3 {
    let next = rows.partition_point(|row| row.0 <= share);
    match (next.checked_sub(1).map(|k| rows[k]), rows.get(next)) {
        (Some((from, a)), Some(&(to, b))) => a + (b - a) * ((share - from) / (to - from)),
        (Some((_, a)), None) => a,
        (None, Some(&(_, b))) => b,
        (None, None) => Vec3::zeros(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toile_body::{Figure, Mannequin, Pose};

    const VRML: &str = "#VRML V2.0 utf8\n\
        DEF clock TimeSensor { cycleInterval 2 loop TRUE }\n\
        DEF hanim_humanoid_root Joint { name \"humanoid_root\" children [\n\
        DEF hanim_l_hip Joint { name \"l_hip\" children [ DEF hanim_l_knee Joint { name \"l_knee\" } ] } ] }\n\
        DEF hip_turn OrientationInterpolator {\n\
        key [ 0, 0.5, 1 ] keyValue [ 1 0 0 0, 1 0 0 -1.5707963, 1 0 0 0 ] }\n\
        ROUTE clock.fraction_changed TO hip_turn.set_fraction\n\
        ROUTE hip_turn.value_changed TO hanim_l_hip.set_rotation\n";

    const XML: &str = "<?xml version='1.0'?>\n<X3D><Scene>\n\
        <TimeSensor DEF='clock' cycleInterval='2' loop='true'/>\n\
        <HAnimJoint DEF='hanim_l_hip' name='l_hip'/>\n\
        <OrientationInterpolator DEF='hip_turn' key='0 0.5 1'\n keyValue='1 0 0 0 1 0 0 -1.5707963 1 0 0 0'/>\n\
        <ROUTE fromNode='hip_turn' fromField='value_changed' toNode='hanim_l_hip' toField='rotation'/>\n\
        </Scene></X3D>\n";

    fn skeleton() -> Skeleton {
        static ONE: std::sync::OnceLock<Skeleton> = std::sync::OnceLock::new();
        let make = || {
            let body = Mannequin::new(&Figure::Woman.average(), Figure::Woman);
            body.unwrap().skeleton().clone()
        };
        ONE.get_or_init(make).clone()
    }

    #[test]
    fn both_encodings_lift_the_thigh() {
        let skeleton = skeleton();
        let [a, b] = [VRML, XML].map(|text| read_x3d(text, &skeleton).unwrap().0);
        assert_eq!(a, b);
        assert!(a.is_loop && (a.duration() - 2.0).abs() < 1e-12);
        let thigh = |pose: &Pose| {
            let frames = skeleton.frames(pose);
            (frames.centre(Joint::LKnee) - frames.centre(Joint::LHip)).normalize()
        };
        // First hanging straight down, then lifted forward by a quarter turn.
        assert!((thigh(&a.at(0.0)) + Vec3::y()).norm() < 1e-6);
        assert!((thigh(&a.at(1.0)) - Vec3::z()).norm() < 1e-6);
        let half = thigh(&a.at(0.5));
        assert!((half.y + half.z).abs() < 1e-6, "{half:?}");
        // No other joint moves.
        let frames = [0.0, 1.0].map(|t| skeleton.frames(&a.at(t)));
        let still = |joint: Joint| (frames[0].centre(joint) - frames[1].centre(joint)).norm();
        assert!(still(Joint::RKnee) < 1e-9 && still(Joint::LWrist) < 1e-9);
    }

    #[test]
    fn damage_is_refused_with_line_and_node() {
        let skeleton = skeleton();
        let error = |text: &str| read_x3d(text, &skeleton).unwrap_err().to_string();
        let short = VRML.replace("0, 0.5, 1 ]", "0, 1 ]");
        assert!(error(&short).contains("line 5, OrientationInterpolator hip_turn"));
        let lost = VRML.replace("ROUTE hip_turn", "ROUTE other");
        assert!(error(&lost).contains("line 8"), "{}", error(&lost));
        let word = VRML.replace("0.5", "half");
        assert!(
            error(&word).contains("line 5, OrientationInterpolator hip_turn"),
            "{}",
            error(&word)
        );
        assert!(error("").contains("VRML"));
        let none = VRML.replace("hanim_l_hip.set", "clock.set");
        assert!(error(&none).contains("no OrientationInterpolator"));
        let long = VRML.replace("cycleInterval 2", "cycleInterval -2");
        assert!(error(&long).contains("TimeSensor"));
    }

    /// A walk and a run of a figure with joints from a prototype, with a finger joint and a sequencer.
    const CLIPS: &str = "#VRML V2.0 utf8\n\
        PROTO Joint [ exposedField SFVec3f center 0 0 0 exposedField SFString name \"\" ]\n\
        { Transform { center IS center } }\n\
        DEF hanim_l_hip Joint { name \"l_hip\" } DEF hanim_l_index1 Joint { name \"l_index1\" }\n\
        DEF walk TimeSensor { cycleInterval 2 loop TRUE } DEF run TimeSensor { cycleInterval 1 }\n\
        DEF steps BooleanSequencer { key [ 0 1 ] keyValue [ TRUE FALSE ] }\n\
        DEF walk_hip OrientationInterpolator { key [ 0 1 ] keyValue [ 1 0 0 0 1 0 0 -1 ] }\n\
        DEF run_hip OrientationInterpolator { key [ 0 1 ] keyValue [ 1 0 0 0 1 0 0 -2 ] }\n\
        DEF idle_hip OrientationInterpolator { key [ 0 1 ] keyValue [ 1 0 0 0 1 0 0 -3 ] }\n\
        ROUTE walk.fraction_changed TO walk_hip.set_fraction\n\
        ROUTE run.fraction_changed TO run_hip.set_fraction\n\
        ROUTE walk_hip.value_changed TO hanim_l_hip.set_rotation\n\
        ROUTE walk_hip.value_changed TO hanim_l_index1.set_rotation\n\
        ROUTE run_hip.value_changed TO hanim_l_hip.set_rotation\n\
        ROUTE idle_hip.value_changed TO hanim_l_hip.set_rotation\n";

    #[test]
    fn of_several_clips_the_first_is_taken_and_what_is_left_out_is_told() {
        let skeleton = skeleton();
        let (motion, notes) = read_x3d(CLIPS, &skeleton).unwrap();
        assert!(motion.is_loop && (motion.duration() - 2.0).abs() < 1e-12);
        let frames = skeleton.frames(&motion.at(1.0));
        let thigh = (frames.centre(Joint::LKnee) - frames.centre(Joint::LHip)).normalize();
        assert!((thigh.z - 0.5f64.sin()).abs() < 1e-6, "{thigh}");
        assert_eq!(
            notes,
            [
                "the file has 2 clips, of the TimeSensors walk, run: walk is taken",
                "left out: idle_hip; no TimeSensor leads to them",
                "left out: hanim_l_index1; the body has no such joints",
            ]
        );
        assert!(read_x3d(VRML, &skeleton).unwrap().1.is_empty());
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(cut in 0..VRML.len(), add in "[A-Za-z0-9 {}\\[\\]<>='.#-]{0,20}") {
            let skeleton = skeleton();
            for text in [VRML, XML] {
                let cut = cut.min(text.len());
                let text = format!("{}{add}{}", &text[..cut], &text[cut..]);
                if let Ok((motion, _)) = read_x3d(&text, &skeleton) {
                    prop_assert!(motion.poses.len() > 1);
                }
            }
        }
    }
}
