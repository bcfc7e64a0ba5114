//! How far a motion may go: moves are cut where features would meet, vertex by vertex, until
//! nothing meets any more.

use super::impact::{edge_edge_impact, vertex_face_impact};
use super::proximity::Nearness;
use super::surface::{ClothSurface, FeaturePair};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Share of their distance that two features keep at the least in one move.
const KEPT: f64 = 0.2;

/// Features nearer than this touch already: recovery, not the bound, sees to them [m].
const TOUCHING: f64 = 1e-8;

/// Rounds in which moves are shortened; those that meet even then are stopped.
const ROUNDS: usize = 6;

/// Two features that may meet, and the distance they must keep [m].
#[derive(Clone, Copy, Debug)]
struct Meeting {
    pair: FeaturePair,
    gap: f64,
}

impl Meeting {
    fn time(&self, x: &[Vec3], moves: &[Vec3]) -> Option<f64> {
        let vertices = self.pair.vertices().map(|v| v as usize);
        let start = vertices.map(|v| x[v]);
        let end = vertices.map(|v| x[v] + moves[v]);
        match self.pair {
            FeaturePair::VertexFace(_) => vertex_face_impact(&start, &end, self.gap),
            FeaturePair::EdgeEdge(_) => edge_edge_impact(&start, &end, self.gap),
        }
    }
}

/// Shortens `moves` so that no two features of the cloth meet on the way; pairs with a tangled
/// vertex on either side are let through. Returns the number of vertices held back.
pub fn bound_moves(
    surface: &mut ClothSurface,
    tangled: &[bool],
    x: &[Vec3],
    moves: &mut [Vec3],
) -> usize {
    let target: Vec<Vec3> = x.iter().zip(&*moves).map(|(x, d)| x + d).collect();
    let near = surface.near_triangles(x, &target, 0.0);
    let mut meetings = meetings(surface, &near, tangled, x, moves);
    let mut held = vec![false; x.len()];
    let mut round = 0;
    while !meetings.is_empty() {
        let times: Vec<Option<f64>> = meetings.par_iter().map(|m| m.time(x, moves)).collect();
        let mut share = vec![1.0f64; x.len()];
        let mut met = false;
        for (meeting, time) in meetings.iter().zip(&times) {
            let Some(time) = *time else { continue };
            met = true;
            let share_of = if round < ROUNDS { time } else { 0.0 };
            for v in meeting.pair.vertices() {
                share[v as usize] = share[v as usize].min(share_of);
            }
        }
        if !met {
            break;
        }
        for (v, &share) in share.iter().enumerate() {
            if share < 1.0 {
                moves[v] *= share;
                held[v] = true;
            }
        }
        meetings.retain(|m| {
            m.pair
                .vertices()
                .iter()
                .any(|&v| moves[v as usize] != Vec3::zeros())
        });
        round += 1;
    }
    held.iter().filter(|&&h| h).count()
}

fn meetings(
    surface: &ClothSurface,
    near: &[[u32; 2]],
    tangled: &[bool],
    x: &[Vec3],
    moves: &[Vec3],
) -> Vec<Meeting> {
    let found: Vec<Vec<Meeting>> = near
        .par_chunks(512)
        .map(|pairs| {
            let mut found = Vec::new();
            for &pair in pairs {
                surface.features(pair, |pair| {
                    let vertices = pair.vertices();
                    let knot = |range: std::ops::Range<usize>| {
                        vertices[range].iter().any(|&v| tangled[v as usize])
                    };
                    let cut = if matches!(pair, FeaturePair::VertexFace(_)) {
                        1
                    } else {
                        2
                    };
                    if knot(0..cut) && knot(cut..4) {
                        return;
                    }
                    found.extend(meeting(pair, x, moves));
                });
            }
            found
        })
        .collect();
    found.concat()
}

/// A pair that may meet: its distance is less than the way its vertices go.
fn meeting(pair: FeaturePair, x: &[Vec3], moves: &[Vec3]) -> Option<Meeting> {
    let vertices = pair.vertices();
    let mean = vertices.iter().map(|&v| moves[v as usize]).sum::<Vec3>() / 4.0;
    let way = vertices.iter().map(|&v| (moves[v as usize] - mean).norm());
    // Each side goes at most this far against the mean of all.
    let reach = 2.0 * way.fold(0.0, f64::max) / (1.0 - KEPT);
    let distance = Nearness::distance(pair, x);
    if distance > reach || distance < TOUCHING {
        return None;
    }
    Some(Meeting {
        pair,
        gap: KEPT * distance,
    })
}
