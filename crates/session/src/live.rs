//! A drape that runs on its own thread while somebody watches and takes hold of the cloth.

use crate::drape::{Drape, DrapeResult};
use crate::hands::HandledRun;
use crate::{GarmentJob, LiveInput, SessionError, StampedInput};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;
use toile_drape::{DrapeError, Stage};
use toile_geometry::Vec3;

/// One moment of a live drape.
#[derive(Clone, Debug)]
pub struct LiveFrame {
    /// Positions of the vertices [m]; fewer after merging.
    pub positions: Vec<Vec3>,
    /// Vertex of this frame for every vertex of the job's garment.
    pub target: Vec<u32>,
    /// What is being done.
    pub stage: Stage,
    /// Net force over weight; infinite while sewing.
    pub residual: f64,
    /// Largest seam gap [m].
    pub gap: f64,
    /// Steps taken in all.
    pub step: usize,
    /// Share of the way done, 0..=1, never falling.
    pub share: f64,
}

/// What the thread is told.
#[derive(Default)]
struct Orders {
    paused: bool,
    stop: bool,
    /// Inputs not yet taken, with the step they are for.
    inputs: Vec<(LiveInput, Option<u64>)>,
}

#[derive(Default)]
struct Shared {
    orders: Mutex<Orders>,
    woken: Condvar,
    latest: Mutex<Option<LiveFrame>>,
    applied: Mutex<Vec<StampedInput>>,
    outcome: Mutex<Option<Result<DrapeResult, String>>>,
    finished: AtomicBool,
}

/// A garment sewn and draped on its own thread. Only the newest frame is kept. While the cloth is
/// held it does not end: at rest it waits for the hand to move or let go. Dropping it stops the
/// thread and waits for it.
pub struct LiveRun {
    job: GarmentJob,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is told of a panic, from what it was raised with.
fn fault(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!(
        "the drape ended by a fault of the program ({}); save the pattern, report it with the pattern, and try another quality or size",
        text.unwrap_or("it left no message")
    )
}

impl LiveRun {
    /// Starts the thread. Should it panic, the run ends with a failure that says so.
    pub fn start(job: GarmentJob) -> Self {
        let shared = Arc::new(Shared::default());
        let (of_thread, its_job) = (shared.clone(), job.clone());
        let thread = std::thread::spawn(move || {
            // After a panic nothing is used but what the locks guard, each of it whole.
            let work = AssertUnwindSafe(|| run(&of_thread, its_job));
            let outcome = match catch_unwind(work) {
                Ok(outcome) => outcome.map_err(|error| error.to_string()),
                Err(panic) => Err(fault(&*panic)),
            };
            *lock(&of_thread.outcome) = outcome.transpose();
            of_thread.finished.store(true, Ordering::Release);
        });
        Self {
            job,
            shared,
            thread: Some(thread),
        }
    }

    /// The newest frame, if there is one that was not taken yet.
    pub fn latest(&self) -> Option<LiveFrame> {
        lock(&self.shared.latest).take()
    }

    /// Does something to the cloth before the next step. Of several inputs for one vertex that
    /// come between two steps only the newest counts. After the end nothing happens.
    ///
    /// # Errors
    /// A vertex or a place that is not there.
    pub fn give(&self, input: LiveInput) -> Result<(), SessionError> {
        self.order(input, None)
    }

    /// The same when so many steps are taken; before the next step if more are already. When the
    /// garment comes to rest earlier, then.
    ///
    /// # Errors
    /// A vertex or a place that is not there.
    pub fn give_at(&self, stamped: StampedInput) -> Result<(), SessionError> {
        self.order(stamped.input, Some(stamped.step))
    }

    fn order(&self, input: LiveInput, step: Option<u64>) -> Result<(), SessionError> {
        input.check(&self.job)?;
        lock(&self.shared.orders).inputs.push((input, step));
        self.shared.woken.notify_all();
        Ok(())
    }

    /// Everything that was done to the cloth so far, each with the step it was applied at. The
    /// same job with these inputs gives the same positions, bit by bit.
    pub fn inputs(&self) -> Vec<StampedInput> {
        lock(&self.shared.applied).clone()
    }

    /// Holds the run after the present step.
    pub fn pause(&self) {
        lock(&self.shared.orders).paused = true;
    }

    /// Lets a held run go on.
    pub fn resume(&self) {
        lock(&self.shared.orders).paused = false;
        self.shared.woken.notify_all();
    }

    /// Whether the run is held.
    pub fn is_paused(&self) -> bool {
        lock(&self.shared.orders).paused
    }

    /// Ends the run after the present step.
    pub fn stop(&self) {
        lock(&self.shared.orders).stop = true;
        self.shared.woken.notify_all();
    }

    /// Whether the run has ended: at rest, stopped or failed.
    pub fn is_finished(&self) -> bool {
        self.shared.finished.load(Ordering::Acquire)
    }

    /// Why it failed, if it did.
    pub fn failure(&self) -> Option<String> {
        lock(&self.shared.outcome).as_ref()?.as_ref().err().cloned()
    }

    /// The draped garment, once it hangs at rest; nothing before, and nothing of a run that was
    /// stopped or failed.
    pub fn result(&self) -> Option<DrapeResult> {
        lock(&self.shared.outcome).as_ref()?.as_ref().ok().cloned()
    }
}

impl Drop for LiveRun {
    fn drop(&mut self) {
        self.stop();
        if let Some(thread) = self.thread.take() {
            // The thread catches its panics and tells of them by `failure`.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// Waits while the run is paused, or at rest with the cloth held. Hands the inputs that came
    /// to the run; `false` means stop.
    fn wait_for_turn(&self, run: &mut HandledRun) -> bool {
        let mut orders = lock(&self.orders);
        loop {
            if orders.stop {
                return false;
            }
            if !orders.paused {
                for (input, step) in orders.inputs.drain(..) {
                    run.give(input, step);
                }
                if !(run.at_rest() && run.is_held()) {
                    return true;
                }
            }
            orders = self
                .woken
                .wait(orders)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Runs to rest; nothing means that it was stopped.
fn run(shared: &Shared, job: GarmentJob) -> Result<Option<DrapeResult>, DrapeError> {
    let start = Instant::now();
    let mut run = HandledRun::new(job)?;
    let mut seconds = start.elapsed().as_secs_f64();
    while shared.wait_for_turn(&mut run) {
        let start = Instant::now();
        if run.at_rest() {
            let drape = Arc::new(Drape::of(run));
            seconds += start.elapsed().as_secs_f64();
            return Ok(Some(DrapeResult { drape, seconds }));
        }
        let progress = run.advance()?;
        seconds += start.elapsed().as_secs_f64();
        let mut applied = lock(&shared.applied);
        let known = applied.len();
        applied.extend_from_slice(&run.applied()[known..]);
        drop(applied);
        let (positions, target) = run.shape()?;
        *lock(&shared.latest) = Some(LiveFrame {
            positions,
            target,
            stage: progress.stage,
            residual: progress.residual,
            gap: progress.gap,
            step: run.steps() as usize,
            share: progress.share,
        });
    }
    Ok(None)
}
