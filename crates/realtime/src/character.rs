//! A character as it is written in files: joints, groups of ellipsoids, clips by key poses.

use crate::RealtimeError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A figure approximated by ellipsoids that hang on a tree of joints (Rudomin, Castillo, Muñoz and
/// Alencastre 2002). All places are those of the rest pose.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Character {
    /// The joints, each after the one it hangs on.
    pub joints: Vec<CharacterJoint>,
    /// Groups of ellipsoids.
    pub groups: Vec<Group>,
    /// The ellipsoids.
    pub ellipsoids: Vec<CharacterEllipsoid>,
    /// The motions; may be none.
    #[serde(default)]
    pub clips: Vec<KeyedClip>,
}

/// A character file: its kind and version before the character. `serde_json` reads it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CharacterFile {
    /// The version of the format.
    toile: u32,
    /// "character".
    kind: String,
    joints: Vec<CharacterJoint>,
    groups: Vec<Group>,
    ellipsoids: Vec<CharacterEllipsoid>,
    #[serde(default)]
    clips: Vec<KeyedClip>,
}

impl CharacterFile {
    /// The version written, and the only one read.
    pub const VERSION: u32 = 1;
    /// The kind that a character file names.
    pub const KIND: &str = "character";

    /// The character, checked.
    ///
    /// # Errors
    /// Another kind or version, and what [`Character::check`] finds.
    pub fn into_character(self) -> Result<Character, RealtimeError> {
        if self.kind != Self::KIND || self.toile != Self::VERSION {
            return Err(RealtimeError::new(
                "kind",
                format!(
                    "{:?} of version {} is not known here",
                    self.kind, self.toile
                ),
                "begin with \"toile\": 1, \"kind\": \"character\"",
            ));
        }
        let character = Character {
            joints: self.joints,
            groups: self.groups,
            ellipsoids: self.ellipsoids,
            clips: self.clips,
        };
        character.check()?;
        Ok(character)
    }
}

/// A joint of the tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CharacterJoint {
    /// Its name.
    pub name: String,
    /// The joint it hangs on; none for one that moves freely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<String>,
    /// Its place at rest (m).
    pub at: [f32; 3],
}

/// Ellipsoids that are near each other and move alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// Names of the groups beside it; said once, it holds both ways.
    #[serde(default)]
    pub touches: Vec<String>,
}

/// One ellipsoid at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CharacterEllipsoid {
    /// The joint it moves with; its parent is the ellipsoids of the joint above.
    pub joint: String,
    /// Its group.
    pub group: String,
    /// Centre at rest (m).
    pub at: [f32; 3],
    /// Semi-axes (m).
    pub semi_axes: [f32; 3],
    /// Rotation vector from its axes to the character's: axis times angle (rad).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub turn: [f32; 3],
}

/// A motion by key poses; between them poses are blended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyedClip {
    /// Its name.
    pub name: String,
    /// Whether it begins anew after the last key, which then shows the first pose again.
    #[serde(default, rename = "loop")]
    pub is_loop: bool,
    /// The key poses in the order of time, the first at 0. One alone is a standing pose.
    pub keys: Vec<KeyPose>,
}

/// A pose at a time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyPose {
    /// When (s).
    pub time: f32,
    /// How far joints without parent are moved from rest (m).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shift: [f32; 3],
    /// Rotation vector of each joint that is turned, about its place, in the frame of the joint it
    /// hangs on (rad).
    #[serde(default)]
    pub turns: BTreeMap<String, [f32; 3]>,
}

fn is_zero(v: &[f32; 3]) -> bool {
    *v == [0.0; 3]
}

/// Groups at the most: which groups touch is kept in the bits of a word.
pub const MAX_GROUPS: usize = 64;

/// Ellipsoids at the most: more are no coarse figure, and a slip of the pen in a file by hand.
const MAX_ELLIPSOIDS: usize = 4096;

/// Largest coordinate of a place, and longest clip (m, s): beyond them `f32` tells millimetres and
/// milliseconds no longer apart.
const LARGEST: f32 = 1e4;

/// Names of a list with their numbers; a name given twice is refused.
fn numbered<'a>(
    list: &str,
    names: impl Iterator<Item = &'a str>,
) -> Result<BTreeMap<&'a str, usize>, RealtimeError> {
    let mut found = BTreeMap::new();
    for (k, name) in names.enumerate() {
        if found.insert(name, k).is_some() {
            return Err(RealtimeError::new(
                format!("{list}[{k}]"),
                format!("the name {name} is given twice"),
                "give each a name of its own",
            ));
        }
    }
    Ok(found)
}

fn finite(place: &str, numbers: &[f32]) -> Result<(), RealtimeError> {
    match numbers.iter().all(|x| x.abs() <= LARGEST) {
        true => Ok(()),
        false => Err(RealtimeError::new(
            place,
            format!("{numbers:?} is no number or is larger than {LARGEST}"),
            "write lengths in metres, times in seconds and turns in radians",
        )),
    }
}

fn unknown(place: String, what: &str, name: &str) -> RealtimeError {
    RealtimeError::new(
        place,
        format!("there is no {what} {name}"),
        "name one that stands in the file, or add it",
    )
}

/// The numbers that names of a character stand for.
pub(crate) struct Numbers<'a> {
    pub joints: BTreeMap<&'a str, usize>,
    pub groups: BTreeMap<&'a str, usize>,
}

impl Character {
    /// Checks that names are there and once, that parents come first, that numbers are finite and
    /// sizes above zero, and that times rise.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn check(&self) -> Result<(), RealtimeError> {
        let numbers = self.numbers()?;
        self.check_ellipsoids(&numbers)?;
        numbered("clips", self.clips.iter().map(|clip| &*clip.name))?;
        for clip in &self.clips {
            clip.check(&numbers)?;
        }
        Ok(())
    }

    pub(crate) fn numbers(&self) -> Result<Numbers<'_>, RealtimeError> {
        let joints = numbered("joints", self.joints.iter().map(|joint| &*joint.name))?;
        for (k, joint) in self.joints.iter().enumerate() {
            let place = format!("joints[{k}] {}", joint.name);
            finite(&place, &joint.at)?;
            let Some(parent) = &joint.parent else {
                continue;
            };
            match joints.get(&**parent) {
                None => return Err(unknown(place, "joint", parent)),
                Some(&above) if above >= k => {
                    return Err(RealtimeError::new(
                        place,
                        format!("it hangs on {parent}, which comes no earlier"),
                        "list every joint after the one it hangs on",
                    ));
                }
                Some(_) => {}
            }
        }
        let groups = numbered("groups", self.groups.iter().map(|group| &*group.name))?;
        if groups.len() > MAX_GROUPS {
            return Err(RealtimeError::new(
                "groups",
                format!("{} groups are more than {MAX_GROUPS}", groups.len()),
                "join groups that move alike",
            ));
        }
        for (k, group) in self.groups.iter().enumerate() {
            let lost = group
                .touches
                .iter()
                .find(|name| !groups.contains_key(&***name));
            if let Some(name) = lost {
                return Err(unknown(
                    format!("groups[{k}] {}", group.name),
                    "group",
                    name,
                ));
            }
        }
        Ok(Numbers { joints, groups })
    }

    fn check_ellipsoids(&self, numbers: &Numbers) -> Result<(), RealtimeError> {
        if !(1..=MAX_ELLIPSOIDS).contains(&self.ellipsoids.len()) {
            return Err(RealtimeError::new(
                "ellipsoids",
                format!("there are {}", self.ellipsoids.len()),
                "a character has 1 to 4096 of them",
            ));
        }
        for (k, ellipsoid) in self.ellipsoids.iter().enumerate() {
            let place = format!("ellipsoids[{k}]");
            if !numbers.joints.contains_key(&*ellipsoid.joint) {
                return Err(unknown(place, "joint", &ellipsoid.joint));
            }
            if !numbers.groups.contains_key(&*ellipsoid.group) {
                return Err(unknown(place, "group", &ellipsoid.group));
            }
            finite(&place, &ellipsoid.at)?;
            finite(&place, &ellipsoid.turn)?;
            finite(&place, &ellipsoid.semi_axes)?;
            if ellipsoid.semi_axes.iter().any(|&axis| axis < 1e-3) {
                return Err(RealtimeError::new(
                    place,
                    format!("the semi-axes {:?} are too small", ellipsoid.semi_axes),
                    "give each a millimetre (0.001) or more",
                ));
            }
        }
        Ok(())
    }
}

impl KeyedClip {
    fn check(&self, numbers: &Numbers) -> Result<(), RealtimeError> {
        let place = format!("clip {}", self.name);
        let least = 1 + usize::from(self.is_loop);
        if self.keys.len() < least {
            return Err(RealtimeError::new(
                place,
                format!("it has {} key poses", self.keys.len()),
                "a clip has one at least, and a loop two, the last like the first",
            ));
        }
        let mut before = None;
        for (k, key) in self.keys.iter().enumerate() {
            let place = format!("{place}, keys[{k}]");
            finite(&place, &[key.time])?;
            finite(&place, &key.shift)?;
            let follows = match before {
                None => key.time == 0.0,
                Some(before) => key.time > before,
            };
            if !follows {
                return Err(RealtimeError::new(
                    place,
                    format!("its time is {} s", key.time),
                    "let the first key stand at 0 and each later than the one before",
                ));
            }
            before = Some(key.time);
            for (name, turn) in &key.turns {
                if !numbers.joints.contains_key(&**name) {
                    return Err(unknown(place, "joint", name));
                }
                finite(&place, turn)?;
            }
        }
        Ok(())
    }
}
