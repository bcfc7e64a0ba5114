//! Figures of cloth in one table, a library of fabrics with their sources, materials from textile tests.
//!
//! A [`Material`] is what the laws of cloth take: 17 figures, each declared once in the table of `material.rs` with
//! its default, its names in files and in the window, its unit and its range. Patterns, scenes, fabric files,
//! checks and the window's table walk over [`FIGURES`]; a new figure is one more entry there.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod domain;
pub mod exact;
mod figure;
mod figure_value;
pub mod kes;
mod library;
mod material;
mod sources;

pub use domain::{Domain, Unit};
pub use figure::{Component, FigureFault};
pub use figure_value::{FigureValue, Shape};
pub use kes::KesValues;
pub use library::{LIBRARY, LibraryFabric};
pub use material::{Access, Compression, FIGURES, Figure, Material};
pub use sources::FabricSources;
