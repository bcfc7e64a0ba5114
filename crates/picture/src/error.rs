//! Errors of pictures.

/// Why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The size asked for is empty or too large.
    #[error(
        "a picture of {width} x {height} pixels cannot be made; ask for 1 to 64 million pixels"
    )]
    Size {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A surface's mesh is unusable.
    #[error("surface {surface} cannot be drawn: {defect}")]
    Mesh {
        /// Index of the surface.
        surface: usize,
        /// What is wrong with it.
        defect: toile_geometry::MeshDefect,
    },
    /// A list does not fit the mesh.
    #[error("surface {surface} has {got} {list} where {expected} are needed")]
    List {
        /// Index of the surface.
        surface: usize,
        /// Which list.
        list: &'static str,
        /// Its length.
        got: usize,
        /// The length that fits.
        expected: usize,
    },
    /// There is nothing to draw.
    #[error("the scene is empty; add a surface with vertices")]
    Empty,
    /// A number that must be finite is not.
    #[error("{0} is not a finite number, or its range is empty")]
    NotFinite(&'static str),
    /// The pixels could not be encoded.
    #[error("the PNG cannot be written: {0}")]
    Png(#[from] png::EncodingError),
}
