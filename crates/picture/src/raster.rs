//! Triangles to pixels: eight samples a pixel with a depth buffer, in square tiles.
//!
//! Corners are put on a grid of 1/256 pixel, so that edge functions are exact in `f64`: a sample
//! on the common edge of two triangles is covered by at least one of them (Pineda 1988).
//! Each tile is drawn by one thread in the order of the triangles, so that the bytes do not
//! depend on the number of threads.

use crate::backdrop::Backdrop;
use crate::camera::{Camera, Projection, Seen};
use crate::colour::srgb_from_linear;
use crate::image::Image;
use crate::prepare::Prepared;
use crate::shade::{Lamps, Place};
use crate::{PictureError, Rgb};
use rayon::prelude::*;
use std::sync::LazyLock;

/// Side of a tile (pixel).
const TILE: usize = 32;
const SAMPLES: usize = 8;
/// Places of the samples in a pixel, no two in one row or column of an 8 x 8 grid.
const OFFSETS: [[f64; 2]; SAMPLES] = [
    [9.0 / 16.0, 5.0 / 16.0],
    [7.0 / 16.0, 11.0 / 16.0],
    [13.0 / 16.0, 9.0 / 16.0],
    [5.0 / 16.0, 3.0 / 16.0],
    [3.0 / 16.0, 13.0 / 16.0],
    [1.0 / 16.0, 7.0 / 16.0],
    [11.0 / 16.0, 15.0 / 16.0],
    [15.0 / 16.0, 1.0 / 16.0],
];
const NOTHING: u32 = u32::MAX;

/// Places beyond this would lose exactness (pixel).
const FURTHEST: f64 = 16_384.0;

/// A linear function over the picture: factor of x, factor of y, value at the origin.
#[derive(Clone, Copy)]
struct Plane([f64; 3]);

impl Plane {
    fn at(&self, x: f64, y: f64) -> f64 {
        self.0[0] * x + self.0[1] * y + self.0[2]
    }
}

/// A triangle on the picture.
struct Flat {
    /// Edge functions opposite corners 1 and 2, positive inside; with that of corner 0 they sum
    /// to `area`.
    edges: [Plane; 2],
    /// Twice the area (pixel2).
    area: f64,
    /// Nearness to the eye.
    near: Plane,
    /// First and last column and row.
    columns: [usize; 2],
    rows: [usize; 2],
    /// Whether the right side is seen.
    right_side: bool,
    /// Interpolation weights of the corners.
    weights: [f64; 3],
    /// Lengths of the edges opposite the corners (pixel).
    lengths: [f64; 3],
}

impl Flat {
    fn new(seen: [Seen; 3], size: [usize; 2]) -> Option<Self> {
        let inside = |s: &Seen| s.weight > 0.0 && s.x.abs() < FURTHEST && s.y.abs() < FURTHEST;
        if !seen.iter().all(inside) {
            return None;
        }
        let p = seen.map(|s| [s.x, s.y].map(|c| (c * 256.0).round() / 256.0));
        let d1 = [p[1][0] - p[0][0], p[1][1] - p[0][1]];
        let d2 = [p[2][0] - p[0][0], p[2][1] - p[0][1]];
        let area = d1[0] * d2[1] - d2[0] * d1[1];
        if area == 0.0 {
            return None;
        }
        let sign = area.signum();
        let plane = |a: f64, b: f64| Plane([a, b, -(a * p[0][0] + b * p[0][1])]);
        let edges = [
            plane(sign * d2[1], -sign * d2[0]),
            plane(-sign * d1[1], sign * d1[0]),
        ];
        let area = area.abs();
        let slopes = [1, 2].map(|k: usize| (seen[k].near - seen[0].near) / area);
        let near = Plane([0, 1, 2].map(|k| {
            let base = if k == 2 { seen[0].near } else { 0.0 };
            base + slopes[0] * edges[0].0[k] + slopes[1] * edges[1].0[k]
        }));
        let span = |k: usize| {
            let low = p[0][k].min(p[1][k]).min(p[2][k]).floor();
            let high = p[0][k].max(p[1][k]).max(p[2][k]).floor();
            (high >= 0.0 && low < size[k] as f64)
                .then(|| [low.max(0.0) as usize, (high as usize).min(size[k] - 1)])
        };
        let length = |a: usize, b: usize| (p[a][0] - p[b][0]).hypot(p[a][1] - p[b][1]).max(1e-9);
        Some(Self {
            edges,
            area,
            near,
            columns: span(0)?,
            rows: span(1)?,
            // Rows count downwards, so a counter-clockwise triangle has negative area.
            right_side: sign < 0.0,
            weights: seen.map(|s| s.weight),
            lengths: [length(1, 2), length(2, 0), length(0, 1)],
        })
    }

    /// Edge functions of all three corners.
    fn edges_at(&self, x: f64, y: f64) -> [f64; 3] {
        let (e1, e2) = (self.edges[0].at(x, y), self.edges[1].at(x, y));
        [self.area - e1 - e2, e1, e2]
    }
}

/// Draws a prepared scene.
pub(crate) fn render(
    prepared: &Prepared,
    camera: &Camera,
    size: [usize; 2],
    backdrop: &Backdrop,
) -> Result<Image, PictureError> {
    let mut image = Image::new(size[0], size[1], [0.0; 3])?;
    let seen: Vec<Seen> = prepared
        .positions
        .par_iter()
        .map(|&p| camera.see(p, size))
        .collect();
    let flats: Vec<Option<Flat>> = prepared
        .triangles
        .par_iter()
        .map(|t| Flat::new(t.map(|v| seen[v as usize]), size))
        .collect();
    let across = size[0].div_ceil(TILE);
    let mut bins: Vec<Vec<u32>> = vec![Vec::new(); across * size[1].div_ceil(TILE)];
    for (t, flat) in flats.iter().enumerate() {
        let Some(flat) = flat else { continue };
        for row in flat.rows[0] / TILE..=flat.rows[1] / TILE {
            for column in flat.columns[0] / TILE..=flat.columns[1] / TILE {
                bins[row * across + column].push(t as u32);
            }
        }
    }
    let view = Painter {
        prepared,
        camera,
        size,
        backdrop,
        flats: &flats,
        lamps: Lamps::new(prepared, camera),
        rows: (0..size[1])
            .map(|y| backdrop.plain((y as f64 + 0.5) / size[1] as f64))
            .collect(),
    };
    let tiles: Vec<Vec<u8>> = bins
        .par_iter()
        .enumerate()
        .map(|(k, bin)| view.tile([k % across * TILE, k / across * TILE], bin))
        .collect();
    for (k, pixels) in tiles.into_iter().enumerate() {
        let left = k % across * TILE;
        let width = TILE.min(size[0] - left);
        let height = pixels.len() / (4 * width);
        image.place(
            &Image {
                width,
                height,
                pixels,
            },
            left,
            k / across * TILE,
        );
    }
    Ok(image)
}

struct Painter<'a> {
    prepared: &'a Prepared<'a>,
    camera: &'a Camera,
    size: [usize; 2],
    backdrop: &'a Backdrop,
    flats: &'a [Option<Flat>],
    lamps: Lamps<'a>,
    /// Linear light of the backdrop in each row.
    rows: Vec<[f64; 3]>,
}

impl Painter<'_> {
    /// Pixels of a tile, cut at the image's border.
    fn tile(&self, [left, top]: [usize; 2], bin: &[u32]) -> Vec<u8> {
        let right = (left + TILE).min(self.size[0]);
        let bottom = (top + TILE).min(self.size[1]);
        let samples = self.samples([left, top], [right, bottom], bin);
        let mut pixels = Vec::with_capacity(4 * (right - left) * (bottom - top));
        for y in top..bottom {
            for x in left..right {
                let at = ((y - top) * TILE + x - left) * SAMPLES;
                let colour = self.pixel(x, y, &samples[at..at + SAMPLES]);
                pixels.extend(quantised(colour, x, y));
                pixels.push(255);
            }
        }
        pixels
    }

    /// The nearest triangle of each sample.
    fn samples(&self, from: [usize; 2], to: [usize; 2], bin: &[u32]) -> Vec<u32> {
        let mut nearest = vec![f32::NEG_INFINITY; TILE * TILE * SAMPLES];
        let mut triangles = vec![NOTHING; TILE * TILE * SAMPLES];
        for &t in bin {
            let Some(flat) = &self.flats[t as usize] else {
                continue;
            };
            let [e1, e2] = &flat.edges;
            // Largest rise of an edge function from a pixel's middle to its border.
            let rise = |e: &Plane| 0.5 * (e.0[0].abs() + e.0[1].abs());
            let rises = [
                0.5 * ((e1.0[0] + e2.0[0]).abs() + (e1.0[1] + e2.0[1]).abs()),
                rise(e1),
                rise(e2),
            ];
            for y in flat.rows[0].max(from[1])..(flat.rows[1] + 1).min(to[1]) {
                for x in flat.columns[0].max(from[0])..(flat.columns[1] + 1).min(to[0]) {
                    let (px, py) = (x as f64, y as f64);
                    let middle = flat.edges_at(px + 0.5, py + 0.5);
                    if (0..3).any(|k| middle[k] + rises[k] < 0.0) {
                        continue;
                    }
                    let base = ((y - from[1]) * TILE + x - from[0]) * SAMPLES;
                    let mut near = [0.0_f32; SAMPLES];
                    let mut least = [0.0_f64; SAMPLES];
                    for k in 0..SAMPLES {
                        let (sx, sy) = (px + OFFSETS[k][0], py + OFFSETS[k][1]);
                        let [a, b, c] = flat.edges_at(sx, sy);
                        least[k] = if a < b { a } else { b };
                        least[k] = if c < least[k] { c } else { least[k] };
                        near[k] = flat.near.at(sx, sy) as f32;
                    }
                    for k in 0..SAMPLES {
                        if least[k] >= 0.0 && near[k] > nearest[base + k] {
                            nearest[base + k] = near[k];
                            triangles[base + k] = t;
                        }
                    }
                }
            }
        }
        triangles
    }

    /// Linear light of a pixel: each triangle is shaded once, at the middle of its samples.
    fn pixel(&self, x: usize, y: usize, samples: &[u32]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (k, &t) in samples.iter().enumerate() {
            if samples[..k].contains(&t) {
                continue;
            }
            let mut count = 0.0;
            let mut middle = [0.0; 2];
            for (offset, _) in OFFSETS.iter().zip(samples).filter(|(_, s)| **s == t) {
                count += 1.0;
                middle = [middle[0] + offset[0], middle[1] + offset[1]];
            }
            let place = [x as f64 + middle[0] / count, y as f64 + middle[1] / count];
            let light = match self.flats.get(t as usize) {
                Some(Some(flat)) => self.triangle(t as usize, flat, place),
                _ => self.behind(place),
            };
            for c in 0..3 {
                sum[c] += light[c] * count / SAMPLES as f64;
            }
        }
        sum
    }

    fn triangle(&self, triangle: usize, flat: &Flat, [x, y]: [f64; 2]) -> [f64; 3] {
        let edges = flat.edges_at(x, y);
        let scaled = [0, 1, 2].map(|k| edges[k] * flat.weights[k]);
        let whole: f64 = scaled.iter().sum();
        let bits = self.prepared.lined[triangle];
        let line = if bits == 0 {
            0.0
        } else {
            let surface = self.prepared.owner[triangle] as usize;
            let half = 0.5 * self.prepared.scene.surfaces[surface].lines.width;
            (0..3)
                .filter(|k| bits >> k & 1 == 1)
                .map(|k| (half + 0.5 - edges[k] / flat.lengths[k]).clamp(0.0, 1.0))
                .fold(0.0, f64::max)
                .min(2.0 * half)
        };
        let to_eye = match self.camera.projection {
            Projection::Orthographic => -self.camera.forward,
            Projection::Perspective => -self.camera.ray(x, y, self.size).1,
        };
        self.lamps.shade(&Place {
            triangle,
            weights: scaled.map(|s| s / whole),
            right_side: flat.right_side,
            to_eye,
            line,
        })
    }

    fn behind(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let plain = self.rows[(y as usize).min(self.size[1] - 1)];
        let Some(floor) = &self.prepared.floor else {
            return plain;
        };
        let ray = self.camera.ray(x, y, self.size);
        let light = self.backdrop.on_floor(x / self.size[0] as f64, ray, floor);
        plain.map(|c| c * light)
    }
}

/// sRGB of linear light from 0 to 1 in even steps of the square root.
static ENCODED: LazyLock<Vec<f64>> = LazyLock::new(|| {
    (0..=1024)
        .map(|k| srgb_from_linear([(f64::from(k) / 1024.0).powi(2); 3])[0])
        .collect()
});

/// Bytes of linear light, with an ordered dither (Bayer 1973) against bands in soft gradients.
fn quantised(light: [f64; 3], x: usize, y: usize) -> [u8; 3] {
    const BAYER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    let threshold = (f64::from(BAYER[y % 4][x % 4]) + 0.5) / 16.0;
    let colour: Rgb = light.map(|l| {
        let place = 1024.0 * l.clamp(0.0, 1.0).sqrt();
        let below = (place as usize).min(1023);
        ENCODED[below] + (ENCODED[below + 1] - ENCODED[below]) * (place - below as f64)
    });
    colour.map(|c| (c * 255.0 + threshold).floor().min(255.0) as u8)
}
