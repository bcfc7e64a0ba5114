//! Pieces of a draft as triangle meshes in their planes, with matching vertices along seams.
//!
//! # Decided with
//! - [`crate::boundary::Boundary`], [`crate::creases::Creases`]: outline and inner lines;
//! - [`crate::edges`] (`set_shape_sizes`), [`crate::sampling::GROWTH`], [`crate::size_field::SizeField`]:
//!   edge length at bends, away from them, inside;
//! - [`crate::planar::Planar`], [`toile_geometry::delaunay_triangles`]: the triangulation;
//! - [`crate::refinement::refine`], [`crate::smoothing::improve_worst`]: vertices added and moved;
//! - [`crate::mesh::MAX_VERTICES`], [`crate::mesh::refuse_too_large`]: too fine is refused;
//! - [`crate::quality::smallest_angle`], [`crate::sanity::sanity`]: angles measured; topology checked.
//!
//! Chosen by crate `session`, `choice.rs`, `derived.rs`.

use crate::boundary::Boundary;
use crate::creases::Creases;
use crate::edges::EdgeTable;
use crate::planar::{Frame, Planar};
use crate::quality::{MeshQuality, smallest_angle};
use crate::refinement::refine;
use crate::sampling::{Sampling, sample};
use crate::seam_match::match_seams;
use crate::size_field::SizeField;
use crate::source::{EdgeSource, MeshSource};
use crate::{AssemblyError, Diagnostic, Stitch};
use std::sync::Arc;
use toile_geometry::{TriangulationError, Vec2};
use toile_pattern::{Draft, Piece, PieceId};

/// Largest number of vertices of a draft.
const MAX_VERTICES: f64 = 5e6;

/// One piece of a draft as a triangle mesh.
#[derive(Clone, Debug)]
pub struct PieceMesh {
    /// Identity of the piece.
    pub piece: PieceId,
    /// Index into the draft's pieces.
    pub draft_piece: usize,
    /// Vertices in the piece's plane (m), those of the boundary loops first.
    pub points: Vec<Vec2>,
    /// Vertex indices of each triangle, wound like the outline.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of each boundary loop in the direction of the outline, the outline first.
    pub loops: Vec<Vec<u32>>,
    /// Vertices of the samples on each edge, ends included.
    pub edge_vertices: Vec<Vec<u32>>,
    /// Arc-length fractions of the samples on each edge, in the order of the vertices.
    pub edge_fractions: Vec<Vec<f64>>,
    /// The shape that the mesh was made from, to be compared with later shapes of the piece.
    pub(crate) source: Arc<MeshSource>,
}

/// Meshed pieces with the stitches between them.
#[derive(Clone, Debug, Default)]
pub struct PieceMeshes {
    /// The sewn pieces in draft order.
    pub pieces: Vec<PieceMesh>,
    /// Pairs of stitched vertices, numbered piece after piece.
    pub stitches: Vec<Stitch>,
    /// Notes for the user.
    pub diagnostics: Vec<Diagnostic>,
    /// Mean edge length that was requested (m).
    pub edge_length: f64,
}

/// Meshes the sewn pieces of a draft. Seams are sampled first, so that the vertices of both sides match, then
/// each piece is triangulated on its own.
///
/// `edge_length` is the mean edge length requested (m). The same draft gives the same meshes.
///
/// # Errors
/// An edge length out of range, an outline that cannot be meshed, a seam to something that does not exist.
pub fn mesh_pieces(draft: &Draft, edge_length: f64) -> Result<PieceMeshes, AssemblyError> {
    let chosen: Vec<bool> = draft.pieces.iter().map(|p| p.sewn).collect();
    mesh_chosen(draft, &chosen, edge_length)
}

pub(crate) fn mesh_chosen(
    draft: &Draft,
    chosen: &[bool],
    edge_length: f64,
) -> Result<PieceMeshes, AssemblyError> {
    if !(5e-4..=1.0).contains(&edge_length) {
        return Err(AssemblyError::EdgeLength(edge_length));
    }
    if !chosen.contains(&true) {
        return Err(AssemblyError::Empty);
    }
    let table = EdgeTable::new(draft, chosen, edge_length)?;
    refuse_too_large(&table, edge_length)?;
    let matching = match_seams(draft, &table, chosen, edge_length)?;
    let sampling = sample(draft, &table, &matching, edge_length);
    let mut meshes = PieceMeshes {
        diagnostics: matching.diagnostics,
        edge_length,
        ..PieceMeshes::default()
    };
    let mut first_vertex = vec![0; draft.pieces.len()];
    let mut count = 0;
    for (index, piece) in draft.pieces.iter().enumerate() {
        first_vertex[index] = count;
        if chosen[index] {
            let boundary = Boundary::new(piece, index, &table, &sampling)?;
            let creases = Creases::new(piece, &boundary, edge_length);
            meshes.diagnostics.extend(creases.note(piece));
            let planar = mesh_piece(piece, &boundary, &creases, edge_length)?;
            let edges = EdgeSource::of_piece(piece, table.of_piece(index), &sampling);
            let source = MeshSource::new(piece, planar.points.clone(), edges, creases);
            count += planar.points.len();
            meshes.pieces.push(PieceMesh {
                piece: piece.id,
                draft_piece: index,
                triangles: wound(&planar.triangles, boundary.counter_clockwise),
                points: planar.points,
                loops: (boundary.loops.iter())
                    .map(|r| r.clone().map(|v| v as u32).collect())
                    .collect(),
                edge_vertices: (boundary.samples.iter())
                    .map(|list| list.iter().map(|&v| v as u32).collect())
                    .collect(),
                edge_fractions: sampling.fractions[table.of_piece(index)].to_vec(),
                source: Arc::new(source),
            });
        }
    }
    meshes.stitches = stitches(draft, &table, &sampling, &meshes.pieces, &first_vertex);
    Ok(meshes)
}

fn refuse_too_large(table: &EdgeTable, edge_length: f64) -> Result<(), AssemblyError> {
    let mut boxes: Vec<[Vec2; 2]> = Vec::new();
    let mut piece = usize::MAX;
    for edge in &table.edges {
        if edge.piece != piece {
            piece = edge.piece;
            boxes.push([edge.curve.start(); 2]);
        }
        if let Some([low, high]) = boxes.last_mut() {
            for p in edge.curve.defining_points() {
                (*low, *high) = (low.inf(&p), high.sup(&p));
            }
        }
    }
    let area: f64 = boxes.iter().map(|[l, h]| (h - l).x * (h - l).y).sum();
    let length: f64 = table.edges.iter().map(|e| e.length).sum();
    let vertices = area / (edge_length * edge_length) + length / edge_length;
    if vertices > MAX_VERTICES {
        return Err(AssemblyError::TooLarge(vertices.round()));
    }
    Ok(())
}

/// Stitches between vertices, which are numbered piece after piece.
pub(crate) fn stitches(
    draft: &Draft,
    table: &EdgeTable,
    sampling: &Sampling,
    pieces: &[PieceMesh],
    first_vertex: &[usize],
) -> Vec<Stitch> {
    let mut mesh_of = vec![usize::MAX; draft.pieces.len()];
    for (k, mesh) in pieces.iter().enumerate() {
        mesh_of[mesh.draft_piece] = k;
    }
    let vertex = |(edge, sample): (usize, usize)| {
        let piece = table.edges[edge].piece;
        let local = edge - table.first[piece];
        pieces[mesh_of[piece]].edge_vertices[local][sample] + first_vertex[piece] as u32
    };
    let mut stitches: Vec<Stitch> = sampling
        .stitches
        .iter()
        .map(|s| Stitch {
            vertices: s.samples.map(vertex),
            seam: draft.seams[s.draft_seam].id,
            draft_seam: s.draft_seam,
        })
        .filter(|s| s.vertices[0] != s.vertices[1])
        .collect();
    // A joint between two edges of one outline is a single vertex, found twice.
    stitches.dedup();
    stitches
}

fn mesh_piece(
    piece: &Piece,
    boundary: &Boundary,
    creases: &Creases,
    edge_length: f64,
) -> Result<Planar, AssemblyError> {
    let mut points = boundary.points.clone();
    points.extend(&creases.points);
    let walls: Vec<[usize; 2]> = boundary
        .segments()
        .map(|[a, b]| {
            if boundary.counter_clockwise {
                [a, b]
            } else {
                [b, a]
            }
        })
        .collect();
    let frame = Frame {
        walls,
        fixed: points.len(),
        creases: creases.segments.clone(),
    };
    let crease_segments: Vec<[Vec2; 2]> =
        frame.creases.iter().map(|c| c.map(|v| points[v])).collect();
    let field = SizeField::new(boundary, &crease_segments, edge_length);
    let seeds = field.lattice(boundary);
    refine(points, seeds, &frame, &field).map_err(|e| planar_error(piece, e))
}

fn planar_error(piece: &Piece, error: TriangulationError) -> AssemblyError {
    let reason = match error {
        TriangulationError::Duplicate => "two points of the outline coincide",
        TriangulationError::Conflict(_) => "the outline crosses itself",
        TriangulationError::Flat => "the outline has no area",
        TriangulationError::Coordinate => "a coordinate is too large or too small",
    };
    AssemblyError::Outline {
        piece: piece.name.clone(),
        reason: reason.to_owned(),
        remedy: "move its points apart".to_owned(),
    }
}

/// Gives counter-clockwise triangles the winding of the outline.
fn wound(triangles: &[[usize; 3]], counter_clockwise: bool) -> Vec<[u32; 3]> {
    let turned = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|v| v as u32);
        if counter_clockwise {
            [a, b, c]
        } else {
            [a, c, b]
        }
    };
    triangles.iter().map(turned).collect()
}

impl PieceMesh {
    /// Area of the triangles (m2).
    pub fn area(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| self.points[v as usize]);
                0.5 * (b - a).perp(&(c - a)).abs()
            })
            .sum()
    }

    /// Angles and edge lengths of the mesh.
    pub fn quality(&self) -> MeshQuality {
        let boundary_count: usize = self.loops.iter().map(Vec::len).sum();
        let angles = self.outline_angles(boundary_count);
        let mut quality = MeshQuality {
            triangles: self.triangles.len(),
            smallest_angle: f64::INFINITY,
            smallest_free_angle: f64::INFINITY,
            shortest_edge: f64::INFINITY,
            ..MeshQuality::default()
        };
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for t in &self.triangles {
            let angle = smallest_angle(t.map(|v| self.points[v as usize]));
            quality.smallest_angle = quality.smallest_angle.min(angle);
            quality.mean_smallest_angle += angle;
            let limit = 20f64.to_radians();
            let forced = t
                .iter()
                .any(|&v| angles.get(v as usize).is_some_and(|&a| a < limit));
            if !forced {
                quality.smallest_free_angle = quality.smallest_free_angle.min(angle);
                quality.under_20 += usize::from(angle < limit);
            }
            let mut on_boundary = 0;
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                edges.push([a.min(b), a.max(b)]);
                on_boundary += usize::from((t[k] as usize) < boundary_count);
            }
            if on_boundary == 3 && !self.cuts_a_corner(t) {
                quality.bridging += 1;
            }
        }
        quality.mean_smallest_angle /= self.triangles.len().max(1) as f64;
        edges.sort_unstable();
        edges.dedup();
        for &[a, b] in &edges {
            let length = (self.points[a as usize] - self.points[b as usize]).norm();
            quality.mean_edge += length / edges.len() as f64;
            quality.shortest_edge = quality.shortest_edge.min(length);
            quality.longest_edge = quality.longest_edge.max(length);
        }
        quality
    }

    /// Whether a triangle of boundary vertices joins three consecutive vertices of a loop.
    fn cuts_a_corner(&self, triangle: &[u32; 3]) -> bool {
        self.loops.iter().any(|list| {
            let Some(&first) = list.first() else {
                return false;
            };
            let count = list.len() as u32;
            let places = triangle.map(|v| v.wrapping_sub(first));
            places.iter().all(|&p| p < count)
                && places.iter().any(|&p| {
                    places.contains(&((p + 1) % count))
                        && places.contains(&((p + count - 1) % count))
                })
        })
    }

    /// Angle of the cloth at each boundary vertex (rad).
    fn outline_angles(&self, boundary_count: usize) -> Vec<f64> {
        let mut angles = vec![0.0; boundary_count];
        for t in &self.triangles {
            for k in 0..3 {
                let v = t[k] as usize;
                if v < boundary_count {
                    let p = |j: usize| self.points[t[(k + j) % 3] as usize];
                    angles[v] += (p(1) - p(0)).angle(&(p(2) - p(0)));
                }
            }
        }
        angles
    }
}
