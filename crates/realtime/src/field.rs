//! The ellipsoids enlarged by an offset: where a place lies against them.

use crate::lanes::{LANES, Lanes, each};
use crate::turn::{Vector, difference, dot, moved};
use crate::{Ellipsoids, RealtimeError};

/// How far over the surface a place is put, as a share of the ellipsoid: rounding of `f32` at
/// places a few metres off must not bring it inside again.
const OVER: f32 = 1e-4;

/// A place against the nearest ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Which ellipsoid of the character.
    pub ellipsoid: usize,
    /// From the surface along the ray from the centre, negative inside: no less than the distance,
    /// the more over it the longer the ellipsoid (m).
    pub distance: f32,
    /// Where that ray meets the surface (m).
    pub point: [f32; 3],
}

/// The ellipsoids of a character, their semi-axes enlarged by an offset, in columns: the field of
/// one layer of clothes. A place p is inside exactly when `|q| < 1`, `q = S^-1 R^T (p - c)`.
#[derive(Clone, Debug)]
pub struct Field {
    /// `S^-1 R^T` by its nine entries (1/m), and `S^-1 R^T c` (1).
    unit: [Vec<f32>; 9],
    shift: [Vec<f32>; 3],
    centre: [Vec<f32>; 3],
    /// 1 over the semi-axes, and over the least of them (1/m).
    inverse: Vec<Vector>,
    steepest: Vec<f32>,
    pub(crate) groups: Vec<usize>,
    pub(crate) touching: Vec<u64>,
    order: Vec<usize>,
    row_of: Vec<usize>,
}

impl Field {
    /// The field of some ellipsoids where they are now.
    ///
    /// # Errors
    /// An offset that leaves an ellipsoid thinner than a millimetre, or is no number.
    pub fn new(ellipsoids: &Ellipsoids, offset: f32) -> Result<Self, RealtimeError> {
        let axes = ellipsoids.semi_axes.iter();
        let enlarged: Vec<Vector> = axes.map(|axes| axes.map(|axis| axis + offset)).collect();
        let fits = |axis: &f32| (1e-3..=1e4).contains(axis);
        if !enlarged.iter().flatten().all(fits) {
            return Err(RealtimeError::new(
                "offset",
                format!("{offset} m leaves no ellipsoid or an enormous one"),
                "give a garment a few millimetres or centimetres",
            ));
        }
        let count = enlarged.len();
        let column = || vec![0.0; count];
        let mut row_of = vec![0; count];
        for (row, &k) in ellipsoids.order.iter().enumerate() {
            row_of[k] = row;
        }
        let inverse: Vec<Vector> = enlarged.iter().map(|axes| axes.map(|a| 1.0 / a)).collect();
        let mut field = Self {
            unit: std::array::from_fn(|_| column()),
            shift: std::array::from_fn(|_| column()),
            centre: std::array::from_fn(|_| column()),
            steepest: inverse
                .iter()
                .map(|axes| axes.iter().copied().fold(0.0, f32::max))
                .collect(),
            inverse,
            groups: ellipsoids.groups.clone(),
            touching: ellipsoids.touching.clone(),
            order: ellipsoids.order.clone(),
            row_of,
        };
        field.follow(ellipsoids);
        Ok(field)
    }

    /// Takes the ellipsoids where they are now: those the field was made of, or it stays.
    pub fn follow(&mut self, ellipsoids: &Ellipsoids) {
        if ellipsoids.len() != self.len() {
            return;
        }
        for (row, frame) in ellipsoids.posed.iter().enumerate() {
            for i in 0..3 {
                let scale = self.inverse[row][i];
                let axis: Vector = std::array::from_fn(|j| frame.rows[j][i] * scale);
                for (j, entry) in axis.into_iter().enumerate() {
                    self.unit[3 * i + j][row] = entry;
                }
                self.shift[i][row] = dot(axis, frame.at);
                self.centre[i][row] = frame.at[i];
            }
        }
    }

    /// Number of ellipsoids.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    pub(crate) fn centre(&self, row: usize) -> Vector {
        std::array::from_fn(|k| self.centre[k][row])
    }

    /// `q` of a place for one row.
    fn unit(&self, row: usize, p: Vector) -> Vector {
        std::array::from_fn(|i| {
            let [a, b, c] = [0, 1, 2].map(|j| self.unit[3 * i + j][row]);
            a * p[0] + b * p[1] + c * p[2] - self.shift[i][row]
        })
    }

    /// `|q|^2` of the vertices of a block for one row.
    #[inline(always)]
    pub(crate) fn ratios(&self, row: usize, [x, y, z]: &[Lanes; 3]) -> Lanes {
        let m: [f32; 9] = std::array::from_fn(|k| self.unit[k][row]);
        let s: Vector = std::array::from_fn(|k| self.shift[k][row]);
        each(|l| {
            let a = m[0] * x[l] + m[1] * y[l] + m[2] * z[l] - s[0];
            let b = m[3] * x[l] + m[4] * y[l] + m[5] * z[l] - s[1];
            let c = m[6] * x[l] + m[7] * y[l] + m[8] * z[l] - s[2];
            a * a + b * b + c * c
        })
    }

    /// Which rows a ball may reach into, by bits: `|q|` changes by at most 1 over the least semi-axis
    /// for each metre. `room` is left from the ball to the surface at the least for the others.
    pub(crate) fn reached(&self, p: Vector, radius: f32, words: &mut [u64], scratch: &mut [f32]) {
        let [a, b, c, d, e, f, g, h, i] = &self.unit;
        let [s, t, u] = &self.shift;
        let count = scratch.len();
        let rows = [a, b, c, d, e, f, g, h, i].map(|column| &column[..count]);
        let [s, t, u] = [s, t, u].map(|column| &column[..count]);
        let steepest = &self.steepest[..count];
        for k in 0..count {
            let x = rows[0][k] * p[0] + rows[1][k] * p[1] + rows[2][k] * p[2] - s[k];
            let y = rows[3][k] * p[0] + rows[4][k] * p[1] + rows[5][k] * p[2] - t[k];
            let z = rows[6][k] * p[0] + rows[7][k] * p[1] + rows[8][k] * p[2] - u[k];
            let reach = 1.0 + radius * steepest[k];
            scratch[k] = x * x + y * y + z * z - reach * reach;
        }
        for (word, run) in words.iter_mut().zip(scratch.chunks(64)) {
            *word = 0;
            for (k, excess) in run.iter().enumerate() {
                *word |= u64::from(*excess < 0.0) << k;
            }
        }
    }

    /// For each vertex of a block the row nearest along the ray from its centre: of its own groups
    /// any, of those beside them one in a group that it lies outside of, or pinched vertices would
    /// change sides. Groups by bits.
    pub(crate) fn nearest_rows(
        &self,
        places: &[Lanes; 3],
        (own, beside): (&[u64; LANES], &[u64; LANES]),
    ) -> [usize; LANES] {
        let any = own.iter().chain(beside).fold(0, |a, b| a | b);
        let mut best = [f32::INFINITY; LANES];
        let mut rows = [0u32; LANES];
        let mut first = 0;
        while first < self.len() {
            let group = self.groups[first];
            let count = self.groups[first..]
                .iter()
                .take_while(|g| **g == group)
                .count();
            if any >> group & 1 == 1 {
                let (near, near_rows, is_inside) = self.nearest_of(first..first + count, places);
                for l in 0..LANES {
                    let is_open =
                        own[l] >> group & 1 == 1 || beside[l] >> group & 1 == 1 && !is_inside[l];
                    let is_nearer = is_open && near[l] < best[l];
                    best[l] = if is_nearer { near[l] } else { best[l] };
                    rows[l] = if is_nearer { near_rows[l] } else { rows[l] };
                }
            }
            first += count;
        }
        rows.map(|row| row as usize)
    }

    /// For each vertex of a block the least distance to some rows, the row, and whether it lies
    /// inside any of them.
    #[inline(always)]
    fn nearest_of(
        &self,
        among: std::ops::Range<usize>,
        places: &[Lanes; 3],
    ) -> (Lanes, [u32; LANES], [bool; LANES]) {
        let mut best = [f32::INFINITY; LANES];
        let mut rows = [0u32; LANES];
        let mut is_inside = [false; LANES];
        for row in among {
            let squared = self.ratios(row, places);
            let c = self.centre(row);
            for l in 0..LANES {
                let [x, y, z] = [0, 1, 2].map(|k| places[k][l] - c[k]);
                // At the very centre the ray has no direction and the distance no end: held.
                let ratio = squared[l].max(1e-8).sqrt();
                let distance = (x * x + y * y + z * z).sqrt() * (1.0 - 1.0 / ratio);
                let is_nearer = distance < best[l];
                best[l] = if is_nearer { distance } else { best[l] };
                rows[l] = if is_nearer { row as u32 } else { rows[l] };
                is_inside[l] |= squared[l] < 1.0;
            }
        }
        (best, rows, is_inside)
    }

    /// A place inside a row put onto its surface along the steepest way out, the gradient of
    /// `|q|^2`. The ray from the centre, as published, would lead along a long limb to its end.
    pub(crate) fn put_out(&self, row: usize, p: Vector) -> Vector {
        let way = self.steepest_way(row, p);
        moved(p, self.leaving(row, p, way), way)
    }

    /// `R S^-1 q`, not scaled; at the very centre any direction.
    pub(crate) fn steepest_way(&self, row: usize, p: Vector) -> Vector {
        let q = self.unit(row, p);
        let way = std::array::from_fn(|j| {
            (0..3)
                .map(|i| self.unit[3 * i + j][row] * q[i])
                .sum::<f32>()
        });
        match dot(way, way) > 1e-6 {
            true => way,
            false => [0.0, 1.0, 0.0],
        }
    }

    /// Puts a place that lies within any row that it sees onto the boundary of all of them: along the
    /// steepest way out of `row`, or along another `way`, whichever is shorter. `sees` are the bits of
    /// groups.
    pub(crate) fn exit(&self, row: usize, p: Vector, (way, sees): (Vector, u64)) -> Vector {
        let places = [self.steepest_way(row, p), way].map(|way| self.exit_along(p, way, sees));
        let [first, second] = places.map(|place| {
            let gap = difference(place, p);
            dot(gap, gap)
        });
        // A way of no length, before there is a rest shape, leads nowhere.
        places[usize::from(dot(way, way) > 0.0 && second < first)]
    }

    /// The first place along a way that lies outside of all rows that it sees. A straight way leaves
    /// each ellipsoid once for good, so every one is left at most once.
    fn exit_along(&self, p: Vector, way: Vector, sees: u64) -> Vector {
        let mut reached = 0.0;
        loop {
            let place = moved(p, reached, way);
            let within = (0..self.len()).filter(|&k| {
                let q = self.unit(k, place);
                sees >> self.groups[k] & 1 == 1 && dot(q, q) < 1.0
            });
            let farthest = within
                .map(|k| self.leaving(k, p, way))
                .fold(f32::NEG_INFINITY, f32::max);
            if farthest <= reached || farthest.is_nan() {
                return place;
            }
            reached = farthest;
        }
    }

    /// How far along a way from a place inside it leaves an ellipsoid, and a little more, in
    /// lengths of that way.
    fn leaving(&self, row: usize, from: Vector, way: Vector) -> f32 {
        let q = self.unit(row, from);
        let w: Vector =
            std::array::from_fn(|i| (0..3).map(|j| self.unit[3 * i + j][row] * way[j]).sum());
        let (a, b, c) = (
            dot(w, w),
            dot(q, w),
            dot(q, q) - (1.0 + OVER) * (1.0 + OVER),
        );
        (-b + (b * b - a * c).max(0.0).sqrt()) / a
    }

    fn searched(&self, p: [f32; 3], sees: u64) -> Option<Nearest> {
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let row = self.nearest_rows(&p.map(|x| [x; LANES]), (&[sees; LANES], &[0; LANES]))[0];
        let q = self.unit(row, p);
        let ratio = dot(q, q).sqrt().max(1e-4);
        let c = self.centre(row);
        let gap = difference(p, c);
        Some(Nearest {
            ellipsoid: self.order[row],
            distance: dot(gap, gap).sqrt() * (1.0 - 1.0 / ratio),
            point: moved(c, 1.0 / ratio, gap),
        })
    }

    /// The ellipsoid nearest to a place along the ray from its centre: a vertex's first parent.
    /// None for a place that is not finite.
    pub fn nearest(&self, p: [f32; 3]) -> Option<Nearest> {
        self.searched(p, u64::MAX)
    }

    /// The nearest among the ellipsoids of a parent's group and of those that touch it: a vertex's
    /// next parent. None for a parent that is not there.
    pub fn reparented(&self, parent: usize, p: [f32; 3]) -> Option<Nearest> {
        let row = *self.row_of.get(parent)?;
        self.searched(p, self.touching[self.groups[row]])
    }

    /// Whether a place lies inside any ellipsoid: exact up to rounding.
    pub fn contains(&self, p: [f32; 3]) -> bool {
        self.contains_among(p, u64::MAX)
    }

    pub(crate) fn contains_among(&self, p: Vector, sees: u64) -> bool {
        (0..self.len()).any(|row| {
            let q = self.unit(row, p);
            sees >> self.groups[row] & 1 == 1 && dot(q, q) < 1.0
        })
    }
}
