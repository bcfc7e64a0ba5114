//! The shape of a body by its scales and levels.

use crate::BodyError;
use crate::curve::Monotone;
use crate::definitions::{THIGH_DROP, trunk_range};
use crate::girths::{Girth, PerGirth};
use crate::levels::{Level, Levels};
use crate::scales::Scales;
use crate::shape::{ArmShape, Curve, LegShape, Shape, ShoulderShape, TrunkShape, below};
use crate::solve_input::SolveInput;
use crate::template_marks::{TemplateMarks, UNDERBUST};

/// Smallest sideways scale of the legs' stance, divided by the scale of the thighs (1): with less, thick
/// thighs would meet.
const ASTRIDE: f64 = 0.75;

/// Scales at one level of the trunk: height on the template (m), lateral, front, back.
type Section = [f64; 4];

/// Least distance between sections with scales of their own, as a share of stature.
const APART: f64 = 0.006;

/// The shape that belongs to given scales and levels.
pub(crate) fn shape(input: &SolveInput, s: &Scales, levels: &Levels) -> Result<Shape, BodyError> {
    let (m, q) = (&input.marks, &input.request);
    let heights = heights(input, levels)?;
    let curve = Monotone::new(heights.clone());
    let on_template = |level: f64| curve.inverse(level);
    let sections = trunk(input, s, levels, &on_template);
    let column = |k: usize| sections.iter().map(|row| [row[0], row[k]]).collect();
    let [middle_on_template, middle_on_body] = middles(input, s);
    let breadth = s.trunk.section[Girth::Hips].aspect.sqrt();
    let shape = Shape {
        stature_ratio: input.stature_ratio(),
        trunk: TrunkShape {
            lateral: column(1),
            front: column(2),
            back: column(3),
            corner_fullness: corner_fullness(input, s, levels, &on_template),
            corner_asymmetry: corner_asymmetry(s, m, levels, &on_template),
            middle_on_template,
            middle_on_body,
            side_depth: PerGirth::of(|girth| s.trunk.section[girth].side_depth),
        },
        shoulder: ShoulderShape {
            tip_rise: levels.at(Level::Tip) - curve.at(m.shoulder.tip.y),
            armpit_rise: s.shoulder.armpit_rise,
        },
        bust: s.bust,
        crotch: s.crotch,
        arm: ArmShape {
            scale: arm(input, s),
            length: arm_length(input, s),
            angle: q.get("arm_pose_angle"),
        },
        leg: LegShape {
            scale: leg(input, s, levels, &on_template),
            stance: (s.girth[Girth::Hips] * breadth).max(ASTRIDE * s.girth[Girth::Thigh]),
            // A requested crotch length already determines the depth of the seat.
            top_breadth: match q.is_asked("crotch_length") {
                true => 1.0,
                false => breadth,
            },
        },
        heights,
    };
    shape.in_order()
}

/// Heights from the floor up, on the template and on the body (m).
fn heights(input: &SolveInput, levels: &Levels) -> Result<Curve, BodyError> {
    let (m, q, t) = (&input.marks, &input.request, input.template);
    let height = levels.at(Level::Crown);
    let knee = levels.at(Level::Knee);
    let ankle = (t.joints.ankle[1] * input.stature_ratio()).min(0.4 * knee);
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
    let is_crowded = heights
        .windows(2)
        .any(|w| !below(w[0][0], w[1][0]) || !below(w[0][1], w[1][1]));
    if is_crowded {
        return Err(BodyError::Contradiction {
            first: "height",
            second: "the lengths along it",
            remedy: "they leave no room between the landmarks: lessen the longest of them",
        });
    }
    Ok(heights)
}

/// Depths about which sections of trunk, neck and head are scaled, on the template and on the body.
fn middles(input: &SolveInput, s: &Scales) -> [Curve; 2] {
    let (m, j) = (&input.marks, &input.template.joints);
    let (trunk, neck, head) = (m.trunk.middle_depth, j.neck[2], j.head[2]);
    let forward = s.neck.forward;
    let rows = [
        (m.crotch.height, trunk, 0.0),
        (m.bust.height, trunk, 0.0),
        (m.shoulder.tip.y, 0.5 * (trunk + neck), 0.5 * forward),
        (m.neck.side.y, neck, forward),
        (j.head[1], head, forward),
        (m.crown, head, forward),
    ];
    let on_body = |depth: f64, forward: f64| (depth - trunk) * input.stature_ratio() + forward;
    [
        rows.map(|(y, depth, _)| [y, depth]).into(),
        rows.map(|(y, depth, forward)| [y, on_body(depth, forward)])
            .into(),
    ]
}

/// Sections of trunk, neck and head from below. If two sections lie too close, only the more important one is
/// kept.
fn trunk(
    input: &SolveInput,
    s: &Scales,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Vec<Section> {
    let (m, t) = (&input.marks, input.template);
    let section = |y: f64, girth: Girth| -> Section {
        let (scale, form) = (s.girth[girth], s.trunk.section[girth]);
        let breadth = form.aspect.sqrt();
        let frontal = scale / breadth;
        let more = 2.0 * form.front_share;
        [
            y,
            scale * breadth,
            frontal * (1.0 + more),
            frontal * (1.0 - more),
        ]
    };
    let [y, crotch @ ..] = section(m.crotch.height, Girth::Hips);
    let [lateral, front, back] = crotch.map(|scale| scale * s.trunk.crotch_to_hips);
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
            // The hips' scale is set within the range in which hips are searched for, also if lengths place
            // their level outside it.
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
    let (neck, head) = (s.girth[Girth::Neck], s.girth[Girth::Head]);
    let [front, back] = [2, 3].map(|k| 0.5 * (top[k] + input.stature_ratio()));
    let tip = [m.shoulder.tip.y, s.shoulder.breadth, front, back];
    rows.extend(under_the_arm(&rows, tip, m.armpit.height, APART * t.height));
    rows.push(tip);
    let between = 0.5 * (s.neck.breadth + neck);
    rows.push([m.neck.side.y, s.neck.breadth, between, between]);
    rows.push([m.neck.middle.y.max(m.neck.side.y + 0.01), neck, neck, neck]);
    let chin = m.neck.side.y + 0.35 * (m.crown - m.neck.side.y);
    rows.push([chin.max(m.neck.middle.y + 0.02), head, head, head]);
    rows.push([m.crown, head, head, head]);
    rows
}

/// Fullness of the corners of the sections over template height: 0 at the shoulders.
fn corner_fullness(
    input: &SolveInput,
    s: &Scales,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Curve {
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
            rows.push([y, s.trunk.section[girth].corner_fullness]);
        }
    }
    rows.push([0.0, s.trunk.section[Girth::Hips].corner_fullness]);
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|b, a| b[0] - a[0] < apart);
    rows
}

/// Amount by which the front corners of the sections are fuller than the back ones, over template height: 0
/// at the waist and at the shoulders.
fn corner_asymmetry(
    s: &Scales,
    m: &TemplateMarks,
    levels: &Levels,
    on_template: &dyn Fn(f64) -> f64,
) -> Curve {
    let waist = on_template(levels.at(Level::Waist));
    vec![
        [0.0, 0.0],
        [waist, 0.0],
        [m.bust.height, s.trunk.chest_asymmetry],
        [m.shoulder.tip.y, 0.0],
        [m.crown, 0.0],
    ]
}

/// Section at the armpits, at least as broad as the highest section below them, so that a broad chest does
/// not form a ledge under the arms.
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
fn leg(input: &SolveInput, s: &Scales, levels: &Levels, on_template: &dyn Fn(f64) -> f64) -> Curve {
    let (m, t, q) = (&input.marks, input.template, &input.request);
    let foot = if q.girth(Girth::Heel).is_some() {
        s.girth[Girth::Heel]
    } else {
        input.stature_ratio()
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
fn arm(input: &SolveInput, s: &Scales) -> Curve {
    let (m, q) = (&input.marks, &input.request);
    let mut rows = vec![[
        0.0,
        0.5 * (input.stature_ratio() + s.girth[Girth::UpperArm]),
    ]];
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
    rows.push([1.3 * m.arm.wrist, input.stature_ratio()]);
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by(|b, a| b[0] - a[0] < 1e-3);
    rows
}

/// Distance from the shoulder joint on the template with the distance on the body that corresponds to it (m).
fn arm_length(input: &SolveInput, s: &Scales) -> Curve {
    let (on_template, on_body) = (&input.marks.arm, &s.arm);
    let wrist = on_body.wrist;
    vec![
        [0.0, 0.0],
        [
            on_template.elbow,
            on_body.elbow.clamp(0.2 * wrist, 0.8 * wrist),
        ],
        [on_template.wrist, wrist],
        [
            1.5 * on_template.wrist,
            wrist + 0.5 * on_template.wrist * input.stature_ratio(),
        ],
    ]
}
