//! The laboratory: physical laws as small scenes, speed against accuracy, stability, benchmarks.
//! It works through the public interfaces only, and tries every method there is.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::print_stdout))]

mod check;
mod elastica;
mod error;
mod flat;
mod laws;
mod outline;
mod root;
mod settle;

pub use check::{Cases, Check, table};
pub use elastica::{Elastica, heavy_elastica};
pub use error::LabError;
pub use flat::{Flat, MeshKind, disc, rectangle};
pub use laws::{Drape, LAWS, Law, Resolved, cusick, locking, validate};
pub use outline::{fold_count, shadow, shadow_area};
pub use settle::{in_time, to_rest};
