//! Selects by click and by box; drags points and whole panels; divides an edge by a double click.
//!
//! # Decided with
//! - [`crate::canvas::hit`], [`crate::views::pattern::PatternView::pointer`]: what is under the pointer;
//! - [`crate::tools::rounding::rounded_place`]: round numbers;
//! - [`toile_pattern::plan::move_point`], [`toile_pattern::plan::move_points`],
//!   [`toile_pattern::plan::move_point_by`]: the edits;
//! - [`toile_session::Session::preview`] (`gesture.rs`), [`toile_session::Session::commit`] (`gesture.rs`): shown, then one
//!   step;
//! - [`crate::app::ToileApp::follow_outcome`] (`perform.rs`), [`crate::tools::refusal::refuse`]: refusals shown.

use super::rounding::rounded_place;
use super::{Event, Outcome, Overlay, Planning, Pointer, PreviewChange, Reading, chosen};
use crate::canvas::hit::Hit;
use crate::canvas::placed::drag_step;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::table_layout::TableLayout;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::plan::{self, FormulaChange};
use toile_pattern::{Edit, EditError, Entity, Evaluation, Panel, PanelId, PointId, SheetId};

/// Sine of the largest angle between the directions of two handles at which they count as collinear (1).
const SMOOTH: f64 = 1e-3;
/// Largest distance from its goal at which a point still counts as in place, after another point was moved
/// (m).
const IN_PLACE: f64 = 1e-9;

/// State of the selection tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SelectState {
    /// No gesture.
    #[default]
    Idle,
    /// Parts are dragged; and how the drag changes the formulas of their numbers.
    Dragging(Dragged, FormulaChange),
    /// A box is drawn between two points of the table (m); the flag says whether it adds to the
    /// selection.
    Boxing([Vec2; 2], bool),
}

/// The dragged parts.
#[derive(Clone, Debug, PartialEq)]
pub enum Dragged {
    /// Points, and the one whose goal is rounded: the point under the pointer; of a dragged edge or curve,
    /// its first end.
    Points(Vec<PointId>, PointId),
    /// Panels on the table.
    Panels(Vec<PanelId>),
    /// Sheets on the table, with everything on them.
    Sheets(Vec<SheetId>),
    /// A part that cannot be dragged, and why.
    Fixed(String),
}

pub(super) fn step(
    state: &SelectState,
    event: &Event,
    reading: &Reading<'_>,
) -> (SelectState, Outcome) {
    let idle = SelectState::Idle;
    match event {
        Event::Click(pointer) => {
            let item = clicked(pointer, reading.selection);
            let select = chosen(reading.selection, item, pointer.modifiers.shift);
            (idle, selecting(select))
        }
        Event::DoubleClick(pointer) => (idle, double_click(pointer, reading)),
        Event::Drag(from, to) => drag(state, from, to, reading),
        Event::Text(text) if text == "=" => match state {
            SelectState::Dragging(dragged, change) => {
                let state = SelectState::Dragging(dragged.clone(), change.next());
                (state, Outcome::default())
            }
            _ => (state.clone(), Outcome::default()),
        },
        Event::Drop => dropped(state, reading),
        Event::Escape => match state {
            SelectState::Idle => (idle, selecting(Selection::default())),
            _ => (idle, nothing_shown()),
        },
        _ => (state.clone(), Outcome::default()),
    }
}

fn selecting(select: Selection) -> Outcome {
    Outcome {
        select: Some(select),
        ..Outcome::default()
    }
}

fn nothing_shown() -> Outcome {
    Outcome {
        shown: PreviewChange::Nothing,
        ..Outcome::default()
    }
}

/// The part that a click selects; repeated clicks at one place select the parts there in turn.
fn clicked(pointer: &Pointer, selection: &Selection) -> Option<Item> {
    let current = selection.single();
    // Clicks on a selected guide do not go on to the panel under it.
    if matches!(current, Some(Item::Guide(_))) {
        return pointer.hits.first().map(|hit| hit.item);
    }
    let at = current.and_then(|item| pointer.hits.iter().position(|hit| hit.item == item));
    let next = at.map_or(0, |k| (k + 1) % pointer.hits.len());
    pointer.hits.get(next).map(|hit| hit.item)
}

fn double_click(pointer: &Pointer, reading: &Reading<'_>) -> Outcome {
    let edge = pointer.hits.iter().find_map(|hit| match hit.item {
        Item::Edge(panel, edge) => Some((panel, edge, hit.at)),
        _ => None,
    });
    let Some((panel, edge, at)) = edge else {
        return Outcome::default();
    };
    match plan::divide_edge(reading.evaluation, (panel, edge), Some(at)) {
        Ok((edits, corner)) => Outcome {
            commit: Some((edits, "Add point".into())),
            select: Some(Selection::one(Item::Point(corner))),
            ..Outcome::default()
        },
        Err(error) => Outcome {
            refusal: Some(error.to_string()),
            ..Outcome::default()
        },
    }
}

fn drag(
    state: &SelectState,
    from: &Pointer,
    to: &Pointer,
    reading: &Reading<'_>,
) -> (SelectState, Outcome) {
    let mut outcome = Outcome::default();
    let (dragged, change) = match state {
        SelectState::Boxing(..) => {
            let state = SelectState::Boxing([from.table, to.table], to.modifiers.shift);
            return (state, outcome);
        }
        SelectState::Dragging(dragged, change) => (dragged.clone(), *change),
        SelectState::Idle => match from.hit() {
            None => {
                let state = SelectState::Boxing([from.table, to.table], to.modifiers.shift);
                return (state, outcome);
            }
            Some(hit) => {
                let (dragged, select) = take_hold(hit, reading);
                outcome.select = select;
                (dragged, FormulaChange::default())
            }
        },
    };
    match moved((&dragged, change), from, to, reading) {
        Ok(edits) => outcome.shown = PreviewChange::Edits(edits),
        Err(error) => outcome.refusal = Some(error.to_string()),
    }
    (SelectState::Dragging(dragged, change), outcome)
}

/// The parts that a drag moves, and the new selection: a drag of a selected part moves the whole selection;
/// a drag of another part moves that part alone, and selects it.
fn take_hold(hit: Hit, reading: &Reading<'_>) -> (Dragged, Option<Selection>) {
    let is_selected = reading.selection.contains(hit.item);
    let select = (!is_selected).then(|| Selection::one(hit.item));
    let dragged = match hit.item {
        Item::Point(id) => {
            let points = match is_selected {
                true => reading.selection.points(),
                false => vec![id],
            };
            Dragged::Points(points, id)
        }
        Item::Panel(id) => Dragged::Panels(match is_selected {
            true => reading.selection.panels(),
            false => vec![id],
        }),
        Item::Sheet(id) => Dragged::Sheets(match is_selected {
            true => reading.selection.sheets(),
            false => vec![id],
        }),
        Item::Edge(panel, id) => {
            let owner = reading.evaluation.pattern().owner_of(panel, id.into());
            match owner.and_then(|owner| owner.edge(id)) {
                Some(edge) => {
                    let points = plan::points_of(reading.evaluation, &[id.into()]);
                    Dragged::Points(points, edge.ends[0])
                }
                None => Dragged::Fixed("the edge is not there".into()),
            }
        }
        Item::Curve(id) => {
            let mut sheets = reading.evaluation.pattern().sheets.iter();
            match sheets.find_map(|sheet| sheet.curve(id)) {
                Some(curve) => {
                    let points = plan::points_of(reading.evaluation, &[id.into()]);
                    Dragged::Points(points, curve.ends[0])
                }
                None => Dragged::Fixed("the curve is not there".into()),
            }
        }
        Item::Line(..) | Item::Notch(..) | Item::Operation(..) | Item::Seam(_) | Item::Guide(_) => {
            Dragged::Fixed("it is moved by its numbers, beside the view".into())
        }
    };
    (dragged, select)
}

fn moved(
    (dragged, change): (&Dragged, FormulaChange),
    from: &Pointer,
    to: &Pointer,
    reading: &Reading<'_>,
) -> Result<Vec<Edit>, EditError> {
    let mut way = to.table - from.table;
    if to.modifiers.shift {
        way = straight(way);
    }
    match dragged {
        Dragged::Points(points, held) => {
            if let Some(now) = reading.evaluation.point(*held) {
                let goal = rounded_place(*held, now + way, to, reading);
                way = match to.modifiers.shift {
                    true => straight(goal - now),
                    false => goal - now,
                };
            }
            // Selected points that cannot move are skipped; but if the point under the pointer cannot move,
            // the drag fails with the reason.
            if let Some(now) = reading.evaluation.point(*held).filter(|_| points.len() > 1) {
                plan::move_point(reading.evaluation, *held, now + way)?;
            }
            let mut goals: Vec<(PointId, Vec2)> = points
                .iter()
                .filter_map(|point| Some((*point, reading.evaluation.point(*point)? + way)))
                .collect();
            let is_alone = goals.len() == 1;
            if let ([(handle, to)], false) = (&goals[..], to.modifiers.command) {
                let opposite = turned_along(*handle, *to, reading);
                goals.extend(opposite);
            }
            if is_alone && change != FormulaChange::Adjust {
                return moved_by(reading, &goals, change);
            }
            Ok(plan::move_points(reading.evaluation, &goals)?.edits)
        }
        Dragged::Panels(panels) => {
            let way = whole(way, to, reading);
            let pattern = reading.evaluation.pattern();
            let moved = panels.iter().filter_map(|id| {
                let panel = pattern.panel(*id)?;
                let old = panel.on_table.map_or_else(Vec2::zeros, Vec2::from);
                Some(Edit::Put(Entity::Panel(Arc::new(Panel {
                    on_table: Some((old + way).into()),
                    ..(**panel).clone()
                }))))
            });
            Ok(moved.collect())
        }
        Dragged::Sheets(sheets) => {
            let way = whole(way, to, reading);
            move_sheets(reading.evaluation, reading.table_layout, sheets, way)
        }
        Dragged::Fixed(words) => Err(EditError::Impossible {
            message: "it cannot be dragged".into(),
            hint: words.clone(),
        }),
    }
}

/// The edits that move the dragged point, and then the opposite handle, and change their formulas as `change`
/// says. The opposite handle is moved by an adjustment instead if that fails for it, or would move the
/// dragged point again, as when one variable defines both.
fn moved_by(
    reading: &Reading<'_>,
    goals: &[(PointId, Vec2)],
    change: FormulaChange,
) -> Result<Vec<Edit>, EditError> {
    let mut planning = Planning::new(reading);
    // Places that the points have reached: a point that is bound to a line may miss its goal.
    let mut reached: Vec<(PointId, Vec2)> = Vec::new();
    for &(point, to) in goals {
        let by = |change| {
            move |evaluation: &Evaluation| {
                let edits = plan::move_point_by(evaluation, point, to, change)?;
                Ok((edits, ()))
            }
        };
        if reached.is_empty() {
            planning.run(by(change))?;
        } else {
            let before = planning.clone();
            let made = planning.run(by(change));
            let is_there = |&(point, to): &(PointId, Vec2)| {
                let at = planning.evaluation().point(point);
                at.is_some_and(|at| (at - to).norm() <= IN_PLACE)
            };
            if made.is_err() || !reached.iter().all(is_there) {
                planning = before.clone();
                // An opposite handle that cannot follow stays in place, as in a drag that adjusts.
                if planning.run(by(FormulaChange::Adjust)).is_err() {
                    planning = before;
                }
            }
        }
        reached.extend(planning.evaluation().point(point).map(|at| (point, at)));
    }
    Ok(planning.edits())
}

/// The edits that move sheets by a vector (m) on the table; the other sheets stay where they are
/// displayed.
///
/// # Errors
/// A sheet does not exist, or lies on a panel.
pub fn move_sheets(
    evaluation: &Evaluation,
    table_layout: &TableLayout,
    sheets: &[SheetId],
    way: Vec2,
) -> Result<Vec<Edit>, EditError> {
    let mut places = table_layout.laid_apart(evaluation.pattern());
    places.retain(|(id, _)| !sheets.contains(id));
    let moved = sheets.iter().map(|id| (*id, table_layout.sheet(*id) + way));
    places.extend(moved.map(|(id, place)| (id, place.into())));
    plan::move_sheets(evaluation, &places)
}

/// The handle opposite to `handle`, with a new place, if both are collinear with their knot: while `handle`
/// moves to a place (m), the opposite one rotates and keeps its length, so that the curve stays smooth.
fn turned_along(handle: PointId, to: Vec2, reading: &Reading<'_>) -> Option<(PointId, Vec2)> {
    let (sheet, _) = reading.scene.point(handle)?;
    let pairs = || sheet.curves.iter().flat_map(|curve| &curve.handles);
    let [anchor, _] = *pairs().find(|pair| pair[1] == handle)?;
    let place = |id| reading.evaluation.point(id);
    let at = place(anchor)?;
    let own = place(handle)? - at;
    let opposite = |&&[of, other]: &&[PointId; 2]| {
        let way = match place(other) {
            Some(other) => other - at,
            None => return false,
        };
        let lengths = own.norm() * way.norm();
        let is_straight = own.perp(&way).abs() <= SMOOTH * lengths && own.dot(&way) < 0.0;
        of == anchor && other != handle && lengths > 0.0 && is_straight
    };
    let [_, other] = *pairs().find(opposite)?;
    let length = (place(other)? - at).norm();
    let way = (to - at).try_normalize(1e-9)?;
    Some((other, at - way * length))
}

fn dropped(state: &SelectState, reading: &Reading<'_>) -> (SelectState, Outcome) {
    let mut outcome = Outcome::default();
    match state {
        SelectState::Idle => {}
        SelectState::Boxing(corners, adds) => {
            let mut select = match adds {
                true => reading.selection.clone(),
                false => Selection::default(),
            };
            for item in (reading.inside)(*corners) {
                select.add(item);
            }
            outcome.select = Some(select);
        }
        SelectState::Dragging(dragged, _) => {
            let label = match dragged {
                Dragged::Points(points, ..) if points.len() == 1 => "Move point",
                Dragged::Points(..) => "Move points",
                Dragged::Panels(panels) if panels.len() == 1 => "Move panel",
                Dragged::Panels(_) => "Move panels",
                Dragged::Sheets(sheets) if sheets.len() == 1 => "Move sheet",
                Dragged::Sheets(_) => "Move sheets",
                Dragged::Fixed(_) => return (SelectState::Idle, nothing_shown()),
            };
            outcome.commit_shown = Some(label.into());
        }
    }
    (SelectState::Idle, outcome)
}

/// A drag vector on the table rounded to round numbers, unless rounding is turned off.
fn whole(way: Vec2, pointer: &Pointer, reading: &Reading<'_>) -> Vec2 {
    let step = drag_step(pointer.pixel, reading.evaluation.pattern().unit.metres());
    match pointer.modifiers.command {
        true => way,
        false => way.map(|along| (along / step).round() * step),
    }
}

/// The horizontal or vertical component of a vector, whichever is larger.
fn straight(way: Vec2) -> Vec2 {
    match way.x.abs() >= way.y.abs() {
        true => Vec2::new(way.x, 0.0),
        false => Vec2::new(0.0, way.y),
    }
}

pub(super) fn overlay(state: &SelectState, reading: &Reading<'_>) -> Vec<Overlay> {
    match state {
        SelectState::Dragging(Dragged::Points(points, held), change) if points.len() == 1 => {
            formula_words(*held, *change, reading).into_iter().collect()
        }
        SelectState::Boxing(corners, _) => vec![Overlay::Box(*corners)],
        _ => Vec::new(),
    }
}

/// Text beside a dragged point that tells how the drag changes its formulas; `None` if no formula defines the
/// point and `change` is the default.
fn formula_words(point: PointId, change: FormulaChange, reading: &Reading<'_>) -> Option<Overlay> {
    let numbers = plan::numbers_of(reading.evaluation, point.into());
    let mut numbers = numbers.iter().filter_map(|entry| entry.number.as_ref());
    let words = match change {
        FormulaChange::Adjust if numbers.any(|number| number.as_formula().is_some()) => {
            "added to the formula; = for another choice"
        }
        FormulaChange::Adjust => return None,
        FormulaChange::Variable => "the formula's variable changes; = for another choice",
        FormulaChange::ThisSize => "in this size alone; = for another choice",
        FormulaChange::Detach => "a number instead of the formula; = for another choice",
    };
    let (sheet, seen) = reading.scene.point(point)?;
    Some(Overlay::Words(sheet.id, seen.at, words.into()))
}

pub(super) fn hint(state: &SelectState, reading: &Reading<'_>) -> String {
    match state {
        SelectState::Idle if reading.scene.is_empty() => {
            "Choose a tool to draw with, or open a pattern".into()
        }
        SelectState::Idle => "Click to select, Shift-click to add, drag to move or to draw a box; \
                              double-click an edge to add a point"
            .into(),
        SelectState::Dragging(..) => {
            "Shift keeps it level or upright; Ctrl moves it freely, and a handle without the one \
             opposite; Esc leaves it"
                .into()
        }
        SelectState::Boxing(..) => "Everything inside is selected; Shift adds".into(),
    }
}
