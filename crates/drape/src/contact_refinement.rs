//! Refinement of contact samples in triangles that cross a solid.

use crate::contact_settings::MAX_EXTRA;
use crate::{ContactSample, Model, State};
use std::sync::Arc;

/// Extra contact offset added each time a refined triangle still crosses a solid (m): a quarter of the default offset.
const EXTRA_OFFSET: f64 = 1e-3;

impl State {
    /// Adds contact samples at the centroid and the edge midpoints of a triangle that is too large for the curvature of
    /// a solid; where it has them already, enlarges their contact offset and that of its corners. A triangle of an
    /// object that ignores the solid ([`PairPolicies`](crate::PairPolicies)) may be given, too: its samples make no
    /// contact with that solid.
    pub fn refine_contact(&mut self, model: &Model, triangle: u32) {
        let samples = Arc::make_mut(&mut self.samples);
        for triangle in covering(model, triangle) {
            refine(model, samples, triangle);
        }
    }

    /// Adapts the state to other rest shapes of the same triangles: contact samples and friction anchors stay, the
    /// areas of samples change. The memory of an equilibrium method is cleared.
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
        self.clear_equilibrium_memory();
    }
}

/// Triangles of the model that cover a triangle of the surface: itself, or both triangles of a pair whose diagonal was
/// exchanged.
fn covering(model: &Model, triangle: u32) -> Vec<u32> {
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

/// Adds samples within a triangle, or enlarges the offset of its samples.
fn refine(model: &Model, samples: &mut Vec<ContactSample>, triangle: u32) {
    if samples.iter().any(|s| s.triangle == Some(triangle)) {
        let corners = model.topology.triangles[triangle as usize];
        for sample in samples.iter_mut() {
            let corner = sample.triangle.is_none() && corners.contains(&sample.vertices[0]);
            if corner || sample.triangle == Some(triangle) {
                sample.extra_offset = (sample.extra_offset + EXTRA_OFFSET).min(MAX_EXTRA);
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
