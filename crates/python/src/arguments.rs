//! Arguments of functions: words of closed lists, numbers and sequences as Python gives them.

use crate::errors::Error;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toile_session::{Choice, SizeSelection};

/// The value of a closed list for a word.
///
/// # Errors
/// Another word; the message lists those that are known.
pub fn chosen<T: Choice + 'static>(what: &str, word: &str) -> PyResult<T> {
    let place = T::words().iter().position(|known| *known == word);
    match place.and_then(|k| T::all().get(k)) {
        Some(&value) => Ok(value),
        None => Err(unknown(what, word, T::words())),
    }
}

/// The value of a list for its name.
///
/// # Errors
/// Another name; the message lists those that are known.
pub fn chosen_named<T: Copy>(
    what: &str,
    word: &str,
    all: &[T],
    name: fn(T) -> &'static str,
) -> PyResult<T> {
    let found = all.iter().find(|&&value| name(value) == word);
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|&value| name(value)).collect();
        unknown(what, word, &names)
    })
}

/// The error of a word that is not among those known.
pub fn unknown(what: &str, word: &str, known: &[&str]) -> PyErr {
    Error::new_err(format!(
        "there is no {what} {word:?}; choose one of {}",
        known.join(", ")
    ))
}

/// One thing or several, as a function is given them.
///
/// # Errors
/// Neither one nor a sequence of them.
pub fn one_or_more<'py, T>(
    given: &Bound<'py, PyAny>,
    one: impl Fn(&Bound<'py, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<T>> {
    let error = match one(given) {
        Ok(value) => return Ok(vec![value]),
        Err(error) => error,
    };
    match given.try_iter() {
        Ok(several) => several.map(|next| one(&next?)).collect(),
        Err(_) => Err(error),
    }
}

/// Sizes by name: one, several, or a dict of the number of garments of each.
///
/// # Errors
/// Anything else.
pub fn sizes(given: &Bound<'_, PyAny>) -> PyResult<SizeSelection> {
    let counted = match given.cast::<PyDict>() {
        Ok(counts) => {
            let each = counts.iter();
            each.map(|(size, count)| Ok((size.extract()?, count.extract()?)))
                .collect::<PyResult<Vec<(String, u32)>>>()?
        }
        Err(_) => one_or_more(given, |size| Ok((size.extract()?, 1)))?,
    };
    Ok(SizeSelection::Named(counted))
}
