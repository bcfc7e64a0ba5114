//! The journal: one command a line as JSON.

use crate::{Command, SessionError};

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
