//! Walking a seam, against closed forms: where the pieces touch, how the second lies, how the edges
//! beside the seam go on across it, and which notches meet.

use crate::sample::*;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::walk::{FixedSide, Joint, Smoothness, Walk, WalkedNotch};
use toile_pattern::*;

fn drafted(pattern: &Pattern) -> Draft {
    let (draft, found) = pattern.resolve(&Measurements::adult());
    assert!(found.is_empty(), "{found:?}");
    draft
}

fn walk<'d>(draft: &'d Draft, name: &str) -> Walk<'d> {
    let seam = draft.seams.iter().find(|seam| seam.name == name).unwrap();
    Walk::new(draft, seam).unwrap()
}

fn v(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

fn near(a: Vec2, b: Vec2) -> bool {
    (a - b).norm() < 1e-9
}

/// Puts a notch on an edge of the k-th panel.
fn put_notch(pattern: &mut Pattern, k: usize, (panel, edge): (&str, &str), share: f64) {
    let notch = Notch {
        id: pattern.ids.take(),
        name: format!("{panel} {share}"),
        line: outline(pattern, panel),
        at: Mark::between(ends(pattern, panel, edge), share),
        kind: NotchKind::Slit,
    };
    alter(pattern, k, |panel| panel.notches.push(notch));
}

/// Kinks at both ends (deg).
fn kinks(joints: &[Option<Joint>; 2]) -> [f64; 2] {
    joints.map(|joint| joint.unwrap().kink.to_degrees())
}

#[test]
fn rectangles_lie_edge_to_edge_and_all_lines_go_on() {
    let pattern = sample();
    let draft = drafted(&pattern);
    let walk = walk(&draft, "one side");
    assert_eq!(walk.lengths(), [0.6, 0.6]);
    for along in [0.0, 0.13, 0.6] {
        let contact = walk.contact(along, FixedSide::First);
        assert_eq!(contact.along, [along, along]);
        assert_eq!(contact.pieces, [0, 1]);
        assert!(near(contact.places[0], v(0.4, along)));
        assert!(near(contact.places[1], v(0.0, along)));
        for (x, y) in [(0.0, 0.0), (0.4, 0.0), (0.1, 0.6)] {
            assert!(near(contact.laid.apply(v(x, y)), v(x + 0.4, y)));
        }
        let other = walk.contact(along, FixedSide::Second);
        assert!(near(other.laid.apply(v(0.3, 0.2)), v(-0.1, 0.2)));
    }
    assert_eq!(walk.contact(9.0, FixedSide::First).along[0], 0.6);
    let joints = walk.joints(0.0);
    for (joint, name) in joints.iter().zip(["bottom", "top"]) {
        let joint = joint.unwrap();
        assert!(joint.kink.abs() < 1e-12 && joint.step.abs() < 1e-12);
        assert_eq!(joint.line(&pattern, &draft), name);
        assert_eq!(joint.smoothness(), Smoothness::Smooth);
    }
    let [start, _] = joints.map(Option::unwrap);
    assert!(near(start.corners[0], v(0.4, 0.0)) && near(start.corners[1], v(0.0, 0.0)));
    assert!(near(start.leaving[0], v(-1.0, 0.0)) && near(start.leaving[1], v(1.0, 0.0)));
}

#[test]
fn trapezoids_have_a_peak_at_one_end_and_a_dip_at_the_other() {
    let (a, b) = (7_f64.to_radians(), 4_f64.to_radians());
    let mut pattern = sample();
    place(
        &mut pattern,
        0,
        "p2",
        PointRule::at(0.4 - 0.6 * a.tan(), 0.6),
    );
    place(&mut pattern, 1, "p3", PointRule::at(0.6 * b.tan(), 0.6));
    let draft = drafted(&pattern);
    let walk = walk(&draft, "one side");
    let joints = walk.joints(0.0);
    let [start, end] = kinks(&joints);
    assert!((start - 11.0).abs() < 1e-9, "a peak: {start}");
    assert!((end + 11.0).abs() < 1e-9, "a dip: {end}");
    assert_eq!(joints[0].unwrap().smoothness(), Smoothness::Kink);
    let longer = 0.6 / a.cos() - 0.6 / b.cos();
    assert!((joints[1].unwrap().step - longer).abs() < 1e-12);
    assert_eq!(joints[0].unwrap().step, 0.0);
    assert_eq!(walk.joints(0.01)[1].unwrap().step, 0.0, "taken in by ease");
    // The back is turned until its left side runs as the right side of the front does.
    for along in [0.0, 0.3] {
        let laid = walk.contact(along, FixedSide::First).laid;
        let turned = laid.axes[0].y.atan2(laid.axes[0].x);
        assert!((turned - (a + b)).abs() < 1e-12);
        assert!((laid.axes[0].perp(&laid.axes[1]) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn arcs_of_one_radius_roll_as_wheels_do() {
    let bulge: f64 = 0.2;
    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc {
            bulge: bulge.into(),
        },
    );
    bend(
        &mut pattern,
        1,
        "left",
        CurveRule::Arc {
            bulge: bulge.into(),
        },
    );
    let draft = drafted(&pattern);
    let walk = walk(&draft, "one side");
    let half = 2.0 * bulge.atan();
    let radius = 0.3 / half.sin();
    let centres = [
        v(0.4 - radius * half.cos(), 0.3),
        v(radius * half.cos(), 0.3),
    ];
    let length = 2.0 * half * radius;
    assert!((walk.lengths()[0] - length).abs() < 1e-12);
    for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let along = share * length;
        let contact = walk.contact(along, FixedSide::First);
        let angle = along / radius - half;
        let outward = v(angle.cos(), angle.sin());
        assert!(near(contact.places[0], centres[0] + outward * radius));
        let rolled = contact.laid.apply(centres[1]);
        assert!(near(rolled, centres[0] + outward * (2.0 * radius)));
        let turned = contact.laid.axes[0].y.atan2(contact.laid.axes[0].x);
        assert!((turned - 2.0 * angle).abs() < 1e-9, "{share}: {turned}");
        assert!(near(
            contact.laid.apply(contact.places[1]),
            contact.places[0]
        ));
    }
    let [start, end] = kinks(&walk.joints(0.0));
    let expected = -2.0 * half.to_degrees();
    assert!((start - expected).abs() < 1e-9 && (end - expected).abs() < 1e-9);
}

#[test]
fn a_dart_in_the_seam_is_passed_over_closed() {
    let mut pattern = sample();
    let kind = dart(&pattern, "right", 0.5, 0.04, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    for name in ["p2", "p3"] {
        let x = if name == "p2" { 0.4 } else { 0.0 };
        place(&mut pattern, 1, name, PointRule::at(x, 0.56));
    }
    // On the back opposite the dart, 4 mm and 12 mm above it.
    for up in [0.28, 0.284, 0.292] {
        put_notch(&mut pattern, 1, ("back", "left"), 1.0 - up / 0.56);
    }
    let draft = drafted(&pattern);
    let walk = walk(&draft, "one side");
    assert!((walk.lengths()[0] - 0.56).abs() < 1e-12);
    let before = walk.contact(0.27, FixedSide::First);
    assert!(near(before.laid.apply(v(0.0, 0.0)), v(0.4, 0.0)));
    let after = walk.contact(0.29, FixedSide::First);
    assert!(near(after.places[0], v(0.4, 0.33)));
    assert!(
        near(after.laid.apply(v(0.0, 0.0)), v(0.4, 0.04)),
        "past the mouth"
    );
    let joints = walk.joints(0.0);
    let [start, end] = kinks(&joints);
    assert!(start.abs() < 1e-9 && end.abs() < 1e-9);
    assert!(joints[1].unwrap().step.abs() < 1e-12);
    let partners: Vec<Option<f64>> = walk.notches().iter().map(|n| n.partner).collect();
    assert!(partners[0].unwrap().abs() < 1e-9, "the dart: {partners:?}");
    assert!((partners[1].unwrap() + 0.004).abs() < 1e-9, "{partners:?}");
    assert_eq!(partners[2..], [None]);
    assert_eq!(walk.nearest(0, 0, v(0.5, 0.1)), Some(0.1));
    assert!((walk.nearest(0, 0, v(0.5, 0.4)).unwrap() - 0.36).abs() < 1e-12);
}

#[test]
fn a_dart_beside_the_seam_is_closed_before_the_next_edge_is_judged() {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.05, 0.04, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    let draft = drafted(&pattern);
    let joint = walk(&draft, "one side").joints(0.0)[1].unwrap();
    // Between the seam and the first leg lies half of what the dart takes, between the second leg and
    // the top a right angle and the other half.
    let taken = 2.0 * (0.02_f64 / 0.1).atan();
    assert_eq!(joint.line(&pattern, &draft), "top");
    assert!(
        (joint.kink + taken).abs() < 1e-9,
        "{}",
        joint.kink.to_degrees()
    );
}

#[test]
fn a_straight_edge_dips_where_its_dart_is_closed() {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.04, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    let draft = drafted(&pattern);
    let [mouth, apex] = walk(&draft, "dart of front").joints(0.0);
    let mouth = mouth.unwrap();
    let taken = 2.0 * (0.02_f64 / 0.1).atan();
    assert_eq!(mouth.line(&pattern, &draft), "top");
    assert!((mouth.kink + taken).abs() < 1e-9);
    assert_eq!(apex, None);
}

#[test]
fn a_pair_lies_as_mirror_images_and_a_panel_drawn_alike_is_turned_over() {
    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
    });
    let right = span(&pattern, "front", "right");
    let copy = Span {
        copy: 1,
        ..right.clone()
    };
    let centre = [vec![right.clone()], vec![copy]];
    let alike = [vec![right], vec![span(&pattern, "back", "right")]];
    for (name, sides) in [("centre", centre), ("alike", alike)] {
        let seam = Seam::new(pattern.ids.take(), name, sides);
        pattern.seams.push(Arc::new(seam));
    }
    let draft = drafted(&pattern);
    let pair = walk(&draft, "centre").contact(0.2, FixedSide::First);
    assert_eq!(pair.pieces, [0, 1]);
    assert!(near(pair.places[1], v(-0.4, 0.2)));
    assert!(near(pair.laid.apply(v(0.0, 0.0)), v(0.8, 0.0)));
    assert!(near(pair.laid.apply(v(-0.1, 0.6)), v(0.7, 0.6)));
    for fixed in [FixedSide::First, FixedSide::Second] {
        let turned = walk(&draft, "alike").contact(0.2, fixed);
        assert!(near(turned.laid.apply(v(0.4, 0.5)), v(0.4, 0.5)));
        assert!(near(turned.laid.apply(v(0.0, 0.1)), v(0.8, 0.1)));
    }
    let [start, end] = kinks(&walk(&draft, "alike").joints(0.0));
    assert!(start.abs() < 1e-9 && end.abs() < 1e-9);
}

#[test]
fn the_other_half_of_a_folded_panel_is_walked_as_the_half_that_is_drawn() {
    let mut pattern = sample();
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    pattern.seams.remove(1);
    place(&mut pattern, 0, "p1", PointRule::at(0.45, 0.0));
    let half = Span {
        half: 1,
        ..span(&pattern, "front", "right")
    };
    let sides = [vec![half], vec![span(&pattern, "back", "right")]];
    let seam = Seam::new(pattern.ids.take(), "other half", sides);
    pattern.seams.push(Arc::new(seam));
    let draft = drafted(&pattern);
    let lean = (0.05_f64 / 0.6).atan().to_degrees();
    for name in ["one side", "other half"] {
        let joints = walk(&draft, name).joints(0.0);
        let [start, end] = kinks(&joints);
        assert!(
            (start - lean).abs() < 1e-9 && (end + lean).abs() < 1e-9,
            "{name}"
        );
    }
    let contact = walk(&draft, "other half").contact(0.0, FixedSide::First);
    assert!(near(contact.places[0], v(-0.45, 0.0)));
    assert!(
        contact.laid.apply(v(0.0, 0.3)).x < -0.45,
        "on the other side"
    );
    let joints = walk(&draft, "other half").joints(0.0);
    assert_eq!(joints[0].unwrap().edges.map(|edge| edge.half), [1, 0]);
}

#[test]
fn where_an_edge_goes_on_past_the_seam_no_line_crosses_it() {
    let mut pattern = sample();
    let half_way = Mark::between(ends(&pattern, "front", "right"), 0.5);
    alter_seam(&mut pattern, 0, |seam| seam.sides[0][0].to = half_way);
    let draft = drafted(&pattern);
    let joints = walk(&draft, "one side").joints(0.0);
    assert!(joints[0].is_some() && joints[1].is_none());
}

#[test]
fn what_is_gathered_is_spread_evenly_and_leaves_no_step() {
    let mut pattern = sample();
    for name in ["p2", "p3"] {
        let x = if name == "p2" { 0.4 } else { 0.0 };
        place(&mut pattern, 1, name, PointRule::at(x, 0.3));
    }
    alter_seam(&mut pattern, 0, |seam| seam.gathered = true);
    let draft = drafted(&pattern);
    let walk = walk(&draft, "one side");
    assert_eq!(walk.contact(0.2, FixedSide::First).along, [0.2, 0.1]);
    assert_eq!(walk.joints(0.0)[1].unwrap().step, 0.0);
}

#[test]
fn notches_are_matched_with_those_opposite() {
    let mut pattern = sample();
    // On the front 6, 30, 30.7, 45 and 60 cm up; on the back 6 and 30.3 cm.
    for share in [0.1, 0.5, 0.307 / 0.6, 0.75, 1.0] {
        put_notch(&mut pattern, 0, ("front", "right"), share);
    }
    for share in [0.9, 1.0 - 0.303 / 0.6] {
        put_notch(&mut pattern, 1, ("back", "left"), share);
    }
    let draft = drafted(&pattern);
    let notches = walk(&draft, "one side").notches();
    let told: Vec<(usize, f64, Option<f64>, bool)> = notches
        .iter()
        .map(|n: &WalkedNotch| {
            let round = |x: f64| (x * 1e6).round() / 1e6;
            (n.side, round(n.along), n.partner.map(round), n.meets())
        })
        .collect();
    assert_eq!(
        told,
        [
            (0, 0.06, Some(0.0), true),
            (0, 0.3, Some(0.003), false),
            (0, 0.307, None, false),
            (0, 0.45, None, false),
            (0, 0.6, Some(0.0), true),
            (1, 0.06, Some(0.0), true),
            (1, 0.303, Some(-0.003), false),
        ]
    );
}

#[test]
fn a_walk_that_is_begun_again_is_the_same() {
    let draft = drafted(&sample());
    let seam = &draft.seams[0];
    let walk = Walk::new(&draft, seam).unwrap();
    let again = Walk::again(&draft, seam, &walk.sides());
    assert_eq!(again.lengths(), walk.lengths());
    for along in [0.0, 0.1, 0.4] {
        let both = [&walk, &again].map(|walk| walk.contact(along, FixedSide::Second));
        assert_eq!(both[0], both[1]);
    }
    assert_eq!(again.joints(0.0), walk.joints(0.0));
    assert_eq!(again.notches(), walk.notches());
}

#[test]
fn a_seam_that_is_not_there_is_not_walked() {
    let draft = drafted(&sample());
    let seam = DraftSeam {
        sides: [Vec::new(), draft.seams[0].sides[1].clone()],
        ..draft.seams[0].clone()
    };
    assert!(Walk::new(&draft, &seam).is_none());
    let mut lost = draft.seams[0].clone();
    lost.sides[0][0].edge = 99;
    assert!(Walk::new(&draft, &lost).is_none());
}
