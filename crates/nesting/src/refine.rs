//! Exact local improvement of an approximate position.
//!
//! Near a position the loss is a sum of ramps, one for each piece that is too near. Its minimum therefore
//! lies at a point where two pieces are just touched, or one piece and an edge of the fabric, or where one
//! ramp ends. Those points are tried, and the search repeats from the best one.

use crate::job::{Axis, Job};
use crate::layout::Layout;
use crate::pair::PairQuery;
use toile_geometry::Vec2;

/// Largest number of steps from point to point.
const STEPS: usize = 8;
/// Largest number of contact lines considered around a position.
const LINES: usize = 8;
/// Largest number of points tried in a step, the most promising first.
const TRIALS: usize = 4;
/// Longest step, relative to the width of the fabric and to the deepest overlap.
const REACH: f64 = 0.25;
const STRIDE: f64 = 4.0;

/// The line of positions at which the moving piece just touches another: `normal . move = level`.
#[derive(Clone, Copy, Debug)]
struct Line {
    normal: Vec2,
    level: f64,
    weight: f64,
    /// Weighted loss; 0 for a piece that is only near.
    loss: f64,
    /// Distance of the line from the current position (m).
    apart: f64,
}

/// A piece to be moved among the others.
pub(crate) struct Mover<'a, 'j> {
    pub job: &'j Job<'j>,
    pub layout: &'a Layout,
    pub piece: usize,
    /// Weights of the pairs of this piece.
    pub weights: &'a [f64],
    /// Number of queries made.
    pub queries: u64,
    pub scratch: &'a mut Scratch<'j>,
}

/// Another piece near a position.
#[derive(Clone, Copy, Debug)]
struct Neighbour<'a> {
    at: Vec2,
    /// Size of the bounding box (m).
    size: Vec2,
    weight: f64,
    pair: PairQuery<'a>,
}

impl Neighbour<'_> {
    /// Offset of a position from this piece (m), if the bounding box of a piece of `size` there is nearer
    /// than `more` to the box of this piece.
    #[inline(always)]
    fn apart(&self, at: Vec2, size: Vec2, more: f64) -> Option<Vec2> {
        let apart = at - self.at;
        let meets = apart.x < self.size.x + more
            && apart.y < self.size.y + more
            && apart.x > -size.x - more
            && apart.y > -size.y - more;
        meets.then_some(apart)
    }
}

/// Reusable lists.
#[derive(Debug, Default)]
pub(crate) struct Scratch<'a> {
    neighbours: Vec<Neighbour<'a>>,
    lines: Vec<Line>,
    targets: Vec<(f64, Vec2)>,
}

impl Mover<'_, '_> {
    /// Finds the pieces that a shape can meet within `reach` of a position (m).
    pub fn gather(&mut self, shape: usize, at: Vec2, reach: f64) {
        let size = self.job.shapes[shape].size;
        let neighbours = &mut self.scratch.neighbours;
        neighbours.clear();
        let layout = self.layout;
        for other in 0..layout.at.len() {
            let (place, far) = (layout.at[other], layout.size[other]);
            let apart = at - place;
            let meets = apart.x < far.x + reach
                && apart.y < far.y + reach
                && apart.x > -size.x - reach
                && apart.y > -size.y - reach;
            if !meets || other == self.piece {
                continue;
            }
            neighbours.extend(
                self.job
                    .pair(layout.shape[other], shape)
                    .map(|pair| Neighbour {
                        at: place,
                        size: far,
                        weight: self.weights[other],
                        pair,
                    }),
            );
        }
    }

    /// Weighted loss at a position within reach; stops early with a value above `limit`.
    #[inline]
    pub fn loss(&mut self, shape: usize, at: Vec2, limit: f64) -> f64 {
        let size = self.job.shapes[shape].size;
        let more = self.job.widest_gap + self.job.growth();
        let mut sum = 0.0;
        for near in &self.scratch.neighbours {
            let Some(apart) = near.apart(at, size, more) else {
                continue;
            };
            self.queries += 1;
            sum += near.weight * near.pair.loss(apart);
            if sum > limit {
                break;
            }
        }
        sum
    }

    /// Computes the loss at a position and the contact lines around it, sorted by decreasing loss.
    fn lines(&mut self, shape: usize, at: Vec2) -> f64 {
        let size = self.job.shapes[shape].size;
        let window = self.job.window();
        let more = self.job.widest_gap + window;
        let mut sum = 0.0;
        let Scratch {
            neighbours, lines, ..
        } = &mut *self.scratch;
        lines.clear();
        for near in neighbours.iter() {
            let Some(apart) = near.apart(at, size, more) else {
                continue;
            };
            self.queries += 1;
            let Some((probe, gap)) = near.pair.probe(apart) else {
                continue;
            };
            let loss = probe.depth + gap;
            if loss < -window {
                continue;
            }
            let weighted = near.weight * loss.max(0.0);
            sum += weighted;
            lines.push(Line {
                normal: probe.normal,
                level: probe.normal.dot(&at) + loss,
                weight: near.weight,
                loss: weighted,
                apart: loss.abs(),
            });
        }
        lines.sort_by(|a, b| b.loss.total_cmp(&a.loss).then(a.apart.total_cmp(&b.apart)));
        sum
    }

    /// Finds the pieces within a step of a position and the contact lines around it; returns the loss there.
    fn look_around(&mut self, shape: usize, at: Vec2) -> f64 {
        let step = REACH * self.job.height;
        self.gather(shape, at, step + self.job.widest_gap + self.job.window());
        self.lines(shape, at)
    }

    /// The best position found near a given one, with its loss. Stops when there is no improvement.
    pub fn refine(&mut self, shape: usize, from: Vec2) -> Option<(f64, Vec2)> {
        let room = self.layout.room(self.job, shape)?;
        let axes = self.job.axes(self.piece, shape, &self.layout.phases);
        let mut at = self
            .layout
            .nearest_allowed(self.job, self.piece, shape, from)?;
        let mut best = self.look_around(shape, at);
        for _ in 0..STEPS {
            if best <= 0.0 {
                break;
            }
            let enough = best * (1.0 - 1e-9);
            let Scratch { lines, targets, .. } = &mut *self.scratch;
            targets.clear();
            propose(lines, (at, REACH * self.job.height), (room, axes), targets);
            let mut next = None;
            for _ in 0..TRIALS {
                let Some((guess, target)) = least(&mut self.scratch.targets) else {
                    break;
                };
                if guess >= best * (1.0 - 1e-9) {
                    break;
                }
                let Some(target) = self
                    .layout
                    .nearest_allowed(self.job, self.piece, shape, target)
                else {
                    continue;
                };
                let loss = self.loss(shape, target, best);
                if loss < best * (1.0 - 1e-9) {
                    best = loss;
                    next = Some(target);
                }
            }
            let Some(next) = next.filter(|_| best < enough) else {
                break;
            };
            at = next;
            best = self.look_around(shape, at);
        }
        Some((best, at))
    }
}

/// Removes the most promising target from a list.
fn least(targets: &mut Vec<(f64, Vec2)>) -> Option<(f64, Vec2)> {
    let best = (0..targets.len()).min_by(|&a, &b| targets[a].0.total_cmp(&targets[b].0))?;
    Some(targets.swap_remove(best))
}

/// Proposes points near a position at which ramps end or contact lines cross, each with the loss predicted by
/// linear extrapolation.
fn propose(
    lines: &[Line],
    (at, reach): (Vec2, f64),
    (room, axes): (Vec2, [Axis; 2]),
    targets: &mut Vec<(f64, Vec2)>,
) {
    let overlapping = lines.iter().filter(|l| l.loss > 0.0).map(|l| l.apart);
    let radius = reach.min(STRIDE * overlapping.fold(0.0, f64::max));
    let mut add = |target: Vec2| {
        let target = target.sup(&Vec2::zeros()).inf(&room);
        if (target - at).norm_squared() <= radius * radius {
            let ramp = |l: &Line| l.weight * (l.level - l.normal.dot(&target)).max(0.0);
            targets.push((lines.iter().map(ramp).sum(), target));
        }
    };
    for (k, line) in lines.iter().take(LINES).enumerate() {
        let missing = line.level - line.normal.dot(&at);
        if line.loss > 0.0 {
            add(at + line.normal * missing);
        }
        // Along each axis to the line, for pieces that can move along one axis only.
        for axis in 0..2 {
            let held = axes[1 - axis] != Axis::Free;
            if (held || line.loss > 0.0) && line.normal[axis].abs() > 1e-3 {
                let mut target = at;
                target[axis] += missing / line.normal[axis];
                add(target);
            }
        }
        if line.loss <= 0.0 {
            continue;
        }
        for other in lines.iter().take(LINES).skip(k + 1) {
            let cross = line.normal.perp(&other.normal);
            if cross.abs() > 1e-3 {
                let x = line.level * other.normal.y - other.level * line.normal.y;
                let y = other.level * line.normal.x - line.level * other.normal.x;
                add(Vec2::new(x, y) / cross);
            }
        }
        // Intersection of the line with an edge of the fabric.
        for axis in 0..2 {
            for wall in [0.0, room[axis]] {
                let other = 1 - axis;
                if line.normal[other].abs() > 1e-3 {
                    let mut target = Vec2::zeros();
                    target[axis] = wall;
                    target[other] = (line.level - line.normal[axis] * wall) / line.normal[other];
                    add(target);
                }
            }
        }
    }
}
