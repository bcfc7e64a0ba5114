//! Native formats, importers, exporters.
//!
//! Readers take bytes or text and return a value or a [`FormatError`] with place and remedy;
//! writers return bytes, and [`write_atomically`] puts them on the disk.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod atomic;
mod error;

pub use atomic::{write_all_atomically, write_atomically};
pub use error::{FileError, FormatError, read_text};
