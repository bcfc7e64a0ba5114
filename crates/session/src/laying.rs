//! Searches for markers while a watcher looks on.

use crate::watcher::tell;
use crate::{NestOptions, SessionError, Watcher};
use toile_marker::{Follow, Garments, Laying, Standing, lay};

/// Does what is to be followed, with a watcher that is told and may stop it.
pub(crate) fn watched<T>(watcher: &mut dyn Watcher, work: impl FnOnce(&mut Follow<'_>) -> T) -> T {
    let stop = watcher.stop_flag().unwrap_or_default();
    let mut told =
        |standing: &Standing| tell(watcher, "laying out", standing.done, &standing.words()).is_ok();
    work(&mut Follow {
        told: &mut told,
        stop,
    })
}

/// Lays garments, followed by a watcher.
pub(crate) fn lay_watched(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<Laying>, SessionError> {
    let layings = watched(watcher, |follow| lay(garments, options, follow))?;
    Ok(layings)
}
