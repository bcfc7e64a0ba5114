//! All tests over the public interface, in one program: `cargo test -p toile-flatten --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod closed_forms;
mod common;
mod refused;
mod regions;
mod sphere;
