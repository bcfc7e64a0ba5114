//! Messages about the sides that pieces show.

use super::exchange::Twin;
use crate::{Code, Diagnostic, Draft, Place};
use std::collections::BTreeSet;

/// Message that lists the seams which take another copy or half of a panel than the document gives.
pub(crate) fn exchange_words<'n>(
    twin: Twin,
    panel: &str,
    seams: impl Iterator<Item = &'n str>,
) -> String {
    let names: Vec<String> = seams.map(|name| format!("{name:?}")).collect();
    let take = if names.len() == 1 { "takes" } else { "take" };
    let other = match twin {
        Twin::Copy => "copy",
        Twin::Half => "half",
    };
    format!(
        "{} {take} the other {other} of panel {panel:?} than is written: so every piece shows its \
         right side",
        seams_named(&names)
    )
}

/// Diagnostic for a piece that shows its wrong side because of these seams.
pub(super) fn turned_words(draft: &Draft, piece: usize, seams: BTreeSet<usize>) -> Diagnostic {
    let found = &draft.pieces[piece];
    Diagnostic::warning(
        Code::InsideOut,
        Place::Panel(found.id.panel),
        format!(
            "piece {:?} is sewn inside out: by {} it shows its wrong side where the others show \
             their right side",
            found.name,
            seams_of(draft, seams)
        ),
        "sew its other copy or half there, or walk one side of the seam from its other end; where \
         that is meant, say that right sides do not lie together",
    )
}

/// Diagnostic for a ring of pieces that cannot all show their right side.
pub(super) fn ring_words(
    draft: &Draft,
    pieces: &BTreeSet<usize>,
    seams: BTreeSet<usize>,
) -> Diagnostic {
    let quoted = |&k: &usize| format!("{:?}", draft.pieces[k].name);
    let names: Vec<String> = pieces.iter().map(quoted).collect();
    let who = match &names[..] {
        [one] => format!("piece {one} is sewn to itself with a half turn"),
        _ => format!(
            "pieces {} are sewn to a ring with a half turn",
            listed(&names)
        ),
    };
    let first = pieces.iter().next().map(|&k| draft.pieces[k].id.panel);
    Diagnostic::error(
        Code::InsideOut,
        first.map_or(Place::Pattern, Place::Panel),
        format!(
            "{who} by {}: sewn so, it has no right side, and some cloth is inside out",
            seams_of(draft, seams)
        ),
        "sew the other copy or half of a piece in one of them, or walk one side of it from its other \
         end",
    )
}

fn seams_of(draft: &Draft, seams: BTreeSet<usize>) -> String {
    let quoted = |k: usize| format!("{:?}", draft.seams[k].name);
    seams_named(&seams.into_iter().map(quoted).collect::<Vec<_>>())
}

fn seams_named(names: &[String]) -> String {
    let word = if names.len() == 1 { "seam" } else { "seams" };
    format!("{word} {}", listed(names))
}

/// A list of names in words, with "and" before the last name.
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
