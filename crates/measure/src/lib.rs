//! Body measurements: a catalogue of names with their meaning, and tables of values.
//!
//! Values are SI: metres for lengths, radians for angles. Names are snake_case; where GarmentCode
//! has a name for a measurement, it is used here too, so that its tables read without a map.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod catalogue;
mod children;
mod foreign;
mod further;
mod measurement;
mod predict;
mod samples;
mod survey;
mod table;

pub use catalogue::{CATALOGUE, definition, is_angle};
pub use foreign::{FREESEWING, SEAMLY, translated};
pub use further::FURTHER;
pub use measurement::{Definition, UnitKind};
pub use predict::Build;
pub use table::{MeasureError, Measured, Measurements, Origin};
