//! States of documents that a crash left.

use super::state_file::DocumentState;
use super::{BEFORE, LOCK, NEWEST, PastStep, file_of};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// A document that a crash left. As long as this value lives, no other process offers the document.
#[derive(Debug)]
pub struct Abandoned {
    /// Name of the pattern.
    pub name: String,
    /// The file that the document was last saved to.
    pub source: Option<PathBuf>,
    /// The pattern in the native format, as it was last kept.
    pub text: String,
    /// The last steps of the document's history, the newest first.
    pub past: Vec<PastStep>,
    /// Time at which the state was kept.
    pub kept: Option<SystemTime>,
    folder: PathBuf,
    id: String,
    _lock: File,
}

/// The documents in a folder that crashes left, the newest first. If the newest state of a document is
/// damaged, the state before it is taken. Documents of processes that still run are left out.
///
/// # Errors
/// The folder exists but cannot be read.
pub fn abandoned(folder: &Path) -> io::Result<Vec<Abandoned>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(error),
    };
    let mut ids = BTreeSet::new();
    for entry in entries {
        let name = entry?.file_name();
        let named = name.to_str().and_then(|name| name.rsplit_once('.'));
        if let Some((id, NEWEST | BEFORE)) = named {
            ids.insert(id.to_owned());
        }
    }
    let mut found: Vec<Abandoned> = ids.into_iter().filter_map(|id| take(folder, id)).collect();
    found.sort_by_key(|document| std::cmp::Reverse(document.kept));
    Ok(found)
}

/// The document of one process, if the process has ended and a state of the document is undamaged.
fn take(folder: &Path, id: String) -> Option<Abandoned> {
    let lock = File::options()
        .write(true)
        .create(true)
        .truncate(false)
        .open(file_of(folder, &id, LOCK))
        .ok()?;
    lock.try_lock().ok()?;
    [NEWEST, BEFORE].into_iter().find_map(|ending| {
        let path = file_of(folder, &id, ending);
        let state = DocumentState::read(&path)?;
        let kept = fs::metadata(&path).and_then(|data| data.modified()).ok();
        Some(Abandoned {
            name: state.head.name,
            source: state.head.source,
            text: state.text,
            past: state.head.past,
            kept,
            folder: folder.to_owned(),
            id: id.clone(),
            _lock: lock.try_clone().ok()?,
        })
    })
}

impl Abandoned {
    /// Removes the files of the document: call it when the document was recovered and kept anew, or is not
    /// wanted.
    ///
    /// # Errors
    /// A file cannot be removed.
    pub fn discard(self) -> io::Result<()> {
        for ending in [BEFORE, NEWEST, LOCK] {
            match fs::remove_file(file_of(&self.folder, &self.id, ending)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }
}
