//! What waits for another part, what is placed by what operations make, and names taken twice.

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

/// Checks that the first seam has that fault and there is no other.
fn check_seam(pattern: &Pattern, code: Code) {
    check(pattern, &[(code, Place::Seam(pattern.seams[0].id))]);
}

/// A seam of a panel that cannot be drawn waits for it: what is wrong is told where it is.
#[test]
fn seams_of_a_faulty_panel_have_its_cause() {
    let mut pattern = sample();
    place(
        &mut pattern,
        0,
        "p1",
        PointRule::At {
            x: formula("bust / 0"),
            y: 0.0.into(),
        },
    );
    let number = formula_in(&pattern, "length('one side')");
    put_variable(&mut pattern, "side", number);
    let faulty = Place::Point(point(&pattern, "front", "p1"));
    let found = pattern.check(&Measurements::adult());
    let errors: Vec<_> = found
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .collect();
    assert_eq!(errors.len(), 1, "{found:#?}");
    assert_eq!((errors[0].code, &errors[0].place), (Code::Formula, &faulty));
}

/// Two spans of one side lie on a copy that is not cut any more: one cause, told once.
#[test]
fn a_copy_that_is_not_cut_is_told_once_a_seam() {
    let mut pattern = sample();
    let spans = ["right", "top"].map(|name| span(&pattern, "front", name));
    alter_seam(&mut pattern, 0, |seam| seam.sides[0] = spans.to_vec());
    alter(&mut pattern, 0, |panel| panel.cut.quantity = 0);
    let seam = Place::Seam(pattern.seams[0].id);
    let found = pattern.check(&Measurements::adult());
    let own = found.iter().filter(|one| one.place == seam);
    assert_eq!(own.count(), 1, "{found:#?}");
}

#[test]
fn sewing_to_a_line_inside_is_refused_by_name() {
    let mut pattern = sample();
    let from = put_point(&mut pattern, 0, "from", PointRule::at(0.1, 0.1));
    let to = put_point(&mut pattern, 0, "to", PointRule::at(0.1, 0.7));
    let pocket = ("pocket", LineKind::Internal);
    let line = put_line(&mut pattern, 0, pocket, &[from, to]);
    place(&mut pattern, 0, "to", PointRule::at(0.1, 0.5));
    alter_seam(&mut pattern, 0, |seam| {
        let span = &mut seam.sides[0][0];
        span.line = Name::Drawn(line);
        (span.from, span.to) = (Mark::corner(from), Mark::corner(to));
    });
    check_seam(&pattern, Code::BadSpan);
    let found = pattern.check(&Measurements::adult());
    let says = &found[0].message;
    assert!(
        says.contains("not possible yet") && says.contains("pocket"),
        "{says}"
    );
    assert!(pattern.resolve(&Measurements::adult()).0.seams.len() == 1);
}

/// A panel with two outlines is wrong, and no fold takes the one for the other.
#[test]
fn a_fold_unfolds_the_line_it_names() {
    let mut pattern = sample();
    let corners = [(1.0, 0.0), (1.2, 0.0), (1.2, 0.3)];
    let points =
        corners.map(|(x, y)| put_point(&mut pattern, 0, &format!("q{x}{y}"), PointRule::at(x, y)));
    let line = put_line(&mut pattern, 0, ("second", LineKind::Outline), &points);
    let kind = OperationKind::Fold {
        line: Name::Drawn(line),
        ends: [points[1], points[2]].map(Mark::corner),
    };
    let fold = put_operation(&mut pattern, 0, "fold", kind);
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let stage = evaluation.stage(front(&pattern), Some(fold)).unwrap();
    let edges: Vec<usize> = stage.lines.iter().map(|line| line.edges.len()).collect();
    assert_eq!(edges, [4, 4]);
    let reach = stage.lines[1].edges.iter().map(|e| e.curve.start().x);
    assert!((reach.fold(0.0, f64::max) - 1.4).abs() < 1e-12);
}

/// Marks are taken on the first stage that has their corners, those of darts too.
#[test]
fn marks_are_placed_by_corners_that_operations_make() {
    let mut pattern = sample();
    let [_, left] = ends(&pattern, "front", "top");
    let kind = dart(&pattern, "top", 0.5, 0.04, Apex::Depth(0.1.into()));
    let first = put_operation(&mut pattern, 0, "dart", kind);
    let made = |role, index| Name::Made {
        by: first,
        role,
        index,
    };
    let line = Name::Drawn(outline(&pattern, "front"));
    // Half the way from the mouth's end to the corner: 10 mm less than from the dart's middle.
    let kind = OperationKind::Dart {
        line,
        mouth: Mark::Between {
            ends: [made(Role::Mouth, 1), Name::Drawn(left)],
            share: 0.5.into(),
        },
        intake: 0.02.into(),
        apex: Apex::Depth(0.1.into()),
        trued: false,
        keeps_length: false,
        pressed: toile_pattern::Pressed::default(),
    };
    let second = put_operation(&mut pattern, 0, "second dart", kind);
    let on_leg = Notch {
        id: pattern.ids.take(),
        name: "on the leg".into(),
        line: outline(&pattern, "front"),
        at: Mark::Along {
            from: made(Role::Apex, 0),
            distance: formula("2cm"),
        },
        kind: NotchKind::Slit,
    };
    alter(&mut pattern, 0, |panel| panel.notches.push(on_leg.clone()));
    let mut seam = Seam::new(
        pattern.ids.take(),
        "top",
        [
            vec![Span {
                panel: front(&pattern),
                copy: 0,
                half: 0,
                line,
                from: Mark::Corner(made(Role::Mouth, 1)),
                to: Mark::corner(left),
                backwards: false,
            }],
            vec![span(&pattern, "back", "top").reversed()],
        ],
    );
    seam.ease = 1.0.into();
    pattern.seams.push(Arc::new(seam));
    check(&pattern, &[]);
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
    let second_dart = stage.darts.iter().find(|dart| dart.by == second).unwrap();
    let middle = (second_dart.mouth[0] + second_dart.mouth[1]) * 0.5;
    assert!((middle.x - 0.09).abs() < 1e-12, "{middle}");
    let notch = stage.notches.iter().find(|n| n.id == on_leg.id).unwrap();
    let apex = stage.darts[0].apex;
    assert!(((notch.point - apex).norm() - 0.02).abs() < 1e-12);
    // The seam runs from the mouth to the corner without the second dart.
    let (draft, _) = evaluation.draft();
    let seam = draft.seams.iter().find(|seam| seam.name == "top").unwrap();
    let piece = &draft.pieces[0];
    let length = |span: &DraftSpan| piece.outline[span.edge].curve.length() * (span.to - span.from);
    let walked: f64 = seam.sides[0].iter().map(length).sum();
    assert!((walked - 0.16).abs() < 1e-12, "{walked}");
    // Without the first dart all of these wait, and only the dart is at fault.
    alter(&mut pattern, 0, |panel| {
        let dart = Arc::make_mut(&mut panel.operations[0]);
        if let OperationKind::Dart { intake, .. } = &mut dart.kind {
            *intake = 1.0.into();
        }
    });
    let place = Place::Operation(front(&pattern), first);
    check(&pattern, &[(Code::DartTooWide, place)]);
    // An operation cannot be placed by what a later one makes.
    alter(&mut pattern, 0, |panel| panel.operations.swap(0, 1));
    let found = pattern.check(&Measurements::adult());
    let place = Place::Operation(front(&pattern), second);
    assert!(
        found
            .iter()
            .any(|d| d.place == place && d.message.contains("later")),
        "{found:?}"
    );
}

/// Two parts of one name are found among all that are told apart by names.
#[test]
fn names_that_are_taken_twice_are_found() {
    let size = |pattern: &mut Pattern| {
        let id = pattern.ids.take();
        let measurements = Measurements::adult();
        let name = "M".into();
        pattern.sizes.push(Arc::new(Size {
            id,
            name,
            measurements,
        }));
        Place::Size(id)
    };
    let notch = |pattern: &mut Pattern| {
        let id = pattern.ids.take();
        let notch = Notch {
            id,
            name: "notch".into(),
            line: outline(pattern, "front"),
            at: Mark::between(ends(pattern, "front", "top"), 0.5),
            kind: NotchKind::Slit,
        };
        alter(pattern, 0, |panel| panel.notches.push(notch));
        Place::Notch(front(pattern), id)
    };
    type Making<'m> = &'m dyn Fn(&mut Pattern) -> Place;
    let twice: [(Severity, Making<'_>); 8] = [
        (Severity::Error, &|pattern| {
            size(pattern);
            size(pattern)
        }),
        (Severity::Error, &|pattern| {
            let sheet = Arc::make_mut(&mut pattern.sheets[1]);
            sheet.name = "front".into();
            Place::Sheet(sheet.id)
        }),
        (Severity::Error, &|pattern| {
            let sheet = Arc::make_mut(&mut pattern.sheets[0]);
            let curve = Arc::make_mut(&mut sheet.curves[3]);
            curve.name = "right".into();
            Place::Curve(curve.id)
        }),
        (Severity::Error, &|pattern| {
            alter_seam(pattern, 1, |seam| seam.name = "one side".into());
            Place::Seam(pattern.seams[1].id)
        }),
        (Severity::Warning, &|pattern| {
            let mut fabric = (*pattern.fabrics[0]).clone();
            fabric.id = pattern.ids.take();
            let place = Place::Fabric(fabric.id);
            pattern.fabrics.push(Arc::new(fabric));
            place
        }),
        (Severity::Warning, &|pattern| {
            let [a, b] = [0.1, 0.3]
                .map(|x| put_point(pattern, 0, &format!("at {x}"), PointRule::at(x, 0.3)));
            let line = put_line(pattern, 0, ("outline", LineKind::Internal), &[a, b]);
            Place::Line(front(pattern), line)
        }),
        (Severity::Warning, &|pattern| {
            notch(pattern);
            notch(pattern)
        }),
        (Severity::Warning, &|pattern| {
            let kind = dart(pattern, "top", 0.3, 0.02, Apex::Depth(0.1.into()));
            put_operation(pattern, 0, "dart", kind);
            let kind = dart(pattern, "top", 0.6, 0.02, Apex::Depth(0.1.into()));
            let id = put_operation(pattern, 0, "dart", kind);
            Place::Operation(front(pattern), id)
        }),
    ];
    for (severity, make) in twice {
        let mut pattern = sample();
        let place = make(&mut pattern);
        check(&pattern, &[(Code::Duplicate, place.clone())]);
        let found = pattern.check(&Measurements::adult());
        assert_eq!(found[0].severity, severity, "{place:?}");
    }
}
