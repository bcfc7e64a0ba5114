//! Compaction: every piece slides towards the start until it touches another.

use crate::job::Axis;
use crate::refine::Mover;
use crate::separate::Separator;

/// Number of rounds over all pieces.
const ROUNDS: usize = 2;
/// First and last step, relative to the width of the fabric.
const STEPS: [f64; 2] = [1e-2, 1e-9];

impl Separator<'_> {
    /// Slides pieces towards the start of the strip, the first ones first, as long as the loss does not grow.
    pub fn slide(&mut self) {
        let count = self.layout.at.len();
        let even = vec![1.0; count];
        for _ in 0..ROUNDS {
            let mut order: Vec<usize> = (0..count).filter(|&k| self.may_slide(k)).collect();
            let start = |k: usize| self.layout.at[k].x;
            order.sort_by(|&a, &b| start(a).total_cmp(&start(b)).then(a.cmp(&b)));
            for piece in order {
                let mut mover = Mover {
                    job: self.job,
                    layout: &self.layout,
                    piece,
                    weights: &even,
                    queries: 0,
                    scratch: &mut self.scratch,
                };
                let shape = self.layout.shape[piece];
                let far = self.layout.length;
                mover.gather(shape, self.layout.at[piece], far);
                let mut at = self.layout.at[piece];
                let loss = mover.loss(shape, at, f64::INFINITY);
                let mut step = STEPS[0] * self.job.height;
                while step > STEPS[1] * self.job.height {
                    let mut next = at;
                    next.x = (at.x - step).max(0.0);
                    if next.x < at.x && mover.loss(shape, next, loss) <= loss {
                        at = next;
                    } else {
                        step *= 0.5;
                    }
                }
                self.queries += mover.queries;
                self.layout.at[piece] = at;
            }
        }
        self.measure();
    }

    fn may_slide(&self, piece: usize) -> bool {
        let layout = &self.layout;
        let axes = self.job.axes(piece, layout.shape[piece], &layout.phases);
        layout.present[piece] && self.job.pieces[piece].locked.is_none() && axes[0] == Axis::Free
    }
}
