//! Stages of panels: as drawn, and after each operation.

use super::node::Node;
use super::numbers::Computation;
use super::panels::PanelEvaluation;
use crate::Want;
use crate::stage::{
    DartApex, DartError, DartMouth, FoldError, MAX_GROWTH, NotTrued, PlaceError, cut_dart,
    cut_diamond, true_darts, unfold, width_kept,
};
use crate::{
    Apex, Code, CornerName, Diagnostic, LineName, Mark, Operation, OperationKind, Panel, PanelId,
    Place, Severity, Stage,
};
use std::sync::Arc;

/// A stage of a panel. `None`: its outline or the stage before it cannot be computed.
pub(super) fn stage(c: &mut Computation<'_>, panel: &Panel, step: usize) -> Option<Arc<Stage>> {
    if step == 0 {
        return PanelEvaluation::new(c, panel).drawn().map(Arc::new);
    }
    let before = step.checked_sub(2).map(|k| panel.operations[k].id);
    let stage = c.stage(Node::Stage(panel.id, before)).cloned();
    let operation = &panel.operations[step - 1];
    let place = Place::Operation(panel.id, operation.id);
    let stage = c.reported(stage, &place, "")?;
    // An operation that cannot be done is skipped, with an error.
    let mut evaluated = PanelEvaluation::new(c, panel);
    let done = evaluated.done(&stage, (step, operation));
    let mut stage = done.map_or(stage, |mut done| {
        if !matches!(operation.kind, OperationKind::Split { .. }) {
            done.sides.clear();
        }
        if !keeps_outline(&operation.kind) {
            done.untrued.clear();
        }
        done.done.push(operation.id);
        if done.idle.contains(&operation.id) {
            evaluated.note_idle(operation, place);
        }
        Arc::new(done)
    });
    let notches = evaluated.notches(&stage, step);
    if !notches.is_empty() {
        Arc::make_mut(&mut stage).notches.extend(notches);
    }
    Some(stage)
}

/// Whether an operation leaves the outline as it is, apart from the mouth of a dart.
fn keeps_outline(kind: &OperationKind) -> bool {
    match kind {
        OperationKind::Dart { .. }
        | OperationKind::Diamond { .. }
        | OperationKind::Insert { .. } => true,
        OperationKind::Fold { .. }
        | OperationKind::Pivot { .. }
        | OperationKind::Spread { .. }
        | OperationKind::Split { .. }
        | OperationKind::Pleat { .. } => false,
    }
}

impl PanelEvaluation<'_, '_, '_> {
    /// Reports that an operation does not change its panel.
    fn note_idle(&mut self, operation: &Operation, place: Place) {
        let what = match &operation.kind {
            OperationKind::Pleat { .. } => "has no depth",
            OperationKind::Pivot { .. } => "moves a dart that has no width",
            OperationKind::Dart { .. }
            | OperationKind::Diamond { .. }
            | OperationKind::Fold { .. }
            | OperationKind::Spread { .. }
            | OperationKind::Split { .. }
            | OperationKind::Insert { .. } => "has no width",
        };
        let step = format!("{} {:?}", operation.kind.word(), operation.name);
        let message = format!("{step} {what} and leaves the panel as it was");
        self.c.diagnostics.push(Diagnostic::new(
            Severity::Note,
            Code::NoEffect,
            place,
            self.words(&message),
            "a size that needs none of it may have 0 here",
        ));
    }

    /// The stage after an operation. `None`: the operation cannot be done.
    fn done(&mut self, stage: &Stage, (step, operation): (usize, &Operation)) -> Option<Stage> {
        let place = Place::Operation(self.panel.id, operation.id);
        match &operation.kind {
            OperationKind::Dart { .. } => self.dart(stage, (step, operation), &place),
            OperationKind::Diamond {
                ends,
                widest,
                intake,
            } => {
                let what = self.words(&format!("dart {:?}", operation.name));
                let ends = ends.map(|end| {
                    let at = self.c.point_at(end);
                    self.c.reported(at, &place, &what)
                });
                let widest = self.c.number(widest, Want::Plain, &place, &what);
                let intake = self.c.number(intake, Want::Length, &place, &what);
                let ([Some(a), Some(b)], Some(widest), Some(intake)) = (ends, widest, intake)
                else {
                    return None;
                };
                let done = cut_diamond(stage, operation.id, [a, b], widest, intake);
                if done.is_none() {
                    self.error(
                        Code::DartTooWide,
                        place,
                        &format!(
                            "dart {:?} is narrower than nothing or has no length",
                            operation.name
                        ),
                        "give it a width of 0 or more, two ends that are apart, and a widest place from 0 to 1",
                    );
                }
                done
            }
            OperationKind::Fold { line, ends } => self.fold(stage, (step, *line), ends, &place),
            OperationKind::Pivot { .. } => self.pivot(stage, (step, operation), &place),
            OperationKind::Spread { .. } => self.spread(stage, (step, operation), &place),
            OperationKind::Split { line, curve } => self.split(stage, (operation, *line), *curve),
            OperationKind::Pleat { .. } => self.pleat(stage, (step, operation), &place),
            OperationKind::Insert { sheet } => self.insert(stage, (step, operation.id), *sheet),
        }
    }

    fn dart(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Option<Stage> {
        let OperationKind::Dart {
            line,
            mouth,
            intake,
            apex,
            pressed,
            trued,
            keeps_length,
        } = &operation.kind
        else {
            return None;
        };
        let what = self.words(&format!("dart {:?}", operation.name));
        let middle = self.first_spot((*line, mouth), step, (place, &what));
        let intake = self.c.number(intake, Want::Length, place, &what);
        let apex = match apex {
            Apex::Depth(depth) => {
                let depth = self.c.number(depth, Want::Length, place, &what);
                depth.map(DartApex::Depth)
            }
            Apex::Point(point) => {
                let at = self.c.point_at(*point);
                self.c.reported(at, place, &what).map(DartApex::Point)
            }
        };
        let (middle, intake, apex) = (middle?, intake?, apex?);
        let done = match middle {
            Ok(middle) => {
                let mut mouth = DartMouth {
                    by: operation.id,
                    line: *line,
                    middle,
                    intake,
                    apex,
                    pressed: *pressed,
                    trued: *trued,
                };
                if *keeps_length && *trued && intake > 0.0 {
                    mouth.intake = self.width_kept(stage, &mouth, (step, place, &what));
                }
                // Positions on the edge are measured on the edge as drawn, even if earlier darts of it are
                // trued.
                cut_dart(&stage.as_untrued(), &mouth)
            }
            Err(PlaceError::Beyond) => Err(DartError::TooWide),
            Err(error) => Err(DartError::Place(error)),
        };
        match done {
            Ok(stage) => return Some(self.trued(stage, (step, operation), place)),
            Err(DartError::Place(error)) => self.no_place(error, place, &what),
            Err(DartError::TooWide) => self.error(
                Code::DartTooWide,
                place.clone(),
                &format!(
                    "dart {:?} is {:.1} cm wide and does not fit on its edge",
                    operation.name,
                    intake * 100.0
                ),
                "give it a width of 0 or more that its edge has room for, or move it along the edge",
            ),
            Err(DartError::Overlaps) => self.error(
                Code::DartTooWide,
                place.clone(),
                "two darts of one edge overlap",
                "move them apart or make them narrower",
            ),
        }
        None
    }

    /// Corners at which an edge continues smoothly: into its mirror image at a later fold, or across a seam
    /// that ends there. Seams of this panel and of panels split off it count.
    fn going_on(&self, step: usize) -> Vec<CornerName> {
        let pattern = &self.c.evaluation.pattern;
        let later = self.panel.operations.iter().skip(step);
        let folds = later.filter_map(|later| Some(later.kind.fold_ends()?.each_ref()));
        let is_of_it = |id: PanelId| {
            let found = pattern.panel(id);
            found.is_some_and(|own| pattern.lineage(own).iter().any(|p| p.id == self.panel.id))
        };
        let spans = pattern.seams.iter().flat_map(|seam| seam.spans());
        let spans = spans.filter(|span| is_of_it(span.panel));
        let ends = folds.chain(spans.map(|span| [&span.from, &span.to]));
        ends.flatten()
            .filter_map(|end| match end {
                Mark::Corner(corner) => Some(*corner),
                Mark::Notch(_) | Mark::Along { .. } | Mark::Between { .. } => None,
            })
            .collect()
    }

    /// The stage with its darts trued where the document asks for it. Reports if the dart of this operation
    /// cannot be trued.
    pub(super) fn trued(
        &mut self,
        stage: Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Stage {
        let going_on = self.going_on(step);
        let (stage, refused) = true_darts(stage, &going_on);
        let own = refused.iter().find(|(by, _)| *by == operation.id);
        if let Some((_, why)) = own {
            let (why, hint) = match why {
                NotTrued::NoLine => (
                    "no smooth line leads across its mouth".to_owned(),
                    "move it along the edge, make it narrower, or do not true it",
                ),
                NotTrued::TooFar => (
                    format!(
                        "its point lies so near the edge that a leg would become over {MAX_GROWTH} times as long \
                         or as short"
                    ),
                    "make it deeper or narrower, or do not true it",
                ),
            };
            let what = format!(
                "{} {:?}: {why}, so it is not trued",
                operation.kind.word(),
                operation.name
            );
            self.c.diagnostics.push(Diagnostic::warning(
                Code::NotTrued,
                place.clone(),
                self.words(&what),
                hint,
            ));
        }
        stage
    }

    /// Width of a dart's mouth with which the finished edge keeps its length although the dart is trued (m).
    fn width_kept(
        &mut self,
        stage: &Stage,
        mouth: &DartMouth,
        (step, place, what): (usize, &Place, &str),
    ) -> f64 {
        let going_on = self.going_on(step);
        width_kept(stage, mouth, &going_on).unwrap_or_else(|| {
            self.c.diagnostics.push(Diagnostic::warning(
                Code::NotTrued,
                place.clone(),
                format!("{what}: no width of its mouth keeps the finished length"),
                "make it narrower, or do not keep the finished length",
            ));
            mouth.intake
        })
    }

    fn fold(
        &mut self,
        stage: &Stage,
        (step, line): (usize, LineName),
        ends: &[Mark; 2],
        place: &Place,
    ) -> Option<Stage> {
        let what = self.words("fold");
        let from = self.placed((line, &ends[0]), step, (place, &what))?;
        let to = self.placed((line, &ends[1]), step, (place, &what))?;
        match unfold(stage, line, [from, to]) {
            Ok((stage, lost)) => {
                for id in lost {
                    let notch = self.panel.notches.iter().find(|notch| notch.id == id);
                    let name = notch.map_or_else(|| id.to_string(), |n| format!("{:?}", n.name));
                    self.error(
                        Code::MissingReference,
                        Place::Notch(self.panel.id, id),
                        &format!("notch {name}: its edge is the fold"),
                        "put it on another edge of this panel",
                    );
                }
                Some(stage)
            }
            Err(FoldError::Place(error)) => {
                self.no_place(error, place, &what);
                None
            }
            Err(FoldError::NotStraight) => {
                self.error(
                    Code::BadFold,
                    place.clone(),
                    "the fold is not a straight edge with a length",
                    "choose a straight edge of the outline, or none",
                );
                None
            }
        }
    }
}
