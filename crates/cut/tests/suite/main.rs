//! All tests over the public interface, in one program: `cargo test -p toile-cut --test suite NAME::` runs those of one file.
#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;
mod corners;
mod darts;
mod holes;
mod properties;
