//! The tables of formats in `docs/FORMATS.md` say what the program does.

use std::path::Path;
use toile_interchange::format_tables;

/// The lines that stand before and after the tables.
const MARKS: [&str; 2] = ["<!-- formats -->\n", "<!-- /formats -->\n"];

#[test]
fn the_page_of_formats_has_the_tables_of_the_program() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/FORMATS.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let [begin, end] = MARKS.map(|mark| page.find(mark).unwrap());
    let begin = begin + MARKS[0].len();
    let now = format_tables();
    if std::env::var_os("TOILE_RECORD").is_some() {
        std::fs::write(path, format!("{}{now}{}", &page[..begin], &page[end..])).unwrap();
        return;
    }
    assert!(
        page[begin..end] == now,
        "docs/FORMATS.md: TOILE_RECORD=1 writes:\n{now}"
    );
}
