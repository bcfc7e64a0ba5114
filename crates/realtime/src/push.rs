//! Vertices are put out of the ellipsoids, a block at a time.

use crate::garment::{Ball, Garment};
use crate::lanes::{LANES, Lanes, each};
use crate::turn::{difference, dot};

/// Room left round a block when the ellipsoids within its reach are found (m): it may move so far
/// within a frame before they are found again.
const SLACK: f32 = 0.01;

/// Times that a block is put out of the deepest ellipsoid before vertices go out along rays.
const PUSHES: usize = 6;

/// Groups, by bits, of each vertex of a block.
type Masks = [u64; LANES];

impl Garment {
    /// Puts every vertex of the blocks that have moved out of its own group, that of its parent, and
    /// out of those that touch it where there is room between: one that is pinched between limbs
    /// stays with its own. Vertices put out lose so much of their shift along the surface as friction
    /// times the depth allows.
    pub(crate) fn push_out(&mut self, friction: f32) {
        for block in 0..self.balls.len() {
            if std::mem::take(&mut self.has_moved[block]) {
                self.push_block(block, friction);
            }
        }
    }

    fn push_block(&mut self, block: usize, friction: f32) {
        let first = block * LANES;
        let mut places = self.places.block(block);
        let words = self.find_reached(block, &places);
        if self.reached[words.clone()].iter().all(|word| *word == 0) {
            return;
        }
        let own: Masks = std::array::from_fn(|l| self.own_group(first + l));
        let beside: Masks = std::array::from_fn(|l| self.sees(first + l) & !own[l]);
        let starts = self.starts.block(block);
        let rubbed = |inside: &[Lanes; 3], out: [Lanes; 3]| match friction > 0.0 {
            true => held_by_friction(&starts, inside, &out, friction),
            false => out,
        };
        let reached = &self.reached[words];
        let mut rows = [0; LANES];
        let mut is_out = false;
        for _ in 0..PUSHES {
            let (ratios, deepest) = self.deepest(reached, &own, &places);
            is_out = ratios.iter().all(|&ratio| ratio >= 1.0);
            if is_out {
                break;
            }
            rows = deepest;
            places = rubbed(&places, self.put_out(&ratios, &deepest, &places));
        }
        if !is_out {
            for l in 0..LANES {
                let p = [places[0][l], places[1][l], places[2][l]];
                let out = self
                    .field
                    .exit(rows[l] as usize, p, (self.outward(first + l), own[l]));
                for axis in 0..3 {
                    places[axis][l] = out[axis];
                }
            }
        }
        let (ratios, deepest) = self.deepest(reached, &beside, &places);
        if ratios.iter().any(|&ratio| ratio < 1.0) {
            let tried = rubbed(&places, self.put_out(&ratios, &deepest, &places));
            let (back, _) = self.deepest(reached, &own, &tried);
            for l in 0..LANES {
                if back[l] >= 1.0 {
                    for axis in 0..3 {
                        places[axis][l] = tried[axis][l];
                    }
                }
            }
        }
        let before = self.places.block(block);
        for l in 0..LANES {
            if (0..3).any(|axis| places[axis][l] != before[axis][l]) {
                self.edges.open_around(first + l);
                self.has_moved[block] = true;
            }
        }
        self.places.set_block(block, &places);
    }

    /// The words of bits of the ellipsoids that reach near a block, found anew where it has left
    /// the ball for which they were found.
    fn find_reached(&mut self, block: usize, places: &[Lanes; 3]) -> std::ops::Range<usize> {
        let bounds = places.each_ref().map(|lanes| {
            let low = lanes.iter().copied().fold(f32::INFINITY, f32::min);
            let high = lanes.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            [low, high]
        });
        let centre = bounds.map(|[low, high]| 0.5 * (low + high));
        let half = bounds.map(|[low, high]| 0.5 * (high - low));
        let radius = dot(half, half).sqrt();
        let words = self.reached.len() / self.balls.len();
        let range = block * words..(block + 1) * words;
        let ball = &mut self.balls[block];
        let gap = difference(centre, ball.centre);
        if dot(gap, gap).sqrt() + radius > ball.radius {
            *ball = Ball {
                centre,
                radius: radius + SLACK,
            };
            let into = &mut self.reached[range.clone()];
            self.field
                .reached(centre, ball.radius, into, &mut self.scratch);
        }
        range
    }

    /// For each vertex the least `|q|^2` below 1 among the ellipsoids of its groups, and its row; 1
    /// for one outside.
    #[inline(always)]
    fn deepest(
        &self,
        reached: &[u64],
        groups: &Masks,
        places: &[Lanes; 3],
    ) -> (Lanes, [u32; LANES]) {
        let any = groups.iter().fold(0, |a, b| a | b);
        let all = groups.iter().fold(u64::MAX, |a, b| a & b);
        let mut best = [1.0f32; LANES];
        let mut rows = [0u32; LANES];
        for (word, bits) in reached.iter().enumerate() {
            let mut bits = *bits;
            while bits != 0 {
                let row = 64 * word + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let group = self.field.groups[row];
                if any >> group & 1 == 0 {
                    continue;
                }
                let mut ratios = self.field.ratios(row, places);
                if all >> group & 1 == 0 {
                    for (ratio, groups) in ratios.iter_mut().zip(groups) {
                        *ratio = if groups >> group & 1 == 0 {
                            1.0
                        } else {
                            *ratio
                        };
                    }
                }
                for l in 0..LANES {
                    let is_deeper = ratios[l] < best[l];
                    best[l] = if is_deeper { ratios[l] } else { best[l] };
                    rows[l] = if is_deeper { row as u32 } else { rows[l] };
                }
            }
        }
        (best, rows)
    }

    /// The vertices inside put onto the surfaces of their rows.
    fn put_out(&self, ratios: &Lanes, rows: &[u32; LANES], places: &[Lanes; 3]) -> [Lanes; 3] {
        let mut out = *places;
        for l in 0..LANES {
            if ratios[l] < 1.0 {
                let p = [places[0][l], places[1][l], places[2][l]];
                let place = self.field.put_out(rows[l] as usize, p);
                for axis in 0..3 {
                    out[axis][l] = place[axis];
                }
            }
        }
        out
    }
}

/// Coulomb's law in places: what a vertex was shifted along the surface since the frame's start is
/// taken back up to friction times the depth by which it was put out.
fn held_by_friction(
    starts: &[Lanes; 3],
    inside: &[Lanes; 3],
    out: &[Lanes; 3],
    friction: f32,
) -> [Lanes; 3] {
    let push: [Lanes; 3] = std::array::from_fn(|k| each(|l| out[k][l] - inside[k][l]));
    let shift: [Lanes; 3] = std::array::from_fn(|k| each(|l| out[k][l] - starts[k][l]));
    let product = |a: &[Lanes; 3], b: &[Lanes; 3]| {
        each(|l| a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l])
    };
    let depth = product(&push, &push);
    let along = product(&shift, &push);
    let normal = each(|l| along[l] / depth[l].max(1e-20));
    let tangent: [Lanes; 3] =
        std::array::from_fn(|k| each(|l| shift[k][l] - normal[l] * push[k][l]));
    let slid = product(&tangent, &tangent);
    let taken = each(|l| (friction * (depth[l] / slid[l].max(1e-20)).sqrt()).min(1.0));
    std::array::from_fn(|k| {
        each(|l| match depth[l] > 0.0 {
            true => out[k][l] - taken[l] * tangent[k][l],
            false => out[k][l],
        })
    })
}
