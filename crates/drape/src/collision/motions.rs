//! A motion of the cloth between two queries, in which impacts are to be resolved.

use toile_geometry::Vec3;

/// A motion of all vertices, to be corrected in place.
pub struct Motions<'a> {
    /// Positions at the start (m).
    pub x: &'a [Vec3],
    /// Displacements from the start to the end (m).
    pub moves: &'a mut [Vec3],
    /// Velocities at the end (m/s).
    pub velocities: &'a mut [Vec3],
    /// Inverse masses (1/kg); zero for vertices whose motion is prescribed.
    pub inverse_mass: &'a [f64],
    /// Duration of the motion (s).
    pub span: f64,
}
