//! The mannequin as a small file: what it is grown from, not what it looks like.

use crate::template::Template;
use crate::{BodyError, Figure, Mannequin, Primitive};
use serde::{Deserialize, Serialize};
use toile_measure::Measurements;

/// All a mannequin is made from: the same description gives the same body, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Which template gives joints and levels.
    pub figure: Figure,
    /// Measurements asked for.
    pub measurements: Measurements,
    /// The template's primitives of trunk, head, left arm and left leg, before any measurement is
    /// applied: those off the middle stand for a pair. Empty for the figure's own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub primitives: Vec<Primitive>,
}

impl Mannequin {
    /// The description of this body, with its template's primitives written out.
    pub fn description(&self) -> Description {
        Description {
            figure: self.figure,
            measurements: self.measurements.clone(),
            primitives: self
                .cast
                .template
                .primitives
                .iter()
                .filter(|p| !p.is_right())
                .copied()
                .collect(),
        }
    }

    /// Grows the body of a description.
    ///
    /// # Errors
    /// As [`Mannequin::new`]; and a primitive with numbers that are not finite, with an axis that
    /// is not positive, or on the wrong side.
    pub fn from_description(description: &Description) -> Result<Self, BodyError> {
        let mut template = Template::of(description.figure);
        if !description.primitives.is_empty() {
            for (index, primitive) in description.primitives.iter().enumerate() {
                check(index, primitive)?;
            }
            template.primitives = both_sides(description.primitives.clone());
        }
        Self::from_template(&description.measurements, description.figure, template)
    }
}

/// Primitives with the mirror images of those off the middle after them.
pub(crate) fn both_sides(mut primitives: Vec<Primitive>) -> Vec<Primitive> {
    let mirrored: Vec<Primitive> = primitives
        .iter()
        .filter(|p| !p.is_central())
        .map(Primitive::mirrored)
        .collect();
    primitives.extend(mirrored);
    primitives
}

fn check(index: usize, p: &Primitive) -> Result<(), BodyError> {
    let bad = |what: &str| Err(BodyError::Description(format!("primitive {index} {what}")));
    let numbers = p.centre.iter().chain(&p.radii).chain(&p.rotation);
    if !numbers.clone().all(|x| x.is_finite() && x.abs() < 10.0) {
        return bad("has a number that is not finite or beyond 10: give metres and radians");
    }
    if p.radii.iter().any(|&r| r < 1e-3) {
        return bad("has a semi-axis under 0.001 m: enlarge it or remove the primitive");
    }
    if p.is_right() {
        return bad("is on the right: give the left one, the right is its mirror image");
    }
    Ok(())
}
