//! Tools: small state machines from what is done at the canvas to edits. They know the document's
//! reading side and edits, never the toolkit of the window.

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

/// Where the pointer is and what is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Pointer {
    /// Its place on the table (m).
    pub table: Vec2,
    /// The sheet that is drawn on there.
    pub sheet: SheetId,
    /// Its place on that sheet (m).
    pub at: Vec2,
    /// Parts there, the likeliest first.
    pub hits: Vec<Hit>,
    /// Places a point could have there, the best first; never empty.
    pub snaps: Vec<Placed>,
    /// Width of a pixel (m).
    pub pixel: f64,
    /// Keys that are held.
    pub modifiers: ToolModifiers,
}

/// Modifier keys that change the behaviour of a tool while they are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ToolModifiers {
    /// Keeps level, upright or at 15 degrees; adds to the selection.
    pub shift: bool,
    /// Turns snapping off.
    pub command: bool,
}

impl Pointer {
    /// The best place, or any other that was asked for by its number; anywhere while snapping is
    /// off.
    pub fn placed(&self, number: usize) -> Placed {
        match self.modifiers.command {
            true => Placed::free(self.sheet, self.at),
            false => self.snaps[number % self.snaps.len()].clone(),
        }
    }

    /// The most wanted part there.
    pub fn hit(&self) -> Option<Hit> {
        self.hits.first().copied()
    }
}

/// Something that is done at the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The pointer is somewhere, no button held.
    Hover(Pointer),
    /// The pointer has left.
    Leave,
    /// The button is pressed and moved: where it was pressed, and where it is.
    Drag(Pointer, Pointer),
    /// It is let go of after a drag.
    Drop,
    /// A click.
    Click(Pointer),
    /// A double click.
    DoubleClick(Pointer),
    /// Typed text.
    Text(String),
    /// The last typed character is taken back.
    Backspace,
    /// What stands is taken.
    Enter,
    /// One step back.
    Escape,
    /// The next number, the next snap, or the other side.
    Tab,
    /// On or back along what the tool walks.
    Go(LineStep),
}

/// A step along a line, by a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStep {
    /// A step back.
    Back,
    /// A step on.
    On,
    /// To the start.
    ToStart,
    /// To the end.
    ToEnd,
}

/// What a tool sees of the pattern.
#[derive(Clone, Copy)]
pub struct Reading<'a> {
    /// Every value, as before the gesture.
    pub evaluation: &'a Evaluation,
    /// How it is seen.
    pub scene: &'a Scene,
    /// Where it lies on the table.
    pub table_layout: &'a TableLayout,
    /// What is selected.
    pub selection: &'a Selection,
    /// The sheet that is drawn on where the pointer does not say which.
    pub sheet: Option<SheetId>,
    /// What lies inside a rectangle of the table (m).
    pub inside: &'a dyn Fn([Vec2; 2]) -> Vec<Item>,
}

/// Something drawn over the pattern by a tool.
#[derive(Clone, Debug, PartialEq)]
pub enum Overlay {
    /// A line on a sheet.
    Line(SheetId, Vec<Vec2>),
    /// A place on a sheet.
    Dot(SheetId, Vec2),
    /// An edge of a panel.
    Edge(PanelId, EdgeId),
    /// Words beside a place on a sheet.
    Words(SheetId, Vec2, String),
    /// What is wrong with what is typed, over a place on a sheet.
    Fault(SheetId, Vec2, String),
    /// A rectangle of the table.
    Box([Vec2; 2]),
    /// A piece that is laid on the table while a tool is in hand: its rings (m), and what they enclose.
    Ghost(Vec<Vec<Vec2>>, Fill),
    /// A line on the table.
    Stroke(Vec<Vec2>, Tone),
    /// A mark on a line of the table.
    Pip(Vec2, Tone),
    /// Where two pieces touch, on the table.
    Touch(Vec2),
    /// Words beside a place of the table.
    Label(Vec2, String, Tone),
}

/// How something that is told is to be taken. It is told in words too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Neither good nor bad.
    Plain,
    /// As it should be.
    Good,
    /// To be looked at.
    Warning,
    /// Wrong.
    Fault,
}

/// A change of the preview: edits that are shown but not yet made.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PreviewChange {
    /// As before.
    #[default]
    Same,
    /// The document as it is.
    Nothing,
    /// The document with these edits.
    Edits(Vec<Edit>),
}

/// The outcome of an event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// What is shown.
    pub shown: PreviewChange,
    /// Edits to make as one step of the history, and its name.
    pub commit: Option<(Vec<Edit>, String)>,
    /// What is shown is made a step of the history of this name.
    pub commit_shown: Option<String>,
    /// What is selected from now on.
    pub select: Option<Selection>,
    /// Why something was not done.
    pub refusal: Option<String>,
    /// The tool came a step on or back: what was refused before is of no matter any more.
    pub gets_on: bool,
    /// The tool is put down.
    pub done: bool,
}

/// A tool in hand.
#[derive(Clone, Copy, Debug)]
pub enum Tool {
    /// Selects, moves, divides.
    Select,
    /// Is given one thing after another, then does its work.
    Slots(&'static SlotTool),
    /// Walks the selected seam.
    Walk,
}

/// How far a tool has come.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// Of [`Tool::Select`].
    Select(SelectState),
    /// Of [`Tool::Slots`].
    Slots(Box<SlotState>),
    /// Of [`Tool::Walk`].
    Walk(WalkState),
}

impl Default for State {
    fn default() -> Self {
        Self::Select(SelectState::default())
    }
}

impl Tool {
    /// The state it begins with.
    pub fn begin(self) -> State {
        match self {
            Self::Select => State::default(),
            Self::Slots(_) => State::Slots(Box::default()),
            Self::Walk => State::Walk(WalkState::default()),
        }
    }

    /// The state after an event, and what comes of it.
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
            // A state of another tool: begin anew.
            _ => self.step(&self.begin(), event, reading),
        }
    }

    /// What is drawn over the pattern.
    pub fn overlay(self, state: &State, reading: &Reading<'_>) -> Vec<Overlay> {
        match (self, state) {
            (Self::Select, State::Select(state)) => select::overlay(state, reading),
            (Self::Slots(tool), State::Slots(state)) => slot_overlay::overlay(tool, state, reading),
            (Self::Walk, State::Walk(state)) => walk::overlay(state, reading),
            _ => Vec::new(),
        }
    }

    /// What a click does now, and which keys change it.
    pub fn hint(self, state: &State, reading: &Reading<'_>) -> String {
        match (self, state) {
            (Self::Select, State::Select(state)) => select::hint(state, reading),
            (Self::Slots(tool), State::Slots(state)) => slot_overlay::hint(tool, state, reading),
            (Self::Walk, State::Walk(state)) => walk::hint(state, reading),
            _ => String::new(),
        }
    }

    /// Whether it has begun, so that Escape goes a step back and does not put it down.
    pub fn is_under_way(self, state: &State) -> bool {
        match state {
            State::Select(state) => *state != SelectState::default(),
            State::Slots(state) => !state.is_empty(),
            State::Walk(state) => state.is_typing(),
        }
    }

    /// Whether numbers, Tab and its other keys go to it.
    pub fn takes_keys(self) -> bool {
        !matches!(self, Self::Select)
    }
}

/// A part that a click chooses: with Shift it is added or taken away.
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
