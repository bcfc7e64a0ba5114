//! The dress form of a body: trunk and root of the neck, closed at neck, armholes and hips, on a
//! stand.

use crate::Part;
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{TriangleMesh, Vec3};

/// A closed surface, oriented outward, with the part of each triangle.
pub(crate) struct DressForm {
    pub(crate) mesh: TriangleMesh,
    pub(crate) parts: Vec<Part>,
    /// Height of the top of the form (m).
    pub(crate) top: f64,
}

/// Largest distance from the plane that cuts off the neck or an arm at which a vertex counts as in the plane,
/// as a share of stature.
const IN_PLANE: f64 = 3e-4;
/// Height by which plates over neck and armholes bulge, as a share of stature.
const BULGE: f64 = 0.006;
/// Rings of a plate: shares of the distance from its centre to its border.
const PLATE: [f64; 3] = [0.85, 0.6, 0.3];
/// Rings that continue the trunk's open lower border: depth of a ring under the lowest point of the border,
/// as a share of stature, and size of the ring as a share of that of the border.
const SKIRT: [[f64; 2]; 6] = [
    [0.015, 1.0],
    [0.03, 0.995],
    [0.045, 0.985],
    [0.056, 0.965],
    [0.06, 0.93],
    [0.061, 0.5],
];
/// The stand: radius and height (m), from the form downwards. It is not scaled: the foot holds a form of any
/// size.
const STAND: [[f64; 2]; 5] = [
    [0.016, 0.06],
    [0.022, 0.045],
    [0.10, 0.028],
    [0.17, 0.016],
    [0.175, 0.0],
];

/// The triangles of a part.
fn own(skin: &TriangleMesh, parts: &[Part], part: Part) -> Vec<[u32; 3]> {
    let all = skin.triangles.iter().zip(parts);
    all.filter(|(_, own)| **own == part)
        .map(|(corners, _)| *corners)
        .collect()
}

/// The plane that cuts off the left arm, by a point and its outward normal. It is parallel to the line
/// through the highest and the lowest point where arm and trunk meet, and no point where they meet lies
/// beyond it.
fn armhole(skin: &TriangleMesh, parts: &[Part]) -> [Vec3; 2] {
    let corners = |part: Part| -> BTreeSet<u32> {
        let own = own(skin, parts, part);
        own.into_iter().flatten().collect()
    };
    let (arm, trunk) = (corners(Part::LeftArm), corners(Part::Trunk));
    let border: Vec<Vec3> = (arm.intersection(&trunk))
        .map(|&v| skin.positions[v as usize])
        .collect();
    let by_height = |a: &&Vec3, b: &&Vec3| a.y.total_cmp(&b.y);
    let ends = (border.iter().max_by(by_height)).zip(border.iter().min_by(by_height));
    let way = ends.map_or(Vec3::y(), |(top, bottom)| top - bottom);
    let outward = Vec3::new(way.y, -way.x, 0.0).normalize();
    let far = |a: &Vec3, b: &Vec3| a.dot(&outward).total_cmp(&b.dot(&outward));
    [border.into_iter().max_by(far).unwrap_or_default(), outward]
}

impl DressForm {
    /// The form of a skin whose neck ends in a plane, given by a point and its upward normal.
    pub(crate) fn of(
        (skin, parts): (&TriangleMesh, &[Part]),
        neck: [Vec3; 2],
        stature: f64,
    ) -> Self {
        let mut form = Self {
            mesh: TriangleMesh {
                positions: skin.positions.clone(),
                triangles: Vec::new(),
            },
            parts: Vec::new(),
            top: 0.0,
        };
        let [point, outward] = armhole(skin, parts);
        let mirrored = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
        let right = [mirrored(point), mirrored(outward)];
        let near = IN_PLANE * stature;
        form.keep((skin, parts), Part::Trunk, None);
        form.keep((skin, parts), Part::Head, Some((neck, near)));
        form.keep((skin, parts), Part::LeftArm, Some(([point, outward], near)));
        form.keep((skin, parts), Part::RightArm, Some((right, near)));
        for border in form.borders() {
            let middle = form.middle(&border);
            let bulge = BULGE * stature;
            match (middle.y > neck[0].y - 0.03 * stature, middle.x) {
                (true, _) => form.plate(&border, neck[1] * bulge, Part::Head),
                (_, x) if x > 0.03 * stature => form.plate(&border, outward * bulge, Part::Trunk),
                (_, x) if x < -0.03 * stature => {
                    form.plate(&border, right[1] * bulge, Part::Trunk);
                }
                _ => form.stand(&border, stature),
            }
        }
        form.without_strays();
        form.top = form.mesh.bounds().map_or(0.0, |[_, high]| high.y);
        form
    }

    /// Adds the triangles of a part of the skin to the form. With an `end`, only the side of the skin below a
    /// plane is added; `end` gives a point and the normal of the plane, and the distance within which
    /// vertices count as in it (m).
    fn keep(
        &mut self,
        (skin, parts): (&TriangleMesh, &[Part]),
        part: Part,
        end: Option<([Vec3; 2], f64)>,
    ) {
        let above = |v: u32| {
            let ([origin, normal], near) = end?;
            let height = (skin.positions[v as usize] - origin).dot(&normal);
            Some(if height.abs() < near { 0.0 } else { height })
        };
        let above = |v: u32| above(v).unwrap_or(-1.0);
        // The root of an arm becomes the shoulder of the form and counts as trunk.
        let kept = match part {
            Part::Head => Part::Head,
            _ => Part::Trunk,
        };
        // The vertex at which each edge crosses the plane.
        let mut cut: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for corners in own(skin, parts, part) {
            let mut rest: Vec<u32> = Vec::new();
            for k in 0..3 {
                let [a, b] = [corners[k], corners[(k + 1) % 3]];
                if above(a) <= 0.0 {
                    rest.push(a);
                }
                if above(a) * above(b) < 0.0 {
                    // The lower number first, so that both triangles at the edge get the same vertex.
                    let edge = [a.min(b), a.max(b)];
                    let [p, q] = edge.map(|v| skin.positions[v as usize]);
                    let [s, t] = edge.map(above);
                    let known = *cut.entry(edge).or_insert_with(|| {
                        self.mesh.positions.push(p + (q - p) * (s / (s - t)));
                        (self.mesh.positions.len() - 1) as u32
                    });
                    rest.push(known);
                }
            }
            for k in 2..rest.len() {
                self.face([rest[0], rest[k - 1], rest[k]], kept);
            }
        }
    }

    fn face(&mut self, corners: [u32; 3], part: Part) {
        self.mesh.triangles.push(corners);
        self.parts.push(part);
    }

    /// The loops along which the surface is open, in the direction of its triangles.
    fn borders(&self) -> Vec<Vec<u32>> {
        let edges = || {
            let around = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
            self.mesh.triangles.iter().flat_map(around)
        };
        let known: BTreeSet<[u32; 2]> = edges().collect();
        let mut next: BTreeMap<u32, u32> = edges()
            .filter(|&[a, b]| !known.contains(&[b, a]))
            .map(|[a, b]| (a, b))
            .collect();
        let mut loops = Vec::new();
        while let Some((&first, _)) = next.first_key_value() {
            let mut border = Vec::new();
            let mut at = first;
            while let Some(after) = next.remove(&at) {
                border.push(at);
                at = after;
            }
            loops.push(border);
        }
        loops
    }

    fn at(&self, vertex: u32) -> Vec3 {
        self.mesh.positions[vertex as usize]
    }

    fn middle(&self, ring: &[u32]) -> Vec3 {
        ring.iter().map(|&v| self.at(v)).sum::<Vec3>() / ring.len().max(1) as f64
    }

    /// Adds a band from an open border to a ring of as many new points, and returns the ring as the new
    /// border.
    fn band(&mut self, border: &[u32], points: Vec<Vec3>, part: Part) -> Vec<u32> {
        let first = self.mesh.positions.len() as u32;
        let ring: Vec<u32> = (first..first + points.len() as u32).collect();
        self.mesh.positions.extend(points);
        for k in 0..border.len() {
            let next = (k + 1) % border.len();
            self.face([border[next], border[k], ring[k]], part);
            self.face([border[next], ring[k], ring[next]], part);
        }
        ring
    }

    /// Closes a border by a fan round a point.
    fn close(&mut self, border: &[u32], point: Vec3, part: Part) {
        let pole = self.mesh.positions.len() as u32;
        self.mesh.positions.push(point);
        for k in 0..border.len() {
            self.face([border[(k + 1) % border.len()], border[k], pole], part);
        }
    }

    /// Closes a border by a plate that bulges outward at its centre.
    fn plate(&mut self, border: &[u32], bulge: Vec3, part: Part) {
        let middle = self.middle(border);
        let edge: Vec<Vec3> = border.iter().map(|&v| self.at(v)).collect();
        let mut ring = border.to_vec();
        for share in PLATE {
            let lifted = middle + bulge * (1.0 - share * share);
            let points = edge.iter().map(|p| lifted + (p - middle) * share);
            ring = self.band(&ring, points.collect(), part);
        }
        self.close(&ring, middle + bulge, part);
    }

    /// Closes the form under the hips and puts it on its stand.
    fn stand(&mut self, border: &[u32], stature: f64) {
        let middle = self.middle(border);
        let edge: Vec<Vec3> = border.iter().map(|&v| self.at(v)).collect();
        let lowest = edge.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let mut ring = border.to_vec();
        for [depth, share] in SKIRT {
            let y = lowest - depth * stature;
            let points = edge.iter().map(|p| {
                let out = (p - middle) * share;
                Vec3::new(middle.x + out.x, y, middle.z + out.z)
            });
            ring = self.band(&ring, points.collect(), Part::Trunk);
        }
        let under = lowest - (SKIRT[SKIRT.len() - 1][0] + 1e-3) * stature;
        let [radius, _] = STAND[0];
        for [radius, y] in [[radius, under]].into_iter().chain(STAND) {
            let points = edge.iter().map(|p| {
                let out = Vec3::new(p.x - middle.x, 0.0, p.z - middle.z).normalize();
                Vec3::new(middle.x, y, middle.z) + out * radius
            });
            ring = self.band(&ring, points.collect(), Part::Trunk);
        }
        self.close(&ring, Vec3::new(middle.x, 0.0, middle.z), Part::Trunk);
    }

    /// Removes vertices that belong to no triangle.
    fn without_strays(&mut self) {
        let mut number = vec![u32::MAX; self.mesh.positions.len()];
        let mut positions = Vec::new();
        for v in self.mesh.triangles.iter_mut().flatten() {
            let known = &mut number[*v as usize];
            if *known == u32::MAX {
                *known = positions.len() as u32;
                positions.push(self.mesh.positions[*v as usize]);
            }
            *v = *known;
        }
        self.mesh.positions = positions;
    }
}
