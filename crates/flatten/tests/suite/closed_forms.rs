//! Developable surfaces against their closed forms, the gradient against differences, random disks.

use crate::common::{self, grid, options};
use std::f64::consts::PI;
use toile_flatten::conformal::flipped;
use toile_flatten::{Flattened, Options, Region, RestEnergy, flatten, tutte::tutte};
use toile_geometry::{Rigid, TriangleMesh, Vec2, Vec3};

/// The largest distance of outline vertices from where they belong, after the rigid motion that fits best (m).
fn off(flat: &Flattened, exact: &[Vec2]) -> f64 {
    let outline = flat.region.outline();
    let places = || outline.iter().map(|&v| flat.places[v as usize]);
    let wanted = || outline.iter().map(|&v| exact[v as usize]);
    let count = outline.len() as f64;
    let (a, b) = (
        places().sum::<Vec2>() / count,
        wanted().sum::<Vec2>() / count,
    );
    let (cosine, sine) = places().zip(wanted()).fold((0.0, 0.0), |sum, (p, q)| {
        let (p, q) = (p - a, q - b);
        (sum.0 + p.dot(&q), sum.1 + p.perp(&q))
    });
    let angle = nalgebra::Rotation2::new(f64::atan2(sine, cosine));
    places()
        .zip(wanted())
        .map(|(p, q)| (angle * (p - a) - (q - b)).norm())
        .fold(0.0, f64::max)
}

fn area(flat: &Flattened) -> f64 {
    let triangles = flat.region.mesh().triangles.iter();
    triangles
        .map(|t| {
            let [a, b, c] = t.map(|v| flat.places[v as usize]);
            0.5 * (b - a).perp(&(c - a))
        })
        .sum()
}

/// A sheet of 20 by 20 cm on a cylinder of 10 cm, turned on it by an angle, and its flat shape.
fn cylinder(cells: usize, turn: f64) -> (TriangleMesh, Vec<Vec2>) {
    let flat = |u: f64, v: f64| Vec2::new(0.2 * u - 0.1, 0.2 * v - 0.1);
    let (sine, cosine) = turn.sin_cos();
    let place = |u: f64, v: f64| {
        let p = flat(u, v);
        let (x, y) = (cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
        Vec3::new(0.1 * (x / 0.1).sin(), y, 0.1 * (x / 0.1).cos())
    };
    let exact = grid(cells, cells, |u, v| {
        let p = flat(u, v);
        Vec3::new(p.x, p.y, 0.0)
    });
    (
        grid(cells, cells, place),
        exact.positions.iter().map(Vec3::xy).collect(),
    )
}

/// A square sheet of 20 cm on a cone, its middle 30 cm from the tip, turned by an angle, and its flat shape.
fn cone(cells: usize, turn: f64) -> (TriangleMesh, Vec<Vec2>) {
    // The sine of half the opening angle: a way around is that share of a full turn of the flat sector.
    let slope: f64 = 0.5;
    let (sine, cosine) = turn.sin_cos();
    let flat = |u: f64, v: f64| {
        let p = Vec2::new(0.2 * u - 0.1, 0.2 * v - 0.1);
        Vec2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y - 0.3)
    };
    let place = |u: f64, v: f64| {
        let p = flat(u, v);
        let (radius, angle) = (p.norm(), f64::atan2(p.x, -p.y) / slope);
        let round = radius * slope;
        Vec3::new(
            round * angle.sin(),
            -radius * (1.0 - slope * slope).sqrt(),
            round * angle.cos(),
        )
    };
    let exact = grid(cells, cells, |u, v| {
        let p = flat(u, v);
        Vec3::new(p.x, p.y, 0.0)
    });
    (
        grid(cells, cells, place),
        exact.positions.iter().map(Vec3::xy).collect(),
    )
}

#[test]
fn cylinders_and_cones_unroll_with_the_square_of_the_cell() {
    type Case = fn(usize, f64) -> (TriangleMesh, Vec<Vec2>);
    let cases: [(&str, Case, f64); 4] = [
        ("cylinder", cylinder, 0.0),
        ("cylinder turned", cylinder, 0.5),
        ("cone", cone, 0.0),
        ("cone turned", cone, 0.5),
    ];
    for (name, make, turn) in cases {
        let mut errors = Vec::new();
        for cells in [10, 20, 40] {
            let (mesh, exact) = make(cells, turn);
            let flat = flatten(&mesh, &options()).unwrap();
            assert_eq!(flipped(&flat.region, &flat.places), 0);
            errors.push([(area(&flat) / 0.04 - 1.0).abs(), off(&flat, &exact) / 0.2]);
        }
        println!("{name}: {errors:?}");
        for k in 0..2 {
            for pair in errors.windows(2) {
                let order = (pair[0][k] / pair[1][k]).log2();
                assert!(order >= 1.8, "{name}: order {order}");
            }
            assert!(errors[2][k] < 2e-4, "{name}: {}", errors[2][k]);
        }
    }
}

#[test]
fn the_gradient_is_the_slope_of_the_energy() {
    let region = Region::new(&common::sphere(60.0, 4)).unwrap();
    let mut flat = tutte(&region).unwrap();
    let law = RestEnergy::new(&region, options().law);
    let mut gradient = vec![Vec2::zeros(); flat.len()];
    law.gradient(&flat, &mut gradient).unwrap();
    let largest = gradient.iter().map(Vec2::norm).fold(0.0, f64::max);
    let mut scratch = gradient.clone();
    for v in 0..flat.len() {
        for axis in 0..2 {
            let step = 1e-7;
            let kept = flat[v];
            flat[v][axis] = kept[axis] + step;
            let high = law.gradient(&flat, &mut scratch).unwrap();
            flat[v][axis] = kept[axis] - step;
            let low = law.gradient(&flat, &mut scratch).unwrap();
            flat[v] = kept;
            let slope = (high - low) / (2.0 * step);
            assert!(
                (slope - gradient[v][axis]).abs() < 1e-6 * largest,
                "{slope} {}",
                gradient[v][axis]
            );
        }
    }
}

/// A number between 0 and 1 that depends on two others in no obvious way.
fn noise(a: u64, b: u64) -> f64 {
    let mut h = a << 32 | b;
    for _ in 0..3 {
        h = (h ^ (h >> 31)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    (h >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn no_triangle_of_two_hundred_random_disks_is_flipped() {
    let mut from_tutte = 0;
    for seed in 0..200u64 {
        let (columns, rows) = (3 + (seed % 7) as usize, 3 + (seed / 7 % 5) as usize);
        let rough = 0.3 * noise(seed, 1);
        let mut mesh = grid(columns, rows, |u, v| {
            let bend = 3.0 * noise(seed, 2) * u;
            Vec3::new(0.2 * bend.sin(), 0.3 * v, 0.2 * bend.cos() + 0.2 * u)
        });
        for (k, place) in mesh.positions.iter_mut().enumerate() {
            let k = k as u64;
            let shift = Vec3::new(
                noise(seed, 3 * k + 10),
                noise(seed, 3 * k + 11),
                noise(seed, 3 * k + 12),
            );
            *place += shift * (0.3 * rough);
        }
        // The disk is turned in space; its grain goes with it.
        let turn = Rigid::rotation(Vec3::new(noise(seed, 4), noise(seed, 5), noise(seed, 6)) * PI);
        mesh.positions.iter_mut().for_each(|p| *p = turn * *p);
        let asked = Options {
            grain: turn * Vec3::y(),
            ..options()
        };
        let flat = flatten(&mesh, &asked).unwrap();
        assert_eq!(flipped(&flat.region, &flat.places), 0, "{seed}");
        assert!(flat.minimum.energy.is_finite());
        from_tutte += usize::from(flat.from_tutte);
    }
    println!("{from_tutte} of 200 began with Tutte's embedding");
}
