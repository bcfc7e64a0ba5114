//! Methods for comparison only: no command and no view uses them unless a user gives their name. Only the list of
//! methods refers to them.

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
