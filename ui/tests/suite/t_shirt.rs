//! The shipped T-shirt drafted in an empty window by tools alone: it drafts as the shipped one in all
//! six sizes, is sewn, laid out, printed, saved, opened again and worn.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;
use toile_pattern::{CurveRule, Evaluation, Panel, Pattern};
use toile_session::{Command, Silent};

/// Measurements its formulas use, by the names of their rows.
const MEASURED: &[&str] = &[
    "bust",
    "hips",
    "waist_line",
    "hips_line",
    "neck_w",
    "shoulder_w",
    "shoulder_incl",
    "back_width",
    "armscye_depth",
    "arm_length",
];

const VARIABLES: &[&str] = &[
    "bust_ease = 11.5cm",
    "body_length = waist_line + hips_line + 4",
    "neck_half = neck_w / 2 + 2.5",
    "neck_front_drop = neck_half * 0.85",
    "neck_back_drop = 3cm",
    "shoulder_half = shoulder_w / 2 + 2.5",
    "shoulder_fall = (shoulder_half - neck_half) * tan(shoulder_incl * 0.9)",
    "chest_quarter = (bust + bust_ease) / 4",
    "front_more = min(bust / 4 - back_width / 2 + 1, 1.7)",
    "hem_quarter = max(chest_quarter, hips / 4 + 1.5)",
    "underarm_level = shoulder_fall + armscye_depth + 6.5",
];

const SLEEVE_VARIABLES: &[&str] = &[
    "cap_height = (length(front.armhole) + length(back.armhole)) * 0.225",
    "cap_stretch = 0.972",
    "cap_front = length(front.armhole) * cap_stretch",
    "cap_back = length(back.armhole) * cap_stretch",
    "sleeve_front = sqrt(cap_front * cap_front - cap_height * cap_height)",
    "sleeve_back = sqrt(cap_back * cap_back - cap_height * cap_height)",
    "sleeve_under = arm_length * 0.38 - cap_height",
    "sleeve_taper = 0.7cm",
];

/// A piece: its name, how far to the right it is drawn, its corners with their places, the edge
/// from each corner to the next with the offsets of its handles, if it is curved.
struct Piece {
    name: &'static str,
    aside: &'static str,
    corners: &'static [(&'static str, &'static str, &'static str)],
    edges: &'static [(&'static str, Option<[[&'static str; 2]; 2]>)],
}

const FRONT: Piece = Piece {
    name: "front",
    aside: "0cm",
    corners: &[
        ("hem_centre", "0cm", "-body_length"),
        ("hem_side", "hem_quarter + front_more", "-body_length"),
        ("underarm", "chest_quarter + front_more", "-underarm_level"),
        ("tip", "shoulder_half", "-shoulder_fall"),
        ("neck_side", "neck_half", "0"),
        ("neck_centre", "0cm", "-neck_front_drop"),
    ],
    edges: &[
        ("hem", None),
        ("side", None),
        (
            "armhole",
            Some([
                ["(shoulder_half - chest_quarter - front_more) * 0.8", "0"],
                [
                    "cos(270deg - shoulder_incl * 0.9) * (underarm_level - shoulder_fall) * 0.5",
                    "sin(270deg - shoulder_incl * 0.9) * (underarm_level - shoulder_fall) * 0.5",
                ],
            ]),
        ),
        ("shoulder", None),
        (
            "neck",
            Some([
                [
                    "-neck_front_drop * 0.58 * tan(shoulder_incl * 0.9)",
                    "-neck_front_drop * 0.58",
                ],
                ["neck_half * 0.58", "0"],
            ]),
        ),
        ("centre", None),
    ],
};

const BACK: Piece = Piece {
    name: "back",
    aside: "110cm",
    corners: &[
        ("back_hem_centre", "0cm", "-body_length"),
        ("back_neck_centre", "0cm", "-neck_back_drop"),
        ("back_neck_side", "-neck_half", "0"),
        ("back_tip", "-shoulder_half", "-shoulder_fall"),
        ("back_underarm", "-chest_quarter", "-underarm_level"),
        ("back_hem_side", "-hem_quarter", "-body_length"),
    ],
    edges: &[
        ("centre", None),
        (
            "neck",
            Some([
                ["-neck_half * 0.6", "0"],
                [
                    "neck_back_drop * 0.7 * tan(shoulder_incl * 0.9)",
                    "-neck_back_drop * 0.7",
                ],
            ]),
        ),
        ("shoulder", None),
        (
            "armhole",
            Some([
                [
                    "cos(shoulder_incl * 0.9 - 90deg) * (underarm_level - shoulder_fall) * 0.5",
                    "sin(shoulder_incl * 0.9 - 90deg) * (underarm_level - shoulder_fall) * 0.5",
                ],
                ["(chest_quarter - shoulder_half) * 0.7", "0"],
            ]),
        ),
        ("side", None),
        ("hem", None),
    ],
};

const SLEEVE: Piece = Piece {
    name: "sleeve",
    aside: "160cm",
    corners: &[
        ("hem_front", "-sleeve_front + sleeve_taper", "-sleeve_under"),
        ("hem_back", "sleeve_back - sleeve_taper", "-sleeve_under"),
        ("underarm_back", "sleeve_back", "0"),
        ("top", "0cm", "cap_height"),
        ("underarm_front", "-sleeve_front", "0"),
    ],
    edges: &[
        (
            "hem",
            Some([
                [
                    "(sleeve_front + sleeve_back - 2 * sleeve_taper) * 0.25",
                    "(sleeve_front + sleeve_back - 2 * sleeve_taper) * 0.25 * sleeve_taper / sleeve_under",
                ],
                [
                    "-(sleeve_front + sleeve_back - 2 * sleeve_taper) * 0.25",
                    "(sleeve_front + sleeve_back - 2 * sleeve_taper) * 0.25 * sleeve_taper / sleeve_under",
                ],
            ]),
        ),
        ("under_back", None),
        (
            "cap_back",
            Some([
                [
                    "-(sleeve_back * 0.35 + cap_height * 0.18)",
                    "(sleeve_back * 0.35 + cap_height * 0.18) * sleeve_taper / sleeve_under",
                ],
                [
                    "sleeve_back * 0.35 + cap_height * 0.21",
                    "-cap_height * 0.35 + sleeve_back * 0.21",
                ],
            ]),
        ),
        (
            "cap_front",
            Some([
                [
                    "-sleeve_front * 0.35 - cap_height * 0.21",
                    "-cap_height * 0.35 + sleeve_front * 0.21",
                ],
                [
                    "(sleeve_front * 0.35 + cap_height * 0.2)",
                    "(sleeve_front * 0.35 + cap_height * 0.2) * sleeve_taper / sleeve_under",
                ],
            ]),
        ),
        ("under_front", None),
    ],
};

impl Drafter {
    /// Types a place by coordinates.
    fn typed_place(&mut self, x: &str, y: &str) {
        self.typed_and(&format!("={x}"), Key::Tab);
        self.typed(&format!("={y}"));
    }

    fn measure(&mut self, shipped: &Pattern) {
        self.key(Key::F8);
        for _ in &shipped.sizes {
            self.press("Add size");
        }
        for name in MEASURED {
            self.enter("New measurement", name);
            let last = shipped.sizes.len() - 1;
            for (k, size) in shipped.sizes.iter().enumerate() {
                let value = size.measurements.get(name).unwrap();
                let is_angle = *name == "shoulder_incl";
                let shown = match is_angle {
                    true => format!("{}", value.to_degrees()),
                    false => format!("{}", value * 100.0),
                };
                let end = if k == last { Key::Enter } else { Key::Tab };
                self.typed_and(&shown, end);
                let pattern = self.pattern();
                let now = pattern.sizes[k].measurements.get(name).unwrap();
                assert!(
                    (now - value).abs() < 1e-12,
                    "{name} {now} {value} {:?}: {}",
                    self.inputs.iter().rev().take(6).collect::<Vec<_>>(),
                    self.status()
                );
            }
        }
        self.key(Key::F8);
    }

    fn name_variables(&mut self, variables: &[&str]) {
        self.key(Key::F8);
        self.press("Variables");
        for variable in variables {
            self.enter("New variable", variable);
            let name = variable.split(" =").next().unwrap();
            let pattern = self.pattern();
            let found = pattern.variables.iter().find(|found| found.name == name);
            assert!(found.is_some(), "{variable}: {}", self.status());
        }
        self.key(Key::F8);
    }

    fn draft(&mut self, piece: &Piece) {
        self.key(Key::Home);
        self.key(Key::P);
        let middle = self.window.get_by_label("Pattern view").rect().center();
        self.hover(middle);
        for (name, x, y) in piece.corners {
            self.typed_place(&format!("{} + {x}", piece.aside), y);
            self.enter("Name", name);
            assert!(
                self.pattern().sheets[0].point_named(name).is_some(),
                "{name}: {}",
                self.status()
            );
        }
        self.key(Key::Home);
        for (k, (edge, handles)) in piece.edges.iter().enumerate() {
            let next = (k + 1) % piece.corners.len();
            let ends = [k, next].map(|k| format!("Point {} of draft", piece.corners[k].0));
            self.key(Key::Escape);
            self.key(Key::Escape);
            self.key(if handles.is_some() { Key::C } else { Key::L });
            for end in &ends {
                self.click(self.part(end));
            }
            if handles.is_some() {
                self.key(Key::Enter);
            }
            self.key(Key::Escape);
            let pattern = self.pattern();
            let curve = pattern.sheets[0].curves.last().unwrap().clone();
            let CurveRule::Spline {
                handles: points, ..
            } = &curve.rule
            else {
                assert!(handles.is_none(), "{edge}: {}", self.status());
                continue;
            };
            for (point, offset) in points.iter().zip(handles.unwrap()) {
                let name = pattern.point(*point).unwrap().1.name.clone();
                self.click(self.part(&format!("Point {name} of draft")));
                self.enter("x", offset[0]);
                self.enter("y", offset[1]);
            }
        }
        // The panel, its name and those of its edges.
        let middle = piece.corners.iter().map(|corner| self.point(corner.0));
        let middle = middle.sum::<Vec2>() / piece.corners.len() as f64;
        self.key(Key::Escape);
        self.key(Key::Escape);
        self.key(Key::Home);
        self.key(Key::T);
        self.click(self.place(middle.x, middle.y));
        self.key(Key::Escape);
        self.enter("Name", piece.name);
        for (k, (edge, _)) in piece.edges.iter().enumerate() {
            let next = (k + 1) % piece.corners.len();
            let pattern = self.pattern();
            let id = |k: usize| {
                pattern.sheets[0]
                    .point_named(piece.corners[k].0)
                    .unwrap()
                    .id
            };
            let panel = pattern.panels.last().unwrap();
            assert_eq!(panel.name, piece.name, "{}", self.status());
            let mut edges = panel.edges();
            let found = edges
                .find(|found| found.ends == [id(k), id(next)] || found.ends == [id(next), id(k)]);
            self.click(self.along(found.unwrap().curve));
            self.enter("Name", edge);
            let pattern = self.pattern();
            let panel = pattern.panels.last().unwrap();
            let named = panel.edges().any(|found| found.name == *edge);
            assert!(named, "{edge}: {}", self.status());
        }
    }
}

/// Places along an edge of a panel in one size, from a corner of the panel (m).
fn places(pattern: &Pattern, size: usize, (panel, edge): (&str, &str)) -> Vec<Vec2> {
    let wearer = &pattern.sizes[size].measurements;
    let evaluation = Evaluation::new(pattern, wearer);
    let panel: &Panel = pattern.panels.iter().find(|p| p.name == panel).unwrap();
    let corner = panel.edges().find(|edge| edge.name == "hem").unwrap();
    let origin = corner.ends.map(|id| evaluation.point(id).unwrap());
    let origin = match origin[0].x < origin[1].x {
        true => origin[0],
        false => origin[1],
    };
    let found = panel.edges().find(|found| found.name == edge).unwrap();
    let path = evaluation.curve(found.curve).unwrap();
    let mut places: Vec<Vec2> = (0..=20)
        .map(|k| path.at_length(path.length() * f64::from(k) / 20.0).unwrap())
        .map(|place| path.point(place) - origin)
        .collect();
    // The same way round, whichever end was drawn first.
    let (first, last) = (places[0], places[20]);
    if (first.x, first.y) > (last.x, last.y) {
        places.reverse();
    }
    places
}

#[test]
fn the_t_shirt_is_drafted_in_an_empty_window() {
    let shipped = Drafter::opened("t-shirt").pattern();
    let mut drafter = Drafter::new();
    // On a display the 3D view is what takes longest to draw.
    drafter.key(Key::F7);
    drafter.press("New pattern");
    drafter.enter("Name", "T-shirt");
    drafter.measure(&shipped);
    drafter.name_variables(VARIABLES);
    drafter.draft(&FRONT);
    drafter.draft(&BACK);
    drafter.name_variables(SLEEVE_VARIABLES);
    drafter.draft(&SLEEVE);
    println!("{} actions", drafter.actions);
    let drafted = drafter.pattern();
    for size in 0..shipped.sizes.len() {
        for piece in [&FRONT, &BACK, &SLEEVE] {
            for (edge, _) in piece.edges {
                let of = |pattern| places(pattern, size, (piece.name, edge));
                for (ours, theirs) in of(&drafted).iter().zip(of(&shipped)) {
                    let away = (ours - theirs).norm();
                    assert!(
                        away < 1e-9,
                        "{}.{edge}, size {size}: {away:e} m",
                        piece.name
                    );
                }
            }
        }
    }

    // Sewn on both sides of the wearer by two clicks a seam.
    for piece in ["front", "back"] {
        drafter.chord(Modifiers::SHIFT, Key::F);
        drafter.click(drafter.part(&format!("Edge centre of {piece}")));
        drafter.key(Key::Escape);
        drafter.key(Key::Escape);
    }
    drafter.click(drafter.part("Panel sleeve"));
    drafter.enter_choice("in mirrored pairs");
    drafter.key(Key::S);
    for [first, second] in [
        ["shoulder of front", "shoulder of back"],
        ["side of front", "side of back"],
        ["armhole of front", "cap_front of sleeve"],
        ["armhole of back", "cap_back of sleeve"],
        ["under_back of sleeve", "under_front of sleeve"],
    ] {
        for edge in [first, second] {
            drafter.click(drafter.part(&format!("Edge {edge}")));
        }
    }
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert_eq!(drafter.pattern().seams.len(), shipped.seams.len());
    let label = drafter.window.query_by_label("No faults");
    assert!(label.is_some(), "{:?}", drafter.window.state().findings());
    println!("{} actions", drafter.actions);

    // Saved, laid out on the fabric, and on paper.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("t-shirt.toile.json");
    drafter.chord(Modifiers::COMMAND, Key::S);
    drafter.enter("File", &file.display().to_string());
    assert!(file.exists(), "{}", drafter.status());
    drafter.keep_way("t_shirt", folder.path());
    drafter.key(Key::F10);
    assert_eq!(drafter.pattern().markers.len(), 1, "{}", drafter.status());
    drafter.press("Search marker");
    let laid = |drafter: &Drafter| !drafter.pattern().markers[0].placements.is_empty();
    drafter.wait(laid);
    drafter.key(Key::F10);
    let paper = folder.path().join("t-shirt.pdf");
    drafter.chord(Modifiers::COMMAND, Key::P);
    drafter.enter("File", &paper.display().to_string());
    drafter.wait(|_| paper.exists());

    // Undone to empty and done again: the same document; replayed from the journal too.
    let end = drafter.pattern();
    let steps = drafter.window.state().session().past().len();
    for _ in 0..steps {
        drafter.chord(Modifiers::COMMAND, Key::Z);
    }
    assert!(
        drafter
            .pattern()
            .sheets
            .iter()
            .all(|sheet| sheet.points.is_empty())
    );
    for _ in 0..steps {
        drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert!(drafter.pattern().says_the_same(&end));

    // Saved again where it was, and opened.
    drafter.chord(Modifiers::COMMAND, Key::S);
    let again = Drafter::begun(toile_ui::Beginning {
        file: Some(file),
        folder: None,
    });
    assert!(again.pattern().says_the_same(&end));

    // And worn.
    let mut session = again.window.state().session().snapshot();
    session.execute(Command::drape(), &mut Silent).unwrap();
    let draped = session.draped().unwrap();
    assert_eq!((draped.body_intersections, draped.components), (0, 1));
}
