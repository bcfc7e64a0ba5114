//! All tests over the public interface, in one program: `cargo test -p toile-nesting --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod anytime;
mod clashes;
mod constraints;
mod instances;
mod limits;
mod locks;
mod markers;
mod print;
mod referee;
mod rolls;
