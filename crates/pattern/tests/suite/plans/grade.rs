//! Grade rules: given, copied, mirrored, changed, read off sizes, taken away.

use super::*;
use crate::sample::{formula, place, point, sample};
use toile_pattern::plan::Axis;

/// The sample with sizes S, M and L of growing bust, M the base.
fn sized() -> (Pattern, [SizeId; 3]) {
    let mut pattern = sample();
    let mut ids = Vec::new();
    for (name, bust) in [("S", 0.84), ("M", 0.9), ("L", 0.98)] {
        let mut body = Measurements::adult_woman();
        body.set("bust", bust, toile_measure::Origin::Asked)
            .unwrap();
        let evaluation = evaluated(&pattern);
        let (edits, id) = plan::add_size(&evaluation, Some(name), body).unwrap();
        pattern = done(&pattern, &edits);
        ids.push(id);
    }
    let edits = plan::set_base_size(&evaluated(&pattern), Some(ids[1])).unwrap();
    (done(&pattern, &edits), [ids[0], ids[1], ids[2]])
}

fn in_size(pattern: &Pattern, size: SizeId) -> Evaluation {
    let size = pattern.sizes.iter().find(|known| known.id == size).unwrap();
    Evaluation::new(pattern, size)
}

fn places(pattern: &Pattern, sizes: [SizeId; 3], id: PointId) -> [Vec2; 3] {
    sizes.map(|size| in_size(pattern, size).point(id).unwrap())
}

#[test]
fn a_rule_moves_its_points_and_a_drag_moves_all_sizes_alike() {
    let (pattern, sizes) = sized();
    let [s, m, l] = sizes;
    let corner = point(&pattern, "front", "p2");
    // The shifts hold against the base size, whichever size is shown.
    let evaluation = in_size(&pattern, l);
    let shifts = [(s, v(-0.01, -0.002)), (l, v(0.012, 0.003))];
    let (edits, number) = plan::give_rule(&evaluation, &[corner], &shifts).unwrap();
    let ruled = done(&pattern, &edits);
    assert_eq!(number, 1);
    let names: Vec<&str> = ruled.variables.iter().map(|one| &*one.name).collect();
    assert_eq!(names, ["grade_1_x", "grade_1_y"]);
    let expected = [v(0.39, 0.598), v(0.4, 0.6), v(0.412, 0.603)];
    for (place, expected) in places(&ruled, sizes, corner).into_iter().zip(expected) {
        same_place(place, expected);
    }
    assert!(in_size(&ruled, l).diagnostics().is_empty());
    let before = places(&ruled, sizes, corner);
    for size in sizes {
        let evaluation = in_size(&ruled, size);
        let to = evaluation.point(corner).unwrap() + v(0.005, -0.007);
        let edits = plan::move_point(&evaluation, corner, to).unwrap();
        let after = places(&done(&ruled, &edits), sizes, corner);
        for k in 0..3 {
            same_place(after[k], before[k] + v(0.005, -0.007));
        }
    }
    let evaluation = in_size(&ruled, m);
    let edits = plan::set_rule_shift(&evaluation, 1, (l, v(0.02, 0.0))).unwrap();
    let changed = done(&ruled, &edits);
    same_place(places(&changed, sizes, corner)[2], v(0.42, 0.6));
    same_place(places(&changed, sizes, corner)[0], before[0]);
    let rule = GradeRule::of_number(&changed, 1).unwrap();
    let told = plan::rule_shifts(&evaluated(&changed), rule);
    let told: Vec<(SizeId, Vec2)> = told.iter().map(|own| (own.size, own.by)).collect();
    assert_eq!(
        told,
        [(s, v(-0.01, -0.002)), (m, v(0.0, 0.0)), (l, v(0.02, 0.0))]
    );
}

#[test]
fn rules_are_copied_and_mirrored() {
    let (pattern, sizes) = sized();
    let [_, m, l] = sizes;
    let [a, b, c] = ["p2", "p3", "p0"].map(|name| point(&pattern, "front", name));
    let evaluation = in_size(&pattern, m);
    let (edits, _) = plan::give_rule(&evaluation, &[a], &[(l, v(0.01, 0.002))]).unwrap();
    let ruled = done(&pattern, &edits);
    let evaluation = in_size(&ruled, l);
    let edits = plan::copy_rule(&evaluation, a, &[b, c]).unwrap();
    let copied = done(&ruled, &edits);
    same_place(places(&copied, sizes, b)[2], v(0.01, 0.602));
    let evaluation = in_size(&copied, l);
    let edits = plan::mirror_rule(&evaluation, &[b], Axis::X).unwrap();
    let mirrored = done(&copied, &edits);
    same_place(places(&mirrored, sizes, b)[1], v(0.0, 0.6));
    same_place(places(&mirrored, sizes, b)[2], v(-0.01, 0.602));
    let edits = plan::mirror_rule(&evaluated(&mirrored), &[c], Axis::Y).unwrap();
    let mirrored = done(&mirrored, &edits);
    same_place(places(&mirrored, sizes, c)[2], v(0.01, -0.002));
    assert_eq!(
        plan::rule_of(&mirrored, c).unwrap().is_turned,
        [false, true]
    );
    let rule = GradeRule::all(&mirrored)[0];
    assert_eq!(plan::points_of_rule(&mirrored, rule), [c, a, b]);
    // A changed rule moves all of its points, each as it is turned.
    let edits = plan::set_rule_shift(&evaluated(&mirrored), 1, (l, v(0.03, 0.004))).unwrap();
    let changed = done(&mirrored, &edits);
    same_place(places(&changed, sizes, a)[2], v(0.43, 0.604));
    same_place(places(&changed, sizes, b)[2], v(-0.03, 0.604));
    same_place(places(&changed, sizes, c)[2], v(0.03, -0.004));
    // The rule stays while a point has it, and goes with the last.
    let edits = plan::ungrade(&evaluated(&changed), &[a, b]).unwrap();
    let less = done(&changed, &edits);
    assert_eq!(GradeRule::all(&less).len(), 1);
    assert_eq!(places(&less, sizes, a), [v(0.4, 0.6); 3]);
    let edits = plan::ungrade(&evaluated(&less), &[c]).unwrap();
    let none = done(&less, &edits);
    assert!(none.variables.is_empty());
    assert!(none.says_the_same(&pattern));
}

#[test]
fn rules_read_off_sizes_give_the_same_places() {
    let (mut pattern, sizes) = sized();
    let points = ["p0", "p1", "p2", "p3"].map(|name| point(&pattern, "front", name));
    place(
        &mut pattern,
        0,
        "p1",
        PointRule::At {
            x: formula("bust / 2 - 5cm"),
            y: 0.0.into(),
        },
    );
    place(
        &mut pattern,
        0,
        "p2",
        PointRule::Offset {
            base: points[1],
            x: 0.0.into(),
            y: 0.6.into(),
        },
    );
    let before = points.map(|id| places(&pattern, sizes, id));
    let (edits, count) = plan::rules_of_sizes(&in_size(&pattern, sizes[2]), &points).unwrap();
    let ruled = done(&pattern, &edits);
    assert_eq!(count, 2, "the others lie alike in all sizes");
    assert_eq!(GradeRule::all(&ruled).len(), 1, "both move alike");
    for (id, before) in points.into_iter().zip(before) {
        for (one, other) in places(&ruled, sizes, id).into_iter().zip(before) {
            assert!((one - other).norm() < 1e-12, "{one:?} is not {other:?}");
        }
    }
    // The bust of size L no longer moves them, and their rule does.
    let measured = plan::set_measurement(&evaluated(&ruled), sizes[2], "bust", Some(1.2)).unwrap();
    let measured = done(&ruled, &measured);
    assert_eq!(
        places(&measured, sizes, points[1]),
        places(&ruled, sizes, points[1])
    );
    let again = plan::rules_of_sizes(&evaluated(&ruled), &points).unwrap();
    assert_eq!(again, (Vec::new(), 0));
}

#[test]
fn wishes_that_cannot_be_granted_are_refused() {
    let (mut pattern, [s, m, l]) = sized();
    let corner = point(&pattern, "front", "p2");
    let moving = point(&pattern, "front", "p1");
    place(
        &mut pattern,
        0,
        "p1",
        PointRule::At {
            x: formula("bust / 2"),
            y: 0.0.into(),
        },
    );
    let evaluation = in_size(&pattern, m);
    let give = |points: &[PointId], shifts: &[(SizeId, Vec2)]| {
        refusal(plan::give_rule(&evaluation, points, shifts))
    };
    for (told, says) in [
        (give(&[], &[]), "no points are chosen"),
        (give(&[corner], &[(m, v(0.01, 0.0))]), "base size"),
        (
            give(&[corner], &[(SizeId(9999), v(0.01, 0.0))]),
            "size 9999",
        ),
        (give(&[corner], &[(l, v(f64::NAN, 0.0))]), "not finite"),
        (give(&[corner], &[(l, v(11.0, 0.0))]), "longer than 10 m"),
        (give(&[PointId(9999)], &[(l, v(0.1, 0.0))]), "point 9999"),
        (give(&[moving], &[(l, v(0.1, 0.0))]), "read rules off"),
        (
            refusal(plan::copy_rule(&evaluation, corner, &[moving])),
            "no grade rule",
        ),
        (
            refusal(plan::mirror_rule(&evaluation, &[corner], Axis::X)),
            "no grade rule",
        ),
        (
            refusal(plan::ungrade(&evaluation, &[moving])),
            "no grade rule",
        ),
        (
            refusal(plan::set_rule_shift(&evaluation, 4, (s, v(0.0, 0.0)))),
            "grade rule 4",
        ),
    ] {
        assert!(told.contains(says), "{told}");
    }
    let bare = sample();
    let corner = point(&bare, "front", "p2");
    let told = refusal(plan::give_rule(&evaluated(&bare), &[corner], &[]));
    assert!(told.contains("add sizes"), "{told}");
}

#[test]
fn even_shifts_grow_from_the_base_size_and_jumps_are_told() {
    let (pattern, [s, m, l]) = sized();
    let corner = point(&pattern, "front", "p2");
    let shifts = plan::even_shifts(&pattern, v(0.01, 0.0));
    assert_eq!(shifts, [(s, v(-0.01, 0.0)), (l, v(0.01, 0.0))]);
    let (edits, number) = plan::give_rule(&evaluated(&pattern), &[corner], &shifts).unwrap();
    let ruled = done(&pattern, &edits);
    let jumps = |pattern: &Pattern| -> Vec<bool> {
        let rule = GradeRule::of_number(pattern, number).unwrap();
        let told = plan::rule_shifts(&evaluated(pattern), rule);
        told.iter().map(|own| own.is_jump).collect()
    };
    assert_eq!(jumps(&ruled), [false; 3]);
    let edits = plan::set_rule_shift(&evaluated(&ruled), number, (l, v(0.015, 0.0))).unwrap();
    let uneven = done(&ruled, &edits);
    assert_eq!(jumps(&uneven), [false, false, true]);
    assert_eq!(in_size(&uneven, m).point(corner), Some(v(0.4, 0.6)));
}
