//! The map from a template to a body of given measurements.
//!
//! Trunk and head: `(x, y, z) -> (x s_l(y), Y(y), z s_f(y))`, with one s_f before and one behind
//! the plane z = 0, so that with `s_l = s_f` a section and the tape round it scale exactly. Legs and arms: the same about their own axes. Between the
//! parts the maps are blended over a few rings of the skin.

use crate::bands::Near;
use crate::curve::{Monotone, smooth_step};
use crate::girths::{Girth, PerGirth};
use crate::rings::at_length;
use crate::template::Template;
use crate::template_marks::{CROTCH_PLACES, TemplateMarks};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// What the shape of a body depends on, all for one template. Heights come in pairs: on the
/// template and on the body [m].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// Heights from the floor up.
    pub(crate) levels: Vec<[f64; 2]>,
    /// Lateral scale of trunk and head over template height.
    pub(crate) lateral: Vec<[f64; 2]>,
    /// Frontal scale of trunk and head before the plane z = 0, over template height.
    pub(crate) front: Vec<[f64; 2]>,
    /// The same behind it.
    pub(crate) back: Vec<[f64; 2]>,
    /// How much farther out the corners of a section lie at equal breadth and depth [1], over
    /// template height.
    pub(crate) corners: Vec<[f64; 2]>,
    /// The same beyond it before the middle, and short of it behind.
    pub(crate) folds: Vec<[f64; 2]>,
    /// Scale of the leg about its axis over template height.
    pub(crate) leg: Vec<[f64; 2]>,
    /// Scale of the arm about its axis over template distance from the shoulder joint.
    pub(crate) arm: Vec<[f64; 2]>,
    /// Distance along the arm's axis from the shoulder joint, on template and body [m].
    pub(crate) arm_length: Vec<[f64; 2]>,
    /// Angle of the arm below the horizontal [rad].
    pub(crate) arm_angle: f64,
    /// Ratio of statures, body to template.
    pub(crate) global: f64,
    /// Sideways scale of the legs' axes.
    pub(crate) stance: f64,
    /// How much broader the tops of the legs are, and how much less deep [1].
    pub(crate) leg_form: f64,
    /// Template depth that becomes z = 0 [m].
    pub(crate) depth: f64,
    /// Depth about which sections of trunk, neck and head are scaled, over template height.
    pub(crate) middle: Vec<[f64; 2]>,
    /// The same on the body.
    pub(crate) middle_to: Vec<[f64; 2]>,
    /// Rise of the ends of the shoulders over what the levels give them [m].
    pub(crate) shoulder_rise: f64,
    /// Rise of the armpits over what the levels give them [m].
    pub(crate) armpit_rise: f64,
    /// How far the bust points are apart over what the sections give them, less one.
    pub(crate) bust_spread: f64,
    /// How far the bust points stand forward of what the sections give them [m].
    pub(crate) bust_bulge: f64,
    /// How flat the crotch lies from front to back: none is as on the template, one is level.
    pub(crate) flat: f64,
    /// Depth of the sides before which a part of a girth lies [m].
    pub(crate) sides: PerGirth<f64>,
    /// Depth of the middle of the crotch over the lowest place's [m].
    pub(crate) fork: f64,
}

/// How far sideways, up and down a bust reaches from its point, over stature.
const BULGE: [f64; 3] = [0.06, 0.10, 0.045];

/// How far sideways, up and down a crotch that lies flat is felt, over stature.
const FLAT: [f64; 3] = [0.06, 0.15, 0.10];

/// Way down the thigh on which the form of the leg's top goes out, over stature.
const LEG_TOP: f64 = 0.09;

/// How far a point follows a limb instead of the trunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follow {
    pub(crate) arm: f64,
    pub(crate) leg: f64,
}

/// Rises of the body's middle over the crotch by their depth [m].
fn fork(marks: &TemplateMarks) -> Vec<[f64; 2]> {
    (0..CROTCH_PLACES)
        .map(|k| [marks.crotch_depth(k), marks.crotch.rise[k]])
        .collect()
}

/// The map, for points of the left half, x >= 0.
#[derive(Clone)]
pub(crate) struct Warp {
    level: Monotone,
    lateral: Monotone,
    front: Monotone,
    back: Monotone,
    corners: Monotone,
    folds: Monotone,
    sections: [Monotone; 3],
    leg: Monotone,
    arm: Monotone,
    arm_length: Monotone,
    middle: Monotone,
    middle_to: Monotone,
    fork: Monotone,
    marks: TemplateMarks,
    shape: Shape,
    leg_axis: [Vec3; 3],
    shoulder: Vec3,
    /// Shoulder, elbow and wrist, where the map leaves everything as it is.
    still: Option<[Vec3; 3]>,
    arm_from: [Vec3; 2],
    arm_to: [Vec3; 2],
}

impl Warp {
    pub(crate) fn new(template: &Template, marks: &TemplateMarks, shape: Shape) -> Self {
        let j = template.joints;
        let shoulder = Vec3::from(j.shoulder);
        let along = (Vec3::from(j.wrist) - shoulder).normalize();
        let target = Vec3::new(shape.arm_angle.cos(), -shape.arm_angle.sin(), 0.0);
        Self {
            level: Monotone::new(shape.levels.clone()),
            lateral: Monotone::new(shape.lateral.clone()),
            front: Monotone::new(shape.front.clone()),
            back: Monotone::new(shape.back.clone()),
            corners: Monotone::new(shape.corners.clone()),
            folds: Monotone::new(shape.folds.clone()),
            sections: [1, 2, 3]
                .map(|k| Monotone::new(marks.trunk.sections.map(|row| [row[0], row[k]]).into())),
            leg: Monotone::new(shape.leg.clone()),
            arm: Monotone::new(shape.arm.clone()),
            arm_length: Monotone::new(shape.arm_length.clone()),
            middle: Monotone::new(shape.middle.clone()),
            middle_to: Monotone::new(shape.middle_to.clone()),
            fork: Monotone::new(fork(marks)),
            marks: *marks,
            leg_axis: [j.hip, j.knee, j.ankle].map(Vec3::from),
            shoulder,
            still: None,
            arm_from: [along, Vec3::z().cross(&along)],
            arm_to: [target, Vec3::z().cross(&target)],
            shape,
        }
    }

    /// The map that leaves everything as it is.
    pub(crate) fn still(template: &Template, marks: &TemplateMarks) -> Self {
        let level = |y: f64| [y, y];
        let one = vec![[0.0, 1.0], [marks.crown, 1.0]];
        let none = vec![[0.0, 0.0], [marks.crown, 0.0]];
        let j = template.joints;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        let along = wrist - shoulder;
        let shape = Shape {
            levels: [0.0, marks.crown].map(level).into(),
            lateral: one.clone(),
            front: one.clone(),
            back: one.clone(),
            corners: none.clone(),
            folds: none.clone(),
            leg: one.clone(),
            arm: one,
            arm_length: [0.0, along.norm()].map(level).into(),
            arm_angle: (-along.y).atan2(along.x),
            global: 1.0,
            stance: 1.0,
            leg_form: 1.0,
            depth: 0.0,
            middle: none.clone(),
            middle_to: none,
            shoulder_rise: 0.0,
            armpit_rise: 0.0,
            bust_spread: 0.0,
            bust_bulge: 0.0,
            flat: 0.0,
            sides: PerGirth::of(|_| 0.0),
            fork: 0.0,
        };
        Self {
            still: Some([shoulder, elbow, wrist]),
            ..Self::new(template, marks, shape)
        }
    }

    /// Whether it leaves everything as it is.
    pub(crate) fn is_still(&self) -> bool {
        self.still.is_some()
    }

    fn trunk(&self, p: Vec3) -> Vec3 {
        let [shoulder, armpit] = self.rise(p);
        // What rises with the armpit has the scale of where it comes to.
        let y = p.y + armpit / self.shape.global;
        let fuller = self.fuller(Vec3::new(p.x, y, p.z));
        let depth = (p.z - self.middle.at(y)) * fuller;
        // From the back's scale to the front's over the middle of the body.
        let before = smooth_step(0.5 + depth / (0.09 * self.marks.crown));
        let [front, back] = [self.front.at(y), self.back.at(y)];
        let frontal = back + (front - back) * before;
        Vec3::new(
            p.x * fuller * self.lateral.at(y) * (1.0 + self.spread(p, depth)),
            self.level.at(p.y - self.sunk(p)) + shoulder + armpit,
            self.middle_to.at(y) + depth * frontal + self.bulge(p, depth),
        )
    }

    /// How far a place stands forward with its bust point [m]: all of it there, nothing beyond the
    /// bust.
    fn bulge(&self, p: Vec3, depth: f64) -> f64 {
        let m = &self.marks;
        let [across, up, down] = BULGE.map(|reach| reach * m.crown);
        let high = p.y - m.bust.height;
        let u = ((p.x - m.bust.point.x) / across).powi(2);
        if self.shape.bust_bulge == 0.0 || u >= 1.0 || high >= up || high <= -down || depth <= 0.0 {
            return 0.0;
        }
        let before = smooth_step(depth / (0.04 * m.crown));
        // Round above, evenly back to the fold below.
        let upright = match high > 0.0 {
            true => (1.0 - (high / up).powi(4)).powi(2),
            false => 1.0 - (-high / down).powf(1.3),
        };
        let full = (1.0 - u * u).powi(2) * upright;
        self.shape.bust_bulge * full * before
    }

    /// By how much a place of the trunk lies farther out from the middle of its section: with its
    /// direction t in a section brought to breadth and depth one, `1 + c sin^2(2 t)`, so that
    /// breadth and depth stay and the corners between them fill.
    fn fuller(&self, p: Vec3) -> f64 {
        let depth = p.z - self.marks.trunk.middle_depth;
        let [corners, folds] = [&self.corners, &self.folds].map(|curve| curve.at(p.y));
        let corners = corners + folds.copysign(depth * folds);
        if corners == 0.0 {
            return 1.0;
        }
        // Below and above the sections that are known, those at the ends.
        let [first, last] = [self.marks.trunk.sections[0][0], self.marks.bust.height];
        let y = p.y.clamp(first, last);
        let [breadth, front, back] = [0, 1, 2].map(|k| self.sections[k].at(y));
        let u = (p.x / breadth).powi(2);
        let v = (depth / if depth > 0.0 { front } else { back }).powi(2);
        1.0 + corners * 4.0 * u * v / (u + v).max(0.5).powi(2)
    }

    /// Share by which a place in front of the chest goes sideways with the bust points: all of it
    /// there, nothing at the sides, above and below.
    fn spread(&self, p: Vec3, depth: f64) -> f64 {
        let m = &self.marks;
        let half = 1.02 * m.shoulder.tip.x;
        let u = (p.x / half).powi(2);
        let v = ((p.y - m.bust.height) / (0.055 * m.crown)).powi(2);
        if u >= 1.0 || v >= 1.0 || depth <= 0.0 {
            return 0.0;
        }
        let before = smooth_step(depth / (0.04 * m.crown));
        self.shape.bust_spread * ((1.0 - u) * (1.0 - v)).powi(2) * before
    }

    /// Rise of a place with the end of the shoulder and with the armpit [m]: all of it there, nothing
    /// at the neck and at the bust.
    fn rise(&self, p: Vec3) -> [f64; 2] {
        let m = &self.marks;
        let inner = 0.92 * m.neck.side.x;
        // Almost straight from the neck, level at the end.
        let out = ((p.x - inner) / (m.shoulder.tip.x - inner)).clamp(0.0, 1.0);
        let out = out * (1.5 - 0.5 * out * out);
        let up = smooth_step((p.y - m.bust.height) / (m.shoulder.tip.y - m.bust.height));
        let to_armpit = smooth_step(1.0 - (m.armpit.height - p.y) / (0.06 * m.crown));
        let from_armpit =
            smooth_step(1.0 - (p.y - m.armpit.height) / (m.shoulder.tip.y - m.armpit.height));
        let armpit = self.shape.armpit_rise * to_armpit.min(from_armpit);
        [self.shape.shoulder_rise * up * out, armpit * out]
    }

    /// How much lower on the template a place comes from where the crotch lies flatter [m]: the
    /// body's middle sinks by a share of its rise over the crotch, what is beside it less.
    fn sunk(&self, p: Vec3) -> f64 {
        let m = &self.marks;
        let [side, up, down] = FLAT.map(|reach| reach * m.crown);
        let high = p.y - m.crotch.height;
        if self.shape.flat == 0.0 || p.x >= side || high >= up || high <= -down {
            return 0.0;
        }
        let beside = smooth_step(1.0 - p.x / side);
        // What sinks deepest goes on from there.
        let top = 0.3 * up;
        let far = match high > 0.0 {
            true => smooth_step((up - high) / (up - top)),
            false => smooth_step((down + high) / down),
        };
        let ends = [0, CROTCH_PLACES - 1].map(|k| m.crotch_depth(k));
        self.shape.flat * self.fork.at(p.z.clamp(ends[0], ends[1])) * beside * far
    }

    /// The axis of the leg at a height.
    fn leg_axis_at(&self, y: f64) -> Vec3 {
        let [hip, knee, ankle] = self.leg_axis;
        let line = |a: Vec3, b: Vec3| a + (b - a) * ((a.y - y) / (a.y - b.y));
        if y > knee.y {
            line(hip, knee)
        } else if y > ankle.y {
            line(knee, ankle)
        } else {
            at_length(&[ankle], 0.0)
        }
    }

    fn leg(&self, p: Vec3) -> Vec3 {
        let axis = self.leg_axis_at(p.y);
        let scale = self.leg.at(p.y);
        // From the hips' form at the crotch to none.
        let top =
            smooth_step(1.0 - (self.marks.crotch.height - p.y) / (LEG_TOP * self.marks.crown));
        let form = 1.0 + (self.shape.leg_form - 1.0) * top;
        Vec3::new(
            axis.x * self.shape.stance + (p.x - axis.x) * scale * form,
            self.level.at(p.y - self.sunk(p)),
            (axis.z - self.shape.depth) * self.shape.global + (p.z - axis.z) * scale / form,
        )
    }

    fn arm(&self, p: Vec3) -> Vec3 {
        let offset = p - self.shoulder;
        let distance = offset.dot(&self.arm_from[0]);
        let scale = self.arm.at(distance);
        self.trunk(self.shoulder)
            + self.arm_to[0] * self.arm_length.at(distance)
            + self.arm_to[1] * (offset.dot(&self.arm_from[1]) * scale)
            + Vec3::z() * (offset.z * scale)
    }

    /// The place on the body of a place on the template.
    pub(crate) fn apply(&self, p: Vec3, follow: Follow) -> Vec3 {
        if self.is_still() {
            return p;
        }
        let mut mapped = self.trunk(p);
        if follow.arm > 0.0 {
            mapped += (self.arm(p) - mapped) * follow.arm;
        }
        if follow.leg > 0.0 {
            mapped += (self.leg(p) - mapped) * follow.leg;
        }
        mapped
    }

    /// Depth of the sides of a girth, before which its front part lies [m].
    pub(crate) fn side_of(&self, girth: Girth) -> f64 {
        self.shape.sides[girth]
    }

    /// Depth of the middle of the crotch on the body [m].
    pub(crate) fn crotch_point(&self) -> f64 {
        let m = &self.marks;
        let lowest = Vec3::new(0.0, m.crotch.height, m.crotch_depth(CROTCH_PLACES / 2));
        self.apply(lowest, Follow::default()).z + self.shape.fork
    }

    /// Least and largest sideways scale of any place of trunk and head [1].
    pub(crate) fn sideways(&self) -> [f64; 2] {
        if self.is_still() {
            return [1.0; 2];
        }
        let s = &self.shape;
        let most = |rows: &[[f64; 2]]| rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
        let fuller = most(&s.corners) + most(&s.folds);
        let scales = s.lateral.iter().map(|row| row[1]);
        let low = scales.clone().fold(f64::INFINITY, f64::min);
        let high = scales.fold(0.0, f64::max);
        let spread = |end: f64| (s.bust_spread * end).max(0.0);
        [
            low * (1.0 - fuller).max(0.1) * (1.0 - spread(-1.0)).max(0.1),
            high * (1.0 + fuller) * (1.0 + spread(1.0)),
        ]
    }

    /// The template's height of a height of the body [m].
    pub(crate) fn template_level(&self, height: f64) -> f64 {
        self.level.inverse(height)
    }

    /// Where on the template lies what may cross a height of the body [m], within a reach: what
    /// rises or sinks with shoulders and armpits comes from farther off.
    pub(crate) fn near(&self, height: f64, reach: f64) -> Near {
        let moved = [self.shape.shoulder_rise, self.shape.armpit_rise]
            .map(|rise| 1.6 * rise / self.shape.global);
        let mut up: f64 = moved.iter().map(|r| r.max(0.0)).sum();
        let mut down: f64 = moved.iter().map(|r| (-r).max(0.0)).sum();
        let at = self.template_level(height);
        if at < self.marks.crotch.height + FLAT[1] * self.marks.crown {
            let most = self
                .marks
                .crotch
                .rise
                .iter()
                .fold(0.0, |a: f64, &b| a.max(b));
            down += self.shape.flat.max(0.0) * most;
            up += (-self.shape.flat).max(0.0) * most;
        }
        Near::Level([at - reach - up, at + reach + down])
    }

    /// The plane across the arm at a template distance from the shoulder joint: a point of the
    /// axis and its direction.
    pub(crate) fn arm_plane(&self, distance: f64) -> [Vec3; 2] {
        if let Some([shoulder, elbow, wrist]) = self.still {
            // Across the bone at the place whose distance along the straight line is this.
            let straight = (wrist - shoulder).normalize();
            let at = (elbow - shoulder).dot(&straight);
            let (from, to, before) = match distance < at {
                true => (shoulder, elbow, 0.0),
                false => (elbow, wrist, at),
            };
            let along = (to - from).normalize();
            let way = (distance - before) / along.dot(&straight).max(0.1);
            return [from + along * way, along];
        }
        let along = self.arm_to[0] * self.arm_length.at(distance);
        [self.trunk(self.shoulder) + along, self.arm_to[0]]
    }

    /// The template distance of a distance along the body's arm from the shoulder joint [m].
    pub(crate) fn arm_distance(&self, along: f64) -> f64 {
        match self.is_still() {
            true => along,
            false => self.arm_length.inverse(along),
        }
    }

    /// The distance along the body's arm from the shoulder joint at which a point lies [m].
    pub(crate) fn along_arm(&self, p: Vec3) -> f64 {
        let [shoulder, along] = match self.still {
            Some([shoulder, _, wrist]) => [shoulder, (wrist - shoulder).normalize()],
            None => self.arm_plane(0.0),
        };
        (p - shoulder).dot(&along)
    }

    /// What the map makes of three axes laid through a place: half the way between the images of
    /// their two ends.
    pub(crate) fn carried_axes(&self, p: Vec3, axes: Matrix3<f64>, follow: Follow) -> Matrix3<f64> {
        let column = |k: usize| {
            let axis = axes.column(k).into_owned();
            (self.apply(p + axis, follow) - self.apply(p - axis, follow)) * 0.5
        };
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }
}
