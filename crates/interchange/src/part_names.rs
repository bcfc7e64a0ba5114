//! Names of other programs as names of parts here.

use std::collections::BTreeSet;
use toile_pattern::NAME_LENGTH;

/// A valid name for a part, different from all names taken.
pub(crate) fn part_name(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let clean: String = wanted
        .chars()
        .filter(|c| !c.is_control() && *c != '\'')
        .take(NAME_LENGTH - 8)
        .collect();
    let clean = clean.trim();
    let base = if clean.is_empty() { "unnamed" } else { clean };
    let mut name = base.to_owned();
    let mut count = 1;
    while !taken.insert(name.clone()) {
        count += 1;
        name = format!("{base} {count}");
    }
    name
}
