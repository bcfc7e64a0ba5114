//! Numbers typed, set, shown and left out.

use super::*;
use crate::sample::{
    alter, bend, dart, edge, ends, fold, formula, outline, point, put_operation, put_point,
    put_variable, sample,
};
use toile_pattern::plan::NumberAddress;

fn read(pattern: &Pattern, text: &str, want: Want) -> Number {
    plan::read_number(&evaluated(pattern), text, want).unwrap()
}

/// The value of a number as typed where something is wanted.
fn value(pattern: &Pattern, text: &str, want: Want) -> f64 {
    let number = read(pattern, text, want);
    evaluated(pattern).number(&number, want).unwrap()
}

#[test]
fn what_is_typed_with_a_unit_where_anything_may_stand_is_shown_with_it() {
    let pattern = sample();
    let evaluation = evaluated(&pattern);
    for typed in ["11deg", "-11deg", "6cm", "1 5/8in", "0.25", "-3"] {
        let number = read(&pattern, typed, Want::Any);
        let shown = plan::number_text(&evaluation, &number, Want::Any);
        assert_eq!(shown, typed);
    }
}

#[test]
fn bare_numbers_mean_the_unit_of_the_document() {
    let mut pattern = sample();
    let bust = Measurements::adult().get("bust").unwrap();
    // So that the word is known to the evaluation.
    put_variable(&mut pattern, "girth", formula("bust"));
    for (unit, metres) in [
        (DisplayUnit::Millimetre, 0.001),
        (DisplayUnit::Centimetre, 0.01),
        (DisplayUnit::Metre, 1.0),
        (DisplayUnit::Inch, 0.0254),
    ] {
        let edits = plan::set_unit(&evaluated(&pattern), unit);
        let pattern = done(&pattern, &edits);
        for (text, wanted) in [
            ("12.3", 12.3 * metres),
            (" -2 ", -2.0 * metres),
            ("10 / 4", 2.5 * metres),
            ("1e1", 10.0 * metres),
            ("2.5cm", 0.025),
            ("1 5/8in", 1.625 * 0.0254),
            ("bust / 4 + 2cm", bust / 4.0 + 0.02),
            ("length(front.right) / 2", 0.3),
        ] {
            assert!(
                (value(&pattern, text, Want::Length) - wanted).abs() < 1e-12,
                "{text}"
            );
        }
        for (text, wanted) in [("90", 90.0), ("45 + 45", 90.0), ("90deg", 90.0)] {
            let found = value(&pattern, text, Want::Angle).to_degrees();
            assert!((found - wanted).abs() < 1e-12, "{text}");
        }
        let half = value(&pattern, "1/2", Want::Plain);
        assert!((half - 0.5).abs() < 1e-15);
        let radians = value(&pattern, "atan2(1, 1)", Want::Angle);
        assert!((radians - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    }
    assert_eq!(read(&pattern, "12.3", Want::Length), Number::Value(0.123));
    assert_eq!(read(&pattern, "2.5cm", Want::Length), Number::Value(0.025));
    assert!(matches!(
        read(&pattern, "2cm + 1mm", Want::Length),
        Number::Formula(_)
    ));
    assert!(matches!(
        read(&pattern, "12cm", Want::Plain),
        Number::Formula(_)
    ));
}

#[test]
fn numbers_are_shown_as_they_may_be_typed() {
    let mut pattern = sample();
    let (edits, size) = plan::add_size(&evaluated(&pattern), None, Measurements::adult()).unwrap();
    pattern = done(&pattern, &edits);
    let formula = Formula::of_measurements("bust / 4").unwrap();
    put_variable(&mut pattern, "girth", formula.clone().into());
    let by = Number::Adjusted {
        formula: formula.clone(),
        by: -0.015,
    };
    let own = Number::PerSize {
        usual: Box::new(formula.clone().into()),
        sizes: vec![(size, 0.2)],
    };
    let cases = [
        (Number::Value(0.123), Want::Length, "12.3cm"),
        (Number::Value(0.1 + 0.2), Want::Length, "30cm"),
        (Number::Value(-1e-14), Want::Length, "0cm"),
        (
            Number::Value(std::f64::consts::FRAC_PI_6),
            Want::Angle,
            "30deg",
        ),
        (Number::Value(0.25), Want::Plain, "0.25"),
        (formula.into(), Want::Length, "bust / 4"),
        (by, Want::Length, "(bust / 4) - 1.5cm"),
        (own, Want::Length, "20cm"),
    ];
    let evaluation = evaluated(&pattern);
    // What was computed is shown shorter than formulas have it; what was typed is shown as it was typed.
    for (value, exact, shown) in [
        (0.123_456_789_1, "12.34567891cm", "12.346cm"),
        (0.123_456, "12.3456cm", "12.3456cm"),
    ] {
        let number = Number::Value(value);
        let [a, b] = [plan::number_text, plan::number_shown]
            .map(|text| text(&evaluation, &number, Want::Length));
        assert_eq!([&*a, &*b], [exact, shown]);
    }
    for (number, want, text) in cases {
        assert_eq!(plan::number_text(&evaluation, &number, want), text);
        let again = plan::read_number(&evaluation, text, want).unwrap();
        let [a, b] = [&number, &again].map(|n| evaluation.number(n, want).unwrap());
        assert!((a - b).abs() < 1e-9, "{text}");
    }
}

#[test]
fn texts_that_are_no_numbers_are_refused() {
    let pattern = sample();
    let evaluation = evaluated(&pattern);
    for (text, says) in [
        ("", "the formula ends too early"),
        ("2 furlongs", "is not a unit: use mm, cm"),
        ("bust /", "column 7"),
        ("length(front.middle)", "front.middle is not there"),
    ] {
        let told = refusal(plan::read_number(&evaluation, text, Want::Length));
        assert!(told.contains(says), "{told}");
    }
}

/// A pattern in which every place of a number is.
fn with_all_places() -> (Pattern, Vec<PartId>) {
    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc { bulge: 0.2.into() },
    );
    let [a, b] = ends(&pattern, "front", "bottom");
    let h = ["h1", "h2"].map(|name| put_point(&mut pattern, 0, name, PointRule::at(0.2, -0.1)));
    bend(&mut pattern, 0, "bottom", CurveRule::cubic(h));
    let right = pattern.sheets[0].curves[1].id;
    let zero = || Number::ZERO;
    let rules = [
        PointRule::Offset {
            base: a,
            x: zero(),
            y: zero(),
        },
        PointRule::Polar {
            base: a,
            angle: zero(),
            distance: zero(),
        },
        PointRule::Between {
            base: a,
            tip: b,
            along: zero(),
            aside: zero(),
        },
        PointRule::Toward {
            base: a,
            tip: b,
            distance: zero(),
        },
        PointRule::OnCurve {
            curve: right,
            share: zero(),
        },
        PointRule::AlongCurve {
            curve: right,
            distance: zero(),
        },
    ];
    let mut parts: Vec<PartId> = vec![a.into()];
    for (k, rule) in rules.into_iter().enumerate() {
        parts.push(put_point(&mut pattern, 0, &format!("q{k}"), rule).into());
    }
    let p = ["u", "w"].map(|name| put_point(&mut pattern, 0, name, PointRule::at(0.2, 0.2)));
    crate::sample::place(&mut pattern, 0, "w", PointRule::at(0.2, 0.4));
    let diamond = OperationKind::Diamond {
        ends: p,
        widest: 0.5.into(),
        intake: 0.01.into(),
    };
    let kinds = [
        dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into())),
        diamond,
        fold(&pattern, "left"),
        OperationKind::Fold {
            line: Name::Drawn(outline(&pattern, "front")),
            ends: [0.0, 1.0].map(|share| Mark::between(ends(&pattern, "front", "left"), share)),
        },
    ];
    for (k, kind) in kinds.into_iter().enumerate() {
        parts.push(put_operation(&mut pattern, 0, &format!("o{k}"), kind).into());
    }
    let line = outline(&pattern, "front");
    let top = ends(&pattern, "front", "top");
    let along = Mark::Along {
        from: Name::Drawn(top[0]),
        distance: 0.05.into(),
    };
    let panel = pattern.panels[0].id;
    for mark in [Mark::between(top, 0.5), along] {
        let wish = (line, mark);
        let (edits, id) = plan::add_notch(&evaluated(&pattern), panel, wish, NotchKind::V).unwrap();
        pattern = done(&pattern, &edits);
        parts.push(id.into());
    }
    alter(&mut pattern, 0, |panel| {
        panel.worn = WornRule::Wrapped {
            part: BodyPart::Trunk,
            facing: Facing::Front,
            level: None,
        };
    });
    crate::sample::alter_seam(&mut pattern, 0, |seam| {
        let from = seam.sides[0][0].from.corners()[0];
        seam.sides[0][0].to = Mark::Along {
            from,
            distance: 0.3.into(),
        };
    });
    put_variable(&mut pattern, "v", 1.0.into());
    parts.extend([
        PartId::from(right),
        pattern.sheets[0].curves[0].id.into(),
        panel.into(),
        edge(&pattern, "front", "right").into(),
        pattern.seams[0].id.into(),
        pattern.variables[0].id.into(),
    ]);
    (pattern, parts)
}

#[test]
fn every_number_is_listed_read_and_set() {
    let (pattern, parts) = with_all_places();
    let evaluation = evaluated(&pattern);
    let mut labels = Vec::new();
    for part in parts {
        let entries = plan::numbers_of(&evaluation, part);
        assert!(
            !entries.is_empty() || matches!(part, PartId::Operation(_)),
            "{part}"
        );
        for entry in entries {
            assert_eq!(entry.place.part, part);
            assert_eq!(plan::number_at(&pattern, &entry.place), entry.number);
            labels.push(entry.label);
            let text = match entry.want {
                Want::Length => "0.03m",
                Want::Angle => "30deg",
                Want::Plain | Want::Any => "0.25",
            };
            let number = read(&pattern, text, entry.want);
            let edits = match plan::set_number(&evaluation, &entry.place, number.clone()) {
                Ok(edits) => edits,
                Err(error) => panic!("{entry:?}: {error}"),
            };
            let after = done(&pattern, &edits);
            assert_eq!(plan::number_at(&after, &entry.place), Some(number));
            let old = entry.number.clone();
            let back = match old {
                Some(old) => plan::set_number(&evaluated(&after), &entry.place, old),
                None => plan::clear_number(&evaluated(&after), &entry.place),
            };
            assert_eq!(done(&after, &back.unwrap()), pattern, "{entry:?}");
        }
    }
    labels.sort_unstable();
    labels.dedup();
    assert_eq!(
        labels,
        [
            "along",
            "angle",
            "aside",
            "bulge",
            "depth",
            "distance",
            "ease",
            "end",
            "grain",
            "height on the body",
            "intake",
            "length",
            "part of the edge",
            "part of the way",
            "seam allowance",
            "start",
            "value",
            "widest at",
            "x",
            "y",
        ]
    );
}

#[test]
fn a_number_moves_what_it_should_in_every_size() {
    let pattern = sample();
    let p1 = point(&pattern, "front", "p1");
    let place = NumberAddress::new(p1, "at.x");
    // Of which factor the unit is meant to be nobody can know.
    let number = read(&pattern, "bust / 2 + 2 * 3", Want::Length);
    let told = refusal(plan::set_number(&evaluated(&pattern), &place, number));
    assert!(
        told.contains("a length is put together with a plain number"),
        "{told}"
    );
    // A bare number beside a length has the document's unit.
    let number = read(&pattern, "bust / 2 + 3", Want::Length);
    assert_eq!(number, read(&pattern, "bust / 2 + 3cm", Want::Length));
    let edits = plan::set_number(&evaluated(&pattern), &place, number).unwrap();
    let after = done(&pattern, &edits);
    for body in bodies() {
        let x = body.get("bust").unwrap() / 2.0 + 0.03;
        same_place(places(&after, &body, &[p1])[0], v(x, 0.0));
    }
}

#[test]
fn numbers_without_a_value_are_refused() {
    let mut pattern = sample();
    let p0 = point(&pattern, "front", "p0");
    let id = put_variable(&mut pattern, "v", formula("2cm"));
    let panel = pattern.panels[0].id;
    let x = NumberAddress::new(p0, "at.x");
    let variable = NumberAddress::new(id, "value");
    let of_text =
        |text: &str| Number::Formula(Formula::parse(text, &Names::new(&pattern)).unwrap());
    let evaluation = evaluated(&pattern);
    let gone = NumberAddress::new(OperationId(9999), "dart.intake");
    let mark = NumberAddress::new(pattern.seams[0].id, "sides.first[7].from.share");
    for (place, number, says) in [
        (
            x.clone(),
            of_text("bus"),
            "there is no variable or measurement \"bus\"",
        ),
        (x.clone(), of_text("2"), "should be a length"),
        (x.clone(), of_text("x(front.p0) + 1cm"), "needs itself"),
        (x.clone(), of_text("2000m"), "beyond"),
        (variable.clone(), of_text("v + 1cm"), "needs itself"),
        (variable.clone(), of_text("bus"), "there is no variable"),
        (x.clone(), f64::NAN.into(), "not finite"),
        (
            NumberAddress::new(panel, "grain"),
            of_text("2cm"),
            "give an angle",
        ),
        (
            gone,
            0.1.into(),
            "the intake of operation 9999 is not there",
        ),
        (mark, 0.1.into(), "is not there"),
        (
            NumberAddress::new(p0, "share"),
            0.1.into(),
            "the share of point",
        ),
    ] {
        let told = refusal(plan::set_number(&evaluation, &place, number));
        assert!(told.contains(says), "{told}");
    }
    let told = refusal(plan::clear_number(&evaluation, &x));
    assert!(told.contains("the x cannot be left out"), "{told}");
    // A variable may be of any dimension.
    for text in ["2", "2cm", "2cm * 3cm", "bust / waist"] {
        assert!(
            plan::set_number(&evaluation, &variable, of_text(text)).is_ok(),
            "{text}"
        );
    }
}

#[test]
fn formulas_are_adjusted_and_sizes_have_values_of_their_own() {
    let (edits, size) =
        plan::add_size(&evaluated(&sample()), None, Measurements::adult_woman()).unwrap();
    let pattern = done(&sample(), &edits);
    let p1 = point(&pattern, "front", "p1");
    let place = NumberAddress::new(p1, "at.x");
    let edits = plan::set_number(&evaluated(&pattern), &place, formula("bust / 2")).unwrap();
    let pattern = done(&pattern, &edits);
    let half = |body: &Measurements| body.get("bust").unwrap() / 2.0;
    let wanted = half(&Measurements::adult()) + 0.02;
    let edits = plan::adjust_number(&evaluated(&pattern), &place, wanted).unwrap();
    let adjusted = done(&pattern, &edits);
    let wish = (size, Some(0.3));
    let edits = plan::set_number_in_size(&evaluated(&adjusted), &place, wish).unwrap();
    let own = done(&adjusted, &edits);
    for body in bodies() {
        same_place(
            places(&adjusted, &body, &[p1])[0],
            v(half(&body) + 0.02, 0.0),
        );
        let x = match body == Measurements::adult_woman() {
            true => 0.3,
            false => half(&body) + 0.02,
        };
        same_place(places(&own, &body, &[p1])[0], v(x, 0.0));
    }
    // Back again, the document is the same as before.
    let wish = (size, None);
    let edits = plan::set_number_in_size(&evaluated(&own), &place, wish).unwrap();
    let back = done(&own, &edits);
    assert_eq!(back, adjusted);
    let edits = plan::adjust_number(&evaluated(&back), &place, wanted - 0.02).unwrap();
    assert_eq!(done(&back, &edits), pattern);
    let evaluation = evaluated(&pattern);
    let lost = NumberAddress::new(VariableId(9999), "value");
    for (found, says) in [
        (
            plan::adjust_number(&evaluation, &place, f64::NAN),
            "not finite",
        ),
        (
            plan::adjust_number(&evaluation, &lost, 0.0),
            "variable 9999 is not there",
        ),
        (
            plan::set_number_in_size(&evaluation, &place, (SizeId(9999), None)),
            "size 9999",
        ),
        (
            plan::set_number_in_size(&evaluation, &lost, wish),
            "variable 9999 is not there",
        ),
        (
            plan::set_number_in_size(&evaluation, &place, (size, Some(f64::NAN))),
            "not finite",
        ),
    ] {
        let told = refusal(found);
        assert!(told.contains(says), "{told}");
    }
}
