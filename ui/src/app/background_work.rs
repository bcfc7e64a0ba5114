//! Work on other threads: the mannequin and the meshed garment are made from a snapshot, then the drape runs
//! live. A garment that hangs follows the edits of its pattern; how it follows is found on another thread
//! too.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use toile_session::{
    CannotFollow, Event, GarmentEdit, GarmentJob, LiveFrame, LiveRun, Project, RestChange, Session,
    SessionError, Stage, Verdict,
};

/// The work in progress and the live drape.
#[derive(Default)]
pub struct BackgroundWork {
    body: Option<Receiver<Made<Result<(), SessionError>>>>,
    garment: Option<Receiver<Made<Result<GarmentJob, SessionError>>>>,
    edit: Option<Receiver<Made<Result<GarmentEdit, CannotFollow>>>>,
    run: Option<LiveRun>,
    last: Option<Moment>,
    /// The garment as it is to hang, by the edit that was given last.
    given: Option<Arc<GarmentJob>>,
    /// The project that the garment was last made for or compared with, and its revision.
    compared: Option<(Project, u64)>,
    /// Why the garment cannot go on to the present project.
    standstill: Option<String>,
    /// Whether the report on the garment at rest was shown.
    told: bool,
}

/// The result of a thread.
struct Made<T> {
    session: Session,
    result: T,
}

/// The status of the garment in the 3D view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GarmentStatus {
    /// No garment.
    Nothing,
    /// A garment that is being meshed.
    Preparing,
    /// The garment of the pattern, on its way.
    Moving,
    /// The same, held by Pause.
    Held,
    /// The same where it was stopped.
    Stopped,
    /// The same at rest.
    AtRest,
    /// The garment of an earlier pattern, and why.
    OutOfDate(String),
}

/// The main numbers of a live drape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// What is being done.
    pub stage: Stage,
    /// Steps taken.
    pub step: usize,
    /// Largest seam gap [m].
    pub gap: f64,
    /// Net force over weight.
    pub residual: f64,
    /// Share of the way done, 0..=1.
    pub share: f64,
    /// Revision of the project it shows.
    revision: u64,
    /// Whether an edit can be taken.
    takes_edits: bool,
}

impl From<&LiveFrame> for Moment {
    fn from(frame: &LiveFrame) -> Self {
        Self {
            stage: frame.stage,
            step: frame.step,
            gap: frame.gap,
            residual: frame.residual,
            share: frame.share,
            revision: frame.job.revision,
            takes_edits: frame.takes_edits,
        }
    }
}

/// An event of the work since the last frame.
pub enum WorkEvent {
    /// The session knows its mannequin now.
    Body,
    /// The garment is meshed and placed; the drape begins.
    Begun(Arc<GarmentJob>),
    /// The cloth has moved.
    Frame(LiveFrame),
    /// The drape has come to rest and was handed to the session, with its events.
    Finished(Vec<Event>),
    /// The garment that followed an edit has come to rest with shortcomings.
    Warned(Vec<String>),
    /// It cannot be done.
    Failed(String),
}

impl BackgroundWork {
    /// Begins to make the mannequin of a session's wearer.
    pub fn start_body(&mut self, session: &Session) {
        self.body = Some(on_thread(session, |session| {
            session.mannequin().map(|_| ())
        }));
    }

    /// Begins to make and drape a session's garment. A drape that runs is ended.
    pub fn start_garment(&mut self, session: &Session) {
        self.clear();
        self.compared = Some((session.project().clone(), session.revision()));
        self.garment = Some(on_thread(session, Session::garment_setup));
    }

    /// Ends the drape. What it has reached stays.
    pub fn stop(&mut self) {
        self.garment = None;
        self.run = None;
    }

    /// Forgets the garment.
    pub fn clear(&mut self) {
        self.stop();
        self.edit = None;
        self.last = None;
        self.given = None;
        self.compared = None;
        self.standstill = None;
        self.told = false;
    }

    /// Holds the drape, or lets it go on.
    pub fn toggle_pause(&mut self) {
        match &self.run {
            Some(run) if run.is_paused() => run.resume(),
            Some(run) => run.pause(),
            None => {}
        }
    }

    /// Whether the drape is held.
    pub fn is_paused(&self) -> bool {
        self.run.as_ref().is_some_and(LiveRun::is_paused)
    }

    /// Whether a garment is being meshed or draped, or is held meanwhile.
    pub fn is_draping(&self) -> bool {
        self.garment.is_some() || self.is_moving() || self.is_paused()
    }

    /// Whether the mannequin is being made.
    pub fn is_making_body(&self) -> bool {
        self.body.is_some()
    }

    /// Whether a garment is shown that can be hung again.
    pub fn hangs(&self) -> bool {
        self.given.is_some()
    }

    /// Whether anything may change without the person doing something.
    pub fn is_busy(&self) -> bool {
        let works = self.body.is_some() || self.garment.is_some() || self.edit.is_some();
        works || self.is_moving()
    }

    /// Whether the cloth moves.
    fn is_moving(&self) -> bool {
        let stands = self.standstill.is_some() && self.last.is_some_and(|last| last.takes_edits);
        let moves = |run: &LiveRun| !run.is_finished() && !run.is_paused();
        !stands && self.run.as_ref().is_some_and(moves)
    }

    /// The drape at its newest.
    pub fn moment(&self) -> Option<Moment> {
        self.last
    }

    /// The verdict on the garment at rest.
    pub fn verdict(&self) -> Option<Verdict> {
        self.run.as_ref()?.verdict()
    }

    /// What the picture shows.
    pub fn status(&self) -> GarmentStatus {
        if self.garment.is_some() {
            return GarmentStatus::Preparing;
        }
        let (Some(given), Some(last)) = (&self.given, self.last) else {
            return GarmentStatus::Nothing;
        };
        if let Some(why) = &self.standstill {
            return GarmentStatus::OutOfDate(why.clone());
        }
        let waits = last.revision != given.revision;
        match last.stage {
            _ if waits && self.run.is_none() => GarmentStatus::OutOfDate(STOPPED.to_owned()),
            _ if waits && self.is_paused() => {
                GarmentStatus::OutOfDate("it is held: Pause lets it follow".to_owned())
            }
            Stage::Sewing if waits => GarmentStatus::OutOfDate(
                "it is still being sewn, and follows when its seams are closed".to_owned(),
            ),
            _ if waits && !last.takes_edits => GarmentStatus::OutOfDate(
                "it still hangs on a coarse mesh, and follows on the fine one".to_owned(),
            ),
            _ if self.is_paused() => GarmentStatus::Held,
            Stage::Finished if !waits && self.edit.is_none() => GarmentStatus::AtRest,
            _ if self.run.is_none() => GarmentStatus::Stopped,
            _ => GarmentStatus::Moving,
        }
    }

    /// What came about since the last look. What threads derived goes to the session.
    pub fn news(&mut self, session: &mut Session) -> Vec<WorkEvent> {
        let mut news = Vec::new();
        match take(&mut self.body, session) {
            Some(Ok(Ok(()))) => news.push(WorkEvent::Body),
            Some(Ok(Err(error))) => news.push(WorkEvent::Failed(error.to_string())),
            Some(Err(words)) => news.push(WorkEvent::Failed(words)),
            None => {}
        }
        match take(&mut self.garment, session) {
            Some(Ok(Ok(job))) => {
                self.run = Some(LiveRun::start(job.clone()));
                let job = Arc::new(job);
                self.given = Some(job.clone());
                news.extend([WorkEvent::Body, WorkEvent::Begun(job)]);
            }
            Some(Ok(Err(error))) => news.push(WorkEvent::Failed(error.to_string())),
            Some(Err(words)) => news.push(WorkEvent::Failed(words)),
            None => {}
        }
        self.follow_edits(session);
        self.follow_run(session, &mut news);
        news
    }

    /// Has the garment that hangs follow the pattern, one edit after the other.
    fn follow_edits(&mut self, session: &mut Session) {
        match take(&mut self.edit, session) {
            Some(Ok(Ok(edit))) => self.give(edit),
            Some(Ok(Err(why))) => self.stand_still(why.to_string()),
            Some(Err(words)) => self.stand_still(words),
            None => {}
        }
        let (Some(given), Some((project, revision))) = (&self.given, &self.compared) else {
            return;
        };
        let waits = self.edit.is_some() || session.is_previewing();
        if waits || *revision == session.revision() {
            return;
        }
        let now = session.project();
        let is_same = Arc::ptr_eq(&project.pattern, &now.pattern) && project == now;
        let given = given.clone();
        self.compared = Some((now.clone(), session.revision()));
        if !is_same {
            self.edit = Some(on_thread(session, move |session| {
                session.garment_edit(&given)
            }));
        } else if self.standstill.is_none() {
            // A gesture was left: the garment is of this revision, too.
            let mut job = (*given).clone();
            job.revision = session.revision();
            let change = RestChange::Nothing;
            self.give(GarmentEdit { job, change });
        }
    }

    fn give(&mut self, edit: GarmentEdit) {
        let Some(run) = &self.run else {
            let follows = edit.change == RestChange::Nothing;
            self.standstill = (!follows).then(|| STOPPED.to_owned());
            return;
        };
        self.standstill = None;
        self.told = false;
        self.given = Some(Arc::new(edit.job.clone()));
        run.edit(edit);
    }

    fn stand_still(&mut self, why: String) {
        self.standstill = Some(why);
        if let Some(run) = &self.run {
            run.stand_still();
        }
    }

    fn follow_run(&mut self, session: &mut Session, news: &mut Vec<WorkEvent>) {
        let Some(run) = &self.run else { return };
        // Asked before the last frame is taken, or that frame could be missed.
        let finished = run.is_finished();
        if let Some(frame) = run.latest() {
            self.last = Some(Moment::from(&frame));
            news.push(WorkEvent::Frame(frame));
        }
        if !finished {
            self.told = false;
        } else if let Some(words) = run.failure() {
            news.push(WorkEvent::Failed(words));
            self.run = None;
        } else if !self.told && !session.is_previewing() {
            self.told = true;
            match run.result() {
                Some(result) if session.draped().is_none() => {
                    news.extend(session.adopt_drape(result).map(WorkEvent::Finished));
                }
                Some(_) => {}
                None => {
                    let warnings = Some(run.warnings()).filter(|words| !words.is_empty());
                    news.extend(warnings.map(WorkEvent::Warned));
                }
            }
        }
    }
}

/// Why a garment that was stopped is out of date.
const STOPPED: &str = "the drape was stopped; hang it again";

fn on_thread<T: Send + 'static>(
    session: &Session,
    work: impl FnOnce(&mut Session) -> T + Send + 'static,
) -> Receiver<Made<T>> {
    let mut session = session.snapshot();
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let result = work(&mut session);
        // Nobody listens any more if something else was asked for meanwhile.
        let _ = sender.send(Made { session, result });
    });
    receiver
}

/// What a thread has sent, if it has; what it derived goes to the session. A thread that ended
/// without a word is a failure.
fn take<T>(
    receiver: &mut Option<Receiver<Made<T>>>,
    session: &mut Session,
) -> Option<Result<T, String>> {
    let made = match receiver.as_ref()?.try_recv() {
        Ok(made) => {
            session.adopt(made.session);
            Ok(made.result)
        }
        Err(TryRecvError::Empty) => return None,
        Err(TryRecvError::Disconnected) => {
            Err("the work ended unexpectedly: save the pattern and try again".to_owned())
        }
    };
    *receiver = None;
    Some(made)
}
