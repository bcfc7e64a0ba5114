//! All jobs of a batch, several at once; other processes may do the rest of them in the same folder.

use super::child::{Ended, do_job};
use super::folder::BatchFolder;
use super::job::Job;
use crate::watcher::report_progress;
use crate::{SessionError, Watcher};
use std::collections::VecDeque;
use std::hash::{BuildHasher, RandomState};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// Time between two looks whether the batch is to stop.
const LOOKS: Duration = Duration::from_millis(50);

/// What a batch needs to run.
#[derive(Clone, Copy, Debug)]
pub struct BatchRun<'a> {
    /// The command line, which does single jobs.
    pub program: &'a Path,
    /// The folder, with the files of the jobs in it.
    pub folder: &'a BatchFolder,
    /// The jobs.
    pub jobs: &'a [Job],
    /// Number of jobs done at once, at least 1.
    pub at_once: usize,
}

/// The jobs that are waiting, each with whether another process was at it when it was taken first.
type Queue = Mutex<VecDeque<(usize, bool)>>;

/// Does all jobs that have no result yet. A job that fails is a result, and the others are done.
///
/// # Errors
/// [`SessionError::Cancelled`] if the watcher stops it; a job that cannot be done for a reason that is none of its
/// own, as on a full disk. What was done stays done.
pub fn run_batch(run: &BatchRun, watcher: &mut dyn Watcher) -> Result<(), SessionError> {
    let total = run.jobs.len();
    let mut order: VecDeque<(usize, bool)> = (0..total).map(|k| (k, false)).collect();
    if run.folder.was_there() && total > 0 {
        // Two processes in one folder begin at different jobs.
        let begin = RandomState::new().hash_one(total) % total as u64;
        order.rotate_left(begin as usize);
    }
    let queue: Queue = Mutex::new(order);
    let stop = AtomicBool::new(false);
    let (sender, receiver) = channel();
    thread::scope(|scope| {
        for _ in 0..run.at_once.clamp(1, total.max(1)) {
            let (sender, queue, stop) = (sender.clone(), &queue, &stop);
            scope.spawn(move || work_off(run, (queue, stop), &sender));
        }
        drop(sender);
        let (mut done, mut failed) = (0, 0);
        let mut outcome = Ok(());
        loop {
            let share = done as f64 / total.max(1) as f64;
            let detail = match failed {
                0 => format!("{done} of {total}"),
                _ => format!("{done} of {total}, {failed} failed"),
            };
            let go_on = report_progress(watcher, "jobs", share, &detail);
            if outcome.is_ok() && go_on.is_err() {
                outcome = go_on;
                stop.store(true, Ordering::Relaxed);
            }
            match receiver.recv_timeout(LOOKS) {
                Ok(Ok(Ended::Done(result))) => {
                    done += 1;
                    failed += usize::from(!result.made);
                }
                Ok(Ok(Ended::Interrupted)) => {}
                Ok(Err(error)) => {
                    stop.store(true, Ordering::Relaxed);
                    if outcome.is_ok() {
                        outcome = Err(error);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        outcome
    })
}

/// Does jobs until none is waiting.
fn work_off(
    run: &BatchRun,
    (queue, stop): (&Queue, &AtomicBool),
    told: &Sender<Result<Ended, SessionError>>,
) {
    loop {
        let next = match queue.lock() {
            Ok(mut waiting) => waiting.pop_front(),
            Err(_) => None,
        };
        let Some((k, was_put_off)) = next.filter(|_| !stop.load(Ordering::Relaxed)) else {
            return;
        };
        let job = &run.jobs[k];
        // What another process is at comes last.
        if !was_put_off && run.folder.result(job).is_none() && run.folder.is_being_done(job) {
            if let Ok(mut waiting) = queue.lock() {
                waiting.push_back((k, true));
            }
            continue;
        }
        let ended = do_job(run.program, &run.folder.job_file(job), job, stop);
        // Nobody listens any more only when all is over.
        let _ = told.send(ended);
    }
}
