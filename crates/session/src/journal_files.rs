//! The files that a journal's commands read: named from the journal's folder, so that it replays from
//! anywhere, and compared with what they were.

use crate::file_stamp::Stamp;
use crate::input::is_pipe;
use crate::journal::{Entry, entry_lines, read_entries};
use crate::open::read_input;
use crate::output::portable;
use crate::paths::{relative, resolved};
use crate::{Command, SessionError};
use std::path::{Path, PathBuf};
use toile_interchange::ExpectedKind;

/// Text of a journal that lies in the folder of its results: files that are read are named from that folder,
/// files that are written by their names alone.
///
/// # Errors
/// A command cannot be written.
pub(crate) fn journal_beside<'a>(
    entries: impl Iterator<Item = &'a Entry>,
    folder: &Path,
) -> Result<String, SessionError> {
    let folder = resolved(folder);
    let lead = |path: &mut PathBuf| {
        if path.is_file()
            && let Some(from_there) = relative(&resolved(path), &folder)
        {
            *path = from_there;
        }
    };
    let moved = entries.map(|entry| {
        let mut command = portable(entry.command.clone());
        command.each_input(&mut |path| lead(path));
        let mut files = entry.files.clone();
        files.iter_mut().for_each(|stamp| lead(&mut stamp.path));
        Entry { command, files }
    });
    entry_lines(&moved.collect::<Vec<_>>())
}

/// Reads the commands of a journal, with files found from its own folder, and notes on files that have
/// changed since it was written. A path that does not exist there is taken from the working directory.
///
/// # Errors
/// The file cannot be read, or a line is not a command.
pub fn open_journal(path: &Path) -> Result<(Vec<Command>, Vec<String>), SessionError> {
    let text = read_input(path, ExpectedKind::Journal)?;
    let folder = match is_pipe(path) {
        true => Path::new(""),
        false => path.parent().unwrap_or(Path::new("")),
    };
    let mut notes = Vec::new();
    let mut commands = Vec::new();
    for Entry { mut command, files } in read_entries(&text)? {
        let found = |path: &Path| {
            let from_there = folder.join(path);
            match from_there.is_file() {
                true => from_there,
                false => path.to_owned(),
            }
        };
        command.each_input(&mut |path| *path = found(path));
        for was in &files {
            let now = Stamp::of(&found(&was.path));
            notes.extend(now.and_then(|now| was.difference(&now)));
        }
        commands.push(command);
    }
    Ok((commands, notes))
}
