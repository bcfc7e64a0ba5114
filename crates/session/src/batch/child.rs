//! A job done in a process of its own: with one thread, with limits, and ended when nobody waits for it.

use super::job::Job;
use super::part::{JobTiming, Part, is_being_done, result_in};
use super::result::{JobOutcome, JobResult};
use crate::SessionError;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use toile_interchange::FileError;

/// Shortest and longest time between two looks at a process.
const LOOKS: [Duration; 2] = [Duration::from_millis(1), Duration::from_millis(40)];
/// Looks in the time that a process has taken: so much of it is lost at its end, at most.
const LOOKS_SO_FAR: u32 = 40;
/// Time between two looks at a job that another process is doing.
const WAITING: Duration = Duration::from_millis(100);
/// What is kept of the words of a process (bytes): the last of them.
const MAX_HEARD: usize = 16_384;
/// Words on standard error by which memory that was refused is known.
const OUT_OF_MEMORY: [&str; 5] = [
    "memory allocation of",
    "OutOfMemory",
    "Cannot allocate memory",
    "Resource temporarily unavailable",
    "failed to allocate",
];
/// Exit status of a program that panicked.
const PANICKED: i32 = 101;
/// Signals by which the system ends a program for its own fault: SIGILL, SIGTRAP, SIGABRT, SIGBUS, SIGFPE, SIGSEGV,
/// SIGSYS.
const FAULTS: [i32; 7] = [4, 5, 6, 7, 8, 11, 31];

/// How the doing of a job ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// The job has a result.
    Done(Box<JobResult>),
    /// It was stopped before; it has none.
    Interrupted,
}

/// How a process ended.
enum Exit {
    /// By itself.
    Status(ExitStatus, String),
    /// It took longer than it may.
    TooLong,
    /// It was asked to stop.
    Stopped,
}

/// Does a job in a process of its own, unless it is done; if another process is doing it, its result is waited for.
/// `program` is the command line; `job_file` lies in the folder of the job.
///
/// # Errors
/// The process cannot be started, or ended without a result for a reason that is none of the job's, as on a full
/// disk.
pub fn do_job(
    program: &Path,
    job_file: &Path,
    job: &Job,
    stop: &AtomicBool,
) -> Result<Ended, SessionError> {
    let folder = job_file.parent().unwrap_or(Path::new("."));
    let done = || result_in(folder, job).map(|result| Ended::Done(Box::new(result)));
    loop {
        if let Some(done) = done() {
            return Ok(done);
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(Ended::Interrupted);
        }
        if !is_being_done(folder) {
            break;
        }
        thread::sleep(WAITING);
    }
    let start = Instant::now();
    let child = begin(program, job_file)?;
    let exit = wait(child, job, (start, stop));
    if let Some(done) = done() {
        return Ok(done);
    }
    let error = match exit {
        Exit::Stopped => return Ok(Ended::Interrupted),
        Exit::TooLong => format!(
            "it took longer than its limit of {} s; raise time_limit and give --retry",
            job.limits.time_s
        ),
        Exit::Status(status, heard) => match fate(status) {
            Fate::Stopped => return Ok(Ended::Interrupted),
            Fate::Refused => {
                let heard = heard.trim();
                let why = heard.strip_prefix("error: ").unwrap_or(heard).to_owned();
                let id = job.id.clone();
                return Err(SessionError::Job { id, why });
            }
            Fate::Crashed(_) if OUT_OF_MEMORY.iter().any(|words| heard.contains(words)) => format!(
                "it took more memory than its limit of {}; raise memory_limit and give --retry",
                job.limits.memory_words()
            ),
            Fate::Crashed(how) => {
                format!(
                    "the program {how}, which is its own fault: please report it with the pattern"
                )
            }
        },
    };
    let outcome = JobOutcome::Failed {
        error,
        report: serde_json::Value::Null,
    };
    let timing = JobTiming {
        wall_s: start.elapsed().as_secs_f64(),
        pattern: job.pattern.clone(),
        ..JobTiming::default()
    };
    Part::begin(folder, job)?.finish_in(job, outcome, &timing)?;
    Ok(done().unwrap_or(Ended::Interrupted))
}

/// Starts the process of a job.
fn begin(program: &Path, job_file: &Path) -> Result<Child, SessionError> {
    let mut command = Command::new(program);
    command
        .args(["job", "--here"])
        .arg(job_file)
        .env("RAYON_NUM_THREADS", "1")
        // The last words of a process are read: they say why it ended.
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    // Ctrl-C on the terminal is for the batch alone, which then ends its children.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let started = command.spawn();
    Ok(started.map_err(|error| FileError::from_io("start", program, &error))?)
}

/// Waits for a process; ends it where it takes too long, or is to stop.
fn wait(mut child: Child, job: &Job, (start, stop): (Instant, &AtomicBool)) -> Exit {
    let words = child.stderr.take();
    let heard = thread::spawn(move || last_words(words));
    let limit = Duration::from_secs_f64(job.limits.time_s);
    loop {
        if let Ok(Some(status)) = child.try_wait() {
            return Exit::Status(status, heard.join().unwrap_or_default());
        }
        let is_stopped = stop.load(Ordering::Relaxed);
        if is_stopped || start.elapsed() > limit {
            // Who has just ended needs no end; its result is looked for all the same.
            let _ = child.kill();
            let _ = child.wait();
            return match is_stopped {
                true => Exit::Stopped,
                false => Exit::TooLong,
            };
        }
        thread::sleep((start.elapsed() / LOOKS_SO_FAR).clamp(LOOKS[0], LOOKS[1]));
    }
}

/// The last that a process says.
fn last_words(source: Option<impl Read>) -> String {
    let Some(mut source) = source else {
        return String::new();
    };
    let mut kept = Vec::new();
    let mut piece = [0; 4096];
    while let Ok(count @ 1..) = source.read(&mut piece) {
        kept.extend_from_slice(&piece[..count]);
        let more = kept.len().saturating_sub(MAX_HEARD);
        kept.drain(..more);
    }
    String::from_utf8_lossy(&kept).into_owned()
}

/// What the exit status of a process without a result means.
enum Fate {
    /// It was ended from outside.
    Stopped,
    /// It said why it did nothing.
    Refused,
    /// It broke down, in such a way.
    Crashed(&'static str),
}

fn fate(status: ExitStatus) -> Fate {
    match (status.code(), signal(status)) {
        (Some(PANICKED), _) => Fate::Crashed("panicked"),
        (Some(0..=2), _) => Fate::Refused,
        (None, Some(signal)) if FAULTS.contains(&signal) => Fate::Crashed("crashed"),
        (None, _) => Fate::Stopped,
        // Beyond 128: a signal that a shell, or the process itself, tells by number.
        (Some(129..), _) => Fate::Stopped,
        (Some(_), _) => Fate::Crashed("ended with a status of its own"),
    }
}

#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

#[cfg(not(unix))]
fn signal(_: ExitStatus) -> Option<i32> {
    None
}
