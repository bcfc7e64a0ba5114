//! Guides: dragged out of the rulers, moved, snapped to, hidden, removed; kept with the pattern.
//!
//! Where `TOILE_SCREENS` names a folder and there is a graphics adapter, pictures by day and by night
//! are written there.

use crate::drafter::Drafter;
use crate::screens::{Colours, Part, Screens};
use egui::{Key, Modifiers, Pos2, Rect, Role, vec2};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;
use toile_pattern::{GuideRun, Point, PointRule};
use toile_session::{Command, Session, Silent};
use toile_ui::{Beginning, Overlay};

/// Key that shows and hides guides.
const SHOW: (Modifiers, Key) = (Modifiers::COMMAND, Key::Semicolon);

impl Drafter {
    fn empty() -> Self {
        let mut drafter = Self::new();
        drafter.press("New pattern");
        drafter.enter("Name", "Guided");
        drafter
    }

    /// The guides, each with where it lies (m).
    fn guides(&self) -> Vec<(GuideRun, f64)> {
        let pattern = self.pattern();
        let guides = pattern.guides.iter();
        guides.map(|guide| (guide.runs, guide.at)).collect()
    }

    fn rect(&self, name: &str) -> Rect {
        self.window.get_by_label(name).rect()
    }

    fn ruler(&self, name: &str) -> Pos2 {
        self.rect(name).center()
    }

    /// Drags a guide out of the top ruler to a height (m).
    fn level(&mut self, y: f64) {
        self.drag(self.ruler("Top ruler"), self.place(0.3, y));
    }

    /// Drags a guide out of the left ruler to a place so far to the right (m).
    fn upright(&mut self, x: f64) {
        self.drag(self.ruler("Left ruler"), self.place(x, 0.4));
    }

    /// The points that were drawn, in order.
    fn points(&self) -> Vec<Point> {
        let pattern = self.pattern();
        let points = pattern.sheets[0].points.iter();
        points.map(|point| (**point).clone()).collect()
    }

    fn last_place(&self) -> Vec2 {
        let id = self.points().last().unwrap().id;
        self.evaluation().point(id).unwrap()
    }

    /// What would be saved, but for the next id, which only counts up.
    fn said(&self) -> String {
        let saved = self.saved();
        let lines = saved.lines().filter(|line| !line.contains("\"next_id\""));
        lines.collect::<Vec<_>>().join("\n")
    }

    /// What the tool in hand says beside the pointer.
    fn told(&self) -> String {
        let view = self.window.state().view();
        let marks = view.overlay(&self.evaluation()).into_iter();
        let words = marks.filter_map(|mark| match mark {
            Overlay::Words(_, _, words) => Some(words),
            _ => None,
        });
        words.collect::<Vec<_>>().join(" | ")
    }

    fn undo(&mut self) {
        self.chord(Modifiers::COMMAND, Key::Z);
    }

    fn redo(&mut self) {
        self.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }

    fn entry(&mut self, menu: &str, name: &str) {
        self.window.get_by_label(menu).click();
        self.window.run();
        let entry = self.window.query_all_by_label(name).last().unwrap();
        entry.click();
        self.window.run();
    }

    fn is_seen(&self, name: &str) -> bool {
        let role = Role::Button;
        self.window.query_by_role_and_label(role, name).is_some()
    }
}

#[test]
fn a_guide_comes_out_of_a_ruler_and_goes_back_into_it() {
    let mut drafter = Drafter::empty();
    let empty = drafter.said();
    let to = drafter.place(0.3, 0.0512);
    drafter.begin_drag(drafter.ruler("Top ruler"), to);
    // While it is dragged nothing is in the document; the status says what else can be done.
    assert!(drafter.guides().is_empty());
    assert!(drafter.status().contains("ruler"), "{}", drafter.status());
    drafter.window.drop_at(to);
    drafter.window.run();
    assert_eq!(drafter.guides(), [(GuideRun::Horizontal, 0.05)]);
    drafter.upright(0.1);
    let both = [(GuideRun::Horizontal, 0.05), (GuideRun::Vertical, 0.1)];
    assert_eq!(drafter.guides(), both);
    assert!(drafter.is_seen("Horizontal guide 1") && drafter.is_seen("Vertical guide 1"));
    // One step of the history each, undone and redone to the same bytes.
    let full = drafter.saved();
    drafter.undo();
    drafter.undo();
    assert!(drafter.said() == empty);
    drafter.redo();
    drafter.redo();
    assert!(drafter.saved() == full);
    // It is moved with the Select tool, where nothing else is under the pointer.
    drafter.drag(drafter.place(0.4, 0.05), drafter.place(0.4, 0.12));
    assert_eq!(drafter.guides()[0], (GuideRun::Horizontal, 0.12));
    // Escape leaves it where it was.
    let away = drafter.place(0.4, 0.2);
    drafter.begin_drag(drafter.place(0.4, 0.12), away);
    drafter.window.key_press(Key::Escape);
    drafter.window.run();
    drafter.window.drop_at(away);
    drafter.window.run();
    assert_eq!(drafter.guides()[0], (GuideRun::Horizontal, 0.12));
    // Back on the ruler it is gone; and one that does not leave the ruler never was.
    let back = Pos2::new(drafter.place(0.4, 0.0).x, drafter.ruler("Top ruler").y);
    drafter.drag(drafter.place(0.4, 0.12), back);
    assert_eq!(drafter.guides(), [(GuideRun::Vertical, 0.1)]);
    let ruler = drafter.ruler("Top ruler");
    drafter.drag(ruler, ruler + vec2(80.0, 0.0));
    assert_eq!(drafter.guides(), [(GuideRun::Vertical, 0.1)]);
    drafter.undo();
    assert_eq!(drafter.guides()[0], (GuideRun::Horizontal, 0.12));
    // Delete removes what is selected.
    drafter.click(drafter.place(0.4, 0.12));
    drafter.key(Key::Delete);
    assert_eq!(drafter.guides(), [(GuideRun::Vertical, 0.1)]);
    // Control lets it lie off the grid.
    drafter
        .window
        .event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    drafter.level(0.0777);
    let at = drafter.guides()[1].1;
    assert!(
        (at - 0.0777).abs() < 0.002 && (at * 100.0).fract().abs() > 0.01,
        "{at}"
    );
    drafter
        .window
        .event(egui::Event::ModifiersChanged(Modifiers::NONE));
    // Arrow keys move it, but not along itself.
    drafter.key(Key::ArrowUp);
    drafter.key(Key::ArrowLeft);
    assert!((drafter.guides()[1].1 - at - 0.001).abs() < 1e-12);
    // Hidden it is not selected: Delete leaves it.
    drafter.chord(SHOW.0, SHOW.1);
    drafter.key(Key::Delete);
    assert_eq!(drafter.guides().len(), 2);
    drafter.chord(SHOW.0, SHOW.1);
    // All are removed, and come back.
    let before = drafter.guides();
    drafter.entry("View", "Remove all guides");
    assert!(drafter.guides().is_empty());
    drafter.undo();
    assert_eq!(drafter.guides(), before);
}

#[test]
fn what_is_drawn_snaps_to_guides_that_are_seen() {
    let mut drafter = Drafter::empty();
    drafter.level(0.05);
    // Its place is typed, as the ruler counts: after a double click, or beside the view.
    drafter.enter("Place on the left ruler", "4.37");
    assert_eq!(drafter.guides(), [(GuideRun::Horizontal, 0.0437)]);
    drafter.upright(0.1);
    let at = drafter.place(0.1, 0.3);
    for _ in 0..2 {
        drafter.window.drag_at(at);
        drafter.window.drop_at(at);
    }
    drafter.window.run();
    drafter.window.run();
    drafter.typed("12.34");
    assert_eq!(drafter.guides()[1], (GuideRun::Vertical, 0.1234));
    // A place that is none is refused, and stays to be mended.
    drafter.enter("Place on the top ruler", "5 / 0");
    assert_eq!(drafter.guides()[1], (GuideRun::Vertical, 0.1234));
    drafter.key(Key::Escape);
    drafter.level(0.26);
    drafter.enter("Place on the left ruler", "=20cm + 63.3mm");
    assert_eq!(drafter.guides()[2], (GuideRun::Horizontal, 0.2633));
    drafter.key(Key::Escape);

    // On a guide, along it by the grid.
    drafter.key(Key::P);
    let near = drafter.place(0.05, 0.0437) + vec2(1.0, 4.0);
    drafter.hover(near);
    assert!(
        drafter.told().contains("on the guide"),
        "{}",
        drafter.told()
    );
    drafter.click(near);
    assert_eq!(drafter.last_place(), Vec2::new(0.05, 0.0437));
    // Where guides cross.
    drafter.click(drafter.place(0.1234, 0.0437) + vec2(-4.0, 3.0));
    assert_eq!(drafter.last_place(), Vec2::new(0.1234, 0.0437));
    // Where a guide crosses a curve the point stays on the curve.
    drafter.key(Key::Escape);
    drafter.key(Key::L);
    drafter.click(drafter.place(0.0, 0.1));
    drafter.click(drafter.place(0.2, 0.2));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::P);
    drafter.click(drafter.place(0.1234, 0.1617) + vec2(3.0, -2.0));
    let rule = drafter.points().pop().unwrap().rule;
    assert!(matches!(rule, PointRule::OnCurve { .. }), "{rule:?}");
    let at = drafter.last_place();
    assert!((at - Vec2::new(0.1234, 0.1617)).norm() < 1e-9, "{at:?}");

    // Guides that are hidden are neither seen nor snapped to.
    drafter.chord(SHOW.0, SHOW.1);
    assert!(!drafter.is_seen("Horizontal guide 1"));
    drafter.click(drafter.place(0.07, 0.2633) + vec2(1.0, 1.0));
    assert_eq!(drafter.last_place(), Vec2::new(0.07, 0.26));
    assert_eq!(drafter.guides().len(), 3);
    // One that is dragged out shows the others again, whatever tool is in hand.
    drafter.level(0.3);
    assert_eq!(drafter.guides().len(), 4);
    assert!(drafter.is_seen("Horizontal guide 1") && drafter.is_seen("Horizontal guide 3"));
    drafter.click(drafter.place(0.18, 0.3) + vec2(0.0, 4.0));
    assert_eq!(drafter.last_place(), Vec2::new(0.18, 0.3));
    // A line that is begun goes on to a guide that was dragged out meanwhile.
    drafter.key(Key::Escape);
    drafter.key(Key::L);
    drafter.click(drafter.place(0.22, 0.35));
    drafter.upright(0.31);
    drafter.click(drafter.place(0.31, 0.38) + vec2(-4.0, 0.0));
    assert_eq!(drafter.last_place(), Vec2::new(0.31, 0.38));
    assert_eq!(drafter.pattern().sheets[0].curves.len(), 2);
}

#[test]
fn points_and_edges_are_taken_before_a_guide_and_panels_after_it() {
    let mut drafter = Drafter::empty();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.1, 0.1));
    drafter.click(drafter.place(0.3, 0.3));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.level(0.1);
    drafter.upright(0.2);
    let both = drafter.guides();
    // A point on a guide that is selected is chosen by a click.
    for (at, kind) in [([0.02, 0.1], "Guide("), ([0.1, 0.1], "Point(")] {
        drafter.click(drafter.place(at[0], at[1]));
        let selected = format!("{:?}", drafter.window.state().view().selection);
        assert!(selected.contains(kind), "{selected}");
    }
    drafter.key(Key::Escape);
    // The corner moves, and the rectangle that is placed by it; the guide under it stays.
    drafter.drag(drafter.place(0.1, 0.1), drafter.place(0.05, 0.05));
    assert_eq!(drafter.guides(), both);
    let corner = drafter.evaluation().point(drafter.points()[0].id).unwrap();
    assert!(
        (corner - Vec2::new(0.05, 0.05)).norm() < 0.005,
        "{corner:?}"
    );
    // The upper edge is chosen, not the guide that crosses it.
    drafter.click(drafter.place(0.2, 0.25));
    let selected = drafter.window.state().view().selection.clone();
    assert!(selected.single().unwrap().panel().is_some(), "{selected:?}");
    // Inside the panel the guide is dragged, not the panel; it is drawn to a point near the pointer.
    let panel = drafter.pattern().panels[0].clone();
    let corner = drafter.place(0.25, 0.25) + vec2(-5.0, 3.0);
    drafter.drag(drafter.place(0.2, 0.2), corner);
    let moved = [both[0], (GuideRun::Vertical, 0.25)];
    assert_eq!(drafter.guides(), moved);
    assert_eq!(*drafter.pattern().panels[0], *panel);
}

#[test]
fn guides_are_saved_and_lie_beside_the_same_pieces_when_opened_again() {
    let mut drafter = Drafter::opened("t-shirt");
    let before = drafter.said();
    let corner = "Panel sleeve";
    let seen = drafter.part(corner);
    let point = {
        let pattern = drafter.pattern();
        let sleeve = pattern.panel_named("sleeve").unwrap();
        let end = sleeve.edges().next().unwrap().ends[0];
        let (sheet, point) = pattern.point(end).unwrap();
        drafter.part(&format!("Point {} of {}", point.name, sheet.name))
    };
    drafter.drag(drafter.ruler("Top ruler"), point);
    drafter.drag(drafter.ruler("Left ruler"), point);
    assert_eq!(drafter.guides().len(), 2, "{}", drafter.status());
    assert!((drafter.part(corner) - seen).length() < 0.5);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("guided.toile.json");
    std::fs::write(&path, drafter.saved()).unwrap();
    // Both go through the corner, and do so in the file.
    let again = Drafter::begun(Beginning {
        file: Some(path),
        folder: None,
    });
    assert_eq!(again.guides(), drafter.guides());
    let pattern = again.pattern();
    let sleeve = pattern.panel_named("sleeve").unwrap();
    let end = sleeve.edges().next().unwrap().ends[0];
    let sheet = pattern.sheet_of(sleeve).unwrap();
    let at = again.evaluation().point(end).unwrap()
        + again.window.state().view().table_layout.sheet(sheet);
    let [(_, y), (_, x)] = again.guides()[..] else {
        panic!("{:?}", again.guides())
    };
    assert_eq!([x, y], [at.x, at.y]);
    drafter.undo();
    drafter.undo();
    assert!(drafter.said() == before);
}

#[test]
fn the_journal_and_what_is_kept_for_recovery_have_the_guides() {
    let mut drafter = Drafter::empty();
    drafter.level(0.05);
    drafter.upright(0.1);
    drafter.drag(drafter.place(0.4, 0.05), drafter.place(0.4, 0.12));
    let session = drafter.window.state().session();
    let folder = tempfile::tempdir().unwrap();
    let (replayed, _) = Session::replay(&session.journal(), folder.path(), &mut Silent).unwrap();
    assert_eq!(replayed.project().pattern, session.project().pattern);
    // States are kept for recovery as the text of the file.
    let mut restored = session.snapshot();
    let restore = Command::RestorePattern {
        text: drafter.saved(),
        source: None,
        past: Vec::new(),
    };
    restored.execute(restore, &mut Silent).unwrap();
    assert_eq!(restored.project().pattern.guides, drafter.pattern().guides);
}

#[test]
fn panning_over_guides_makes_nothing_anew() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.drag(drafter.ruler("Top ruler"), drafter.place(0.3, 0.2));
    let state = |drafter: &Drafter| {
        let app = drafter.window.state();
        (app.view().scene.made(), app.session().revision())
    };
    let before = state(&drafter);
    let at = drafter.rect("Pattern view").center();
    let button = |pressed| egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Middle,
        pressed,
        modifiers: Modifiers::NONE,
    };
    drafter.window.hover_at(at);
    drafter.window.event(button(true));
    drafter.window.run();
    for k in 0..10 {
        drafter.window.hover_at(at + vec2(12.0, 7.0) * k as f32);
        drafter.window.run();
    }
    drafter.window.event(button(false));
    drafter.window.run();
    assert_eq!(state(&drafter), before);
}

#[test]
fn guides_are_seen_by_day_and_by_night() {
    let Some((screens, renderer)) = Screens::asked() else {
        return;
    };
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns");
    let beginning = Beginning {
        file: Some(folder.join("t-shirt.toile.json")),
        folder: None,
    };
    let mut drafter = Drafter::of_size(vec2(1400.0, 900.0), beginning, Some(renderer));
    let view = drafter.rect("Pattern view");
    for share in [0.2, 0.45] {
        let to = view.min + view.size() * share;
        drafter.drag(drafter.ruler("Top ruler"), to);
        drafter.drag(drafter.ruler("Left ruler"), to);
    }
    drafter.key(Key::Escape);
    for name in ["guides-light", "guides-dark"] {
        let to = view.min + view.size() * 0.7;
        drafter.begin_drag(drafter.ruler("Left ruler"), to);
        let picture = Part::of(&mut drafter.window, None);
        screens.write(name, &[picture], Colours::All);
        drafter.window.key_press(Key::Escape);
        drafter.window.run();
        drafter.window.drop_at(to);
        drafter.window.run();
        drafter.entry("View", "Dark or light");
    }
}
