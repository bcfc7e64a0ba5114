//! Long work without the interpreter's lock, with its progress told to Python.

use crate::errors::raised;
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use toile_session::{SessionError, Watcher};

/// Shortest time between two reports of one stage: Python is slow beside a step of a drape.
const PAUSE: Duration = Duration::from_millis(50);

/// Tells progress to a Python function, and stops the work when that raises, when it returns False, or at Ctrl-C.
struct Teller {
    tell: Option<Py<PyAny>>,
    raised: Option<PyErr>,
    last: Option<(String, Instant)>,
    stop: Arc<AtomicBool>,
}

impl Teller {
    fn goes_on(&self, (stage, share, words): (&str, f64, &str)) -> PyResult<bool> {
        Python::attach(|py| {
            py.check_signals()?;
            let Some(tell) = &self.tell else {
                return Ok(true);
            };
            let answer = tell.call1(py, (stage, share, words))?;
            Ok(!answer
                .bind(py)
                .cast::<PyBool>()
                .is_ok_and(|answer| !answer.is_true()))
        })
    }
}

impl Watcher for Teller {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        if self.stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        let is_soon = |(known, at): &(String, Instant)| known == stage && at.elapsed() < PAUSE;
        if self.last.as_ref().is_some_and(is_soon) {
            return ControlFlow::Continue(());
        }
        self.last = Some((stage.to_owned(), Instant::now()));
        match self.goes_on((stage, share, detail)) {
            Ok(true) => ControlFlow::Continue(()),
            Ok(false) => self.end(None),
            Err(error) => self.end(Some(error)),
        }
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        Some(self.stop.clone())
    }
}

impl Teller {
    fn end(&mut self, raised: Option<PyErr>) -> ControlFlow<()> {
        self.raised = raised;
        self.stop.store(true, Ordering::Relaxed);
        ControlFlow::Break(())
    }
}

/// Does long work without the interpreter's lock. What `tell` raises is what is raised.
pub fn watched<T: Send>(
    py: Python<'_>,
    tell: Option<Py<PyAny>>,
    work: impl FnOnce(&mut dyn Watcher) -> Result<T, SessionError> + Send,
) -> PyResult<T> {
    let mut teller = Teller {
        tell,
        raised: None,
        last: None,
        stop: Arc::default(),
    };
    let done = py.detach(|| work(&mut teller));
    match teller.raised {
        Some(error) => Err(error),
        None => done.map_err(|error| raised(py, error)),
    }
}

/// Does work without the interpreter's lock that tells no progress.
pub fn detached<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, SessionError> + Send,
) -> PyResult<T> {
    py.detach(work).map_err(|error| raised(py, error))
}
