//! Sparse symmetric matrices over a mesh: 3x3 blocks and scalars by rows, nested dissection and Cholesky
//! factorisation, conjugate gradients. It does not depend on cloth. Results are the same to the byte at any number of
//! threads.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod factor;
mod matrix;
mod pcg;

pub use matrix::{BlockPattern, ROW_CHUNK, ScalarMatrix, dot};
pub use pcg::{BlockJacobi, LinearSystem, Pcg, PcgLimits, Preconditioner};
