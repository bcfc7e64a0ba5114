//! What came of a batch: `report.json`, the same bytes however often it was interrupted, and `timing.json`.

use super::folder::BatchFolder;
use super::job::Job;
use super::part::JobTiming;
use super::result::JobResult;
use crate::SessionError;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use toile_interchange::write_all_atomically;

/// The format's name in its file.
const FORMAT: &str = "toile-batch-report";
/// Version of reports.
const VERSION: u32 = 1;

/// What came of the jobs of a batch, in their order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    format: &'static str,
    version: u32,
    /// Number of jobs.
    pub total: usize,
    /// Number of jobs that were done.
    pub made: usize,
    /// Number of those with a bad verdict on what was made.
    pub faulty: usize,
    /// Number of jobs that failed.
    pub failed: usize,
    /// Names of the jobs that have no result yet.
    pub waiting: Vec<String>,
    /// The results.
    pub jobs: Vec<JobResult>,
}

#[derive(Serialize)]
struct Timing<'a> {
    jobs: BTreeMap<&'a str, JobTiming>,
}

impl Report {
    /// The results that are there.
    pub fn of(folder: &BatchFolder, jobs: &[Job]) -> Self {
        let mut results = Vec::new();
        let mut waiting = Vec::new();
        for job in jobs {
            match folder.result(job) {
                Some(result) => results.push(result),
                None => waiting.push(job.id.clone()),
            }
        }
        let count = |is: &dyn Fn(&JobResult) -> bool| results.iter().filter(|r| is(r)).count();
        Self {
            format: FORMAT,
            version: VERSION,
            total: jobs.len(),
            made: count(&|result| result.made),
            faulty: count(&|result| result.fault.is_some()),
            failed: count(&|result| !result.made),
            waiting,
            jobs: results,
        }
    }

    /// Writes the report into the folder of the batch, with times and paths beside it. Returns the files.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, folder: &BatchFolder, jobs: &[Job]) -> Result<Vec<PathBuf>, SessionError> {
        let waiting: BTreeSet<&String> = self.waiting.iter().collect();
        let done = jobs.iter().filter(|job| !waiting.contains(&job.id));
        let timing = Timing {
            jobs: done.map(|job| (&*job.id, folder.timing(job))).collect(),
        };
        let files = [
            ("report.json", serde_json::to_string_pretty(self)),
            ("timing.json", serde_json::to_string_pretty(&timing)),
        ];
        let files = files.map(|(name, text)| (name, text.unwrap_or_default() + "\n"));
        write_all_atomically(&folder.file(""), &files)?;
        Ok(files.map(|(name, _)| folder.file(name)).to_vec())
    }
}
