//! Areas and stitches of real patterns, through the session's own reader.

use std::path::PathBuf;
use toile_session::{Command, Session, Silent};

fn shared() -> Option<PathBuf> {
    let given = std::env::var_os("TOILE_SHARED").map(PathBuf::from);
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let found = here.ancestors().map(|folder| folder.join("shared/data"));
    given
        .into_iter()
        .chain(found)
        .find(|folder| folder.is_dir())
}

#[test]
fn garmentcode_samples_have_their_areas_and_stitches() {
    let Some(data) = shared() else {
        println!("skipped: no shared data");
        return;
    };
    for (file, area, stitches, kinks) in [
        ("shirt_mean_specification.json", 6396.2, 18, 12),
        ("hoody_mean_specification.json", 5936.0, 12, 10),
    ] {
        let path = data.join("garmentcode").join(file);
        let mut session = Session::new();
        session.execute(Command::open(path), &mut Silent).unwrap();
        let draft = session.draft();
        let pieces: f64 = draft
            .pieces
            .iter()
            .map(|piece| {
                let twice: f64 = piece.outline.iter().map(|e| e.curve.swept_area()).sum();
                0.5e4 * twice.abs()
            })
            .sum();
        assert!((pieces - area).abs() < 0.1, "{file}: {pieces} cm2");
        assert_eq!(draft.seams.len(), stitches, "{file}");
        // Lines that turn across their seams are drawn so there.
        let found = session.diagnostics();
        let is_kink = |found: &toile_pattern::Diagnostic| found.code == toile_pattern::Code::Kink;
        assert!(found.iter().all(is_kink), "{file}: {found:?}");
        assert_eq!(found.len(), kinks, "{file}");
    }
}
