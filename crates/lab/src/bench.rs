//! Timed benchmarks on frozen scenes.
//!
//! # Decided with
//! - [`crate::bench::all`], [`crate::bench::is_long`]: the list of benchmarks;
//! - [`crate::drag`], [`crate::detect`], [`crate::factor`], [`crate::flatten`], [`crate::nest`], [`crate::realtime`],
//!   [`crate::square`]: drags, contact, factors, panels of surfaces, markers, real time, frames;
//! - [`crate::accuracy::SECTIONS`]: tables of docs/ACCURACY.md;
//! - [`crate::timed::Timed`], [`crate::clock`]: how a time is taken.
//!
//! `.ci/compare_builds.py` times two builds in turn.

use crate::chart_contact::crossed;
use crate::clock::Clock;
use crate::factor::Lattice;
use crate::scenes::card;
use crate::square::{SIDES, Square};
use crate::timed::Timed;
use crate::{LabError, subdivided};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use toile_drape::{
    GarmentLevel, GarmentRun, GarmentSetup, MethodKind, MethodSettings, RestSettings, SewSettings,
    Stage, State, System,
};
use toile_session::Watcher;

/// The kinds of benchmarks.
#[derive(Clone, Copy)]
enum Work {
    /// Ten frames of 1/60 s of the hang scene by a method, the mesh divided so many times.
    Frames(MethodKind, usize),
    /// Forty frames of 1/60 s of a square of a metre with so many vertices along a side.
    Square(Square, u32, MethodKind),
    /// The shirt to rest, its mesh divided so many times, to a net force over weight.
    Rest(usize, f64),
    /// A marker of shirts in three sizes.
    Nest,
    /// Queries of pairs of their pieces, as the search makes them, one thread.
    NestQueries,
    /// Contacts of a smooth sheet with itself, so many cells along a side.
    DetectSheet(usize),
    /// Contacts of the worn shirt with itself, its mesh divided so many times.
    DetectShirt(usize),
    /// Contact of a fallen sheet of so many cells along a side, beside a step of deformation.
    Contact(usize),
    /// The square of so many vertices a side that falls on the ball, kept from passing through itself.
    Touching(u32),
    /// Factorisation of a matrix of about so many vertices.
    Factor(Lattice, usize),
    /// Clothes in real time beside the method as published, one thread.
    Realtime,
    /// Patches of a sphere to panels, one thread.
    Flatten,
    /// Points dragged in a large pattern and in those that ship, one thread.
    Drag,
}

impl Work {
    /// Threads it is given in turn.
    fn threads(self) -> &'static [usize] {
        match self {
            Self::Drag | Self::Realtime | Self::Flatten => &THREADS[..1],
            _ => &THREADS,
        }
    }
}

/// Frames of a benchmark of motion.
const FRAMES: usize = 10;

/// Frames of a square, long enough to swing down or to lie on the ball.
const SQUARE_FRAMES: usize = 40;

/// The benchmarks by name: those of motion for every method there is.
fn all() -> Vec<(String, Work)> {
    let mut list: Vec<(String, Work)> = MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| !kind.is_equilibrium())
        .map(|(name, kind)| (format!("frame-1k-{name}"), Work::Frames(kind, 0)))
        .collect();
    list.push((
        "frame-13k-implicit-euler".to_owned(),
        Work::Frames(MethodKind::ImplicitEuler, 2),
    ));
    for (scene, square) in Square::ALL {
        for side in SIDES {
            for (name, kind) in MethodKind::ALL {
                if !kind.is_equilibrium() {
                    let work = Work::Square(square, side, kind);
                    list.push((format!("{scene}-{side}-{name}"), work));
                }
            }
        }
    }
    list.push(("drag".to_owned(), Work::Drag));
    list.push(("flatten".to_owned(), Work::Flatten));
    list.push(("realtime".to_owned(), Work::Realtime));
    list.push(("nest".to_owned(), Work::Nest));
    list.push(("nest-queries".to_owned(), Work::NestQueries));
    for (name, cells) in [("1k", 22), ("30k", 122), ("1m", 707)] {
        list.push((format!("detect-sheet-{name}"), Work::DetectSheet(cells)));
    }
    for (cuts, name) in ["1k", "6k", "22k"].iter().enumerate() {
        list.push((format!("detect-shirt-{name}"), Work::DetectShirt(cuts)));
    }
    list.push(("contact-10k".to_owned(), Work::Contact(100)));
    for side in [SIDES[1], SIDES[2]] {
        list.push((format!("sphere-{side}-touching"), Work::Touching(side)));
    }
    for (name, lattice) in [("sheet", Lattice::Sheet), ("tube", Lattice::Tube)] {
        for thousands in [10, 30, 100] {
            let work = Work::Factor(lattice, 1000 * thousands);
            list.push((format!("factor-{name}-{thousands}k"), work));
        }
    }
    list.push(("rest-shirt-1k".to_owned(), Work::Rest(0, 1e-2)));
    list.push(("rest-shirt-6k".to_owned(), Work::Rest(1, 1e-3)));
    list.push(("rest-shirt-22k".to_owned(), Work::Rest(2, 1e-3)));
    list.push(("rest-shirt-90k".to_owned(), Work::Rest(3, 1e-3)));
    list
}

/// Names of the benchmarks.
pub fn bench_names() -> Vec<String> {
    all().into_iter().map(|(name, _)| name).collect()
}

/// Whether a benchmark is run only when it is named: what takes more than seconds, and the squares
/// by other methods than the fastest.
fn is_long(name: &str, work: Work) -> bool {
    match work {
        Work::Square(_, side, kind) => side > SIDES[1] || kind != MethodKind::PatchVerlet,
        Work::DetectSheet(cells) => cells > 700,
        Work::Factor(_, vertices) => vertices > 50_000,
        _ => matches!(name, "rest-shirt-22k" | "rest-shirt-90k"),
    }
}

/// Threads a benchmark is given in turn.
const THREADS: [usize; 2] = [1, 2];

/// Steps to rest at the most, and wall time after which it is given up (s).
const MAX_STEPS: usize = 2000;
const BUDGET: f64 = 300.0;

/// Runs the benchmarks named, or all that take seconds.
///
/// # Errors
/// An unknown name; the watcher asked to stop.
pub fn bench(names: &[String], watcher: &mut dyn Watcher) -> Result<Vec<Timed>, LabError> {
    let list = all();
    for name in names {
        if list.iter().all(|(known, _)| known != name) {
            return Err(LabError::Unknown {
                what: "benchmark",
                name: name.clone(),
                known: bench_names().join(", "),
            });
        }
    }
    let chosen: Vec<&(String, Work)> = list
        .iter()
        .filter(|(name, work)| match names.is_empty() {
            true => !is_long(name, *work),
            false => names.contains(name),
        })
        .collect();
    let mut found = Vec::new();
    for (k, (name, work)) in chosen.iter().enumerate() {
        for &threads in work.threads() {
            let share = k as f64 / chosen.len() as f64;
            let detail = format!("{name}, {threads} threads");
            if watcher.progress("bench", share, &detail) == ControlFlow::Break(()) {
                return Err(LabError::Cancelled);
            }
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .map_err(|error| LabError::Files {
                    what: format!("cannot start {threads} threads: {error}"),
                })?;
            found.push(pool.install(|| timed(name, *work, threads))?);
        }
    }
    Ok(found)
}

fn timed(name: &str, work: Work, threads: usize) -> Result<Timed, LabError> {
    let mut result = Timed {
        name: name.to_owned(),
        threads,
        vertices: 0,
        wall_s: 0.0,
        cpu_s: None,
        counted: BTreeMap::new(),
        report: None,
        failure: None,
    };
    match work {
        Work::Frames(kind, cuts) => {
            let card = card("hang")?;
            let mut cloth = card.cloth(1)?;
            for _ in 0..cuts {
                cloth = subdivided(&cloth);
            }
            let (system, state) = card.system(&cloth, &card.cloths[1].pins)?;
            result.vertices = system.vertex_count();
            frames(&system, state, (kind.into(), FRAMES), &mut result)?;
        }
        Work::Square(square, side, kind) => {
            let (system, state) = square.build(side)?;
            result.vertices = system.vertex_count();
            frames(&system, state, (kind.into(), SQUARE_FRAMES), &mut result)?;
        }
        Work::Touching(side) => touching(side, &mut result)?,
        Work::Rest(cuts, residual) => rest(cuts, residual, &mut result)?,
        Work::DetectSheet(cells) => crate::detect::sheet(cells, &mut result)?,
        Work::DetectShirt(cuts) => crate::detect::shirt(cuts, &mut result)?,
        Work::Contact(cells) => crate::detect::cost(cells, &mut result)?,
        Work::Factor(lattice, vertices) => {
            crate::factor::factor((lattice, vertices), &mut result)?;
        }
        Work::Drag => crate::drag::drag(&mut result)?,
        Work::Flatten => crate::flatten::patches(&mut result)?,
        Work::Realtime => crate::realtime::realtime(&mut result)?,
        Work::Nest => crate::nest::nest(threads, &mut result)?,
        Work::NestQueries => crate::nest::queries(threads, &mut result)?,
    }
    Ok(result)
}

/// Distance that the square keeps from itself (m), and substeps of a frame.
const TOUCHING_OFFSET: f64 = 2e-3;
const TOUCHING_SUBSTEPS: u32 = 10;

/// The square falls on the ball without passing through itself; what passed all the same is counted.
fn touching(side: u32, result: &mut Timed) -> Result<(), LabError> {
    let (system, state) = Square::Sphere.build(side)?;
    let system = system.with(|builder| builder.contact.cloth_offset = TOUCHING_OFFSET);
    result.vertices = system.vertex_count();
    let settings = MethodSettings {
        substeps: Some(TOUCHING_SUBSTEPS),
        ..MethodKind::Xpbd.into()
    };
    let end = frames(&system, state, (settings, SQUARE_FRAMES), result)?;
    let crossed = crossed(&system, &end.positions);
    result
        .counted
        .insert("crossings".to_owned(), crossed as f64);
    Ok(())
}

/// Takes frames of 1/60 s and times them; where they end.
fn frames(
    system: &System,
    mut state: State,
    (settings, count): (MethodSettings, usize),
    result: &mut Timed,
) -> Result<State, LabError> {
    let mut method = toile_reference::build(&settings)?;
    let step = 1.0 / 60.0;
    // The first frame sizes the workspace.
    let mut substeps = 0;
    let mut clock = Clock::start();
    for frame in 0..=count {
        if frame == 1 {
            result
                .counted
                .insert("first_frame_s".to_owned(), clock.wall());
            clock = Clock::start();
        }
        match method.advance(system, &mut state, step) {
            Ok(report) => substeps = report.iterations,
            Err(error) => {
                result.failure = Some(error.to_string());
                break;
            }
        }
    }
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    let iterations = result.counted.entry("iterations_last_frame".to_owned());
    iterations.or_insert(substeps as f64);
    if let Some(cpu) = result.cpu_s {
        let per_frame = 1e3 * cpu / count as f64;
        result
            .counted
            .insert("cpu_ms_per_frame".to_owned(), per_frame);
    }
    let per_frame = 1e3 * result.wall_s / count as f64;
    result.counted.insert("ms_per_frame".to_owned(), per_frame);
    if let Some(tally) = method.cloth_tally().filter(|tally| tally.looks > 0) {
        for (name, value) in [
            ("looks_a_frame", tally.looks as f64 / (count + 1) as f64),
            ("crossings_most", tally.crossings[1] as f64),
            ("impulses", tally.impulses as f64),
        ] {
            result.counted.insert(name.to_owned(), value);
        }
    }
    Ok(state)
}

/// The sewn shirt to rest, from its coarsest mesh to the finest; times of each mesh apart.
fn rest(cuts: usize, residual: f64, result: &mut Timed) -> Result<(), LabError> {
    let card = card("shirt")?;
    let mut cloth = card.cloth(0)?;
    let (system, _) = card.system(&cloth, &[])?;
    let mut levels = Vec::new();
    for cut in 0..=cuts {
        if cut > 0 {
            cloth = subdivided(&cloth);
        }
        levels.push(GarmentLevel {
            cloth: cloth.clone(),
            stitches: Vec::new(),
            layer: Vec::new(),
        });
    }
    result.vertices = cloth.positions.len();
    let setup = GarmentSetup {
        levels,
        counted: Vec::new(),
        colliders: system.colliders.iter().map(|c| c.surface.clone()).collect(),
        contact: system.contact,
        gravity: system.control.gravity,
        sew: SewSettings::default(),
        rest: RestSettings {
            residual,
            steps: MAX_STEPS,
            ..RestSettings::default()
        },
    };
    let clock = Clock::start();
    let mut run = GarmentRun::new(setup)?;
    while run.progress().stage != Stage::Finished {
        let ([level, _], stage) = (run.level(), run.progress().stage);
        let before = clock.wall();
        if let Err(error) = run.advance() {
            result.failure = Some(error.to_string());
            break;
        }
        let spent = clock.wall() - before;
        let name = match stage {
            Stage::Swinging => "swing",
            _ => "settle",
        };
        for (what, more) in [("s", spent), ("steps", 1.0)] {
            let counted = result.counted.entry(format!("level_{level}_{name}_{what}"));
            *counted.or_default() += more;
        }
        if clock.wall() > BUDGET {
            result.failure = Some(format!("not done in {BUDGET} s"));
            break;
        }
    }
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    let reached = run.progress().residual;
    result.counted.insert("residual".to_owned(), reached);
    if reached > residual && result.failure.is_none() {
        result.failure = Some(format!("net force {reached:.1e} of the weight at the end"));
    }
    Ok(())
}

/// The benchmarks as a table for people.
pub fn bench_table(found: &[Timed]) -> String {
    use std::fmt::Write;
    let mut text = format!(
        "{:<34} {:>7} {:>9} {:>10} {:>10}  counted\n",
        "benchmark", "threads", "vertices", "wall, s", "cpu, s"
    );
    for t in found {
        let counted: Vec<String> = t
            .counted
            .iter()
            .map(|(name, value)| format!("{name} {}", crate::check::significant(*value, 3)))
            .collect();
        let _ = writeln!(
            text,
            "{:<34} {:>7} {:>9} {:>10.3} {:>10}  {}{}",
            t.name,
            t.threads,
            t.vertices,
            t.wall_s,
            t.cpu_s.map_or("-".to_owned(), |c| format!("{c:.2}")),
            counted.join(", "),
            t.failure
                .as_ref()
                .map_or(String::new(), |f| format!("; {f}")),
        );
    }
    let reports = bench_report(found);
    if reports.is_empty() {
        return text;
    }
    text + "\n" + &reports
}

/// The tables that benchmarks have of their own, as Markdown.
pub fn bench_report(found: &[Timed]) -> String {
    let reports: Vec<&str> = found.iter().filter_map(|t| t.report.as_deref()).collect();
    reports.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_benchmark_counts_what_it_does_at_every_number_of_threads() {
        let found = bench(
            &["frame-1k-semi-implicit-euler".to_owned()],
            &mut toile_session::Silent,
        )
        .unwrap();
        assert_eq!(found.len(), THREADS.len());
        for timed in &found {
            assert!(timed.failure.is_none() && timed.wall_s > 0.0, "{timed:?}");
            assert!(timed.counted["ms_per_frame"] > 0.0);
        }
        assert!(bench_table(&found).lines().count() == 3);
        assert!(bench(&["nothing".to_owned()], &mut toile_session::Silent).is_err());
    }
}
