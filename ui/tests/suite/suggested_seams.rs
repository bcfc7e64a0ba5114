//! Seams suggested in the window: candidates shown one after another, accepted by a key, undone exactly.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use std::path::Path;
use toile_ui::Beginning;

/// The T-shirt that ships, without its seams.
fn bare(folder: &Path) -> Drafter {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json");
    let text = std::fs::read_to_string(path).unwrap();
    let mut shirt: serde_json::Value = serde_json::from_str(&text).unwrap();
    shirt["seams"] = serde_json::json!([]);
    let file = folder.join("bare.toile.json");
    std::fs::write(&file, shirt.to_string()).unwrap();
    Drafter::begun(Beginning {
        file: Some(file),
        folder: None,
    })
}

#[test]
fn three_suggested_seams_are_accepted_and_undone_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = bare(folder.path());
    drafter.key(Key::Home);
    let before = drafter.pattern();
    drafter.press("Suggested seams");
    let said = drafter.status();
    assert!(said.contains("Candidate 1 of"), "{said}");
    assert_eq!(drafter.pattern(), before);
    let mut counts = Vec::new();
    for _ in 0..3 {
        drafter.key(Key::Enter);
        counts.push(drafter.pattern().seams.len());
    }
    // Each acceptance is one step, and sews one seam or the two of both sides.
    assert_eq!(drafter.steps(), 3, "{}", drafter.status());
    assert!(
        counts[0] >= 1 && counts[1] > counts[0] && counts[2] > counts[1],
        "{counts:?}"
    );
    for _ in 0..3 {
        drafter.chord(Modifiers::COMMAND, Key::Z);
    }
    // The counter of ids alone goes on.
    assert!(drafter.pattern().says_the_same(&before));
}

#[test]
fn an_edge_shows_its_own_candidates_and_tab_goes_to_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = bare(folder.path());
    drafter.key(Key::Home);
    drafter.press("Suggested seams");
    drafter.click(drafter.part("Edge side of front"));
    let said = drafter.status();
    assert!(said.contains("Candidate 1 of"), "{said}");
    assert!(
        said.contains("front side (") && said.contains("back side ("),
        "{said}"
    );
    drafter.key(Key::Tab);
    let said = drafter.status();
    assert!(said.contains("Candidate 2 of"), "{said}");
    assert_eq!(drafter.pattern().seams.len(), 0);
    drafter.click(drafter.part("Edge side of front"));
    drafter.key(Key::Enter);
    let pattern = drafter.pattern();
    assert_eq!(pattern.seams.len(), 2, "{}", drafter.status());
    for seam in &pattern.seams {
        let panels = [0, 1].map(|side| pattern.panel(seam.sides[side][0].panel).unwrap());
        let mut names = panels.map(|panel| panel.name.as_str());
        names.sort_unstable();
        assert_eq!(names, ["back", "front"]);
    }
    // An edge that is sewn has no candidates.
    drafter.click(drafter.part("Edge side of front"));
    let said = drafter.status();
    assert!(said.contains("sewn already"), "{said}");
    drafter.key(Key::Enter);
    assert_eq!(drafter.pattern().seams.len(), 2);
}
