//! The player of clips: it shows a clip at a rate and fades to another, without jumps.

use crate::curve::smooth_step;
use crate::{Clip, Joint, Pose};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// A command to a player.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PlayCommand {
    /// Starts the clock.
    Start,
    /// Stops the clock; the figure keeps its pose.
    Stop,
    /// Fades to another clip within a time (s). Of several such commands given during a fade, only the last
    /// is carried out, after the fade.
    Change {
        /// Number of the clip.
        clip: usize,
        /// Duration of the fade (s).
        fade: f64,
    },
    /// Sets the rate of the clock, from 0 to [`MAX_RATE`].
    Rate(f64),
}

/// Largest rate of a player (1); at a rate of 1 a clip is as fast as it was made.
pub const MAX_RATE: f64 = 2.0;
/// Longest fade (s).
pub const MAX_FADE: f64 = 60.0;
/// Largest angular speed of a joint that a player shows (rad/s); where a clip or a fade is faster, its clock
/// is slowed down. Runners' knees turn at 20 rad/s (Novacheck 1998).
pub const FASTEST_TURN: f64 = 25.0;
/// Time that the clock takes from rest to a rate of 1 (s).
const CLOCK_START: f64 = 0.2;
/// Shortest fade (s): shorter ones are lengthened to it.
const SHORTEST_FADE: f64 = 0.1;
/// Halvings in the search for the longest step of the clock without too fast a turn.
const HALVINGS: usize = 12;

/// Reason why a player refuses a command.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlayError {
    /// There is no such clip.
    #[error("clip {asked} is not there: there are {count}, counted from 0")]
    NoClip {
        /// Number of the clip asked for.
        asked: usize,
        /// Number of clips.
        count: usize,
    },
    /// A rate or a fade is out of range or not a number.
    #[error("a {what} of {value} is out of range: give 0 to {most}")]
    OutOfRange {
        /// Name of the value.
        what: &'static str,
        /// Value given.
        value: f64,
        /// Largest value allowed.
        most: f64,
    },
}

/// A clip that is shown, and the position in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Shown {
    clip: usize,
    /// Number of rounds played so far; for a clip that is no loop, the share of the clip.
    phase: f64,
}

/// A fade to another clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fade {
    to: Shown,
    /// Duration of the fade (s).
    length: f64,
    /// Time of the fade that has passed (s).
    gone: f64,
}

/// State of a player: plain data, to save it and to continue from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Playback {
    shown: Shown,
    fade: Option<Fade>,
    /// Clip and fade that wait for the end of the present fade.
    waiting: Option<(usize, f64)>,
    /// Requested rate of the clock (1).
    asked: f64,
    /// Whether the clock runs; if not, it comes to rest or is at rest.
    goes: bool,
    /// Present rate of the clock (1).
    rate: f64,
    /// Distance over the ground so far, divided by the leg length (1).
    travelled: Vec3,
}

impl Playback {
    /// The state at the start of a clip, with the clock at rest.
    fn new(clip: usize) -> Self {
        Self {
            shown: Shown { clip, phase: 0.0 },
            fade: None,
            waiting: None,
            asked: 1.0,
            goes: false,
            rate: 0.0,
            travelled: Vec3::zeros(),
        }
    }

    /// Rounds so far of the clip that is shown or being faded in.
    pub fn rounds(&self) -> f64 {
        self.fade.map_or(self.shown, |fade| fade.to).phase
    }

    /// Number of the clip that is shown or being faded in.
    pub fn clip(&self) -> usize {
        self.fade.map_or(self.shown, |fade| fade.to).clip
    }

    /// Distance over the ground so far, divided by the leg length (1).
    pub fn travelled(&self) -> Vec3 {
        self.travelled
    }

    /// Clip time that still passes until rest if the clock is stopped now (s).
    pub fn coming_to_rest(&self) -> f64 {
        0.5 * CLOCK_START * self.rate * self.rate
    }

    /// Present rate of the clock.
    pub fn rate(&self) -> f64 {
        self.rate
    }
}

/// A player of some clips.
#[derive(Clone, Debug, PartialEq)]
pub struct Player {
    clips: Vec<Clip>,
    playback: Playback,
}

impl Player {
    /// A player at the start of a clip, with its clock at rest.
    ///
    /// # Errors
    /// [`PlayError::NoClip`] for a clip that does not exist.
    pub fn new(clips: Vec<Clip>, first: usize) -> Result<Self, PlayError> {
        let player = Self {
            clips,
            playback: Playback::new(first),
        };
        player.check_clip(first)?;
        Ok(player)
    }

    /// A player of the same clips that continues from a saved state.
    ///
    /// # Errors
    /// [`PlayError`] for a clip that does not exist, or numbers out of range.
    pub fn resumed(clips: Vec<Clip>, playback: Playback) -> Result<Self, PlayError> {
        let fade = playback.fade.map(|fade| fade.to.clip);
        let player = Self { clips, playback };
        let waiting = player.playback.waiting.map(|(clip, _)| clip);
        for clip in [Some(player.playback.shown.clip), fade, waiting] {
            clip.map_or(Ok(()), |clip| player.check_clip(clip))?;
        }
        within("rate", player.playback.rate, MAX_RATE)?;
        within("rate", player.playback.asked, MAX_RATE)?;
        if let Some(fade) = player.playback.fade {
            within("fade", fade.length, MAX_FADE)?;
        }
        Ok(player)
    }

    /// State of the player.
    pub fn playback(&self) -> &Playback {
        &self.playback
    }

    fn check_clip(&self, asked: usize) -> Result<(), PlayError> {
        match self.clips.len() {
            count if asked < count => Ok(()),
            count => Err(PlayError::NoClip { asked, count }),
        }
    }

    /// Accepts a command, which takes effect from the next step on.
    ///
    /// # Errors
    /// [`PlayError`] for a clip that does not exist, or a rate or a fade out of range; the player then stays
    /// unchanged.
    pub fn tell(&mut self, command: PlayCommand) -> Result<(), PlayError> {
        match command {
            PlayCommand::Start => self.playback.goes = true,
            PlayCommand::Stop => self.playback.goes = false,
            PlayCommand::Rate(rate) => self.playback.asked = within("rate", rate, MAX_RATE)?,
            PlayCommand::Change { clip, fade } => {
                self.check_clip(clip)?;
                let fade = within("fade", fade, MAX_FADE)?;
                match self.playback.fade {
                    Some(_) => self.playback.waiting = Some((clip, fade)),
                    None => self.begin_fade(clip, fade),
                }
            }
        }
        Ok(())
    }

    /// Begins to fade to a clip: from a loop to a loop at the same phase, else from the start of the new
    /// clip.
    fn begin_fade(&mut self, clip: usize, length: f64) {
        let Playback { shown, .. } = self.playback;
        let both_loop = [shown.clip, clip].iter().all(|&c| self.clips[c].is_loop);
        let phase = if both_loop { shown.phase } else { 0.0 };
        self.playback.fade = Some(Fade {
            to: Shown { clip, phase },
            length: length.max(SHORTEST_FADE),
            gone: 0.0,
        });
    }

    /// Advances by a time (s). No joint turns faster than [`FASTEST_TURN`]: where one would, the clocks of
    /// clip and fade are slowed down.
    pub fn advance(&mut self, time: f64) {
        let from = self.pose();
        let most = FASTEST_TURN * time;
        let whole = self.later(time, 1.0);
        let too_fast = |playback: &Playback| {
            let to = self.pose_of(playback);
            let turns = Joint::ALL.map(|j| from.rotation(j).angle_to(&to.rotation(j)));
            turns.into_iter().fold(0.0, f64::max) > most
        };
        self.playback = match too_fast(&whole) {
            false => whole,
            true => {
                let (mut slow, mut fast) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (slow + fast);
                    match too_fast(&self.later(time, middle)) {
                        true => fast = middle,
                        false => slow = middle,
                    }
                }
                self.later(time, slow)
            }
        };
        if self.playback.fade.is_none()
            && let Some((clip, fade)) = self.playback.waiting.take()
        {
            self.begin_fade(clip, fade);
        }
    }

    /// State after a time (s) in which the clocks of clip and fade advance only by `share` of that time.
    fn later(&self, time: f64, share: f64) -> Playback {
        let mut next = self.playback.clone();
        let aim = if next.goes { next.asked } else { 0.0 };
        let most = time / CLOCK_START;
        next.rate += (aim - next.rate).clamp(-most, most);
        let clock = next.rate * time * share;
        let Some(mut fade) = next.fade else {
            let clip = &self.clips[next.shown.clip];
            next.travelled += clip.travelled(clock);
            next.shown.phase = moved(clip, next.shown.phase, clock / clip.duration());
            return next;
        };
        let [old, new] = [next.shown.clip, fade.to.clip].map(|clip| &self.clips[clip]);
        let mixed = fade.share();
        fade.gone += time * share;
        next.travelled += old.travelled(clock) * (1.0 - mixed) + new.travelled(clock) * mixed;
        // Two loops run at the same phase, so that their feet stay in step.
        let [mut per_old, mut per_new] = [old, new].map(|clip| clock / clip.duration());
        if old.is_loop && new.is_loop {
            let round = old.duration() + (new.duration() - old.duration()) * mixed;
            (per_old, per_new) = (clock / round, clock / round);
        }
        next.shown.phase = moved(old, next.shown.phase, per_old);
        fade.to.phase = moved(new, fade.to.phase, per_new);
        next.fade = Some(fade);
        if fade.gone >= fade.length {
            next.shown = fade.to;
            next.fade = None;
        }
        next
    }

    /// The present pose, without the distance over the ground. The shift of the root is divided by the leg
    /// length.
    pub fn pose(&self) -> Pose {
        self.pose_of(&self.playback)
    }

    fn pose_of(&self, playback: &Playback) -> Pose {
        let of = |shown: Shown| {
            let clip = &self.clips[shown.clip];
            clip.at(shown.phase * clip.duration())
        };
        match &playback.fade {
            None => of(playback.shown),
            Some(fade) => of(playback.shown).blended(&of(fade.to), fade.share()),
        }
    }
}

impl Fade {
    /// Share of the new clip in the pose, 0 to 1.
    fn share(&self) -> f64 {
        smooth_step(self.gone / self.length)
    }
}

/// Phase of a clip after some more rounds; a clip that is no loop ends at its last pose.
fn moved(clip: &Clip, phase: f64, rounds: f64) -> f64 {
    match (clip.is_loop, rounds.is_finite()) {
        (_, false) => phase,
        (true, true) => phase + rounds,
        (false, true) => (phase + rounds).min(1.0),
    }
}

fn within(what: &'static str, value: f64, most: f64) -> Result<f64, PlayError> {
    match (0.0..=most).contains(&value) {
        true => Ok(value),
        false => Err(PlayError::OutOfRange { what, value, most }),
    }
}
