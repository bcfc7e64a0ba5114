//! A job made ready: every piece in every orientation, and what each pair may not do.
//!
//! Shapes are moved so that their boxes start at the origin. Moves are measured from the corner of
//! the usable fabric.

use crate::check::{TILTS, orientations_within};
use crate::marker::{Phase, turned};
use crate::nofit::NoFit;
use crate::pair::{Pair, PairQuery};
use crate::raster::DepthRaster;
use crate::shape::{Shape, coincide};
use crate::side_by_side::side_by_side;
use crate::simplify::simplify_outward;
use crate::{Item, Nap, Pose, Strip};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use toile_geometry::{Polygon, Vec2, no_fit_polygon};

/// How far outlines may grow when they are simplified, over the width of the fabric: a tenth of a
/// millimetre on the roll.
const SIMPLIFY: f64 = 6e-5;
/// Distance kept between touching pieces over the width of the fabric: above the rounding of the
/// no-fit polygons, far under what can be cut.
const SAFE: f64 = 6e-8;
/// How far outside of a no-fit polygon its edges are still found, over the width of the fabric.
const WINDOW: f64 = 0.02;
/// Most rows of the loss maps.
const ROWS: f64 = 64.0;
/// Outlines of more corners are not compared with each other.
const MOST_CORNERS: usize = 500;
/// Most numbers in all depth rasters together, padding included: 128 MB.
const RASTER_NUMBERS: f64 = 32e6;
/// Most no-fit polygons, about 50 kB each: where tilts would need more, fewer tilts are tried.
const MOST_NO_FITS: usize = 4000;
const FEW_TILTS: [f64; 3] = [0.0, -1.0, 1.0];

/// One copy to lay, or something that lies already.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The item; nothing for a defect.
    pub item: Option<usize>,
    pub copy: u32,
    /// Orientations it may take.
    pub shapes: Vec<usize>,
    /// The only place it may have.
    pub locked: Option<(usize, Vec2)>,
    /// Number of its garment, if that must run one way.
    pub bundle: Option<usize>,
    /// Number of its set of matched pieces.
    pub set: Option<usize>,
    /// Area of the outline \[m2\].
    pub area: f64,
}

impl Piece {
    /// Whether some shape of it fits a strip of a length \[m\] by its box.
    pub fn fits(&self, job: &Job<'_>, length: f64) -> bool {
        let snug = length + crate::check::SNUG;
        self.shapes.iter().any(|&s| job.shapes[s].size.x <= snug)
    }
}

/// Outlines, angle between them \[rad\], and whether one of them is turned over.
type Key = (usize, usize, f64, bool);

/// What a coordinate of a piece's place may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Axis {
    Free,
    Only(f64),
    Every { first: f64, step: f64 },
}

impl Axis {
    /// The allowed value nearest to one, from 0 to `end`.
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

/// A job with its tables; shared by threads.
pub(crate) struct Job<'a> {
    pub items: &'a [Item],
    pub strip: &'a Strip,
    pub shapes: Vec<Shape>,
    pub pieces: Vec<Piece>,
    /// Usable width \[m\].
    pub height: f64,
    /// Greatest gap \[m\].
    pub widest_gap: f64,
    /// Spacing of the loss maps \[m\].
    pub spacing: f64,
    /// Numbers of garments and of matched sets.
    pub bundles: usize,
    pub sets: usize,
    pairs: Vec<Pair>,
    keys: Vec<Key>,
    rings: Vec<Vec<Vec2>>,
    no_fits: Vec<OnceLock<NoFit>>,
    rasters: Vec<OnceLock<DepthRaster>>,
}

impl<'a> Job<'a> {
    /// Poses every copy in every allowed orientation. Items and strip are sound.
    pub fn new(items: &'a [Item], strip: &'a Strip, copies: &[(usize, u32)]) -> Self {
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
        for tilts in [&TILTS[..], &FEW_TILTS, &[0.0]] {
            job.add_items(copies, tilts);
            job.add_defects();
            job.pair_up();
            if job.no_fits.len() <= MOST_NO_FITS {
                break;
            }
        }
        job.spacing = job.height / ROWS;
        while job.raster_numbers() > RASTER_NUMBERS {
            job.spacing *= 1.05;
        }
        job
    }

    /// Numbers in all depth rasters together.
    fn raster_numbers(&self) -> f64 {
        let count = self.shapes.len();
        let mut seen = vec![false; self.rasters.len()];
        let mut sum = 0.0;
        for (k, pair) in self.pairs.iter().enumerate() {
            if !std::mem::replace(&mut seen[pair.raster as usize], true) {
                sum += DepthRaster::numbers(self, k / count, k % count) as f64;
            }
        }
        sum
    }

    fn add_items(&mut self, copies: &[(usize, u32)], tilts: &[f64]) {
        self.shapes.clear();
        self.pieces.clear();
        self.rings.clear();
        let mut bundles = BTreeMap::new();
        let mut sets = BTreeMap::new();
        let mut known: BTreeMap<(usize, i64, bool), usize> = BTreeMap::new();
        let mut looks: BTreeMap<(usize, i64, bool), usize> = BTreeMap::new();
        for (kind, item) in self.items.iter().enumerate() {
            let straight = Polygon::new(turned(&item.outline.outer, -item.grain, false)).oriented();
            let ring = simplify_outward(&straight.outer, SIMPLIFY * self.height);
            let ring = self.ring(ring);
            let own = copies.iter().filter(|c| c.0 == kind).map(|c| c.1);
            for copy in own {
                let lock = item.locked.iter().find(|l| l.copy == copy);
                let ways = match lock {
                    Some(lock) => vec![(lock.turn, lock.mirrored)],
                    None => orientations_within(item, self.strip, (copy, tilts)),
                };
                let shapes: Vec<usize> = ways
                    .into_iter()
                    .filter_map(|way| {
                        let key = (kind, (way.0.rem_euclid(TAU) * 1e9).round() as i64, way.1);
                        if let Some(&shape) = known.get(&key) {
                            return Some(shape);
                        }
                        let mut shape = Shape::new(kind, item, way, self.strip)?;
                        shape.ring = ring;
                        let next = self.shapes.len();
                        shape.look = *looks.entry((ring, key.1, way.1)).or_insert(next);
                        self.shapes.push(shape);
                        known.insert(key, self.shapes.len() - 1);
                        Some(self.shapes.len() - 1)
                    })
                    .collect();
                let shapes = self.distinct(item, shapes);
                let locked = lock.zip(shapes.first()).map(|(lock, &shape)| {
                    let at = lock.translation + self.shapes[shape].offset - self.corner();
                    (shape, at)
                });
                let bundle = (self.strip.nap == Nap::PerBundle).then(|| {
                    let count = bundles.len();
                    *bundles.entry(item.bundle(copy)).or_insert(count)
                });
                let set = match item.match_point.map(|m| m.phase) {
                    Some(Phase::Set(set)) if self.strip.stripes.is_some() => {
                        let count = sets.len();
                        Some(*sets.entry(set).or_insert(count))
                    }
                    _ => None,
                };
                self.pieces.push(Piece {
                    item: Some(kind),
                    copy,
                    shapes,
                    locked,
                    bundle,
                    set,
                    area: item.outline.area(),
                });
            }
        }
        (self.bundles, self.sets) = (bundles.len(), sets.len());
    }

    /// The number of an outline, the old one if there is one just alike.
    fn ring(&mut self, ring: Vec<Vec2>) -> usize {
        let known = self.rings.iter().position(|old| *old == ring);
        known.unwrap_or_else(|| {
            self.rings.push(ring);
            self.rings.len() - 1
        })
    }

    /// Which way a garment runs at first: every second one backwards, if all its pieces may.
    pub fn starts_forward(&self, bundle: usize) -> bool {
        let mut own = self.pieces.iter().filter(|p| p.bundle == Some(bundle));
        let may = |p: &Piece| p.shapes.iter().any(|&s| !self.shapes[s].forward);
        bundle.is_multiple_of(2) || !own.all(may)
    }

    /// Whether locked pieces fix where a matched set lies.
    pub fn is_fixed(&self, set: usize) -> bool {
        let fixes = |p: &Piece| p.set == Some(set) && p.locked.is_some();
        self.pieces.iter().any(fixes)
    }

    /// Shapes without those that look like an earlier one: a rectangle turned half round is the
    /// same to everything but a garment that runs one way.
    fn distinct(&self, item: &Item, shapes: Vec<usize>) -> Vec<usize> {
        let corners = item.outline.outer.len();
        if self.strip.nap == Nap::PerBundle || corners > MOST_CORNERS {
            return shapes;
        }
        let mut kept: Vec<(usize, Vec<Vec2>)> = Vec::new();
        for index in shapes {
            let shape = &self.shapes[index];
            let ring = shape.outline(item).outer;
            let same = |(k, other): &(usize, Vec<Vec2>)| {
                let known = &self.shapes[*k];
                known.anchor == shape.anchor
                    && known.on_fold == shape.on_fold
                    && coincide(&ring, other, SAFE * self.height)
            };
            if !kept.iter().any(same) {
                kept.push((index, ring));
            }
        }
        kept.into_iter().map(|(index, _)| index).collect()
    }

    /// Defects lie where they lie.
    fn add_defects(&mut self) {
        for (k, defect) in self.strip.defects.iter().enumerate() {
            let outline = defect.outline.oriented();
            let bounds = outline.bounds();
            let ring = self.ring(outline.outer);
            self.shapes.push(Shape {
                kind: self.items.len() + k,
                ring,
                look: self.shapes.len(),
                turn: 0.0,
                mirrored: false,
                offset: bounds.min,
                size: bounds.size(),
                forward: true,
                anchor: None,
                on_fold: None,
            });
            self.pieces.push(Piece {
                item: None,
                copy: 0,
                shapes: Vec::new(),
                locked: Some((self.shapes.len() - 1, bounds.min - self.corner())),
                bundle: None,
                set: None,
                area: 0.0,
            });
        }
    }

    /// Lower left corner of the usable fabric \[m\].
    pub fn corner(&self) -> Vec2 {
        Vec2::new(self.strip.end_margin, self.strip.lower())
    }

    /// Greatest length between the end margins \[m\].
    pub fn longest(&self) -> f64 {
        self.strip
            .max_length
            .map_or(f64::INFINITY, |l| l - 2.0 * self.strip.end_margin)
    }

    /// Least length on which all movable pieces could lie \[m\].
    pub fn shortest(&self) -> f64 {
        let least = |p: &Piece| {
            let lengths = p.shapes.iter().map(|&s| self.shapes[s].size.x);
            lengths.fold(f64::INFINITY, f64::min)
        };
        let movable = self.pieces.iter().filter(|p| p.locked.is_none());
        let area: f64 = self.pieces.iter().map(|p| p.area).sum();
        movable.map(least).fold(area / self.height, f64::max)
    }

    /// A length on which the pieces could lie one behind the other \[m\].
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

    fn gap(&self, a: usize, b: usize) -> f64 {
        let count = self.items.len();
        let gap = match (self.items.get(a), self.items.get(b)) {
            (Some(one), Some(other)) => self.strip.gap_between(one, other),
            (Some(item), None) if !item.over_defects => self.strip.defects[b - count].clearance,
            (None, Some(item)) if !item.over_defects => self.strip.defects[a - count].clearance,
            _ => return f64::NEG_INFINITY,
        };
        gap + self.safe()
    }

    /// What touching pieces are kept apart \[m\].
    pub fn safe(&self) -> f64 {
        SAFE * self.height
    }

    /// How far from touching two shapes are still seen \[m\].
    pub fn window(&self) -> f64 {
        WINDOW * self.height
    }

    /// How much larger than its outline a shape may be taken \[m\].
    pub fn growth(&self) -> f64 {
        2.0 * SIMPLIFY * self.height
    }

    /// With N(a, b) = a + (-b) and an isometry Q: N(Qa, Qb) = Q N(a, b) and N(b, a) = -N(a, b), so
    /// one polygon serves all pairs that lie alike.
    fn pair_up(&mut self) {
        self.keys.clear();
        let count = self.shapes.len();
        let mut rasters: BTreeMap<(usize, usize, u64), u32> = BTreeMap::new();
        let mut known: BTreeMap<(usize, usize, i64, bool), u32> = BTreeMap::new();
        let mut pairs = Vec::with_capacity(count * count);
        for a in &self.shapes {
            for b in &self.shapes {
                let swapped = b.ring < a.ring;
                let (fixed, moving) = if swapped { (b, a) } else { (a, b) };
                let apart = moving.turn - fixed.turn;
                let apart = if fixed.mirrored { -apart } else { apart };
                let angle = (apart.rem_euclid(TAU) * 1e9).round() as i64;
                let angle = angle % (TAU * 1e9).round() as i64;
                let mirrored = fixed.mirrored != moving.mirrored;
                let key = (fixed.ring, moving.ring, angle, mirrored);
                let next = known.len() as u32;
                let no_fit = *known.entry(key).or_insert(next);
                if no_fit == next {
                    self.keys.push((fixed.ring, moving.ring, apart, mirrored));
                }
                let sign = if swapped { -1.0 } else { 1.0 };
                let pose = Pose {
                    grain: 0.0,
                    turn: fixed.turn,
                    mirrored: fixed.mirrored,
                    translation: Vec2::zeros(),
                };
                let axes = pose.axes().map(|axis| axis * sign);
                let between = a.offset - b.offset;
                let gap = self.gap(a.kind, b.kind);
                let next = rasters.len() as u32;
                let raster = rasters.entry((a.look, b.look, gap.to_bits()));
                pairs.push(Pair {
                    no_fit,
                    raster: *raster.or_insert(next),
                    axes,
                    shift: Vec2::new(between.dot(&axes[0]), between.dot(&axes[1])),
                    gap,
                });
            }
        }
        let gaps = pairs.iter().map(|p| p.gap);
        self.widest_gap = gaps.filter(|g| g.is_finite()).fold(0.0, f64::max);
        self.no_fits = known.iter().map(|_| OnceLock::new()).collect();
        self.rasters = rasters.iter().map(|_| OnceLock::new()).collect();
        self.pairs = pairs;
    }

    fn no_fit(&self, number: u32) -> &NoFit {
        self.no_fits[number as usize].get_or_init(|| {
            let (fixed, moving, angle, mirrored) = self.keys[number as usize];
            let ring = turned(&self.rings[moving], angle, mirrored);
            let reach = self.widest_gap + self.window();
            NoFit::new(&no_fit_polygon(&self.rings[fixed], &ring), reach)
        })
    }

    /// The pair of a fixed and a moving shape; nothing if they may overlap.
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

    /// How much nearer than allowed a moving shape lies to a fixed one \[m\], 0 or more.
    #[inline]
    pub fn loss(&self, fixed: usize, moving: usize, apart: Vec2) -> f64 {
        self.pair(fixed, moving)
            .map_or(0.0, |pair| pair.loss(apart))
    }

    /// The outline of a shape as the search takes it, from the corner of its box \[m\].
    pub fn taken(&self, shape: usize) -> Polygon {
        let shape = &self.shapes[shape];
        let ring = turned(&self.rings[shape.ring], shape.turn, shape.mirrored);
        Polygon::new(ring).translated(-shape.offset)
    }

    /// The losses of a moving shape at regular moves from a fixed one.
    pub fn raster(&self, fixed: usize, moving: usize) -> &DepthRaster {
        let number = self.pairs[fixed * self.shapes.len() + moving].raster;
        self.rasters[number as usize].get_or_init(|| DepthRaster::new(self, fixed, moving))
    }

    /// Makes all no-fit polygons, on as many threads as asked, and says so now and then; stops
    /// early if `stop` says so: those left are made when they are needed.
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

    /// What the coordinates of a piece's place may be, for the phases chosen for the sets.
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
    use crate::{Allowed, Mirror};
    use toile_geometry::PreparedPolygon;

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

    /// Every query against the exact answer on the outlines themselves.
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
        let job = Job::new(&items, &strip, &[(0, 0), (1, 0)]);
        assert_eq!(job.shapes.len(), 4 + 10);
        let mut sequence = crate::sequence::Sequence(7);
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
}
