//! Heights of the landmarks, solved from the lengths that are asked for.

use crate::conflict::gives_way;
use crate::definitions::trunk_range;
use crate::girths::Girth;
pub(crate) use crate::landmark_level::Level;
use crate::request::Request;
use crate::template_marks::{TemplateMarks, UNDERBUST};
use nalgebra::{SMatrix, SVector};
use toile_measure::{Measurements, Origin};

use Level::{
    Armpit, Bust, Crotch, Crown, HighBust, HighHips, Hips, Knee, Nape, NeckSide, Tip, Underbust,
    Waist,
};

const COUNT: usize = 13;

/// Heights of the landmarks above the floor (m), and whether the waist is smaller than the girth under the
/// bust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levels {
    heights: [f64; COUNT],
    pub(crate) is_waisted: bool,
}

impl Levels {
    pub(crate) fn at(&self, level: Level) -> f64 {
        self.heights[level as usize]
    }

    /// Whether a girth round the trunk is searched for on a body with these levels and with crotch and crown
    /// at these heights (m). Otherwise it is taped at its level, for example a waist at the navel. Hips are
    /// always searched for.
    pub(crate) fn is_looked_for(&self, girth: Girth, [crotch, crown]: [f64; 2]) -> bool {
        let share = |level: Level| (self.at(level) - crotch) / (crown - crotch);
        let within = |level: Level, [low, high]: [f64; 2]| (low..=high).contains(&share(level));
        match girth {
            Girth::Hips => true,
            Girth::Waist => {
                let range = WAIST_RANGE[usize::from(self.is_waisted)];
                within(Waist, range) && share(Underbust) > UNDERBUST_LEAST
            }
            Girth::Bust => within(Bust, BUST_RANGE),
            _ => false,
        }
    }
}

/// Range of a waist's level, as shares of the way from crotch to crown, in which it is the smallest girth: of
/// a body with a belly, and of one whose waist is smaller than the girth under the bust.
const WAIST_RANGE: [[f64; 2]; 2] = [[0.30, 0.37], [0.28, 0.37]];
/// Range of the bust's level in which it is the largest girth, as shares of the same way.
const BUST_RANGE: [f64; 2] = [0.44, 0.56];
/// Lowest level of the girth under the bust, as a share of the way from crotch to crown: if the girth lies
/// lower, the smallest girth below it is not the waist.
const UNDERBUST_LEAST: f64 = 0.385;

/// Corrections between lengths measured on the skin and differences of the levels (m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SkinOffsets {
    /// Height of the landmark on the skin above its level.
    pub(crate) level: [f64; COUNT],
    /// Horizontal distance from the side of the neck to the end of the shoulder; `None` until it is known.
    pub(crate) run: Option<f64>,
    /// Length over the body minus its drop in height, in the order of [`OVER`].
    pub(crate) over: [f64; OVER.len()],
}

/// Straight upright lengths: name, upper and lower landmark (`None` is the floor).
const UPRIGHT: [(&str, Level, Option<Level>); 20] = [
    ("height", Crown, None),
    ("nape_height", Nape, None),
    ("head_l", Crown, Some(Nape)),
    ("shoulder_height", Tip, None),
    ("armpit_height", Armpit, None),
    ("bust_height", Bust, None),
    ("waist_height", Waist, None),
    ("hip_height", Hips, None),
    ("inside_leg", Crotch, None),
    ("knee_height", Knee, None),
    ("waist_line", Nape, Some(Waist)),
    ("hips_line", Waist, Some(Hips)),
    ("crotch_hip_diff", Hips, Some(Crotch)),
    ("vert_bust_line", Nape, Some(Bust)),
    ("waist_to_underbust", Underbust, Some(Waist)),
    ("armscye_depth", Tip, Some(Armpit)),
    ("waist_to_armpit", Armpit, Some(Waist)),
    ("waist_to_high_hips", Waist, Some(HighHips)),
    ("waist_to_crotch", Waist, Some(Crotch)),
    ("waist_to_knee", Waist, Some(Knee)),
];

/// Lengths over the body: name, upper and lower landmark (`None` is the floor), and other lengths. If one of
/// these others is requested, it determines the level instead.
pub(crate) const OVER: [(&str, Level, Option<Level>, &[&str]); 6] = [
    (
        "bust_line",
        NeckSide,
        Some(Bust),
        &["vert_bust_line", "bust_height"],
    ),
    ("hps_to_waist_back", NeckSide, Some(Waist), &["waist_line"]),
    ("hps_to_waist_front", NeckSide, Some(Waist), &["waist_line"]),
    (
        "waist_over_bust_line",
        NeckSide,
        Some(Waist),
        &["waist_line", "hps_to_waist_back", "bust_line"],
    ),
    ("bust_to_underbust", Bust, Some(Underbust), &[]),
    (
        "outside_leg",
        Waist,
        None,
        &["waist_height", "waist_to_crotch", "waist_line"],
    ),
];

/// All upright lengths with their landmarks.
pub(crate) fn upright() -> impl Iterator<Item = (&'static str, Level, Option<Level>)> {
    UPRIGHT.into_iter()
}

/// Normal equations of the least squares of all lengths, each weighted by its certainty.
struct System {
    normal: SMatrix<f64, COUNT, COUNT>,
    right: SVector<f64, COUNT>,
}

impl System {
    fn add(&mut self, terms: &[(Level, f64)], value: f64, deviation: f64) {
        let weight = 1.0 / (deviation * deviation);
        for &(a, x) in terms {
            self.right[a as usize] += weight * x * value;
            for &(b, y) in terms {
                self.normal[(a as usize, b as usize)] += weight * x * y;
            }
        }
    }
}

/// Standard deviation of a requested upright length, as a share of stature.
const ASKED: f64 = 3e-5;
/// Standard deviation of a requested length over the body, as a share of stature.
const ASKED_OVER: f64 = 3e-4;
/// Standard deviation of a predicted length, as a share of stature.
const PREDICTED: f64 = 0.02;
/// Standard deviation of a proportion of the template, as a share of stature.
const PROPORTION: f64 = 0.008;
/// Standard deviation of a level that is fixed by definition, as a share of stature.
const DEFINED: f64 = 3e-4;
/// Height of the neck's side below the nape, as a share of stature.
const NECK_SIDE_DROP: f64 = 0.020;

/// Heights that meet the lengths of a completed table in the sense of least squares: requested lengths have
/// the largest weight, then definitions, then predictions.
pub(crate) fn solve(request: &Request, marks: &TemplateMarks, offsets: &SkinOffsets) -> Levels {
    let table = &request.table;
    let height = table.get("height").unwrap_or(1.7);
    let mut system = System {
        normal: SMatrix::zeros(),
        right: SVector::zeros(),
    };
    let asked = |name: &str| {
        table
            .measured(name)
            .is_some_and(|m| m.origin == Origin::Asked)
    };
    for (name, upper, lower) in UPRIGHT {
        let Some(measured) = table.measured(name) else {
            continue;
        };
        let mut terms = vec![(upper, 1.0)];
        let mut value = measured.value - offsets.level[upper as usize];
        if let Some(lower) = lower {
            terms.push((lower, -1.0));
            value += offsets.level[lower as usize];
        }
        let deviation = match name {
            _ if asked(name) => ASKED,
            // The survey predicts the armpit height better than the template's proportions do.
            "armpit_height" => PROPORTION,
            _ => PREDICTED,
        };
        system.add(&terms, value, deviation * height);
    }
    for (k, (name, upper, lower, beside)) in OVER.into_iter().enumerate() {
        if !asked(name) || beside.iter().any(|name| asked(name)) {
            continue;
        }
        let mut terms = vec![(upper, 1.0)];
        terms.extend(lower.map(|lower| (lower, -1.0)));
        let value = table.get(name).unwrap_or_default() - offsets.over[k];
        let other = name == "bust_to_underbust" && request.follows_skin();
        let deviation = match other || gives_way(name, &request.conflicts) {
            true => PREDICTED,
            false => ASKED_OVER,
        };
        system.add(&terms, value, deviation * height);
    }
    proportions(&mut system, table, marks, height, offsets);
    let solved = system
        .normal
        .cholesky()
        .map_or(SVector::zeros(), |factor| factor.solve(&system.right));
    let mut heights = in_order(solved.into(), height);
    if !["bust_to_underbust", "waist_to_underbust"]
        .into_iter()
        .any(asked)
    {
        let at = |level: Level| heights[level as usize];
        let crotch = at(Crotch) + offsets.level[Crotch as usize];
        let lies = trunk_range(Girth::Underbust, [crotch, at(Crown)]).map_or(0.0, |range| range[0]);
        let room = [at(Waist) + 0.012 * height, at(Bust) - 0.012 * height];
        heights[Underbust as usize] = lies.max(room[0]).min(room[1]);
    }
    let [waist, underbust] = [Girth::Waist, Girth::Underbust].map(|girth| request.girth(girth));
    Levels {
        heights,
        is_waisted: waist < underbust,
    }
}

/// Adds equations that hold for any body: definitions, then the template's proportions.
fn proportions(
    system: &mut System,
    table: &Measurements,
    marks: &TemplateMarks,
    height: f64,
    offsets: &SkinOffsets,
) {
    let h = height;
    system.add(
        &[(Nape, 1.0), (NeckSide, -1.0)],
        NECK_SIDE_DROP * h,
        DEFINED * h,
    );
    if let (Some(slope), Some(shoulders), Some(neck)) = (
        table.measured("shoulder_incl"),
        table.get("shoulder_w"),
        table.get("neck_w"),
    ) {
        let run = offsets.run.unwrap_or(0.5 * (shoulders - neck));
        let fall = run * slope.value.clamp(-0.2, 1.2).tan();
        let deviation = match slope.origin {
            Origin::Asked => ASKED,
            Origin::Predicted => PROPORTION,
        };
        let value = fall + offsets.level[Tip as usize] - offsets.level[NeckSide as usize];
        system.add(&[(NeckSide, 1.0), (Tip, -1.0)], value, deviation * h);
    }
    let t = marks;
    let [bust, crotch] = [t.bust.height, t.crotch.height];
    let of_template = |a: f64| a / t.crown * h;
    let near = PROPORTION * h;
    system.add(&[(Bust, 1.0), (Underbust, -1.0)], UNDERBUST * h, near);
    system.add(&[(HighBust, 1.0), (Bust, -0.62), (Tip, -0.38)], 0.0, near);
    system.add(&[(HighHips, 1.0), (Waist, -0.5), (Hips, -0.5)], 0.0, near);
    system.add(&[(Knee, 1.0), (Crotch, -t.leg.knee / crotch)], 0.0, near);
    system.add(
        &[(Tip, 1.0), (Armpit, -1.0)],
        of_template(t.shoulder.tip.y - t.armpit.height),
        PREDICTED * h,
    );
    // Weak equations, so that every level is determined.
    let weak = 0.05 * h;
    for (level, y) in [
        (Crown, t.crown),
        (Nape, t.neck.side.y),
        (Tip, t.shoulder.tip.y),
        (Bust, bust),
        (Crotch, crotch),
        (Waist, crotch + 0.6 * (bust - crotch)),
        (Hips, crotch + 0.2 * (bust - crotch)),
    ] {
        system.add(&[(level, 1.0)], of_template(y), weak);
    }
}

/// Smallest distance of each landmark above the landmark before it in this list, as a share of stature; of
/// the first above the floor.
const ROOM: [(Level, f64); 9] = [
    (Knee, 0.12),
    (Crotch, 0.10),
    (Hips, 0.008),
    (Waist, 0.03),
    (Underbust, 0.012),
    (Bust, 0.012),
    (Tip, 0.03),
    (NeckSide, 0.004),
    (Crown, 0.08),
];

/// The heights raised where needed, so that they rise in order with the least distances between them.
fn in_order(mut heights: [f64; COUNT], height: f64) -> [f64; COUNT] {
    let mut floor = 0.0;
    for (level, room) in ROOM {
        let least = floor + room * height;
        let at = &mut heights[level as usize];
        *at = at.max(least);
        floor = *at;
    }
    let [hips, waist] = [heights[Hips as usize], heights[Waist as usize]];
    let between = &mut heights[HighHips as usize];
    *between = between.clamp(hips + 0.008 * height, waist - 0.008 * height);
    let [bust, tip] = [heights[Bust as usize], heights[Tip as usize]];
    // The bust is taped below the armpits.
    let armpit = &mut heights[Armpit as usize];
    *armpit = armpit.clamp(bust + 0.008 * height, tip - 0.02 * height);
    let bust = heights[Bust as usize];
    let high = &mut heights[HighBust as usize];
    *high = high.clamp(bust + 0.008 * height, tip - 0.008 * height);
    heights
}
