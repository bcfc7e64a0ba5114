//! The proportion box: head counts, legs and breadths a body is brought to.

use toile_body::{Description, Figure, Mannequin, ProportionBox};

fn of_heads(heads: f64) -> ProportionBox {
    ProportionBox::of_heads(heads, &[])
}

fn made(row: &ProportionBox, body: &Description) -> Mannequin {
    Mannequin::from_description(&row.apply(body).unwrap()).unwrap()
}

#[test]
fn figures_of_four_to_eight_heads_have_them() {
    for figure in [Figure::Woman, Figure::Man] {
        let body = Mannequin::framed(figure).unwrap();
        let before = Mannequin::from_description(&body).unwrap();
        let own = ProportionBox::of_body(&before);
        assert!((6.8..8.2).contains(&own.heads), "{figure:?}: {}", own.heads);
        for heads in [4.0, 5.0, 6.0, 7.0, 7.5, 8.0] {
            let after = made(&of_heads(heads), &body);
            let got = ProportionBox::of_body(&after);
            assert!((got.heads / heads - 1.0).abs() < 0.01, "{heads}: {got:?}");
            // The stature stays, and what was not asked keeps its share of what is left.
            let crown = |m: &Mannequin| m.landmarks().crown.y;
            assert!((crown(&after) / crown(&before) - 1.0).abs() < 3e-3);
            let share = |b: &ProportionBox| b.crotch.unwrap() / (b.heads - 1.0);
            assert!((share(&got) / share(&own) - 1.0).abs() < 0.02, "{heads}");
            assert!(after.skin().is_closed_and_oriented());
            assert_eq!(after.skin().euler_characteristic(), 2);
            assert!(
                after.skin_tree().self_intersections().is_empty(),
                "{figure:?}, {heads} heads"
            );
        }
    }
}

#[test]
fn legs_and_breadths_asked_for_are_met_one_by_one() {
    let body = Mannequin::framed(Figure::Man).unwrap();
    let row = ProportionBox {
        crotch: Some(3.4),
        shoulders: Some(1.9),
        hips: Some(1.55),
        ..of_heads(7.2)
    };
    let got = ProportionBox::of_body(&made(&row, &body));
    for (asked, got) in [
        (row.heads, got.heads),
        (row.crotch.unwrap(), got.crotch.unwrap()),
        (row.shoulders.unwrap(), got.shoulders.unwrap()),
        (row.hips.unwrap(), got.hips.unwrap()),
    ] {
        assert!((got / asked - 1.0).abs() < 0.005, "{got} for {asked}");
    }
}

#[test]
fn a_body_brought_back_to_its_own_box_is_the_same_again() {
    let body = Mannequin::framed(Figure::Woman).unwrap();
    let own = ProportionBox::of_body(&Mannequin::from_description(&body).unwrap());
    let there = of_heads(6.0).apply(&body).unwrap();
    let back = own.apply(&there).unwrap();
    let skins = [&body, &back].map(|d| Mannequin::from_description(d).unwrap());
    let furthest = skins[0]
        .skin()
        .positions
        .iter()
        .zip(&skins[1].skin().positions)
        .map(|(a, b)| (a - b).norm())
        .fold(0.0, f64::max);
    // A head count is met to one in two thousand; neck and arms go by where they were then.
    assert!(furthest < 0.03, "{furthest}");
}

#[test]
fn a_head_count_lies_between_the_boxes_next_to_it() {
    let row = |heads: f64, crotch: f64| ProportionBox {
        crotch: Some(crotch),
        ..of_heads(heads)
    };
    let table = [row(5.0, 2.0), row(7.0, 3.2), row(7.0, 3.0)];
    let crotch = |heads: f64| ProportionBox::of_heads(heads, &table).crotch.unwrap();
    assert!((crotch(7.0) - 3.1).abs() < 1e-12);
    assert!((crotch(6.0) - 2.55).abs() < 1e-12);
    // Beyond the table its last box's share of the stature.
    assert!((crotch(4.0) - 1.6).abs() < 1e-12);
    assert!((crotch(8.0) - 3.1 / 7.0 * 8.0).abs() < 1e-12);
    assert_eq!(of_heads(6.0).crotch, None);
}

#[test]
fn what_no_body_has_is_refused() {
    let body = Mannequin::framed(Figure::Mean).unwrap();
    let bad = [
        of_heads(f64::NAN),
        of_heads(1.0),
        of_heads(1e9),
        ProportionBox {
            crotch: Some(0.5),
            ..of_heads(7.0)
        },
        ProportionBox {
            shoulders: Some(40.0),
            ..of_heads(7.0)
        },
        ProportionBox {
            hips: Some(f64::INFINITY),
            ..of_heads(7.0)
        },
    ];
    for row in bad {
        assert!(row.apply(&body).is_err(), "{row:?}");
    }
    let grown = Mannequin::new(&Figure::Man.average(), Figure::Man).unwrap();
    let error = of_heads(7.0).apply(&grown.description()).unwrap_err();
    assert!(error.to_string().contains("frame"), "{error}");
}
