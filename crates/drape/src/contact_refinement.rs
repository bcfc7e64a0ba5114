//! Contact tested more finely where cloth went on crossing a solid surface.

use crate::contact_settings::MOST_EXTRA;
use crate::{ContactSample, Model, State};
use std::sync::Arc;

/// How much farther a triangle is kept each time it is found crossing again [m]: a quarter of the
/// usual offset.
const EXTRA_OFFSET: f64 = 1e-3;

impl State {
    /// Tests a triangle at its middle and the middles of its edges too, where it is too large
    /// for the curve it lies on; when it is tested so already, keeps it and its corners farther
    /// from the surface. Whoever looks for triangles that cross a surface may count those of an object
    /// that ignores it ([`PairPolicies`](crate::PairPolicies)): its samples then grow more, and still do not
    /// feel that surface.
    pub fn refine_contact(&mut self, model: &Model, triangle: u32) {
        let samples = Arc::make_mut(&mut self.samples);
        for triangle in under(model, triangle) {
            refine(model, samples, triangle);
        }
        self.follow_samples();
    }

    /// Goes on where it is under other rest shapes of the same triangles: cloth sticks where it stuck, and is
    /// tested against solids where it was. A way to rest begins anew.
    pub(crate) fn follow_shapes(&mut self, model: &Model) {
        let at_vertices = model.rest.samples.iter().copied();
        let mut samples: Vec<ContactSample> = at_vertices.collect();
        for (sample, before) in samples.iter_mut().zip(self.samples.iter()) {
            sample.extra_offset = before.extra_offset;
        }
        let within = self
            .samples
            .iter()
            .filter(|sample| sample.triangle.is_some());
        samples.extend(within.map(|sample| {
            ContactSample {
                area: sample
                    .triangle
                    .map_or(sample.area, |t| model.rest_area(t as usize) / 3.0),
                ..*sample
            }
        }));
        self.samples = Arc::new(samples);
        self.begin_rest_anew();
    }
}

/// Triangles of the model that cover one of the surface: itself, or the two that were exchanged
/// for it and its neighbour.
fn under(model: &Model, triangle: u32) -> Vec<u32> {
    let given = model.surface_triangles()[triangle as usize];
    let own = model.topology.triangles[triangle as usize];
    if given == own {
        return vec![triangle];
    }
    let quad = |v: &u32| given.contains(v) || own.contains(v);
    let all = 0..model.topology.triangles.len() as u32;
    all.filter(|&t| model.topology.triangles[t as usize].iter().all(quad))
        .collect()
}

/// Adds samples within a triangle, or keeps those that are there farther off.
fn refine(model: &Model, samples: &mut Vec<ContactSample>, triangle: u32) {
    if samples.iter().any(|s| s.triangle == Some(triangle)) {
        let corners = model.topology.triangles[triangle as usize];
        for sample in samples.iter_mut() {
            let corner = sample.triangle.is_none() && corners.contains(&sample.vertices[0]);
            if corner || sample.triangle == Some(triangle) {
                sample.extra_offset = (sample.extra_offset + EXTRA_OFFSET).min(MOST_EXTRA);
            }
        }
        return;
    }
    let vertices = model.topology.triangles[triangle as usize];
    let material = &model.materials.list[model.materials.of_triangle[triangle as usize] as usize];
    let third = 1.0 / 3.0;
    for weights in [
        [third; 3],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.5],
        [0.5, 0.0, 0.5],
    ] {
        samples.push(ContactSample {
            triangle: Some(triangle),
            vertices,
            weights,
            area: model.rest.elements[triangle as usize].area / 3.0,
            friction: material.friction,
            restitution: material.restitution,
            extra_offset: 0.0,
        });
    }
}
