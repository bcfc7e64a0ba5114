//! Which clip is played, and the pose it gives: key poses and clips are blended.

use crate::character::Numbers;
use crate::turn::{Turn, Vector, moved};
use crate::{Character, KeyedClip, RealtimeError};

/// How poses are mixed, between keys and between clips.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blending {
    /// Quaternions evenly mixed: as published, for the least cost. Turns a little slower at both
    /// ends of a large angle than amid it.
    Linear,
    /// Along the arc at an even speed.
    #[default]
    Slerp,
}

/// Turns of all joints and the shift of the roots.
#[derive(Clone, Debug)]
pub(crate) struct JointPose {
    pub turns: Vec<Turn>,
    pub shift: Vector,
}

impl JointPose {
    pub fn rest(joints: usize) -> Self {
        Self {
            turns: vec![Turn::NONE; joints],
            shift: [0.0; 3],
        }
    }

    /// Becomes what lies between two poses: `a` at share 0.
    fn blend(
        &mut self,
        a: (&[Turn], Vector),
        b: (&[Turn], Vector),
        (share, blending): (f32, Blending),
    ) {
        for ((into, a), b) in self.turns.iter_mut().zip(a.0).zip(b.0) {
            *into = match blending {
                _ if a == b => *a,
                Blending::Linear => a.blended_linearly(b, share),
                Blending::Slerp => a.slerped(b, share),
            };
        }
        let gap = std::array::from_fn(|k| b.1[k] - a.1[k]);
        self.shift = moved(a.1, share, gap);
    }
}

/// A clip in columns.
#[derive(Clone, Debug)]
struct Track {
    name: String,
    is_loop: bool,
    times: Vec<f32>,
    shifts: Vec<Vector>,
    /// Turns of all joints of the first key, then of the next.
    turns: Vec<Turn>,
}

impl Track {
    fn new(clip: &KeyedClip, numbers: &Numbers) -> Self {
        let joints = numbers.joints.len();
        let mut turns = vec![Turn::NONE; joints * clip.keys.len()];
        for (key, row) in clip.keys.iter().zip(turns.chunks_mut(joints.max(1))) {
            for (name, vector) in &key.turns {
                row[numbers.joints[&**name]] = Turn::new(*vector);
            }
        }
        Self {
            name: clip.name.clone(),
            is_loop: clip.is_loop,
            times: clip.keys.iter().map(|key| key.time).collect(),
            shifts: clip.keys.iter().map(|key| key.shift).collect(),
            turns,
        }
    }

    fn duration(&self) -> f32 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// A time brought into the clip: round a loop, held at the ends otherwise.
    fn wrapped(&self, time: f32) -> f32 {
        match self.is_loop {
            true => time.rem_euclid(self.duration()),
            false => time.clamp(0.0, self.duration()),
        }
    }

    fn sample(&self, time: f32, blending: Blending, into: &mut JointPose) {
        let joints = into.turns.len();
        let after = self.times.partition_point(|&t| t <= time);
        let low = after.saturating_sub(1);
        let high = after.min(self.times.len() - 1);
        let gap = self.times[high] - self.times[low];
        let share = match gap > 0.0 {
            true => (time - self.times[low]) / gap,
            false => 0.0,
        };
        let key = |k: usize| (&self.turns[k * joints..(k + 1) * joints], self.shifts[k]);
        into.blend(key(low), key(high), (share, blending));
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Playing {
    clip: usize,
    time: f32,
}

/// What a fade comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    Clip(Playing),
    /// The pose that was shown when the fade began.
    Kept,
}

#[derive(Clone, Copy, Debug)]
struct Fade {
    from: Source,
    elapsed: f32,
    length: f32,
}

/// Plays one clip at a time, and two while it fades from one to the next.
#[derive(Clone, Debug)]
pub(crate) struct Player {
    tracks: Vec<Track>,
    playing: Option<Playing>,
    fade: Option<Fade>,
    pub rate: f32,
    pub blending: Blending,
    /// The pose shown.
    pub pose: JointPose,
    kept: JointPose,
    scratch: JointPose,
}

impl Player {
    pub fn new(character: &Character, numbers: &Numbers) -> Self {
        let rest = JointPose::rest(numbers.joints.len());
        let tracks = character.clips.iter();
        Self {
            tracks: tracks.map(|clip| Track::new(clip, numbers)).collect(),
            playing: None,
            fade: None,
            rate: 1.0,
            blending: Blending::default(),
            kept: rest.clone(),
            scratch: rest.clone(),
            pose: rest,
        }
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.tracks.iter().map(|track| &*track.name)
    }

    pub fn playing(&self) -> Option<&str> {
        self.playing.map(|playing| &*self.tracks[playing.clip].name)
    }

    /// Starts a clip, faded into from what is shown. A loop that follows a loop begins at the same
    /// share of its round.
    pub fn start(&mut self, name: &str, fade: f32) -> Result<(), RealtimeError> {
        let clip = self.tracks.iter().position(|track| track.name == name);
        let clip = clip.ok_or_else(|| {
            let known: Vec<&str> = self.names().collect();
            RealtimeError::new(
                "clip",
                format!("there is no {name} among {}", known.join(", ")),
                "start one that the character has",
            )
        })?;
        if !(0.0..=60.0).contains(&fade) {
            return Err(RealtimeError::new(
                "fade",
                format!("{fade} s is no length of a fade"),
                "give 0 to 60 seconds",
            ));
        }
        let from = match (self.playing, self.fade) {
            (Some(playing), None) => Source::Clip(playing),
            _ => Source::Kept,
        };
        if matches!(from, Source::Kept) {
            self.kept.turns.copy_from_slice(&self.pose.turns);
            self.kept.shift = self.pose.shift;
        }
        let next = &self.tracks[clip];
        let phase = self.playing.map_or(0.0, |playing| {
            let old = &self.tracks[playing.clip];
            match old.is_loop && next.is_loop {
                true => playing.time / old.duration(),
                false => 0.0,
            }
        });
        self.playing = Some(Playing {
            clip,
            time: next.wrapped(phase * next.duration()),
        });
        self.fade = (fade > 0.0).then_some(Fade {
            from,
            elapsed: 0.0,
            length: fade,
        });
        Ok(())
    }

    /// Stops: the pose stays as it is.
    pub fn stop(&mut self) {
        self.playing = None;
        self.fade = None;
    }

    /// Goes on by some time (s) and makes the pose.
    pub fn advance(&mut self, dt: f32) {
        let Some(mut playing) = self.playing else {
            return;
        };
        let dt = if dt > 0.0 && dt.is_finite() { dt } else { 0.0 };
        let step = dt * self.rate;
        playing.time = self.tracks[playing.clip].wrapped(playing.time + step);
        self.playing = Some(playing);
        self.tracks[playing.clip].sample(playing.time, self.blending, &mut self.pose);
        let Some(mut fade) = self.fade.take() else {
            return;
        };
        fade.elapsed += dt;
        if fade.elapsed >= fade.length {
            return;
        }
        if let Source::Clip(from) = &mut fade.from {
            let track = &self.tracks[from.clip];
            from.time = track.wrapped(from.time + step);
            track.sample(from.time, self.blending, &mut self.kept);
        }
        // Smooth at both ends, so that joints start and stop without a jerk.
        let s = fade.elapsed / fade.length;
        let share = s * s * (3.0 - 2.0 * s);
        let scratch = &mut self.scratch;
        scratch.turns.copy_from_slice(&self.pose.turns);
        scratch.shift = self.pose.shift;
        let [from, to] = [&self.kept, &*scratch].map(|pose| (&*pose.turns, pose.shift));
        self.pose.blend(from, to, (share, self.blending));
        self.fade = Some(fade);
    }
}
