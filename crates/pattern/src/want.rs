//! What a number must be where it stands.

/// The kind of value that a number must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// A length (m).
    Length,
    /// A plain number.
    Plain,
    /// An angle (rad): computed as a plain number, typed and shown in degrees.
    Angle,
    /// Anything, as a variable is: a bare value is a plain number.
    Any,
}
