//! Work on other threads: the mannequin and the meshed garment are made from a snapshot, then the drape
//! runs live. A draped garment follows the edits of its pattern; the change to its simulation is computed
//! on another thread too. If the garment cannot follow, because its wearer, its cloth or a garment worn with
//! it changed, it is draped anew automatically; of several changes meanwhile only the newest counts.
//!
//! # Decided with
//! - [`toile_session::LiveRun`]: the run;
//! - [`toile_session::GarmentEdit`], [`toile_session::CannotFollow`]: how the garment follows an edit;
//! - [`crate::app::background_work::BackgroundWork::follow_edits`],
//!   [`crate::app::background_work::BackgroundWork::hang`]: edits handed to the run; the garment hung anew;
//! - [`crate::app::background_work::BackgroundWork::status`], [`crate::app::garment_pane`]: why it is out of
//!   date; the words;
//! - [`toile_session::Session::snapshot`] (`snapshot.rs`), [`crate::app::job::Job`]: work on a copy, on a
//!   thread;
//! - [`crate::app::ToileApp::drape`] (`perform.rs`): the command of the user.

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
    /// Project and revision of the mannequin that is shown or being made.
    body_of: Option<(Project, u64)>,
    garment: Option<Receiver<Made<Result<GarmentJob, SessionError>>>>,
    /// Whether the garment that is being meshed is outdated; the garment of the newest project is meshed
    /// next.
    is_overtaken: bool,
    /// Reason why the garment is being draped from the start.
    reason: Reason,
    edit: Option<Receiver<Made<Result<GarmentEdit, CannotFollow>>>>,
    run: Option<LiveRun>,
    last: Option<Moment>,
    /// The garment that is simulated, as the last edit left it.
    given: Option<Arc<GarmentJob>>,
    /// Project and revision that the garment was last made for or compared with.
    compared: Option<(Project, u64)>,
    /// Reason why the garment cannot follow the present project.
    standstill: Option<String>,
    /// Whether the report on the garment at rest was shown.
    told: bool,
    /// Whether the displayed cloth is to be removed.
    is_undressed: bool,
}

/// Reason why a garment is draped from the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Reason {
    /// The user asked for the drape.
    #[default]
    Asked,
    /// The draped garment could not follow a change of the pattern; the body is the same.
    Change,
    /// The wearer changed.
    Wearer,
}

/// Result of a thread, with the session that the thread worked on.
struct Made<T> {
    session: Session,
    result: T,
}

/// Status of the garment in the 3D view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GarmentStatus {
    /// No garment.
    Nothing,
    /// The garment is being meshed.
    Preparing,
    /// The garment of the present pattern is moving.
    Moving,
    /// The garment of the present pattern is paused.
    Held,
    /// The garment of the present pattern was stopped before it was at rest.
    Stopped,
    /// The garment of the present pattern is at rest.
    AtRest,
    /// The garment belongs to an earlier state of the pattern; the text says why.
    OutOfDate(String),
    /// No garment: the one that was draped before cannot be made from the present pattern; the text says
    /// why.
    NotMade(String),
}

/// Main numbers of a live drape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Stage of the computation.
    pub stage: Stage,
    /// Number of steps taken.
    pub step: usize,
    /// Largest seam gap (m).
    pub gap: f64,
    /// Net force divided by weight (1).
    pub residual: f64,
    /// Progress of the drape, 0..=1.
    pub share: f64,
    /// Revision of the project that the last frame shows.
    revision: u64,
    /// Whether the drape can take an edit now.
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

/// Event of the work since the last frame.
pub enum WorkEvent {
    /// The session has its mannequin now.
    Body,
    /// The cloth on show must be removed: possibly it no longer fits the present body.
    Undressed,
    /// The garment is meshed and placed round its mannequin; the drape begins.
    Begun(Arc<GarmentJob>),
    /// The cloth has moved.
    Frame(LiveFrame),
    /// The drape has come to rest and was handed to the session; these are the session's events.
    Finished(Vec<Event>),
    /// The garment has come to rest after an edit, with shortcomings; the texts describe these.
    Warned(Vec<String>),
    /// The work failed; the text says why.
    Failed(String),
}

impl BackgroundWork {
    /// Compares the garment with the present project of a session: if the wearer changed, the garment is
    /// draped anew. Does nothing during the preview of a gesture.
    pub fn follow(&mut self, session: &Session) {
        if session.is_previewing() {
            return;
        }
        let Some((project, revision)) = &self.compared else {
            return;
        };
        let now = session.project();
        let is_new = *revision != session.revision();
        if is_new && !project.has_same_body(now) {
            self.hang(session, Reason::Wearer);
        } else if is_new && self.is_not_made() && project != now {
            self.hang(session, Reason::Change);
        }
    }

    /// Makes the mannequin of a session's wearer on another thread, unless that mannequin is on show
    /// already, or a garment is being made, which brings its own mannequin.
    pub fn follow_body(&mut self, session: &Session) {
        let is_known = |of: &(Project, u64)| of.1 == session.revision();
        let waits = self.body.is_some() || self.garment.is_some() || session.is_previewing();
        if waits || self.body_of.as_ref().is_some_and(is_known) {
            return;
        }
        let now = session.project();
        let known = self.body_of.as_ref();
        let is_same = known.is_some_and(|(project, _)| project.has_same_body(now));
        self.body_of = Some((now.clone(), session.revision()));
        if !is_same {
            self.body = Some(on_thread(session, |session| {
                session.mannequin().map(|_| ())
            }));
        }
    }

    /// Begins to make and drape the garment of a session, in place of a running drape.
    pub fn start_garment(&mut self, session: &Session) {
        self.hang(session, Reason::Asked);
    }

    /// Drapes the garment of a session from the start. If another garment is being meshed, that is finished
    /// first; of several requests meanwhile only the newest is kept.
    fn hang(&mut self, session: &Session, reason: Reason) {
        // Cloth of an earlier wearer is still on show: this stays the reason until the cloth is replaced.
        let stays = self.garment.is_some() && self.reason == Reason::Wearer;
        self.reason = if stays { Reason::Wearer } else { reason };
        self.leave_run();
        self.compared = Some((session.project().clone(), session.revision()));
        self.is_overtaken = self.garment.is_some();
        if !self.is_overtaken {
            self.garment = Some(on_thread(session, Session::garment_setup));
        }
    }

    /// Ends the drape and keeps the present shape of the cloth. A garment that is still being meshed is
    /// discarded.
    pub fn stop(&mut self) {
        if self.garment.take().is_some() {
            self.is_undressed = true;
            self.compared = None;
        }
        self.is_overtaken = false;
        self.end_run();
    }

    /// Removes the draped garment, and discards one that is being meshed.
    pub fn clear(&mut self) {
        self.stop();
        self.leave_run();
        self.compared = None;
    }

    /// Ends the drape and forgets its garment.
    fn leave_run(&mut self) {
        self.end_run();
        self.edit = None;
        self.last = None;
        self.given = None;
        self.standstill = None;
        self.told = false;
    }

    /// Ends the thread of the drape without waiting for the end of its present step.
    fn end_run(&mut self) {
        if let Some(run) = self.run.take() {
            run.stop();
            std::thread::spawn(move || drop(run));
        }
    }

    /// Pauses the drape, or resumes it.
    pub fn toggle_pause(&mut self) {
        match &self.run {
            Some(run) if run.is_paused() => run.resume(),
            Some(run) => run.pause(),
            None => {}
        }
    }

    /// Whether the drape is paused.
    pub fn is_paused(&self) -> bool {
        self.run.as_ref().is_some_and(LiveRun::is_paused)
    }

    /// Whether a garment is being meshed or draped, or is paused.
    pub fn is_draping(&self) -> bool {
        self.garment.is_some() || self.is_moving() || self.is_paused()
    }

    /// Whether the mannequin is being made.
    pub fn is_making_body(&self) -> bool {
        self.body.is_some()
    }

    /// Whether the displayed cloth belongs to an earlier project.
    pub fn is_out_of_date(&self) -> bool {
        let is_replaced = self.garment.is_some() && self.reason != Reason::Asked;
        is_replaced || matches!(self.status(), GarmentStatus::OutOfDate(_))
    }

    /// Whether the displayed cloth was draped on the body of an earlier wearer.
    pub fn is_on_another_body(&self) -> bool {
        self.garment.is_some() && self.reason == Reason::Wearer
    }

    /// Whether the garment that was draped before cannot be made from the present pattern.
    fn is_not_made(&self) -> bool {
        let works = self.garment.is_some() || self.given.is_some();
        !works && self.standstill.is_some()
    }

    /// Whether anything can change without user input.
    pub fn is_busy(&self) -> bool {
        let works = self.body.is_some() || self.garment.is_some() || self.edit.is_some();
        works || self.is_moving()
    }

    /// Whether the cloth is moving.
    fn is_moving(&self) -> bool {
        let stands = self.standstill.is_some() && self.last.is_some_and(|last| last.takes_edits);
        let moves = |run: &LiveRun| !run.is_finished() && !run.is_paused();
        !stands && self.run.as_ref().is_some_and(moves)
    }

    /// The newest numbers of the drape.
    pub fn moment(&self) -> Option<Moment> {
        self.last
    }

    /// Verdict on the garment at rest.
    pub fn verdict(&self) -> Option<Verdict> {
        self.run.as_ref()?.verdict()
    }

    /// Status of the garment on show.
    pub fn status(&self) -> GarmentStatus {
        if self.garment.is_some() {
            return GarmentStatus::Preparing;
        }
        let (Some(given), Some(last)) = (&self.given, self.last) else {
            let why = self.standstill.clone();
            return why.map_or(GarmentStatus::Nothing, GarmentStatus::NotMade);
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

    /// Events since the last call. Values that threads computed are stored in the session.
    pub fn news(&mut self, session: &mut Session) -> Vec<WorkEvent> {
        let mut news = Vec::new();
        self.follow(session);
        match take(&mut self.body, session) {
            Some(Ok(made)) => match made {
                // The wearer has changed meanwhile: this mannequin is discarded.
                _ if !self.is_of_wearer(session) => {}
                Ok(()) => news.push(WorkEvent::Body),
                Err(error) => news.push(WorkEvent::Failed(error.to_string())),
            },
            Some(Err(words)) => news.push(WorkEvent::Failed(words)),
            None => {}
        }
        self.follow_setup(session, &mut news);
        if std::mem::take(&mut self.is_undressed) {
            self.body_of = None;
            news.push(WorkEvent::Undressed);
        }
        self.follow_edits(session);
        self.follow_run(session, &mut news);
        news
    }

    /// Whether the mannequin that was made fits the session's wearer.
    fn is_of_wearer(&self, session: &Session) -> bool {
        let known = self.body_of.as_ref();
        known.is_some_and(|(project, _)| project.has_same_body(session.project()))
    }

    /// Begins to drape a garment that has been meshed; or, if it is outdated, meshes the newest one.
    fn follow_setup(&mut self, session: &mut Session, news: &mut Vec<WorkEvent>) {
        let Some(made) = take(&mut self.garment, session) else {
            return;
        };
        if std::mem::take(&mut self.is_overtaken) {
            self.compared = Some((session.project().clone(), session.revision()));
            self.garment = Some(on_thread(session, Session::garment_setup));
            return;
        }
        match made.and_then(|made| made.map_err(|error| error.to_string())) {
            Ok(job) => {
                self.run = Some(LiveRun::start(job.clone()));
                let job = Arc::new(job);
                self.given = Some(job.clone());
                self.body_of.clone_from(&self.compared);
                news.push(WorkEvent::Begun(job));
            }
            Err(words) => {
                if self.reason == Reason::Asked {
                    self.compared = None;
                    news.push(WorkEvent::Failed(words));
                } else {
                    self.standstill = Some(words);
                }
                self.is_undressed = true;
            }
        }
    }

    /// Applies edits of the pattern to the draped garment, one after the other.
    fn follow_edits(&mut self, session: &mut Session) {
        match take(&mut self.edit, session) {
            Some(Ok(Ok(edit))) => self.give(edit),
            Some(Ok(Err(why))) if why.asks_for_another() => self.hang(session, Reason::Change),
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
            // The project is the same as before, as after a cancelled gesture: the garment is valid for
            // this revision, too.
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
        // Must be read before the latest frame is taken: otherwise the last frame could be missed.
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

/// Reason why a garment that was stopped is out of date.
const STOPPED: &str = "the drape was stopped; drape it again";

fn on_thread<T: Send + 'static>(
    session: &Session,
    work: impl FnOnce(&mut Session) -> T + Send + 'static,
) -> Receiver<Made<T>> {
    let mut session = session.snapshot();
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let result = work(&mut session);
        // The receiver is gone if other work was requested meanwhile.
        let _ = sender.send(Made { session, result });
    });
    receiver
}

/// Takes the result that a thread has sent, if any, and stores in `session` the values that the thread
/// derived. A thread that ended without a result counts as failed.
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
