//! Meshes and markers of the patterns that ship.

use super::{Content, markdown};
use crate::LabError;
use crate::clock::Clock;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toile_session::{
    Budget, MarkerSummary, NestOptions, SAMPLES, SessionError, SizeSelection, Watcher, mesh_panels,
    nest_patterns,
};

/// Edge length of the meshes (m).
const EDGE: f64 = 0.01;
/// Evaluations given to each marker.
const EVALUATIONS: u64 = 20_000_000;

/// A folder for files that nobody keeps.
pub(super) fn scratch() -> Result<tempfile::TempDir, LabError> {
    tempfile::tempdir().map_err(|error| LabError::Files {
        what: format!("cannot make a temporary folder: {error}; free some room in it"),
    })
}

/// Tells the watcher of one of several pieces of work.
pub(super) fn tell(
    watcher: &mut dyn Watcher,
    (stage, number, count): (&str, usize, usize),
    detail: &str,
) -> Result<(), LabError> {
    match watcher.progress(stage, number as f64 / count as f64, detail) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(LabError::Cancelled),
    }
}

/// The row of what failed: its name and why.
pub(super) fn failed(name: &str, error: &SessionError) -> Result<Vec<String>, LabError> {
    match error {
        SessionError::Cancelled => Err(LabError::Cancelled),
        error => Ok(vec![name.to_owned(), format!("failed: {error}")]),
    }
}

/// `toile mesh` of each pattern.
pub(super) fn meshes(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let folder = scratch()?;
    let mut rows = Vec::new();
    for (number, (path, name)) in SAMPLES.iter().enumerate() {
        tell(watcher, ("meshing", number, SAMPLES.len()), name)?;
        let clock = Clock::start();
        let file = folder.path().join("mesh.obj");
        rows.push(match mesh_panels(Path::new(path), None, EDGE, &file) {
            Ok((quality, _)) => vec![
                (*name).to_owned(),
                quality.triangles.to_string(),
                format!("{:.1}", quality.smallest_free_angle.to_degrees()),
                quality.under_20.to_string(),
                format!("{:.2}", 1e3 * quality.mean_edge),
                format!(
                    "{:.2} to {:.2}",
                    1e3 * quality.shortest_edge,
                    1e3 * quality.longest_edge
                ),
                format!("{:.0}", 1e3 * clock.spent()),
            ],
            Err(error) => failed(name, &error)?,
        });
    }
    let columns = [
        "pattern",
        "triangles",
        "smallest angle, degrees",
        "triangles under 20 degrees",
        "mean edge, mm",
        "edges, mm",
        "processor time, ms",
    ];
    Ok(markdown(&columns, rows).into())
}

/// `toile nest` of each pattern, alone and in all sizes.
pub(super) fn markers(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let folder = scratch()?;
    let alone = NestOptions {
        budget: Budget::Evaluations(EVALUATIONS),
        seed: 1,
        formats: Vec::new(),
        ..NestOptions::default()
    };
    let all_sizes = NestOptions {
        sizes: SizeSelection::All,
        ..alone.clone()
    };
    let mut rows = Vec::new();
    let count = 2 * SAMPLES.len();
    for (path, name) in SAMPLES {
        for (options, suffix) in [(&alone, ""), (&all_sizes, ", six sizes")] {
            let name = format!("{name}{suffix}");
            tell(watcher, ("laying out", rows.len(), count), &name)?;
            let share = rows.len() as f64 / count as f64;
            let mut follow = |_: &str, done: f64, _: &str| {
                watcher.progress("laying out", share + done / count as f64, &name)
            };
            let clock = Clock::start();
            let patterns = [PathBuf::from(path)];
            let made = nest_patterns(&patterns, options, (folder.path(), &mut follow));
            rows.push(match made {
                Ok((nested, _)) => marker_row(&name, &nested, &clock),
                Err(error) => failed(&name, &error)?,
            });
        }
    }
    let columns = [
        "marker",
        "pieces",
        "not laid",
        "width, m",
        "fabric, m",
        "efficiency, %",
        "referee",
        "wall / processor time, s",
    ];
    Ok(markdown(&columns, rows).into())
}

/// The markers of one job; each of the patterns that ship is cut from one fabric.
fn marker_row(name: &str, nested: &[MarkerSummary], clock: &Clock) -> Vec<String> {
    let joined = |tell: &dyn Fn(&MarkerSummary) -> String| {
        let each: Vec<String> = nested.iter().map(tell).collect();
        each.join(", ")
    };
    let sound = nested.iter().all(|marker| marker.sound);
    vec![
        name.to_owned(),
        joined(&|marker| marker.pieces.to_string()),
        joined(&|marker| marker.unplaced.to_string()),
        joined(&|marker| format!("{:.2}", marker.width)),
        joined(&|marker| format!("{:.3}", marker.length)),
        joined(&|marker| format!("{:.2}", 100.0 * marker.efficiency)),
        if sound { "passed" } else { "refused" }.to_owned(),
        format!("{:.1} / {:.1}", clock.wall(), clock.spent()),
    ]
}
