//! All tests over the public interface, in one program: `cargo test -p toile --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod batch;
mod cases;
mod command_line;
mod common;
mod flatten;
mod formats;
mod laboratory;
mod log;
mod markers;
mod pieces;
mod records;
mod sizes;
mod stored_markers;
mod suggested_seams;
mod what_is_said;
mod wrong_uses;
