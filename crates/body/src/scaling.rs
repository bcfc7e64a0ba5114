//! Five scaling parameters on skeleton and primitives (Volino, Magnenat-Thalmann, Shen, Thalmann
//! 1996): each a ratio, applied one after the other, each with its inverse.

use crate::template::{BodyFrame, Features};
use crate::{BodyError, Description, Part, Primitive};
use toile_geometry::Vec3;

/// Ratios applied to a body, in this order. Principal directions of the ellipsoids keep their orientation;
/// the length along each is scaled with the ratio of its tag, the global direction that it is nearest to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// Global: all three directions (1).
    pub global: f64,
    /// Frontal: depth (1).
    pub frontal: f64,
    /// High lateral: breadth of arms and head, and of the trunk above the spine's origin (1).
    pub high_lateral: f64,
    /// Spine origin: its new height divided by its old one, at the same stature (1). A higher origin
    /// lengthens the legs and shortens the trunk.
    pub spine_origin: f64,
    /// Low lateral: breadth of legs, and of the trunk below the spine's origin (1).
    pub low_lateral: f64,
}

impl Default for Scaling {
    fn default() -> Self {
        Self {
            global: 1.0,
            frontal: 1.0,
            high_lateral: 1.0,
            spine_origin: 1.0,
            low_lateral: 1.0,
        }
    }
}

/// One of the five ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Global(f64),
    Frontal(f64),
    HighLateral(f64),
    SpineOrigin(f64),
    LowLateral(f64),
}

/// Limits of every ratio: wider than the ratio between any two bodies.
const LIMITS: [f64; 2] = [0.1, 10.0];

impl Scaling {
    /// The scaling that brings a body to a stature (mm), everything in proportion.
    pub fn to_stature(frame: &BodyFrame, millimetres: f64) -> Self {
        Self {
            global: millimetres * 1e-3 / frame.height,
            ..Self::default()
        }
    }

    fn steps(&self) -> [Step; 5] {
        [
            Step::Global(self.global),
            Step::Frontal(self.frontal),
            Step::HighLateral(self.high_lateral),
            Step::SpineOrigin(self.spine_origin),
            Step::LowLateral(self.low_lateral),
        ]
    }

    /// Applies the five ratios in order.
    ///
    /// # Errors
    /// [`BodyError::Description`] for a ratio that is not between 0.1 and 10, a position of the spine's
    /// origin that leaves no trunk or legs, or a body without a frame.
    pub fn apply(&self, body: &Description) -> Result<Description, BodyError> {
        self.applied(body, self.steps().into())
    }

    /// Undoes the five ratios, in reverse order.
    ///
    /// # Errors
    /// As [`Scaling::apply`].
    pub fn take_back(&self, body: &Description) -> Result<Description, BodyError> {
        let back = self.steps().into_iter().rev().map(Step::inverse);
        self.applied(body, back.collect())
    }

    fn applied(&self, body: &Description, steps: Vec<Step>) -> Result<Description, BodyError> {
        let bad = |what: &str| Err(BodyError::Description(format!("the scaling {what}")));
        let ratios = [
            self.global,
            self.frontal,
            self.high_lateral,
            self.spine_origin,
            self.low_lateral,
        ];
        if !ratios.iter().all(|r| (LIMITS[0]..=LIMITS[1]).contains(r)) {
            return bad("has a ratio that is not between 0.1 and 10: 1 leaves things as they are");
        }
        let Some(mut frame) = body.frame else {
            return bad("needs a body with a frame of its own: one fitted to a mesh, or framed");
        };
        let mut primitives = body.primitives.clone();
        for step in steps {
            let origin = frame.joints.pelvis[1];
            if let Step::SpineOrigin(ratio) = step {
                let share = origin * ratio / frame.height;
                if !(0.2..=0.8).contains(&share) {
                    return bad("puts the spine's origin outside 0.2 to 0.8 of the stature");
                }
            }
            for primitive in &mut primitives {
                *primitive = step.primitive(primitive, origin, frame.height);
            }
            frame = step.frame(&frame);
        }
        Ok(Description {
            primitives,
            frame: Some(frame),
            measurements: toile_measure::Measurements::new(),
            ..body.clone()
        })
    }
}

impl Step {
    fn inverse(self) -> Self {
        match self {
            Self::Global(r) => Self::Global(1.0 / r),
            Self::Frontal(r) => Self::Frontal(1.0 / r),
            Self::HighLateral(r) => Self::HighLateral(1.0 / r),
            Self::SpineOrigin(r) => Self::SpineOrigin(1.0 / r),
            Self::LowLateral(r) => Self::LowLateral(1.0 / r),
        }
    }

    /// Ratios of the three directions (lateral, height, frontal), for parts above or below the spine's
    /// origin.
    fn ratios(self, is_high: bool, origin: f64, height: f64) -> Vec3 {
        match self {
            Self::Global(r) => Vec3::repeat(r),
            Self::Frontal(r) => Vec3::new(1.0, 1.0, r),
            Self::HighLateral(r) if is_high => Vec3::new(r, 1.0, 1.0),
            Self::LowLateral(r) if !is_high => Vec3::new(r, 1.0, 1.0),
            Self::SpineOrigin(r) if is_high => {
                Vec3::new(1.0, (height - origin * r) / (height - origin), 1.0)
            }
            Self::SpineOrigin(r) => Vec3::new(1.0, r, 1.0),
            _ => Vec3::repeat(1.0),
        }
    }

    /// A point after the step; the height of a point above the spine's origin is scaled from the crown down.
    fn place(self, p: [f64; 3], is_high: bool, [origin, height]: [f64; 2]) -> [f64; 3] {
        let ratio = self.ratios(is_high, origin, height);
        let y = match self {
            Self::SpineOrigin(_) => {
                let above = self.ratios(true, origin, height).y;
                match p[1] > origin {
                    true => height - (height - p[1]) * above,
                    false => p[1] * self.ratios(false, origin, height).y,
                }
            }
            _ => p[1] * ratio.y,
        };
        [p[0] * ratio.x, y, p[2] * ratio.z]
    }

    fn primitive(self, p: &Primitive, origin: f64, height: f64) -> Primitive {
        let is_high = match p.part {
            Part::Head | Part::LeftArm | Part::RightArm => true,
            Part::LeftLeg | Part::RightLeg => false,
            Part::Trunk => p.centre[1] > origin,
        };
        // A stretch in height depends on the height of the primitive, not on its part.
        let along = match self {
            Self::SpineOrigin(_) => self.ratios(p.centre[1] > origin, origin, height),
            _ => self.ratios(is_high, origin, height),
        };
        let tags = tags(p);
        Primitive {
            centre: self.place(p.centre, is_high, [origin, height]),
            radii: std::array::from_fn(|k| p.radii[k] * along[tags[k]]),
            ..*p
        }
    }

    fn frame(self, frame: &BodyFrame) -> BodyFrame {
        let places = [frame.joints.pelvis[1], frame.height];
        let high = |p: [f64; 3]| self.place(p, true, places);
        let low = |p: [f64; 3]| self.place(p, false, places);
        let level = |y: f64| self.place([0.0, y, 0.0], true, places)[1];
        let j = &frame.joints;
        let mut scaled = *frame;
        let s = &mut scaled.joints;
        [s.shoulder, s.elbow, s.wrist] = [j.shoulder, j.elbow, j.wrist].map(high);
        scaled.features = frame.features.map(|f| Features {
            thumb: f.thumb.map(high),
        });
        [s.pelvis, s.chest, s.neck, s.head] = [j.pelvis, j.chest, j.neck, j.head].map(high);
        [s.hip, s.knee, s.ankle, s.toe] = [j.hip, j.knee, j.ankle, j.toe].map(low);
        let across = self.ratios(true, places[0], places[1]).x;
        scaled.height = level(frame.height);
        scaled.crotch = level(frame.crotch);
        scaled.armpit = level(frame.armpit);
        scaled.neck_radius = frame.neck_radius * across;
        if let Self::Global(r) = self {
            scaled.hand = frame.hand * r;
        }
        scaled
    }
}

/// Tag of each principal direction: the global axis along which it has its largest component, 0 lateral, 1
/// height, 2 frontal.
pub fn tags(primitive: &Primitive) -> [usize; 3] {
    let turn = *primitive.rotation().matrix();
    std::array::from_fn(|k| turn.column(k).iamax())
}
