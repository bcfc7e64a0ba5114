//! Every slot of every tool, from the tools' own lists, given a number, a formula and a name by keys alone:
//! what is typed comes to the document to a nanometre, or is refused with the field named. Nothing is
//! swallowed, and no key of it changes a view or a tool.

use crate::drafter::Drafter;
use egui::{Event, Key, Modifiers};
use std::fmt::Write;
use toile_geometry::Vec2;
use toile_pattern::{PartId, Pattern, Want, plan};
use toile_session::Command;
use toile_ui::{
    Answer, Pointer, SlotKind, SlotTool, ToileApp, Tool, ToolEvent, ToolModifiers, ToolState,
    commands,
};

/// What is typed for lengths (cm), angles (degrees) and plain numbers, and how much that is.
const LENGTH: (&str, f64) = ("7.31", 0.0731);
const ANGLE: (&str, f64) = ("37.3", 37.3);
const PLAIN: (&str, f64) = ("2", 2.0);
/// A formula, and the length it is: the waist is 72 cm.
const FORMULA: (&str, f64) = ("=waist/9 - 0.69", 0.0731);
const NAME: &str = "'zeugma";
/// A place on the line that is drawn across a panel, nearer to its end.
const ACROSS: Vec2 = Vec2::new(0.66, 0.13);
/// How near what is typed the document comes.
const NEAR: f64 = 1e-9;

#[test]
fn what_is_typed_for_any_slot_is_in_the_document_or_refused_with_its_field() {
    let mut table = Table::new();
    let mut rows = 0;
    let mut report = String::new();
    for command in commands().filter(|command| may_take_tool(command.name)) {
        let before = table.drafter.pattern();
        table.take(command.does);
        let Some(tool) = table.tool().filter(|tool| tool.command == command.name) else {
            panic!("{} takes no tool in hand", command.name);
        };
        for slot in 0..tool.slots.len() {
            for (typed, value) in texts(tool.slots[slot].kind) {
                for end in [Key::Enter, Key::Tab, Key::Escape] {
                    let row = Row {
                        tool,
                        slot,
                        typed,
                        value,
                        end,
                    };
                    let came_to = table.try_row(command.does, &row);
                    let named = &tool.slots[slot].hint;
                    if let Err(words) = came_to {
                        let _ = writeln!(
                            report,
                            "{} | {named} | {typed} {end:?}: {words}",
                            tool.command
                        );
                    }
                    table.restore(&before);
                    rows += 1;
                }
            }
        }
    }
    assert!(rows > 500, "{rows} rows");
    assert!(report.is_empty(), "of {rows} rows:\n{report}");
}

/// Whether a command takes a tool of slots in hand.
fn may_take_tool(name: &str) -> bool {
    use toile_ui::Menu::{Draw, Panel, Sew};
    let others = [
        "Select",
        "New sheet",
        "Flip seam",
        "Select seam",
        "Walk seam",
        "Suggested seams",
    ];
    let command = toile_ui::named(name).unwrap();
    matches!(command.menu, Draw | Panel | Sew) && !others.contains(&name)
}

/// What is typed into a slot, and how much it is in the units of the document.
fn texts(kind: SlotKind) -> [(&'static str, Option<f64>); 3] {
    let (number, formula) = match kind {
        SlotKind::Number {
            want: Want::Angle, ..
        } => (ANGLE, ("=30deg + 7.3deg", 37.3)),
        SlotKind::Number {
            want: Want::Plain, ..
        }
        | SlotKind::Numbers { .. } => (PLAIN, ("=4 / 2", 2.0)),
        _ => (LENGTH, FORMULA),
    };
    [
        (number.0, Some(number.1)),
        (formula.0, Some(formula.1)),
        (NAME, None),
    ]
}

struct Row {
    tool: &'static SlotTool,
    slot: usize,
    typed: &'static str,
    value: Option<f64>,
    end: Key,
}

struct Table {
    drafter: Drafter,
}

impl Table {
    /// A window with a panel that has a dart, one that is sewn to it, and a line drawn across that.
    fn new() -> Self {
        let mut drafter = Drafter::new();
        drafter.press("New pattern");
        drafter.enter("Name", "Table");
        drafter.key(Key::F8);
        drafter.press("Add size");
        drafter.enter("Waist girth", "72");
        drafter.key(Key::F8);
        drafter.key(Key::R);
        for [x, y, width, height] in [["0", "0", "30", "40"], ["40", "0", "31", "41"]] {
            drafter.typed_and(x, Key::Tab);
            drafter.typed(y);
            drafter.typed_and(width, Key::Tab);
            drafter.typed(height);
        }
        drafter.key(Key::Home);
        drafter.key(Key::D);
        drafter.click(drafter.part("Edge top of draft"));
        drafter.typed("3");
        drafter.typed("6");
        drafter.key(Key::L);
        drafter.typed_and("36", Key::Tab);
        drafter.typed("13");
        drafter.typed_and("#76", Key::Tab);
        drafter.typed("13");
        drafter.key(Key::S);
        drafter.click(drafter.part("Edge right of draft"));
        drafter.click(drafter.place(0.4, 0.3));
        for _ in 0..4 {
            drafter.key(Key::Escape);
        }
        drafter.key(Key::Home);
        // What is not looked at takes no time.
        drafter.key(Key::F7);
        drafter.key(Key::Home);
        let pattern = drafter.pattern();
        assert_eq!((pattern.panels.len(), pattern.seams.len()), (2, 1));
        let line = pattern.sheets[0].curves.last().unwrap();
        let path = drafter.evaluation().curve(line.id).unwrap().clone();
        let away = (path.point(path.nearest(ACROSS).unwrap()) - ACROSS).norm();
        assert!(away < 1e-3, "{away}");
        Self { drafter }
    }

    fn tool(&self) -> Option<&'static SlotTool> {
        match self.drafter.window.state().view().tool {
            Tool::Slots(tool) => Some(tool),
            _ => None,
        }
    }

    /// Takes a tool in hand, the first panel selected.
    fn take(&mut self, does: fn(&mut ToileApp)) {
        self.put_down();
        self.click(Vec2::new(0.08, 0.05));
        does(self.drafter.window.state_mut());
    }

    fn put_down(&mut self) {
        let select = toile_ui::named("Select").unwrap();
        (select.does)(self.drafter.window.state_mut());
    }

    /// A click at a place of the sheet (m).
    fn click(&mut self, at: Vec2) {
        let pointer = self.pointer(at);
        self.event(&ToolEvent::Click(pointer));
    }

    fn pointer(&self, at: Vec2) -> Pointer {
        let view = self.drafter.window.state().view();
        view.pointer(view.sheet_origin() + at, ToolModifiers::default())
    }

    /// Gives the tool an event, as the canvas does.
    fn event(&mut self, event: &ToolEvent) {
        self.drafter.window.state_mut().give(event);
    }

    /// How many things the tool was given.
    fn given(&self) -> usize {
        match &self.drafter.window.state().view().state {
            ToolState::Slots(state) => state.given().len(),
            _ => 0,
        }
    }

    /// Where the pointer gives a slot something: of each kind of thing one after another.
    fn site(tool: &SlotTool, slot: usize) -> Vec2 {
        let count = |is: fn(&SlotKind) -> bool| {
            let before = tool.slots[..slot].iter();
            before.filter(|slot| is(&slot.kind)).count()
        };
        let place = |k: usize| Vec2::from([[0.06, 0.08], [0.21, 0.17], [0.1, 0.2]][k.min(2)]);
        match tool.slots[slot].kind {
            SlotKind::Place(_) | SlotKind::Named(_) | SlotKind::Places | SlotKind::Inside => {
                let earlier = |kind: &SlotKind| {
                    matches!(
                        kind,
                        SlotKind::Place(_) | SlotKind::Named(_) | SlotKind::Places
                    )
                };
                place(count(earlier))
            }
            SlotKind::OnLine => {
                let x = [0.3, 0.0][count(|kind| matches!(kind, SlotKind::OnLine))];
                Vec2::new(x, 0.12)
            }
            SlotKind::Edge | SlotKind::Chain => {
                let x = match (tool.slots[slot].kind, slot) {
                    (_, 0) => 0.0,
                    (SlotKind::Chain, _) => 0.71,
                    _ => 0.3,
                };
                Vec2::new(x, 0.22)
            }
            SlotKind::Operation => Vec2::new(0.1425, 0.37),
            SlotKind::Curve | SlotKind::End => ACROSS,
            SlotKind::Panel => Vec2::new(0.08, 0.05),
            SlotKind::Number { .. } | SlotKind::Numbers { .. } => place(2),
        }
    }

    /// Gives a slot something by the pointer, or the number it has at first.
    fn give(&mut self, tool: &SlotTool, slot: usize) {
        let at = Self::site(tool, slot);
        match tool.slots[slot].kind {
            SlotKind::Number { .. } | SlotKind::Numbers { .. } => self.event(&ToolEvent::Enter),
            SlotKind::Places => {
                self.click(at);
                self.click(Vec2::new(0.2, 0.27));
                self.event(&ToolEvent::Enter);
            }
            _ => self.click(at),
        }
    }

    fn try_row(&mut self, does: fn(&mut ToileApp), row: &Row) -> Result<(), String> {
        self.take(does);
        for slot in 0..row.slot {
            self.give(row.tool, slot);
        }
        if self.given() != row.slot {
            return Err(format!("{} given: {}", self.given(), self.drafter.status()));
        }
        let at = Self::site(row.tool, row.slot);
        let before = Seen::of(&self.drafter);
        match row.end {
            Key::Enter => {
                self.drafter.hover(self.drafter.place(at.x, at.y));
                self.keys(row.typed);
            }
            _ => {
                let pointer = self.pointer(at);
                self.event(&ToolEvent::Hover(pointer));
                self.event(&ToolEvent::Text(row.typed.into()));
            }
        }
        let view = self.drafter.window.state().view();
        if self.tool().map(|tool| tool.command) != Some(row.tool.command) {
            return Err("another tool was taken".into());
        }
        if (view.camera.scale, view.camera.centre) != before.camera {
            return Err("the view changed".into());
        }
        if !view.is_typing() {
            // Refused at once, with what is asked for instead.
            let fault = self.drafter.window.state().fault().unwrap_or_default();
            let hint = row.tool.slots[row.slot].hint;
            return match fault.contains(hint) {
                true => Ok(()),
                false => Err(format!("swallowed: {fault:?}")),
            };
        }
        match row.end {
            Key::Escape => self.taken_back(row),
            Key::Tab => {
                self.event(&ToolEvent::Tab);
                self.event(&ToolEvent::Enter);
                self.finish(row, &before)
            }
            _ => {
                self.drafter.key(Key::Enter);
                self.finish(row, &before)
            }
        }
    }

    /// Escape takes back what is typed and nothing else.
    fn taken_back(&mut self, row: &Row) -> Result<(), String> {
        let steps = self.drafter.steps();
        self.event(&ToolEvent::Escape);
        let is_as_before = self.given() == row.slot
            && !self.drafter.window.state().view().is_typing()
            && self.drafter.steps() == steps;
        match is_as_before {
            true => Ok(()),
            false => Err(format!("not taken back: {}", self.drafter.status())),
        }
    }

    /// What is typed was taken, or is refused; then the tool is given all else.
    fn finish(&mut self, row: &Row, before: &Seen) -> Result<(), String> {
        if let Some(fault) = self.drafter.window.state().fault() {
            let is_kept = self.drafter.window.state().view().is_typing();
            let labels = [
                "x", "y", "length", "radius", "angle", "width", "height", "distance", "number",
                "name",
            ];
            let own = match row.tool.slots[row.slot].kind {
                SlotKind::Number { label, .. } | SlotKind::Numbers { label, .. } => Some(label),
                _ => None,
            };
            let mut labels = labels.into_iter().chain(own);
            let is_named = labels.any(|label| fault.starts_with(&format!("{label}: ")));
            return match is_kept && is_named {
                true => Ok(()),
                false => Err(format!("refused, and lost or not named: {fault}")),
            };
        }
        let is_given = row.value.is_some_and(|value| self.is_given(value));
        if let SlotKind::Places = row.tool.slots[row.slot].kind {
            self.click(Vec2::new(0.2, 0.27));
            self.click(Vec2::new(0.07, 0.3));
            self.event(&ToolEvent::Enter);
        }
        if self.given() == row.slot + 1 {
            for slot in row.slot + 1..row.tool.slots.len() {
                self.give(row.tool, slot);
            }
        }
        self.drafter.window.step();
        let now = Seen::of(&self.drafter);
        // What only says where something is done is in what is done there.
        let says_where = [
            "Measure",
            "Move",
            "Turn",
            "Mirror",
            "Scale",
            "Grain",
            "Bend edge",
            "Trace",
        ];
        match row.value {
            None => named(&now, &self.drafter),
            Some(_)
                if says_where.contains(&row.tool.command)
                    && (is_given || !now.pattern.says_the_same(&before.pattern)) =>
            {
                Ok(())
            }
            Some(value) => now.came_to(before, value, (row, &self.drafter.status())),
        }
    }

    /// Whether the tool was given a place by a number.
    fn is_given(&self, value: f64) -> bool {
        let ToolState::Slots(state) = &self.drafter.window.state().view().state else {
            return false;
        };
        let places: Vec<Vec2> = state
            .given()
            .iter()
            .filter_map(|answer| match answer {
                Answer::Place(placed) | Answer::End(placed, ..) => Some(placed.at),
                _ => None,
            })
            .collect();
        let Some(last) = places.last() else {
            return false;
        };
        let apart = places.iter().map(|place| (last - place).norm());
        let mut found = apart.chain([last.x, last.y]);
        found.any(|found| (found - value).abs() < NEAR)
    }

    /// Presses the keys of a text as a keyboard does: each with its letter.
    fn keys(&mut self, text: &str) {
        for c in text.chars() {
            if let Some(key) = Key::from_name(&c.to_uppercase().to_string()) {
                self.drafter.window.event(Event::Key {
                    key,
                    physical_key: None,
                    pressed: true,
                    repeat: false,
                    modifiers: Modifiers::NONE,
                });
            }
            self.drafter.window.event(Event::Text(c.to_string()));
        }
        self.drafter.window.run();
    }

    /// Takes everything back.
    fn restore(&mut self, start: &Pattern) {
        self.put_down();
        for _ in 0..4 {
            if self.drafter.pattern().says_the_same(start) {
                return;
            }
            self.drafter.window.state_mut().execute(Command::Undo);
        }
        panic!("not taken back");
    }
}

/// Whether what was made has the name.
fn named(now: &Seen, drafter: &Drafter) -> Result<(), String> {
    let has_name = now.pattern.sheets.iter().any(|sheet| {
        let points = sheet.points.iter().map(|point| &*point.name);
        let curves = sheet.curves.iter().map(|curve| &*curve.name);
        points.chain(curves).any(|name| name.starts_with("zeugma"))
    });
    let panels = now.pattern.panels.iter();
    let mut names = panels.flat_map(|panel| {
        let lines = panel.lines.iter().map(|line| &*line.name);
        lines.chain([&*panel.name])
    });
    match has_name || names.any(|name| name == "zeugma") {
        true => Ok(()),
        false => Err(format!("the name is gone: {}", drafter.status())),
    }
}

/// What a document comes to.
struct Seen {
    pattern: Pattern,
    /// Enlargement and middle of the view.
    camera: (f64, Vec2),
    /// Lengths (m) and plain numbers in it.
    values: Vec<f64>,
    places: Vec<Vec2>,
    sides: Vec<Vec2>,
}

impl Seen {
    fn of(drafter: &Drafter) -> Self {
        let pattern = drafter.pattern();
        let evaluation = drafter.evaluation();
        let mut values = Vec::new();
        let mut places = Vec::new();
        for (part, _) in pattern.parts() {
            for entry in plan::numbers_of(&evaluation, part) {
                values.extend(
                    entry
                        .number
                        .and_then(|number| evaluation.number(&number, entry.want)),
                );
            }
            if let PartId::Point(id) = part {
                places.extend(evaluation.point(id));
            }
        }
        let mut sides = Vec::new();
        for panel in &pattern.panels {
            for notch in evaluation
                .last_stage(panel)
                .into_iter()
                .flat_map(|s| &s.notches)
            {
                places.push(notch.point);
            }
            for edge in panel.edges() {
                let ends = edge.ends.map(|end| evaluation.point(end));
                if let [Some(a), Some(b)] = ends {
                    sides.push(b - a);
                }
            }
        }
        let camera = drafter.window.state().view().camera;
        let camera = (camera.scale, camera.centre);
        Self {
            pattern,
            camera,
            values,
            places,
            sides,
        }
    }

    /// Whether something is as typed that was not before: a number, a coordinate, a distance, a direction, a
    /// factor, or as many parts.
    fn came_to(
        &self,
        before: &Self,
        typed: f64,
        (row, status): (&Row, &str),
    ) -> Result<(), String> {
        let is = |value: f64| (value.abs() - typed).abs() < NEAR;
        let measured = |seen: &Self| {
            let coordinates = seen.places.iter().flat_map(|at| [at.x, at.y]);
            let apart = seen
                .places
                .iter()
                .flat_map(|a| seen.places.iter().map(move |b| (b - a).norm()));
            let ways = seen
                .places
                .iter()
                .flat_map(|a| seen.places.iter().flat_map(move |b| [b.x - a.x, b.y - a.y]));
            let turned = seen.values.iter().flat_map(|value| {
                // An arc keeps the tangent of a quarter of its angle.
                [value.to_degrees(), 4.0 * value.atan().to_degrees()]
            });
            let all = seen.values.iter().copied().chain(coordinates).chain(apart);
            all.chain(ways)
                .chain(turned)
                .filter(|value| is(*value))
                .count()
        };
        let is_new = measured(self) > measured(before);
        // What is transformed is turned or scaled by it.
        let turns = self.sides.iter().zip(&before.sides).any(|(now, old)| {
            let turn = old.perp(now).atan2(old.dot(now)).to_degrees();
            is(turn) || is(now.norm() / old.norm())
        });
        let moved = self.places.iter().zip(&before.places);
        let mut moved = moved.map(|(now, old)| (now - old).norm());
        let counts = matches!(
            row.tool.slots[row.slot].kind,
            SlotKind::Number {
                want: Want::Plain,
                ..
            } | SlotKind::Numbers { .. }
        ) && !self.pattern.says_the_same(&before.pattern);
        let tells = status.contains("7.31 cm");
        match is_new || turns || moved.any(is) || counts || tells {
            true => Ok(()),
            false => Err(format!("not in the document: {status}")),
        }
    }
}
