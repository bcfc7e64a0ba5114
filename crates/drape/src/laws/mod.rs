//! Force laws: pure functions over small stencils giving energy, gradient and Hessian.

pub mod air;
pub mod bending;
pub mod contact;
pub mod elastic;
pub mod fold;
pub mod membrane;
pub mod rest_sheet;
pub mod stretch;
