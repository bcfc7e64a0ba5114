//! The stages of a panel, including the stages of the panel it was split from.

use super::{OperationKind, Panel, Pattern, Source};
use crate::{Mark, Notch, NotchId, Operation, OperationId, PanelId, PartId, SheetId};
use std::sync::Arc;

/// The stages that lead to a panel, in order: the panel as drawn, then the panel after each of its
/// operations, beginning with the panel that it was split from.
#[derive(Clone, Debug, Default)]
pub(crate) struct StageLineage {
    /// Each stage: its panel, the last operation of that panel that is done (`None`: none is done yet), and
    /// the operation that makes the stage (`None`: the panel is as drawn).
    stages: Vec<(PanelId, Option<OperationId>, Option<OperationId>)>,
    /// Index of the stage at which the panel itself starts, before any operation of its own.
    pub base: usize,
}

impl StageLineage {
    /// Panel of a stage, and the last operation of that panel that is done (`None`: none is done yet).
    pub fn stage(&self, step: usize) -> Option<(PanelId, Option<OperationId>)> {
        self.stages.get(step).map(|stage| (stage.0, stage.1))
    }

    /// Index of the stage that an operation makes.
    pub fn step_of(&self, operation: OperationId) -> Option<usize> {
        self.stages
            .iter()
            .position(|stage| stage.2 == Some(operation))
    }
}

impl Pattern {
    /// The panel, the panel that it is a side of after a split, and so on up to a panel that is drawn.
    pub fn lineage<'p>(&'p self, panel: &'p Panel) -> Vec<&'p Panel> {
        let mut found = vec![panel];
        let mut at = panel;
        while let Source::Side { of, .. } = at.source {
            match self.panel(of) {
                // A panel that is its own side is reported elsewhere, as a cycle.
                Some(parent) if !found.iter().any(|known| known.id == parent.id) => {
                    found.push(parent);
                    at = parent;
                }
                _ => break,
            }
        }
        found
    }

    /// The sheet that a panel is drawn on; for a side of a split panel, the sheet of the panel that is split.
    pub fn sheet_of(&self, panel: &Panel) -> Option<SheetId> {
        self.lineage(panel).last().and_then(|root| root.sheet())
    }

    /// A notch of a panel or of a panel that it is a side of.
    pub fn notch_of<'p>(&'p self, panel: &'p Panel, id: NotchId) -> Option<&'p Notch> {
        self.lineage(panel)
            .into_iter()
            .find_map(|own| own.notch(id))
    }

    /// The panel that has the edge, line, notch or operation `part`: `panel` itself, or one that it is a side
    /// of. `None`: none of these panels has the part.
    pub fn owner_of(&self, panel: PanelId, part: PartId) -> Option<&Panel> {
        let has = |own: &Panel| match part {
            PartId::Edge(id) => own.edge(id).is_some(),
            PartId::Line(id) => own.line(id).is_some(),
            PartId::Notch(id) => own.notch(id).is_some(),
            PartId::Operation(id) => own.step_of(id).is_some(),
            PartId::Size(_)
            | PartId::Variable(_)
            | PartId::Fabric(_)
            | PartId::Sheet(_)
            | PartId::Point(_)
            | PartId::Curve(_)
            | PartId::Panel(_)
            | PartId::Seam(_)
            | PartId::Marker(_)
            | PartId::Guide(_) => false,
        };
        let lineage = self.lineage(self.panel(panel)?);
        lineage.into_iter().find(|own| has(own))
    }

    /// Whether a panel is split and its sides are cut instead of it.
    pub fn is_replaced(&self, panel: &Panel) -> bool {
        let is_side =
            |other: &Arc<Panel>| matches!(other.source, Source::Side { of, .. } if of == panel.id);
        panel.is_split() && self.panels.iter().any(is_side)
    }

    /// An operation of a panel or of a panel that it is a side of.
    pub fn operation_of<'p>(
        &'p self,
        panel: &'p Panel,
        id: OperationId,
    ) -> Option<&'p Arc<Operation>> {
        let lineage = self.lineage(panel).into_iter();
        let mut all = lineage.flat_map(|own| &own.operations);
        all.find(|operation| operation.id == id)
    }

    pub(crate) fn stage_lineage(&self, panel: &Panel) -> StageLineage {
        let mut found = StageLineage::default();
        let mut lineage = self.lineage(panel).into_iter().rev().peekable();
        while let Some(own) = lineage.next() {
            let split = match own.source {
                Source::Side { split, .. } => Some(split),
                Source::Traced(_) => None,
            };
            found.base = found.stages.len();
            found.stages.push((own.id, None, split));
            let until = lineage.peek().and_then(|side| match side.source {
                Source::Side { split, .. } => Some(split),
                Source::Traced(_) => None,
            });
            for operation in &own.operations {
                if Some(operation.id) == until {
                    break;
                }
                let id = Some(operation.id);
                found.stages.push((own.id, id, id));
            }
        }
        found
    }

    /// Index of the first stage of a panel that has all corners by which a mark is placed. `None`: one of
    /// these corners is made by an operation that does not lead to the panel.
    pub(crate) fn first_step(
        &self,
        panel: &Panel,
        lineage: &StageLineage,
        mark: &Mark,
    ) -> Option<usize> {
        let at = match mark {
            Mark::Notch(id) => &self.notch_of(panel, *id)?.at,
            own @ (Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_)) => own,
        };
        let makers = at.corners().into_iter().filter_map(|corner| corner.maker());
        makers
            .map(|by| lineage.step_of(by))
            .try_fold(0, |first, step| Some(first.max(step?)))
    }
}

impl Panel {
    /// Whether operations move parts of the panel away from their drawn places.
    pub fn is_altered(&self) -> bool {
        let mut kinds = self.operations.iter().map(|operation| &operation.kind);
        kinds.any(OperationKind::moves_parts)
    }

    /// Whether the panel is split into other panels, which are cut instead of it.
    pub fn is_split(&self) -> bool {
        let mut kinds = self.operations.iter().map(|operation| &operation.kind);
        kinds.any(|kind| matches!(kind, OperationKind::Split { .. }))
    }
}
