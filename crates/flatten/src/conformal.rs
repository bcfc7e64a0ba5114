//! Least squares conformal maps (Levy, Petitjean, Ray and Maillot 2002): the flat shape of least change of angles.
//!
//! With u, v the flat places, the energy 1/2 (u L u + v L v) - area(u, v), L the cotangent matrix, is zero where every
//! triangle keeps its angles. Two vertices far apart on the outline are held.

use crate::cotangent::{entries, graph};
use crate::{FlattenError, Region};
use toile_geometry::Vec2;
use toile_sparse::factor::{Block, Factor};

/// The map with the area of the surface; triangles may be flipped (m).
///
/// # Errors
/// The triangles are too thin.
pub fn conformal(region: &Region) -> Result<Vec<Vec2>, FlattenError> {
    let count = region.vertex_count();
    let held = far_apart(region);
    // The entries of the matrix as blocks of u and v, by rows.
    let mut blocks: Vec<(u32, u32, Block<2>)> = entries(region)
        .into_iter()
        .map(|(row, column, value)| (row, column, [[value, 0.0], [0.0, value]]))
        .collect();
    let outline = region.outline();
    for (k, &a) in outline.iter().enumerate() {
        // Area is 1/2 sum of u_a v_b - u_b v_a over the outline.
        let b = outline[(k + 1) % outline.len()];
        blocks.push((a, b, [[0.0, -0.5], [0.5, 0.0]]));
        blocks.push((b, a, [[0.0, 0.5], [-0.5, 0.0]]));
    }
    let matrix = summed(count, blocks);
    let value = |row: usize, column: u32| {
        let line = &matrix[row];
        let found = line.binary_search_by_key(&column, |entry| entry.0);
        found.map_or([[0.0; 2]; 2], |at| line[at].1)
    };
    let places: [(usize, Vec2); 2] = [
        (held[0] as usize, Vec2::zeros()),
        (held[1] as usize, Vec2::new(0.0, 1.0)),
    ];
    let is_held = |v: usize| places.iter().any(|place| place.0 == v);
    let mut factor: Factor<2> = Factor::new(graph(region), &region.mesh().positions);
    factor.factorise(|v, columns, row| {
        for (out, &column) in row.iter_mut().zip(columns) {
            let one = if v == column as usize { 1.0 } else { 0.0 };
            *out = if is_held(v) || is_held(column as usize) {
                [[one, 0.0], [0.0, one]]
            } else {
                value(v, column)
            };
        }
    })?;
    let mut right = vec![0.0; 2 * count];
    for (row, line) in matrix.iter().enumerate().filter(|(row, _)| !is_held(*row)) {
        for (column, block) in line {
            if let Some((_, place)) = places.iter().find(|place| place.0 == *column as usize) {
                for k in 0..2 {
                    right[2 * row + k] -= block[k][0] * place.x + block[k][1] * place.y;
                }
            }
        }
    }
    for (v, place) in places {
        right[2 * v] = place.x;
        right[2 * v + 1] = place.y;
    }
    let mut result = vec![0.0; 2 * count];
    factor.solve_columns(1, &right, &mut result);
    let mut flat: Vec<Vec2> = (result.chunks(2)).map(|p| Vec2::new(p[0], p[1])).collect();
    to_area(region, &mut flat);
    Ok(flat)
}

/// Scales a flat shape about the origin to the area of the surface, as far as it has any.
pub fn to_area(region: &Region, flat: &mut [Vec2]) {
    let area: f64 = (region.mesh().triangles.iter())
        .map(|&t| {
            let [a, b, c] = t.map(|v| flat[v as usize]);
            0.5 * (b - a).perp(&(c - a)).abs()
        })
        .sum();
    let scale = (region.area() / area).sqrt();
    if scale.is_finite() {
        flat.iter_mut().for_each(|p| *p *= scale);
    }
}

/// Triangles that are flipped or have no area.
pub fn flipped(region: &Region, flat: &[Vec2]) -> usize {
    let is_flipped = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|v| flat[v as usize]);
        let twice = (b - a).perp(&(c - a));
        twice.is_nan() || twice <= 0.0
    };
    region.mesh().triangles.iter().filter(is_flipped).count()
}

/// Two vertices of the outline far apart: the farthest from its first vertex, and the farthest from that.
fn far_apart(region: &Region) -> [u32; 2] {
    let positions = &region.mesh().positions;
    let farthest = |from: u32| {
        let distance = |v: &&u32| (positions[**v as usize] - positions[from as usize]).norm();
        (region.outline().iter())
            .filter(|&&v| v != from)
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
            .copied()
            .unwrap_or(from)
    };
    let one = farthest(region.outline()[0]);
    [one, farthest(one)]
}

/// Entries summed by row and column, columns ascending.
fn summed(rows: usize, entries: Vec<(u32, u32, Block<2>)>) -> Vec<Vec<(u32, Block<2>)>> {
    let mut matrix: Vec<Vec<(u32, Block<2>)>> = vec![Vec::new(); rows];
    for (row, column, block) in entries {
        matrix[row as usize].push((column, block));
    }
    for line in &mut matrix {
        line.sort_by_key(|entry| entry.0);
        line.dedup_by(|from, to| {
            let same = from.0 == to.0;
            if same {
                for r in 0..2 {
                    for c in 0..2 {
                        to.1[r][c] += from.1[r][c];
                    }
                }
            }
            same
        });
    }
    matrix
}
