//! Toile from Python: the module `toile`, which passes on to the session and decides nothing itself.

mod arguments;
mod arrays;
mod body;
mod draft;
mod errors;
mod flat;
mod garment;
mod nest;
mod pattern;
mod progress;

/// Garment patterns from Python: read, changed, drafted, laid on fabric, draped, written.
///
/// Lengths are in metres, angles in radians, areas in square metres, shares are plain numbers (0.02 is 2 %). Arrays
/// are NumPy's, of float64 (indices of uint32), and read-only: what the module returns does not change. Space is
/// right-handed, y up, the body faces +z; a piece lies in its own plane, seen from the right side of the cloth.
///
/// Errors are of class Error. Functions that work long take progress=f and call f(stage, share, words); an exception
/// in f stops them and is raised. They let other threads run.
#[pyo3::pymodule(name = "_toile")]
mod toile {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::body::{Body, body};
    #[pymodule_export]
    use crate::draft::{Draft, Edge, Notch, Piece, Seam};
    #[pymodule_export]
    use crate::errors::{Cancelled, Error, FormatError, PatternError};
    #[pymodule_export]
    use crate::flat::{Flat, flatten};
    #[pymodule_export]
    use crate::garment::{Garment, drape};
    #[pymodule_export]
    use crate::nest::{Marker, Nest, nest};
    #[pymodule_export]
    use crate::pattern::{Diagnostic, Guess, Loss, Pattern, read, write};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::errors::add_fields(module.py())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
