//! Force laws: pure functions over small stencils giving energy, gradient and Hessian.

pub mod bending;
pub mod contact;
pub mod elastic;
pub mod membrane;
pub mod stretch;
