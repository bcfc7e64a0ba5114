//! Compilation of a world into the system that is simulated.

use super::{Kind, Object, ObjectId, VertexMap, World};
use crate::merge::merged_layers;
use crate::pair_policies::{BETWEEN_OBJECTS, PairPolicies};
use crate::{Cloth, Collider, Control, DrapeError, PrescribedVertex, System, SystemBuilder};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// Colliders by object, each with the mesh it was made of: its distance field is reused as long as the object keeps
/// that mesh.
pub(crate) type Solids = BTreeMap<ObjectId, (Arc<TriangleMesh>, Collider)>;

impl World {
    /// The cloths of all objects concatenated, not merged, at their starting positions.
    pub(super) fn panels(&self) -> Cloth {
        let mut all = Cloth::default();
        for (_, cloth) in self.cloths() {
            append(&mut all, cloth);
        }
        for material in &mut all.materials {
            material.stiffness_damping += self.environment.damping.stiffness;
        }
        all
    }

    /// The merged cloth at `positions` (m).
    pub(super) fn merged_cloth(&self, map: &VertexMap, positions: Vec<Vec3>) -> Cloth {
        let panels = self.panels();
        let mut merged = panels.merged(&map.target, map.count);
        merged.positions = positions;
        merged
    }

    /// The system of the world, with the merged vertices at `positions` (m) when elimination orders are chosen.
    ///
    /// # Errors
    /// No cloth, bad meshes, materials that cannot be simulated.
    pub(super) fn compile(
        &self,
        map: &VertexMap,
        positions: Vec<Vec3>,
        solids: &mut Solids,
    ) -> Result<System, DrapeError> {
        let materials: usize = (self.cloths().map(|(_, cloth)| cloth.materials.len())).sum();
        if materials > usize::from(u16::MAX) {
            return Err(DrapeError::Scene {
                place: "objects".to_owned(),
                what: format!("they have {materials} materials"),
                remedy: "make cloths of one material one object".to_owned(),
            });
        }
        let merged = self.merged_cloth(map, positions);
        if merged.triangles.is_empty() {
            return Err(DrapeError::Scene {
                place: "objects".to_owned(),
                what: "no deformable object has any triangle".to_owned(),
                remedy: "add an object of kind \"deformable\"".to_owned(),
            });
        }
        let builder = SystemBuilder::new(self.name, &merged)?;
        Ok(self.furnish(map, builder, solids))
    }

    /// Adds solids, pins, grips, attachments, layers, contact and loads to the system of a cloth.
    pub(super) fn furnish(
        &self,
        map: &VertexMap,
        mut builder: SystemBuilder,
        solids: &mut Solids,
    ) -> System {
        let environment = &self.environment;
        builder.colliders = self.solids(solids);
        let materials = self.cloths().flat_map(|(_, cloth)| &cloth.materials);
        builder.contact = environment.contact.for_cloth(materials);
        builder.contact.offset -= environment.recess;
        let layers = self.layers(map);
        match environment.layers_apart {
            None => builder.layer = merged_layers(&layers, &map.target, map.count),
            Some(apart) => {
                builder.layer = Vec::new();
                let own = merged_layers(&layers, &map.target, map.count);
                builder.offset_layers(&own, apart);
            }
        }
        builder.policies = self.policies(map);
        let attachments = self.resolve_attachments(map);
        builder.control = Control {
            gravity: environment.gravity,
            air_drag: environment.air.drag + environment.damping.mass,
            air: environment.air,
            frames: attachments.frames,
            ties: attachments.ties,
            ..Control::default()
        };
        builder.elastics = attachments.elastics;
        builder.release();
        builder.led = self.led(map);
        let pins = self.pins(map).chain(builder.led.iter().map(|g| g.vertex));
        for vertex in pins.collect::<Vec<_>>() {
            builder.pinned[vertex as usize] = true;
        }
        builder.build()
    }

    /// The colliders of the solid objects, in order; `cache` has those of earlier compilations.
    fn solids(&self, cache: &mut Solids) -> Vec<Collider> {
        let mut solids = Vec::new();
        for (id, object) in self.objects() {
            let (motion, track) = match object.kind {
                Kind::Deformable => continue,
                Kind::Static => (None, None),
                Kind::Animated => (object.motion.clone(), object.track.clone()),
            };
            cache.retain(|other, (mesh, _)| *other != id || Arc::ptr_eq(mesh, &object.mesh));
            let (_, collider) = cache.entry(id).or_insert_with(|| {
                let surface = SurfaceTree::new(TriangleMesh::clone(&object.mesh));
                (object.mesh.clone(), Collider::new(Arc::new(surface)))
            });
            let mut collider = collider.clone();
            collider.motion = motion;
            collider.track = track;
            solids.push(collider);
        }
        solids
    }

    /// The pairs of cloths, and of a cloth and a solid, that ignore each other.
    fn policies(&self, map: &VertexMap) -> PairPolicies {
        if self.ignored.is_empty() {
            return PairPolicies::default();
        }
        let mut owner: Vec<Option<u16>> = vec![None; map.count];
        let cloths: Vec<ObjectId> = map.objects().collect();
        for (number, &id) in (0..).zip(&cloths) {
            for &vertex in map.vertices_of(id).unwrap_or(&[]) {
                let owner = &mut owner[vertex as usize];
                *owner = Some(match *owner {
                    Some(other) if other != number => BETWEEN_OBJECTS,
                    _ => number,
                });
            }
        }
        let is_solid = |object: &Object| object.kind != Kind::Deformable;
        let solids = self.objects().filter(|(_, object)| is_solid(object));
        let solids: Vec<ObjectId> = solids.map(|(id, _)| id).collect();
        let cloth = |id: ObjectId| cloths.binary_search(&id).ok().map(|at| at as u16);
        let solid = |id: ObjectId| solids.binary_search(&id).ok().map(|at| at as u32);
        let between = self
            .ignored
            .iter()
            .filter_map(|&[a, b]| Some([cloth(a)?, cloth(b)?]));
        let through = self.ignored.iter().filter_map(|&[a, b]| {
            let [own, other] = if cloth(a).is_some() { [a, b] } else { [b, a] };
            Some((cloth(own)?, solid(other)?))
        });
        let owner = owner
            .into_iter()
            .map(|owner| owner.unwrap_or(BETWEEN_OBJECTS));
        PairPolicies::new(owner.collect(), between, through)
    }

    /// The layer of each vertex of the concatenated cloths; empty where all have the same.
    fn layers(&self, map: &VertexMap) -> Vec<u16> {
        let mut layers: Vec<u16> = Vec::with_capacity(map.target.len());
        for id in map.objects() {
            let Some(object) = self.object(id) else {
                continue;
            };
            layers.extend((0..object.vertex_count()).map(|v| object.layers.of(v)));
        }
        match layers.windows(2).all(|pair| pair[0] == pair[1]) {
            true => Vec::new(),
            false => layers,
        }
    }

    /// The pinned vertices of the merged cloth.
    pub(super) fn pins<'a>(&'a self, map: &'a VertexMap) -> impl Iterator<Item = u32> + 'a {
        map.objects().flat_map(move |id| {
            let object = self.object(id);
            let pins = object.into_iter().flat_map(|object| object.pins.iter());
            let own = map.vertices_of(id).unwrap_or(&[]);
            pins.filter_map(|&pin| own.get(pin as usize).copied())
        })
    }

    /// The gripped vertices of the merged cloth with their motions.
    fn led(&self, map: &VertexMap) -> Vec<PrescribedVertex> {
        let mut led = Vec::new();
        for id in map.objects() {
            let (Some(object), Some(own)) = (self.object(id), map.vertices_of(id)) else {
                continue;
            };
            for grip in &object.grips {
                led.extend(grip.vertices.iter().map(|&v| PrescribedVertex {
                    vertex: own[v as usize],
                    home: object.mesh.positions[v as usize],
                    motion: grip.motion.clone(),
                }));
            }
        }
        led
    }
}

/// Adds a cloth's vertices, triangles and materials to others.
fn append(all: &mut Cloth, cloth: &Cloth) {
    let vertex = all.positions.len() as u32;
    let material = all.materials.len() as u16;
    all.positions.extend(&cloth.positions);
    let triangles = cloth.triangles.iter();
    all.triangles
        .extend(triangles.map(|t| t.map(|v| v + vertex)));
    all.rest.extend(&cloth.rest);
    all.material
        .extend(cloth.material.iter().map(|m| m + material));
    let panel = all.panel.iter().max().map_or(0, |p| p + 1);
    all.panel.extend(cloth.panel.iter().map(|p| p + panel));
    all.materials.extend(cloth.materials.iter().cloned());
}
