//! Eleven problems of drafting whose answers have closed forms, solved by tools alone: no answer is typed.

use crate::drafter::Drafter;
use egui::Key;
use toile_geometry::{Path, Vec2};
use toile_pattern::plan;

/// How near the answer is (m), (m2).
const NEAR: f64 = 1e-9;

fn begun() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Problem");
    drafter
}

impl Drafter {
    fn take(&mut self, tool: &str) {
        let command = toile_ui::named(tool).unwrap();
        (command.does)(self.window.state_mut());
        self.window.run();
    }

    /// Types both numbers of a place.
    fn pair(&mut self, first: &str, second: &str) {
        self.typed_and(first, Key::Tab);
        self.typed(second);
    }

    /// The rectangle of so many centimetres at the origin.
    fn rectangle(&mut self, width: &str, height: &str) {
        self.take("Rectangle");
        self.pair("0", "0");
        self.pair(width, height);
        self.take("Select");
        self.key(Key::Home);
    }

    /// Puts the tool down and shows all that is drawn.
    fn look(&mut self) {
        self.key(Key::Escape);
        self.take("Select");
        self.key(Key::Home);
    }

    /// Corners of the first panel in order (m).
    fn corners(&self) -> Vec<Vec2> {
        let evaluation = self.evaluation();
        let pattern = self.pattern();
        let edges = pattern.panels[0].edges();
        edges
            .map(|edge| start(evaluation.edge(edge.id).unwrap()))
            .collect()
    }

    fn length_of_last_curve(&self) -> f64 {
        let pattern = self.pattern();
        let curve = pattern.sheets[0].curves.last().unwrap();
        self.evaluation().curve(curve.id).unwrap().length()
    }
}

fn start(path: &Path) -> Vec2 {
    path.point(path.at_length(0.0).unwrap())
}

fn area(corners: &[Vec2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let parts = corners.iter().zip(next).map(|(a, b)| 0.5 * a.perp(b));
    parts.sum::<f64>().abs()
}

fn is(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < NEAR, "{found} {wanted}");
}

fn is_at(found: Vec2, x: f64, y: f64) {
    assert!((found - Vec2::new(x, y)).norm() < NEAR, "{found} {x} {y}");
}

/// A hexagon by its sides: the last closes it by itself, and the area is 3/2 sqrt(3) a^2.
#[test]
fn a_hexagon_closes() {
    let mut drafter = begun();
    drafter.take("Polygon");
    drafter.pair("0", "0");
    for angle in ["0", "60", "120", "180", "240"] {
        drafter.pair("10", angle);
    }
    drafter.click(drafter.place(0.0, 0.0));
    drafter.look();
    let corners = drafter.corners();
    assert_eq!(corners.len(), 6, "{}", drafter.status());
    is(area(&corners), 1.5 * 3.0_f64.sqrt() * 0.01);
    is((corners[5] - corners[0]).norm(), 0.1);
}

/// Two sides and the angle between them: the third by the law of cosines.
#[test]
fn the_third_side_of_a_triangle() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("30", "0");
    drafter.pair("20", "120");
    drafter.click(drafter.part("Point A of draft"));
    is(drafter.length_of_last_curve(), 0.07_f64.sqrt());
}

/// The foot of a perpendicular on a line at 30 degrees, from a place 40 cm along the level.
#[test]
fn the_foot_of_a_perpendicular() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("60", "30");
    drafter.look();
    drafter.take("Point from");
    drafter.click(drafter.part("Point A of draft"));
    drafter.pair("40", "0");
    drafter.look();
    drafter.take("Perpendicular");
    for name in ["C", "A", "B"] {
        drafter.click(drafter.part(&format!("Point {name} of draft")));
    }
    let cos = 3.0_f64.sqrt() / 2.0;
    is_at(drafter.point("D"), 0.4 * cos * cos, 0.4 * cos * 0.5);
}

/// A point mirrored across the line at 45 degrees changes its coordinates with each other.
#[test]
fn a_point_mirrored_across_the_diagonal() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("40", "45");
    drafter.look();
    drafter.take("Point");
    drafter.pair("31", "7");
    drafter.look();
    drafter.take("Mirror point");
    for name in ["C", "A", "B"] {
        drafter.click(drafter.part(&format!("Point {name} of draft")));
    }
    is_at(drafter.point("D"), 0.07, 0.31);
}

/// A compass of 5 cm about a point 3 cm above a line meets it 4 cm to either side: the pointer says which.
#[test]
fn a_compass_meets_a_line_on_the_side_of_the_pointer() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("40", "0");
    drafter.look();
    drafter.take("Point");
    drafter.pair("20", "3");
    drafter.look();
    let before = drafter.pattern();
    for (aside, name, x) in [(0.3, "D", 0.24), (0.1, "E", 0.16)] {
        drafter.take("Compass on line");
        for name in ["A", "B", "C"] {
            drafter.click(drafter.part(&format!("Point {name} of draft")));
        }
        drafter.hover(drafter.place(aside, 0.0));
        drafter.typed("5");
        is_at(drafter.point(name), x, 0.0);
    }
    // One that is too short is refused, with the field and a remedy; nothing is drawn.
    let steps = drafter.steps();
    drafter.take("Compass on line");
    for name in ["A", "B", "C"] {
        drafter.click(drafter.part(&format!("Point {name} of draft")));
    }
    drafter.hover(drafter.place(0.3, 0.0));
    drafter.typed("2");
    let fault = drafter.window.state().fault().unwrap_or_default();
    assert!(
        fault.starts_with("radius: ") && fault.contains("longer"),
        "{fault}"
    );
    assert_eq!(drafter.steps(), steps);
    drafter.take("Select");
    for _ in 0..2 {
        drafter.chord(egui::Modifiers::COMMAND, Key::Z);
    }
    assert!(drafter.pattern().says_the_same(&before));
}

/// 30 and 40 cm from points that are 50 cm apart: a right angle, on the side of the pointer.
#[test]
fn two_compasses_meet_on_the_side_of_the_pointer() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("50", "0");
    drafter.look();
    let before = drafter.pattern();
    for (aside, name, y) in [(0.1, "C", 0.24), (-0.1, "D", -0.24)] {
        drafter.take("Two compasses");
        for name in ["A", "B"] {
            drafter.click(drafter.part(&format!("Point {name} of draft")));
        }
        drafter.typed("30");
        drafter.hover(drafter.place(0.2, aside));
        drafter.typed("40");
        is_at(drafter.point(name), 0.18, y);
        drafter.look();
    }
    // Two that do not meet are refused.
    drafter.take("Two compasses");
    for name in ["A", "B"] {
        drafter.click(drafter.part(&format!("Point {name} of draft")));
    }
    drafter.typed("30");
    drafter.hover(drafter.place(0.2, 0.1));
    drafter.typed("10");
    let fault = drafter.window.state().fault().unwrap_or_default();
    assert!(fault.contains("no point has both distances"), "{fault}");
    drafter.take("Select");
    for _ in 0..2 {
        drafter.chord(egui::Modifiers::COMMAND, Key::Z);
    }
    assert!(drafter.pattern().says_the_same(&before));
}

/// A third of the way along a quarter of a circle lies at 30 degrees.
#[test]
fn a_third_of_a_quarter_circle() {
    let mut drafter = begun();
    drafter.take("Arc about centre");
    drafter.pair("0", "0");
    drafter.pair("20", "0");
    drafter.typed("90");
    drafter.look();
    let pattern = drafter.pattern();
    let arc = pattern.sheets[0].curves[0].id;
    is(drafter.length_of_last_curve(), 0.1 * std::f64::consts::PI);
    drafter.take("Point along");
    let at = drafter.along(arc);
    drafter.click(at);
    drafter.typed("=20cm * pi / 6");
    let pattern = drafter.pattern();
    let made = pattern.sheets[0].points.last().unwrap().id;
    let at = drafter.evaluation().point(made).unwrap();
    // Measured from the end that was nearer to the click.
    let cos = 3.0_f64.sqrt() / 2.0;
    let (x, y) = (at.x.max(at.y), at.x.min(at.y));
    is(x, 0.2 * cos);
    is(y, 0.1);
}

/// An arc that goes on from a level line and ends as far up as ahead is a quarter of a circle.
#[test]
fn an_arc_that_goes_on_from_a_line() {
    let mut drafter = begun();
    drafter.take("Line");
    drafter.pair("0", "0");
    drafter.pair("10", "0");
    drafter.look();
    drafter.take("Tangent arc");
    let pattern = drafter.pattern();
    let line = pattern.sheets[0].curves[0].id;
    let path = drafter.evaluation().curve(line).unwrap().clone();
    let end = path.point(path.at_length(0.09).unwrap());
    drafter.click(drafter.place(end.x, end.y));
    drafter.typed_and("@10", Key::Tab);
    drafter.typed("10");
    is(drafter.length_of_last_curve(), 0.05 * std::f64::consts::PI);
}

/// A dart of 3 cm, 9 cm deep, in the middle of 20 cm: closed and trued, the edge is straight from corner to
/// corner. As seen from the apex a corner lies at atan(10 / 9) from the middle, less atan(1.5 / 9) when the dart
/// is closed: the edge is 102 / sqrt(37) cm long.
#[test]
fn the_edge_over_a_closed_dart() {
    let mut drafter = begun();
    drafter.rectangle("20", "30");
    drafter.take("Dart");
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("3");
    drafter.typed("9");
    let pattern = drafter.pattern();
    let panel = &pattern.panels[0];
    let top = panel.edges().find(|edge| edge.name == "top").unwrap().id;
    let finished = plan::finished_edge(&drafter.evaluation(), panel.id, top).unwrap();
    is(finished.length, 1.02 / 37.0_f64.sqrt());
}

/// A rectangle turned by 30 degrees about its corner.
#[test]
fn a_rectangle_turned_about_its_corner() {
    let mut drafter = begun();
    drafter.rectangle("20", "30");
    drafter.click(drafter.place(0.1, 0.1));
    drafter.take("Turn");
    drafter.pair("0", "0");
    drafter.typed("30");
    let (sin, cos) = (0.5, 3.0_f64.sqrt() / 2.0);
    let corners = drafter.corners();
    let wanted = Vec2::new(0.2 * cos - 0.3 * sin, 0.2 * sin + 0.3 * cos);
    let nearest = corners.iter().map(|corner| (corner - wanted).norm());
    is(nearest.fold(f64::INFINITY, f64::min), 0.0);
    is(area(&corners), 0.06);
}

/// An edge of 30 cm divided in the golden section by a formula: both parts are in the ratio of the whole to the
/// longer one.
#[test]
fn an_edge_in_the_golden_section() {
    let mut drafter = begun();
    drafter.rectangle("30", "10");
    drafter.take("Divide edge");
    let top = drafter.part("Edge top of draft");
    drafter.hover(top);
    drafter.typed("=30cm * 2 / (1 + sqrt(5))");
    let corners = drafter.corners();
    assert_eq!(corners.len(), 5, "{}", drafter.status());
    let pattern = drafter.pattern();
    let made = pattern.sheets[0].points.last().unwrap().id;
    let at = drafter.evaluation().point(made).unwrap();
    let (longer, shorter) = (at.x.max(0.3 - at.x), at.x.min(0.3 - at.x));
    is(longer / shorter, 0.3 / longer);
    is(longer / shorter, 0.5 * (1.0 + 5.0_f64.sqrt()));
}
