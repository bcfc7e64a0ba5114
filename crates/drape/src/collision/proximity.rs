//! Proximities: pairs of features within their reach, measured.

use super::candidate_search::Near;
use super::nearness::{Nearness, is_far, passes_by};
use super::reach::Reach;
use super::separation_filter::SeparationFilter;
use super::surface::ClothSurface;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Neighbours are measured within this many times their contact offset.
const NEIGHBOURS_REACH: f64 = 2.0;

/// All candidate pairs whose features are within their reach at positions `x`, sorted. Pairs of neighbours, whose
/// triangles share a vertex and are not folded against each other by more than a right angle, have a shorter reach.
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
    let filter = SeparationFilter::still(x, reach.max);
    let mut found = surface.filtered(near, Some(&filter), |pair, owners, found| {
        let p = pair.vertices().map(|v| x[v as usize]);
        if is_far(pair, &p, reach.max) || passes_by(pair, &p) {
            return;
        }
        let reach = reach.of(pair);
        let neighbours = surface.adjacent(owners) && {
            let [n, m] = owners.map(normal);
            n.dot(&m) > 0.0
        };
        let reach = match neighbours {
            true => NEIGHBOURS_REACH * surface.contact_offset(pair, true, reach / NEIGHBOURS_REACH),
            false => reach,
        };
        let near = Nearness::measured(pair, &p, reach);
        found.extend(near.map(|near| Nearness { neighbours, ..near }));
    });
    found.par_sort_unstable_by_key(|near| near.pair);
    found
}
