//! Sources of the figures of a fabric.

/// Sources of the figures of a fabric.
#[derive(Clone, Copy, Debug)]
pub struct FabricSources {
    /// Of the density.
    pub density: &'static str,
    /// Of the thickness.
    pub thickness: &'static str,
    /// Of the stretch.
    pub stretch: &'static str,
    /// Of the shear.
    pub shear: &'static str,
    /// Of the bending.
    pub bend: &'static str,
    /// Of the friction.
    pub friction: &'static str,
}
