//! GarmentCode (pygarment) pattern specifications: JSON with panels placed in space, curved
//! edges and a list of stitched edge pairs (Korosteleva and Sorkine-Hornung 2023).
//!
//! Curves, units and places are carried over exactly. A stitch has no direction in the file: see
//! [`read_garmentcode`].

mod curves;
mod json;
mod loops;
mod reader;
mod specification;
mod writer;

#[cfg(test)]
mod tests;

pub use reader::{GarmentCodeReading, read_garmentcode};
pub use writer::{GarmentCodeWriting, write_garmentcode};
