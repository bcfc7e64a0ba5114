//! Primitives of the left side and the median plane, and those of both sides that they stand for.

use crate::Primitive;

/// Primitives, followed by the mirror images of the primitives off the median plane.
pub(crate) fn both_sides(mut primitives: Vec<Primitive>) -> Vec<Primitive> {
    let mirrored: Vec<Primitive> = primitives
        .iter()
        .filter(|p| !p.is_central())
        .map(Primitive::mirrored)
        .collect();
    primitives.extend(mirrored);
    primitives
}

/// For each primitive of both sides, in the order of [`both_sides`]: number of the primitive of the left side
/// and the median plane that it comes from, and whether it is the mirror image.
pub(crate) fn sources(left: &[Primitive]) -> Vec<(usize, bool)> {
    let images = (0..left.len()).filter(|&k| !left[k].is_central());
    (0..left.len())
        .map(|k| (k, false))
        .chain(images.map(|k| (k, true)))
        .collect()
}
