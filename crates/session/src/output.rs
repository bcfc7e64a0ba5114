//! Output of commands: files with their names, errors of writing, and redirection into a folder.

use crate::{Command, SessionError};
use std::path::Path;
use toile_interchange::FormatError;

/// A file to write: its name and its content.
pub type File = (String, Vec<u8>);

/// Makes a file name of a name: letters and digits of any language, `-`, `_` and `.` (not at the start) stay,
/// other characters become `_`.
pub(crate) fn file_name(name: &str) -> String {
    let plain = |(k, c): (usize, char)| {
        let keeps = c.is_alphanumeric() || "-_".contains(c) || (c == '.' && k > 0);
        if keeps { c } else { '_' }
    };
    name.chars().enumerate().map(plain).collect()
}

pub(crate) fn cannot(file: &'static str) -> impl Fn(FormatError) -> SessionError {
    move |error| SessionError::Write { file, error }
}

/// The command as a journal beside its results records it: a file that is written by its name alone, a folder
/// as `.`, so that the journal does not depend on where it lies.
pub(crate) fn portable(mut command: Command) -> Command {
    let is_folder = matches!(command, Command::Export(_));
    if let Some(output) = command.output_mut() {
        match output.file_name() {
            _ if is_folder => *output = ".".into(),
            Some(name) => *output = name.into(),
            None => {}
        }
    }
    command
}

/// The commands with all output redirected into one folder.
pub(crate) fn redirected(commands: &[Command], folder: &Path) -> Vec<Command> {
    let mut commands: Vec<Command> = commands.iter().cloned().map(portable).collect();
    for command in &mut commands {
        let is_folder = matches!(command, Command::Export(_));
        if let Some(output) = command.output_mut() {
            *output = match is_folder {
                true => folder.to_owned(),
                false => folder.join(&*output),
            };
        }
    }
    commands
}
