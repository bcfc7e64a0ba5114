//! A drape on its own thread: it publishes frames, and takes dragged vertices and edits of the pattern.
//!
//! # Decided with
//! - [`crate::interactive_run::InteractiveRun`]: a step, hands and edits;
//! - [`crate::live::run`], [`crate::live::Shared::wait_for_task`]: the thread, and what it does next;
//! - [`toile_drape::GarmentRun`]: the run itself;
//! - [`crate::session::Session::adopt_drape`]: its result taken over as the drape;
//! - [`crate::drape::drape`]: the same for commands, without a thread.

use crate::drape::{Drape, DrapeResult};
use crate::garment_edit::GarmentEdit;
use crate::interactive_run::{InteractiveRun, check_action};
use crate::rest_change::RestChange;
use crate::{GarmentJob, SessionError};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;
use toile_drape::{Action, DrapeError, Input, Progress, Stage, Verdict};
use toile_geometry::Vec3;

/// State of a live drape at one moment.
#[derive(Clone)]
pub struct LiveFrame {
    /// Job of the garment shown, after the newest edit that was applied.
    pub job: Arc<GarmentJob>,
    /// Positions of the vertices (m); fewer after merging.
    pub positions: Vec<Vec3>,
    /// Vertex of this frame for every vertex of the job's garment.
    pub target: Vec<u32>,
    /// Present stage of the drape.
    pub stage: Stage,
    /// Whether an edit can be applied: the run is on its finest mesh, with closed seams.
    pub takes_edits: bool,
    /// Net force over weight (1); infinite while sewing.
    pub residual: f64,
    /// Largest seam gap (m).
    pub gap: f64,
    /// Steps taken in all.
    pub step: usize,
    /// Share of the drape that is done, 0..=1; only an edit makes it fall.
    pub share: f64,
}

/// Requests to the thread.
#[derive(Default)]
struct Orders {
    paused: bool,
    /// Whether the garment is held where it hangs until an edit comes ([`LiveRun::stand_still`]).
    stands: bool,
    stop: bool,
    /// Inputs not yet taken, with the step they are for.
    actions: Vec<(Action, Option<u64>)>,
    /// An edit not yet taken.
    edit: Option<GarmentEdit>,
    /// Job that the thread works on.
    job: Option<Arc<GarmentJob>>,
    /// Whether the thread has ended.
    ended: bool,
}

/// State that the thread and its [`LiveRun`] share.
#[derive(Default)]
struct Shared {
    orders: Mutex<Orders>,
    /// Wakes the thread when `orders` have changed.
    woken: Condvar,
    /// The newest frame. `None`: it was taken already.
    latest: Mutex<Option<LiveFrame>>,
    /// Actions on the cloth so far.
    applied: Mutex<Vec<Input>>,
    /// The garment at rest, or the reason why the run failed. `None`: the run goes on, was stopped, or came
    /// to rest after an edit.
    outcome: Mutex<Option<Result<DrapeResult, String>>>,
    /// Warnings about the garment when it last came to rest.
    warnings: Mutex<Vec<String>>,
    /// Verdict on the garment at rest. `None`: it moves, or has not come to rest yet.
    verdict: Mutex<Option<Verdict>>,
    /// Whether nothing moves any more.
    finished: AtomicBool,
}

/// A garment sewn and draped on its own thread, which then waits for input: a dragged vertex or an edit of
/// the pattern. Only the newest frame is available. Dropping it stops the thread and waits for it.
pub struct LiveRun {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The message for a panic, from the value it was raised with.
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
        let job = Arc::new(job);
        lock(&shared.orders).job = Some(job.clone());
        let of_thread = shared.clone();
        let thread = std::thread::spawn(move || {
            // After a panic only values behind the locks are used, each of which is whole.
            let work = AssertUnwindSafe(|| run(&of_thread, job));
            let failure = match catch_unwind(work) {
                Ok(ended) => ended.err().map(|error| error.to_string()),
                Err(panic) => Some(fault(&*panic)),
            };
            lock(&of_thread.orders).ended = true;
            if let Some(words) = failure {
                *lock(&of_thread.outcome) = Some(Err(words));
            }
            of_thread.finished.store(true, Ordering::Release);
        });
        Self {
            shared,
            thread: Some(thread),
        }
    }

    /// The newest frame, if there is one that was not taken yet.
    pub fn latest(&self) -> Option<LiveFrame> {
        lock(&self.shared.latest).take()
    }

    /// Queues an action on the cloth for the next step: a garment takes hands on its vertices. Of several
    /// actions on one vertex between two steps only the newest counts. A garment at rest moves again.
    ///
    /// # Errors
    /// An unknown vertex, a place or force out of range, an action that a garment does not take.
    pub fn give(&self, action: Action) -> Result<(), SessionError> {
        self.order(action, None)
    }

    /// Queues an action for after the number of steps that the input says; for the next step if that
    /// is past. If the garment comes to rest earlier, the action is applied then.
    ///
    /// # Errors
    /// Those of [`LiveRun::give`].
    pub fn give_at(&self, input: Input) -> Result<(), SessionError> {
        self.order(input.action, Some(input.step))
    }

    fn order(&self, action: Action, step: Option<u64>) -> Result<(), SessionError> {
        let mut orders = lock(&self.shared.orders);
        if let Some(job) = &orders.job {
            check_action(&action, job)?;
        }
        orders.actions.push((action, step));
        self.shared.begin_again(&orders);
        Ok(())
    }

    /// Applies an edit of the pattern to the garment where it hangs, as soon as the seams of its finest mesh
    /// are closed. `edit` must be made from the newest garment that this run was given: by
    /// [`LiveRun::start`], or by the edit before. An edit that still waits is replaced. Hands stay on the
    /// cloth unless it is meshed anew. A garment that stands still goes on.
    ///
    /// A garment that comes to rest after an edit is no [`LiveRun::result`]: friction and folds remember the
    /// shapes before, so it hangs a little otherwise than a drape of the pattern from the start.
    pub fn edit(&self, mut edit: GarmentEdit) {
        let mut orders = lock(&self.shared.orders);
        if let Some(replaced) = orders.edit.take() {
            edit.change = edit.change.max(replaced.change);
        }
        orders.edit = Some(edit);
        orders.stands = false;
        self.shared.begin_again(&orders);
    }

    /// Holds the garment where it hangs until an edit comes that it can follow. While it is sewn it goes on
    /// until its seams are closed.
    pub fn stand_still(&self) {
        lock(&self.shared.orders).stands = true;
    }

    /// All actions on the cloth so far, each with the step at which it was applied. The same job
    /// with these inputs gives the same positions, bit by bit.
    pub fn inputs(&self) -> Vec<Input> {
        lock(&self.shared.applied).clone()
    }

    /// Pauses the run after the present step.
    pub fn pause(&self) {
        lock(&self.shared.orders).paused = true;
    }

    /// Resumes a paused run.
    pub fn resume(&self) {
        lock(&self.shared.orders).paused = false;
        self.shared.woken.notify_all();
    }

    /// Whether the run is paused.
    pub fn is_paused(&self) -> bool {
        lock(&self.shared.orders).paused
    }

    /// Ends the run after the present step.
    pub fn stop(&self) {
        lock(&self.shared.orders).stop = true;
        self.shared.woken.notify_all();
    }

    /// Whether nothing moves any more: at rest, stopped or failed. An action on a garment at rest, or an
    /// edit of it, starts it again.
    pub fn is_finished(&self) -> bool {
        self.shared.finished.load(Ordering::Acquire)
    }

    /// Reason why the run failed, if it did.
    pub fn failure(&self) -> Option<String> {
        lock(&self.shared.outcome).as_ref()?.as_ref().err().cloned()
    }

    /// The draped garment once it hangs at rest. `None` before, for a run that was stopped or failed, and
    /// after an edit that changed the garment.
    pub fn result(&self) -> Option<DrapeResult> {
        lock(&self.shared.outcome).as_ref()?.as_ref().ok().cloned()
    }

    /// Warnings about a garment at rest, in plain words, also after an edit.
    pub fn warnings(&self) -> Vec<String> {
        lock(&self.shared.warnings).clone()
    }

    /// The verdict on a garment that rests, also after an edit; `None` while it moves.
    pub fn verdict(&self) -> Option<Verdict> {
        lock(&self.shared.verdict).clone()
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

/// The next task of the thread.
enum NextTask {
    /// Take a step.
    Step,
    /// Apply an edit of the pattern.
    Edit(Box<GarmentEdit>),
    /// Report on a garment that has come to rest.
    Report,
    /// End the thread.
    End,
}

impl Shared {
    /// Wakes the thread for a new order and discards the earlier result; does nothing once the thread has
    /// ended.
    fn begin_again(&self, orders: &Orders) {
        if !orders.ended {
            *lock(&self.outcome) = None;
            *lock(&self.verdict) = None;
            self.finished.store(false, Ordering::Release);
            self.woken.notify_all();
        }
    }

    /// Waits while the run is paused, stands still, or is at rest with nothing to do. Passes queued actions
    /// on to the run. `told` is the report on the garment at rest, if it was made already: it is published.
    fn wait_for_task(&self, run: &mut InteractiveRun, told: Option<&RestReport>) -> NextTask {
        let mut orders = lock(&self.orders);
        loop {
            if orders.stop {
                return NextTask::End;
            }
            if !orders.paused {
                for (action, step) in orders.actions.drain(..) {
                    run.give(action, step);
                }
                if run.takes_edits()
                    && let Some(edit) = orders.edit.take()
                {
                    orders.job = Some(Arc::new(edit.job.clone()));
                    return NextTask::Edit(Box::new(edit));
                }
                match told {
                    _ if !run.at_rest() => {
                        if !(orders.stands && run.takes_edits()) {
                            return NextTask::Step;
                        }
                    }
                    _ if run.is_held() => {}
                    None => return NextTask::Report,
                    Some(told) => {
                        *lock(&self.outcome) = told.result.clone().map(Ok);
                        lock(&self.warnings).clone_from(&told.warnings);
                        *lock(&self.verdict) = Some(told.verdict.clone());
                        self.finished.store(true, Ordering::Release);
                    }
                }
            }
            orders = self
                .woken
                .wait(orders)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn show(
        &self,
        run: &mut InteractiveRun,
        job: &Arc<GarmentJob>,
        progress: Progress,
    ) -> Result<(), DrapeError> {
        let (positions, target) = run.shape()?;
        *lock(&self.latest) = Some(LiveFrame {
            job: job.clone(),
            positions,
            target,
            stage: progress.stage,
            takes_edits: run.takes_edits(),
            residual: progress.residual,
            gap: progress.gap,
            step: run.steps() as usize,
            share: progress.share,
        });
        Ok(())
    }
}

/// The report on a garment at rest.
struct RestReport {
    /// Drape of the garment, unless it followed an edit.
    result: Option<DrapeResult>,
    warnings: Vec<String>,
    verdict: Verdict,
}

/// Work of the thread: runs the drape until the run is stopped.
fn run(shared: &Shared, mut job: Arc<GarmentJob>) -> Result<(), DrapeError> {
    let start = Instant::now();
    let mut run = InteractiveRun::new((*job).clone())?;
    let mut seconds = start.elapsed().as_secs_f64();
    let mut told: Option<RestReport> = None;
    let mut is_edited = false;
    loop {
        let turn = shared.wait_for_task(&mut run, told.as_ref());
        let start = Instant::now();
        told = None;
        match turn {
            NextTask::End => return Ok(()),
            NextTask::Report => {
                let drape = Arc::new(Drape::of(&mut run));
                seconds += start.elapsed().as_secs_f64();
                let warnings = drape.warnings.clone();
                let verdict = drape.verdict.clone();
                let result = (!is_edited).then_some(DrapeResult { drape, seconds });
                told = Some(RestReport {
                    result,
                    warnings,
                    verdict,
                });
            }
            NextTask::Edit(edit) => {
                is_edited |= edit.change != RestChange::Nothing;
                job = Arc::new(edit.job.clone());
                let progress = run.edit(edit.job, edit.change)?;
                shared.show(&mut run, &job, progress)?;
            }
            NextTask::Step => {
                let progress = run.advance()?;
                seconds += start.elapsed().as_secs_f64();
                let mut applied = lock(&shared.applied);
                let known = applied.len();
                applied.extend_from_slice(&run.applied()[known..]);
                drop(applied);
                shared.show(&mut run, &job, progress)?;
            }
        }
    }
}
