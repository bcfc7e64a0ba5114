//! What a mannequin is made from.

use crate::Project;
use crate::placed_panels::sleeve_angle;
use std::sync::Arc;
use toile_body::{BodyError, Description, Figure, Mannequin};
use toile_measure::{Measurements, Origin};

/// What a mannequin is made from: the same makes the same.
#[derive(Clone, PartialEq)]
pub(crate) enum MannequinSource {
    /// Grown to measurements.
    Grown(Figure, Measurements),
    /// Standing as its description says.
    Shaped(Arc<Description>),
}

impl MannequinSource {
    pub fn of(project: &Project) -> Self {
        match project.body.description() {
            Some(description) => Self::Shaped(description.clone()),
            None => Self::Grown(project.figure(), measurements_for_sleeves(project).0),
        }
    }

    pub fn make(&self) -> Result<Mannequin, BodyError> {
        match self {
            Self::Grown(figure, measurements) => Mannequin::new(measurements, *figure),
            Self::Shaped(description) => Mannequin::from_description(description),
        }
    }
}

impl Project {
    /// Whether another project is worn by the very same body.
    pub fn has_same_body(&self, other: &Self) -> bool {
        MannequinSource::of(self) == MannequinSource::of(other)
    }
}

/// The measurements of the mannequin of a project, with its arms held as the sleeves of its garments are placed
/// where nobody says how they are held, and that angle.
pub(crate) fn measurements_for_sleeves(project: &Project) -> (Measurements, Option<f64>) {
    let mut measurements = project.body_measurements();
    let given = measurements.measured("arm_pose_angle");
    if given.is_some_and(|measured| measured.origin == Origin::Asked) {
        return (measurements, None);
    }
    let patterns = [&project.pattern]
        .into_iter()
        .chain(project.other_patterns().map(|(_, pattern)| pattern));
    let angle = patterns
        .into_iter()
        .find_map(|pattern| sleeve_angle(pattern));
    let kept = angle.filter(|&angle| {
        let set = measurements.set("arm_pose_angle", angle, Origin::Asked);
        set.is_ok()
    });
    (measurements, kept)
}
