//! A region meshed anew with edges of one length (Botsch and Kobbelt 2004): long edges split, short ones collapsed, edges
//! turned until the triangles are Delaunay, vertices moved along the surface to the middle of their neighbours. The outline
//! and the cuts stay where they are.

use crate::LoopError;
use crate::surface_loop::SurfaceRegion;
use std::collections::HashMap;
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3, triangle_area};

/// Least length of edges (m).
pub const MIN_EDGE: f64 = 5e-4;

/// Largest length of edges (m).
pub const MAX_EDGE: f64 = 0.1;

/// Most triangles of a region.
pub const MAX_TRIANGLES: usize = 200_000;

/// Rounds of splitting, collapsing, turning and moving.
const ROUNDS: usize = 10;

/// Passes over the edges within a round.
const MAX_PASSES: usize = 12;

/// Edges longer than this share of the length are split (1).
const LONG: f64 = 4.0 / 3.0;

/// Edges shorter than this share of the length are collapsed (1).
const SHORT: f64 = 0.8;

/// Least cosine between a triangle's normal and the surface's, for a triangle to be made (1).
const MIN_FACING: f64 = 0.3;

/// Excess of the angles opposite an edge over two right ones by which it is turned (rad).
const BEYOND: f64 = 1e-6;

/// A region meshed anew.
#[derive(Clone, Debug)]
pub struct Remeshed {
    /// The surface.
    pub mesh: TriangleMesh,
    /// Vertices of each cut, from the outline to its end inside.
    pub cuts: Vec<Vec<u32>>,
}

/// How a vertex may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Hold {
    /// Along the surface.
    Free,
    /// Along a line.
    Line(u32),
    /// Not at all.
    Fixed,
}

impl SurfaceRegion {
    /// The length of edges that suits a region: a thirtieth of the side of a square as large, 2 to 12 mm (m).
    pub fn default_edge(&self) -> f64 {
        (self.surface().area().sqrt() / 30.0).clamp(2e-3, 0.012)
    }

    /// Meshes the region with edges of about a length (m).
    ///
    /// # Errors
    /// The length cannot be used.
    pub fn remeshed(&self, edge: f64) -> Result<Remeshed, LoopError> {
        let expected = self.surface().area() / (0.433 * edge * edge);
        let sound = (MIN_EDGE..=MAX_EDGE).contains(&edge);
        if !sound || !(3.0..=MAX_TRIANGLES as f64).contains(&expected) {
            return Err(LoopError::EdgeLength(edge, MAX_TRIANGLES));
        }
        let mut work = Work::new(self, edge);
        for _ in 0..ROUNDS {
            work.split_long();
            work.collapse_short();
            work.turn_edges();
            work.relax();
        }
        work.turn_edges();
        Ok(work.done(self))
    }
}

struct Work {
    edge: f64,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    hold: Vec<Hold>,
    /// Triangles; those that were collapsed have all corners alike.
    triangles: Vec<[u32; 3]>,
    around: Vec<Vec<u32>>,
    /// The line that an edge of the outline or of a cut lies on.
    line_of: HashMap<[u32; 2], u32>,
    /// Places of the vertices of each line (m).
    lines: Vec<Vec<Vec3>>,
    surface: SurfaceTree,
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Work {
    fn new(region: &SurfaceRegion, edge: f64) -> Self {
        let mesh = region.surface();
        let mut hold = vec![Hold::Free; mesh.positions.len()];
        let (mut lines, mut line_of) = (Vec::new(), HashMap::new());
        let mut fixed = vec![false; mesh.positions.len()];
        let ends = region.cuts.iter().flat_map(|cut| [cut.first(), cut.last()]);
        for &v in region
            .corners
            .iter()
            .chain(&region.fixed)
            .chain(ends.flatten())
        {
            fixed[v as usize] = true;
        }
        // A ring without corners still has ends, so that its parts have.
        let ring = &region.ring;
        if ring.iter().filter(|&&v| fixed[v as usize]).count() < 2 {
            for k in [0, ring.len() / 3, 2 * ring.len() / 3] {
                fixed[ring[k] as usize] = true;
            }
        }
        let first = ring.iter().position(|&v| fixed[v as usize]).unwrap_or(0);
        let turned: Vec<u32> = (0..=ring.len())
            .map(|k| ring[(first + k) % ring.len()])
            .collect();
        for way in [&turned].into_iter().chain(&region.cuts) {
            let mut from = 0;
            for k in 1..way.len() {
                if !fixed[way[k] as usize] {
                    continue;
                }
                let line = lines.len() as u32;
                for pair in way[from..=k].windows(2) {
                    line_of.insert(sorted(pair[0], pair[1]), line);
                }
                for &v in &way[from + 1..k] {
                    hold[v as usize] = Hold::Line(line);
                }
                lines.push(
                    way[from..=k]
                        .iter()
                        .map(|&v| mesh.positions[v as usize])
                        .collect(),
                );
                from = k;
            }
        }
        for (v, _) in fixed.iter().enumerate().filter(|(_, is_fixed)| **is_fixed) {
            hold[v] = Hold::Fixed;
        }
        let mut around = vec![Vec::new(); mesh.positions.len()];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for &v in corners {
                around[v as usize].push(t as u32);
            }
        }
        Self {
            edge,
            positions: mesh.positions.clone(),
            normals: region.mesh.normals().to_vec(),
            hold,
            triangles: mesh.triangles.clone(),
            around,
            line_of,
            lines,
            surface: SurfaceTree::new(mesh),
        }
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        (self.positions[a as usize] - self.positions[b as usize]).norm()
    }

    /// All edges with their lengths (m), in a fixed order.
    fn edges(&self) -> Vec<(f64, [u32; 2])> {
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(3 * self.triangles.len());
        for &[a, b, c] in self.triangles.iter().filter(|t| t[0] != t[1]) {
            edges.extend([sorted(a, b), sorted(b, c), sorted(c, a)]);
        }
        edges.sort_unstable();
        edges.dedup();
        edges
            .into_iter()
            .map(|[a, b]| (self.length(a, b), [a, b]))
            .collect()
    }

    /// The triangles on an edge.
    fn on_edge(&self, [a, b]: [u32; 2]) -> Vec<u32> {
        let at = &self.around[a as usize];
        at.iter()
            .copied()
            .filter(|&t| self.triangles[t as usize].contains(&b))
            .collect()
    }

    /// The corner of a triangle that lies opposite an edge.
    fn opposite(&self, t: u32, [a, b]: [u32; 2]) -> u32 {
        let corners = self.triangles[t as usize];
        corners.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
    }

    /// Cosine between the normal of a triangle and that of the surface; that of a triangle without area is -1.
    fn facing(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = corners.map(|v| self.positions[v as usize]);
        let surface: Vec3 = corners.iter().map(|&v| self.normals[v as usize]).sum();
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
        let surface = surface.try_normalize(0.0);
        normal.zip(surface).map_or(-1.0, |(a, b)| a.dot(&b))
    }

    fn split_long(&mut self) {
        for _ in 0..MAX_PASSES {
            let mut long: Vec<(f64, [u32; 2])> = self.edges();
            long.retain(|edge| edge.0 > LONG * self.edge);
            if long.is_empty() {
                return;
            }
            long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            for (_, ends) in long {
                self.split(ends);
            }
        }
    }

    fn split(&mut self, [a, b]: [u32; 2]) {
        let on = self.on_edge([a, b]);
        if on.is_empty() {
            return;
        }
        let m = self.positions.len() as u32;
        let middle = |values: &[Vec3]| 0.5 * (values[a as usize] + values[b as usize]);
        let normal = middle(&self.normals);
        self.positions.push(middle(&self.positions));
        self.normals
            .push(normal.try_normalize(0.0).unwrap_or(normal));
        self.around.push(Vec::new());
        let line = self.line_of.remove(&sorted(a, b));
        self.hold.push(line.map_or(Hold::Free, Hold::Line));
        if let Some(line) = line {
            self.line_of.insert(sorted(a, m), line);
            self.line_of.insert(sorted(m, b), line);
        }
        for t in on {
            let third = self.opposite(t, [a, b]);
            let with =
                |from: u32| self.triangles[t as usize].map(|v| if v == from { m } else { v });
            let (kept, new) = (with(b), with(a));
            let next = self.triangles.len() as u32;
            self.triangles[t as usize] = kept;
            self.triangles.push(new);
            self.around[b as usize].retain(|&other| other != t);
            self.around[b as usize].push(next);
            self.around[third as usize].push(next);
            self.around[m as usize].extend([t, next]);
        }
    }

    fn collapse_short(&mut self) {
        for _ in 0..MAX_PASSES {
            let mut short: Vec<(f64, [u32; 2])> = self.edges();
            short.retain(|edge| edge.0 < SHORT * self.edge);
            short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut done = 0;
            for (_, [a, b]) in short {
                let order = if self.hold[a as usize] <= self.hold[b as usize] {
                    [a, b]
                } else {
                    [b, a]
                };
                done += usize::from(self.collapse(order) || self.collapse([order[1], order[0]]));
            }
            if done == 0 {
                return;
            }
        }
    }

    /// Takes one end of an edge away into the other, which stays; whether that could be done.
    fn collapse(&mut self, [gone, kept]: [u32; 2]) -> bool {
        let on = self.on_edge([gone, kept]);
        if on.is_empty() || self.length(gone, kept) >= SHORT * self.edge {
            return false;
        }
        let line = self.line_of.get(&sorted(gone, kept)).copied();
        match self.hold[gone as usize] {
            Hold::Fixed => return false,
            Hold::Line(own) if line != Some(own) => return false,
            Hold::Line(_) | Hold::Free => {}
        }
        // The ends may have no neighbours in common but those of the triangles that go.
        let near = |v: u32| {
            let mut all: Vec<u32> = (self.around[v as usize].iter())
                .flat_map(|&t| self.triangles[t as usize])
                .filter(|&w| w != v)
                .collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let (of_gone, of_kept) = (near(gone), near(kept));
        let common = of_gone
            .iter()
            .filter(|v| of_kept.binary_search(v).is_ok())
            .count();
        if common != on.len() {
            return false;
        }
        let too_long = |&v: &u32| v != kept && self.length(v, kept) > LONG * self.edge;
        if of_gone.iter().any(too_long) {
            return false;
        }
        let moved: Vec<u32> = (self.around[gone as usize].iter().copied())
            .filter(|t| !on.contains(t))
            .collect();
        for &t in &moved {
            let old = self.triangles[t as usize];
            let new = old.map(|v| if v == gone { kept } else { v });
            let facing = self.facing(new);
            if facing < MIN_FACING && facing <= self.facing(old) {
                return false;
            }
        }
        // The triangles on the edge go; their other sides become one.
        for &t in &on {
            let third = self.opposite(t, [gone, kept]);
            let side = self.line_of.remove(&sorted(gone, third));
            if let Some(side) = side {
                self.line_of.insert(sorted(kept, third), side);
            }
            self.triangles[t as usize] = [gone; 3];
            for v in [kept, third] {
                self.around[v as usize].retain(|&other| other != t);
            }
        }
        if line.is_some() {
            self.line_of.remove(&sorted(gone, kept));
        }
        for &v in of_gone.iter().filter(|&&v| v != kept) {
            if let Some(side) = self.line_of.remove(&sorted(gone, v)) {
                self.line_of.insert(sorted(kept, v), side);
            }
        }
        for t in moved {
            let corner = self.triangles[t as usize].iter().position(|&v| v == gone);
            if let Some(k) = corner {
                self.triangles[t as usize][k] = kept;
                self.around[kept as usize].push(t);
            }
        }
        self.around[gone as usize].clear();
        true
    }

    fn turn_edges(&mut self) {
        for _ in 0..MAX_PASSES {
            let mut done = 0;
            for (_, ends) in self.edges() {
                done += usize::from(self.turn(ends));
            }
            if done == 0 {
                return;
            }
        }
    }

    /// Turns an edge whose opposite angles are more than two right ones together; whether it was.
    fn turn(&mut self, ends: [u32; 2]) -> bool {
        if self.line_of.contains_key(&ends) {
            return false;
        }
        let on = self.on_edge(ends);
        let [one, two] = on[..] else {
            return false;
        };
        let (c, d) = (self.opposite(one, ends), self.opposite(two, ends));
        if c == d || !self.on_edge([c, d]).is_empty() {
            return false;
        }
        let angle = |v: u32| {
            let side = |w: u32| self.positions[w as usize] - self.positions[v as usize];
            side(ends[0]).angle(&side(ends[1]))
        };
        if angle(c) + angle(d) <= std::f64::consts::PI + BEYOND {
            return false;
        }
        // With the first triangle (a, b, c) the new ones are (a, d, c) and (d, b, c).
        let corners = self.triangles[one as usize];
        let k = corners.iter().position(|&v| v == c).unwrap_or(0);
        let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let new = [[a, d, c], [d, b, c]];
        let least =
            |triangles: [[u32; 3]; 2]| self.facing(triangles[0]).min(self.facing(triangles[1]));
        let old = [self.triangles[one as usize], self.triangles[two as usize]];
        if least(new) < MIN_FACING && least(new) <= least(old) {
            return false;
        }
        self.triangles[one as usize] = new[0];
        self.triangles[two as usize] = new[1];
        self.around[a as usize].retain(|&t| t != two);
        self.around[b as usize].retain(|&t| t != one);
        self.around[c as usize].push(two);
        self.around[d as usize].push(one);
        true
    }

    /// Moves each vertex to the middle of its neighbours, along the surface or its line.
    fn relax(&mut self) {
        let mut beside: HashMap<u32, Vec<u32>> = HashMap::new();
        for &[a, b] in self.line_of.keys() {
            beside.entry(a).or_default().push(b);
            beside.entry(b).or_default().push(a);
        }
        for v in 0..self.positions.len() as u32 {
            if self.around[v as usize].is_empty() {
                continue;
            }
            let place = self.positions[v as usize];
            let (to, normal) = match self.hold[v as usize] {
                Hold::Fixed => continue,
                Hold::Line(line) => {
                    let Some([a, b]) = beside
                        .get(&v)
                        .map(Vec::as_slice)
                        .and_then(|s| s.first_chunk())
                        .copied()
                    else {
                        continue;
                    };
                    let middle = 0.5 * (self.positions[a as usize] + self.positions[b as usize]);
                    let to = on_line(&self.lines[line as usize], middle);
                    (to, self.normals[v as usize])
                }
                Hold::Free => {
                    let (mut sum, mut weight) = (Vec3::zeros(), 0.0);
                    for &t in &self.around[v as usize] {
                        let [a, b, c] =
                            self.triangles[t as usize].map(|w| self.positions[w as usize]);
                        let area = triangle_area([a, b, c]);
                        sum += (a + b + c) * (area / 3.0);
                        weight += area;
                    }
                    if weight <= 0.0 {
                        continue;
                    }
                    let normal = self.normals[v as usize];
                    let way = sum / weight - place;
                    let along = place + way - normal * way.dot(&normal);
                    let Some(found) = self.surface.closest_point(along, f64::INFINITY) else {
                        continue;
                    };
                    (found.point, self.normal_at(found.triangle, found.weights))
                }
            };
            let least = |work: &Self| {
                (work.around[v as usize].iter())
                    .map(|&t| work.facing(work.triangles[t as usize]))
                    .fold(1.0, f64::min)
            };
            let before = least(self);
            let old_normal = self.normals[v as usize];
            self.positions[v as usize] = to;
            self.normals[v as usize] = normal;
            let after = least(self);
            if after < MIN_FACING && after < before {
                self.positions[v as usize] = place;
                self.normals[v as usize] = old_normal;
            }
        }
    }

    fn normal_at(&self, triangle: u32, weights: [f64; 3]) -> Vec3 {
        let corners = self.surface.mesh().triangles[triangle as usize];
        let sum: Vec3 = (corners.iter().zip(weights))
            .map(|(&v, weight)| self.surface.vertex_normals()[v as usize] * weight)
            .sum();
        sum.try_normalize(0.0).unwrap_or(sum)
    }

    fn done(self, region: &SurfaceRegion) -> Remeshed {
        let mut numbers: Vec<Option<u32>> = vec![None; self.positions.len()];
        let mut mesh = TriangleMesh::default();
        for corners in self.triangles.iter().filter(|t| t[0] != t[1]) {
            mesh.triangles.push(corners.map(|v| {
                *numbers[v as usize].get_or_insert_with(|| {
                    mesh.positions.push(self.positions[v as usize]);
                    mesh.positions.len() as u32 - 1
                })
            }));
        }
        let mut beside: HashMap<u32, Vec<u32>> = HashMap::new();
        for &[a, b] in self.line_of.keys() {
            beside.entry(a).or_default().push(b);
            beside.entry(b).or_default().push(a);
        }
        // The lines of the outline come first, then those of each cut in order.
        let of_cuts = region.cuts.iter().map(|cut| {
            let mut way: Vec<u32> = vec![cut[0]];
            let end = cut[cut.len() - 1];
            let is_cut = |a: u32, b: u32| {
                let line = self.line_of.get(&sorted(a, b));
                line.is_some_and(|&line| line >= self.outline_lines(region))
            };
            while let Some(&at) = way.last().filter(|&&at| at != end) {
                let next = beside.get(&at).and_then(|near| {
                    near.iter()
                        .copied()
                        .find(|&v| is_cut(at, v) && !way.contains(&v))
                });
                match next {
                    Some(next) => way.push(next),
                    None => break,
                }
            }
            way.into_iter()
                .filter_map(|v| numbers[v as usize])
                .collect()
        });
        let cuts = of_cuts.collect();
        Remeshed { mesh, cuts }
    }

    /// Number of lines of the outline.
    fn outline_lines(&self, region: &SurfaceRegion) -> u32 {
        let of_cuts: usize = (region.cuts.iter())
            .map(|cut| cut.iter().filter(|v| region.fixed.contains(v)).count() - 1)
            .sum();
        (self.lines.len() - of_cuts) as u32
    }
}

/// The point of a line nearest to a place (m).
fn on_line(line: &[Vec3], place: Vec3) -> Vec3 {
    let mut best = (f64::INFINITY, place);
    for pair in line.windows(2) {
        let side = pair[1] - pair[0];
        let share = ((place - pair[0]).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        let on = pair[0] + side * share;
        let distance = (on - place).norm();
        if distance < best.0 {
            best = (distance, on);
        }
    }
    best.1
}
