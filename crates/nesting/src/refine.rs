//! The exact step from a rough place to a good one.
//!
//! Near a place the loss is a sum of ramps, one for each piece that is too near, so its least value
//! lies where two pieces touch, or one piece and an edge of the fabric, or where one ramp ends.
//! Those points are tried, and from the best one again.

use crate::job::{Axis, Job};
use crate::layout::Layout;
use toile_geometry::Vec2;

/// Most steps from point to point.
const STEPS: usize = 8;
/// Most pieces looked at around a place.
const LINES: usize = 8;

/// The line on which the moving piece just touches another: `normal . move = level`.
#[derive(Clone, Copy, Debug)]
struct Line {
    normal: Vec2,
    level: f64,
    /// Weighted loss; 0 for one that is only near.
    loss: f64,
    /// How far the line is from the place \[m\].
    apart: f64,
}

/// A piece that may move among the others.
pub(crate) struct Mover<'a> {
    pub job: &'a Job<'a>,
    pub layout: &'a Layout,
    pub piece: usize,
    /// Weights of this piece's pairs.
    pub weights: &'a [f64],
    /// Queries made.
    pub queries: u64,
}

impl Mover<'_> {
    /// How far a place lies from another piece, where the box of a piece of `size` there comes
    /// nearer than `more` to its box [m].
    #[inline(always)]
    fn near(&self, other: usize, at: Vec2, size: Vec2, more: f64) -> Option<Vec2> {
        let apart = at - self.layout.at[other];
        let far = self.layout.size[other];
        let meets = apart.x < far.x + more
            && apart.y < far.y + more
            && apart.x > -size.x - more
            && apart.y > -size.y - more;
        (meets && other != self.piece).then_some(apart)
    }

    /// Weighted loss at a place, or something above `limit` as soon as it is.
    #[inline]
    pub fn loss(&mut self, shape: usize, at: Vec2, limit: f64) -> f64 {
        let size = self.job.shapes[shape].size;
        let more = self.job.widest_gap + self.job.growth();
        let mut sum = 0.0;
        for other in 0..self.layout.at.len() {
            let Some(apart) = self.near(other, at, size, more) else {
                continue;
            };
            self.queries += 1;
            sum += self.weights[other] * self.job.loss(self.layout.shape[other], shape, apart);
            if sum > limit {
                break;
            }
        }
        sum
    }

    /// The loss at a place and the lines round it, the heaviest first.
    fn lines(&mut self, shape: usize, at: Vec2, lines: &mut Vec<Line>) -> f64 {
        lines.clear();
        let size = self.job.shapes[shape].size;
        let window = self.job.window();
        let more = self.job.widest_gap + window;
        let mut sum = 0.0;
        for other in 0..self.layout.at.len() {
            let Some(apart) = self.near(other, at, size, more) else {
                continue;
            };
            self.queries += 1;
            let Some((probe, gap)) = self.job.probe(self.layout.shape[other], shape, apart) else {
                continue;
            };
            let loss = probe.depth + gap;
            if loss < -window {
                continue;
            }
            let weighted = self.weights[other] * loss.max(0.0);
            sum += weighted;
            lines.push(Line {
                normal: probe.normal,
                level: probe.normal.dot(&at) + loss,
                loss: weighted,
                apart: loss.abs(),
            });
        }
        lines.sort_by(|a, b| b.loss.total_cmp(&a.loss).then(a.apart.total_cmp(&b.apart)));
        lines.truncate(LINES);
        sum
    }

    /// The best place found near one, with its loss. Stops once it cannot be improved.
    pub fn refine(&mut self, shape: usize, from: Vec2) -> Option<(f64, Vec2)> {
        let room = self.layout.room(self.job, shape)?;
        let axes = self.job.axes(self.piece, shape, &self.layout.phases);
        let mut at = self.layout.settle(self.job, self.piece, shape, from)?;
        let mut lines = Vec::with_capacity(2 * LINES);
        let mut targets = Vec::with_capacity(64);
        let mut best = self.lines(shape, at, &mut lines);
        for _ in 0..STEPS {
            if best <= 0.0 {
                break;
            }
            targets.clear();
            propose(&lines, at, (room, axes), &mut targets);
            let mut next = None;
            for &target in &targets {
                let Some(target) = self.layout.settle(self.job, self.piece, shape, target) else {
                    continue;
                };
                let loss = self.loss(shape, target, best);
                if loss < best * (1.0 - 1e-9) {
                    best = loss;
                    next = Some(target);
                }
            }
            let Some(next) = next else {
                break;
            };
            at = next;
            best = self.lines(shape, at, &mut lines);
        }
        Some((best, at))
    }
}

/// Points near a place where lines end or cross.
fn propose(lines: &[Line], at: Vec2, (room, axes): (Vec2, [Axis; 2]), targets: &mut Vec<Vec2>) {
    let farthest = lines
        .iter()
        .filter(|l| l.loss > 0.0)
        .map(|l| l.apart)
        .fold(0.0, f64::max);
    let radius = 4.0 * farthest;
    let near = |p: &Vec2| (p - at).norm_squared() <= radius * radius;
    for (k, line) in lines.iter().enumerate() {
        let missing = line.level - line.normal.dot(&at);
        if line.loss > 0.0 {
            targets.push(at + line.normal * missing);
        }
        // Along the axes: to the line, for pieces that may move along one only.
        for axis in 0..2 {
            let held = axes[1 - axis] != Axis::Free;
            if (held || line.loss > 0.0) && line.normal[axis].abs() > 1e-3 {
                let mut target = at;
                target[axis] += missing / line.normal[axis];
                targets.extend(Some(target).filter(near));
            }
        }
        for other in &lines[k + 1..] {
            if line.loss <= 0.0 {
                break;
            }
            let cross = line.normal.perp(&other.normal);
            if cross.abs() > 1e-3 {
                let x = line.level * other.normal.y - other.level * line.normal.y;
                let y = other.level * line.normal.x - line.level * other.normal.x;
                targets.extend(Some(Vec2::new(x, y) / cross).filter(near));
            }
        }
        // Where the line meets an edge of the fabric.
        for axis in 0..2 {
            for wall in [0.0, room[axis]] {
                let other = 1 - axis;
                if line.loss > 0.0 && line.normal[other].abs() > 1e-3 {
                    let mut target = Vec2::zeros();
                    target[axis] = wall;
                    target[other] = (line.level - line.normal[axis] * wall) / line.normal[other];
                    targets.extend(Some(target).filter(near));
                }
            }
        }
    }
}
