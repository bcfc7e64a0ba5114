//! All tests over the public interface, in one program: `cargo test -p toile-pattern --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod causes;
mod compass;
mod diagnostics;
mod drafting;
mod edits;
mod enormous;
mod marker_journals;
mod markers;
mod names;
mod plans;
mod sample;
mod suggested_seams;
mod truing;
mod walk;
