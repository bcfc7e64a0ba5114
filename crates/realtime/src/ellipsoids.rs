//! A character's ellipsoids in motion.

use crate::player::{Blending, Player};
use crate::turn::{Frame, Turn, Vector, difference};
use crate::{Character, RealtimeError};

/// One character in motion: its joints' frames and its ellipsoids. Matrices are made anew only
/// for joints that moved, themselves or by one they hang on.
#[derive(Clone, Debug)]
pub struct Ellipsoids {
    parents: Vec<Option<usize>>,
    /// From the joint above to each joint, at rest (m).
    offsets: Vec<Vector>,
    rest: Vec<Vector>,
    player: Player,
    /// The pose that `frames` show.
    shown: Vec<Turn>,
    shown_roots: Frame,
    moved: Vec<bool>,
    frames: Vec<Frame>,
    place: Frame,
    /// Ellipsoids in the order of their groups: which of the character each is.
    pub(crate) order: Vec<usize>,
    row_of: Vec<usize>,
    pub(crate) joints: Vec<usize>,
    pub(crate) groups: Vec<usize>,
    pub(crate) semi_axes: Vec<Vector>,
    /// Which groups each group sees, itself too, by bits.
    pub(crate) touching: Vec<u64>,
    local: Vec<Frame>,
    pub(crate) posed: Vec<Frame>,
}

impl Ellipsoids {
    /// A character at rest, at the origin.
    ///
    /// # Errors
    /// What [`Character::check`] finds.
    pub fn new(character: &Character) -> Result<Self, RealtimeError> {
        character.check()?;
        let numbers = character.numbers()?;
        let rest: Vec<Vector> = character.joints.iter().map(|joint| joint.at).collect();
        let above = |name: &Option<String>| name.as_ref().map(|name| numbers.joints[&**name]);
        let parents: Vec<_> = character.joints.iter().map(|j| above(&j.parent)).collect();
        let offsets = parents.iter().zip(&rest).map(|(parent, at)| match parent {
            Some(parent) => difference(*at, rest[*parent]),
            None => *at,
        });
        let listed = &character.ellipsoids;
        let group = |k: usize| numbers.groups[&*listed[k].group];
        let mut order: Vec<usize> = (0..listed.len()).collect();
        order.sort_by_key(|&k| group(k));
        let mut row_of = vec![0; order.len()];
        for (row, &k) in order.iter().enumerate() {
            row_of[k] = row;
        }
        let mut touching: Vec<u64> = (0..numbers.groups.len()).map(|g| 1 << g).collect();
        for (g, group) in character.groups.iter().enumerate() {
            for name in &group.touches {
                let other = numbers.groups[&**name];
                touching[g] |= 1 << other;
                touching[other] |= 1 << g;
            }
        }
        let joints: Vec<usize> = order
            .iter()
            .map(|&k| numbers.joints[&*listed[k].joint])
            .collect();
        let local = order.iter().zip(&joints).map(|(&k, &joint)| Frame {
            rows: Turn::new(listed[k].turn).matrix(),
            at: difference(listed[k].at, rest[joint]),
        });
        let mut made = Self {
            offsets: offsets.collect(),
            player: Player::new(character, &numbers),
            shown: vec![Turn::NONE; rest.len()],
            shown_roots: Frame::NONE,
            moved: vec![true; rest.len()],
            frames: vec![Frame::NONE; rest.len()],
            place: Frame::NONE,
            groups: order.iter().map(|&k| group(k)).collect(),
            semi_axes: order.iter().map(|&k| listed[k].semi_axes).collect(),
            local: local.collect(),
            posed: vec![Frame::NONE; order.len()],
            parents,
            rest,
            order,
            row_of,
            joints,
            touching,
        };
        made.pose_joints(true);
        Ok(made)
    }

    /// Number of ellipsoids.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none: never, as a character has one at least.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The names of the clips.
    pub fn clips(&self) -> impl Iterator<Item = &str> {
        self.player.names()
    }

    /// The clip that is played.
    pub fn playing(&self) -> Option<&str> {
        self.player.playing()
    }

    /// Starts a clip, faded into within some time (s) from what is shown. A loop after a loop
    /// goes on at the same share of its round.
    ///
    /// # Errors
    /// A clip that is not there, a length that is none.
    pub fn start(&mut self, clip: &str, fade: f32) -> Result<(), RealtimeError> {
        self.player.start(clip, fade)
    }

    /// Stops: the pose stays as it is.
    pub fn stop(&mut self) {
        self.player.stop();
    }

    /// How fast clips are played: a ratio of 0 to 4, held within.
    pub fn set_rate(&mut self, rate: f32) {
        self.player.rate = if rate.is_finite() {
            rate.clamp(0.0, 4.0)
        } else {
            1.0
        };
    }

    /// How poses are mixed.
    pub fn set_blending(&mut self, blending: Blending) {
        self.player.blending = blending;
    }

    /// Puts the character somewhere, turned about the vertical from its rest (m, rad). A place
    /// that is not finite changes nothing.
    pub fn set_place(&mut self, at: [f32; 3], heading: f32) {
        if at.iter().all(|x| x.is_finite()) && heading.is_finite() {
            self.place = Frame {
                rows: Turn::new([0.0, heading, 0.0]).matrix(),
                at,
            };
        }
    }

    /// Goes on by some time (s) and poses the ellipsoids. Returns how many matrices were made anew.
    pub fn advance(&mut self, dt: f32) -> usize {
        self.player.advance(dt);
        self.pose_joints(false)
    }

    fn pose_joints(&mut self, all: bool) -> usize {
        let pose = &self.player.pose;
        let roots = self.place.after(&Frame {
            at: pose.shift,
            ..Frame::NONE
        });
        let roots_moved = all || roots != self.shown_roots;
        self.shown_roots = roots;
        for (k, turn) in pose.turns.iter().enumerate() {
            let above = self.parents[k];
            let carried = above.map_or(roots_moved, |parent| self.moved[parent]);
            self.moved[k] = carried || *turn != self.shown[k];
            if !self.moved[k] {
                continue;
            }
            self.shown[k] = *turn;
            let step = Frame {
                rows: turn.matrix(),
                at: self.offsets[k],
            };
            let outer = above.map_or(roots, |parent| self.frames[parent]);
            self.frames[k] = outer.after(&step);
        }
        let mut count = 0;
        for (row, &joint) in self.joints.iter().enumerate() {
            if self.moved[joint] {
                self.posed[row] = self.frames[joint].after(&self.local[row]);
                count += 1;
            }
        }
        count
    }

    /// From an ellipsoid's axes to the world, by its number in the character (m); none beyond the
    /// last. A host hangs the character's visible parts on it.
    pub fn transform(&self, ellipsoid: usize) -> Option<Frame> {
        self.row_of.get(ellipsoid).map(|&row| self.posed[row])
    }

    /// Semi-axes of an ellipsoid (m).
    pub fn semi_axes(&self, ellipsoid: usize) -> Option<[f32; 3]> {
        self.row_of.get(ellipsoid).map(|&row| self.semi_axes[row])
    }

    /// How the joints moved from rest: each maps places at rest to the world, in the order of the
    /// character's joints. A host's skin is blended from them.
    pub fn motions(&self) -> impl Iterator<Item = Frame> {
        let pairs = self.frames.iter().zip(&self.rest);
        pairs.map(|(frame, rest)| {
            frame.after(&Frame {
                at: rest.map(|x| -x),
                ..Frame::NONE
            })
        })
    }

    pub(crate) fn frames(&self) -> &[Frame] {
        &self.frames
    }
}
