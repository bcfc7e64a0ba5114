//! Work that must not hold up the window: the mannequin and the meshed garment are made on a
//! thread of their own from a snapshot, then the drape runs live.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use toile_session::{Event, GarmentJob, LiveFrame, LiveRun, Session, SessionError, Stage};

/// What is being made.
#[derive(Default)]
pub struct Making {
    body: Option<Receiver<Made>>,
    garment: Option<Receiver<Made>>,
    run: Option<LiveRun>,
    last: Option<Moment>,
    /// Revision of the project the garment was made from.
    revision: Option<u64>,
}

/// What a thread hands back.
struct Made {
    session: Session,
    result: Result<Option<Box<GarmentJob>>, SessionError>,
}

/// A live drape in a few numbers.
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
}

/// Something that came about since the last look.
pub enum News {
    /// The session knows its mannequin now.
    Body,
    /// The garment is meshed and placed; the drape begins.
    Begun(Box<GarmentJob>),
    /// The cloth has moved.
    Frame(LiveFrame),
    /// The drape has ended by itself. What the session tells of it; nothing when the pattern has
    /// changed since.
    Finished(Vec<Event>),
    /// It cannot be done.
    Failed(String),
}

impl Making {
    /// Begins to make the mannequin of a session's wearer.
    pub fn start_body(&mut self, session: &Session) {
        self.body = Some(on_thread(session, |session| {
            session.mannequin().map(|_| None)
        }));
    }

    /// Begins to make and drape a session's garment. A drape that runs is ended.
    pub fn start_garment(&mut self, session: &Session) {
        self.stop();
        self.last = None;
        self.revision = Some(session.revision());
        self.garment = Some(on_thread(session, |session| {
            session.garment_setup().map(|job| Some(Box::new(job)))
        }));
    }

    /// Ends the drape. What it has reached stays.
    pub fn stop(&mut self) {
        self.garment = None;
        self.run = None;
    }

    /// Forgets the garment.
    pub fn clear(&mut self) {
        self.stop();
        self.last = None;
        self.revision = None;
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

    /// Whether a garment is being meshed or draped.
    pub fn is_draping(&self) -> bool {
        self.garment.is_some() || self.run.is_some()
    }

    /// Whether the garment is still being meshed.
    pub fn is_preparing(&self) -> bool {
        self.garment.is_some()
    }

    /// Whether the mannequin is being made.
    pub fn is_making_body(&self) -> bool {
        self.body.is_some()
    }

    /// Whether anything may change without the person doing something.
    pub fn is_busy(&self) -> bool {
        self.body.is_some() || self.is_draping() && !self.is_paused()
    }

    /// The drape at its newest.
    pub fn moment(&self) -> Option<Moment> {
        self.last
    }

    /// Revision of the project that the garment shown was made from.
    pub fn revision(&self) -> Option<u64> {
        self.revision
    }

    /// What came about since the last look. What threads derived goes to the session.
    pub fn news(&mut self, session: &mut Session) -> Vec<News> {
        let mut news = Vec::new();
        if let Some(made) = take(&mut self.body) {
            news.push(match made {
                Ok(made) => received(made, session).map_or_else(News::Failed, |_| News::Body),
                Err(words) => News::Failed(words),
            });
        }
        if let Some(made) = take(&mut self.garment) {
            match made.and_then(|made| received(made, session)) {
                Ok(Some(job)) => {
                    self.run = Some(LiveRun::start((*job).clone()));
                    news.extend([News::Body, News::Begun(job)]);
                }
                Ok(None) => {}
                Err(words) => news.push(News::Failed(words)),
            }
        }
        self.follow(session, &mut news);
        news
    }

    fn follow(&mut self, session: &mut Session, news: &mut Vec<News>) {
        let Some(run) = &self.run else { return };
        // Asked before the last frame is taken, or that frame could be missed.
        let finished = run.is_finished();
        if let Some(frame) = run.latest() {
            self.last = Some(Moment {
                stage: frame.stage,
                step: frame.step,
                gap: frame.gap,
                residual: frame.residual,
                share: frame.share,
            });
            news.push(News::Frame(frame));
        }
        if finished {
            let adopted = run.result().and_then(|result| session.adopt_drape(result));
            news.push(match (run.failure(), adopted) {
                (Some(words), _) => News::Failed(words),
                (None, events) => News::Finished(events.unwrap_or_default()),
            });
            self.run = None;
        }
    }
}

fn on_thread(
    session: &Session,
    work: impl FnOnce(&mut Session) -> Result<Option<Box<GarmentJob>>, SessionError> + Send + 'static,
) -> Receiver<Made> {
    let mut session = session.snapshot();
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let result = work(&mut session);
        // Nobody listens any more if something else was asked for meanwhile.
        let _ = sender.send(Made { session, result });
    });
    receiver
}

/// What a thread has sent, if it has; a thread that ended without a word is a failure.
fn take(receiver: &mut Option<Receiver<Made>>) -> Option<Result<Made, String>> {
    let made = match receiver.as_ref()?.try_recv() {
        Ok(made) => Ok(made),
        Err(TryRecvError::Empty) => return None,
        Err(TryRecvError::Disconnected) => {
            Err("the work ended unexpectedly: save the pattern and try again".to_owned())
        }
    };
    *receiver = None;
    Some(made)
}

fn received(made: Made, session: &mut Session) -> Result<Option<Box<GarmentJob>>, String> {
    session.adopt(made.session);
    made.result.map_err(|error| error.to_string())
}
