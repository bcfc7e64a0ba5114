//! The journal: what was done, in order; in a file one command a line as JSON.

use crate::{Command, SessionError};
use std::collections::VecDeque;

/// Most commands that are kept.
pub(crate) const MOST_COMMANDS: usize = 1000;

/// The commands that were done: all of them, or the latest if there were too many.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    commands: VecDeque<Command>,
    dropped: usize,
}

impl Journal {
    /// Notes a command that was done.
    pub fn push(&mut self, command: Command) {
        if self.commands.len() == MOST_COMMANDS {
            self.commands.pop_front();
            self.dropped += 1;
        }
        self.commands.push_back(command);
    }

    /// Whether every command is kept, so that doing them again gives the same project.
    pub fn is_whole(&self) -> bool {
        self.dropped == 0
    }

    /// The commands that are kept, the oldest first.
    pub fn commands(&self) -> Vec<Command> {
        self.commands.iter().cloned().collect()
    }
}

/// The commands as text, one JSON object a line.
///
/// # Errors
/// A command cannot be written, as with a path that is no text.
pub fn journal_lines(commands: &[Command]) -> Result<String, SessionError> {
    let mut text = String::new();
    for (k, command) in commands.iter().enumerate() {
        let line = serde_json::to_string(command).map_err(|error| SessionError::Journal {
            line: k + 1,
            what: error.to_string(),
        })?;
        text.push_str(&line);
        text.push('\n');
    }
    Ok(text)
}

/// Reads a journal. Empty lines are skipped.
///
/// # Errors
/// The first line that is not a command.
pub fn read_journal(text: &str) -> Result<Vec<Command>, SessionError> {
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
