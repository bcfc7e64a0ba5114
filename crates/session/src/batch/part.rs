//! What one process writes of a job: a folder beside the job's file, which becomes the job's files at once or goes.
//!
//! A process holds a lock on its own folder for as long as it lives, however it ends. So others see who is at
//! work, and what dead writers left is swept.

use super::job::Job;
use super::result::{JobOutcome, JobResult};
use crate::SessionError;
use crate::timing::cpu_seconds;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};
use std::time::Instant;
use toile_interchange::{FileError, sweep_unfinished, write_atomically, write_new_atomically};

/// Ending of the folder that a process writes into.
const PART: &str = "part";
/// Folder of a job's files.
const FILES: &str = "files";
/// Times at which a new folder is made again because somebody swept it before it was locked.
const MAX_TRIES: usize = 20;

/// Times and paths of a job, which are in no result.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct JobTiming {
    /// Time from its beginning to its end (s).
    pub wall_s: f64,
    /// Processor time (s), where the system tells it.
    pub cpu_s: Option<f64>,
    /// Largest memory (bytes), where the system tells it.
    pub peak_memory_bytes: Option<u64>,
    /// The pattern's file.
    pub pattern: String,
}

impl JobTiming {
    /// Times of this process, which began a job at `start`.
    fn of_this_process(job: &Job, start: Instant) -> Self {
        Self {
            wall_s: start.elapsed().as_secs_f64(),
            cpu_s: cpu_seconds(),
            peak_memory_bytes: peak_memory(),
            pattern: job.pattern.clone(),
        }
    }
}

/// Largest memory that this process had so far (bytes), where the system tells it (Linux: `VmHWM` of
/// `/proc/self/status`, in units of 1024 bytes).
fn peak_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}

/// A folder that this process writes the files of a job into. Dropping it removes the folder.
#[derive(Debug)]
pub struct Part {
    /// Folder of the job.
    folder: PathBuf,
    path: PathBuf,
    /// Holds the lock.
    lock: Option<File>,
    start: Instant,
}

impl Part {
    /// Begins to write the files of a job, in its folder.
    ///
    /// # Errors
    /// The folder cannot be made.
    pub fn begin(folder: &Path, job: &Job) -> Result<Self, SessionError> {
        let start = Instant::now();
        for _ in 0..MAX_TRIES {
            // Keys that a system draws by chance for each of these.
            let chance = RandomState::new().hash_one(start);
            let process = std::process::id();
            let name = format!("{}.{process}-{chance:08x}.{PART}", job.id);
            let path = folder.join(name);
            fs::create_dir(&path)
                .map_err(|error| FileError::from_io("create the folder", &path, &error))?;
            let lock = locked(&path);
            if path.is_dir() {
                let folder = folder.to_owned();
                return Ok(Self {
                    folder,
                    path,
                    lock,
                    start,
                });
            }
        }
        let cause = std::io::Error::other("other processes remove what is made there");
        Err(FileError::from_io("create a folder in", folder, &cause).into())
    }

    /// The folder to write into.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes what was written the result of the job, if no other process was first.
    ///
    /// # Errors
    /// Something cannot be written; there is no result then.
    pub fn finish(self, job: &Job, outcome: JobOutcome) -> Result<(), SessionError> {
        let timing = JobTiming::of_this_process(job, self.start);
        self.finish_in(job, outcome, &timing)
    }

    /// [`Self::finish`] with the times of the process that did the job.
    pub(crate) fn finish_in(
        mut self,
        job: &Job,
        outcome: JobOutcome,
        timing: &JobTiming,
    ) -> Result<(), SessionError> {
        let is_made = matches!(outcome, JobOutcome::Made { .. });
        let result = JobResult::new(job, outcome, is_made.then_some(&*self.path));
        let folder = self.folder.clone();
        if !result.files.is_empty() {
            self.become_files(&folder.join(FILES))?;
        }
        drop(self);
        if result_in(&folder, job).is_some() {
            return Ok(());
        }
        let text = serde_json::to_string_pretty(timing).unwrap_or_default() + "\n";
        write_atomically(&folder.join("timing.json"), text.as_bytes())?;
        let text = serde_json::to_string_pretty(&result).unwrap_or_default() + "\n";
        let file = result_file(&folder);
        // One of other files, or a damaged one, is replaced; one of this job has the same content.
        if !write_new_atomically(&file, text.as_bytes())? && result_in(&folder, job).is_none() {
            write_atomically(&file, text.as_bytes())?;
        }
        Ok(())
    }

    /// Renames the folder, unless another process was first.
    fn become_files(&mut self, files: &Path) -> Result<(), SessionError> {
        match fs::rename(&self.path, files) {
            Ok(()) => Ok(()),
            Err(_) if files.is_dir() => Ok(()),
            Err(error) => Err(FileError::from_io("write", files, &error).into()),
        }
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        // It is gone already if it became the job's files.
        let _ = fs::remove_dir_all(&self.path);
        self.lock = None;
    }
}

/// A folder with an exclusive lock, on systems where folders can be opened.
fn locked(path: &Path) -> Option<File> {
    let file = File::open(path).ok()?;
    file.lock().ok()?;
    Some(file)
}

/// The file of the result in the folder of a job.
pub(crate) fn result_file(folder: &Path) -> PathBuf {
    folder.join("result.json")
}

/// The result in the folder of a job, if the job was done.
pub(crate) fn result_in(folder: &Path, job: &Job) -> Option<JobResult> {
    let text = fs::read_to_string(result_file(folder)).ok()?;
    JobResult::of(job, &text)
}

/// Times of a job that was done.
pub(crate) fn timing_in(folder: &Path) -> JobTiming {
    let text = fs::read_to_string(folder.join("timing.json")).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Removes the result of a job, so that it is done again.
pub(crate) fn forget(folder: &Path) -> Result<(), SessionError> {
    let removed = match fs::remove_file(result_file(folder)) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        Ok(()) | Err(_) => match fs::remove_dir_all(folder.join(FILES)) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
            Ok(()) | Err(_) => Ok(()),
        },
    };
    removed.map_err(|error| FileError::from_io("remove the result in", folder, &error).into())
}

/// The folders that processes write into, in the folder of a job.
fn parts(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths.filter(|path| path.extension().is_some_and(|end| end == PART))
}

/// Whether the process that writes into a folder is alive; where folders have no locks, nobody knows.
fn is_held(part: &Path) -> bool {
    let Ok(file) = File::open(part) else {
        return false;
    };
    matches!(file.try_lock_shared(), Err(fs::TryLockError::WouldBlock))
}

/// Whether another process is doing a job.
pub(crate) fn is_being_done(folder: &Path) -> bool {
    parts(folder).any(|part| is_held(&part))
}

/// Removes what dead writers left in the folder of a job.
pub(crate) fn sweep(folder: &Path) {
    sweep_unfinished(folder);
    for part in parts(folder) {
        let Ok(file) = File::open(&part) else {
            continue;
        };
        if file.try_lock().is_ok() {
            // Who cannot remove it leaves it: no result is taken from there.
            let _ = fs::remove_dir_all(&part);
        }
    }
}
