//! The line to cut along as the window draws it at true size, against that of the piece as cut, which
//! prints and markers take: every shipped pattern, panel and size.

use egui::{Pos2, Rect, pos2, vec2};
use std::path::Path;
use toile_cut::CutPiece;
use toile_geometry::{Vec2, point_segment_distance};
use toile_pattern::{PanelId, Pattern, PointId};
use toile_session::Command;
use toile_ui::{Beginning, ToileApp, ToolEvent, ToolModifiers, named};

/// Farthest the drawn line may be from the true one (m).
const FARTHEST: f64 = 0.000_02;
/// Between places of a line whose distance from the other is taken (m).
const APART: f64 = 0.001;
/// Pixels a metre at true size on a screen of 96 an inch.
const TRUE_SIZE: f64 = 96.0 / 0.0254;

type Ring = Vec<Vec2>;

fn window(name: &str) -> ToileApp {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns");
    let mut app = ToileApp::new(
        &egui::Context::default(),
        None,
        Beginning {
            file: Some(folder.join(format!("{name}.toile.json"))),
            folder: None,
        },
    );
    (named("True size").unwrap().does)(&mut app);
    // The scene is made for the enlargement when the session is next followed.
    app.execute(Command::Check);
    app
}

fn view() -> Rect {
    Rect::from_min_size(pos2(190.0, 50.0), vec2(960.0, 800.0))
}

/// Lines of a panel as they are drawn on the screen, taken back to the panel's plane (m).
fn drawn(app: &ToileApp, panel: PanelId) -> Vec<Ring> {
    let (pattern_view, view) = (app.view(), view());
    let (centre, scale) = (pattern_view.camera.centre, pattern_view.camera.scale);
    assert!((scale - TRUE_SIZE).abs() < 1e-9, "{scale}");
    let origin = pattern_view.table_layout.panel(panel);
    let on_panel = |at: Pos2| {
        let way = at - view.center();
        centre + Vec2::new(f64::from(way.x), -f64::from(way.y)) / TRUE_SIZE - origin
    };
    let rings = pattern_view.scene.cut_lines.of(panel).iter();
    let rings = rings.map(|ring| {
        let seen = ring.iter().map(|at| pattern_view.screen(view, origin, *at));
        seen.map(on_panel).collect()
    });
    rings.collect()
}

/// Lines of the pieces as cut, from a draft of their own.
fn true_rings(app: &ToileApp) -> Vec<(PanelId, String, Vec<Ring>)> {
    let project = app.session().project();
    let pattern: &Pattern = &project.pattern;
    let (draft, _) = pattern.resolve(project.drafted_to());
    let pieces = draft.pieces.iter().enumerate();
    let first = pieces.filter(|(_, piece)| piece.id.copy == 0);
    first
        .map(|(number, piece)| {
            let of = (pattern, &draft);
            let cut = CutPiece::new(of, number, (None, &Default::default())).unwrap();
            let rings = cut.cut.iter().map(|ring| {
                let mut points = ring.points.clone();
                points.extend(ring.points.first());
                points
            });
            (piece.id.panel, piece.name.clone(), rings.collect())
        })
        .collect()
}

/// The farthest that any place of closed lines is from others (m).
fn farthest(from: &[Ring], to: &[Ring]) -> f64 {
    let mut farthest = 0.0_f64;
    for [a, b] in from.iter().flat_map(|ring| ring.array_windows()) {
        let steps = ((b - a).norm() / APART).ceil().max(1.0) as usize;
        for step in 0..steps {
            let at = a + (b - a) * (step as f64 / steps as f64);
            let ends = to.iter().flat_map(|ring| ring.array_windows());
            let away = ends.map(|&[c, d]| point_segment_distance(at, [c, d]));
            farthest = farthest.max(away.fold(f64::INFINITY, f64::min));
        }
    }
    farthest
}

/// How many lines the window draws as they are cut, each within [`FARTHEST`] both ways.
fn compared(app: &ToileApp, when: &str) -> usize {
    let mut compared = 0;
    for (panel, name, wanted) in true_rings(app) {
        let drawn = drawn(app, panel);
        assert_eq!(drawn.len(), wanted.len(), "{name}, {when}");
        let away = farthest(&drawn, &wanted).max(farthest(&wanted, &drawn));
        assert!(away <= FARTHEST, "{name}, {when}: {} mm", away * 1e3);
        compared += drawn.len();
    }
    compared
}

#[test]
fn every_shipped_piece_and_size_is_drawn_as_it_is_cut() {
    for (name, pieces) in [
        ("gathered-skirt", 3),
        ("poncho", 2),
        ("t-shirt", 3),
        ("trousers", 3),
    ] {
        let mut app = window(name);
        let sizes = app.session().project().pattern.sizes.clone();
        assert_eq!(sizes.len(), 6, "{name}");
        for size in &sizes {
            let chosen = Some(size.name.clone());
            assert!(app.execute(Command::SetSize { size: chosen }));
            let when = format!("{name}, size {}", size.name);
            let count = compared(&app, &when);
            assert!(count >= pieces, "{when}: {count} lines");
        }
    }
}

#[test]
fn while_a_corner_is_dragged_the_line_follows() {
    let mut app = window("t-shirt");
    let pattern = app.session().project().pattern.clone();
    let corner: PointId = pattern.panels[0].edges().next().unwrap().ends[0];
    let (sheet, _) = pattern.point(corner).unwrap();
    let at = app.base().point(corner).unwrap() + app.view().table_layout.sheet(sheet.id);
    let modifiers = ToolModifiers {
        shift: false,
        command: true,
    };
    let before: Vec<_> = true_rings(&app);
    let from = app.view().pointer(at, modifiers);
    for way in [0.004, 0.011] {
        let to = app.view().pointer(at + Vec2::new(-way, way), modifiers);
        app.give(&ToolEvent::Drag(from.clone(), to));
        assert!(app.session().is_previewing(), "{:?}", app.fault());
        assert!(compared(&app, "dragged") >= 3);
    }
    assert_ne!(true_rings(&app), before);
    app.give(&ToolEvent::Escape);
    assert_eq!(true_rings(&app), before);
    assert!(compared(&app, "left") >= 3);
}
