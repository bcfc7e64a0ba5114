//! What is wrong between the circles found and those known.

use crate::imports::Circle;
use crate::known::Known;
use std::collections::BTreeMap;

/// Where the known circles stand.
const LIST: &str = "tests/tests/circles/known.rs";

/// One text for each circle that is new or has grown, and for each that is known but has gone or
/// become smaller; each says what to do.
pub fn complaints(found: &BTreeMap<&str, Vec<Circle>>, known: &[Known]) -> Vec<String> {
    let mut texts = Vec::new();
    for (folder, circles) in found {
        let listed = listed_for(folder, known);
        let fresh = circles.iter().filter(|circle| !has(&listed, circle));
        texts.extend(fresh.map(|circle| of_found(folder, circle, &listed)));
    }
    for (folder, listed) in known {
        let circles = found.get(folder).map_or(&[][..], Vec::as_slice);
        // One that has grown is told of above: first it must lose what joined.
        let done = |files: &&&[&str]| {
            let same = |circle: &Circle| circle.files == **files;
            let grown = |circle: &Circle| shares(circle, files) && !is_part(circle, files);
            !circles.iter().any(|circle| same(circle) || grown(circle))
        };
        let done = listed.iter().filter(done);
        texts.extend(done.map(|files| of_listed(folder, files, circles)));
    }
    texts
}

fn listed_for(folder: &str, known: &[Known]) -> Vec<&'static [&'static str]> {
    let of_folder = known.iter().filter(|(name, _)| *name == folder);
    of_folder
        .flat_map(|(_, listed)| listed.iter().copied())
        .collect()
}

fn has(listed: &[&[&str]], circle: &Circle) -> bool {
    listed.iter().any(|files| circle.files == *files)
}

/// Whether all files of a circle are in a listed one.
fn is_part(circle: &Circle, listed: &[&str]) -> bool {
    circle
        .files
        .iter()
        .all(|file| listed.contains(&file.as_str()))
}

/// Whether any file of a circle is in a listed one.
fn shares(circle: &Circle, listed: &[&str]) -> bool {
    circle
        .files
        .iter()
        .any(|file| listed.contains(&file.as_str()))
}

/// What to say of a circle that is not listed.
fn of_found(folder: &str, circle: &Circle, listed: &[&[&str]]) -> String {
    let files = circle.files.join(", ");
    let ties = circle.ties.join("\n    ");
    if listed.iter().any(|listed| is_part(circle, listed)) {
        return format!(
            "{folder}: of a circle listed in {LIST} this much is left: {files}. List it instead \
             (the entry is below), or open it too; it is tied by\n    {ties}\n{}",
            entry(&circle.files)
        );
    }
    let joined: Vec<&str> = match listed.iter().find(|listed| shares(circle, listed)) {
        Some(listed) => {
            let fresh = circle.files.iter().map(String::as_str);
            fresh.filter(|file| !listed.contains(file)).collect()
        }
        None => Vec::new(),
    };
    let how = match joined.is_empty() {
        true => "these files import each other in a circle".to_owned(),
        false => format!(
            "a circle has grown by {} (a file that only has a new name is renamed in {LIST})",
            joined.join(", ")
        ),
    };
    format!(
        "{folder}: {how}: {files}. Take back the import that closes it: move what both sides need \
         into a file that imports neither, or pass it as an argument. Do not list it. \
         It is tied by\n    {ties}"
    )
}

/// What to say of a listed circle that is open or smaller.
fn of_listed(folder: &str, listed: &[&str], found: &[Circle]) -> String {
    let files = listed.join(", ");
    let what = match found.iter().any(|circle| is_part(circle, listed)) {
        true => "is smaller now",
        false => "is open now",
    };
    format!("{folder}: this circle {what}; delete its entry in {LIST}: {files}")
}

/// A circle as it is written in the list.
fn entry(files: &[String]) -> String {
    format!("    &{files:?},")
}
