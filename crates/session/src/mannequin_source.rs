//! What a mannequin is made from.

use crate::Project;
use crate::choice::BodyChoice;
use std::sync::Arc;
use toile_body::{BodyError, Description, Figure, Mannequin};
use toile_measure::Measurements;

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
        match &project.body {
            BodyChoice::Shaped { description, .. } => Self::Shaped(description.clone()),
            _ => Self::Grown(project.figure(), project.body_measurements()),
        }
    }

    pub fn make(&self) -> Result<Mannequin, BodyError> {
        match self {
            Self::Grown(figure, measurements) => Mannequin::new(measurements, *figure),
            Self::Shaped(description) => Mannequin::from_description(description),
        }
    }
}
