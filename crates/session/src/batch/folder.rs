//! The folder of a batch, which several processes may work in at once.
//!
//! `batch.json` says what the batch is; `jobs/ID/` holds the file of each job, its files and, written last, its
//! result. A job is done when it has a result with its digest: going on after an interruption and sharing the
//! folder need nothing more.

use super::job::Job;
use super::part::JobTiming;
use super::part::{forget, is_being_done, result_in, sweep, timing_in};
use super::result::JobResult;
use super::spec::Spec;
use crate::SessionError;
use crate::paths::resolved;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use toile_interchange::{FileError, sweep_unfinished, write_atomically, write_new_atomically};

/// The format's name in its file.
const FORMAT: &str = "toile-batch-folder";

/// The folder of a batch.
#[derive(Clone, Debug)]
pub struct BatchFolder {
    path: PathBuf,
    /// Whether the batch was begun before, by this or by another process.
    was_there: bool,
}

impl BatchFolder {
    /// Opens the folder of a batch, and makes it if need be.
    ///
    /// # Errors
    /// The folder holds a batch of another specification, or cannot be written to.
    pub fn open(path: &Path, spec: &Spec) -> Result<Self, SessionError> {
        let path = resolved(path);
        let jobs = path.join("jobs");
        fs::create_dir_all(&jobs)
            .map_err(|error| FileError::from_io("create the folder", &jobs, &error))?;
        let file = path.join("batch.json");
        let own = json!({ "format": FORMAT, "version": 1, "batch": spec.fields });
        let text = serde_json::to_string_pretty(&own).unwrap_or_default() + "\n";
        let was_there = !write_new_atomically(&file, text.as_bytes())?;
        if was_there {
            let there = fs::read_to_string(&file)
                .map_err(|error| FileError::from_io("read", &file, &error))?;
            let there: Value = serde_json::from_str(&there).unwrap_or_default();
            refuse_another(&file, &there["batch"], &spec.fields)?;
        }
        Ok(Self { path, was_there })
    }

    /// Folder of a job.
    pub fn job_folder(&self, job: &Job) -> PathBuf {
        self.path.join("jobs").join(&job.id)
    }

    /// File of a job, which `toile job` takes.
    pub fn job_file(&self, job: &Job) -> PathBuf {
        self.job_folder(job).join("job.json")
    }

    /// A file of the batch itself.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Whether the batch was begun before, by this or by another process.
    pub(crate) fn was_there(&self) -> bool {
        self.was_there
    }

    /// Writes the file of each job where it is not there already.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn put(&self, jobs: &[Job]) -> Result<(), SessionError> {
        for job in jobs {
            let (folder, file) = (self.job_folder(job), self.job_file(job));
            fs::create_dir_all(&folder)
                .map_err(|error| FileError::from_io("create the folder", &folder, &error))?;
            let text = serde_json::to_string_pretty(job).unwrap_or_default() + "\n";
            let there = fs::read(&file);
            if there.is_ok_and(|there| there == text.as_bytes()) {
                continue;
            }
            write_atomically(&file, text.as_bytes())?;
        }
        Ok(())
    }

    /// The result of a job, if it was done.
    pub fn result(&self, job: &Job) -> Option<JobResult> {
        result_in(&self.job_folder(job), job)
    }

    /// Times of a job that was done.
    pub(crate) fn timing(&self, job: &Job) -> JobTiming {
        timing_in(&self.job_folder(job))
    }

    /// Whether a process is doing a job.
    pub(crate) fn is_being_done(&self, job: &Job) -> bool {
        is_being_done(&self.job_folder(job))
    }

    /// Removes what dead writers left.
    pub fn sweep(&self) {
        sweep_unfinished(&self.path);
        let folders = fs::read_dir(self.path.join("jobs")).into_iter().flatten();
        folders.flatten().for_each(|entry| sweep(&entry.path()));
    }

    /// Forgets the results of jobs that failed, so that they are done again. Returns how many they were.
    ///
    /// # Errors
    /// A result cannot be removed.
    pub fn forget_failed(&self, jobs: &[Job]) -> Result<usize, SessionError> {
        let mut count = 0;
        for job in jobs {
            if self.result(job).is_some_and(|result| !result.made) {
                forget(&self.job_folder(job))?;
                count += 1;
            }
        }
        Ok(count)
    }

    /// Number of jobs in the folder that are none of the batch as it is now: of patterns that were changed.
    pub fn count_of_others(&self, jobs: &[Job]) -> usize {
        let own: BTreeSet<&str> = jobs.iter().map(|job| &*job.id).collect();
        let entries = fs::read_dir(self.path.join("jobs")).into_iter().flatten();
        let names = entries.flatten().map(|entry| entry.file_name());
        names
            .filter(|name| name.to_str().is_none_or(|name| !own.contains(name)))
            .count()
    }
}

/// Refuses a specification that is not the one that the folder was begun with.
fn refuse_another(file: &Path, there: &Value, own: &Value) -> Result<(), SessionError> {
    if there == own {
        return Ok(());
    }
    let fields = |value: &Value| -> BTreeSet<String> {
        let fields = value
            .as_object()
            .into_iter()
            .flat_map(|fields| fields.keys());
        fields.cloned().collect()
    };
    let all: BTreeSet<String> = fields(there).union(&fields(own)).cloned().collect();
    let differing: Vec<String> = all
        .into_iter()
        .filter(|field| there.get(field) != own.get(field))
        .collect();
    Err(SessionError::Conflict(format!(
        "{}: this folder holds a batch of another specification (it differs in {}); give another --out, or the \
         specification that it was begun with",
        file.display(),
        differing.join(", ")
    )))
}
