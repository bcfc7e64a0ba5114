//! Builds the curves of the warp from scales and levels.

use crate::BodyError;
use crate::curve::Monotone;
use crate::definitions::{THIGH_DROP, trunk_range};
use crate::girths::{Girth, PerGirth};
use crate::levels::{Level, Levels};
use crate::solve_input::SolveInput;
use crate::template_marks::{TemplateMarks, UNDERBUST};
use crate::warp::Shape;
use std::cmp::Ordering;

/// Scales that are solved for.
#[derive(Clone, Debug)]
pub(crate) struct Scales {
    /// Of each girth.
    pub(crate) girth: PerGirth<f64>,
    /// Square of lateral over frontal scale, of girths round the trunk.
    pub(crate) aspect: PerGirth<f64>,
    /// How much fuller the corners of a section are, of girths round the trunk.
    pub(crate) corners: PerGirth<f64>,
    /// How much fuller the front corners of the chest are, and the back ones emptier.
    pub(crate) folds: f64,
    /// Front over back: the front's share of the scale beyond one half.
    pub(crate) split: PerGirth<f64>,
    /// How much narrower the trunk is at the crotch than at the hips, so that nothing there is larger
    /// round than they are.
    pub(crate) seat: f64,
    /// Lateral, at the ends of the shoulders.
    pub(crate) shoulder: f64,
    /// Lateral, at the sides of the neck.
    pub(crate) neck: f64,
    /// Distances along the arm from the shoulder joint [m].
    pub(crate) elbow: f64,
    pub(crate) wrist: f64,
    /// How far the neck stands forward of the template's [m].
    pub(crate) lean: f64,
    /// How far the bust points are apart over what the sections give them, less one.
    pub(crate) spread: f64,
    /// Rise of the armpits over what the levels give them [m].
    pub(crate) armpit: f64,
    /// How far the bust points stand forward of what the sections give them [m].
    pub(crate) bulge: f64,
    /// How flat the crotch lies from front to back.
    pub(crate) flat: f64,
    /// Depth of the sides of girths round the trunk [m].
    pub(crate) sides: PerGirth<f64>,
    /// Depth of the middle of the crotch over the lowest place's [m].
    pub(crate) fork: f64,
}

/// How far apart the legs stand at least, over the scale of the thighs: thicker ones would meet.
const ASTRIDE: f64 = 0.75;

impl Scales {
    /// All the template's own, at a ratio of statures.
    pub(crate) fn new(global: f64, marks: &TemplateMarks) -> Self {
        Self {
            girth: PerGirth::of(|_| global),
            aspect: PerGirth::of(|_| 1.0),
            corners: PerGirth::of(|_| 0.0),
            folds: 0.0,
            split: PerGirth::of(|_| 0.0),
            seat: 1.0,
            shoulder: global,
            neck: global,
            elbow: global * marks.arm.elbow,
            wrist: global * marks.arm.wrist,
            lean: 0.0,
            spread: 0.0,
            armpit: 0.0,
            bulge: 0.0,
            flat: 0.0,
            sides: PerGirth::of(|_| 0.0),
            fork: 0.0,
        }
    }

    /// What goes to its place together, slowest where one pulls at another.
    pub(crate) fn coupled(&mut self) -> impl Iterator<Item = &mut f64> {
        let single = [
            &mut self.shoulder,
            &mut self.neck,
            &mut self.lean,
            &mut self.spread,
            &mut self.armpit,
            &mut self.bulge,
            &mut self.flat,
            &mut self.seat,
        ];
        self.girth.iter_mut().chain(single)
    }
}

/// Scales at one level of the trunk: height on the template [m], lateral, front, back.
type Section = [f64; 4];

/// Least distance between sections that are scaled apart, over stature.
const APART: f64 = 0.006;

/// The shape of given scales and levels.
pub(crate) fn shape(input: &SolveInput, s: &Scales, levels: &Levels) -> Result<Shape, BodyError> {
    let (m, q, t) = (&input.marks, &input.request, input.template);
    let height = levels.at(Level::Crown);
    let global = q.get("height") / t.height;
    let knee = levels.at(Level::Knee);
    let ankle = (t.joints.ankle[1] * global).min(0.4 * knee);
    let mut heights = vec![
        [0.0, 0.0],
        [t.joints.ankle[1], ankle],
        [m.leg.knee, knee],
        [m.crotch.height, levels.at(Level::Crotch)],
        [m.bust.height, levels.at(Level::Bust)],
        [m.neck.side.y, levels.at(Level::NeckSide)],
        [m.crown, height],
    ];
    if q.follows_skin() {
        // The fold under the bust.
        let fold = [
            m.bust.height - UNDERBUST * t.height,
            levels.at(Level::Underbust),
        ];
        heights.insert(4, fold);
    }
    if heights
        .windows(2)
        .any(|w| !below(w[0][0], w[1][0]) || !below(w[0][1], w[1][1]))
    {
        return Err(BodyError::Contradiction {
            first: "height",
            second: "the lengths along it",
            remedy: "they leave no room between the landmarks: lessen the longest of them",
        });
    }
    let curve = Monotone::new(heights.clone());
    let shoulder_rise = levels.at(Level::Tip) - curve.at(m.shoulder.tip.y);
    let [neck, head] = [t.joints.neck[2], t.joints.head[2]];
    let places = [
        m.crotch.height,
        m.bust.height,
        m.shoulder.tip.y,
        m.neck.side.y,
        t.joints.head[1],
        m.crown,
    ];
    let middle = [
        m.trunk.middle_depth,
        m.trunk.middle_depth,
        0.5 * (m.trunk.middle_depth + neck),
        neck,
        head,
        head,
    ];
    let forward = [0.0, 0.0, 0.5 * s.lean, s.lean, s.lean, s.lean];
    let row = |k: usize| [places[k], middle[k]];
    let row_to = |k: usize| {
        [
            places[k],
            (middle[k] - m.trunk.middle_depth) * global + forward[k],
        ]
    };
    let on_template = |level: f64| curve.inverse(level);
    let sections = trunk(input, s, levels, &on_template);
    let column = |k: usize| sections.iter().map(|row| [row[0], row[k]]).collect();
    let aspect = s.aspect[Girth::Hips].sqrt();
    let shape = Shape {
        levels: heights,
        lateral: column(1),
        front: column(2),
        back: column(3),
        corners: corners(input, s, levels, &on_template),
        folds: folds(s, m, levels, &on_template),
        leg: leg(input, s, levels, &on_template),
        arm: arm(input, s, global),
        arm_length: vec![
            [0.0, 0.0],
            [m.arm.elbow, s.elbow.clamp(0.2 * s.wrist, 0.8 * s.wrist)],
            [m.arm.wrist, s.wrist],
            [1.5 * m.arm.wrist, s.wrist + 0.5 * m.arm.wrist * global],
        ],
        arm_angle: q.get("arm_pose_angle"),
        global,
        stance: (s.girth[Girth::Hips] * aspect).max(ASTRIDE * s.girth[Girth::Thigh]),
        // An asked crotch length says how deep the seat is.
        leg_form: if q.is_asked("crotch_length") {
            1.0
        } else {
            aspect
        },
        depth: m.trunk.middle_depth,
        middle: (0..6).map(row).collect(),
        middle_to: (0..6).map(row_to).collect(),
        shoulder_rise,
        bust_spread: s.spread,
        bust_bulge: s.bulge,
        flat: s.flat,
        sides: s.sides,
        fork: s.fork,
        armpit_rise: s.armpit,
    };
    in_order(&shape)?;
    Ok(shape)
}

/// Whether a number is less than another, as no number is that is none.
fn below(low: f64, high: f64) -> bool {
    low.partial_cmp(&high) == Some(Ordering::Less)
}

/// Whether every form of a shape has its levels one above the other: landmarks of a skin whose
/// primitives were moved or deleted may not.
fn in_order(shape: &Shape) -> Result<(), BodyError> {
    for form in [
        &shape.lateral,
        &shape.front,
        &shape.back,
        &shape.corners,
        &shape.folds,
        &shape.leg,
        &shape.arm,
        &shape.arm_length,
        &shape.middle,
        &shape.middle_to,
    ] {
        if let Some(pair) = form.windows(2).find(|w| !below(w[0][0], w[1][0])) {
            return Err(BodyError::Disordered { level: pair[1][0] });
        }
    }
    Ok(())
}

/// Sections of trunk, neck and head from below. Of two that lie too close, the more important
/// one stands.
fn trunk(
    input: &SolveInput,
    s: &Scales,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Vec<Section> {
    let (m, t) = (&input.marks, input.template);
    let section = |y: f64, girth: Girth| -> Section {
        let (scale, form) = (s.girth[girth], s.aspect[girth].sqrt());
        let frontal = scale / form;
        let [front, back] = [1.0 + 2.0 * s.split[girth], 1.0 - 2.0 * s.split[girth]];
        [y, scale * form, frontal * front, frontal * back]
    };
    let [y, crotch @ ..] = section(m.crotch.height, Girth::Hips);
    let [lateral, front, back] = crotch.map(|scale| scale * s.seat);
    let mut rows = vec![[y, lateral, front, back]];
    let ends = [Level::Crotch, Level::Crown].map(|level| levels.at(level));
    for girth in [
        Girth::Hips,
        Girth::Waist,
        Girth::Bust,
        Girth::Underbust,
        Girth::HighBust,
        Girth::HighHips,
    ] {
        if let (Some(_), Some(level)) = (input.request.girth(girth), girth.level()) {
            // Hips have their girth wherever lengths put their level.
            let range = match girth {
                Girth::Hips => trunk_range(girth, ends),
                _ => None,
            };
            let at = levels.at(level);
            let at = range.map_or(at, |[low, high]| at.clamp(low, high));
            let y = on_template(at);
            if rows.iter().all(|row| (row[0] - y).abs() > APART * t.height) {
                rows.push(section(y, girth));
            }
        }
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let top = rows[rows.len() - 1];
    rows.retain(|row| row[0] < m.shoulder.tip.y - APART * t.height);
    let global = input.request.get("height") / t.height;
    let (neck, head) = (s.girth[Girth::Neck], s.girth[Girth::Head]);
    let [front, back] = [2, 3].map(|k| 0.5 * (top[k] + global));
    let tip = [m.shoulder.tip.y, s.shoulder, front, back];
    rows.extend(under_the_arm(&rows, tip, m.armpit.height, APART * t.height));
    rows.push(tip);
    let between = 0.5 * (s.neck + neck);
    rows.push([m.neck.side.y, s.neck, between, between]);
    rows.push([m.neck.middle.y.max(m.neck.side.y + 0.01), neck, neck, neck]);
    let chin = m.neck.side.y + 0.35 * (m.crown - m.neck.side.y);
    rows.push([chin.max(m.neck.middle.y + 0.02), head, head, head]);
    rows.push([m.crown, head, head, head]);
    rows
}

/// How much fuller the corners of the sections are over template height: nothing at the shoulders.
fn corners(
    input: &SolveInput,
    s: &Scales,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Vec<[f64; 2]> {
    let m = &input.marks;
    let apart = APART * input.template.height;
    let mut rows = vec![[m.shoulder.tip.y, 0.0]];
    for (girth, level) in [
        (Girth::Hips, Level::Hips),
        (Girth::Waist, Level::Waist),
        (Girth::Bust, Level::Bust),
    ] {
        let y = on_template(levels.at(level));
        if rows.iter().all(|row| (row[0] - y).abs() > apart) && y < m.shoulder.tip.y {
            rows.push([y, s.corners[girth]]);
        }
    }
    rows.push([0.0, s.corners[Girth::Hips]]);
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|b, a| b[0] - a[0] < apart);
    rows
}

/// How much fuller the front corners of the sections are than the back ones, over template height:
/// nothing at the waist and at the shoulders.
fn folds(
    s: &Scales,
    m: &TemplateMarks,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Vec<[f64; 2]> {
    let waist = on_template(levels.at(Level::Waist));
    vec![
        [0.0, 0.0],
        [waist, 0.0],
        [m.bust.height, s.folds],
        [m.shoulder.tip.y, 0.0],
        [m.crown, 0.0],
    ]
}

/// At the armpits the trunk is as broad in proportion as at its highest section below, so that a
/// broad chest does not lie under the arms like a ledge.
fn under_the_arm(rows: &[Section], tip: Section, armpit: f64, apart: f64) -> Option<Section> {
    let below = rows.iter().rev().find(|row| row[0] < armpit - apart)?;
    let between = rows
        .iter()
        .any(|row| row[0] >= armpit - apart && row[0] < tip[0]);
    if between || armpit > tip[0] - apart {
        return None;
    }
    let share = (armpit - below[0]) / (tip[0] - below[0]);
    let even = |k: usize| below[k] + (tip[k] - below[k]) * share;
    Some([armpit, even(1).max(below[1]), even(2), even(3)])
}

/// Scales of the leg over template height.
fn leg(
    input: &SolveInput,
    s: &Scales,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Vec<[f64; 2]> {
    let (m, t, q) = (&input.marks, input.template, &input.request);
    let global = q.get("height") / t.height;
    let foot = if q.girth(Girth::Heel).is_some() {
        s.girth[Girth::Heel]
    } else {
        global
    };
    let crotch = levels.at(Level::Crotch);
    let thigh = on_template(crotch - THIGH_DROP * levels.at(Level::Crown));
    let mut rows = vec![[0.0, foot], [0.8 * t.joints.ankle[1], foot]];
    for (girth, y) in [
        (Girth::Ankle, m.leg.ankle),
        (Girth::Calf, m.leg.calf),
        (Girth::Knee, m.leg.knee),
        (Girth::LowerThigh, m.leg.lower_thigh),
    ] {
        if q.girth(girth).is_some() {
            rows.push([y, s.girth[girth]]);
        }
    }
    rows.push([thigh, s.girth[Girth::Thigh]]);
    rows.push([
        thigh.max(m.crotch.height) + 0.05 * t.height,
        s.girth[Girth::Thigh],
    ]);
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|b, a| b[0] - a[0] < 1e-3);
    rows
}

/// Scales of the arm over template distance from the shoulder joint.
fn arm(input: &SolveInput, s: &Scales, global: f64) -> Vec<[f64; 2]> {
    let (m, q) = (&input.marks, &input.request);
    let mut rows = vec![[0.0, 0.5 * (global + s.girth[Girth::UpperArm])]];
    for (girth, distance) in [
        (Girth::UpperArm, m.arm.upper_arm),
        (Girth::Elbow, m.arm.elbow),
        (Girth::Forearm, m.arm.forearm),
        (Girth::Wrist, m.arm.wrist),
    ] {
        if q.girth(girth).is_some() {
            rows.push([distance, s.girth[girth]]);
        }
    }
    rows.push([1.1 * m.arm.wrist, s.girth[Girth::Wrist]]);
    rows.push([1.3 * m.arm.wrist, global]);
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|b, a| b[0] - a[0] < 1e-3);
    rows
}
