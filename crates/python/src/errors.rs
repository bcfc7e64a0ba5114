//! Exceptions of the module, made of the session's errors.

use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use std::path::Path;
use toile_session::SessionError;

create_exception!(
    toile,
    Error,
    PyException,
    "What was asked for cannot be done: str(error) says what, where and what to do about it."
);
create_exception!(
    toile,
    FormatError,
    Error,
    "A file has a wrong format or content, or a format cannot hold what is to be written.\n\n\
     path: the file, or \"pattern\" for bytes. place: the place in it, as in \"line 12\". what: the fault there.\n\
     hint: what to do about it. All are texts."
);
create_exception!(
    toile,
    PatternError,
    Error,
    "The pattern has faults that keep the garment from being made.\n\n\
     diagnostics: each fault with its place and remedy, as list of texts."
);
create_exception!(
    toile,
    Cancelled,
    Error,
    "The work was stopped because progress returned False."
);

/// Gives the classes of errors their fields, so that they are there in errors made by hand too.
pub fn add_fields(py: Python<'_>) -> PyResult<()> {
    let format = py.get_type::<FormatError>();
    for field in ["path", "place", "what", "hint"] {
        format.setattr(field, "")?;
    }
    py.get_type::<PatternError>()
        .setattr("diagnostics", pyo3::types::PyTuple::empty(py))
}

/// The exception for an error of the session.
pub fn raised(py: Python<'_>, error: SessionError) -> PyErr {
    let words = error.to_string();
    let made = match &error {
        SessionError::Cancelled => Ok(Cancelled::new_err(words)),
        SessionError::Format { path, error } => wrong_format(py, (words, path), error),
        SessionError::Write { file, error } => wrong_format(py, (words, Path::new(file)), error),
        SessionError::Faults { faults, .. } => with_faults(py, words, faults),
        _ => Ok(Error::new_err(words)),
    };
    made.unwrap_or_else(|failed| failed)
}

fn wrong_format(
    py: Python<'_>,
    (words, path): (String, &Path),
    error: &toile_session::FormatError,
) -> PyResult<PyErr> {
    let made = FormatError::new_err(words);
    let value = made.value(py);
    value.setattr("path", path.display().to_string())?;
    value.setattr("place", &error.place)?;
    value.setattr("what", &error.what)?;
    value.setattr("hint", &error.hint)?;
    Ok(made)
}

fn with_faults(py: Python<'_>, words: String, faults: &[String]) -> PyResult<PyErr> {
    let made = PatternError::new_err(words);
    made.value(py).setattr("diagnostics", faults)?;
    Ok(made)
}
