//! Force laws of materials, contact, elastics and air: pure functions over small stencils giving energy,
//! gradient and Hessian. The physical laws by which simulations are validated are in crate `lab`.

pub mod air;
pub mod bending;
pub mod contact;
pub mod elastic;
pub mod fold;
pub mod membrane;
pub mod rest_sheet;
pub mod stretch;
