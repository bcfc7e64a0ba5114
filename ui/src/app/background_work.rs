//! Work on other threads: the mannequin and the meshed garment are made from a snapshot, then the drape runs
//! live. A garment that hangs follows the edits of its pattern; how it follows is found on another thread
//! too. Where it cannot follow, since its wearer, cloth or fellow garments are others now, it is hung anew by
//! itself; of several changes that come meanwhile only the newest counts.

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
    /// The project whose mannequin is shown or being made.
    body_of: Option<(Project, u64)>,
    garment: Option<Receiver<Made<Result<GarmentJob, SessionError>>>>,
    /// Whether what is being meshed is too old: the garment of the newest project is meshed after it.
    is_overtaken: bool,
    /// Why the garment that is being meshed is hung.
    reason: Reason,
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
    /// Whether the cloth that is shown is to be taken off.
    is_undressed: bool,
}

/// Why a garment is hung.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Reason {
    /// It was asked for.
    #[default]
    Asked,
    /// The one that hung could not follow a change, on the same body.
    Change,
    /// Its wearer is another.
    Wearer,
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
    /// No garment, for the one that hung cannot be made any more, and why.
    NotMade(String),
}

/// The main numbers of a live drape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// What is being done.
    pub stage: Stage,
    /// Steps taken.
    pub step: usize,
    /// Largest seam gap (m).
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
    /// The cloth that is shown belongs on no body any more.
    Undressed,
    /// The garment is meshed and placed round its mannequin; the drape begins.
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
    /// Brings the work up to a session's present project: a garment whose wearer is another now is hung anew. A
    /// gesture that is being shown is waited for.
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

    /// Has the mannequin of a session's wearer made where it is another than the one shown, and no garment brings
    /// it.
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

    /// Begins to make and drape a session's garment. A drape that runs is ended.
    pub fn start_garment(&mut self, session: &Session) {
        self.hang(session, Reason::Asked);
    }

    /// Hangs a garment from the start. While another is meshed it waits, and only the newest that waits counts.
    fn hang(&mut self, session: &Session, reason: Reason) {
        // Cloth on the body of another wearer stays that until it is replaced.
        let stays = self.garment.is_some() && self.reason == Reason::Wearer;
        self.reason = if stays { Reason::Wearer } else { reason };
        self.leave_run();
        self.compared = Some((session.project().clone(), session.revision()));
        self.is_overtaken = self.garment.is_some();
        if !self.is_overtaken {
            self.garment = Some(on_thread(session, Session::garment_setup));
        }
    }

    /// Ends the drape. What it has reached stays; while a garment is meshed nothing is reached yet.
    pub fn stop(&mut self) {
        if self.garment.take().is_some() {
            self.is_undressed = true;
            self.compared = None;
        }
        self.is_overtaken = false;
        self.end_run();
    }

    /// Forgets the garment.
    pub fn clear(&mut self) {
        self.stop();
        self.leave_run();
        self.compared = None;
    }

    /// Forgets the garment that hangs.
    fn leave_run(&mut self) {
        self.end_run();
        self.edit = None;
        self.last = None;
        self.given = None;
        self.standstill = None;
        self.told = false;
    }

    /// Ends the thread of the drape without waiting for its present step.
    fn end_run(&mut self) {
        if let Some(run) = self.run.take() {
            run.stop();
            std::thread::spawn(move || drop(run));
        }
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

    /// Whether the cloth that is shown is that of an earlier project.
    pub fn is_out_of_date(&self) -> bool {
        let is_replaced = self.garment.is_some() && self.reason != Reason::Asked;
        is_replaced || matches!(self.status(), GarmentStatus::OutOfDate(_))
    }

    /// Whether the cloth that is shown hung on another body than the wearer's.
    pub fn is_on_another_body(&self) -> bool {
        self.garment.is_some() && self.reason == Reason::Wearer
    }

    /// Whether a garment that hung cannot be made any more.
    fn is_not_made(&self) -> bool {
        let works = self.garment.is_some() || self.given.is_some();
        !works && self.standstill.is_some()
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

    /// What came about since the last look. What threads derived goes to the session.
    pub fn news(&mut self, session: &mut Session) -> Vec<WorkEvent> {
        let mut news = Vec::new();
        self.follow(session);
        match take(&mut self.body, session) {
            Some(Ok(made)) => match made {
                // Another mannequin is wanted by now.
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

    /// Whether the mannequin that was made is that of the session's wearer.
    fn is_of_wearer(&self, session: &Session) -> bool {
        let known = self.body_of.as_ref();
        known.is_some_and(|(project, _)| project.has_same_body(session.project()))
    }

    /// Begins to drape a garment that was meshed, or has a newer one meshed.
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

    /// Has the garment that hangs follow the pattern, one edit after the other.
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
const STOPPED: &str = "the drape was stopped; drape it again";

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
