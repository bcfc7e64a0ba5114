//! A layout: positions of all pieces, overlaps allowed.

use crate::job::{Axis, Job, Piece};
use crate::marker::Phase;
use toile_geometry::Vec2;

/// Position of a piece that is not laid: far from the strip and from all other pieces.
fn off_strip(job: &Job<'_>, piece: usize) -> Vec2 {
    let extent = job
        .shapes
        .iter()
        .map(|s| s.size.norm())
        .fold(job.height, f64::max);
    Vec2::new(-10.0 * extent * (2.0 + piece as f64), 0.0)
}

/// Number of phases tried along each axis of the repeat.
const PHASES: usize = 32;

/// A layout on a strip with a given length.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    /// Index of the shape of every piece.
    pub shape: Vec<usize>,
    /// Position of the lower left corner of each bounding box (m).
    pub at: Vec<Vec2>,
    /// Sizes of the bounding boxes (m).
    pub size: Vec<Vec2>,
    /// Length of the strip between the end margins (m).
    pub length: f64,
    /// Whether each garment runs along +x.
    pub forward: Vec<bool>,
    /// Place of each matched set within the repeat (m).
    pub phases: Vec<Vec2>,
    /// Whether each piece is laid; the others are far outside.
    pub present: Vec<bool>,
}

impl Layout {
    /// A layout with only the locked pieces laid. Garments alternate in direction if they allow both.
    pub fn new(job: &Job<'_>, length: f64) -> Self {
        let forward: Vec<bool> = (0..job.bundles).map(|b| job.starts_forward(b)).collect();
        let as_garment = |p: &Piece| {
            let way = p.bundle.is_none_or(|b| forward[b]);
            let runs = |&&s: &&usize| job.shapes[s].forward == way;
            p.shapes.iter().find(runs).copied()
        };
        let first = |p: &Piece| {
            p.locked
                .map(|l| l.0)
                .or_else(|| as_garment(p))
                .unwrap_or_else(|| p.shapes[0])
        };
        let shape: Vec<usize> = job.pieces.iter().map(first).collect();
        let place = |(k, p): (usize, &Piece)| p.locked.map_or_else(|| off_strip(job, k), |l| l.1);
        let mut layout = Self {
            present: job.pieces.iter().map(|p| p.locked.is_some()).collect(),
            at: job.pieces.iter().enumerate().map(place).collect(),
            size: shape.iter().map(|&s| job.shapes[s].size).collect(),
            shape,
            length,
            forward,
            phases: vec![Vec2::zeros(); job.sets],
        };
        layout.apply_locks(job);
        layout.ease_phases(job);
        layout
    }

    /// Changes the phase of matched sets that have a piece without an allowed position, if another phase
    /// gives all pieces of the set one. Phases are tried on a regular grid over the repeat.
    pub fn ease_phases(&mut self, job: &Job<'_>) {
        let Some(stripes) = job.strip.stripes else {
            return;
        };
        let tries = |axis: usize| match stripes.repeat[axis] > 0.0 {
            true => PHASES,
            false => 1,
        };
        for set in (0..job.sets).filter(|&set| !job.is_fixed(set)) {
            let first = self.phases[set];
            let all = (0..tries(0)).flat_map(|x| (0..tries(1)).map(move |y| (x, y)));
            let share = |(x, y): (usize, usize)| Vec2::new(x as f64, y as f64) / PHASES as f64;
            let mut more = all.map(|k| first + stripes.repeat.component_mul(&share(k)));
            let good = more.find(|&phase| {
                self.phases[set] = phase;
                self.set_can_lie(job, set)
            });
            self.phases[set] = good.unwrap_or(first);
        }
    }

    /// Whether every piece of a matched set has an allowed position in the current direction of its garment.
    fn set_can_lie(&self, job: &Job<'_>, set: usize) -> bool {
        let lies = |piece: usize| {
            let mut shapes = job.pieces[piece].shapes.iter();
            shapes.any(|&s| self.allows(job, piece, s) && job.can_lie(piece, s, &self.phases))
        };
        let own = (0..job.pieces.len()).filter(|&k| job.pieces[k].set == Some(set));
        own.into_iter().all(lies)
    }

    /// Sets the direction of each garment and the phase of each set that a locked piece fixes.
    pub fn apply_locks(&mut self, job: &Job<'_>) {
        for (k, piece) in job.pieces.iter().enumerate() {
            let Some((shape, _)) = piece.locked else {
                continue;
            };
            if let Some(bundle) = piece.bundle {
                self.forward[bundle] = job.shapes[shape].forward;
            }
            self.set_phase(job, k);
        }
    }

    /// Sets the phase of a matched set from the position of one of its pieces.
    pub fn set_phase(&mut self, job: &Job<'_>, piece: usize) {
        let (Some(set), Some(stripes)) = (job.pieces[piece].set, job.strip.stripes) else {
            return;
        };
        let item = job.pieces[piece].item.map(|k| &job.items[k]);
        let point = item.and_then(|i| i.match_point);
        let anchor = job.shapes[self.shape[piece]].anchor;
        if let (Some(anchor), Some(Phase::Set(_))) = (anchor, point.map(|p| p.phase)) {
            let at: Vec2 = self.at[piece] + anchor + job.corner() - stripes.origin;
            for axis in (0..2).filter(|&axis| stripes.repeat[axis] > 0.0) {
                self.phases[set][axis] = at[axis].rem_euclid(stripes.repeat[axis]);
            }
        }
    }

    /// Takes a piece off the strip.
    pub fn remove(&mut self, job: &Job<'_>, piece: usize) {
        self.present[piece] = false;
        self.at[piece] = off_strip(job, piece);
    }

    /// Area of the pieces that are not laid (m2).
    pub fn missing_area(&self, job: &Job<'_>) -> f64 {
        let missing = (0..self.at.len()).filter(|&k| !self.present[k]);
        missing.map(|k| job.pieces[k].area).sum()
    }

    /// Places a piece with a shape at a position.
    pub fn put(&mut self, job: &Job<'_>, piece: usize, shape: usize, at: Vec2) {
        self.present[piece] = true;
        self.shape[piece] = shape;
        self.size[piece] = job.shapes[shape].size;
        self.at[piece] = at;
    }

    /// Largest coordinates of a shape on this strip (m); `None` if it does not fit.
    pub fn room(&self, job: &Job<'_>, shape: usize) -> Option<Vec2> {
        let room = Vec2::new(self.length, job.height) - job.shapes[shape].size;
        let snug = -crate::shape::SNUG;
        (room.x >= snug && room.y >= snug).then(|| room.sup(&Vec2::zeros()))
    }

    /// Whether a piece may have a shape in the current direction of its garment.
    pub fn allows(&self, job: &Job<'_>, piece: usize, shape: usize) -> bool {
        let bundle = job.pieces[piece].bundle;
        bundle.is_none_or(|b| self.forward[b] == job.shapes[shape].forward)
    }

    /// The allowed position of a piece's shape that is nearest to `at`.
    pub fn nearest_allowed(
        &self,
        job: &Job<'_>,
        piece: usize,
        shape: usize,
        at: Vec2,
    ) -> Option<Vec2> {
        let room = self.room(job, shape)?;
        let axes = job.axes(piece, shape, &self.phases);
        if axes == [Axis::Free; 2] {
            return Some(at.sup(&Vec2::zeros()).inf(&room));
        }
        let (x, y) = (
            axes[0].nearest(at.x, room.x)?,
            axes[1].nearest(at.y, room.y)?,
        );
        Some(Vec2::new(x, y))
    }

    /// End of the last piece along the strip (m).
    pub fn reach(&self, job: &Job<'_>) -> f64 {
        let laid = |k: &usize| self.present[*k] && job.pieces[*k].item.is_some();
        let ends = (0..self.at.len()).filter(laid);
        ends.map(|k| self.at[k].x + self.size[k].x)
            .fold(0.0, f64::max)
    }

    /// End of the last locked piece along the strip, a lower bound of the length (m).
    pub fn least_reach(&self, job: &Job<'_>) -> f64 {
        let locked = |k: &usize| job.pieces[*k].item.is_some() && job.pieces[*k].locked.is_some();
        let ends = (0..self.at.len()).filter(locked);
        ends.map(|k| self.at[k].x + self.size[k].x)
            .fold(0.0, f64::max)
    }

    /// Changes the length of the strip (m). Pieces beyond `cut` move with its end; pieces without an allowed
    /// position on the new strip are removed.
    pub fn resize(&mut self, job: &Job<'_>, length: f64, cut: f64) {
        let by = length - self.length;
        self.length = length;
        for piece in 0..self.at.len() {
            if job.pieces[piece].locked.is_some() || !self.present[piece] {
                continue;
            }
            let mut at = self.at[piece];
            if at.x + 0.5 * self.size[piece].x > cut {
                at.x += by;
            }
            match self.nearest_allowed(job, piece, self.shape[piece], at) {
                Some(at) => self.at[piece] = at,
                None => self.remove(job, piece),
            }
        }
    }
}
