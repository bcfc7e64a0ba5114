//! The file that a state of a document is kept in: a line with length and checksum, a line with the
//! head as JSON, then the document as its own file would be.

use super::PastStep;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Start of the first line: the name and version of the format.
const FORMAT: &str = "toile-recovery 1";

/// A state of a document.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DocumentState {
    pub head: Head,
    /// The pattern in the native format.
    pub text: String,
}

/// Facts about a document that are read without its text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Head {
    pub name: String,
    /// The file that the document was last saved to.
    pub source: Option<PathBuf>,
    /// The last steps of the document's history, the newest first; empty in files of older versions.
    #[serde(default)]
    pub past: Vec<PastStep>,
}

impl DocumentState {
    pub fn to_bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut body = serde_json::to_vec(&self.head)?;
        body.push(b'\n');
        body.extend(self.text.as_bytes());
        let mut bytes = first_line(&body).into_bytes();
        bytes.extend(body);
        Ok(bytes)
    }

    /// Reads a state; `None` if the bytes are not exactly those that were written.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (first, body) = bytes.split_at(bytes.iter().position(|&b| b == b'\n')? + 1);
        if first != first_line(body).as_bytes() {
            return None;
        }
        let end = body.iter().position(|&b| b == b'\n')?;
        Some(Self {
            head: serde_json::from_slice(&body[..end]).ok()?,
            text: String::from_utf8(body[end + 1..].to_vec()).ok()?,
        })
    }

    /// Reads the state in a file; `None` if the file is missing or damaged.
    pub fn read(path: &Path) -> Option<Self> {
        Self::from_bytes(&std::fs::read(path).ok()?)
    }
}

/// First line of the file: the format, the length of the rest (bytes) and its checksum.
fn first_line(body: &[u8]) -> String {
    format!("{FORMAT} {} {:08x}\n", body.len(), crc32fast::hash(body))
}
