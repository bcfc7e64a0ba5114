//! The files that a journal's commands read: named from the journal's folder, so that it replays from anywhere, and
//! compared with what they were.

use crate::export::portable;
use crate::file_stamp::Stamp;
use crate::input::is_pipe;
use crate::journal::{Entry, entry_lines, read_entries};
use crate::open::read_input;
use crate::{Command, SessionError};
use std::path::{Component, Path, PathBuf};
use toile_interchange::ExpectedKind;

/// The journal as text beside what it made, in a folder: files are named from there, and places to write to by their
/// names alone.
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

/// The whole path of a file or a folder, which need not be there yet.
fn resolved(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = whole
        .ancestors()
        .find_map(|a| Some((a, a.canonicalize().ok()?)));
    match there {
        Some((ancestor, real)) => match whole.strip_prefix(ancestor) {
            Ok(rest) if rest.as_os_str().is_empty() => real,
            Ok(rest) => real.join(rest),
            Err(_) => whole,
        },
        None => whole,
    }
}

/// The way from a folder to a file; none where they have no common root.
fn relative(file: &Path, folder: &Path) -> Option<PathBuf> {
    let parts = |path: &Path| {
        path.components()
            .map(|c| c.as_os_str().to_owned())
            .collect()
    };
    let (to, from): (Vec<_>, Vec<_>) = (parts(file), parts(folder));
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let up = from
        .iter()
        .skip(common)
        .map(|_| Component::ParentDir.as_os_str());
    let way: PathBuf = up
        .chain(to.iter().skip(common).map(|part| &**part))
        .collect();
    (common > 0).then_some(way)
}

/// Reads a journal: its commands, with files found from its own folder, and what of them differs from when it was
/// written. A path that is not there is taken from where the program is run.
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
        command.each_input(&mut |path| {
            let stamp = files.iter().find(|stamp| stamp.path == *path);
            let from_there = folder.join(&path);
            if from_there.is_file() {
                *path = from_there;
            }
            if let (Some(was), Some(now)) = (stamp, Stamp::of(path)) {
                notes.extend(was.difference(&now));
            }
        });
        commands.push(command);
    }
    Ok((commands, notes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_a_folder_to_a_file() {
        let way = |file: &str, folder: &str| {
            relative(Path::new(file), Path::new(folder))
                .unwrap()
                .display()
                .to_string()
        };
        assert_eq!(way("/a/b/p.json", "/a/out"), "../b/p.json");
        assert_eq!(way("/a/p.json", "/a"), "p.json");
        assert_eq!(way("/p.json", "/a/b"), "../../p.json");
    }
}
