//! From a surface to its panel: start, least energy, darts until the stretch is within its limit.

use crate::conformal::{conformal, flipped};
use crate::dart::open;
use crate::search::{State, next_dart};
use crate::tutte::tutte;
use crate::{
    Dart, FlattenError, Grain, MAX_STEPS, Minimum, Options, Region, RestEnergy, SHARE_WITHIN,
    Stretch, arap, minimise, stretch_of, stretch_quantile,
};
use toile_geometry::{TriangleMesh, Vec2};

/// A panel.
#[derive(Clone, Debug)]
pub struct Flattened {
    /// The surface, opened along the darts.
    pub region: Region,
    /// Place of each vertex on the panel, the grain along +y (m).
    pub places: Vec<Vec2>,
    /// Stretch of each triangle from the panel to the surface.
    pub stretch: Vec<Stretch>,
    /// The size of stretch that is not exceeded on [`SHARE_WITHIN`] of the area (1).
    pub strain: f64,
    /// The end of the last descent.
    pub minimum: Minimum,
    /// Darts, in the order in which they were cut.
    pub darts: Vec<Dart>,
    /// Energy (J) and stretch (1) before each dart that was added.
    pub before: Vec<[f64; 2]>,
    /// Whether the start was Tutte's embedding, as the conformal map had flipped triangles.
    pub from_tutte: bool,
}

/// Flattens a mesh.
///
/// # Errors
/// The mesh is no disk, the grain is square to it, a number or a cut cannot be used.
pub fn flatten(mesh: &TriangleMesh, options: &Options) -> Result<Flattened, FlattenError> {
    flatten_region(Region::new(mesh)?, options)
}

/// Flattens a surface that is a disk.
///
/// # Errors
/// The grain is square to it, a number or a cut cannot be used.
pub fn flatten_region(region: Region, options: &Options) -> Result<Flattened, FlattenError> {
    check(options)?;
    let mut region = region;
    let mut darts = Vec::new();
    for (cut, path) in options.cuts.iter().enumerate() {
        let opened = open(&region, path, cut)?;
        region = opened.region;
        darts.push(Dart {
            left: opened.left,
            right: opened.right,
        });
    }
    let (places, from_tutte) = start(&region)?;
    let mut state = State {
        region,
        places,
        darts,
    };
    let mut before = Vec::new();
    let (mut minimum, mut stretch, mut strain) = settle(&mut state, options)?;
    while strain > options.strain && before.len() < options.darts {
        let Some(mut next) = next_dart(&state, options, minimum.energy)? else {
            break;
        };
        before.push([minimum.energy, strain]);
        (minimum, stretch, strain) = settle(&mut next, options)?;
        state = next;
    }
    Ok(Flattened {
        region: state.region,
        places: state.places,
        darts: state.darts,
        stretch,
        strain,
        minimum,
        before,
        from_tutte,
    })
}

/// Brings a flat shape to rest: the end of the descent, the stretch of each triangle, and its size on most of the area.
fn settle(
    state: &mut State,
    options: &Options,
) -> Result<(Minimum, Vec<Stretch>, f64), FlattenError> {
    let grain = Grain::new(&state.region, options.grain)?;
    let energy = RestEnergy::new(&state.region, options.law);
    let minimum = minimise(&energy, &grain, &mut state.places, MAX_STEPS)?;
    let stretch = stretch_of(&state.region, &state.places);
    let strain = stretch_quantile(&state.region, &stretch, SHARE_WITHIN);
    Ok((minimum, stretch, strain))
}

/// A flat shape without flipped triangles, and whether it began with Tutte's embedding.
fn start(region: &Region) -> Result<(Vec<Vec2>, bool), FlattenError> {
    let conformal = conformal(region).ok();
    let sound = conformal.filter(|flat| flipped(region, flat) == 0);
    let from_tutte = sound.is_none();
    let mut flat = match sound {
        Some(flat) => flat,
        None => tutte(region)?,
    };
    if flipped(region, &flat) > 0 {
        return Err(FlattenError::NoStart);
    }
    arap::arap(region, &mut flat, arap::STEPS)?;
    Ok((flat, from_tutte))
}

fn check(options: &Options) -> Result<(), FlattenError> {
    let number = |what, value, remedy| {
        Err(FlattenError::Number {
            what,
            value,
            remedy,
        })
    };
    if options.strain.is_nan() || options.strain <= 0.0 {
        let remedy = "give a share above zero, as 2%";
        return number("the limit of the stretch", options.strain, remedy);
    }
    let [c11, c22, c12, g] = options.law.stiffness;
    let sound = c11 > 0.0 && c22 > 0.0 && g > 0.0 && c11 * c22 > c12 * c12;
    if !sound || !(c11 + c22 + g).is_finite() {
        let remedy = "give a fabric whose stiffness is above zero in warp, weft and shear";
        return number(
            "the least stiffness of the fabric",
            c11.min(c22).min(g),
            remedy,
        );
    }
    Ok(())
}
