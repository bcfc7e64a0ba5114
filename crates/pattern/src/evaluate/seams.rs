//! Seams: where their spans lie, and how long both sides are when all operations are done.

use super::node::{Node, SeamValue, SpanValue};
use super::numbers::{Computation, Want};
use super::panels::has_made;
use crate::stage::{MarkValue, PlaceError, Placed, StageEdge, Stretch, reversed};
use crate::{Code, Diagnostic, Line, Mark, Name, Panel, Place, Role, Seam, Span, Stage};
use std::sync::Arc;

/// The value of a seam; nothing if a span has no place.
pub(super) fn seam(c: &mut Computation<'_>, seam: &Seam) -> Option<Arc<SeamValue>> {
    let place = Place::Seam(seam.id);
    let what = format!("seam {:?}, ease", seam.name);
    let ease = c
        .number(&seam.ease, Want::Length, &place, &what)
        .unwrap_or(0.0);
    let mut sides = [Vec::new(), Vec::new()];
    let mut lengths = [0.0; 2];
    let mut complete = true;
    for (side, spans) in seam.sides.iter().enumerate() {
        let mut whole = true;
        for span in spans {
            match locate(c, seam, span) {
                Some((found, length)) => {
                    lengths[side] += length;
                    sides[side].push(found);
                }
                None => whole = false,
            }
        }
        complete &= whole;
        if complete && sides[side].is_empty() {
            complete = false;
            c.diagnostics.push(Diagnostic::error(
                Code::MissingSpan,
                place.clone(),
                format!("seam {:?} has an empty side", seam.name),
                "name at least one edge on each side",
            ));
        }
    }
    // Several spans may lack the same thing, which is told once.
    let mut told: Vec<Diagnostic> = Vec::new();
    for found in std::mem::take(&mut c.diagnostics) {
        if !told.contains(&found) {
            told.push(found);
        }
    }
    c.diagnostics = told;
    complete.then(|| {
        Arc::new(SeamValue {
            ease,
            sides,
            lengths,
        })
    })
}

fn missing(c: &mut Computation<'_>, seam: &Seam, (message, hint): (String, &str)) {
    c.diagnostics.push(Diagnostic::error(
        Code::MissingSpan,
        Place::Seam(seam.id),
        message,
        hint,
    ));
}

/// Where a span lies, and its length [m].
fn locate(c: &mut Computation<'_>, seam: &Seam, span: &Span) -> Option<(SpanValue, f64)> {
    let name = &seam.name;
    let from = mark(c, seam, span, &span.from)?;
    let to = mark(c, seam, span, &span.to)?;
    let Some(panel) = c.evaluation.pattern.panel(span.panel).cloned() else {
        let message = format!("seam {name:?} names {}, which is not there", span.panel);
        missing(
            c,
            seam,
            (message, "name a panel of this pattern, or remove the seam"),
        );
        return None;
    };
    if span.copy >= panel.cut.quantity {
        let message = format!(
            "seam {name:?} names copy {} of panel {:?}, which is cut {} times",
            span.copy, panel.name, panel.cut.quantity
        );
        let hint = "cut the panel more often, or name another copy (they count from 0)";
        missing(c, seam, (message, hint));
        return None;
    }
    let internal = |line: &&Line| Name::Drawn(line.id) == span.line && !line.is_closed();
    if let Some(line) = panel.lines.iter().find(internal) {
        c.diagnostics.push(Diagnostic::error(
            Code::BadSpan,
            Place::Seam(seam.id),
            format!(
                "sewing to an internal line is not possible yet: seam {name:?} names line {:?} inside \
                 panel {:?}",
                line.name, panel.name
            ),
            "sew to an edge of its outline or of a hole",
        ));
        return None;
    }
    let last = panel.operations.last().map(|o| o.id);
    let finished = c.stage(Node::Stage(panel.id, last)).cloned();
    let finished = c.reported(finished, &Place::Seam(seam.id), "")?;
    if from == to && !matches!(from, MarkValue::Corner(_)) {
        c.diagnostics.push(bad_span(seam));
        return None;
    }
    let stretch = match stretch(c, (seam, span), &panel, [from, to])? {
        Ok(stretch) if !stretch.is_empty() => stretch,
        Err(PlaceError::Beyond) | Ok(_) => {
            c.diagnostics.push(bad_span(seam));
            return None;
        }
        Err(PlaceError::NoLine | PlaceError::NoCorner(_)) => {
            let message = format!(
                "seam {name:?} names a place of panel {:?} that is not there",
                panel.name
            );
            let hint = "name an edge of that panel, or remove the seam";
            missing(c, seam, (message, hint));
            return None;
        }
    };
    if usize::from(span.half) >= 1 << finished.folds.len().min(8) {
        let message = format!(
            "seam {name:?} names the other half of panel {:?}, which has no fold",
            panel.name
        );
        let hint = "put the panel on the fold, or name the half as drawn";
        missing(c, seam, (message, hint));
        return None;
    }
    let length = length(&finished, span.half, &stretch);
    if length <= 0.0 {
        let message = format!(
            "seam {name:?} names a place of panel {:?} on its fold or in the mouth of a dart",
            panel.name
        );
        let hint = "sew another edge, or leave the fold or the dart out";
        missing(c, seam, (message, hint));
        return None;
    }
    let value = SpanValue {
        panel: panel.id,
        copy: span.copy,
        half: span.half,
        stretch,
    };
    Some((value, length))
}

/// The edges of a span between its marks, each mark taken on the first stage that has its corners;
/// nothing if that stage has not what was to be made, which is told there.
fn stretch(
    c: &mut Computation<'_>,
    (seam, span): (&Seam, &Span),
    panel: &Panel,
    marks: [MarkValue; 2],
) -> Option<Result<Stretch, PlaceError>> {
    let steps = [&span.from, &span.to].map(|mark| panel.first_step(mark));
    let [Some(from), Some(to)] = steps else {
        return Some(Err(PlaceError::NoLine));
    };
    let mut stage_at = |step: usize| {
        let after = step.checked_sub(1).map(|k| panel.operations[k].id);
        let stage = c.stage(Node::Stage(panel.id, after)).cloned();
        c.reported(stage, &Place::Seam(seam.id), "")
    };
    let stage = stage_at(from.max(to))?;
    let mut places = marks.map(Placed::Mark);
    for ((place, step), mark) in places
        .iter_mut()
        .zip([from, to])
        .zip([&span.from, &span.to])
    {
        if !has_made(&stage, panel, mark) {
            return None;
        }
        if step < from.max(to)
            && let Placed::Mark(value @ (MarkValue::Along(..) | MarkValue::Between(..))) = *place
        {
            match stage_at(step)?.spot(span.line, value) {
                Ok(spot) => *place = Placed::Spot(spot),
                Err(error) => return Some(Err(error)),
            }
        }
    }
    if span.backwards {
        places.reverse();
    }
    // Legs are sewn by their dart; the other halves are named by spans of their own.
    let wanted = |edge: &StageEdge| {
        let is_leg = matches!(
            edge.name,
            Name::Made {
                role: Role::Leg,
                ..
            }
        );
        edge.half == 0 && !is_leg
    };
    let found = stage.stretch(span.line, places, wanted);
    Some(found.map(|stretch| match span.backwards {
        true => reversed(stretch),
        false => stretch,
    }))
}

fn bad_span(seam: &Seam) -> Diagnostic {
    Diagnostic::error(
        Code::BadSpan,
        Place::Seam(seam.id),
        format!(
            "seam {:?}: a span has no length or reaches beyond its line",
            seam.name
        ),
        "use two different places, shares from 0 to 1",
    )
}

fn mark(c: &mut Computation<'_>, seam: &Seam, span: &Span, mark: &Mark) -> Option<MarkValue> {
    let place = Place::Seam(seam.id);
    let what = format!("seam {:?}, span", seam.name);
    Some(match mark {
        Mark::Corner(corner) => MarkValue::Corner(*corner),
        Mark::Along { from, distance } => {
            MarkValue::Along(*from, c.number(distance, Want::Length, &place, &what)?)
        }
        Mark::Between { ends, share } => {
            MarkValue::Between(*ends, c.number(share, Want::Plain, &place, &what)?)
        }
        Mark::Notch(id) => {
            let panel = c.evaluation.pattern.panel(span.panel);
            let notch = panel.and_then(|panel| panel.notch(*id)).cloned();
            match notch {
                Some(notch) if !matches!(notch.at, Mark::Notch(_)) => {
                    self::mark(c, seam, span, &notch.at)?
                }
                _ => {
                    let message = format!("seam {:?} names {id}, which is not there", seam.name);
                    missing(
                        c,
                        seam,
                        (message, "name another place, or undo its removal"),
                    );
                    return None;
                }
            }
        }
    })
}

/// Length of a stretch on a stage [m].
fn length(stage: &Stage, half: u8, stretch: &Stretch) -> f64 {
    let parts = stretch.iter().map(|&(name, from, to)| {
        let (low, high) = (from.min(to), from.max(to));
        let edges = stage.lines.iter().flat_map(|line| &line.edges);
        let own = edges.filter(|edge| edge.name == name && edge.half == half);
        own.map(|edge| {
            let (a, b) = (edge.from.min(edge.to), edge.from.max(edge.to));
            let covered = (b.min(high) - a.max(low)).max(0.0);
            edge.curve.length() * covered / (b - a).max(1e-300)
        })
        .sum::<f64>()
    });
    parts.sum()
}
