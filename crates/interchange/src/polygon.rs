//! Polygonal faces of meshes: checks them and triangulates them.

use crate::FormatError;
use toile_geometry::{TriangulationError, Vec3, polygon_triangles};

/// A fault of a face and the remedy; the reader adds the place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FaceFault {
    what: String,
    hint: &'static str,
}

impl FaceFault {
    fn new(what: impl Into<String>, hint: &'static str) -> Self {
        let what = what.into();
        Self { what, hint }
    }

    /// The error for a face at a place.
    pub fn at(self, place: String) -> FormatError {
        FormatError::new(place, self.what, self.hint)
    }
}

/// Removes repeated consecutive corners: exporters write a triangle as a quad with one corner twice.
///
/// # Errors
/// Fewer than three corners are left, or a corner occurs again later.
pub(crate) fn distinct_corners<T, K: Ord>(
    corners: &mut Vec<T>,
    vertex: impl Fn(&T) -> K,
) -> Result<(), FaceFault> {
    corners.dedup_by_key(|corner| vertex(corner));
    while corners.len() > 1 && vertex(&corners[0]) == vertex(&corners[corners.len() - 1]) {
        corners.pop();
    }
    if corners.len() < 3 {
        return Err(FaceFault::new(
            format!("a face of {} different corners", corners.len()),
            "give at least three, or remove it",
        ));
    }
    let mut vertices: Vec<K> = corners.iter().map(vertex).collect();
    vertices.sort();
    match vertices.windows(2).any(|pair| pair[0] == pair[1]) {
        true => Err(FaceFault::new(
            "a polygon has a corner twice, as one round a hole has",
            "split it into simple polygons, or triangulate the faces when exporting",
        )),
        false => Ok(()),
    }
}

/// Triangulates a face by the positions of its corners; returns indices of corners.
///
/// # Errors
/// A polygon without area, with two corners at one position, or that crosses itself.
pub(crate) fn triangles_of(corners: &[Vec3]) -> Result<Vec<[usize; 3]>, FaceFault> {
    polygon_triangles(corners).map_err(|error| match error {
        TriangulationError::Flat => FaceFault::new(
            format!(
                "a polygon without area: its {} corners lie on a line",
                corners.len()
            ),
            "remove it, or dissolve degenerate faces in the program it comes from",
        ),
        TriangulationError::Duplicate => FaceFault::new(
            "two corners of a polygon lie in one place",
            "merge vertices by distance in the program it comes from",
        ),
        TriangulationError::Conflict(_) => FaceFault::new(
            format!(
                "a polygon that crosses itself, or is bent too far out of its plane ({} corners)",
                corners.len()
            ),
            "split it into simple polygons, or triangulate the faces when exporting",
        ),
        TriangulationError::Coordinate => FaceFault::new(
            "a polygon with a coordinate that is too large or too small",
            "give metres",
        ),
    })
}
