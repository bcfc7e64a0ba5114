//! Where something is on an edge, in words: so far from a corner, or from the centre.

use crate::tools::number;
use toile_pattern::plan::{MarkNumber, NumberAddress, NumberEntry, OperationNumber, SpanEnd};
use toile_pattern::{
    CornerName, Evaluation, Mark, Name, Operation, OperationKind, Panel, Pattern, Want,
};

/// What a number is called beside its field.
pub fn label(pattern: &Pattern, entry: &NumberEntry) -> String {
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

/// How far along its edge a place is that is given as a part of it.
pub fn distance(evaluation: &Evaluation, entry: &NumberEntry) -> Option<String> {
    let pattern = evaluation.pattern();
    let (panel, mark) = match entry.place {
        NumberAddress::Operation(panel, step, number) => {
            let panel = pattern.panel(panel)?;
            (panel, mark_of(pattern.operation_of(panel, step)?, number)?)
        }
        NumberAddress::Notch(panel, notch, _) => {
            let panel = pattern.panel(panel)?;
            (panel, &panel.notches.iter().find(|own| own.id == notch)?.at)
        }
        _ => return None,
    };
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
        corner(pattern, panel, ends[from])?
    ))
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
        Some(Mark::Along { from, .. }) => Some(format!("from {}", corner(pattern, panel, *from)?)),
        _ => None,
    }
}

/// What a corner is called.
fn corner(pattern: &Pattern, panel: &Panel, name: CornerName) -> Option<String> {
    if is_on_fold(panel, name) {
        return Some("the centre".to_owned());
    }
    match name {
        Name::Drawn(id) => Some(pattern.point(id)?.1.name.clone()),
        Name::Made { .. } => None,
    }
}

/// Whether a corner is an end of the panel's fold, which is its centre.
fn is_on_fold(panel: &Panel, name: CornerName) -> bool {
    panel.operations.iter().any(|step| match &step.kind {
        OperationKind::Fold { ends, .. } => ends.contains(&Mark::Corner(name)),
        _ => false,
    })
}
