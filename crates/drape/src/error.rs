//! What can go wrong in building or running a simulation.

/// Why a simulation could not be built or went no further.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrapeError {
    /// The mesh of an object cannot be simulated.
    #[error("object \"{object}\": {defect}; repair the mesh and try again")]
    Mesh {
        /// Name of the object.
        object: String,
        /// What is wrong with it.
        defect: toile_geometry::MeshDefect,
    },
    /// A triangle of cloth has no area at rest, so no strain can be measured on it.
    #[error(
        "object \"{object}\": triangle {triangle} has no area at rest; merge its corners or mesh the panel again"
    )]
    EmptyTriangle {
        /// Name of the object.
        object: String,
        /// Index of the triangle.
        triangle: usize,
    },
    /// A number of a material is missing, negative or not finite.
    #[error("material of \"{object}\": {field} is {value}; {remedy}")]
    Material {
        /// Name of the object.
        object: String,
        /// Which number.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        remedy: &'static str,
    },
    /// Something of the scene is given that does not fit.
    #[error("{place}: {what}; {remedy}")]
    Scene {
        /// Where in the scene.
        place: String,
        /// What is wrong.
        what: String,
        /// What to do.
        remedy: String,
    },
    /// A position or velocity became something that is no number, and smaller steps did not help.
    #[error(
        "{stage}: vertex {vertex} left the finite numbers even at the smallest step; look for slivers or extreme stiffness near it"
    )]
    NotFinite {
        /// What was being done.
        stage: &'static str,
        /// The first vertex concerned.
        vertex: usize,
    },
    /// Steps made no progress even at the smallest size.
    #[error(
        "{stage}: no progress even at the smallest step (residual {residual:.2e}); the last good state was kept"
    )]
    NoProgress {
        /// What was being done.
        stage: &'static str,
        /// Net force over weight at the last good state.
        residual: f64,
    },
    /// Seams stayed open.
    #[error(
        "seams are still {gap_mm:.1} mm apart after {steps} steps of sewing; the garment may be too tight for the body, or a panel hangs behind it: check the measurements and the placement"
    )]
    SeamsOpen {
        /// Largest remaining gap [mm].
        gap_mm: f64,
        /// Steps taken.
        steps: usize,
    },
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}
