//! The window of Toile: the pattern on its table, the garment on the mannequin beside it.
//!
//! The window does not edit documents itself: every change is a command of the session. Camera, selection
//! and tools are view state and stay here.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod app;
mod canvas;
mod fields;
mod figure;
mod glossary;
mod gpu;
mod inspector;
mod tables;
mod theme;
mod tools;
mod views;

pub use app::command::{Menu, UiCommand};
pub use app::command_table::{commands, named};
pub use app::{Beginning, ToileApp};
pub use canvas::selection::{Item, Selection};
pub use figure::{FigureTask, FigureWindow};
pub use tools::slots::{Answer, Slot, SlotKind, SlotTool};
pub use tools::{
    Event as ToolEvent, LineStep, Overlay, Pointer, State as ToolState, Tone, Tool, ToolModifiers,
};
pub use views::pattern::PatternView;
