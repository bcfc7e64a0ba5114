//! Makes a body for every person of a survey table (ANSUR II, as CSV with head units: millimetres)
//! and says how many have what was measured of them.
//!
//! `cargo run --release -p toile-body --example survey -- SUBJECTS.csv [EVERY [FIRST] | ROW,ROW,...]`
//!
//! Twelve girths and ten lengths are asked, and girth and height at the navel, where the survey's waist lies; breadths and depths are not, and are held against the
//! survey's own.
#![allow(clippy::print_stdout, clippy::print_stderr)]

#[path = "../tests/common/survey.rs"]
mod survey;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::Instant;
use survey::{ASKED, Person, is_closed, people};
use toile_body::{Figure, Mannequin};
use toile_measure::Origin;

/// What is not asked: the survey's name and the catalogue's.
const HELD_OUT: [(&str, &str); 6] = [
    ("chestbreadth", "chest_breadth"),
    ("chestdepth", "chest_depth"),
    ("waistbreadth", "waist_breadth"),
    ("waistdepth", "waist_depth"),
    ("hipbreadth", "hip_breadth"),
    ("buttockdepth", "hip_depth"),
];

/// What became of one person.
struct Outcome {
    /// Measurements missed by more than a millimetre, or why there is no body.
    missed: Vec<String>,
    /// Pairs of triangles of the skin that cross; none when the skin is not a closed manifold.
    crossings: Option<usize>,
    held_out: [f64; HELD_OUT.len()],
    /// Time of the solve [s].
    time: f64,
}

fn run(person: &Person) -> Outcome {
    let mut table = person.asked();
    // The survey's waist lies at the navel: what is predicted stands on that.
    for (from, name) in [
        ("waistcircumference", "navel_girth"),
        ("waistheightomphalion", "navel_height"),
    ] {
        let _ = table.set(name, person.get(from), Origin::Asked);
    }
    let start = Instant::now();
    let body = match Mannequin::new(&table, person.figure) {
        Ok(body) => body,
        Err(error) => {
            return Outcome {
                missed: vec![error.to_string()],
                crossings: None,
                held_out: [f64::NAN; HELD_OUT.len()],
                time: 0.0,
            };
        }
    };
    let time = start.elapsed().as_secs_f64();
    let rows = body.measure();
    let missed = rows
        .iter()
        .filter(|row| row.origin == Origin::Asked && row.gap().abs() > 1e-3)
        .map(|row| format!("{} {:+.1} mm", row.name, row.gap() * 1e3))
        .collect();
    let crossings = is_closed(body.skin()).then(|| body.skin_tree().self_intersections().len());
    let taken = |name: &str| body.taken(name).unwrap_or(f64::NAN);
    Outcome {
        missed,
        crossings,
        held_out: HELD_OUT.map(|(_, name)| taken(name)),
        time,
    }
}

/// Whether every asked value lies between the survey's 5th and 95th of a hundred of that sex.
fn in_box(person: &Person, limits: &BTreeMap<(bool, &str), [f64; 2]>) -> bool {
    ASKED.iter().all(|(name, _)| {
        let [low, high] = limits[&(person.figure == Figure::Woman, *name)];
        (low..=high).contains(&person.get(name))
    })
}

fn limits(people: &[Person]) -> BTreeMap<(bool, &'static str), [f64; 2]> {
    let mut limits = BTreeMap::new();
    for woman in [false, true] {
        for (name, _) in ASKED {
            let mut values: Vec<f64> = people
                .iter()
                .filter(|person| (person.figure == Figure::Woman) == woman)
                .map(|person| person.get(name))
                .collect();
            values.sort_by(f64::total_cmp);
            let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
            limits.insert((woman, name), [at(0.05), at(0.95)]);
        }
    }
    limits
}

/// Root mean square of a linear regression on the asked values, fitted on people with an odd row
/// and held against the even ones, and of the bodies against the same [m].
fn held_out(
    everyone: &[Person],
    (people, bodies): (&[Person], &[Outcome]),
    woman: bool,
    which: usize,
) -> [f64; 2] {
    let own = |p: &&Person| (p.figure == Figure::Woman) == woman;
    let inputs = |p: &Person| -> Vec<f64> {
        let values = ASKED.iter().map(|(name, _)| p.get(name));
        std::iter::once(1.0).chain(values).collect()
    };
    let half: Vec<&Person> = everyone
        .iter()
        .filter(own)
        .filter(|p| p.row % 2 == 1)
        .collect();
    let rows: Vec<f64> = half.iter().flat_map(|p| inputs(p)).collect();
    let rows = DMatrix::from_row_slice(half.len(), ASKED.len() + 1, &rows);
    let actual = half.iter().map(|p| p.get(HELD_OUT[which].0));
    let right = rows.tr_mul(&DVector::from_iterator(half.len(), actual));
    let Some(line) = rows.tr_mul(&rows).cholesky().map(|n| n.solve(&right)) else {
        return [f64::NAN; 2];
    };
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for (person, body) in people.iter().zip(bodies) {
        let got = body.held_out[which];
        if !own(&person) || person.row % 2 == 1 || !got.is_finite() {
            continue;
        }
        let actual = person.get(HELD_OUT[which].0);
        let fitted: f64 = inputs(person).iter().zip(&line).map(|(x, b)| x * b).sum();
        sums[0] += (fitted - actual).powi(2);
        sums[1] += (got - actual).powi(2);
        count += 1.0;
    }
    sums.map(|sum: f64| (sum / f64::max(count, 1.0)).sqrt())
}

fn report(everyone: &[Person], people: Vec<Person>) {
    let limits = limits(everyone);
    let start = Instant::now();
    let outcomes: Vec<Outcome> = people.par_iter().map(run).collect();
    println!(
        "{} people in {:.0} s",
        people.len(),
        start.elapsed().as_secs_f64()
    );
    let mut times: Vec<f64> = outcomes.iter().map(|o| o.time).collect();
    times.sort_by(f64::total_cmp);
    let at = |share: f64| 1e3 * times[(share * (times.len() - 1) as f64) as usize];
    println!(
        "a body: median {:.1} ms, 99 of 100 within {:.1} ms",
        at(0.5),
        at(0.99)
    );
    let inside: Vec<bool> = people.iter().map(|p| in_box(p, &limits)).collect();
    let count = |test: &dyn Fn(usize) -> bool| (0..people.len()).filter(|&k| test(k)).count();
    let good = |k: usize| outcomes[k].missed.is_empty();
    println!(
        "within 1 mm: {} of {} inside the 5-95 % box, {} of {} in all",
        count(&|k| inside[k] && good(k)),
        count(&|k| inside[k]),
        count(&good),
        people.len()
    );
    println!(
        "skins closed, of one piece, without a crossing: {}",
        count(&|k| outcomes[k].crossings == Some(0))
    );
    for (person, outcome) in people.iter().zip(&outcomes) {
        if !outcome.missed.is_empty() {
            println!("person {} misses {}", person.row, outcome.missed.join(", "));
        }
        match outcome.crossings {
            Some(0) => {}
            Some(pairs) => println!("person {}: {pairs} crossing pairs", person.row),
            None => println!("person {}: no closed skin", person.row),
        }
    }
    if people.len() > 50 {
        for woman in [true, false] {
            for (which, (name, _)) in HELD_OUT.iter().enumerate() {
                let [line, body] =
                    held_out(everyone, (&people, &outcomes), woman, which).map(|x| 1e3 * x);
                let sex = if woman { "women" } else { "men" };
                println!("not asked, {sex} {name}: regression {line:.2} mm, body {body:.2} mm");
            }
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(path) = arguments.first() else {
        eprintln!("give the table of people: survey SUBJECTS.csv [EVERY [FIRST] | ROW,ROW,...]");
        return ExitCode::from(2);
    };
    let rows: Vec<usize> = arguments
        .get(1)
        .filter(|text| text.contains(','))
        .map(|text| text.split(',').filter_map(|n| n.parse().ok()).collect())
        .unwrap_or_default();
    let number = |k: usize| arguments.get(k).and_then(|text| text.parse::<usize>().ok());
    let (every, first) = (number(1).unwrap_or(1).max(1), number(2).unwrap_or(0));
    let everyone = match std::fs::read_to_string(path).map(|text| people(&text)) {
        Ok(everyone) if !everyone.is_empty() => everyone,
        Ok(_) => {
            eprintln!("{path}: no people in it");
            return ExitCode::from(2);
        }
        Err(error) => {
            eprintln!("{path}: {error}");
            return ExitCode::from(2);
        }
    };
    let chosen = |p: &Person| match rows.is_empty() {
        true => p.row >= first && (p.row - first).is_multiple_of(every),
        false => rows.contains(&p.row),
    };
    let people = everyone.iter().filter(|p| chosen(p)).cloned().collect();
    report(&everyone, people);
    ExitCode::SUCCESS
}
