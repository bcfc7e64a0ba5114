//! A motion of the cloth between two looks, to be corrected.

use toile_geometry::Vec3;

/// A motion in hand.
pub struct Motions<'a> {
    /// Where vertices are [m].
    pub x: &'a [Vec3],
    /// Where each goes from there [m].
    pub moves: &'a mut [Vec3],
    /// Their velocities at the end [m/s].
    pub velocities: &'a mut [Vec3],
    /// One over the mass of each [1/kg]; zero where nothing moves it.
    pub lightness: &'a [f64],
    /// The time that the motion takes [s].
    pub span: f64,
}
