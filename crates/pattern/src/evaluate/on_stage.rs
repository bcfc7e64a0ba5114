//! Parts drawn on a stage of a panel: points at its marks, and lines that are inserted into it.

use super::node::Node;
use super::numbers::Computation;
use super::panels::{PanelEvaluation, has_made};
use crate::Want;
use crate::{
    Code, Diagnostic, LineKind, LineName, Mark, OperationId, Pattern, Place, Point, SheetId, Stage,
};
use toile_geometry::Vec2;

/// The position of a point that is placed by a mark on the panel stage that its sheet lies on (m).
pub(super) fn point(
    c: &mut Computation<'_>,
    point: &Point,
    (line, at): (LineName, &Mark),
) -> Option<Vec2> {
    let place = Place::Point(point.id);
    let what = c.point_words(point);
    let pattern = &c.evaluation.pattern;
    let on = pattern.point(point.id).and_then(|found| found.0.on);
    let seen = on.and_then(|(id, after)| Some((pattern.panel(id)?, after)));
    let known = seen.filter(|(panel, after)| after.is_none_or(|by| panel.step_of(by).is_some()));
    let Some((panel, after)) = known else {
        let found = Diagnostic::error(
            Code::MissingReference,
            place,
            format!("{what}: its sheet lies on no stage of a panel that is there"),
            "undo the removal, or give the point another place",
        );
        c.diagnostics.push(found);
        return None;
    };
    let stage = c.stage(Node::Stage(panel.id, after)).cloned();
    let stage = c.reported(stage, &place, &what)?;
    let mut evaluated = PanelEvaluation::new(c, panel);
    let value = evaluated.mark(at, &place, &what)?;
    let lineage = &evaluated.lineage;
    let pattern = &evaluated.c.evaluation.pattern;
    let own = lineage.base + after.and_then(|by| panel.step_of(by)).unwrap_or(0);
    let step = pattern.first_step(panel, lineage, at);
    let Some(step) = step.filter(|step| *step <= own) else {
        let what = format!("{what}: a corner it is placed by is made after the stage of its sheet");
        evaluated.gone(&place, &what, "the corner");
        return None;
    };
    if !has_made(&stage, (pattern, panel, lineage), at) {
        // The operation that could not be done reports the fault itself.
        let index = &evaluated.c.evaluation.index;
        evaluated.c.cause = index.get(&Node::Stage(panel.id, after)).copied()?;
        return None;
    }
    let spot = match at {
        Mark::Corner(_) => stage.spot(line, value),
        Mark::Notch(_) | Mark::Along { .. } | Mark::Between { .. } => {
            evaluated.past(step, &place)?.spot(line, value)
        }
    };
    match spot {
        Ok(spot) => match stage.at_spot(line, spot) {
            Some((found, _)) => return Some(found),
            None => evaluated.gone(&place, &what, "its place on the line"),
        },
        Err(error) => evaluated.no_place(error, &place, &what),
    }
    None
}

impl Pattern {
    /// Whether a sheet lies on the stage of a panel just before its operation number `step`; operations in
    /// between may only insert lines.
    pub(crate) fn lies_before(&self, sheet: SheetId, panel: &crate::Panel, step: usize) -> bool {
        let Some((of, after)) = self.sheet(sheet).and_then(|sheet| sheet.on) else {
            return false;
        };
        let on = match after {
            Some(by) => panel.step_of(by),
            None => Some(0),
        };
        let is_since = |on: usize| {
            let mut between = panel.operations[on..step - 1].iter();
            between.all(|step| step.kind.sheet().is_some())
        };
        of == panel.id && on.is_some_and(|on| on < step && is_since(on))
    }
}

impl PanelEvaluation<'_, '_, '_> {
    /// The stage with the lines that an operation inserts. `None`: their sheet lies on another stage.
    pub(super) fn insert(
        &mut self,
        stage: &Stage,
        (step, by): (usize, OperationId),
        sheet: SheetId,
    ) -> Option<Stage> {
        let panel = self.panel;
        let name = &panel.operations[step - 1].name;
        let place = Place::Operation(panel.id, by);
        let pattern = &self.c.evaluation.pattern;
        if !pattern.lies_before(sheet, panel, step) {
            let words = match pattern.sheet(sheet) {
                Some(sheet) => format!("sheet {:?}", sheet.name),
                None => sheet.to_string(),
            };
            self.error(
                Code::MissingReference,
                place,
                &format!("insert {name:?}: {words} does not lie on the stage before it"),
                "do it right after the operation the sheet lies on, or undo the removal",
            );
            return None;
        }
        let what = self.words("seam allowance");
        let general = self.c.number(
            &panel.allowance,
            Want::Length,
            &Place::Panel(panel.id),
            &what,
        );
        let mut result = stage.clone();
        for kind in [LineKind::Hole, LineKind::Internal] {
            let own = panel.lines.iter();
            for line in own.filter(|line| line.kind == kind && line.by == Some(by)) {
                let Some(line) = self.line(line, general.unwrap_or(0.0)) else {
                    continue;
                };
                let is_later = |known: &crate::StageLine| {
                    kind == LineKind::Hole && known.kind == LineKind::Internal
                };
                let at = result.lines.iter().position(is_later);
                result.lines.insert(at.unwrap_or(result.lines.len()), line);
            }
        }
        Some(result)
    }
}
