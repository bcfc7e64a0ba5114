//! The front bodice of the shipped dress drafted by tools alone, from a document that holds its
//! measurements: it drafts as the shipped one in all six sizes. Actions are counted as in
//! `drafting.rs`; what the document is at the start and at the end is recorded, see
//! `drafter/counted.rs`.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable;
use toile_geometry::{Curve, Vec2};
use toile_pattern::{CurveId, Draft, OperationKind, Pattern, PieceEdge};
use toile_session::Project;

/// How far places and lengths may be from those of the shipped pattern (m).
const NEAR: f64 = 1e-9;

/// What the shipped dress calls by a name, as far as its front needs it. Its `bust_front` is a
/// measurement of the catalogue too, which the window does not take for a variable.
const VARIABLES: &[&str] = &[
    "bust_ease = 6cm",
    "waist_ease = 4cm",
    "neck_wider = 2cm",
    "neck_half = neck_w / 2 + neck_wider",
    "neck_slope = neck_wider * tan(shoulder_incl)",
    "neck_front_drop = neck_half * 0.85",
    "shoulder_half = shoulder_w / 2 - 1.2cm",
    "shoulder_fall = (shoulder_half - neck_half) * tan(shoulder_incl)",
    "armhole_level = shoulder_fall + armscye_depth * 0.6 + 10cm",
    "front_bust = (bust - back_width) / 2 + bust_ease / 4",
    "bust_back = back_width / 2 + bust_ease / 4",
    "waist_front = (waist - waist_back_width) / 2 + waist_ease / 4",
    "waist_back = waist_back_width / 2 + waist_ease / 4",
    "neck_to_bust = hypot(vert_bust_line, bust * 0.21 - 4.6cm) - neck_slope",
    "bust_to_waist = waist_line - vert_bust_line + 0.8cm",
    "front_length = neck_to_bust + bust_to_waist",
    "back_length = waist_line + back_width / 8 - 6cm - neck_slope",
    "side_in_front = (front_bust - waist_front) * 0.3",
    "side_in_back = (bust_back - waist_back) * 0.35",
    "side_length = hypot(back_length - armhole_level, side_in_back)",
    "waist_to_bust_dart = side_length * 0.7",
    "waist_dart_front = front_bust - waist_front - side_in_front",
    "dart_line_front = bust_points / 2 + 0.5cm",
    "dart_short = 2.5cm",
];

/// Corners and the bust point, by coordinates.
const POINTS: &[[&str; 3]] = &[
    ["neck_side", "neck_half", "0"],
    ["neck_centre", "0", "-neck_front_drop"],
    ["waist_centre", "0", "-front_length"],
    [
        "waist_side",
        "waist_front + waist_dart_front",
        "-front_length",
    ],
    ["tip", "shoulder_half", "-shoulder_fall"],
    ["bust_point", "dart_line_front", "-neck_to_bust"],
];

/// Points from others, at a distance and an angle.
const FROM_POINTS: &[[&str; 4]] = &[
    [
        "underarm_closed",
        "waist_side",
        "side_length",
        "atan2(sqrt(side_length * side_length - side_in_front * side_in_front), side_in_front)",
    ],
    [
        "dart_low",
        "waist_side",
        "waist_to_bust_dart",
        "angle(draft.waist_side, draft.underarm_closed)",
    ],
];

/// The bust dart: it is opened until the armhole lies as high as the bust asks for.
const DART_VARIABLES: &[&str] = &[
    "bust_reach = distance(draft.bust_point, draft.underarm_closed)",
    "bust_rise = neck_to_bust - armhole_level",
    "bust_dart = atan2(bust_rise, sqrt(bust_reach * bust_reach - bust_rise * bust_rise)) \
     - angle(draft.bust_point, draft.underarm_closed)",
];

const OPENED_POINTS: &[[&str; 4]] = &[
    [
        "dart_high",
        "bust_point",
        "distance(draft.bust_point, draft.dart_low)",
        "angle(draft.bust_point, draft.dart_low) + bust_dart",
    ],
    [
        "underarm",
        "bust_point",
        "bust_reach",
        "angle(draft.bust_point, draft.underarm_closed) + bust_dart",
    ],
];

/// Lines that begin where the one before ends.
const LINES: &[&[&str]] = &[
    &[
        "waist_centre",
        "waist_side",
        "dart_low",
        "dart_high",
        "underarm",
    ],
    &["tip", "neck_side"],
    &["neck_centre", "waist_centre"],
];

/// A curve: its name, its ends, and how far its handles are from them.
type DrawnCurve = (&'static str, [&'static str; 2], [[&'static str; 2]; 2]);

const CURVES: &[DrawnCurve] = &[
    (
        "armhole",
        ["underarm", "tip"],
        [
            [
                "cos(angle(draft.waist_side, draft.underarm_closed) + bust_dart + 90deg) * (front_bust - shoulder_half) * 0.7",
                "sin(angle(draft.waist_side, draft.underarm_closed) + bust_dart + 90deg) * (front_bust - shoulder_half) * 0.7",
            ],
            [
                "cos(270deg - shoulder_incl) * (armhole_level - shoulder_fall) * 0.5",
                "sin(270deg - shoulder_incl) * (armhole_level - shoulder_fall) * 0.5",
            ],
        ],
    ),
    (
        "neck",
        ["neck_side", "neck_centre"],
        [
            [
                "-neck_front_drop * 0.58 * tan(shoulder_incl)",
                "-neck_front_drop * 0.58",
            ],
            ["neck_half * 0.58", "0"],
        ],
    ),
];

impl Drafter {
    fn type_variables(&mut self, variables: &[&str]) {
        for (k, variable) in variables.iter().enumerate() {
            // The field keeps the keys for the next.
            match k {
                0 => self.enter("New variable", variable),
                _ => self.typed(variable),
            }
            let name = variable.split(" =").next().unwrap();
            let pattern = self.pattern();
            let found = pattern.variables.iter().find(|found| found.name == name);
            assert!(found.is_some(), "{variable}: {}", self.status());
        }
        self.key(Key::Escape);
    }

    fn draw_points_from(&mut self, points: &[[&str; 4]]) {
        self.key(Key::U);
        for [name, from, distance, angle] in points {
            self.click(self.part(&format!("Point {from} of draft")));
            self.typed_and(&format!("={distance}"), Key::Tab);
            self.typed_and(&format!("={angle}"), Key::Tab);
            self.typed(name);
            let is_drawn = self.pattern().sheets[0].point_named(name).is_some();
            assert!(is_drawn, "{name}: {}", self.status());
        }
    }

    /// Names what was just drawn, which is selected.
    fn name_drawn(&mut self, name: &str) {
        self.enter("Name", name);
        let drawn = self.pattern().sheets[0].clone();
        let is_named = drawn.point_named(name).is_some() || drawn.curve_named(name).is_some();
        assert!(is_named, "{name}: {}", self.status());
    }

    fn has_steps(&self, count: usize) {
        let steps = self.pattern().panels[0].operations.len();
        assert_eq!(steps, count, "{}", self.status());
    }

    /// The curve of the edge between two corners.
    fn curve_between(&self, ends: [&str; 2]) -> CurveId {
        let pattern = self.pattern();
        let ids = ends.map(|name| pattern.sheets[0].point_named(name).unwrap().id);
        let mut edges = pattern.panels[0].edges();
        let found = edges.find(|edge| ids.iter().all(|id| edge.ends.contains(id)));
        found.unwrap().curve
    }

    /// Where the edge between two corners is seen.
    fn edge(&self, ends: [&str; 2]) -> Pos2 {
        self.along(self.curve_between(ends))
    }

    /// Where the edge between two corners is seen near the first.
    fn edge_near(&self, ends: [&str; 2]) -> Pos2 {
        let evaluation = self.evaluation();
        let path = evaluation.curve(self.curve_between(ends)).unwrap();
        let corner = self.point(ends[0]);
        let places = [0.15, 0.85].map(|share| path.at_length(share * path.length()).unwrap());
        let [one, other] = places.map(|place| path.point(place));
        let is_nearer = (one - corner).norm() < (other - corner).norm();
        let at = if is_nearer { one } else { other };
        self.place(at.x, at.y)
    }
}

/// What is drafted in a size.
fn draft(pattern: &Pattern, size: &str) -> Draft {
    let project = Project {
        pattern: pattern.clone().into(),
        size: Some(size.into()),
        ..Project::default()
    };
    let (draft, found) = pattern.resolve(project.drafted_to());
    assert!(found.is_empty(), "{size}: {found:?}");
    draft
}

/// How far the places along an outline are from those of another that has the same edges, wherever
/// each begins; and how far the lengths and allowances of edges are from each other (m).
fn farthest(ours: &[PieceEdge], theirs: &[PieceEdge]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let start = theirs[0].curve.start();
    let away = |k: &usize| (ours[*k].curve.start() - start).norm();
    let first = (0..ours.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
    let ours = ours.iter().cycle().skip(first.unwrap());
    let mut farthest = 0.0_f64;
    for (ours, theirs) in ours.zip(theirs) {
        farthest = farthest.max((ours.seam_allowance - theirs.seam_allowance).abs());
        let (ours, theirs) = (&ours.curve, &theirs.curve);
        farthest = farthest.max((ours.length() - theirs.length()).abs());
        for share in 0..=10 {
            let at = |curve: &Curve| {
                let along = curve.length() * f64::from(share) / 10.0;
                curve.point(curve.parameter_at_length(along))
            };
            farthest = farthest.max((at(ours) - at(theirs)).norm());
        }
    }
    farthest
}

#[test]
fn the_front_bodice_of_the_dress_is_drafted_by_tools() {
    let shipped = Drafter::opened("dress").pattern();
    let mut drafter = Drafter::at_start_of("bodice");

    // What its numbers are called.
    drafter.key(Key::F8);
    drafter.press("Variables");
    drafter.type_variables(VARIABLES);

    // The corners, and the points that the bust dart is opened by.
    drafter.key(Key::P);
    let middle = drafter.window.get_by_label("Pattern view").rect().center();
    drafter.hover(middle);
    for [name, x, y] in POINTS {
        drafter.typed_and(&format!("={x}"), Key::Tab);
        drafter.typed_and(&format!("={y}"), Key::Tab);
        drafter.typed(name);
    }
    drafter.key(Key::Home);
    drafter.draw_points_from(FROM_POINTS);
    drafter.type_variables(DART_VARIABLES);
    drafter.draw_points_from(OPENED_POINTS);

    // Lines and curves between them.
    drafter.key(Key::L);
    for (k, line) in LINES.iter().enumerate() {
        if k > 0 {
            drafter.key(Key::Escape);
        }
        for point in *line {
            drafter.click(drafter.part(&format!("Point {point} of draft")));
        }
    }
    drafter.key(Key::C);
    for (name, ends, handles) in CURVES {
        for end in ends {
            drafter.click(drafter.part(&format!("Point {end} of draft")));
        }
        drafter.key(Key::Enter);
        drafter.name_drawn(name);
        // Its handles are beside its name, one after the other.
        let [[x, y], [last_x, last_y]] = handles;
        drafter.enter_on(&format!("x of handle at {}", ends[0]), x);
        drafter.typed_and(y, Key::Tab);
        drafter.typed_and(last_x, Key::Tab);
        drafter.typed(last_y);
    }

    // The panel, its allowances, the fold at the centre front.
    drafter.key(Key::T);
    let inside = drafter.point("bust_point") + Vec2::new(0.0, 0.1);
    drafter.click(drafter.place(inside.x, inside.y));
    assert_eq!(drafter.pattern().panels.len(), 1, "{}", drafter.status());
    drafter.enter("Name", "front bodice");
    drafter.enter("seam allowance", "1.5");
    drafter.key(Key::V);
    drafter.click(drafter.edge(["underarm", "tip"]));
    drafter.shift_click(drafter.edge(["neck_side", "neck_centre"]));
    drafter.enter("seam allowance of all", "1");
    drafter.click(drafter.edge(["neck_centre", "waist_centre"]));
    drafter.enter("seam allowance", "0");
    drafter.key(Key::N);
    drafter.hover(drafter.edge_near(["underarm", "tip"]));
    drafter.typed("=length('front bodice'.armhole) * 0.4");
    drafter.key(Key::D);
    let mouth = (drafter.point("dart_low") + drafter.point("dart_high")) / 2.0;
    drafter.click(drafter.place(mouth.x, mouth.y));
    drafter.typed("=distance(draft.dart_low, draft.dart_high)");
    drafter.typed("=distance(draft.bust_point, draft.dart_low) * cos(bust_dart / 2) - dart_short");
    drafter.has_steps(1);
    drafter.hover(drafter.edge_near(["waist_centre", "waist_side"]));
    drafter.typed("=dart_line_front");
    drafter.typed("=waist_dart_front");
    drafter.typed("=bust_to_waist - dart_short");
    drafter.has_steps(2);
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.edge(["neck_centre", "waist_centre"]));

    println!(
        "{} actions; {} are typed fields that had not the keys before",
        drafter.actions, drafter.reached
    );
    assert!(drafter.actions <= 120, "{}", drafter.actions);
    drafter.ends("bodice");

    // Of the dress that ships no dart is trued.
    let mut drafted = drafter.pattern();
    for panel in &mut drafted.panels {
        for step in &mut std::sync::Arc::make_mut(panel).operations {
            if let OperationKind::Dart { trued, .. } = &mut std::sync::Arc::make_mut(step).kind {
                assert!(*trued);
                *trued = false;
            }
        }
    }
    for size in &shipped.sizes {
        let both = [&drafted, &shipped].map(|pattern| draft(pattern, &size.name));
        let [ours, theirs] = both.each_ref().map(|draft| {
            let mut pieces = draft.pieces.iter();
            pieces.find(|piece| piece.name == "front bodice").unwrap()
        });
        let away = farthest(&ours.outline, &theirs.outline);
        assert!(away < NEAR, "{}: {away:e} m", size.name);
        let marks = [ours, theirs].map(|piece| {
            let darts = piece.darts.iter().flat_map(|dart| {
                let [open, close] = dart.mouth;
                [open, close, dart.apex]
            });
            let notches = piece.notches.iter().map(|notch| notch.point);
            let folds = piece.folds.iter().map(|fold| fold[0]);
            darts.chain(notches).chain(folds).collect::<Vec<_>>()
        });
        assert_eq!(marks[0].len(), 15, "{}", size.name);
        assert_eq!(marks[0].len(), marks[1].len(), "{}", size.name);
        for (ours, theirs) in marks[0].iter().zip(&marks[1]) {
            let away = (ours - theirs).norm();
            assert!(away < NEAR, "{}: {away:e} m", size.name);
        }
    }
}
