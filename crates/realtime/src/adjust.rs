//! The two adjustments of a frame: by gravity and by shape.

use crate::Ellipsoids;
use crate::garment::{Ball, Garment};
use crate::lanes::LANES;
use crate::turn::{Frame, difference, dot, moved};

/// Earth's mean acceleration (m/s2).
const GRAVITY: f32 = 9.81;

/// Fastest motion against the parent ellipsoid (m/s): a second of free fall is not waited for.
const FASTEST: f32 = 4.0;

/// Longest step of the explicit scheme (s): a longer frame is taken as this.
const MAX_STEP: f32 = 1.0 / 20.0;

/// Largest stiffness over mass times the square of the step: with some six springs at a vertex,
/// each of weight 2, symplectic Euler stays stable below 4 over 12 to 16.
const STABLE: f32 = 0.2;

/// Rounds after which edges that do not become fewer beyond their bounds by a tenth are left: bounds
/// and ellipsoids cannot hold together.
const STALLED: usize = 8;

/// Distance from its target, beyond its slack, from which a vertex has gone astray (m).
const STRAY: f32 = 0.03;

/// In each frame one block of so many finds its parents anew: cloth slides over an ellipsoid in
/// some tenths of a second, so eight frames are soon enough.
const PARENT_TURNS: usize = 8;

impl Garment {
    /// Lets the garment hang: vertices go with their parents, gravity and springs move them by one
    /// explicit step of Euler's, edges are brought within their bounds, vertices out of the
    /// ellipsoids, and parents are found anew. The ellipsoids are those it was made on, `dt` is the
    /// time since the last frame (s); others change nothing.
    pub fn adjust_by_gravity(&mut self, ellipsoids: &Ellipsoids, dt: f32) {
        if !self.begin(ellipsoids) {
            return;
        }
        let dt = held(dt);
        let frames = ellipsoids.frames().iter().zip(&self.last);
        for (motion, (now, last)) in self.motions.iter_mut().zip(frames) {
            *motion = now.after(&last.inverse());
        }
        self.carry();
        self.follows_targets = false;
        if dt > 0.0 {
            self.step(dt);
        }
        set_motions(&mut self.motions, ellipsoids.frames(), &self.bind_inverse);
        self.bring_targets(None);
        self.hold_near_targets();
        self.bring_within(self.settings.friction);
        if dt > 0.0 {
            self.take_velocities(dt);
        }
        self.find_parents();
        self.end(ellipsoids);
    }

    /// Fits the garment closely: vertices go with the joints of their rest shape and are drawn to
    /// it, edges are brought within their bounds, vertices out of the ellipsoids. There are no
    /// forces and no velocities. The ellipsoids are those it was made on, `dt` is the time since
    /// the last frame (s); others change nothing.
    pub fn adjust_by_shape(&mut self, ellipsoids: &Ellipsoids, dt: f32) {
        if !self.begin(ellipsoids) {
            return;
        }
        if !self.follows_targets {
            self.parents.copy_from_slice(&self.first_parents);
            set_motions(&mut self.motions, &self.last, &self.bind_inverse);
            self.bring_targets(None);
            self.velocities
                .0
                .iter_mut()
                .for_each(|column| column.fill(0.0));
            self.follows_targets = true;
        }
        set_motions(&mut self.motions, ellipsoids.frames(), &self.bind_inverse);
        self.bring_targets(Some((-held(dt) / self.settings.draw).exp()));
        self.bring_within(0.0);
        self.end(ellipsoids);
    }

    /// Takes the ellipsoids where they are now. False for those of another character.
    fn begin(&mut self, ellipsoids: &Ellipsoids) -> bool {
        let is_own =
            ellipsoids.len() == self.field.len() && ellipsoids.frames().len() == self.last.len();
        if is_own {
            self.field.follow(ellipsoids);
            self.balls.fill(Ball::NOWHERE);
        }
        is_own
    }

    fn end(&mut self, ellipsoids: &Ellipsoids) {
        self.last.copy_from_slice(ellipsoids.frames());
        self.adjusted += 1;
    }

    /// Moves vertices and velocities with the joints that their rest shape hangs on. With that of
    /// the nearest ellipsoid alone, as published, cloth would be torn where two joints meet.
    fn carry(&mut self) {
        for (k, (joints, &share)) in self.homes.joints.iter().zip(&self.homes.share).enumerate() {
            let [first, second] = joints.map(|joint| &self.motions[usize::from(joint)]);
            let (place, velocity) = (self.places.at(k), self.velocities.at(k));
            let mut carried = first.applied(place);
            if share > 0.0 {
                let gap = difference(second.applied(place), carried);
                carried = moved(carried, share, gap);
            }
            self.places.set(k, carried);
            self.velocities.set(k, first.turned(velocity));
        }
        self.starts.copy_from(&self.places);
    }

    /// One step of symplectic Euler: velocities by gravity and springs, then places.
    fn step(&mut self, dt: f32) {
        let stiffness = self.settings.stiffness.min(STABLE / (dt * dt));
        self.edges
            .pull(&self.places, stiffness * dt, &mut self.velocities);
        let kept = (1.0 - self.settings.damping * dt).max(0.0);
        for (axis, (places, velocities)) in self
            .places
            .0
            .iter_mut()
            .zip(&mut self.velocities.0)
            .enumerate()
        {
            let fall = if axis == 1 { GRAVITY * dt } else { 0.0 };
            for (place, velocity) in places.iter_mut().zip(velocities) {
                *velocity = kept * (*velocity - fall);
                *place += dt * *velocity;
            }
        }
    }

    /// The velocities against the parents that the frame came to. Bounds and contacts take energy
    /// and give none: a vertex becomes no faster than the step made it, or cloth that is hauled in
    /// round after round would fly.
    fn take_velocities(&mut self, dt: f32) {
        for k in 0..self.order.len() {
            let (place, start) = (self.places.at(k), self.starts.at(k));
            let found = difference(place, start).map(|x| x / dt);
            let given = self.velocities.at(k);
            let [squared, most] = [found, given].map(|v| dot(v, v).min(FASTEST * FASTEST));
            let scale = match squared > most {
                true => (most / squared).sqrt(),
                false => 1.0,
            };
            self.velocities.set(k, found.map(|x| x * scale));
        }
    }

    /// Brings the targets to the joints' motions, and the vertices after them with a share of
    /// their distance kept.
    fn bring_targets(&mut self, kept: Option<f32>) {
        for (k, (joints, &share)) in self.homes.joints.iter().zip(&self.homes.share).enumerate() {
            let rest = self.bind.at(k);
            let [first, second] = joints.map(|joint| &self.motions[usize::from(joint)]);
            let mut target = first.applied(rest);
            if share > 0.0 {
                let other = second.applied(rest);
                target = std::array::from_fn(|i| target[i] + share * (other[i] - target[i]));
            }
            if let Some(kept) = kept {
                let (place, old) = (self.places.at(k), self.targets.at(k));
                let gap = std::array::from_fn(|i| place[i] - old[i]);
                self.places.set(k, moved(target, kept, gap));
            }
            self.targets.set(k, target);
        }
    }

    /// Brings vertices as near to their targets as they may be away from them.
    fn hold_near_targets(&mut self) {
        for (k, &slack) in self.slack.iter().enumerate() {
            let (place, target) = (self.places.at(k), self.targets.at(k));
            let gap = difference(place, target);
            let squared = dot(gap, gap);
            if squared > slack * slack {
                self.places
                    .set(k, moved(target, slack / squared.sqrt(), gap));
            }
        }
    }

    /// Puts vertices out of the ellipsoids and edges within their bounds, in turn, until both hold,
    /// the rounds are over or help no more; the ellipsoids have the last word.
    fn bring_within(&mut self, friction: f32) {
        self.edges.open_all();
        self.has_moved.fill(true);
        self.push_out(friction);
        let (mut fewest, mut stalled) = (usize::MAX, 0);
        for _ in 0..self.settings.rounds {
            let beyond = self.limit_edges();
            if beyond == 0 {
                break;
            }
            self.limit_edges();
            self.push_out(friction);
            self.rounds += 1;
            let is_fewer = beyond < fewest - fewest / 10;
            (fewest, stalled) = match is_fewer {
                true => (beyond, 0),
                false => (fewest, stalled + 1),
            };
            if stalled == STALLED {
                break;
            }
        }
        self.return_strays();
    }

    /// Puts back what has been put out of the ellipsoids on another side than its target is.
    fn return_strays(&mut self) {
        for k in 0..self.order.len() {
            let (place, target) = (self.places.at(k), self.targets.at(k));
            let gap = difference(place, target);
            let most = self.slack[k] + STRAY;
            if dot(gap, gap) <= most * most {
                continue;
            }
            self.parents[k] = self.first_parents[k];
            let (parent, own) = (self.parents[k] as usize, self.own_group(k));
            let back = match self.field.contains_among(target, own) {
                true => self.field.exit(parent, target, (self.outward(k), own)),
                false => target,
            };
            self.places.set(k, back);
        }
    }

    /// One sweep over the edges; how many were beyond their bounds.
    fn limit_edges(&mut self) -> usize {
        let bounds = self.bounds();
        let Self {
            edges,
            places,
            has_moved,
            ..
        } = self;
        edges.limit(bounds, places, |k| has_moved[k / LANES] = true)
    }

    /// Finds the parents of the blocks whose turn it is, among the groups that each sees.
    fn find_parents(&mut self) {
        for block in (self.turn..self.places.0[0].len() / LANES).step_by(PARENT_TURNS) {
            let first = block * LANES;
            let own: [u64; LANES] = std::array::from_fn(|l| self.own_group(first + l));
            let beside = std::array::from_fn(|l| self.sees(first + l) & !own[l]);
            let rows = self
                .field
                .nearest_rows(&self.places.block(block), (&own, &beside));
            for (parent, row) in self.parents[first..first + LANES].iter_mut().zip(rows) {
                *parent = row as u32;
            }
        }
        self.turn = (self.turn + 1) % PARENT_TURNS;
    }
}

/// A step that the scheme bears (s).
fn held(dt: f32) -> f32 {
    match dt > 0.0 {
        true => dt.min(MAX_STEP),
        false => 0.0,
    }
}

fn set_motions(motions: &mut [Frame], now: &[Frame], rest_inverse: &[Frame]) {
    for (motion, (frame, inverse)) in motions.iter_mut().zip(now.iter().zip(rest_inverse)) {
        *motion = frame.after(inverse);
    }
}
