//! Fills of panels: lyon triangulates their rings.

use lyon::math::point;
use lyon::path::Path;
use lyon::tessellation::{BuffersBuilder, FillOptions, FillTessellator, FillVertex, VertexBuffers};
use toile_geometry::Vec2;

/// Triangles of a filled region, in a panel's plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fill {
    /// Corners (m).
    pub points: Vec<[f32; 2]>,
    /// Three indices per triangle.
    pub indices: Vec<u32>,
}

/// Fills rings by the even-odd rule: holes stay empty; a ring that crosses itself is filled where it winds
/// an odd number of times. Rings with coordinates that are not finite are skipped.
pub fn fill(rings: &[Vec<Vec2>]) -> Fill {
    let mut path = Path::builder();
    for ring in rings {
        if ring.len() < 3 || ring.iter().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            continue;
        }
        let mut points = ring.iter().map(|p| point(p.x as f32, p.y as f32));
        if let Some(first) = points.next() {
            path.begin(first);
            points.for_each(|p| {
                path.line_to(p);
            });
            path.end(true);
        }
    }
    let mut buffers: VertexBuffers<[f32; 2], u32> = VertexBuffers::new();
    let done = FillTessellator::new().tessellate_path(
        &path.build(),
        // The tolerance matters to curves only, and the rings are polylines already.
        &FillOptions::even_odd().with_tolerance(1e-4),
        &mut BuffersBuilder::new(&mut buffers, |vertex: FillVertex<'_>| {
            vertex.position().to_array()
        }),
    );
    match done {
        Ok(()) => Fill {
            points: buffers.vertices,
            indices: buffers.indices,
        },
        Err(_) => Fill::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(fill: &Fill) -> f64 {
        let at = |k: u32| Vec2::from(fill.points[k as usize].map(f64::from));
        fill.indices
            .chunks(3)
            .map(|t| (at(t[1]) - at(t[0])).perp(&(at(t[2]) - at(t[0]))).abs() / 2.0)
            .sum()
    }

    fn square(from: f64, to: f64) -> Vec<Vec2> {
        vec![
            Vec2::new(from, from),
            Vec2::new(to, from),
            Vec2::new(to, to),
            Vec2::new(from, to),
        ]
    }

    #[test]
    fn a_ring_with_a_hole_has_its_area() {
        let filled = fill(&[square(0.0, 0.4), square(0.1, 0.2)]);
        assert!((area(&filled) - 0.15).abs() < 1e-6);
    }

    #[test]
    fn nothing_and_rubbish_make_nothing() {
        assert_eq!(fill(&[]), Fill::default());
        let rubbish = vec![Vec2::new(f64::NAN, 0.0); 4];
        assert_eq!(fill(&[rubbish, vec![Vec2::zeros(); 2]]), Fill::default());
    }
}
