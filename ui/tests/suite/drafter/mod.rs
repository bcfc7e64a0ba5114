//! A window that is drafted in by raw events, with its actions counted: an action is a click, a whole
//! drag, a key or chord, or a typed field with the Enter or Tab that ends it.

mod counted;

use egui::{Key, Modifiers, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::WgpuTestRenderer;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{CurveId, Evaluation, Pattern, Stage};
use toile_ui::{Beginning, ToileApp};

/// A window with its actions counted.
pub struct Drafter {
    /// The window.
    pub window: Harness<'static, ToileApp>,
    /// What was done.
    pub actions: usize,
    /// Every raw input but drags, a line each, so that they can be replayed with a mouse and keys on a
    /// display: `click X Y`, `hover X Y` and `wheel X Y` (down by a notch) in pixels, `key CHORD` and
    /// `text TEXT`.
    pub inputs: Vec<String>,
    /// How many of the typed fields had not the keys before, so that a hand clicks into them first.
    pub reached: usize,
}

impl Drafter {
    pub fn new() -> Self {
        Self::begun(Beginning::default())
    }

    /// A window with a pattern that is shipped.
    pub fn opened(name: &str) -> Self {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns");
        Self::begun(Beginning {
            file: Some(folder.join(format!("{name}.toile.json"))),
            folder: None,
        })
    }

    /// A window with a new pattern whose one panel "draft" is a rectangle, 20 cm wide and 30 cm high.
    pub fn with_panel(pattern: &str) -> Self {
        let mut drafter = Self::new();
        drafter.press("New pattern");
        drafter.enter("Name", pattern);
        drafter.key(Key::R);
        drafter.click(drafter.place(0.0, 0.0));
        drafter.click(drafter.place(0.2, 0.3));
        drafter.key(Key::Escape);
        drafter.key(Key::Escape);
        drafter
    }

    pub fn begun(beginning: Beginning) -> Self {
        Self::of_size(vec2(1400.0, 900.0), beginning, None)
    }

    /// A window of a size (logical pixels), drawn by a renderer if there is one.
    pub fn of_size(
        size: egui::Vec2,
        beginning: Beginning,
        renderer: Option<WgpuTestRenderer>,
    ) -> Self {
        let mut builder = Harness::builder()
            .with_size(size)
            .with_theme(egui::Theme::Light)
            .with_max_steps(20)
            .with_step_dt(1.0 / 60.0);
        if let Some(renderer) = renderer {
            builder = builder.renderer(renderer);
        }
        let mut window = builder.build_eframe(move |creation| {
            let state = creation.wgpu_render_state.as_ref();
            ToileApp::new(&creation.egui_ctx, state, beginning)
        });
        window.run();
        Self {
            window,
            actions: 0,
            inputs: Vec::new(),
            reached: 0,
        }
    }

    pub fn pattern(&self) -> Pattern {
        (*self.window.state().session().project().pattern).clone()
    }

    pub fn evaluation(&self) -> Evaluation {
        let project = self.window.state().session().project();
        Evaluation::new(&project.pattern, project.drafted_to())
    }

    /// The first panel as it is after all its operations.
    pub fn stage(&self) -> Arc<Stage> {
        let pattern = self.pattern();
        let evaluation = self.evaluation();
        evaluation.last_stage(&pattern.panels[0]).unwrap().clone()
    }

    /// Length of a drawn edge of the first panel as it is after all its operations (m).
    pub fn finished_length(&self, name: &str) -> f64 {
        let pattern = self.pattern();
        let edge = pattern.panels[0].edges().find(|edge| edge.name == name);
        let edge = toile_pattern::Name::Drawn(edge.unwrap().id);
        let stage = self.stage();
        let own = stage.outline().iter().filter(|found| found.name == edge);
        own.map(|found| found.curve.length()).sum()
    }

    /// How many steps the history has.
    pub fn steps(&self) -> usize {
        self.window.state().session().past().len()
    }

    /// Presses a button or an entry of a menu that is open.
    pub fn press(&mut self, name: &str) {
        self.click_on(Role::Button, name);
    }

    /// Clicks in the middle of something that is seen.
    fn click_on(&mut self, role: Role, name: &str) {
        let found = self.window.get_by_role_and_label(role, name);
        self.click(found.rect().center());
    }

    /// Clicks a tick of the inspector.
    pub fn tick(&mut self, name: &str) {
        self.click_on(Role::CheckBox, name);
    }

    pub fn key(&mut self, key: Key) {
        self.chord(Modifiers::NONE, key);
    }

    pub fn chord(&mut self, modifiers: Modifiers, key: Key) {
        self.actions += 1;
        self.note_key(modifiers, key);
        self.window.key_press_modifiers(modifiers, key);
        self.window.run();
    }

    fn note_key(&mut self, modifiers: Modifiers, key: Key) {
        let held = [(modifiers.command, "ctrl+"), (modifiers.shift, "shift+")];
        let held = held.map(|(is_held, word)| if is_held { word } else { "" });
        let name = match key {
            Key::Enter => "Return".to_owned(),
            Key::Escape | Key::Tab | Key::Delete => format!("{key:?}"),
            _ => key.name().to_owned(),
        };
        // A letter alone names its key; a capital would be one with Shift.
        let name = match name.len() {
            1 => name.to_lowercase(),
            _ => name,
        };
        self.inputs.push(format!("key {}{name}", held.concat()));
    }

    /// Types text where the keys go, and takes it.
    pub fn typed(&mut self, text: &str) {
        self.typed_and(text, Key::Enter);
    }

    /// Types text where the keys go, and ends it by a key: Enter, or Tab to go on to the next.
    pub fn typed_and(&mut self, text: &str, end: Key) {
        self.type_text(text);
        self.note_key(Modifiers::NONE, end);
        self.window.key_press(end);
        self.window.run();
    }

    /// Types text into the field of a name, and goes on to the next field by Tab.
    pub fn enter_on(&mut self, field: &str, text: &str) {
        self.reach(field);
        self.typed_and(text, Key::Tab);
    }

    /// Gives the keys to the field of a name, by a click that belongs to the field unless it has
    /// them already.
    fn reach(&mut self, field: &str) {
        self.scroll_to(field);
        let found = self.window.get_by_role_and_label(Role::TextInput, field);
        if !found.is_focused() {
            self.reached += 1;
            self.click_on(Role::TextInput, field);
            self.actions -= 1;
        }
    }

    /// Turns the wheel over the tables until a field of theirs is seen, as a hand does. Turning the
    /// wheel is pointing.
    fn scroll_to(&mut self, field: &str) {
        for _ in 0..100 {
            let found = self.window.get_by_role_and_label(Role::TextInput, field);
            let at = found.rect().center();
            let low = self.window.ctx.content_rect().bottom() - 40.0;
            if at.y < low {
                return;
            }
            let place = Pos2::new(at.x, low).round();
            self.inputs.push(format!("wheel {} {}", place.x, place.y));
            self.window.hover_at(place);
            self.window.event(egui::Event::MouseWheel {
                unit: egui::MouseWheelUnit::Line,
                delta: vec2(0.0, -1.0),
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: Modifiers::NONE,
            });
            self.window.run();
        }
        panic!("{field:?} is out of reach");
    }

    /// Types text into the field of a name, and takes it.
    pub fn enter(&mut self, field: &str, text: &str) {
        self.reach(field);
        self.typed(text);
    }

    pub fn click(&mut self, at: Pos2) {
        self.actions += 1;
        let at = at.round();
        self.inputs.push(format!("click {} {}", at.x, at.y));
        self.window.hover_at(at);
        self.window.run();
        self.window.drag_at(at);
        self.window.drop_at(at);
        self.window.run();
    }

    /// A click with Shift held.
    pub fn shift_click(&mut self, at: Pos2) {
        let held = egui::Event::ModifiersChanged;
        self.window.event(held(Modifiers::SHIFT));
        self.click(at);
        self.window.event(held(Modifiers::NONE));
        self.window.run();
    }

    /// A drag from a place to another, the button still held.
    pub fn begin_drag(&mut self, from: Pos2, to: Pos2) {
        self.window.hover_at(from);
        self.window.run();
        self.window.drag_at(from);
        self.window.run();
        for share in [0.3, 0.7, 1.0] {
            self.window.hover_at(from + (to - from) * share);
            self.window.run();
        }
    }

    /// A drag from a place to another.
    pub fn drag(&mut self, from: Pos2, to: Pos2) {
        self.actions += 1;
        self.begin_drag(from, to);
        self.window.drop_at(to);
        self.window.run();
    }

    pub fn hover(&mut self, at: Pos2) {
        let at = at.round();
        self.inputs.push(format!("hover {} {}", at.x, at.y));
        self.window.hover_at(at);
        self.window.run();
    }

    /// Where a named part is seen.
    pub fn part(&self, name: &str) -> Pos2 {
        let part = self.window.get_by_role_and_label(Role::Button, name);
        part.rect().center()
    }

    /// A place of the first sheet on the screen.
    pub fn place(&self, x: f64, y: f64) -> Pos2 {
        let view = self.window.get_by_label("Pattern view").rect();
        let view_state = self.window.state().view();
        let origin = view_state.sheet_origin();
        view_state.screen(view, origin, Vec2::new(x, y))
    }

    /// Where a curve is seen farthest from all points, which would be chosen before it.
    pub fn along(&self, curve: CurveId) -> Pos2 {
        let evaluation = self.evaluation();
        let path = evaluation.curve(curve).unwrap();
        let pattern = self.pattern();
        let points = pattern.sheets[0].points.iter();
        let points: Vec<Vec2> = points.filter_map(|p| evaluation.point(p.id)).collect();
        let away = |at: &Vec2| {
            let all = points.iter().map(|point| (point - at).norm());
            all.fold(f64::INFINITY, f64::min)
        };
        let places = (1..20).map(|k| path.length() * f64::from(k) / 20.0);
        let at = places
            .map(|along| path.point(path.at_length(along).unwrap()))
            .max_by(|a, b| away(a).total_cmp(&away(b)))
            .unwrap();
        self.place(at.x, at.y)
    }

    pub fn point(&self, name: &str) -> Vec2 {
        let pattern = self.pattern();
        let found = pattern
            .sheets
            .iter()
            .find_map(|sheet| sheet.point_named(name));
        self.evaluation().point(found.unwrap().id).unwrap()
    }
}

impl Drafter {
    /// What the status line says.
    pub fn status(&self) -> String {
        let labels = self.window.query_all_by_role(Role::Label);
        labels
            .filter_map(|label| label.value())
            .collect::<Vec<_>>()
            .join(" | ")
    }
}

impl Drafter {
    /// Types text where the keys go.
    pub fn type_text(&mut self, text: &str) {
        self.inputs.push(format!("text {text}"));
        self.window.event(egui::Event::Text(text.into()));
        self.window.run();
        self.actions += 1;
    }

    /// Ticks a box.
    pub fn enter_choice(&mut self, name: &str) {
        self.click_on(Role::CheckBox, name);
    }

    /// Keeps the inputs so far, and the file that was saved last, for `.ci/window.py`, which gives
    /// them to the window on a display. The folder that was saved to is left open there.
    pub fn keep_way(&self, name: &str, folder: &std::path::Path) {
        let kept = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        let open = |text: &str| text.replace(&folder.display().to_string(), "{folder}");
        let lines: Vec<String> = self.inputs.iter().map(|line| open(line)).collect();
        std::fs::write(kept.join(format!("{name}.way")), lines.join("\n") + "\n").unwrap();
        let source = self.window.state().session().project().source.clone();
        let end = kept.join(format!("{name}.toile.json"));
        std::fs::copy(source.unwrap(), end).unwrap();
    }

    /// Waits for work that goes on beside the window.
    pub fn wait(&mut self, done: impl Fn(&Self) -> bool) {
        for _ in 0..6000 {
            if done(self) {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(10));
            self.window.run_steps(1);
        }
        panic!("it never ended: {}", self.status());
    }
}
