//! Long runs. `soak nest` lays instances by `toile nest` and by another program in turn, with the
//! same wall limit, and judges every solution on the original outlines:
//!
//! ```text
//! cargo run --release -p toile-tests --example soak -- nest --toile target/release/toile \
//!   --peer "python3 solver.py" --seconds 10,60 --seeds 10 --out out/soak a.json b.json
//! ```
//!
//! The other program is called with INSTANCE SECONDS SEED THREADS OUT and writes a solution in the
//! instance's own format. `--seconds 1:5` gives it five seconds for our one, `--seeds 8-10` makes these seeds alone. `--referee COMMAND`
//! is run on every solution, and what it prints is kept. Rows are added to `runs.csv` as they are
//! made, with the commit; what is there already of the same commit is not run again; `table.csv` sums up, with the 95 %
//! interval of the difference.
//!
//! `soak hard [--short] [--out DIR] [NAME...]` runs the hard scenes of cloth on cloth at full size, or as tests do, and
//! `soak tangles [COUNT]` so many planted tangles (100); both print a line each and fail where
//! anything is left crossing. `--out` keeps pictures of the ends.
//!
//! `soak sizes [--quality preview|fit|final] [--out DIR] [NAME...]` drapes every pattern that ships, or those named, on
//! five women, five men and two children, or those named, prints a line each with the crossings
//! of cloth with body and with cloth, and fails where there are any or one is not at rest.
//!
//! `soak rest [--quality preview|fit|final] [--seeds N] [--limit SECONDS] [--body FIGURE] [--over PATTERN]... [PATTERN]`
//! drapes one garment, the T-shirt, and those over it from N starts that differ by micrometres, and prints steps and
//! seconds of each stage: the way to rest is chaotic. A run is given up at the limit.
//!
//! `soak layers [--fit] [--outfit 1|2|3] [FIGURE...]` wears the shipped patterns in three layers on every mannequin, and fails
//! where layers cross the body, themselves or each other, are out of order or not at rest.
//!
//! `soak edits [--plain] [--quality preview|fit|final] [COUNT]` moves points of the T-shirt under the garment that hangs, by 1 mm
//! and by 5 mm, so many times each (10), prints what taking the edit, predicting and going on to rest cost beside a drape
//! from the start, and fails where one ends tangled, not at rest, or with another hem or girth than drapes from the start have;
//! `--plain` leaves these out.
//!
//! `soak losses [COUNT]` makes so many random deletions and changes of count (1000) in the shipped patterns, each undone and
//! done again, replays the journals, and fails where a cause is told twice, anything stands without what it needs or comes back otherwise.
//!
//! `soak events [COUNT]` makes so many random events (100000) on the window's tools and its session, from the shipped patterns
//! and the empty document, and fails where one panics, damages the document, or it cannot be undone, done again and replayed.
//!
//! `soak damaged [COUNT]` reads so many damaged pattern files of every format (100000), and fails where one panics, takes more
//! than 2 s, or is refused without its place and a remedy.
#![allow(clippy::print_stdout, clippy::print_stderr)]

#[path = "soak/cloth.rs"]
mod cloth;
#[path = "soak/document.rs"]
mod document;
#[path = "soak/edits.rs"]
mod edits;
#[path = "soak/layers.rs"]
mod layers;
#[path = "soak/rest.rs"]
mod rest;
#[path = "soak/sizes.rs"]
mod sizes;
#[path = "soak/worn.rs"]
mod worn;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use toile_geometry::Vec2;
use toile_interchange::{read_jagua, write_atomically};
use toile_nesting::{Marker, Placement, judge};
use toile_session::Quality;
use toile_tests::root;

/// Samples of the bootstrap (Efron 1979).
const SAMPLES: usize = 2000;
/// Header of `runs.csv`.
const HEADER: &str = "commit,instance,seconds,seed,place,program,allowed_s,wall_s,cpu_s,load,pieces,length,density_percent,sound,deepest_m";
/// A run that had less of the processors than this is named at the end: the machine was not idle.
const MIN_LOAD: f64 = 0.85;
/// Fewer pairs say nothing of how far their mean may be off.
const MIN_PAIRS: usize = 3;

/// What is asked.
#[derive(Debug)]
struct Task {
    toile: PathBuf,
    peer: Option<String>,
    referee: Option<String>,
    /// Wall limits of ours and of the other program (s).
    limits: Vec<(f64, f64)>,
    seeds: RangeInclusive<u64>,
    threads: usize,
    out: PathBuf,
    instances: Vec<PathBuf>,
}

fn parse(arguments: &[String]) -> Result<Task, String> {
    let mut task = Task {
        toile: root().join("target/release/toile"),
        peer: None,
        referee: None,
        limits: vec![(10.0, 10.0)],
        seeds: 1..=10,
        threads: 2,
        out: PathBuf::from("out/soak"),
        instances: Vec::new(),
    };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let mut value = || rest.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--toile" => task.toile = PathBuf::from(value()?),
            "--peer" => task.peer = Some(value()?.clone()),
            "--referee" => task.referee = Some(value()?.clone()),
            "--seconds" => task.limits = limits(value()?)?,
            "--seeds" => task.seeds = seeds(value()?)?,
            "--threads" => {
                let text = value()?;
                task.threads = text.parse().map_err(|_| format!("{text}: no number"))?;
            }
            "--out" => task.out = PathBuf::from(value()?),
            option if option.starts_with("--") => return Err(format!("{option} is not known")),
            file => task.instances.push(PathBuf::from(file)),
        }
    }
    match task.instances.is_empty() {
        true => Err("name the instances".to_owned()),
        false => Ok(task),
    }
}

/// Limits as in `10,60` or `1:5`.
fn limits(text: &str) -> Result<Vec<(f64, f64)>, String> {
    let number = |text: &str| {
        let value = text.parse::<f64>().ok().filter(|v| *v > 0.0);
        value.ok_or(format!("{text}: no time in seconds"))
    };
    let pair = |text: &str| match text.split_once(':') {
        Some((ours, theirs)) => Ok((number(ours)?, number(theirs)?)),
        None => number(text).map(|both| (both, both)),
    };
    text.split(',').map(pair).collect()
}

/// Seeds as in `10`, the first ten, or `8-10`.
fn seeds(text: &str) -> Result<RangeInclusive<u64>, String> {
    let (first, last) = text.split_once('-').unwrap_or(("1", text));
    let number = |text: &str| text.parse::<u64>().map_err(|_| format!("{text}: no seed"));
    Ok(number(first)?..=number(last)?)
}

/// One run of one program.
#[derive(Clone, Debug)]
struct Run {
    instance: String,
    seconds: f64,
    seed: u64,
    /// Whether it ran first or second of its pair.
    place: usize,
    program: String,
}

impl Run {
    /// What tells it from all others in `runs.csv`.
    fn key(&self) -> String {
        let Self {
            instance,
            seconds,
            seed,
            program,
            ..
        } = self;
        format!("{instance},{seconds},{seed},{program}")
    }
}

/// The commit the project stands at, with a plus where files are changed.
fn commit() -> String {
    let git = |arguments: &[&str]| {
        let ran = Command::new("git")
            .arg("-C")
            .arg(root())
            .args(arguments)
            .output();
        ran.map_or_else(
            |_| String::new(),
            |o| String::from_utf8_lossy(&o.stdout).trim().to_owned(),
        )
    };
    let name = git(&["rev-parse", "--short", "HEAD"]);
    let changed = !git(&["status", "--porcelain", "--untracked-files=no"]).is_empty();
    match (name.as_str(), changed) {
        ("", _) => "unknown".to_owned(),
        (name, true) => format!("{name}+"),
        (name, false) => name.to_owned(),
    }
}

/// Processor time of all children so far (s), where the system tells it.
fn children_cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace();
    let ticks = fields
        .skip(13)
        .take(2)
        .filter_map(|f| f.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// A command line without quotes, split at spaces.
fn command(line: &str) -> Command {
    let mut words = line.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words);
    command
}

fn call(
    task: &Task,
    run: &Run,
    file: &Path,
    (limit, solution): (f64, &Path),
) -> Result<(), String> {
    let seed = run.seed.to_string();
    let mut made = match (run.program.as_str(), &task.peer) {
        ("peer", Some(peer)) => {
            let mut made = command(peer);
            made.arg(file)
                .args([limit.to_string(), seed, task.threads.to_string()]);
            made.arg(solution);
            made
        }
        _ => {
            let mut made = Command::new(&task.toile);
            made.arg("nest")
                .arg(file)
                .args(["--time", &limit.to_string(), "--seed", &seed])
                .args(["--threads", &task.threads.to_string()]);
            made.arg("--out")
                .arg(solution.parent().unwrap_or(Path::new(".")));
            made
        }
    };
    let ran = made
        .output()
        .map_err(|e| format!("{:?}: {e}", made.get_program()))?;
    match ran.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&ran.stderr).into_owned()),
    }
}

/// What a solution is worth.
struct Judged {
    pieces: usize,
    /// In units of the instance.
    length: f64,
    /// Area over height times length, 0..=1.
    density: f64,
    sound: bool,
    /// Deepest overlap, in the scale of a roll of fabric (m).
    deepest: f64,
}

/// Judges a solution on the outlines of the instance.
fn judged(instance: &str, solution: &str) -> Result<Judged, String> {
    let read = read_jagua(instance).map_err(|e| e.to_string())?;
    let parsed = |text: &str| serde_json::from_str(text).map_err(|e| e.to_string());
    let (instance, solution): (serde_json::Value, serde_json::Value) =
        (parsed(instance)?, parsed(solution)?);
    let listed = instance["items"].as_array().ok_or("no items")?;
    let mut copies = vec![0; listed.len()];
    let mut marker = Marker::default();
    let placed = &solution["solution"]["layout"]["placed_items"];
    for one in placed.as_array().ok_or("no placed items")? {
        let is_it = |item: &serde_json::Value| item["id"] == one["item_id"];
        let item = listed.iter().position(is_it).ok_or("an unknown item")?;
        let number = |value: &serde_json::Value| value.as_f64().ok_or("no number");
        let way = &one["transformation"];
        let to = &way["translation"];
        marker.placements.push(Placement {
            item,
            copy: copies[item],
            turn: number(&way["rotation"])?.to_radians(),
            mirrored: false,
            translation: Vec2::new(number(&to[0])?, number(&to[1])?) * read.scale,
        });
        copies[item] += 1;
    }
    marker.measure(&read.items, &read.strip);
    let verdict = judge(&read.items, &read.strip, &marker);
    Ok(Judged {
        pieces: marker.placements.len(),
        length: marker.length / read.scale,
        density: marker.efficiency,
        sound: verdict.is_sound(),
        deepest: verdict.deepest,
    })
}

/// Makes one run and returns its row.
fn measure(task: &Task, run: &Run, file: &Path, limit: f64) -> Result<String, String> {
    let Run {
        instance,
        seconds,
        seed,
        program,
        place,
    } = run;
    let folder = task
        .out
        .join(format!("{instance}-{seconds}s-{seed}-{program}"));
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let solution = folder.join(format!("{instance}.json"));
    let (clock, before) = (Instant::now(), children_cpu());
    call(task, run, file, (limit, &solution))?;
    let (wall, cpu) = (clock.elapsed().as_secs_f64(), children_cpu() - before);
    let text =
        |path: &Path| std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()));
    let judged = judged(&text(file)?, &text(&solution)?)?;
    if let Some(referee) = &task.referee {
        let said = command(referee)
            .arg(&solution)
            .output()
            .map_err(|e| e.to_string())?;
        std::fs::write(folder.join("referee.txt"), said.stdout).map_err(|e| e.to_string())?;
    }
    let load = cpu / (wall * task.threads as f64);
    Ok(format!(
        "{},{instance},{seconds},{seed},{place},{program},{limit},{wall:.2},{cpu:.2},{load:.3},{},{:.4},{:.4},{},{:.1e}",
        commit(),
        judged.pieces,
        judged.length,
        100.0 * judged.density,
        judged.sound,
        judged.deepest
    ))
}

/// All runs in order: seed after seed, so that what is slow for a while hits all alike, and first
/// the one, then the other program first.
fn plan(task: &Task) -> Vec<(Run, PathBuf, f64)> {
    let mut plan = Vec::new();
    for seed in task.seeds.clone() {
        for (k, file) in task.instances.iter().enumerate() {
            let name = file
                .file_stem()
                .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            for &(ours, theirs) in &task.limits {
                let mut pair = vec![("toile", ours)];
                pair.extend(task.peer.as_ref().map(|_| ("peer", theirs)));
                if (seed as usize + k).is_multiple_of(2) {
                    pair.reverse();
                }
                for (place, (program, limit)) in pair.into_iter().enumerate() {
                    let run = Run {
                        instance: name.clone(),
                        seconds: ours,
                        seed,
                        place,
                        program: program.to_owned(),
                    };
                    plan.push((run, file.clone(), limit));
                }
            }
        }
    }
    plan
}

/// Densities by instance and seconds, then by seed and program (%).
type Table = BTreeMap<(String, String), BTreeMap<(String, String), f64>>;

/// The densities of the sound rows of `runs.csv`, and rows to look at.
///
/// Rows of other commits are left out.
fn table(rows: &str, commit: &str) -> (Table, Vec<String>) {
    let (mut table, mut named) = (Table::new(), Vec::new());
    for row in rows.lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let [
            made_at,
            instance,
            seconds,
            seed,
            _,
            program,
            _,
            _,
            _,
            load,
            _,
            _,
            density,
            sound,
            _,
        ] = fields[..]
        else {
            continue;
        };
        if made_at != commit {
            continue;
        }
        let number = |text: &str| text.parse::<f64>().unwrap_or(f64::NAN);
        if sound != "true" {
            named.push(format!("not sound, not counted: {row}"));
            continue;
        }
        if number(load) < MIN_LOAD {
            named.push(format!("the processors were not free: {row}"));
        }
        let cell = table
            .entry((instance.to_owned(), seconds.to_owned()))
            .or_default();
        cell.insert((seed.to_owned(), program.to_owned()), number(density));
    }
    (table, named)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Bounds of the middle 95 % of the means of samples drawn with repeats.
fn interval(values: &[f64]) -> [f64; 2] {
    let mut state: u64 = 1;
    let mut below = |end: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % end.max(1)
    };
    let mut means: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            mean(
                &values
                    .iter()
                    .map(|_| values[below(values.len())])
                    .collect::<Vec<_>>(),
            )
        })
        .collect();
    means.sort_by(f64::total_cmp);
    [means[SAMPLES / 40], means[SAMPLES - 1 - SAMPLES / 40]]
}

/// `table.csv`: a line for every instance and limit.
fn summary(table: &Table, commit: &str) -> String {
    let mut text = "commit,instance,seconds,seeds,toile_mean,toile_least,toile_best,peer_mean,peer_best,difference,low,high,wins,losses\n".to_owned();
    for ((instance, seconds), runs) in table {
        let of = |program: &str| -> Vec<f64> {
            runs.iter()
                .filter(|(k, _)| k.1 == program)
                .map(|(_, d)| *d)
                .collect()
        };
        let (ours, theirs) = (of("toile"), of("peer"));
        let paired: Vec<f64> = runs
            .iter()
            .filter(|(k, _)| k.1 == "toile")
            .filter_map(|(k, d)| Some(d - runs.get(&(k.0.clone(), "peer".to_owned()))?))
            .collect();
        let best = |all: &[f64]| all.iter().copied().fold(f64::NAN, f64::max);
        let least = ours.iter().copied().fold(f64::NAN, f64::min);
        let _ = write!(
            text,
            "{commit},{instance},{seconds},{},{:.3},{least:.3},{:.3}",
            ours.len(),
            mean(&ours),
            best(&ours)
        );
        if paired.is_empty() {
            text += ",,,,,,,\n";
            continue;
        }
        let bounds = match paired.len() {
            ..MIN_PAIRS => ",".to_owned(),
            _ => {
                let [low, high] = interval(&paired);
                format!("{low:+.3},{high:+.3}")
            }
        };
        let wins = paired.iter().filter(|d| **d > 0.0).count();
        let losses = paired.iter().filter(|d| **d < 0.0).count();
        let _ = writeln!(
            text,
            ",{:.3},{:.3},{:+.3},{bounds},{wins},{losses}",
            mean(&theirs),
            best(&theirs),
            mean(&paired)
        );
    }
    text
}

fn nest(task: &Task) -> Result<(), String> {
    let said = |e: std::io::Error| e.to_string();
    std::fs::create_dir_all(&task.out).map_err(said)?;
    let file = task.out.join("runs.csv");
    let mut rows = std::fs::read_to_string(&file).unwrap_or_else(|_| format!("{HEADER}\n"));
    let commit = commit();
    let known = |rows: &str, run: &Run| {
        let key = format!("{commit},{}", run.key());
        rows.lines().any(|row| {
            let f: Vec<&str> = row.split(',').collect();
            f.len() > 5 && [f[0], f[1], f[2], f[3], f[5]].join(",") == key
        })
    };
    let plan = plan(task);
    let mut failed = Vec::new();
    for (number, (run, instance, limit)) in plan.iter().enumerate() {
        if known(&rows, run) {
            continue;
        }
        match measure(task, run, instance, *limit) {
            Ok(row) => {
                println!("{}/{} {row}", number + 1, plan.len());
                rows += &row;
                rows.push('\n');
                write_atomically(&file, rows.as_bytes()).map_err(|e| e.to_string())?;
            }
            Err(why) => failed.push(format!("{}: {}", run.key(), why.trim())),
        }
    }
    let (table, named) = table(&rows, &commit);
    let text = summary(&table, &commit);
    let file = task.out.join("table.csv");
    write_atomically(&file, text.as_bytes()).map_err(|e| e.to_string())?;
    println!("{text}");
    for row in &named {
        println!("{row}");
    }
    match failed.is_empty() {
        true => Ok(()),
        false => Err(failed.join("\n")),
    }
}

/// The quality an option names.
fn quality_named(name: Option<&String>) -> Result<Quality, String> {
    let name = name.ok_or("--quality needs preview, fit or final")?;
    let all = [Quality::Preview, Quality::Fit, Quality::Final];
    let found = all.into_iter().find(|quality| quality.name() == name);
    found.ok_or(format!("there is no quality {name}"))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.split_first() {
        Some((first, rest)) if first == "nest" => parse(rest).and_then(|task| nest(&task)),
        Some((first, rest)) if first == "hard" => cloth::hard(rest),
        Some((first, rest)) if first == "tangles" => cloth::tangles(rest),
        Some((first, rest)) if first == "sizes" => sizes::sizes(rest),
        Some((first, rest)) if first == "layers" => layers::layers(rest),
        Some((first, rest)) if first == "rest" => rest::rest(rest),
        Some((first, rest)) if first == "edits" => edits::edits(rest),
        Some((first, rest)) if first == "losses" => document::losses(rest),
        Some((first, rest)) if first == "events" => document::events(rest),
        Some((first, rest)) if first == "damaged" => document::damaged(rest),
        _ => Err(
            "say what: soak nest [OPTIONS] INSTANCE.json..., soak hard, soak tangles, soak sizes, soak layers, soak rest, soak edits, soak losses, soak events, soak damaged"
                .to_owned(),
        ),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}
