//! A coordinate frame for each body part, and the skin vertices that belong to it.

use crate::PlacementBody;
use crate::outline_curve::OutlineCurve;
use toile_geometry::{Vec2, Vec3};
use toile_pattern::{BodyPart, Facing};

/// Typical radius of a body part (m), the unit in which distances from its axis are compared.
const fn usual_radius(part: BodyPart) -> f64 {
    match part {
        BodyPart::Trunk => 0.15,
        BodyPart::Head => 0.09,
        BodyPart::LeftArm | BodyPart::RightArm => 0.05,
        BodyPart::LeftLeg | BodyPart::RightLeg => 0.08,
    }
}

/// Frame of a body part: the upward direction of cloth and its four facings in counter-clockwise order, for
/// the trunk front, left, back and right.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartFrame {
    pub part: BodyPart,
    /// A point on the axis; heights are measured from it along `up` (m).
    pub origin: Vec3,
    pub up: Vec3,
    facings: [Vec3; 4],
}

/// The axis of a part, or a vertical substitute if the body does not have the part.
fn axis(body: &PlacementBody, part: BodyPart) -> (Vec3, Vec3) {
    let axis = body.limbs.iter().find(|l| l.part == part);
    let ends = axis.and_then(|l| Some((*l.axis.first()?, *l.axis.last()?)));
    ends.unwrap_or((
        Vec3::new(0.0, body.levels.crotch, 0.0),
        Vec3::new(0.0, body.levels.neck, 0.0),
    ))
}

impl PartFrame {
    /// The frame of a part of a body.
    pub fn new(body: &PlacementBody, part: BodyPart) -> Self {
        let (root, tip) = axis(body, part);
        let side = match part {
            BodyPart::LeftArm => 1.0,
            BodyPart::RightArm => -1.0,
            _ => {
                // Upright parts use true heights above the floor.
                let middle = (root + tip) * 0.5;
                let front = Vec3::z();
                return Self {
                    part,
                    origin: Vec3::new(middle.x, 0.0, middle.z),
                    up: Vec3::y(),
                    facings: [front, Vec3::x(), -front, -Vec3::x()],
                };
            }
        };
        let up = (root - tip).try_normalize(1e-9).unwrap_or_else(Vec3::y);
        let outward = Vec3::new(side, 0.3, 0.0);
        let top = (outward - up * outward.dot(&up))
            .try_normalize(1e-9)
            .unwrap_or_else(Vec3::z);
        let next = up.cross(&top);
        Self {
            part,
            origin: root,
            up,
            facings: [top, next, -top, -next],
        }
    }

    /// Number of quarter turns from the frame's first direction to a facing.
    pub fn quarter(&self, facing: Facing) -> usize {
        let arm = |front: usize| match facing {
            Facing::Front => front,
            Facing::Back => (front + 2) % 4,
            Facing::Right => 2,
            Facing::Left | Facing::Around | Facing::Over => 0,
        };
        match (self.part, facing) {
            (BodyPart::LeftArm, _) => arm(3),
            (BodyPart::RightArm, _) => arm(1),
            (BodyPart::LeftLeg, Facing::Around) => 1,
            (BodyPart::RightLeg, Facing::Around) => 3,
            (_, Facing::Front | Facing::Around | Facing::Over) => 0,
            (_, Facing::Left) => 1,
            (_, Facing::Back) => 2,
            (_, Facing::Right) => 3,
        }
    }

    /// Coordinate along the frame's upward direction (m).
    pub fn height(&self, p: Vec3) -> f64 {
        (p - self.origin).dot(&self.up)
    }

    /// Coordinates across the axis, looking in the direction of `quarter`: to the left of it, and along it
    /// (m).
    pub fn across(&self, p: Vec3, quarter: usize) -> Vec2 {
        let offset = p - self.origin;
        Vec2::new(
            offset.dot(&self.facings[(quarter + 1) % 4]),
            offset.dot(&self.facings[quarter]),
        )
    }

    /// The point with coordinates across the axis and a height (m).
    pub fn point(&self, across: Vec2, quarter: usize, height: f64) -> Vec3 {
        self.origin
            + self.facings[(quarter + 1) % 4] * across.x
            + self.facings[quarter] * across.y
            + self.up * height
    }

    /// A point of cloth on a curve, at the arc length `along` and a height (m).
    pub fn on_curve(&self, curve: &OutlineCurve, quarter: usize, along: f64, height: f64) -> Vec3 {
        self.point(curve.at(along), quarter, height)
    }
}

/// Distance from a point to a polyline (m).
fn polyline_distance(p: Vec3, line: &[Vec3]) -> f64 {
    let segment = |a: Vec3, b: Vec3| {
        let d = b - a;
        let t = ((p - a).dot(&d) / d.norm_squared().max(1e-12)).clamp(0.0, 1.0);
        (a + d * t - p).norm()
    };
    match line {
        [] => f64::INFINITY,
        [only] => (only - p).norm(),
        _ => line
            .windows(2)
            .map(|w| segment(w[0], w[1]))
            .fold(f64::INFINITY, f64::min),
    }
}

/// The body part of each skin vertex: the part whose axis is nearest in multiples of its typical radius.
pub(crate) fn label_skin(body: &PlacementBody) -> Vec<BodyPart> {
    body.skin
        .mesh()
        .positions
        .iter()
        .map(|&p| {
            let mut best = (f64::INFINITY, BodyPart::Trunk);
            for limb in &body.limbs {
                let distance = polyline_distance(p, &limb.axis) / usual_radius(limb.part);
                if distance < best.0 {
                    best = (distance, limb.part);
                }
            }
            best.1
        })
        .collect()
}
