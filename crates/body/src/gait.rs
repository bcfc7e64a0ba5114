//! Our own clips: walk and run, whose feet stand still on the ground they go over, and two standing poses.

use crate::curve::smooth_step;
use crate::leg::{FootPlace, LEFT_LEG, REACH, RIGHT_LEG, length, stand};
use crate::{Clip, Joint, Pose, Skeleton};
use nalgebra::UnitQuaternion;
use std::f64::consts::{PI, TAU};
use toile_geometry::Vec3;

/// Number of poses of a stride: so many that a standing foot stays in place although poses are slerped.
const FRAMES: usize = 48;

impl Clip {
    /// The program's own walk: one stride of 1.1 s, on the spot; the left heel strikes at phase 0.
    pub fn walk(skeleton: &Skeleton) -> Self {
        Self::cycle(skeleton, &WALK)
    }

    /// The program's own run: one stride of 0.72 s, on the spot, with the phase of [`Clip::walk`].
    pub fn run(skeleton: &Skeleton) -> Self {
        Self::cycle(skeleton, &RUN)
    }

    fn cycle(skeleton: &Skeleton, gait: &Gait) -> Self {
        let height = gait.height(skeleton);
        let poses = (0..FRAMES).map(|k| gait.pose(skeleton, height, k as f64 / FRAMES as f64));
        Self {
            step: gait.duration / FRAMES as f64,
            poses: poses.collect(),
            is_loop: true,
            advance: Vec3::new(0.0, 0.0, gait.speed * gait.duration),
        }
    }

    /// Standing at ease: the feet side by side under the hips, the arms hanging.
    pub fn stand(skeleton: &Skeleton) -> Self {
        Self::still(standing(skeleton, 0.7, 0.0))
    }

    /// Standing astride: the feet apart, the arms held away from the body.
    pub fn astride(skeleton: &Skeleton) -> Self {
        Self::still(standing(skeleton, 1.4, 0.35))
    }

    fn still(pose: Pose) -> Self {
        Self {
            step: 1.0,
            poses: vec![pose],
            is_loop: false,
            advance: Vec3::zeros(),
        }
    }
}

/// A pose on both feet: `apart` is 0 with the feet under the hips, 1 as far apart as at rest; `raised` is the
/// angle (rad) between the arms and hanging arms.
fn standing(skeleton: &Skeleton, apart: f64, raised: f64) -> Pose {
    let scale = skeleton.leg_length();
    let mut pose = Pose::rest();
    let feet = [LEFT_LEG, RIGHT_LEG].map(|leg| {
        let [hip, rest] = [leg[0], leg[2]].map(|joint| skeleton.centre(joint));
        let x = hip.x + (rest.x - hip.x) * apart;
        (leg, Vec3::new(x, rest.y, rest.z))
    });
    let lowest = feet.map(|(leg, ankle)| highest_hip(skeleton, leg, ankle));
    pose.shift.y = lowest[0].min(lowest[1]).min(0.0);
    for (leg, ankle) in feet {
        let foot = FootPlace {
            ankle,
            pitch: 0.0,
            toes: 0.0,
        };
        stand(skeleton, &mut pose, leg, &foot);
    }
    for side in SIDES {
        let angles = ArmAngles {
            forward: 0.02,
            bend: 0.12,
            raised,
        };
        angles.set(skeleton, &mut pose, side);
    }
    pose.shift /= scale;
    pose
}

/// Largest height of the root over its rest position (m) with which a leg reaches a position of the ankle
/// (m).
fn highest_hip(skeleton: &Skeleton, leg: [Joint; 4], ankle: Vec3) -> f64 {
    let hip = skeleton.centre(leg[0]);
    let reach = REACH * length(skeleton, leg);
    let level2 = (ankle.x - hip.x).powi(2) + (ankle.z - hip.z).powi(2);
    ankle.y + (reach * reach - level2).max(0.0).sqrt() - hip.y
}

/// A side of the body: its leg, shoulder and elbow, and its sign along x.
#[derive(Clone, Copy)]
struct Side {
    leg: [Joint; 4],
    arm: [Joint; 2],
    sign: f64,
    /// Delay relative to the left side, as a share of a stride.
    later: f64,
}

const SIDES: [Side; 2] = [
    Side {
        leg: LEFT_LEG,
        arm: [Joint::LShoulder, Joint::LElbow],
        sign: 1.0,
        later: 0.0,
    },
    Side {
        leg: RIGHT_LEG,
        arm: [Joint::RShoulder, Joint::RElbow],
        sign: -1.0,
        later: 0.5,
    },
];

/// Angles of an arm (rad): swung forward, bent at the elbow, raised sideways from hanging.
struct ArmAngles {
    forward: f64,
    bend: f64,
    raised: f64,
}

impl ArmAngles {
    fn set(&self, skeleton: &Skeleton, pose: &mut Pose, side: Side) {
        let about = |axis: Vec3, angle: f64| UnitQuaternion::new(axis * angle);
        let [shoulder, elbow] = side.arm;
        // Arms are lowered from their rest position until they hang, but not into the trunk.
        let arm = skeleton.centre(elbow) - skeleton.centre(shoulder);
        let down = (-arm.y).atan2(arm.x * side.sign);
        let lowered = (skeleton.hang() - down).max(0.0) - self.raised;
        let hang = about(Vec3::z(), -side.sign * lowered);
        pose.set(shoulder, about(Vec3::x(), -self.forward) * hang);
        // The elbow bends about the axis across the hanging arm, expressed in the arm at rest.
        let across = hang.inverse() * Vec3::x();
        pose.set(elbow, about(across, -self.bend));
    }
}

/// A wave over a stride: mean, then cosine and sine at one and at two periods per stride (rad).
type Wave = [f64; 5];

/// A gait: a foot stands still on the ground for a share of the stride and swings forward in the rest; arms
/// and trunk follow waves. Lengths are divided by the leg length; the right side is half a stride later.
struct Gait {
    /// Duration of the stride (s).
    duration: f64,
    /// Speed over the ground, in leg lengths (1/s).
    speed: f64,
    /// Share of the stride in which a foot is on the ground.
    duty: f64,
    /// Distance of the ankle before the hip when its foot touches the ground.
    ahead: f64,
    /// Pitch of the foot at strike and when it leaves the ground (rad): positive with the heel above the
    /// toes.
    pitch: [f64; 2],
    /// Shares of the standing time at which the foot begins to lie flat, and at which the heel leaves the
    /// ground.
    flat: [f64; 2],
    /// Height by which the swinging ankle is lifted above the straight path, and the share of the swing at
    /// which it is highest.
    lift: [f64; 2],
    /// Distance of the feet from the median plane: 0 under the hips, 1 as far apart as at rest.
    apart: f64,
    /// Half the rise and fall of the hips in a step, and the phase of their first lowest position.
    bounce: [f64; 2],
    /// Bend of the elbow (rad).
    elbow: Wave,
    /// Swing of the arm forward at the shoulder (rad).
    shoulder: Wave,
    /// Largest turn of the pelvis to one side (rad); the chest turns to the other.
    twist: f64,
    /// Forward lean of the trunk (rad).
    lean: f64,
}

/// Speed, step, time on the ground and motion of the foot are those of level walking (Winter 1991; Murray,
/// Drought and Kory 1964): 1.15 m/s with a leg of 0.82 m, a foot on the ground for three fifths of the
/// stride, the hips lowest while both feet are on the ground.
const WALK: Gait = Gait {
    duration: 1.1,
    speed: 1.4,
    duty: 0.61,
    ahead: 0.38,
    pitch: [-0.32, 0.95],
    flat: [0.16, 0.56],
    lift: [0.07, 0.35],
    apart: 0.65,
    bounce: [0.018, 0.06],
    elbow: [0.30, -0.12, 0.0, 0.0, 0.0],
    shoulder: [0.02, -0.30, 0.0, 0.0, 0.0],
    twist: 0.07,
    lean: 0.03,
};

/// A run of 2.2 m/s with a leg of 0.82 m: a foot is on the ground for a third of the stride, so that twice a
/// stride neither foot is, and the hips are lowest over the standing foot (Novacheck 1998).
const RUN: Gait = Gait {
    duration: 0.72,
    speed: 2.7,
    duty: 0.34,
    ahead: 0.2,
    pitch: [-0.12, 0.85],
    flat: [0.2, 0.5],
    lift: [0.09, 0.34],
    apart: 0.65,
    bounce: [0.03, 0.16],
    elbow: [0.9, -0.14, 0.0, 0.0, 0.0],
    shoulder: [-0.03, -0.38, 0.0, 0.0, 0.0],
    twist: 0.12,
    lean: 0.12,
};

fn wave(w: &Wave, phase: f64) -> f64 {
    let [once, twice] = [TAU * phase, 2.0 * TAU * phase];
    w[0] + w[1] * once.cos() + w[2] * once.sin() + w[3] * twice.cos() + w[4] * twice.sin()
}

impl Gait {
    /// Rise of the root over its mean height, divided by the leg length (1).
    fn bob(&self, phase: f64) -> f64 {
        let [half, lowest] = self.bounce;
        -half * (2.0 * TAU * (phase - lowest)).cos()
    }

    /// Mean height of the root over its rest position (m): as high as the standing legs reach.
    fn height(&self, skeleton: &Skeleton) -> f64 {
        let scale = skeleton.leg_length();
        let phases = (0..8 * FRAMES).map(|k| k as f64 / (8 * FRAMES) as f64);
        let highest = phases.filter(|&phase| phase < self.duty).map(|phase| {
            let foot = self.foot(skeleton, SIDES[0], phase);
            highest_hip(skeleton, LEFT_LEG, foot.ankle) - self.bob(phase) * scale
        });
        highest.fold(0.0, f64::min)
    }

    /// Pitch of the standing foot (rad), positive with the heel up, at a share of the standing time.
    fn standing_pitch(&self, share: f64) -> f64 {
        let ([strike, off], [flat, rise]) = (self.pitch, self.flat);
        match share {
            s if s < flat => strike * (1.0 - smooth_step(s / flat)),
            s if s < rise => 0.0,
            s => {
                let up = (s - rise) / (1.0 - rise);
                off * up * up
            }
        }
    }

    /// A foot on the ground at a phase since its strike; the root stays at its rest position and the ground
    /// moves back.
    fn standing_foot(&self, skeleton: &Skeleton, side: Side, phase: f64) -> FootPlace {
        let scale = skeleton.leg_length();
        let [hip, _, ankle, toes] = side.leg.map(|joint| skeleton.centre(joint));
        let (heel, ball) = ([-0.3, 1.0]).map(|share| share * (toes.z - ankle.z)).into();
        let pitch = self.standing_pitch(phase / self.duty);
        // The foot first rolls about the heel, at the end about the ball of the foot.
        let pivot = Vec3::new(0.0, -ankle.y, if pitch < 0.0 { heel } else { ball });
        let turned = UnitQuaternion::new(Vec3::x() * pitch) * -pivot;
        let strike = hip.z + self.ahead * scale;
        let back = self.speed * self.duration * phase * scale;
        let flat = Vec3::new(
            hip.x + (ankle.x - hip.x) * self.apart,
            ankle.y,
            strike - back,
        );
        FootPlace {
            ankle: flat + pivot + turned,
            pitch,
            toes: pitch.max(0.0),
        }
    }

    /// Position of a foot at a phase since its strike, 0 to 1, with the root at its rest position.
    fn foot(&self, skeleton: &Skeleton, side: Side, phase: f64) -> FootPlace {
        if phase < self.duty {
            return self.standing_foot(skeleton, side, phase);
        }
        let at = |phase: f64| self.standing_foot(skeleton, side, phase);
        let swing = 1.0 - self.duty;
        let share = (phase - self.duty) / swing;
        // The foot leaves and meets the ground at the speed at which the ground moves.
        let tiny = 1e-4;
        let [off, strike] = [at(self.duty), at(0.0)];
        let [before, after] = [at(self.duty - tiny), at(tiny)];
        let per = swing / tiny;
        let [height, top] = self.lift;
        // A hump with its top at the given share.
        let bent = share.powf(0.5_f64.ln() / top.ln());
        let lift = height * skeleton.leg_length() * (PI * bent).sin().powi(2);
        let ankle = hermite(
            [off.ankle, strike.ankle],
            [off.ankle - before.ankle, after.ankle - strike.ankle].map(|d| d * per),
            share,
        );
        let pitch = hermite(
            [off, strike].map(|foot| Vec3::x() * foot.pitch),
            [off.pitch - before.pitch, after.pitch - strike.pitch].map(|d| Vec3::x() * d * per),
            share,
        );
        FootPlace {
            ankle: ankle + Vec3::y() * lift,
            pitch: pitch.x,
            toes: off.toes * (1.0 - smooth_step(2.0 * share)),
        }
    }

    fn pose(&self, skeleton: &Skeleton, height: f64, phase: f64) -> Pose {
        let about = |axis: Vec3, angle: f64| UnitQuaternion::new(axis * angle);
        let scale = skeleton.leg_length();
        let mut pose = Pose::rest();
        let twist = self.twist * (TAU * phase).cos();
        pose.set(Joint::Sacroiliac, about(Vec3::y(), -twist));
        pose.set(
            Joint::Vl5,
            about(Vec3::y(), 2.0 * twist) * about(Vec3::x(), self.lean),
        );
        pose.set(
            Joint::Vc4,
            about(Vec3::y(), -twist) * about(Vec3::x(), -self.lean),
        );
        pose.shift = Vec3::new(0.0, height + self.bob(phase) * scale, 0.0);
        for side in SIDES {
            let own = (phase + side.later).rem_euclid(1.0);
            let foot = self.foot(skeleton, side, own);
            stand(skeleton, &mut pose, side.leg, &foot);
            let arm = ArmAngles {
                forward: wave(&self.shoulder, own),
                bend: wave(&self.elbow, own).max(0.0),
                raised: 0.0,
            };
            arm.set(skeleton, &mut pose, side);
        }
        pose.shift /= scale;
        pose
    }
}

/// Cubic (Hermite) interpolation between two values with given slopes per whole interval, at a share of it.
fn hermite([from, to]: [Vec3; 2], [leaving, arriving]: [Vec3; 2], s: f64) -> Vec3 {
    let (s2, s3) = (s * s, s * s * s);
    let b = 3.0 * s2 - 2.0 * s3;
    from * (1.0 - b) + to * b + leaving * (s3 - 2.0 * s2 + s) + arriving * (s3 - s2)
}
