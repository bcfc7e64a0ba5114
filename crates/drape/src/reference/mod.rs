//! Methods kept for comparison: no command and no view takes them unless they are asked for by name. Only
//! the list of methods names them.

pub mod block_descent;
mod colours;
mod descent;
pub mod forward_euler;
pub mod lbfgs;
mod metric;
mod pieces;
pub mod projective;
pub mod relaxation;
pub mod runge_kutta;
pub mod symplectic_euler;
