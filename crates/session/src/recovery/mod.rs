//! Recovery: while a document has changes that are in no file, all of it is kept in a folder of
//! the user's, so that a crash loses a second's work at most. The last steps of its history are kept with it.
//!
//! Every process has its own three files there: `ID.lock`, which it holds locked as long as it
//! lives, and the last two states of its document, `ID.newest` and `ID.before`. A state whose lock
//! nobody holds was left by a crash.
//!
//! # Decided with
//! - [`crate::recovery::keeper::Recovery`]: the state kept, and when it is let go;
//! - [`crate::recovery::state_file::DocumentState`], [`crate::recovery::past_step::PastStep`]: the file, and
//!   the last steps in it;
//! - [`crate::recovery::abandoned::abandoned`]: found after a crash;
//! - [`crate::session::Session::restore`] (`perform.rs`): opened again;
//! - [`toile_interchange::write_atomically`]: how other files are written whole; states kept here do it
//!   themselves.
//!
//! When: the window, `app/mod.rs`; offered in `app/welcome.rs`.

mod abandoned;
mod keeper;
mod past_step;
mod state_file;

pub use abandoned::{Abandoned, abandoned};
pub use keeper::Recovery;
pub use past_step::PastStep;

use std::path::{Path, PathBuf};

/// Ending of the name of the file that a process holds locked.
const LOCK: &str = "lock";
/// Ending of the name of the file with the newest state.
const NEWEST: &str = "newest";
/// Ending of the name of the file with the state before the newest.
const BEFORE: &str = "before";

/// The user's folder for data that this program keeps from one run to the next; `None` if the system has no
/// such folder.
pub fn state_folder() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "toile")?;
    let folder = folders
        .state_dir()
        .unwrap_or_else(|| folders.data_local_dir());
    Some(folder.to_owned())
}

/// Path of a file of one process.
fn file_of(folder: &Path, id: &str, ending: &str) -> PathBuf {
    folder.join(format!("{id}.{ending}"))
}
