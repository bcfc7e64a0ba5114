//! The model: everything about a simulation that does not change while it runs.

use crate::caps::without_caps;
use crate::contact_sample::ContactSample;
use crate::contact_settings::FIELD_REACH;
use crate::elastic::{Elastic, ElasticEnd};
use crate::laws::air::Air;
use crate::laws::bending::{BendingMatrix, BendingStencil, RestSheet};
use crate::laws::membrane::MembraneElement;
use crate::laws::stretch::MembraneLaw;
use crate::{Cloth, ContactSettings, DrapeError, Material, Motion, Pose};
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;
use toile_geometry::{DistanceField, SurfaceTree, TriangleMesh, Vec3};
use toile_sparse::{BlockPattern, ScalarMatrix};

/// A solid surface: exact for counting, smooth for forces.
#[derive(Clone)]
pub struct Collider {
    /// The surface with its tree.
    pub surface: Arc<SurfaceTree>,
    /// Smooth signed distance to it.
    pub field: Arc<DistanceField>,
    /// How it moves; nothing when it stands.
    pub motion: Option<Arc<Motion>>,
    /// Corners of the box round it as loaded [m].
    corners: [Vec3; 8],
}

/// Cells of a collider's distance field [m]: a third of the sharpest crease cloth is held in.
const FIELD_CELL: f64 = 6e-3;

impl Collider {
    /// Lays a distance field over a surface; it is sampled where cloth comes near.
    pub fn new(surface: Arc<SurfaceTree>) -> Self {
        let field = Arc::new(DistanceField::new(surface.clone(), FIELD_CELL, FIELD_REACH));
        Self {
            corners: box_corners(&surface.mesh().positions),
            surface,
            field,
            motion: None,
        }
    }

    /// The same on the move.
    pub fn moving(surface: Arc<SurfaceTree>, motion: Motion) -> Self {
        Self {
            motion: Some(Arc::new(motion)),
            ..Self::new(surface)
        }
    }

    /// Where it stands at a time [s]; nothing when it never moves.
    pub fn pose(&self, time: f64) -> Option<Pose> {
        self.motion.as_ref().map(|motion| motion.pose(time))
    }

    /// Smooth signed distance [m] and its gradient at a place, the surface standing as given.
    pub fn distance(&self, pose: Option<&Pose>, place: Vec3) -> Option<(f64, Vec3)> {
        match pose {
            None => self.field.distance(place),
            Some(pose) => {
                let (distance, slope) = self.field.distance(pose.undo(place))?;
                Some((distance, pose.rotation * slope))
            }
        }
    }

    /// Second derivative of the distance [1/m], likewise.
    pub fn curvature(&self, pose: Option<&Pose>, place: Vec3) -> Option<Matrix3<f64>> {
        match pose {
            None => self.field.curvature(place),
            Some(pose) => {
                let own = self.field.curvature(pose.undo(place))?;
                let turn = pose.rotation.matrix();
                Some(turn * own * turn.transpose())
            }
        }
    }

    /// How far any point of the surface moves between two placings [m], from the corners of its
    /// box: the way is largest at one of them, being affine in the point.
    pub fn travel(&self, from: &Pose, to: &Pose) -> f64 {
        let way = |&corner: &Vec3| (to.apply(corner) - from.apply(corner)).norm();
        self.corners.iter().map(way).fold(0.0, f64::max)
    }

    /// Pairs of a triangle of the surface as it stands at a time [s] and one of `cloth` that
    /// intersect, exactly for corners rounded to the body's own frame; the cloth's comes first.
    pub fn crossings(&self, time: f64, cloth: &TriangleMesh) -> Vec<[u32; 2]> {
        match self.pose(time) {
            None => self.surface.intersections_with(cloth),
            Some(pose) => {
                let places = cloth.positions.iter().map(|&p| pose.undo(p));
                self.surface.intersections_with(&TriangleMesh {
                    positions: places.collect(),
                    triangles: cloth.triangles.clone(),
                })
            }
        }
    }

    /// Exact signed distance [m] of a place from the surface as it stands at a time [s].
    pub fn exact_distance(&self, pose: Option<&Pose>, place: Vec3) -> f64 {
        let place = pose.map_or(place, |pose| pose.undo(place));
        let closest = self.surface.closest_point(place, f64::INFINITY);
        closest.map_or(f64::INFINITY, |c| c.signed_distance)
    }
}

fn box_corners(positions: &[Vec3]) -> [Vec3; 8] {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = Vec3::repeat(f64::NEG_INFINITY);
    for place in positions {
        low = low.inf(place);
        high = high.sup(place);
    }
    let of = |axis: usize, k: usize| [low, high][k >> axis & 1][axis];
    [0, 1, 2, 3, 4, 5, 6, 7].map(|k| Vec3::new(of(0, k), of(1, k), of(2, k)))
}

/// A pinned vertex that is led along a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Grip {
    /// The vertex.
    pub vertex: u32,
    /// Where it was loaded [m].
    pub home: Vec3,
    /// The motion.
    pub motion: Arc<Motion>,
}

/// The constant part of a simulation.
pub struct Model {
    /// Corners of the triangles: those of the cloth, but that caps (an angle near 180 degrees)
    /// have exchanged their long edge for the other diagonal of their pair.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles of the surface as it was given, where caps were exchanged.
    pub(crate) surface: Option<Vec<[u32; 3]>>,
    /// Material of each triangle.
    pub material: Vec<u16>,
    /// The materials.
    pub materials: Vec<Material>,
    /// How each material resists stretch.
    pub laws: Vec<MembraneLaw>,
    /// Mass of each vertex [kg].
    pub mass: Vec<f64>,
    /// Vertices that do not move.
    pub pinned: Vec<bool>,
    /// Pinned vertices that are led; only XPBD leads them.
    pub grips: Vec<Grip>,
    /// Attachment forces.
    pub elastics: Vec<Elastic>,
    /// Solid surfaces.
    pub colliders: Vec<Collider>,
    /// How the cloth meets them.
    pub contact: ContactSettings,
    /// Where the cloth is tested against them from the start: at its vertices. A state has more where it
    /// needs them.
    pub samples: Arc<Vec<ContactSample>>,
    /// Layer of each vertex, larger numbers farther out, or
    /// [`BETWEEN_LAYERS`](crate::collision::BETWEEN_LAYERS); empty where all are of one.
    pub layer: Vec<u16>,
    /// Acceleration of gravity [m/s2].
    pub gravity: Vec3,
    /// Drag per mass, of the air and of Rayleigh damping together [1/s]: a free velocity falls by
    /// exp(-drag t).
    pub air_drag: f64,
    /// What the air does to triangles; its own `drag` is in [`Model::air_drag`].
    pub air: Air,
    pub(crate) elements: Vec<MembraneElement>,
    pub(crate) bending: ScalarMatrix,
    /// Viscous matrix of bending, where any cloth has one: the pattern of `bending`.
    pub(crate) viscous_bending: Option<ScalarMatrix>,
    /// Curvatures of each triangle; empty unless folds are viscous or kept.
    pub(crate) stencils: Vec<BendingStencil>,
    /// Where the vertices lay when the model was built [m]: what orders of elimination follow.
    pub(crate) layout: Vec<Vec3>,
    pub(crate) pattern: BlockPattern,
    pub(crate) corner_start: Vec<u32>,
    pub(crate) corners: Vec<u32>,
    pub(crate) elastic_start: Vec<u32>,
    pub(crate) elastic_uses: Vec<u32>,
}

impl Model {
    /// Builds the model of a cloth that hangs free: add elastics, colliders and pins after.
    ///
    /// # Errors
    /// Bad indices, triangles without area, materials that cannot be simulated.
    pub fn new(object: &str, cloth: &Cloth) -> Result<Self, DrapeError> {
        let name = || object.to_owned();
        let mesh = cloth.mesh();
        mesh.check().map_err(|defect| DrapeError::Mesh {
            object: name(),
            defect,
        })?;
        for material in &cloth.materials {
            material.check(object)?;
        }
        let cloth = &*without_caps(cloth);
        let exchanged = cloth.triangles != mesh.triangles;
        let surface = exchanged.then(|| mesh.triangles.clone());
        let mesh = cloth.mesh();
        let mut elements = Vec::with_capacity(cloth.triangles.len());
        for (triangle, &rest) in cloth.rest.iter().enumerate() {
            let empty = || DrapeError::EmptyTriangle {
                object: name(),
                triangle,
            };
            elements.push(MembraneElement::new(rest).ok_or_else(empty)?);
        }
        let count = cloth.positions.len();
        let (corner_start, corners) = corner_lists(count, &cloth.triangles);
        let bending = Bending::new(cloth, &mesh, &elements);
        let mut model = Self {
            pattern: BlockPattern::new(count, &cloth.triangles),
            triangles: cloth.triangles.clone(),
            surface,
            material: cloth.material.clone(),
            laws: cloth.materials.iter().map(Material::membrane).collect(),
            materials: cloth.materials.clone(),
            mass: vec![0.0; count],
            pinned: vec![false; count],
            grips: Vec::new(),
            elastics: Vec::new(),
            colliders: Vec::new(),
            contact: ContactSettings::default(),
            samples: Arc::default(),
            layer: Vec::new(),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            air_drag: 0.0,
            air: Air::default(),
            elements,
            bending: bending.elastic,
            viscous_bending: bending.viscous,
            stencils: bending.stencils,
            layout: cloth.positions.clone(),
            corner_start,
            corners,
            elastic_start: vec![0; count + 1],
            elastic_uses: Vec::new(),
        };
        model.lump(count);
        Ok(model)
    }

    /// Elastics at a vertex with their other end.
    pub(crate) fn elastics_at(&self, v: usize) -> impl Iterator<Item = (usize, ElasticEnd)> + '_ {
        let uses = self.elastic_start[v] as usize..self.elastic_start[v + 1] as usize;
        self.elastic_uses[uses].iter().map(move |&e| {
            let elastic = &self.elastics[e as usize];
            let other = match elastic.from as usize == v {
                true => elastic.to,
                false => ElasticEnd::Vertex(elastic.from),
            };
            (e as usize, other)
        })
    }

    /// Lumps mass, area and friction at the vertices: a third of each triangle to each corner.
    fn lump(&mut self, count: usize) {
        let mut area = vec![0.0; count];
        let mut friction = vec![0.0; count];
        let mut restitution = vec![[0.0; 2]; count];
        for (t, corners) in self.triangles.iter().enumerate() {
            let share = self.elements[t].area / 3.0;
            let material = &self.materials[self.material[t] as usize];
            for &v in corners {
                area[v as usize] += share;
                self.mass[v as usize] += share * material.density;
                friction[v as usize] += share * material.friction;
                if let Some(e) = material.restitution {
                    restitution[v as usize][0] += share * e;
                    restitution[v as usize][1] += share;
                }
            }
        }
        let samples = (0..count)
            .filter(|&v| area[v] > 0.0)
            .map(|v| ContactSample {
                triangle: None,
                vertices: [v as u32; 3],
                weights: [1.0, 0.0, 0.0],
                area: area[v],
                friction: friction[v] / area[v],
                restitution: (restitution[v][1] > 0.0)
                    .then(|| restitution[v][0] / restitution[v][1]),
                extra_offset: 0.0,
            })
            .collect();
        self.samples = Arc::new(samples);
        // A vertex on no triangle has no mass; it stays where it is.
        for (v, &share) in area.iter().enumerate() {
            if share <= 0.0 {
                self.pinned[v] = true;
                self.mass[v] = 1.0;
            }
        }
    }

    /// Mass of the cloth at each vertex [kg]: that of the model, and none for a vertex on no triangle.
    pub(crate) fn cloth_mass(&self) -> Vec<f64> {
        let corners = self.corner_start.windows(2);
        let own = self.mass.iter().zip(corners);
        own.map(|(&mass, corners)| if corners[0] < corners[1] { mass } else { 0.0 })
            .collect()
    }

    /// Whether any cloth says how it bounces.
    pub(crate) fn bounces(&self) -> bool {
        self.materials.iter().any(|m| m.restitution.is_some())
    }

    /// Whether stretch of any cloth is viscous.
    pub(crate) fn has_viscous_stretch(&self) -> bool {
        self.materials.iter().any(|m| m.is_viscous()[0])
    }

    /// Whether any cloth keeps stretch or folds.
    pub(crate) fn keeps_strain(&self) -> bool {
        self.materials.iter().any(Material::keeps_strain)
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.mass.len()
    }

    /// Area of a triangle at rest [m2].
    pub fn rest_area(&self, triangle: usize) -> f64 {
        self.elements[triangle].area
    }

    /// Replaces the elastics.
    pub fn set_elastics(&mut self, elastics: Vec<Elastic>) {
        let mut uses: Vec<(u32, u32)> = Vec::new();
        for (e, elastic) in elastics.iter().enumerate() {
            uses.push((elastic.from, e as u32));
            if let ElasticEnd::Vertex(to) = elastic.to {
                uses.push((to, e as u32));
            }
        }
        uses.sort_unstable();
        let mut start = vec![0u32; self.vertex_count() + 1];
        for &(v, _) in &uses {
            start[v as usize + 1] += 1;
        }
        for v in 0..self.vertex_count() {
            start[v + 1] += start[v];
        }
        self.elastic_start = start;
        self.elastic_uses = uses.into_iter().map(|(_, e)| e).collect();
        self.elastics = elastics;
    }

    /// Sum of the stiffnesses of the elastics at a vertex at small gaps [N/m].
    pub(crate) fn elastic_stiffness(&self, v: usize) -> f64 {
        let uses = self.elastic_start[v] as usize..self.elastic_start[v + 1] as usize;
        self.elastic_uses[uses]
            .iter()
            .map(|&e| self.elastics[e as usize].law.stiffness)
            .sum()
    }

    /// Triangles of the surface as it was given.
    pub fn surface_triangles(&self) -> &[[u32; 3]] {
        self.surface.as_ref().unwrap_or(&self.triangles)
    }

    /// The surface at some positions.
    pub fn mesh(&self, positions: &[Vec3]) -> TriangleMesh {
        TriangleMesh {
            positions: positions.to_vec(),
            triangles: self.surface_triangles().to_vec(),
        }
    }
}

/// For each vertex the corners (3 t + k) that use it, in order.
pub(crate) fn corner_lists(count: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; count + 1];
    for &v in triangles.iter().flatten() {
        start[v as usize + 1] += 1;
    }
    for v in 0..count {
        start[v + 1] += start[v];
    }
    let mut next = start.clone();
    let mut corners = vec![0u32; 3 * triangles.len()];
    for (at, &v) in triangles.iter().flatten().enumerate() {
        corners[next[v as usize] as usize] = at as u32;
        next[v as usize] += 1;
    }
    (start, corners)
}

/// The bending of a cloth.
struct Bending {
    elastic: ScalarMatrix,
    viscous: Option<ScalarMatrix>,
    stencils: Vec<BendingStencil>,
}

impl Bending {
    fn new(cloth: &Cloth, mesh: &TriangleMesh, elements: &[MembraneElement]) -> Self {
        let topology = mesh.topology();
        let sheet = RestSheet {
            triangles: &cloth.triangles,
            rest: &cloth.rest,
            topology: &topology,
        };
        let stencils = sheet.stencils();
        let sum = |of: fn(&Material) -> BendingMatrix| {
            let laws: Vec<_> = cloth.materials.iter().map(of).collect();
            let mut entries = Vec::with_capacity(100 * stencils.len());
            for (t, stencil) in stencils.iter().enumerate() {
                let law = laws[cloth.material[t] as usize];
                let stiffness = stencil.stiffness(law) * elements[t].area;
                for (&i, p) in stencil.vertices.iter().zip(&stencil.weights) {
                    let moment = stiffness * Vector3::from(*p);
                    for (&j, q) in stencil.vertices.iter().zip(&stencil.weights) {
                        entries.push((i, j, moment.dot(&Vector3::from(*q))));
                    }
                }
            }
            ScalarMatrix::from_entries(cloth.positions.len(), &entries)
        };
        let elastic = sum(Material::bending_matrix);
        let viscous = cloth
            .materials
            .iter()
            .any(|m| m.is_viscous()[1])
            .then(|| sum(Material::viscous_bend));
        let kept = cloth.materials.iter().any(|m| m.kept[1] > 0.0);
        Self {
            elastic,
            stencils: if kept || viscous.is_some() {
                stencils
            } else {
                Vec::new()
            },
            viscous,
        }
    }
}
