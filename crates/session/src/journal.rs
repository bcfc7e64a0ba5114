//! The journal: one command a line as JSON.

use crate::{Command, SessionError};

/// The commands as text, one JSON object a line.
pub fn journal_lines(commands: &[Command]) -> String {
    let mut text = String::new();
    for command in commands {
        // Commands hold nothing that JSON cannot: numbers that are not finite become null.
        text.push_str(&serde_json::to_string(command).unwrap_or_default());
        text.push('\n');
    }
    text
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
