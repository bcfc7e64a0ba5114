//! Tools that work on panels: darts, folds, notches, points on edges, internal lines.

use super::planning::{Planning, panel_under, places, put_rule};
use super::refusal::refuse;
use super::slots::{Answer, Fields, Slot, SlotKind, SlotTool};
use super::{Pointer, Reading};
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::press::toward_fold;
use crate::canvas::scene::fold_line;
use crate::canvas::selection::Item;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{
    Apex, CornerName, Curve, CurveId, CurveRule, EdgeId, Edit, EditError, Entity, LineKind, Mark,
    Name, NotchKind, Number, OperationKind, Panel, PanelId, PointId, PointRule, Pressed, SheetId,
    Want,
    plan::{self, Chain, CurveShape},
    press_arrows,
};

/// Takes a dart out of an outline.
pub static DART: SlotTool = SlotTool {
    command: "Dart",
    slots: &[
        Slot {
            hint: "Click the edge where the middle of the dart's mouth is",
            kind: SlotKind::OnLine,
        },
        Slot {
            hint: "Type the width of the mouth",
            kind: SlotKind::Number {
                label: "intake",
                want: Want::Length,
                usual: 0.03,
                live: None,
            },
        },
        Slot {
            hint: "Click how deep the dart is",
            kind: SlotKind::Number {
                label: "depth",
                want: Want::Length,
                usual: 0.1,
                live: Some(depth),
            },
        },
    ],
    plan: |answers, reading| {
        let [
            Answer::OnLine(panel, _, at, mark),
            Answer::Number(intake),
            Answer::Number(depth),
        ] = answers
        else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        let near = marked(reading, *panel, (*at, mark))?;
        let kind = |pressed| OperationKind::Dart {
            line: Name::Drawn(near.line),
            mouth: near.mark.clone(),
            intake: intake.clone(),
            apex: Apex::Depth(depth.clone()),
            pressed,
            trued: true,
            keeps_length: false,
        };
        let made = |pressed| operation(reading, *panel, kind(pressed), "Add dart");
        let mut plan = made(Pressed::default())?;
        if leads_from_fold(reading, &plan) {
            plan = made(Pressed::After)?;
        }
        plan.told = plan.select.single().and_then(|item| match item {
            Item::Operation(panel, dart) => {
                let mut planning = Planning::new(reading);
                planning.make(plan.edits.clone()).ok()?;
                super::finished_words(planning.evaluation(), panel, dart)
            }
            _ => None,
        });
        Ok(plan)
    },
};

/// Whether the dart that a plan adds is pressed away from the fold line of its panel: the fold line is the
/// centre of the panel.
fn leads_from_fold(reading: &Reading<'_>, plan: &super::slots::Plan) -> bool {
    let toward = || {
        let Some(Item::Operation(id, dart)) = plan.select.single() else {
            return None;
        };
        let mut planning = Planning::new(reading);
        planning.make(plan.edits.clone()).ok()?;
        let evaluation = planning.evaluation();
        let panel = evaluation.pattern().panel(id)?;
        let stage = evaluation.last_stage(panel)?;
        let arrows = press_arrows(stage, evaluation.pattern(), panel);
        let arrow = arrows
            .iter()
            .find(|arrow| arrow.by == dart && arrow.half == 0)?;
        toward_fold((arrow.at, arrow.way), fold_line(stage)?)
    };
    toward().is_some_and(|toward| toward < -0.5)
}

/// Takes out a dart inside a panel, pointed at both ends (fisheye dart).
pub static FISHEYE: SlotTool = SlotTool {
    command: "Fisheye dart",
    slots: &[
        Slot {
            hint: "Click inside a panel where the dart begins",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where it ends",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Type its width in the middle",
            kind: SlotKind::Number {
                label: "intake",
                want: Want::Length,
                usual: 0.02,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [Answer::Place(a), Answer::Place(b), Answer::Number(intake)] = answers else {
            return Err(refuse("nothing was given", "click inside a panel"));
        };
        let panel = panel_under(reading, (a.sheet, a.at))?;
        let mut planning = Planning::new(reading);
        let (_, points) = points_inside(&mut planning, reading, panel, &[a, b])?;
        let kind = OperationKind::Diamond {
            ends: [points[0], points[1]],
            widest: Number::Value(0.5),
            intake: intake.clone(),
        };
        let id = planning.run(|evaluation| plan::add_operation(evaluation, panel, kind))?;
        Ok(planning.done("Add dart", [Item::Operation(panel, id)]))
    },
};

/// Distance from the pointer to the mouth of a dart (m), in whole millimetres and at least one.
fn depth(answers: &[Answer], pointer: &Pointer) -> f64 {
    let mouth = answers.iter().find_map(|answer| match answer {
        Answer::OnLine(_, _, at, _) => Some(*at),
        _ => None,
    });
    let away = mouth.map_or(0.1, |mouth| (pointer.at - mouth).norm());
    crate::canvas::placed::rounded(away, 0.001).max(0.001)
}

/// Folds a panel: the drafted panel is half of the cut one; a straight edge of it lies on the fold.
pub static FOLD: SlotTool = SlotTool {
    command: "Fold",
    slots: &[Slot {
        hint: "Click the straight edge that lies on the fold of the cloth",
        kind: SlotKind::Edge,
    }],
    plan: |answers, reading| {
        let Some(Answer::Edge(panel, edge, _)) = answers.first() else {
            return Err(refuse("nothing was given", "click a straight edge"));
        };
        let owner = panel_of(reading, *panel)?;
        let (line, ends) = plan::edge_ends(reading.evaluation, owner, *edge)?;
        let kind = OperationKind::Fold {
            line: Name::Drawn(line),
            ends: ends.map(Mark::Corner),
        };
        operation(reading, *panel, kind, "Put on fold")
    },
};

/// Puts a notch on an edge.
pub static NOTCH: SlotTool = SlotTool {
    command: "Notch",
    slots: &[Slot {
        hint: "Click the edge where the notch is",
        kind: SlotKind::OnLine,
    }],
    plan: |answers, reading| {
        let Some(Answer::OnLine(panel, _, at, mark)) = answers.first() else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        let near = marked(reading, *panel, (*at, mark))?;
        let mut planning = Planning::new(reading);
        let id = planning.run(|evaluation| {
            let place = (near.line, near.mark);
            plan::add_notch(evaluation, *panel, place, NotchKind::default())
        })?;
        Ok(planning.done("Add notch", [Item::Notch(*panel, id)]))
    },
};

/// Bends an edge to an arc; the ends of the edge stay.
pub static BEND: SlotTool = SlotTool {
    command: "Bend edge",
    slots: &[
        Slot {
            hint: "Click the edge to bend",
            kind: SlotKind::Edge,
        },
        Slot {
            hint: "Click a place it is to go through",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let [Answer::Edge(panel, edge, _), Answer::Place(through)] = answers else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        let owner = reading
            .evaluation
            .pattern()
            .owner_of(*panel, (*edge).into());
        let found = owner.and_then(|owner| owner.edge(*edge));
        let curve = found
            .ok_or_else(|| refuse("the edge is gone", "click another"))?
            .curve;
        let mut planning = Planning::new(reading);
        bend(&mut planning, curve, through)?;
        Ok(planning.done("Bend edge", [Item::Edge(*panel, *edge)]))
    },
};

/// Bends a curve to an arc through a place.
fn bend(planning: &mut Planning, id: CurveId, through: &Placed) -> Result<(), EditError> {
    let found = planning.evaluation().pattern().curve(id);
    if let Some((sheet, curve)) = found
        && sheet.id == through.sheet
    {
        let (sheet, curve) = (sheet.id, (**curve).clone());
        if let CurveShape::Rule(rule) = super::arc::through(planning, curve.ends, through)? {
            let bent = Arc::new(Curve { rule, ..curve });
            return planning.make(vec![Edit::Put(Entity::Curve(sheet, bent))]);
        }
    }
    planning.run(|evaluation| Ok((plan::bend_curve(evaluation, id, through.at)?, ())))
}

/// Puts a new corner on an edge.
pub static DIVIDE: SlotTool = SlotTool {
    command: "Divide edge",
    slots: &[Slot {
        hint: "Click the edge where a point is to divide it",
        kind: SlotKind::OnLine,
    }],
    plan: |answers, reading| {
        let Some(Answer::OnLine(panel, item, at, mark)) = answers.first() else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        let Item::Edge(_, edge) = item else {
            return Err(refuse(
                "a line inside a panel is not divided",
                "click an edge",
            ));
        };
        let place = (*panel, *edge, *at);
        let tidy = || super::along::told(reading, place).map_or(*at, |(_, at)| at);
        let at = mark.as_ref().map_or_else(tidy, |_| *at);
        let mut planning = Planning::new(reading);
        let corner =
            planning.run(|evaluation| plan::divide_edge(evaluation, (*panel, *edge), Some(at)))?;
        if let Some(Mark::Along { from, distance }) = mark {
            let place = (*panel, *edge);
            if let Some(rule) = along_curve(reading, place, (*from, distance))? {
                put_rule(&mut planning, corner, rule)?;
            }
        }
        Ok(planning.done("Add point", [Item::Point(corner)]))
    },
};

/// Rule for a point at a typed distance along an edge, as a distance along the curve that the edge follows,
/// so that the typed number is kept. `None` if the edge does not cover the whole curve, or operations
/// change its length.
fn along_curve(
    reading: &Reading<'_>,
    (panel, edge): (PanelId, EdgeId),
    (from, distance): (CornerName, &Number),
) -> Result<Option<PointRule>, EditError> {
    let pattern = reading.evaluation.pattern();
    let owner = pattern.owner_of(panel, edge.into());
    let Some(found) = owner.and_then(|owner| owner.edge(edge)) else {
        return Ok(None);
    };
    let Some((_, curve)) = pattern.curve(found.curve) else {
        return Ok(None);
    };
    let drawn = reading.evaluation.curve(curve.id);
    let finished = plan::finished_edge(reading.evaluation, panel, edge)?;
    let is_whole = drawn.is_some_and(|path| (path.length() - finished.length).abs() < 1e-9);
    let is_end = curve.ends.map(Name::Drawn).contains(&from);
    let backwards = match found.ends {
        ends if ends == curve.ends => false,
        [start, end] if [end, start] == curve.ends => true,
        _ => return Ok(None),
    };
    if !is_whole || !is_end {
        return Ok(None);
    }
    let distance = match backwards {
        true => super::along::negated(distance, reading)?,
        false => distance.clone(),
    };
    Ok(Some(PointRule::AlongCurve {
        curve: curve.id,
        distance,
    }))
}

/// Draws a line inside a panel.
pub static INNER_LINE: SlotTool = SlotTool {
    command: "Inner line",
    slots: &[
        Slot {
            hint: "Click the panel the line is on",
            kind: SlotKind::Panel,
        },
        Slot {
            hint: "Click where the line goes, Enter ends it",
            kind: SlotKind::Places,
        },
    ],
    plan: |answers, reading| {
        let Some(Answer::Panel(panel)) = answers.first() else {
            return Err(refuse("nothing was given", "click a panel"));
        };
        let (closes, name) = match answers.get(1) {
            Some(Answer::Places(_, closes, name)) => (*closes, name.as_deref()),
            _ => (false, None),
        };
        let mut planning = Planning::new(reading);
        let (sheet, points) = points_inside(&mut planning, reading, *panel, &places(answers))?;
        let count = points.len();
        let mut curves = Vec::new();
        for k in 0..if closes { count } else { count - 1 } {
            let ends = [points[k], points[(k + 1) % count]];
            let curve = planning.run(|evaluation| {
                let shape = CurveShape::Rule(CurveRule::Line);
                plan::add_curve(evaluation, (sheet, None), ends, shape)
            })?;
            curves.push(curve);
        }
        let kind = match closes {
            true => LineKind::Hole,
            false => LineKind::Internal,
        };
        let line = planning.run(|evaluation| {
            plan::add_line(evaluation, *panel, (kind, name), Chain::Curves(&curves))
        })?;
        let label = if closes { "Add hole" } else { "Add inner line" };
        Ok(planning.done(label, [Item::Line(*panel, line)]))
    },
};

/// Lays a sheet on the finished panel, to draw on.
pub static DRAW_ON: SlotTool = SlotTool {
    command: "Draw on panel",
    slots: &[Slot {
        hint: "Click the panel to draw on as it is finished",
        kind: SlotKind::Panel,
    }],
    plan: |answers, reading| {
        let Some(Answer::Panel(panel)) = answers.first() else {
            return Err(refuse("nothing was given", "click a panel"));
        };
        let mut planning = Planning::new(reading);
        let sheet = planning.run(|evaluation| plan::open_sheet(evaluation, *panel))?;
        let drawn = planning.evaluation().pattern().sheet(sheet);
        let points = drawn.into_iter().flat_map(|sheet| &sheet.points);
        let items: Vec<Item> = points.map(|point| Item::Point(point.id)).collect();
        Ok(planning.done("Draw on panel", items))
    },
};

/// Makes a drawn curve an internal line of the panel that it lies on.
pub static INSERT_LINE: SlotTool = SlotTool {
    command: "Insert line",
    slots: &[Slot {
        hint: "Click the curve that becomes a line of the panel it lies on",
        kind: SlotKind::Curve,
    }],
    plan: |answers, reading| {
        let Some(Answer::Curve(sheet, curve, at)) = answers.first() else {
            return Err(refuse("nothing was given", "click a curve"));
        };
        let panel = panel_under(reading, (*sheet, *at))?;
        let mut planning = Planning::new(reading);
        let line = planning.run(|evaluation| {
            let kind = (LineKind::Internal, None);
            plan::add_line(evaluation, panel, kind, Chain::Curves(&[*curve]))
        })?;
        Ok(planning.done("Insert line", [Item::Line(panel, line)]))
    },
};

/// Sets the direction of the warp.
pub static GRAIN: SlotTool = SlotTool {
    command: "Grain",
    slots: &[
        Slot {
            hint: "Click the panel whose grain is set",
            kind: SlotKind::Panel,
        },
        Slot {
            hint: "Click where the grainline starts",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where it points",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let Some(Answer::Panel(panel)) = answers.first() else {
            return Err(refuse("nothing was given", "click a panel"));
        };
        let given = places(answers);
        let way = given[1].at - given[0].at;
        if way.norm() < 1e-9 {
            return Err(refuse(
                "the grainline has no direction",
                "click another place",
            ));
        }
        let mut planning = Planning::new(reading);
        let grain = match &given[1].spec {
            Spec::FromLast { angle, .. } => angle.clone(),
            _ => Number::Value(way.y.atan2(way.x)),
        };
        let changed = Panel {
            grain,
            ..(**panel_of(reading, *panel)?).clone()
        };
        planning.make(vec![Edit::Put(Entity::Panel(Arc::new(changed)))])?;
        Ok(planning.done("Set grain", [Item::Panel(*panel)]))
    },
};

/// Puts notches at equal distances along an edge.
pub static NOTCH_ROW: SlotTool = SlotTool {
    command: "Row of notches",
    slots: &[
        Slot {
            hint: "Click the edge to divide by notches",
            kind: SlotKind::Edge,
        },
        Slot {
            hint: "Type how many notches",
            kind: SlotKind::Number {
                label: "count",
                want: Want::Plain,
                usual: 3.0,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [Answer::Edge(panel, edge, _), Answer::Number(count)] = answers else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        let owner = panel_of(reading, *panel)?;
        let (line, ends) = plan::edge_ends(reading.evaluation, owner, *edge)?;
        let count = reading.evaluation.number(count, Want::Plain);
        let count = count.filter(|count| (1.0..=100.0).contains(count) && count.fract() == 0.0);
        let count =
            count.ok_or_else(|| refuse("a row has a count of 1 to 100", "type a whole number"))?;
        let row = plan::NotchRow {
            line,
            ends,
            count: count.round() as u32,
        };
        let mut planning = Planning::new(reading);
        let made = planning
            .run(|evaluation| plan::add_notches(evaluation, *panel, row, NotchKind::Slit))?;
        let items = made.into_iter().map(|id| Item::Notch(*panel, id));
        Ok(planning.done("Add row of notches", items))
    },
};

/// Makes points inside a panel; returns them with their sheet. For an ordinary panel this is the sheet on
/// which the panel is traced; for a part of a split panel, or an altered panel, a sheet that lies on the
/// finished panel.
fn points_inside(
    planning: &mut Planning,
    reading: &Reading<'_>,
    panel: PanelId,
    given: &[&Placed],
) -> Result<(SheetId, Vec<PointId>), EditError> {
    let owner = panel_of(reading, panel)?;
    let pattern = reading.evaluation.pattern();
    let is_here = |sheet: SheetId| {
        let on = pattern.sheet(sheet).and_then(|sheet| sheet.on);
        on.is_some_and(|(of, _)| of == panel)
    };
    let altered = owner.sheet().is_none() || owner.is_altered();
    let sheet = match given.iter().find(|placed| is_here(placed.sheet)) {
        Some(placed) => placed.sheet,
        None if altered => planning.run(|evaluation| plan::open_sheet(evaluation, panel))?,
        None => owner.sheet().unwrap_or_default(),
    };
    let given: Vec<Placed> = given
        .iter()
        .map(|placed| match placed.sheet == sheet {
            true => (*placed).clone(),
            false => Placed::free(sheet, placed.at),
        })
        .collect();
    let points = planning.points(&given.iter().collect::<Vec<_>>())?;
    Ok((sheet, points))
}

fn panel_of<'r>(reading: &Reading<'r>, id: PanelId) -> Result<&'r Arc<Panel>, EditError> {
    let found = reading.evaluation.pattern().panel(id);
    found.ok_or_else(|| refuse("the panel is not there", "click another"))
}

/// The line of a panel nearest to a point, with a mark on it: the typed mark; else, on an edge, a mark
/// rounded to a whole millimetre of the finished edge, or to its middle if that is near.
pub(super) fn marked(
    reading: &Reading<'_>,
    panel: PanelId,
    (at, typed): (Vec2, &Option<Mark>),
) -> Result<plan::NearMark, EditError> {
    let mut near = plan::nearest_mark(reading.evaluation, panel, at)?;
    if let Some(mark) = typed {
        near.mark = mark.clone();
        return Ok(near);
    }
    if let (Mark::Between { share, .. }, Name::Drawn(edge)) = (&mut near.mark, near.edge)
        && let Ok(edge) = plan::finished_edge(reading.evaluation, panel, edge)
    {
        let along = super::along::tidy(&edge, at);
        // No rounding onto a part of the edge that an operation inserted.
        if let Some((_, tidy)) = edge.share(along).filter(|(name, _)| *name == near.edge) {
            *share = Number::Value(short(tidy));
            near.at = edge.place(along).unwrap_or(near.at);
        }
    }
    Ok(near)
}

/// A share rounded to nine digits, if the digits left out come from rounding only.
fn short(share: f64) -> f64 {
    let short = (share * 1e9).round() / 1e9;
    match (short - share).abs() < 1e-12 {
        true => short,
        false => share,
    }
}

/// The plan that adds an operation to a panel.
fn operation(
    reading: &Reading<'_>,
    panel: PanelId,
    kind: OperationKind,
    label: &str,
) -> Result<super::slots::Plan, EditError> {
    let mut planning = Planning::new(reading);
    let id = planning.run(|evaluation| plan::add_operation(evaluation, panel, kind))?;
    Ok(planning.done(label, [Item::Operation(panel, id)]))
}
