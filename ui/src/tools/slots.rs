//! Slot tools: tools that collect answers to a list of slots, then make a plan. Typed text is handled in
//! `typing`, answers in `answering`, transitions in `slot_steps`.
//!
//! # Decided with
//! - [`crate::tools::slot_steps`] (`accept`), [`crate::tools::answering::answer`]: how it goes on; what is
//!   given;
//! - [`crate::tools::slot_overlay::overlay`]: the overlay and the hints;
//! - [`crate::tools::typing::ways`]: what may be typed;
//! - [`crate::tools::planning::Planning`]: planners one after another; places;
//! - [`crate::app`] (`tool_commands.rs`, `TOOL_COMMANDS`, `tool_bar.rs`): its command and button;
//! - [`crate::views::pattern::PatternView::cursor`] (`input.rs`): shape of the pointer.

use super::{Pointer, Reading};
use crate::canvas::placed::Placed;
use crate::canvas::selection::{Item, Selection};
use toile_geometry::Vec2;
use toile_pattern::{
    CurveId, EdgeId, Edit, EditError, Mark, Number, OperationId, PanelId, SheetId, Want,
};

/// A slot tool.
#[derive(Debug)]
pub struct SlotTool {
    /// Name of the command that takes it in hand.
    pub command: &'static str,
    /// Slots, in order.
    pub slots: &'static [Slot],
    /// Makes the plan, with its edits, from the answers.
    pub plan: fn(&[Answer], &Reading<'_>) -> Result<Plan, EditError>,
}

/// A slot: one input that a tool asks for.
#[derive(Debug)]
pub struct Slot {
    /// Instruction to the user.
    pub hint: &'static str,
    /// Kind of the answer.
    pub kind: SlotKind,
}

/// Kind of answer that a slot takes.
#[derive(Clone, Copy, Debug)]
pub enum SlotKind {
    /// A place of a sheet; numbers can be typed for it in these fields.
    Place(Fields),
    /// The last place of a shape; a name can be typed after the numbers.
    Named(Fields),
    /// Several places, and a name for the shape through them; Enter or a click on the first ends them.
    Places,
    /// A place on an outline, hole or internal line of a panel; a distance along an edge from its nearer
    /// corner can be typed.
    OnLine,
    /// An edge of a panel.
    Edge,
    /// A chain of edges: Shift-clicks add, a click ends it.
    Chain,
    /// A dart or another operation of a panel.
    Operation,
    /// A curve of a sheet.
    Curve,
    /// An end of a curve of a sheet: the one nearer to the click.
    End,
    /// A panel.
    Panel,
    /// A place inside closed lines or a panel, without snapping, and a name for the result.
    Inside,
    /// A plain number; or several lengths, which also replace the answers to all later slots.
    Numbers {
        /// Label of the field.
        label: &'static str,
        /// Default of the plain number.
        usual: f64,
    },
    /// A number: typed, or given by the pointer.
    Number {
        /// Label of the field.
        label: &'static str,
        /// Kind of quantity.
        want: Want,
        /// Default, if the pointer gives no number (m, rad or 1).
        usual: f64,
        /// Function for the number that the pointer gives, from the answers so far (m, rad or 1).
        live: Option<fn(&[Answer], &Pointer) -> f64>,
    },
}

/// Fields for the numbers of a place, until a typed sign chooses other fields. For the first place of a tool
/// coordinates are typed instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fields {
    /// Distance and angle from the last place.
    Usual,
    /// Radius and angle from the last place, the centre of an arc.
    Radius,
    /// Width and height from the last place.
    Size,
    /// Radius and angle of an arc that continues the end of a curve smoothly.
    Turn,
}

/// An edge of a chain, with its panel.
pub type ChainEdge = (PanelId, EdgeId);

/// An answer to a slot.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// A place.
    Place(Placed),
    /// The last place of a shape, and its name if one was typed.
    Named(Placed, Option<String>),
    /// Places, whether the shape is closed, and its name if one was typed.
    Places(Vec<Placed>, bool, Option<String>),
    /// A place on a line of a panel, in coordinates of the panel's sheet (m); and the mark there if a
    /// distance was typed.
    OnLine(PanelId, Item, Vec2, Option<Mark>),
    /// An edge, and the point at which it was clicked (m).
    Edge(PanelId, EdgeId, Vec2),
    /// A chain of edges.
    Chain(Vec<ChainEdge>),
    /// An operation of a panel.
    Operation(PanelId, OperationId),
    /// A curve, and the point at which it was clicked (m).
    Curve(SheetId, CurveId, Vec2),
    /// The end point of a curve; and the end: 0 the start, 1 the end.
    End(Placed, CurveId, usize),
    /// A panel.
    Panel(PanelId),
    /// Several lengths (m).
    Numbers(Vec<Number>),
    /// A place on a sheet inside closed lines or a panel (m), and the name if one was typed.
    Inside(SheetId, Vec2, Option<String>),
    /// A number.
    Number(Number),
}

/// Result of a tool once all slots are answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The edits.
    pub edits: Vec<Edit>,
    /// Name of the step in the history.
    pub label: String,
    /// New selection.
    pub select: Selection,
    /// Answers with which the tool begins anew, after this plan is made.
    pub again: Vec<Answer>,
    /// Note that the user should read before the plan is made.
    pub told: Option<String>,
}

/// State of a slot tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlotState {
    pub(super) answers: Vec<Answer>,
    /// Places given so far to a slot that takes several.
    pub(super) places: Vec<Placed>,
    /// Edges given so far to a slot that takes a chain.
    pub(super) chain: Vec<ChainEdge>,
    /// Typed texts, one per field.
    pub(super) typed: Typed,
    /// Name that was typed before the last of several places was given, or before the next part was begun.
    pub(super) named: String,
    /// The part that the tool made last: text typed before the next part is begun may belong to it.
    pub(super) made: Option<Item>,
    /// Whether the handles of that part have been accepted: text typed now belongs to the next part.
    pub(super) settled: bool,
    /// Whether the last place was given by the pointer, not by numbers.
    pub(super) pointed: bool,
    /// Index of the chosen snapping place, counted from the best.
    pub(super) snap: usize,
    pub(super) pointer: Option<Pointer>,
    /// Reason why the last input was refused.
    pub(super) refusal: Option<String>,
    /// Note on the effect of the present answer.
    pub(super) told: Option<String>,
}

/// Text that is being typed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Typed {
    /// Texts by field; shorter than the list of fields if the last ones are untouched.
    texts: Vec<String>,
    /// Index of the way in which the answer is typed, among the ways of the slot.
    pub way: usize,
    /// Index of the present field.
    pub field: usize,
    /// Whether a name was begun by the sign for names.
    pub naming: bool,
    /// Index of the field with an error.
    pub fault: Option<usize>,
}

impl Typed {
    /// The text typed into a field.
    pub fn text(&self, field: usize) -> &str {
        self.texts.get(field).map_or("", String::as_str)
    }

    /// The text typed into a field, to be changed.
    pub fn text_mut(&mut self, field: usize) -> &mut String {
        let count = self.texts.len().max(field + 1);
        self.texts.resize(count, String::new());
        &mut self.texts[field]
    }

    /// Whether no text is typed or begun.
    pub fn is_empty(&self) -> bool {
        !self.naming && self.way == 0 && self.is_blank(self.texts.len())
    }

    /// Whether the first `count` fields are empty.
    pub fn is_blank(&self, count: usize) -> bool {
        self.texts.iter().take(count).all(String::is_empty)
    }
}

impl SlotState {
    /// Whether no answer was given and no text typed yet.
    pub fn is_empty(&self) -> bool {
        self.is_unbegun() && !self.is_typing()
    }

    /// Whether no answer, place or edge was given yet.
    pub(super) fn is_unbegun(&self) -> bool {
        self.answers.is_empty() && self.places.is_empty() && self.chain.is_empty()
    }

    /// The part made last; `None` once the next part is begun.
    pub(super) fn newest(&self) -> Option<Item> {
        self.made.filter(|_| self.is_unbegun())
    }

    /// Whether a number or a name is being typed.
    pub fn is_typing(&self) -> bool {
        !self.typed.is_empty()
    }

    /// The sheet of the last place.
    pub fn sheet(&self) -> Option<SheetId> {
        self.last_place().map(|placed| placed.sheet)
    }

    /// Answers so far.
    pub fn given(&self) -> &[Answer] {
        &self.answers
    }

    /// The last place.
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

/// The present slot.
pub(super) fn slot<'t>(tool: &'t SlotTool, state: &SlotState) -> &'t Slot {
    let last = tool.slots.len() - 1;
    &tool.slots[state.answers.len().min(last)]
}

/// Whether a tool needs no further answers.
pub(super) fn is_complete(tool: &SlotTool, answers: &[Answer]) -> bool {
    let ends = matches!(answers.last(), Some(Answer::Numbers(_)));
    ends || answers.len() >= tool.slots.len()
}

/// The default answer of a number slot.
pub(super) fn usual(slot: &Slot) -> Option<Answer> {
    match slot.kind {
        SlotKind::Number { usual, .. } | SlotKind::Numbers { usual, .. } => {
            Some(Answer::Number(usual.into()))
        }
        _ => None,
    }
}
