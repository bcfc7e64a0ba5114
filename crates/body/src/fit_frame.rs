//! Levels and joints of a foreign mesh of a person, found by sections of its limbs.

use crate::arm_rings::{Ring, arm_rings, finger_tip};
use crate::template::{BodyFrame, Joints};
use crate::{BodyError, Scan};
use toile_geometry::Vec3;

/// A frame, with positions on the arm and of the chin that were found along with it.
pub(crate) struct FoundFrame {
    pub(crate) frame: BodyFrame,
    /// The tip of the left hand (m).
    pub(crate) finger_tip: Vec3,
    /// Distance from the shoulder joint along the upper arm at which the sections begin that contain only the
    /// arm (m).
    pub(crate) arm_begins: f64,
    /// Height of the lower end of the face (m).
    pub(crate) chin: f64,
}

/// Least distance from crotch to armpits, as a share of stature.
const MIN_TRUNK: f64 = 0.1;
/// Least number of sections from wrist to shoulder.
const MIN_ARM: usize = 4;

/// Height of the shoulder joint over the armpit, as a share of stature.
const JOINT_RISE: f64 = 0.037;

/// Finds levels and joints on a mesh that stands on y = 0 centred at x = 0.
///
/// # Errors
/// [`BodyError::Mesh`] for a level or limb that could not be found, with the landmark to give.
pub(crate) fn find(scan: &Scan) -> Result<FoundFrame, BodyError> {
    let missing = |what: &str| BodyError::Mesh(format!("has no {what} that could be found"));
    let marks = scan.landmarks();
    let height = scan.height();
    let crotch = marks
        .crotch
        .ok_or_else(|| missing("crotch: give its height as landmark crotch"))?;
    let armpit = marks.armpit.ok_or_else(|| {
        missing("armpit with arms beside the trunk: give its height as landmark armpit")
    })?;
    if armpit - crotch < MIN_TRUNK * height {
        return Err(BodyError::Mesh(format!(
            "has the crotch at {crotch:.3} m and the armpits at {armpit:.3} m, which leaves no trunk: give better landmarks crotch and armpit"
        )));
    }
    let tip = finger_tip(scan);
    let rings = arm_rings(scan, tip, armpit);
    if rings.len() < 12 {
        return Err(missing(
            "left arm (+X) as a limb of its own: hold the arms off the trunk",
        ));
    }
    let given = marks.wrist.map(Vec3::from);
    let wrist_at = match given {
        Some(p) => nearest(&rings, p),
        None => wrist_ring(&rings, height),
    };
    if wrist_at + MIN_ARM >= rings.len() {
        return Err(missing(
            "arm between wrist and shoulder: give another landmark wrist",
        ));
    }
    let wrist = rings[wrist_at].0;
    let elbow_at = elbow_ring(&rings, wrist_at);
    let elbow = rings[elbow_at].0;
    let last = rings[rings.len() - 1].0;
    let shoulder = shoulder_joint(&rings, elbow, armpit, height);
    let along = (elbow - shoulder).normalize();
    let [hip, knee, ankle, toe] = leg(scan, crotch).ok_or_else(|| missing("left leg (+X)"))?;
    let neck = neck(scan, armpit).ok_or_else(|| missing("neck narrower than head and trunk"))?;
    let middle = |y: f64| scan.trunk(y).map_or(0.0, |l| l.centre().y);
    // The fold between arm and trunk.
    let beside = scan.trunk(armpit - 0.004 * height);
    let half = beside.map_or(0.1 * height, |l| 0.5 * l.extent()[0]);
    let fold = Vec3::new(half, armpit, shoulder.z);
    let head_y = neck.base + 0.43 * (height - neck.base);
    let brow = neck.base + 0.68 * (height - neck.base);
    let chest_y = shoulder.y - 0.0375 * height;
    let pelvis_y = crotch + 0.0575 * height;
    let joints = Joints {
        shoulder: shoulder.into(),
        elbow: elbow.into(),
        wrist: wrist.into(),
        hip: hip.into(),
        knee: knee.into(),
        ankle: ankle.into(),
        toe: toe.into(),
        pelvis: [0.0, pelvis_y, middle(pelvis_y)],
        chest: [0.0, chest_y, middle(chest_y.min(armpit - 0.01 * height))],
        neck: [0.0, neck.base, neck.depth],
        head: [0.0, head_y, middle(brow) - 0.002 * height],
    };
    Ok(FoundFrame {
        frame: BodyFrame {
            height,
            crotch,
            armpit,
            hand: 0.86 * (tip - wrist).norm(),
            neck_radius: neck.radius,
            joints,
            features: None,
        },
        finger_tip: tip,
        chin: neck.narrowest - 0.004 * height,
        arm_begins: (last - shoulder)
            .dot(&along)
            .max((fold - shoulder).dot(&along) + 0.004 * height),
    })
}

fn nearest(rings: &[Ring], p: Vec3) -> usize {
    let far = |k: &usize| (rings[*k].0 - p).norm();
    (0..rings.len())
        .min_by(|a, b| far(a).total_cmp(&far(b)))
        .unwrap_or_default()
}

/// Index of the wrist's section: the thinnest about a hand's length from the tip.
fn wrist_ring(rings: &[Ring], height: f64) -> usize {
    let tip = rings[0].0;
    let window = |k: &usize| (0.085..0.15).contains(&((rings[*k].0 - tip).norm() / height));
    (0..rings.len())
        .filter(window)
        .min_by(|&a, &b| rings[a].1.total_cmp(&rings[b].1))
        .unwrap_or(8.min(rings.len() - 1))
}

/// Index of the elbow's section: the one for which two straight bones fit the centres of the sections best;
/// near the middle of a straight arm.
fn elbow_ring(rings: &[Ring], wrist: usize) -> usize {
    let last = rings.len() - 1;
    let span = last - wrist;
    let distance = |p: Vec3, [a, b]: [Vec3; 2]| (p - a).cross(&(b - a).normalize()).norm();
    let misfit = |k: usize| -> f64 {
        let bones = (wrist..=last).map(|i| {
            let bone = if i <= k { [wrist, k] } else { [k, last] };
            distance(rings[i].0, bone.map(|j| rings[j].0)).powi(2)
        });
        let mean = (bones.sum::<f64>() / (span + 1) as f64).sqrt();
        // Within the noise of the centres, the usual position of an elbow decides.
        let share = (k - wrist) as f64 / span as f64;
        mean + 0.02 * (share - 0.52).powi(2) * (rings[last].0 - rings[wrist].0).norm()
    };
    let window = wrist + (0.38 * span as f64) as usize..=wrist + (0.68 * span as f64) as usize;
    window
        .min_by(|&a, &b| misfit(a).total_cmp(&misfit(b)))
        .unwrap_or((wrist + last) / 2)
}

/// The shoulder joint: on the line of the upper arm, at the usual height above the armpit; for level arms, at
/// the usual distance from the median plane.
fn shoulder_joint(rings: &[Ring], elbow: Vec3, armpit: f64, height: f64) -> Vec3 {
    let last = rings[rings.len() - 1].0;
    let along = (last - elbow).normalize();
    let rise = armpit + JOINT_RISE * height - last.y;
    let way = match along.y > 0.4 {
        true => rise / along.y,
        false => (last.x - 0.1 * height) / -along.x.min(-0.3),
    };
    last + along * way.clamp(0.0, 0.09 * height)
}

/// Hip, knee, ankle and tip of the foot of the left leg.
fn leg(scan: &Scan, crotch: f64) -> Option<[Vec3; 4]> {
    let height = scan.height();
    let centre = |y: f64| {
        let middle = scan.leg(y)?.centre();
        Some(Vec3::new(middle.x, y, middle.y))
    };
    let knee_y = scan.landmarks().knee.unwrap_or(0.28 * height);
    let knee = centre(knee_y)?;
    let thigh = centre(crotch - 0.06 * height)?;
    let hip_y = crotch + 0.05 * height;
    let trunk = scan.trunk(hip_y)?;
    // The flesh of thighs extends farther outwards and backwards from the bone.
    let hip = Vec3::new(
        (0.06 * height).min(thigh.x),
        hip_y,
        0.5 * (thigh.z + trunk.centre().y),
    );
    let shin = centre(0.07 * height)?;
    let ankle_y = 0.043 * height;
    let ankle = Vec3::new(shin.x, ankle_y, shin.z);
    let low = scan
        .mesh()
        .positions
        .iter()
        .filter(|p| p.x > 0.0 && p.y < 0.06 * height);
    let toe = low.max_by(|a, b| a.z.total_cmp(&b.z))?;
    let sole = centre(0.012 * height)?;
    let toe = Vec3::new(0.5 * (toe.x + sole.x), 0.014 * height, toe.z);
    Some([hip, knee, ankle, toe])
}

/// The neck: height and depth of its base, a distance from the median plane that lies outside the neck, and
/// the height of its narrowest section (m).
struct Neck {
    base: f64,
    depth: f64,
    radius: f64,
    narrowest: f64,
}

fn neck(scan: &Scan, armpit: f64) -> Option<Neck> {
    let height = scan.height();
    let step = 0.0025 * height;
    let levels = |from: f64, to: f64| {
        let count = ((to - from) / step) as usize;
        (0..=count).map(move |k| from + step * k as f64)
    };
    let (narrowest, least) = levels(armpit + 0.03 * height, 0.93 * height)
        .filter_map(|y| Some((y, scan.trunk(y)?)))
        .min_by(|a, b| a.1.girth().total_cmp(&b.1.girth()))?;
    let radius = 0.8 * least.extent()[0];
    // The base is the highest level at which the section through the shoulders is as wide as twice the neck's
    // radius.
    let base = levels(armpit, narrowest)
        .filter(|&y| scan.trunk(y).is_some_and(|l| l.extent()[0] >= 2.0 * radius))
        .fold(armpit, f64::max);
    let depth = scan.trunk(base)?.centre().y - 0.008 * height;
    Some(Neck {
        base,
        depth,
        radius,
        narrowest,
    })
}
