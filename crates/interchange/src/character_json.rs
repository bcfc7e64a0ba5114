//! Character files: ellipsoids, joints and clips for real time, as JSON that can be written by hand.

use crate::FormatError;
use toile_realtime::{Character, CharacterFile};

/// Reads a character file and checks it.
///
/// # Errors
/// The text is not a character file, or the character is not valid: the place and the remedy.
pub fn read_character(text: &str) -> Result<Character, FormatError> {
    let hint = "write {\"toile\": 1, \"kind\": \"character\", \"joints\": […], \"groups\": […], \"ellipsoids\": […]}";
    let file: CharacterFile = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        FormatError::new(place, error.to_string(), hint)
    })?;
    let refused = |error: toile_realtime::RealtimeError| {
        FormatError::new(error.place, error.what, error.hint)
    };
    file.into_character().map_err(refused)
}

/// Writes a character file, with one line for every joint, group, ellipsoid and key pose.
///
/// # Errors
/// The character has a value that JSON cannot represent.
pub fn write_character(character: &Character) -> Result<String, FormatError> {
    let line = |value: Result<String, serde_json::Error>| {
        value.map_err(|error| FormatError::new("character", error.to_string(), "correct it"))
    };
    let list = |name: &str, lines: Vec<String>| {
        format!("  \"{name}\": [\n    {}\n  ]", lines.join(",\n    "))
    };
    let joints: Result<Vec<_>, _> = (character.joints.iter())
        .map(|joint| line(serde_json::to_string(joint)))
        .collect();
    let groups: Result<Vec<_>, _> = (character.groups.iter())
        .map(|group| line(serde_json::to_string(group)))
        .collect();
    let ellipsoids: Result<Vec<_>, _> = (character.ellipsoids.iter())
        .map(|ellipsoid| line(serde_json::to_string(ellipsoid)))
        .collect();
    let mut clips = Vec::new();
    for clip in &character.clips {
        let keys: Result<Vec<_>, _> = (clip.keys.iter())
            .map(|key| line(serde_json::to_string(key)))
            .collect();
        clips.push(format!(
            "{{\"name\": {}, \"loop\": {}, \"keys\": [\n      {}\n    ]}}",
            line(serde_json::to_string(&clip.name))?,
            clip.is_loop,
            keys?.join(",\n      ")
        ));
    }
    let lists = [
        list("joints", joints?),
        list("groups", groups?),
        list("ellipsoids", ellipsoids?),
        list("clips", clips),
    ];
    Ok(format!(
        "{{\n  \"toile\": {},\n  \"kind\": \"{}\",\n{}\n}}\n",
        CharacterFile::VERSION,
        CharacterFile::KIND,
        lists.join(",\n")
    ))
}
