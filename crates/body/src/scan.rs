//! Any closed mesh of a standing person as a body to measure: loops of its sections, landmarks
//! found or given, and the same tape as on our own bodies: the convex hull of a section.

use crate::BodyError;
use crate::definitions::{BodyMarks, KNEE, Taping};
use crate::girths::Girth;
use crate::tape::extent;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_geometry::{TriangleMesh, Vec2, Vec3, closed_length, convex_hull};

/// One closed loop of a section of a mesh by a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Corners in order, in the plane's coordinates; for a level plane (x, z) (m).
    pub points: Vec<Vec2>,
}

impl Loop {
    /// Length of the loop itself (m).
    pub fn length(&self) -> f64 {
        closed_length(&self.points)
    }

    /// Length of a tight tape round the loop: of its convex hull (m).
    pub fn girth(&self) -> f64 {
        closed_length(&convex_hull(&self.points))
    }

    /// Extent along both axes of the plane (m).
    pub fn extent(&self) -> [f64; 2] {
        extent(&self.points)
    }

    /// Middle of the extent (m).
    pub fn centre(&self) -> Vec2 {
        let end = |k: usize, pick: fn(f64, f64) -> f64, start: f64| {
            self.points.iter().map(|p| p[k]).fold(start, pick)
        };
        let middle = |k: usize| {
            0.5 * (end(k, f64::min, f64::INFINITY) + end(k, f64::max, f64::NEG_INFINITY))
        };
        Vec2::new(middle(0), middle(1))
    }
}

/// Landmarks of a mesh: heights above its lowest point, and points (m). Landmarks that are left out are
/// searched for; if they cannot be found, the measurements that need them are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScanLandmarks {
    /// Height of the crotch (m).
    pub crotch: Option<f64>,
    /// Height of the fullest hips (m).
    pub hips: Option<f64>,
    /// Height of the waist (m).
    pub waist: Option<f64>,
    /// Height under the bust (m).
    pub underbust: Option<f64>,
    /// Height of the fullest bust or chest (m).
    pub bust: Option<f64>,
    /// Height of the armpits (m).
    pub armpit: Option<f64>,
    /// Height of the knees (m).
    pub knee: Option<f64>,
    /// Base of the neck at the back (m).
    pub nape: Option<[f64; 3]>,
    /// Outer end of the left shoulder, +X (m).
    pub shoulder_tip: Option<[f64; 3]>,
    /// Left side of the neck, +X (m).
    pub neck_side: Option<[f64; 3]>,
    /// Left wrist (m).
    pub wrist: Option<[f64; 3]>,
}

/// A closed mesh of a person standing upright, facing +Z, measured by sections.
pub struct Scan {
    mesh: TriangleMesh,
    /// Height of the lowest point (m).
    pub(crate) floor: f64,
    height: f64,
    /// x of the median plane (m).
    pub(crate) middle: f64,
    landmarks: ScanLandmarks,
}

/// Step of the search for the crotch, as a share of stature.
const CROTCH_STEP: f64 = 0.001;
/// Step of the search for the armpits, as a share of stature.
const ARMPIT_STEP: f64 = 0.002;
/// Number of halvings of the step in which crotch or armpits lie.
const HALVINGS: usize = 8;
/// Sudden increase in the trunk's breadth where arms join it, as a share of stature.
const ARM_BREADTH: f64 = 0.05;
/// Height of the crotch of an upright person, as a share of stature, used if the search for it fails.
const CROTCH: f64 = 0.46;
/// Height of the waist, as a share of stature: the searches for crotch and armpits start there or near it.
const WAIST: f64 = 0.6;
/// Height of the armpits, as a share of stature, used if the search for them fails.
const ARMPIT: f64 = 0.74;
/// Highest armpit, as a share of stature.
const ARMPIT_MOST: f64 = 0.85;
/// Length of a loop as a share of stature below which it is a finger or a toe.
const LIMB: f64 = 0.03;

impl Scan {
    /// Takes a mesh in metres, Y up, with landmarks, and searches for the landmarks that are left out.
    ///
    /// # Errors
    /// [`BodyError::Mesh`] for a mesh that is not closed and outward, or smaller than a doll or larger than a
    /// giant, or a landmark outside it.
    pub fn new(mesh: TriangleMesh, landmarks: ScanLandmarks) -> Result<Self, BodyError> {
        let bad = |what: &str| Err(BodyError::Mesh(what.to_owned()));
        if mesh.check().is_err() {
            return bad("has a corner that points nowhere or is not finite: repair the file");
        }
        let Some([low, high]) = mesh.bounds() else {
            return bad("is empty");
        };
        if !mesh.is_closed_and_oriented() {
            return bad("is not a closed surface: close its holes and join its shells");
        }
        let height = high.y - low.y;
        if !(0.12..6.0).contains(&height) {
            return bad(
                "is not between 0.12 and 6 m tall along Y: give metres, Y up, or say its unit and which axis is up",
            );
        }
        if mesh.volume() <= 0.0 {
            return bad("is inside out: turn its triangles round");
        }
        let given = [
            landmarks.crotch,
            landmarks.hips,
            landmarks.waist,
            landmarks.underbust,
            landmarks.bust,
            landmarks.armpit,
            landmarks.knee,
        ];
        let outside = |y: f64| !(0.0..=height).contains(&y);
        if given.iter().flatten().any(|&y| outside(y)) {
            return bad(
                "has a landmark that is not between floor and crown: give heights in metres",
            );
        }
        let mut scan = Self {
            floor: low.y,
            height,
            middle: 0.5 * (low.x + high.x),
            mesh,
            landmarks,
        };
        scan.find();
        Ok(scan)
    }

    /// Shift that makes the mesh stand on y = 0 centred at x = 0 (m).
    pub(crate) fn shift(&self) -> Vec3 {
        -Vec3::new(self.middle, self.floor, 0.0)
    }

    /// The scan with its mesh and landmarks shifted (m).
    pub(crate) fn moved(&self, shift: Vec3) -> Result<Self, BodyError> {
        let mut mesh = self.mesh.clone();
        for p in &mut mesh.positions {
            *p += shift;
        }
        let moved = |p: Option<[f64; 3]>| p.map(|p| (Vec3::from(p) + shift).into());
        let l = &self.landmarks;
        let landmarks = ScanLandmarks {
            nape: moved(l.nape),
            shoulder_tip: moved(l.shoulder_tip),
            neck_side: moved(l.neck_side),
            wrist: moved(l.wrist),
            ..l.clone()
        };
        Self::new(mesh, landmarks)
    }

    /// The mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Height from floor to crown (m).
    pub fn height(&self) -> f64 {
        self.height
    }

    /// The landmarks, given and found.
    pub fn landmarks(&self) -> &ScanLandmarks {
        &self.landmarks
    }

    /// The loops of the level section at a height above the lowest point (m).
    pub fn level(&self, height: f64) -> Vec<Loop> {
        let origin = Vec3::new(0.0, self.floor + height, 0.0);
        self.section(origin, [Vec3::x(), Vec3::z()])
    }

    /// The loops of the section by the plane through a point along two unit axes.
    pub fn section(&self, origin: Vec3, [first, second]: [Vec3; 2]) -> Vec<Loop> {
        let normal = second.cross(&first);
        let side = |v: u32| (self.mesh.positions[v as usize] - origin).dot(&normal);
        // For each triangle: the edge where its segment begins, and the edge where it ends.
        let mut next: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
        for triangle in &self.mesh.triangles {
            let heights = triangle.map(side);
            let (mut from, mut to) = (None, None);
            for k in 0..3 {
                let (i, j) = (k, (k + 1) % 3);
                let edge = [triangle[i].min(triangle[j]), triangle[i].max(triangle[j])];
                match (heights[i] >= 0.0, heights[j] >= 0.0) {
                    (true, false) => from = Some(edge),
                    (false, true) => to = Some(edge),
                    _ => {}
                }
            }
            if let (Some(from), Some(to)) = (from, to) {
                next.insert(from, to);
            }
        }
        let at = |[a, b]: [u32; 2]| {
            let (u, v) = (side(a), side(b));
            let [a, b] = [a, b].map(|v| self.mesh.positions[v as usize]);
            let offset = a + (b - a) * (u / (u - v)) - origin;
            Vec2::new(offset.dot(&first), offset.dot(&second))
        };
        let mut loops = Vec::new();
        while let Some((start, mut edge)) = next.pop_first() {
            let mut points = vec![at(start)];
            while edge != start {
                points.push(at(edge));
                match next.remove(&edge) {
                    Some(further) => edge = further,
                    None => break,
                }
            }
            loops.push(Loop { points });
        }
        loops
    }

    /// The trunk's loop at a height: the loop that crosses the median plane; the longest if there are
    /// several.
    pub fn trunk(&self, height: f64) -> Option<Loop> {
        self.trunk_of(&self.level(height)).cloned()
    }

    /// The left leg's loop at a height: the innermost on the left, below the crotch.
    pub fn leg(&self, height: f64) -> Option<Loop> {
        self.leg_of(&self.level(height)).cloned()
    }

    /// The left arm's loop beside the trunk at a height: the outermost on the left.
    pub(crate) fn arm(&self, height: f64) -> Option<Loop> {
        self.arm_of(&self.level(height)).cloned()
    }

    /// The loop of the trunk among the loops of a level.
    pub(crate) fn trunk_of<'a>(&self, loops: &'a [Loop]) -> Option<&'a Loop> {
        let holds = |l: &&Loop| {
            let left = l.points.iter().any(|p| p.x < self.middle);
            left && l.points.iter().any(|p| p.x > self.middle)
        };
        loops
            .iter()
            .filter(holds)
            .max_by(|a, b| a.length().total_cmp(&b.length()))
    }

    /// The loop of the left leg among the loops of a level.
    pub(crate) fn leg_of<'a>(&self, loops: &'a [Loop]) -> Option<&'a Loop> {
        loops
            .iter()
            .filter(|l| l.centre().x > self.middle && l.length() > LIMB * self.height)
            .min_by(|a, b| a.centre().x.total_cmp(&b.centre().x))
    }

    /// The loop of the left arm among the loops of a level.
    pub(crate) fn arm_of<'a>(&self, loops: &'a [Loop]) -> Option<&'a Loop> {
        let trunk = self.trunk_of(loops)?;
        let side = trunk.centre().x + 0.5 * trunk.extent()[0];
        loops
            .iter()
            .filter(|l| l.centre().x > side)
            .max_by(|a, b| a.centre().x.total_cmp(&b.centre().x))
    }

    /// Searches for the heights that were not given.
    fn find(&mut self) {
        if self.landmarks.crotch.is_none() {
            self.landmarks.crotch = self.lowest_trunk();
        }
        if self.landmarks.armpit.is_none() {
            self.landmarks.armpit = self.under_the_arm();
        }
        let body = self.body();
        let level = |given: Option<f64>, girth: Girth| {
            given.or_else(|| {
                let taping = Taping::of(girth, &body)?;
                taping.find(|y| Some(self.trunk(y)?.girth()))
            })
        };
        let l = self.landmarks.clone();
        self.landmarks = ScanLandmarks {
            hips: level(l.hips, Girth::Hips),
            waist: level(l.waist, Girth::Waist),
            underbust: level(l.underbust, Girth::Underbust),
            bust: level(l.bust, Girth::Bust),
            knee: Some(body.knee),
            ..l
        };
    }

    /// Landmarks that determine the positions of the girths, except for those of the arm.
    pub(crate) fn body(&self) -> BodyMarks {
        let (h, l) = (self.height, &self.landmarks);
        let crotch = l.crotch.unwrap_or(CROTCH * h);
        BodyMarks {
            stature: h,
            crotch,
            armpit: l.armpit.unwrap_or(ARMPIT * h),
            knee: l.knee.unwrap_or(KNEE * crotch),
            arm: [0.0; 2],
        }
    }

    /// The crotch: from the waist down, the last level at which one loop as long as a trunk's crosses the
    /// median plane.
    fn lowest_trunk(&self) -> Option<f64> {
        let h = self.height;
        let is_trunk = |y: f64| self.trunk(y).is_some_and(|l| l.length() > 0.2 * h);
        let mut y = WAIST * h;
        while y > 0.3 * h && is_trunk(y) {
            y -= CROTCH_STEP * h;
        }
        (y > 0.3 * h).then(|| between([y, y + CROTCH_STEP * h], is_trunk))
    }

    /// The armpit: from the waist up, the first level with no arm beside the trunk, or, for arms held level,
    /// the level at which the trunk is suddenly broader.
    fn under_the_arm(&self) -> Option<f64> {
        let h = self.height;
        let broad = |y: f64| self.trunk(y).map_or(0.0, |l| l.extent()[0]);
        let from = (WAIST + 0.02) * h;
        let mut y = from;
        while y < ARMPIT_MOST * h {
            let has_arm = self.arm(y).is_some();
            let next = y + ARMPIT_STEP * h;
            let joins = |y: f64| match has_arm {
                true => self.arm(y).is_none(),
                false => broad(y) > broad(next - ARMPIT_STEP * h) + ARM_BREADTH * h,
            };
            if joins(next) {
                return (y > from + 0.01 * h).then(|| between([y, next], joins));
            }
            y = next;
        }
        None
    }
}

/// Position between two given positions at which a condition begins to hold: it is false at the first and
/// true at the second.
fn between([mut without, mut with]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (without + with);
        match holds(middle) {
            true => with = middle,
            false => without = middle,
        }
    }
    0.5 * (without + with)
}
