//! A region cut out of a surface along shortest paths between places on it, with lines to cut in it.

use crate::LoopError;
use crate::geodesic::{PathNode, shortest_path};
use crate::region::outlines;
use crate::split_mesh::SplitMesh;
use std::collections::{HashMap, HashSet};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3, closest_point_on_triangle};

/// Largest distance of a place from the surface (m).
pub const MAX_OFF: f64 = 0.02;

/// Fewest places of a loop.
pub const MIN_PLACES: usize = 3;

/// Most places of a loop.
pub const MAX_PLACES: usize = 200;

/// Most lines to cut.
pub const MAX_CUTS: usize = 20;

/// Turn of the outline at a place by which the place is a corner (rad).
const CORNER: f64 = 0.2;

/// Places on a surface round a region, and lines to cut in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceLoop {
    /// Places round the region, in order (m).
    pub places: Vec<Vec3>,
    /// A place inside the region (m); without one it is the smaller side.
    pub inside: Option<Vec3>,
    /// Lines to cut: places from the loop to a place inside (m).
    pub cuts: Vec<Vec<Vec3>>,
}

/// A region of a surface.
#[derive(Clone, Debug)]
pub struct SurfaceRegion {
    pub(crate) mesh: SplitMesh,
    /// Vertices of the outline in order, the region on the left.
    pub(crate) ring: Vec<u32>,
    /// Vertices at which the outline turns.
    pub(crate) corners: HashSet<u32>,
    /// Lines to cut, from the outline to a vertex inside.
    pub(crate) cuts: Vec<Vec<u32>>,
    /// Vertices of the cuts that stay where they are.
    pub(crate) fixed: HashSet<u32>,
    /// Largest distance of a place from the surface (m).
    pub farthest: f64,
}

/// Cuts the region inside a loop out of a surface.
///
/// # Errors
/// The surface branches, a place is not on it, the loop meets itself or does not part the surface, a cut cannot be made.
pub fn cut_out(mesh: &TriangleMesh, asked: &SurfaceLoop) -> Result<SurfaceRegion, LoopError> {
    let count = asked.places.len();
    if !(MIN_PLACES..=MAX_PLACES).contains(&count) {
        return Err(LoopError::Count {
            count,
            least: MIN_PLACES,
            most: MAX_PLACES,
        });
    }
    let mut split = SplitMesh::new(mesh)?;
    let tree = SurfaceTree::new(mesh.clone());
    let mut farthest: f64 = 0.0;
    let mut corners = Vec::with_capacity(count);
    for (k, &place) in asked.places.iter().enumerate() {
        let (v, distance) = vertex_at(&mut split, &tree, place, &place_name(k))?;
        if let Some(other) = corners.iter().position(|&w| w == v) {
            return Err(LoopError::Same(place_name(other), place_name(k)));
        }
        farthest = farthest.max(distance);
        corners.push(v);
    }
    let ring = loop_ring(&mut split, &corners)?;
    let inside = match asked.inside {
        Some(place) => {
            let found = on_surface(&tree, place, "the place inside")?;
            Some(split_triangle(&split, &tree, found.0, place))
        }
        None => None,
    };
    let mut region = side_of(&split, &ring, &corners, inside)?;
    region.farthest = farthest;
    for (k, line) in asked.cuts.iter().enumerate() {
        region.cut(line, k + 1)?;
    }
    Ok(region)
}

/// Places along the shortest path over a surface from one place to another, with both; each is taken to the nearest point
/// of the surface (m).
///
/// # Errors
/// The surface branches, a place is not on it, both are the same, or no path joins them.
pub fn surface_path(surface: &SurfaceTree, ends: [Vec3; 2]) -> Result<Vec<Vec3>, LoopError> {
    let mut split = SplitMesh::new(surface.mesh())?;
    let [name, other] = [place_name(0), place_name(1)];
    let (from, _) = vertex_at(&mut split, surface, ends[0], &name)?;
    let (to, _) = vertex_at(&mut split, surface, ends[1], &other)?;
    if from == to {
        return Err(LoopError::Same(name, other));
    }
    let path = shortest_path(&split, from, to).ok_or(LoopError::Apart(name, other))?;
    let places = path.into_iter().map(|node| node_place(&split, node));
    Ok(places.collect())
}

/// The name of a place of a loop in messages.
fn place_name(k: usize) -> String {
    format!("place {}", k + 1)
}

/// The triangle nearest to a place, and the distance (m).
fn on_surface(tree: &SurfaceTree, place: Vec3, what: &str) -> Result<(u32, f64), LoopError> {
    let off = |distance: f64| LoopError::Off {
        what: what.to_owned(),
        distance: (distance * 1e4).round() / 10.0,
        most: MAX_OFF * 1e3,
    };
    let found = tree
        .closest_point(place, f64::INFINITY)
        .ok_or_else(|| off(f64::INFINITY))?;
    let distance = (found.point - place).norm();
    if distance > MAX_OFF {
        return Err(off(distance));
    }
    Ok((found.triangle, distance))
}

/// The triangle of a mesh that was split since its tree was made, nearest to a place whose nearest triangle was another.
fn split_triangle(split: &SplitMesh, tree: &SurfaceTree, triangle: u32, place: Vec3) -> u32 {
    let whole = tree.mesh().triangles.len() as u32;
    let distance = |t: u32| {
        let corners = split.corners(t);
        let (w, _) = closest_point_on_triangle(place, corners);
        (corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2] - place).norm()
    };
    let new = whole..split.triangles().len() as u32;
    let mut best = (distance(triangle), triangle);
    for t in new {
        let found = distance(t);
        if found < best.0 {
            best = (found, t);
        }
    }
    best.1
}

fn vertex_at(
    split: &mut SplitMesh,
    tree: &SurfaceTree,
    place: Vec3,
    what: &str,
) -> Result<(u32, f64), LoopError> {
    let (triangle, distance) = on_surface(tree, place, what)?;
    let t = split_triangle(split, tree, triangle, place);
    let (weights, _) = closest_point_on_triangle(place, split.corners(t));
    Ok((split.vertex_at(t, weights), distance))
}

/// The vertices of the shortest paths from each corner to the next, cut into the surface.
fn loop_ring(split: &mut SplitMesh, corners: &[u32]) -> Result<Vec<u32>, LoopError> {
    // The paths that vertices and edges of the loop belong to.
    let mut vertices: HashMap<u32, usize> =
        corners.iter().enumerate().map(|(k, &v)| (v, k)).collect();
    let mut edges: HashMap<[u32; 2], usize> = HashMap::new();
    let mut ring = Vec::new();
    for (k, &from) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        let to = corners[next];
        let path = shortest_path(split, from, to)
            .ok_or_else(|| LoopError::Apart(place_name(k), place_name(next)))?;
        if let Some((node, other)) = meets(&path, &vertices, &edges) {
            let place = node_place(split, node);
            return Err(LoopError::Crosses {
                first: place_name(k),
                second: place_name(other),
                x: place.x,
                y: place.y,
                z: place.z,
            });
        }
        let way = insert(split, &path).ok_or_else(|| LoopError::TooThin(place_name(k)))?;
        for pair in way.windows(2) {
            edges.insert(sorted(pair[0], pair[1]), k);
        }
        for &v in &way[1..way.len() - 1] {
            vertices.insert(v, k);
        }
        ring.extend_from_slice(&way[..way.len() - 1]);
    }
    Ok(ring)
}

fn sorted(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The first node of a path, but for its ends, that lies on other paths, and the number of that one.
fn meets(
    path: &[PathNode],
    vertices: &HashMap<u32, usize>,
    edges: &HashMap<[u32; 2], usize>,
) -> Option<(PathNode, usize)> {
    let inner = &path[1..path.len().max(2) - 1];
    let node = inner.iter().find_map(|node| {
        let met = match node {
            PathNode::Vertex(v) => vertices.get(v),
            PathNode::Edge { ends, .. } => edges.get(&sorted(ends[0], ends[1])),
        };
        met.map(|&k| (*node, k))
    });
    // A path that is one edge may be an edge of another.
    let whole = match path {
        [PathNode::Vertex(a), PathNode::Vertex(b)] => {
            edges.get(&sorted(*a, *b)).map(|&k| (path[0], k))
        }
        _ => None,
    };
    node.or(whole)
}

fn node_place(split: &SplitMesh, node: PathNode) -> Vec3 {
    match node {
        PathNode::Vertex(v) => split.positions()[v as usize],
        PathNode::Edge {
            ends: [a, b],
            share,
        } => split.positions()[a as usize].lerp(&split.positions()[b as usize], share),
    }
}

/// Cuts a path into the triangles; its vertices. None where thin triangles were in the way.
fn insert(split: &mut SplitMesh, path: &[PathNode]) -> Option<Vec<u32>> {
    let mut way: Vec<u32> = Vec::with_capacity(path.len());
    for node in path {
        let v = match *node {
            PathNode::Vertex(v) => v,
            PathNode::Edge { ends, share } => split.vertex_on(ends, share),
        };
        if way.last() != Some(&v) {
            way.push(v);
        }
    }
    let joined = way.windows(2).all(|pair| split.is_edge(pair[0], pair[1]));
    (joined && way.len() >= 2).then_some(way)
}

/// The region on one side of a ring: the one with a triangle, else the smaller.
fn side_of(
    split: &SplitMesh,
    ring: &[u32],
    corners: &[u32],
    inside: Option<u32>,
) -> Result<SurfaceRegion, LoopError> {
    let pairs = || (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]);
    let barred: HashSet<[u32; 2]> = pairs().map(|[a, b]| sorted(a, b)).collect();
    let mut side: Vec<Option<bool>> = vec![None; split.triangles().len()];
    for is_left in [true, false] {
        let mut open: Vec<u32> = pairs()
            .filter_map(|[a, b]| match is_left {
                true => split.left_of(a, b),
                false => split.left_of(b, a),
            })
            .collect();
        while let Some(t) = open.pop() {
            match side[t as usize] {
                Some(known) if known == is_left => continue,
                Some(_) => return Err(LoopError::PartsNothing),
                None => side[t as usize] = Some(is_left),
            }
            let corners = split.triangles()[t as usize];
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                if !barred.contains(&sorted(a, b)) {
                    open.extend(split.left_of(b, a));
                }
            }
        }
    }
    // Without a place inside the smaller disk is meant, else the smaller side.
    let sides = match inside {
        Some(t) => vec![side[t as usize].ok_or(LoopError::Inside)?],
        None => vec![true, false],
    };
    let rank = |is_left: bool| {
        let part = part(split, &side, is_left);
        // Along the rim of an open surface a loop has nothing on its other side.
        let kind = match part.triangles.len() {
            0 => 2,
            _ => usize::from(disk(&part).is_err()),
        };
        (kind, part.area())
    };
    let mut ranked: Vec<((usize, f64), bool)> = sides.into_iter().map(|s| (rank(s), s)).collect();
    ranked.sort_by(|a, b| a.0.0.cmp(&b.0.0).then(a.0.1.total_cmp(&b.0.1)));
    let is_left = ranked.first().is_none_or(|best| best.1);
    disk(&part(split, &side, is_left))?;
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let mut mesh = TriangleMesh::default();
    let mut normals = Vec::new();
    for (t, corners) in split.triangles().iter().enumerate() {
        if side[t] != Some(is_left) {
            continue;
        }
        mesh.triangles.push(corners.map(|v| {
            *numbers.entry(v).or_insert_with(|| {
                mesh.positions.push(split.positions()[v as usize]);
                normals.push(split.normals()[v as usize]);
                mesh.positions.len() as u32 - 1
            })
        }));
    }
    let mesh = SplitMesh::with_normals(&mesh, normals)?;
    let mut ring: Vec<u32> = ring
        .iter()
        .filter_map(|v| numbers.get(v).copied())
        .collect();
    if !is_left {
        ring.reverse();
    }
    let turns = |&v: &u32| {
        let fan = mesh.fan(v)?;
        let within: f64 = fan.triangles.iter().map(|&t| mesh.angle_at(t, v)).sum();
        ((within - std::f64::consts::PI).abs() > CORNER).then_some(v)
    };
    let corners = (corners.iter().filter_map(|v| numbers.get(v)))
        .filter_map(turns)
        .collect();
    Ok(SurfaceRegion {
        mesh,
        ring,
        corners,
        cuts: Vec::new(),
        fixed: HashSet::new(),
        farthest: 0.0,
    })
}

/// The triangles on one side of a loop, with all vertices.
fn part(split: &SplitMesh, side: &[Option<bool>], is_left: bool) -> TriangleMesh {
    TriangleMesh {
        positions: split.positions().to_vec(),
        triangles: (split.triangles().iter().zip(side))
            .filter(|(_, s)| **s == Some(is_left))
            .map(|(t, _)| *t)
            .collect(),
    }
}

/// Refuses a part that is no disk.
fn disk(part: &TriangleMesh) -> Result<(), LoopError> {
    let outlines = outlines(part).len();
    match (outlines, part.euler_characteristic()) {
        (1, 1) => Ok(()),
        (1, _) => Err(LoopError::Handle),
        _ => Err(LoopError::Holes(outlines)),
    }
}

impl SurfaceRegion {
    /// The surface of the region.
    pub fn surface(&self) -> TriangleMesh {
        self.mesh.mesh()
    }

    /// Lines to cut, as vertices of the surface from the outline to their ends inside.
    pub fn cuts(&self) -> &[Vec<u32>] {
        &self.cuts
    }

    /// Vertices of the outline in order, the region on the left.
    pub fn outline(&self) -> &[u32] {
        &self.ring
    }

    /// The region with every vertex moved along the normal that the whole surface had there (m).
    #[must_use]
    pub fn moved_out(&self, ease: f64) -> Self {
        let mut mesh = self.mesh.mesh();
        for (place, normal) in mesh.positions.iter_mut().zip(self.mesh.normals()) {
            *place += normal * ease;
        }
        let mut moved = self.clone();
        moved.mesh.set_positions(mesh.positions);
        moved
    }

    /// Draws a line to cut, from the outline along shortest paths through places to the last one, numbered for messages.
    ///
    /// # Errors
    /// The line does not begin near the outline, leaves the region, or meets the outline or another cut.
    pub fn cut(&mut self, line: &[Vec3], number: usize) -> Result<(), LoopError> {
        let refuse = |why: String, remedy| {
            Err(LoopError::Cut {
                cut: number,
                why,
                remedy,
            })
        };
        if line.len() < 2 || line.len() > MAX_PLACES {
            return refuse(
                format!("has {} places", line.len()),
                "give a place on the loop, and at least one inside",
            );
        }
        if self.cuts.len() >= MAX_CUTS {
            return refuse(format!("is one of more than {MAX_CUTS}"), "give fewer");
        }
        let mouth = match self.mouth(line[0]) {
            Ok(mouth) => mouth,
            Err(distance) => {
                return refuse(
                    format!("begins {:.1} mm from the loop", distance * 1e3),
                    "begin it on the loop",
                );
            }
        };
        let mut mesh = self.mesh.clone();
        let from = mesh.vertex_on(mouth.0, mouth.1);
        let mut ring = self.ring.clone();
        if !ring.contains(&from) {
            let at = ring.iter().position(|&v| v == mouth.0[0]).unwrap_or(0);
            ring.insert(at + 1, from);
        }
        let mut taken: HashSet<u32> = ring.iter().copied().collect();
        taken.extend(self.cuts.iter().flatten().copied());
        if self.cuts.iter().any(|cut| cut.contains(&from)) {
            return refuse("begins where another does".to_owned(), "begin it elsewhere");
        }
        let tree = SurfaceTree::new(mesh.mesh());
        let mut stops = vec![from];
        for (k, &place) in line.iter().enumerate().skip(1) {
            let what = format!("place {} of cut {number}", k + 1);
            let (v, _) = vertex_at(&mut mesh, &tree, place, &what)?;
            if taken.contains(&v) || stops.contains(&v) {
                return refuse(
                    format!("has its place {} on the outline or on a cut", k + 1),
                    "give places inside the region",
                );
            }
            stops.push(v);
        }
        let mut way = vec![from];
        for pair in stops.windows(2) {
            let path = shortest_path(&mesh, pair[0], pair[1]);
            let path = path.ok_or_else(|| LoopError::TooThin(format!("cut {number}")))?;
            let meets = |node: &PathNode| match node {
                PathNode::Vertex(v) => taken.contains(v) || way.contains(v),
                PathNode::Edge { ends, .. } => {
                    let is_cut = |cut: &[u32]| {
                        let mut pairs = cut.windows(2);
                        pairs.any(|pair| sorted(pair[0], pair[1]) == sorted(ends[0], ends[1]))
                    };
                    is_cut(&way) || self.cuts.iter().any(|cut| is_cut(cut))
                }
            };
            let inner = &path[1..path.len().max(2) - 1];
            if let Some(node) = inner.iter().find(|node| meets(node)) {
                let p = node_place(&mesh, *node);
                return refuse(
                    format!(
                        "meets the outline or a cut at ({:.4}, {:.4}, {:.4}) m",
                        p.x, p.y, p.z
                    ),
                    "give a place more between, away from them",
                );
            }
            let part = insert(&mut mesh, &path)
                .ok_or_else(|| LoopError::TooThin(format!("cut {number}")))?;
            way.extend_from_slice(&part[1..]);
        }
        self.mesh = mesh;
        self.ring = ring;
        self.fixed.extend(stops);
        self.cuts.push(way);
        Ok(())
    }

    /// The edge of the outline nearest to a place, and the share of the way along it; else the distance (m).
    fn mouth(&self, place: Vec3) -> Result<([u32; 2], f64), f64> {
        let mut best = (f64::INFINITY, [0, 0], 0.0);
        for k in 0..self.ring.len() {
            let ends = [self.ring[k], self.ring[(k + 1) % self.ring.len()]];
            let [a, b] = ends.map(|v| self.mesh.positions()[v as usize]);
            let side = b - a;
            let share = ((place - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
            let distance = (a + side * share - place).norm();
            if distance < best.0 {
                best = (distance, ends, share);
            }
        }
        if best.0 > MAX_OFF {
            Err(best.0)
        } else {
            Ok((best.1, best.2))
        }
    }
}
