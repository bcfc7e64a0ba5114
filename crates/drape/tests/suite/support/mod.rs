//! What tests of cloth share.

pub mod crumpled;
pub mod hard_run;
pub mod hard_scenes;
pub mod numbers;
pub mod sheets;
pub mod solids;
pub mod strips;
pub mod tangles;
