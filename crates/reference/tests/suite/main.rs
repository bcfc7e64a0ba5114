//! All tests over the public interface, in one program: `cargo test -p toile-reference --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod builders;
mod dissipation;
mod distances;
mod features;
mod methods;
mod policies;
#[path = "../../../drape/tests/suite/support/sheets.rs"]
mod sheets;
#[allow(dead_code)]
#[path = "../../../drape/tests/suite/support/solids.rs"]
mod solids;
#[path = "../../../drape/tests/suite/support/strips.rs"]
mod strips;
mod xpbd_viscosity;
