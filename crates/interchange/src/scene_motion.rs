//! Rigid motions in the scene file.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use toile_drape::{Motion, MotionKey};
use toile_geometry::Vec3;

/// Unknown fields, by name.
pub(crate) type Unknown = BTreeMap<String, Value>;

/// A motion as written in the file. A solid moves by keys, linearly from key to key, and rests before the
/// first key and after the last. A body moves by a clip; keys then turn it about its own root and shift it.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct MotionFile {
    /// The pivot of rotations, in the scene (m).
    #[serde(default)]
    pub pivot: [f64; 3],
    /// The keys: positions and rotations at given times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<KeyFile>,
    /// The clip of a body: `walk`, `run`, `stand`, `astride`, or a file (BVH, X3D, VRML).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<String>,
    /// Number of loop cycles after which the figure stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strides: Option<f64>,
    /// Playback rate of the clip, 0 to 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Whether the figure travels over the ground; otherwise it stays in place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub travel: Option<bool>,
    /// Whether the figure moves from its dressing pose to the start of the clip before time 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lead_in: Option<bool>,
    #[serde(flatten)]
    unknown: Unknown,
}

/// One key of a motion.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct KeyFile {
    /// The time (s).
    pub time: f64,
    /// Translation from the loaded position (m).
    #[serde(default)]
    pub translation: [f64; 3],
    /// Rotation vector: axis times angle (rad).
    #[serde(default)]
    pub rotation: [f64; 3],
    #[serde(flatten)]
    unknown: Unknown,
}

/// Vertices that follow a given motion.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct GripFile {
    /// The vertices.
    pub vertices: Vec<u32>,
    /// The motion.
    pub motion: MotionFile,
    #[serde(flatten)]
    unknown: Unknown,
}

impl MotionFile {
    /// Names of the given fields that apply only to the clip of a body.
    pub fn clip_fields(&self) -> Vec<&'static str> {
        let given = [
            ("clip", self.clip.is_some()),
            ("strides", self.strides.is_some()),
            ("rate", self.rate.is_some()),
            ("travel", self.travel.is_some()),
            ("lead_in", self.lead_in.is_some()),
        ];
        let given = given.into_iter().filter(|(_, given)| *given);
        given.map(|(field, _)| field).collect()
    }

    /// The motion that the keys describe; the clip is ignored.
    pub fn motion(&self) -> Motion {
        let keys = self.keys.iter().map(|key| MotionKey {
            time: key.time,
            translation: Vec3::from(key.translation),
            rotation: Vec3::from(key.rotation),
        });
        Motion {
            pivot: Vec3::from(self.pivot),
            keys: keys.collect(),
        }
    }

    /// Unknown fields, each with the path of its place.
    pub(crate) fn unknown_fields(&self) -> Vec<(String, &Unknown)> {
        let keys = self.keys.iter().enumerate();
        std::iter::once((String::new(), &self.unknown))
            .chain(keys.map(|(k, key)| (format!(".keys[{k}]"), &key.unknown)))
            .collect()
    }
}

impl GripFile {
    /// Unknown fields, each with the path of its place.
    pub(crate) fn unknown_fields(&self) -> Vec<(String, &Unknown)> {
        let motion = self.motion.unknown_fields().into_iter();
        std::iter::once((String::new(), &self.unknown))
            .chain(motion.map(|(place, unknown)| (format!(".motion{place}"), unknown)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_read_and_unknown_fields_are_named() {
        let text = r#"{ "vertices": [0, 1], "motion": { "pivot": [0, 1, 0], "speed": 3,
            "keys": [ { "time": 0 }, { "time": 1, "rotation": [0, 12.5, 0], "ease": "in" } ] } }"#;
        let grip: GripFile = serde_json::from_str(text).expect("readable");
        let motion = grip.motion.motion();
        assert_eq!(motion.pivot, Vec3::new(0.0, 1.0, 0.0));
        assert_eq!(motion.keys.len(), 2);
        assert_eq!(motion.keys[1].rotation.y, 12.5);
        assert!(motion.defect().is_none());
        let named: Vec<String> = (grip.unknown_fields().iter())
            .flat_map(|(place, fields)| fields.keys().map(move |key| format!("{place}.{key}")))
            .collect();
        assert_eq!(named, [".motion.speed", ".motion.keys[1].ease"]);
        let walk = r#"{ "clip": "walk", "strides": 8, "travel": false }"#;
        let walk: MotionFile = serde_json::from_str(walk).expect("readable");
        assert_eq!(walk.clip_fields(), ["clip", "strides", "travel"]);
        assert!(walk.motion().defect().is_some(), "it has no key");
    }
}
