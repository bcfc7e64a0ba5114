//! Quantities that a number may be required to have.

/// The quantity that a number is required to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// A length (m).
    Length,
    /// A plain number.
    Plain,
    /// An angle (rad). Formulas compute it as a plain number; it is typed and shown in degrees.
    Angle,
    /// Any quantity, as for variables; a number without unit is then plain.
    Any,
}
