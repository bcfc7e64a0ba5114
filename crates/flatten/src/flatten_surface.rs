//! A region of a surface to its panel: meshed anew, flattened, and its darts cut straight.

use crate::search::{LEGS_APART, darts_are_clear};
use crate::{FlattenError, Flattened, MAX_EDGE, Options, SurfaceRegion, flatten};

/// Largest energy of darts cut straight over that of darts along edges, for the straight ones to be kept (1).
const MAX_COST: f64 = 1.1;

/// Length of the edges on which darts are looked for, over the length that is asked for (1).
const COARSE: f64 = 1.6;

/// Flattens a region with triangles of about a length of edges (m). Its lines are cut first. Darts that are found along
/// edges of the mesh are drawn again as shortest paths, and the region is meshed along them, so that their legs are straight.
///
/// # Errors
/// The region is no disk, the grain is square to it, or a number cannot be used.
pub fn flatten_surface(
    region: &SurfaceRegion,
    edge: f64,
    options: &Options,
) -> Result<Flattened, FlattenError> {
    let drawn = region.cuts().len();
    if options.darts == 0 {
        return flatten_drawn(region, edge, options);
    }
    // Where darts lie is found on large triangles.
    let coarse = flatten_drawn(region, (COARSE * edge).min(MAX_EDGE), options)?;
    let has_darts = coarse.darts.len() > drawn;
    let straight = (has_darts || coarse.strain <= options.strain)
        .then(|| straightened(region, edge, options, &coarse))
        .flatten();
    if let Some(straight) =
        straight.filter(|s| s.minimum.energy <= MAX_COST * coarse.minimum.energy)
    {
        return Ok(Flattened {
            before: coarse.before,
            ..straight
        });
    }
    let found = flatten_drawn(region, edge, options)?;
    if found.darts.len() == drawn {
        return Ok(found);
    }
    match straightened(region, edge, options, &found) {
        Some(straight) if straight.minimum.energy <= MAX_COST * found.minimum.energy => {
            Ok(Flattened {
                before: found.before,
                ..straight
            })
        }
        Some(_) | None => Ok(found),
    }
}

fn flatten_drawn(
    region: &SurfaceRegion,
    edge: f64,
    options: &Options,
) -> Result<Flattened, FlattenError> {
    let meshed = region.remeshed(edge)?;
    let cuts = meshed.cuts;
    flatten(
        &meshed.mesh,
        &Options {
            cuts,
            ..options.clone()
        },
    )
}

/// The panel with the darts that were found drawn straight; none where one of them cannot be drawn.
fn straightened(
    region: &SurfaceRegion,
    edge: f64,
    options: &Options,
    found: &Flattened,
) -> Option<Flattened> {
    let mut cut = region.clone();
    let drawn = region.cuts().len();
    for (k, dart) in found.darts.iter().enumerate().skip(drawn) {
        let place = |v: &u32| found.region.mesh().positions[*v as usize];
        let line = [place(dart.left.first()?), place(dart.left.last()?)];
        cut.cut(&line, k + 1).ok()?;
    }
    let options = Options {
        darts: 0,
        ..options.clone()
    };
    let flat = flatten_drawn(&cut, edge, &options).ok()?;
    let panel = (&flat.region, &*flat.places);
    let mut found_darts = flat.darts.iter().skip(drawn);
    let is_dart = !found_darts.any(|dart| dart.overlaps(&flat.places));
    (is_dart && darts_are_clear(panel, &flat.darts, LEGS_APART[1])).then_some(flat)
}
