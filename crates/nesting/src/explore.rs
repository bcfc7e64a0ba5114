//! Shorter and shorter strips (after Gardeyn and Wauters 2025): the strip is cut down, the overlaps
//! are taken apart, and where that fails another layout is tried.

use crate::job::Job;
use crate::layout::Layout;
use crate::separate::{Limit, Patience, Separator};
use toile_geometry::Vec2;

/// Density at which the first layout is tried.
const FIRST_DENSITY: f64 = 0.82;
/// Patience while searching for shorter strips, and while pressing the best one.
const EXPLORE: Patience = Patience {
    rounds: 100,
    strikes: 3,
};
const PRESS: Patience = Patience {
    rounds: 50,
    strikes: 2,
};
/// Parts by which the strip is shortened: at most, and at least.
const STEPS: [f64; 2] = [0.02, 0.0005];
/// Parts of the strip by which the best one is pressed, at first and at last.
const PRESSES: [f64; 2] = [0.0005, 0.00002];
/// Most failed layouts kept.
const POOL: usize = 24;

/// One line of search with its own chance.
pub(crate) struct Island<'a> {
    separator: Separator<'a>,
    /// The best layout without overlaps.
    pub best: Option<Layout>,
    /// What the next strip is shorter by, as a part.
    step: f64,
    /// Failed layouts at the present length, least loss first.
    pool: Vec<(f64, Layout)>,
    /// Length now tried \[m\]; 0 before the first.
    target: f64,
}

impl<'a> Island<'a> {
    pub fn new(job: &'a Job<'a>, seed: u64) -> Self {
        Self {
            separator: Separator::new(job, Layout::new(job, job.height), seed),
            best: None,
            step: STEPS[0],
            pool: Vec::new(),
            target: 0.0,
        }
    }

    /// Margin at either end of the strip \[m\].
    pub fn end_margin(&self) -> f64 {
        self.separator.job.strip.end_margin
    }

    /// Queries made so far.
    pub fn queries(&self) -> u64 {
        self.separator.queries
    }

    /// Length of the best layout \[m\].
    pub fn length(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |b| b.length)
    }

    /// Takes a better layout from elsewhere.
    pub fn adopt(&mut self, layout: &Layout) {
        self.best = Some(layout.clone());
        self.pool.clear();
        self.target = 0.0;
    }

    /// Finds a first layout: pieces are laid where they overlap least, the largest first, and taken
    /// apart; on a longer strip where that fails.
    pub fn start(&mut self, limit: &Limit<'_>) {
        let job = self.separator.job;
        let area: f64 = job.pieces.iter().map(|p| p.area).sum();
        let least = |p: &crate::job::Piece| {
            let lengths = p.shapes.iter().map(|&s| job.shapes[s].size.x);
            lengths.fold(f64::INFINITY, f64::min)
        };
        let movable = job.pieces.iter().filter(|p| p.locked.is_none());
        let needed = movable.map(least).fold(0.0, f64::max);
        let mut length = (area / (FIRST_DENSITY * job.height)).max(needed);
        length = length.max(Layout::new(job, 0.0).least_reach(job)).min(job.longest());
        loop {
            self.construct(length);
            if self.separator.separate(EXPLORE, limit) {
                self.keep();
                return;
            }
            if (limit.stop)() || self.separator.queries >= limit.queries || length >= job.longest() {
                return;
            }
            length = (length * 1.05).min(job.longest());
        }
    }

    /// Lays one piece after the other, the largest first.
    fn construct(&mut self, length: f64) {
        let job = self.separator.job;
        let far = Vec2::new(50.0, 0.0) * (job.height + length);
        let mut layout = Layout::new(job, length);
        let mut order: Vec<usize> = (0..job.pieces.len()).collect();
        order.retain(|&k| job.pieces[k].locked.is_none());
        order.sort_by(|&a, &b| job.pieces[b].area.total_cmp(&job.pieces[a].area).then(a.cmp(&b)));
        for &piece in &order {
            layout.at[piece] = far * (1.0 + piece as f64);
        }
        self.separator.load(layout);
        for piece in order {
            self.separator.move_piece(piece, 0.02);
        }
    }

    fn keep(&mut self) {
        let mut layout = self.separator.layout.clone();
        layout.length = layout.reach(self.separator.job);
        self.best = Some(layout);
        self.pool.clear();
    }

    /// Tries shorter strips until the limit.
    pub fn explore(&mut self, limit: &Limit<'_>) {
        while !self.is_over(limit) {
            let Some(best) = &self.best else {
                return;
            };
            if self.target <= 0.0 || self.target >= best.length {
                let target = best.length * (1.0 - self.step);
                let job = self.separator.job;
                if target < best.least_reach(job) {
                    return;
                }
                let mut layout = best.clone();
                let cut = self.separator.sequence.unit() * layout.length;
                layout.resize(job, target, cut);
                self.separator.load(layout);
                self.target = target;
            } else {
                self.restart();
            }
            if self.separator.separate(EXPLORE, limit) {
                self.keep();
                self.target = 0.0;
                self.step = (self.step * 1.25).min(STEPS[0]);
            } else if !self.is_over(limit) {
                let failed = (self.separator.total(), self.separator.layout.clone());
                let place = self.pool.partition_point(|known| known.0 <= failed.0);
                self.pool.insert(place, failed);
                self.pool.truncate(POOL);
                if self.step > STEPS[1] {
                    // Too much at once: from the best again, with less.
                    self.step = (self.step * 0.5).max(STEPS[1]);
                    self.pool.clear();
                    self.target = 0.0;
                }
            }
        }
    }

    /// One of the better failed layouts with two of its large pieces exchanged.
    fn restart(&mut self) {
        let separator = &mut self.separator;
        let chance = separator.sequence.unit();
        let number = (chance * chance * self.pool.len() as f64) as usize;
        let layout = match self.pool.get(number) {
            Some((_, layout)) => layout.clone(),
            None => separator.layout.clone(),
        };
        separator.load(layout);
        self.exchange();
    }

    fn exchange(&mut self) {
        let separator = &mut self.separator;
        let job = separator.job;
        let movable = |&k: &usize| job.pieces[k].locked.is_none();
        let mut large: Vec<usize> = (0..job.pieces.len()).filter(movable).collect();
        large.sort_by(|&a, &b| job.pieces[b].area.total_cmp(&job.pieces[a].area).then(a.cmp(&b)));
        large.truncate((large.len() / 2).max(2));
        if large.len() < 2 {
            return;
        }
        let a = large[separator.sequence.below(large.len())];
        let different = |&k: &usize| job.pieces[k].item != job.pieces[a].item;
        let others: Vec<usize> = large.iter().copied().filter(different).collect();
        if others.is_empty() {
            return;
        }
        let b = others[separator.sequence.below(others.len())];
        let mut layout = separator.layout.clone();
        let middle = |k: usize| layout.at[k] + layout.size[k] * 0.5;
        let places = [(a, middle(b)), (b, middle(a))];
        for (piece, middle) in places {
            let shape = layout.shape[piece];
            let at = middle - job.shapes[shape].size * 0.5;
            if let Some(at) = layout.settle(job, piece, shape, at) {
                layout.put(job, piece, shape, at);
            }
        }
        separator.load(layout);
    }

    /// Presses the best layout by less and less until the limit. `done` says how far the press is.
    pub fn press(&mut self, limit: &Limit<'_>, done: &dyn Fn(u64) -> f64) {
        while !self.is_over(limit) {
            let Some(best) = &self.best else {
                return;
            };
            let done = done(self.separator.queries).clamp(0.0, 1.0);
            let step = PRESSES[0] * (PRESSES[1] / PRESSES[0]).powf(done);
            let job = self.separator.job;
            let target = best.length * (1.0 - step);
            if target < best.least_reach(job) {
                return;
            }
            let mut layout = best.clone();
            let cut = self.separator.sequence.unit() * layout.length;
            layout.resize(job, target, cut);
            self.separator.load(layout);
            if self.separator.separate(PRESS, limit) {
                self.keep();
            }
        }
        self.target = 0.0;
    }

    fn is_over(&self, limit: &Limit<'_>) -> bool {
        self.separator.queries >= limit.queries || (limit.stop)()
    }
}
