//! Answers to slots: from typed text, else from the pointer.

use super::list::{self, Listed};
use super::refusal::{Unanswered, no_edge};
use super::slots::{Answer, SlotKind, SlotState, SlotTool, slot};
use super::toward::{to_side, turned};
use super::typing::{Typable, Way, way};
use super::{Pointer, Reading, along, number, tangent};
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::selection::Item;
use toile_geometry::Vec2;
use toile_pattern::{CurveId, EdgeId, Number, PanelId, PointRule, SheetId, Want};

/// The answer that pointer and typed text give now to the slot that the tool asks for.
///
/// # Errors
/// There is no valid answer yet: the reason, and the field it is about.
pub(super) fn answer(
    tool: &SlotTool,
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<Answer, Unanswered> {
    let kind = slot(tool, state).kind;
    let typable = Typable::new(tool, state, reading);
    typable.refuse_untaken(state)?;
    let numbers = match kind {
        // Several numbers are typed into one field, and read further below.
        SlotKind::Numbers { .. } => Vec::new(),
        _ => typed_numbers(&typable, state, reading)?,
    };
    let name = || {
        let name = match typable.typed_name(state) {
            "" => &state.named,
            typed => typed,
        };
        (!name.is_empty()).then(|| name.to_owned())
    };
    let here = || {
        let pointer = state.pointer.as_ref();
        pointer.ok_or_else(|| "point at a place of the pattern".to_owned())
    };
    let hit = |wanted: &dyn Fn(Item) -> bool, words: &str| {
        let found = here()?.hits.iter().find(|hit| wanted(hit.item)).copied();
        found.ok_or_else(|| format!("there is no {words} here: click on one"))
    };
    let place = || placed(way(kind, state), &numbers, state, reading);
    match kind {
        SlotKind::Place(_) | SlotKind::Places => Ok(Answer::Place(place()?)),
        SlotKind::Named(_) => Ok(Answer::Named(place()?, name())),
        SlotKind::OnLine => on_line(state, reading, numbers.into_iter().next().flatten()),
        SlotKind::Edge => {
            let (panel, edge, at) = edge_here(false, state, reading)?;
            Ok(Answer::Edge(panel, edge, at))
        }
        SlotKind::Chain => {
            let (panel, edge, _) = edge_here(true, state, reading)?;
            let mut chain = state.chain.clone();
            chain.push((panel, edge));
            Ok(Answer::Chain(chain))
        }
        SlotKind::Operation => {
            match hit(&|item| matches!(item, Item::Operation(..)), "dart")?.item {
                Item::Operation(panel, step) => Ok(Answer::Operation(panel, step)),
                _ => Err("there is no dart here: click on one".into()),
            }
        }
        SlotKind::Curve => {
            let (sheet, curve, at) = curve_here(state, reading)?;
            Ok(Answer::Curve(sheet, curve, at))
        }
        SlotKind::End => {
            let (sheet, curve, at) = curve_here(state, reading)?;
            Ok(tangent::end_near(reading, (sheet, curve), at)?)
        }
        SlotKind::Panel => {
            let found = hit(&|item| item.panel().is_some(), "panel")?;
            let panel = found.item.panel().ok_or("there is no panel here")?;
            Ok(Answer::Panel(panel))
        }
        SlotKind::Inside => {
            if numbers.iter().all(Option::is_none) {
                let pointer = here()?;
                return Ok(Answer::Inside(pointer.sheet, pointer.at, name()));
            }
            let placed = place()?;
            Ok(Answer::Inside(placed.sheet, placed.at, name()))
        }
        SlotKind::Numbers { label, usual } => {
            let text = state.typed.text(0).trim();
            listed(text, (label, usual), reading)
        }
        SlotKind::Number { usual, live, .. } => {
            if let Some(typed) = numbers.into_iter().next().flatten() {
                return Ok(Answer::Number(typed));
            }
            let said = live.zip(state.pointer.as_ref());
            let value = said.map_or(usual, |(live, pointer)| live(&state.answers, pointer));
            Ok(Answer::Number(Number::Value(value)))
        }
    }
}

/// Reads one plain number or several lengths from one field.
fn listed(
    text: &str,
    (label, usual): (&str, f64),
    reading: &Reading<'_>,
) -> Result<Answer, Unanswered> {
    if text.is_empty() {
        return Ok(Answer::Number(usual.into()));
    }
    match list::parse(text, reading.evaluation) {
        Ok(Listed::One(number)) => Ok(Answer::Number(number)),
        Ok(Listed::Lengths(lengths)) => Ok(Answer::Numbers(lengths)),
        Err(words) => Err(Unanswered {
            field: Some(0),
            words: format!("{label}: {words}"),
        }),
    }
}

/// The edge of a panel under the pointer, and the point of the edge nearest to the pointer (m).
fn edge_here(
    sews: bool,
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<(PanelId, EdgeId, Vec2), Unanswered> {
    let pointer = state.pointer.as_ref();
    let at = pointer.ok_or("point at a place of the pattern")?;
    let mut edges = at.hits.iter().filter_map(|hit| match hit.item {
        Item::Edge(panel, edge) => Some((panel, edge, hit.at)),
        _ => None,
    });
    let found = edges.next();
    found.ok_or_else(|| no_edge(sews, pointer, reading).into())
}

/// The curve under the pointer, or the curve that the edge there follows, with its sheet and the nearest
/// point on it (m).
fn curve_here(
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<(SheetId, CurveId, Vec2), Unanswered> {
    let pointer = state.pointer.as_ref();
    let hits = &pointer.ok_or("point at a place of the pattern")?.hits;
    let mut curves = hits.iter().filter_map(|hit| match hit.item {
        Item::Curve(curve) => Some((hit.sheet, curve, hit.at)),
        _ => None,
    });
    let traced = || tangent::curve_of(reading, edge_here(false, state, reading).ok()?);
    let found = curves.next().or_else(traced);
    found.ok_or_else(|| "there is no curve here: click on one".into())
}

/// A point on the line of a panel under the pointer; at a typed distance along an edge, if one was typed.
fn on_line(
    state: &SlotState,
    reading: &Reading<'_>,
    distance: Option<Number>,
) -> Result<Answer, Unanswered> {
    let pointer = state.pointer.as_ref();
    let hits = &pointer.ok_or("point at a place of the pattern")?.hits;
    let wanted = |item| matches!(item, Item::Edge(..) | Item::Line(..));
    let hit = hits.iter().find(|hit| wanted(hit.item));
    let hit = hit.ok_or("there is no line of a panel here: click on one")?;
    let panel = hit.item.panel().ok_or("there is no panel here")?;
    let Some(distance) = distance else {
        return Ok(Answer::OnLine(panel, hit.item, hit.at, None));
    };
    let fault = |words: String| Unanswered {
        field: Some(0),
        words: format!("distance: {words}"),
    };
    let Item::Edge(_, edge) = hit.item else {
        return Err(fault("it is measured along an edge: point at one".into()));
    };
    let found = along::mark_along(reading, (panel, edge, hit.at), distance);
    let (mark, at) = found.map_err(|error| fault(error.to_string()))?;
    Ok(Answer::OnLine(panel, hit.item, at, Some(mark)))
}

/// Reads the typed numbers, one per field; `None` for an empty field.
fn typed_numbers(
    typable: &Typable,
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<Vec<Option<Number>>, Unanswered> {
    let fields = typable.fields.iter().take(typable.numbers()).enumerate();
    let read = fields.map(|(k, field)| match state.typed.text(k).trim() {
        "" => Ok(None),
        text => {
            let number = number::parse(text, field.want, reading.evaluation);
            number.map(Some).map_err(|words| Unanswered {
                field: Some(k),
                words: format!("{}: {words}", field.label),
            })
        }
    });
    read.collect()
}

/// The present place: from the typed numbers if there are any, else from the pointer.
fn placed(
    way: Option<Way>,
    numbers: &[Option<Number>],
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<Placed, Unanswered> {
    let pointer = state.pointer.as_ref();
    let last = state.last_place();
    let [first, second] = [0, 1].map(|k| numbers.get(k).cloned().flatten());
    if first.is_none() && second.is_none() {
        let pointer = pointer.ok_or("point at a place, or type numbers")?;
        let free = pointer.placed(state.snap);
        return Ok(match last.filter(|_| pointer.modifiers.shift) {
            Some(last) => turned(last, pointer, free),
            None => free,
        });
    }
    let typed = TypedPlace {
        numbers: [first, second],
        origin: last.map_or_else(Vec2::zeros, |last| last.at),
        pointed: pointer.map(|pointer| pointer.placed(state.snap).at),
        pointer,
        reading,
    };
    let sheet = last.map(|last| last.sheet);
    let sheet = sheet.or(pointer.map(|pointer| pointer.sheet));
    // Typed numbers suffice for a place, even if the pointer is not on the canvas, as when a name is typed
    // elsewhere.
    let sheet = sheet.or(reading.sheet).ok_or("point at a sheet first")?;
    let (at, spec) = match way {
        Some(Way::FromLast | Way::Radius) => typed.after_last(),
        Some(Way::Beside) => typed.beside(false),
        Some(Way::Size) => typed.beside(state.pointed),
        Some(Way::Turn) => tangent::turned_place(state.answers.last(), typed.numbers, reading),
        _ => typed.coordinates(),
    }?;
    Ok(Placed {
        sheet,
        at,
        spec,
        words: String::new(),
    })
}

/// Numbers typed for a place; the pointer gives the numbers that are not typed.
struct TypedPlace<'a> {
    numbers: [Option<Number>; 2],
    origin: Vec2,
    pointed: Option<Vec2>,
    pointer: Option<&'a Pointer>,
    reading: &'a Reading<'a>,
}

impl TypedPlace<'_> {
    fn or_pointed(&self, k: usize, value: f64) -> Result<Number, Unanswered> {
        match (&self.numbers[k], self.pointed) {
            (Some(number), _) => Ok(number.clone()),
            (None, Some(_)) => Ok(Number::Value(value)),
            (None, None) => Err(Unanswered {
                field: Some(k),
                words: "type the other number too (Tab), or point at a place".into(),
            }),
        }
    }

    fn values(&self, numbers: [&Number; 2], want: [Want; 2]) -> Result<Vec2, Unanswered> {
        let value = |k: usize| {
            let value = self.reading.evaluation.number(numbers[k], want[k]);
            value.ok_or_else(|| Unanswered {
                field: Some(k),
                words: "the formula has no value".into(),
            })
        };
        Ok(Vec2::new(value(0)?, value(1)?))
    }

    fn way(&self) -> Vec2 {
        self.pointed.map_or_else(Vec2::zeros, |at| at - self.origin)
    }

    fn after_last(&self) -> Result<(Vec2, Spec), Unanswered> {
        let way = self.way();
        let distance = self.or_pointed(0, way.norm())?;
        let angle = self.or_pointed(1, way.y.atan2(way.x))?;
        let polar = self.values([&distance, &angle], [Want::Length, Want::Angle])?;
        let at = self.origin + Vec2::new(polar.y.cos(), polar.y.sin()) * polar.x;
        Ok((at, Spec::FromLast { distance, angle }))
    }

    /// A place at an offset from the last place. With `to_pointer`, for a rectangle, typed numbers without
    /// a sign are taken toward the side of the pointer.
    fn beside(&self, to_pointer: bool) -> Result<(Vec2, Spec), Unanswered> {
        let way = self.way();
        let pixel = self.pointer.map_or(0.0, |pointer| pointer.pixel);
        let signed = |k: usize, way: f64| match &self.numbers[k] {
            Some(number) if to_pointer => Ok(to_side(number.clone(), way, (pixel, self.reading))?),
            _ => self.or_pointed(k, way),
        };
        let (x, y) = (signed(0, way.x)?, signed(1, way.y)?);
        let to = self.values([&x, &y], [Want::Length; 2])?;
        Ok((self.origin + to, Spec::BesideLast { x, y }))
    }

    fn coordinates(&self) -> Result<(Vec2, Spec), Unanswered> {
        let at = self.pointed.unwrap_or_default();
        let (x, y) = (self.or_pointed(0, at.x)?, self.or_pointed(1, at.y)?);
        let at = self.values([&x, &y], [Want::Length; 2])?;
        Ok((at, Spec::New(PointRule::At { x, y })))
    }
}
