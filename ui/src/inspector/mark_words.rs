//! Where something is on an edge, in words: so far from a corner, or from the centre.

use crate::tools::{corner_words, is_on_fold, number, scaled};
use toile_pattern::plan::{MarkNumber, NumberAddress, NumberEntry, OperationNumber, SpanEnd};
use toile_pattern::{
    EditError, Evaluation, Mark, Name, Number, Operation, OperationKind, Panel, Pattern, Want,
};

/// What a number is called beside its field.
pub fn label(evaluation: &Evaluation, entry: &NumberEntry) -> String {
    let pattern = evaluation.pattern();
    let usual = || entry.label.to_owned();
    match entry.place {
        NumberAddress::Operation(panel, step, number) => {
            let panel = pattern.panel(panel);
            let found = panel.and_then(|panel| Some((panel, pattern.operation_of(panel, step)?)));
            let Some((panel, step)) = found else {
                return usual();
            };
            let what = match step.kind {
                OperationKind::Pleat { .. } => "pleat",
                _ => "cut",
            };
            match number {
                OperationNumber::Cut(k, _, MarkNumber::Distance) => {
                    let along = edge_along(evaluation, panel, mark_of(step, number));
                    let from = from(pattern, panel, mark_of(step, number));
                    match (along, from) {
                        (Some(edge), Some(from)) => format!("{what} {} on {edge} {from}", k + 1),
                        _ => format!("{what} {} at", k + 1),
                    }
                }
                OperationNumber::Cut(k, SpanEnd::From, _) => format!("{what} {} at", k + 1),
                OperationNumber::Cut(k, SpanEnd::To, _) => {
                    format!("{what} {}, other edge", k + 1)
                }
                OperationNumber::Opening(k, SpanEnd::From) => format!("{what} {} opens", k + 1),
                OperationNumber::Opening(k, SpanEnd::To) => {
                    format!("{what} {} opens, other edge", k + 1)
                }
                OperationNumber::Mouth(MarkNumber::Distance) => {
                    from(pattern, panel, mark_of(step, number)).unwrap_or_else(usual)
                }
                _ => usual(),
            }
        }
        NumberAddress::Notch(panel, notch, MarkNumber::Distance) => {
            let panel = pattern.panel(panel);
            let found = panel.and_then(|panel| {
                let notch = panel.notches.iter().find(|own| own.id == notch)?;
                from(pattern, panel, Some(&notch.at))
            });
            found.unwrap_or_else(usual)
        }
        _ => usual(),
    }
}

/// A number as it is shown: a distance from the end of an edge without the sign that says that it leads back.
pub fn shown(evaluation: &Evaluation, entry: NumberEntry) -> NumberEntry {
    let leads_back = leads_back(evaluation, &entry.place);
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

/// A number as the document keeps it at a place, given as it is shown.
///
/// # Errors
/// A formula would be too long.
pub fn kept(
    evaluation: &Evaluation,
    place: &NumberAddress,
    number: Number,
) -> Result<Number, EditError> {
    match leads_back(evaluation, place) {
        true => scaled(evaluation, &number, -1.0),
        false => Ok(number),
    }
}

/// Whether a number is a distance along an edge from its end, against it.
fn leads_back(evaluation: &Evaluation, place: &NumberAddress) -> bool {
    let is_back = |(_, mark): (&Panel, &Mark)| {
        let Mark::Along { distance, .. } = mark else {
            return false;
        };
        evaluation
            .number(distance, Want::Length)
            // Of a distance of nothing the sign tells it, too.
            .is_some_and(f64::is_sign_negative)
    };
    mark_at(evaluation.pattern(), place).is_some_and(is_back)
}

/// The edge that a mark lies on, counted from one of its corners.
fn edge_along(evaluation: &Evaluation, panel: &Panel, mark: Option<&Mark>) -> Option<String> {
    let Some(Mark::Along { from, distance }) = mark else {
        return None;
    };
    let back = evaluation
        .number(distance, Want::Length)?
        .is_sign_negative();
    let starts = |ends: [toile_pattern::PointId; 2]| Name::Drawn(ends[usize::from(back)]) == *from;
    let edge = panel.edges().find(|edge| starts(edge.ends))?;
    Some(edge.name.clone())
}

/// How far along its edge a place is that is given as a part of it.
pub fn distance(evaluation: &Evaluation, entry: &NumberEntry) -> Option<String> {
    let pattern = evaluation.pattern();
    let (panel, mark) = mark_at(pattern, &entry.place)?;
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

/// The mark that a number is of, and its panel.
fn mark_at<'p>(pattern: &'p Pattern, place: &NumberAddress) -> Option<(&'p Panel, &'p Mark)> {
    match *place {
        NumberAddress::Operation(panel, step, number) => {
            let panel = pattern.panel(panel)?;
            Some((panel, mark_of(pattern.operation_of(panel, step)?, number)?))
        }
        NumberAddress::Notch(panel, notch, _) => {
            let panel = pattern.panel(panel)?;
            let notch = panel.notches.iter().find(|own| own.id == notch)?;
            Some((panel, &notch.at))
        }
        _ => None,
    }
}

fn mark_of(step: &Operation, number: OperationNumber) -> Option<&Mark> {
    match (number, &step.kind) {
        (
            OperationNumber::Mouth(_),
            OperationKind::Dart { mouth, .. } | OperationKind::Pivot { mouth, .. },
        ) => Some(mouth),
        (OperationNumber::Cut(k, end, _), OperationKind::Spread { cuts, .. }) => {
            Some(&cuts.get(k)?.ends[usize::from(end == SpanEnd::To)])
        }
        (OperationNumber::Cut(k, end, _), OperationKind::Pleat { pleats, .. }) => {
            Some(&pleats.get(k)?.ends[usize::from(end == SpanEnd::To)])
        }
        _ => None,
    }
}

/// From which corner a distance counts.
fn from(pattern: &Pattern, panel: &Panel, mark: Option<&Mark>) -> Option<String> {
    match mark {
        Some(Mark::Along { from, .. }) => {
            Some(format!("from {}", corner_words(pattern, panel, *from)?))
        }
        _ => None,
    }
}
