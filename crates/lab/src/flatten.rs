//! Times of flattening: a patch of a sphere with its darts searched for, and a region cut out of a ball.

use crate::LabError;
use crate::clock::Clock;
use crate::timed::Timed;
use std::fmt::Display;
use toile_drape::laws::stretch::MembraneLaw;
use toile_flatten::{Options, SurfaceLoop, cut_out, flatten, flatten_surface};
use toile_geometry::{TriangleMesh, Vec3};

/// Cells along a side of the patch.
const CELLS: usize = 24;

/// Radius of the sphere (m).
const RADIUS: f64 = 0.1;

/// Length of the edges of the region (m).
const EDGE: f64 = 4e-3;

/// A patch of 60 by 60 degrees with at most four darts within 3 %; then half as large a region of a larger patch, cut out,
/// meshed anew and flattened.
pub(crate) fn patches(result: &mut Timed) -> Result<(), LabError> {
    let mut options = Options {
        law: MembraneLaw::linear([600.0, 600.0, 120.0, 60.0]),
        grain: Vec3::y(),
        strain: 0.03,
        darts: 4,
        cuts: Vec::new(),
        stop: None,
    };
    let mesh = patch(60.0, CELLS);
    result.vertices = mesh.positions.len();
    let clock = Clock::start();
    let flat = flatten(&mesh, &options).map_err(failed)?;
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    options.darts = 0;
    let corner = |x: f64, y: f64| place(30.0 * x, 30.0 * y);
    let asked = SurfaceLoop {
        places: vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        ..SurfaceLoop::default()
    };
    let clock = Clock::start();
    let region = cut_out(&patch(120.0, 4 * CELLS), &asked).map_err(failed)?;
    let panel = flatten_surface(&region, EDGE, &options).map_err(failed)?;
    for (name, value) in [
        ("darts", flat.darts.len() as f64),
        ("steps", flat.minimum.steps as f64),
        ("energy_mj", 1e3 * flat.minimum.energy),
        ("region_s", clock.wall()),
        ("region_vertices", panel.region.vertex_count() as f64),
        ("region_energy_mj", 1e3 * panel.minimum.energy),
    ] {
        result.counted.insert(name.to_owned(), value);
    }
    Ok(())
}

fn failed(error: impl Display) -> LabError {
    LabError::Files {
        what: error.to_string(),
    }
}

/// A place on the sphere by longitude and latitude (degrees).
fn place(longitude: f64, latitude: f64) -> Vec3 {
    let (x, y) = (longitude.to_radians(), latitude.to_radians());
    Vec3::new(x.sin() * y.cos(), y.sin(), x.cos() * y.cos()) * RADIUS
}

/// A patch of the sphere between meridians and parallels, so many degrees each way.
fn patch(degrees: f64, cells: usize) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let share = |k: usize| degrees * (k as f64 / cells as f64 - 0.5);
    let at = |i: usize, j: usize| (j * (cells + 1) + i) as u32;
    for j in 0..=cells {
        for i in 0..=cells {
            mesh.positions.push(place(share(i), share(j)));
            if i < cells && j < cells {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                match (i + j) % 2 {
                    0 => mesh.triangles.extend([[a, b, c], [a, c, d]]),
                    _ => mesh.triangles.extend([[a, b, d], [b, c, d]]),
                }
            }
        }
    }
    mesh
}
