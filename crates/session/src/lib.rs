//! The application without a window: project, commands, history, journal, and the one function
//! that turns draft, fabrics and mannequin into a drape.
//!
//! Only the [`Project`] is edited, saved and undone. Draft, marker, garment and drape are derived
//! from it, kept while it does not change, and may be thrown away.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod choice;
mod command;
mod derived;
mod error;
mod event;
mod history;
mod journal;
mod live;
mod open;
mod project;
mod session;
mod setup;
mod watcher;

pub use choice::{BodyChoice, Quality};
pub use command::Command;
pub use error::SessionError;
pub use event::{Assembled, Draped, Event, Nested};
pub use journal::{journal_lines, read_journal};
pub use live::{LiveFrame, LiveRun};
pub use open::{Opened, PatternFormat, SAMPLE, open_pattern, read_pattern_text};
pub use project::Project;
pub use session::Session;
pub use setup::{GarmentJob, JobPanel};
pub use watcher::{Silent, Watcher};
