//! Damaged pattern files of every format: five thousand here beside those of each reader's own tests, more in
//! `soak damaged`.

use toile_tests::damaged::{FILES, damaged};

#[test]
fn damaged_files_of_every_format_are_read_or_refused_with_a_place_and_a_remedy() {
    let runs = 5_000 / FILES as u64;
    let failed: Vec<String> = (0..runs)
        .filter_map(|seed| damaged(seed, false).err())
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
