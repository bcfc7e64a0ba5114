//! What the drape half computes, recorded so that its shape can change and its results not: frozen
//! states, steps of every method, steps of the stages of a garment, ends of whole runs.
//!
//! Results hold to the byte where the processor has the instructions of the one they were recorded on;
//! elsewhere sums are taken in another order, and numbers are compared with a tolerance.
//! `TOILE_RECORD=1 cargo test -p toile-lab --test recorded` records anew and says what changed most.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[allow(dead_code)]
#[path = "../../../session/tests/suite/support/mod.rs"]
mod band;
mod ends;
mod frozen;
mod motions;
#[path = "../../../drape/tests/suite/support/numbers.rs"]
mod numbers;
mod record;
mod states;

use record::Record;

/// Energy, gradient, Hessian, contacts, crossings, impact times and truncated moves of frozen states.
#[test]
fn frozen_states_are_as_recorded() {
    let mut record = Record::new("frozen", 1e-9);
    frozen::note(&mut record);
    record.hold();
}

/// Places and velocities after 1 and 10 steps of every method.
#[test]
fn steps_of_every_method_are_as_recorded() {
    // On another processor a vertex that slides or sticks may do the other.
    let mut record = Record::new("steps", 1e-2);
    motions::note_methods(&mut record);
    record.hold();
}

/// The same after 20 steps of sewing, swing and rest.
#[test]
fn steps_of_the_stages_are_as_recorded() {
    let mut record = Record::new("stages", 1e-2);
    motions::note_stages(&mut record);
    record.hold();
}

/// Rest is chaotic: whole runs end within bounds, not at a place.
#[test]
fn whole_runs_end_within_bounds() {
    ends::check();
}
