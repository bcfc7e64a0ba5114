//! Objects of a world: surfaces with their kind, cloth, material and motion.

use crate::material::MaterialLaws;
use crate::scene::{MAX_LAYER, ObjectKind, SceneObject};
use crate::track::animated_positions;
use crate::{Cloth, DrapeError, Material, Motion, SharedTrack};
use serde::ser::Error;
use serde::{Deserialize, Serialize, Serializer};
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};

/// The number of an object, in order of creation; never reused in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ObjectId(pub(super) u32);

/// A vertex of an object's own mesh, before merging.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshVertex {
    /// The object.
    pub object: ObjectId,
    /// The vertex of its mesh.
    pub vertex: u32,
}

impl MeshVertex {
    /// A pair of vertices, the smaller first, as a world stores it.
    pub(super) fn pair([a, b]: [Self; 2]) -> [Self; 2] {
        [a.min(b), a.max(b)]
    }
}

/// The cause of an object's motion in a running world. [`crate::ObjectKind`] is that of an object in a file, with its
/// data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// A solid at rest.
    Static,
    /// A solid on a prescribed motion.
    Animated,
    /// Simulated cloth.
    Deformable,
}

/// Vertices of a cloth with a prescribed motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VertexGrip {
    /// The vertices of its mesh.
    pub vertices: Vec<u32>,
    /// The motion: its pose takes each vertex from its position in the mesh to its position in the world.
    pub motion: Arc<Motion>,
}

/// Layers of the vertices of a cloth among cloths worn over one another; larger numbers lie farther out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Layers {
    /// The same layer for all vertices.
    One(u16),
    /// A layer for each vertex.
    Each(Vec<u16>),
}

impl Layers {
    /// The layer of a vertex.
    pub(super) fn of(&self, vertex: usize) -> u16 {
        match self {
            Self::One(layer) => *layer,
            Self::Each(layers) => layers.get(vertex).copied().unwrap_or(0),
        }
    }
}

/// An object. Kind, shape, material and motion are independent: a change of kind loses none of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Unique name.
    pub name: String,
    /// The cause of its motion.
    pub kind: Kind,
    /// Its surface (m): of a static object in the world, of an animated one in its own frame, of a cloth as it was when
    /// it became cloth.
    #[serde(with = "super::written_mesh")]
    pub mesh: Arc<TriangleMesh>,
    /// Rest shapes and materials of its triangles, and its starting positions (m). Made from the mesh and the material
    /// when it first becomes deformable.
    pub cloth: Option<Arc<Cloth>>,
    /// Its material until it has a cloth.
    pub material: Option<Material>,
    /// Its motion as a whole while it is animated.
    pub motion: Option<Arc<Motion>>,
    /// The way of its vertices before that motion while it is animated.
    #[serde(
        skip_deserializing,
        skip_serializing_if = "Option::is_none",
        serialize_with = "no_track"
    )]
    pub track: Option<SharedTrack>,
    /// Vertices at rest while it is deformable.
    pub pins: Vec<u32>,
    /// Vertices with a prescribed motion while it is deformable.
    pub grips: Vec<VertexGrip>,
    /// Its layers while it is deformable.
    pub layers: Layers,
}

/// Refuses to write a track, which is a rule and no data: whoever saves an object with one keeps its digest beside it.
fn no_track<S: Serializer>(track: &Option<SharedTrack>, to: S) -> Result<S::Ok, S::Error> {
    match track {
        None => to.serialize_none(),
        Some(_) => Err(S::Error::custom("the track of an object cannot be written")),
    }
}

impl Object {
    /// A static object.
    pub fn fixed(name: impl Into<String>, mesh: TriangleMesh) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Static,
            mesh: Arc::new(mesh),
            cloth: None,
            material: None,
            motion: None,
            track: None,
            pins: Vec::new(),
            grips: Vec::new(),
            layers: Layers::One(0),
        }
    }

    /// A cloth in layer 0 without pins and grips.
    pub fn deformable(name: impl Into<String>, cloth: Cloth) -> Self {
        Self {
            kind: Kind::Deformable,
            cloth: Some(Arc::new(cloth.clone())),
            ..Self::fixed(name, cloth.mesh())
        }
    }

    /// An object of a scene, without its grips.
    ///
    /// # Errors
    /// A mesh without a rest shape.
    pub(super) fn of_scene(object: &SceneObject) -> Result<Self, DrapeError> {
        let mut own = Self {
            cloth: object.cloth.clone().map(Arc::new),
            layers: Layers::One(object.layer),
            ..Self::fixed(&object.name, object.mesh.clone())
        };
        match &object.kind {
            ObjectKind::Static => {}
            ObjectKind::Animated { motion, track } => {
                own.kind = Kind::Animated;
                own.motion = motion.clone().map(Arc::new);
                own.track = track.clone();
            }
            ObjectKind::Deformable { material, pins } => {
                own.kind = Kind::Deformable;
                own.material = Some(material.clone());
                own.pins.clone_from(pins);
                own.ensure_cloth()?;
            }
        }
        Ok(own)
    }

    /// Makes its cloth from its mesh and its material unless it has one.
    ///
    /// # Errors
    /// No material, a mesh that cannot be a rest shape.
    pub(super) fn ensure_cloth(&mut self) -> Result<(), DrapeError> {
        if self.cloth.is_some() {
            return Ok(());
        }
        let Some(material) = self.material.clone() else {
            return Err(self.refuse("it has no material", "give it one to make it deformable"));
        };
        let cloth = Cloth::from_mesh(&self.name, &self.mesh, material)?;
        self.cloth = Some(Arc::new(cloth));
        Ok(())
    }

    /// Its cloth while it is deformable.
    pub fn deformable_cloth(&self) -> Option<&Cloth> {
        match self.kind {
            Kind::Deformable => self.cloth.as_deref(),
            _ => None,
        }
    }

    /// Number of vertices of its mesh.
    pub fn vertex_count(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Refuses an object that cannot be simulated as its kind.
    ///
    /// # Errors
    /// The first of its properties that does not fit, with the remedy.
    pub(super) fn check(&self) -> Result<(), DrapeError> {
        self.mesh.check().map_err(|defect| DrapeError::Mesh {
            object: self.name.clone(),
            defect,
        })?;
        let count = self.vertex_count();
        let of_grips = self.grips.iter().flat_map(|grip| &grip.vertices);
        if let Some(v) = (self.pins.iter().chain(of_grips)).find(|&&v| v as usize >= count) {
            let what = format!("it has no vertex {v}");
            return Err(self.refuse(&what, "name vertices below its vertex count"));
        }
        let motions = self
            .motion
            .iter()
            .chain(self.grips.iter().map(|g| &g.motion));
        if let Some(what) = motions.filter_map(|motion| motion.defect()).next() {
            return Err(self.refuse(&what, "give keys with rising times and finite numbers"));
        }
        match (self.kind, &self.cloth) {
            (Kind::Animated, _) => match &self.track {
                Some(track) => self.check_track(track),
                None if self.motion.is_none() => {
                    Err(self.refuse("it has no motion", "give it one, or let it stand"))
                }
                None => Ok(()),
            },
            (Kind::Deformable, Some(cloth)) => {
                if cloth.triangles != self.mesh.triangles || cloth.positions.len() != count {
                    let remedy = "give cloth and surface the same triangles";
                    return Err(self.refuse("its cloth is of another mesh", remedy));
                }
                if let Some(what) = cloth.defect() {
                    return Err(self.refuse(&what, "give each triangle its own"));
                }
                if let Layers::Each(layers) = &self.layers
                    && layers.len() != count
                {
                    let what = format!("{} layers are given for {count} vertices", layers.len());
                    return Err(self.refuse(&what, "give one for each, or one for all"));
                }
                let most = (0..count).map(|v| self.layers.of(v)).max().unwrap_or(0);
                if most > MAX_LAYER {
                    let what = format!("layer {most} is out of range");
                    return Err(self.refuse(&what, "give numbers from 0 to 999"));
                }
                for material in &cloth.materials {
                    material.check(&self.name)?;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Whether its vertices move one by one.
    pub(super) fn bends(&self) -> bool {
        self.kind == Kind::Animated && self.track.is_some()
    }

    /// Refuses what is to be attached to its frame where its vertices move one by one, so that it has none.
    pub(super) fn check_frame(&self) -> Result<(), DrapeError> {
        if self.bends() {
            let remedy = "attach it to a point of its surface or to a frame of its track";
            return Err(self.refuse("a surface that bends has no frame of its own", remedy));
        }
        Ok(())
    }

    /// Refuses a point within a triangle that it has not, or outside of it.
    pub(super) fn check_place(&self, triangle: u32, weights: [f64; 3]) -> Result<(), DrapeError> {
        let count = self.mesh.triangles.len();
        if triangle as usize >= count {
            let what = format!("it has no triangle {triangle}");
            return Err(self.refuse(&what, &format!("name one below {count}")));
        }
        let sum: f64 = weights.iter().sum();
        // Rounding of weights in files; NaN is outside.
        let within = weights.iter().all(|&weight| weight >= -1e-9);
        if !(within && (sum - 1.0).abs() <= 1e-6) {
            let what = format!("weights {weights:?} are of no point of a triangle");
            return Err(self.refuse(&what, "give three numbers of 0 to 1 with the sum 1"));
        }
        Ok(())
    }

    /// Refuses a frame that its track has not, and a point in it that is no number.
    pub(super) fn check_track_frame(&self, frame: u16, point: Vec3) -> Result<(), DrapeError> {
        let track = self.track.as_ref().filter(|_| self.bends());
        let count = track.map_or(0, |track| track.frames(0.0).len());
        if usize::from(frame) >= count {
            let what = format!("it has no frame {frame}: there are {count}");
            return Err(self.refuse(&what, "attach it to a point of the surface"));
        }
        match point.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(self.refuse("the point is not finite", "give numbers in m")),
        }
    }

    /// Refuses a track of another surface, or one that begins at no number.
    fn check_track(&self, track: &SharedTrack) -> Result<(), DrapeError> {
        let (positions, count) = (track.positions(0.0), self.vertex_count());
        if positions.len() != count {
            let what = format!("its track has {} vertices, not {count}", positions.len());
            return Err(self.refuse(&what, "give it the track of its own surface"));
        }
        let finite = |p: &Vec3| p.iter().all(|x| x.is_finite());
        match positions.iter().position(|p| !finite(p)) {
            Some(v) => {
                let what = format!("its track has no number for vertex {v}");
                Err(self.refuse(&what, "give finite numbers in m"))
            }
            None => Ok(()),
        }
    }

    /// Places of its vertices at a time (s) while it is animated (m).
    pub(super) fn animated_positions(&self, time: f64) -> Vec<Vec3> {
        let loaded = &self.mesh.positions;
        animated_positions(loaded, self.track.as_ref(), self.motion.as_deref(), time)
    }

    /// An error about this object.
    pub(crate) fn refuse(&self, what: &str, remedy: &str) -> DrapeError {
        DrapeError::Scene {
            place: format!("\"{}\"", self.name),
            what: what.to_owned(),
            remedy: remedy.to_owned(),
        }
    }
}
