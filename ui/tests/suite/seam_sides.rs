//! The seam tool and the sides of the cloth: it sews the copy that lies right side to right side, and says
//! while the second side is pointed at which piece would be turned inside out.

use crate::drafter::Drafter;
use egui::Key;
use std::path::Path;
use toile_ui::Beginning;

/// The newcomer's skirt without its seams; its back cut as `cut` says.
fn skirt(cut: &str, folder: &Path) -> Drafter {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/cases/pair-sewn-inside-out/skirt.toile.json");
    let text = std::fs::read_to_string(path).unwrap();
    let (before, after) = (
        text.find("\"seams\"").unwrap(),
        text.find("\"next_id\"").unwrap(),
    );
    let text = format!("{}{}", &text[..before], &text[after..]);
    let text = text.replace("\"cut\": \"pair\",", cut);
    let file = folder.join("skirt.toile.json");
    std::fs::write(&file, text).unwrap();
    Drafter::begun(Beginning {
        file: Some(file),
        folder: None,
    })
}

/// Takes the seam tool and gives it the chain of hem and side of the front, and the hem of the back.
fn begin_seam(drafter: &mut Drafter) {
    drafter.key(Key::Home);
    drafter.key(Key::S);
    drafter.shift_click(drafter.part("Edge hem of front"));
    drafter.click(drafter.part("Edge side of front"));
    drafter.shift_click(drafter.part("Edge hem of back"));
}

#[test]
fn a_chain_is_sewn_to_the_copy_that_lies_right_side_to_right_side() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = skirt("\"cut\": \"pair\",", folder.path());
    begin_seam(&mut drafter);
    let side = drafter.part("Edge side of back");
    drafter.hover(side);
    assert!(
        !drafter.status().contains("right side"),
        "{}",
        drafter.status()
    );
    drafter.click(side);
    let pattern = drafter.pattern();
    assert_eq!(pattern.seams.len(), 2, "{}", drafter.status());
    for seam in &pattern.seams {
        let [front, back] = [0, 1].map(|side| &seam.sides[side][0]);
        assert_ne!(u32::from(front.half), back.copy);
    }
    assert_eq!(drafter.evaluation().check_sides(), []);
}

#[test]
fn a_piece_that_would_be_turned_is_named_while_the_second_side_is_pointed_at() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = skirt("", folder.path());
    begin_seam(&mut drafter);
    let side = drafter.part("Edge side of back");
    drafter.hover(side);
    let said = drafter.status();
    assert!(said.contains("piece \"back\" is sewn inside out"), "{said}");
    // Nothing was sewn but for show: Escape takes back the answers one by one, and what is shown with them.
    for _ in 0..4 {
        drafter.key(Key::Escape);
    }
    assert_eq!(drafter.pattern().seams.len(), 0);
}
