//! Options of `toile batch` and `toile job`.

use clap::Args;
use std::path::PathBuf;

/// `toile batch`.
#[derive(Debug, Args)]
pub struct Batch {
    /// What to do (JSON): patterns, sizes, fabrics, bodies, do, options; see docs/FORMATS.md, batches.
    #[arg(value_name = "SPEC")]
    pub spec: PathBuf,
    /// Folder of the batch; it is made if need be. Given again, it goes on with what is not done yet; several
    /// processes may work in one folder.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Jobs done at once. Default: one a processor.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=1024), conflicts_with_all = ["list", "report"])]
    pub jobs: Option<u16>,
    /// Write the file of each job and list the jobs, but do none; with --json for schedulers, which run `toile job`.
    #[arg(long, conflicts_with_all = ["report", "retry"])]
    pub list: bool,
    /// Write the report of what is done so far, but do no job.
    #[arg(long, conflicts_with = "retry")]
    pub report: bool,
    /// Do jobs again that failed.
    #[arg(long)]
    pub retry: bool,
}

/// `toile job`.
#[derive(Debug, Args)]
pub struct JobTask {
    /// The job: DIR/jobs/ID/job.json of a batch. Its result is written beside it.
    #[arg(value_name = "JOB")]
    pub job: PathBuf,
    /// Do it in this very process, without a limit of time; it ends when its standard input closes.
    #[arg(long, hide = true)]
    pub here: bool,
}
