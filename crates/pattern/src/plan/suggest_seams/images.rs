//! Mirror images: pairs of pieces, and halves of one piece, that are alike but for the side of the wearer.

use super::edges::{SeamEdge, wrapped};

/// Largest difference in length of two edges that are images of each other, as a part of their length (1).
const SAME_LENGTH: f64 = 0.02;
/// Largest difference of an angle between images (rad).
const SAME_ANGLE: f64 = 0.05;
/// Cost for a piece to be its own image: another piece that is an image of it is preferred (1).
const ITSELF: f64 = 0.05;

/// For each edge, its mirror image: an edge of another piece, or of the other half of its own piece. `None`:
/// the piece has no image.
///
/// Two outlines are images of each other if the edges of one, walked the other way, have the lengths and
/// angles of the other's. Of several images the one nearest to the mirror image in space is taken, else the
/// one that keeps the grain upright.
pub(super) fn mirror_images(
    edges: &[SeamEdge],
    away: &dyn Fn(usize, usize) -> Option<f64>,
) -> Vec<Option<usize>> {
    let mut images = vec![None; edges.len()];
    let rings = outlines(edges);
    for own in &rings {
        let mut best: Option<(f64, &[usize], usize)> = None;
        for other in rings.iter().filter(|other| other.len() == own.len()) {
            for shift in 0..own.len() {
                let Some(unlike) = unlike(edges, own, other, shift) else {
                    continue;
                };
                let image = other[shift % other.len()];
                let (a, b) = (&edges[own[0]], &edges[image]);
                let upright = 0.5 * (1.0 - (a.direction + b.direction).cos());
                let itself = if a.piece == b.piece { ITSELF } else { 0.0 };
                let away = away(own[0], image).unwrap_or(0.0);
                let cost = 0.1 * unlike + 0.5 * upright + itself + (10.0 * away).min(3.0);
                if best.is_none_or(|(least, ..)| cost < least - 1e-9) {
                    best = Some((cost, other, shift));
                }
            }
        }
        if let Some((_, other, shift)) = best {
            let count = own.len();
            for (k, &edge) in own.iter().enumerate() {
                images[edge] = Some(other[(shift + count - k) % count]);
            }
        }
    }
    // Only images that name each other are kept.
    let of = |edge: usize| images[edge].filter(|&image| images[image] == Some(edge));
    (0..edges.len()).map(of).collect()
}

/// The outlines of all pieces: rings of edges, without holes.
fn outlines(edges: &[SeamEdge]) -> Vec<Vec<usize>> {
    let mut rings: Vec<Vec<usize>> = Vec::new();
    let mut known = None;
    for (first, edge) in edges.iter().enumerate() {
        if known == Some(edge.piece) {
            continue;
        }
        known = Some(edge.piece);
        let mut ring = vec![first];
        let mut next = edge.next;
        while next != first {
            ring.push(next);
            next = edges[next].next;
        }
        rings.push(ring);
    }
    rings
}

/// By how much two outlines differ from images of each other, as a part of what is allowed (1). `None`: more.
fn unlike(edges: &[SeamEdge], own: &[usize], other: &[usize], shift: usize) -> Option<f64> {
    let count = own.len();
    let mut most = 0.0_f64;
    for (k, &edge) in own.iter().enumerate() {
        let (a, b) = (&edges[edge], &edges[other[(shift + count - k) % count]]);
        let length = (a.length - b.length).abs() / a.length.max(b.length).max(1e-9);
        let corner = wrapped(a.angles[0] - b.angles[1]).abs();
        let bend = (a.turning - b.turning).abs();
        most = most
            .max(length / SAME_LENGTH)
            .max(corner / SAME_ANGLE)
            .max(bend / (2.0 * SAME_ANGLE));
        if most > 1.0 {
            return None;
        }
    }
    Some(most)
}
