//! What tests of markers need.

use std::path::{Path, PathBuf};
use toile_interchange::{MarkerSettings, read_marker_settings};

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
