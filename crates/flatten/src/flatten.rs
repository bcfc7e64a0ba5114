//! From a surface to its panel: start, least energy, darts until the stretch is within its limit.

use crate::conformal::{conformal, flipped};
use crate::dart::open;
use crate::search::{APART_AT_REST, State, next_darts};
use crate::tutte::tutte;
use crate::{
    Dart, FlattenError, Grain, MAX_STEPS, Minimum, Options, Region, RestEnergy, SHARE_WITHIN,
    Stretch, arap, minimise, stretch_of, stretch_quantile,
};
use toile_geometry::{TriangleMesh, Vec2};

/// First darts that are followed up.
const FOLLOWED: usize = 3;

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
    let state = State {
        region,
        places,
        darts,
    };
    let best = dressed(settled(state, Vec::new(), options)?, options)?;
    Ok(Flattened {
        region: best.state.region,
        places: best.state.places,
        darts: best.state.darts,
        stretch: best.stretch,
        strain: best.strain,
        minimum: best.minimum,
        before: best.before,
        from_tutte,
    })
}

/// A flat shape at rest.
struct Settled {
    state: State,
    minimum: Minimum,
    stretch: Vec<Stretch>,
    strain: f64,
    before: Vec<[f64; 2]>,
}

/// Adds darts until the stretch is within its limit, or no dart helps. One dart after another is chosen, and of the first
/// ones several are followed up, as the best one alone need not be the best of two.
fn dressed(first: Settled, options: &Options) -> Result<Settled, FlattenError> {
    let drawn = options.cuts.len();
    let rank = |shape: &Settled| (shape.strain > options.strain, shape.minimum.energy);
    let better = |a: Settled, b: Settled| {
        let (ranked, other) = (rank(&a), rank(&b));
        let order = ranked.0.cmp(&other.0).then(ranked.1.total_cmp(&other.1));
        if order.is_le() { a } else { b }
    };
    // Those that no further dart helps are ended; the best of them and of the last ones counts.
    let mut followed = vec![first];
    let mut ended = Vec::new();
    for number in 0..options.darts {
        let within = |shape: &Settled| shape.strain <= options.strain;
        if followed.is_empty() || followed.iter().any(within) {
            break;
        }
        let most = match number {
            0 if options.darts > 1 => FOLLOWED,
            _ => 1,
        };
        let mut longer = Vec::new();
        for shape in followed {
            let energy = shape.minimum.energy;
            let count = longer.len();
            for next in next_darts(&shape.state, options, energy, most)? {
                let mut before = shape.before.clone();
                before.push([energy, shape.strain]);
                let next = settled(next, before, options)?;
                if next.state.can_be_sewn(drawn, APART_AT_REST) {
                    longer.push(next);
                }
            }
            if longer.len() == count {
                ended.push(shape);
            }
        }
        followed = longer;
    }
    let best = followed.into_iter().chain(ended).reduce(better);
    best.ok_or(FlattenError::NoStart)
}

/// Brings a flat shape to rest.
fn settled(
    mut state: State,
    before: Vec<[f64; 2]>,
    options: &Options,
) -> Result<Settled, FlattenError> {
    let grain = Grain::new(&state.region, options.grain)?;
    let energy = RestEnergy::new(&state.region, options.law);
    let minimum = minimise(&energy, &grain, &mut state.places, MAX_STEPS)?;
    let stretch = stretch_of(&state.region, &state.places);
    let strain = stretch_quantile(&state.region, &stretch, SHARE_WITHIN);
    Ok(Settled {
        state,
        minimum,
        stretch,
        strain,
        before,
    })
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
