//! Cloth that spans the hollows of a surface: a film under even tension over the surface as an obstacle, held at the corners of
//! its outline.
//!
//! Where cloth lies on a surface, it is pressed to it; over a hollow it is drawn straight. The least area above an obstacle
//! is that of a film whose mean curvature is zero where it is free (Plateau's problem with an obstacle). It is found by
//! moving every vertex to the middle of its neighbours, overrelaxed, and back out where that is nearer to the surface than
//! the ease.

use crate::LoopError;
use crate::region::outlines;
use crate::split_mesh::SplitMesh;
use crate::surface_loop::SurfaceRegion;
use std::collections::HashSet;
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// Most rounds over all vertices.
const MAX_ROUNDS: usize = 2000;

/// Movement of a vertex in a round, over the length of the edges, below which the film is at rest (1).
const REST: f64 = 1e-5;

/// Overrelaxation (1).
const OVER: f64 = 1.85;

/// Distance from the plane x = 0 within which an edge of a region is taken for the middle of a symmetrical surface (m).
const ON_PLANE: f64 = 2e-4;

/// Length added to the distance within which the surface is looked for, against rounding (m).
const NEAR: f64 = 1e-6;

/// How a vertex of the film moves.
enum Moves {
    /// Not at all.
    Fixed,
    /// To the middle of all its neighbours.
    Free(Vec<u32>),
    /// The same within the plane x = 0, on whose other side its neighbours are mirrored.
    InPlane(Vec<u32>),
    /// Towards the line between its neighbours on the outline, and only out along a normal: so the outline stays where it was
    /// drawn.
    Line([u32; 2], Vec3),
    /// Towards the middle of all its neighbours, and only out along a normal: a corner in the plane x = 0.
    Corner(Vec<u32>, Vec3),
}

/// The surface under the film.
struct Obstacle {
    tree: SurfaceTree,
    /// Whether a vertex lies on the outline.
    is_rim: Vec<bool>,
    ease: f64,
}

/// A region of cloth that spans the hollows of a surface.
#[derive(Clone, Debug)]
pub struct Spanning {
    /// The region.
    pub region: SurfaceRegion,
    /// The farthest that the cloth is from the surface, beyond the ease (m).
    pub farthest: f64,
    /// Whether the film came to rest.
    pub at_rest: bool,
}

impl Obstacle {
    /// How far a place is beyond the ease (m), and the place at the ease; `None` beside the outline, where nothing is under the
    /// place. The surface is at most `reach` away (m).
    fn room(&self, place: Vec3, reach: f64) -> Option<(f64, Vec3)> {
        let found = self.tree.closest_point(place, reach)?;
        let corners = self.tree.mesh().triangles[found.triangle as usize];
        let mut on = corners
            .iter()
            .zip(found.weights)
            .filter(|(_, weight)| *weight > 1e-6);
        let is_beside = on.clone().count() < 3 && on.all(|(v, _)| self.is_rim[*v as usize]);
        let at_ease = found.point + found.normal * self.ease;
        (!is_beside).then_some((found.signed_distance - self.ease, at_ease))
    }
}

impl SurfaceRegion {
    /// The region of cloth at an ease (m) from this region of a surface, straight over its hollows; meshed with about a length
    /// of edges (m). Where the surface is its own mirror image, an edge in the plane x = 0 is the middle of the cloth.
    ///
    /// # Errors
    /// The length cannot be used.
    pub fn spanning_hollows(
        &self,
        ease: f64,
        edge: f64,
        is_symmetrical: bool,
    ) -> Result<Spanning, LoopError> {
        let tree = SurfaceTree::new(self.surface());
        let mut is_rim = vec![false; tree.mesh().positions.len()];
        self.ring.iter().for_each(|&v| is_rim[v as usize] = true);
        let obstacle = Obstacle { tree, is_rim, ease };
        let moved = self.moved_out(ease);
        let meshed = moved.remeshed(edge)?;
        let mut mesh = meshed.mesh;
        let at = |v: u32| moved.mesh.positions()[v as usize];
        let number = |v: &u32| nearest(&mesh, at(*v));
        let corners: HashSet<u32> = moved.corners.iter().map(number).collect();
        let fixed: HashSet<u32> = moved.fixed.iter().map(number).collect();
        let Some(ring) = outlines(&mesh).into_iter().next() else {
            return Ok(Spanning {
                region: moved,
                farthest: 0.0,
                at_rest: true,
            });
        };
        // Normals of the whole surface, whose rim this is not.
        let normal = |v: u32| {
            let off = |w: &u32| (at(*w) - mesh.positions[v as usize]).norm_squared();
            let near = moved.ring.iter().copied();
            let near = near.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
            moved.mesh.normals()[near as usize]
        };
        let moves = moves(&mesh, (&ring, &corners), normal, is_symmetrical);
        let at_rest = relax(&mut mesh.positions, &moves, &obstacle, edge);
        let off = |place: &Vec3| {
            let room = obstacle.room(*place, f64::INFINITY);
            room.map_or(0.0, |(room, _)| room)
        };
        let farthest = mesh.positions.iter().map(off).fold(0.0, f64::max);
        let normals = mesh.vertex_normals();
        let region = Self {
            mesh: SplitMesh::with_normals(&mesh, normals)?,
            ring,
            corners,
            cuts: meshed.cuts,
            fixed,
            farthest: self.farthest,
        };
        Ok(Spanning {
            region,
            farthest,
            at_rest,
        })
    }
}

/// The vertex of a mesh nearest to a place.
fn nearest(mesh: &TriangleMesh, place: Vec3) -> u32 {
    let off = |v: &usize| (mesh.positions[*v] - place).norm_squared();
    let all = 0..mesh.positions.len();
    all.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0) as u32
}

fn moves(
    mesh: &TriangleMesh,
    (ring, corners): (&[u32], &HashSet<u32>),
    normal: impl Fn(u32) -> Vec3,
    is_symmetrical: bool,
) -> Vec<Moves> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for [a, b] in mesh.topology().edges {
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
    }
    let mut moves: Vec<Moves> = neighbours.into_iter().map(Moves::Free).collect();
    for (k, &v) in ring.iter().enumerate() {
        let own = &mut moves[v as usize];
        let beside = [
            ring[(k + ring.len() - 1) % ring.len()],
            ring[(k + 1) % ring.len()],
        ];
        let is_in_plane = |v: &u32| mesh.positions[*v as usize].x.abs() < ON_PLANE;
        let is_end = is_symmetrical && is_in_plane(&v) && beside.iter().any(is_in_plane);
        let is_middle = is_end && beside.iter().all(is_in_plane);
        let all = match std::mem::replace(own, Moves::Fixed) {
            Moves::Free(all) => all,
            Moves::Fixed | Moves::InPlane(_) | Moves::Line(..) | Moves::Corner(..) => continue,
        };
        let normal = normal(v);
        *own = match corners.contains(&v) {
            true if is_end => {
                let normal = Vec3::new(0.0, normal.y, normal.z);
                Moves::Corner(all, normal.try_normalize(0.0).unwrap_or_default())
            }
            true => Moves::Fixed,
            false if is_middle => Moves::InPlane(all),
            false => Moves::Line(beside, normal),
        };
    }
    moves
}

/// Moves the vertices until none moves any more; whether they came to rest.
fn relax(positions: &mut [Vec3], moves: &[Moves], obstacle: &Obstacle, edge: f64) -> bool {
    let start = positions.to_vec();
    // Distances change by no more than the way of a vertex: one that is far from the surface need not be measured, and the
    // surface is no farther away than when it was measured last and the way since.
    let mut room = vec![0.0_f64; positions.len()];
    let mut reach = vec![f64::INFINITY; positions.len()];
    let way = |positions: &[Vec3], v: usize, of: &[u32]| {
        let sum: Vec3 = of.iter().map(|&w| positions[w as usize]).sum();
        (sum / of.len().max(1) as f64 - positions[v]) * OVER
    };
    for _ in 0..MAX_ROUNDS {
        let mut most = 0.0_f64;
        for (v, moves) in moves.iter().enumerate() {
            let before = positions[v];
            let place = match moves {
                Moves::Fixed => continue,
                Moves::Corner(of, normal) => {
                    let out = normal.dot(&(before - start[v] + way(positions, v, of)));
                    start[v] + normal * out.max(0.0)
                }
                Moves::Line(beside, normal) => {
                    let ends = beside.map(|w| positions[w as usize]);
                    let out = normal.dot(&(before - start[v]));
                    let out = out + OVER * along(before, *normal, ends);
                    start[v] + normal * out.max(0.0)
                }
                Moves::Free(of) | Moves::InPlane(of) => {
                    let mut place = before + way(positions, v, of);
                    let is_in_plane = matches!(moves, Moves::InPlane(_));
                    if is_in_plane {
                        place.x = before.x;
                    }
                    let moved = (place - before).norm();
                    room[v] -= moved;
                    reach[v] += moved + NEAR;
                    if room[v] <= 0.0
                        && let Some((beyond, at_ease)) = obstacle.room(place, reach[v])
                    {
                        if beyond < 0.0 {
                            place = at_ease;
                            if is_in_plane {
                                place.x = before.x;
                            }
                        }
                        room[v] = beyond.max(0.0);
                        reach[v] = beyond.max(0.0) + obstacle.ease.abs() + NEAR;
                    }
                    place
                }
            };
            most = most.max((place - before).norm());
            positions[v] = place;
        }
        if most < REST * edge {
            return true;
        }
    }
    false
}

/// The way along a direction from a place to where it is nearest to the line through two others.
fn along(place: Vec3, direction: Vec3, [a, b]: [Vec3; 2]) -> f64 {
    let line = (b - a).try_normalize(0.0).unwrap_or_default();
    let across = |v: Vec3| v - line * line.dot(&v);
    let (off, direction) = (across(place - a), across(direction));
    match direction.norm_squared() {
        // Along the line itself nothing is nearer.
        little if little < 1e-6 => 0.0,
        length => -off.dot(&direction) / length,
    }
}
