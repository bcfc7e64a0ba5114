//! What substeps came to, and how many constraints they solve.

/// The outcome of some substeps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct XpbdReport {
    /// Pieces into which each substep was divided; 1 where it was taken whole.
    pub pieces: u32,
    /// Kinetic energy at the end (J).
    pub kinetic_energy: f64,
    /// Speed of the fastest vertex at the end (m/s).
    pub fastest: f64,
}

/// Numbers of constraints of one sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConstraintCount {
    /// Triangles with three strains each.
    pub membrane: usize,
    /// Entries of the bending force, or triangles with three curvatures for x, y and z each.
    pub bending: usize,
    /// Elastics, three rows each.
    pub elastics: usize,
    /// Contact samples.
    pub contacts: usize,
}
