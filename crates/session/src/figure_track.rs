//! A figure in motion as a scene sees it: the way into its clip, then the clip over the ground, as places of
//! its skin.

use std::sync::Arc;
use toile_body::{Clip, Joint, Mannequin, PlayCommand, PlayError, Player, Pose};
use toile_drape::{Digest, Motion, Track};
use toile_geometry::Vec3;
use toile_interchange::TransformFile;

/// Poses per second of a figure's course (1/s); between two poses joints turn at constant speed.
const RATE: f64 = 240.0;
/// Time that a figure stands before its clip begins (s).
const STANDS: f64 = 0.3;
/// Gap kept between limbs and body (m): room for a cloth of 2 mm on each of the two, 4 mm off the skin.
const LIMB_GAP: f64 = 0.012;

/// Options for playing a clip on a figure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FigureMotion {
    /// Number of rounds of a looped clip after which the figure stops; `None` if it goes on.
    pub strides: Option<f64>,
    /// Speed of playback over that of the clip, 0 to 2 (1).
    pub rate: f64,
    /// Whether the figure travels over the ground, or moves on the spot.
    pub travel: bool,
    /// Rigid motion over time that turns the figure about itself and moves it.
    pub heading: Option<Motion>,
}

/// Skin of a figure over time: poses at even steps from before the start of the scene; the skin is posed on
/// demand.
pub(crate) struct FigureTrack {
    body: Arc<Mannequin>,
    /// The poses; the shift of each root is in metres from where the figure stood.
    course: Clip,
    /// The time of the first pose (s), at most 0.
    start: f64,
    /// Transform of the skin into the scene.
    transform: TransformFile,
    digest: u64,
}

/// The motion of a figure over time, with notes for the user.
pub(crate) struct Course {
    pub track: FigureTrack,
    /// Duration of the lead-in, the way into the clip before time 0 (s).
    pub lead_in: f64,
    /// Time at which the figure has come to rest again (s); `None` if it goes on.
    pub ends: Option<f64>,
    pub notes: Vec<String>,
}

impl FigureTrack {
    /// The course of a body from its sewing pose through a clip, for a duration from time 0 on (s). `step` is
    /// the step of the scene (s): the lead-in takes a whole number of steps.
    ///
    /// # Errors
    /// A rate that is out of range.
    pub fn course(
        body: Arc<Mannequin>,
        clip: Clip,
        asked: &FigureMotion,
        transform: TransformFile,
        (duration, step): (f64, f64),
    ) -> Result<Course, PlayError> {
        let mut notes = clip_notes(&clip);
        let played = played(clip, asked, duration)?;
        let first = played.poses[0].clone();
        let mut lead = Clip::lead_in(&body, &Pose::rest(), &first);
        let begins_there = turn_between(&Pose::rest(), &first) < 1e-6;
        let lead_time = match begins_there {
            true => 0.0,
            // Whole steps of the scene, so that time 0 is the end of one.
            false => ((lead.duration() + STANDS) / step).ceil() * step,
        };
        let before = (lead_time * RATE).round() as usize;
        lead.poses.truncate(before);
        lead.poses.resize(before, first);
        let whole = Clip {
            step: 1.0 / RATE,
            poses: lead.poses.into_iter().chain(played.poses).collect(),
            is_loop: false,
            advance: Vec3::zeros(),
        };
        let cleared = whole.cleared(&body, LIMB_GAP);
        notes.extend(clearing_notes(&cleared, lead_time));
        let mut course = cleared.clip;
        let scale = body.skeleton().leg_length();
        for pose in &mut course.poses {
            pose.shift *= scale;
        }
        let start = -lead_time;
        if let Some(heading) = &asked.heading {
            turn_along(&mut course, start, heading);
        }
        let digest = digest(&body, &course, (start, &transform));
        Ok(Course {
            track: Self {
                body,
                course,
                start,
                transform,
                digest,
            },
            lead_in: lead_time,
            ends: played.ends,
            notes,
        })
    }

    /// The pose at a time (s), its root in metres.
    fn pose(&self, time: f64) -> Pose {
        self.course.at(time - self.start)
    }
}

impl Track for FigureTrack {
    fn positions(&self, time: f64) -> Vec<Vec3> {
        let mut positions = self.body.posed_skin(&self.pose(time)).positions;
        for position in &mut positions {
            *position = self.transform.apply(*position);
        }
        positions
    }

    fn digest(&self) -> u64 {
        self.digest
    }
}

/// Poses of a clip played from time 0 on, with the travel over the ground, and the time at which it comes to
/// rest (s).
struct Played {
    poses: Vec<Pose>,
    ends: Option<f64>,
}

fn played(clip: Clip, asked: &FigureMotion, duration: f64) -> Result<Played, PlayError> {
    let round = clip.duration();
    let is_loop = clip.is_loop;
    let mut player = Player::new(vec![clip], 0)?;
    player.tell(PlayCommand::Rate(asked.rate))?;
    player.tell(PlayCommand::Start)?;
    let tick = 1.0 / RATE;
    let count = (duration * RATE).ceil() as usize + 1;
    let mut poses = Vec::with_capacity(count);
    let (mut ends, mut stopped) = (None, false);
    for k in 0..count {
        let mut pose = player.pose();
        let playback = player.playback().clone();
        if asked.travel {
            pose.shift += playback.travelled();
        }
        poses.push(pose);
        let left = |strides: f64| (strides - playback.rounds()) * round;
        let coming = playback.coming_to_rest();
        let is_over = asked.strides.is_some_and(|strides| left(strides) <= coming);
        if is_loop && is_over && !stopped {
            player.tell(PlayCommand::Stop)?;
            stopped = true;
        }
        let at_rest = stopped && playback.rate() == 0.0;
        let at_end = !is_loop && playback.rounds() >= 1.0;
        if ends.is_none() && (at_rest || at_end || round == 0.0) {
            ends = Some(k as f64 * tick);
        }
        player.advance(tick);
    }
    Ok(Played { poses, ends })
}

/// The largest turn of a joint from one pose to another (rad).
fn turn_between(a: &Pose, b: &Pose) -> f64 {
    let turns = Joint::ALL.map(|joint| a.rotation(joint).angle_to(&b.rotation(joint)));
    turns.into_iter().fold(0.0, f64::max)
}

/// Note on a joint of a clip that turns too fast to be shown as it is.
fn clip_notes(clip: &Clip) -> Vec<String> {
    let next = |k: usize| match clip.is_loop {
        true => Some((k + 1) % clip.poses.len()),
        false => (k + 1 < clip.poses.len()).then_some(k + 1),
    };
    let speeds = (0..clip.poses.len()).filter_map(|k| {
        let turn = turn_between(&clip.poses[k], &clip.poses[next(k)?]);
        Some((turn / clip.step, k))
    });
    let fastest = speeds.max_by(|a, b| a.0.total_cmp(&b.0));
    let too_fast = fastest.filter(|(speed, _)| *speed > toile_body::FASTEST_TURN);
    let words = too_fast.map(|(speed, k)| {
        format!(
            "the clip turns a joint at {speed:.0} rad/s at {:.2} s: it is played slower there, no joint faster than {} rad/s",
            k as f64 * clip.step,
            toile_body::FASTEST_TURN
        )
    });
    words.into_iter().collect()
}

/// Notes on how limbs were kept off the body.
fn clearing_notes(cleared: &toile_body::Cleared, lead_in: f64) -> Vec<String> {
    let mut notes = Vec::new();
    let [shoulder, hip] = cleared.largest_turn.map(f64::to_degrees);
    if shoulder > 0.0 || hip > 0.0 {
        notes.push(format!(
            "limbs are kept off the body: shoulders turned outward by up to {shoulder:.0} degrees, hips by {hip:.0}"
        ));
    }
    if let (Some(first), count) = (cleared.unclear.first(), cleared.unclear.len()) {
        notes.push(format!(
            "limbs come too near to the body at {count} moments all the same, the first at {:.2} s",
            first - lead_in
        ));
    }
    notes
}

/// Turns the course by the keys of a rigid motion: the figure turns about itself, goes the way that it then
/// faces, and is moved by the translation.
fn turn_along(course: &mut Clip, start: f64, heading: &Motion) {
    let Some(first) = course.poses.first().map(|pose| pose.shift) else {
        return;
    };
    let (mut before, mut at) = (first, first);
    for (k, pose) in course.poses.iter_mut().enumerate() {
        let time = start + k as f64 * course.step;
        let turn = heading.pose(time).rotation;
        let own = pose.shift;
        at += turn * (own - before);
        before = own;
        pose.shift = at + heading.translation(time);
        let root = pose.rotation(Joint::HumanoidRoot);
        pose.set(
            Joint::HumanoidRoot,
            nalgebra::UnitQuaternion::from_rotation_matrix(&turn) * root,
        );
    }
}

fn digest(body: &Mannequin, course: &Clip, (start, transform): (f64, &TransformFile)) -> u64 {
    let mut digest = Digest::new();
    digest.vectors(&[Vec3::new(start, course.step, 0.0)]);
    digest.vectors(&body.skin().positions);
    for pose in &course.poses {
        digest.vectors(&[pose.shift]);
        let turns = Joint::ALL.map(|joint| pose.rotation(joint));
        let halves = turns.map(|turn| [turn.imag(), Vec3::repeat(turn.scalar())]);
        digest.vectors(halves.as_flattened());
    }
    let TransformFile {
        translation,
        rotation,
        scale,
        ..
    } = transform;
    if (*translation, *rotation, *scale) != ([0.0; 3], [0.0; 3], 1.0) {
        digest.numbers(translation);
        digest.numbers(rotation);
        digest.numbers(&[*scale]);
    }
    digest.value()
}
