//! The journal: what was done, in order; in a file one command a line as JSON.

use crate::file_stamp::Stamp;
use crate::{Command, SessionError};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::path::PathBuf;

/// Most commands that are kept.
pub(crate) const MAX_COMMANDS: usize = 1000;

/// A command, with stamps of the files it read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Entry {
    #[serde(flatten)]
    pub command: Command,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<Stamp>,
}

/// The commands that were done: all of them, or the latest if there were too many.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    entries: VecDeque<Entry>,
    /// Number of commands that are no longer kept.
    dropped: usize,
}

impl Journal {
    /// Records a command that was done, with the files it read.
    pub fn push(&mut self, command: Command) {
        self.push_with(command, &[]);
    }

    /// Records a command that read more files than it names.
    pub fn push_with(&mut self, mut command: Command, more: &[PathBuf]) {
        if self.entries.len() == MAX_COMMANDS {
            self.entries.pop_front();
            self.dropped += 1;
        }
        let mut files = Stamp::of_inputs(&mut command);
        files.extend(more.iter().filter_map(|path| Stamp::of(path)));
        self.entries.push_back(Entry { command, files });
    }

    /// Whether every command is kept, so that doing them again gives the same project.
    pub fn is_whole(&self) -> bool {
        self.dropped == 0
    }

    /// The commands that are kept, the oldest first.
    pub fn commands(&self) -> Vec<Command> {
        self.entries
            .iter()
            .map(|entry| entry.command.clone())
            .collect()
    }

    /// The commands that are kept with the files they read, the oldest first.
    pub fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter()
    }
}

/// The commands as text, one JSON object a line.
///
/// # Errors
/// A command cannot be written, such as one with a path that is not text.
pub fn journal_lines(commands: &[Command]) -> Result<String, SessionError> {
    let bare = commands.iter().map(|command| Entry {
        command: command.clone(),
        files: Vec::new(),
    });
    entry_lines(&bare.collect::<Vec<_>>())
}

/// Entries as text, one JSON object a line.
pub(crate) fn entry_lines(entries: &[Entry]) -> Result<String, SessionError> {
    let mut text = String::new();
    for (k, entry) in entries.iter().enumerate() {
        let line = serde_json::to_string(entry).map_err(|error| SessionError::Journal {
            line: k + 1,
            what: error.to_string(),
        })?;
        text.push_str(&line);
        text.push('\n');
    }
    Ok(text)
}

/// Reads a journal. Empty lines are skipped; paths stay as they are written.
///
/// # Errors
/// The first line that is not a command.
pub fn read_journal(text: &str) -> Result<Vec<Command>, SessionError> {
    let entries = read_entries(text)?;
    Ok(entries.into_iter().map(|entry| entry.command).collect())
}

/// The entries of a journal.
pub(crate) fn read_entries(text: &str) -> Result<Vec<Entry>, SessionError> {
    text.lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(k, line)| {
            serde_json::from_str(line).map_err(|error| SessionError::Journal {
                line: k + 1,
                what: error.to_string(),
            })
        })
        .collect()
}
