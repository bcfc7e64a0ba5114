//! In which order pieces are laid.

use crate::Item;
use toile_geometry::{Polygon, convex_hull};

/// One copy of an item.
pub(crate) type Copy = (usize, u32);

/// What makes a piece come early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Criterion {
    Area,
    HullArea,
    Length,
    Width,
    Perimeter,
    Diagonal,
    Hollow,
}

/// All criteria, the usually best first.
pub(crate) const CRITERIA: [Criterion; 7] = [
    Criterion::Area,
    Criterion::HullArea,
    Criterion::Length,
    Criterion::Diagonal,
    Criterion::Width,
    Criterion::Perimeter,
    Criterion::Hollow,
];

/// All copies, greatest first; equal ones in the order given.
pub(crate) fn ordered(items: &[Item], criterion: Criterion) -> Vec<Copy> {
    let mut ranked: Vec<(f64, usize)> = items
        .iter()
        .enumerate()
        .map(|(k, item)| (measure(item, criterion), k))
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let copies = |&(_, k): &(f64, usize)| (0..items[k].quantity).map(move |copy| (k, copy));
    ranked.iter().flat_map(copies).collect()
}

fn measure(item: &Item, criterion: Criterion) -> f64 {
    // Along the grain: the box in the orientation the piece will have.
    let size = item.outline.rotated(-item.grain).bounds().size();
    let hull = || Polygon::new(convex_hull(&item.outline.outer)).area();
    match criterion {
        Criterion::Area => item.outline.area(),
        Criterion::HullArea => hull(),
        Criterion::Length => size.x,
        Criterion::Width => size.y,
        Criterion::Perimeter => item.outline.perimeter(),
        Criterion::Diagonal => size.norm(),
        Criterion::Hollow => hull() * (2.0 - item.outline.area() / hull()),
    }
}

/// Numbers that look random and are the same on every run (Steele, Lea and Flood 2014,
/// SplitMix64).
pub(crate) struct Sequence(pub u64);

impl Sequence {
    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}

/// The order with one copy moved to another's place.
pub(crate) fn shuffled(order: &[Copy], sequence: &mut Sequence) -> Vec<Copy> {
    let mut order = order.to_vec();
    let (from, to) = (sequence.below(order.len()), sequence.below(order.len()));
    if sequence.below(2) == 0 {
        order.swap(from, to);
    } else {
        let moved = order.remove(from);
        order.insert(to.min(order.len()), moved);
    }
    order
}
