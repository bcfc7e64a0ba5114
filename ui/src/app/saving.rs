//! Saves the pattern: to its own file, or as another program reads it.

use super::ToileApp;
use super::dialogs::Dialog;
use super::notice::Notice;
use super::save_choice::SaveTarget;
use std::path::PathBuf;
use toile_session::{Command, Format};

impl ToileApp {
    /// Saves to a file; the existing file of another document is replaced only if `replaces` is set.
    pub(super) fn save_to(&mut self, mut target: SaveTarget, replaces: bool) {
        let name = target.path.to_string_lossy().to_lowercase();
        let ending = match &target.foreign {
            Some(options) => options.format.map_or("", Format::ending),
            // A native file may end in .json alone.
            None if name.ends_with(".json") => "",
            None => Format::Native.ending(),
        };
        if !name.ends_with(ending) {
            target.path = PathBuf::from(format!("{}{ending}", target.path.display()));
        }
        let own = self.session.project().source.as_ref() == Some(&target.path);
        if target.foreign.is_some() && own {
            let words = "the pattern was read from this file; give the new one another name";
            self.notice = Notice::fault(format!("{}: {words}", target.path.display()));
            self.ask_save();
            return;
        }
        if !own && !replaces && target.path.exists() {
            self.dialog = Some(Dialog::Replace(target));
            return;
        }
        self.dialog = None;
        let SaveTarget { path, foreign } = target;
        match foreign {
            None => {
                self.execute(Command::SavePattern { path });
                self.keep_drape_view();
            }
            Some(options) => {
                let told = format!("Wrote {}", path.display());
                if self.execute(Command::WritePattern { path, options }) {
                    self.notice = Notice::news(told);
                }
            }
        }
    }
}
