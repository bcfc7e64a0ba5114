//! Pieces that their file places on both sides of the body, such as the halves of a hood: both are moved
//! together if the seams between them would close through the body.

use crate::role::Role;
use crate::{Diagnostic, PieceMeshes, PlacementBody, Stitch};
use toile_geometry::{TriangleMesh, Vec3};
use toile_pattern::Draft;

/// Smallest sideways component of the normal of a piece that counts as lying at the side of the body.
const SIDEWAYS: f64 = 0.7;
/// Largest move of such pieces (m), and step of the search (m).
const FARTHEST: f64 = 0.2;
const STEP: f64 = 0.01;
/// Extra move beyond the position at which the seams are clear (m).
const SPARE: f64 = 0.02;

/// The pieces of a draft with their meshes and roles.
pub(crate) struct PlacedPieces<'a> {
    pub draft: &'a Draft,
    pub meshes: &'a PieceMeshes,
    pub roles: &'a [Role],
}

/// Moves pairs of opposite pieces that are sewn to each other, back or forward, until no stitch between them
/// crosses the body on its closing path.
pub(crate) fn clear_closing_seams(
    pieces: &PlacedPieces,
    body: &PlacementBody,
    positions: &mut [Vec<Vec3>],
    diagnostics: &mut Vec<Diagnostic>,
) {
    for a in 0..positions.len() {
        for b in a + 1..positions.len() {
            if !pieces.are_opposite([a, b], positions) {
                continue;
            }
            let ways = pieces.ways([a, b], positions);
            if ways.is_empty() || blocked(&ways, body, 0.0) == 0 {
                continue;
            }
            let steps = (FARTHEST / STEP) as i32;
            let moves = (1..=steps).flat_map(|k| [-f64::from(k), f64::from(k)].map(|k| k * STEP));
            let found = moves.into_iter().find(|&by| blocked(&ways, body, by) == 0);
            let Some(by) = found.map(|by| by + SPARE * by.signum()) else {
                continue;
            };
            for p in positions[a].iter_mut() {
                p.z += by;
            }
            for p in positions[b].iter_mut() {
                p.z += by;
            }
            let name = |k: usize| {
                pieces.draft.pieces[pieces.meshes.pieces[k].draft_piece]
                    .name
                    .as_str()
            };
            let names = [a, b].map(name);
            let way = if by < 0.0 { "back" } else { "forward" };
            diagnostics.push(Diagnostic::note(
                names[0],
                format!(
                    "its seams with \"{}\" would close through the body: both are moved {way} by {:.0} mm",
                    names[1],
                    by.abs() * 1e3
                ),
                "place them so that the body lies between their other edges",
            ));
        }
    }
}

impl PlacedPieces<'_> {
    /// Whether two pieces are placed by their file on opposite sides of the body.
    fn are_opposite(&self, pair: [usize; 2], positions: &[Vec<Vec3>]) -> bool {
        let sides = pair.map(|k| match self.roles[k] {
            Role::Placed(place) if !positions[k].is_empty() => {
                let across = (place.rotation * Vec3::z()).x.abs();
                let middle = positions[k].iter().map(|p| p.x).sum::<f64>();
                (across > SIDEWAYS).then(|| middle.signum())
            }
            _ => None,
        });
        matches!(sides, [Some(a), Some(b)] if a * b < 0.0)
    }

    /// Closing paths of the stitches between two pieces: straight lines between the stitched vertices.
    fn ways(&self, pair: [usize; 2], positions: &[Vec<Vec3>]) -> Vec<[Vec3; 2]> {
        let mut ends = Vec::new();
        for mesh in &self.meshes.pieces {
            ends.push(ends.last().copied().unwrap_or(0) + mesh.points.len());
        }
        let place = |v: u32| {
            let piece = ends.partition_point(|&end| end <= v as usize);
            let first = ends[piece] - self.meshes.pieces[piece].points.len();
            (piece, positions[piece].get(v as usize - first).copied())
        };
        let between = |stitch: &Stitch| match stitch.vertices.map(place) {
            [(a, Some(p)), (b, Some(q))] if [a.min(b), a.max(b)] == pair => Some([p, q]),
            _ => None,
        };
        self.meshes.stitches.iter().filter_map(between).collect()
    }
}

/// Number of closing paths, moved by `by` along the depth of the body (m), that cross the skin.
fn blocked(ways: &[[Vec3; 2]], body: &PlacementBody, by: f64) -> usize {
    let mut slivers = TriangleMesh::default();
    for &[a, b] in ways {
        let first = slivers.positions.len() as u32;
        let [a, b] = [a, b].map(|p| p + Vec3::z() * by);
        slivers.positions.extend([a, b, b + Vec3::y() * 1e-4]);
        slivers.triangles.push([first, first + 1, first + 2]);
    }
    let mut crossing: Vec<u32> = body
        .skin
        .intersections_with(&slivers)
        .iter()
        .map(|pair| pair[0])
        .collect();
    crossing.dedup();
    crossing.len()
}
