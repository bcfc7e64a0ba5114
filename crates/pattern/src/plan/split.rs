//! Splits panels in two: the sides become panels of their own, which take over the seams.

use super::impossible;
use super::lookup::{self, after};
use super::names::free_name;
use super::on_stage::mark_value;
use super::operations::add_operation;
use crate::stage::is_sewn;
use crate::{
    CornerName, CurveId, Edit, EditError, Entity, Evaluation, Ids, LineName, Mark, Name, Operation,
    OperationId, OperationKind, Panel, PanelId, Place, Role, Seam, Severity, Side, Source, Span,
    Stage,
};
use std::sync::Arc;

/// Request to split a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitWish {
    /// The line on which the cut starts and ends.
    pub line: LineName,
    /// The curve of the cut, which starts and ends on the line.
    pub curve: CurveId,
    /// Whether both sides are sewn together again along the cut.
    pub joined: Joined,
}

/// Whether both sides of a split panel are sewn together again along the cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Joined {
    /// The sides are sewn by seams along the cut, one seam for each copy and half.
    #[default]
    Sewn,
    /// The sides are not sewn together.
    Apart,
}

/// Parts made by splitting a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitPanel {
    /// The split operation.
    pub operation: OperationId,
    /// The panels left and right of the curve.
    pub sides: [PanelId; 2],
}

/// Plans to split a panel. Its two sides become panels with its fabric, its number of copies and its folds;
/// seams of the panel then sew the sides.
///
/// # Errors
/// The panel is missing or cannot be drawn; it cannot be split like this, or a span of a seam would be
/// divided into more than two stretches (the message gives the reason).
pub fn split_panel(
    evaluation: &Evaluation,
    panel: PanelId,
    wish: SplitWish,
) -> Result<(Vec<Edit>, SplitPanel), EditError> {
    let SplitWish {
        line,
        curve,
        joined,
    } = wish;
    let kind = OperationKind::Split { line, curve };
    let (mut edits, operation) = add_operation(evaluation, panel, kind)?;
    let split = after(evaluation, &edits)?;
    let owner = lookup::panel(split.pattern(), panel)?.clone();
    let mut ids = split.pattern().ids;
    let sides = [("left", Side::Left), ("right", Side::Right)].map(|(word, side)| {
        let taken = |name: &str| {
            let mut panels = split.pattern().panels.iter();
            let mut sheets = split.pattern().sheets.iter();
            panels.any(|known| known.name == name) || sheets.any(|known| known.name == name)
        };
        Panel {
            id: ids.take(),
            name: free_name(&format!("{} {word}", owner.name), taken),
            source: Source::Side {
                of: panel,
                split: operation,
                side,
            },
            lines: Vec::new(),
            notches: Vec::new(),
            operations: Vec::new(),
            on_table: owner.on_table,
            ..(*owner).clone()
        }
    });
    let found = SplitPanel {
        operation,
        sides: [sides[0].id, sides[1].id],
    };
    let mut panels: Vec<Edit> = Vec::with_capacity(2);
    for side in sides {
        let folded = with_folds(&split, (&owner, operation), side, &mut ids)?;
        panels.push(Edit::Put(Entity::Panel(Arc::new(folded))));
    }
    edits.extend(panels);
    let whole = after(evaluation, &edits)?;
    let mover = Mover {
        evaluation: &whole,
        split: &found,
        panel: &owner,
    };
    for seam in &whole.pattern().seams {
        edits.extend(
            mover
                .seam(seam)?
                .map(|seam| Edit::Put(Entity::Seam(Arc::new(seam)))),
        );
    }
    if joined == Joined::Sewn {
        edits.extend(mover.joined(line, &mut ids));
    }
    Ok((edits, found))
}

fn cut_corner(by: OperationId, index: u16) -> CornerName {
    Name::Made {
        by,
        role: Role::Split,
        index,
    }
}

/// A side panel with the folds of the panel that is split. If the cut divides a fold, the side gets the
/// stretch of the fold that lies on it.
fn with_folds(
    split: &Evaluation,
    (owner, by): (&Panel, OperationId),
    mut side: Panel,
    ids: &mut Ids,
) -> Result<Panel, EditError> {
    for operation in &owner.operations {
        let OperationKind::Fold { line, ends: [a, b] } = &operation.kind else {
            continue;
        };
        let cut = |index: u16| Mark::Corner(cut_corner(by, index));
        let choices = [
            [a.clone(), b.clone()],
            [a.clone(), cut(0)],
            [a.clone(), cut(1)],
            [cut(0), b.clone()],
            [cut(1), b.clone()],
        ];
        let id = ids.take();
        for ends in choices {
            let mut tried = side.clone();
            tried.operations.push(Arc::new(Operation {
                meant: false,
                id,
                name: operation.name.clone(),
                kind: OperationKind::Fold { line: *line, ends },
            }));
            let after = after(split, &[Edit::Put(Entity::Panel(Arc::new(tried.clone())))])?;
            let place = Place::Operation(side.id, id);
            let is_fault =
                |d: &crate::Diagnostic| d.severity == Severity::Error && d.place == place;
            if !after.diagnostics().iter().any(is_fault) {
                side = tried;
                break;
            }
        }
    }
    Ok(side)
}

/// Transfers seams from a panel to its sides.
struct Mover<'m> {
    /// Evaluation of the pattern that has the sides already.
    evaluation: &'m Evaluation,
    split: &'m SplitPanel,
    panel: &'m Panel,
}

impl Mover<'_> {
    /// A seam transferred to the sides. `None`: the seam does not sew the panel.
    fn seam(&self, seam: &Seam) -> Result<Option<Seam>, EditError> {
        let mut changed = seam.clone();
        let mut is_moved = false;
        for side in &mut changed.sides {
            let mut spans = Vec::with_capacity(side.len() + 1);
            for span in side.drain(..) {
                if span.panel != self.panel.id {
                    spans.push(span);
                    continue;
                }
                is_moved = true;
                let parts = self.span(&span).ok_or_else(|| {
                    impossible(
                        format!(
                            "seam {:?} runs along panel {:?} in more than two stretches of its sides",
                            seam.name, self.panel.name
                        ),
                        "divide the seam first, one for each side of the cut",
                    )
                })?;
                spans.extend(parts);
            }
            *side = spans;
        }
        Ok(is_moved.then_some(changed))
    }

    /// The spans of the side panels that together cover a span of the panel.
    fn span(&self, span: &Span) -> Option<Vec<Span>> {
        let whole = self.length(self.panel.id, span)?;
        let same = |length: f64| (length - whole).abs() <= 1e-8;
        let on = |panel: PanelId, from: &Mark, to: &Mark| Span {
            panel,
            from: from.clone(),
            to: to.clone(),
            ..span.clone()
        };
        for side in self.split.sides {
            let own = on(side, &span.from, &span.to);
            if self.length(side, &own).is_some_and(same) {
                return Some(vec![own]);
            }
        }
        let [left, right] = self.split.sides;
        for (first, second) in [(left, right), (right, left)] {
            for index in [0, 1] {
                let cut = Mark::Corner(cut_corner(self.split.operation, index));
                let parts = vec![on(first, &span.from, &cut), on(second, &cut, &span.to)];
                let lengths: Option<Vec<f64>> = parts
                    .iter()
                    .map(|part| self.length(part.panel, part))
                    .collect();
                if lengths.is_some_and(|lengths| same(lengths.iter().sum())) {
                    return Some(parts);
                }
            }
        }
        None
    }

    /// Length of a span on its panel before unfolding (m). `None`: the span has no position.
    fn length(&self, panel: PanelId, span: &Span) -> Option<f64> {
        let pattern = self.evaluation.pattern();
        let owner = pattern.panel(panel)?;
        let lineage = pattern.stage_lineage(owner);
        let stage = match panel == self.panel.id {
            true => self.evaluation.stage(panel, Some(self.split.operation))?,
            false => self.evaluation.stage(panel, None)?,
        };
        let place = |mark: &Mark| {
            let value = mark_value(self.evaluation, owner, mark)?;
            let step = pattern.first_step(owner, &lineage, mark)?;
            let (of, after) = lineage.stage(step)?;
            let first: &Stage = self.evaluation.stage(of, after)?;
            stage.placed(first, span.line, value).ok()
        };
        let mut ends = [place(&span.from)?, place(&span.to)?];
        if span.backwards {
            ends.reverse();
        }
        let stretch = stage.stretch(span.line, ends, is_sewn).ok()?;
        Some(stage.stretch_length(0, &stretch))
    }

    /// The edits that add the seams along the cut, one for each copy and half.
    fn joined(&self, line: LineName, ids: &mut Ids) -> Vec<Edit> {
        let pattern = self.evaluation.pattern();
        let [left, right] = self.split.sides;
        let folds = |id: PanelId| {
            let own = pattern.panel(id).map_or(&[][..], |panel| &panel.operations);
            let folds = own
                .iter()
                .filter(|o| matches!(o.kind, OperationKind::Fold { .. }));
            folds.count().min(7)
        };
        let halves = 1_u8 << folds(left).min(folds(right));
        let mut seams: Vec<Edit> = Vec::new();
        let mut names: Vec<String> = pattern.seams.iter().map(|seam| seam.name.clone()).collect();
        for copy in 0..self.panel.cut.quantity {
            for half in 0..halves {
                let span = |panel: PanelId, backwards: bool| Span {
                    panel,
                    copy,
                    half,
                    line,
                    from: Mark::Corner(cut_corner(self.split.operation, 0)),
                    to: Mark::Corner(cut_corner(self.split.operation, 1)),
                    backwards,
                };
                let wanted = format!("{} joined", self.panel.name);
                let name = free_name(&wanted, |name| names.iter().any(|known| known == name));
                names.push(name.clone());
                let sides = [vec![span(left, false)], vec![span(right, true)]];
                let seam = Seam::new(ids.take(), &name, sides);
                seams.push(Edit::Put(Entity::Seam(Arc::new(seam))));
            }
        }
        seams
    }
}
