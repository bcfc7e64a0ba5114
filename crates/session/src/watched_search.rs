//! Runs a marker search that reports progress to a watcher and can be stopped by it.

use crate::watcher::report_progress;
use crate::{NestOptions, SessionError, Watcher};
use toile_marker::{FinishedMarker, Garments, SearchProgress, SearchWatcher, lay};

/// Runs `work` with progress reported to the watcher, which may stop it.
pub(crate) fn watched<T>(
    watcher: &mut dyn Watcher,
    work: impl FnOnce(&mut SearchWatcher<'_>) -> T,
) -> T {
    let stop = watcher.stop_flag().unwrap_or_default();
    let mut report = |progress: &SearchProgress| {
        report_progress(watcher, "laying out", progress.done, &progress.words()).is_ok()
    };
    work(&mut SearchWatcher {
        report: &mut report,
        stop,
    })
}

/// Makes markers of garments, with progress reported to the watcher.
pub(crate) fn lay_watched(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<FinishedMarker>, SessionError> {
    let finished_markers = watched(watcher, |follow| lay(garments, options, follow))?;
    Ok(finished_markers)
}
