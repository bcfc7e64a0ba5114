//! Vertices of moving solids against faces of the cloth: the half of contact that samples of the cloth leave open.
//!
//! Contact samples keep points of the cloth off a surface. Between them a face reaches over the surface, and where that
//! is sharp, as at an elbow, it would cut through. So every vertex of the surface that a face comes near keeps that face
//! off, at half the distance that samples keep: where the surface is as smooth as the cloth is fine this never acts.

use super::Xpbd;
use super::carried_plane::CarriedPlane;
use super::contact::{ContactConstraint, ContactStencil};
use super::moving_solids::MovingSolids;
use crate::System;
use rayon::prelude::*;
use toile_geometry::{ClosestPoint, MovingSurface, TriangleMesh, Vec3};

/// Distance that a vertex keeps a face off, over the contact offset. An edge of 15 mm over a limb of 40 mm radius comes
/// 0.7 mm nearer to it than its ends, which is less than the half that is left.
const OFFSET: f64 = 0.5;
/// Distance within which a face is looked for, over the contact offset; and the one that a vertex may come to in the step
/// by the present speeds for its face to be watched.
const REACH: f64 = 2.5;
const NEAR: f64 = 1.0;
/// Least cosine between the normal of a vertex and that of its face, to either side: in a fold of the skin the plane of a
/// vertex says nothing about a face across it.
const FACING: f64 = 0.7;
/// Weight of a corner from which the closest point of a face is that corner, whose own sample keeps it off.
const CORNER: f64 = 0.98;

/// A vertex of a moving solid near a face of the cloth.
#[derive(Clone, Copy, Debug)]
pub struct SkinContact {
    /// The point of the face, with the plane that the vertex keeps it off.
    pub stencil: ContactStencil,
    /// The vertex as a place of one of its triangles.
    pub carried: CarriedPlane,
}

/// A vertex and the face that it is near to.
struct Near {
    solid: u32,
    vertex: ClosestPoint,
    face: u32,
    weights: [f64; 3],
}

/// The search for vertices of moving solids near the cloth.
#[derive(Default)]
pub struct SkinSearch {
    /// The cloth as a surface, in its present places.
    cloth: Option<MovingSurface>,
    /// The face that each vertex of each solid was nearest to last, from which the search begins; it changes no result.
    last: Vec<Vec<Option<u32>>>,
}

/// The cloth at the start of a step, and the length of the step over that of its first part.
#[derive(Clone, Copy)]
pub struct StepStart<'a> {
    pub positions: &'a [Vec3],
    pub velocities: &'a [Vec3],
    /// Length of the first part [s], and how many parts there are.
    pub part: f64,
    pub parts: u32,
}

impl SkinSearch {
    /// All vertices that come near a face in the step, in order of solids and vertices.
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
            let near = last.par_iter_mut().enumerate().with_min_len(256);
            let near = near.filter_map(|(v, last)| look.at_vertex(v as u32, last));
            found.extend(near.collect::<Vec<_>>());
        }
        found
    }
}

/// A look at the cloth from the vertices of one solid.
struct Look<'a> {
    system: &'a System,
    cloth: &'a MovingSurface,
    surface: &'a MovingSurface,
    start: &'a StepStart<'a>,
    solid: u32,
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
        let velocity: Vec3 = (corners.iter().zip(face.weights))
            .map(|(&v, w)| start.velocities[v as usize] * w)
            .sum();
        let moved = surface.vertex(vertex, 1.0) - place;
        let comes = own.normal.dot(&(moved - velocity * start.part)) * f64::from(start.parts);
        let gap = own.normal.dot(&(face.point - place));
        if gap - comes.max(0.0) >= NEAR * system.contact.offset {
            return None;
        }
        // Where two walls face each other the face keeps off the nearer one.
        let wall = surface.closest_point(face.point, 0.0, reach, Some(own.triangle))?;
        (wall.normal.dot(&own.normal) > 0.0).then_some(Near {
            solid: self.solid,
            vertex: own,
            face: face.triangle,
            weights: face.weights,
        })
    }
}

impl Xpbd {
    /// Replaces the contacts of vertices of moving solids with faces of the cloth by those at the start of the step, whose
    /// first part the solids are placed for.
    pub(super) fn set_skin_contacts(&mut self, system: &System, start: &StepStart) {
        let near = match self.moving.any() {
            true => self.skin.near(system, &self.moving, start),
            false => Vec::new(),
        };
        let slot_of = &self.partition.slot_of;
        let slots = |near: &Near| {
            let [a, b, c] =
                system.topology.triangles[near.face as usize].map(|v| slot_of[v as usize]);
            [a, b, c, a]
        };
        let moving = &self.moving;
        let contact = |near: &Near, start: u32| {
            let [a, b, c] = near.weights.map(|w| w as f32);
            let area = system.rest.elements[near.face as usize].area;
            let compliance = (1.0 / (system.contact.stiffness * area)).min(1e30) as f32;
            let carried = moving
                .surface(near.solid)
                .map(|surface| CarriedPlane::new(surface, &near.vertex, 0.0));
            SkinContact {
                stencil: ContactStencil {
                    vertices: slots(near).map(|slot| slot - start),
                    weights: [a, b, c, 0.0],
                    constraint: ContactConstraint {
                        normal: [0, 1, 2].map(|k| near.vertex.normal[k] as f32),
                        compliance,
                        offset: (OFFSET * system.contact.offset) as f32,
                        solid: near.solid,
                        ..ContactConstraint::none()
                    },
                    begun_at: [0.0; 3],
                    number: 0,
                    restitution: None,
                },
                carried: carried.unwrap_or_default(),
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
