//! What is refused, and what changes nothing.

use toile_realtime::{
    Character, CharacterEllipsoid, CharacterJoint, Ellipsoids, Field, Garment, GarmentSettings,
    Group, KeyPose, KeyedClip,
};

/// A ball of 10 cm, and a clip in which it stands.
fn ball() -> Character {
    Character {
        joints: vec![CharacterJoint {
            name: "ball".into(),
            parent: None,
            at: [0.0; 3],
        }],
        groups: vec![Group {
            name: "ball".into(),
            touches: Vec::new(),
        }],
        ellipsoids: vec![CharacterEllipsoid {
            joint: "ball".into(),
            group: "ball".into(),
            at: [0.0; 3],
            semi_axes: [0.1; 3],
            turn: [0.0; 3],
        }],
        clips: vec![KeyedClip {
            name: "stand".into(),
            is_loop: false,
            keys: vec![KeyPose::default()],
        }],
    }
}

const SHEET: [[f32; 3]; 3] = [[-0.1, 0.12, -0.1], [0.1, 0.12, -0.1], [0.0, 0.12, 0.1]];

#[test]
fn clothes_that_cannot_be_are_refused_with_place_and_remedy() {
    let ellipsoids = Ellipsoids::new(&ball()).unwrap();
    let made =
        |positions: &[[f32; 3]], triangles: &[[u32; 3]], change: fn(&mut GarmentSettings)| {
            let mut settings = GarmentSettings::default();
            change(&mut settings);
            Garment::new(&ellipsoids, positions, triangles, settings)
        };
    assert!(made(&SHEET, &[[0, 1, 2]], |_| ()).is_ok());
    let mut lost = SHEET;
    lost[1][2] = f32::NAN;
    let cases = [
        (made(&[], &[], |_| ()), "garment"),
        (made(&lost, &[[0, 1, 2]], |_| ()), "positions[1]"),
        (made(&SHEET, &[[0, 1, 3]], |_| ()), "triangles[0]"),
        (made(&SHEET, &[[0, 1, 1]], |_| ()), "triangles"),
        (made(&SHEET, &[[0, 1, 2]], |s| s.offset = -0.2), "offset"),
        (
            made(&SHEET, &[[0, 1, 2]], |s| s.offset = f32::NAN),
            "offset",
        ),
        (made(&SHEET, &[[0, 1, 2]], |s| s.stretch = 0.0), "stretch"),
        (
            made(&SHEET, &[[0, 1, 2]], |s| s.friction = -1.0),
            "friction",
        ),
        (made(&SHEET, &[[0, 1, 2]], |s| s.rounds = 0), "rounds"),
        (made(&SHEET, &[[0, 1, 2]], |s| s.slack = f32::NAN), "slack"),
    ];
    for (made, place) in cases {
        let error = made.unwrap_err();
        assert_eq!(error.place, place, "{error}");
        assert!(!error.hint.is_empty() && error.to_string().contains(error.hint));
    }
}

#[test]
fn a_player_told_what_is_not_there_refuses() {
    let mut ellipsoids = Ellipsoids::new(&ball()).unwrap();
    let error = ellipsoids.start("fly", 0.1).unwrap_err();
    assert!(error.to_string().contains("no fly among stand"), "{error}");
    for fade in [f32::NAN, -1.0, 1e9] {
        assert_eq!(ellipsoids.start("stand", fade).unwrap_err().place, "fade");
    }
    assert_eq!(ellipsoids.playing(), None);
    assert!(ellipsoids.transform(1).is_none());
}

#[test]
fn times_and_places_that_are_none_move_nothing() {
    let mut ellipsoids = Ellipsoids::new(&ball()).unwrap();
    let settings = GarmentSettings::default();
    let mut worn = Garment::new(&ellipsoids, &SHEET, &[[0, 1, 2]], settings).unwrap();
    let before: Vec<_> = worn.positions().collect();
    ellipsoids.start("stand", 0.0).unwrap();
    ellipsoids.set_place([f32::NAN, 0.0, 0.0], 0.0);
    for dt in [f32::NAN, -1.0, 0.0] {
        ellipsoids.advance(dt);
        worn.adjust_by_gravity(&ellipsoids, dt);
    }
    assert_eq!(worn.positions().collect::<Vec<_>>(), before);
    // A long frame is taken as a short one, and nothing leaves the world.
    worn.adjust_by_gravity(&ellipsoids, f32::INFINITY);
    assert!(worn.positions().flatten().all(|x| x.abs() < 1.0));
}

#[test]
fn a_sheet_falls_onto_the_ball_and_lies_there() {
    let ellipsoids = Ellipsoids::new(&ball()).unwrap();
    let cells = 12u32;
    let at = |k: u32| 0.16 * (k as f32 / cells as f32 - 0.5);
    let positions: Vec<[f32; 3]> = (0..=cells)
        .flat_map(|i| (0..=cells).map(move |j| [at(i), 0.14, at(j)]))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..cells)
        .flat_map(|i| (0..cells).map(move |j| i * (cells + 1) + j))
        .flat_map(|a| {
            [
                [a, a + 1, a + cells + 1],
                [a + 1, a + cells + 2, a + cells + 1],
            ]
        })
        .collect();
    let settings = GarmentSettings::default();
    let mut worn = Garment::new(&ellipsoids, &positions, &triangles, settings).unwrap();
    for _ in 0..240 {
        worn.adjust_by_gravity(&ellipsoids, 1.0 / 60.0);
    }
    assert_eq!(worn.inside_count(), 0);
    let centre = worn.positions().nth(84).unwrap();
    assert!((centre[1] - 0.1).abs() < 2e-3, "{centre:?}");
    let field = Field::new(&ellipsoids, 0.0).unwrap();
    let far = worn.positions().map(|p| field.nearest(p).unwrap().distance);
    assert!(far.fold(0.0, f32::max) < 0.03);
}
