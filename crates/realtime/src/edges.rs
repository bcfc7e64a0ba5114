//! The edges of a garment: springs, and bounds of their lengths.
//!
//! Cloth hangs from above. So edges are corrected from the highest at rest to the lowest, and the
//! lower end takes the larger share: a pull goes down a whole garment in one sweep, where even
//! shares would take as many sweeps as the square of the edges on the way.

use crate::RealtimeError;
use crate::lanes::Columns;

/// The edges from the highest at rest to the lowest, the higher end first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    ends: Vec<[u32; 2]>,
    /// Length at rest, squared, and 1 over that [m2, 1/m2].
    rest: Vec<f32>,
    inverse: Vec<f32>,
    /// Share of a correction that the higher end takes.
    share: Vec<f32>,
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

    /// Goes through edges once in their order. Returns how many were beyond the bounds.
    #[inline(always)]
    fn swept<'a>(
        &self,
        edges: impl Iterator<Item = (&'a [u32; 2], ((&'a f32, &'a f32), &'a f32))>,
        places: &mut Columns,
    ) -> usize {
        let [x, y, z] = &mut places.0;
        let count = x.len();
        let [x, y, z] = [&mut x[..count], &mut y[..count], &mut z[..count]];
        let ([low, high], [shorter, longer]) = (self.squares, self.targets);
        let mut beyond = 0;
        for (&[a, b], ((rest, inverse), share)) in edges {
            let (a, b) = (a as usize, b as usize);
            let d = [x[b] - x[a], y[b] - y[a], z[b] - z[a]];
            let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let ratio = squared * inverse;
            if ratio >= low && ratio <= high {
                continue;
            }
            beyond += 1;
            let target = if ratio < low { shorter } else { longer };
            // Ends in one place have no direction: springs and neighbours part them.
            let whole = 1.0 - target * (rest / squared.max(1e-14)).sqrt();
            let (s, t) = (share * whole, (1.0 - share) * whole);
            x[a] += s * d[0];
            y[a] += s * d[1];
            z[a] += s * d[2];
            x[b] -= t * d[0];
            y[b] -= t * d[1];
            z[b] -= t * d[2];
        }
        beyond
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
        Ok(edges)
    }

    /// Adds to velocities what springs give in a step: `push` is stiffness over mass times the
    /// step [1/s]. The force is that of the energy of squared lengths, so it needs no root.
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

    /// Brings edges beyond their bounds within, one after the other from above. Returns how many
    /// there were.
    pub fn limit(&self, bounds: Bounds, places: &mut Columns) -> usize {
        let numbers = self.rest.iter().zip(&self.inverse).zip(&self.share);
        Limit::new(bounds).swept(self.ends.iter().zip(numbers), places)
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
