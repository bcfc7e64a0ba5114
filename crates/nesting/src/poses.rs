//! Shapes of every piece in every allowed orientation, and of flaws.

use crate::job::{Job, Piece, SAFE, SIMPLIFY};
use crate::marker::{Phase, turned};
use crate::shape::{Shape, coincide};
use crate::simplify::simplify_outward;
use crate::turns::{Fineness, orientations_within};
use crate::{Item, Nap};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use toile_geometry::{Polygon, Vec2};

/// Outlines with more corners are not compared with each other.
const MAX_CORNERS: usize = 500;

/// Properties that make two shapes equal for the search: outline, whether it is mirrored, whether it may
/// cover flaws, and all lengths and angles.
type Alike = (usize, bool, bool, [u64; 9]);

/// Indices of the shapes created so far.
#[derive(Default)]
struct Known {
    /// Shape by item, angle and side.
    of_item: BTreeMap<(usize, i64, bool), usize>,
    /// First shape by outline, angle and side.
    by_outline: BTreeMap<(usize, i64, bool), usize>,
    alike: BTreeMap<Alike, usize>,
}

/// The key of a shape: shapes with equal keys are the same for the search.
fn alike(item: &Item, shape: &Shape) -> Alike {
    let none = Vec2::repeat(f64::NAN);
    let anchor = shape.anchor.unwrap_or(none);
    let numbers = [
        shape.turn,
        shape.offset.x,
        shape.offset.y,
        shape.size.x,
        shape.size.y,
        anchor.x,
        anchor.y,
        shape.on_fold.unwrap_or(f64::NAN),
        item.gap,
    ];
    (
        shape.ring,
        shape.mirrored,
        item.over_flaws,
        numbers.map(f64::to_bits),
    )
}

impl Job<'_> {
    pub(crate) fn add_items(&mut self, copies: &[(usize, u32)], fineness: &Fineness) {
        self.shapes.clear();
        self.pieces.clear();
        self.rings.clear();
        let mut bundles = BTreeMap::new();
        let mut sets = BTreeMap::new();
        let mut known = Known::default();
        for (kind, item) in self.items.iter().enumerate() {
            let straight = Polygon::new(turned(&item.outline.outer, -item.grain, false)).oriented();
            let ring = simplify_outward(&straight.outer, SIMPLIFY * self.height);
            let ring = self.ring(ring);
            let own = copies.iter().filter(|c| c.0 == kind).map(|c| c.1);
            for copy in own {
                let lock = item.locked.iter().find(|l| l.copy == copy);
                let ways = match lock {
                    Some(lock) => vec![(lock.turn, lock.mirrored)],
                    None => orientations_within(item, self.strip, (copy, fineness)),
                };
                let shapes: Vec<usize> = ways
                    .into_iter()
                    .filter_map(|way| self.shape((kind, ring), way, &mut known))
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
        self.drop_misfits();
    }

    /// Index of a shape of an item; an equal existing shape is reused. `None` if the orientation does not
    /// bring the piece's fold edge to a fold.
    fn shape(
        &mut self,
        (kind, ring): (usize, usize),
        way: (f64, bool),
        known: &mut Known,
    ) -> Option<usize> {
        let angle = (way.0.rem_euclid(TAU) * 1e9).round() as i64;
        let key = (kind, angle, way.1);
        if let Some(&shape) = known.of_item.get(&key) {
            return Some(shape);
        }
        let item = &self.items[kind];
        let mut shape = Shape::new(kind, item, way, self.strip)?;
        shape.ring = ring;
        let next = self.shapes.len();
        let number = *known.alike.entry(alike(item, &shape)).or_insert(next);
        if number == next {
            shape.look = *known.by_outline.entry((ring, angle, way.1)).or_insert(next);
            self.shapes.push(shape);
        }
        known.of_item.insert(key, number);
        Some(number)
    }

    /// Removes shapes without an allowed position on the print from pieces that have other shapes.
    fn drop_misfits(&mut self) {
        for piece in 0..self.pieces.len() {
            let point = self.pieces[piece]
                .item
                .and_then(|k| self.items[k].match_point);
            let is_fixed = matches!(point.map(|p| p.phase), Some(Phase::At(_)));
            if !is_fixed || self.strip.stripes.is_none() || self.pieces[piece].locked.is_some() {
                continue;
            }
            let shapes = self.pieces[piece].shapes.iter().copied();
            let lying: Vec<usize> = shapes.filter(|&s| self.can_lie(piece, s, &[])).collect();
            if !lying.is_empty() {
                self.pieces[piece].shapes = lying;
            }
        }
    }

    /// Index of an outline; an equal existing outline is reused.
    fn ring(&mut self, ring: Vec<Vec2>) -> usize {
        let known = self.rings.iter().position(|old| *old == ring);
        known.unwrap_or_else(|| {
            self.rings.push(ring);
            self.rings.len() - 1
        })
    }

    /// Removes shapes that look like an earlier one: a rectangle rotated by half a turn is the same, except
    /// for a garment that must run one way.
    fn distinct(&self, item: &Item, shapes: Vec<usize>) -> Vec<usize> {
        let corners = item.outline.outer.len();
        if self.strip.nap == Nap::PerBundle || corners > MAX_CORNERS {
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

    /// Adds the flaws of the strip as fixed shapes. The search keeps pieces clear of them through `Job::gap`.
    pub(crate) fn add_defects(&mut self) {
        for (k, flaw) in self.strip.flaws.iter().enumerate() {
            let outline = flaw.outline.oriented();
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
}
