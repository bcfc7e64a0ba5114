//! Simulation of cloth: worlds and scenes, models, states, materials, force laws, contact, elastics, merging, methods
//! in time and to equilibrium. It does not depend on patterns, bodies, files or windows.
//!
//! Five lifetimes: a [`Model`] is constant, a [`Control`] may change with each step, a [`State`] changes in time,
//! contacts are recomputed, a [`Workspace`] is private memory. A model is compiled from a [`World`].
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod action;
mod bending_structure;
mod caps;
mod carry;
mod cloth;
mod collider;
pub mod collision;
mod contact_refinement;
mod contact_sample;
mod contact_settings;
mod contacts;
mod control;
mod digest;
mod elastic;
mod environment;
mod equilibrium;
mod error;
mod features;
mod garment;
mod hessian;
mod incremental_potential;
mod internal_strain;
mod kinetic_damping;
mod lane_arithmetic;
mod lanes;
pub mod laws;
mod material;
mod materials;
mod measure;
mod memory;
mod merge;
mod method;
mod methods;
mod model;
mod motion;
mod newton;
mod pair_policies;
mod pairs;
mod patches;
mod pseudo_transient;
mod recorded_track;
mod reference;
mod rest_data;
mod scene;
mod scene_checkpoint;
mod scene_run;
mod sew;
mod solid_friction;
mod state;
mod step;
mod submodel;
mod support;
mod system;
mod tie;
mod tied;
mod topology;
mod track;
mod verdict;
mod world;
mod xpbd;

pub use action::{Action, FARTHEST_PULL, HAND_FORCE, HAND_STIFFNESS, Input, Spot};
pub use carry::Carry;
pub use cloth::Cloth;
pub use collider::{Collider, PlacedSolid, PrescribedVertex};
pub use contact_sample::ContactSample;
pub use contact_settings::{ContactSettings, MAX_OFFSET};
pub use contacts::{Contact, Contacts};
pub use control::{Attachment, Attachments, Control, FrameAttachment};
pub use digest::Digest;
pub use elastic::{Elastic, ElasticCouplings, ElasticEnd};
pub use environment::{Damping, Environment, Parameter};
pub use equilibrium::{Equilibrium, Prediction};
pub use error::DrapeError;
pub use features::Feature;
pub use garment::{Checkpoint, GarmentLevel, GarmentRun, GarmentSetup, Progress, Stage};
pub use internal_strain::InternalStrain;
pub use laws::air::Air;
pub use material::MaterialLaws;
pub use materials::Materials;
pub use measure::{LayerMeasures, Measures, measure, residual, stretch_per_triangle};
pub use memory::{Memory, RelaxationMemory, RestMemory};
pub use merge::{keeps_corners, merge_map};
pub use method::{Method, MethodKind, MethodSettings, StepReport};
pub use methods::{largest_frequency, whole_energy};
pub use model::{Model, ModelParts, Prescribed};
pub use motion::{Motion, MotionKey, Pose};
pub use newton::{Expansion, Inertia, LinearSolver, NewtonReport, NewtonSettings, Workspace};
pub use pair_policies::{BETWEEN_OBJECTS, PairPolicies};
pub use pseudo_transient::{PseudoTransientContinuation, RestSettings};
pub use recorded_track::RecordedTrack;
pub use rest_data::RestData;
pub use scene::{MAX_LAYER, ObjectKind, Scene, SceneElastic, SceneEnd, SceneGrip, SceneObject};
pub use scene_checkpoint::SceneCheckpoint;
pub use scene_run::{SceneRun, Surface, TimeSettings};
pub use sew::{SewRun, SewSettings};
pub use solid_friction::SolidFriction;
pub use state::State;
pub use step::{StepSettings, step_in_time};
pub use support::{Support, supports};
pub use system::{System, SystemBuilder};
pub use tie::{Tie, TieEnd, TrianglePoint};
pub use toile_fabric::{Compression, Material};
pub use toile_sparse::PcgLimits;
pub use topology::Topology;
pub use track::{SharedTrack, Track};
pub use verdict::{Aspect, Finding, Verdict};
pub use world::{
    AttachmentEnd, AttachmentId, Edited, Kind, Layers, MeshVertex, Object, ObjectAttachment,
    ObjectId, OpenAttachment, PairPolicy, Simulation, VertexGrip, VertexMap, World, WorldEdit,
};
pub use xpbd::{ConstraintCount, Losses, Xpbd, XpbdReport, XpbdSettings};
