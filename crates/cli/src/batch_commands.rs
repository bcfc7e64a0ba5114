//! Runs `toile batch` and `toile job`: many jobs, each a command in a process of its own.

use crate::arguments::Arguments;
use crate::bar::{Bar, INTERRUPTED};
use crate::batch_arguments::{Batch, JobTask};
use crate::output::{Failure, Made, Output, count};
use clap::Parser;
use serde_json::{Value, json};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use toile_session::{
    BatchFolder, BatchRun, Choice, Ended, Job, JobOutcome, Part, Report, SessionError, Spec,
    Watcher, do_job, list_jobs, run_batch,
};

/// Most failed jobs that are told in words.
const MAX_TOLD: usize = 10;

/// The arguments of a command of the command line, without the program's name.
fn parsed(words: &[String]) -> Result<Arguments, String> {
    let program = std::iter::once("toile".to_owned());
    Arguments::try_parse_from(program.chain(words.iter().cloned())).map_err(|error| {
        let text = error.to_string();
        let lines = text
            .lines()
            .take_while(|line| !line.starts_with("For more"));
        let lines = lines.map(str::trim).filter(|line| !line.is_empty());
        let lines = lines.take_while(|line| !line.starts_with("Usage:"));
        let words: Vec<&str> = lines.collect();
        let words = words.join(" ");
        words.strip_prefix("error: ").unwrap_or(&words).to_owned()
    })
}

/// This program, to be run again.
fn program() -> Result<PathBuf, Failure> {
    std::env::current_exe().map_err(|error| {
        Failure::failed(format!("the program does not find its own file: {error}"))
    })
}

/// A batch done, listed or reported.
pub fn batch(batch: &Batch, output: &Output) -> Result<Made, Failure> {
    let spec = Spec::open(&batch.spec, &|words| parsed(words).map(drop))?;
    let jobs = list_jobs(&spec)?;
    let folder = BatchFolder::open(&batch.out, &spec)?;
    folder.put(&jobs)?;
    if batch.list {
        return Ok(list(&folder, &jobs, output).into());
    }
    if !batch.report {
        run(batch, &folder, &jobs, output)?;
    }
    report(&folder, &jobs, output)
}

/// The jobs with their files.
fn list(folder: &BatchFolder, jobs: &[Job], output: &Output) -> Value {
    let listed = jobs.iter().map(|job| {
        let state = match folder.result(job) {
            None => "waiting",
            Some(result) if result.made => "made",
            Some(_) => "failed",
        };
        output.say(format!("{state:<8} {}", job.id));
        json!({
            "id": job.id,
            "state": state,
            "do": job.work.word(),
            "pattern": job.pattern_name(),
            "size": job.size,
            "fabric": job.fabric_name(),
            "body": job.body_name(),
            "job": folder.job_file(job),
        })
    });
    json!({ "jobs": listed.collect::<Vec<_>>() })
}

/// Does the jobs that are not done yet.
fn run(batch: &Batch, folder: &BatchFolder, jobs: &[Job], output: &Output) -> Result<(), Failure> {
    folder.sweep();
    if batch.retry {
        let forgotten = folder.forget_failed(jobs)?;
        output.say(format!("done again: {}", count(forgotten, "failed job")));
    }
    if !cfg!(target_os = "linux") {
        output.warn("note: memory of jobs has no limit on this system");
    }
    let others = folder.count_of_others(jobs);
    if others > 0 {
        output.warn(format!(
            "note: {} of patterns as they were before in {}: remove what you do not need",
            count(others, "job"),
            folder.file("jobs").display()
        ));
    }
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let run = BatchRun {
        program: &program()?,
        folder,
        jobs,
        at_once: batch.jobs.map_or_else(processors, usize::from),
    };
    let outcome = run_batch(&run, &mut Bar::stopped_by_a_signal());
    folder.sweep();
    outcome.map_err(|error| match error {
        SessionError::Cancelled => {
            let done = jobs.iter().filter(|job| folder.result(job).is_some());
            Failure::failed(format!(
                "stopped with {} of {} done; the same command goes on from there",
                done.count(),
                count(jobs.len(), "job")
            ))
        }
        other => other.into(),
    })
}

/// What came of the batch so far.
fn report(folder: &BatchFolder, jobs: &[Job], output: &Output) -> Result<Made, Failure> {
    let report = Report::of(folder, jobs);
    let files = report.write(folder, jobs)?;
    output.say(format!(
        "{}: {} made, {} failed{}",
        count(report.total, "job"),
        report.made,
        report.failed,
        match report.waiting.len() {
            0 => String::new(),
            waiting => format!(", {waiting} waiting"),
        }
    ));
    if report.faulty > 0 {
        output.warn(format!(
            "note: {} with a bad verdict on what was made",
            count(report.faulty, "job")
        ));
    }
    for file in &files {
        output.say(format!("wrote {}", file.display()));
    }
    let failed = report.jobs.iter().filter(|result| !result.made);
    let failed: Vec<(&str, &str)> = failed
        .map(|result| (&*result.id, result.error.as_deref().unwrap_or_default()))
        .collect();
    let told = json!({
        "files": files,
        "total": report.total,
        "made": report.made,
        "faulty": report.faulty,
        "failed": failed.iter().map(|(id, error)| json!({ "id": id, "error": error })).collect::<Vec<_>>(),
        "waiting": report.waiting,
    });
    if failed.is_empty() && report.waiting.is_empty() {
        return Ok(told.into());
    }
    let mut lines: Vec<String> = failed
        .iter()
        .take(MAX_TOLD)
        .map(|(id, error)| format!("{id}: {}", error.lines().next().unwrap_or_default()))
        .collect();
    lines.push(format!(
        "{} of {} failed, {} without a result; all are in {}",
        failed.len(),
        count(report.total, "job"),
        report.waiting.len(),
        folder.file("report.json").display()
    ));
    Err(Failure::failed(lines.join("\n")).with_report(told))
}

/// One job done.
pub fn job(task: &JobTask, output: &Output) -> Result<Made, Failure> {
    match task.here {
        true => job_here(&task.job),
        false => job_watched(&task.job, output),
    }
}

/// A job in a process of its own, with its limits.
fn job_watched(file: &Path, output: &Output) -> Result<Made, Failure> {
    let job = Job::open(file)?;
    let stop = Bar::stopped_by_a_signal().stop_flag().unwrap_or_default();
    if is_pipe() {
        let stop = stop.clone();
        at_end_of_input(move || stop.store(true, Ordering::Relaxed));
    }
    let ended = do_job(&program()?, &whole(file), &job, &stop)?;
    let Ended::Done(result) = ended else {
        let words = format!("job {} was stopped before it was done", job.id);
        return Err(Failure::failed(words));
    };
    let report = json!({ "result": result });
    match &result.error {
        Some(error) => Err(Failure::failed(error).with_report(report)),
        None => {
            output.say(format!("made {}", result.id));
            Ok(report.into())
        }
    }
}

/// A job in this process, which ends when its standard input closes.
fn job_here(file: &Path) -> Result<Made, Failure> {
    // Commands that end early at Ctrl-C with their best result find that somebody else answers it: a result is
    // whole, or there is none.
    let _ = ctrlc::set_handler(|| std::process::exit(INTERRUPTED));
    at_end_of_input(|| std::process::exit(INTERRUPTED));
    let job = Job::open(file)?;
    job.limits.hold_memory();
    job.refuse_changed()?;
    let file = whole(file);
    let folder = file.parent().unwrap_or(Path::new("."));
    let part = Part::begin(folder, &job)?;
    enter(part.path())?;
    let outcome = outcome(&job);
    // No system renames the folder that a process works in.
    enter(folder)?;
    part.finish(&job, outcome?)?;
    Ok(json!({}).into())
}

/// Does a job by its command, in the working directory.
///
/// # Errors
/// What is none of the job's: its files cannot be written.
fn outcome(job: &Job) -> Result<JobOutcome, Failure> {
    let task = parsed(&job.arguments()).map_err(Failure::bad_input)?.task;
    let Some(task) = task else {
        return Err(Failure::bad_input("the job names no command"));
    };
    match crate::run(task, &Output::silent()) {
        Ok(made) => {
            let (report, fault) = made.into_parts();
            Ok(JobOutcome::Made { report, fault })
        }
        Err(failure) if failure.is_unwritten() => Err(failure),
        Err(failure) => Ok(JobOutcome::Failed {
            error: failure.message().to_owned(),
            report: failure.report().cloned().unwrap_or_default(),
        }),
    }
}

/// An absolute path, which stays right when the working directory changes.
fn whole(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

fn enter(folder: &Path) -> Result<(), Failure> {
    std::env::set_current_dir(folder)
        .map_err(|error| Failure::failed(format!("cannot enter {}: {error}", folder.display())))
}

/// Whether the standard input is a pipe, by which another program holds on to this one.
fn is_pipe() -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let about = std::fs::metadata("/dev/stdin");
        about.is_ok_and(|about| about.file_type().is_fifo())
    }
    #[cfg(not(unix))]
    false
}

/// Does something once the standard input is at its end.
fn at_end_of_input(act: impl FnOnce() + Send + 'static) {
    std::thread::spawn(move || {
        let mut piece = [0; 256];
        while let Ok(1..) = std::io::stdin().read(&mut piece) {}
        act();
    });
}
