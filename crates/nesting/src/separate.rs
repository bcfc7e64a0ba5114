//! Overlaps are resolved by guided local search (Voudouris and Tsang 1999; for nesting Umetani and others
//! 2009, Gardeyn and Wauters 2025): overlapping pieces move to the position of least weighted loss, and pairs
//! that keep overlapping gain weight until one of them moves elsewhere.

use crate::job::Job;
use crate::layout::Layout;
use crate::random::SplitMix64;
use crate::raster::{Candidate, LossMap};
use crate::refine::{Mover, Scratch};
use toile_geometry::Vec2;

/// Number of cells of the loss maps examined closely at every move.
const LOOKS: usize = 4;
/// Growth factors of the weights of overlapping pairs, for the smallest and the deepest overlap; decay factor
/// of the others.
const GROWTH: [f64; 2] = [1.2, 2.0];
const DECAY: f64 = 0.95;

/// Loss that counts as none, relative to the distance kept between touching pieces: large enough that four
/// pieces that fill the width exactly, with three such distances between them, count as separate.
pub(crate) const TOLERANCE: f64 = 3.5;
/// Number of cells of a loss map that cost as much as one query.
const CELLS_A_QUERY: usize = 64;
/// Pairs of large pieces weigh more, since large pieces are harder to move: exponent of area over mean area.
const AREA_POWER: f64 = 0.3;

/// Limits after which an attempt is given up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    /// Rounds without improvement before a strike.
    pub rounds: usize,
    /// Number of consecutive strikes.
    pub strikes: usize,
}

/// Limits of a search.
pub(crate) struct Limit<'a> {
    /// Number of queries after which it stops.
    pub queries: u64,
    /// Function that returns true to stop at once.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// State of an attempt to resolve the overlaps of a layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing overlaps.
    Apart,
    /// Patience is exhausted.
    Failed,
    /// The limit is reached; the next call continues.
    Paused,
}

/// An attempt in progress.
#[derive(Clone, Debug)]
struct Attempt {
    /// Smallest loss so far, with its layout.
    best: (f64, Layout),
    /// Smallest loss at the last strike.
    before: f64,
    strikes: usize,
    rounds: usize,
}

/// A layout with overlaps to be resolved.
pub(crate) struct Separator<'a> {
    pub job: &'a Job<'a>,
    pub layout: Layout,
    /// Number of queries made so far.
    pub queries: u64,
    pub sequence: SplitMix64,
    /// Loss that counts as none (m).
    pub tolerance: f64,
    weights: Vec<f64>,
    least_weights: Vec<f64>,
    losses: Vec<f64>,
    map: LossMap,
    found: Vec<Candidate>,
    attempt: Option<Attempt>,
    pub(crate) scratch: Scratch<'a>,
}

impl<'a> Separator<'a> {
    pub fn new(job: &'a Job<'a>, layout: Layout, seed: u64) -> Self {
        let mut separator = Self {
            job,
            queries: 0,
            sequence: SplitMix64(seed),
            tolerance: TOLERANCE * job.safe(),
            weights: Vec::new(),
            least_weights: least_weights(job),
            losses: Vec::new(),
            map: LossMap::new(),
            found: Vec::new(),
            attempt: None,
            scratch: Scratch::default(),
            layout: layout.clone(),
        };
        separator.load(layout);
        separator
    }

    /// Loads another layout and resets all weights.
    pub fn load(&mut self, layout: Layout) {
        self.layout = layout;
        self.weights.clone_from(&self.least_weights);
        self.attempt = None;
        self.measure();
    }

    pub(crate) fn measure(&mut self) {
        let count = self.layout.at.len();
        self.losses = vec![0.0; count * count];
        for piece in 0..count {
            self.measure_piece(piece);
        }
    }

    fn measure_piece(&mut self, piece: usize) {
        let count = self.layout.at.len();
        let (shape, at) = (self.layout.shape[piece], self.layout.at[piece]);
        let stays = |k: usize| self.job.pieces[k].locked.is_some();
        let locked = stays(piece);
        for other in 0..count {
            let apart = at - self.layout.at[other];
            // Two fixed pieces cannot be separated, so their overlap is ignored.
            let loss = if other == piece || (locked && stays(other)) {
                0.0
            } else {
                self.job.loss(self.layout.shape[other], shape, apart)
            };
            self.losses[piece * count + other] = loss;
            self.losses[other * count + piece] = loss;
        }
        self.queries += count as u64;
    }

    fn overlaps(&self, piece: usize) -> bool {
        let count = self.layout.at.len();
        let row = &self.losses[piece * count..][..count];
        row.iter().any(|&loss| loss > self.tolerance)
    }

    /// Sum of all losses above the tolerance (m).
    pub fn total(&self) -> f64 {
        let counts = self.losses.iter().filter(|&&loss| loss > self.tolerance);
        0.5 * counts.sum::<f64>()
    }

    /// Sum of the losses of one piece above the tolerance (m).
    pub fn loss_of(&self, piece: usize) -> f64 {
        let count = self.layout.at.len();
        let row = self.losses[piece * count..][..count].iter();
        row.filter(|&&loss| loss > self.tolerance).sum()
    }

    /// Whether an attempt was paused.
    pub fn is_paused(&self) -> bool {
        self.attempt.is_some()
    }

    /// Discards a paused attempt.
    pub fn give_up(&mut self) {
        self.attempt = None;
    }

    /// Moves pieces until nothing overlaps or patience is exhausted; the layout is then the best one found.
    /// Pauses at the limit.
    pub fn separate(&mut self, patience: Patience, limit: &Limit<'_>) -> Outcome {
        let mut attempt = self.attempt.take().unwrap_or_else(|| Attempt {
            best: (self.total(), self.layout.clone()),
            before: self.total(),
            strikes: 0,
            rounds: 0,
        });
        while attempt.best.0 > 0.0 && attempt.strikes < patience.strikes {
            if self.is_over(limit) {
                self.attempt = Some(attempt);
                return Outcome::Paused;
            }
            self.round();
            let total = self.total();
            if total < attempt.best.0 {
                if total < 0.98 * attempt.best.0 {
                    attempt.rounds = 0;
                }
                attempt.best = (total, self.layout.clone());
            }
            attempt.rounds += 1;
            self.reweigh();
            if attempt.rounds >= patience.rounds {
                let better = attempt.best.0 < 0.98 * attempt.before;
                attempt.strikes = if better { 0 } else { attempt.strikes + 1 };
                attempt.before = attempt.best.0;
                attempt.rounds = 0;
                self.layout.clone_from(&attempt.best.1);
                self.measure();
            }
        }
        self.layout = attempt.best.1;
        self.measure();
        if self.total() == 0.0 {
            Outcome::Apart
        } else {
            Outcome::Failed
        }
    }

    fn is_over(&self, limit: &Limit<'_>) -> bool {
        self.queries >= limit.queries || (limit.stop)()
    }

    /// Moves every overlapping piece once.
    fn round(&mut self) {
        let movable = |&k: &usize| self.job.pieces[k].locked.is_none() && self.overlaps(k);
        let mut order: Vec<usize> = (0..self.layout.at.len()).filter(movable).collect();
        self.sequence.shuffle(&mut order);
        for piece in order {
            if self.overlaps(piece) {
                self.move_piece(piece, 0.0);
            }
        }
    }

    /// Moves a piece to the best position found, starting from the best cells of its loss maps and from its
    /// current position, each refined exactly. `bias` is the cost per metre from the start of the strip.
    pub fn move_piece(&mut self, piece: usize, bias: f64) {
        let count = self.layout.at.len();
        self.survey(piece, bias);
        let mut mover = Mover {
            job: self.job,
            layout: &self.layout,
            piece,
            weights: &self.weights[piece * count..][..count],
            queries: 0,
            scratch: &mut self.scratch,
        };
        let here = (self.layout.shape[piece], self.layout.at[piece]);
        let here = Some(here).filter(|_| self.layout.present[piece]);
        let mut best: Option<(f64, usize, Vec2)> = None;
        let looks = self.found.iter().map(|c| (c.shape, c.at));
        for (shape, from) in looks.chain(here) {
            if let Some((loss, at)) = mover.refine(shape, from) {
                let loss = loss + bias * at.x;
                if best.is_none_or(|b| loss < b.0) {
                    best = Some((loss, shape, at));
                }
            }
        }
        self.queries += mover.queries;
        if let Some((_, shape, at)) = best {
            self.layout.put(self.job, piece, shape, at);
            self.measure_piece(piece);
        }
    }

    /// Finds the best cells of a piece's loss maps.
    fn survey(&mut self, piece: usize, bias: f64) {
        let count = self.layout.at.len();
        let spacing = self.job.spacing;
        self.found.clear();
        let job = self.job;
        for &shape in &job.pieces[piece].shapes {
            if !self.layout.allows(job, piece, shape) {
                continue;
            }
            let Some(room) = self.layout.room(job, shape) else {
                continue;
            };
            let cells = room.map(|r| (r / spacing).ceil() as usize + 1);
            self.map.clear(cells.x, cells.y);
            for other in (0..count).filter(|&o| o != piece) {
                let cell = self.layout.at[other].map(|c| (c / spacing).round() as i32);
                let weight = self.weights[piece * count + other] as f32;
                let raster = job.raster(self.layout.shape[other], shape);
                self.map.add(raster, [cell.x, cell.y], weight);
            }
            self.queries += (count + cells.x * cells.y / CELLS_A_QUERY) as u64;
            let found = (&mut self.found, LOOKS);
            let of = (shape, spacing, room);
            self.map.collect(of, bias, &mut self.sequence, found);
        }
    }

    /// Increases the weights of overlapping pairs in proportion to the overlap, and decreases the others.
    fn reweigh(&mut self) {
        let deepest = self.losses.iter().copied().fold(0.0, f64::max);
        if deepest <= 0.0 {
            return;
        }
        for ((weight, &loss), &base) in self
            .weights
            .iter_mut()
            .zip(&self.losses)
            .zip(&self.least_weights)
        {
            *weight = if loss > self.tolerance {
                *weight * (GROWTH[0] + (GROWTH[1] - GROWTH[0]) * loss / deepest)
            } else {
                (*weight * DECAY).max(base)
            };
        }
    }
}

/// Smallest weight of each pair.
fn least_weights(job: &Job<'_>) -> Vec<f64> {
    let count = job.pieces.len();
    let mean = job.pieces.iter().map(|p| p.area).sum::<f64>() / count as f64;
    let weight = |k: usize| match job.pieces[k].locked {
        Some(_) => 1.0,
        None => (job.pieces[k].area / mean).powf(AREA_POWER),
    };
    let pairs = (0..count * count).map(|k| weight(k / count) * weight(k % count));
    pairs.collect()
}
