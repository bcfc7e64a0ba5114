//! Quantities that a number may be required to have.

/// The quantity that a number must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// A length (m).
    Length,
    /// A plain number.
    Plain,
    /// An angle (rad): computed as a plain number, typed and shown in degrees.
    Angle,
    /// Any quantity, as for a variable: a number without unit is plain.
    Any,
}
