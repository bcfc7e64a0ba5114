//! The edges of a garment: springs, and bounds of their lengths.
//!
//! Cloth hangs from above. So edges are corrected from the highest at rest to the lowest, and the
//! lower end takes the larger share: a pull goes down a whole garment in one sweep, where even
//! shares would take as many sweeps as the square of the edges on the way. An edge whose ends have
//! not moved since it was within its bounds is not looked at again.

use crate::RealtimeError;
use crate::lanes::Columns;

/// The edges from the highest at rest to the lowest, the higher end first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    ends: Vec<[u32; 2]>,
    /// Length at rest, squared, and 1 over that (m2, 1/m2).
    rest: Vec<f32>,
    inverse: Vec<f32>,
    /// Share of a correction that the higher end takes.
    share: Vec<f32>,
    /// Where the edges of each vertex begin in `around`; one entry more than there are vertices.
    first: Vec<u32>,
    around: Vec<u32>,
    /// The edges with an end that has moved since they were looked at, by bits. All others are within
    /// their bounds.
    open: Vec<u64>,
}

/// Share of the higher end of an edge that stands upright at rest: of a level one it is a half.
/// None at all would let nothing slide over a shoulder.
const UPRIGHT_SHARE: f32 = 0.25;

/// Lengths over rest that edges may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub least: f32,
    pub most: f32,
}

/// Share of the room between rest and a bound that a corrected edge is left with: a little less
/// than all, so that edges beside it come to lie within their bounds soon. Much less, and cloth
/// that hangs would be thrown up by all its edges together.
const INNER: f32 = 0.97;

/// Bounds in squares, and the lengths that edges beyond them get.
struct Limit {
    squares: [f32; 2],
    targets: [f32; 2],
}

impl Limit {
    fn new(bounds: Bounds) -> Self {
        let both = [bounds.least, bounds.most];
        Self {
            squares: both.map(|bound| bound * bound),
            targets: both.map(|bound| 1.0 + (bound - 1.0) * INNER),
        }
    }
}

impl Edges {
    pub fn new(triangles: &[[u32; 3]], places: &Columns) -> Result<Self, RealtimeError> {
        let mut ends: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        ends.sort_unstable();
        ends.dedup();
        let height = |v: u32| places.0[1][v as usize];
        for pair in &mut ends {
            if height(pair[1]) > height(pair[0]) {
                pair.swap(0, 1);
            }
        }
        ends.sort_by(|a, b| height(b[0]).total_cmp(&height(a[0])));
        let mut edges = Self::default();
        for [a, b] in ends {
            let gap = crate::turn::difference(places.at(a as usize), places.at(b as usize));
            let squared = crate::turn::dot(gap, gap);
            if !(1e-10..1e4).contains(&squared) {
                return Err(RealtimeError::new(
                    "triangles",
                    format!("an edge is {} m long", squared.sqrt()),
                    "take out triangles without area and give lengths in metres",
                ));
            }
            edges.ends.push([a, b]);
            edges.rest.push(squared);
            edges.inverse.push(1.0 / squared);
            let slope = gap[1] / squared.sqrt();
            edges.share.push(0.5 + (UPRIGHT_SHARE - 0.5) * slope);
        }
        edges.find_around(places.0[0].len());
        Ok(edges)
    }

    /// Finds the edges of each of so many vertices.
    fn find_around(&mut self, vertices: usize) {
        self.first = vec![0; vertices + 1];
        for &end in self.ends.iter().flatten() {
            self.first[end as usize + 1] += 1;
        }
        for v in 0..vertices {
            self.first[v + 1] += self.first[v];
        }
        let mut next = self.first.clone();
        self.around = vec![0; 2 * self.ends.len()];
        for (edge, ends) in self.ends.iter().enumerate() {
            for &end in ends {
                self.around[next[end as usize] as usize] = edge as u32;
                next[end as usize] += 1;
            }
        }
        self.open = vec![0; self.ends.len().div_ceil(64)];
    }

    /// Adds to velocities what springs give in a step: `push` is stiffness over mass times the
    /// step (1/s). The force is that of the energy of squared lengths, so it needs no root.
    pub fn pull(&self, places: &Columns, push: f32, velocities: &mut Columns) {
        let [x, y, z] = &places.0;
        let [vx, vy, vz] = &mut velocities.0;
        let count = x.len();
        let [x, y, z] = [&x[..count], &y[..count], &z[..count]];
        let [vx, vy, vz] = [&mut vx[..count], &mut vy[..count], &mut vz[..count]];
        for (&[a, b], inverse) in self.ends.iter().zip(&self.inverse) {
            let (a, b) = (a as usize, b as usize);
            let d = [x[b] - x[a], y[b] - y[a], z[b] - z[a]];
            let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let f = push * (0.5 * (squared * inverse - 1.0)).clamp(-0.5, 0.5);
            vx[a] += f * d[0];
            vy[a] += f * d[1];
            vz[a] += f * d[2];
            vx[b] -= f * d[0];
            vy[b] -= f * d[1];
            vz[b] -= f * d[2];
        }
    }

    /// Opens all edges: their ends have moved.
    pub fn open_all(&mut self) {
        let count = self.ends.len();
        for (word, bits) in self.open.iter_mut().enumerate() {
            let left = count - 64 * word;
            *bits = u64::MAX >> 64_usize.saturating_sub(left);
        }
    }

    /// Opens the edges of a vertex that has moved.
    #[inline(always)]
    pub fn open_around(&mut self, vertex: usize) {
        let [from, to] = [self.first[vertex], self.first[vertex + 1]].map(|k| k as usize);
        for &edge in &self.around[from..to] {
            self.open[edge as usize / 64] |= 1 << (edge % 64);
        }
    }

    /// Brings open edges beyond their bounds within, one after the other from above. Returns how many
    /// there were; `moved` is told of each end.
    pub fn limit(
        &mut self,
        bounds: Bounds,
        places: &mut Columns,
        mut moved: impl FnMut(usize),
    ) -> usize {
        let limit = Limit::new(bounds);
        let mut beyond = 0;
        for word in 0..self.open.len() {
            // Of the edges that a correction opens, the later ones are looked at in this sweep, the
            // earlier ones in the next.
            let mut later = u64::MAX;
            loop {
                let bits = self.open[word] & later;
                if bits == 0 {
                    break;
                }
                let bit = bits.trailing_zeros();
                self.open[word] &= !(1 << bit);
                later = u64::MAX << bit << 1;
                let edge = 64 * word + bit as usize;
                if self.correct(edge, &limit, places) {
                    beyond += 1;
                    for end in self.ends[edge] {
                        self.open_around(end as usize);
                        moved(end as usize);
                    }
                }
            }
        }
        beyond
    }

    /// Brings an edge within its bounds; whether it was beyond.
    #[inline(always)]
    fn correct(&self, edge: usize, limit: &Limit, places: &mut Columns) -> bool {
        let [a, b] = self.ends[edge].map(|v| v as usize);
        let [x, y, z] = &mut places.0;
        let count = x.len();
        let [x, y, z] = [&mut x[..count], &mut y[..count], &mut z[..count]];
        let d = [x[b] - x[a], y[b] - y[a], z[b] - z[a]];
        let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let ratio = squared * self.inverse[edge];
        let ([low, high], [shorter, longer]) = (limit.squares, limit.targets);
        if ratio >= low && ratio <= high {
            return false;
        }
        let target = if ratio < low { shorter } else { longer };
        // Ends in one place have no direction: springs and neighbours part them.
        let whole = 1.0 - target * (self.rest[edge] / squared.max(1e-14)).sqrt();
        let share = self.share[edge];
        let (s, t) = (share * whole, (1.0 - share) * whole);
        x[a] += s * d[0];
        y[a] += s * d[1];
        z[a] += s * d[2];
        x[b] -= t * d[0];
        y[b] -= t * d[1];
        z[b] -= t * d[2];
        true
    }

    /// The shortest and the longest edge over their lengths at rest.
    pub fn extremes(&self, places: &Columns) -> [f32; 2] {
        let ratios = self.ends.iter().zip(&self.inverse).map(|(ends, inverse)| {
            let [a, b] = ends.map(|v| places.at(v as usize));
            let gap = crate::turn::difference(a, b);
            (crate::turn::dot(gap, gap) * inverse).sqrt()
        });
        ratios.fold([f32::INFINITY, 0.0], |[low, high], r| {
            [low.min(r), high.max(r)]
        })
    }

    pub fn ends(&self) -> &[[u32; 2]] {
        &self.ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of squares, each with a diagonal, its vertices shaken.
    fn sheet(shaken: f32) -> (Edges, Columns) {
        const SIDE: usize = 13;
        let mut places = Columns::zeros(SIDE * SIDE);
        let mut triangles = Vec::new();
        for i in 0..SIDE {
            for j in 0..SIDE {
                places.set(i * SIDE + j, [i as f32 * 0.02, j as f32 * 0.02, 0.0]);
                if i > 0 && j > 0 {
                    let [a, b, c, d] = [0, 1, SIDE, SIDE + 1].map(|k| (i * SIDE + j - k) as u32);
                    triangles.extend([[a, b, d], [a, d, c]]);
                }
            }
        }
        let edges = Edges::new(&triangles, &places).unwrap_or_default();
        for k in 0..SIDE * SIDE {
            let shake = |axis: usize| shaken * ((k * 3 + axis) as f32 * 2.39).sin();
            let [x, y, z] = places.at(k);
            places.set(k, [x + shake(0), y + shake(1), z + shake(2)]);
        }
        (edges, places)
    }

    #[test]
    fn edges_whose_ends_stay_need_no_second_look() {
        let bounds = Bounds {
            least: 0.92,
            most: 1.08,
        };
        let (mut edges, start) = sheet(0.006);
        let (mut some, mut all) = (start.clone(), start);
        edges.open_all();
        let mut open = edges.clone();
        let mut counts = Vec::new();
        for _ in 0..200 {
            open.open_all();
            let expected = open.limit(bounds, &mut all, |_| {});
            let found = edges.limit(bounds, &mut some, |_| {});
            assert_eq!(found, expected);
            counts.push(found);
        }
        assert!(some.0 == all.0, "places differ");
        assert!(counts[0] > 100 && counts[199] == 0, "{counts:?}");
        let [low, high] = edges.extremes(&some);
        assert!(low >= 0.9199 && high <= 1.0801);
    }
}
