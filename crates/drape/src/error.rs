//! What can go wrong in building or running a simulation.

use crate::laws::rest_sheet::IllConditioned;

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
    /// Rest shapes changed so far that the triangles of their panel do not serve any more.
    #[error(
        "triangle {triangle} is too far from the shape its mesh was made for; mesh its panel again"
    )]
    NeedsRemesh {
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
    /// A position or velocity is no finite number, given so or become so.
    #[error(
        "{stage}: the position or velocity of vertex {vertex} is not a finite number; look for slivers or extreme stiffness near it, or take smaller steps"
    )]
    NotFinite {
        /// What was being done.
        stage: &'static str,
        /// The first vertex concerned.
        vertex: usize,
    },
    /// A vertex moves as nothing physical does: the step is above the method's stability limit.
    #[error(
        "{stage}: blown up at vertex {vertex} ({speed:.3e} m/s); the substep of {substep:.3e} s is too long: take more substeps, softer cloth or an implicit method"
    )]
    BlownUp {
        /// The method.
        stage: &'static str,
        /// The fastest vertex.
        vertex: usize,
        /// Its speed [m/s].
        speed: f64,
        /// The substep [s].
        substep: f64,
    },
    /// A step ended with far more energy than the cloth can have come by.
    #[error(
        "{stage}: the energy grew to {energy:.3e} J where {possible:.3e} J can have come from the start, weight and air; the fastest is vertex {vertex}; take more substeps, or a method that damps such as implicit-euler"
    )]
    EnergyGrew {
        /// The method.
        stage: &'static str,
        /// The fastest vertex after the step.
        vertex: usize,
        /// Energy of motion, strain, elastics and contact after it [J].
        energy: f64,
        /// The most that the cloth can have come by [J].
        possible: f64,
    },
    /// No number of substeps that could be waited for keeps an explicit method stable.
    #[error(
        "{stage}: vertex {vertex} is so stiff for its mass that a step would take {substeps:.1e} substeps; mesh without slivers or take an implicit method"
    )]
    TooStiff {
        /// The method.
        stage: &'static str,
        /// The vertex of the fastest vibration.
        vertex: usize,
        /// Substeps it would take.
        substeps: f64,
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

impl From<IllConditioned> for DrapeError {
    fn from(IllConditioned { triangle }: IllConditioned) -> Self {
        Self::NeedsRemesh { triangle }
    }
}
