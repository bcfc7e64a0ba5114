//! Checkpoints of a garment's run as files: two lines of JSON, what the file is and the checkpoint. Numbers are
//! written so that they are read again to the last bit; a checksum finds what was changed since.

use crate::FormatError;
use crate::scene::json_error;
use serde::{Deserialize, Serialize};
use toile_drape::Checkpoint;

/// What the first line says.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: String,
    version: u32,
    /// CRC-32 of the second line.
    checksum: u32,
}

/// The name of the format, and the version that is written and read: what was saved by another goes on to
/// other bytes.
const FORMAT: &str = "toile-checkpoint";
const VERSION: u32 = 1;

/// What to do about a file that does not serve.
const REMEDY: &str = "take another checkpoint, or drape from the start";

/// Writes a checkpoint.
///
/// # Errors
/// One that JSON has no words for.
pub fn write_checkpoint(checkpoint: &Checkpoint) -> Result<String, FormatError> {
    let body = serde_json::to_string(checkpoint).map_err(|error| json_error(&error))?;
    let head = Head {
        format: FORMAT.to_owned(),
        version: VERSION,
        checksum: crc32fast::hash(body.as_bytes()),
    };
    let head = serde_json::to_string(&head).map_err(|error| json_error(&error))?;
    Ok(format!("{head}\n{body}\n"))
}

/// Reads a checkpoint.
///
/// # Errors
/// Text that is no checkpoint, of another version, cut short or changed, by the place and what to do.
pub fn read_checkpoint(text: &str) -> Result<Checkpoint, FormatError> {
    let (head, body) = text.split_once('\n').unwrap_or((text, ""));
    let is_ours = head.contains(FORMAT);
    let head: Head = serde_json::from_str(head).map_err(|error| match is_ours {
        true => FormatError::new("line 1", error.to_string(), REMEDY),
        false => no_checkpoint(),
    })?;
    if head.format != FORMAT {
        return Err(no_checkpoint());
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

fn no_checkpoint() -> FormatError {
    FormatError::new(
        "line 1",
        format!("this is no checkpoint: the format is not \"{FORMAT}\""),
        "choose the file of a checkpoint",
    )
}
