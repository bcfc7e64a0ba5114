//! Meshes as the 3D view draws them: corners with normals and colours, and seam lines.

use crate::theme::Palette;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{Vec3, triangle_area};
use toile_session::{Garment, GarmentJob, LiveFrame, RealtimeSurface, Stage};

/// A corner in the vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Position (m).
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Linear colour, 0..=1, and the [`Finish`] as a number.
    pub colour: [f32; 4],
}

/// Lighting of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Unlit: the plain colour.
    Plain,
    /// Lit from outside only.
    Solid,
    /// Lit from both sides; the wrong side is a little darker.
    Cloth,
}

/// Floats per corner.
pub const CORNER_FLOATS: usize = 10;

impl Corner {
    fn new(position: Vec3, normal: Vec3, colour: [f32; 3], finish: Finish) -> Self {
        let [red, green, blue] = colour;
        Self {
            position: position.map(|x| x as f32).into(),
            normal: normal.map(|x| x as f32).into(),
            colour: [red, green, blue, finish as u8 as f32],
        }
    }

    /// The numbers in the order of the vertex buffer.
    pub fn floats(&self) -> [f32; CORNER_FLOATS] {
        let (p, n, c) = (self.position, self.normal, self.colour);
        [p[0], p[1], p[2], n[0], n[1], n[2], c[0], c[1], c[2], c[3]]
    }
}

/// Linear from sRGB, both 0..=1 (IEC 61966-2-1).
fn linear(srgb: f64) -> f32 {
    let linear = match srgb <= 0.04045 {
        true => srgb / 12.92,
        false => ((srgb + 0.055) / 1.055).powf(2.4),
    };
    linear as f32
}

/// Colour of the mannequin: unbleached linen, sRGB.
const LINEN: [f64; 3] = [0.80, 0.765, 0.715];
/// Radius of the floor (m).
const FLOOR: f64 = 0.75;
/// Lightness factors of neighbouring panels of one cloth, so that seams are visible.
const PANEL_SHADES: [f64; 3] = [1.0, 0.93, 1.05];

/// Colour of seam lines on a cloth (both linear): darker on light cloth, lighter on dark.
fn seam_ink(cloth: [f32; 3]) -> [f32; 3] {
    match luminance(cloth) > 0.08 {
        true => cloth.map(|c| 0.2 * c),
        false => cloth.map(|c| 0.12 + 0.7 * c),
    }
}

/// Luminance of a linear colour of sRGB primaries (IEC 61966-2-1).
fn luminance([red, green, blue]: [f32; 3]) -> f32 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// Unit normals of the vertices, weighted by triangle area.
fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::zeros(); positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let normal = (b - a).cross(&(c - a));
        for vertex in triangle {
            normals[*vertex as usize] += normal;
        }
    }
    for normal in &mut normals {
        *normal = normal.try_normalize(1e-30).unwrap_or_else(Vec3::y);
    }
    normals
}

/// Corners of the triangles of the mannequin.
pub fn mannequin(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Corner> {
    let normals = normals(positions, triangles);
    let colour = LINEN.map(linear);
    let corners = triangles.iter().flatten().map(|&v| {
        Corner::new(
            positions[v as usize],
            normals[v as usize],
            colour,
            Finish::Solid,
        )
    });
    corners.collect()
}

/// Corners of the triangles of a surface of a figure in motion, lit from both sides.
pub fn painted(surface: &RealtimeSurface) -> Vec<Corner> {
    let place = |p: &[f32; 3]| Vec3::from(p.map(f64::from));
    let positions: Vec<Vec3> = surface.positions.iter().map(place).collect();
    shaded(&positions, &surface.triangles, &surface.colours)
}

/// Corners of triangles with a colour each (sRGB, 0..=1), lit from both sides.
pub fn shaded(positions: &[Vec3], triangles: &[[u32; 3]], colours: &[[f64; 3]]) -> Vec<Corner> {
    let normals = normals(positions, triangles);
    let triangles = triangles.iter().zip(colours);
    let corners = triangles.flat_map(|(triangle, colour)| {
        let colour = colour.map(linear);
        triangle.map(|v| {
            let v = v as usize;
            Corner::new(positions[v], normals[v], colour, Finish::Cloth)
        })
    });
    corners.collect()
}

/// Corners of lines along paths.
pub fn path_lines(paths: &[Vec<Vec3>], colour: egui::Color32) -> Vec<Corner> {
    let [red, green, blue, _] = colour.to_array();
    let colour = [red, green, blue].map(|c| linear(f64::from(c) / 255.0));
    let pairs = paths.iter().flat_map(|path| path.windows(2));
    let ends = pairs.flatten();
    ends.map(|&at| Corner::new(at, Vec3::y(), colour, Finish::Plain))
        .collect()
}

/// Triangles of the floor: a disc that fades into the background at the rim.
pub fn floor(palette: &Palette) -> Vec<Corner> {
    let [middle, rim] = [palette.floor, palette.stage].map(|colour| {
        let [red, green, blue, _] = colour.to_array();
        [red, green, blue].map(|share| linear(f64::from(share) / 255.0))
    });
    let count = 64;
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        Vec3::new(FLOOR * angle.sin(), -0.002, FLOOR * angle.cos())
    };
    let corner = |place, colour| Corner::new(place, Vec3::y(), colour, Finish::Plain);
    (0..count)
        .flat_map(|k| {
            [
                corner(Vec3::new(0.0, -0.002, 0.0), middle),
                corner(at(k), rim),
                corner(at(k + 1), rim),
            ]
        })
        .collect()
}

/// Appearance of the cloth of a garment: colours, which are constant during a drape.
pub struct ClothLook {
    garment: Arc<Garment>,
    /// Linear colour of each triangle.
    colours: Vec<[f32; 3]>,
    /// Boundary edges of panels, as pairs of vertices of the job's garment, with their linear colours.
    rims: Vec<([u32; 2], [f32; 3])>,
}

/// Cloth of a garment as corners, ready to be uploaded and drawn.
#[derive(Default)]
pub struct ClothSolid {
    /// Three corners per triangle.
    pub corners: Vec<Corner>,
    /// Two corners per line.
    pub lines: Vec<Corner>,
}

/// Linear greys of out-of-date cloth: for cloth that was black, and for cloth that was white. Both differ
/// from the mannequin and from every colour of cloth.
const OLD_GREYS: [f32; 2] = [0.18, 0.40];
/// Linear grey of seam lines on out-of-date cloth.
const OLD_INK: f32 = 0.04;

impl ClothSolid {
    /// Turns the cloth grey, because it is out of date.
    pub fn fade(&mut self) {
        let [black, white] = OLD_GREYS;
        for corner in &mut self.corners {
            let [red, green, blue, finish] = corner.colour;
            let grey = black + (white - black) * luminance([red, green, blue]).clamp(0.0, 1.0);
            corner.colour = [grey, grey, grey, finish];
        }
        for corner in &mut self.lines {
            corner.colour = [OLD_INK, OLD_INK, OLD_INK, corner.colour[3]];
        }
    }
}

impl ClothLook {
    /// The appearance of a garment's cloth.
    pub fn new(job: &GarmentJob) -> Self {
        let garment = &job.garment;
        let mut colours = vec![[0.5; 3]; garment.triangles.len()];
        for (k, panel) in garment.panels.iter().enumerate() {
            let base = job.panels.get(k).map_or([0.7; 3], |panel| panel.colour);
            let shade = PANEL_SHADES[k % PANEL_SHADES.len()];
            let colour = base.map(|c| linear((c * shade).clamp(0.0, 1.0)));
            colours[panel.triangles.clone()].fill(colour);
        }
        let mut sides: BTreeMap<[u32; 2], (u32, usize)> = BTreeMap::new();
        for (k, [a, b, c]) in garment.triangles.iter().enumerate() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                sides
                    .entry([*from.min(to), *from.max(to)])
                    .or_insert((0, k))
                    .0 += 1;
            }
        }
        let rims = sides.into_iter().filter(|(_, (count, _))| *count == 1);
        let rims = rims
            .map(|(side, (_, k))| (side, seam_ink(colours[k])))
            .collect();
        Self {
            garment: garment.clone(),
            colours,
            rims,
        }
    }

    /// The corners and seam lines of the cloth in a frame of a drape.
    pub fn solid(&self, frame: &LiveFrame) -> ClothSolid {
        let positions = &frame.positions;
        let merged = |v: u32| frame.target.get(v as usize).copied().unwrap_or(0);
        let triangles: Vec<[u32; 3]> = self
            .garment
            .triangles
            .iter()
            .map(|triangle| triangle.map(merged))
            .collect();
        let normals = normals(positions, &triangles);
        let mut solid = ClothSolid::default();
        for (triangle, colour) in triangles.iter().zip(&self.colours) {
            let corners = triangle.map(|v| v as usize);
            if triangle_area(corners.map(|v| positions[v])) <= 0.0 {
                continue;
            }
            solid.corners.extend(
                corners.map(|v| Corner::new(positions[v], normals[v], *colour, Finish::Cloth)),
            );
        }
        for (side, ink) in &self.rims {
            let [a, b] = side.map(merged);
            if a == b {
                continue;
            }
            solid.lines.extend([a, b].map(|v| {
                let v = v as usize;
                Corner::new(positions[v], normals[v], *ink, Finish::Plain)
            }));
        }
        solid
    }
}

/// The garment before its first step.
pub fn first_frame(job: &Arc<GarmentJob>) -> LiveFrame {
    let garment = &job.garment;
    LiveFrame {
        job: job.clone(),
        takes_edits: false,
        positions: garment.positions.clone(),
        target: (0..garment.positions.len() as u32).collect(),
        stage: Stage::Sewing,
        residual: f64::INFINITY,
        gap: 0.0,
        step: 0,
        share: 0.0,
    }
}
