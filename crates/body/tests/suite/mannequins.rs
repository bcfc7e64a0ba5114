//! Whole mannequins: closed skin, measurements, symmetry, inside tests, refusals.

use crate::common::shared;
use proptest::prelude::*;
use toile_body::{BodyError, Conflict, Description, Deviation, Figure, Mannequin, Part};
use toile_geometry::Vec3;
use toile_measure::{Measurements, Origin};

fn built_in() -> [(Figure, Measurements); 3] {
    [
        (Figure::Woman, Measurements::adult_woman()),
        (Figure::Man, Measurements::adult_man()),
        (Figure::Mean, Measurements::adult()),
    ]
}

/// GarmentCode's tables where the shared data are present.
fn yaml_tables() -> Vec<(Figure, Measurements)> {
    let figures = [
        (Figure::Woman, "mean_female"),
        (Figure::Man, "mean_male"),
        (Figure::Mean, "mean_all"),
    ];
    let read = |name: &str| {
        let file = shared(&format!("garmentcode/{name}.yaml"))?;
        let text = std::fs::read_to_string(file).ok()?;
        let mut table = Measurements::new();
        for line in text.lines().skip(1) {
            let (name, value) = line.split_once(':')?;
            let (name, value) = (name.trim(), value.trim().parse::<f64>().ok()?);
            let angle = name.ends_with("_angle") || name.ends_with("_incl");
            let angle = angle || name == "hip_inclination";
            let si = if angle {
                value.to_radians()
            } else {
                value / 100.0
            };
            table.set(name, si, Origin::Asked).ok()?;
        }
        Some(table)
    };
    figures
        .iter()
        .filter_map(|&(figure, name)| Some((figure, read(name)?)))
        .collect()
}

/// Measurements of a GarmentCode table that decide the body; the others follow from them.
const SOLVED: [&str; 17] = [
    "height",
    "head_l",
    "neck_w",
    "shoulder_w",
    "shoulder_incl",
    "bust",
    "vert_bust_line",
    "underbust",
    "waist",
    "waist_line",
    "hips",
    "hips_line",
    "crotch_hip_diff",
    "leg_circ",
    "arm_length",
    "arm_pose_angle",
    "wrist",
];

fn check(figure: Figure, table: &Measurements) {
    let body = Mannequin::new(table, figure).unwrap();
    let skin = body.skin();
    assert_eq!(skin.check(), Ok(()));
    assert!(skin.is_closed_and_oriented(), "{figure:?}");
    assert_eq!(skin.euler_characteristic(), 2);
    assert_eq!(skin.component_count(), 1);
    let crossing = body.skin_tree().self_intersections();
    assert!(
        crossing.is_empty(),
        "{figure:?}: {} pairs cross",
        crossing.len()
    );
    assert!(
        (0.04..0.2).contains(&skin.volume()),
        "outward, and a body's size"
    );
    let rows = body.measure();
    for name in SOLVED {
        let row = rows.iter().find(|row| row.name == name);
        let met = |row: &Deviation| row.origin == Origin::Asked && row.deviation().abs() < 5e-4;
        assert!(row.is_some_and(met), "{figure:?} {name}: {row:?}");
    }
    let [low, high] = skin.bounds().unwrap();
    assert_eq!(low.x, -high.x, "left and right are exact mirror images");
    assert!(
        low.y >= 0.0 && low.y < 1e-9,
        "stands on the floor: {}",
        low.y
    );
}

#[test]
fn what_a_body_has_is_no_contradiction() {
    for (figure, girths) in [
        (Figure::Woman, [0.95, 0.78, 0.80]),
        (Figure::Woman, [1.25, 0.85, 0.80]),
        (Figure::Woman, [1.10, 0.95, 1.20]),
        (Figure::Man, [1.00, 0.95, 0.85]),
        (Figure::Man, [1.10, 1.00, 1.30]),
    ] {
        let mut table = Measurements::new();
        let ways = [
            ("height", 1.70),
            ("bust_line", 0.27),
            ("bust_to_underbust", 0.08),
            ("waist_to_underbust", 0.10),
            ("hps_to_waist_front", 0.43),
            ("hps_to_waist_back", 0.43),
            ("front_width", 0.52 * girths[0]),
            ("crotch_length", 0.72),
        ];
        for (name, value) in ["bust", "underbust", "waist"]
            .into_iter()
            .zip(girths)
            .chain(ways)
        {
            table.set(name, value, Origin::Asked).unwrap();
        }
        // What a body came out with, asked for again.
        let mut again = Measurements::new();
        for row in Mannequin::new(&table, figure).unwrap().measure() {
            if row.origin == Origin::Asked {
                again.set(row.name, row.got, Origin::Asked).unwrap();
            }
        }
        let body = Mannequin::new(&again, figure).unwrap();
        assert_eq!(body.conflicts(), [], "{figure:?} {girths:?}");
    }
}

#[test]
fn the_sample_tables_do_not_contradict_themselves() {
    for (figure, table) in built_in() {
        let body = Mannequin::new(&table, figure).unwrap();
        assert_eq!(body.conflicts(), [], "{figure:?}");
    }
}

#[test]
fn built_in_bodies_are_closed_and_have_their_measurements() {
    for (figure, table) in built_in() {
        check(figure, &table);
    }
}

#[test]
fn bodies_for_published_tables_have_their_measurements() {
    for (figure, table) in yaml_tables() {
        check(figure, &table);
    }
}

#[test]
fn other_sizes_stay_closed_and_free_of_crossings() {
    for (figure, table) in built_in() {
        for (girth, length) in [(0.9, 1.0), (1.12, 1.0), (1.0, 0.93), (1.05, 1.06)] {
            let mut sized = table.clone();
            for name in ["bust", "underbust", "waist", "hips", "leg_circ", "wrist"] {
                sized
                    .set(name, table.get(name).unwrap() * girth, Origin::Asked)
                    .unwrap();
            }
            for name in [
                "height",
                "head_l",
                "waist_line",
                "hips_line",
                "vert_bust_line",
            ] {
                sized
                    .set(name, table.get(name).unwrap() * length, Origin::Asked)
                    .unwrap();
            }
            check(figure, &sized);
        }
    }
}

#[test]
fn every_vertex_has_its_mirror_image() {
    let body = Mannequin::new(&Measurements::adult(), Figure::Mean).unwrap();
    let key = |p: &Vec3| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
    let mut all: Vec<_> = body.skin().positions.iter().map(key).collect();
    let mirrored = body
        .skin()
        .positions
        .iter()
        .map(|p| Vec3::new(0.0 - p.x, p.y, p.z));
    let mut other: Vec<_> = mirrored.map(|p| key(&p)).collect();
    all.sort_unstable();
    other.sort_unstable();
    assert_eq!(all, other);
}

#[test]
fn inside_and_closest_point() {
    let body = Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap();
    let marks = body.landmarks();
    for (joint, centre) in body.skeleton().joints() {
        assert!(body.contains(centre), "{joint:?} {centre:?}");
    }
    for inside in marks.spine.iter().skip(1) {
        assert!(body.contains(*inside), "{inside:?}");
        assert!(
            body.field().contains(*inside),
            "{inside:?} in the implicit surface"
        );
    }
    let out = [
        Vec3::new(0.0, 0.3, 0.0),
        Vec3::new(0.0, 1.2, 1.0),
        Vec3::new(0.5, 1.4, 0.0),
        marks.crown + Vec3::y() * 0.01,
        Vec3::new(0.3, 0.9, 0.0),
    ];
    for outside in out {
        assert!(!body.contains(outside), "{outside:?}");
        assert!(
            !body.field().contains(outside),
            "{outside:?} in the implicit surface"
        );
        let closest = body.closest_point(outside).unwrap();
        let brute = body
            .skin()
            .positions
            .iter()
            .map(|p| (p - outside).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(closest.signed_distance > 0.0 && closest.signed_distance <= brute + 1e-12);
    }
    assert!(body.closest_point(Vec3::repeat(f64::NAN)).is_none());
    // Along the normals the side changes at the skin.
    let normals = body.skin_tree().vertex_normals();
    for v in (0..normals.len()).step_by(97) {
        let p = body.skin().positions[v];
        assert!(!body.contains(p + normals[v] * 1e-5), "vertex {v}");
        assert!(body.contains(p - normals[v] * 1e-5), "vertex {v}");
    }
}

#[test]
fn the_skin_lies_on_the_primitives() {
    // Only where the maps of the parts are not blended, and up to their linearisation.
    let body = Mannequin::new(&Measurements::adult_man(), Figure::Man).unwrap();
    let (skin, field) = (body.skin(), body.field());
    let mut worst: f64 = 0.0;
    for (t, part) in body.part_of_triangle().iter().enumerate() {
        let p = skin.corners(t)[0];
        let waist = (p.y - body.levels().waist).abs() < 0.1 && *part == Part::Trunk;
        let shin = (0.2..0.4).contains(&p.y) && *part == Part::LeftLeg;
        if waist || shin {
            let slope = field.gradient(*part, p).norm().max(1.0);
            worst = worst.max((field.density(*part, p) - 0.5).abs() / slope);
        }
    }
    assert!(worst > 0.0 && worst < 0.012, "{worst}");
}

#[test]
fn parts_and_levels_are_in_order() {
    for (figure, table) in built_in() {
        let body = Mannequin::new(&table, figure).unwrap();
        let parts = body.parts();
        assert_eq!(parts.iter().map(|p| p.part).collect::<Vec<_>>(), Part::ALL);
        for part in &parts {
            assert!(part.axis.len() >= 3, "{part:?}");
        }
        let l = body.levels();
        let down = [
            l.crown, l.neck, l.shoulder, l.chest, l.waist, l.hip, l.crotch, 0.0,
        ];
        assert!(down.windows(2).all(|w| w[0] > w[1]), "{down:?}");
        for part in Part::ALL {
            assert!(body.part_of_triangle().contains(&part));
            assert!(body.ellipsoids().iter().any(|p| p.part == part));
        }
        let arm = &parts[2].axis;
        let along = arm[2] - arm[0];
        assert!(
            along.x > 0.3 && along.y < -0.3 && along.z.abs() < 1e-9,
            "{along:?}"
        );
    }
}

#[test]
fn the_same_input_gives_the_same_body() {
    let make = || Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap();
    let (a, b) = (make(), make());
    assert_eq!(a.skin(), b.skin());
    assert_eq!(a.ellipsoids(), b.ellipsoids());
}

#[test]
fn a_description_is_small_and_gives_the_same_body() {
    let body = Mannequin::new(&Measurements::adult_woman(), Figure::Woman).unwrap();
    let text = serde_json::to_string(&body.description()).unwrap();
    assert!(text.len() < 32_000, "{} bytes", text.len());
    let read: Description = serde_json::from_str(&text).unwrap();
    let again = Mannequin::from_description(&read).unwrap();
    assert_eq!(again.skin(), body.skin());
    let short = Description {
        primitives: Vec::new(),
        ..read.clone()
    };
    assert!(serde_json::to_string(&short).unwrap().len() < 2_500);
    assert_eq!(
        Mannequin::from_description(&short).unwrap().skin(),
        body.skin()
    );
    for spoil in [f64::NAN, 0.0, -1.0, 1e9] {
        let mut bad = read.clone();
        bad.primitives[5].radii[1] = spoil;
        let refused = Mannequin::from_description(&bad);
        assert!(matches!(refused, Err(BodyError::Description(_))), "{spoil}");
    }
    // Every figure's own primitives, written out, are the figure's.
    for (figure, table) in built_in() {
        let body = Mannequin::new(&table, figure).unwrap();
        let again = Mannequin::from_description(&body.description()).unwrap();
        assert_eq!(
            again.ellipsoids().len(),
            body.ellipsoids().len(),
            "{figure:?}"
        );
        assert_eq!(again.skin(), body.skin(), "{figure:?}");
    }
    let mut few = read;
    few.primitives.truncate(3);
    assert!(matches!(
        Mannequin::from_description(&few),
        Err(BodyError::Open { .. })
    ));
}

#[test]
fn bad_measurements_are_named_with_a_remedy() {
    let refuse = |change: &dyn Fn(&mut Measurements)| -> BodyError {
        let mut table = Measurements::adult();
        change(&mut table);
        match Mannequin::new(&table, Figure::Mean) {
            Ok(_) => panic!("accepted"),
            Err(error) => error,
        }
    };
    let set = |name: &'static str, value: f64| {
        move |t: &mut Measurements| t.set(name, value, Origin::Asked).unwrap()
    };
    for (name, value) in [
        ("waist", 0.0),
        ("waist", -0.8),
        ("waist", 84.3),
        ("height", 172.0),
        ("height", 1e300),
        ("shoulder_incl", 21.7),
        ("arm_pose_angle", 45.0),
    ] {
        let error = refuse(&set(name, value));
        assert!(
            matches!(error, BodyError::OutOfRange { name: n, .. } if n == name),
            "{error}"
        );
        assert!(error.to_string().contains("give a value from"));
    }
    let error = refuse(&set("neck_w", 0.33));
    assert!(matches!(error, BodyError::Contradiction { .. }), "{error}");
}

#[test]
fn contradictions_are_met_halfway_and_named() {
    for (name, value) in [
        ("hips_line", 0.40),
        ("vert_bust_line", 0.32),
        ("leg_circ", 0.9),
    ] {
        let mut table = Measurements::adult();
        table.set(name, value, Origin::Asked).unwrap();
        let body = Mannequin::new(&table, Figure::Mean).unwrap();
        assert!(body.skin().is_closed_and_oriented());
        let conflicts = body.conflicts();
        assert!(
            conflicts.iter().any(|c| c.names.contains(&name)),
            "{name}: {conflicts:?}"
        );
    }
}

#[test]
fn what_is_missing_is_predicted_and_marked() {
    let mut table = Measurements::new();
    for (name, value) in [("height", 1.72), ("bust", 0.98), ("hips", 1.02)] {
        table.set(name, value, Origin::Asked).unwrap();
    }
    let body = Mannequin::new(&table, Figure::Woman).unwrap();
    let rows = body.measure();
    assert_eq!(
        rows.iter()
            .filter(|row| row.origin == Origin::Asked)
            .count(),
        3
    );
    for row in rows.iter().filter(|row| row.is_girth()) {
        assert!(row.deviation().abs() < 5e-4, "{row:?}");
    }
    assert!(body.conflicts().is_empty(), "{:?}", body.conflicts());
    let nobody = Mannequin::new(&Measurements::new(), Figure::Man).unwrap();
    assert!(
        nobody
            .measure()
            .iter()
            .all(|row| row.origin == Origin::Predicted)
    );
    assert_eq!(
        nobody.completed().measured("waist").unwrap().origin,
        Origin::Predicted
    );
}

/// Every measurement the mannequin reads, with limits well inside those it accepts.
const WIDE: [(&str, f64, f64); 17] = [
    ("height", 1.4, 2.1),
    ("head_l", 0.2, 0.32),
    ("neck_w", 0.14, 0.24),
    ("shoulder_w", 0.3, 0.48),
    ("shoulder_incl", 0.2, 0.55),
    ("bust", 0.75, 1.3),
    ("vert_bust_line", 0.16, 0.26),
    ("underbust", 0.65, 1.2),
    ("waist", 0.55, 1.25),
    ("waist_line", 0.32, 0.46),
    ("hips", 0.8, 1.4),
    ("hips_line", 0.15, 0.27),
    ("crotch_hip_diff", 0.06, 0.12),
    ("leg_circ", 0.45, 0.75),
    ("arm_length", 0.45, 0.65),
    ("arm_pose_angle", 0.6, 0.95),
    ("wrist", 0.13, 0.21),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn any_table_gives_a_closed_body_or_a_reason(
        shares in prop::collection::vec(0.0..1.0f64, WIDE.len()),
        kind in 0..3usize,
    ) {
        let mut table = Measurements::new();
        for ((name, low, high), share) in WIDE.iter().zip(&shares) {
            table.set(name, low + (high - low) * share, Origin::Asked).unwrap();
        }
        let figure = [Figure::Woman, Figure::Man, Figure::Mean][kind];
        match Mannequin::new(&table, figure) {
            Ok(body) => {
                prop_assert_eq!(body.skin().check(), Ok(()));
                prop_assert!(body.skin().is_closed_and_oriented());
                prop_assert!(body.skin().volume() > 0.0);
                prop_assert!(body.measure().iter().all(|g| g.got.is_finite()));
                let conflicts = body.conflicts();
                for gap in body.measure().iter().filter(|row| row.is_girth()) {
                    // Only what broke a rule before the body was made is let off.
                    let broke = |c: &Conflict| c.names.len() > 1 && c.names.contains(&gap.name);
                    let asked = gap.origin == Origin::Asked;
                    let met = gap.deviation().abs() < 2e-3;
                    prop_assert!(!asked || met || conflicts.iter().any(broke), "{:?}", gap);
                }
            }
            Err(error) => prop_assert!(error.to_string().contains(": "), "{}", error),
        }
    }
}
