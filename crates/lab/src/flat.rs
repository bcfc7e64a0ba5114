//! Flat sheets in four kinds of mesh.

use crate::LabError;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};
use std::collections::BTreeMap;
use strum::{EnumCount, VariantArray, VariantNames};
use toile_drape::{Cloth, Material};
use toile_geometry::{Vec2, Vec3};

/// How a sheet is cut into triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum MeshKind {
    /// Squares, all cut along the same diagonal.
    Right,
    /// Squares, cut along alternating diagonals.
    Alternating,
    /// Constrained Delaunay, refined to angles of 25 degrees and more.
    Delaunay,
    /// The same with slivers planted inside: flat triangles a fiftieth of their neighbour high.
    Slivers,
}

impl MeshKind {
    /// Every kind with its name.
    pub const ALL: [(&'static str, Self); Self::COUNT] = toile_geometry::named_variants!();
}

/// A flat sheet: points in its plane (m), and triangles, all of one hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flat {
    /// Points in the plane (m).
    pub points: Vec<Vec2>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Flat {
    /// The cloth of this sheet, its rest shape the sheet itself (warp along the first axis), each
    /// point put where `place` says (m).
    pub fn cloth(&self, material: Material, place: impl Fn(Vec2) -> Vec3) -> Cloth {
        let corner = |v: u32| self.points[v as usize];
        Cloth {
            positions: self.points.iter().map(|&p| place(p)).collect(),
            triangles: self.triangles.clone(),
            rest: self.triangles.iter().map(|t| t.map(corner)).collect(),
            material: vec![0; self.triangles.len()],
            panel: vec![0; self.triangles.len()],
            materials: vec![material],
        }
    }

    /// Points that fulfil a condition.
    pub fn chosen(&self, condition: impl Fn(Vec2) -> bool) -> Vec<u32> {
        (0..self.points.len() as u32)
            .filter(|&v| condition(self.points[v as usize]))
            .collect()
    }
}

/// Columns of cells at the start of a sheet that end on straight rows of points in every kind of
/// mesh: a strip is clamped there. Bending looks two cells far, so that the clamp must be three
/// wide to keep what lies behind it from bending.
pub(crate) const STRAIGHT: usize = 3;

/// Whether a point is held where a strip of cells of a size is clamped at 0 (m): up to half a cell
/// behind it.
pub(crate) fn clamped(x: f64, cell: f64) -> bool {
    x < 0.51 * cell
}

/// A rectangle from `from` to `to` (m) in `cells` squares (or triangles of that size). The first
/// three columns of cells, where strips are clamped, end on straight rows of points.
///
/// # Errors
/// The outline cannot be meshed.
pub fn rectangle(
    kind: MeshKind,
    from: Vec2,
    to: Vec2,
    cells: [usize; 2],
) -> Result<Flat, LabError> {
    match kind {
        MeshKind::Right | MeshKind::Alternating => Ok(grid(kind, from, to, cells)),
        MeshKind::Delaunay => delaunay(from, to, cells),
        MeshKind::Slivers => {
            let cell = (to.x - from.x) / cells[0] as f64;
            let clamp = from.x + STRAIGHT as f64 * cell;
            Ok(with_slivers(delaunay(from, to, cells)?, clamp))
        }
    }
}

fn grid(kind: MeshKind, from: Vec2, to: Vec2, [columns, rows]: [usize; 2]) -> Flat {
    let size = to - from;
    let mut flat = Flat::default();
    for j in 0..=rows {
        for i in 0..=columns {
            flat.points.push(Vec2::new(
                from.x + size.x * i as f64 / columns as f64,
                from.y + size.y * j as f64 / rows as f64,
            ));
        }
    }
    let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if kind == MeshKind::Right || (i + j) % 2 == 0 {
                flat.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                flat.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    flat
}

/// Smallest angle asked of Delaunay meshes (degree).
const MIN_ANGLE: f64 = 25.0;

fn refined(points: Vec<Vec2>, edges: Vec<[usize; 2]>, cell: f64) -> Result<Flat, LabError> {
    let vertices = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let refused = |_| toile_drape::DrapeError::Scene {
        place: "sheet".to_owned(),
        what: "its outline cannot be triangulated".to_owned(),
        remedy: "give a larger size".to_owned(),
    };
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(vertices, edges)
        .map_err(refused)?;
    // Triangles of half the cell at the most come out at about the size of half a cell.
    let parameters = RefinementParameters::new()
        .with_angle_limit(AngleLimit::from_deg(MIN_ANGLE))
        .with_max_allowed_area(0.65 * cell * cell)
        .with_max_additional_vertices(100 * points.len() + 1000)
        .keep_constraint_edges();
    mesh.refine(parameters);
    Ok(Flat {
        points: mesh
            .vertices()
            .map(|v| Vec2::new(v.position().x, v.position().y))
            .collect(),
        triangles: mesh
            .inner_faces()
            .map(|f| f.vertices().map(|v| v.index() as u32))
            .collect(),
    })
}

fn delaunay(from: Vec2, to: Vec2, [columns, rows]: [usize; 2]) -> Result<Flat, LabError> {
    let size = to - from;
    let x = |i: usize| from.x + size.x * i as f64 / columns as f64;
    let y = |j: usize| from.y + size.y * j as f64 / rows as f64;
    let mut points = Vec::new();
    let mut edges = Vec::new();
    let mut run = |places: Vec<Vec2>| {
        let mut last = None;
        for place in places {
            let known = points.iter().position(|&p: &Vec2| p == place);
            let at = known.unwrap_or_else(|| {
                points.push(place);
                points.len() - 1
            });
            if let Some(last) = last {
                edges.push([last, at]);
            }
            last = Some(at);
        }
    };
    for row in [0, rows] {
        run((0..=columns).map(|i| Vec2::new(x(i), y(row))).collect());
    }
    for column in (0..=STRAIGHT.min(columns)).chain([columns]) {
        run((0..=rows).map(|j| Vec2::new(x(column), y(j))).collect());
    }
    refined(points, edges, size.x / columns as f64)
}

/// A disc of a radius (m) about the origin, in triangles of a size (m), with two rings of points
/// half a cell inside and outside an inner radius, where it is held.
///
/// # Errors
/// The outline cannot be meshed.
pub fn disc(radius: f64, inner: f64, cell: f64) -> Result<Flat, LabError> {
    let mut points = Vec::new();
    let mut edges = Vec::new();
    for ring in [inner - 0.5 * cell, inner + 0.5 * cell, radius] {
        let count = (std::f64::consts::TAU * ring / cell).round() as usize;
        let first = points.len();
        for k in 0..count {
            let angle = std::f64::consts::TAU * k as f64 / count as f64;
            points.push(Vec2::new(angle.cos(), angle.sin()) * ring);
            edges.push([first + k, first + (k + 1) % count]);
        }
    }
    refined(points, edges, cell)
}

/// Plants a sliver into every seventh triangle: a point a fiftieth of the height from the middle of
/// an edge. The edge is one between two triangles: on the border such a triangle stays a cap (the
/// model can exchange no edge there) and holds the border to its chord. Columns before `clamp` (m)
/// stay plain: a point between the two last held rows would be held to their chord.
fn with_slivers(mut flat: Flat, clamp: f64) -> Flat {
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut uses: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for v in &flat.triangles {
        for k in 0..3 {
            *uses.entry(key(v[k], v[(k + 1) % 3])).or_default() += 1;
        }
    }
    let count = flat.triangles.len();
    for t in (3..count).step_by(7) {
        let v = flat.triangles[t];
        let inside = |&k: &usize| uses.get(&key(v[k], v[(k + 1) % 3])) == Some(&2);
        let Some(first) = (0..3).find(inside) else {
            continue;
        };
        let [a, b, c] = [0, 1, 2].map(|k| v[(first + k) % 3]);
        let [pa, pb, pc] = [a, b, c].map(|v| flat.points[v as usize]);
        if pa.x.min(pb.x).min(pc.x) < clamp - 1e-9 {
            continue;
        }
        let middle = (pa + pb) * 0.5;
        let new = flat.points.len() as u32;
        flat.points.push(middle + (pc - middle) * 0.02);
        flat.triangles[t] = [a, b, new];
        flat.triangles.extend([[b, c, new], [c, a, new]]);
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smallest_angle(flat: &Flat) -> f64 {
        let mut smallest = f64::INFINITY;
        for t in &flat.triangles {
            let p = t.map(|v| flat.points[v as usize]);
            for k in 0..3 {
                let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                assert!(u.perp(&v) > 0.0, "one hand");
                smallest = smallest.min(u.angle(&v));
            }
        }
        smallest.to_degrees()
    }

    #[test]
    fn every_kind_covers_the_rectangle() {
        let (from, to) = (Vec2::new(-0.1, 0.0), Vec2::new(0.9, 0.25));
        for (name, kind) in MeshKind::ALL {
            let flat = rectangle(kind, from, to, [20, 5]).unwrap();
            let area: f64 = flat
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|v| flat.points[v as usize]);
                    0.5 * (b - a).perp(&(c - a))
                })
                .sum();
            assert!((area - 0.25).abs() < 1e-12, "{name}");
            let angle = smallest_angle(&flat);
            match kind {
                MeshKind::Right | MeshKind::Alternating => assert!((angle - 45.0).abs() < 1e-6),
                MeshKind::Delaunay => assert!(angle > 20.0, "{angle}"),
                MeshKind::Slivers => assert!(angle < 3.0, "{angle}"),
            }
            let count = flat.points.len();
            assert!((100..260).contains(&count), "{name} {count}");
            // The end of the clamp is a straight row.
            let row = flat.chosen(|p| (p.x - 0.05).abs() < 1e-12);
            assert_eq!(row.len(), 6, "{name}");
        }
    }

    #[test]
    fn a_disc_is_round_and_held_on_two_rings() {
        let flat = disc(0.15, 0.09, 0.01).unwrap();
        let furthest = flat.points.iter().map(|p| p.norm()).fold(0.0, f64::max);
        assert!((furthest - 0.15).abs() < 1e-12);
        assert!(flat.chosen(|p| (p.norm() - 0.095).abs() < 1e-12).len() > 50);
        assert!(smallest_angle(&flat) > 15.0);
    }
}
