//! Breadths and depths of the trunk that nobody asked for, against a survey's and against a
//! regression; the chest's breadth as the survey takes it.

use crate::common::shared;
use crate::common::survey::{HELD_OUT, Person, held_out, people};
use toile_body::{Figure, Mannequin};
use toile_measure::Origin;

/// What the tape finds of what was not asked (m).
fn found(person: &Person) -> [f64; HELD_OUT.len()] {
    let body = Mannequin::new(&person.asked_with_navel(), person.figure).unwrap();
    HELD_OUT.map(|(_, name)| body.taken(name).unwrap())
}

#[test]
fn breadths_and_depths_nobody_asked_for_are_as_near_as_a_regression() {
    // All people of even rows with TOILE_ALL set; every 40th row else, a small sample.
    let (step, allowed) = match std::env::var("TOILE_ALL").is_ok() {
        true => (2, 1.0),
        false => (40, 1.02),
    };
    let Some(path) = shared("body/measurements/ansur2_subjects_garment.csv") else {
        return;
    };
    let everyone = people(&std::fs::read_to_string(path).unwrap());
    let some: Vec<&Person> = everyone.iter().step_by(step).collect();
    let bodies: Vec<[f64; HELD_OUT.len()]> = some.iter().map(|person| found(person)).collect();
    for figure in [Figure::Woman, Figure::Man] {
        for (which, (name, _)) in HELD_OUT.iter().enumerate() {
            let [line, body] = held_out(&everyone, (&some, &bodies), figure, which);
            println!(
                "{figure:?} {name}: regression {:.2} mm, body {:.2} mm",
                1e3 * line,
                1e3 * body
            );
            assert!(body <= allowed * line, "{figure:?} {name}: {body} {line}");
        }
    }
}

#[test]
fn an_asked_chest_is_as_broad_between_the_folds_and_as_deep() {
    for figure in [Figure::Woman, Figure::Man] {
        let usual = Mannequin::new(&figure.average(), figure).unwrap();
        let [breadth, depth] =
            ["chest_breadth", "chest_depth"].map(|name| usual.taken(name).unwrap());
        for (wider, deeper) in [(0.012, 0.0), (-0.012, 0.004), (0.0, -0.008)] {
            let mut table = figure.average();
            table
                .set("chest_breadth", breadth + wider, Origin::Asked)
                .unwrap();
            table
                .set("chest_depth", depth + deeper, Origin::Asked)
                .unwrap();
            let body = Mannequin::new(&table, figure).unwrap();
            for row in body.measure() {
                let limit = match row.name {
                    "bust" => 5e-4,
                    "chest_breadth" | "chest_depth" => 1e-3,
                    _ => continue,
                };
                assert!(row.deviation().abs() < limit, "{figure:?} {row:?}");
            }
        }
    }
}
