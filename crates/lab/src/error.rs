//! Errors of the laboratory.

/// Why an experiment could not be made.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// Something asked for by name does not exist.
    #[error("there is no {what} \"{name}\"; choose from {known}")]
    Unknown {
        /// Law, scene, benchmark.
        what: &'static str,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A simulation stopped.
    #[error(transparent)]
    Drape(#[from] toile_drape::DrapeError),
    /// A simulation ended before it was where it had to be.
    #[error("{what}: {got:.2e} after {steps} steps, {asked:.0e} asked for")]
    Unfinished {
        /// What was to fall below a limit.
        what: &'static str,
        /// Its value.
        got: f64,
        /// The limit.
        asked: f64,
        /// Steps taken.
        steps: usize,
    },
    /// A file of the laboratory itself is not what it must be.
    #[error("{file} of the laboratory is damaged: {what}; build Toile again")]
    Damaged {
        /// Its name.
        file: String,
        /// What is wrong.
        what: String,
    },
    /// Something could not be read, made or written.
    #[error("{what}")]
    Files {
        /// What went wrong, with place and remedy.
        what: String,
    },
    /// A picture could not be drawn.
    #[error(transparent)]
    Picture(#[from] toile_picture::PictureError),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}
