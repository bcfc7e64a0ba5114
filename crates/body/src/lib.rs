//! Mannequins: skeleton, ellipsoid primitives, skin.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod attach;
mod bands;
mod bones;
mod conflict;
mod curve;
mod describe;
mod error;
mod fair;
mod field;
mod gaps;
mod girths;
mod joint;
mod landmarks;
mod levels;
mod limbs;
mod mannequin;
mod marks;
mod motion;
mod refit;
mod request;
mod rings;
mod scan;
mod shape;
mod skeleton;
mod skinning;
mod solve;
mod taken;
mod tape;
mod template;
mod underarm;
mod warp;

pub use attach::AttachedPrimitive;
pub use conflict::Conflict;
pub use describe::Description;
pub use error::BodyError;
pub use field::{Field, Part, Primitive, THRESHOLD, VISIBLE_RATIO};
pub use gaps::Gap;
pub use joint::Joint;
pub use landmarks::{BodyLevels, Landmarks, PartAxis};
pub use mannequin::{Mannequin, template_skin};
pub use motion::Motion;
pub use scan::{Loop, Scan, ScanLandmarks};
pub use skeleton::{JointFrames, Pose, Skeleton};
pub use template::Figure;
