//! A mannequin as a character of real time: its joints, its ellipsoids in groups by part, clips as
//! key poses (Rudomin, Castillo, Muñoz and Alencastre 2002).

use crate::{BodyError, Clip, Joint, Mannequin, Part, Pose, Skeleton, VISIBLE_RATIO};
use toile_geometry::Vec3;
use toile_realtime::{
    Character, CharacterEllipsoid, CharacterJoint, Ellipsoids, Field, Group, KeyPose, KeyedClip,
};

/// Share of the skin's vertices nearest to an ellipsoid that must lie inside it. With a share of 1, the
/// ellipsoids beside a crease would become too large.
const COVERED: f32 = 0.9;

/// Largest length added to the semi-axes of an ellipsoid so that it covers the skin (m).
const MAX_ENLARGED: f32 = 0.03;

/// Name of the group of a part's ellipsoids.
fn group(part: Part) -> &'static str {
    match part {
        Part::Trunk => "trunk",
        Part::Head => "head",
        Part::LeftArm => "left arm",
        Part::RightArm => "right arm",
        Part::LeftLeg => "left leg",
        Part::RightLeg => "right leg",
    }
}

fn single(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

impl Mannequin {
    /// The body as a character with some named clips: an ellipsoid for every primitive, in a group for each
    /// part. The groups of head, arms and legs touch only that of the trunk. Where primitives blend, the skin
    /// lies outside their ellipsoids: each ellipsoid is enlarged until it holds most of the skin that it is
    /// nearest to.
    ///
    /// # Errors
    /// [`BodyError::NotRigid`] for a primitive that changes with a reference joint: a character's ellipsoids
    /// are rigid.
    pub fn character(&self, clips: &[(&str, &Clip)]) -> Result<Character, BodyError> {
        let skeleton = self.skeleton();
        if let Some(k) = self
            .primitives()
            .iter()
            .position(|p| p.deformation.is_some())
        {
            return Err(BodyError::NotRigid { primitive: k });
        }
        let joints = skeleton.joints().map(|(joint, at)| CharacterJoint {
            name: joint.name().to_owned(),
            parent: joint.parent().map(|parent| parent.name().to_owned()),
            at: single(at),
        });
        let groups = Part::ALL.map(|part| Group {
            name: group(part).to_owned(),
            touches: match part {
                Part::Trunk => Vec::new(),
                _ => vec![group(Part::Trunk).to_owned()],
            },
        });
        let ellipsoids = self.primitives().iter().map(|attached| {
            let local = &attached.local;
            CharacterEllipsoid {
                joint: attached.joint.name().to_owned(),
                group: group(local.part).to_owned(),
                at: single(skeleton.centre(attached.joint) + Vec3::from(local.centre)),
                semi_axes: single(Vec3::from(local.radii) * VISIBLE_RATIO),
                turn: single(Vec3::from(local.rotation)),
            }
        });
        let clips = clips.iter().map(|(name, clip)| keyed(name, clip, skeleton));
        let mut character = Character {
            joints: joints.collect(),
            groups: groups.into(),
            ellipsoids: ellipsoids.collect(),
            clips: clips.collect(),
        };
        self.cover(&mut character);
        Ok(character)
    }

    /// Enlarges each ellipsoid until it holds most of the skin at rest that it is nearest to.
    fn cover(&self, character: &mut Character) {
        let Ok(ellipsoids) = Ellipsoids::new(character) else {
            return;
        };
        let Ok(field) = Field::new(&ellipsoids, 0.0) else {
            return;
        };
        let mut gaps = vec![Vec::new(); ellipsoids.len()];
        for &p in &self.skin().positions {
            if let Some(nearest) = field.nearest(single(p)) {
                gaps[nearest.ellipsoid].push(nearest.distance);
            }
        }
        for (ellipsoid, gaps) in character.ellipsoids.iter_mut().zip(&mut gaps) {
            gaps.sort_by(f32::total_cmp);
            let index = (COVERED * gaps.len() as f32) as usize;
            let gap = gaps.get(index).copied().unwrap_or(0.0);
            let more = gap.clamp(0.0, MAX_ENLARGED);
            ellipsoid.semi_axes = ellipsoid.semi_axes.map(|axis| axis + more);
        }
    }
}

/// A clip as key poses of a skeleton; in a loop the first pose is repeated at the end.
fn keyed(name: &str, clip: &Clip, skeleton: &Skeleton) -> KeyedClip {
    let again = clip.poses.first().filter(|_| clip.is_loop);
    let keys = clip.poses.iter().chain(again).enumerate();
    KeyedClip {
        name: name.to_owned(),
        is_loop: clip.is_loop,
        keys: keys
            .map(|(k, pose)| KeyPose {
                time: (k as f64 * clip.step) as f32,
                shift: single(pose.shift * skeleton.leg_length()),
                turns: Joint::ALL
                    .into_iter()
                    .filter_map(|joint| turn(pose, joint))
                    .collect(),
            })
            .collect(),
    }
}

fn turn(pose: &Pose, joint: Joint) -> Option<(String, [f32; 3])> {
    let vector = single(pose.rotation(joint).scaled_axis());
    (vector != [0.0; 3]).then(|| (joint.name().to_owned(), vector))
}
