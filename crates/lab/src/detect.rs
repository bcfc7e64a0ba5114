//! What finding contacts of cloth with itself costs: on a smooth sheet however fine, and on a worn
//! shirt, with regions left out by their curvature and with all looked into.

use crate::bench::Timed;
use crate::clock::Clock;
use crate::scenes::card;
use crate::{LabError, subdivided};
use toile_drape::collision::{ClothContacts, ClothSurface, crossings, nearnesses};
use toile_drape::{Cloth, MethodKind, MethodSettings};
use toile_geometry::{TriangleMesh, Vec3};

/// Distance that cloth keeps from cloth [m], and how far it is looked.
const OFFSET: f64 = 2e-3;
const REACH: f64 = 2.0 * OFFSET;
/// Looks timed, and frames of 1/60 s.
const LOOKS: usize = 20;
const FRAMES: usize = 12;

/// A gently waved sheet of a metre, `cells` by `cells`.
fn waved(cells: usize) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let share = |k: usize| k as f64 / cells as f64;
    for (i, j) in (0..(cells + 1) * (cells + 1)).map(|k| (k % (cells + 1), k / (cells + 1))) {
        let (u, v) = (share(i), share(j));
        let up = 0.1 * (3.0 * u).sin() * (3.0 * v).sin();
        mesh.positions.push(Vec3::new(u, up, v));
    }
    let at = |i: usize, j: usize| (j * (cells + 1) + i) as u32;
    for (i, j) in (0..cells * cells).map(|k| (k % cells, k / cells)) {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

/// Finds the near triangles of a smooth sheet again and again, vertices free to stray by a tenth of an
/// edge meanwhile.
pub(crate) fn sheet(cells: usize, result: &mut Timed) {
    let mesh = waved(cells);
    result.vertices = mesh.positions.len();
    let mut surface = ClothSurface::of_mesh(&mesh);
    let edge = 1.0 / cells as f64;
    let mut clearance = ClothContacts::clearance(0.1 * edge);
    clearance.stray = 0.1 * edge;
    let x = &mesh.positions;
    let mut counted = |name: &str, find: &mut dyn FnMut(&mut ClothSurface) -> usize| {
        let clock = Clock::start();
        let mut pairs = 0;
        for _ in 0..LOOKS {
            pairs = find(&mut surface);
        }
        let each = clock.wall() / LOOKS as f64;
        result.wall_s += each * LOOKS as f64;
        for (what, value) in [
            ("ms", 1e3 * each),
            ("regions", surface.opened() as f64),
            ("pairs", pairs as f64),
        ] {
            result.counted.insert(format!("{name}_{what}"), value);
        }
    };
    counted("all", &mut |surface| {
        surface.near_triangles(x, x, edge).len()
    });
    counted("curved", &mut |surface| {
        surface.near_unless_clear(x, x, edge, clearance).len()
    });
}

/// Finds the contacts of the worn shirt with itself, its mesh divided so many times, and makes frames of
/// XPBD with them and without.
pub(crate) fn shirt(cuts: usize, result: &mut Timed) -> Result<(), LabError> {
    let card = card("shirt")?;
    let mut cloth: Cloth = card.cloth(0)?;
    if let Some(worn) = card.reference(0)? {
        cloth.positions = worn
            .positions
            .iter()
            .map(|p| Vec3::from(p.map(f64::from)))
            .collect();
    }
    for _ in 0..cuts {
        cloth = subdivided(&cloth);
    }
    let (mut model, state) = card.model(&cloth, &[])?;
    result.vertices = model.vertex_count();
    let mut surface = ClothSurface::new(&model);
    let (x, clearance) = (&state.positions, ClothContacts::clearance(OFFSET));
    let mut look = |name: &str, near: &mut dyn FnMut(&mut ClothSurface) -> Vec<[u32; 2]>| {
        let (clock, mut found) = (Clock::start(), [0; 3]);
        for _ in 0..LOOKS {
            let near = near(&mut surface);
            let touching = nearnesses(&surface, &near, x, REACH).len();
            found = [near.len(), touching, crossings(&surface, &near, x).len()];
        }
        let each = 1e3 * clock.wall() / LOOKS as f64;
        for (what, value) in [
            ("ms", each),
            ("regions", surface.opened() as f64),
            ("pairs", found[0] as f64),
            ("contacts", found[1] as f64),
            ("crossings", found[2] as f64),
        ] {
            result.counted.insert(format!("{name}_{what}"), value);
        }
        each
    };
    let reach = REACH + 2.0 * clearance.stray;
    look("all", &mut |surface| surface.near_triangles(x, x, reach));
    let each = look("curved", &mut |surface| {
        surface.near_unless_clear(x, x, reach, clearance)
    });
    for (name, offset) in [("frame_without", 0.0), ("frame_with", OFFSET)] {
        model.contact.cloth_offset = offset;
        let mut method = MethodSettings::from(MethodKind::Xpbd).build();
        let mut state = state.clone();
        let step = 1.0 / 60.0;
        if let Err(error) = method.advance(&model, &mut state, step) {
            result.failure = Some(error.to_string());
            return Ok(());
        }
        let (clock, first) = (
            Clock::start(),
            method.cloth_tally().unwrap_or_default().looks,
        );
        for _ in 0..FRAMES {
            if let Err(error) = method.advance(&model, &mut state, step) {
                result.failure = Some(error.to_string());
                return Ok(());
            }
        }
        let frame = 1e3 * clock.wall() / FRAMES as f64;
        result.wall_s = clock.wall();
        result.cpu_s = clock.cpu();
        result.counted.insert(format!("{name}_ms"), frame);
        if offset > 0.0 {
            let looks = method.cloth_tally().unwrap_or_default().looks - first;
            let looks = looks as f64 / FRAMES as f64;
            result.counted.insert("looks_a_frame".to_owned(), looks);
            let share = 100.0 * each * looks / frame;
            result.counted.insert("detection_percent".to_owned(), share);
        }
    }
    Ok(())
}
