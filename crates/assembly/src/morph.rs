//! Meshes that follow an edit of the pattern: the same triangles with new vertex positions.

use crate::boundary::Boundary;
use crate::creases::left_out_note;
use crate::edges::EdgeTable;
use crate::harmonic::HarmonicWeights;
use crate::mesh::stitches;
use crate::quality::smallest_angle;
use crate::sampling::Sampling;
use crate::seam_match::{Nodes, match_seams};
use crate::source::EdgeSource;
use crate::{AssemblyError, PieceMesh, PieceMeshes, Stitch};
use std::collections::{HashMap, VecDeque};
use toile_geometry::{Vec2, orient2d};
use toile_pattern::{Draft, Piece, PieceId, SeamOrigin};

/// Smallest allowed angle of a triangle after an edit (rad), 15 degrees: membrane forces of sharper triangles
/// are stiff across them and inaccurate along them. Fresh meshes have angles over 25 degrees.
const MIN_ANGLE: f64 = 0.261_799_387_799_149_4;
/// Largest decrease of the angle of a triangle that was sharper than that from the start (rad), 1 degree: a
/// narrow corner of an outline has such triangles in every mesh.
const ANGLE_LOSS: f64 = 0.017_453_292_519_943_295;
/// Allowed range of an edge's length, relative to its original length.
const LENGTH_SHARES: [f64; 2] = [0.5, 1.5];
/// A node that moved by less than this fraction of its edge counts as unmoved: the search for the position of
/// a notch, and fractions of a chain's length, are no more accurate.
const SAME_FRACTION: f64 = 1e-9;

/// The reason why meshes cannot follow an edit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MorphError {
    /// Identities of pieces that differ too much from the meshed ones: sorted, each once.
    #[error("{} pieces changed too much for their triangles to follow; mesh the draft anew", .0.len())]
    NeedsRemesh(Vec<PieceId>),
    /// The edited draft cannot be meshed at all.
    #[error(transparent)]
    Draft(#[from] AssemblyError),
}

/// Applies the shapes of an edited draft to the meshes of an earlier one: triangles, stitched vertices and
/// their order stay, the points move.
///
/// Samples of the outline keep their fraction of their edge; between two nodes that moved (ends of spans,
/// notches) they keep their fraction of the stretch between them. Points of internal lines keep their
/// fraction of their curve. All other vertices follow by harmonic weights from their original positions: the
/// result depends on the original mesh and on `draft`, not on edits in between, and a piece that returns to
/// its original shape gets its original points, bit by bit.
///
/// Cost: one solution for each piece with a changed outline or changed internal lines, and one factorisation
/// when the first copy of its mesh changes.
///
/// # Errors
/// [`MorphError::NeedsRemesh`] if pieces, edges or internal lines were added, removed or reordered; if seams
/// sew other points, or need more or fewer; if an outline crosses itself, a triangle turned over, has an
/// angle under 15 degrees (or lost 1 degree, if it was sharper originally) or an edge under half or over 1.5
/// times its original length. [`MorphError::Draft`] if the draft cannot be meshed, see
/// [`crate::mesh_pieces`].
pub fn morph(meshes: &PieceMeshes, draft: &Draft) -> Result<PieceMeshes, MorphError> {
    let chosen: Vec<bool> = draft.pieces.iter().map(|p| p.sewn).collect();
    let mut pieces = meshes.pieces.clone();
    find_pieces(&mut pieces, draft)?;
    let table = EdgeTable::measured(draft, &chosen)?;
    let matching = match_seams(draft, &table, &chosen, meshes.edge_length)?;
    let (mut sampling, mut fits) = sampled(&pieces, draft, &table, &matching.nodes);
    let mut sewn = Vec::new();
    if !fits.contains(&false) {
        sampling.sew(&table, &matching);
        let fresh = stitches(
            draft,
            &table,
            &sampling,
            &pieces,
            &first_vertices(&pieces, draft),
        );
        match renumbered(&meshes.stitches, &fresh) {
            Ok(stitches) => sewn = stitches,
            Err(others) => mark_owners(&pieces, &others, &mut fits),
        }
    }
    for (mesh, fits) in pieces.iter_mut().zip(&mut fits) {
        *fits = *fits && mesh.follow(&draft.pieces[mesh.draft_piece], &table, &sampling);
    }
    if fits.contains(&false) {
        let stale = pieces.iter().zip(&fits).filter(|(_, fits)| !**fits);
        return Err(needs_remesh(stale.map(|(mesh, _)| mesh.piece).collect()));
    }
    let mut diagnostics = matching.diagnostics;
    diagnostics.extend(
        pieces.iter().filter_map(|mesh| {
            left_out_note(&draft.pieces[mesh.draft_piece], mesh.source.left_out)
        }),
    );
    Ok(PieceMeshes {
        pieces,
        stitches: sewn,
        diagnostics,
        edge_length: meshes.edge_length,
    })
}

fn needs_remesh(mut pieces: Vec<PieceId>) -> MorphError {
    pieces.sort_unstable();
    pieces.dedup();
    MorphError::NeedsRemesh(pieces)
}

/// Finds the meshed pieces in a draft, which must sew the same ones in the same order.
fn find_pieces(pieces: &mut [PieceMesh], draft: &Draft) -> Result<(), MorphError> {
    let sewn: Vec<usize> = (0..draft.pieces.len())
        .filter(|&k| draft.pieces[k].sewn)
        .collect();
    let id = |&k: &usize| draft.pieces[k].id;
    if pieces.iter().map(|m| m.piece).eq(sewn.iter().map(id)) {
        for (mesh, k) in pieces.iter_mut().zip(sewn) {
            mesh.draft_piece = k;
        }
        return Ok(());
    }
    let old: Vec<PieceId> = pieces.iter().map(|m| m.piece).collect();
    let new: Vec<PieceId> = sewn.iter().map(id).collect();
    let [removed, added] = [(&old, &new), (&new, &old)]
        .map(|(these, others)| these.iter().filter(|p| !others.contains(p)).copied());
    let mut changed: Vec<PieceId> = removed.chain(added).collect();
    if changed.is_empty() {
        // The same pieces in another order.
        let both = old.iter().zip(&new).filter(|(a, b)| a != b);
        changed = both.flat_map(|(a, b)| [*a, *b]).collect();
    }
    Err(needs_remesh(changed))
}

/// The samples of all edges, empty for pieces with other edges or other nodes; and for each piece whether it
/// has the same.
fn sampled(
    pieces: &[PieceMesh],
    draft: &Draft,
    table: &EdgeTable,
    nodes: &Nodes,
) -> (Sampling, Vec<bool>) {
    let mut sampling = Sampling {
        fractions: vec![Vec::new(); table.edges.len()],
        nodes: vec![Vec::new(); table.edges.len()],
        stitches: Vec::new(),
    };
    let mut fits = Vec::with_capacity(pieces.len());
    for mesh in pieces {
        let range = table.of_piece(mesh.draft_piece);
        let edges = &mesh.source.edges;
        let fractions: Option<Vec<Vec<f64>>> = (edges.iter().zip(range.clone()))
            .map(|(edge, k)| fractions(edge, nodes, k))
            .collect();
        let fractions = fractions.filter(|_| mesh.source.is_of(&draft.pieces[mesh.draft_piece]));
        fits.push(fractions.is_some());
        for ((k, edge), list) in range.zip(edges).zip(fractions.into_iter().flatten()) {
            sampling.fractions[k] = list;
            sampling.nodes[k].clone_from(&edge.nodes);
        }
    }
    (sampling, fits)
}

/// Fractions of an edge's samples, keeping their fraction between nodes; `None` if the number of nodes
/// differs.
fn fractions(source: &EdgeSource, nodes: &Nodes, edge: usize) -> Option<Vec<f64>> {
    let list = &nodes.on_edge[edge];
    if list.len() != source.nodes.len() {
        return None;
    }
    let mut fractions = source.fractions.clone();
    let ends = list.iter().zip(&source.nodes);
    let ends: Vec<[f64; 2]> = ends
        .map(|(&node, &sample)| {
            let (old, new) = (source.fractions[sample], nodes.all[node].fraction);
            let moved = (new - old).abs() > SAME_FRACTION;
            [old, if moved { new } else { old }]
        })
        .collect();
    for (pair, samples) in ends.windows(2).zip(source.nodes.windows(2)) {
        let ([old, new], [old_end, new_end]) = (pair[0], pair[1]);
        if [old, old_end] == [new, new_end] {
            continue;
        }
        let stretched = (new_end - new) / (old_end - old);
        let range = samples[0]..samples[1];
        for (fraction, was) in fractions[range.clone()]
            .iter_mut()
            .zip(&source.fractions[range])
        {
            *fraction = new + (was - old) * stretched;
        }
        fractions[samples[1]] = new_end;
    }
    Some(fractions)
}

/// Index of the first vertex of each piece of the draft.
fn first_vertices(pieces: &[PieceMesh], draft: &Draft) -> Vec<usize> {
    let mut first = vec![0; draft.pieces.len()];
    let mut count = 0;
    for mesh in pieces {
        first[mesh.draft_piece] = count;
        count += mesh.points.len();
    }
    first
}

/// The old stitches in their order, numbered by the seams of the new draft.
///
/// # Errors
/// Vertices that are sewn in only one of the two.
fn renumbered(old: &[Stitch], new: &[Stitch]) -> Result<Vec<Stitch>, Vec<u32>> {
    let mut known: HashMap<(SeamOrigin, [u32; 2]), VecDeque<usize>> = HashMap::new();
    for s in new {
        let seams = known.entry((s.seam, s.vertices)).or_default();
        seams.push_back(s.draft_seam);
    }
    let mut others = Vec::new();
    let mut stitches = Vec::with_capacity(old.len());
    for &stitch in old {
        let found = known.get_mut(&(stitch.seam, stitch.vertices));
        match found.and_then(VecDeque::pop_front) {
            Some(draft_seam) => stitches.push(Stitch {
                draft_seam,
                ..stitch
            }),
            None => others.extend(stitch.vertices),
        }
    }
    let added = known.iter().filter(|(_, seams)| !seams.is_empty());
    others.extend(added.flat_map(|((_, vertices), _)| *vertices));
    if others.is_empty() {
        Ok(stitches)
    } else {
        Err(others)
    }
}

/// Marks the pieces of some vertices as unfit.
fn mark_owners(pieces: &[PieceMesh], vertices: &[u32], fits: &mut [bool]) {
    let mut first = 0;
    for (mesh, fits) in pieces.iter().zip(fits) {
        let range = first..first + mesh.points.len();
        *fits &= !vertices.iter().any(|&v| range.contains(&(v as usize)));
        first = range.end;
    }
}

impl PieceMesh {
    /// Moves the vertices to a new shape of the piece with the given samples; returns whether the triangles
    /// are valid there.
    fn follow(&mut self, piece: &Piece, table: &EdgeTable, sampling: &Sampling) -> bool {
        let range = table.of_piece(self.draft_piece);
        self.edge_fractions = sampling.fractions[range].to_vec();
        let source = &self.source;
        if source.has_shape_of(piece, &self.edge_fractions) {
            self.points.clone_from(&source.points);
            return true;
        }
        let boundary = Boundary::sampled(self.draft_piece, table, sampling);
        let mut given = boundary.points.clone();
        for place in &source.line_places {
            let Some(point) = place.point(piece) else {
                return false;
            };
            given.push(point);
        }
        let count = given.len();
        if given == self.points[..count] {
            return true;
        }
        if boundary.check(piece).is_err() {
            return false;
        }
        let way: Vec<Vec2> = (given.iter().zip(&source.points))
            .map(|(new, old)| new - old)
            .collect();
        let weights = || HarmonicWeights::new(&source.points, self.counter_clockwise(), count);
        let Ok(way) = source.weights.displacements(&way, weights) else {
            return false;
        };
        // Given vertices have exact positions, the others are displaced.
        given.extend((source.points.iter().zip(&way).skip(count)).map(|(p, d)| p + d));
        self.points = given;
        let old = &self.source.points;
        let corners = |points: &[Vec2], t: &[u32; 3]| t.map(|v| points[v as usize]);
        (self.triangles.iter()).all(|t| is_sound(corners(old, t), corners(&self.points, t)))
    }

    /// The original triangles, counter-clockwise.
    fn counter_clockwise(&self) -> Vec<[usize; 3]> {
        let p = |v: usize| self.source.points[v];
        let turned = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| v as usize);
            if orient2d(p(a), p(b), p(c)) < 0.0 {
                [a, c, b]
            } else {
                [a, b, c]
            }
        };
        self.triangles.iter().map(turned).collect()
    }
}

/// Whether a triangle has not turned over, and keeps its angles and edges within the limits.
fn is_sound(old: [Vec2; 3], new: [Vec2; 3]) -> bool {
    let side = |[a, b, c]: [Vec2; 3]| orient2d(a, b, c);
    let angle = smallest_angle(old);
    let least = if angle < MIN_ANGLE {
        angle - ANGLE_LOSS
    } else {
        MIN_ANGLE
    };
    side(old) * side(new) > 0.0
        && smallest_angle(new) >= least
        && (0..3).all(|k| {
            let length = |p: [Vec2; 3]| (p[(k + 1) % 3] - p[k]).norm();
            let share = length(new) / length(old);
            (LENGTH_SHARES[0]..=LENGTH_SHARES[1]).contains(&share)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVEN: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.9]];

    fn sound(old: [[f64; 2]; 3], new: [[f64; 2]; 3]) -> bool {
        is_sound(old.map(Vec2::from), new.map(Vec2::from))
    }

    fn scaled(triangle: [[f64; 2]; 3], x: f64, y: f64) -> [[f64; 2]; 3] {
        triangle.map(|p| [p[0] * x, p[1] * y])
    }

    #[test]
    fn lengths_stay_within_half_and_one_and_a_half() {
        for (scale, wanted) in [(0.49, false), (0.51, true), (1.49, true), (1.51, false)] {
            assert_eq!(sound(EVEN, scaled(EVEN, scale, scale)), wanted, "{scale}");
        }
    }

    #[test]
    fn a_triangle_that_turned_over_or_lost_its_area_is_refused() {
        assert!(!sound(EVEN, scaled(EVEN, -1.0, 1.0)));
        assert!(!sound(EVEN, [[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]]));
        assert!(!sound(EVEN, [[0.0, 0.0], [1.0, 0.0], [f64::NAN, 0.9]]));
        // The same winding as the original, whichever that is.
        assert!(sound(scaled(EVEN, -1.0, 1.0), scaled(EVEN, -1.1, 1.0)));
    }

    #[test]
    fn angles_stay_over_fifteen_degrees_or_within_one_of_what_they_were() {
        let with = |degrees: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            [[0.0, 0.0], [1.0, 0.0], [cosine, sine]]
        };
        for (old, new, wanted) in [
            (20.0, 15.01, true),
            (20.0, 14.99, false),
            (14.9, 13.95, true),
            (14.9, 13.85, false),
            (5.0, 4.1, true),
            (5.0, 3.9, false),
        ] {
            assert_eq!(sound(with(old), with(new)), wanted, "{old} {new}");
        }
    }
}
