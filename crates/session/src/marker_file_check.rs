//! Checks a `marker.json` as it stands, also after somebody edited it.

use crate::SessionError;
use crate::input::read_file;
use crate::open::open_marker;
use crate::output::cannot;
use std::path::{Path, PathBuf};
use toile_interchange::{write_all_atomically, write_marker_svg};
use toile_marker::{MarkerSummary, judge_file};

/// The result of a check of a marker file.
#[derive(Clone, Debug)]
pub struct JudgedMarker {
    /// The main numbers of the marker.
    pub summary: MarkerSummary,
    /// Faults in words; empty if the marker can be cut.
    pub faults: Vec<String>,
    /// The drawing with overlaps in red, if a folder was given.
    pub files: Vec<PathBuf>,
}

/// Whether a file is a marker.
pub fn is_marker_file(path: &Path) -> bool {
    let marked = |text: &str| {
        let head = text.get(..400.min(text.len())).unwrap_or(text);
        head.contains("\"toile-marker\"")
    };
    let bytes = read_file(path).unwrap_or_default();
    std::str::from_utf8(&bytes).is_ok_and(marked)
}

/// Judges a `marker.json` by its own outlines: overlaps, gaps, margins, nap of each garment, print,
/// flaws. Rules that only the pattern knows (tilt allowed, folds, pairs, locks) are not judged.
/// Writes `marker-judged.svg`, in which overlaps are red, into the folder if one is given.
///
/// # Errors
/// The file cannot be read or is no marker; the drawing cannot be written.
pub fn judge_marker_file(path: &Path, folder: Option<&Path>) -> Result<JudgedMarker, SessionError> {
    let judged = judge_file(&open_marker(path)?);
    let mut files = Vec::new();
    if let Some(folder) = folder {
        let svg = write_marker_svg(&judged.drawing).map_err(cannot("marker-judged.svg"))?;
        let written = [("marker-judged.svg".to_owned(), svg.into_bytes())];
        write_all_atomically(folder, &written)?;
        files.push(folder.join("marker-judged.svg"));
    }
    Ok(JudgedMarker {
        summary: judged.summary,
        faults: judged.faults,
        files,
    })
}
