//! What is asked of a panel that is to be flattened.

use crate::FlattenError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_drape::laws::stretch::MembraneLaw;
use toile_geometry::Vec3;

/// Share of the surface's area on which the stretch keeps its limit (1).
pub const SHARE_WITHIN: f64 = 0.99;

/// What is asked of a panel.
#[derive(Clone, Debug)]
pub struct Options {
    /// Law of the fabric.
    pub law: MembraneLaw,
    /// Direction of the grain in space, along the surface as far as it can (1).
    pub grain: Vec3,
    /// Limit of the stretch on [`SHARE_WITHIN`] of the area, either way (1).
    pub strain: f64,
    /// Most darts that are added to the cuts.
    pub darts: usize,
    /// Cuts to be made first: vertices of the mesh along edges, from the outline to the apex.
    pub cuts: Vec<Vec<u32>>,
    /// Set to stop the work; asked before every dart that is tried.
    pub stop: Option<Arc<AtomicBool>>,
}

impl Options {
    /// Ends the work if it is to stop.
    ///
    /// # Errors
    /// It is to stop.
    pub(crate) fn go_on(&self) -> Result<(), FlattenError> {
        let is_stopped = self.stop.as_ref().map(|stop| stop.load(Ordering::Relaxed));
        match is_stopped {
            Some(true) => Err(FlattenError::Stopped),
            Some(false) | None => Ok(()),
        }
    }
}
