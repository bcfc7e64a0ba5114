//! Random deletions and changes of count: a hundred here, a thousand in `soak losses`.

use toile_tests::losses::{CHANGES, losses};

#[test]
fn what_is_deleted_at_random_suspends_what_needs_it_and_returns_with_undo() {
    let folder = tempfile::tempdir().unwrap();
    let runs = 100 / CHANGES as u64;
    let failed: Vec<String> = (0..runs)
        .filter_map(|seed| losses(seed, folder.path()).err())
        .collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn a_variable_that_several_numbers_of_one_step_name_is_missed_once() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(losses(79, folder.path()), Ok(()));
}
