//! A region of a surface to its panel: meshed anew, flattened, and its darts cut straight.

use crate::search::{APART_AT_REST, can_be_sewn};
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
    // Where darts lie is found on large triangles, if a region has enough of them.
    let coarse = match options.darts {
        0 => None,
        _ => flatten_drawn(region, (COARSE * edge).min(MAX_EDGE), options).ok(),
    };
    options.go_on()?;
    let coarse = coarse.filter(|found| found.darts.len() > drawn);
    if let Some(flat) = coarse.and_then(|found| drawn_straight(region, edge, options, &found)) {
        return Ok(flat);
    }
    let found = flatten_drawn(region, edge, options)?;
    if found.darts.len() == drawn {
        return Ok(found);
    }
    Ok(drawn_straight(region, edge, options, &found).unwrap_or(found))
}

/// The panel with the darts that were found drawn straight, if that costs little and loses no limit that was kept.
fn drawn_straight(
    region: &SurfaceRegion,
    edge: f64,
    options: &Options,
    found: &Flattened,
) -> Option<Flattened> {
    let straight = straightened(region, edge, options, found)?;
    let keeps = straight.strain <= options.strain || found.strain > options.strain;
    (keeps && straight.minimum.energy <= MAX_COST * found.minimum.energy).then(|| Flattened {
        before: found.before.clone(),
        ..straight
    })
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
    can_be_sewn(panel, &flat.darts, drawn, APART_AT_REST).then_some(flat)
}
