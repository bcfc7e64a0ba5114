//! Tools: small state machines that turn canvas events into edits. They read the document and produce
//! edits, and are independent of the GUI toolkit.
//!
//! # Decided with
//! - [`crate::tools::slots::SlotTool`]: tools that are given one thing after another;
//! - [`crate::tools::draw`], [`crate::tools::arc`], [`crate::tools::ring`], [`crate::tools::compass`]: draw on
//!   a sheet;
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
pub mod compass;
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

/// Position of the pointer, and the parts and places found there.
#[derive(Clone, Debug, PartialEq)]
pub struct Pointer {
    /// Position on the table (m).
    pub table: Vec2,
    /// The sheet on which a tool draws at this position.
    pub sheet: SheetId,
    /// Position on that sheet (m).
    pub at: Vec2,
    /// Parts at the position, the likeliest first.
    pub hits: Vec<Hit>,
    /// Candidate places for a point at the position, the best first; never empty.
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
    /// The snapping place with an index, counted from the best; while snapping is off, the exact position.
    pub fn placed(&self, number: usize) -> Placed {
        match self.modifiers.command {
            true => Placed::free(self.sheet, self.at),
            false => self.snaps[number % self.snaps.len()].clone(),
        }
    }

    /// The likeliest part at the position.
    pub fn hit(&self) -> Option<Hit> {
        self.hits.first().copied()
    }
}

/// An event on the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The pointer has moved, with no button held.
    Hover(Pointer),
    /// The pointer has left the canvas.
    Leave,
    /// The pointer moves with the button held: pointer when the button was pressed, and pointer now.
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
    /// Tab: goes to the next field, the next snapping place, or the other side of a seam.
    Tab,
    /// A key that moves along the walked seam.
    Go(LineStep),
}

/// Movement along a line by a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStep {
    /// One step toward the start.
    Back,
    /// One step toward the end.
    On,
    /// To the start of the line.
    ToStart,
    /// To the end of the line.
    ToEnd,
}

/// A tool's read access to the pattern.
#[derive(Clone, Copy)]
pub struct Reading<'a> {
    /// The evaluated pattern without the gesture that is being previewed.
    pub evaluation: &'a Evaluation,
    /// The scene of the pattern, as the canvas draws it.
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
    /// A polyline on a sheet.
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
    /// Preview of a piece laid on the table, such as the piece moved along a walked seam: its rings (m),
    /// and its fill.
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
    /// Neutral.
    Plain,
    /// The state is as it should be.
    Good,
    /// The state needs attention.
    Warning,
    /// The state is an error.
    Fault,
}

/// A change of the preview: edits that are shown but not made yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PreviewChange {
    /// The preview stays unchanged.
    #[default]
    Same,
    /// No preview: the document is shown without edits.
    Nothing,
    /// The document is shown with these edits.
    Edits(Vec<Edit>),
}

/// The outcome of an event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Change of the preview.
    pub shown: PreviewChange,
    /// Edits to make as one step of the history, and the name of the step.
    pub commit: Option<(Vec<Edit>, String)>,
    /// Name of the step in the history that makes the previewed edits.
    pub commit_shown: Option<String>,
    /// New selection.
    pub select: Option<Selection>,
    /// Reason why an input was refused.
    pub refusal: Option<String>,
    /// Whether the tool made a step forward or back; an earlier refusal is cleared then.
    pub gets_on: bool,
    /// Whether the tool is finished, and Select is taken in hand.
    pub done: bool,
}

/// A tool in hand.
#[derive(Clone, Copy, Debug)]
pub enum Tool {
    /// Selects, moves, divides.
    Select,
    /// Collects answers to the slots of a tool in order, then makes the plan of the tool.
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

    /// The state of the tool after an event, and the outcome of the event.
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
            // The state belongs to another tool: this tool starts anew.
            _ => self.step(&self.begin(), event, reading),
        }
    }

    /// Marks that the tool draws over the pattern now.
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

    /// Whether the tool is in progress: then Escape goes one step back, instead of putting the tool down.
    pub fn is_under_way(self, state: &State) -> bool {
        match state {
            State::Select(state) => *state != SelectState::default(),
            State::Slots(state) => !state.is_empty(),
            State::Walk(state) => state.is_typing(),
        }
    }

    /// Whether the tool handles digits, Tab and further keys.
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
