//! The five scaling parameters.

use proptest::prelude::*;
use toile_body::{Description, Figure, Mannequin, Scaling, tags};

fn far(a: &Description, b: &Description) -> f64 {
    let numbers = |d: &Description| -> Vec<f64> {
        let f = d.frame.unwrap();
        let j = f.joints;
        let places = [
            j.shoulder, j.elbow, j.wrist, j.hip, j.knee, j.ankle, j.toe, j.pelvis, j.chest, j.neck,
            j.head,
        ];
        let mut all = vec![f.height, f.crotch, f.armpit, f.hand, f.neck_radius];
        all.extend(places.iter().flatten());
        for p in &d.primitives {
            all.extend(p.centre.iter().chain(&p.radii).chain(&p.rotation));
        }
        all
    };
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, f64::max)
}

#[test]
fn a_stature_in_millimetres_and_each_ratio_do_what_they_say() {
    let body = Mannequin::framed(Figure::Woman).unwrap();
    let frame = body.frame.unwrap();
    let tall = Scaling::to_stature(&frame, 1800.0).apply(&body).unwrap();
    let skin = Mannequin::from_description(&tall).unwrap();
    let [low, high] = skin.skin().bounds().unwrap();
    assert!((high.y - low.y - 1.8).abs() < 2e-3, "{}", high.y - low.y);
    let one = Scaling::default();
    let with = |scaling: Scaling| scaling.apply(&body).unwrap();
    // Depth alone.
    let deep = with(Scaling {
        frontal: 1.2,
        ..one
    });
    for (p, q) in body.primitives.iter().zip(&deep.primitives) {
        assert!((q.centre[2] - 1.2 * p.centre[2]).abs() < 1e-12);
        assert_eq!([q.centre[0], q.centre[1]], [p.centre[0], p.centre[1]]);
        assert_eq!((q.rotation, tags(q)), (p.rotation, tags(p)));
        for k in 0..3 {
            let ratio = if tags(p)[k] == 2 { 1.2 } else { 1.0 };
            assert!((q.radii[k] - ratio * p.radii[k]).abs() < 1e-12);
        }
    }
    // Shoulders and not hips, then hips and not shoulders.
    let broad = with(Scaling {
        high_lateral: 1.1,
        ..one
    })
    .frame
    .unwrap()
    .joints;
    let wide = with(Scaling {
        low_lateral: 1.1,
        ..one
    })
    .frame
    .unwrap()
    .joints;
    let j = frame.joints;
    assert!((broad.shoulder[0] - 1.1 * j.shoulder[0]).abs() < 1e-12 && broad.hip == j.hip);
    assert!((wide.hip[0] - 1.1 * j.hip[0]).abs() < 1e-12 && wide.shoulder == j.shoulder);
    // Longer legs at the same stature.
    let long = with(Scaling {
        spine_origin: 1.05,
        ..one
    })
    .frame
    .unwrap();
    assert!((long.height - frame.height).abs() < 1e-12);
    assert!((long.joints.pelvis[1] - 1.05 * j.pelvis[1]).abs() < 1e-12);
    assert!(long.joints.head[1] > j.head[1] && long.crotch > frame.crotch);
}

#[test]
fn what_no_body_has_is_refused() {
    let body = Mannequin::framed(Figure::Man).unwrap();
    let one = Scaling::default();
    for bad in [
        Scaling { global: 0.0, ..one },
        Scaling {
            frontal: f64::NAN,
            ..one
        },
        Scaling {
            high_lateral: 1e9,
            ..one
        },
        Scaling {
            spine_origin: 3.0,
            ..one
        },
    ] {
        assert!(bad.apply(&body).is_err());
    }
    let grown = Mannequin::new(&Figure::Man.average(), Figure::Man).unwrap();
    let error = one.apply(&grown.description()).unwrap_err().to_string();
    assert!(error.contains("frame"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn taken_back_the_body_is_the_same(
        global in 0.4..2.5_f64, frontal in 0.6..1.6_f64, high in 0.6..1.6_f64,
        origin in 0.8..1.25_f64, low in 0.6..1.6_f64,
    ) {
        let body = Mannequin::framed(Figure::Mean).unwrap();
        let scaling = Scaling {
            global,
            frontal,
            high_lateral: high,
            spine_origin: origin,
            low_lateral: low,
        };
        let back = scaling.take_back(&scaling.apply(&body).unwrap()).unwrap();
        prop_assert!(far(&body, &back) < 1e-9, "{}", far(&body, &back));
    }
}

#[test]
fn the_tape_of_a_scaled_body_is_laid_on_that_body() {
    let body = Mannequin::framed(Figure::Woman).unwrap();
    let taped = |ratio: f64| {
        let scaling = Scaling {
            global: ratio,
            ..Scaling::default()
        };
        let scaled = scaling.apply(&body).unwrap();
        Mannequin::from_description(&scaled).unwrap().measure()
    };
    let own = taped(1.0);
    for ratio in [0.8, 1.15] {
        let scaled = taped(ratio);
        let got = |name: &str, table: &[toile_body::Deviation]| {
            let row = table.iter().find(|row| row.name == name);
            row.unwrap_or_else(|| panic!("no {name}")).got
        };
        let height = body.frame.unwrap().height;
        assert!((got("height", &scaled) - ratio * height).abs() < 3e-3);
        // Levels between what the frame says are those of people of that height, to a few per cent.
        for name in ["hip_height", "nape_height", "knee_height", "armpit_height"] {
            let share = got(name, &scaled) / (ratio * got(name, &own));
            assert!((share - 1.0).abs() < 0.05, "{name} at {ratio}: {share}");
        }
        for name in ["bust", "hips", "waist", "neck"] {
            let share = got(name, &scaled) / (ratio * got(name, &own));
            assert!((share - 1.0).abs() < 0.08, "{name} at {ratio}: {share}");
        }
    }
}
