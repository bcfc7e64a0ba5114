//! How long a frame of XPBD takes: 20 substeps of 1/1200 s on sheets of some sizes, free and on a
//! floor, with one thread and two.
#![allow(missing_docs, clippy::print_stdout, clippy::unwrap_used)]

#[path = "../tests/suite/support/sheets.rs"]
mod sheets;

use sheets::sheet;
use std::sync::Arc;
use std::time::Instant;
use toile_drape::{Cloth, Collider, Material, State, System, SystemBuilder, Xpbd};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

fn bumpy(n: usize, cell: f64) -> TriangleMesh {
    let size = cell * n as f64;
    sheet([n, n], [size, size], |u, v| {
        let bump = 0.2 * cell * (9.0 * u + 7.0 * v).sin();
        Vec3::new(u, 6e-3 + bump, v)
    })
}

fn floor() -> Collider {
    let mesh = TriangleMesh {
        positions: vec![
            Vec3::new(-2.0, 0.0, -2.0),
            Vec3::new(-2.0, 0.0, 2.0),
            Vec3::new(2.0, 0.0, 2.0),
            Vec3::new(2.0, 0.0, -2.0),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    Collider::new(Arc::new(SurfaceTree::new(mesh)))
}

/// Milliseconds of a frame: what reading and writing a state takes, and twenty substeps. Found from
/// the least time of short runs, so that what other programs take is left out as far as can be.
fn time(system: &System, threads: usize, runs: usize) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut state = State::at_rest(system, sheet_positions(system));
        let mut solver = Xpbd::new(system);
        let mut least = [f64::INFINITY; 2];
        for _ in 0..runs {
            for (least, substeps) in least.iter_mut().zip([1, 4]) {
                let start = Instant::now();
                solver
                    .advance(system, &mut state, 1.0 / 1200.0, substeps, 0.1)
                    .unwrap();
                *least = least.min(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        least[0] + 19.0 * (least[1] - least[0]) / 3.0
    })
}

fn sheet_positions(system: &System) -> Vec<Vec3> {
    let n = (system.vertex_count() as f64).sqrt() as usize - 1;
    bumpy(n, 1.0 / n as f64).positions
}

fn main() {
    println!("vertices  triangles  scene       1 thread [ms]  2 threads [ms]  ratio  triangles/s");
    for n in [31, 99, 172] {
        for (name, bend, contact) in [
            ("hang", 1.5e-5, false),
            ("floor", 1.5e-5, true),
            ("stiff bend", 2e-3, false),
        ] {
            let material = Material {
                bend: [bend; 3],
                ..Material::default()
            };
            let cloth = Cloth::from_mesh("sheet", &bumpy(n, 1.0 / n as f64), material).unwrap();
            let mut builder = SystemBuilder::new("sheet", &cloth).unwrap();
            builder.pinned[0] = true;
            builder.pinned[n] = true;
            if contact {
                builder.colliders.push(floor());
            }
            let system = builder.build();
            let runs = (2_000_000 / system.vertex_count()).max(150);
            let (one, two) = (time(&system, 1, runs), time(&system, 2, runs));
            let triangles = system.topology.triangles.len();
            println!(
                "{:8}  {triangles:9}  {name:10}  {one:13.3}  {two:14.3}  {:5.2}  {:.2e}",
                system.vertex_count(),
                one / two,
                triangles as f64 * 20.0 / (two * 1e-3)
            );
        }
    }
}
