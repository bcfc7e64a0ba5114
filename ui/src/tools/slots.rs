//! Tools that are given one thing after another: a list of slots and a planner. What is typed for a slot
//! stands in `typing`, what is given there in `answering`, and how a tool goes on in `slot_steps`.

use super::{Pointer, Reading};
use crate::canvas::placed::Placed;
use crate::canvas::selection::{Item, Selection};
use toile_geometry::Vec2;
use toile_pattern::{
    CurveId, EdgeId, Edit, EditError, Mark, Number, OperationId, PanelId, SheetId, Want,
};

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
    /// A place on an outline, hole or inner line of a panel; a distance along an edge from its nearer
    /// corner may be typed.
    OnLine,
    /// An edge of a panel.
    Edge,
    /// Edges one after another: Shift-clicks add, a click ends them.
    Chain,
    /// A dart or another kept step of a panel.
    Operation,
    /// A curve of a sheet.
    Curve,
    /// An end of a curve of a sheet: that which is nearer to the click.
    End,
    /// A panel.
    Panel,
    /// A place inside something, which need not be drawn to anything, and a name for it.
    Inside,
    /// A plain number; or several lengths, which answer what is asked after it too.
    Numbers {
        /// What it is called.
        label: &'static str,
        /// The plain number as long as nothing is typed.
        usual: f64,
    },
    /// A number: typed, or given by the pointer.
    Number {
        /// What it is called.
        label: &'static str,
        /// What it measures.
        want: Want,
        /// What it is as long as nothing is typed, if the pointer does not say (m), (rad).
        usual: f64,
        /// What the pointer says, from what was given before (m), (rad).
        live: Option<fn(&[Answer], &Pointer) -> f64>,
    },
}

/// Which numbers are typed first for a place that follows another; the others may be typed too, and for
/// the first place of a tool coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fields {
    /// Length and angle from the place before.
    Usual,
    /// Radius and angle from the place before, which is a centre.
    Radius,
    /// Width and height from the place before.
    Size,
    /// Radius and angle of an arc that goes on smoothly from the end of a curve.
    Turn,
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
    /// A place of a panel's line, on its sheet (m); and the mark there if a distance was typed.
    OnLine(PanelId, Item, Vec2, Option<Mark>),
    /// An edge, and the place it was taken at (m).
    Edge(PanelId, EdgeId, Vec2),
    /// Edges one after another.
    Chain(Vec<ChainEdge>),
    /// A kept step of a panel.
    Operation(PanelId, OperationId),
    /// A curve, and the place it was taken at (m).
    Curve(SheetId, CurveId, Vec2),
    /// The point at an end of a curve; and which end: 0 the start, 1 the end.
    End(Placed, CurveId, usize),
    /// A panel.
    Panel(PanelId),
    /// Several lengths (m).
    Numbers(Vec<Number>),
    /// A place inside something of a sheet (m), and the name if one was typed.
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
    /// What is typed, a text a field.
    pub(super) typed: Typed,
    /// The name that was typed before the last of several places.
    pub(super) named: String,
    /// What the tool made last: what is typed before another is begun may belong to it.
    pub(super) made: Option<Item>,
    /// Whether its handles are as they should be: what is typed next is the next.
    pub(super) settled: bool,
    /// Whether the last place was given by the pointer, not by numbers.
    pub(super) pointed: bool,
    /// The snap that is taken, counted from the best.
    pub(super) snap: usize,
    pub(super) pointer: Option<Pointer>,
    /// Why what was asked last was not done.
    pub(super) refusal: Option<String>,
    /// What ought to be known of what would be done now.
    pub(super) told: Option<String>,
}

/// What is being typed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Typed {
    /// Texts by field; none yet for fields behind the last.
    texts: Vec<String>,
    /// Which of the ways to say a place is typed.
    pub way: usize,
    /// Which field is typed.
    pub field: usize,
    /// Whether the name was begun by its sign.
    pub naming: bool,
    /// The field that is at fault.
    pub fault: Option<usize>,
}

impl Typed {
    /// What is typed into a field.
    pub fn text(&self, field: usize) -> &str {
        self.texts.get(field).map_or("", String::as_str)
    }

    /// The same to be changed.
    pub fn text_mut(&mut self, field: usize) -> &mut String {
        let count = self.texts.len().max(field + 1);
        self.texts.resize(count, String::new());
        &mut self.texts[field]
    }

    /// Whether nothing is typed or begun.
    pub fn is_empty(&self) -> bool {
        !self.naming && self.way == 0 && self.is_blank(self.texts.len())
    }

    /// Whether nothing stands in so many first fields.
    pub fn is_blank(&self, count: usize) -> bool {
        self.texts.iter().take(count).all(String::is_empty)
    }
}

impl SlotState {
    /// Whether nothing was given or typed yet.
    pub fn is_empty(&self) -> bool {
        self.is_unbegun() && !self.is_typing()
    }

    /// Whether nothing was given yet.
    pub(super) fn is_unbegun(&self) -> bool {
        self.answers.is_empty() && self.places.is_empty() && self.chain.is_empty()
    }

    /// What the tool made last, until another is begun.
    pub(super) fn newest(&self) -> Option<Item> {
        self.made.filter(|_| self.is_unbegun())
    }

    /// Whether a number or a name is being typed.
    pub fn is_typing(&self) -> bool {
        !self.typed.is_empty()
    }

    /// The sheet of the place given last.
    pub fn sheet(&self) -> Option<SheetId> {
        self.last_place().map(|placed| placed.sheet)
    }

    /// What was given so far.
    pub fn given(&self) -> &[Answer] {
        &self.answers
    }

    /// The place given last (m).
    pub(super) fn last_place(&self) -> Option<&Placed> {
        let given = self.answers.iter().rev().find_map(|answer| match answer {
            Answer::Place(placed) | Answer::End(placed, ..) => Some(placed),
            _ => None,
        });
        self.places.last().or(given)
    }

    pub(super) fn clear_typed(&mut self) {
        self.typed = Typed::default();
        self.snap = 0;
    }
}

/// The slot that is asked for now.
pub(super) fn slot<'t>(tool: &'t SlotTool, state: &SlotState) -> &'t Slot {
    let last = tool.slots.len() - 1;
    &tool.slots[state.answers.len().min(last)]
}

/// Whether answers are all that a tool needs.
pub(super) fn is_complete(tool: &SlotTool, answers: &[Answer]) -> bool {
    let ends = matches!(answers.last(), Some(Answer::Numbers(_)));
    ends || answers.len() >= tool.slots.len()
}

/// The answer of a number as long as nothing is typed and nothing is pointed at.
pub(super) fn usual(slot: &Slot) -> Option<Answer> {
    match slot.kind {
        SlotKind::Number { usual, .. } | SlotKind::Numbers { usual, .. } => {
            Some(Answer::Number(usual.into()))
        }
        _ => None,
    }
}
