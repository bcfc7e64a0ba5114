//! Garments on moving figures of ellipsoids, adjusted once a frame (Rudomin, Castillo,
//! Muñoz and Alencastre 2002).
//!
//! A [`Character`] is what files hold. [`Ellipsoids`] are one such character in motion; any number
//! of [`Garment`]s refer to them. Each frame the ellipsoids are advanced once, then every garment
//! is adjusted to them once, by gravity or by shape, and shown as often as is liked. Nothing is
//! allocated after `new`, and the same calls give the same bytes.
//!
//! Lengths are in metres, times in seconds, angles in radians; Y is up.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod adjust;
mod character;
mod edges;
mod ellipsoids;
mod error;
mod field;
mod garment;
mod home;
mod lanes;
mod player;
mod push;
mod turn;

pub use character::{
    Character, CharacterEllipsoid, CharacterFile, CharacterJoint, Group, KeyPose, KeyedClip,
    MAX_GROUPS,
};
pub use ellipsoids::Ellipsoids;
pub use error::RealtimeError;
pub use field::{Field, Nearest};
pub use garment::{Garment, GarmentSettings};
pub use player::Blending;
pub use turn::Frame;
