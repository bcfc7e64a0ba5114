//! Tools that are given one thing after another: a list of slots and a planner. One machine gives
//! all of them hovering, typed numbers, snapping, steps back and hints.

use super::refusal::no_edge;
use super::toward::{to_side, turned};
use super::{Event, Outcome, Pointer, PreviewChange, Reading};
use super::{along, number};
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::selection::{Item, Selection};
use toile_geometry::Vec2;
use toile_pattern::{
    CurveId, EdgeId, Edit, EditError, Mark, Number, OperationId, PanelId, SheetId, Want,
};

/// The field of a name.
const NAME: &str = "name";
/// What begins a name where nothing else is typed: names stand in it in formulas too.
pub const NAME_SIGN: char = '\'';

/// A tool of slots.
#[derive(Debug)]
pub struct SlotTool {
    /// The name of the command that takes it in hand.
    pub command: &'static str,
    /// What it is given, in order.
    pub slots: &'static [Slot],
    /// From what it was given to edits.
    pub plan: fn(&[Answer], &Reading<'_>) -> Result<Plan, EditError>,
}

/// One thing a tool is given.
#[derive(Debug)]
pub struct Slot {
    /// What to do to give it.
    pub hint: &'static str,
    /// What it is.
    pub kind: SlotKind,
}

/// What a slot takes.
#[derive(Clone, Copy, Debug)]
pub enum SlotKind {
    /// A place of a sheet, with numbers that may be typed for it.
    Place(Fields),
    /// A place that ends what is drawn, which may be typed a name after the numbers.
    Named(Fields),
    /// Several places, and a name for what runs through them; Enter or a click on the first ends them.
    Places,
    /// A place on an outline, hole or inner line of a panel, with numbers that may be typed for it.
    OnLine(Fields),
    /// An edge of a panel.
    Edge,
    /// Edges one after another: Shift-clicks add, a click ends them.
    Chain,
    /// A dart or another kept step of a panel.
    Operation,
    /// A curve of a sheet.
    Curve,
    /// A panel.
    Panel,
    /// A place inside something, which need not be drawn to anything, and a name for it.
    Inside,
    /// A number: typed, or given by the pointer.
    Number {
        /// What it is called.
        label: &'static str,
        /// What it measures.
        want: Want,
        /// What it is as long as nothing is typed, if the pointer does not say [m], [rad].
        usual: f64,
        /// What the pointer says, from what was given before [m], [rad].
        live: Option<fn(&[Answer], &Pointer) -> f64>,
    },
}

/// Numbers that may be typed for a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fields {
    /// None.
    None,
    /// Distance along an edge from its nearer corner.
    Distance,
    /// Coordinates on the sheet.
    Coordinates,
    /// Length and angle from the place before.
    FromLast,
    /// Width and height from the place before.
    Size,
}

impl Fields {
    fn labels(self) -> &'static [(&'static str, Want)] {
        match self {
            Self::None => &[],
            Self::Distance => &[("distance", Want::Length)],
            Self::Coordinates => &[("x", Want::Length), ("y", Want::Length)],
            Self::FromLast => &[("length", Want::Length), ("angle", Want::Angle)],
            Self::Size => &[("width", Want::Length), ("height", Want::Length)],
        }
    }
}

/// An edge of a chain, with its panel.
pub type ChainEdge = (PanelId, EdgeId);

/// What was given.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// A place.
    Place(Placed),
    /// The place that ends what is drawn, and the name of it if one was typed.
    Named(Placed, Option<String>),
    /// Places, whether the last joins the first, and the name if one was typed.
    Places(Vec<Placed>, bool, Option<String>),
    /// A place of a panel's line, on its sheet [m]; and the mark there if a distance was typed.
    OnLine(PanelId, Item, Vec2, Option<Mark>),
    /// An edge, and the place it was taken at [m].
    Edge(PanelId, EdgeId, Vec2),
    /// Edges one after another.
    Chain(Vec<ChainEdge>),
    /// A kept step of a panel.
    Operation(PanelId, OperationId),
    /// A curve, and the place it was taken at [m].
    Curve(SheetId, CurveId, Vec2),
    /// A panel.
    Panel(PanelId),
    /// A place inside something of a sheet [m], and the name if one was typed.
    Inside(SheetId, Vec2, Option<String>),
    /// A number.
    Number(Number),
}

/// What a tool does when it has been given everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The edits.
    pub edits: Vec<Edit>,
    /// The step's name in the history.
    pub label: String,
    /// What is selected then.
    pub select: Selection,
    /// What the tool has been given already when it begins again.
    pub again: Vec<Answer>,
    /// What ought to be known of it before it is done.
    pub told: Option<String>,
}

/// How far a tool has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlotState {
    pub(super) answers: Vec<Answer>,
    /// Places of a slot that takes several.
    pub(super) places: Vec<Placed>,
    /// Edges of a chain that more are added to.
    pub(super) chain: Vec<ChainEdge>,
    /// What is typed: up to two numbers, and the name of what is drawn.
    pub(super) typed: [String; 3],
    /// Which of them is typed.
    pub(super) field: usize,
    /// Whether the name was begun by its sign.
    pub(super) naming: bool,
    /// The name that was typed before the last of several places.
    pub(super) named: String,
    /// Whether the last place was given by the pointer, not by numbers.
    pointed: bool,
    /// The snap that is taken, counted from the best.
    snap: usize,
    pub(super) pointer: Option<Pointer>,
    /// Why what was asked last was not done.
    pub(super) refusal: Option<String>,
    /// What ought to be known of what would be done now.
    pub(super) told: Option<String>,
}

impl SlotState {
    /// Whether nothing was given yet.
    pub fn is_empty(&self) -> bool {
        self.answers.is_empty()
            && self.places.is_empty()
            && self.chain.is_empty()
            && !self.is_typing()
    }

    /// Whether a number or a name is being typed.
    pub fn is_typing(&self) -> bool {
        self.naming || self.typed.iter().any(|text| !text.is_empty())
    }

    /// Takes typed text. The sign of names begins the name of what is drawn; within a formula it is a
    /// sign like others.
    fn take_text(&mut self, kind: SlotKind, text: &str) {
        let fields = fields(kind);
        let Some(last) = fields.len().checked_sub(1) else {
            return;
        };
        self.field = self.field.min(last);
        let is_begun = !self.typed[self.field].is_empty() || self.naming;
        match text.strip_prefix(NAME_SIGN).filter(|_| !is_begun) {
            Some(rest) if fields[last].0 == NAME => {
                self.naming = true;
                self.field = last;
                self.typed[last] = rest.to_owned();
            }
            _ => self.typed[self.field].push_str(text),
        }
    }

    /// The name that was typed.
    fn name(&self, kind: SlotKind) -> Option<String> {
        let field = fields(kind).iter().position(|(label, _)| *label == NAME);
        let typed = field.map_or("", |field| self.typed[field].trim());
        let name = match typed.is_empty() {
            true => &self.named,
            false => typed,
        };
        (!name.is_empty()).then(|| name.to_owned())
    }

    /// The sheet of the place given last.
    pub fn sheet(&self) -> Option<SheetId> {
        self.last_place().map(|placed| placed.sheet)
    }

    /// The place given last [m].
    pub(super) fn last_place(&self) -> Option<&Placed> {
        let given = self.answers.iter().rev().find_map(|answer| match answer {
            Answer::Place(placed) => Some(placed),
            _ => None,
        });
        self.places.last().or(given)
    }

    fn clear_typed(&mut self) {
        self.typed = Default::default();
        self.field = 0;
        self.naming = false;
        self.snap = 0;
    }
}

pub(super) fn slot<'t>(tool: &'t SlotTool, state: &SlotState) -> &'t Slot {
    let last = tool.slots.len() - 1;
    &tool.slots[state.answers.len().min(last)]
}

pub(super) fn step(
    tool: &'static SlotTool,
    state: &SlotState,
    event: &Event,
    reading: &Reading<'_>,
) -> (SlotState, Outcome) {
    let mut next = state.clone();
    next.refusal = None;
    let kind = slot(tool, state).kind;
    let mut outcome = Outcome::default();
    match event {
        Event::Hover(pointer) | Event::Drag(_, pointer) => {
            if next.pointer.as_ref().is_none_or(|old| old.at != pointer.at) {
                next.snap = 0;
            }
            next.pointer = Some(pointer.clone());
        }
        Event::Leave => next.pointer = None,
        Event::Click(pointer) | Event::DoubleClick(pointer) => {
            next.pointer = Some(pointer.clone());
            outcome = accept(tool, &mut next, reading, false);
        }
        Event::Enter => outcome = accept(tool, &mut next, reading, true),
        Event::Text(text) => next.take_text(kind, text),
        Event::Backspace => {
            let field = next.field;
            if next.typed[field].pop().is_none() && next.naming {
                next.naming = false;
                next.field = 0;
            }
        }
        Event::Tab => match next.is_typing() {
            true => next.field = (next.field + 1) % fields(kind).len().max(1),
            false => next.snap += 1,
        },
        Event::Escape => {
            if next.is_typing() {
                next.clear_typed();
            } else if next.places.pop().is_none()
                && next.chain.pop().is_none()
                && next.answers.pop().is_none()
            {
                outcome.done = true;
            }
            if next.places.is_empty() {
                next.named.clear();
            }
        }
        Event::Drop | Event::Go(_) => {}
    }
    next.told = None;
    if outcome.commit.is_none() {
        outcome.shown = PreviewChange::Nothing;
        if let Some(plan) = shown(tool, &next, reading) {
            outcome.shown = PreviewChange::Edits(plan.edits);
            next.told = plan.told;
        }
    }
    next.refusal = outcome.refusal.clone();
    outcome.gets_on = outcome.refusal.is_none()
        && matches!(
            event,
            Event::Click(_) | Event::DoubleClick(_) | Event::Enter | Event::Escape
        );
    (next, outcome)
}

/// What may be typed in a slot: numbers, and the name of what is drawn.
pub(super) fn fields(kind: SlotKind) -> Vec<(&'static str, Want)> {
    let named = |fields: Fields| [fields.labels(), &[(NAME, Want::Any)]].concat();
    match kind {
        SlotKind::Named(fields) => named(fields),
        SlotKind::Place(fields) | SlotKind::OnLine(fields) => fields.labels().to_vec(),
        SlotKind::Places => named(Fields::FromLast),
        SlotKind::Inside => named(Fields::None),
        SlotKind::Number { label, want, .. } => vec![(label, want)],
        _ => Vec::new(),
    }
}

/// What is given now, if the slot can be answered so.
pub(super) fn answer(
    kind: SlotKind,
    state: &SlotState,
    reading: &Reading<'_>,
) -> Result<Answer, String> {
    let pointer = state.pointer.as_ref();
    let here = || pointer.ok_or_else(|| "point at a place of the pattern".to_owned());
    let hit = |wanted: &dyn Fn(Item) -> bool, words: &str| {
        let found = here()?.hits.iter().find(|hit| wanted(hit.item)).copied();
        found.ok_or_else(|| format!("there is no {words} here: click on one"))
    };
    let edge = || {
        let mut edges = here()?.hits.iter().filter_map(|hit| match hit.item {
            Item::Edge(panel, edge) => Some((panel, edge, hit.at)),
            _ => None,
        });
        edges
            .next()
            .ok_or_else(|| no_edge(matches!(kind, SlotKind::Chain), pointer, reading))
    };
    match kind {
        SlotKind::Place(fields) => Ok(Answer::Place(placed(fields, state, reading)?)),
        SlotKind::Named(fields) => {
            let name = state.name(kind);
            Ok(Answer::Named(placed(fields, state, reading)?, name))
        }
        SlotKind::Places => Ok(Answer::Place(placed(Fields::FromLast, state, reading)?)),
        SlotKind::OnLine(_) => {
            let wanted = |item| matches!(item, Item::Edge(..) | Item::Line(..));
            let hit = hit(&wanted, "line of a panel")?;
            let panel = hit.item.panel().ok_or("there is no panel here")?;
            let typed = state.typed[0].trim();
            if typed.is_empty() {
                return Ok(Answer::OnLine(panel, hit.item, hit.at, None));
            }
            let Item::Edge(_, edge) = hit.item else {
                return Err("a distance is measured along an edge: point at one".into());
            };
            let distance = number::parse(typed, Want::Length, reading.evaluation)?;
            let found = along::mark_along(reading, (panel, edge, hit.at), distance);
            let (mark, at) = found.map_err(|error| error.to_string())?;
            Ok(Answer::OnLine(panel, hit.item, at, Some(mark)))
        }
        SlotKind::Edge => edge().map(|(panel, edge, at)| Answer::Edge(panel, edge, at)),
        SlotKind::Chain => {
            let (panel, edge, _) = edge()?;
            let mut chain = state.chain.clone();
            chain.push((panel, edge));
            Ok(Answer::Chain(chain))
        }
        SlotKind::Operation => {
            let found = hit(&|item| matches!(item, Item::Operation(..)), "dart")?;
            match found.item {
                Item::Operation(panel, step) => Ok(Answer::Operation(panel, step)),
                _ => Err("there is no dart here: click on one".into()),
            }
        }
        SlotKind::Curve => {
            let found = hit(&|item| matches!(item, Item::Curve(_)), "curve")?;
            match found.item {
                Item::Curve(curve) => Ok(Answer::Curve(found.sheet, curve, found.at)),
                _ => Err("there is no curve here: click on one".into()),
            }
        }
        SlotKind::Panel => {
            let found = hit(&|item| item.panel().is_some(), "panel")?;
            let panel = found.item.panel().ok_or("there is no panel here")?;
            Ok(Answer::Panel(panel))
        }
        SlotKind::Inside => {
            let pointer = here()?;
            Ok(Answer::Inside(pointer.sheet, pointer.at, state.name(kind)))
        }
        SlotKind::Number {
            want, usual, live, ..
        } => {
            let typed = state.typed[0].trim();
            if !typed.is_empty() {
                return Ok(Answer::Number(number::parse(
                    typed,
                    want,
                    reading.evaluation,
                )?));
            }
            let said = live.zip(pointer);
            let value = said.map_or(usual, |(live, pointer)| live(&state.answers, pointer));
            Ok(Answer::Number(Number::Value(value)))
        }
    }
}

/// The place that is given now: where the pointer is, or where typed numbers say.
fn placed(fields: Fields, state: &SlotState, reading: &Reading<'_>) -> Result<Placed, String> {
    let mut numbers = [None, None];
    for (k, (_, want)) in fields.labels().iter().enumerate() {
        let text = state.typed[k].trim();
        if !text.is_empty() {
            numbers[k] = Some(number::parse(text, *want, reading.evaluation)?);
        }
    }
    let pointer = state.pointer.as_ref();
    let last = state.last_place();
    if numbers == [None, None] {
        let pointer = pointer.ok_or("point at a place, or type numbers")?;
        let free = pointer.placed(state.snap);
        let level = pointer.modifiers.shift && fields != Fields::None;
        return Ok(match last.filter(|_| level) {
            Some(last) => turned(last, pointer, free),
            None => free,
        });
    }
    let value = |number: &Number, want: Want| {
        let value = reading.evaluation.number(number, want);
        value.ok_or_else(|| "the formula has no value".to_owned())
    };
    let pointed = pointer.map(|pointer| pointer.placed(state.snap).at);
    let sheet = last.map(|last| last.sheet);
    let sheet = sheet.or(pointer.map(|pointer| pointer.sheet));
    // Numbers alone say where, though the pointer is elsewhere, as in the field of a name.
    let sheet = sheet.or(reading.sheet);
    let sheet = sheet.ok_or("point at a sheet first")?;
    let origin = last.map_or_else(Vec2::zeros, |last| last.at);
    let way = pointed.map_or_else(Vec2::zeros, |at| at - origin);
    let [first, second] = numbers;
    let missing = "type the other number too (Tab), or point at a place".to_owned();
    let or_pointed = |number: Option<Number>, value: f64| match number {
        Some(number) => Ok(number),
        None if pointed.is_some() => Ok(Number::Value(value)),
        None => Err(missing.clone()),
    };
    match fields {
        Fields::FromLast if last.is_some() => {
            let distance = or_pointed(first, way.norm())?;
            let angle = or_pointed(second, way.y.atan2(way.x))?;
            let (far, turn) = (value(&distance, Want::Length)?, value(&angle, Want::Angle)?);
            Ok(Placed {
                sheet,
                at: origin + Vec2::new(turn.cos(), turn.sin()) * far,
                spec: Spec::FromLast { distance, angle },
                words: String::new(),
            })
        }
        Fields::Size if last.is_some() => {
            // A rectangle grows to the side the pointer is on; from a corner that was typed, to the right
            // and upward.
            let pixel = pointer.map_or(0.0, |pointer| pointer.pixel);
            let signed = |number: Option<Number>, way: f64| match number {
                Some(number) if state.pointed => to_side(number, way, (pixel, reading)),
                Some(number) => Ok(number),
                None => or_pointed(None, way),
            };
            let (x, y) = (signed(first, way.x)?, signed(second, way.y)?);
            let to = Vec2::new(value(&x, Want::Length)?, value(&y, Want::Length)?);
            Ok(Placed {
                sheet,
                at: origin + to,
                spec: Spec::BesideLast { x, y },
                words: String::new(),
            })
        }
        _ => {
            let at = pointed.unwrap_or_default();
            let (x, y) = (or_pointed(first, at.x)?, or_pointed(second, at.y)?);
            let at = Vec2::new(value(&x, Want::Length)?, value(&y, Want::Length)?);
            Ok(Placed {
                sheet,
                at,
                spec: Spec::New(toile_pattern::PointRule::At { x, y }),
                words: String::new(),
            })
        }
    }
}

/// Takes what is given now, and does the work when that was the last.
fn accept(
    tool: &'static SlotTool,
    state: &mut SlotState,
    reading: &Reading<'_>,
    by_key: bool,
) -> Outcome {
    let kind = slot(tool, state).kind;
    let refused = |words: String| Outcome {
        refusal: Some(words),
        ..Outcome::default()
    };
    if let SlotKind::Places = kind {
        // A name alone is no place: Enter after it ends them.
        let ends = by_key && state.typed[..2].iter().all(String::is_empty);
        state.named = state.name(kind).unwrap_or_default();
        let given = match ends {
            true => None,
            false => match answer(kind, state, reading) {
                Ok(Answer::Place(placed)) => Some(placed),
                Ok(_) => None,
                Err(words) => return refused(words),
            },
        };
        let near = state
            .pointer
            .as_ref()
            .map_or(0.0, |pointer| 9.0 * pointer.pixel);
        let first = state.places.first();
        let closes = given.as_ref().zip(first).is_some_and(|(given, first)| {
            state.places.len() > 2 && (given.at - first.at).norm() <= near
        });
        if let Some(placed) = given.filter(|_| !closes) {
            state.places.push(placed);
            state.clear_typed();
            return Outcome::default();
        }
        if state.places.len() < 2 {
            // A name that was typed is kept for what comes of the places that are still to be given.
            if state.is_typing() && !state.named.is_empty() {
                state.clear_typed();
                return Outcome::default();
            }
            return refused("click at least two places first".into());
        }
        let places = std::mem::take(&mut state.places);
        let name = state.name(kind);
        state.answers.push(Answer::Places(places, closes, name));
    } else {
        let adds = state.pointer.as_ref().is_some_and(|at| at.modifiers.shift);
        match answer(kind, state, reading) {
            Ok(Answer::Chain(chain)) if adds && !by_key => {
                state.chain = chain;
                return Outcome::default();
            }
            Ok(answer) => {
                state.pointed = state.typed[..2].iter().all(String::is_empty);
                state.answers.push(answer);
            }
            Err(words) => return refused(words),
        }
    }
    state.clear_typed();
    state.chain.clear();
    if state.answers.len() < tool.slots.len() {
        return Outcome::default();
    }
    match (tool.plan)(&state.answers, reading) {
        Ok(plan) => {
            state.answers = plan.again;
            state.named.clear();
            Outcome {
                commit: Some((plan.edits, plan.label)),
                select: Some(plan.select),
                ..Outcome::default()
            }
        }
        Err(error) => {
            // What was given last is asked for again.
            state.named.clear();
            if let Some(Answer::Places(places, ..)) = state.answers.pop() {
                state.places = places;
            }
            refused(error.to_string())
        }
    }
}

/// What the tool would do if it were given this now.
fn shown(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> Option<Plan> {
    let kind = slot(tool, state).kind;
    let is_last = state.answers.len() + 1 == tool.slots.len();
    if !is_last || matches!(kind, SlotKind::Places) {
        return None;
    }
    let mut answers = state.answers.clone();
    answers.push(answer(kind, state, reading).ok()?);
    (tool.plan)(&answers, reading).ok()
}
