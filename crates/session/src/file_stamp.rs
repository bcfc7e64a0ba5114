//! Stamps of files that commands read: digests by which a later look tells what was changed.

use crate::Command;
use crate::digest::digest;
use crate::input::read_file;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Stamp of a file as it was when a command read it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    /// Path of the file, as the command names it.
    pub path: PathBuf,
    /// Digest of the file's bytes.
    digest: String,
    /// Digest of each part of a JSON file: `panels front`, `unit`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    parts: BTreeMap<String, String>,
}

impl Stamp {
    /// Stamps of the files that a command reads; samples inside the program and pipes have none.
    pub fn of_inputs(command: &mut Command) -> Vec<Self> {
        let mut stamps = Vec::new();
        command.each_input(&mut |path| stamps.extend(Self::of(path)));
        stamps
    }

    /// Stamp of a file as it is now; `None` if the path is no regular file.
    pub fn of(path: &Path) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let bytes = read_file(path).ok()?;
        Some(Self {
            path: path.to_owned(),
            digest: digest(&bytes),
            parts: parts(&bytes),
        })
    }

    /// Describes the difference between the file at this stamp and at the stamp `now`; `None` if the file is
    /// unchanged.
    pub fn difference(&self, now: &Self) -> Option<String> {
        if self.digest == now.digest {
            return None;
        }
        let keys = self.parts.keys().chain(now.parts.keys());
        let mut differing: Vec<&str> = keys
            .filter(|key| self.parts.get(*key) != now.parts.get(*key))
            .map(String::as_str)
            .collect();
        differing.sort_unstable();
        differing.dedup();
        let what = match &differing[..] {
            [] => "its text".to_owned(),
            few if few.len() <= MAX_NAMED => few.join(", "),
            many => format!(
                "{} and {} more",
                many[..MAX_NAMED].join(", "),
                many.len() - MAX_NAMED
            ),
        };
        Some(format!(
            "{} is not the file that the journal was made with, and is replayed as it is now; what differs: {what}",
            now.path.display()
        ))
    }
}

/// Most parts of a changed file that are named one by one.
const MAX_NAMED: usize = 8;

/// Digests of the fields of a JSON object, by name. A field that is a list has a digest for each item
/// instead, by the item's name or number. Empty if the bytes are no JSON object.
fn parts(bytes: &[u8]) -> BTreeMap<String, String> {
    let Ok(Value::Object(fields)) = serde_json::from_slice(bytes) else {
        return BTreeMap::new();
    };
    let mut parts = BTreeMap::new();
    for (field, value) in fields {
        let mut put = |key: String, value: &Value| {
            parts.insert(key, digest(value.to_string().as_bytes()));
        };
        let Value::Array(list) = &value else {
            put(field, &value);
            continue;
        };
        for (k, one) in list.iter().enumerate() {
            match one.get("name").and_then(Value::as_str) {
                Some(name) => put(format!("{field} {name}"), one),
                None => put(format!("{field} {}", k + 1), one),
            }
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_says_what_differs() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("p.json");
        let write = |text: &str| {
            std::fs::write(&path, text).unwrap();
            Stamp::of(&path).unwrap()
        };
        let was =
            write(r#"{"unit": "cm", "panels": [{"name": "front", "x": 1}, {"name": "back"}]}"#);
        assert_eq!(was.difference(&was), None);
        let now =
            write(r#"{"unit": "mm", "panels": [{"name": "front", "x": 2}, {"name": "back"}]}"#);
        let said = was.difference(&now).unwrap();
        assert!(said.ends_with("what differs: panels front, unit"), "{said}");
        let respaced =
            write(r#"{ "unit": "cm", "panels": [{"name": "front", "x": 1}, {"name": "back"}]}"#);
        assert!(
            was.difference(&respaced)
                .unwrap()
                .ends_with("what differs: its text")
        );
    }
}
