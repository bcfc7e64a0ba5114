//! Points struck with a compass: on a line at a distance from a point, and at two distances, in closed forms.

use crate::sample::*;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::*;

/// Places of the points that the rules below are made from (m).
fn drawn(places: &[[f64; 2]]) -> (Pattern, Vec<PointId>) {
    let mut pattern = sample();
    let ids = places.iter().enumerate().map(|(k, [x, y])| {
        let rule = PointRule::at(*x, *y);
        put_point(&mut pattern, 0, &format!("given{k}"), rule)
    });
    let ids = ids.collect();
    (pattern, ids)
}

fn on_line(places: [[f64; 2]; 3], distance: f64, far: bool) -> (Pattern, PointId) {
    let (mut pattern, ids) = drawn(&places);
    let rule = PointRule::OnLineAt {
        line: [ids[0], ids[1]],
        centre: ids[2],
        distance: distance.into(),
        far,
    };
    let made = put_point(&mut pattern, 0, "made", rule);
    (pattern, made)
}

fn by_two(places: [[f64; 2]; 2], distances: [f64; 2], left: bool) -> (Pattern, PointId) {
    let (mut pattern, ids) = drawn(&places);
    let rule = PointRule::TwoDistances {
        centres: [ids[0], ids[1]],
        distances: distances.map(Number::from),
        left,
    };
    let made = put_point(&mut pattern, 0, "made", rule);
    (pattern, made)
}

fn found((pattern, made): (Pattern, PointId)) -> Vec2 {
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    assert_eq!(evaluation.diagnostics(), []);
    evaluation.point(made).unwrap()
}

/// The fault of a rule that has no place, with its remedy.
fn fault((pattern, made): (Pattern, PointId)) -> (String, String) {
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    assert_eq!(evaluation.point(made), None);
    let own = evaluation.diagnostics();
    let own = own.into_iter().find(|one| one.place == Place::Point(made));
    let own = own.unwrap();
    (own.message, own.hint)
}

fn is_at(found: Vec2, [x, y]: [f64; 2]) {
    assert!((found - Vec2::new(x, y)).norm() < 1e-12, "{found} {x} {y}");
}

const RIGHT: [f64; 2] = [0.5, 0.0];
const ORIGIN: [f64; 2] = [0.0, 0.0];

#[test]
fn a_compass_meets_a_line_where_three_four_five_says() {
    // The centre is 3 above the line, the compass 5 wide: it meets the line 4 to either side.
    let above = [0.2, 0.03];
    is_at(
        found(on_line([ORIGIN, RIGHT, above], 0.05, true)),
        [0.24, 0.0],
    );
    is_at(
        found(on_line([ORIGIN, RIGHT, above], 0.05, false)),
        [0.16, 0.0],
    );
    // The farther place is farther in the direction of the line.
    is_at(
        found(on_line([RIGHT, ORIGIN, above], 0.05, true)),
        [0.16, 0.0],
    );
    // The line goes on beyond its points.
    let beyond = [0.9, -0.03];
    is_at(
        found(on_line([ORIGIN, RIGHT, beyond], 0.05, true)),
        [0.94, 0.0],
    );
    // On a line that rises by 3 in 4 a centre on it is met at the distance along it.
    let slope = [[0.0, 0.0], [0.4, 0.3], [0.08, 0.06]];
    is_at(found(on_line(slope, 0.05, true)), [0.12, 0.09]);
    is_at(found(on_line(slope, 0.05, false)), [0.04, 0.03]);
}

#[test]
fn a_compass_that_touches_a_line_meets_it_once() {
    let above = [0.2, 0.03];
    for far in [true, false] {
        is_at(
            found(on_line([ORIGIN, RIGHT, above], 0.03, far)),
            [0.2, 0.0],
        );
    }
}

#[test]
fn a_compass_that_does_not_reach_its_line_is_told_with_a_remedy() {
    let (message, hint) = fault(on_line([ORIGIN, RIGHT, [0.2, 0.03]], 0.0299, true));
    assert!(
        message.contains("farther away than the distance"),
        "{message}"
    );
    assert!(hint.contains("longer"), "{hint}");
    let (message, _) = fault(on_line([ORIGIN, ORIGIN, [0.2, 0.03]], 0.05, true));
    assert!(message.contains("same place"), "{message}");
}

#[test]
fn two_compasses_meet_where_three_four_five_says() {
    // 30 and 40 from points that are 50 apart: a right angle, 24 beside the line and 18 along it.
    is_at(
        found(by_two([ORIGIN, RIGHT], [0.3, 0.4], true)),
        [0.18, 0.24],
    );
    is_at(
        found(by_two([ORIGIN, RIGHT], [0.3, 0.4], false)),
        [0.18, -0.24],
    );
    is_at(
        found(by_two([RIGHT, ORIGIN], [0.4, 0.3], true)),
        [0.18, -0.24],
    );
    // A leg that is longer than the way between both.
    is_at(
        found(by_two([ORIGIN, [0.03, 0.0]], [0.05, 0.04], true)),
        [0.03, 0.04],
    );
}

#[test]
fn two_compasses_that_touch_meet_once() {
    for left in [true, false] {
        is_at(found(by_two([ORIGIN, RIGHT], [0.2, 0.3], left)), [0.2, 0.0]);
        // One within the other.
        is_at(found(by_two([ORIGIN, RIGHT], [0.8, 0.3], left)), [0.8, 0.0]);
    }
}

#[test]
fn two_compasses_that_do_not_meet_are_told_with_a_remedy() {
    for distances in [[0.2, 0.29], [0.9, 0.3], [0.3, 0.9]] {
        let (message, hint) = fault(by_two([ORIGIN, RIGHT], distances, true));
        assert!(message.contains("no point has both distances"), "{message}");
        assert!(hint.contains("circles meet"), "{hint}");
    }
    let (message, _) = fault(by_two([ORIGIN, ORIGIN], [0.2, 0.2], true));
    assert!(message.contains("same place"), "{message}");
}

#[test]
fn a_struck_point_follows_what_it_is_made_from() {
    let (mut pattern, made) = by_two([ORIGIN, RIGHT], [0.3, 0.4], true);
    let moved = pattern.sheets[0].point_named("given1").unwrap().id;
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    // 30 from the origin and 40 from a point 70 away: touching.
    let edits = plan::move_point(&evaluation, moved, Vec2::new(0.7, 0.0)).unwrap();
    pattern.apply(&edits).unwrap();
    is_at(at(&pattern, made), [0.3, 0.0]);
}
