//! The window of Toile: the pattern on the left, the garment on the mannequin on the right.
//!
//! It decides nothing about documents: whatever is done becomes a command of the session. Camera,
//! selection and tools are view state and stay here.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod act;
mod app;
mod bars;
mod command;
mod dialogs;
mod drawing;
mod fill;
mod gpu;
mod inside;
mod layout;
mod making;
mod notice;
mod orbit;
mod selection;
mod solid;
mod space;
mod stage_view;
mod table_paint;
mod table_view;
mod theme;

pub use app::ToileApp;
pub use command::UiCommand;
pub use selection::Selection;
