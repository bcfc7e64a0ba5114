//! The first layout, and leaving out pieces if not all of them fit.

use crate::explore::Island;
use crate::job::Job;
use crate::layout::Layout;
use crate::separate::{Limit, Outcome, Patience};

/// Density of the first layout that is tried.
const FIRST_DENSITY: f64 = 0.76;
/// Factor by which the strip grows if that fails.
const LONGER: f64 = 1.06;
/// Cost per metre from the start of the strip, while pieces are laid one by one (m).
const BIAS: f64 = 0.02;
/// Fraction of the available fabric that is filled first if not all pieces fit.
const FILLING: f64 = 0.9;
/// Patience with a first layout, and with one piece too many: little, since there are alternatives.
const FIRST: Patience = Patience {
    rounds: 40,
    strikes: 1,
};
const CROWDED: Patience = Patience {
    rounds: 15,
    strikes: 1,
};

impl Island<'_> {
    /// Finds a first layout: pieces are laid in the positions of least overlap, the largest first, and the
    /// overlaps are resolved. If that fails a longer strip is tried; on the longest strip pieces are left
    /// out.
    pub fn start(&mut self, limit: &Limit<'_>) {
        let job = self.separator.job;
        let longest = job.longest().min(job.ample());
        let fixed = Layout::new(job, 0.0).least_reach(job);
        let area: f64 = job.pieces.iter().map(|p| p.area).sum();
        let wanted = area / (FIRST_DENSITY * job.height);
        let mut length = wanted.max(job.shortest()).max(fixed).min(longest);
        while !(limit.stop)() {
            let order = largest_first(job);
            self.construct(length, &order);
            if self.separator.separate(FIRST, limit) == Outcome::Apart {
                self.keep();
                return;
            }
            if length >= longest {
                self.leave_out(longest, limit);
                return;
            }
            length = (length * LONGER).min(longest);
        }
    }

    /// Lays the pieces one after the other.
    fn construct(&mut self, length: f64, order: &[usize]) {
        let job = self.separator.job;
        self.separator.load(Layout::new(job, length));
        for &piece in order {
            self.separator.move_piece(piece, BIAS);
        }
    }

    /// Fills the longest strip and removes pieces until nothing overlaps.
    fn leave_out(&mut self, longest: f64, limit: &Limit<'_>) {
        let job = self.separator.job;
        let mut room = FILLING * longest * job.height;
        let mut order = largest_first(job);
        order.retain(|&k| {
            let fits = job.pieces[k].area <= room && job.pieces[k].fits(job, longest);
            room -= if fits { job.pieces[k].area } else { 0.0 };
            fits
        });
        self.construct(longest, &order);
        loop {
            match self.separator.separate(CROWDED, limit) {
                Outcome::Apart => break,
                Outcome::Paused => return,
                Outcome::Failed => {}
            }
            let worst = |&a: &usize, &b: &usize| {
                let loss = |k: usize| self.separator.loss_of(k) / job.pieces[k].area;
                loss(a).total_cmp(&loss(b)).then(a.cmp(&b))
            };
            let laid = |k: &usize| self.separator.layout.present[*k];
            let movable = |k: &usize| laid(k) && job.pieces[*k].locked.is_none();
            let Some(out) = (0..job.pieces.len()).filter(movable).max_by(worst) else {
                break;
            };
            let mut layout = self.separator.layout.clone();
            layout.remove(job, out);
            self.separator.load(layout);
        }
        self.keep();
    }

    /// Tries to insert one of the missing pieces.
    pub(crate) fn insert(&mut self, limit: &Limit<'_>) {
        if !self.separator.is_paused() {
            self.add_one();
        }
        match self.separator.separate(FIRST, limit) {
            Outcome::Apart if self.is_better() => self.keep(),
            Outcome::Apart | Outcome::Failed => self.failed(),
            Outcome::Paused => {}
        }
    }

    /// Whether more area is laid in the current layout than in the best.
    fn is_better(&self) -> bool {
        let missing_area = self.separator.layout.missing_area(self.separator.job);
        missing_area < self.score().0
    }

    /// Loads the best layout with one more piece, which may overlap.
    fn add_one(&mut self) {
        let job = self.separator.job;
        let Some(mut layout) = self.best.clone() else {
            return;
        };
        layout.length = job.longest().min(job.ample());
        let missing: Vec<usize> = (0..layout.at.len())
            .filter(|&k| !layout.present[k])
            .collect();
        let piece = missing[self.separator.sequence.below(missing.len())];
        self.separator.load(layout);
        self.separator.move_piece(piece, 0.0);
    }
}

/// Movable pieces in order of decreasing area.
fn largest_first(job: &Job<'_>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..job.pieces.len()).collect();
    order.retain(|&k| job.pieces[k].locked.is_none());
    let area = |k: usize| job.pieces[k].area;
    order.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
    order
}
