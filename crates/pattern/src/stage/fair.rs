//! The stretches of an edge between darts, redrawn so that the edge is smooth once the darts are closed:
//! straight if possible, else with the least additional bending.
//!
//! Let w be the displacement of the edge square to its drawn shape, as a function of its length s. The
//! additional bending is the integral of w''(s)^2. It is least for a cubic spline which is free at the darts,
//! except that it must turn there by the angle of the kink to be removed (Holladay 1957).

use super::motion::{Motion, turned};
use nalgebra::{Cholesky, DMatrix, DVector};
use toile_geometry::{Curve, Vec2};

/// A dart of a row: it lies between two stretches of the edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closing {
    /// Apex of the dart (m).
    pub apex: Vec2,
    /// Ends of the two legs at the mouth: where the stretch before the dart ends and the stretch after it
    /// starts (m).
    pub ends: [Vec2; 2],
}

/// Row of darts: consecutive darts that open in one edge, and the stretches of the edge before, between and
/// after them.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Curves of each stretch; there is one stretch more than there are darts.
    pub stretches: Vec<Vec<Curve>>,
    pub closings: Vec<Closing>,
    /// Whether the edge keeps its direction at the start and at the end of the row.
    pub keeps: [bool; 2],
}

/// Result of redrawing the edge of a row.
#[derive(Clone, Debug)]
pub(super) struct Redrawn {
    /// New curves of each stretch, one for each curve before.
    pub stretches: Vec<Vec<Curve>>,
    /// New ends of each dart's two legs (m).
    pub ends: Vec<[Vec2; 2]>,
}

/// Reason why the edge of a row cannot be redrawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotTrued {
    /// No smooth line leads across the darts.
    NoLine,
    /// Some leg would become longer or shorter than [`MAX_GROWTH`] allows.
    TooFar,
}

/// Greatest factor by which a leg may become longer or shorter (1). If the apex of a dart lies near its edge,
/// a smooth line across the dart would move the ends of its legs far, and the edge would have little in
/// common with its drawn shape.
pub(crate) const MAX_GROWTH: f64 = 2.0;
/// Differences of angles (rad) and lengths (m) below this count as zero.
const SAME: f64 = 1e-9;
/// Least length of a handle at an end of a curve whose direction is turned there, as a share of the chord of
/// the curve (1).
const SHORTEST_HANDLE: f64 = 0.05;

impl Closing {
    /// Unit vector along a leg, from the apex, and the length of the leg (m).
    fn leg(&self, k: usize) -> Option<(Vec2, f64)> {
        let leg = self.ends[k] - self.apex;
        Some((leg.try_normalize(1e-12)?, leg.norm()))
    }

    /// Angle by which the second leg is turned about the apex to lie on the first (rad).
    fn angle(&self) -> Option<f64> {
        Some(between(self.leg(1)?.0, self.leg(0)?.0))
    }

    /// Angle by which the edge turns at the dart once the dart is closed (rad).
    pub fn kink(&self, before: &[Curve], after: &[Curve]) -> Option<f64> {
        Some(between(
            arriving(before)?,
            turned(leaving(after)?, self.angle()?),
        ))
    }
}

impl Row {
    /// Whether the edge is smooth already once the darts are closed, with legs of equal lengths.
    pub fn is_smooth(&self) -> bool {
        self.closings.iter().enumerate().all(|(k, closing)| {
            let kink = closing.kink(&self.stretches[k], &self.stretches[k + 1]);
            let legs = [0, 1].map(|leg| closing.leg(leg).map_or(0.0, |found| found.1));
            kink.is_some_and(|kink| kink.abs() < SAME) && (legs[0] - legs[1]).abs() < SAME
        })
    }

    /// Whether each stretch of the row is one straight line.
    pub fn is_straight(&self) -> bool {
        self.stretches.iter().all(|stretch| {
            let lines = stretch.iter().all(|c| matches!(c, Curve::Line { .. }));
            let ways: Vec<Vec2> = stretch.iter().map(|c| c.end() - c.start()).collect();
            let bends = ways.windows(2).map(|w| between(w[0], w[1]).abs());
            lines && bends.fold(0.0, f64::max) < SAME
        })
    }

    /// Redraws the edge so that it is smooth once the darts are closed.
    ///
    /// # Errors
    /// No smooth line leads across the darts, or only one that is far from the edge as drawn.
    pub fn redrawn(&self) -> Result<Redrawn, NotTrued> {
        let straight = match self.is_straight() && self.keeps == [false; 2] {
            true => self.straight(),
            false => None,
        };
        let redrawn = straight.or_else(|| self.bent()).ok_or(NotTrued::NoLine)?;
        let pairs = self.closings.iter().zip(&redrawn.ends);
        let is_near = |(closing, ends): (&Closing, &[Vec2; 2])| {
            let [new, first, second] =
                [ends[0], closing.ends[0], closing.ends[1]].map(|end| (end - closing.apex).norm());
            new <= MAX_GROWTH * first.max(second) && MAX_GROWTH * new >= first.min(second)
        };
        match pairs.into_iter().all(is_near) {
            true => Ok(redrawn),
            false => Err(NotTrued::TooFar),
        }
    }

    /// Redraws the edge along the straight line that joins its ends when all darts are closed.
    fn straight(&self) -> Option<Redrawn> {
        let mut motion = Motion::NONE;
        let mut folds = Vec::with_capacity(self.closings.len());
        for closing in &self.closings {
            let apex = motion.point(closing.apex);
            folds.push((apex, motion.direction(closing.leg(0)?.0)));
            motion = motion.after(Motion::about(closing.apex, closing.angle()?));
        }
        let start = self.stretches.first()?.first()?.start();
        let end = self.stretches.last()?.last()?.end();
        let way = motion.point(end) - start;
        let mut reached = 0.0;
        let mut ends = Vec::with_capacity(folds.len());
        for (closing, (apex, out)) in self.closings.iter().zip(folds) {
            let radius = (start - apex).perp(&way) / out.perp(&way);
            let along = (apex + out * radius - start).dot(&way) / way.norm_squared();
            if !(radius > SAME && along > reached && along < 1.0) {
                return None;
            }
            reached = along;
            ends.push(closing.at(radius)?);
        }
        let stretches = self.stretches.iter().enumerate().map(|(k, stretch)| {
            let from = k.checked_sub(1).map_or(start, |k| ends[k][1]);
            let to = ends.get(k).map_or(end, |ends| ends[0]);
            let mut shares = lengths_before(stretch);
            let length = shares.last().copied().unwrap_or(1.0);
            shares.iter_mut().for_each(|share| *share /= length);
            let at = |share: f64| match share {
                share if share >= 1.0 => to,
                share => from + (to - from) * share,
            };
            let lines = shares.windows(2).map(|share| Curve::Line {
                start: at(share[0]),
                end: at(share[1]),
            });
            lines.collect()
        });
        Some(Redrawn {
            stretches: stretches.collect(),
            ends,
        })
    }

    /// Redraws the edge with the least additional bending. An end of the row is free to turn if all stretches
    /// are straight and the edge need not keep its direction there.
    fn bent(&self) -> Option<Redrawn> {
        let is_straight = self.is_straight();
        let frees = self.keeps.map(|keeps| is_straight && !keeps);
        let beam = Beam::of(self, frees)?;
        let solved = beam.solve()?;
        let mut ends = Vec::with_capacity(self.closings.len());
        for (k, closing) in self.closings.iter().enumerate() {
            let radius = solved[2 * k];
            if !(radius.is_finite() && radius > SAME) {
                return None;
            }
            ends.push(closing.at(radius)?);
        }
        let mut stretches = Vec::with_capacity(self.stretches.len());
        for (k, stretch) in self.stretches.iter().enumerate() {
            let [from, to] = beam.knots[k].each_ref().map(|knot| knot.at(&solved));
            let bent = Bent {
                stretch,
                heights: [from.0, to.0],
                turns: [from.1, to.1],
                ends: [
                    k.checked_sub(1).map(|k| ends[k][1]),
                    ends.get(k).map(|ends| ends[0]),
                ],
            };
            stretches.push(bent.curves()?);
        }
        Some(Redrawn { stretches, ends })
    }
}

impl Closing {
    /// Ends of both legs if they are `radius` long (m).
    fn at(&self, radius: f64) -> Option<[Vec2; 2]> {
        let [a, b] = [self.leg(0)?.0, self.leg(1)?.0];
        Some([a, b].map(|out| self.apex + out * radius))
    }
}

/// A number that is an affine function of the unknowns: `constant`, plus a factor times the unknown for each
/// of `terms`, which hold the index of the unknown and the factor.
#[derive(Clone, Debug, Default)]
struct Affine {
    constant: f64,
    terms: Vec<(usize, f64)>,
}

impl Affine {
    fn of(unknown: usize, factor: f64, constant: f64) -> Self {
        Self {
            constant,
            terms: vec![(unknown, factor)],
        }
    }

    fn at(&self, solved: &DVector<f64>) -> f64 {
        let terms = self.terms.iter().map(|(k, factor)| solved[*k] * factor);
        self.constant + terms.sum::<f64>()
    }
}

/// An end of a stretch: displacement square to the stretch (m) and turn of its direction (rad).
#[derive(Clone, Debug, Default)]
struct Knot {
    height: Affine,
    turn: Affine,
}

impl Knot {
    fn at(&self, solved: &DVector<f64>) -> (f64, f64) {
        (self.height.at(solved), self.turn.at(solved))
    }
}

/// The additional bending of a row as a function of unknowns: for each dart the length of its legs (m) and
/// the turn of the edge there (rad), then the turns of the free ends (rad).
struct Beam {
    /// Both ends of each stretch.
    knots: Vec<[Knot; 2]>,
    /// Length of each stretch (m).
    lengths: Vec<f64>,
    /// Number of unknowns.
    unknowns: usize,
}

impl Beam {
    fn of(row: &Row, frees: [bool; 2]) -> Option<Self> {
        let count = row.closings.len();
        let mut unknowns = 2 * count;
        let mut knots = vec![[Knot::default(), Knot::default()]; count + 1];
        for (end, &is_free) in frees.iter().enumerate() {
            if is_free {
                knots[end * count][end].turn = Affine::of(unknowns, 1.0, 0.0);
                unknowns += 1;
            }
        }
        for (k, closing) in row.closings.iter().enumerate() {
            let (before, after) = (&row.stretches[k], &row.stretches[k + 1]);
            let ways = [arriving(before)?, leaving(after)?];
            let kink = closing.kink(before, after)?;
            let heights = [0, 1].map(|leg| {
                let (out, length) = closing.leg(leg)?;
                let across = ways[leg].perp(&out);
                Some(Affine::of(2 * k, across, -length * across))
            });
            let [first, second] = heights;
            knots[k][1] = Knot {
                height: first?,
                turn: Affine::of(2 * k + 1, 1.0, 0.0),
            };
            knots[k + 1][0] = Knot {
                height: second?,
                turn: Affine::of(2 * k + 1, 1.0, -kink),
            };
        }
        let lengths = row.stretches.iter().map(|s| length(s)).collect();
        Some(Self {
            knots,
            lengths,
            unknowns,
        })
    }

    /// Solves for the unknowns with which the additional bending is least.
    fn solve(&self) -> Option<DVector<f64>> {
        let mut matrix = DMatrix::zeros(self.unknowns, self.unknowns);
        let mut right = DVector::zeros(self.unknowns);
        for ([from, to], &l) in self.knots.iter().zip(&self.lengths) {
            // Matrix of twice the bending energy of a cubic, for its heights and slopes at both ends.
            let stiffness = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
            ];
            let values = [&from.height, &from.turn, &to.height, &to.turn];
            for (a, row) in values.iter().zip(stiffness) {
                for (b, entry) in values.iter().zip(row) {
                    let entry = entry / (l * l * l);
                    for &(i, first) in &a.terms {
                        for &(j, second) in &b.terms {
                            matrix[(i, j)] += first * entry * second;
                        }
                        right[i] -= first * entry * b.constant;
                    }
                }
            }
        }
        Some(Cholesky::new(matrix)?.solve(&right))
    }
}

/// A stretch that is displaced by a cubic with these heights (m) and turns (rad) at its ends.
struct Bent<'r> {
    stretch: &'r [Curve],
    heights: [f64; 2],
    turns: [f64; 2],
    /// Exact start and end of the stretch (m), if they are ends of legs of darts. `None`: the drawn end
    /// stays.
    ends: [Option<Vec2>; 2],
}

impl Bent<'_> {
    /// Height (m) and turn (rad) of the cubic at a share of its length.
    fn at(&self, share: f64, length: f64) -> (f64, f64) {
        let (t, u) = (share, 1.0 - share);
        let ([h, k], [a, b]) = (self.heights, self.turns.map(|turn| turn * length));
        let height = h * u * u * (1.0 + 2.0 * t) + k * t * t * (1.0 + 2.0 * u) + a * t * u * u
            - b * t * t * u;
        let slope = 6.0 * t * u * (k - h) + a * u * (u - 2.0 * t) + b * t * (t - 2.0 * u);
        (height, slope / length)
    }

    fn curves(&self) -> Option<Vec<Curve>> {
        let before = lengths_before(self.stretch);
        let length = *before.last()?;
        let last = self.stretch.len();
        let mut places = Vec::with_capacity(last + 1);
        for (k, along) in before.iter().enumerate() {
            let (height, turn) = match k {
                0 => (self.heights[0], self.turns[0]),
                k if k == last => (self.heights[1], self.turns[1]),
                _ => self.at(along / length, length),
            };
            let (at, way) = match k {
                0 => (self.stretch[0].start(), leaving(self.stretch)?),
                k => (self.stretch[k - 1].end(), arriving(&self.stretch[..k])?),
            };
            let at = match k {
                0 => self.ends[0].unwrap_or(at),
                k if k == last => self.ends[1].unwrap_or(at),
                _ => at + Vec2::new(-way.y, way.x) * height,
            };
            places.push((at, turn));
        }
        let curves = self.stretch.iter().zip(places.windows(2));
        curves
            .map(|(curve, ends)| bent(*curve, [ends[0], ends[1]]))
            .collect()
    }
}

/// A curve moved to new ends, with its directions at both ends turned by angles (rad). `None`: the curve has
/// no direction.
fn bent(curve: Curve, [(start, first), (end, second)]: [(Vec2, f64); 2]) -> Option<Curve> {
    let [near, far] = handles(curve);
    let chord = (curve.end() - curve.start()).norm();
    let scale = match chord > SAME {
        true => (end - start).norm() / chord,
        false => 1.0,
    };
    let handle = |handle: Vec2, way: Vec2, turn: f64| {
        let short = handle.norm() < SHORTEST_HANDLE * chord;
        let handle = match short && turn != 0.0 {
            true => way * (SHORTEST_HANDLE * chord),
            false => handle,
        };
        turned(handle * scale, turn)
    };
    Some(Curve::Cubic {
        start,
        controls: [
            start + handle(near, leaving(&[curve])?, first),
            end + handle(far, -arriving(&[curve])?, second),
        ],
        end,
    })
}

/// Vectors from both ends of a curve to the control points of an equal cubic; for an arc, of the cubic with
/// the same ends, end directions and middle (Goldapp 1991).
fn handles(curve: Curve) -> [Vec2; 2] {
    let third = match curve {
        // The arc turns by four times atan(bulge).
        Curve::Arc { bulge, .. } if bulge != 0.0 => bulge / (3.0 * bulge.atan()),
        Curve::Line { .. } | Curve::Arc { .. } | Curve::Quadratic { .. } | Curve::Cubic { .. } => {
            1.0 / 3.0
        }
    };
    [
        curve.derivative(0.0) * third,
        -curve.derivative(1.0) * third,
    ]
}

fn length(curves: &[Curve]) -> f64 {
    curves.iter().map(Curve::length).sum()
}

/// Length before each of the joined curves, and the length of all (m).
fn lengths_before(curves: &[Curve]) -> Vec<f64> {
    let mut along = 0.0;
    let mut before = vec![0.0];
    before.extend(curves.iter().map(|curve| {
        along += curve.length();
        along
    }));
    before
}

/// Unit vector along joined curves at their start.
pub(super) fn leaving(curves: &[Curve]) -> Option<Vec2> {
    let first = curves.first()?;
    let own = first.derivative(0.0).try_normalize(1e-12);
    own.or_else(|| (first.point(1e-3) - first.start()).try_normalize(1e-15))
}

/// Unit vector along joined curves at their end.
pub(super) fn arriving(curves: &[Curve]) -> Option<Vec2> {
    let last = curves.last()?;
    let own = last.derivative(1.0).try_normalize(1e-12);
    own.or_else(|| (last.end() - last.point(1.0 - 1e-3)).try_normalize(1e-15))
}

/// Signed angle from one direction to another (rad), positive counter-clockwise.
pub(super) fn between(from: Vec2, to: Vec2) -> f64 {
    from.perp(&to).atan2(from.dot(&to))
}
