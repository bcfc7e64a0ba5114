//! Clips without limbs in one another: shoulders and hips are turned outward, no further than it takes.
//!
//! Cloth between two walls of skin that cross has no place to be, so clips are cleared before cloth is
//! simulated on them.

use crate::{Clip, Joint, Mannequin, Part, Pose};
use nalgebra::UnitQuaternion;
use rayon::prelude::*;
use toile_geometry::{MovingSurface, TriangleMesh, Vec3};

/// A clip in which limbs keep a gap from the rest of the body, with the turns that were needed for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleared {
    /// The clip. If no limb had to be turned, it is identical to the given one, bit by bit.
    pub clip: Clip,
    /// The largest turn of a shoulder and of a hip (rad).
    pub largest_turn: [f64; 2],
    /// Times at which limbs come nearer than the gap even with the largest turn (s).
    pub unclear: Vec<f64>,
}

/// Largest outward turn of a shoulder (rad): 25 degrees. Beyond it a figure no longer moves as the clip
/// shows.
const MAX_SHOULDER: f64 = 25.0 * std::f64::consts::PI / 180.0;
/// Largest outward turn of a hip (rad): 8 degrees, for the same reason.
const MAX_HIP: f64 = 8.0 * std::f64::consts::PI / 180.0;
/// Distance, as a share of stature, from the junction of two parts within which skin is not checked: there it
/// touches in any pose.
const JOINED: f64 = 0.075;
/// Least number of poses checked per second.
const LOOKS: f64 = 30.0;
/// Time before and after a checked pose (s): the pose gets the largest turn within this time, and the turns
/// are then averaged over it.
const SPREAD: f64 = 0.1;
/// Number of halvings in the search for the least turn: they find a shoulder's turn to 0.8 degrees.
const HALVINGS: usize = 5;
/// Largest distance at which the skin of another part is looked for (m). A limb that lies deeper in another
/// part passed through smaller depths at earlier moments, where it was found.
const DEEPEST: f64 = 0.08;

/// Limbs that are turned: the left arm, the right arm, both legs alike.
const CHANNELS: [Channel; 3] = [
    Channel {
        joints: &[(Joint::LShoulder, 1.0)],
        limb: Part::LeftArm,
        most: MAX_SHOULDER,
    },
    Channel {
        joints: &[(Joint::RShoulder, -1.0)],
        limb: Part::RightArm,
        most: MAX_SHOULDER,
    },
    Channel {
        joints: &[(Joint::LHip, 1.0), (Joint::RHip, -1.0)],
        limb: Part::LeftLeg,
        most: MAX_HIP,
    },
];

/// Joints that are turned outward together, by the angle `most` (rad) at most, until the skin of `limb` keeps
/// its gap.
struct Channel {
    /// The joints, each with the sign of an outward turn about z.
    joints: &'static [(Joint, f64)],
    limb: Part,
    most: f64,
}

impl Channel {
    fn turn(&self, pose: &mut Pose, angle: f64) {
        for &(joint, sign) in self.joints {
            let outward = UnitQuaternion::new(Vec3::z() * (sign * angle));
            pose.set(joint, outward * pose.rotation(joint));
        }
    }

    /// Whether the limb has to keep away from a part.
    fn keeps_off(&self, part: Part) -> bool {
        match self.limb {
            Part::LeftLeg => part == Part::RightLeg,
            limb => part != limb,
        }
    }
}

/// The skin that is checked for a channel: `vertices` of its limb, away from the junctions with other parts,
/// and `others`, the surface of the parts that the limb keeps away from.
struct Watched {
    channel: &'static Channel,
    vertices: Vec<u32>,
    others: MovingSurface,
    /// For each vertex of `others`, its number in the skin.
    of_skin: Vec<u32>,
}

impl Watched {
    fn new(body: &Mannequin, channel: &'static Channel) -> Self {
        let skin = body.skin();
        let parts = body.part_of_triangle();
        let mut first: Vec<Option<Part>> = vec![None; skin.positions.len()];
        let mut joined = Vec::new();
        for (triangle, &part) in skin.triangles.iter().zip(parts) {
            for &v in triangle {
                let known = first[v as usize].get_or_insert(part);
                if *known != part {
                    joined.push(skin.positions[v as usize]);
                }
            }
        }
        let reach = JOINED * body.levels().crown;
        let is_off = |v: &u32| {
            let p = skin.positions[*v as usize];
            joined.iter().all(|q| (p - q).norm() > reach)
        };
        let of_limb = |v: &u32| first[*v as usize] == Some(channel.limb);
        let all = 0..skin.positions.len() as u32;
        let mut number = vec![u32::MAX; skin.positions.len()];
        let (mut mesh, mut of_skin) = (TriangleMesh::default(), Vec::new());
        for (triangle, _) in skin
            .triangles
            .iter()
            .zip(parts)
            .filter(|(_, p)| channel.keeps_off(**p))
        {
            mesh.triangles.push(triangle.map(|v| {
                let known = &mut number[v as usize];
                if *known == u32::MAX {
                    *known = of_skin.len() as u32;
                    of_skin.push(v);
                    mesh.positions.push(skin.positions[v as usize]);
                }
                *known
            }));
        }
        Self {
            channel,
            vertices: all.filter(of_limb).filter(is_off).collect(),
            others: MovingSurface::new(&mesh),
            of_skin,
        }
    }

    /// Whether the limb keeps a gap (m) in a pose.
    fn is_clear(&self, body: &Mannequin, pose: &Pose, gap: f64) -> bool {
        let skin = body.posed_skin(pose).positions;
        let places: Vec<Vec3> = self.of_skin.iter().map(|&v| skin[v as usize]).collect();
        let mut others = self.others.clone();
        others.set_step(&places, &places);
        self.vertices.iter().all(|&v| {
            let closest = others.closest_point(skin[v as usize], 1.0, DEEPEST, None);
            closest.is_none_or(|closest| closest.signed_distance >= gap)
        })
    }

    /// Least outward turn (rad) with which the limb keeps a gap (m) in a pose; `None` if the largest is not
    /// enough.
    fn least_turn(&self, body: &Mannequin, pose: &Pose, gap: f64) -> Option<f64> {
        let is_clear = |angle: f64| {
            let mut turned = pose.clone();
            self.channel.turn(&mut turned, angle);
            self.is_clear(body, &turned, gap)
        };
        if is_clear(0.0) {
            return Some(0.0);
        }
        let (mut low, mut high) = (0.0, self.channel.most);
        if !is_clear(high) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match is_clear(middle) {
                true => high = middle,
                false => low = middle,
            }
        }
        Some(high)
    }
}

impl Clip {
    /// The clip with shoulders and hips turned outward, pose by pose, by the least angle with which arms keep
    /// a gap (m) from all other parts and legs from each other, away from their junctions; at most 25 degrees
    /// at shoulders and 8 at hips. Each turn becomes the largest within a tenth of a second before and after
    /// it, and the turns are then smoothed, so that nothing jumps; a loop stays a loop.
    pub fn cleared(&self, body: &Mannequin, gap: f64) -> Cleared {
        let every = ((1.0 / (LOOKS * self.step.max(1e-6))).floor() as usize).max(1);
        let looks: Vec<usize> = (0..self.poses.len()).step_by(every).collect();
        let mut clip = self.clone();
        let mut largest_turn = [0.0_f64; 2];
        let mut unclear: Vec<usize> = Vec::new();
        // Hips first, as arms keep away from the legs in their turned position.
        for channel in CHANNELS.iter().rev() {
            let watched = Watched::new(body, channel);
            let found: Vec<Option<f64>> = looks
                .par_iter()
                .map(|&k| {
                    let mut pose = clip.poses[k].clone();
                    pose.shift *= body.skeleton().leg_length();
                    watched.least_turn(body, &pose, gap)
                })
                .collect();
            let failed = looks.iter().zip(&found).filter(|(_, turn)| turn.is_none());
            unclear.extend(failed.map(|(k, _)| *k));
            let turns: Vec<f64> = found.iter().map(|t| t.unwrap_or(channel.most)).collect();
            if turns.iter().all(|turn| *turn == 0.0) {
                continue;
            }
            let most = turns.iter().copied().fold(0.0, f64::max);
            let kind = usize::from(channel.limb == Part::LeftLeg);
            largest_turn[kind] = largest_turn[kind].max(most);
            let spread = (SPREAD / (self.step * every as f64)).ceil() as usize;
            let smooth = smoothed(&turns, spread, self.is_loop);
            for (k, pose) in clip.poses.iter_mut().enumerate() {
                let angle = between(&smooth, k as f64 / every as f64, self.is_loop);
                channel.turn(pose, angle);
            }
        }
        unclear.sort_unstable();
        unclear.dedup();
        Cleared {
            clip,
            largest_turn,
            unclear: unclear.into_iter().map(|k| k as f64 * self.step).collect(),
        }
    }
}

/// Each number becomes the largest of itself and of `spread` neighbours before and after it; then all are
/// averaged over the same neighbours. None becomes lower than before.
fn smoothed(numbers: &[f64], spread: usize, is_loop: bool) -> Vec<f64> {
    let count = numbers.len() as isize;
    let near = |all: &[f64], k: isize, d: isize| {
        let at = match is_loop {
            true => (k + d).rem_euclid(count),
            false => (k + d).clamp(0, count - 1),
        };
        all[at as usize]
    };
    let spread = spread as isize;
    let window = move || -spread..=spread;
    let largest = |k: isize| window().map(|d| near(numbers, k, d)).fold(0.0, f64::max);
    let raised: Vec<f64> = (0..count).map(largest).collect();
    let mean = |k: isize| {
        let sum: f64 = window().map(|d| near(&raised, k, d)).sum();
        sum / (2 * spread + 1) as f64
    };
    (0..count).map(mean).collect()
}

/// Value at the position `place` among numbers, linearly interpolated; in a loop the first number follows the
/// last.
fn between(numbers: &[f64], place: f64, is_loop: bool) -> f64 {
    let last = numbers.len() - 1;
    let low = (place.floor() as usize).min(last);
    let high = match is_loop {
        true => (low + 1) % numbers.len(),
        false => (low + 1).min(last),
    };
    let share = place - place.floor();
    numbers[low] + (numbers[high] - numbers[low]) * share
}
