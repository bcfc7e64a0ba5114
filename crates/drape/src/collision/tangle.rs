//! Where cloth has crossed cloth, exactly, and the way out: each edge that pierces a face is moved
//! so that the line of intersection grows shorter (Volino and Magnenat-Thalmann 2006, Resolving
//! surface collisions through intersection contour minimization).

use super::memory::RecoveryDirection;
use super::surface::{ClothSurface, Near};
use toile_geometry::{Vec3, segment_intersects_triangle};

/// An edge that pierces a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piercing {
    /// Ends of the edge, then corners of the face.
    pub vertices: [u32; 5],
    /// Weights of the piercing point on the edge, and negative ones on the face.
    pub weights: [f64; 5],
    /// Unit direction in which the edge is to move against the face.
    pub way: Vec3,
}

/// Looks after which it is forgotten which way a vertex was drawn, unless it went so of its own since.
const MEMORY: u32 = 8;

/// Directions of this length and less, summed over a piercing's vertices, cancel.
const CANCELLED: f64 = 0.1;

/// Has each piercing edge go on the way that its vertices and the face's were drawn before, in order of
/// vertices, where its own would turn back; what is to be remembered then. Else two edges at one corner,
/// of which now one crosses and now the other, draw the cloth to and fro for ever.
pub fn keep_on(piercings: &mut [Piercing], before: &[RecoveryDirection]) -> Vec<RecoveryDirection> {
    let drawn = |v: &u32| {
        let at = before.binary_search_by_key(v, |drawn| drawn.vertex);
        at.ok().map(|at| before[at])
    };
    let older = |drawn: &RecoveryDirection| RecoveryDirection {
        looks: drawn.looks + 1,
        ..*drawn
    };
    let mut after: Vec<RecoveryDirection> = Vec::new();
    for piercing in piercings {
        let signed = piercing
            .vertices
            .into_iter()
            .zip([1.0, 1.0, -1.0, -1.0, -1.0]);
        let known = || {
            signed
                .clone()
                .filter_map(|(v, sign)| Some((drawn(&v)?, sign)))
        };
        let sum: Vec3 = known().map(|(drawn, sign)| drawn.way * sign).sum();
        let before = sum.try_normalize(CANCELLED);
        let kept = before.filter(|way| way.dot(&piercing.way) < 0.0);
        let mut looks = 0;
        if let Some(way) = kept {
            piercing.way = way;
            looks = 1 + known().map(|(drawn, _)| drawn.looks).min().unwrap_or(0);
        }
        after.extend(signed.map(|(vertex, sign)| RecoveryDirection {
            vertex,
            way: piercing.way * sign,
            looks,
        }));
    }
    after.extend(before.iter().map(older));
    after.retain(|drawn| drawn.looks <= MEMORY);
    // The latest of a vertex; of one look, that of its first piercing.
    after.sort_by_key(|drawn| (drawn.vertex, drawn.looks));
    after.dedup_by_key(|drawn| drawn.vertex);
    after
}

/// Looks after which a ring of edges more round a vertex that stays at a crossing is loose, and the most
/// rings.
const WIDER_AFTER: u32 = 25;
const WIDEST: u32 = 8;

/// For how many looks vertices have been at a crossing, each look without taken off; empty where none was.
pub fn crossed_for(crossed: &[bool], before: &[u32]) -> Vec<u32> {
    if before.is_empty() && !crossed.contains(&true) {
        return Vec::new();
    }
    let before = before.iter().copied().chain(std::iter::repeat(0));
    let looks = crossed.iter().zip(before);
    let looks = looks.map(|(&crossed, before)| match crossed {
        true => before + 1,
        false => before.saturating_sub(1),
    });
    let looks: Vec<u32> = looks.collect();
    match looks.iter().any(|&looks| looks > 0) {
        true => looks,
        false => Vec::new(),
    }
}

/// Vertices round those that stay at a crossing, one ring of edges more after every [`WIDER_AFTER`] looks:
/// where cloth lies on the wrong side round a crossing, its contacts hold it there. Empty where none stays.
pub fn loose_round(edges: &[[u32; 2]], crossed: &[bool], looks: &[u32]) -> Vec<bool> {
    let rings = crossed.iter().zip(looks);
    let rings = rings.map(|(&crossed, looks)| u32::from(crossed) * looks / WIDER_AFTER);
    let mut rings: Vec<u32> = rings.map(|rings| rings.min(WIDEST)).collect();
    let widest = rings.iter().copied().max().unwrap_or(0);
    if widest == 0 {
        return Vec::new();
    }
    let mut loose: Vec<bool> = rings.iter().map(|&rings| rings > 0).collect();
    for _ in 0..widest {
        let before = rings.clone();
        for &[a, b] in edges {
            for [a, b] in [[a as usize, b as usize], [b as usize, a as usize]] {
                if before[a] > rings[b] {
                    rings[b] = before[a] - 1;
                    loose[b] = true;
                }
            }
        }
    }
    loose
}

/// The cosine between edge and face's normal is not taken smaller than this: a move along the face
/// cannot help an edge that lies in it.
const FLAT: f64 = 0.15;

/// The ways out of some crossings, as [`crossings`] gives them. An edge in the plane of the face has
/// none, and neither has one in the middle of a flat sheet.
pub fn piercings(surface: &ClothSurface, crossings: &[[u32; 2]], x: &[Vec3]) -> Vec<Piercing> {
    let found = crossings.iter();
    found
        .filter_map(|&[e, t]| way_out(surface, e as usize, t as usize, x))
        .collect()
}

/// Every edge and face that cross, exactly, and share no vertex, of those that are near, sorted.
pub fn crossings<'a>(
    surface: &ClothSurface,
    near: impl Into<Near<'a>>,
    x: &[Vec3],
) -> Vec<[u32; 2]> {
    let mut found = surface.edges_and_faces(near, |[e, t]| {
        let ends = surface.edges[e as usize].map(|v| x[v as usize]);
        let corners = surface.triangles[t as usize].map(|v| x[v as usize]);
        let apart = (0..3).any(|k| {
            let (low, high) = (ends[0][k].min(ends[1][k]), ends[0][k].max(ends[1][k]));
            corners.iter().all(|c| c[k] < low) || corners.iter().all(|c| c[k] > high)
        });
        !apart && segment_intersects_triangle(ends, corners)
    });
    found.sort_unstable();
    found
}

/// The direction of a piercing, none where the edge lies in the face or nothing is to be gained.
fn way_out(surface: &ClothSurface, e: usize, t: usize, x: &[Vec3]) -> Option<Piercing> {
    let [a, b] = surface.edges[e];
    let face = surface.triangles[t];
    let (pa, pb) = (x[a as usize], x[b as usize]);
    let [p, q, r] = face.map(|v| x[v as usize]);
    let along = (pb - pa).try_normalize(0.0)?;
    let normal = (q - p).cross(&(r - p)).try_normalize(0.0)?;
    let (da, db) = ((pa - p).dot(&normal), (pb - p).dot(&normal));
    let s = if da == db {
        0.5
    } else {
        (da / (da - db)).clamp(0.0, 1.0)
    };
    let point = pa + (pb - pa) * s;
    let slope = along.dot(&normal);
    let slope = slope.abs().max(FLAT) * if slope < 0.0 { -1.0 } else { 1.0 };
    let mut gradient = Vec3::zeros();
    for &of in &surface.edge_triangles[e] {
        let Some(third) = surface.triangles[of as usize]
            .into_iter()
            .find(|v| ![a, b].contains(v))
        else {
            continue;
        };
        let inward = x[third as usize] - point;
        let own = along.cross(&inward);
        let Some(line) = own.cross(&normal).try_normalize(0.0) else {
            continue;
        };
        let inward = inward - along * inward.dot(&along);
        let line = if line.dot(&inward) < 0.0 { -line } else { line };
        gradient += line - normal * (2.0 * along.dot(&line) / slope);
    }
    let way = gradient.try_normalize(1e-3)?;
    let w = toile_geometry::closest_on_face(point, [p, q, r]);
    Some(Piercing {
        vertices: [a, b, face[0], face[1], face[2]],
        weights: [1.0 - s, s, -w[0], -w[1], -w[2]],
        way,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piercing(vertices: [u32; 5], way: Vec3) -> Piercing {
        Piercing {
            vertices,
            weights: [0.5, 0.5, -0.4, -0.3, -0.3],
            way,
        }
    }

    #[test]
    fn cloth_grows_loose_ring_by_ring_round_a_crossing_that_stays() {
        // A row of vertices, the first of which is at a crossing.
        let edges: Vec<[u32; 2]> = (0..12).map(|v| [v, v + 1]).collect();
        let crossed: Vec<bool> = (0..13).map(|v| v == 0).collect();
        let mut looks = Vec::new();
        for look in 1..=400 {
            looks = crossed_for(&crossed, &looks);
            let loose = loose_round(&edges, &crossed, &looks);
            let rings = (look / WIDER_AFTER).min(WIDEST) as usize;
            match rings {
                0 => assert!(loose.is_empty()),
                _ => assert!(
                    (0..13).all(|v| loose[v] == (v <= rings)),
                    "{look}: {loose:?}"
                ),
            }
        }
        let none = [false; 13];
        assert!(
            loose_round(&edges, &none, &looks).is_empty(),
            "not where none is"
        );
        for _ in 0..399 {
            looks = crossed_for(&none, &looks);
        }
        assert_eq!(looks[0], 1);
        assert!(crossed_for(&none, &looks).is_empty());
        assert!(crossed_for(&none, &[]).is_empty());
    }

    #[test]
    fn two_edges_at_one_corner_are_drawn_one_way() {
        let mut first = [piercing([7, 1, 2, 3, 4], Vec3::x())];
        let drawn = keep_on(&mut first, &[]);
        assert_eq!(first[0].way, Vec3::x());
        assert_eq!(drawn.len(), 5);
        // The other edge would turn back, its neighbour in another corner of the cloth goes its own way.
        let back = Vec3::new(-0.8, 0.6, 0.0);
        let mut second = [
            piercing([7, 8, 2, 5, 6], back),
            piercing([20, 21, 22, 23, 24], back),
        ];
        let drawn = keep_on(&mut second, &drawn);
        assert_eq!(second[0].way, Vec3::x());
        assert_eq!(second[1].way, back);
        // What turns less is followed.
        let turned = Vec3::new(0.6, 0.8, 0.0);
        let mut third = [piercing([8, 7, 2, 5, 6], turned)];
        let mut drawn = keep_on(&mut third, &drawn);
        assert_eq!(third[0].way, turned);
        assert!(drawn.windows(2).all(|pair| pair[0].vertex < pair[1].vertex));
        for _ in 0..=MEMORY {
            drawn = keep_on(&mut [], &drawn);
        }
        assert_eq!(drawn, []);
    }
}
