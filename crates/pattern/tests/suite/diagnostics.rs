//! Every fault a pattern can have is found, at its place, with a remedy.

use crate::sample::*;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::*;

/// Checks that the pattern has exactly the faults named, and each a message and a remedy.
fn check(pattern: &Pattern, expected: &[(Code, Place)]) {
    let found = faults(pattern);
    let places: Vec<_> = found.iter().map(|d| (d.code, d.place.clone())).collect();
    assert_eq!(places, expected, "{found:#?}");
    for diagnostic in &found {
        assert!(diagnostic.message.len() > 10 && diagnostic.hint.len() > 10);
    }
}

fn front(pattern: &Pattern) -> PanelId {
    panel_id(pattern, "front")
}

fn hole(pattern: &mut Pattern, corners: [(f64, f64); 3]) -> Place {
    let mut k = 0;
    let points = corners.map(|(x, y)| {
        k += 1;
        put_point(pattern, 0, &format!("h{k}"), PointRule::at(x, y))
    });
    let line = put_line(pattern, 0, ("hole", LineKind::Hole), &points);
    Place::Line(front(pattern), line)
}

/// Adds an edge to the front's sheet that no line has yet.
fn loose_edge(pattern: &mut Pattern, name: &str, ends: [PointId; 2]) -> Edge {
    let curve: CurveId = pattern.ids.take();
    let sheet = Arc::make_mut(&mut pattern.sheets[0]);
    sheet.curves.push(Arc::new(Curve {
        id: curve,
        name: name.into(),
        ends,
        rule: CurveRule::Line,
    }));
    Edge {
        id: pattern.ids.take(),
        name: name.into(),
        curve,
        ends,
        allowance: None,
        corner: EdgeCorner::default(),
    }
}

#[test]
fn the_sample_is_sound() {
    check(&sample(), &[]);
}

#[test]
fn an_open_outline() {
    let mut pattern = sample();
    let loose = put_point(&mut pattern, 0, "loose", PointRule::at(0.1, 0.7));
    let corner = point(&pattern, "front", "p2");
    let top = loose_edge(&mut pattern, "to nowhere", [corner, loose]);
    alter(&mut pattern, 0, |panel| panel.lines[0].edges[2] = top);
    let place = Place::Edge(front(&pattern), edge(&pattern, "front", "left"));
    check(&pattern, &[(Code::OpenOutline, place)]);
}

#[test]
fn a_self_crossing_outline() {
    let mut pattern = sample();
    place(&mut pattern, 0, "p2", PointRule::at(-0.1, 0.3));
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
    let twin = put_point(&mut pattern, 0, "twin", PointRule::at(0.4, 0.0));
    let [corner, above] = ends(&pattern, "front", "right");
    let nothing = loose_edge(&mut pattern, "nothing", [corner, twin]);
    let right = loose_edge(&mut pattern, "right again", [twin, above]);
    let place = Place::Edge(front(&pattern), nothing.id);
    pattern.seams.clear();
    alter(&mut pattern, 1, |panel| panel.cut.quantity = 0);
    alter(&mut pattern, 0, |panel| {
        panel.lines[0].edges[1] = right;
        panel.lines[0].edges.insert(1, nothing);
    });
    check(&pattern, &[(Code::ZeroLengthEdge, place)]);
}

#[test]
fn holes_wound_wrongly_or_outside() {
    let mut pattern = sample();
    hole(&mut pattern, [(0.1, 0.1), (0.1, 0.2), (0.2, 0.1)]);
    check(&pattern, &[]);
    let mut pattern = sample();
    let place = hole(&mut pattern, [(0.1, 0.1), (0.2, 0.1), (0.1, 0.2)]);
    check(&pattern, &[(Code::HoleWinding, place)]);
    let mut pattern = sample();
    let place = hole(&mut pattern, [(1.1, 0.1), (1.1, 0.2), (1.2, 0.1)]);
    check(&pattern, &[(Code::HoleOutside, place)]);
}

#[test]
fn seams_to_nowhere() {
    let gone = PointId(10_000);
    for change in [
        |span: &mut Span, _| span.panel = PanelId(10_000),
        |span: &mut Span, _| span.line = Name::Drawn(LineId(10_000)),
        |span: &mut Span, gone| span.to = Mark::corner(gone),
        |span: &mut Span, _| span.copy = 1,
        |span: &mut Span, _| span.half = 1,
    ] {
        let mut pattern = sample();
        alter_seam(&mut pattern, 0, |seam| change(&mut seam.sides[0][0], gone));
        check_seam(&pattern, Code::MissingSpan);
    }
    let mut pattern = sample();
    alter_seam(&mut pattern, 0, |seam| seam.sides[1].clear());
    check_seam(&pattern, Code::MissingSpan);
    for share in [1.5, 0.0] {
        let mut pattern = sample();
        let left = ends(&pattern, "back", "left");
        alter_seam(&mut pattern, 0, |seam| {
            seam.sides[1][0].from = Mark::between(left, share);
            seam.sides[1][0].to = Mark::between(left, 0.0);
        });
        check_seam(&pattern, Code::BadSpan);
    }
}

/// Checks that the first seam has that fault and there is no other.
fn check_seam(pattern: &Pattern, code: Code) {
    check(pattern, &[(code, Place::Seam(pattern.seams[0].id))]);
}

#[test]
fn seam_lengths_beyond_their_ease() {
    let mut pattern = sample();
    let right = ends(&pattern, "front", "right");
    alter_seam(&mut pattern, 0, |seam| {
        seam.sides[0][0].to = Mark::between(right, 0.9);
    });
    check_seam(&pattern, Code::SeamLength);
    alter_seam(&mut pattern, 0, |seam| seam.ease = formula("5.9cm"));
    check_seam(&pattern, Code::SeamLength);
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
    let inside = put_point(&mut pattern, 0, "inside", PointRule::at(0.2, 0.3));
    let border = put_point(&mut pattern, 0, "border", PointRule::at(0.4, 0.3));
    let outside = put_point(&mut pattern, 0, "outside", PointRule::at(0.5, 0.3));
    let pocket = ("pocket", LineKind::Internal);
    put_line(&mut pattern, 0, pocket, &[inside, border]);
    check(&pattern, &[]);
    let line = put_line(
        &mut pattern,
        0,
        ("flap", LineKind::Internal),
        &[inside, outside],
    );
    let place = Place::Line(front(&pattern), line);
    check(&pattern, &[(Code::LineOutside, place)]);
    // The cloth has what lies inside, so the garment can be made.
    assert_eq!(faults(&pattern)[0].severity, Severity::Note);
}

#[test]
fn panels_sewn_to_nothing() {
    let mut pattern = sample();
    let mut ids = pattern.ids;
    let pocket = rectangle(&mut ids, "pocket", pattern.fabrics[0].id, [0.1, 0.1]);
    let id = pocket.1.id;
    pattern.add(pocket);
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
        (named("length(front.elephant)"), Code::MissingReference),
        (named("length(elephant.top)"), Code::MissingReference),
        (named("x(front.p1)"), Code::Cycle),
        (named("length(front.right)"), Code::Cycle),
    ] {
        let mut pattern = sample();
        let rule = PointRule::At {
            x: number,
            y: Number::ZERO,
        };
        place(&mut pattern, 0, "p1", rule);
        let found = pattern.check(&Measurements::adult());
        let point = Place::Point(point(&pattern, "front", "p1"));
        assert_eq!(
            (found[0].code, &found[0].place),
            (code, &point),
            "{found:?}"
        );
    }
}

/// A formula that speaks of the sample's parts.
fn named(text: &str) -> Number {
    formula_in(&sample(), text)
}

#[test]
fn cycles_are_named_whole() {
    let mut pattern = sample();
    // Names are known before their formulas are read.
    let ids = ["a", "b", "c"].map(|name| put_variable(&mut pattern, name, Number::ZERO));
    for (k, text) in ["b + 1cm", "2 * c", "max(a, 1cm)"].into_iter().enumerate() {
        let number = formula_in(&pattern, text);
        assert_eq!(pattern.variables[k].id, ids[k]);
        Arc::make_mut(&mut pattern.variables[k]).number = number;
    }
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].message.contains("a -> b -> c -> a"),
        "{}",
        found[0].message
    );
}

/// Variables each of which is one more than the next.
fn chain(length: usize, last: &dyn Fn(&Pattern) -> Number) -> Pattern {
    let mut pattern = sample();
    for k in 0..length {
        put_variable(&mut pattern, &format!("v{k}"), Number::ZERO);
    }
    let names = Names::new(&pattern);
    for k in 0..length - 1 {
        let text = format!("v{} + 1", k + 1);
        let number = Number::Formula(Formula::parse(&text, &names).unwrap());
        Arc::make_mut(&mut pattern.variables[k]).number = number;
    }
    let number = last(&pattern);
    Arc::make_mut(&mut pattern.variables[length - 1]).number = number;
    pattern
}

#[test]
fn long_chains_have_values_and_long_cycles_are_one_fault() {
    let pattern = chain(10_000, &|_| Number::Value(1.0));
    assert!(pattern.check(&Measurements::adult()).is_empty());
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let first = evaluation.variable(pattern.variables[0].id);
    assert_eq!(first, Some((10_000.0, 0)));
    let pattern = chain(3000, &|pattern| formula_in(pattern, "v0"));
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code, Code::Cycle);
}

#[test]
fn measurements_that_are_not_given_are_borrowed_with_a_note() {
    let mut pattern = sample();
    let id = pattern.ids.take();
    pattern.sizes.push(Arc::new(Size {
        id,
        name: "M".into(),
        measurements: Measurements::adult(),
    }));
    put_variable(&mut pattern, "quarter", formula("bust / 4"));
    let found = pattern.check(&Measurements::new());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].code, Code::BorrowedMeasurement);
    assert_eq!(found[0].severity, Severity::Note);
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
        let kind = dart(&pattern, "top", at, width, Apex::Depth(depth.into()));
        let id = put_operation(&mut pattern, 0, "dart", kind);
        let found = faults(&pattern);
        assert_eq!(found.first().map(|d| d.code), code, "{found:?}");
        let place = Place::Operation(front(&pattern), id);
        let here = |d: &Diagnostic| d.place == place;
        assert!(found.iter().all(here), "{found:?}");
    }
}

#[test]
fn dart_legs_of_different_lengths() {
    let mut pattern = sample();
    let apex = put_point(&mut pattern, 0, "apex", PointRule::at(0.25, 0.5));
    let kind = dart(&pattern, "top", 0.5, 0.05, Apex::Point(apex));
    let id = put_operation(&mut pattern, 0, "dart", kind);
    let place = Place::Operation(front(&pattern), id);
    check(&pattern, &[(Code::SeamLength, place)]);
}

#[test]
fn notches_off_their_edge() {
    let pattern = sample();
    let top = ends(&pattern, "front", "top");
    let along = |text: &str| Mark::Along {
        from: Name::Drawn(top[0]),
        distance: formula(text),
    };
    for (at, sound) in [
        (Mark::between(top, 0.5), true),
        (Mark::between(top, 1.1), false),
        (along("39cm"), true),
        (along("-39cm"), true),
        (along("1.9m"), true),
        (along("2.1m"), false),
        (along("-2.1m"), false),
    ] {
        let mut pattern = sample();
        let id: NotchId = pattern.ids.take();
        let notch = Notch {
            id,
            name: "notch".into(),
            line: outline(&pattern, "front"),
            at,
            kind: NotchKind::Slit,
        };
        alter(&mut pattern, 0, |panel| panel.notches.push(notch));
        let expected = [(Code::NotchOffEdge, Place::Notch(front(&pattern), id))];
        check(&pattern, if sound { &[] } else { &expected });
    }
}

/// What is lost suspends what needs it, is told once, and comes back when its name does.
#[test]
fn lost_parts_wait_for_their_return() {
    let mut pattern = sample();
    let apex = put_point(&mut pattern, 0, "apex", PointRule::at(0.2, 0.5));
    let kind = dart(&pattern, "top", 0.5, 0.05, Apex::Point(apex));
    let id = put_operation(&mut pattern, 0, "dart", kind);
    let number = formula_in(&pattern, "x(front.apex) / 1m");
    let variable = put_variable(&mut pattern, "share", number);
    let whole = pattern.clone();
    check(&whole, &[]);
    pattern.apply(&[Edit::Remove(apex.into())]).unwrap();
    let places = [
        Place::Variable(variable),
        Place::Operation(front(&pattern), id),
    ];
    let expected = places.map(|place| (Code::MissingReference, place));
    check(&pattern, &expected);
    let text = pattern.variables[0].number.as_formula().unwrap();
    assert_eq!(
        text.text(&Names::new(&pattern)),
        format!("x(?{}) / 1m", apex.0)
    );
    let (sheet, point) = whole.point(apex).unwrap();
    let back = Edit::Put(Entity::Point(sheet.id, point.clone()));
    pattern.apply(&[back]).unwrap();
    assert!(pattern.says_the_same(&whole));
    check(&pattern, &[]);
}

#[test]
fn bad_fabrics_folds_pairs_and_duplicates() {
    let mut pattern = sample();
    Arc::make_mut(&mut pattern.fabrics[0]).material.density = 0.0;
    let place = Place::Fabric(pattern.fabrics[0].id);
    check(&pattern, &[(Code::BadFabric, place)]);

    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "left",
        CurveRule::Arc { bulge: 0.3.into() },
    );
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
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
    alter(&mut pattern, 0, |panel| panel.allowance = (-0.01).into());
    let found = pattern.check(&Measurements::adult());
    assert!(found.iter().all(|d| d.code == Code::Negative) && found.len() == 4);
}

#[test]
fn an_outline_of_a_hundred_thousand_edges() {
    let mut pattern = sample();
    let count = 100_000;
    let mut ids = pattern.ids;
    let fabric = pattern.fabrics[0].id;
    let mut drawing = PanelBuilder::new(&mut ids, "coast", fabric);
    let mut points: Vec<PointId> = Vec::new();
    for k in 0..count {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let radius = 0.5 + 0.1 * (7.0 * angle).cos() + 1e-4 * f64::from(k % 2);
        let rule = PointRule::at(angle.cos() * radius, angle.sin() * radius);
        points.push(drawing.point(format!("p{k}"), rule));
    }
    let mut edges = Vec::new();
    for k in 0..points.len() {
        let ends = [points[k], points[(k + 1) % points.len()]];
        edges.push(drawing.edge(format!("e{k}"), ends, CurveRule::Line));
    }
    drawing.line("outline", LineKind::Outline, edges);
    let drawn = drawing.done();
    let id = drawn.1.id;
    pattern.add(drawn);
    check(&pattern, &[(Code::NotSewn, Place::Panel(id))]);
}

#[test]
fn check_draft_finds_the_same_in_a_draft() {
    let mut pattern = sample();
    place(&mut pattern, 0, "p2", PointRule::at(-0.1, 0.3));
    let (mut draft, found) = pattern.resolve(&Measurements::adult());
    assert!(found.is_empty());
    let found = check_draft(&draft);
    assert!(found.iter().any(|d| d.code == Code::SelfCrossing));
    draft.seams[0].sides[0][0].edge = 99;
    let found = check_draft(&draft);
    assert!(found.iter().any(|d| d.code == Code::MissingSpan));
}
