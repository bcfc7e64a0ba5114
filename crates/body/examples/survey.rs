//! Makes a body for every person of a survey table (ANSUR II, as CSV with head units: millimetres)
//! and says how many have what was measured of them.
//!
//! `cargo run --release -p toile-body --example survey -- SUBJECTS.csv [EVERY [FIRST] | ROW,ROW,...]`
//!
//! Twelve girths and ten lengths are asked, and girth and height at the navel, where the survey's waist lies; breadths and depths are not, and are held against the
//! survey's own.
#![allow(clippy::print_stdout, clippy::print_stderr)]

#[path = "../tests/suite/common/survey.rs"]
mod survey;

use rayon::prelude::*;
use std::collections::BTreeMap;
use std::process::ExitCode;
use std::time::Instant;
use survey::{ASKED, HELD_OUT, Person, held_out, is_closed, people};
use toile_body::{Figure, Mannequin};
use toile_measure::Origin;

/// What became of one person.
struct Outcome {
    /// Measurements missed by more than a millimetre, or why there is no body.
    missed: Vec<String>,
    /// Pairs of triangles of the skin that cross; none when the skin is not a closed manifold.
    crossings: Option<usize>,
    held_out: [f64; HELD_OUT.len()],
    /// Time of the solve (s).
    time: f64,
}

fn run(person: &Person) -> Outcome {
    let table = person.asked_with_navel();
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
        .filter(|row| row.origin == Origin::Asked && row.deviation().abs() > 1e-3)
        .map(|row| format!("{} {:+.1} mm", row.name, row.deviation() * 1e3))
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
        let (people, bodies): (Vec<&Person>, Vec<_>) = people
            .iter()
            .zip(&outcomes)
            .map(|(person, outcome)| (person, outcome.held_out))
            .unzip();
        for (figure, sex) in [(Figure::Woman, "women"), (Figure::Man, "men")] {
            for (which, (name, _)) in HELD_OUT.iter().enumerate() {
                let [line, body] =
                    held_out(everyone, (&people, &bodies), figure, which).map(|x| 1e3 * x);
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
