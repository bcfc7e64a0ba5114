//! Documents that counted ways of drafting begin and end with, in `ui/tests/counted`. A test compares
//! them byte by byte with what the window would save.
//!
//! Where the program deliberately changes what it writes, record them anew and read what changed:
//! `TOILE_RECORD=1 cargo test -p toile-ui -- drafting:: bodice::`, then `git diff`.

use super::Drafter;
use std::path::PathBuf;
use toile_session::{Command, Silent};
use toile_ui::Beginning;

fn file(way: &str, end: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/counted");
    folder.join(format!("{way}.{end}.toile.json"))
}

impl Drafter {
    /// A window with the document that a way begins with.
    pub fn at_start_of(way: &str) -> Self {
        let drafter = Self::begun(Beginning {
            file: Some(file(way, "start")),
            folder: None,
        });
        drafter.starts(way);
        drafter
    }

    /// The document is the one that a way begins with.
    pub fn starts(&self, way: &str) {
        self.is_recorded(way, "start");
    }

    /// The document is the one that a way ends with.
    pub fn ends(&self, way: &str) {
        self.is_recorded(way, "end");
    }

    fn is_recorded(&self, way: &str, end: &str) {
        let file = file(way, end);
        let saved = self.saved();
        if std::env::var_os("TOILE_RECORD").is_some() {
            std::fs::write(&file, &saved).unwrap();
        }
        let recorded = std::fs::read_to_string(&file)
            .unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let lines = saved.lines().zip(recorded.lines()).enumerate();
        let differs = lines.into_iter().find(|(_, (now, then))| now != then);
        assert!(
            saved == recorded,
            "{} is not what the window would save, first: {differs:?}",
            file.display()
        );
    }

    /// What the window would write to a file.
    pub fn saved(&self) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("saved.toile.json");
        let mut session = self.window.state().session().snapshot();
        let save = Command::SavePattern { path: path.clone() };
        session.execute(save, &mut Silent).unwrap();
        std::fs::read_to_string(path).unwrap()
    }
}
