//! All tests over the public interface, in one program: `cargo test -p toile-assembly --test suite NAME::` runs those of one file.
#![allow(clippy::unwrap_used)]

mod flares;
mod morph;
mod placement;
mod quality;
mod random;
mod seams;
mod support;
