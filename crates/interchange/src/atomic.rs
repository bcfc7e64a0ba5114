//! Files written whole or not at all.
//!
//! The bytes are written to a temporary file in the same folder and reach the disk. Only then is that
//! file renamed to the wanted name: after a crash the name holds either the old file or the new one.

use crate::FileError;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes a file atomically: other processes see either the old content or the complete new one. A file of
/// the same name is replaced and keeps its permissions; a symbolic link is followed.
///
/// # Errors
/// The folder is missing or cannot be written to, the name is not that of an ordinary file, or the
/// disk is full. The old file is then intact and nothing else is left behind.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    Staged::new(path, bytes)?.commit()
}

/// Writes a file atomically where none of that name is yet. Returns whether it was written: `false` if another
/// process was first, whose file stays.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_new_atomically(path: &Path, bytes: &[u8]) -> Result<bool, FileError> {
    let Staged { file, target } = Staged::new(path, bytes)?;
    match file.persist_noclobber(&target) {
        Ok(_) => {
            sync_folder_of(&target);
            Ok(true)
        }
        Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(FileError::from_io("write", &target, &error.error)),
    }
}

/// Checks that files can be written into a folder, which need not exist yet. Nothing is left behind.
///
/// # Errors
/// The folder cannot be created, or nothing can be written in it or in its nearest existing parent.
pub fn check_folder(folder: &Path) -> Result<(), FileError> {
    let there = folder.ancestors().find(|above| above.exists());
    let there = there.unwrap_or(Path::new("."));
    if !there.is_dir() {
        return Err(FileError {
            action: "create the folder",
            path: folder.to_owned(),
            cause: format!("{} is a file", there.display()),
            hint: "name a folder",
        });
    }
    let tried = temporary_in(there);
    tried.map_err(|error| FileError::from_io("write into", there, &error))?;
    Ok(())
}

/// Creates a folder if it does not exist and writes several files into it. All of them are on the disk under
/// temporary names before the first one is renamed to its own name.
///
/// # Errors
/// As [`write_atomically`]; if one of the files cannot be written under its temporary name, no file is
/// replaced.
pub fn write_all_atomically<Name: AsRef<Path>, Bytes: AsRef<[u8]>>(
    folder: &Path,
    files: &[(Name, Bytes)],
) -> Result<(), FileError> {
    fs::create_dir_all(folder)
        .map_err(|error| FileError::from_io("create the folder", folder, &error))?;
    let staged: Vec<Staged> = files
        .iter()
        .map(|(name, bytes)| Staged::new(&folder.join(name), bytes.as_ref()))
        .collect::<Result<_, _>>()?;
    staged.into_iter().try_for_each(Staged::commit)
}

/// A file under a temporary name, complete and on the disk. Dropping the value removes the file.
struct Staged {
    file: NamedTempFile,
    target: PathBuf,
}

impl Staged {
    fn new(path: &Path, bytes: &[u8]) -> Result<Self, FileError> {
        let target = ordinary_target(path)?;
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let failed = |error: io::Error| FileError::from_io("write", path, &error);
        let mut file = temporary_in(folder).map_err(failed)?;
        file.write_all(bytes).map_err(failed)?;
        if let Ok(old) = fs::metadata(&target) {
            file.as_file()
                .set_permissions(old.permissions())
                .map_err(failed)?;
        }
        file.as_file().sync_all().map_err(failed)?;
        Ok(Self { file, target })
    }

    fn commit(self) -> Result<(), FileError> {
        let Self { file, target } = self;
        file.persist(&target)
            .map_err(|error| FileError::from_io("write", &target, &error.error))?;
        tracing::debug!(file = %target.display(), "file written");
        sync_folder_of(&target);
        Ok(())
    }
}

/// The file that a path names, with symbolic links followed; refuses folders and devices.
fn ordinary_target(path: &Path) -> Result<PathBuf, FileError> {
    let refuse = |cause: &str, hint| FileError {
        action: "write",
        path: path.to_owned(),
        cause: cause.to_owned(),
        hint,
    };
    if path.file_name().is_none() {
        return Err(refuse("the path names no file", "add a file name"));
    }
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(refuse(
            "a folder has that name",
            "name a file, not a folder",
        )),
        Ok(found) if !found.is_file() => Err(refuse(
            "it is a device or a pipe, which cannot be replaced whole",
            "name an ordinary file",
        )),
        Ok(_) => fs::canonicalize(path).map_err(|error| FileError::from_io("write", path, &error)),
        Err(_) => Ok(path.to_owned()),
    }
}

/// Beginning and end of the names of temporary files.
const TEMPORARY: [&str; 2] = [".toile-", ".partial"];
/// Times at which a temporary file is made again because somebody swept it before it was locked.
const MAX_TRIES: usize = 20;

/// Removes the temporary files in a folder whose writers died before they were complete. Those of living writers
/// stay: each holds a lock on its own. Files that cannot be removed are left.
pub fn sweep_unfinished(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let [start, end] = TEMPORARY;
        if name.starts_with(start)
            && name.ends_with(end)
            && let Ok(file) = fs::File::open(&path)
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(&path);
        }
    }
}

/// A new temporary file with a lock that is held for as long as it is open, on systems with such locks.
fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..MAX_TRIES {
        let file = unlocked_in(folder)?;
        let _ = file.as_file().lock();
        if file.path().exists() {
            return Ok(file);
        }
    }
    Err(io::Error::other(
        "other processes remove what is made there",
    ))
}

/// A new temporary file with the permissions that any new file would get.
fn unlocked_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY[0]).suffix(TEMPORARY[1]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
        builder.tempfile_in(folder)
    }
    #[cfg(not(unix))]
    builder.tempfile_in(folder)
}

/// Writes the folder of a file to the disk, so that a new name survives a loss of power, on systems that can
/// do so. The file is already complete, so a failure of this step is harmless and not reported.
fn sync_folder_of(file: &Path) {
    let folder = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if let Ok(handle) = fs::File::open(folder) {
        let _ = handle.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn writes_and_replaces_without_a_trace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two, longer").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two, longer");
        assert_eq!(names(folder.path()), ["a.json"]);
    }

    #[test]
    fn only_temporary_files_of_dead_writers_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let alive = temporary_in(folder.path()).unwrap();
        fs::write(folder.path().join(".toile-dead.partial"), b"half").unwrap();
        fs::write(folder.path().join("a.json"), b"whole").unwrap();
        sweep_unfinished(folder.path());
        let own = alive.path().file_name().unwrap().to_str().unwrap();
        assert_eq!(names(folder.path()), [own, "a.json"]);
    }

    #[test]
    fn a_file_that_is_there_is_not_written_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        assert!(write_new_atomically(&path, b"first").unwrap());
        assert!(!write_new_atomically(&path, b"second").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(names(folder.path()), ["a.json"]);
    }

    #[test]
    fn writes_several_files_into_a_new_folder() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("out/size 38");
        write_all_atomically(&deep, &[("b.txt", "b".as_bytes()), ("a.txt", b"a")]).unwrap();
        assert_eq!(names(&deep), ["a.txt", "b.txt"]);
        assert_eq!(fs::read(deep.join("b.txt")).unwrap(), b"b");
    }

    #[test]
    fn one_bad_name_replaces_no_file() {
        let folder = tempfile::tempdir().unwrap();
        write_atomically(&folder.path().join("a"), b"old").unwrap();
        fs::create_dir(folder.path().join("b")).unwrap();
        let error = write_all_atomically(folder.path(), &[("a", "new"), ("b", "new")]).unwrap_err();
        assert!(error.to_string().contains("folder"), "{error}");
        assert_eq!(fs::read(folder.path().join("a")).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a", "b"]);
    }

    #[test]
    fn missing_folder_is_named_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nowhere/a.json");
        let text = write_atomically(&path, b"x").unwrap_err().to_string();
        assert!(
            text.contains("nowhere") && text.contains("check the spelling"),
            "{text}"
        );
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("out");
        fs::write(&file, b"kept").unwrap();
        let error = write_all_atomically(&file, &[("a", "b")]).unwrap_err();
        assert!(error.to_string().contains("rename it"), "{error}");
        assert_eq!(fs::read(&file).unwrap(), b"kept");
    }

    #[test]
    fn paths_without_a_file_name_and_devices_are_refused() {
        for path in ["/", "..", ""] {
            let error = write_atomically(Path::new(path), b"x").unwrap_err();
            assert_eq!(error.hint, "add a file name");
        }
        if cfg!(unix) {
            let error = write_atomically(Path::new("/dev/null"), b"x").unwrap_err();
            assert!(error.cause.contains("device"), "{error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn unwritable_folder_keeps_the_old_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, b"old").unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        let outcome = write_atomically(&path, b"new");
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        // The administrator may write anywhere: then the file is simply replaced.
        match outcome {
            Err(error) => {
                assert!(error.hint.contains("permissions"), "{error}");
                assert_eq!(fs::read(&path).unwrap(), b"old");
            }
            Ok(()) => assert_eq!(fs::read(&path).unwrap(), b"new"),
        }
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_permissions_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let real = folder.path().join("real");
        let link = folder.path().join("link");
        fs::write(&real, b"old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert_eq!(
            fs::metadata(&real).unwrap().permissions().mode() & 0o777,
            0o640
        );
    }
}
