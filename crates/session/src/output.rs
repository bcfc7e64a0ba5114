//! What commands write: files with their names, why one cannot be written, where commands are led to write.

use crate::{Command, SessionError};
use std::path::Path;
use toile_interchange::FormatError;

/// A file to write: its name and its content.
pub(crate) type File = (String, Vec<u8>);

/// A name as one of a file: letters and digits of any language, `-`, `_` and `.` but at its start.
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

/// A command as it is written beside what it made: a place to write to is named by the file name alone, so that the
/// journal does not depend on where it lies.
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

/// The commands with everything that is written going into one folder.
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
