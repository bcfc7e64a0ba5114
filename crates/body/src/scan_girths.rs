//! The tape on a foreign mesh: every measurement its landmarks allow.

use crate::arm_rings::{arm_rings, finger_tip};
use crate::definitions::{BodyMarks, Cut, NECK_TILT, Taping};
use crate::girths::Girth;
use crate::{Loop, Scan};
use toile_geometry::Vec3;
use toile_measure::{Measurements, Origin};

/// Range of the narrowest level of the neck: least height above the armpits and least depth below the crown,
/// as a share of stature.
const NECK: [f64; 2] = [0.03, 0.07];
/// Distance between the levels tried for the neck, as a share of stature.
const NECK_STEP: f64 = 0.0025;
/// Length of a loop as a share of stature below which it is a finger or an ear.
const LIMB: f64 = 0.04;
/// Length of a loop of the neck as a share of stature below which it belongs to the mouth.
const MIN_NECK: f64 = 0.12;

/// Middle line of the left arm from the shoulder to the finger tips (m).
struct ArmPath {
    middles: Vec<Vec3>,
    /// Distance of each point from the first along the arm (m).
    along: Vec<f64>,
}

impl ArmPath {
    /// `None` if no arm can be separated from the trunk.
    fn of(scan: &Scan, armpit: f64) -> Option<Self> {
        let tip = finger_tip(scan);
        let mut middles: Vec<Vec3> = arm_rings(scan, tip, armpit).iter().map(|r| r.0).collect();
        if middles.len() < 12 {
            return None;
        }
        middles.insert(0, tip);
        middles.reverse();
        let mut along = vec![0.0];
        for pair in middles.windows(2) {
            along.push(along[along.len() - 1] + (pair[1] - pair[0]).norm());
        }
        Some(Self { middles, along })
    }

    /// Point and direction at a distance along the arm.
    fn at(&self, distance: f64) -> [Vec3; 2] {
        let last = self.middles.len() - 1;
        let next = self.along.partition_point(|d| *d < distance).clamp(1, last);
        let [a, b] = [next - 1, next].map(|k| self.middles[k]);
        let share = (distance - self.along[next - 1]) / (self.along[next] - self.along[next - 1]);
        // Averaged over several sections: the centre of a single section wavers.
        let [from, to] = [next.saturating_sub(4), (next + 3).min(last)];
        let way = self.middles[to] - self.middles[from];
        [a + (b - a) * share, way.normalize()]
    }

    /// Distance along the arm of a point near its beginning, also of a point on the straight line before the
    /// beginning.
    fn along(&self, p: Vec3) -> f64 {
        let [start, way] = self.at(0.0);
        (p - start).dot(&way)
    }
}

impl Scan {
    /// Every measurement that the landmarks allow, as a table to make a body from or to draft a pattern to
    /// (m). Girths are taped as on our own bodies.
    pub fn measurements(&self) -> Measurements {
        let mut table = Measurements::new();
        let mut put = |name: &str, value: Option<f64>| {
            if let Some(value) = value.filter(|v| v.is_finite() && *v > 0.0) {
                let _ = table.set(name, value, Origin::Asked);
            }
        };
        let (h, l) = (self.height(), self.landmarks());
        put("height", Some(h));
        for (girth, value) in self.girths() {
            put(girth.name(), value);
        }
        for (names, level) in [
            (["waist_breadth", "waist_depth"], l.waist),
            (["hip_breadth", "hip_depth"], l.hips),
        ] {
            let found = level.and_then(|y| Some(self.trunk(y)?.extent()));
            put(names[0], found.map(|e| e[0]));
            put(names[1], found.map(|e| e[1]));
        }
        put("inside_leg", l.crotch);
        put("waist_height", l.waist);
        put("hip_height", l.hips);
        put("bust_height", l.bust);
        put("armpit_height", l.armpit);
        let up = |p: [f64; 3]| p[1] - self.floor;
        put("nape_height", l.nape.map(up));
        put("head_l", l.nape.map(|p| h - up(p)));
        put("waist_line", l.nape.zip(l.waist).map(|(p, y)| up(p) - y));
        put("shoulder_height", l.shoulder_tip.map(up));
        let across = |p: [f64; 3]| 2.0 * (p[0] - self.middle).abs();
        put("shoulder_w", l.shoulder_tip.map(across));
        put("neck_w", l.neck_side.map(across));
        let far = |(a, b): ([f64; 3], [f64; 3])| (Vec3::from(a) - Vec3::from(b)).norm();
        put("shoulder_length", l.neck_side.zip(l.shoulder_tip).map(far));
        put("arm_length", l.shoulder_tip.zip(l.wrist).map(far));
        table
    }

    /// Every girth that the tape can take (m).
    fn girths(&self) -> Vec<(Girth, Option<f64>)> {
        let mut body = self.body();
        let l = self.landmarks();
        let arm = l.armpit.and_then(|armpit| ArmPath::of(self, armpit));
        let fold = self.fold(&body);
        if let Some(arm) = &arm {
            body.arm = [arm.along(fold), arm.along[arm.along.len() - 1]];
        }
        let neck = self.neck_middle(&body);
        let found = Girth::ALL.into_iter().filter_map(|girth| {
            let taping = Taping::of(girth, &body)?;
            let around = |place: f64| match taping.cut {
                Cut::Trunk | Cut::Head => Some(self.trunk(place)?.girth()),
                Cut::Leg => Some(self.leg(place)?.girth()),
                Cut::Neck => self.around_neck(neck? + Vec3::y() * place),
                Cut::Arm => self.across_arm(arm.as_ref()?.at(place)),
            };
            let given = match girth {
                Girth::Bust => l.bust,
                Girth::Underbust => l.underbust,
                Girth::Waist => l.waist,
                Girth::Hips => l.hips,
                _ => taping.find(around),
            };
            Some((girth, given.and_then(around)))
        });
        found.collect()
    }

    /// The point in the fold between the left arm and the trunk (m).
    fn fold(&self, body: &BodyMarks) -> Vec3 {
        let beside = self.trunk(body.armpit - 0.002 * body.stature);
        let side = beside.map_or(0.1 * body.stature, |l| {
            l.centre().x - self.middle + 0.5 * l.extent()[0]
        });
        Vec3::new(self.middle + side, self.floor + body.armpit, 0.0)
    }

    /// Centre of the narrowest level section between shoulders and head (m).
    fn neck_middle(&self, body: &BodyMarks) -> Option<Vec3> {
        let h = body.stature;
        let [low, high] = [body.armpit + NECK[0] * h, (1.0 - NECK[1]) * h];
        let count = ((high - low) / (NECK_STEP * h)).max(0.0) as usize;
        let (y, narrowest) = (0..=count)
            .map(|k| low + NECK_STEP * h * k as f64)
            .filter_map(|y| Some((y, self.trunk(y)?)))
            .min_by(|a, b| a.1.girth().total_cmp(&b.1.girth()))?;
        let middle = narrowest.centre();
        Some(Vec3::new(self.middle, self.floor + y, middle.y))
    }

    /// Girth of a neck through a point at its centre (m).
    fn around_neck(&self, middle: Vec3) -> Option<f64> {
        let (sin, cos) = NECK_TILT.sin_cos();
        let loops = self.section(middle, [Vec3::x(), Vec3::new(0.0, -sin, cos)]);
        self.round_the_middle(loops, MIN_NECK)
    }

    /// Girth across the arm through a point at its centre (m).
    fn across_arm(&self, [middle, along]: [Vec3; 2]) -> Option<f64> {
        let first = along.cross(&Vec3::z()).try_normalize(1e-9)?;
        self.round_the_middle(self.section(middle, [first, first.cross(&along)]), LIMB)
    }

    /// Girth of the loop whose centre is nearest to the section's origin, among loops at least `least` times
    /// as long as the stature (m).
    fn round_the_middle(&self, loops: Vec<Loop>, least: f64) -> Option<f64> {
        let far = |l: &Loop| l.centre().norm();
        let nearest = loops
            .into_iter()
            .filter(|l| l.length() > least * self.height())
            .min_by(|a, b| far(a).total_cmp(&far(b)))?;
        Some(nearest.girth())
    }
}
