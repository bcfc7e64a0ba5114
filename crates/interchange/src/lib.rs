//! Native formats, importers, exporters.
//!
//! Readers take bytes or text and return a value or a [`FormatError`] with place and remedy;
//! writers return bytes, and [`write_atomically`] puts them on the disk.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod atomic;
mod error;
mod garmentcode;
mod gltf;
mod obj;
mod obj_read;

pub use atomic::{write_all_atomically, write_atomically};
pub use error::{FileError, FormatError, read_text};
pub use garmentcode::{GarmentCodeReading, GarmentCodeWriting, read_garmentcode, write_garmentcode};
pub use gltf::{GlbMesh, GlbPrimitive, GlbScene, write_glb};
pub use obj::{ObjGroup, ObjMesh, write_obj};
pub use obj_read::read_obj;
