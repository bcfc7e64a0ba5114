//! Garments laid while a watcher looks on.

use crate::watcher::tell;
use crate::{NestOptions, SessionError, Watcher};
use toile_marker::{Follow, Garments, Laying, Standing, lay};

/// Lays garments, followed by a watcher.
pub(crate) fn lay_watched(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<Laying>, SessionError> {
    let stop = watcher.stop_flag().unwrap_or_default();
    let mut told =
        |standing: &Standing| tell(watcher, "laying out", standing.done, &standing.words()).is_ok();
    let mut follow = Follow {
        told: &mut told,
        stop,
    };
    Ok(lay(garments, options, &mut follow)?)
}
