//! Hand-made specifications, damaged ones, and a round trip of writing and reading.

use super::{read_garmentcode, write_garmentcode};
use proptest::prelude::*;
use toile_geometry::{Curve, Vec2};
use toile_measure::Measurements;
use toile_pattern::{CurveRule, Draft, Worn};

/// Two panels with every kind of curve, placed apart and sewn by two seams: one start to end, one reversed.
const SAMPLE: &str = r#"{
  "pattern": {
    "panels": {
      "front": {
        "translation": [0, 100, 25], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [20, 0], [20, 30], [0, 30]],
        "edges": [
          { "endpoints": [0, 1] },
          { "endpoints": [1, 2], "curvature": { "type": "quadratic", "params": [[0.5, 0.1]] } },
          { "endpoints": [2, 3], "curvature": { "type": "cubic", "params": [[0.3, 0.1], [0.6, -0.1]] }, "label": "neck" },
          { "endpoints": [3, 0], "curvature": { "type": "circle", "params": [20, 0, 1] } }
        ]
      },
      "back": {
        "translation": [0, 100, -20], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [0, 30], [20, 30], [20, 0]],
        "edges": [
          { "endpoints": [0, 1], "curvature": { "type": "circle", "params": [20, 0, 0] } },
          { "endpoints": [1, 2] },
          { "endpoints": [2, 3] },
          { "endpoints": [3, 0] }
        ]
      }
    },
    "stitches": [
      [{ "panel": "front", "edge": 1 }, { "panel": "back", "edge": 2 }],
      [{ "panel": "front", "edge": 3 }, { "panel": "back", "edge": 0 }]
    ]
  },
  "parameters": {}, "parameter_order": [],
  "properties": { "curvature_coords": "relative", "normalize_panel_translation": false,
                  "normalized_edge_loops": true, "units_in_meter": 100 }
}"#;

fn draft(text: &str) -> Draft {
    let reading = read_garmentcode(text).unwrap();
    let (draft, findings) = reading.pattern.resolve(&Measurements::new());
    for finding in &findings {
        assert!(
            finding.severity < toile_pattern::Severity::Error,
            "{finding}"
        );
    }
    draft
}

#[test]
fn curves_units_and_places_are_read() {
    let draft = draft(SAMPLE);
    let front = draft.pieces.iter().find(|p| p.name == "front").unwrap();
    assert_eq!(
        front.outline[0].curve,
        Curve::Line {
            start: Vec2::zeros(),
            end: Vec2::new(0.2, 0.0)
        }
    );
    // Half-way along an upward edge of 30 cm, and a tenth of its length to the left.
    let quadratic = Curve::Quadratic {
        start: Vec2::new(0.2, 0.0),
        control: Vec2::new(0.17, 0.15),
        end: Vec2::new(0.2, 0.3),
    };
    for t in [0.0, 0.3, 0.7, 1.0] {
        let gap = front.outline[1].curve.point(t) - quadratic.point(t);
        assert!(gap.norm() < 1e-12);
    }
    let Curve::Arc { bulge, .. } = front.outline[3].curve else {
        panic!("{:?}", front.outline[3].curve);
    };
    // A chord of 30 cm of a circle of 20 cm radius, bulging to the right of its downward direction.
    assert!((bulge - (0.5 * 0.75f64.asin()).tan()).abs() < 1e-12);
    assert!(front.outline[3].curve.point(0.5).x < -0.05);
    let Worn::Placed(place) = front.worn else {
        panic!("{:?}", front.worn);
    };
    assert!((place.translation.vector.y - 1.0).abs() < 1e-12);
    assert!((place.translation.vector.z - 0.25).abs() < 1e-12);
    let reading = read_garmentcode(SAMPLE).unwrap();
    assert!(
        reading
            .pattern
            .panel_named("front")
            .unwrap()
            .edge_named("neck")
            .is_some()
    );
    assert_eq!(reading.notes, []);
}

#[test]
fn stitches_run_start_to_end_unless_marked() {
    let pattern = read_garmentcode(SAMPLE).unwrap().pattern;
    for seam in &pattern.seams {
        let [a, b] = [&seam.sides[0][0], &seam.sides[1][0]];
        assert!(!a.backwards && b.backwards);
        assert!(seam.right_sides_together && !seam.multi_ply);
    }
    let marked = SAMPLE.replace(
        r#"{ "panel": "back", "edge": 0 }]"#,
        r#"{ "panel": "back", "edge": 0 }, "right_wrong"]"#,
    );
    let reading = read_garmentcode(&marked).unwrap();
    let seam = &reading.pattern.seams[1];
    assert!(!seam.sides[1][0].backwards);
    assert!(!seam.right_sides_together);
    assert!(
        reading.notes.iter().any(|n| n.what.contains("twisted")),
        "{:?}",
        reading.notes
    );
}

#[test]
fn older_files_are_sewn_by_place_in_space() {
    // Bare curvature lists; both panels are wound alike, so that the nearer ends pair start with start.
    let older = SAMPLE
        .replace(
            r#"{ "type": "quadratic", "params": [[0.5, 0.1]] }"#,
            "[0.5, 0.1]",
        )
        .replace(
            "[[0, 0], [0, 30], [20, 30], [20, 0]]",
            "[[0, 0], [20, 0], [20, 30], [0, 30]]",
        )
        .replace(
            r#""stitches": ["#,
            r#""stitches": [[{ "panel": "front", "edge": 0 }, { "panel": "back", "edge": 0 }],"#,
        );
    let pattern = read_garmentcode(&older).unwrap().pattern;
    assert!(!pattern.seams[0].sides[1][0].backwards);
    let mut curves = pattern.sheets.iter().flat_map(|sheet| &sheet.curves);
    let bowed = curves.find(|curve| matches!(curve.rule, CurveRule::Spline { .. }));
    assert!(bowed.is_some_and(|curve| curve.name == "e1"));
}

#[test]
fn lengths_that_differ_are_ease_or_gathers() {
    let pattern = read_garmentcode(SAMPLE).unwrap().pattern;
    // A straight side of 30 cm sewn to a curved one that is less than 5 % longer.
    assert!(!pattern.seams[0].gathered && pattern.seams[0].ease.value().unwrap() > 1e-4);
    let gathered = SAMPLE.replace("[20, 30], [20, 0]]", "[35, 30], [35, -20]]");
    assert!(read_garmentcode(&gathered).unwrap().pattern.seams[0].gathered);
}

#[test]
fn darts_keep_the_vertex_they_share() {
    let text = r#"{"pattern": {"panels": {"p": {
        "translation": [0,0,0], "rotation": [0,0,0],
        "vertices": [[0,0],[9,0],[10,5],[11,0],[20,0],[20,20],[0,20]],
        "edges": [{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,3]},
                  {"endpoints":[3,4]},{"endpoints":[4,5]},{"endpoints":[5,6]},{"endpoints":[6,0]}]}},
        "stitches": [[{"panel":"p","edge":1},{"panel":"p","edge":2},"right_wrong"]]},
        "properties": {"units_in_meter": 100, "curvature_coords": "relative"}}"#;
    let draft = draft(text);
    let meshes = toile_assembly::mesh_pieces(&draft, 0.01).unwrap();
    for stitch in &meshes.stitches {
        let [a, b] = stitch.vertices.map(|v| meshes.pieces[0].points[v as usize]);
        assert!((a.x + b.x - 0.2).abs() < 1e-9 && (a.y - b.y).abs() < 1e-9);
    }
    assert!(!meshes.stitches.is_empty());
}

#[test]
fn edges_out_of_order_and_absolute_coordinates_are_understood() {
    let text = r#"{"pattern": {"panels": {"p": {
        "translation": [0,0,0], "rotation": [0,0,0],
        "vertices": [[0,0],[100,0],[100,100],[0,100]],
        "edges": [{"endpoints":[0,1]},{"endpoints":[3,2],"curvature":[50,120]},{"endpoints":[1,2]},{"endpoints":[3,0]}]}},
        "stitches": []}, "properties": {"units_in_meter": 1000, "curvature_coords": "absolute"}}"#;
    let reading = read_garmentcode(text).unwrap();
    let (draft, _) = reading.pattern.resolve(&Measurements::new());
    let curves: Vec<Curve> = draft.pieces[0].outline.iter().map(|e| e.curve).collect();
    assert_eq!(curves.len(), 4);
    for k in 0..4 {
        assert_eq!(curves[k].end(), curves[(k + 1) % 4].start());
    }
    let control = Vec2::new(0.05, 0.12);
    assert!(
        curves.iter().any(
            |c| matches!(c, Curve::Cubic { start, controls: [p, _], .. } if (start + (p - start) * 1.5 - control).norm() < 1e-12)
        )
    );
}

#[test]
fn refusals_say_where_and_what_to_do() {
    let cases = [
        ("{", "line 1", "JSON"),
        ("[]", "the file", "object"),
        ("{}", "the file", "\"pattern\" is missing"),
        (r#"{"pattern":{"panels":{}}}"#, "pattern.panels", "no panel"),
        (
            &SAMPLE.replace("[2, 3], \"curv", "[2, 9], \"curv"),
            "pattern.panels.front.edges[2].endpoints[1]",
            "vertex 9",
        ),
        (
            &SAMPLE.replace("[3, 0] }\n", "[3, 1] }\n"),
            "pattern.panels.back.edges",
            "closed outline",
        ),
        (
            &SAMPLE.replace("\"circle\"", "\"spiral\""),
            "curvature.type",
            "spiral",
        ),
        (
            &SAMPLE.replace("\"edge\": 2 }]", "\"edge\": 22 }]"),
            "pattern.stitches[0][1].edge",
            "no edge 22",
        ),
        (
            &SAMPLE.replace(
                "{ \"panel\": \"back\", \"edge\": 2",
                "{ \"panel\": \"bak\", \"edge\": 2",
            ),
            "pattern.stitches[0][1].panel",
            "bak",
        ),
        (
            &SAMPLE.replace("\"units_in_meter\": 100", "\"units_in_meter\": 0"),
            "properties.units_in_meter",
            "0 units",
        ),
        (
            &SAMPLE.replace(
                "[20, 0], [20, 30], [0, 30]]",
                "[20, \"x\"], [20, 30], [0, 30]]",
            ),
            "vertices[1][1]",
            "number",
        ),
        (
            &SAMPLE.replace("[0, 100, 25]", "[0, 1e300, 25]"),
            "translation[1]",
            "too large",
        ),
    ];
    for (text, place, what) in cases {
        let error = read_garmentcode(text).unwrap_err();
        assert!(error.place.contains(place), "{error}");
        assert!(error.what.contains(what), "{error}");
        assert!(!error.hint.is_empty());
    }
}

#[test]
fn unknown_fields_and_doubtful_turns_are_reported() {
    let text = SAMPLE
        .replace("\"pattern\": {", "\"author\": \"me\", \"pattern\": {")
        .replacen(
            "\"rotation\": [0, 0, 0]",
            "\"rotation\": [10, 20, 0], \"layer\": 3",
            1,
        );
    let notes = read_garmentcode(&text).unwrap().notes;
    for word in ["author", "layer", "Rz Ry Rx"] {
        assert!(
            notes.iter().any(|n| n.what.contains(word)),
            "{word}: {notes:?}"
        );
    }
}

#[test]
fn turned_panels_are_turned_about_z_last() {
    let text = SAMPLE.replacen("\"rotation\": [0, 0, 0]", "\"rotation\": [90, 0, 90]", 1);
    let draft = draft(&text);
    let Worn::Placed(place) = draft
        .pieces
        .iter()
        .find(|p| p.name == "front")
        .unwrap()
        .worn
    else {
        panic!("not placed");
    };
    // The rotation about x tips the panel's up direction to +z, and the rotation about z leaves it there.
    let up = place.rotation * toile_geometry::Vec3::y();
    assert!((up - toile_geometry::Vec3::z()).norm() < 1e-12, "{up}");
    let right = place.rotation * toile_geometry::Vec3::x();
    assert!(
        (right - toile_geometry::Vec3::y()).norm() < 1e-12,
        "{right}"
    );
}

/// Compares geometry, places and seams of two drafts.
fn assert_same(a: &Draft, b: &Draft) {
    assert_eq!(a.pieces.len(), b.pieces.len());
    assert_eq!(a.seams.len(), b.seams.len());
    for (p, q) in a.pieces.iter().zip(&b.pieces) {
        assert_eq!(p.name, q.name);
        assert_eq!(p.outline.len(), q.outline.len());
        for (e, f) in p.outline.iter().zip(&q.outline) {
            for k in 0..=8 {
                let t = f64::from(k) / 8.0;
                let gap = (e.curve.point(t) - f.curve.point(t)).norm();
                assert!(gap < 1e-12, "{}: {gap}", p.name);
            }
        }
        let (Worn::Placed(x), Worn::Placed(y)) = (p.worn, q.worn) else {
            panic!("not placed");
        };
        assert!((x.translation.vector - y.translation.vector).norm() < 1e-12);
        assert!(x.rotation.angle_to(&y.rotation) < 1e-9);
    }
    for (s, t) in a.seams.iter().zip(&b.seams) {
        assert_eq!(s.sides, t.sides);
        assert_eq!(s.right_sides_together, t.right_sides_together);
    }
}

#[test]
fn written_and_read_again_it_is_the_same() {
    for text in [
        SAMPLE.to_owned(),
        SAMPLE.replace("\"edge\": 0 }]", "\"edge\": 0 }, \"right_wrong\"]"),
        SAMPLE.replacen("\"rotation\": [0, 0, 0]", "\"rotation\": [10, 20, 30]", 1),
    ] {
        let first = draft(&text);
        let second = draft(&write_garmentcode(&first).text);
        assert_same(&first, &second);
    }
}

#[test]
fn partial_spans_are_cut_into_whole_edges() {
    let mut first = draft(SAMPLE);
    let seam = &mut first.seams[0];
    seam.sides[0][0].to = 0.4;
    let writing = write_garmentcode(&first);
    let second = draft(&writing.text);
    let (a, b) = (&first.pieces, &second.pieces);
    let count =
        |pieces: &[toile_pattern::Piece]| pieces.iter().map(|p| p.outline.len()).sum::<usize>();
    assert_eq!(count(b), count(a) + 1);
    assert_eq!(second.seams.len(), 2);
    let span = &second.seams[0].sides[0][0];
    let length = second.pieces[span.piece].outline[span.edge].curve.length();
    let whole = first.seams[0].sides[0][0];
    let expected = 0.4 * first.pieces[whole.piece].outline[whole.edge].curve.length();
    assert!((length - expected).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_files_never_panic(
        at in 0..SAMPLE.len(),
        cut in 0..40usize,
        put in "[\\[\\]{}\",:0-9a-z.eE-]{0,6}",
    ) {
        let end = (at + cut).min(SAMPLE.len());
        let text = format!("{}{put}{}", &SAMPLE[..at], &SAMPLE[end..]);
        if let Ok(reading) = read_garmentcode(&text) {
            let (draft, _) = reading.pattern.resolve(&Measurements::new());
            let writing = write_garmentcode(&draft);
            prop_assert!(read_garmentcode(&writing.text).is_ok() || draft.pieces.iter().all(|p| !p.sewn));
            // Meshing a damaged file must not panic either; the size of the mesh is bounded.
            let _ = toile_assembly::mesh_pieces(&draft, 0.05);
        } else {
            let error = read_garmentcode(&text).unwrap_err();
            prop_assert!(!error.place.is_empty() && !error.hint.is_empty());
        }
    }
}
