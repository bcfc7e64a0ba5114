//! Random changes and events on documents.

use toile_tests::damaged::FILES;
use toile_tests::events::EVENTS;
use toile_tests::losses::CHANGES;

/// Random deletions and changes of count, a thousand or as many as are asked.
pub fn losses(arguments: &[String]) -> Result<(), String> {
    runs(arguments, (1000, CHANGES), toile_tests::losses::losses)
}

/// Random events on the window's tools, a hundred thousand or as many as are asked.
pub fn events(arguments: &[String]) -> Result<(), String> {
    runs(arguments, (100_000, EVENTS), toile_tests::events::events)
}

/// Damaged pattern files of every format, a hundred thousand or as many as are asked, each read within its time.
pub fn damaged(arguments: &[String]) -> Result<(), String> {
    runs(arguments, (100_000, FILES), |seed, _| {
        toile_tests::damaged::damaged(seed, true)
    })
}

/// Runs of so many changes each, by one seed after another, until there were as many changes as
/// are asked or usual.
fn runs(
    arguments: &[String],
    (usual, each): (usize, usize),
    run: fn(u64, &std::path::Path) -> Result<(), String>,
) -> Result<(), String> {
    let count = match arguments {
        [] => usual,
        [count] => count.parse().map_err(|_| format!("{count}: no number"))?,
        _ => return Err("one number at the most".to_owned()),
    };
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let runs = count.div_ceil(each) as u64;
    let failed: Vec<String> = (0..runs)
        .filter_map(|seed| run(seed, folder.path()).err())
        .collect();
    println!(
        "{} changes, {} of {runs} runs failed",
        runs * each as u64,
        failed.len()
    );
    match failed.is_empty() {
        true => Ok(()),
        false => Err(failed.join("\n")),
    }
}
