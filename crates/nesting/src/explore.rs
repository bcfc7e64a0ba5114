//! Search for shorter strips (after Gardeyn and Wauters 2025): the strip is shortened, the overlaps are
//! resolved, and if that fails another layout is tried.

use crate::job::Job;
use crate::layout::Layout;
use crate::random::SplitMix64;
use crate::separate::{Limit, Outcome, Patience, Separator, TOLERANCE};
use toile_geometry::Vec2;

/// Patience while searching for shorter strips, and while compressing the best one.
const EXPLORE: Patience = Patience {
    rounds: 100,
    strikes: 2,
};
const PRESS: Patience = Patience {
    rounds: 30,
    strikes: 2,
};
/// Fractions by which the strip is shortened: largest and smallest.
const STEPS: [f64; 2] = [0.04, 0.0005];
/// Fractions by which the best strip is compressed: first and last.
const PRESSES: [f64; 2] = [0.0005, 0.00002];
/// Number of failures, for every pair of pieces, after which a small job counts as solved.
const TRIES: usize = 25;
/// Additions to the strip length (relative to its width) to separate touching pieces completely.
const LONGER: [f64; 3] = [3e-7, 2e-6, 1e-5];
/// Probability that the ends of a failed layout are exchanged, rather than two pieces.
const ENDS: f64 = 0.2;
/// Probability that a garment is turned round when the strip is shortened.
const TURNED: f64 = 0.1;
/// Largest number of failed layouts kept.
const POOL: usize = 24;

/// One independent search with its own random numbers.
pub(crate) struct Island<'a> {
    pub(crate) separator: Separator<'a>,
    /// The best layout without overlaps.
    pub best: Option<Layout>,
    /// Fraction by which the next strip is shorter.
    step: f64,
    /// Failed layouts at the current length, in order of increasing loss.
    pool: Vec<(f64, Layout)>,
    /// Strip length of the current attempt (m); 0 before the first.
    target: f64,
    /// Number of consecutive failed attempts.
    failures: usize,
}

impl<'a> Island<'a> {
    pub fn new(job: &'a Job<'a>, seed: u64) -> Self {
        Self {
            separator: Separator::new(job, Layout::new(job, job.height), seed),
            best: None,
            step: STEPS[0],
            pool: Vec::new(),
            target: 0.0,
            failures: 0,
        }
    }

    /// Number of queries made so far.
    pub fn queries(&self) -> u64 {
        self.separator.queries
    }

    /// Area of the pieces not laid (m2), then length of the best layout (m): less is better.
    pub fn score(&self) -> (f64, f64) {
        let job = self.separator.job;
        let score = |b: &Layout| (b.missing_area(job), b.length);
        self.best
            .as_ref()
            .map_or((f64::INFINITY, f64::INFINITY), score)
    }

    /// Adopts a better layout of another island. An attempt at a strip that is shorter still continues; an
    /// attempt to insert a piece into the old best layout is given up.
    pub fn adopt(&mut self, layout: &Layout) {
        self.best = Some(layout.clone());
        if self.target <= 0.0 || self.target >= layout.length {
            self.separator.give_up();
            self.pool.clear();
            self.target = 0.0;
        }
    }

    /// Stores the current layout as the best.
    pub(crate) fn keep(&mut self) {
        self.separator.slide();
        let mut layout = self.separator.layout.clone();
        layout.length = layout.reach(self.separator.job);
        self.best = Some(layout);
        self.pool.clear();
        self.failures = 0;
    }

    /// Improves until the limit, or until no improvement is possible: first inserts missing pieces, then
    /// shortens the strip.
    pub fn explore(&mut self, limit: &Limit<'_>) {
        while !self.is_over(limit) && !self.is_settled() {
            let Some(best) = &self.best else {
                return;
            };
            if best.present.contains(&false) {
                self.insert(limit);
                continue;
            }
            if !self.separator.is_paused() {
                if self.target <= 0.0 {
                    self.target = best.length * (1.0 - self.step);
                    self.shorten(self.target);
                } else {
                    self.restart();
                }
            }
            match self.separator.separate(EXPLORE, limit) {
                Outcome::Apart if self.is_whole() => {
                    self.keep();
                    self.target = 0.0;
                    self.step = (self.step * 1.25).min(STEPS[0]);
                }
                Outcome::Apart | Outcome::Failed => self.fail(),
                Outcome::Paused => {}
            }
        }
    }

    /// Whether every piece of the current layout is laid.
    fn is_whole(&self) -> bool {
        !self.separator.layout.present.contains(&false)
    }

    /// Loads a layout and lays its missing pieces in the positions of least overlap.
    fn load(&mut self, layout: Layout) {
        let laid = |k: &usize| layout.present[*k];
        let missing: Vec<usize> = (0..layout.at.len()).filter(|k| !laid(k)).collect();
        self.separator.load(layout);
        for piece in missing {
            self.separator.move_piece(piece, 0.0);
        }
    }

    /// Loads the best layout on a shorter strip, which is cut at a random position.
    fn shorten(&mut self, target: f64) {
        let Some(mut layout) = self.best.clone() else {
            return;
        };
        let job = self.separator.job;
        let sequence = &mut self.separator.sequence;
        let cut = sequence.unit() * layout.length;
        layout.resize(job, target, cut);
        if job.bundles > 1 && sequence.unit() < TURNED {
            turn_round(job, &mut layout, sequence.below(job.bundles));
        }
        self.load(layout);
    }

    /// Counts a failure.
    pub(crate) fn failed(&mut self) {
        self.failures += 1;
    }

    /// Keeps a layout with overlaps that could not be resolved in the pool.
    fn fail(&mut self) {
        self.failures += 1;
        if self.step > STEPS[1] {
            // The step was too large: restart from the best layout with a smaller one.
            self.step = (self.step * 0.5).max(STEPS[1]);
            self.pool.clear();
            self.target = 0.0;
            return;
        }
        // A layout with missing pieces is worse than any overlap.
        let total = match self.is_whole() {
            true => self.separator.total(),
            false => f64::INFINITY,
        };
        let failed = (total, self.separator.layout.clone());
        let place = self.pool.partition_point(|known| known.0 <= failed.0);
        self.pool.insert(place, failed);
        self.pool.truncate(POOL);
    }

    /// Whether no shorter strip is possible, or a small job was tried often enough.
    fn is_settled(&self) -> bool {
        let job = self.separator.job;
        let Some(best) = &self.best else {
            return true;
        };
        let count = best.present.len();
        let whole = !best.present.contains(&false);
        let shortest = job.shortest().max(best.least_reach(job));
        (whole && best.length <= shortest * (1.0 + 1e-9)) || self.failures > TRIES * count * count
    }

    /// Loads one of the better failed layouts with a random change.
    fn restart(&mut self) {
        let separator = &mut self.separator;
        let chance = separator.sequence.unit();
        let number = (chance * chance * self.pool.len() as f64) as usize;
        let mut layout = match self.pool.get(number) {
            Some((_, layout)) => layout.clone(),
            None => separator.layout.clone(),
        };
        disturb(separator.job, &mut layout, &mut separator.sequence);
        self.load(layout);
    }

    /// Compresses the best layout in smaller and smaller steps until the limit. `done` gives the progress of
    /// this phase.
    pub fn press(&mut self, limit: &Limit<'_>, done: &dyn Fn(u64) -> f64) {
        while !self.is_over(limit) && !self.is_settled() {
            let Some(best) = &self.best else {
                return;
            };
            if best.present.contains(&false) {
                self.insert(limit);
                continue;
            }
            if !self.separator.is_paused() {
                let done = done(self.separator.queries).clamp(0.0, 1.0);
                let step = PRESSES[0] * (PRESSES[1] / PRESSES[0]).powf(done);
                self.target = best.length * (1.0 - step);
                self.shorten(self.target);
            }
            match self.separator.separate(PRESS, limit) {
                Outcome::Apart if self.is_whole() => self.keep(),
                Outcome::Apart | Outcome::Failed => self.failures += 1,
                Outcome::Paused => {}
            }
        }
    }

    /// Separates pieces of the best layout that touch within rounding, if there is room, on a strip that is
    /// longer by as little as needed.
    ///
    /// If the limit is reached first, the pieces stay as close as they are, which the referee accepts.
    pub fn polish(&mut self, limit: &Limit<'_>) {
        let Some(best) = self.best.clone() else {
            return;
        };
        let job = self.separator.job;
        // Rounding of the no-fit polygons is less than half of the distance kept between touching pieces.
        self.separator.tolerance = 0.5 * job.safe();
        for more in LONGER {
            let mut layout = best.clone();
            layout.length = (best.length + more * job.height).min(job.longest());
            layout.length = layout.length.max(best.length);
            self.separator.load(layout);
            if self.separator.separate(PRESS, limit) == Outcome::Apart {
                self.keep();
                break;
            }
        }
        self.separator.tolerance = TOLERANCE * job.safe();
    }

    pub(crate) fn is_over(&self, limit: &Limit<'_>) -> bool {
        self.separator.queries >= limit.queries || (limit.stop)()
    }
}

/// Changes a layout at random: turns a garment round, moves a matched set within the repeat, or exchanges the
/// ends of the strip or two large pieces.
fn disturb(job: &Job<'_>, layout: &mut Layout, sequence: &mut SplitMix64) {
    match sequence.below(4) {
        0 if job.bundles > 0 => {
            turn_round(job, layout, sequence.below(job.bundles));
        }
        1 if job.sets > 0 => {
            let set = sequence.below(job.sets);
            if job.is_fixed(set) {
                return exchange(job, layout, sequence);
            }
            let repeat = job.strip.stripes.map_or_else(Vec2::zeros, |s| s.repeat);
            let chance = Vec2::new(sequence.unit(), sequence.unit());
            move_set(job, layout, (set, repeat.component_mul(&chance)));
        }
        _ if sequence.unit() < ENDS => swap_ends(job, layout, sequence),
        _ => exchange(job, layout, sequence),
    }
}

/// Moves a matched set to another place in the repeat, if all its pieces have an allowed position there.
fn move_set(job: &Job<'_>, layout: &mut Layout, (set, phase): (usize, Vec2)) {
    let mut moved = layout.clone();
    moved.phases[set] = phase;
    for piece in (0..layout.at.len()).filter(|&k| job.pieces[k].set == Some(set)) {
        if !moved.present[piece] {
            continue;
        }
        match moved.nearest_allowed(job, piece, moved.shape[piece], moved.at[piece]) {
            Some(at) => moved.at[piece] = at,
            None => return,
        }
    }
    *layout = moved;
}

/// Cuts the strip at a random position and exchanges its two parts.
fn swap_ends(job: &Job<'_>, layout: &mut Layout, sequence: &mut SplitMix64) {
    let cut = sequence.unit() * layout.length;
    let movable = |&k: &usize| job.pieces[k].locked.is_none() && layout.present[k];
    let pieces: Vec<usize> = (0..layout.at.len()).filter(movable).collect();
    for piece in pieces {
        let middle = layout.at[piece].x + 0.5 * layout.size[piece].x;
        let by = if middle < cut {
            layout.length - cut
        } else {
            -cut
        };
        let at = layout.at[piece] + Vec2::new(by, 0.0);
        if let Some(at) = layout.nearest_allowed(job, piece, layout.shape[piece], at) {
            layout.at[piece] = at;
        }
    }
}

/// Moves a piece to a random position and orientation.
fn scatter(job: &Job<'_>, layout: &mut Layout, piece: usize, sequence: &mut SplitMix64) {
    let shapes = job.pieces[piece].shapes.iter().copied();
    let allowed: Vec<usize> = shapes.filter(|&s| layout.allows(job, piece, s)).collect();
    if allowed.is_empty() {
        return;
    }
    let shape = allowed[sequence.below(allowed.len())];
    let chance = Vec2::new(sequence.unit(), sequence.unit());
    let at = chance.component_mul(&Vec2::new(layout.length, job.height));
    if let Some(at) = layout.nearest_allowed(job, piece, shape, at) {
        layout.put(job, piece, shape, at);
    }
}

/// Turns the pieces of a garment the other way, each about its centre, if every piece has an allowed
/// orientation and position.
fn turn_round(job: &Job<'_>, layout: &mut Layout, bundle: usize) {
    let mut turned = layout.clone();
    turned.forward[bundle] = !turned.forward[bundle];
    for piece in (0..layout.at.len()).filter(|&k| job.pieces[k].bundle == Some(bundle)) {
        let old = &job.shapes[turned.shape[piece]];
        let half = |s: &usize| {
            let new = &job.shapes[*s];
            turned.allows(job, piece, *s)
                && new.mirrored == old.mirrored
                && ((new.turn - old.turn).cos() + 1.0).abs() < 1e-9
        };
        let Some(&shape) = job.pieces[piece].shapes.iter().find(|s| half(s)) else {
            return;
        };
        if turned.present[piece] {
            let middle = turned.at[piece] + old.size * 0.5;
            if !move_middle(job, &mut turned, (piece, shape), middle) {
                return;
            }
        } else {
            turned.shape[piece] = shape;
        }
    }
    *layout = turned;
}

/// Moves a shape so that its centre is near a point; returns whether there is an allowed position.
fn move_middle(
    job: &Job<'_>,
    layout: &mut Layout,
    (piece, shape): (usize, usize),
    middle: Vec2,
) -> bool {
    let at = middle - job.shapes[shape].size * 0.5;
    let place = layout.nearest_allowed(job, piece, shape, at);
    if let Some(at) = place {
        layout.put(job, piece, shape, at);
    }
    place.is_some()
}

/// Exchanges two of the larger pieces.
fn exchange(job: &Job<'_>, layout: &mut Layout, sequence: &mut SplitMix64) {
    let movable = |&k: &usize| job.pieces[k].locked.is_none() && layout.present[k];
    let mut large: Vec<usize> = (0..job.pieces.len()).filter(movable).collect();
    let area = |k: usize| job.pieces[k].area;
    large.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
    large.truncate((large.len() / 2).max(2));
    if large.len() < 2 {
        return;
    }
    let a = large[sequence.below(large.len())];
    let different = |&k: &usize| job.pieces[k].item != job.pieces[a].item;
    let others: Vec<usize> = large.iter().copied().filter(different).collect();
    if others.is_empty() {
        return scatter(job, layout, a, sequence);
    }
    let b = others[sequence.below(others.len())];
    let middle = |k: usize| layout.at[k] + layout.size[k] * 0.5;
    let middles = [middle(a), middle(b)];
    move_middle(job, layout, (a, layout.shape[a]), middles[1]);
    move_middle(job, layout, (b, layout.shape[b]), middles[0]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Item, Strip, Stripes};
    use crate::{MatchPoint, marker::Phase};
    use toile_geometry::{Bounds2, Polygon};

    fn item(length: f64, width: f64, quantity: u32) -> Item {
        let outline = Polygon::rectangle(Bounds2 {
            min: Vec2::zeros(),
            max: Vec2::new(length, width),
        });
        Item {
            quantity,
            match_point: Some(MatchPoint {
                point: Vec2::new(0.1, 0.0),
                phase: Phase::At(Vec2::zeros()),
            }),
            ..Item::new("box", outline)
        }
    }

    /// A piece without an allowed position on the shorter strip is removed, not left beyond its end.
    #[test]
    fn a_shorter_strip_holds_no_piece_that_sticks_out() {
        let items = [item(0.5, 0.3, 2), item(0.2, 0.2, 3)];
        let strip = Strip {
            stripes: Some(Stripes {
                repeat: Vec2::new(0.4, 0.0),
                origin: Vec2::zeros(),
            }),
            ..Strip::of_width(0.7)
        };
        let copies = [(0, 0), (0, 1), (1, 0), (1, 1), (1, 2)];
        let job = Job::new(&items, &strip, &copies, &|| false).unwrap();
        let mut island = Island::new(&job, 1);
        let limit = Limit {
            queries: u64::MAX,
            stop: &|| false,
        };
        island.start(&limit);
        let first = island.score();
        assert_eq!(first.0, 0.0);
        for target in [0.95, 0.75, 0.6, 0.45] {
            island.shorten(target);
            let layout = &island.separator.layout;
            for k in (0..5).filter(|&k| layout.present[k]) {
                let end = layout.at[k].x + layout.size[k].x;
                assert!(end <= target + 1e-9, "{target}: piece {k} ends at {end}");
            }
        }
        let limit = Limit {
            queries: 200_000,
            ..limit
        };
        island.separator.give_up();
        island.target = 0.0;
        island.explore(&limit);
        assert!(island.score() <= first, "{:?} {first:?}", island.score());
    }
}
