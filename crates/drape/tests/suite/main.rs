//! All tests over the public interface, in one program: `cargo test -p toile-drape --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod bounce;
mod cantilever;
mod curvature;
mod friction;
mod hard_scenes;
mod impact_queries;
mod layers;
mod merging;
mod moving;
mod queries;
mod reshape;
mod scene;
mod self_collision;
mod support;
mod tangles;
mod ties;
mod tracks;
mod transfer;
mod tube;
mod world_edits;
mod xpbd;
mod xpbd_air;
