//! The map of trunk, neck and head from a template to a body:
//! `(x, y, z) -> (x s_l(y), Y(y), z s_f(y))`, with one s_f before and one behind the plane z = 0, so
//! that with `s_l = s_f` a section and the tape round it scale exactly.

use crate::bands::Near;
use crate::curve::{Monotone, smooth_step};
use crate::shape::Shape;
use crate::template_marks::{CROTCH_PLACES, TemplateMarks};
use toile_geometry::Vec3;

/// Extents of a bust sideways, up and down from its point, as a share of stature.
const BUST_REACH: [f64; 3] = [0.06, 0.10, 0.045];

/// Distances sideways, up and down over which a flat crotch changes the body, as a share of stature.
const CROTCH_REACH: [f64; 3] = [0.06, 0.15, 0.10];

/// The map, for points of the left half, x >= 0. Curves are functions of the height on the template.
#[derive(Clone)]
pub(crate) struct TrunkWarp {
    /// Height on the body, by height on the template (m).
    height: Monotone,
    /// Sideways scale of sections (1).
    lateral: Monotone,
    /// Scale of sections in front of their middle (1).
    front: Monotone,
    /// Scale of sections behind their middle (1).
    back: Monotone,
    /// Amount by which the corners of sections lie farther out (1).
    corner_fullness: Monotone,
    /// Amount by which front corners lie farther out than that, and back corners less far (1).
    corner_asymmetry: Monotone,
    /// Half the breadth, and depths in front of and behind the centre of the section, on the template (m).
    extents: [Monotone; 3],
    /// Depth on the template about which sections are scaled (m).
    middle_on_template: Monotone,
    /// Depth on the body about which sections are scaled (m).
    middle_on_body: Monotone,
    /// Rise of the body's midline above the crotch by depth on the template (m).
    crotch_rise: Monotone,
    marks: TemplateMarks,
    shape: Shape,
}

/// Rises of the body's midline above the crotch, by depth (m).
fn crotch_rise(marks: &TemplateMarks) -> Vec<[f64; 2]> {
    (0..CROTCH_PLACES)
        .map(|k| [marks.crotch_depth(k), marks.crotch.rise[k]])
        .collect()
}

impl TrunkWarp {
    pub(crate) fn new(marks: &TemplateMarks, shape: Shape) -> Self {
        let trunk = &shape.trunk;
        let sections = &marks.trunk.sections;
        Self {
            height: Monotone::new(shape.heights.clone()),
            lateral: Monotone::new(trunk.lateral.clone()),
            front: Monotone::new(trunk.front.clone()),
            back: Monotone::new(trunk.back.clone()),
            corner_fullness: Monotone::new(trunk.corner_fullness.clone()),
            corner_asymmetry: Monotone::new(trunk.corner_asymmetry.clone()),
            extents: [1, 2, 3].map(|k| Monotone::new(sections.map(|row| [row[0], row[k]]).into())),
            middle_on_template: Monotone::new(trunk.middle_on_template.clone()),
            middle_on_body: Monotone::new(trunk.middle_on_body.clone()),
            crotch_rise: Monotone::new(crotch_rise(marks)),
            marks: *marks,
            shape,
        }
    }

    /// The shape that the map was made from.
    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Point that a point of the template is mapped to.
    pub(crate) fn apply(&self, p: Vec3) -> Vec3 {
        let [shoulder, armpit] = self.rise(p);
        // Points that rise with the armpit get the scale of the height that they rise to.
        let y = p.y + armpit / self.shape.stature_ratio;
        let fuller = self.fuller(Vec3::new(p.x, y, p.z));
        let depth = (p.z - self.middle_on_template.at(y)) * fuller;
        // The scale changes from that of the back to that of the front across the centre of the section.
        let before = smooth_step(0.5 + depth / (0.09 * self.marks.crown));
        let [front, back] = [self.front.at(y), self.back.at(y)];
        let frontal = back + (front - back) * before;
        Vec3::new(
            p.x * fuller * self.lateral.at(y) * (1.0 + self.spread(p, depth)),
            self.height(p) + shoulder + armpit,
            self.middle_on_body.at(y) + depth * frontal + self.projection(p, depth),
        )
    }

    /// Height on the body of a point of the template, without the rise of shoulder and armpit (m).
    pub(crate) fn height(&self, p: Vec3) -> f64 {
        self.height.at(p.y - self.sunk(p))
    }

    /// Distance by which a point is moved forward with the bust point (m): the whole distance at the bust
    /// point, 0 outside the bust.
    fn projection(&self, p: Vec3, depth: f64) -> f64 {
        let m = &self.marks;
        let [across, up, down] = BUST_REACH.map(|reach| reach * m.crown);
        let high = p.y - m.bust.height;
        let u = ((p.x - m.bust.point.x) / across).powi(2);
        if self.shape.bust.projection == 0.0
            || u >= 1.0
            || high >= up
            || high <= -down
            || depth <= 0.0
        {
            return 0.0;
        }
        let before = smooth_step(depth / (0.04 * m.crown));
        // Round above the bust point, evenly back to the fold below it.
        let upright = match high > 0.0 {
            true => (1.0 - (high / up).powi(4)).powi(2),
            false => 1.0 - (-high / down).powf(1.3),
        };
        let full = (1.0 - u * u).powi(2) * upright;
        self.shape.bust.projection * full * before
    }

    /// Factor by which a point of the trunk lies farther out from the centre of its section. With the point's
    /// direction t in a section scaled to breadth and depth 1 it is `1 + c sin^2(2 t)`, so that breadth and
    /// depth stay and the corners between them are filled.
    fn fuller(&self, p: Vec3) -> f64 {
        let depth = p.z - self.marks.trunk.middle_depth;
        let [fullness, asymmetry] =
            [&self.corner_fullness, &self.corner_asymmetry].map(|curve| curve.at(p.y));
        let fullness = fullness + asymmetry.copysign(depth * asymmetry);
        if fullness == 0.0 {
            return 1.0;
        }
        // Below and above the known sections, the sections at the ends are used.
        let [first, last] = [self.marks.trunk.sections[0][0], self.marks.bust.height];
        let y = p.y.clamp(first, last);
        let [breadth, front, back] = [0, 1, 2].map(|k| self.extents[k].at(y));
        let u = (p.x / breadth).powi(2);
        let v = (depth / if depth > 0.0 { front } else { back }).powi(2);
        1.0 + fullness * 4.0 * u * v / (u + v).max(0.5).powi(2)
    }

    /// Share by which a point in front of the chest moves sideways with the bust points: the whole share at
    /// their height in front, 0 at the sides, above and below.
    fn spread(&self, p: Vec3, depth: f64) -> f64 {
        let m = &self.marks;
        let half = 1.02 * m.shoulder.tip.x;
        let u = (p.x / half).powi(2);
        let v = ((p.y - m.bust.height) / (0.055 * m.crown)).powi(2);
        if u >= 1.0 || v >= 1.0 || depth <= 0.0 {
            return 0.0;
        }
        let before = smooth_step(depth / (0.04 * m.crown));
        self.shape.bust.spread * ((1.0 - u) * (1.0 - v)).powi(2) * before
    }

    /// Rises of a point with the end of the shoulder and with the armpit (m): the whole rise at these two
    /// points, 0 at the neck and at the bust.
    fn rise(&self, p: Vec3) -> [f64; 2] {
        let m = &self.marks;
        let inner = 0.92 * m.neck.side.x;
        // Almost straight from the neck, level at the end of the shoulder.
        let out = ((p.x - inner) / (m.shoulder.tip.x - inner)).clamp(0.0, 1.0);
        let out = out * (1.5 - 0.5 * out * out);
        let up = smooth_step((p.y - m.bust.height) / (m.shoulder.tip.y - m.bust.height));
        let to_armpit = smooth_step(1.0 - (m.armpit.height - p.y) / (0.06 * m.crown));
        let from_armpit =
            smooth_step(1.0 - (p.y - m.armpit.height) / (m.shoulder.tip.y - m.armpit.height));
        let armpit = self.shape.shoulder.armpit_rise * to_armpit.min(from_armpit);
        [self.shape.shoulder.tip_rise * up * out, armpit * out]
    }

    /// Depth by which a point of the template is lowered if the crotch is flatter (m): the body's midline
    /// sinks by a share of its rise above the crotch, points beside it by less.
    fn sunk(&self, p: Vec3) -> f64 {
        let m = &self.marks;
        let [side, up, down] = CROTCH_REACH.map(|reach| reach * m.crown);
        let high = p.y - m.crotch.height;
        if self.shape.crotch.flatness == 0.0 || p.x >= side || high >= up || high <= -down {
            return 0.0;
        }
        let beside = smooth_step(1.0 - p.x / side);
        // Up to this height above the crotch points sink as far as at the crotch.
        let top = 0.3 * up;
        let far = match high > 0.0 {
            true => smooth_step((up - high) / (up - top)),
            false => smooth_step((down + high) / down),
        };
        let ends = [0, CROTCH_PLACES - 1].map(|k| m.crotch_depth(k));
        self.shape.crotch.flatness * self.crotch_rise.at(p.z.clamp(ends[0], ends[1])) * beside * far
    }

    /// Least and largest sideways scale of any point of trunk and head (1).
    pub(crate) fn sideways(&self) -> [f64; 2] {
        let s = &self.shape;
        let most = |rows: &[[f64; 2]]| rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
        let fuller = most(&s.trunk.corner_fullness) + most(&s.trunk.corner_asymmetry);
        let scales = s.trunk.lateral.iter().map(|row| row[1]);
        let low = scales.clone().fold(f64::INFINITY, f64::min);
        let high = scales.fold(0.0, f64::max);
        let spread = |end: f64| (s.bust.spread * end).max(0.0);
        [
            low * (1.0 - fuller).max(0.1) * (1.0 - spread(-1.0)).max(0.1),
            high * (1.0 + fuller) * (1.0 + spread(1.0)),
        ]
    }

    /// Height on the template that corresponds to a height on the body (m).
    pub(crate) fn template_level(&self, height: f64) -> f64 {
        self.height.inverse(height)
    }

    /// Range of heights on the template of the triangles that may cross a height on the body (m): `reach` (m)
    /// up and down from the level that corresponds to it, or more where points rise or sink with shoulders,
    /// armpits or crotch.
    pub(crate) fn near(&self, height: f64, reach: f64) -> Near {
        let (m, s) = (&self.marks, &self.shape);
        let moved =
            [s.shoulder.tip_rise, s.shoulder.armpit_rise].map(|rise| 1.6 * rise / s.stature_ratio);
        let mut up: f64 = moved.iter().map(|r| r.max(0.0)).sum();
        let mut down: f64 = moved.iter().map(|r| (-r).max(0.0)).sum();
        let at = self.template_level(height);
        if at < m.crotch.height + CROTCH_REACH[1] * m.crown {
            let most = m.crotch.rise.iter().fold(0.0, |a: f64, &b| a.max(b));
            down += s.crotch.flatness.max(0.0) * most;
            up += (-s.crotch.flatness).max(0.0) * most;
        }
        Near::Level([at - reach - up, at + reach + down])
    }
}
