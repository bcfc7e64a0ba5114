//! A job prepared for the search: every piece in every orientation, with the constraints of each pair.
//!
//! Shapes are translated so that their bounding boxes start at the origin. Positions are relative to the
//! corner of the usable fabric: selvedges and end margins lie outside the searched region.
//!
//! # Decided with
//! - [`toile_geometry::no_fit_polygon`], [`crate::nofit::NoFit`]: no-fit polygons, and distances looked up in
//!   them;
//! - [`crate::pair::Pair`], [`crate::job::Job::pair_up`] (`tables.rs`): the loss of a pair less its gap; all
//!   pairs;
//! - [`crate::raster::LossMap`], [`crate::depth_raster::DepthRaster`]: losses of a piece at all places,
//!   coarsely;
//! - [`crate::job::Job::add_items`] (`poses.rs`), [`crate::job::Job::add_defects`] (`poses.rs`): pieces in
//!   each turn; flaws as pieces that do not move;
//! - [`crate::layout::Layout::set_phase`]: prints: the phase of a set of pieces;
//! - [`crate::simplify`]: outlines of fewer points;
//! - [`crate::referee`] (`check_pair`): the exact judgement.

use crate::depth_raster::DepthRaster;
use crate::error::NestingError;
use crate::marker::{Phase, turned};
use crate::nofit::{NoFit, most_cells};
use crate::pair::{Pair, PairQuery};
use crate::shape::{SNUG, Shape};
use crate::side_by_side::side_by_side;
use crate::turns::Fineness;
use crate::{Item, Strip};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use toile_geometry::{Polygon, Vec2, no_fit_polygon};

/// Largest growth of simplified outlines, relative to the width of the fabric: 0.1 mm on a roll.
pub(crate) const SIMPLIFY: f64 = 6e-5;
/// Distance kept between touching pieces, relative to the width of the fabric: more than the rounding of the
/// no-fit polygons, far less than the accuracy of cutting.
pub(crate) const SAFE: f64 = 6e-8;
/// Distance outside a no-fit polygon up to which its edges are found, relative to the width of the fabric.
const WINDOW: f64 = 0.02;
/// One copy to lay, or an obstacle that lies there already.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Index of the item; `None` for a flaw.
    pub item: Option<usize>,
    pub copy: u32,
    /// Shapes of the allowed orientations.
    pub shapes: Vec<usize>,
    /// The shape and position of a locked piece.
    pub locked: Option<(usize, Vec2)>,
    /// Index of the garment, if its pieces must run one way.
    pub bundle: Option<usize>,
    /// Index of the set of matched pieces.
    pub set: Option<usize>,
    /// Area of the outline (m2).
    pub area: f64,
}

impl Piece {
    /// Whether the bounding box of some shape of the piece fits a strip length (m).
    pub fn fits(&self, job: &Job<'_>, length: f64) -> bool {
        let snug = length + SNUG;
        self.shapes.iter().any(|&s| job.shapes[s].size.x <= snug)
    }
}

/// A pair of outlines, the angle between them (rad), and whether one of them is mirrored.
pub(crate) type Key = (usize, usize, f64, bool);

/// Allowed values of a coordinate of a piece's position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Axis {
    Free,
    Only(f64),
    Every { first: f64, step: f64 },
}

impl Axis {
    /// The allowed value from 0 to `end` that is nearest to `value`.
    pub fn nearest(self, value: f64, end: f64) -> Option<f64> {
        match self {
            Self::Free => Some(value.clamp(0.0, end)),
            Self::Only(only) => (only <= end + 1e-9).then_some(only),
            Self::Every { first, step } => {
                let first = first.rem_euclid(step);
                let last = ((end - first) / step).floor();
                let number = ((value - first) / step).round().clamp(0.0, last.max(0.0));
                (last >= 0.0).then_some(first + number * step)
            }
        }
    }
}

/// A job with its tables, shared by threads.
pub(crate) struct Job<'a> {
    pub items: &'a [Item],
    pub strip: &'a Strip,
    pub shapes: Vec<Shape>,
    pub pieces: Vec<Piece>,
    /// Usable width of the fabric (m).
    pub height: f64,
    /// Largest gap (m).
    pub widest_gap: f64,
    /// Grid spacing of the loss maps (m).
    pub spacing: f64,
    /// Number of garments, and of matched sets.
    pub bundles: usize,
    pub sets: usize,
    pub(crate) pairs: Vec<Pair>,
    pub(crate) keys: Vec<Key>,
    pub(crate) rings: Vec<Vec<Vec2>>,
    pub(crate) no_fits: Vec<OnceLock<NoFit>>,
    pub(crate) rasters: Vec<OnceLock<DepthRaster>>,
}

impl<'a> Job<'a> {
    /// Creates shapes of every copy in every allowed orientation, or in fewer if the tables of all pairs
    /// would be too large. Items and strip must have passed the check.
    ///
    /// # Errors
    /// The tables are too large even with few turns, or `stop` returned true.
    pub fn new(
        items: &'a [Item],
        strip: &'a Strip,
        copies: &[(usize, u32)],
        stop: &dyn Fn() -> bool,
    ) -> Result<Self, NestingError> {
        let mut job = Self {
            items,
            strip,
            shapes: Vec::new(),
            pieces: Vec::new(),
            height: strip.usable_width(),
            widest_gap: 0.0,
            spacing: 0.0,
            bundles: 0,
            sets: 0,
            pairs: Vec::new(),
            keys: Vec::new(),
            rings: Vec::new(),
            no_fits: Vec::new(),
            rasters: Vec::new(),
        };
        for (fineness, maps) in Fineness::levels(items) {
            job.add_items(copies, fineness);
            job.add_defects();
            let held = job.pair_up(fineness.no_fits, stop) && job.choose_spacing(maps);
            if stop() {
                return Err(NestingError::Cancelled);
            }
            if held {
                return Ok(job);
            }
        }
        Err(NestingError::TooManyShapes {
            outlines: job.rings.len(),
            orientations: job.shapes.len(),
        })
    }

    /// Initial direction of a garment: the only one that all its pieces allow; if both are allowed, every
    /// second garment runs backwards.
    pub fn starts_forward(&self, bundle: usize) -> bool {
        let may = |forward: bool| {
            let mut own = self.pieces.iter().filter(|p| p.bundle == Some(bundle));
            own.all(|p| p.shapes.iter().any(|&s| self.shapes[s].forward == forward))
        };
        match (may(true), may(false)) {
            (true, true) => bundle.is_multiple_of(2),
            (false, true) => false,
            _ => true,
        }
    }

    /// Whether locked pieces fix the place of a matched set in the repeat.
    pub fn is_fixed(&self, set: usize) -> bool {
        let fixes = |p: &Piece| p.set == Some(set) && p.locked.is_some();
        self.pieces.iter().any(fixes)
    }

    /// Lower left corner of the usable fabric (m).
    pub fn corner(&self) -> Vec2 {
        Vec2::new(self.strip.end_margin, self.strip.lower())
    }

    /// Largest length between the end margins (m).
    pub fn longest(&self) -> f64 {
        self.strip
            .max_length
            .map_or(f64::INFINITY, |l| l - 2.0 * self.strip.end_margin)
    }

    /// Lower bound of the length needed for all movable pieces (m).
    pub fn shortest(&self) -> f64 {
        let least = |p: &Piece| {
            let lengths = p.shapes.iter().map(|&s| self.shapes[s].size.x);
            lengths.fold(f64::INFINITY, f64::min)
        };
        let movable = self.pieces.iter().filter(|p| p.locked.is_none());
        let area: f64 = self.pieces.iter().map(|p| p.area).sum();
        movable.map(least).fold(area / self.height, f64::max)
    }

    /// A length that is certain to hold all pieces one behind the other (m).
    pub fn ample(&self) -> f64 {
        let longest = |p: &Piece| {
            let shapes = p.shapes.iter().chain(p.locked.as_ref().map(|l| &l.0));
            shapes.map(|&s| self.shapes[s].size.x).fold(0.0, f64::max)
        };
        let repeat = self.strip.stripes.map_or(0.0, |s| s.repeat.x);
        let each: f64 = self
            .pieces
            .iter()
            .map(|p| longest(p) + self.widest_gap + repeat)
            .sum();
        let locked = self.pieces.iter().filter_map(|p| p.locked);
        let end = locked
            .map(|(s, at)| at.x + self.shapes[s].size.x)
            .fold(0.0, f64::max);
        2.0 * each + end
    }

    pub(crate) fn gap(&self, a: usize, b: usize) -> f64 {
        let count = self.items.len();
        let gap = match (self.items.get(a), self.items.get(b)) {
            (Some(one), Some(other)) => self.strip.gap_between(one, other),
            (Some(item), None) if !item.over_flaws => self.strip.flaws[b - count].clearance,
            (None, Some(item)) if !item.over_flaws => self.strip.flaws[a - count].clearance,
            _ => return f64::NEG_INFINITY,
        };
        gap + self.safe()
    }

    /// Distance kept between touching pieces (m).
    pub fn safe(&self) -> f64 {
        SAFE * self.height
    }

    /// Distance up to which the search evaluates a pair of shapes (m).
    pub fn window(&self) -> f64 {
        WINDOW * self.height
    }

    /// Largest growth of a simplified outline for a pair of shapes (m).
    pub fn growth(&self) -> f64 {
        2.0 * SIMPLIFY * self.height
    }

    fn no_fit(&self, number: u32) -> &NoFit {
        self.no_fits[number as usize].get_or_init(|| {
            let (fixed, moving, angle, mirrored) = self.keys[number as usize];
            let ring = turned(&self.rings[moving], angle, mirrored);
            let reach = self.widest_gap + self.window();
            let cells = most_cells(self.no_fits.len());
            NoFit::new(&no_fit_polygon(&self.rings[fixed], &ring), reach, cells)
        })
    }

    /// The pair of a fixed and a moving shape; `None` if they may overlap.
    #[inline]
    pub fn pair(&self, fixed: usize, moving: usize) -> Option<PairQuery<'_>> {
        let pair = &self.pairs[fixed * self.shapes.len() + moving];
        (pair.gap >= 0.0).then(|| PairQuery {
            no_fit: self.no_fit(pair.no_fit),
            axes: pair.axes,
            shift: pair.shift,
            gap: pair.gap,
        })
    }

    /// Amount by which a moving shape is nearer to a fixed one than allowed (m), 0 or more.
    #[inline]
    pub fn loss(&self, fixed: usize, moving: usize, apart: Vec2) -> f64 {
        self.pair(fixed, moving)
            .map_or(0.0, |pair| pair.loss(apart))
    }

    /// The simplified outline of a shape, relative to the corner of its bounding box (m).
    pub fn taken(&self, shape: usize) -> Polygon {
        let shape = &self.shapes[shape];
        let ring = turned(&self.rings[shape.ring], shape.turn, shape.mirrored);
        Polygon::new(ring).translated(-shape.offset)
    }

    /// Computes all no-fit polygons on a number of threads and calls `told` at intervals. Stops early if
    /// `stop` returns true: the rest is computed when needed.
    pub fn prepare(
        &self,
        threads: usize,
        stop: &(dyn Fn() -> bool + Sync),
        told: &mut dyn FnMut(),
    ) {
        let next = AtomicUsize::new(0);
        let work = |_: usize| {
            while !stop() {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= self.no_fits.len() {
                    break;
                }
                self.no_fit(number as u32);
            }
        };
        let threads = threads.clamp(1, self.no_fits.len().max(1));
        side_by_side((0..threads).collect(), &work, told);
    }

    /// Whether a shape of a piece has any allowed position, for the given phases of the sets.
    pub fn can_lie(&self, piece: usize, shape: usize, phases: &[Vec2]) -> bool {
        let room = Vec2::new(self.longest(), self.height) - self.shapes[shape].size;
        let axes = self.axes(piece, shape, phases);
        let snug = -SNUG;
        (0..2).all(|k| room[k] >= snug && axes[k].nearest(0.0, room[k].max(0.0)).is_some())
    }

    /// Allowed coordinates of a piece's position, for the given phases of the sets.
    pub fn axes(&self, piece: usize, shape: usize, phases: &[Vec2]) -> [Axis; 2] {
        let (piece, shape) = (&self.pieces[piece], &self.shapes[shape]);
        let mut axes = [Axis::Free; 2];
        if let (Some(anchor), Some(stripes)) = (shape.anchor, self.strip.stripes) {
            let phase = match (
                piece.set,
                piece.item.and_then(|i| self.items[i].match_point),
            ) {
                (Some(set), _) => phases[set],
                (_, Some(point)) => match point.phase {
                    Phase::At(phase) => phase,
                    Phase::Set(_) => Vec2::zeros(),
                },
                _ => Vec2::zeros(),
            };
            let first = stripes.origin - self.corner() + phase - anchor;
            for k in 0..2 {
                if stripes.repeat[k] > 0.0 {
                    axes[k] = Axis::Every {
                        first: first[k],
                        step: stripes.repeat[k],
                    };
                }
            }
        }
        if let Some(y) = shape.on_fold {
            axes[1] = Axis::Only(y);
        }
        axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Allowed, MatchPoint, Mirror, Stripes};
    use std::f64::consts::TAU;
    use toile_geometry::{Bounds2, PreparedPolygon};

    fn notched() -> Polygon {
        let points = [
            (0.0, 0.0),
            (0.4, 0.0),
            (0.4, 0.3),
            (0.25, 0.1),
            (0.1, 0.3),
            (0.0, 0.2),
        ];
        Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
    }

    /// Compares every query with the exact answer on the outlines themselves.
    #[test]
    fn queries_of_pairs_in_all_poses_are_exact() {
        let triangle = [(0.0, 0.0), (0.3, 0.05), (0.1, 0.2)];
        let triangle = triangle.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
        let mut items = [
            Item::new("notched", notched()),
            Item::new("triangle", Polygon::new(triangle)),
        ];
        items[0].grain = 0.4;
        items[0].allowed = Allowed::two_way().mirrored(Mirror::Free);
        items[1].allowed = Allowed {
            tilt: 0.05,
            ..Allowed::two_way()
        };
        let strip = Strip::of_width(1.0);
        let job = Job::new(&items, &strip, &[(0, 0), (1, 0)], &|| false).unwrap();
        assert_eq!(job.shapes.len(), 4 + 10);
        let mut sequence = crate::random::SplitMix64(7);
        for a in 0..job.shapes.len() {
            let fixed = PreparedPolygon::new(&job.shapes[a].outline(&items[job.shapes[a].kind]));
            for b in 0..job.shapes.len() {
                let outline = job.shapes[b].outline(&items[job.shapes[b].kind]);
                for _ in 0..60 {
                    let span = job.shapes[a].size + job.shapes[b].size;
                    let chance = Vec2::new(sequence.unit(), sequence.unit());
                    let apart = span.component_mul(&chance) - job.shapes[b].size;
                    let moving = PreparedPolygon::new(&outline.translated(apart));
                    let exact = if fixed.overlaps(&moving) {
                        fixed.penetration_depth(&moving)
                    } else {
                        -fixed.distance(&moving)
                    };
                    match job.pair(a, b).and_then(|pair| pair.probe(apart)) {
                        Some((probe, _)) => {
                            let off = (probe.depth - exact).abs();
                            assert!(off < 1e-7, "{a} {b} {apart}: {} {exact}", probe.depth);
                        }
                        None => assert!(exact < -job.window()),
                    }
                }
            }
        }
    }

    /// Matched garments have items of their own, but equal pieces share their shapes.
    #[test]
    fn pieces_of_many_matched_garments_share_their_shapes() {
        let item = |garment: u32| Item {
            allowed: Allowed {
                tilt: 0.03,
                ..Allowed::two_way()
            },
            match_point: Some(MatchPoint {
                point: Vec2::new(0.1, 0.1),
                phase: Phase::Set(garment),
            }),
            ..Item::new("notched", notched())
        };
        let items: Vec<Item> = (0..60).map(item).collect();
        let strip = Strip {
            stripes: Some(Stripes {
                repeat: Vec2::new(0.05, 0.0),
                origin: Vec2::zeros(),
            }),
            ..Strip::of_width(1.0)
        };
        let copies: Vec<(usize, u32)> = (0..60).map(|k| (k, 0)).collect();
        let job = Job::new(&items, &strip, &copies, &|| false).unwrap();
        assert_eq!((job.shapes.len(), job.pairs.len()), (10, 100));
        let other = Item {
            gap: 0.01,
            ..items[0].clone()
        };
        let items = [items[0].clone(), other];
        let job = Job::new(&items, &strip, &[(0, 0), (1, 0)], &|| false).unwrap();
        assert_eq!(job.shapes.len(), 20, "another gap, another shape");
    }

    /// Loss maps keep a useful resolution, however many shapes there are.
    #[test]
    fn many_turns_do_not_coarsen_the_loss_maps_without_end() {
        let item = |k: u32| {
            let bulge = 1e-4 * f64::from(k);
            let points = [(0.0, 0.0), (0.1, bulge), (0.08, 0.07), (0.02, 0.06 + bulge)];
            let points = points.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
            let turns = (0..24).map(|k| TAU * f64::from(k) / 24.0).collect();
            Item {
                allowed: Allowed::turned(turns),
                ..Item::new("piece", Polygon::new(points))
            }
        };
        // The bar fits only along the diagonal of the strip: with the second turn, or the fourteenth.
        let bar = Item {
            grain: -10f64.to_radians(),
            ..Item::new(
                "bar",
                Polygon::rectangle(Bounds2 {
                    min: Vec2::zeros(),
                    max: Vec2::new(1.3, 0.001),
                }),
            )
        };
        let strip = Strip {
            max_length: Some(1.2),
            ..Strip::of_width(0.56)
        };
        for (count, turns) in [(5, 24), (10, 12), (60, 4)] {
            let mut items: Vec<Item> = (0..count).map(item).collect();
            items.push(Item {
                allowed: items[0].allowed.clone(),
                ..bar.clone()
            });
            let copies: Vec<(usize, u32)> = (0..items.len()).map(|k| (k, 0)).collect();
            let job = Job::new(&items, &strip, &copies, &|| false).unwrap();
            assert!(job.spacing <= 1.05 * 0.56 / 8.0, "{count}: {}", job.spacing);
            assert_eq!(job.pieces[0].shapes.len(), turns, "{count}");
            let fits = |&&s: &&usize| job.shapes[s].size.x <= 1.2 && job.shapes[s].size.y <= 0.56;
            let bar = &job.pieces[copies.len() - 1];
            assert!(bar.shapes.iter().any(|s| fits(&s)), "{count}");
            let stopped = Job::new(&items, &strip, &copies, &|| true);
            assert!(matches!(stopped, Err(NestingError::Cancelled)));
        }
    }
}
