//! The shape of a body relative to its template: all parameters of the warp.

use crate::BodyError;
use crate::girths::PerGirth;
use crate::template_marks::TemplateMarks;
use std::cmp::Ordering;

/// Points of a curve from below: a position on the template (m) and the value there.
pub(crate) type Curve = Vec<[f64; 2]>;

/// The shape of a body relative to its template, by parts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// Ratio of statures, body to template.
    pub(crate) stature_ratio: f64,
    /// Heights on the template with the heights on the body that correspond to them, from the floor up (m).
    pub(crate) heights: Curve,
    pub(crate) trunk: TrunkShape,
    pub(crate) shoulder: ShoulderShape,
    pub(crate) bust: BustForm,
    pub(crate) crotch: CrotchForm,
    pub(crate) arm: ArmShape,
    pub(crate) leg: LegShape,
}

/// Sections of trunk, neck and head: curves over template height.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TrunkShape {
    /// Lateral scale (1).
    pub(crate) lateral: Curve,
    /// Frontal scale in front of the middle of a section, which `middle_on_template` gives (1).
    pub(crate) front: Curve,
    /// Frontal scale behind the middle of a section (1).
    pub(crate) back: Curve,
    /// Amount by which the corners of a section lie farther out at equal breadth and depth (1).
    pub(crate) corner_fullness: Curve,
    /// Amount by which front corners are fuller than `corner_fullness`, and back corners less full (1).
    pub(crate) corner_asymmetry: Curve,
    /// Depth on the template about which sections are scaled (m).
    pub(crate) middle_on_template: Curve,
    /// Depth on the body about which sections are scaled (m).
    pub(crate) middle_on_body: Curve,
    /// Depth of the side lines, which divide a girth into front and back (m).
    pub(crate) side_depth: PerGirth<f64>,
}

/// Rises at the shoulders above the heights given by the levels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ShoulderShape {
    /// Rise of the outer ends of the shoulders (m).
    pub(crate) tip_rise: f64,
    /// Rise of the armpits (m).
    pub(crate) armpit_rise: f64,
}

/// Form of the bust in addition to the sections of the trunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BustForm {
    /// Share by which the bust points are farther apart (1).
    pub(crate) spread: f64,
    /// Distance by which the bust points stand forward (m).
    pub(crate) projection: f64,
}

/// Form of the crotch in addition to the levels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CrotchForm {
    /// Flatness from front to back: 0 is as on the template, 1 is level.
    pub(crate) flatness: f64,
    /// Distance of the crotch point in front of the lowest point: it divides the crotch length into front and
    /// back (m).
    pub(crate) point_offset: f64,
}

/// Shape of the arm: curves over the distance from the shoulder joint on the template.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ArmShape {
    /// Scale about the axis (1).
    pub(crate) scale: Curve,
    /// Distance from the shoulder joint on the body, by the distance on the template (m).
    pub(crate) length: Curve,
    /// Angle of the arm below the horizontal (rad).
    pub(crate) angle: f64,
}

/// Shape of the leg.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LegShape {
    /// Scale about the axis (1), by template height.
    pub(crate) scale: Curve,
    /// Sideways scale of the position of the axis (1).
    pub(crate) stance: f64,
    /// Factor by which the top of the leg is broader and less deep (1).
    pub(crate) top_breadth: f64,
}

impl Shape {
    /// The template's own shape, with an arm of a length (m) at an angle below the horizontal (rad).
    pub(crate) fn of_template(marks: &TemplateMarks, [length, angle]: [f64; 2]) -> Self {
        let even = |value: f64| vec![[0.0, value], [marks.crown, value]];
        let same = |end: f64| vec![[0.0, 0.0], [end, end]];
        Self {
            stature_ratio: 1.0,
            heights: same(marks.crown),
            trunk: TrunkShape {
                lateral: even(1.0),
                front: even(1.0),
                back: even(1.0),
                corner_fullness: even(0.0),
                corner_asymmetry: even(0.0),
                middle_on_template: even(0.0),
                middle_on_body: even(0.0),
                side_depth: PerGirth::default(),
            },
            shoulder: ShoulderShape::default(),
            bust: BustForm::default(),
            crotch: CrotchForm::default(),
            arm: ArmShape {
                scale: even(1.0),
                length: same(length),
                angle,
            },
            leg: LegShape {
                scale: even(1.0),
                stance: 1.0,
                top_breadth: 1.0,
            },
        }
    }

    /// Refuses a shape in which the positions of a curve do not rise: the landmarks of a skin can be out of
    /// order if its primitives were moved or deleted.
    pub(crate) fn in_order(self) -> Result<Self, BodyError> {
        let (trunk, arm) = (&self.trunk, &self.arm);
        for curve in [
            &trunk.lateral,
            &trunk.front,
            &trunk.back,
            &trunk.corner_fullness,
            &trunk.corner_asymmetry,
            &self.leg.scale,
            &arm.scale,
            &arm.length,
            &trunk.middle_on_template,
            &trunk.middle_on_body,
        ] {
            if let Some(pair) = curve.windows(2).find(|w| !below(w[0][0], w[1][0])) {
                return Err(BodyError::Disordered { level: pair[1][0] });
            }
        }
        Ok(self)
    }
}

/// Whether a number is less than another; false if either is NaN.
pub(crate) fn below(low: f64, high: f64) -> bool {
    low.partial_cmp(&high) == Some(Ordering::Less)
}
