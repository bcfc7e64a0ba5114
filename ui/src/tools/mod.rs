//! Tools: small state machines that turn canvas events into edits. They read the document and produce
//! edits, and are independent of the GUI toolkit.
//!
//! # Decided with
//! - [`crate::tools::slots::SlotTool`]: tools that are given one thing after another;
//! - [`crate::tools::draw`], [`crate::tools::arc`], [`crate::tools::ring`]: draw on a sheet;
//! - [`crate::tools::panel`], [`crate::tools::alter`], [`crate::tools::parts`], [`crate::tools::seam`]: work
//!   on panels, alter them, move parts, sew;
//! - [`crate::tools::select`] (`drag`), [`crate::tools::rounding::rounded_place`], [`crate::tools::walk`]:
//!   drags, and the round numbers they keep to; a seam walked;
//! - [`crate::app::ToileApp::follow_outcome`] (`perform.rs`), [`toile_session::Session::preview`]
//!   (`gesture.rs`), [`toile_session::Session::commit`] (`gesture.rs`): outcomes of tools carried out; a
//!   preview and its end;
//! - [`crate::views::pattern::PatternView::follow`], [`crate::app::ToileApp::refresh`]: the preview drawn;
//!   checks wait until it is over;
//! - [`crate::tools::refusal::refuse`]: refusals in words;
//! - [`toile_pattern::plan`]: the edits it gives.
//!
//! By hand: `step`, `overlay` and `hint` name pairs of tool and state.

mod along;
pub mod alter;
mod answering;
pub mod arc;
mod composed;
pub mod draw;
mod finished;
mod list;
mod newest;
pub mod number;
pub mod panel;
pub mod parts;
mod planning;
mod refusal;
pub mod ring;
mod rounding;
pub mod seam;
pub(crate) mod select;
mod slot_overlay;
mod slot_steps;
pub mod slots;
mod tangent;
mod toward;
pub mod typing;
pub mod walk;

pub use along::{corner_words, is_on_fold, scaled};
pub use finished::finished_words;
pub use planning::Planning;
pub use select::SelectState;
pub use walk::WalkState;

use crate::canvas::fill::Fill;
use crate::canvas::hit::Hit;
use crate::canvas::placed::Placed;
use crate::canvas::scene::Scene;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::table_layout::TableLayout;
use slots::{SlotState, SlotTool};
use toile_geometry::Vec2;
use toile_pattern::{EdgeId, Edit, Evaluation, PanelId, SheetId};

/// Position of the pointer, and the parts there.
#[derive(Clone, Debug, PartialEq)]
pub struct Pointer {
    /// Position on the table (m).
    pub table: Vec2,
    /// The sheet that a tool draws on there.
    pub sheet: SheetId,
    /// Position on that sheet (m).
    pub at: Vec2,
    /// Parts there, the likeliest first.
    pub hits: Vec<Hit>,
    /// Candidate places for a point there, the best first; never empty.
    pub snaps: Vec<Placed>,
    /// Width of a pixel (m).
    pub pixel: f64,
    /// Modifier keys that are held.
    pub modifiers: ToolModifiers,
}

/// Modifier keys that change the behaviour of a tool while they are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ToolModifiers {
    /// Shift: restricts to horizontal, vertical or steps of 15 degrees; adds to the selection.
    pub shift: bool,
    /// Ctrl (Cmd): turns snapping off.
    pub command: bool,
}

impl Pointer {
    /// The snapping place with a number, counted from the best; the exact position while snapping is off.
    pub fn placed(&self, number: usize) -> Placed {
        match self.modifiers.command {
            true => Placed::free(self.sheet, self.at),
            false => self.snaps[number % self.snaps.len()].clone(),
        }
    }

    /// The likeliest part there.
    pub fn hit(&self) -> Option<Hit> {
        self.hits.first().copied()
    }
}

/// An event on the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The pointer has moved, with no button held.
    Hover(Pointer),
    /// The pointer has left.
    Leave,
    /// The pointer moves with the button held: where it was pressed, and where it is now.
    Drag(Pointer, Pointer),
    /// The button is released after a drag.
    Drop,
    /// A click.
    Click(Pointer),
    /// A double click.
    DoubleClick(Pointer),
    /// Typed text.
    Text(String),
    /// Backspace: deletes the last typed character.
    Backspace,
    /// Enter: accepts the present answer.
    Enter,
    /// Escape: one step back.
    Escape,
    /// Tab: the next field, the next snapping place, or the other side.
    Tab,
    /// Moves along the seam that is walked.
    Go(LineStep),
}

/// A key press that moves along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStep {
    /// A step back.
    Back,
    /// A step forward.
    On,
    /// To the start.
    ToStart,
    /// To the end.
    ToEnd,
}

/// A tool's read access to the pattern.
#[derive(Clone, Copy)]
pub struct Reading<'a> {
    /// The evaluated pattern without the gesture that is being previewed.
    pub evaluation: &'a Evaluation,
    /// The scene.
    pub scene: &'a Scene,
    /// Positions of sheets and panels on the table.
    pub table_layout: &'a TableLayout,
    /// Selected parts.
    pub selection: &'a Selection,
    /// The current sheet, for input without a pointer position.
    pub sheet: Option<SheetId>,
    /// Finds the parts inside a rectangle of the table (m).
    pub inside: &'a dyn Fn([Vec2; 2]) -> Vec<Item>,
}

/// A mark drawn over the pattern by a tool.
#[derive(Clone, Debug, PartialEq)]
pub enum Overlay {
    /// A line on a sheet.
    Line(SheetId, Vec<Vec2>),
    /// A place on a sheet.
    Dot(SheetId, Vec2),
    /// An edge of a panel.
    Edge(PanelId, EdgeId),
    /// Text beside a place on a sheet.
    Words(SheetId, Vec2, String),
    /// Error in the typed text, above a place on a sheet.
    Fault(SheetId, Vec2, String),
    /// A rectangle of the table.
    Box([Vec2; 2]),
    /// A piece that is laid on the table while a tool is in hand: its rings (m), and its fill.
    Ghost(Vec<Vec<Vec2>>, Fill),
    /// A line on the table.
    Stroke(Vec<Vec2>, Tone),
    /// A mark on a line of the table.
    Pip(Vec2, Tone),
    /// Point on the table where two pieces touch.
    Touch(Vec2),
    /// Text beside a place on the table.
    Label(Vec2, String, Tone),
}

/// Kind of a message or mark; it is expressed in words too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Neither good nor bad.
    Plain,
    /// As it should be.
    Good,
    /// Needs attention.
    Warning,
    /// Wrong.
    Fault,
}

/// A change of the preview: edits that are shown but not made yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PreviewChange {
    /// The preview stays as it is.
    #[default]
    Same,
    /// No preview: the document as it is.
    Nothing,
    /// The document with these edits.
    Edits(Vec<Edit>),
}

/// The outcome of an event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Change of the preview.
    pub shown: PreviewChange,
    /// Edits to make as one step of the history, and its name.
    pub commit: Option<(Vec<Edit>, String)>,
    /// Name under which the previewed edits are made as one step of the history.
    pub commit_shown: Option<String>,
    /// New selection.
    pub select: Option<Selection>,
    /// Reason why something was refused.
    pub refusal: Option<String>,
    /// Whether the tool made a step forward or back: an earlier refusal is obsolete then.
    pub gets_on: bool,
    /// Whether the tool is put down.
    pub done: bool,
}

/// A tool in hand.
#[derive(Clone, Copy, Debug)]
pub enum Tool {
    /// Selects, moves, divides.
    Select,
    /// Collects answers to slots in order, then makes its plan.
    Slots(&'static SlotTool),
    /// Walks the selected seam.
    Walk,
}

/// State of a tool.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// State of [`Tool::Select`].
    Select(SelectState),
    /// State of [`Tool::Slots`].
    Slots(Box<SlotState>),
    /// State of [`Tool::Walk`].
    Walk(WalkState),
}

impl Default for State {
    fn default() -> Self {
        Self::Select(SelectState::default())
    }
}

impl Tool {
    /// The initial state.
    pub fn begin(self) -> State {
        match self {
            Self::Select => State::default(),
            Self::Slots(_) => State::Slots(Box::default()),
            Self::Walk => State::Walk(WalkState::default()),
        }
    }

    /// The state after an event, and the outcome.
    pub fn step(self, state: &State, event: &Event, reading: &Reading<'_>) -> (State, Outcome) {
        match (self, state) {
            (Self::Select, State::Select(state)) => {
                let (state, outcome) = select::step(state, event, reading);
                (State::Select(state), outcome)
            }
            (Self::Slots(tool), State::Slots(state)) => {
                let (state, outcome) = slot_steps::step(tool, state, event, reading);
                (State::Slots(Box::new(state)), outcome)
            }
            (Self::Walk, State::Walk(state)) => {
                let (state, outcome) = walk::step(state, event, reading);
                (State::Walk(state), outcome)
            }
            // The state belongs to another tool: starts anew.
            _ => self.step(&self.begin(), event, reading),
        }
    }

    /// Marks that the tool draws over the pattern.
    pub fn overlay(self, state: &State, reading: &Reading<'_>) -> Vec<Overlay> {
        match (self, state) {
            (Self::Select, State::Select(state)) => select::overlay(state, reading),
            (Self::Slots(tool), State::Slots(state)) => slot_overlay::overlay(tool, state, reading),
            (Self::Walk, State::Walk(state)) => walk::overlay(state, reading),
            _ => Vec::new(),
        }
    }

    /// Hint on the effect of a click, and on the keys that change it.
    pub fn hint(self, state: &State, reading: &Reading<'_>) -> String {
        match (self, state) {
            (Self::Select, State::Select(state)) => select::hint(state, reading),
            (Self::Slots(tool), State::Slots(state)) => slot_overlay::hint(tool, state, reading),
            (Self::Walk, State::Walk(state)) => walk::hint(state, reading),
            _ => String::new(),
        }
    }

    /// Whether it is in progress, so that Escape goes one step back instead of putting it down.
    pub fn is_under_way(self, state: &State) -> bool {
        match state {
            State::Select(state) => *state != SelectState::default(),
            State::Slots(state) => !state.is_empty(),
            State::Walk(state) => state.is_typing(),
        }
    }

    /// Whether it handles digits, Tab and further keys.
    pub fn takes_keys(self) -> bool {
        !matches!(self, Self::Select)
    }
}

/// The selection after a click on a part; with `adds` (Shift) the part is added or removed.
fn chosen(selection: &Selection, item: Option<Item>, adds: bool) -> Selection {
    match (item, adds) {
        (Some(item), true) => {
            let mut selection = selection.clone();
            selection.toggle(item);
            selection
        }
        (Some(item), false) => Selection::one(item),
        (None, true) => selection.clone(),
        (None, false) => Selection::default(),
    }
}
