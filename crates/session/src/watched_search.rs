//! Runs a marker search that reports progress to a watcher and can be stopped by it.

use crate::watcher::report_progress;
use crate::{NestOptions, SessionError, Watcher};
use toile_marker::{Follow, Garments, Laying, Standing, lay};

/// Runs `work` with progress reported to the watcher, which may stop it.
pub(crate) fn watched<T>(watcher: &mut dyn Watcher, work: impl FnOnce(&mut Follow<'_>) -> T) -> T {
    let stop = watcher.stop_flag().unwrap_or_default();
    let mut told = |standing: &Standing| {
        report_progress(watcher, "laying out", standing.done, &standing.words()).is_ok()
    };
    work(&mut Follow {
        told: &mut told,
        stop,
    })
}

/// Makes markers of garments, with progress reported to the watcher.
pub(crate) fn lay_watched(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<Laying>, SessionError> {
    let layings = watched(watcher, |follow| lay(garments, options, follow))?;
    Ok(layings)
}
