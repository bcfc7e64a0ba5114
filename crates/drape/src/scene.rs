//! The scene: the description of a simulation, independent of file formats.

use crate::environment::check_number;
use crate::material::MaterialLaws;
use crate::{
    Air, Cloth, Damping, DrapeError, Environment, Material, MethodSettings, Motion, SharedTrack,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A simulation: objects, elastics, grips, environment, duration and method.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3,
    /// The air.
    pub air: Air,
    /// Rayleigh damping.
    pub damping: Damping,
    /// Time simulated before time 0, in which figures go into their clips (s).
    pub lead_in: f64,
    /// Time simulated from 0 on (s).
    pub duration: f64,
    /// Step in time (s).
    pub step: f64,
    /// Time between saved frames (s); none to save only the last state.
    pub frame_step: Option<f64>,
    /// The method.
    pub method: MethodSettings,
    /// Contact settings.
    pub contact: crate::ContactSettings,
    /// The objects.
    pub objects: Vec<SceneObject>,
    /// Attachment forces between them.
    pub elastics: Vec<SceneElastic>,
    /// Vertices of cloth on a prescribed motion.
    pub grips: Vec<SceneGrip>,
    /// Pairs of object indices that pass through each other; a cloth paired with itself passes through itself.
    pub ignored: Vec<[usize; 2]>,
}

impl Default for Scene {
    /// Earth's gravity, still air without drag, one second in steps of 1/120 s.
    fn default() -> Self {
        Self {
            gravity: Vec3::new(0.0, -9.81, 0.0),
            air: Air::default(),
            damping: Damping::default(),
            lead_in: 0.0,
            duration: 1.0,
            step: 1.0 / 120.0,
            frame_step: None,
            method: MethodSettings::default(),
            contact: crate::ContactSettings::default(),
            objects: Vec::new(),
            elastics: Vec::new(),
            grips: Vec::new(),
            ignored: Vec::new(),
        }
    }
}

/// The cause of an object's motion in a scene, with its data; in a running world it is [`crate::world::Kind`].
#[derive(Clone, Debug, PartialEq)]
pub enum ObjectKind {
    /// A solid at rest.
    Static,
    /// A solid on a prescribed motion, of all of it or of each vertex. Only `xpbd` supports it.
    Animated {
        /// Its motion as a whole.
        motion: Option<Motion>,
        /// The way of its vertices before that motion.
        track: Option<SharedTrack>,
    },
    /// The simulation: it is cloth.
    Deformable {
        /// Its material.
        material: Material,
        /// Vertices that do not move.
        pins: Vec<u32>,
    },
}

impl ObjectKind {
    /// A solid that moves as a whole.
    pub fn moving(motion: Motion) -> Self {
        Self::Animated {
            motion: Some(motion),
            track: None,
        }
    }

    /// A solid whose vertices move one by one.
    pub fn tracked(track: SharedTrack) -> Self {
        Self::Animated {
            motion: None,
            track: Some(track),
        }
    }
}

/// An object, with its transform applied.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// Unique name.
    pub name: String,
    /// The cause of its motion.
    pub kind: ObjectKind,
    /// Its surface (m).
    pub mesh: TriangleMesh,
    /// Rest shape of a garment's panels; none where the mesh itself is the rest shape.
    pub cloth: Option<Cloth>,
    /// Layer of a cloth among cloths worn over one another. Larger numbers lie farther out, on the side of the inner
    /// ones' normals; cloths of one layer have no order.
    pub layer: u16,
}

/// Largest number of a layer.
pub const MAX_LAYER: u16 = 999;

/// Vertices of a cloth on a prescribed motion. Only `xpbd` supports them.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneGrip {
    /// Index of the object.
    pub object: usize,
    /// The vertices.
    pub vertices: Vec<u32>,
    /// The motion.
    pub motion: Motion,
}

/// One end of an elastic in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneEnd {
    /// A vertex of an object.
    Vertex {
        /// Index of the object.
        object: usize,
        /// The vertex.
        vertex: u32,
    },
    /// A point in space (m).
    Point(Vec3),
}

/// A spring of rest length zero in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneElastic {
    /// The first end.
    pub from: SceneEnd,
    /// The second end.
    pub to: SceneEnd,
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Distance below which the two vertices are merged (m); none where they never are.
    pub merge_within: Option<f64>,
}

/// Most steps of a scene: more are a mistake in step or duration.
const MAX_STEPS: f64 = 1e7;

impl Scene {
    /// Refuses an invalid scene before anything is built.
    ///
    /// # Errors
    /// The first invalid value, with its field and the remedy.
    pub fn check(&self) -> Result<(), DrapeError> {
        let refuse = |place: String, what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place,
                what,
                remedy: remedy.to_owned(),
            })
        };
        for (field, value, least) in [
            ("lead_in", self.lead_in, 0.0),
            ("duration", self.duration, 0.0),
            ("step", self.step, f64::MIN_POSITIVE),
        ] {
            check_number(field, value, least)?;
        }
        if (self.lead_in + self.duration) / self.step > MAX_STEPS {
            return refuse(
                "step".to_owned(),
                format!("{} s takes more than 1e7 steps", self.step),
                "give a longer step or a shorter duration",
            );
        }
        if let Some(frame) = self.frame_step
            && !(frame.is_finite() && frame > 0.0)
        {
            return refuse(
                "frame step".to_owned(),
                format!("{frame} is out of range"),
                "give a number of seconds above zero",
            );
        }
        self.environment().check()?;
        self.check_objects()?;
        self.check_distances()?;
        self.check_layers()?;
        self.check_motions()?;
        self.check_ignored()?;
        for (index, elastic) in self.elastics.iter().enumerate() {
            let place = format!("elastics[{index}]");
            if !(elastic.stiffness.is_finite() && elastic.stiffness >= 0.0) {
                return refuse(
                    place,
                    format!("stiffness {} is out of range", elastic.stiffness),
                    "give a finite number in N/m, zero or above",
                );
            }
            for end in [elastic.from, elastic.to] {
                if let SceneEnd::Vertex { object, vertex } = end {
                    let Some(named) = self.objects.get(object) else {
                        return refuse(
                            place,
                            format!("there is no object {object}"),
                            "name an object of the scene",
                        );
                    };
                    if vertex as usize >= named.mesh.positions.len() {
                        let what = format!("\"{}\" has no vertex {vertex}", named.name);
                        return refuse(
                            place,
                            what,
                            "name a vertex below the object's vertex count",
                        );
                    }
                }
            }
        }
        Ok(())
    }

    fn check_ignored(&self) -> Result<(), DrapeError> {
        for (index, &pair) in self.ignored.iter().enumerate() {
            let refuse = |what: String, remedy: &str| {
                Err(DrapeError::Scene {
                    place: format!("ignored pair {index}"),
                    what,
                    remedy: remedy.to_owned(),
                })
            };
            let mut is_cloth = false;
            for number in pair {
                let Some(object) = self.objects.get(number) else {
                    let what = format!("there is no object {number}");
                    return refuse(what, "name an object of the scene");
                };
                is_cloth |= matches!(object.kind, ObjectKind::Deformable { .. });
            }
            if !is_cloth {
                let [a, b] = pair.map(|number| &self.objects[number].name);
                let what = format!("\"{a}\" and \"{b}\" are solids, which never meet");
                return refuse(what, "name a cloth and what it passes through");
            }
        }
        Ok(())
    }

    /// Gravity, air, damping and contact.
    pub(crate) fn environment(&self) -> Environment {
        Environment {
            gravity: self.gravity,
            air: self.air,
            damping: self.damping,
            contact: self.contact,
            layers_apart: None,
            recess: 0.0,
        }
    }

    /// The materials of an object's cloth; none for a solid.
    pub fn materials_of(object: &SceneObject) -> &[Material] {
        match (&object.kind, &object.cloth) {
            (ObjectKind::Deformable { .. }, Some(cloth)) => &cloth.materials,
            (ObjectKind::Deformable { material, .. }, None) => std::slice::from_ref(material),
            _ => &[],
        }
    }

    fn check_distances(&self) -> Result<(), DrapeError> {
        self.contact.check_reach("collision.offset")?;
        for object in &self.objects {
            let contact = self.contact.for_cloth(Self::materials_of(object));
            contact.check_reach(&format!("thickness of \"{}\"", object.name))?;
        }
        Ok(())
    }

    fn check_layers(&self) -> Result<(), DrapeError> {
        let refuse = |object: &SceneObject, what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place: format!("layer of \"{}\"", object.name),
                what,
                remedy: remedy.to_owned(),
            })
        };
        for object in self.objects.iter().filter(|object| object.layer > 0) {
            if !matches!(object.kind, ObjectKind::Deformable { .. }) {
                let what = "only cloth is worn in layers".to_owned();
                return refuse(object, what, "leave it out: bodies lie under every layer");
            }
            if object.layer > MAX_LAYER {
                let what = format!("{} is out of range", object.layer);
                return refuse(object, what, "give a number from 0 to 999");
            }
        }
        let cloths = || {
            let cloth = |o: &&SceneObject| matches!(o.kind, ObjectKind::Deformable { .. });
            self.objects.iter().filter(cloth)
        };
        let first = cloths().next().map(|object| object.layer);
        let Some(other) = cloths().find(|object| Some(object.layer) != first) else {
            return Ok(());
        };
        if self.contact.cloth_offset <= 0.0 {
            let what = "cloth passes through cloth, so layers have no order".to_owned();
            let remedy = "give collision.cloth_offset a distance, as in 0.002";
            return refuse(other, what, remedy);
        }
        Ok(())
    }

    fn check_motions(&self) -> Result<(), DrapeError> {
        let refuse = |place: String, what: String, remedy: &str| {
            Err(DrapeError::Scene {
                place,
                what,
                remedy: remedy.to_owned(),
            })
        };
        let mut moved: Vec<(String, &Motion)> = Vec::new();
        for object in &self.objects {
            if let ObjectKind::Animated {
                motion: Some(motion),
                ..
            } = &object.kind
            {
                moved.push((format!("motion of \"{}\"", object.name), motion));
            }
        }
        let mut gripped = std::collections::BTreeSet::new();
        for (index, grip) in self.grips.iter().enumerate() {
            let place = format!("grip {index}");
            let Some(object) = self.objects.get(grip.object) else {
                return refuse(
                    place,
                    format!("there is no object {}", grip.object),
                    "name an object of the scene",
                );
            };
            if !matches!(object.kind, ObjectKind::Deformable { .. }) {
                let what = format!("\"{}\" is not deformable", object.name);
                return refuse(place, what, "grip cloth; a solid moves as a whole");
            }
            let count = object.mesh.positions.len();
            if let Some(vertex) = grip.vertices.iter().find(|&&v| v as usize >= count) {
                let what = format!("\"{}\" has no vertex {vertex}", object.name);
                return refuse(place, what, "name a vertex below the object's vertex count");
            }
            let taken = |v: &&u32| !gripped.insert((grip.object, **v));
            if let Some(vertex) = grip.vertices.iter().find(taken) {
                let what = format!("vertex {vertex} of \"{}\" is gripped already", object.name);
                return refuse(place, what, "name each vertex in one grip, once");
            }
            moved.push((place, &grip.motion));
        }
        for (place, motion) in &moved {
            if let Some(what) = motion.defect() {
                let remedy = "give keys with rising times and finite numbers";
                return refuse(place.clone(), what, remedy);
            }
        }
        Ok(())
    }

    fn check_objects(&self) -> Result<(), DrapeError> {
        for (index, object) in self.objects.iter().enumerate() {
            object.mesh.check().map_err(|defect| DrapeError::Mesh {
                object: object.name.clone(),
                defect,
            })?;
            if self.objects[..index]
                .iter()
                .any(|other| other.name == object.name)
            {
                return Err(DrapeError::Scene {
                    place: format!("objects[{index}]"),
                    what: format!("a second object is called \"{}\"", object.name),
                    remedy: "give every object its own name".to_owned(),
                });
            }
            let ObjectKind::Deformable { material, pins } = &object.kind else {
                continue;
            };
            material.check(&object.name)?;
            if let Some(pin) = pins
                .iter()
                .find(|&&pin| pin as usize >= object.mesh.positions.len())
            {
                return Err(DrapeError::Scene {
                    place: format!("pins of \"{}\"", object.name),
                    what: format!("there is no vertex {pin}"),
                    remedy: format!(
                        "name vertices from 0 to {}",
                        object.mesh.positions.len().max(1) - 1
                    ),
                });
            }
        }
        Ok(())
    }
}
