//! Seams: positions of their spans, and lengths of both sides after all operations.

use super::node::{Node, SeamValue, SpanValue};
use super::numbers::Computation;
use super::panels::has_made;
use crate::Want;
use crate::stage::{MarkValue, PlaceError, Stretch, is_sewn, reversed};
use crate::{Code, Diagnostic, Line, Mark, Name, Panel, Place, Seam, Span, Stage};
use std::sync::Arc;

/// The value of a seam. `None`: a span has no position.
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
    // Several spans may have the same fault: it is reported once.
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

/// Position of a span, and its length (m).
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
    if panel.is_split() {
        let message = format!(
            "seam {name:?} names panel {:?}, which is split and not cut itself",
            panel.name
        );
        missing(c, seam, (message, "sew the panels that are its sides"));
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
    let stretch = match stretch(c, (seam, span), (&panel, &finished), [from, to])? {
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
    let length = finished.stretch_length(span.half, &stretch);
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

/// The edges of a span between its two marks, after all operations; each mark is taken on the first stage
/// that has its corners. `None`: an operation that makes one of the corners failed, which that operation
/// reports.
fn stretch(
    c: &mut Computation<'_>,
    (seam, span): (&Seam, &Span),
    (panel, finished): (&Panel, &Stage),
    marks: [MarkValue; 2],
) -> Option<Result<Stretch, PlaceError>> {
    let evaluation = c.evaluation;
    let pattern = &evaluation.pattern;
    let lineage = pattern.stage_lineage(panel);
    let mut places = Vec::with_capacity(2);
    for (mark, value) in [&span.from, &span.to].into_iter().zip(marks) {
        let step = pattern.first_step(panel, &lineage, mark);
        let Some((of, after)) = step.and_then(|step| lineage.stage(step)) else {
            return Some(Err(PlaceError::NoLine));
        };
        let first = c.stage(Node::Stage(of, after)).cloned();
        let first = c.reported(first, &Place::Seam(seam.id), "")?;
        if !has_made(&first, (pattern, panel, &lineage), mark) {
            return None;
        }
        match finished.placed(&first, span.line, value) {
            Ok(place) => places.push(place),
            Err(error) => return Some(Err(error)),
        }
    }
    let ends = match span.backwards {
        true => [places[1], places[0]],
        false => [places[0], places[1]],
    };
    let found = finished.stretch(span.line, ends, is_sewn);
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
            let notch = panel.and_then(|panel| c.evaluation.pattern.notch_of(panel, *id));
            let notch = notch.cloned();
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
