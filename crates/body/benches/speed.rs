//! Times of the mannequin on one core, the best of some repeats: wall time wavers, the best less.
//!
//! `cargo bench -p toile-body --bench speed`
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[allow(dead_code)]
#[path = "../tests/suite/common/mod.rs"]
mod common;

use common::freesewing::freesewing;
use std::hint::black_box;
use std::time::Instant;
use toile_body::{Clip, Figure, Mannequin, template_skin};
use toile_geometry::{SurfaceTree, Vec3};
use toile_measure::{Measurements, Origin};

/// Best and middle time of some repeats (ms).
fn timed(name: &str, repeats: usize, mut work: impl FnMut(usize)) {
    let mut times: Vec<f64> = (0..repeats)
        .map(|k| {
            let start = Instant::now();
            work(k);
            1e3 * start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let [best, middle] = [times[0], times[repeats / 2]];
    println!("{name}: best {best:.3} ms, median {middle:.3} ms of {repeats}");
}

/// Women of different sizes, all with the measurements of a garment.
fn sized(k: usize) -> Measurements {
    let average = Measurements::adult_woman();
    let mut table = Measurements::new();
    for (name, measured) in average.iter() {
        let share = 1.0 + 0.01 * ((k * 7) % 11) as f64 - 0.05;
        table
            .set(name, measured.value * share, Origin::Asked)
            .unwrap();
    }
    let bust = average.get("bust").unwrap() * (0.95 + 0.01 * ((k * 3) % 13) as f64);
    table.set("bust", bust, Origin::Asked).unwrap();
    table
}

fn measure() {
    let skin = template_skin(Figure::Woman).unwrap();
    println!(
        "{} vertices, {} triangles",
        skin.positions.len(),
        skin.triangles.len()
    );
    timed("skin from primitives", 15, |_| {
        black_box(template_skin(Figure::Woman).unwrap());
    });
    timed("size solve, all garment measurements", 25, |k| {
        black_box(Mannequin::new(&sized(k), Figure::Woman).unwrap());
    });
    timed("size solve, height, bust, waist and hips", 25, |k| {
        let full = sized(k);
        let mut table = Measurements::new();
        for name in ["height", "bust", "waist", "hips"] {
            table
                .set(name, full.get(name).unwrap(), Origin::Asked)
                .unwrap();
        }
        black_box(Mannequin::new(&table, Figure::Woman).unwrap());
    });
    let sets = freesewing();
    if !sets.is_empty() {
        timed("size solve, the sets of FreeSewing", 2 * sets.len(), |k| {
            let (_, figure, table) = &sets[k % sets.len()];
            black_box(Mannequin::new(table, *figure).unwrap());
        });
    }
    let body = Mannequin::new(&sized(0), Figure::Woman).unwrap();
    let walk = Clip::walk(body.skeleton());
    timed("skinning made", 1, |_| {
        black_box(body.shares(0));
    });
    timed("primitives fitted to the skin", 1, |_| {
        black_box(body.primitives().len());
    });
    timed("skin posed", 40, |k| {
        let pose = walk.pose_for(body.skeleton(), 0.03 * k as f64);
        black_box(body.posed_skin(&pose));
    });
    timed("box tree of the skin", 5, |_| {
        black_box(SurfaceTree::new(body.skin().clone()));
    });
    let tree = SurfaceTree::new(body.skin().clone());
    timed("self-intersections counted", 5, |_| {
        black_box(tree.self_intersections());
    });
    let points: Vec<Vec3> = body.skin().positions.iter().map(|p| p * 1.01).collect();
    timed("closest point of every vertex", 3, |_| {
        for &p in &points {
            black_box(body.closest_point(p));
        }
    });
}

fn main() {
    // One thread, as the figures say.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(measure);
}
