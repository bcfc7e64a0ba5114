//! Arrays for Python: read-only, so that what was returned does not change.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An array of rows of equal length, which cannot be written to.
pub fn rows<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    let flat: Vec<T> = rows.flatten().collect();
    let array = PyArray1::from_vec(py, flat).reshape([count, N])?;
    read_only(&array)?;
    Ok(array)
}

/// Keeps an array from being written to.
pub fn read_only(array: &Bound<'_, PyAny>) -> PyResult<()> {
    let flags = PyDict::new(array.py());
    flags.set_item("write", false)?;
    array.call_method("setflags", (), Some(&flags))?;
    Ok(())
}
