//! Bottom-left-fill: each piece in turn goes as far left, then as far down, as it can.
//!
//! The best position lies at a corner of the free region, so the candidates are the corners of the
//! no-fit polygons, the points where two of them cross, and where they cross the limits of the
//! strip (Burke, Hellier, Kendall and Whitwell 2006).

use crate::check::{SNUG, orientations};
use crate::fit::{Fit, NoFit, Shape};
use crate::order::Copy;
use crate::{Item, Placement, Strip};
use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_geometry::{Bounds2, PreparedPolygon, Vec2};

/// Overlap or missing gap the last check lets pass when no small step mends it \[m\]: a fifth of
/// what the referee allows.
const FORGIVEN: f64 = 2e-7;
/// Lengths of the small steps back \[m\].
const STEPS: [f64; 3] = [1e-8, 1e-7, 4e-7];

/// How the best of several orientations is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Preference {
    /// The one whose right end is furthest left.
    ShortestReach,
    /// The one whose left end is furthest left.
    EarliestStart,
}

/// A piece laid.
struct Laid {
    shape: usize,
    at: Vec2,
    exact: PreparedPolygon,
}

/// One marker of a given order.
pub(crate) struct Layout {
    /// What lies where, in the order laid.
    pub placements: Vec<Placement>,
    /// Copies that found no place.
    pub left_over: Vec<Copy>,
    /// Right end of the last piece \[m\].
    pub reach: f64,
    /// Sum of the right ends of all pieces \[m\].
    pub spread: f64,
    /// Positions weighed.
    pub positions: u64,
}

struct Layer<'a> {
    fit: &'a Fit,
    strip: &'a Strip,
    laid: Vec<Laid>,
    positions: Cell<u64>,
}

/// Lays copies in an order. Nothing if it was told to stop.
pub(crate) fn lay(
    (items, strip, fit): (&[Item], &Strip, &Fit),
    order: &[Copy],
    preference: Preference,
    cancel: &AtomicBool,
) -> Option<Layout> {
    let mut layer = Layer {
        fit,
        strip,
        laid: Vec::with_capacity(order.len()),
        positions: Cell::new(0),
    };
    let mut layout = Layout {
        placements: Vec::with_capacity(order.len()),
        left_over: Vec::new(),
        reach: strip.end_margin,
        spread: 0.0,
        positions: 0,
    };
    for &(item, copy) in order {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        let ways = orientations(&items[item], strip, copy);
        let allowed = |s: &Shape| s.item == item && ways.contains(&(s.pose.turn, s.pose.mirrored));
        let shapes = (0..fit.shapes.len()).filter(|&s| allowed(&fit.shapes[s]));
        let Some((shape, at)) = layer.best_of(shapes, preference) else {
            layout.left_over.push((item, copy));
            continue;
        };
        let pose = fit.shapes[shape].pose;
        let end = fit.shapes[shape].bounds.max.x + at.x;
        layout.reach = layout.reach.max(end);
        layout.spread += end;
        layout.placements.push(Placement {
            item,
            copy,
            turn: pose.turn,
            mirrored: pose.mirrored,
            translation: at,
        });
        layer.add(shape, at);
    }
    layout.positions = layer.positions.get();
    Some(layout)
}

impl Layer<'_> {
    fn add(&mut self, shape: usize, at: Vec2) {
        self.laid.push(Laid {
            shape,
            at,
            exact: PreparedPolygon::new(&self.fit.shapes[shape].outline.translated(at)),
        });
    }

    fn best_of(
        &self,
        shapes: impl Iterator<Item = usize>,
        preference: Preference,
    ) -> Option<(usize, Vec2)> {
        let mut best: Option<((f64, f64), usize, Vec2)> = None;
        for shape in shapes {
            let bounds = &self.fit.shapes[shape].bounds;
            let side = match preference {
                Preference::ShortestReach => bounds.max.x,
                Preference::EarliestStart => bounds.min.x,
            };
            let limit = best.map_or(f64::INFINITY, |((x, _), ..)| x - side);
            let Some(at) = self.leftmost(shape, limit) else {
                continue;
            };
            let score = (at.x + side, at.y + bounds.min.y);
            if best.is_none_or(|(known, ..)| score < known) {
                best = Some((score, shape, at));
            }
        }
        best.map(|(_, shape, at)| (shape, at))
    }

    /// Moves that keep a shape between the margins.
    fn room(&self, shape: &Shape) -> Option<Bounds2> {
        let (margin, edge) = (self.strip.end_margin, self.strip.selvedge);
        let min = Vec2::new(margin - shape.bounds.min.x, edge - shape.bounds.min.y);
        let length = self.strip.max_length.unwrap_or(f64::INFINITY);
        let max = Vec2::new(
            length - margin - shape.bounds.max.x,
            self.strip.width - edge - shape.bounds.max.y,
        );
        let snug = |low: f64, high: f64| {
            if high >= low - SNUG {
                Some(high.max(low))
            } else {
                None
            }
        };
        Some(Bounds2 {
            min,
            max: Vec2::new(snug(min.x, max.x)?, snug(min.y, max.y)?),
        })
    }

    /// The leftmost, then lowest, move at which a shape is free, with x at most `limit`.
    fn leftmost(&self, shape: usize, limit: f64) -> Option<Vec2> {
        let whole = self.room(&self.fit.shapes[shape])?;
        let mut room = whole;
        room.max.x = room.max.x.min(limit);
        let around: Vec<Around> = self
            .laid
            .iter()
            .map(|laid| Around::new(laid.at, self.fit.no_fit(laid.shape, shape)))
            .collect();
        let mut blocker = 0;
        let mut free = |at: Vec2| {
            if around.get(blocker).is_some_and(|a| a.forbids(at)) {
                return None;
            }
            if let Some(k) = around.iter().position(|a| a.forbids(at)) {
                blocker = k;
                return None;
            }
            self.settle(shape, at, &whole)
        };
        let mut corners = corner_candidates(&around, &room);
        let found = first_free(&mut corners, &mut free);
        if let Some(at) = found {
            room.max.x = room.max.x.min(at.x);
        }
        let mut crossings = crossing_candidates(&around, &room);
        let edges: usize = around.iter().map(|a| a.nfp.edges.len()).sum();
        let weighed = edges + corners.len() + crossings.len();
        self.positions.set(self.positions.get() + weighed as u64);
        first_free(&mut crossings, &mut free)
            .into_iter()
            .chain(found)
            .min_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)))
    }

    /// The move itself, or one a tiny step away, that passes the exact check.
    fn settle(&self, shape: usize, at: Vec2, room: &Bounds2) -> Option<Vec2> {
        if self.is_free(shape, at, 0.0) {
            return Some(at);
        }
        for step in STEPS {
            for (x, y) in [
                (1, 0),
                (1, 1),
                (1, -1),
                (0, 1),
                (0, -1),
                (-1, 1),
                (-1, -1),
                (-1, 0),
            ] {
                let moved = at + Vec2::new(f64::from(x), f64::from(y)) * step;
                if room.contains(moved) && self.is_free(shape, moved, 0.0) {
                    return Some(moved);
                }
            }
        }
        self.is_free(shape, at, FORGIVEN).then_some(at)
    }

    /// Whether a shape at a move neither overlaps nor comes nearer than its gap, but for
    /// `forgiven` \[m\], on the exact outlines.
    fn is_free(&self, shape: usize, at: Vec2, forgiven: f64) -> bool {
        let bounds = self.fit.shapes[shape].bounds.translated(at);
        let near = |laid: &&Laid| {
            let gap = self.fit.gap(laid.shape, shape);
            laid.exact.bounds().distance(&bounds) <= gap
        };
        let mut others = self.laid.iter().filter(near).peekable();
        if others.peek().is_none() {
            return true;
        }
        let exact = PreparedPolygon::new(&self.fit.shapes[shape].outline.translated(at));
        others.all(|laid| {
            let gap = self.fit.gap(laid.shape, shape);
            if gap > 0.0 {
                return laid.exact.distance(&exact) >= gap - forgiven.max(1e-12);
            }
            !laid.exact.overlaps(&exact)
                || (forgiven > 0.0 && laid.exact.penetration_depth(&exact) <= forgiven)
        })
    }
}

/// A no-fit polygon where its piece lies.
struct Around {
    at: Vec2,
    nfp: Arc<NoFit>,
    bounds: Bounds2,
}

impl Around {
    fn new(at: Vec2, nfp: Arc<NoFit>) -> Self {
        Self {
            at,
            bounds: nfp.bounds.translated(at),
            nfp,
        }
    }

    fn forbids(&self, at: Vec2) -> bool {
        self.bounds.contains(at) && self.nfp.forbids(at - self.at)
    }

    fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        self.nfp.edges.iter().map(|e| e.map(|p| p + self.at))
    }
}

/// The first candidate from the left, then from below, that is free.
fn first_free(candidates: &mut [Vec2], free: &mut dyn FnMut(Vec2) -> Option<Vec2>) -> Option<Vec2> {
    candidates.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    candidates.iter().find_map(|&at| free(at))
}

/// Corners of the room and of the no-fit polygons, and where these cross the room's sides.
fn corner_candidates(around: &[Around], room: &Bounds2) -> Vec<Vec2> {
    let mut found = vec![room.min, Vec2::new(room.min.x, room.max.y)];
    for one in around.iter().filter(|a| a.bounds.meets(room)) {
        for [a, b] in one.edges() {
            if room.contains(a) {
                found.push(a);
            }
            for y in [room.min.y, room.max.y] {
                if (a.y < y) != (b.y < y) {
                    let x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                    if x >= room.min.x && x <= room.max.x {
                        found.push(Vec2::new(x, y));
                    }
                }
            }
            let x = room.min.x;
            if (a.x < x) != (b.x < x) {
                let y = a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
                if y >= room.min.y && y <= room.max.y {
                    found.push(Vec2::new(x, y));
                }
            }
        }
    }
    found
}

/// Points of the room where two no-fit polygons cross, by a sweep along x.
fn crossing_candidates(around: &[Around], room: &Bounds2) -> Vec<Vec2> {
    let mut edges: Vec<(Bounds2, [Vec2; 2], usize)> = Vec::new();
    for (k, one) in around.iter().enumerate() {
        if !one.bounds.meets(room) {
            continue;
        }
        let boxed = one.edges().map(|e| (Bounds2::of(e), e, k));
        edges.extend(boxed.filter(|(b, ..)| b.meets(room)));
    }
    edges.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x));
    let mut found = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for (k, (bounds, edge, owner)) in edges.iter().enumerate() {
        open.retain(|&o| edges[o].0.max.x >= bounds.min.x);
        for &o in &open {
            let (other, crossed, whose) = &edges[o];
            if whose != owner && bounds.min.y <= other.max.y && other.min.y <= bounds.max.y {
                found.extend(crossing(*edge, *crossed).filter(|&p| room.contains(p)));
            }
        }
        open.push(k);
    }
    found
}

/// Where two segments cross, if they are not parallel.
fn crossing(a: [Vec2; 2], b: [Vec2; 2]) -> Option<Vec2> {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let cross = u.perp(&v);
    let (s, t) = (w.perp(&v) / cross, w.perp(&u) / cross);
    let within = |x: f64| (0.0..=1.0).contains(&x);
    (within(s) && within(t)).then(|| a[0] + u * s)
}
