//! The start of a fit: our own figure's primitives carried to the joints and girths of a mesh.

use crate::fit_frame::FoundFrame;
use crate::rings::at_length;
use crate::template::{BodyFrame, Template, plain_primitives};
use crate::{Figure, Part, Primitive, Scan};
use nalgebra::{Rotation3, UnitQuaternion};
use toile_geometry::Vec3;

/// Pairs of primitives along a leg: with them both sides of a body have 150 in all.
const PAIRS: usize = 9;

/// One of the two bodies: the body to carry primitives from, or the body to carry them to.
struct Side<'a> {
    scan: &'a Scan,
    frame: &'a BodyFrame,
}

impl Side<'_> {
    fn bones(&self, part: Part) -> Vec<Vec3> {
        let j = &self.frame.joints;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        match part {
            Part::LeftArm => {
                let hand = (wrist - elbow).normalize() * self.frame.hand;
                vec![shoulder, elbow, wrist, wrist + hand]
            }
            _ => [j.hip, j.knee, j.ankle, j.toe].map(Vec3::from).to_vec(),
        }
    }

    /// Half breadth, half depth and depth of the centre of the trunk at a height (m); below the crotch and
    /// above the armpit, the values at the end of the trunk.
    fn trunk(&self, y: f64) -> [f64; 3] {
        let f = self.frame;
        let armpit = f.joints.shoulder[1] - 0.05 * f.height;
        let y = y.max(f.crotch + 0.02 * f.height).min(armpit);
        let section = self.scan.trunk(y);
        section.map_or([0.09 * f.height, 0.06 * f.height, 0.0], |l| {
            let [breadth, depth] = l.extent();
            [0.5 * breadth, 0.5 * depth, l.centre().y]
        })
    }

    /// Girth across a bone at a share of its length (m).
    fn girth(&self, [from, to]: [Vec3; 2], share: f64) -> Option<f64> {
        let along = (to - from).try_normalize(1e-9)?;
        let first = along.cross(&Vec3::z()).try_normalize(1e-6)?;
        let origin = from + (to - from) * share;
        let loops = self.scan.section(origin, [first, first.cross(&along)]);
        let near = loops
            .into_iter()
            .min_by(|a, b| a.centre().norm().total_cmp(&b.centre().norm()))?;
        Some(near.girth())
    }

    /// Heights that correspond to each other on two bodies: floor, crotch, shoulder, base of the neck, crown.
    fn heights(&self) -> [f64; 5] {
        let f = self.frame;
        [
            0.0,
            f.crotch,
            f.joints.shoulder[1],
            f.joints.neck[1],
            f.height,
        ]
    }
}

/// Primitives of the left side and the median plane to start from: those of the woman's figure carried to a
/// mesh, and new ones for hand and leg. `own` is the skin of the woman's figure.
pub(crate) fn start(scan: &Scan, found: &FoundFrame, own: &Scan) -> Vec<Primitive> {
    let template = Template::of(Figure::Woman);
    let frame = BodyFrame {
        height: template.height,
        crotch: template.crotch,
        armpit: own.landmarks().armpit.unwrap_or_default(),
        hand: template.hand,
        neck_radius: template.neck_radius,
        joints: template.joints,
        features: None,
    };
    let from = Side {
        scan: own,
        frame: &frame,
    };
    let to = Side {
        scan,
        frame: &found.frame,
    };
    let mut all: Vec<Primitive> = plain_primitives(Figure::Woman)
        .iter()
        .map(|p| match p.part {
            Part::Trunk | Part::Head => carried(p, &from, &to),
            _ => along_bone(p, &from, &to),
        })
        .collect();
    all.extend(hand(&to));
    all.extend(leg(&to));
    all
}

/// Primitives of a hand, one behind another.
fn hand(to: &Side) -> Vec<Primitive> {
    let bones = to.bones(Part::LeftArm);
    let [wrist, end] = [bones[2], bones[3]];
    let height = to.frame.height;
    [
        (0.2, [0.026, 0.026, 0.045]),
        (0.5, [0.026, 0.029, 0.048]),
        (0.83, [0.026, 0.028, 0.038]),
    ]
    .map(|(share, radii)| {
        let at = wrist + (end - wrist) * share;
        Primitive::new(Part::LeftArm, at.into(), radii.map(|r| r * height))
    })
    .into()
}

/// Ellipsoids that a leg is made of: pairs from hip to ankle, in turn a front and a back one and an inner and
/// an outer one; and some for the foot.
fn leg(to: &Side) -> Vec<Primitive> {
    let bones = to.bones(Part::LeftLeg);
    let height = to.frame.height;
    let primitive =
        |centre: Vec3, radii: [f64; 3]| Primitive::new(Part::LeftLeg, centre.into(), radii);
    let path = &bones[..3];
    let length: f64 = path.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let spacing = length / PAIRS as f64;
    let mut all = Vec::new();
    for k in 0..PAIRS {
        let at = at_length(path, spacing * (k as f64 + 0.5));
        let k_bone = usize::from(at.y < bones[1].y);
        let bone = [bones[k_bone], bones[k_bone + 1]];
        let share = (at - bone[0]).norm() / (bone[1] - bone[0]).norm();
        let around = to.girth(bone, share.clamp(0.25, 1.0));
        let thick = around.unwrap_or(0.2 * height) / std::f64::consts::TAU;
        let aside = if k % 2 == 0 { Vec3::z() } else { Vec3::x() } * (0.4 * thick);
        for side in [-1.0, 1.0] {
            let wide = 1.3 * thick;
            all.push(primitive(at + aside * side, [wide, 1.7 * spacing, wide]));
        }
    }
    let [ankle, toe] = [bones[2], bones[3]];
    let way = Vec3::new(toe.x - ankle.x, 0.0, toe.z - ankle.z);
    for (along, beside, up, radii) in [
        (-0.15, 0.0, 0.022, [0.04, 0.04, 0.05]),
        (0.15, 0.0, 0.03, [0.04, 0.05, 0.06]),
        (0.4, 0.0, 0.022, [0.04, 0.04, 0.07]),
        (0.65, -0.012, 0.014, [0.035, 0.03, 0.06]),
        (0.65, 0.014, 0.014, [0.035, 0.03, 0.06]),
        (0.9, 0.0, 0.01, [0.045, 0.022, 0.04]),
    ] {
        let at = Vec3::new(ankle.x, 0.0, ankle.z) + way * along;
        let place = at + Vec3::new(beside, up, 0.0) * height;
        all.push(primitive(place, radii.map(|r| r * height)));
    }
    all
}

/// Height on one body that corresponds to a height on another.
fn level(y: f64, from: &[f64; 5], to: &[f64; 5]) -> f64 {
    let k = from.partition_point(|&h| h <= y).clamp(1, 4);
    let share = (y - from[k - 1]) / (from[k] - from[k - 1]);
    to[k - 1] + (to[k] - to[k - 1]) * share
}

/// A primitive of trunk or head, carried to the other body.
fn carried(p: &Primitive, from: &Side, to: &Side) -> Primitive {
    let c = Vec3::from(p.centre);
    let y = level(c.y, &from.heights(), &to.heights());
    let [a, b] = [from.frame, to.frame];
    let above = (c.y - a.joints.neck[1]).max(0.0) / (a.height - a.joints.neck[1]);
    let (ratio, old, new) = if p.part == Part::Head {
        let neck = b.neck_radius / a.neck_radius;
        let skull = (b.height - b.joints.neck[1]) / (a.height - a.joints.neck[1]);
        let s = neck + (skull - neck) * (2.0 * above).min(1.0);
        let middle = |f: &BodyFrame| {
            let [neck, head] = [f.joints.neck[2], f.joints.head[2]];
            neck + (head - neck) * (2.0 * above).min(1.0)
        };
        ([s, skull, s], middle(a), middle(b))
    } else {
        let [x0, z0, m0] = from.trunk(c.y);
        let [x1, z1, m1] = to.trunk(y);
        let tall = (to.heights()[2] - to.heights()[1]) / (from.heights()[2] - from.heights()[1]);
        ([x1 / x0, tall, z1 / z0], m0, m1)
    };
    let turn = *p.rotation().matrix();
    let radii = std::array::from_fn(|k| {
        let axis = turn.column(k);
        let long: f64 = (0..3).map(|i| (axis[i] * ratio[i]).powi(2)).sum();
        p.radii[k] * long.sqrt()
    });
    Primitive {
        centre: [c.x * ratio[0], y, new + (c.z - old) * ratio[2]],
        radii,
        ..*p
    }
}

/// A primitive of a limb, carried to the other body with its position beside the bone.
fn along_bone(p: &Primitive, from: &Side, to: &Side) -> Primitive {
    let (old, new) = (from.bones(p.part), to.bones(p.part));
    let c = Vec3::from(p.centre);
    let share = |k: usize| {
        let bone = old[k + 1] - old[k];
        (c - old[k]).dot(&bone) / bone.norm_squared()
    };
    let far = |k: usize| {
        let at = old[k] + (old[k + 1] - old[k]) * share(k).clamp(0.0, 1.0);
        (c - at).norm()
    };
    let k = (0..3)
        .min_by(|&a, &b| far(a).total_cmp(&far(b)))
        .unwrap_or_default();
    let t = share(k);
    let (bone, to_bone) = (old[k + 1] - old[k], new[k + 1] - new[k]);
    let turn = UnitQuaternion::rotation_between(&bone, &to_bone).unwrap_or_default();
    let inner = t.clamp(0.2, 1.0);
    // Sections of hands and feet are not reliable.
    let thick = match k {
        2 => to.frame.height / from.frame.height,
        _ => match (
            from.girth([old[k], old[k + 1]], inner),
            to.girth([new[k], new[k + 1]], inner),
        ) {
            (Some(a), Some(b)) => (b / a).clamp(0.2, 4.0),
            _ => to.frame.height / from.frame.height,
        },
    };
    let offset = c - (old[k] + bone * t);
    let centre = new[k] + to_bone * t + turn * (offset * thick);
    let long = to_bone.norm() / bone.norm();
    let axes = *p.rotation().matrix();
    let along = bone.normalize();
    let radii = std::array::from_fn(|i| {
        let share = axes.column(i).dot(&along).powi(2);
        p.radii[i] * (long * long * share + thick * thick * (1.0 - share)).sqrt()
    });
    Primitive {
        centre: centre.into(),
        radii,
        rotation: (Rotation3::from(turn) * p.rotation()).scaled_axis().into(),
        ..*p
    }
}
