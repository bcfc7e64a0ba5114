//! What the shape of a body depends on, all for one template.

use crate::BodyError;
use crate::girths::PerGirth;
use crate::template_marks::TemplateMarks;
use std::cmp::Ordering;

/// Points of a curve from below: a place on the template (m) and the value there.
pub(crate) type Curve = Vec<[f64; 2]>;

/// A body over its template, by its parts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// Ratio of statures, body to template.
    pub(crate) stature_ratio: f64,
    /// Heights on the body over those on the template, from the floor up (m).
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
    /// Frontal scale before the plane z = 0 (1).
    pub(crate) front: Curve,
    /// The same behind it.
    pub(crate) back: Curve,
    /// How much farther out the corners of a section lie at equal breadth and depth (1).
    pub(crate) corner_fullness: Curve,
    /// By how much the corners before the middle are fuller than that, and those behind less full (1).
    pub(crate) corner_asymmetry: Curve,
    /// Depth on the template about which sections are scaled (m).
    pub(crate) middle_on_template: Curve,
    /// The same on the body.
    pub(crate) middle_on_body: Curve,
    /// Depth of the sides before which the front part of a girth lies (m).
    pub(crate) side_depth: PerGirth<f64>,
}

/// What rises at the shoulders over what the levels say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ShoulderShape {
    /// Of the outer ends of the shoulders (m).
    pub(crate) tip_rise: f64,
    /// Of the armpits (m).
    pub(crate) armpit_rise: f64,
}

/// The bust over what the sections of the trunk say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BustForm {
    /// By what share the bust points are farther apart (1).
    pub(crate) spread: f64,
    /// How far the bust points stand forward (m).
    pub(crate) projection: f64,
}

/// The crotch over what the levels say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CrotchForm {
    /// How flat it lies from front to back: 0 is as on the template, 1 is level.
    pub(crate) flatness: f64,
    /// How far before its lowest place the crotch point lies, where the crotch length is parted
    /// into front and back (m).
    pub(crate) point_offset: f64,
}

/// The arm: curves over the distance from the shoulder joint on the template.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ArmShape {
    /// Scale about the axis (1).
    pub(crate) scale: Curve,
    /// Distance from the shoulder joint on the body (m).
    pub(crate) length: Curve,
    /// Angle below the horizontal (rad).
    pub(crate) angle: f64,
}

/// The leg.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LegShape {
    /// Scale about the axis over template height (1).
    pub(crate) scale: Curve,
    /// Sideways scale of where the axis stands (1).
    pub(crate) stance: f64,
    /// How much broader the top is, and how much less deep (1).
    pub(crate) top_breadth: f64,
}

impl Shape {
    /// The template's own, with an arm of a length (m) at an angle below the horizontal (rad).
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

    /// Refuses a shape in which the places of a curve do not lie one above the other: landmarks of
    /// a skin whose primitives were moved or deleted may not.
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

/// Whether a number is less than another, as no number is that is none.
pub(crate) fn below(low: f64, high: f64) -> bool {
    low.partial_cmp(&high) == Some(Ordering::Less)
}
