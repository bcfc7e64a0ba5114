//! The order of a garment's vertices in memory, and the joints that its rest shape hangs on.

use crate::lanes::Columns;
use crate::turn::Vector;

/// The vertices along a curve that fills space (Morton 1966): those of a block lie near each other.
pub(crate) fn along_a_curve(positions: &[Vector]) -> Vec<u32> {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for p in positions {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    let size = (0..3).map(|k| high[k] - low[k]).fold(1e-6, f32::max);
    let code = |p: &Vector| {
        let cell: [u32; 3] = std::array::from_fn(|k| ((p[k] - low[k]) / size * 1023.0) as u32);
        (0..10).fold(0u32, |code, bit| {
            (0..3).fold(code, |code, k| code | (cell[k] >> bit & 1) << (3 * bit + k))
        })
    };
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_by_cached_key(|&v| (code(&positions[v as usize]), v));
    order
}

/// The two joints that each vertex's rest shape hangs on, and the share of the second.
#[derive(Clone, Debug, Default)]
pub(crate) struct Homes {
    pub joints: Vec<[u16; 2]>,
    pub share: Vec<f32>,
}

/// Means over neighbours by which shares of joints are spread: some six edges to either side, a
/// hand's breadth of a usual mesh, so that cloth bends at a joint and does not break.
const SPREADS: usize = 24;

impl Homes {
    /// Shares of the joints of the nearest ellipsoids, spread over the mesh; the largest two of
    /// each vertex are kept.
    pub fn new(nearest: &[usize], ends: &[[u32; 2]], joints: usize) -> Self {
        let count = nearest.len();
        let mut shares = vec![0.0f32; count * joints];
        for (v, joint) in nearest.iter().enumerate() {
            shares[v * joints + joint] = 1.0;
        }
        let mut valence = vec![1.0f32; count];
        for v in ends.iter().flatten() {
            valence[*v as usize] += 1.0;
        }
        for _ in 0..SPREADS {
            let mut next = shares.clone();
            for &[a, b] in ends {
                let (a, b) = (a as usize, b as usize);
                for joint in 0..joints {
                    next[a * joints + joint] += shares[b * joints + joint];
                    next[b * joints + joint] += shares[a * joints + joint];
                }
            }
            for (row, valence) in next.chunks_mut(joints).zip(&valence) {
                row.iter_mut().for_each(|share| *share /= valence);
            }
            shares = next;
        }
        let mut homes = Self::default();
        for row in shares.chunks(joints) {
            let mut first = 0;
            for (joint, share) in row.iter().enumerate() {
                first = if *share > row[first] { joint } else { first };
            }
            let mut second = first;
            for (joint, share) in row.iter().enumerate() {
                let is_next = joint != first && (second == first || *share > row[second]);
                second = if is_next { joint } else { second };
            }
            let whole = row[first] + row[second];
            homes.joints.push([first as u16, second as u16]);
            homes.share.push(match second == first {
                true => 0.0,
                false => row[second] / whole,
            });
        }
        homes
    }
}

/// Columns of a mesh's places in an order, filled up to whole blocks with the last vertex.
pub(crate) fn columns(positions: &[Vector], order: &[u32], padded: usize) -> Columns {
    let mut columns = Columns::zeros(padded);
    for k in 0..padded {
        let v = order[k.min(order.len() - 1)];
        columns.set(k, positions[v as usize]);
    }
    columns
}
