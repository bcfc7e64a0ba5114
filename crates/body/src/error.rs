//! Why a mannequin could not be made.

/// Reason why a mannequin could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A value that no body has.
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
    /// The primitives leave a hole where the skin should be.
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
    /// Landmarks of the skin that are not in the order from floor to crown that bodies have.
    #[error(
        "the landmarks of the skin lie out of order at {level:.3} m on its template: give the primitives there back their places"
    )]
    Disordered {
        /// Height, or distance along the arm (m).
        level: f64,
    },
    /// A mesh that cannot be measured as a body.
    #[error("the mesh {0}")]
    Mesh(String),
    /// A file of another version or with damaged values.
    #[error("mannequin description: {0}")]
    Description(String),
}
