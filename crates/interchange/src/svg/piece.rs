//! A piece as an SVG file draws it, and the drawn piece that it becomes.

use crate::Loss;
use crate::drawn::builder::{ON_VERTEX, without_vertices_between};
use crate::drawn::inset::inset;
use crate::drawn::piece::{DrawnLine, DrawnNotch, DrawnPiece, Span};
use toile_geometry::{Curve, Vec2, closest_on_segment, ring_area};
use toile_pattern::{Cut, NotchKind};

/// Vertices that lie nearer to the one before are repeats (m).
const REPEAT: f64 = 1e-7;
/// Turn of straight spans in a row that are the chords of a curve, at most (rad): 10 degrees.
const MAX_TURN: f64 = 10.0 / 180.0 * std::f64::consts::PI;
/// Least number of such turns in a row.
const MIN_TURNS: usize = 4;
/// Largest ratio of the lengths of two chords of a curve that follow one another.
const MAX_RATIO: f64 = 3.0;
/// Shortest handle of a curve (m).
const HANDLE: f64 = 1e-6;
/// Largest distance of a notch from the fold that it marks (m).
const ON_FOLD: f64 = 1e-3;

/// A piece, in units of the file, y down.
#[derive(Clone, Debug, Default)]
pub(super) struct SvgPiece {
    /// The name.
    pub name: String,
    /// The line that is sewn, closed, if it is told from the cut line.
    pub sew: Option<DrawnLine>,
    /// The cut line, closed, if the file draws it.
    pub cut: Option<DrawnLine>,
    /// Closed lines that are cut out.
    pub holes: Vec<DrawnLine>,
    /// Lines drawn inside.
    pub inside: Vec<DrawnLine>,
    /// Places and shapes of notches.
    pub notches: Vec<(Vec2, NotchKind)>,
    /// Ends of the grain line.
    pub grain: Option<[Vec2; 2]>,
    /// Two places on the line that lies on the fold.
    pub fold: Option<[Vec2; 2]>,
    /// Number of pieces cut.
    pub quantity: Cut,
}

impl SvgPiece {
    /// The line that is its outline.
    pub fn outline(&self) -> Option<&DrawnLine> {
        self.sew.as_ref().or(self.cut.as_ref())
    }

    /// The piece in metres, y up; also what it lost. `inside` is the distance (m) from the cut line of a piece
    /// that has no sew line inwards to one.
    pub fn drawn(&self, unit: f64, inside: Option<f64>) -> (DrawnPiece, Vec<Loss>) {
        let mut losses = Vec::new();
        let place = |p: Vec2| Vec2::new(p.x, -p.y) * unit;
        let line = |line: &DrawnLine| {
            let mut line = line.mapped(place);
            line.drop_repeats(REPEAT);
            told_curves(&mut line);
            free_handles(&mut line);
            line
        };
        let cut = self.cut.as_ref().map(line);
        let fold = self.fold.map(|ends| ends.map(place));
        let (outline, cut_line) = match (&self.sew, cut) {
            (Some(sew), cut) => (line(sew), cut),
            (None, Some(cut)) => match inside.map(|by| moved_in(&cut, fold, by)) {
                None => (cut, None),
                Some(Some(sew)) => (sew, Some(cut)),
                Some(None) => {
                    losses.push(Loss::at(
                        &self.name,
                        "the allowance that was asked for",
                        "the piece is too narrow for it",
                    ));
                    (cut, None)
                }
            },
            (None, None) => (DrawnLine::default(), None),
        };
        let mut outline = whole(outline);
        let on_outline = fold.and_then(|ends| folded(&mut outline, ends));
        let is_on_fold = |at: Vec2| {
            on_outline.is_some_and(|ends| {
                let place = closest_on_segment(at, ends);
                let is_end = ends.iter().any(|end| (at - end).norm() <= ON_FOLD);
                (place - at).norm() <= ON_FOLD && !is_end
            })
        };
        if outline.area(0) < 0.0 {
            outline.reverse();
        }
        let cut_line = cut_line.map(|mut cut| {
            if cut.area(0) < 0.0 {
                cut.reverse();
            }
            cut.chords(0).points
        });
        let notch = |&(at, kind): &(Vec2, NotchKind)| DrawnNotch {
            at: place(at),
            in_sizes: Vec::new(),
            kind,
        };
        let inner = |all: &[DrawnLine], least: usize| -> Vec<DrawnLine> {
            let all = all.iter().map(line).map(|line| match line.is_closed {
                true => whole(line),
                false => line,
            });
            all.filter(|line| line.len() >= least).collect()
        };
        let notches: Vec<DrawnNotch> = self.notches.iter().map(notch).collect();
        let (on_fold, notches): (Vec<DrawnNotch>, Vec<DrawnNotch>) =
            notches.into_iter().partition(|notch| is_on_fold(notch.at));
        if !on_fold.is_empty() {
            losses.push(Loss {
                count: on_fold.len(),
                ..Loss::at(
                    &self.name,
                    "notches on the fold",
                    "the unfolded piece has no edge there",
                )
            });
        }
        let piece = DrawnPiece {
            name: self.name.clone(),
            fabric: None,
            cut: self.quantity,
            outline,
            cut_line,
            cut_outline: None,
            drills: Vec::new(),
            holes: inner(&self.holes, 2),
            inside: inner(&self.inside, 2),
            notches,
            grain: self.grain.map(|ends| {
                // A grain line has no sense: it is taken to run upwards.
                let [a, b] = ends.map(place);
                let along = b - a;
                let angle = along.y.atan2(along.x).rem_euclid(std::f64::consts::PI);
                (angle * 1e9).round() / 1e9
            }),
            fold: on_outline.or(fold),
        };
        (piece, losses)
    }
}

/// Moves handles that lie on their vertices off them, so that the curves have a direction there.
fn free_handles(line: &mut DrawnLine) {
    let points = line.in_size(0).to_vec();
    for (k, way) in line.spans.iter_mut().enumerate() {
        let Span::Cubic([a, b]) = way else { continue };
        let (from, to) = (points[k], points[(k + 1) % points.len()]);
        let off = |end: Vec2, handle: Vec2, others: [Vec2; 2]| {
            let mut ways = others.into_iter().map(|other| other - end);
            let way = ways.find(|way| way.norm() > HANDLE)?;
            ((handle - end).norm() < HANDLE).then(|| end + way.normalize() * HANDLE)
        };
        let moved = [off(from, *a, [*b, to]), off(to, *b, [*a, from])];
        *a = moved[0].unwrap_or(*a);
        *b = moved[1].unwrap_or(*b);
    }
}

/// A closed line of at least two vertices: one that has a single curve is divided.
fn whole(mut line: DrawnLine) -> DrawnLine {
    if let (true, 1, Span::Cubic([a, b])) = (line.is_closed, line.len(), line.span(0)) {
        let p = line.in_size(0)[0];
        let curve = Curve::Cubic {
            start: p,
            controls: [a, b],
            end: p,
        };
        let halves = [curve.between(0.0, 0.5), curve.between(0.5, 1.0)];
        line.by_size[0].push(halves[0].end());
        let span = |half: &Curve| match half {
            Curve::Cubic { controls, .. } => Span::Cubic(*controls),
            Curve::Line { .. } | Curve::Arc { .. } | Curve::Quadratic { .. } => Span::Straight,
        };
        line.spans = halves.iter().map(span).collect();
    }
    line
}

/// Takes straight spans in a row that turn a little at each vertex for the chords of a curve.
fn told_curves(line: &mut DrawnLine) {
    let count = line.len();
    let points = line.in_size(0);
    let is_smooth = |k: usize| {
        let before = (k + count - 1) % count;
        let is_straight = |k: usize| line.span(k) == Span::Straight;
        let is_inner = line.is_closed || k > 0 && k + 1 < count;
        let (a, b) = (
            points[k] - points[before],
            points[(k + 1) % count] - points[k],
        );
        let turn = a.perp(&b).atan2(a.dot(&b)).abs();
        let ratio = a.norm() / b.norm();
        let is_even = (1.0 / MAX_RATIO..=MAX_RATIO).contains(&ratio);
        let is_turn = turn <= MAX_TURN && turn > 1e-3 && is_even;
        is_inner && is_straight(before) && is_straight(k) && is_turn
    };
    let smooth: Vec<bool> = (0..count).map(is_smooth).collect();
    line.spans.resize(count, Span::Straight);
    // Runs are counted from a vertex that is no part of one; a line without such is a curve all round.
    let Some(start) = smooth.iter().position(|smooth| !smooth) else {
        if count > MIN_TURNS {
            line.spans.fill(Span::Chord);
        }
        return;
    };
    let mut k = start + 1;
    while k < start + count {
        let rest = (k..start + count).take_while(|k| smooth[k % count]);
        let run = rest.count();
        if run >= MIN_TURNS {
            for way in k - 1..k + run {
                line.spans[way % count] = Span::Chord;
            }
        }
        k += run + 1;
    }
}

/// The vertices at the ends of the straight stretch of an outline on which the middle of two places lies, the
/// second one counted on beyond the last; `None` if there is none.
fn stretch(outline: &DrawnLine, [a, b]: [Vec2; 2]) -> Option<[usize; 2]> {
    let points = outline.in_size(0);
    let count = points.len();
    let along = b - a;
    let length = along.norm();
    let off = |p: Vec2| (along.perp(&(p - a)) / length).abs();
    let is_on = |k: usize| {
        let ends = [points[k % count], points[(k + 1) % count]];
        !matches!(outline.span(k % count), Span::Cubic(_))
            && ends.iter().all(|&end| off(end) <= ON_VERTEX)
    };
    let middle = (a + b) * 0.5;
    let first = (0..count).find(|&k| {
        let [from, to] = [points[k], points[(k + 1) % count]];
        let way = to - from;
        let share = (middle - from).dot(&way) / way.norm_squared();
        is_on(k) && (0.0..=1.0).contains(&share)
    })?;
    let on = (1..count).take_while(|step| is_on(first + step)).count();
    let back = (1..count)
        .take_while(|step| is_on(first + count - step))
        .count();
    let from = (first + count - back) % count;
    Some([from, from + (back + on + 1).min(count - 1)])
}

/// The places of both ends of the stretch of an outline on which a fold lies, between which the outline then has
/// no vertices.
fn folded(outline: &mut DrawnLine, ends: [Vec2; 2]) -> Option<[Vec2; 2]> {
    let [from, to] = stretch(outline, ends)?;
    let count = outline.len();
    let found = [from, to].map(|k| outline.in_size(0)[k % count]);
    outline.spans.resize(count, Span::Straight);
    without_vertices_between(outline, [from, to % count]);
    Some(found)
}

/// A sew line at a distance (m) inside a cut line, but on it along the fold; `None` if too little is left.
fn moved_in(cut: &DrawnLine, fold: Option<[Vec2; 2]>, by: f64) -> Option<DrawnLine> {
    let mut cut = cut.clone();
    if cut.area(0) < 0.0 {
        cut.reverse();
    }
    let count = cut.len();
    let fold = fold.and_then(|ends| stretch(&cut, ends));
    let is_fold = |k: usize| {
        fold.is_some_and(|[from, to]| {
            let on = from..to;
            on.contains(&k) || on.contains(&(k + count))
        })
    };
    let on_fold: Vec<bool> = (0..cut.len()).map(is_fold).collect();
    let chords = cut.chords(0);
    let moved = inset(&chords.points, |k| match on_fold[chords.vertex(k)] {
        true => 0.0,
        false => by,
    })?;
    // Vertices of the cut line are corners of the sew line; between them it follows the chords of curves.
    let mut line = DrawnLine::one(moved, true);
    line.is_corner = vec![false; line.len()];
    chords.starts.iter().for_each(|&k| line.is_corner[k] = true);
    (ring_area(line.in_size(0)) > 0.0).then_some(line)
}
