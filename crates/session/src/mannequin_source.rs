//! Source of a mannequin: measurements that it is grown to, or a description.
//!
//! # Decided with
//! - [`crate::project::Project::body_measurements`], [`crate::project::Project::figure`]: measurements and
//!   template;
//! - [`crate::session::Session::set_measurements`] (`perform.rs`), [`crate::session::Session::set_body`]
//!   (`perform.rs`): measurements typed; a body chosen;
//! - [`crate::bodies::body_of`], [`toile_interchange::read_sized_measurements`],
//!   [`toile_interchange::read_seamly`]: files of measurements, in one size or several;
//! - [`toile_body::Description`], [`toile_interchange::read_mannequin`]: mannequins saved and made again;
//! - [`toile_measure::Build`]: what is missing is predicted;
//! - [`toile_body::Mannequin`], [`toile_body::BodyError`]: the body grown; measurements that no body has;
//! - [`crate::derived`] (`body_error`): its errors with the name of the file;
//! - [`crate::placed_panels::sleeve_angle`]: how the arms are held;
//! - [`crate::garment_edit::CannotFollow`], [`crate::derived::Derived::follow`]: a worn garment does not follow
//!   to another body; its drape is out of date.

use crate::Project;
use crate::placed_panels::sleeve_angle;
use std::sync::Arc;
use toile_body::{BodyError, Description, Figure, Mannequin};
use toile_measure::{Measurements, Origin};

/// Everything that a mannequin is made from: equal sources make equal mannequins.
#[derive(Clone, PartialEq)]
pub(crate) enum MannequinSource {
    /// Grown to measurements.
    Grown(Figure, Measurements),
    /// Made as its description says.
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
    /// Whether this project and `other` have the very same body.
    pub fn has_same_body(&self, other: &Self) -> bool {
        MannequinSource::of(self) == MannequinSource::of(other)
    }
}

/// The measurements of the mannequin of a project. Unless the angle of its arms was asked for, they are held
/// as the sleeves of its garments are placed in space, and that angle (rad) is returned, too.
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
