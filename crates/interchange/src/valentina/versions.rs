//! Versions of the files, and what depends on them.

use super::build::Build;
use roxmltree::Node;

/// The newest known version of Valentina's patterns.
const NEWEST_OF_VALENTINA: [u32; 3] = [1, 2, 1];
/// The newest known version of Seamly2D's patterns.
const NEWEST_OF_SEAMLY: [u32; 3] = [0, 7, 1];
/// Version of Valentina's patterns from which a negative length on a spline counts from its end.
const LENGTHS_FROM_ENDS: [u32; 3] = [1, 0, 0];

/// Reads the version of a pattern: a newer one than is known is read all the same, and said.
pub(super) fn read(build: &mut Build, root: Node<'_, '_>) {
    let mut children = root.children();
    let node = children.find(|node| node.has_tag_name("version"));
    let Some(text) = node.and_then(|node| node.text()).map(str::trim) else {
        return;
    };
    let Some(version) = version(text) else {
        let note = format!("the version {text:?} of the file is no version of patterns");
        build.notes.push(note);
        return;
    };
    let is_of_seamly = root.descendants().any(|node| {
        let tag = node.tag_name().name();
        matches!(tag, "draftBlock" | "pieces")
    });
    let (program, newest) = match is_of_seamly {
        true => ("Seamly2D", NEWEST_OF_SEAMLY),
        false => ("Valentina", NEWEST_OF_VALENTINA),
    };
    build.from_ends = !is_of_seamly && version >= LENGTHS_FROM_ENDS;
    if version > newest {
        let newest = newest.map(|part| part.to_string()).join(".");
        build.notes.push(format!(
            "the file is of version {text} of {program}'s patterns, newer than {newest}, the newest that is known: \
             what is new in it is among the losses; save it for an older version to be sure"
        ));
    }
}

/// The three numbers of a version.
fn version(text: &str) -> Option<[u32; 3]> {
    let parts: Option<Vec<u32>> = text
        .split('.')
        .map(|part| part.trim().parse().ok())
        .collect();
    <[u32; 3]>::try_from(parts?).ok()
}
