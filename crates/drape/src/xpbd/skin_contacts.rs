//! Vertices and edges of moving solids against faces and edges of the cloth: the half of contact that samples of the
//! cloth leave open.
//!
//! Contact samples keep points of the cloth off a surface. Between them a face reaches over the surface, and where that
//! is sharp, as at an elbow, it would cut through. So every vertex of the surface that a face comes near keeps that face
//! off, and every convex edge an edge of the cloth that crosses over it, at half the distance that samples keep: where
//! the surface is as smooth as the cloth is fine this never acts, and nothing is looked for.

use super::Xpbd;
use super::carried_plane::CarriedPlane;
use super::contact::{ContactConstraint, ContactStencil, Solid, compliance_of};
use super::moving_solids::MovingSolids;
use super::skin_edges::{Ridges, edges_near};
use super::skin_look::{Look, Near, REACH, StepStart};
use crate::System;
use crate::lanes::Point;
use crate::laws::contact::HARDER;
use rayon::prelude::*;
use toile_geometry::{
    MovingSurface, TriangleMesh, Vec3, closest_on_segments, closest_point_on_triangle,
};

/// Least cosine between the normal of a vertex and that of its face, to either side: in a fold of the skin the plane of a
/// vertex says nothing about a face across it.
const FACING: f64 = 0.7;
/// Weight of a corner from which the closest point of a face is that corner, whose own sample keeps it off.
const CORNER: f64 = 0.98;
/// Sine of the angle between two edges of equal length below which they have no common normal.
const PARALLEL: f64 = 0.1;

/// A vertex or edge of a moving solid near a face or an edge of the cloth.
#[derive(Clone, Copy, Debug)]
pub struct SkinContact {
    /// The point of the cloth, with the plane that the solid keeps it off.
    pub stencil: ContactStencil,
    /// The place of the solid on one of its triangles.
    pub carried: CarriedPlane,
    /// The side of that triangle, where it is an edge.
    pub side: Option<u8>,
}

impl SkinContact {
    /// Goes on in the next part of a step, for which the surfaces are set.
    pub fn go_on(&mut self, moving: &MovingSolids) {
        if let Some(surface) = moving.surface(self.stencil.constraint.solid) {
            self.carried.go_on(surface);
        }
    }

    /// Finds the points that are nearest to each other anew, of the face or the edge of the cloth and the vertex or the
    /// edge of the solid, at the start of a substep. `points` are the vertices then.
    pub fn follow(&mut self, solid: &Solid, points: &[Point]) {
        let Some(surface) = solid.moving.surface(self.stencil.constraint.solid) else {
            return;
        };
        let time = solid.shares[0];
        let corners = self.stencil.vertices.map(|v| {
            let [x, y, z, _] = points[v as usize];
            solid.origin + Vec3::new(x.into(), y.into(), z.into())
        });
        let plane = self.carried.at([time; 2]);
        let weights = match self.side {
            None => closest_point_on_triangle(plane.point, [corners[0], corners[1], corners[2]]).0,
            Some(side) => {
                let (triangle, side) = (self.carried.triangle, usize::from(side));
                let ends = surface.corners(triangle, time);
                let (own, other) = ([corners[0], corners[1]], [ends[side], ends[(side + 1) % 3]]);
                let [s, t] = closest_on_segments(own, other);
                let across = (own[1] - own[0]).cross(&(other[1] - other[0]));
                let across = across * across.dot(&plane.normal).signum();
                // Where they are nearly parallel the normal stays as it is.
                let normal = across.try_normalize(PARALLEL * (own[1] - own[0]).norm_squared());
                let mut weights = [0.0; 3];
                (weights[side], weights[(side + 1) % 3]) = (1.0 - t, t);
                let normal = normal.unwrap_or(plane.normal);
                self.carried.shift(surface, weights, (normal, time));
                [1.0 - s, s, 0.0]
            }
        };
        let [a, b, c] = weights.map(|w| w as f32);
        self.stencil.weights = [a, b, c, 0.0];
    }
}

/// The search for vertices of moving solids near the cloth.
#[derive(Default)]
pub struct SkinSearch {
    /// The cloth as a surface, in its present places.
    cloth: Option<MovingSurface>,
    /// The face that each vertex of each solid was nearest to last, from which the search begins; it changes no result.
    last: Vec<Vec<Option<u32>>>,
}

impl SkinSearch {
    /// All vertices that come near a face in the step, in order of solids and vertices, then the edges that come near an
    /// edge.
    fn near(&mut self, system: &System, moving: &MovingSolids, start: &StepStart) -> Vec<Near> {
        let cloth = self.cloth.get_or_insert_with(|| {
            MovingSurface::new(&TriangleMesh {
                positions: start.positions.to_vec(),
                triangles: system.topology.triangles.clone(),
            })
        });
        cloth.set_step(start.positions, start.positions);
        let cloth = &*cloth;
        self.last.resize_with(system.colliders.len(), Vec::new);
        let mut found = Vec::new();
        for (solid, last) in (0..).zip(&mut self.last) {
            let Some(surface) = moving.surface(solid) else {
                continue;
            };
            last.resize(surface.starts().len(), None);
            let look = Look {
                system,
                cloth,
                surface,
                start,
                solid,
            };
            let ridges = Ridges::of(&look);
            let sharp = ridges.sharp_vertices(&look);
            let near = last.par_iter_mut().zip(&sharp).enumerate();
            let near = near.with_min_len(256).filter_map(|(v, (last, is_sharp))| {
                is_sharp.then(|| look.at_vertex(v as u32, last)).flatten()
            });
            found.extend(near.collect::<Vec<_>>());
            found.extend(edges_near(&look, &ridges));
        }
        found
    }
}

impl Look<'_> {
    /// The face that a vertex comes near in the step, if it does and may meet it.
    fn at_vertex(&self, vertex: u32, last: &mut Option<u32>) -> Option<Near> {
        let Self {
            system,
            surface,
            start,
            ..
        } = self;
        let place = surface.vertex(vertex, 0.0);
        let reach = REACH * system.contact.offset;
        let face = self.cloth.closest_point(place, 1.0, reach, *last)?;
        *last = Some(face.triangle);
        if face.weights.iter().any(|&w| w > CORNER) {
            return None;
        }
        let corners = system.topology.triangles[face.triangle as usize];
        let object = system.policies.object_of_sample(&corners);
        if system.policies.ignores_solid(object, self.solid as usize) {
            return None;
        }
        let own = surface.at_vertex(vertex, 0.0)?;
        let [a, b, c] = corners.map(|v| start.positions[v as usize]);
        let across = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        if own.normal.dot(&across).abs() < FACING {
            return None;
        }
        let offset = self.kept_off(&own, (corners, face.weights))?;
        Some(Near {
            solid: self.solid,
            place: own,
            side: None,
            vertices: corners,
            weights: face.weights,
            area: system.rest.elements[face.triangle as usize].area,
            offset,
        })
    }
}

impl Xpbd {
    /// Replaces the contacts of vertices and edges of moving solids with the cloth by those at the start of the step, whose
    /// first part the solids are placed for.
    pub(super) fn set_skin_contacts(&mut self, system: &System, start: &StepStart) {
        let near = match self.moving.any() {
            true => self.skin.near(system, &self.moving, start),
            false => Vec::new(),
        };
        let slot_of = &self.partition.slot_of;
        let slots = |near: &Near| {
            let [a, b, c] = near.vertices.map(|v| slot_of[v as usize]);
            [a, b, c, a]
        };
        let moving = &self.moving;
        let contact = |near: &Near, start: u32| {
            let [a, b, c] = near.weights.map(|w| w as f32);
            let law = system.contact.law(near.area, 0.0);
            let carried = moving
                .surface(near.solid)
                .map(|surface| CarriedPlane::new(surface, (&near.place, 0.0), near.offset));
            SkinContact {
                stencil: ContactStencil {
                    vertices: slots(near).map(|slot| slot - start),
                    weights: [a, b, c, 0.0],
                    constraint: ContactConstraint {
                        normal: [0, 1, 2].map(|k| near.place.normal[k] as f32),
                        compliance: compliance_of(HARDER * law.normal),
                        solid: near.solid,
                        ..ContactConstraint::none()
                    },
                    begun_at: [0.0; 3],
                    number: 0,
                    restitution: None,
                },
                carried: carried.unwrap_or_default(),
                side: near.side,
            }
        };
        self.regions.replace(
            &self.partition,
            &near,
            slots,
            (contact, |region| &mut region.skin),
        );
    }
}
