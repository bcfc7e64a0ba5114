//! Batches: one specification makes many jobs, each done by itself in a process of its own.
//!
//! # Decided with
//! - [`crate::batch::spec::Spec`]: the file that says what is done;
//! - [`crate::batch::work::Work`]: the commands that jobs are, and the options they take;
//! - [`crate::batch::list::list_jobs`], [`crate::batch::job::Job`]: jobs, their digests and files;
//! - [`crate::batch::folder::BatchFolder`], [`crate::batch::part::Part`]: the folder that several processes may
//!   share, results that are whole or absent;
//! - [`crate::batch::child::do_job`], [`crate::batch::limits::Limits`]: a job in its process, with its limits;
//! - [`crate::batch::run::run_batch`], [`crate::batch::report::Report`]: all jobs; what came of them.
//!
//! A job is done by the command line's own commands: crate `cli`, `batch_commands.rs`.

mod child;
mod folder;
mod job;
mod limits;
mod list;
mod part;
mod report;
mod result;
mod run;
mod spec;
mod strict_json;
mod work;

pub use child::{Ended, do_job};
pub use folder::BatchFolder;
pub use job::Job;
pub use limits::Limits;

pub use list::list_jobs;
pub use part::Part;
pub use report::Report;
pub use result::{JobOutcome, JobResult};
pub use run::{BatchRun, run_batch};
pub use spec::{CheckArguments, Spec};
pub use work::Work;
