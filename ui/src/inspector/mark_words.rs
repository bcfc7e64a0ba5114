//! Places on an edge in words: distances from a corner, or from the centre.

use crate::tools::{corner_words, is_on_fold, number, scaled};
use toile_pattern::plan::NumberEntry;
use toile_pattern::{EditError, Evaluation, Mark, Name, Number, Panel, PartId, Pattern, Want};

/// Label of the field of a number: for a distance along an edge it names the corner from which the distance
/// counts.
pub fn label(evaluation: &Evaluation, entry: &NumberEntry) -> String {
    let pattern = evaluation.pattern();
    let usual = || entry.label.to_owned();
    let found = mark_at(pattern, entry);
    let from = found.and_then(|(panel, mark)| from(pattern, panel, mark));
    let Some(k) = entry
        .item
        .filter(|_| matches!(entry.place.part, PartId::Operation(_)))
    else {
        return from.unwrap_or_else(usual);
    };
    let what = match entry.place.path.starts_with("pleat") {
        true => "pleat",
        false => "cut",
    };
    let number = k + 1;
    let edge = found.and_then(|(panel, mark)| edge_along(evaluation, panel, mark));
    match (entry.label, &entry.mark, edge, from) {
        (_, Some(Mark::Along { .. }), Some(edge), Some(from)) => {
            format!("{what} {number} on {edge} {from}")
        }
        (_, Some(Mark::Along { .. }), ..) | ("cut from", ..) => format!("{what} {number} at"),
        ("cut to", ..) => format!("{what} {number}, other edge"),
        ("opening at start", ..) => format!("{what} {number} opens"),
        ("opening at end", ..) => format!("{what} {number} opens, other edge"),
        _ => usual(),
    }
}

/// A number as displayed. A distance that is stored as negative, because it counts from the end of an edge
/// backwards, is shown without the minus sign.
pub fn shown(evaluation: &Evaluation, entry: NumberEntry) -> NumberEntry {
    let leads_back = leads_back(evaluation, &entry);
    let turned = |number: &Number| scaled(evaluation, number, -1.0).ok();
    match entry
        .number
        .as_ref()
        .filter(|_| leads_back)
        .and_then(turned)
    {
        Some(number) => NumberEntry {
            number: Some(number),
            ..entry
        },
        None => entry,
    }
}

/// Converts a displayed number to the stored one.
///
/// # Errors
/// The formula would be too long.
pub fn kept(
    evaluation: &Evaluation,
    entry: &NumberEntry,
    number: Number,
) -> Result<Number, EditError> {
    match leads_back(evaluation, entry) {
        true => scaled(evaluation, &number, -1.0),
        false => Ok(number),
    }
}

/// Whether a number is a distance that counts from the end of an edge backwards; such a distance is stored
/// as negative.
fn leads_back(evaluation: &Evaluation, entry: &NumberEntry) -> bool {
    let is_back = |(_, mark): (&Panel, &Mark)| {
        let Mark::Along { distance, .. } = mark else {
            return false;
        };
        evaluation
            .number(distance, Want::Length)
            // The sign distinguishes -0 too.
            .is_some_and(f64::is_sign_negative)
    };
    mark_at(evaluation.pattern(), entry).is_some_and(is_back)
}

/// Name of the edge that a mark lies on at a distance from a corner.
fn edge_along(evaluation: &Evaluation, panel: &Panel, mark: &Mark) -> Option<String> {
    let Mark::Along { from, distance } = mark else {
        return None;
    };
    let back = evaluation
        .number(distance, Want::Length)?
        .is_sign_negative();
    let starts = |ends: [toile_pattern::PointId; 2]| Name::Drawn(ends[usize::from(back)]) == *from;
    let edge = panel.edges().find(|edge| starts(edge.ends))?;
    Some(edge.name.clone())
}

/// For a place that is stored as a share of an edge: its distance along the edge, in words.
pub fn distance(evaluation: &Evaluation, entry: &NumberEntry) -> Option<String> {
    let pattern = evaluation.pattern();
    let (panel, mark) = mark_at(pattern, entry)?;
    let Mark::Between { ends, share } = mark else {
        return None;
    };
    let share = evaluation.number(share, Want::Plain)?;
    let [Name::Drawn(start), Name::Drawn(end)] = *ends else {
        return None;
    };
    let edge = panel.edges().find(|edge| edge.ends == [start, end])?;
    let length = evaluation.edge(edge.id)?.length();
    // From the nearer corner, or from the centre.
    let centre = ends.iter().position(|end| is_on_fold(panel, *end));
    let from = centre.unwrap_or(usize::from(share > 0.5));
    let along = match from {
        0 => share * length,
        _ => (1.0 - share) * length,
    };
    let along = number::show(along, Want::Length, pattern.unit);
    Some(format!(
        "{along} from {}",
        corner_words(pattern, panel, ends[from])?
    ))
}

/// The place on an edge (mark) that a number belongs to, and the panel of that place: where a notch, a dart's
/// mouth, a cut or a pleat is.
fn mark_at<'p>(pattern: &'p Pattern, entry: &'p NumberEntry) -> Option<(&'p Panel, &'p Mark)> {
    let owns = |panel: &Panel| match entry.place.part {
        PartId::Notch(id) => panel.notch(id).is_some(),
        // Held points, and both ends of a fold, have labels of their own.
        PartId::Operation(id) if !matches!(entry.label, "held at" | "start" | "end") => {
            panel.step_of(id).is_some()
        }
        _ => false,
    };
    let panel = pattern.panels.iter().find(|panel| owns(panel))?;
    Some((panel, entry.mark.as_ref()?))
}

/// The corner that a stored distance counts from, in words.
fn from(pattern: &Pattern, panel: &Panel, mark: &Mark) -> Option<String> {
    match mark {
        Mark::Along { from, .. } => Some(format!("from {}", corner_words(pattern, panel, *from)?)),
        Mark::Notch(_) | Mark::Between { .. } | Mark::Corner(_) => None,
    }
}
