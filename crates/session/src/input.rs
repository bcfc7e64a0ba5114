//! Files as commands are given them: by name, through a pipe, or `-` for what comes on the standard input.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use toile_interchange::FileError;

/// Content of pipes by the path they were read by. A pipe can be read only once, and a file is inspected
/// before its reader is known: therefore the content is kept.
static PIPED: Mutex<BTreeMap<PathBuf, Vec<u8>>> = Mutex::new(BTreeMap::new());

/// The path that stands for the standard input.
const STANDARD_INPUT: &str = "-";

/// Whether a path is no regular file: a pipe, or the standard input.
pub(crate) fn is_pipe(path: &Path) -> bool {
    let is_other = |data: std::fs::Metadata| !data.is_file() && !data.is_dir();
    path == Path::new(STANDARD_INPUT) || path.metadata().is_ok_and(is_other)
}

/// Whether a path can be read from.
pub fn is_input(path: &Path) -> bool {
    path.is_file() || is_pipe(path)
}

/// Reads a whole file; what comes through a pipe is read once and given again to whoever asks later.
///
/// # Errors
/// The file is missing or cannot be read.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, FileError> {
    let failed = |error: std::io::Error| FileError::from_io("read", path, &error);
    if !is_pipe(path) {
        return std::fs::read(path).map_err(failed);
    }
    let mut piped = PIPED.lock().unwrap_or_else(|broken| broken.into_inner());
    if let Some(bytes) = piped.get(path) {
        return Ok(bytes.clone());
    }
    let mut bytes = Vec::new();
    match path == Path::new(STANDARD_INPUT) {
        true => std::io::stdin().read_to_end(&mut bytes),
        false => std::fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes)),
    }
    .map_err(failed)?;
    piped.insert(path.to_owned(), bytes.clone());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_comes_through_a_pipe_is_read_once_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let writer = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::write(pipe, "words").unwrap()
        });
        assert!(is_pipe(&pipe) && is_input(&pipe) && !is_input(folder.path()));
        assert_eq!(read_file(&pipe).unwrap(), b"words");
        assert_eq!(read_file(&pipe).unwrap(), b"words");
        writer.join().unwrap();
        assert!(read_file(&folder.path().join("gone")).is_err());
    }
}
