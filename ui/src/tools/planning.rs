//! Several planners in a row, each of which sees the edits of those before.

use super::Reading;
use super::refusal::refuse;
use super::slots::{Answer, Plan};
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::scene::PanelScene;
use crate::canvas::selection::{Item, Selection};
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{
    Edit, EditError, Entity, Evaluation, PanelId, Point, PointId, PointRule, SheetId, plan,
};

/// Edits that are being collected, and the pattern with these edits.
#[derive(Clone)]
pub struct Planning {
    evaluation: Evaluation,
    edits: Vec<Edit>,
}

impl Planning {
    /// Starts without edits, on the pattern that a tool reads.
    pub fn new(reading: &Reading<'_>) -> Self {
        Self::of(reading.evaluation)
    }

    /// Starts without edits, on an evaluated pattern.
    pub fn of(evaluation: &Evaluation) -> Self {
        Self {
            evaluation: evaluation.clone(),
            edits: Vec::new(),
        }
    }

    /// The evaluated pattern with the edits collected so far.
    pub fn evaluation(&self) -> &Evaluation {
        &self.evaluation
    }

    /// The edits collected so far.
    pub fn edits(self) -> Vec<Edit> {
        self.edits
    }

    /// Runs a planner on the pattern as it is now, applies its edits and collects them.
    ///
    /// # Errors
    /// The planner refuses, or its edits cannot be made.
    pub fn run<T>(
        &mut self,
        planner: impl FnOnce(&Evaluation) -> Result<(Vec<Edit>, T), EditError>,
    ) -> Result<T, EditError> {
        let (edits, found) = planner(&self.evaluation)?;
        self.make(edits)?;
        Ok(found)
    }

    /// Applies edits to the pattern, and collects them.
    ///
    /// # Errors
    /// The edits cannot be made.
    pub fn make(&mut self, edits: Vec<Edit>) -> Result<(), EditError> {
        let mut pattern = self.evaluation.pattern().clone();
        pattern.apply(&edits)?;
        let wearer = self.evaluation.wearer().clone();
        self.evaluation.update(&pattern, wearer);
        self.edits.extend(edits);
        Ok(())
    }

    /// The point at a place: the existing point, else a new one. `before` is the point at the place given
    /// before, for places relative to it.
    ///
    /// # Errors
    /// The point cannot be made.
    pub fn point(
        &mut self,
        placed: &Placed,
        before: Option<PointId>,
    ) -> Result<PointId, EditError> {
        if let Spec::Point(id) = placed.spec {
            return Ok(id);
        }
        let (sheet, rule) = (placed.sheet, rule_at(placed, before));
        self.run(|evaluation| plan::add_point(evaluation, sheet, None, rule))
    }

    /// The points at places; places relative to the place before are constructed from the point there.
    ///
    /// # Errors
    /// A point cannot be made, or the places are on several sheets.
    pub fn points(&mut self, places: &[&Placed]) -> Result<Vec<PointId>, EditError> {
        let mut points = Vec::new();
        for placed in places {
            one_sheet(places[0].sheet, placed.sheet)?;
            let point = self.point(placed, points.last().copied())?;
            points.push(point);
        }
        Ok(points)
    }

    /// The plan of a tool, from the edits collected.
    pub fn done(self, label: &str, select: impl IntoIterator<Item = Item>) -> Plan {
        Plan {
            edits: self.edits,
            label: label.to_owned(),
            select: select.into_iter().collect::<Selection>(),
            again: Vec::new(),
            told: None,
        }
    }
}

/// Rule for a new point at a place. At an existing point, the new one has a zero offset from it. `before`
/// is the point at the place given before.
pub(super) fn rule_at(placed: &Placed, before: Option<PointId>) -> PointRule {
    match (&placed.spec, before) {
        (Spec::Point(base), _) => PointRule::Offset {
            base: *base,
            x: 0.0.into(),
            y: 0.0.into(),
        },
        (Spec::New(rule), _) => rule.clone(),
        (Spec::FromLast { distance, angle }, Some(base)) => PointRule::Polar {
            base,
            angle: angle.clone(),
            distance: distance.clone(),
        },
        (Spec::BesideLast { x, y }, Some(base)) => PointRule::Offset {
            base,
            x: x.clone(),
            y: y.clone(),
        },
        _ => PointRule::at(placed.at.x, placed.at.y),
    }
}

/// Changes the rule of a point.
///
/// # Errors
/// The point does not exist, or the rule is not possible.
pub(super) fn put_rule(
    planning: &mut Planning,
    id: PointId,
    rule: PointRule,
) -> Result<(), EditError> {
    let found = planning.evaluation().pattern().point(id);
    let (sheet, point) = found.ok_or_else(|| refuse("the point is gone", "begin again"))?;
    let point = Point {
        rule,
        ..(**point).clone()
    };
    let edit = Edit::Put(Entity::Point(sheet.id, Arc::new(point)));
    planning.make(vec![edit])
}

/// Refuses a shape drawn across two sheets.
fn one_sheet(one: SheetId, other: SheetId) -> Result<(), EditError> {
    if one == other {
        return Ok(());
    }
    Err(refuse(
        "the places are on two sheets",
        "stay on the sheet that was begun on",
    ))
}

/// All places among the answers, in order.
pub fn places(answers: &[Answer]) -> Vec<&Placed> {
    let mut found = Vec::new();
    for answer in answers {
        match answer {
            Answer::Place(placed) | Answer::Named(placed, _) | Answer::End(placed, ..) => {
                found.push(placed);
            }
            Answer::Places(places, ..) => found.extend(places),
            _ => {}
        }
    }
    found
}

/// The panel under a point (m) of a sheet: the panel that the sheet lies on, else one that is traced on the
/// sheet.
///
/// # Errors
/// No panel lies there.
pub fn panel_under(
    reading: &Reading<'_>,
    (sheet, at): (SheetId, Vec2),
) -> Result<PanelId, EditError> {
    let drawn = reading.scene.sheet_scene(sheet);
    let laid = drawn.and_then(|drawn| drawn.on);
    let is_own = |panel: &PanelScene| match laid {
        Some(on) => panel.id == on,
        None => panel.sheet == sheet,
    };
    let is_there = |panel: &&PanelScene| is_own(panel) && panel.shape.contains(at);
    let found = reading.scene.panels.iter().find(is_there);
    found.map(|panel| panel.id).ok_or_else(|| {
        refuse(
            "no panel lies there",
            "click where a panel drawn on the same sheet lies",
        )
    })
}
