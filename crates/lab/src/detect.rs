//! Cost of contact of cloth with itself: of finding contacts on a smooth sheet of any fineness and on a worn shirt,
//! with and without the curvature test, and of contact in a frame of cloth that lies in folds.

use crate::chart_contact::fall;
use crate::clock::Clock;
use crate::scenes::card;
use crate::timed::Timed;
use crate::{LabError, MeshKind, rectangle, subdivided};
use toile_drape::collision::{
    Clearance, ClothSurface, ContactDetector, LinearTrajectories, Near, Reach, crossings,
    nearnesses,
};
use toile_drape::{Cloth, MethodKind, MethodSettings, State, System};
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// Contact offset (m), and the reach of queries for contacts (m).
const OFFSET: f64 = 2e-3;
const REACH: f64 = 2.0 * OFFSET;
/// Reach of queries for impacts on trajectories (m).
const IMPACT_REACH: f64 = 5e-4;
/// Number of queries timed, and of frames of 1/60 s.
const QUERIES: usize = 20;
const FRAMES: usize = 12;
const STEP: f64 = 1.0 / 60.0;
/// Substeps of a frame, as XPBD takes them when it is not told.
const SUBSTEPS: f64 = 20.0;

/// A gently waved sheet of a metre, `cells` by `cells`.
fn waved(cells: usize) -> Result<TriangleMesh, LabError> {
    let kind = MeshKind::Right;
    let flat = rectangle(kind, Vec2::zeros(), Vec2::repeat(1.0), [cells; 2])?;
    let place = |p: &Vec2| Vec3::new(p.x, 0.1 * (3.0 * p.x).sin() * (3.0 * p.y).sin(), p.y);
    Ok(TriangleMesh {
        positions: flat.points.iter().map(place).collect(),
        triangles: flat.triangles,
    })
}

/// Finds the near leaves of a smooth sheet, with a clearance that holds while vertices drift by a tenth of an edge.
pub(crate) fn sheet(cells: usize, result: &mut Timed) -> Result<(), LabError> {
    let mesh = waved(cells)?;
    result.vertices = mesh.positions.len();
    let mut surface = ClothSurface::of_mesh(&mesh);
    let edge = 1.0 / cells as f64;
    let clearance = Clearance {
        offset: 0.1 * edge,
        max_drift: 0.1 * edge,
    };
    let x = &mesh.positions;
    let mut counted = |name: &str, find: &mut dyn FnMut(&mut ClothSurface) -> usize| {
        let clock = Clock::start();
        let mut pairs = 0;
        for _ in 0..QUERIES {
            pairs = find(&mut surface);
        }
        let spent = [clock.wall(), clock.spent()];
        result.wall_s += spent[0];
        for (what, value) in [
            ("ms", 1e3 * spent[0] / QUERIES as f64),
            ("cpu_ms", 1e3 * spent[1] / QUERIES as f64),
            ("regions", surface.region_counts()[0] as f64),
            ("pairs", pairs as f64),
        ] {
            result.counted.insert(format!("{name}_{what}"), value);
        }
    };
    counted("all", &mut |surface| {
        surface
            .near_leaves(LinearTrajectories::still(x), edge)
            .len()
    });
    counted("curved", &mut |surface| {
        surface
            .near_leaves_unless_clear(LinearTrajectories::still(x), edge, clearance)
            .len()
    });
    Ok(())
}

/// Frames that the shirt settles in before its mesh is divided, and after, until it hangs still; drag of the
/// air then (1/s).
const SETTLED: [usize; 2] = [60, 180];
const SETTLING_DRAG: f64 = 10.0;
/// Turn of the worn shirt about the upright when it is set in motion (rad/s).
const TURN: f64 = 2.0;

/// Takes some frames of XPBD; what one takes (s), the looks for contacts in it, and its processor time (s).
fn frames(system: &System, state: &mut State, count: usize) -> Result<[f64; 3], LabError> {
    let mut method = MethodSettings::from(MethodKind::Xpbd).build()?;
    let clock = Clock::start();
    for _ in 0..count {
        method.advance(system, state, STEP)?;
    }
    let looks = method.cloth_tally().unwrap_or_default().looks;
    Ok([clock.wall(), looks as f64, clock.spent()].map(|sum| sum / count as f64))
}

/// The worn shirt, its mesh divided so many times.
fn worn(cuts: usize) -> Result<(System, State), LabError> {
    let card = card("shirt")?;
    let mut cloth: Cloth = card.cloth(0)?;
    let settled = |cloth: &Cloth, count: usize| -> Result<(System, State), LabError> {
        let (mut system, mut state) = card.system(cloth, &[])?;
        system = system.with(|builder| builder.contact.cloth_offset = OFFSET);
        system.control.air_drag = SETTLING_DRAG;
        frames(&system, &mut state, count)?;
        system.control.air_drag = 0.0;
        Ok((system, state))
    };
    let [coarse, fine] = SETTLED;
    let (system, state) = settled(&cloth, coarse)?;
    if cuts == 0 {
        return Ok((system, state));
    }
    cloth.positions = state.positions;
    for _ in 0..cuts {
        cloth = subdivided(&cloth);
    }
    settled(&cloth, fine)
}

/// Finds the contacts of the worn shirt with itself, its mesh divided so many times, and makes frames of
/// XPBD with them and without while the shirt turns about its wearer.
pub(crate) fn shirt(cuts: usize, result: &mut Timed) -> Result<(), LabError> {
    let (system, state) = worn(cuts)?;
    result.vertices = system.vertex_count();
    let mut surface = ClothSurface::new(&system);
    let (x, clearance) = (&state.positions, ContactDetector::clearance(OFFSET));
    let counted = &mut result.counted;
    let mut search = |name: &str, near: &mut dyn FnMut(&mut ClothSurface) -> Vec<[u32; 2]>| {
        let (clock, mut found) = (Clock::start(), [0; 3]);
        for _ in 0..QUERIES {
            let near = near(&mut surface);
            let touching = nearnesses(&surface, &near, x, &Reach::uniform(REACH)).len();
            found = [near.len(), touching, crossings(&surface, &near, x).len()];
        }
        for (what, value) in [
            ("ms", 1e3 * clock.wall() / QUERIES as f64),
            ("cpu_ms", 1e3 * clock.spent() / QUERIES as f64),
            ("regions", surface.region_counts()[0] as f64),
            ("pairs", found[0] as f64),
            ("contacts", found[1] as f64),
            ("crossings", found[2] as f64),
        ] {
            counted.insert(format!("{name}_{what}"), value);
        }
    };
    search("all", &mut |surface| {
        surface.near_leaves(LinearTrajectories::still(x), REACH)
    });
    search("curved", &mut |surface| {
        surface.near_leaves_unless_clear(LinearTrajectories::still(x), REACH, clearance)
    });
    for (name, turn) in [("worn", 0.0), ("turning", TURN)] {
        let mut start = state.clone();
        let upright = Vec3::new(0.0, turn, 0.0);
        for (v, x) in start.velocities.iter_mut().zip(&start.positions) {
            *v += upright.cross(x);
        }
        let clock = Clock::start();
        let (mut with, mut without) = (start.clone(), start.clone());
        let free = system.with(|builder| builder.contact.cloth_offset = 0.0);
        let [plain, _, plain_cpu] = frames(&free, &mut without, FRAMES)?;
        let [frame, looks, frame_cpu] = frames(&system, &mut with, FRAMES)?;
        // The same motion again, for what looking alone takes.
        let mut path = vec![start.positions.clone()];
        let mut method = MethodSettings {
            substeps: Some((SUBSTEPS / looks).round().max(1.0) as u32),
            ..MethodKind::Xpbd.into()
        }
        .build()?;
        for _ in 0..QUERIES {
            method.advance(&system, &mut start, STEP / looks)?;
            path.push(start.positions.clone());
        }
        let each = follow(&mut surface, &path);
        result.wall_s += clock.wall();
        for (what, value) in [
            ("frame_without_ms", 1e3 * plain),
            ("frame_without_cpu_ms", 1e3 * plain_cpu),
            ("frame_ms", 1e3 * frame),
            ("frame_cpu_ms", 1e3 * frame_cpu),
            ("looks_a_frame", looks),
            ("look_ms", 1e3 * each[0]),
            ("look_regions", each[1]),
            ("look_contours", each[2]),
            ("detection_percent", 100.0 * each[0] * looks / frame),
        ] {
            result.counted.insert(format!("{name}_{what}"), value);
        }
    }
    Ok(())
}

/// Finds contacts and crossings at the positions of a path. Returns means over its steps: time (s), number of regions
/// opened, and number of regions given the curvature test.
fn follow(surface: &mut ClothSurface, path: &[Vec<Vec3>]) -> [f64; 3] {
    let clearance = ContactDetector::clearance(OFFSET);
    let [of_impacts, of_contacts] = [IMPACT_REACH, REACH].map(Reach::uniform);
    let mut opened = [0; 2];
    surface.query(LinearTrajectories::still(&path[0]), &of_contacts, clearance);
    let clock = Clock::start();
    for ends in path.windows(2) {
        let still = LinearTrajectories::still(&ends[1]);
        for (trajectories, reach) in [
            (
                LinearTrajectories::together(&ends[0], &ends[1]),
                &of_impacts,
            ),
            (still, &of_contacts),
        ] {
            surface.query(trajectories, reach, clearance);
            std::hint::black_box(nearnesses(surface, Near::Listed, trajectories.from, reach));
            let [regions, contours] = surface.region_counts();
            opened = [opened[0] + regions, opened[1] + contours];
        }
        std::hint::black_box(crossings(surface, Near::Listed, still.from));
    }
    let count = (path.len() - 1) as f64;
    [
        clock.wall() / count,
        opened[0] as f64 / count,
        opened[1] as f64 / count,
    ]
}

/// What contact adds to a frame of a fallen sheet of so many cells along its metre, beside one step of
/// deformation by implicit Euler.
pub(crate) fn cost(cells: usize, result: &mut Timed) -> Result<(), LabError> {
    let (system, mut state) = fall(1.0, cells)?;
    let free = system.with(|builder| builder.contact.cloth_offset = 0.0);
    let system = system.with(|builder| builder.contact.cloth_offset = OFFSET);
    result.vertices = system.vertex_count();
    let clock = Clock::start();
    // Until much of it lies in folds.
    frames(&system, &mut state, 30)?;
    let with = 1e3 * frames(&system, &mut state.clone(), FRAMES)?[0];
    let without = 1e3 * frames(&free, &mut state.clone(), FRAMES)?[0];
    let mut method = MethodSettings::from(MethodKind::ImplicitEuler).build()?;
    let step = Clock::start();
    method.advance(&free, &mut state, STEP)?;
    let implicit = 1e3 * step.wall();
    result.wall_s = clock.wall();
    for (name, value) in [
        ("frame_with_ms", with),
        ("frame_without_ms", without),
        ("contact_adds_ms", with - without),
        ("implicit_step_ms", implicit),
    ] {
        result.counted.insert(name.to_owned(), value);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_worn_shirt_comes_to_rest_under_xpbd_with_few_substeps() {
        let card = card("shirt").expect("the card");
        let cloth = card.cloth(0).expect("its cloth");
        let (mut system, mut state) = card.system(&cloth, &[]).expect("a model");
        system.control.air_drag = SETTLING_DRAG;
        let mut method = MethodSettings {
            substeps: Some(4),
            ..MethodKind::Xpbd.into()
        }
        .build()
        .expect("a method");
        for _ in 0..120 {
            method.advance(&system, &mut state, STEP).expect("a step");
        }
        let speeds = state.velocities.iter().map(Vec3::norm);
        let fastest = speeds.fold(0.0, f64::max);
        assert!(fastest < 0.05, "{fastest} m/s after two seconds");
    }
}
