//! Somebody who goes by the guide: what its tables say is typed and clicked in the window.

pub mod text;

use crate::drafter::Drafter;
use crate::screens::{Colours, Part, Screens};
use egui::{Key, Modifiers, Pos2, Rect, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use std::collections::BTreeSet;
use text::Section;
use toile_geometry::Vec2;
use toile_pattern::Panel;
use toile_ui::Beginning;

/// Somebody who goes by the guide.
pub struct Reader {
    pub drafter: Drafter,
    pub screens: Option<Screens>,
    /// Pictures that were made.
    pub shown: BTreeSet<&'static str>,
    /// Names that were seen in the window.
    pub seen: BTreeSet<String>,
}

impl Reader {
    pub fn new() -> Self {
        let (screens, renderer) = Screens::asked().unzip();
        let drafter = Drafter::of_size(vec2(1200.0, 800.0), Beginning::default(), renderer);
        Self {
            drafter,
            screens,
            shown: BTreeSet::new(),
            seen: BTreeSet::new(),
        }
    }

    /// Makes a picture of a part of the window; notes what is named in it.
    pub fn picture(&mut self, name: &'static str, part: Option<Rect>) {
        self.shown.insert(name);
        self.look();
        if let Some(screens) = &self.screens {
            let window = &mut self.drafter.window;
            let is_shaded = part.is_none() && window.query_by_label_contains("3D view").is_some();
            let colours = if is_shaded {
                Colours::All
            } else {
                Colours::Few
            };
            screens.write(name, &[Part::of(window, part)], colours);
        }
    }

    pub fn picture_of_tables(&mut self, name: &'static str) {
        let tab = self.drafter.window.get_by_label("Measurements").rect();
        let tables = Rect::from_min_max(pos2(0.0, tab.top() - 6.0), pos2(700.0, 766.0));
        self.picture(name, Some(tables));
    }

    /// Notes the names that stand in the window now.
    pub fn look(&mut self) {
        let nodes = self.drafter.window.query_all_by(|_| true);
        for node in nodes {
            let node = node.accesskit_node();
            self.seen
                .extend([node.label(), node.value()].into_iter().flatten());
        }
    }

    pub fn view(&self) -> Rect {
        self.drafter.window.get_by_label("Pattern view").rect()
    }

    /// Escape until no tool is in hand and nothing is selected.
    pub fn put_down(&mut self) {
        for _ in 0..4 {
            self.drafter.key(Key::Escape);
        }
    }

    /// Draws the upper rim of the tables upward, and turns back to their first row.
    pub fn enlarge_tables(&mut self) {
        let tab = self.drafter.window.get_by_label("Measurements").rect();
        let rim = pos2(600.0, tab.top() - 2.0);
        self.drafter.drag(rim, pos2(600.0, 130.0));
        let window = &mut self.drafter.window;
        window.hover_at(pos2(300.0, 700.0));
        window.run();
        for _ in 0..40 {
            window.event(egui::Event::MouseWheel {
                unit: egui::MouseWheelUnit::Line,
                delta: vec2(0.0, 1.0),
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: Modifiers::NONE,
            });
            window.run();
        }
        window.hover_at(pos2(600.0, 20.0));
        window.run();
    }

    pub fn point(&mut self, sheet: &str, name: &str) {
        let at = self.drafter.part(&format!("Point {name} of {sheet}"));
        self.drafter.click(at);
    }

    pub fn edge(&mut self, panel: &str, name: &str) {
        let at = self.on_edge(panel, name, None);
        self.drafter.click(at);
    }

    /// Where an edge of a panel is seen: farthest from all points, which would be chosen before it, on
    /// the half at a corner if one is given.
    pub fn on_edge(&self, panel: &str, edge: &str, corner: Option<&str>) -> Pos2 {
        let pattern = self.drafter.pattern();
        let evaluation = self.drafter.evaluation();
        let panel: &Panel = pattern.panel_named(panel).unwrap();
        let sheet = pattern.sheet(panel.sheet().unwrap()).unwrap();
        let points = sheet.points.iter();
        let points: Vec<Vec2> = points.filter_map(|p| evaluation.point(p.id)).collect();
        let corner = corner.map(|name| {
            evaluation
                .point(sheet.point_named(name).unwrap().id)
                .unwrap()
        });
        let edge = panel.edges().find(|found| found.name == edge).unwrap();
        let path = evaluation.curve(edge.curve).unwrap();
        let place = |k: i32| path.at_length(path.length() * f64::from(k) / 40.0).unwrap();
        let mut places: Vec<Vec2> = (1..40).map(|k| path.point(place(k))).collect();
        if let Some(corner) = corner {
            places.sort_by(|a, b| (a - corner).norm().total_cmp(&(b - corner).norm()));
            places.truncate(15);
        }
        let away = |at: &Vec2| {
            let all = points.iter().map(|point| (point - at).norm());
            all.fold(f64::INFINITY, f64::min)
        };
        let at = places
            .into_iter()
            .max_by(|a, b| away(a).total_cmp(&away(b)))
            .unwrap();
        let view = self.drafter.window.state().view();
        view.screen(self.view(), view.table_layout.panel(panel.id), at)
    }

    /// Points by coordinates.
    pub fn draw_points(&mut self, part: Section, number: usize) {
        self.drafter.key(Key::P);
        for row in part.table("point | x | y", number) {
            let [name, x, y] = row[..] else {
                panic!("{row:?}");
            };
            self.drafter.typed_and(&begun(x), Key::Tab);
            self.drafter.typed_and(&begun(y), Key::Tab);
            self.drafter.typed(name);
            self.has_point(name);
        }
        self.drafter.key(Key::Home);
    }

    /// Points from others.
    pub fn draw_points_from(&mut self, part: Section, sheet: &str) {
        self.drafter.key(Key::U);
        for row in part.table("point | from | length | angle", 0) {
            let [name, from, length, angle] = row[..] else {
                panic!("{row:?}");
            };
            self.drafter.key(Key::Home);
            self.point(sheet, from);
            self.drafter.typed_and(&begun(length), Key::Tab);
            self.drafter.typed_and(&begun(angle), Key::Tab);
            self.drafter.type_text(name);
            if name == "dart_high" {
                self.picture("point", None);
            }
            self.drafter.key(Key::Enter);
            self.has_point(name);
        }
    }

    pub fn has_point(&self, name: &str) {
        let pattern = self.drafter.pattern();
        let sheet = pattern.sheets.last().unwrap();
        let found = sheet.point_named(name).is_some();
        assert!(found, "{name}: {}", self.drafter.status());
    }

    pub fn draw_lines(&mut self, part: Section, sheet: &str) {
        self.drafter.key(Key::L);
        let mut last = "";
        for row in part.table("line | from | to", 0) {
            let [name, from, to] = row[..] else {
                panic!("{row:?}");
            };
            if from != last {
                self.drafter.key(Key::Escape);
                self.drafter.key(Key::L);
                self.point(sheet, from);
            }
            self.drafter.type_text(&format!("'{name}"));
            self.point(sheet, to);
            self.has_curve(name);
            last = to;
        }
    }

    pub fn draw_curves(&mut self, part: Section, sheet: &str) {
        self.drafter.key(Key::C);
        let head = "curve | from | to | x at from | y at from | x at to | y at to";
        for row in part.table(head, 0) {
            let [name, from, to, x, y, last_x, last_y] = row[..] else {
                panic!("{row:?}");
            };
            self.point(sheet, from);
            self.drafter.type_text(&format!("'{name}"));
            self.point(sheet, to);
            self.drafter.key(Key::Enter);
            self.has_curve(name);
            for number in [x, y, last_x] {
                self.drafter.typed_and(&begun(number), Key::Tab);
            }
            self.drafter.typed(&begun(last_y));
            if (sheet, name) == ("draft", "armhole") {
                self.picture("curve", None);
            }
        }
    }

    pub fn has_curve(&self, name: &str) {
        let pattern = self.drafter.pattern();
        let found = pattern.sheets.last().unwrap().curve_named(name);
        assert!(found.is_some(), "{name}: {}", self.drafter.status());
    }

    /// Makes a panel of the lines round a place of the sheet that is drawn on.
    pub fn trace(&mut self, part: Section, [x, y]: [f64; 2], name: &str) {
        self.drafter.key(Key::T);
        self.drafter.click(self.drafter.place(x, y));
        self.drafter.enter("Name", part.says(name));
        self.drafter.enter("seam allowance", part.says("1.5"));
        let pattern = self.drafter.pattern();
        let panel = pattern.panels.last().unwrap();
        assert_eq!(panel.name, name, "{}", self.drafter.status());
    }

    /// Allowances of neck, armhole and hem of a panel.
    pub fn allow(&mut self, part: Section, panel: &str) {
        self.drafter.key(Key::V);
        self.edge(panel, "armhole");
        let neck = self.on_edge(panel, "neck", None);
        self.drafter.shift_click(neck);
        self.look();
        self.drafter.enter("seam allowance of all", part.says("1"));
        self.edge(panel, "hem");
        self.drafter.enter("seam allowance", part.says("4"));
        self.choose("Corner of allowance", "mirrored, as a hem");
    }

    /// Chooses from a list; of a dialog's and the window's that of the dialog.
    pub fn choose(&mut self, list: &str, choice: &str) {
        let window = &self.drafter.window;
        let found = window.query_all_by_role_and_label(Role::ComboBox, list);
        let at = found.last().unwrap().rect().center();
        self.drafter.click(at);
        self.look();
        let at = self.drafter.window.get_by_label(choice).rect().center();
        self.drafter.click(at);
    }
}

/// What is typed for a number: a formula begins with an equals sign.
fn begun(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(_) => text.to_owned(),
        Err(_) => format!("={text}"),
    }
}
