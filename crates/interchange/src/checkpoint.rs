//! Checkpoints of a garment's or a scene's run as files of two lines of JSON: a head with format and
//! checksum, then the checkpoint. Numbers are written so that reading gives back every bit; the checksum
//! detects later changes.
//!
//! # Decided with
//! - [`toile_drape::Checkpoint`], [`toile_drape::SceneCheckpoint`]: what is saved;
//! - [`toile_drape::State`], [`toile_drape::Memory`], [`toile_drape::Control`]: parts of what is saved;
//! - [`crate::atomic::write_atomically`]: files written whole or not at all.
//!
//! By hand: `VERSION` is raised when a saved part changes.

use crate::FormatError;
use crate::scene::json_error;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toile_drape::{Checkpoint, SceneCheckpoint};

/// The first line of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: String,
    version: u32,
    /// CRC-32 of the second line.
    checksum: u32,
}

/// A type that can be saved as a checkpoint, with the name of its format. The type that `toile run` writes is
/// defined in `toile-session`: it holds a scene's run together with the counts of its report.
pub trait CheckpointFormat: Serialize + DeserializeOwned {
    /// The name of the format.
    const FORMAT: &'static str;
}

impl CheckpointFormat for Checkpoint {
    const FORMAT: &'static str = "toile-checkpoint";
}

impl CheckpointFormat for SceneCheckpoint {
    const FORMAT: &'static str = "toile-scene-checkpoint";
}

/// The version written and read. A checkpoint of another version would continue to different results.
const VERSION: u32 = 5;

/// Remedy for a checkpoint that cannot be used.
const REMEDY: &str = "take another checkpoint, or drape from the start";

/// Writes a checkpoint.
///
/// # Errors
/// The checkpoint has a value that JSON cannot represent.
pub fn write_checkpoint<C: CheckpointFormat>(checkpoint: &C) -> Result<String, FormatError> {
    let body = serde_json::to_string(checkpoint).map_err(|error| json_error(&error))?;
    let head = Head {
        format: C::FORMAT.to_owned(),
        version: VERSION,
        checksum: crc32fast::hash(body.as_bytes()),
    };
    let head = serde_json::to_string(&head).map_err(|error| json_error(&error))?;
    Ok(format!("{head}\n{body}\n"))
}

/// Reads a checkpoint.
///
/// # Errors
/// The text is no checkpoint, is of another version, cut short or changed: the place and a remedy.
pub fn read_checkpoint<C: CheckpointFormat>(text: &str) -> Result<C, FormatError> {
    let (head, body) = text.split_once('\n').unwrap_or((text, ""));
    let is_ours = head.contains(C::FORMAT);
    let head: Head = serde_json::from_str(head).map_err(|error| match is_ours {
        true => FormatError::new("line 1", error.to_string(), REMEDY),
        false => no_checkpoint(C::FORMAT),
    })?;
    if head.format != C::FORMAT {
        return Err(no_checkpoint(C::FORMAT));
    }
    if head.version != VERSION {
        return Err(FormatError::new(
            "version",
            format!(
                "it is {}; only version {VERSION} is known here",
                head.version
            ),
            "go on with the program that wrote it, or drape from the start",
        ));
    }
    let body = body.strip_suffix('\n').unwrap_or(body);
    if crc32fast::hash(body.as_bytes()) != head.checksum {
        return Err(FormatError::new(
            "line 2",
            "it was cut short or changed since it was written",
            REMEDY,
        ));
    }
    serde_json::from_str(body).map_err(|error| {
        let place = format!("line 2, column {}", error.column());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or_default();
        FormatError::new(place, what, REMEDY)
    })
}

fn no_checkpoint(format: &str) -> FormatError {
    FormatError::new(
        "line 1",
        format!("this is no checkpoint: the format is not \"{format}\""),
        "choose the file of a checkpoint",
    )
}
