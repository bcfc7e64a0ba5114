//! Tutte's embedding (1963): the outline on a circle, every vertex inside at the mean of its neighbours. No triangle is
//! flipped, whatever the surface (Floater 1997).

use crate::conformal::to_area;
use crate::cotangent::graph;
use crate::{FlattenError, Region};
use std::f64::consts::TAU;
use toile_geometry::{Vec2, Vec3};
use toile_sparse::factor::Factor;

/// The embedding with the area of the surface; places on the circle by the outline's lengths (m).
///
/// # Errors
/// The linear system cannot be solved.
pub fn tutte(region: &Region) -> Result<Vec<Vec2>, FlattenError> {
    let positions = &region.mesh().positions;
    let outline = region.outline();
    let side = |k: usize| {
        let (a, b) = (outline[k], outline[(k + 1) % outline.len()]);
        (positions[b as usize] - positions[a as usize]).norm()
    };
    let whole: f64 = (0..outline.len()).map(side).sum();
    let mut place: Vec<Option<Vec2>> = vec![None; region.vertex_count()];
    let mut way = 0.0;
    for (k, &v) in outline.iter().enumerate() {
        let (sine, cosine) = (TAU * way / whole).sin_cos();
        place[v as usize] = Some(Vec2::new(cosine, sine));
        way += side(k);
    }
    let graph = graph(region);
    let mut right = vec![Vec3::zeros(); region.vertex_count()];
    for (v, sum) in right.iter_mut().enumerate() {
        *sum = match place[v] {
            Some(p) => Vec3::new(p.x, p.y, 0.0),
            None => (graph.row(v).iter())
                .filter_map(|&u| place[u as usize])
                .map(|p| Vec3::new(p.x, p.y, 0.0))
                .sum(),
        };
    }
    let mut factor: Factor<1> = Factor::new(graph.clone(), positions);
    factor.factorise(|v, columns, row| {
        for (out, &u) in row.iter_mut().zip(columns) {
            let fixed = place[v].is_some() || place[u as usize].is_some();
            out[0][0] = match (u as usize == v, fixed) {
                (true, true) => 1.0,
                (true, false) => columns.len() as f64 - 1.0,
                (false, true) => 0.0,
                (false, false) => -1.0,
            };
        }
    })?;
    let mut result = vec![Vec3::zeros(); region.vertex_count()];
    factor.solve(&right, &mut result);
    let mut flat: Vec<Vec2> = result.iter().map(Vec3::xy).collect();
    to_area(region, &mut flat);
    Ok(flat)
}
