//! The next dart: from evenly spaced places of the outline towards the peak of energy and the deepest place inside, each
//! tried by a short descent, the one of least energy taken.

use crate::dart::{Opened, open, shortest_ways, way_to};
use crate::{Dart, FlattenError, Grain, Options, Region, RestEnergy, minimise};
use toile_geometry::{Polygon, Vec2, Vec3, closest_on_segment, segment_distance, segments_cross};

/// Places of the outline that are tried.
const MOUTHS: usize = 20;

/// Shares of the way to the target at which the apex is tried (1).
const DEPTHS: [f64; 4] = [0.45, 0.6, 0.75, 0.9];

/// Index in [`DEPTHS`] with which mouths are compared.
const FIRST_DEPTH: usize = 2;

/// Steps of a short descent.
const SHORT_STEPS: usize = 8;

/// Least distance of a mouth from corners of the outline and from other mouths, as a share of the outline's length (1).
const APART: f64 = 0.04;

/// Least distance of the mouths of darts that are followed up, as a share of the outline's length (1).
const MOUTHS_APART: f64 = 0.08;

/// Turn of the outline that makes a corner (rad).
const CORNER: f64 = 0.5;

/// Least decrease of the energy for which a dart is cut, as a share of it (1).
const MIN_GAIN: f64 = 0.02;

/// Largest distance of a cut from the straight line between its ends on the panel, as a share of its length: the legs of
/// a dart are sewn straight (1).
const MAX_BOW: f64 = 0.12;

/// Least distance of the straight legs of darts from those of others and of an apex from the outline, as a share of the
/// outline's length, when a dart is chosen (1).
const APART_CHOSEN: f64 = 0.008;

/// The same once the shape is at rest (1).
pub const APART_AT_REST: f64 = 0.004;

/// A surface with its flat shape and darts.
pub struct State {
    pub region: Region,
    pub places: Vec<Vec2>,
    pub darts: Vec<Dart>,
}

impl State {
    /// Whether the darts after `drawn` others can be sewn, as [`can_be_sewn`] says.
    pub fn can_be_sewn(&self, drawn: usize, share: f64) -> bool {
        can_be_sewn((&self.region, &self.places), &self.darts, drawn, share)
    }

    /// The state with one more dart; the flat shape is the same, closed.
    pub fn opened(&self, path: &[u32]) -> Result<Self, FlattenError> {
        let Opened {
            region,
            left,
            right,
        } = open(&self.region, path, self.darts.len())?;
        let mut places = self.places.clone();
        places.extend(
            path[..path.len() - 1]
                .iter()
                .map(|&v| self.places[v as usize]),
        );
        let mut darts = self.darts.clone();
        darts.push(Dart { left, right });
        Ok(Self {
            region,
            places,
            darts,
        })
    }
}

/// Whether the darts that were found, all after `drawn` others, can be sewn with straight legs: their sides do not overlap, they
/// keep clear of other darts and of the outline by a share of its length, and the outline with their mouths is simple.
pub fn can_be_sewn(
    (region, places): (&Region, &[Vec2]),
    darts: &[Dart],
    drawn: usize,
    share: f64,
) -> bool {
    let found = &darts[drawn.min(darts.len())..];
    if found.iter().any(|dart| dart.overlaps(places)) {
        return false;
    }
    let mut in_dart = vec![false; places.len()];
    let mut is_leg = vec![false; places.len()];
    for dart in darts {
        for leg in [&dart.left, &dart.right] {
            leg.iter().for_each(|&v| in_dart[v as usize] = true);
            leg.iter().skip(1).for_each(|&v| is_leg[v as usize] = true);
        }
    }
    let outline = region.outline();
    // The outline with the mouths as its edges, as the panel has it; sides of a drawn cut that overlap stay part of it.
    if !darts[..drawn].iter().any(|dart| dart.overlaps(places)) {
        let ring = outline.iter().filter(|&&v| !is_leg[v as usize]);
        if !Polygon::new(ring.map(|&v| places[v as usize]).collect()).is_simple() {
            return false;
        }
    }
    let next = outline.iter().cycle().skip(1);
    // Edges that end at a mouth touch its legs.
    let edges = outline.iter().zip(next).filter_map(|(&a, &b)| {
        let is_free = !in_dart[a as usize] && !in_dart[b as usize];
        is_free.then(|| [a, b].map(|v| places[v as usize]))
    });
    let edges: Vec<[Vec2; 2]> = edges.collect();
    let length: f64 = edges.iter().map(|[a, b]| (b - a).norm()).sum();
    let near = share * length;
    let legs = darts.iter().map(|dart| dart.straight_legs(places));
    let legs: Vec<Vec<[Vec2; 2]>> = legs.collect();
    let is_apart = |own: &[[Vec2; 2]], other: &[[Vec2; 2]]| {
        let mut pairs = own.iter().flat_map(|a| other.iter().map(move |b| (*a, *b)));
        pairs.all(|(a, b)| segment_distance(a, b) > near)
    };
    let is_inside = |[mouth, apex]: [Vec2; 2]| {
        let on = (apex - mouth).try_normalize(0.0).unwrap_or_default();
        let leg = [mouth, apex + on * near];
        edges.iter().all(|&edge| !segments_cross(leg, edge))
    };
    (drawn..legs.len()).all(|k| {
        legs[k].iter().all(|&leg| is_inside(leg))
            && legs[..k].iter().all(|other| is_apart(&legs[k], other))
    })
}

/// A dart that was tried.
struct Trial {
    energy: f64,
    /// The state with the dart, not yet at rest.
    state: State,
    /// The whole way from the mouth to the target, of which the dart is the first part.
    way: Vec<u32>,
}

/// The states with one more dart each that lower the energy most, not yet at rest, the best first; none where none is worth it.
/// Their mouths lie apart.
///
/// # Errors
/// The triangles are too thin.
pub fn next_darts(
    state: &State,
    options: &Options,
    energy: f64,
    most: usize,
) -> Result<Vec<State>, FlattenError> {
    let mesh = state.region.mesh();
    let mut barred = vec![false; mesh.positions.len()];
    for &v in state.region.outline() {
        barred[v as usize] = true;
    }
    let try_path = |path: &[u32], way: &[u32]| {
        options.go_on()?;
        let mut trial = state.opened(path)?;
        let grain = Grain::new(&trial.region, options.grain)?;
        let law = RestEnergy::new(&trial.region, options.law);
        let found = minimise(&law, &grain, &mut trial.places, SHORT_STEPS)?;
        if !trial.can_be_sewn(options.cuts.len(), APART_CHOSEN) {
            return Ok(None);
        }
        Ok::<_, FlattenError>(Some(Trial {
            energy: found.energy,
            state: trial,
            way: way.to_vec(),
        }))
    };
    let mut trials: Vec<Trial> = Vec::new();
    for target in targets(state, options, &barred) {
        let (_, before) = ways_inside(mesh, target, &barred);
        for mouth in mouths(state) {
            let mut way = way_to(&before, mouth);
            way.reverse();
            let path = cut_short(&mesh.positions, &way, DEPTHS[FIRST_DEPTH]);
            if let Some(path) = path.filter(|path| is_straight(&state.places, path)) {
                trials.extend(try_path(path, &way)?);
            }
        }
    }
    trials.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    let mouth = |trial: &Trial| state.places[trial.way[0] as usize];
    let apart = MOUTHS_APART * along_outline(state)[state.region.outline().len()];
    let mut chosen: Vec<Trial> = Vec::new();
    for trial in trials {
        let is_apart = |other: &Trial| (mouth(other) - mouth(&trial)).norm() > apart;
        if chosen.len() < most && chosen.iter().all(is_apart) {
            chosen.push(trial);
        }
    }
    for trial in &mut chosen {
        let way = trial.way.clone();
        for (k, depth) in DEPTHS.into_iter().enumerate() {
            let path = cut_short(&mesh.positions, &way, depth).filter(|_| k != FIRST_DEPTH);
            let other = path.map(|path| try_path(path, &way)).transpose()?.flatten();
            if let Some(other) = other.filter(|other| other.energy < trial.energy) {
                *trial = other;
            }
        }
    }
    chosen.retain(|trial| trial.energy < (1.0 - MIN_GAIN) * energy);
    chosen.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    Ok(chosen.into_iter().map(|trial| trial.state).collect())
}

/// For each vertex of the outline, its way along that from the first one on the panel, and the whole length last (m).
fn along_outline(state: &State) -> Vec<f64> {
    let outline = state.region.outline();
    let place = |k: usize| state.places[outline[k % outline.len()] as usize];
    let mut along = vec![0.0];
    for k in 0..outline.len() {
        along.push(along[k] + (place(k + 1) - place(k)).norm());
    }
    along
}

/// The vertex inside with the most energy about it, and the one deepest inside.
fn targets(state: &State, options: &Options, barred: &[bool]) -> Vec<u32> {
    let mesh = state.region.mesh();
    let densities = RestEnergy::new(&state.region, options.law).densities(&state.places);
    let mut about = vec![(0.0, 0u32); mesh.positions.len()];
    for (triangle, density) in mesh.triangles.iter().zip(densities) {
        for &v in triangle {
            about[v as usize].0 += density;
            about[v as usize].1 += 1;
        }
    }
    let (depths, _) = shortest_ways(
        mesh,
        state.region.outline(),
        &vec![false; mesh.positions.len()],
    );
    let mean = |v: u32| about[v as usize].0 / f64::from(about[v as usize].1.max(1));
    let inside = || (0..mesh.positions.len() as u32).filter(|&v| !barred[v as usize]);
    let deepest = inside().max_by(|&a, &b| depths[a as usize].total_cmp(&depths[b as usize]));
    let Some(deepest) = deepest else {
        return Vec::new();
    };
    // A dart to a peak beside the outline would be a notch.
    let far = 0.4 * depths[deepest as usize];
    let peak = inside()
        .filter(|&v| depths[v as usize] >= far)
        .max_by(|&a, &b| mean(a).total_cmp(&mean(b)));
    let mut targets = vec![deepest];
    targets.extend(peak.filter(|&peak| peak != deepest));
    targets
}

/// Shortest ways from a target through the inside; vertices of the outline are reached and not passed.
fn ways_inside(
    mesh: &toile_geometry::TriangleMesh,
    target: u32,
    barred: &[bool],
) -> (Vec<f64>, Vec<Option<u32>>) {
    let (mut lengths, mut before) = shortest_ways(mesh, &[target], barred);
    let distance = |a: u32, b: u32| {
        let way: Vec3 = mesh.positions[a as usize] - mesh.positions[b as usize];
        way.norm()
    };
    for &[a, b] in &mesh.topology().edges {
        for (inside, mouth) in [(a, b), (b, a)] {
            let way = lengths[inside as usize] + distance(a, b);
            if barred[mouth as usize] && !barred[inside as usize] && way < lengths[mouth as usize] {
                lengths[mouth as usize] = way;
                before[mouth as usize] = Some(inside);
            }
        }
    }
    (lengths, before)
}

/// Places of the outline for a mouth: evenly spaced, away from corners, darts and their mouths.
fn mouths(state: &State) -> Vec<u32> {
    let outline = state.region.outline();
    let place = |k: usize| state.places[outline[k % outline.len()] as usize];
    let along = along_outline(state);
    let whole = along[outline.len()];
    let in_dart = |v: u32| {
        let mut darts = state.darts.iter();
        darts.any(|d| d.left.contains(&v) || d.right.contains(&v))
    };
    let is_taken = |k: usize| {
        let (before, after) = (
            place(k) - place(k + outline.len() - 1),
            place(k + 1) - place(k),
        );
        before.angle(&after) > CORNER || in_dart(outline[k])
    };
    let taken: Vec<f64> = (0..outline.len())
        .filter(|&k| is_taken(k))
        .map(|k| along[k])
        .collect();
    let free = |at: f64| {
        taken.iter().all(|&other| {
            let apart = (at - other).abs();
            apart.min(whole - apart) > APART * whole
        })
    };
    let mut mouths = Vec::new();
    for step in 0..MOUTHS {
        let wanted = whole * (step as f64 + 0.5) / MOUTHS as f64;
        let k = along.partition_point(|&at| at < wanted);
        if k < outline.len() && free(along[k]) && !mouths.contains(&outline[k]) {
            mouths.push(outline[k]);
        }
    }
    mouths
}

/// Whether a path is near the straight line between its ends on the panel.
fn is_straight(places: &[Vec2], path: &[u32]) -> bool {
    let (Some(&first), Some(&last)) = (path.first(), path.last()) else {
        return false;
    };
    let line = [places[first as usize], places[last as usize]];
    let most = MAX_BOW * (line[1] - line[0]).norm();
    path.iter().all(|&v| {
        let place = places[v as usize];
        (place - closest_on_segment(place, line)).norm() <= most
    })
}

/// The first part of a way, as near to a share of its length as its vertices allow.
fn cut_short<'a>(positions: &[Vec3], way: &'a [u32], share: f64) -> Option<&'a [u32]> {
    let mut along = vec![0.0];
    for pair in way.windows(2) {
        let side: Vec3 = positions[pair[1] as usize] - positions[pair[0] as usize];
        along.push(along[along.len() - 1] + side.norm());
    }
    let wanted = share * along[along.len() - 1];
    let nearest = (1..way.len()).min_by(|&a, &b| {
        (along[a] - wanted)
            .abs()
            .total_cmp(&(along[b] - wanted).abs())
    })?;
    Some(&way[..=nearest])
}
