//! The proportion box: a figure in head lengths from crown to chin (Volino, Magnenat-Thalmann, Shen, Thalmann
//! 1996). The boxes are data; this module applies them to a body.

use crate::curve::smooth_step;
use crate::scaling::tags;
use crate::template::{BodyFrame, Features};
use crate::{BodyError, Description, Mannequin, Part, Primitive};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Proportions of a figure. Proportions that are left out stay as the body has them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProportionBox {
    /// Name by which a user chooses the box.
    pub name: String,
    /// Sex of the figure; both if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sex: Option<Sex>,
    /// Age (years); adult if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age: Option<f64>,
    /// Stature in head lengths (1).
    pub heads: f64,
    /// Height of the crotch in head lengths (1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crotch: Option<f64>,
    /// Distance between the ends of the shoulders in head lengths (1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shoulders: Option<f64>,
    /// Breadth of the hips in head lengths (1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hips: Option<f64>,
    /// Source of the numbers.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
}

/// Sex of the figure of a proportion box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sex {
    /// Woman or girl.
    Female,
    /// Man or boy.
    Male,
}

/// Range of head counts that a body may be given: wider than those of any source (1).
const HEADS: [f64; 2] = [3.0, 10.0];
/// Range of the crotch's height as a share of stature (1).
const CROTCH: [f64; 2] = [0.25, 0.6];
/// Range of breadths in head lengths (1).
const BREADTH: [f64; 2] = [0.5, 4.0];
/// Relative difference between measured and requested box at which the search ends (1).
const NEAR: f64 = 5e-4;
/// Largest relative difference that is accepted (1).
const MISS: f64 = 0.01;
/// Largest number of rounds of measuring: each leaves less than a tenth of the difference.
const ROUNDS: usize = 12;

/// A map of the points of a body: heights by a piecewise linear function, breadths by two ratios, the head
/// scaled evenly in all directions.
struct Map {
    /// Heights of floor, crotch, chin and crown, each before and after the map (m).
    heights: [[f64; 2]; 4],
    /// Ratio of the head (1).
    head: f64,
    /// Ratios of breadth at the hips and at the shoulders (1).
    across: [f64; 2],
    /// Ratio of the arms' lengths and girths (1).
    arm: f64,
    frame: BodyFrame,
}

impl ProportionBox {
    /// The box of a head count: the crotch is interpolated between the next rows of a table, where rows of
    /// the same head count are averaged.
    pub fn of_heads(heads: f64, table: &[ProportionBox]) -> Self {
        let mut known: Vec<[f64; 2]> = table
            .iter()
            .filter_map(|row| Some([row.heads, row.crotch?]))
            .collect();
        known.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mean = |heads: f64| {
            let own = known.iter().filter(|row| row[0] == heads);
            let (sum, count) = own.fold((0.0, 0.0), |(s, n), row| (s + row[1], n + 1.0));
            sum / count
        };
        let above = known.iter().find(|row| row[0] >= heads).map(|row| row[0]);
        let below = known.iter().rfind(|row| row[0] <= heads).map(|row| row[0]);
        let crotch = match (below, above) {
            (Some(a), Some(b)) if a < b => {
                Some(mean(a) + (mean(b) - mean(a)) * (heads - a) / (b - a))
            }
            (Some(a), _) => Some(mean(a) / a * heads),
            (_, Some(b)) => Some(mean(b) / b * heads),
            _ => None,
        };
        Self {
            name: format!("{heads} heads"),
            sex: None,
            age: None,
            heads,
            crotch,
            shoulders: None,
            hips: None,
            source: String::new(),
        }
    }

    /// The proportions that a body has, from its landmarks and the section of its hips.
    pub fn of_body(body: &Mannequin) -> Self {
        let marks = body.landmarks();
        let head = marks.crown.y - marks.chin.y;
        let [left, right] = marks.shoulder_tips;
        Self {
            name: String::new(),
            sex: None,
            age: body.figure().age().map(f64::from),
            heads: marks.crown.y / head,
            crotch: Some(marks.crotch.y / head),
            shoulders: Some((left.x - right.x) / head),
            hips: body.taken("hip_breadth").map(|breadth| breadth / head),
            source: String::new(),
        }
    }

    /// Proportions in which a body with proportions `got` misses these by more than a hundredth of a head:
    /// name, requested and measured value in head lengths (1).
    pub fn missed_by(&self, got: &Self) -> Vec<(&'static str, f64, f64)> {
        /// Difference that is not visible and not shown by two decimals (1).
        const SEEN: f64 = 0.01;
        let rows = [
            ("heads", Some(self.heads), Some(got.heads)),
            ("crotch", self.crotch, got.crotch),
            ("shoulders", self.shoulders, got.shoulders),
            ("hips", self.hips, got.hips),
        ];
        let both = rows
            .into_iter()
            .filter_map(|(name, asked, got)| Some((name, asked?, got?)));
        both.filter(|(_, asked, got)| (asked - got).abs() > SEEN)
            .collect()
    }

    /// Brings a body to these proportions at its own stature; girths of trunk and legs stay, except for the
    /// breadths asked for.
    ///
    /// # Errors
    /// [`BodyError::Description`] for numbers that no body has, or a body without a frame of its own.
    pub fn apply(&self, body: &Description) -> Result<Description, BodyError> {
        self.check()?;
        let Some(frame) = body.frame else {
            return bad("needs a body with a frame of its own: one fitted to a mesh, or framed");
        };
        let first = Mannequin::from_description(body)?;
        let has = Self::of_body(&first);
        let chin = first.landmarks().chin.y;
        let mut head = has.heads / self.heads;
        let mut low = self.wanted_crotch(&has, frame.height);
        let mut across = [1.0, 1.0];
        let mut best: Option<(f64, Description)> = None;
        for round in 0..ROUNDS {
            let done = Map::new(&frame, (chin, head), low, across)?.description(body);
            let got = Self::of_body(&Mannequin::from_description(&done)?);
            let mut furthest = 0.0_f64;
            // The skin's rings shift by steps when the chin moves, and the measured proportions with them:
            // smaller corrections find a position between two steps.
            let share = if round < ROUNDS / 2 { 1.0 } else { 0.5 };
            let mut miss = |asked: Option<f64>, got: Option<f64>| -> f64 {
                match (asked, got) {
                    (Some(asked), Some(got)) if got > 0.0 => {
                        furthest = furthest.max((asked / got - 1.0).abs());
                        (asked / got).powf(share)
                    }
                    _ => 1.0,
                }
            };
            head /= miss(Some(self.heads), Some(got.heads));
            low *= miss(self.crotch, got.crotch);
            across[0] *= miss(self.hips, got.hips);
            across[1] *= miss(self.shoulders, got.shoulders);
            if best.as_ref().is_none_or(|known| furthest < known.0) {
                best = Some((furthest, done));
            }
            if furthest < NEAR {
                break;
            }
        }
        match best {
            Some((miss, done)) if miss < MISS => Ok(done),
            _ => bad("cannot be met on this body: ask for less at a time"),
        }
    }

    /// Height of the frame's crotch at the start of the search (m).
    fn wanted_crotch(&self, has: &Self, height: f64) -> f64 {
        // Without a requested crotch height, the crotch keeps its share of the height below the chin.
        let own = |b: &Self| b.crotch.unwrap_or_default() / (b.heads - 1.0);
        let share = match self.crotch {
            Some(crotch) => crotch / self.heads,
            None => own(has) * (self.heads - 1.0) / self.heads,
        };
        share * height
    }

    fn check(&self) -> Result<(), BodyError> {
        let within = |x: f64, [low, high]: [f64; 2]| (low..=high).contains(&x);
        if !within(self.heads, HEADS) {
            return bad("has a head count that is not between 3 and 10: adults have 7 to 8");
        }
        let crotch = self.crotch.unwrap_or(0.45 * self.heads) / self.heads;
        if !within(crotch, CROTCH) {
            return bad(
                "puts the crotch outside 0.25 to 0.6 of the stature: give it in head lengths",
            );
        }
        let mut breadths = self.shoulders.iter().chain(&self.hips);
        if !breadths.all(|&x| within(x, BREADTH)) {
            return bad(
                "has a breadth that is not between 0.5 and 4 heads: give it in head lengths",
            );
        }
        Ok(())
    }
}

fn bad<T>(what: &str) -> Result<T, BodyError> {
    Err(BodyError::Description(format!("the proportion box {what}")))
}

impl Map {
    fn new(
        frame: &BodyFrame,
        (chin, head): (f64, f64),
        crotch: f64,
        across: [f64; 2],
    ) -> Result<Self, BodyError> {
        let crown = frame.height;
        let heights = [
            [0.0, 0.0],
            [frame.crotch, crotch],
            [chin, crown - head * (crown - chin)],
            [crown, crown],
        ];
        let orderly = heights
            .windows(2)
            .all(|w| w[1][0] - w[0][0] > 0.05 * crown && w[1][1] - w[0][1] > 0.05 * crown);
        if !orderly {
            return bad("leaves no room between floor, crotch and chin");
        }
        let mut map = Self {
            heights,
            head,
            across,
            arm: 1.0,
            frame: *frame,
        };
        // The ratio of an arm is the geometric mean of the ratios of the trunk's length and of the shoulder's
        // height.
        let shoulder = frame.joints.shoulder[1];
        map.arm = (map.steep(shoulder) * map.height(shoulder) / shoulder).sqrt();
        Ok(map)
    }

    fn segment(&self, y: f64) -> [[f64; 2]; 2] {
        let k = self.heights[1..3].iter().filter(|h| h[0] <= y).count();
        [self.heights[k], self.heights[k + 1]]
    }

    /// Height after the map, of a height before the map (m).
    fn height(&self, y: f64) -> f64 {
        let [a, _] = self.segment(y);
        a[1] + (y - a[0]) * self.steep(y)
    }

    /// Ratio of upright lengths at a height (1).
    fn steep(&self, y: f64) -> f64 {
        let [a, b] = self.segment(y);
        (b[1] - a[1]) / (b[0] - a[0])
    }

    /// Ratio of breadths at a height (1): up to the pelvis that of the hips, from the chest on that of the
    /// shoulders.
    fn broad(&self, y: f64) -> f64 {
        let [low, high] = [self.frame.joints.pelvis[1], self.frame.joints.chest[1]];
        let share = smooth_step((y - low) / (high - low));
        self.across[0] + (self.across[1] - self.across[0]) * share
    }

    /// Ratio of breadth and depth of neck and head at a height (1): 1 up to the middle of the neck, from the
    /// chin on the ratio of the head.
    fn round(&self, y: f64) -> f64 {
        let chin = self.heights[2][0];
        let half = 0.5 * (self.frame.joints.neck[1] + chin);
        1.0 + (self.head - 1.0) * smooth_step((y - half) / (chin - half).max(1e-6))
    }

    /// Depth of the axis of neck and head at a height (m): the map does not change it.
    fn axis(&self, y: f64) -> f64 {
        let [neck, head] = [self.frame.joints.neck, self.frame.joints.head];
        let share = ((y - neck[1]) / (head[1] - neck[1])).clamp(0.0, 1.0);
        neck[2] + (head[2] - neck[2]) * share
    }

    /// Maps a point of the trunk or a leg.
    fn trunk(&self, p: [f64; 3]) -> [f64; 3] {
        [p[0] * self.broad(p[1]), self.height(p[1]), p[2]]
    }

    /// Maps a point of neck or head.
    fn head(&self, p: [f64; 3]) -> [f64; 3] {
        let (ratio, axis) = (self.round(p[1]), self.axis(p[1]));
        [
            p[0] * ratio,
            self.height(p[1]),
            axis + (p[2] - axis) * ratio,
        ]
    }

    /// Maps a point of an arm, relative to the shoulder joint.
    fn arm(&self, p: [f64; 3]) -> [f64; 3] {
        let joint = Vec3::from(self.frame.joints.shoulder);
        let there = Vec3::from(self.trunk(joint.into()));
        (there + (Vec3::from(p) - joint) * self.arm).into()
    }

    fn primitive(&self, p: &Primitive) -> Primitive {
        let y = p.centre[1];
        let (centre, along) = match p.part {
            Part::LeftArm | Part::RightArm => (self.arm(p.centre), [self.arm; 3]),
            Part::Head => {
                let ratio = self.round(y);
                (self.head(p.centre), [ratio, self.steep(y), ratio])
            }
            _ => (self.trunk(p.centre), [self.broad(y), self.steep(y), 1.0]),
        };
        let tags = tags(p);
        Primitive {
            centre,
            radii: std::array::from_fn(|k| p.radii[k] * along[tags[k]]),
            ..*p
        }
    }

    fn description(&self, body: &Description) -> Description {
        let mut frame = self.frame;
        let j = self.frame.joints;
        let s = &mut frame.joints;
        [s.hip, s.knee, s.ankle, s.toe] = [j.hip, j.knee, j.ankle, j.toe].map(|p| self.trunk(p));
        [s.pelvis, s.chest, s.neck] = [j.pelvis, j.chest, j.neck].map(|p| self.trunk(p));
        [s.shoulder, s.elbow, s.wrist] = [j.shoulder, j.elbow, j.wrist].map(|p| self.arm(p));
        s.head = self.head(j.head);
        frame.features = frame.features.map(|f| Features {
            thumb: f.thumb.map(|p| self.arm(p)),
        });
        frame.crotch = self.height(frame.crotch);
        frame.armpit = self.height(frame.armpit);
        frame.hand *= self.arm;
        frame.neck_radius *= self.across[1];
        Description {
            primitives: body.primitives.iter().map(|p| self.primitive(p)).collect(),
            frame: Some(frame),
            measurements: toile_measure::Measurements::new(),
            ..body.clone()
        }
    }
}
