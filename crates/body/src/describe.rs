//! The data from which a mannequin is made again.

use crate::rigging::Rigging;
use crate::sides::both_sides;
use crate::template::Template;
use crate::{BodyError, BodyFrame, Figure, Mannequin, Primitive};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;
use toile_measure::Measurements;

/// All data of a mannequin: the same description gives the same body, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// The template that gives joints and levels.
    pub figure: Figure,
    /// Measurements asked for.
    pub measurements: Measurements,
    /// The template's primitives of trunk, head, left arm and left leg, before any measurement is applied: a
    /// primitive off the median plane stands for itself and its mirror image. Empty for the figure's own
    /// primitives.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub primitives: Vec<Primitive>,
    /// Levels and joints of a body whose primitives are used unchanged, such as a body fitted to a mesh;
    /// `None` for a body grown from the figure's template to its measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<BodyFrame>,
    /// Attachments, deformations and joins of single primitives.
    #[serde(default, skip_serializing_if = "Rigging::is_empty")]
    pub rigging: Rigging,
}

impl Mannequin {
    /// The description of this body, with its template's primitives written out.
    pub fn description(&self) -> Description {
        Description {
            figure: self.figure,
            measurements: self.measurements.clone(),
            frame: self.template_body.template.frame(),
            rigging: self.template_body.template.rigging.clone(),
            primitives: self
                .template_body
                .template
                .primitives
                .iter()
                .filter(|p| !p.is_right())
                .copied()
                .collect(),
        }
    }

    /// Description of a figure's own primitives unchanged, with their frame: a body without measurements that
    /// can be scaled and edited.
    ///
    /// # Errors
    /// As [`Mannequin::new`].
    pub fn framed(figure: Figure) -> Result<Description, BodyError> {
        let body = Self::new(&figure.average(), figure)?;
        let template_body = &body.template_body;
        Ok(Description {
            frame: Some(BodyFrame {
                height: template_body.template.height,
                crotch: template_body.template.crotch,
                armpit: template_body.marks.armpit.height,
                hand: template_body.template.hand,
                neck_radius: template_body.template.neck_radius,
                joints: template_body.template.joints,
                features: template_body.template.features,
            }),
            measurements: Measurements::new(),
            ..body.description()
        })
    }

    /// Grows the body of a description.
    ///
    /// # Errors
    /// As [`Mannequin::new`]; also for a primitive with numbers that are not finite, with an axis that is not
    /// positive, or on the wrong side.
    pub fn from_description(description: &Description) -> Result<Self, BodyError> {
        let mut template = Template::of(description.figure);
        if !description.primitives.is_empty() {
            for (index, primitive) in description.primitives.iter().enumerate() {
                check(index, primitive)?;
            }
            template.primitives = both_sides(description.primitives.clone());
        }
        let left = template.primitives.iter().filter(|p| !p.is_right()).count();
        description.rigging.check(left)?;
        template.rigging = description.rigging.clone();
        if let Some(frame) = &description.frame {
            sound(frame)?;
            let rigging = template.rigging;
            let template = Template {
                rigging,
                ..Template::framed(frame, template.primitives)
            };
            return Self::still(&description.measurements, description.figure, template);
        }
        Self::from_template(&description.measurements, description.figure, template)
    }
}

/// Refuses a frame with values that no body can have.
fn sound(frame: &BodyFrame) -> Result<(), BodyError> {
    let bad = |what: &str| Err(BodyError::Description(format!("the frame {what}")));
    let j = &frame.joints;
    let places = [
        j.shoulder, j.elbow, j.wrist, j.hip, j.knee, j.ankle, j.toe, j.pelvis, j.chest, j.neck,
        j.head,
    ];
    let lengths = [
        frame.height,
        frame.crotch,
        frame.armpit,
        frame.hand,
        frame.neck_radius,
    ];
    if !(0.12..=6.0).contains(&frame.height) {
        return bad("is not between 0.12 and 6 m tall: give metres");
    }
    let within = |x: &f64| x.is_finite() && x.abs() <= frame.height;
    let thumb = frame.features.iter().flat_map(|f| &f.thumb);
    if !(places.iter().chain(thumb).flatten())
        .chain(&lengths)
        .all(within)
    {
        return bad("has a place beyond its height: give metres");
    }
    let rising = [
        0.0,
        j.ankle[1],
        j.knee[1],
        frame.crotch,
        j.pelvis[1],
        frame.armpit,
        j.neck[1],
        j.head[1],
        frame.height,
    ];
    if rising
        .windows(2)
        .any(|w| w[1] - w[0] < 0.005 * frame.height)
    {
        return bad("has levels out of order from the floor to the crown: correct them");
    }
    let far = |a: [f64; 3], b: [f64; 3]| (Vec3::from(a) - Vec3::from(b)).norm();
    let bones = [
        far(j.shoulder, j.elbow),
        far(j.elbow, j.wrist),
        frame.hand,
        frame.neck_radius,
        j.shoulder[0] - frame.neck_radius,
        j.hip[0],
        j.toe[2] - j.ankle[2],
    ];
    if bones.iter().any(|&length| length < 0.01 * frame.height) {
        return bad("has a bone of no length, or one on the right (-X): give the left ones");
    }
    Ok(())
}

/// Refuses a primitive with values that no body can have.
pub(crate) fn check(index: usize, p: &Primitive) -> Result<(), BodyError> {
    let bad = |what: &str| Err(BodyError::Description(format!("primitive {index} {what}")));
    let numbers = p.centre.iter().chain(&p.radii).chain(&p.rotation);
    if !numbers.clone().all(|x| x.is_finite() && x.abs() < 10.0) {
        return bad("has a number that is not finite or beyond 10: give metres and radians");
    }
    if p.radii.iter().any(|&r| r < 1e-3) {
        return bad("has a semi-axis under 0.001 m: enlarge it or remove the primitive");
    }
    if !(0.01..=100.0).contains(&p.weight) {
        return bad("has a weight that is not between 0.01 and 100: give 1");
    }
    if p.is_right() {
        return bad("is on the right: give the left one, the right is its mirror image");
    }
    let in_the_middle = p.part == p.part.mirrored() && p.centre[0] == 0.0;
    let of_a_side = p.also.is_some_and(|part| part != part.mirrored());
    if in_the_middle && (!p.is_central() || of_a_side) {
        return bad(
            "in the middle is turned sideways or belongs to one side: move it off the middle",
        );
    }
    Ok(())
}
