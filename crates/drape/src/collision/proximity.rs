//! Places where cloth is near cloth.

use super::nearness::{Nearness, is_far, passes_by};
use super::reach::Reach;
use super::separation_filter::SeparationFilter;
use super::surface::{ClothSurface, Near};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Neighbours are looked for at this many times the distance that they keep.
const NEIGHBOURS_REACH: f64 = 2.0;

/// Every pair of features within its reach, of those that are near, sorted. Features of triangles that
/// share a vertex and are not folded against each other by more than a right angle count only where they
/// come nearer than neighbours do.
pub fn nearnesses<'a>(
    surface: &ClothSurface,
    near: impl Into<Near<'a>>,
    x: &[Vec3],
    reach: &Reach,
) -> Vec<Nearness> {
    let normal = |t: u32| {
        let [a, b, c] = surface.triangles[t as usize].map(|v| x[v as usize]);
        (b - a).cross(&(c - a))
    };
    let filter = SeparationFilter::still(x, reach.most);
    let mut found = surface.filtered(near, Some(&filter), |pair, owners, found| {
        let p = pair.vertices().map(|v| x[v as usize]);
        if is_far(pair, &p, reach.most) || passes_by(pair, &p) {
            return;
        }
        let reach = reach.of(pair);
        let neighbours = surface.adjacent(owners) && {
            let [n, m] = owners.map(normal);
            n.dot(&m) > 0.0
        };
        let reach = match neighbours {
            true => NEIGHBOURS_REACH * surface.kept(pair, true, reach / NEIGHBOURS_REACH),
            false => reach,
        };
        let near = Nearness::measured(pair, &p, reach);
        found.extend(near.map(|near| Nearness { neighbours, ..near }));
    });
    found.par_sort_unstable_by_key(|near| near.pair);
    found
}
