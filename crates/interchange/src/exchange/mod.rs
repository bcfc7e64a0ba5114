//! Patterns of every format: one way in, [`read`], and one way out, [`write()`].
//!
//! Neither opens a file: whoever calls brings the bytes and takes the files that were written. Decisions on
//! what a file leaves open are returned as [`Guess`]es, each with the option that decides otherwise; what a
//! format has no place for is returned as [`Loss`]es, by kind and number.
//!
//! # Decided with
//! - [`crate::file_kind::FileKind`]: what a file is, by its content;
//! - [`crate::exchange::format::Format`]: formats, their words and endings;
//! - [`crate::exchange::content::Content`], [`mod@crate::exchange::contents`]: what a document holds, and which format
//!   has a place for it;
//! - [`crate::native`], [`crate::garmentcode`], [`crate::svg`], [`crate::dxf`], [`crate::valentina`]: readers and writers of the formats.

mod content;
mod contents;
mod format;
mod guess;
mod loss;
mod read_option;
mod read_options;
mod reading;
mod tables;
mod write_source;
mod writing;

#[cfg(test)]
mod tests;

pub use content::Content;
pub use contents::contents;
pub use format::Format;
pub use guess::Guess;
pub use loss::Loss;
pub use read_option::ReadOption;
pub use read_options::{Companion, ReadOptions};
pub use reading::{Reading, companion_names, read};
pub use tables::format_tables;
pub use write_source::{SizedDraft, WriteSource, Writing, Written};
pub use writing::write;
