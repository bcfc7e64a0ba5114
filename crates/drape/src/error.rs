//! Errors of building and running a simulation.

use crate::laws::rest_sheet::IllConditioned;

/// An error of building or running a simulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrapeError {
    /// The mesh of an object cannot be simulated.
    #[error("object \"{object}\": {defect}; repair the mesh and try again")]
    Mesh {
        /// Name of the object.
        object: String,
        /// The defect.
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
    /// Rest shapes changed so far that the mesh of their panel is ill-conditioned.
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
        /// Name of the number.
        field: String,
        /// Its value.
        value: f64,
        /// The remedy.
        remedy: &'static str,
    },
    /// Invalid data in a scene, a world or a checkpoint.
    #[error("{place}: {what}; {remedy}")]
    Scene {
        /// Object or field concerned.
        place: String,
        /// The defect.
        what: String,
        /// The remedy.
        remedy: String,
    },
    /// A position or velocity that is not finite, in the input or after a step.
    #[error(
        "{stage}: the position or velocity of vertex {vertex} is not a finite number; look for slivers or extreme stiffness near it, or take smaller steps"
    )]
    NotFinite {
        /// The operation.
        stage: &'static str,
        /// The first vertex concerned.
        vertex: usize,
    },
    /// A vertex with a speed that is not physical: the step exceeds the method's stability limit.
    #[error(
        "{stage}: blown up at vertex {vertex} ({speed:.3e} m/s); the substep of {substep:.3e} s is too long: take more substeps, softer cloth or an implicit method"
    )]
    BlownUp {
        /// The method.
        stage: &'static str,
        /// The fastest vertex.
        vertex: usize,
        /// Its speed (m/s).
        speed: f64,
        /// The substep (s).
        substep: f64,
    },
    /// A step ended with far more energy than initial energy, weight and air can have supplied.
    #[error(
        "{stage}: the energy grew to {energy:.3e} J where {possible:.3e} J can have come from the start, weight and air; the fastest is vertex {vertex}; take more substeps, or a method that damps such as implicit-euler"
    )]
    EnergyGrew {
        /// The method.
        stage: &'static str,
        /// The fastest vertex after the step.
        vertex: usize,
        /// Energy of motion, strain, elastics and contact after the step (J).
        energy: f64,
        /// Largest energy that can have been supplied (J).
        possible: f64,
    },
    /// An explicit method that would need too many substeps to be stable.
    #[error(
        "{stage}: vertex {vertex} is so stiff for its mass that a step would take {substeps:.1e} substeps; mesh without slivers or take an implicit method"
    )]
    TooStiff {
        /// The method.
        stage: &'static str,
        /// The vertex of the fastest vibration.
        vertex: usize,
        /// Substeps that stability needs.
        substeps: f64,
    },
    /// No progress even with the smallest step.
    #[error(
        "{stage}: no progress even at the smallest step (residual {residual:.2e}); the last good state was kept"
    )]
    NoProgress {
        /// The operation.
        stage: &'static str,
        /// Net force over weight at the last good state.
        residual: f64,
    },
    /// Seams that are still open after the last step of sewing.
    #[error(
        "seams are still {gap_mm:.1} mm apart after {steps} steps of sewing; the garment may be too tight for the body, or a panel hangs behind it: check the measurements and the placement"
    )]
    SeamsOpen {
        /// Largest remaining gap (mm).
        gap_mm: f64,
        /// Steps taken.
        steps: usize,
    },
    /// Cloth that no seam or contact holds on the body any more.
    #[error(
        "the garment fell off the body: the highest point of a part that hangs together is {top:.2} m above the soles; check where its panels are worn, its size, and what should hold it"
    )]
    LeftBody {
        /// Highest point of the part over the body's lowest (m).
        top: f64,
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
