//! A drape that runs on its own thread while somebody watches.

use crate::GarmentJob;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use toile_drape::{GarmentRun, Stage};
use toile_geometry::Vec3;

/// One moment of a live drape.
#[derive(Clone, Debug)]
pub struct LiveFrame {
    /// Positions of the vertices [m]; fewer after merging.
    pub positions: Vec<Vec3>,
    /// Corners of the triangles; the same list until merging.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// Vertex of this frame for every vertex of the job's garment.
    pub target: Arc<Vec<u32>>,
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

#[derive(Default)]
struct Shared {
    latest: Mutex<Option<LiveFrame>>,
    failure: Mutex<Option<String>>,
    paused: Mutex<bool>,
    woken: Condvar,
    stop: AtomicBool,
    finished: AtomicBool,
}

/// A garment sewn and draped on its own thread. Only the newest frame is kept. Dropping it stops
/// the thread and waits for it.
pub struct LiveRun {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl LiveRun {
    /// Starts the thread.
    pub fn start(job: GarmentJob) -> Self {
        let shared = Arc::new(Shared::default());
        let of_thread = shared.clone();
        let thread = std::thread::spawn(move || {
            if let Err(error) = run(&of_thread, job) {
                *lock(&of_thread.failure) = Some(error.to_string());
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

    /// Holds the run after the present step.
    pub fn pause(&self) {
        *lock(&self.shared.paused) = true;
    }

    /// Lets a held run go on.
    pub fn resume(&self) {
        *lock(&self.shared.paused) = false;
        self.shared.woken.notify_all();
    }

    /// Whether the run is held.
    pub fn is_paused(&self) -> bool {
        *lock(&self.shared.paused)
    }

    /// Ends the run after the present step.
    pub fn stop(&self) {
        self.shared.stop.store(true, Ordering::Release);
        self.resume();
    }

    /// Whether the run has ended: at rest, stopped or failed.
    pub fn is_finished(&self) -> bool {
        self.shared.finished.load(Ordering::Acquire)
    }

    /// Why it failed, if it did.
    pub fn failure(&self) -> Option<String> {
        lock(&self.shared.failure).clone()
    }
}

impl Drop for LiveRun {
    fn drop(&mut self) {
        self.stop();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was reported when it happened; there is nothing to add here.
            let _ = thread.join();
        }
    }
}

fn run(shared: &Shared, job: GarmentJob) -> Result<(), toile_drape::DrapeError> {
    let mut run = GarmentRun::new(job.setup)?;
    let mut triangles = Arc::new(run.model.triangles.clone());
    let mut target = Arc::new(run.target.clone());
    loop {
        let mut paused = lock(&shared.paused);
        while *paused && !shared.stop.load(Ordering::Acquire) {
            paused = shared
                .woken
                .wait(paused)
                .unwrap_or_else(PoisonError::into_inner);
        }
        drop(paused);
        if shared.stop.load(Ordering::Acquire) {
            return Ok(());
        }
        let stage = run.progress().stage;
        let progress = run.advance()?;
        if progress.stage != stage {
            triangles = Arc::new(run.model.triangles.clone());
            target = Arc::new(run.target.clone());
        }
        *lock(&shared.latest) = Some(LiveFrame {
            positions: run.state.positions.clone(),
            triangles: triangles.clone(),
            target: target.clone(),
            stage: progress.stage,
            residual: progress.residual,
            gap: progress.gap,
            step: run.steps().iter().sum(),
            share: progress.share,
        });
        if progress.stage == Stage::Finished {
            return Ok(());
        }
    }
}
