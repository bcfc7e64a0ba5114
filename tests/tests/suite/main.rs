//! Tests over the public interfaces of all crates, in one program: `cargo test -p toile-tests --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod checkpoints;
mod damaged;
mod edits;
mod events;
mod flattened_bodice;
mod garments;
mod losses;
mod morph;
mod nothing_lost;
mod records;
mod scene_checkpoints;
