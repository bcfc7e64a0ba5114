//! Writes 200 random pattern files, 30 damaged ones and the table of what they draft to, for the
//! test that later versions of the program draft the same.
//!
//! `cargo run -p toile-interchange --example record_drafts`

#[path = "../../tests/draft_table/mod.rs"]
mod draft_table;
#[path = "../../tests/random_pattern/mod.rs"]
mod random_pattern;
mod sound;

use draft_table::draft_table;
use random_pattern::{Dice, random_pattern};
use std::fs;
use std::path::Path;
use toile_interchange::{read_pattern, write_pattern};

const SHIPPED: [&str; 4] = ["gathered-skirt", "poncho", "t-shirt", "trousers"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drafts");
    let mut table = String::new();
    let mut put = |name: &str, text: &str| {
        table.push_str(&format!("file {name}\n{}", draft_table(text)));
    };
    let patterns = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    for name in SHIPPED {
        let text = fs::read_to_string(patterns.join(format!("{name}.toile.json")))?;
        fs::write(folder.join(format!("{name}.json")), &text)?;
        put(name, &text);
    }
    let (mut seed, mut count) = (0, 0);
    while count < 150 {
        seed += 1;
        let pattern = sound::sound_pattern(&mut Dice::new(seed));
        let text = write_pattern(&pattern)?;
        let said = draft_table(&text);
        if said.lines().any(|line| line.starts_with("error")) {
            continue;
        }
        fs::write(folder.join(format!("sound-{count:03}.json")), &text)?;
        put(&format!("sound-{count:03}"), &text);
        count += 1;
    }
    count = 0;
    while count < 50 {
        seed += 1;
        let Ok(text) = write_pattern(&random_pattern(&mut Dice::new(seed))) else {
            continue;
        };
        let said = draft_table(&text);
        let errors = said.lines().filter(|l| l.starts_with("error")).count();
        if errors == 0 || text.len() > 2800 || read_pattern(&text)?.0.panels.is_empty() {
            continue;
        }
        fs::write(folder.join(format!("unsound-{count:02}.json")), &text)?;
        put(&format!("unsound-{count:02}"), &text);
        count += 1;
    }
    count = 0;
    while count < 30 {
        seed += 1;
        let mut dice = Dice::new(seed);
        let text = fs::read_to_string(folder.join(format!("sound-{:03}.json", count * 5)))?;
        let text = sound::damaged(&text, &mut dice);
        if read_pattern(&text).is_ok() {
            continue;
        }
        fs::write(folder.join(format!("damaged-{count:02}.json")), &text)?;
        put(&format!("damaged-{count:02}"), &text);
        count += 1;
    }
    fs::write(folder.join("table.txt"), &table)?;
    Ok(())
}
