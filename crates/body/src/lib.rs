//! Mannequins: skeleton, ellipsoid primitives, skin.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod curve;
mod describe;
mod error;
mod fair;
mod field;
mod gaps;
mod landmarks;
mod limbs;
mod mannequin;
mod marks;
mod request;
mod rings;
mod solve;
mod tape;
mod template;
mod warp;

pub use describe::Description;
pub use error::BodyError;
pub use field::{Field, Part, Primitive, THRESHOLD, VISIBLE_RATIO};
pub use gaps::Gap;
pub use landmarks::{BodyLevels, Landmarks, PartAxis};
pub use mannequin::Mannequin;
pub use template::Figure;
