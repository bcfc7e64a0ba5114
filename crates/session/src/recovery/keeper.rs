//! Keeps the state of a document on a thread of its own.

use super::state_file::{DocumentState, Head};
use super::{BEFORE, LOCK, NEWEST, PastStep, file_of};
use crate::Project;
use crate::fitting::document_text;
use crate::history::HistoryStep;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

/// Shortest time between two writes. Together with the write itself it stays under a second.
const PERIOD: Duration = Duration::from_millis(500);

/// Keeps the unsaved state of a document on the disk. Dropping the value writes a state that is not written
/// yet.
pub struct Recovery {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    /// Lock file, locked as long as this value lives.
    lock: Option<File>,
    files: Files,
}

/// State that the thread and its [`Recovery`] share, with a signal of changes.
#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

/// Orders to the thread, and its last failure.
#[derive(Default)]
struct State {
    /// Order that the thread has not taken yet; a newer order replaces it.
    wish: Option<Wish>,
    /// Whether the thread is to end.
    ends: bool,
    /// Reason why the last order could not be carried out.
    failure: Option<String>,
}

/// An order to the thread.
enum Wish {
    /// Keep a state with the last steps of its history, the newest first.
    Keep(Box<Project>, Vec<HistoryStep>),
    /// Remove the kept states.
    Clear,
}

/// Texts of the document before each of the steps that were kept last, by the numbers of the steps.
#[derive(Default)]
struct KeptTexts {
    /// File of the document; the texts name other files from its folder.
    source: Option<PathBuf>,
    by_number: BTreeMap<u64, String>,
}

/// Folder of the files of one process, and the start of their names.
#[derive(Clone)]
struct Files {
    folder: PathBuf,
    id: String,
}

impl Recovery {
    /// Begins to keep states in a folder, which is made if need be.
    ///
    /// # Errors
    /// The folder or the file that is locked cannot be made.
    pub fn start(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let nanoseconds = since.map_or(0, |time| time.as_nanos());
        let files = Files {
            folder: folder.to_owned(),
            id: format!("{nanoseconds}-{}", std::process::id()),
        };
        let lock = File::create_new(files.path(LOCK))?;
        lock.try_lock()?;
        let shared = Arc::new(Shared::default());
        let (of_thread, to) = (shared.clone(), files.clone());
        let thread = std::thread::Builder::new()
            .name("recovery".into())
            .spawn(move || of_thread.run(&to))?;
        Ok(Self {
            shared,
            thread: Some(thread),
            lock: Some(lock),
            files,
        })
    }

    /// Keeps a state of the document with the last steps of its history, the newest first, within a second.
    /// The state replaces an earlier one that is not written yet.
    pub fn keep(&self, project: &Project, past: Vec<HistoryStep>) {
        self.wish(Wish::Keep(Box::new(project.clone()), past));
    }

    /// Removes the kept states: call it when the document is saved, or its changes are not wanted.
    pub fn clear(&self) {
        self.wish(Wish::Clear);
    }

    /// Reason why the last state could not be kept, if it could not.
    pub fn failure(&self) -> Option<String> {
        self.shared.lock().failure.clone()
    }

    fn wish(&self, wish: Wish) {
        self.shared.lock().wish = Some(wish);
        self.shared.changed.notify_all();
    }
}

impl Drop for Recovery {
    fn drop(&mut self) {
        self.shared.lock().ends = true;
        self.shared.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // The thread reported its panic on standard error; no more can be done here.
            let _ = thread.join();
        }
        self.lock = None;
        let kept = self.files.path(NEWEST).exists() || self.files.path(BEFORE).exists();
        if !kept {
            // A lock file that cannot be removed does no harm: without a kept state no document is offered.
            let _ = fs::remove_file(self.files.path(LOCK));
        }
    }
}

impl Shared {
    /// The locked state. A lock that a panicked thread held is taken all the same: every field is valid by
    /// itself.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn run(&self, files: &Files) {
        let mut texts = KeptTexts::default();
        while let Some(wish) = self.next() {
            let begun = Instant::now();
            let done = match wish {
                Wish::Keep(project, past) => files.keep(&project, &past, &mut texts),
                Wish::Clear => files.clear().map_err(|error| error.to_string()),
            };
            self.lock().failure = done.err();
            self.rest(begun);
        }
    }

    /// Waits for the next order to the thread; `None` at the end.
    fn next(&self) -> Option<Wish> {
        let mut state = self.lock();
        loop {
            if let Some(wish) = state.wish.take() {
                return Some(wish);
            }
            if state.ends {
                return None;
            }
            let woken = self.changed.wait(state);
            state = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Waits until a period is over since `begun`, or until the end.
    fn rest(&self, begun: Instant) {
        let mut state = self.lock();
        while !state.ends {
            let left = PERIOD.saturating_sub(begun.elapsed());
            if left.is_zero() {
                return;
            }
            let woken = self.changed.wait_timeout(state, left);
            state = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Files {
    fn path(&self, ending: &str) -> PathBuf {
        file_of(&self.folder, &self.id, ending)
    }

    /// Keeps a state. `texts` holds the texts from before the steps that were kept last, so that these texts
    /// are not made anew.
    fn keep(
        &self,
        project: &Project,
        past: &[HistoryStep],
        texts: &mut KeptTexts,
    ) -> Result<(), String> {
        let source = project.source.clone();
        let text = document_text(project, source.as_deref()).map_err(|error| error.to_string())?;
        let mut known = match texts.source == source {
            true => std::mem::take(&mut texts.by_number),
            false => BTreeMap::new(),
        };
        let mut befores = Vec::with_capacity(past.len());
        for step in past {
            let before = match known.remove(&step.number) {
                Some(before) => before,
                None => match document_text(&step.project, source.as_deref()) {
                    Ok(before) => before,
                    // Older steps cannot be rebuilt without this one.
                    Err(_) => break,
                },
            };
            befores.push(before);
        }
        let afters = std::iter::once(&text).chain(&befores);
        let steps = past.iter().zip(&befores).zip(afters);
        let steps = steps
            .map(|((step, before), after)| PastStep::between(step.label.clone(), before, after));
        let steps = steps.collect();
        texts.source.clone_from(&source);
        texts.by_number = past.iter().map(|step| step.number).zip(befores).collect();
        let state = DocumentState {
            head: Head {
                name: project.pattern.name.clone(),
                source,
                past: steps,
            },
            text,
        };
        let bytes = state.to_bytes().map_err(|error| error.to_string())?;
        self.put(&bytes).map_err(|error| error.to_string())
    }

    /// Writes a state. Whenever the process ends, one of the last two states is undamaged.
    fn put(&self, bytes: &[u8]) -> io::Result<()> {
        let written = self.path("writing");
        let mut file = File::create(&written)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        let newest = self.path(NEWEST);
        if newest.exists() {
            fs::rename(&newest, self.path(BEFORE))?;
        }
        fs::rename(&written, &newest)
    }

    fn clear(&self) -> io::Result<()> {
        for ending in [BEFORE, NEWEST, "writing"] {
            match fs::remove_file(self.path(ending)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }
}
