//! Every fault a pattern can have is found, at its place, with a remedy.
#![allow(clippy::unwrap_used)]

mod sample;

use sample::*;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::*;

/// Checks that the pattern has exactly the faults named, and each a message and a remedy.
fn check(pattern: &Pattern, expected: &[(Code, Place)]) {
    let found = pattern.check(&Measurements::adult());
    let places: Vec<_> = found.iter().map(|d| (d.code, d.place.clone())).collect();
    assert_eq!(places, expected, "{found:#?}");
    for diagnostic in &found {
        assert!(diagnostic.message.len() > 10 && diagnostic.hint.len() > 10);
    }
}

fn front_edge(pattern: &Pattern, name: &str) -> EdgeId {
    edge(pattern, "front", name).1
}

fn hole(pattern: &mut Pattern, corners: [(f64, f64); 3]) {
    let points = corners.map(|(x, y)| {
        let name = format!("h{}", pattern.ids.point);
        put_point(pattern, 0, &name, PointPlace::at(x, y))
    });
    let edges = (0..3).map(|k| Edge {
        id: EdgeId(100 + k as u32),
        name: format!("hole{k}"),
        ends: [points[k], points[(k + 1) % 3]],
        curve: EdgeCurve::Line,
        seam_allowance: None,
    });
    let edges: Vec<_> = edges.collect();
    alter(pattern, 0, |panel| panel.holes.push(edges));
}

#[test]
fn the_sample_is_sound() {
    check(&sample(), &[]);
}

#[test]
fn an_open_outline() {
    let mut pattern = sample();
    let loose = put_point(&mut pattern, 0, "loose", PointPlace::at(0.1, 0.7));
    alter(&mut pattern, 0, |panel| panel.outline[2].ends[1] = loose);
    let left = front_edge(&pattern, "left");
    check(&pattern, &[(Code::OpenOutline, Place::Edge(FRONT, left))]);
}

#[test]
fn a_self_crossing_outline() {
    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.points[2].place = PointPlace::at(-0.1, 0.3);
    });
    let found = pattern.check(&Measurements::adult());
    assert!(
        found.iter().any(|d| d.code == Code::SelfCrossing),
        "{found:?}"
    );
    assert!(found[0].message.contains("x = "), "{}", found[0].message);
}

#[test]
fn a_zero_length_edge() {
    let mut pattern = sample();
    let twin = put_point(&mut pattern, 0, "twin", PointPlace::at(0.4, 0.0));
    alter(&mut pattern, 0, |panel| {
        let corner = panel.points[1].id;
        panel.outline[1].ends[0] = twin;
        panel.outline.insert(
            1,
            Edge {
                id: EdgeId(100),
                name: "nothing".into(),
                ends: [corner, twin],
                curve: EdgeCurve::Line,
                seam_allowance: None,
            },
        );
    });
    check(
        &pattern,
        &[(Code::ZeroLengthEdge, Place::Edge(FRONT, EdgeId(100)))],
    );
}

#[test]
fn holes_wound_wrongly_or_outside() {
    let mut pattern = sample();
    hole(&mut pattern, [(0.1, 0.1), (0.1, 0.2), (0.2, 0.1)]);
    check(&pattern, &[]);
    let mut pattern = sample();
    hole(&mut pattern, [(0.1, 0.1), (0.2, 0.1), (0.1, 0.2)]);
    check(&pattern, &[(Code::HoleWinding, Place::Hole(FRONT, 0))]);
    let mut pattern = sample();
    hole(&mut pattern, [(1.1, 0.1), (1.1, 0.2), (1.2, 0.1)]);
    check(&pattern, &[(Code::HoleOutside, Place::Hole(FRONT, 0))]);
}

#[test]
fn seams_to_nowhere() {
    for change in [
        |span: &mut Span| span.panel = PanelId(7),
        |span: &mut Span| span.edge = EdgeId(77),
        |span: &mut Span| span.copy = 1,
        |span: &mut Span| span.reflected = true,
    ] {
        let mut pattern = sample();
        alter_seam(&mut pattern, 0, |seam| change(&mut seam.sides[0][0]));
        check(&pattern, &[(Code::MissingSpan, Place::Seam(SeamId(0)))]);
    }
    let mut pattern = sample();
    alter_seam(&mut pattern, 0, |seam| seam.sides[1].clear());
    check(&pattern, &[(Code::MissingSpan, Place::Seam(SeamId(0)))]);
    let mut pattern = sample();
    alter_seam(&mut pattern, 0, |seam| seam.sides[1][0].from = 1.5.into());
    check(&pattern, &[(Code::BadSpan, Place::Seam(SeamId(0)))]);
}

#[test]
fn seam_lengths_beyond_their_ease() {
    let mut pattern = sample();
    alter_seam(&mut pattern, 0, |seam| seam.sides[0][0].to = 0.9.into());
    check(&pattern, &[(Code::SeamLength, Place::Seam(SeamId(0)))]);
    alter_seam(&mut pattern, 0, |seam| seam.ease = formula("5.9cm"));
    check(&pattern, &[(Code::SeamLength, Place::Seam(SeamId(0)))]);
    alter_seam(&mut pattern, 0, |seam| seam.ease = formula("6cm"));
    check(&pattern, &[]);
    alter_seam(&mut pattern, 0, |seam| {
        seam.ease = Number::ZERO;
        seam.gathered = true;
    });
    check(&pattern, &[]);
}

#[test]
fn internal_lines_that_leave_the_panel() {
    let mut pattern = sample();
    let inside = put_point(&mut pattern, 0, "inside", PointPlace::at(0.2, 0.3));
    let border = put_point(&mut pattern, 0, "border", PointPlace::at(0.4, 0.3));
    let outside = put_point(&mut pattern, 0, "outside", PointPlace::at(0.5, 0.3));
    let line = |end| InternalLine {
        id: InternalLineId(3),
        name: "pocket".into(),
        segments: vec![LineSegment {
            ends: [inside, end],
            curve: EdgeCurve::Line,
        }],
    };
    alter(&mut pattern, 0, |panel| {
        panel.internal_lines.push(line(border))
    });
    check(&pattern, &[]);
    alter(&mut pattern, 0, |panel| {
        panel.internal_lines[0] = line(outside)
    });
    let place = Place::InternalLine(FRONT, InternalLineId(3));
    check(&pattern, &[(Code::LineOutside, place)]);
}

#[test]
fn panels_sewn_to_nothing() {
    let mut pattern = sample();
    let mut ids = pattern.ids;
    let pocket = rectangle(&mut ids, "pocket", [0.1, 0.1]);
    let id = pocket.id;
    pattern.panels.push(Arc::new(pocket));
    check(&pattern, &[(Code::NotSewn, Place::Panel(id))]);
}

#[test]
fn numbers_without_a_value() {
    for (number, code) in [
        (Number::Value(f64::NAN), Code::NotFinite),
        (Number::Value(f64::INFINITY), Code::NotFinite),
        (Number::Value(1e9), Code::TooLarge),
        (formula("bust / 0"), Code::Formula),
        (formula("bust * bust"), Code::Formula),
        (formula("3"), Code::Formula),
        (formula("elephant"), Code::MissingReference),
        (formula("length(front.elephant)"), Code::MissingReference),
        (formula("length(elephant.top)"), Code::MissingReference),
        (formula("x(front.p1)"), Code::Cycle),
        (formula("length(front.right)"), Code::Cycle),
    ] {
        let mut pattern = sample();
        alter(&mut pattern, 0, |panel| {
            panel.points[1].place = PointPlace::At {
                x: number,
                y: Number::ZERO,
            };
        });
        let found = pattern.check(&Measurements::adult());
        let point = Place::Point(FRONT, PointId(1));
        assert_eq!(
            (found[0].code, &found[0].place),
            (code, &point),
            "{found:?}"
        );
    }
}

#[test]
fn cycles_are_named_whole() {
    let mut pattern = sample();
    for (name, text) in [("a", "b + 1cm"), ("b", "2 * c"), ("c", "max(a, 1cm)")] {
        pattern.variables.push(Variable {
            name: name.into(),
            number: formula(text),
        });
    }
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].message.contains("a -> b -> c -> a"),
        "{}",
        found[0].message
    );
    let mut pattern = sample();
    for k in 0..5000 {
        pattern.variables.push(Variable {
            name: format!("v{k}"),
            number: formula(&format!("v{} + 1", k + 1)),
        });
    }
    let found = pattern.check(&Measurements::adult());
    assert!(
        found.iter().any(|d| d.code == Code::TooMany),
        "and no stack overflow"
    );
}

#[test]
fn measurements_that_are_not_given_are_borrowed_with_a_note() {
    let mut pattern = sample();
    pattern.sizes.push(Size {
        name: "M".into(),
        measurements: Measurements::adult(),
    });
    pattern.variables.push(Variable {
        name: "quarter".into(),
        number: formula("bust / 4"),
    });
    let found = pattern.check(&Measurements::new());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].code, Code::BorrowedMeasurement);
    assert_eq!(found[0].severity, Severity::Note);
}

fn dart(pattern: &Pattern, at: f64, width: f64, depth: f64) -> Dart {
    Dart {
        id: DartId(0),
        name: "dart".into(),
        shape: DartShape::Edge {
            edge: front_edge(pattern, "top"),
            at: at.into(),
            width: width.into(),
            tip: DartTip::Depth(depth.into()),
        },
    }
}

#[test]
fn darts_that_do_not_fit() {
    for (at, width, depth, code) in [
        (0.5, 0.05, 0.1, None),
        (0.5, 0.5, 0.1, Some(Code::DartTooWide)),
        (0.02, 0.05, 0.1, Some(Code::DartTooWide)),
        (0.5, -0.05, 0.1, Some(Code::DartTooWide)),
        (0.5, 0.05, 0.7, Some(Code::DartOutside)),
    ] {
        let mut pattern = sample();
        let dart = dart(&pattern, at, width, depth);
        alter(&mut pattern, 0, |panel| panel.darts.push(dart));
        let found = pattern.check(&Measurements::adult());
        assert_eq!(found.first().map(|d| d.code), code, "{found:?}");
        let here = |d: &Diagnostic| d.place == Place::Dart(FRONT, DartId(0));
        assert!(found.iter().all(here), "{found:?}");
    }
}

#[test]
fn dart_legs_of_different_lengths() {
    let mut pattern = sample();
    let apex = put_point(&mut pattern, 0, "apex", PointPlace::at(0.25, 0.5));
    let mut dart = dart(&pattern, 0.5, 0.05, 0.1);
    if let DartShape::Edge { tip, .. } = &mut dart.shape {
        *tip = DartTip::Apex(apex);
    }
    alter(&mut pattern, 0, |panel| panel.darts.push(dart));
    let place = Place::Dart(FRONT, DartId(0));
    check(&pattern, &[(Code::SeamLength, place)]);
}

#[test]
fn notches_off_their_edge() {
    for (at, sound) in [
        (Along::Fraction(0.5.into()), true),
        (Along::Fraction(1.1.into()), false),
        (Along::Distance(formula("39cm")), true),
        (Along::Distance(formula("-39cm")), true),
        (Along::Distance(formula("41cm")), false),
        (Along::Distance(formula("-41cm")), false),
    ] {
        let mut pattern = sample();
        let notch = Notch {
            id: NotchId(0),
            name: "notch".into(),
            edge: front_edge(&pattern, "top"),
            at,
        };
        alter(&mut pattern, 0, |panel| panel.notches.push(notch));
        let place = Place::Notch(FRONT, NotchId(0));
        let expected = [(Code::NotchOffEdge, place)];
        check(&pattern, if sound { &[] } else { &expected });
    }
}

#[test]
fn bad_fabrics_folds_pairs_and_duplicates() {
    let mut pattern = sample();
    Arc::make_mut(&mut pattern.fabrics[0]).density = 0.0;
    check(&pattern, &[(Code::BadFabric, Place::Fabric(FabricId(0)))]);

    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.outline[3].curve = EdgeCurve::Arc { bulge: 0.3.into() };
        panel.fold = Some(panel.outline[3].id);
    });
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found[0].code, Code::BadFold);

    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.cut = Cut {
            quantity: 3,
            mirrored: true,
        };
    });
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found[0].code, Code::OddPair);

    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| panel.cut.quantity = u32::MAX);
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found[0].code, Code::TooMany);

    let mut pattern = sample();
    alter(&mut pattern, 1, |panel| panel.name = "front".into());
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found[0].code, Code::Duplicate);

    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.seam_allowance = (-0.01).into()
    });
    let found = pattern.check(&Measurements::adult());
    assert!(found.iter().all(|d| d.code == Code::Negative) && found.len() == 4);
}

#[test]
fn an_outline_of_a_hundred_thousand_edges() {
    let mut pattern = sample();
    let count = 100_000;
    let mut ids = pattern.ids;
    let mut panel = Panel::new(ids.take_panel(), "coast", FabricId(0));
    for k in 0..count {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let radius = 0.5 + 0.1 * (7.0 * angle).cos() + 1e-4 * f64::from(k % 2);
        panel.points.push(Point {
            id: ids.take_point(),
            name: format!("p{k}"),
            place: PointPlace::at(angle.cos() * radius, angle.sin() * radius),
        });
    }
    let points: Vec<PointId> = panel.points.iter().map(|p| p.id).collect();
    for k in 0..points.len() {
        panel.outline.push(Edge {
            id: ids.take_edge(),
            name: format!("e{k}"),
            ends: [points[k], points[(k + 1) % points.len()]],
            curve: EdgeCurve::Line,
            seam_allowance: None,
        });
    }
    let id = panel.id;
    pattern.panels.push(Arc::new(panel));
    check(&pattern, &[(Code::NotSewn, Place::Panel(id))]);
}

#[test]
fn check_draft_finds_the_same_in_a_draft() {
    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.points[2].place = PointPlace::at(-0.1, 0.3);
    });
    let (mut draft, found) = pattern.resolve(&Measurements::adult());
    assert!(found.is_empty());
    let found = check_draft(&draft);
    assert!(found.iter().any(|d| d.code == Code::SelfCrossing));
    draft.seams[0].sides[0][0].edge = 99;
    let found = check_draft(&draft);
    assert!(found.iter().any(|d| d.code == Code::MissingSpan));
}
