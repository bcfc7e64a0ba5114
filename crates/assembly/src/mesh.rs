//! Pieces of a draft as triangle meshes in their planes, with matching seams.

use crate::boundary::Boundary;
use crate::chain::match_seams;
use crate::edges::EdgeTable;
use crate::planar::{Frame, Planar, PlanarError};
use crate::quality::{MeshQuality, smallest_angle};
use crate::refinement::refine;
use crate::sampling::{Sampling, sample};
use crate::size_field::SizeField;
use crate::{AssemblyError, Diagnostic, Stitch};
use toile_geometry::{Vec2, segments_cross};
use toile_pattern::{Draft, Piece};

/// Most vertices a draft may ask for.
const MOST_VERTICES: f64 = 5e6;

/// One piece of a draft as a triangle mesh.
#[derive(Clone, Debug)]
pub struct PieceMesh {
    /// Index into the draft's pieces.
    pub draft_piece: usize,
    /// Vertices in the piece's plane [m]: boundary loops first.
    pub points: Vec<Vec2>,
    /// Corners, wound like the outline.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of each boundary loop in the direction of the outline: outline first.
    pub loops: Vec<Vec<u32>>,
    /// Vertices of each edge's samples, ends included.
    pub edge_vertices: Vec<Vec<u32>>,
}

/// Meshed pieces and how they are sewn.
#[derive(Clone, Debug, Default)]
pub struct PieceMeshes {
    /// The sewn pieces in draft order.
    pub pieces: Vec<PieceMesh>,
    /// Pairs of vertices; numbered piece after piece.
    pub stitches: Vec<Stitch>,
    /// What is worth telling.
    pub diagnostics: Vec<Diagnostic>,
}

/// Meshes the sewn pieces of a draft: seams sampled first, so that both sides match vertex to
/// vertex, then each piece triangulated on its own.
///
/// `edge_length` [m] is the mean edge asked for. The same draft gives the same meshes.
///
/// # Errors
/// An edge length out of range, an outline that cannot be meshed, a seam to nothing.
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
        ..PieceMeshes::default()
    };
    let mut first_vertex = vec![0; draft.pieces.len()];
    let mut count = 0;
    for (index, piece) in draft.pieces.iter().enumerate() {
        first_vertex[index] = count;
        if chosen[index] {
            let boundary = Boundary::new(piece, index, &table, &sampling)?;
            let mesh = mesh_piece(piece, boundary, edge_length, &mut meshes.diagnostics)?;
            count += mesh.points.len();
            meshes.pieces.push(PieceMesh {
                draft_piece: index,
                ..mesh
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
    if vertices > MOST_VERTICES {
        return Err(AssemblyError::TooLarge(vertices.round()));
    }
    Ok(())
}

fn stitches(
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
    // A joint between two edges of one outline is one vertex, met twice.
    stitches.dedup();
    stitches
}

fn mesh_piece(
    piece: &Piece,
    boundary: Boundary,
    edge_length: f64,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<PieceMesh, AssemblyError> {
    let (creases, crease_points) = creases(piece, &boundary, edge_length, diagnostics);
    let mut points = boundary.points.clone();
    points.extend(crease_points);
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
        creases,
    };
    let crease_segments: Vec<[Vec2; 2]> =
        frame.creases.iter().map(|c| c.map(|v| points[v])).collect();
    let field = SizeField::new(&boundary, &crease_segments, edge_length);
    let seeds = field.lattice(&boundary);
    let planar = refine(points, seeds, &frame, &field).map_err(|e| planar_error(piece, e))?;
    Ok(to_mesh(&boundary, planar))
}

fn planar_error(piece: &Piece, error: PlanarError) -> AssemblyError {
    let reason = match error {
        PlanarError::Duplicate => "two points of the outline coincide",
        PlanarError::Conflict(_) => "the outline crosses itself",
        PlanarError::Coordinate => "a coordinate is too large or too small",
    };
    AssemblyError::Outline {
        piece: piece.name.clone(),
        reason: reason.to_owned(),
        remedy: "move its points apart".to_owned(),
    }
}

fn to_mesh(boundary: &Boundary, planar: Planar) -> PieceMesh {
    let triangles = planar
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| v as u32);
            if boundary.counter_clockwise {
                [a, b, c]
            } else {
                [a, c, b]
            }
        })
        .collect();
    let narrow = |list: &Vec<usize>| list.iter().map(|&v| v as u32).collect();
    PieceMesh {
        draft_piece: 0,
        points: planar.points,
        triangles,
        loops: boundary
            .loops
            .iter()
            .map(|r| r.clone().map(|v| v as u32).collect())
            .collect(),
        edge_vertices: boundary.samples.iter().map(narrow).collect(),
    }
}

/// Samples the internal lines of a piece: the segments the mesh follows, as pairs of vertices
/// numbered after the boundary's, and their points [m].
fn creases(
    piece: &Piece,
    boundary: &Boundary,
    edge_length: f64,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Vec<[usize; 2]>, Vec<Vec2>) {
    let walls: Vec<[Vec2; 2]> = boundary
        .segments()
        .map(|s| s.map(|v| boundary.points[v]))
        .collect();
    let field = SizeField::new(boundary, &[], edge_length);
    let base = boundary.points.len();
    let (mut segments, mut points): (Vec<[usize; 2]>, Vec<Vec2>) = Default::default();
    let mut left_out = 0;
    for line in &piece.internal_lines {
        let mut previous: Option<usize> = None;
        for curve in line.curves.iter().filter(|c| c.is_finite()) {
            let count = (curve.length() / edge_length).round().clamp(1.0, 1e5) as usize;
            for p in curve.sample(0.0, 1.0, count) {
                if previous.is_some_and(|v| (points[v] - p).norm() < 1e-6) {
                    continue;
                }
                let clear = points.iter().all(|q| (q - p).norm() > 0.4 * edge_length);
                if field.boundary_distance(p) < 0.5 * edge_length || !clear || !boundary.contains(p)
                {
                    previous = None;
                    left_out += usize::from(!clear);
                    continue;
                }
                points.push(p);
                let here = points.len() - 1;
                if let Some(before) = previous {
                    let segment = [points[before], p];
                    let free = walls.iter().all(|w| !segments_cross(*w, segment))
                        && segments.iter().all(|s: &[usize; 2]| {
                            s.contains(&(before + base))
                                || !segments_cross(s.map(|v| points[v - base]), segment)
                        });
                    if free {
                        segments.push([before + base, here + base]);
                    } else {
                        left_out += 1;
                    }
                }
                previous = Some(here);
            }
        }
    }
    if left_out > 0 {
        diagnostics.push(Diagnostic::note(
            &piece.name,
            format!("{left_out} points of internal lines cross others and are not meshed exactly"),
            "keep internal lines apart",
        ));
    }
    (segments, points)
}

impl PieceMesh {
    /// Area of the triangles [m2].
    pub fn area(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| self.points[v as usize]);
                0.5 * (b - a).perp(&(c - a)).abs()
            })
            .sum()
    }

    /// Angles and edge lengths.
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

    /// Whether a triangle of boundary vertices joins three neighbours on a loop.
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

    /// Angle of the cloth at each boundary vertex [rad].
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
