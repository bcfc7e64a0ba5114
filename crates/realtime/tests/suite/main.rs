//! All tests over the public interface, in one program: `cargo test -p toile-realtime --test suite NAME::` runs those of one file.
#![allow(clippy::unwrap_used)]

mod allocations;
mod bad_input;
mod coat;
mod dog;
