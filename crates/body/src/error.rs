//! Why a mannequin could not be made.

/// Reason why a mannequin could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A measurement lies outside the range of values that bodies have.
    #[error("measurement {name} is {value}: give a value from {low} to {high} ({unit})")]
    OutOfRange {
        /// The measurement.
        name: &'static str,
        /// The value refused (m) or (degrees).
        value: f64,
        /// Smallest value accepted (m) or (degrees).
        low: f64,
        /// Largest value accepted (m) or (degrees).
        high: f64,
        /// `m` or `degrees`.
        unit: &'static str,
    },
    /// Two measurements that no single body can have together.
    #[error("measurements {first} and {second} do not fit together: {remedy}")]
    Contradiction {
        /// The first measurement.
        first: &'static str,
        /// The second measurement.
        second: &'static str,
        /// Remedy: the change to make.
        remedy: &'static str,
    },
    /// A primitive that changes with a reference joint, although only rigid primitives are allowed.
    #[error(
        "primitive {primitive} changes with a reference joint, and a character's ellipsoids are rigid: take its keys out"
    )]
    NotRigid {
        /// The primitive, counted from 0.
        primitive: usize,
    },
    /// The primitives of a part do not enclose its axis, so that its skin would have a hole there.
    #[error("the primitives of the {part} do not enclose its axis near ({x:.3}, {y:.3}, {z:.3}) m")]
    Open {
        /// Name of the body part.
        part: &'static str,
        /// x of the place on the axis (m).
        x: f64,
        /// y of the place on the axis (m).
        y: f64,
        /// z of the place on the axis (m).
        z: f64,
    },
    /// Primitives were moved or deleted so that landmarks of the skin are out of order along the body or an
    /// arm.
    #[error(
        "the landmarks of the skin lie out of order at {level:.3} m on its template: give the primitives there back their places"
    )]
    Disordered {
        /// Height, or distance along the arm, of a landmark that is out of order (m).
        level: f64,
    },
    /// A mesh that cannot be measured as a body; the text names the fault.
    #[error("the mesh {0}")]
    Mesh(String),
    /// A description of a mannequin, or an edit of one, with values that no body can have; the text names the
    /// fault.
    #[error("mannequin description: {0}")]
    Description(String),
}
