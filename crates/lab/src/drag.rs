//! What one pointer move of a drag costs, as a window makes it: planner, preview, draft, and the
//! cut lines of the pieces that changed. Beside it: everything afresh, and the draft after another
//! measurement. Checks wait until a drag ends, so they are no part of it; nor is drawing.

use crate::LabError;
use crate::clock::Clock;
use crate::drag_pattern::{POINTS, large_pattern};
use crate::timed::Timed;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::Vec2;
use toile_interchange::write_pattern;
use toile_pattern::{Draft, Evaluation, Pattern, PointId, Stage, plan};
use toile_session::{Command, SAMPLES, Session, Silent};

/// Panels of the large pattern.
const PANELS: usize = 200;
/// Points that are dragged of it, chosen by a seed.
const DRAGGED: usize = 100;
const SEED: u64 = 4;
/// Moves timed of each point.
const MOVES: usize = 5;
/// Of the large pattern everything is evaluated after every tenth point, of a small one after each.
const LARGE_STRIDE: usize = 10;
/// How far the pointer is from where the point was, at the most (m).
const REACH: f64 = 0.004;

/// Wall and processor time (s).
#[derive(Clone, Copy, Debug, Default)]
struct DragTimes {
    wall: f64,
    cpu: f64,
}

impl DragTimes {
    fn since(clock: &Clock) -> Self {
        Self {
            wall: clock.wall(),
            cpu: clock.spent(),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            wall: self.wall + other.wall,
            cpu: self.cpu + other.cpu,
        }
    }
}

/// Middle of times, wall and processor each.
fn middle(times: &[DragTimes]) -> DragTimes {
    DragTimes {
        wall: median(times.iter().map(|t| t.wall)),
        cpu: median(times.iter().map(|t| t.cpu)),
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NAN, f64::max)
}

/// A pattern in a window: its session, the values before the drag, and what is shown of each panel.
struct Window {
    session: Session,
    base: Arc<Evaluation>,
    stages: Vec<Option<Arc<Stage>>>,
    cuts: Vec<Option<CutPiece>>,
}

fn session_error(error: impl std::fmt::Display) -> LabError {
    LabError::Files {
        what: format!("the drag cannot be timed: {error}"),
    }
}

impl Window {
    fn open(command: Command) -> Result<Self, LabError> {
        let mut session = Session::new();
        session
            .execute(command, &mut Silent)
            .map_err(session_error)?;
        let mut window = Self {
            base: session.evaluation(),
            session,
            stages: Vec::new(),
            cuts: Vec::new(),
        };
        window.follow();
        Ok(window)
    }

    /// Draft and cut lines of what changed since this was last done; numbers of the pieces.
    fn follow(&mut self) -> Vec<usize> {
        let draft = self.session.draft();
        let evaluation = self.session.evaluation();
        let pattern = evaluation.pattern();
        self.cuts.resize_with(draft.pieces.len(), || None);
        let mut changed = Vec::new();
        let mut stages = Vec::new();
        for (k, panel) in pattern.panels.iter().enumerate() {
            let now = evaluation.last_stage(panel);
            let known = self.stages.get(k).and_then(Option::as_ref);
            let same = match (known, now) {
                (Some(known), Some(now)) => Arc::ptr_eq(known, now),
                (known, now) => known.is_none() && now.is_none(),
            };
            if !same {
                let pieces = draft.pieces.iter().enumerate();
                let own = pieces.filter(|(_, piece)| piece.id.panel == panel.id);
                changed.extend(own.map(|(number, _)| number));
            }
            stages.push(now.cloned());
        }
        for &number in &changed {
            self.cuts[number] = cut(pattern, &draft, number);
        }
        self.stages = stages;
        changed
    }

    /// Shows edits, as a window does with each move of the pointer.
    fn show(&mut self, edits: &[toile_pattern::Edit]) -> Result<Vec<usize>, LabError> {
        self.session.preview(edits).map_err(session_error)?;
        Ok(self.follow())
    }

    /// A pointer move that brings a point to a place (m).
    fn drag(&mut self, goal: (PointId, Vec2)) -> Result<Vec<usize>, LabError> {
        let moved = plan::move_points(&self.base, &[goal]).map_err(session_error)?;
        self.show(&moved.edits)
    }

    fn release(&mut self) {
        self.session.cancel();
        self.follow();
    }
}

fn cut(pattern: &Pattern, draft: &Draft, number: usize) -> Option<CutPiece> {
    let how = (None, &CutOptions::default());
    CutPiece::new((pattern, draft), number, how).ok()
}

/// Everything afresh, by its parts.
#[derive(Clone, Default)]
struct Whole {
    values: Vec<DragTimes>,
    draft: Vec<DragTimes>,
    /// Of each piece.
    cuts: Vec<Vec<DragTimes>>,
    all: Vec<DragTimes>,
}

impl Whole {
    fn again(&mut self, base: &Evaluation) {
        let clock = Clock::start();
        let evaluation = Evaluation::new(base.pattern(), base.wearer());
        let values = DragTimes::since(&clock);
        let clock = Clock::start();
        let (draft, _) = evaluation.draft();
        let drafted = DragTimes::since(&clock);
        self.cuts.resize_with(draft.pieces.len(), Vec::new);
        let mut all = values.plus(drafted);
        for number in 0..draft.pieces.len() {
            let clock = Clock::start();
            let _ = cut(base.pattern(), &draft, number);
            let spent = DragTimes::since(&clock);
            self.cuts[number].push(spent);
            all = all.plus(spent);
        }
        self.values.push(values);
        self.draft.push(drafted);
        self.all.push(all);
    }

    /// Processor time of what depends on a point (s): its values as they were timed, its part of
    /// the draft by the number of pieces, and their cut lines.
    fn part(&self, dragged: &Dragged) -> f64 {
        let pieces = &dragged.pieces;
        let cuts = pieces.iter().map(|&k| middle(&self.cuts[k]).cpu);
        let draft = middle(&self.draft).cpu * pieces.len() as f64 / self.cuts.len().max(1) as f64;
        dragged.values.cpu + draft + cuts.sum::<f64>()
    }
}

/// One point that was dragged.
struct Dragged {
    spent: DragTimes,
    /// The values that depend on it, computed once.
    values: DragTimes,
    pieces: Vec<usize>,
}

/// Results on one pattern.
struct Found {
    name: String,
    points: usize,
    panels: usize,
    dragged: Vec<Dragged>,
    whole: Whole,
    redraft: Vec<DragTimes>,
    measurement: String,
}

/// A number from 0 to 1 by a seed and its place (Steele, Lea and Flood 2014, SplitMix64).
fn unit(seed: u64, k: u64) -> f64 {
    let mut z = (seed << 32 | k)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Points that can be moved, in an order by a seed.
fn chosen(base: &Evaluation, most: usize) -> Vec<(PointId, Vec2)> {
    let mut all: Vec<(PointId, Vec2)> = base
        .points()
        .into_iter()
        .map(|((_, id), place)| (id, place))
        .collect();
    for k in (1..all.len()).rev() {
        let other = (unit(SEED, k as u64) * (k + 1) as f64) as usize;
        all.swap(k, other);
    }
    let step = Vec2::new(REACH, REACH);
    let moves = |&(id, place): &(PointId, Vec2)| plan::move_point(base, id, place + step).is_ok();
    all.into_iter().filter(moves).take(most).collect()
}

/// The measurement of the base size from which most follows, its value (m), and the edits that make
/// it a centimetre more or less.
fn measurement(base: &Evaluation) -> Option<(String, [Vec<toile_pattern::Edit>; 2])> {
    let pattern = base.pattern();
    let size = pattern.base()?;
    let names = size.measurements.iter().map(|(name, _)| name.to_owned());
    let edits = |name: &str, more: f64| {
        let value = size.measurements.get(name)? + more;
        plan::set_measurement(base, size.id, name, Some(value)).ok()
    };
    let follows = |name: &String| {
        let mut after = pattern.clone();
        let edits = edits(name, 0.01).unwrap_or_default();
        let wearer = |pattern: &Pattern| pattern.base().map(toile_pattern::Wearer::from);
        match after.apply(&edits) {
            Ok(()) => {
                let mut evaluation = base.clone();
                let whom = wearer(&after).unwrap_or_default();
                evaluation.update(&after, whom).changed
            }
            Err(_) => 0,
        }
    };
    let name = names.max_by_key(follows)?;
    let both = [edits(&name, 0.01)?, edits(&name, 0.005)?];
    Some((name, both))
}

fn measured(name: &str, command: Command, stride: usize) -> Result<Found, LabError> {
    let mut window = Window::open(command)?;
    let base = window.base.clone();
    let mut found = Found {
        name: name.to_owned(),
        points: base.points().len(),
        panels: base.pattern().panels.len(),
        dragged: Vec::new(),
        whole: Whole::default(),
        redraft: Vec::new(),
        measurement: String::new(),
    };
    let other = measurement(&base);
    for (k, (id, place)) in chosen(&base, DRAGGED).into_iter().enumerate() {
        let mut times = Vec::new();
        let mut pieces = Vec::new();
        // The first move begins the gesture; those after it are what a drag consists of.
        for step in 0..=MOVES {
            let at = |j: usize| 2.0 * unit(SEED + 1, (64 * k + 2 * step + j) as u64) - 1.0;
            let goal = (id, place + Vec2::new(at(0), at(1)) * REACH);
            let clock = Clock::start();
            pieces = window.drag(goal)?;
            if step > 0 {
                times.push(DragTimes::since(&clock));
            }
        }
        window.release();
        found.dragged.push(Dragged {
            spent: middle(&times),
            values: values(&base, (id, place))?,
            pieces,
        });
        if k % stride == 0 {
            found.whole.again(&base);
            if let Some((name, edits)) = &other {
                found.measurement.clone_from(name);
                for edits in edits {
                    let clock = Clock::start();
                    window.show(edits)?;
                    found.redraft.push(DragTimes::since(&clock));
                }
                window.release();
            }
        }
    }
    Ok(found)
}

/// What computing the values takes that depend on a point: it is moved to and fro, without planner
/// and session.
fn values(base: &Evaluation, (id, place): (PointId, Vec2)) -> Result<DragTimes, LabError> {
    let mut kept = base.clone();
    let mut times = Vec::new();
    for step in 0..=MOVES {
        let goal = place + Vec2::repeat(REACH / (step + 2) as f64);
        let edits = plan::move_point(base, id, goal).map_err(session_error)?;
        let mut pattern = base.pattern().clone();
        pattern.apply(&edits).map_err(session_error)?;
        let clock = Clock::start();
        kept.update(&pattern, base.wearer());
        if step > 0 {
            times.push(DragTimes::since(&clock));
        }
    }
    Ok(middle(&times))
}

/// Times drags on the large pattern and on those that ship.
pub(crate) fn drag(result: &mut Timed) -> Result<(), LabError> {
    let clock = Clock::start();
    let large = large_pattern(PANELS).map_err(session_error)?;
    result.vertices = PANELS * POINTS;
    let command = Command::RestorePattern {
        text: write_pattern(&large).map_err(session_error)?,
        source: None,
        past: Vec::new(),
    };
    let mut all = vec![measured("large", command, LARGE_STRIDE)?];
    for (path, name) in SAMPLES {
        let path = PathBuf::from(path);
        all.push(measured(name, Command::open(path), 1)?);
    }
    let mut text = heading();
    for found in &all {
        line(&mut text, found);
        let key = found.name.to_lowercase().replace([' ', '-'], "_");
        let moves = || found.dragged.iter().map(|d| d.spent);
        let (one, whole) = (
            middle(&moves().collect::<Vec<_>>()),
            middle(&found.whole.all),
        );
        for (what, value) in [
            ("move_cpu_ms", 1e3 * one.cpu),
            ("move_wall_ms", 1e3 * one.wall),
            ("all_cpu_ms", 1e3 * whole.cpu),
            ("all_wall_ms", 1e3 * whole.wall),
            ("redraft_cpu_ms", 1e3 * middle(&found.redraft).cpu),
            ("move_to_all", one.cpu / whole.cpu),
            ("move_to_part", median(excesses(found))),
        ] {
            result.counted.insert(format!("{key}_{what}"), value);
        }
    }
    result.report = Some(text);
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    Ok(())
}

/// Of each point: the cost of its move over that of what depends on it.
fn excesses(found: &Found) -> impl Iterator<Item = f64> {
    let dragged = found.dragged.iter();
    dragged.map(|one| one.spent.cpu / found.whole.part(one))
}

/// The text over the table, and its first two lines.
fn heading() -> String {
    let columns = [
        "pattern",
        "points",
        "panels",
        "a move, ms (most)",
        "wall",
        "all, ms: values + draft + cut lines",
        "wall",
        "all / move",
        "what depends on the point, % of all",
        "move / that (most)",
        "after a measurement, ms",
        "wall",
    ];
    format!(
        "Processor time, and wall time where it says so: medians over the points, in brackets the most of one point.\n\n\
         | {} |\n{}|\n",
        columns.join(" | "),
        "|---".repeat(columns.len())
    )
}

fn line(text: &mut String, found: &Found) {
    let moves: Vec<DragTimes> = found.dragged.iter().map(|d| d.spent).collect();
    let one = middle(&moves);
    let whole = middle(&found.whole.all);
    let cuts = found.whole.cuts.iter().map(|times| middle(times).cpu);
    let redraft = middle(&found.redraft);
    let depends = median(found.dragged.iter().map(|one| found.whole.part(one)));
    let _ = writeln!(
        text,
        "| {} | {} | {} | {:.3} ({:.3}) | {:.3} | {:.2}: {:.2} + {:.2} + {:.2} | {:.2} | {:.1} | {:.1} | {:.2} ({:.2}) | {:.2} ({}) | {:.2} |",
        found.name,
        found.points,
        found.panels,
        1e3 * one.cpu,
        1e3 * most(moves.iter().map(|t| t.cpu)),
        1e3 * one.wall,
        1e3 * whole.cpu,
        1e3 * middle(&found.whole.values).cpu,
        1e3 * middle(&found.whole.draft).cpu,
        1e3 * cuts.sum::<f64>(),
        1e3 * whole.wall,
        whole.cpu / one.cpu,
        100.0 * depends / whole.cpu,
        median(excesses(found)),
        most(excesses(found)),
        1e3 * redraft.cpu,
        found.measurement.replace('_', " "),
        1e3 * redraft.wall,
    );
}
