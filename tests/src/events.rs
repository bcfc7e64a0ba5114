//! Random events on the window's tools and its session, without a display: what is refused leaves
//! the document as it was, no number of it is other than finite, the journal replayed gives the
//! same document, and everything can be undone and done again.

use crate::random::Random;
use crate::root;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use toile_geometry::Vec2;
use toile_interchange::{read_pattern, write_pattern};
use toile_measure::Measurements;
use toile_pattern::{Edit, Evaluation, PartId, Pattern, plan};
use toile_session::{Command, Session, Silent};
use toile_ui::{
    Beginning, Item, Menu, Overlay, Pointer, ToileApp, ToolEvent, ToolModifiers, UiCommand,
    commands, named,
};

/// Events of one run: fewer than a history and a journal keep.
pub const EVENTS: usize = 500;
/// What runs begin with in turn: the patterns that ship, and the empty document.
const STARTS: [Option<&str>; 6] = [
    None,
    Some("t-shirt"),
    Some("trousers"),
    None,
    Some("gathered-skirt"),
    Some("poncho"),
];
/// Commands that ask for files or begin work on a thread, which goes on beside the events.
const LEFT_OUT: [&str; 2] = ["Search marker", "Dark or light"];
/// Commands that are given as often as all others together: undo, and tools that must be given much.
const OFTEN: [&str; 11] = [
    "Undo",
    "Undo",
    "Redo",
    "Delete",
    "Dart",
    "Dart",
    "Pivot dart",
    "Spread",
    "Seam",
    "Fold",
    "Inner line",
];
/// Every how many changes the file is read back.
const READ_BACK: usize = 10;
/// Events that are told when something does not hold.
const TOLD: usize = 12;
/// Parts a document may have before new ones are no longer drawn: copies of everything double it at every turn.
const MAX_PARTS: usize = 600;
/// Kinds of parts that are pointed at.
const KINDS: [fn(&Item) -> bool; 6] = [
    |item| matches!(item, Item::Point(_)),
    |item| matches!(item, Item::Edge(..)),
    |item| matches!(item, Item::Edge(..)),
    |item| matches!(item, Item::Curve(_)),
    |item| matches!(item, Item::Operation(..)),
    |item| matches!(item, Item::Panel(_) | Item::Notch(..)),
];
/// Numbers, formulas and rubbish as they are typed.
const TEXTS: [&str; 30] = [
    "12",
    "3,5",
    "2.5",
    "30",
    "45",
    "90",
    "-7",
    "0",
    "0.5",
    "1",
    "=hips / 4 + 1cm",
    "waist/2",
    "1 5/8in",
    "10%",
    "2mm",
    "if(1 < 2, 3cm, 4cm)",
    "max(1cm,",
    "length(",
    "length(front)",
    "1/0",
    "sqrt(-1)",
    "1e999",
    "1e308",
    "-1e-300",
    "nan",
    "inf",
    "((((((((",
    "\u{1f9f5}",
    " ",
    "12 12 ..,,",
];

/// [`EVENTS`] random events by a seed, then everything undone and done again; the journal is
/// replayed into a folder.
///
/// # Errors
/// What does not hold, with the seed and the latest events.
pub fn events(seed: u64, folder: &Path) -> Result<(), String> {
    let start = STARTS[seed as usize % STARTS.len()];
    let mut run = Run::new(seed, start)?;
    let told = |run: &Run, number: usize, what: String| {
        let latest: Vec<&str> = run.latest.iter().map(|event| &**event).collect();
        let start = start.unwrap_or("empty");
        format!(
            "{start}, seed {seed}, event {number}: {what}; the latest events:\n  {}",
            latest.join("\n  ")
        )
    };
    for number in 0..EVENTS {
        match catch_unwind(AssertUnwindSafe(|| run.event())) {
            Ok(Ok(())) => {}
            Ok(Err(what)) => return Err(told(&run, number, what)),
            Err(_) => return Err(told(&run, number, "a panic".to_owned())),
        }
    }
    match catch_unwind(AssertUnwindSafe(|| run.end(folder))) {
        Ok(done) => done.map_err(|what| told(&run, EVENTS, what)),
        Err(_) => Err(told(&run, EVENTS, "a panic at the end".to_owned())),
    }
}

/// The document as its file. The counter of ids, which an undo does not set back, is left out.
fn uncounted(pattern: &Pattern) -> Result<String, String> {
    let mut pattern = pattern.clone();
    pattern.ids.next = u32::MAX / 2;
    write_pattern(&pattern).map_err(|error| error.to_string())
}

/// A number of the document that is not finite, with what stands round it.
fn not_finite(pattern: &Pattern) -> Option<String> {
    // Cloth without a limit of stretch has an infinite one.
    let printed = format!("{pattern:?}").replace("strain_limit: [inf, inf]", "");
    let mut is_text = false;
    let mut before = ' ';
    for (at, c) in printed.char_indices() {
        if c == '"' && before != '\\' {
            is_text = !is_text;
        }
        let rest = &printed[at..];
        let begins = !before.is_alphanumeric() && before != '_';
        if !is_text
            && begins
            && ["NaN", "inf,", "inf]", "inf)", "inf "]
                .iter()
                .any(|n| rest.starts_with(n))
        {
            let from = printed[..at]
                .char_indices()
                .rev()
                .nth(160)
                .map_or(0, |(k, _)| k);
            return Some(printed[from..at + 3].to_owned());
        }
        before = match before {
            '\\' => ' ',
            _ => c,
        };
    }
    None
}

/// A window that is worked on.
struct Run {
    app: ToileApp,
    random: Random,
    latest: VecDeque<String>,
    /// The document before the present event, and as its file.
    known: Pattern,
    text: String,
    changes: usize,
    /// Events that the tool in hand is given before anything else is done.
    answers: usize,
    /// Where a drag began, while one goes on.
    pressed: Option<Pointer>,
    at_first: String,
}

impl Run {
    fn new(seed: u64, start: Option<&str>) -> Result<Self, String> {
        let file = start.map(|name| root().join(format!("patterns/{name}.toile.json")));
        let beginning = Beginning { file, folder: None };
        let mut app = ToileApp::new(&egui::Context::default(), None, beginning);
        if start.is_none() {
            let name = "Random".to_owned();
            app.execute(Command::NewPattern { name });
        }
        let known = app.base().pattern().clone();
        if known.sheets.is_empty() {
            return Err(format!("{start:?} is not open: {:?}", app.fault()));
        }
        Ok(Self {
            text: write_pattern(&known).map_err(|error| error.to_string())?,
            at_first: uncounted(&known)?,
            app,
            random: Random(seed),
            latest: VecDeque::new(),
            known,
            changes: 0,
            answers: 0,
            pressed: None,
        })
    }

    /// One event, and what must hold after it.
    fn event(&mut self) -> Result<(), String> {
        if let Some(from) = self.pressed.clone() {
            self.drag_on(from);
        } else if self.answers > 0 {
            // A tool that was just taken in hand is given what it asks for.
            self.answers -= 1;
            match self.random.percent(75) {
                true => self.click(),
                false => self.key(),
            }
        } else {
            match self.random.below(100) {
                0..18 => {
                    let pointer = self.pointer();
                    self.give(ToolEvent::Hover(pointer));
                }
                18..40 => self.click(),
                40..53 => {
                    let from = self.pointer();
                    self.pressed = Some(from.clone());
                    self.drag_on(from);
                }
                53..63 => self.key(),
                63..91 => self.command(),
                91 => self.size(),
                _ => self.number(),
            }
        }
        self.judge()
    }

    /// A drag goes on, or ends in one way or another.
    fn drag_on(&mut self, from: Pointer) {
        match self.random.below(10) {
            0..6 => {
                let to = match self.random.percent(80) {
                    true => {
                        let mut way = || self.random.between(-0.05, 0.05);
                        let table = from.table + Vec2::new(way(), way());
                        self.app.view().pointer(table, from.modifiers)
                    }
                    false => self.pointer(),
                };
                self.give(ToolEvent::Drag(from, to));
            }
            6..9 => {
                self.pressed = None;
                self.give(ToolEvent::Drop);
            }
            _ => self.key(),
        }
    }

    fn give(&mut self, event: ToolEvent) {
        let words = match &event {
            ToolEvent::Hover(at) => format!("hover {:?}", at.table),
            ToolEvent::Click(at) => {
                format!("click {:?} on {:?}", at.table, at.hit().map(|hit| hit.item))
            }
            ToolEvent::DoubleClick(at) => format!("double click {:?}", at.table),
            ToolEvent::Drag(from, to) => format!(
                "drag from {:?} ({:?}) to {:?}",
                from.table,
                from.hit().map(|hit| hit.item),
                to.table
            ),
            other => format!("{other:?}"),
        };
        self.tell(words);
        self.app.give(&event);
    }

    fn tell(&mut self, words: String) {
        if self.latest.len() == TOLD {
            self.latest.pop_front();
        }
        self.latest.push_back(words);
    }

    /// A pointer at a part of any kind or anywhere, seldom very far away.
    fn pointer(&mut self) -> Pointer {
        let mut parts = self.app.view().parts();
        let kind = self.random.one_of(&KINDS).copied().unwrap_or(KINDS[0]);
        if parts.iter().any(|(_, item, _)| kind(item)) {
            parts.retain(|(_, item, _)| kind(item));
        }
        let table = match self.random.one_of(&parts) {
            Some((_, _, at)) if self.random.percent(70) => {
                let away = if self.random.percent(50) { 0.004 } else { 0.0 };
                let mut jitter = || self.random.between(-away, away);
                at + Vec2::new(jitter(), jitter())
            }
            _ => {
                let far = if self.random.percent(3) { 1e5 } else { 1.2 };
                let mut place = || self.random.between(-far, far);
                Vec2::new(place(), place())
            }
        };
        let modifiers = ToolModifiers {
            shift: self.random.percent(15),
            command: self.random.percent(5),
        };
        self.app.view().pointer(table, modifiers)
    }

    fn click(&mut self) {
        self.pressed = None;
        let pointer = self.pointer();
        // A click comes after the pointer has come there.
        self.app.give(&ToolEvent::Hover(pointer.clone()));
        let event = match self.random.percent(6) {
            true => ToolEvent::DoubleClick(pointer),
            false => ToolEvent::Click(pointer),
        };
        self.give(event);
    }

    fn key(&mut self) {
        let event = match self.random.below(20) {
            0..8 => {
                let text = self.random.one_of(&TEXTS).copied().unwrap_or("1");
                ToolEvent::Text(text.to_owned())
            }
            8..14 => ToolEvent::Enter,
            14..16 => ToolEvent::Tab,
            16 => ToolEvent::Backspace,
            17 | 18 => ToolEvent::Escape,
            _ => ToolEvent::Leave,
        };
        if event == ToolEvent::Escape {
            self.pressed = None;
        }
        self.give(event);
    }

    /// A command of the menus: a tool in hand, undo, delete and the like.
    fn command(&mut self) {
        let wanted = |command: &&UiCommand| {
            !matches!(command.menu, Menu::File | Menu::Garment) && !LEFT_OUT.contains(&command.name)
        };
        let all: Vec<&UiCommand> = commands().filter(wanted).collect();
        let often = self.random.one_of(&OFTEN).and_then(|name| named(name));
        let command = match self.random.percent(50) {
            true => often,
            false => self.random.one_of(&all).copied(),
        };
        let Some(command) = command.filter(|command| (command.when)(&self.app)) else {
            return;
        };
        let doubles = ["Paste", "Duplicate"].contains(&command.name);
        if doubles && self.app.base().pattern().parts().len() > MAX_PARTS {
            return;
        }
        self.pressed = None;
        self.tell(format!("command {}", command.name));
        (command.does)(&mut self.app);
        if matches!(command.menu, Menu::Draw | Menu::Panel | Menu::Sew) {
            self.answers = self.random.below(10);
        }
    }

    /// Another size, one there is not among them.
    fn size(&mut self) {
        let sizes = &self.app.base().pattern().sizes;
        let mut names: Vec<Option<String>> = sizes.iter().map(|s| Some(s.name.clone())).collect();
        names.extend([None, Some("of nobody".to_owned())]);
        let size = self.random.one_of(&names).cloned().flatten();
        self.pressed = None;
        self.tell(format!("size {size:?}"));
        self.app.execute(Command::SetSize { size });
    }

    /// What the inspector and the tables do: a number typed, a part removed, renamed, a size more
    /// or less.
    fn number(&mut self) {
        let planned = self.planned();
        self.pressed = None;
        match planned {
            Some(edits) => {
                let label = "Change".to_owned();
                self.app.execute(Command::Edit { edits, label });
            }
            None => self.tell("refused by a planner".to_owned()),
        }
    }

    fn planned(&mut self) -> Option<Vec<Edit>> {
        let evaluation: Evaluation = self.app.base().clone();
        let pattern = evaluation.pattern();
        let parts: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
        let part = *self.random.one_of(&parts)?;
        let text = self.random.one_of(&TEXTS).copied()?;
        let size = self.random.one_of(&pattern.sizes).map(|size| size.id);
        let kind = self.random.below(10);
        self.tell(format!("change {kind} of {part:?} with {text:?}"));
        let planned = match kind {
            0..5 => {
                let entries = plan::numbers_of(&evaluation, part);
                let entry = self.random.one_of(&entries)?;
                let want = entry.want;
                match self.random.below(6) {
                    0 => plan::clear_number(&evaluation, &entry.place),
                    1 => plan::adjust_number(
                        &evaluation,
                        &entry.place,
                        self.random.between(-1.0, 1.0),
                    ),
                    2 => {
                        let value = self.random.between(-0.1, 0.5);
                        plan::set_number_in_size(&evaluation, &entry.place, (size?, Some(value)))
                    }
                    _ => plan::read_number(&evaluation, text, want)
                        .and_then(|number| plan::set_number(&evaluation, &entry.place, number)),
                }
            }
            5 => Ok(vec![Edit::Remove(part)]),
            6 => plan::remove_parts(&evaluation, &[part]),
            7 => plan::rename(&evaluation, part, text),
            8 => {
                let table = Measurements::default();
                plan::add_size(&evaluation, Some(text), table).map(|done| done.0)
            }
            _ => plan::remove_size(&evaluation, size?),
        };
        planned.ok()
    }

    /// What holds after every event.
    fn judge(&mut self) -> Result<(), String> {
        let app = &self.app;
        let _ = app.view().hint(app.base());
        for overlay in app.view().overlay(app.base()) {
            if let Overlay::Line(_, points) = &overlay
                && points
                    .iter()
                    .any(|at| !at.x.is_finite() || !at.y.is_finite())
            {
                return Err(format!("drawn at no place: {overlay:?}"));
            }
        }
        let pattern = app.base().pattern();
        if !app.session().is_previewing() && *app.session().project().pattern != *pattern {
            return Err("the window sees another document than the session has".to_owned());
        }
        if *pattern == self.known {
            return Ok(());
        }
        if let Some(found) = not_finite(pattern) {
            return Err(format!("not finite: {found}"));
        }
        let text = write_pattern(pattern).map_err(|error| error.to_string())?;
        if let Some(fault) = app.fault().filter(|_| text != self.text) {
            return Err(format!("refused and changed all the same: {fault}"));
        }
        self.changes += 1;
        if self.changes.is_multiple_of(READ_BACK) {
            let read = read_pattern(&text).map_err(|error| format!("the file: {error}"))?;
            let again = write_pattern(&read.0).map_err(|error| error.to_string())?;
            if again != text {
                return Err("the file read and written again is another".to_owned());
            }
        }
        self.known = pattern.clone();
        self.text = text;
        Ok(())
    }

    /// What holds after all events.
    fn end(&mut self, folder: &Path) -> Result<(), String> {
        self.app.give(&ToolEvent::Escape);
        self.app.execute(Command::Check);
        self.judge()?;
        let journal = self.app.session().journal();
        let (replayed, _) = Session::replay(&journal, folder, &mut Silent)
            .map_err(|error| format!("replayed: {error}"))?;
        let replayed =
            write_pattern(&replayed.project().pattern).map_err(|error| error.to_string())?;
        if replayed != self.text {
            return Err("replayed it is another document".to_owned());
        }
        let at_last = uncounted(&self.known)?;
        let steps = self.app.session().past().len();
        self.travel("Undo", steps)?;
        if uncounted(self.app.base().pattern())? != self.at_first {
            return Err("all undone it is not as at first".to_owned());
        }
        self.travel("Redo", steps)?;
        if uncounted(self.app.base().pattern())? != at_last {
            return Err("all done again it is not as at last".to_owned());
        }
        Ok(())
    }

    fn travel(&mut self, name: &str, steps: usize) -> Result<(), String> {
        let command = named(name).ok_or("no such command")?;
        for step in 0..steps {
            if !(command.when)(&self.app) {
                return Err(format!(
                    "{name}: nothing more after {step} of {steps} steps"
                ));
            }
            (command.does)(&mut self.app);
            if let Some(fault) = self.app.fault() {
                return Err(format!("{name}: {fault}"));
            }
        }
        Ok(())
    }
}
