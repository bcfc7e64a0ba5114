//! The result of one job, as its file `result.json` says it: nothing in it depends on times or on folders.

use super::job::Job;
use crate::digest::digest;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;
use toile_pattern::fields::Choice;

/// The format's name in its file.
const FORMAT: &str = "toile-result";
/// Version of results.
const VERSION: u32 = 1;
/// Files that hold times or paths, which differ from run to run: they are listed without a digest.
const VARYING: [&str; 2] = ["timing.json", "journal.jsonl"];

/// What became of a job.
#[derive(Clone, Debug, PartialEq)]
pub enum JobOutcome {
    /// It was done.
    Made {
        /// The report of the command, as `--json` prints it.
        report: Value,
        /// Words for a bad verdict on what was made.
        fault: Option<String>,
    },
    /// It could not be done.
    Failed {
        /// Why, with the remedy.
        error: String,
        /// What was found all the same.
        report: Value,
    },
}

/// A file that a job wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MadeFile {
    /// Its name in the folder `files` of the job.
    pub name: String,
    /// Digest of its content; absent of files that hold times or paths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
}

/// The result of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobResult {
    format: String,
    version: u32,
    /// Name of the job.
    pub id: String,
    /// Digest of the job.
    pub digest: String,
    /// Word for what was done.
    #[serde(rename = "do")]
    pub work: String,
    /// Name of the pattern's file.
    pub pattern: String,
    /// Named size, where one was asked for.
    pub size: Option<String>,
    /// The fabric, where one was asked for.
    pub fabric: Option<String>,
    /// The body, where one was asked for.
    pub body: Option<String>,
    /// Whether the job was done.
    pub made: bool,
    /// Words for a bad verdict on what was made.
    pub fault: Option<String>,
    /// Why the job could not be done.
    pub error: Option<String>,
    /// The files that were written.
    pub files: Vec<MadeFile>,
    /// The report of the command, as `--json` prints it.
    pub report: Value,
}

impl JobResult {
    /// The result of a job, with the files that it wrote into a folder, if it is there.
    pub(crate) fn new(job: &Job, outcome: JobOutcome, folder: Option<&Path>) -> Self {
        let own = |text: String| job.without_folders(&text);
        let (made, fault, error, report) = match outcome {
            JobOutcome::Made { report, fault } => (true, fault, None, report),
            JobOutcome::Failed { error, report } => (false, None, Some(own(error)), report),
        };
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            id: job.id.clone(),
            digest: job.digest.clone(),
            work: job.work.word().to_owned(),
            pattern: job.pattern_name(),
            size: job.size.clone(),
            fabric: job.fabric_name(),
            body: job.body_name(),
            made,
            fault,
            error,
            files: folder.map(files_in).unwrap_or_default(),
            report: with_texts(report, &own),
        }
    }

    /// The result in the text of a file, if it is one of this job.
    pub(crate) fn of(job: &Job, text: &str) -> Option<Self> {
        let read: Self = serde_json::from_str(text).ok()?;
        let is_own = read.format == FORMAT && read.version == VERSION && read.digest == job.digest;
        is_own.then_some(read)
    }
}

/// The files in a folder in the order of their names.
fn files_in(folder: &Path) -> Vec<MadeFile> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<MadeFile> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let content = match VARYING.contains(&&*name) {
                true => None,
                false => std::fs::read(entry.path()).ok(),
            };
            MadeFile {
                name,
                digest: content.map(|bytes| digest(&bytes)),
            }
        })
        .collect();
    files.sort_by(|a, b| a.name.cmp(&b.name));
    files
}

/// A value with every text in it changed.
fn with_texts(value: Value, change: &dyn Fn(String) -> String) -> Value {
    match value {
        Value::String(text) => change(text).into(),
        Value::Array(items) => items
            .into_iter()
            .map(|item| with_texts(item, change))
            .collect(),
        Value::Object(fields) => {
            let fields = fields.into_iter();
            let fields = fields.map(|(name, value)| (name, with_texts(value, change)));
            Value::Object(fields.collect())
        }
        other @ (Value::Null | Value::Bool(_) | Value::Number(_)) => other,
    }
}
