//! What tests of markers need.

use std::path::{Path, PathBuf};
use toile_interchange::{MarkerSettings, read_marker_settings};
use toile_session::Roll;

/// A pattern of the project.
pub fn pattern(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    folder.join(format!("{name}.toile.json"))
}

/// Settings with a body of fields.
pub fn settings(body: &str) -> MarkerSettings {
    let text = format!("{{ \"toile\": 1, \"kind\": \"marker-settings\", {body} }}");
    read_marker_settings(&text).unwrap()
}

/// Rolls of a length and, if that is not the fabric's, a width (m).
pub fn rolls(of: &[(f64, Option<f64>)]) -> Option<Vec<Roll>> {
    let roll = |&(length, width): &(f64, Option<f64>)| Roll {
        length: Some(length),
        width,
        ..Roll::default()
    };
    Some(of.iter().map(roll).collect())
}
