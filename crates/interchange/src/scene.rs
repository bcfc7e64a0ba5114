//! The scene file: JSON for every object of a simulation.
//!
//! All quantities are in SI units. Meshes, patterns and bodies are named by path; the caller that has loaded
//! them turns a [`SceneFile`] into a scene.
//!
//! # Decided with
//! - [`toile_drape::MethodKind`], [`crate::scene::SceneFile::method`]: methods by name; settings that one has
//!   no use for are refused;
//! - [`crate::scene_motion::MotionFile`], [`crate::scene::ObjectFile`]: motions; objects with their
//!   materials;
//! - [`toile_drape::Environment`], [`toile_drape::ContactSettings`]: air, damping, contact; contact and
//!   friction off where the file says so;
//! - [`toile_drape::laws::air::Air`], [`crate::scene::earth`]: wind of a scene; gravity of a scene that gives
//!   none;
//! - [`toile_drape::Scene::check`]: how a scene is checked;
//! - [`toile_drape::World`]: the world made of it.
//!
//! By hand: `unknown_fields` names every part that may have some. The scene is built in crate `session`,
//! `scene_builder.rs`.

use crate::scene_motion::{GripFile, MotionFile, Unknown};
use crate::{FormatError, MaterialFile};
use serde::{Deserialize, Serialize};
use toile_body::AskedStance;
use toile_drape::{Air, ContactSettings, Damping, MethodKind, MethodSettings, Scene};
use toile_geometry::Vec3;

/// A scene as written in its file.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct SceneFile {
    /// Acceleration of gravity (m/s2).
    #[serde(default = "earth")]
    pub gravity: [f64; 3],
    /// The air: drag, density and wind.
    #[serde(default)]
    pub air: AirFile,
    /// Damping of all objects.
    #[serde(default)]
    pub damping: DampingFile,
    /// Simulated time (s). Default: until all figures that come to rest have stood still for 1 s, or 1 s if
    /// there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Time step (s).
    #[serde(default = "usual_step")]
    pub step: f64,
    /// Time between saved frames (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame_step: Option<f64>,
    /// The time integration method. Default: `xpbd` if a body moves, else implicit Euler.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<MethodFile>,
    /// Contact of cloth with surfaces and with cloth.
    #[serde(default)]
    pub collision: CollisionFile,
    /// Axes and unit of mesh files. Default: recognised from a person among the meshes.
    #[serde(default)]
    pub meshes: MeshesFile,
    /// The objects.
    pub objects: Vec<ObjectFile>,
    /// Elastics: attachment forces between two vertices, or a vertex and a point.
    #[serde(default)]
    pub elastics: Vec<ElasticFile>,
    #[serde(flatten)]
    unknown: Unknown,
}

/// Axes and unit of a scene's mesh files.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct MeshesFile {
    /// The axis that is up: `x`, `y`, `z`, `-x`, `-y` or `-z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<String>,
    /// Unit: `m`, `cm`, `mm`, `in` or `ft`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    #[serde(flatten)]
    unknown: Unknown,
}

impl MeshesFile {
    /// The axis and the unit that the file states.
    ///
    /// # Errors
    /// An unknown axis or an unknown unit.
    pub fn asked(&self) -> Result<AskedStance, FormatError> {
        let wrong = |field: &str, what: String| {
            FormatError::new(
                format!("meshes.{field}"),
                what,
                "correct it, or leave it out",
            )
        };
        Ok(AskedStance {
            up: read_word(&self.up).map_err(|what| wrong("up", what))?,
            forward: None,
            unit: read_word(&self.unit).map_err(|what| wrong("unit", what))?,
        })
    }
}

fn read_word<T: std::str::FromStr<Err = String>>(
    text: &Option<String>,
) -> Result<Option<T>, String> {
    text.as_deref().map(str::parse).transpose()
}

/// The air of a scene.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct AirFile {
    /// Drag coefficient per mass (1/s).
    #[serde(default)]
    pub drag: f64,
    /// Density (kg/m3). Default: that at sea level if `normal`, `tangential` or `wind` is given, or else 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Drag coefficient normal to the cloth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<f64>,
    /// Drag coefficient tangential to the cloth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential: Option<f64>,
    /// Velocity of the wind (m/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind: Option<[f64; 3]>,
    #[serde(flatten)]
    unknown: Unknown,
}

impl AirFile {
    /// The air, with defaults for missing values.
    pub fn air(&self) -> Air {
        let usual = Air::default();
        let acts = self.normal.is_some() || self.tangential.is_some() || self.wind.is_some();
        let density = if acts { Air::SEA_LEVEL } else { usual.density };
        Air {
            drag: self.drag,
            density: self.density.unwrap_or(density),
            normal: self.normal.unwrap_or(usual.normal),
            tangential: self.tangential.unwrap_or(usual.tangential),
            wind: self.wind.map_or(usual.wind, Vec3::from),
        }
    }
}

/// Rayleigh damping of a scene.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct DampingFile {
    /// Mass-proportional coefficient (1/s).
    #[serde(default)]
    pub mass: f64,
    /// Stiffness-proportional coefficient (s).
    #[serde(default)]
    pub stiffness: f64,
    #[serde(flatten)]
    unknown: Unknown,
}

impl DampingFile {
    /// The damping.
    pub fn damping(&self) -> Damping {
        Damping {
            mass: self.mass,
            stiffness: self.stiffness,
        }
    }
}

/// The time integration method of a scene.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct MethodFile {
    /// Name of the method.
    pub name: String,
    /// Number of substeps in a step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub substeps: Option<u32>,
    /// Largest number of iterations in a substep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iterations: Option<usize>,
    /// Tolerance at which iterations stop: norm of a gradient (N) if the method computes motion in time, net
    /// force divided by weight if it computes the state of rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    #[serde(flatten)]
    unknown: Unknown,
}

impl Default for MethodFile {
    fn default() -> Self {
        Self {
            name: MethodKind::default().name().to_owned(),
            substeps: None,
            iterations: None,
            tolerance: None,
            unknown: Unknown::new(),
        }
    }
}

/// Contact in a scene.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct CollisionFile {
    /// Distance kept between cloth and surfaces (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Contact stiffness: pressure per penetration depth (N/m3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Whether friction acts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<bool>,
    /// Distance kept between the mid-surfaces of two cloths (m). If missing or 0, cloth passes through cloth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cloth_offset: Option<f64>,
    /// Pairs of object names that pass through each other; a cloth paired with itself has no self-contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ignore: Vec<[String; 2]>,
    #[serde(flatten)]
    unknown: Unknown,
}

/// One object of a scene.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ObjectFile {
    /// Name, unique in the scene.
    pub name: String,
    /// Kind of the object: `static`, `animated` or `deformable`.
    pub kind: String,
    /// A mesh file (OBJ or PLY), with a path relative to the scene file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<String>,
    /// A pattern file. Its garment is sewn on the body `on`, or else on the first body of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pattern: Option<String>,
    /// Name of the body that wears the garment. Before the scene begins, the garment is sewn and draped to
    /// rest on the body, together with all other garments of that body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// `preview`, `fit` or `final`: mesh size of a worn garment, and how close to rest it is draped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quality: Option<String>,
    /// A mannequin: `woman`, `man`, `mean`, or a file of measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// A file of recorded frames (the motion of an animated object, or the initial state of a deformable
    /// one), or a point cache (PC2) of the object's mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<String>,
    /// Name of the object in the recording. Default: the object of the same name, or the only one that moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub object: Option<String>,
    /// The frame that a deformable object starts from, counted from 0. Default: the last frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<usize>,
    /// Frame rate of a point cache (1/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Placement of the object in the scene.
    #[serde(default)]
    pub transform: TransformFile,
    /// Material of a deformable object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<MaterialFile>,
    /// Vertices that do not move.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<u32>,
    /// Motion of an animated object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionFile>,
    /// Vertices of a deformable object that follow a given motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grips: Vec<GripFile>,
    /// Layer of a deformable object among cloths worn over one another: larger lies farther out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<u16>,
    #[serde(flatten)]
    unknown: Unknown,
}

/// A similarity transform: scale, then rotation, then translation.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct TransformFile {
    /// Translation (m).
    #[serde(default)]
    pub translation: [f64; 3],
    /// Rotation vector: axis times angle (rad).
    #[serde(default)]
    pub rotation: [f64; 3],
    /// Uniform scale.
    #[serde(default = "one")]
    pub scale: f64,
    #[serde(flatten)]
    unknown: Unknown,
}

impl Default for TransformFile {
    fn default() -> Self {
        Self {
            translation: [0.0; 3],
            rotation: [0.0; 3],
            scale: 1.0,
            unknown: Unknown::new(),
        }
    }
}

impl TransformFile {
    /// Position in the scene of a point of the object's own file (m).
    pub fn apply(&self, point: Vec3) -> Vec3 {
        nalgebra::Rotation3::from_scaled_axis(Vec3::from(self.rotation)) * (point * self.scale)
            + Vec3::from(self.translation)
    }
}

/// An elastic between two ends.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ElasticFile {
    /// First end: a vertex of an object.
    pub from: EndFile,
    /// Second end: a vertex of an object, or a point.
    pub to: EndFile,
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Distance at which the two ends are merged into one vertex (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub merge_within: Option<f64>,
    #[serde(flatten)]
    unknown: Unknown,
}

/// One end of an elastic: `["shirt", 12]`, or `[x, y, z]` in metres.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub enum EndFile {
    /// A vertex of an object.
    Vertex(String, u32),
    /// A fixed point (m).
    Point([f64; 3]),
}

fn earth() -> [f64; 3] {
    [0.0, -9.81, 0.0]
}
fn one() -> f64 {
    1.0
}
/// Largest number of substeps, and of iterations, that a file may ask for: more is surely a mistake.
const MAX_ITERATIONS: usize = 1_000_000;

fn usual_step() -> f64 {
    Scene::default().step
}

impl SceneFile {
    /// The time integration method with its settings.
    ///
    /// # Errors
    /// An unknown name (the message lists the known ones), or settings out of range.
    pub fn method(&self) -> Result<MethodSettings, FormatError> {
        let moves = |object: &ObjectFile| object.body.is_some() && object.motion.is_some();
        let usual = MethodFile {
            name: match self.objects.iter().any(moves) {
                true => MethodKind::Xpbd.name().to_owned(),
                false => MethodKind::default().name().to_owned(),
            },
            ..MethodFile::default()
        };
        let file = self.method.as_ref().unwrap_or(&usual);
        let found = MethodKind::ALL.iter().find(|(name, _)| *name == file.name);
        let Some(&(_, kind)) = found else {
            let known: Vec<_> = MethodKind::ALL.iter().map(|(name, _)| *name).collect();
            return Err(FormatError::new(
                "method.name",
                format!("\"{}\" is not a method", file.name),
                format!("write one of {}", known.join(", ")),
            ));
        };
        let given = [
            ("substeps", file.substeps.is_some()),
            ("iterations", file.iterations.is_some()),
            ("tolerance", file.tolerance.is_some()),
        ];
        let takes = kind.settings();
        if let Some((field, _)) = given.iter().find(|(f, given)| *given && !takes.contains(f)) {
            return Err(FormatError::new(
                format!("method.{field}"),
                format!("method \"{}\" has no {field}", file.name),
                format!("leave it out; it has {}", takes.join(" and ")),
            ));
        }
        let counts = [
            ("substeps", file.substeps.map(|n| n as usize)),
            ("iterations", file.iterations),
        ];
        for (field, count) in counts {
            if count.is_some_and(|n| n == 0 || n > MAX_ITERATIONS) {
                return Err(FormatError::new(
                    format!("method.{field}"),
                    "it is out of range".to_owned(),
                    format!("give a whole number from 1 to {MAX_ITERATIONS}"),
                ));
            }
        }
        if file.tolerance.is_some_and(|t| !(t.is_finite() && t >= 0.0)) {
            return Err(FormatError::new(
                "method.tolerance",
                "it is out of range".to_owned(),
                "give a finite number, zero or above".to_owned(),
            ));
        }
        Ok(MethodSettings {
            kind,
            substeps: file.substeps,
            iterations: file.iterations,
            tolerance: file.tolerance,
        })
    }

    /// The contact settings, with defaults for missing values.
    pub fn contact(&self) -> ContactSettings {
        let usual = ContactSettings::default();
        ContactSettings {
            offset: self.collision.offset.unwrap_or(usual.offset),
            stiffness: self.collision.stiffness.unwrap_or(usual.stiffness),
            friction: self.collision.friction.unwrap_or(usual.friction),
            cloth_offset: self.collision.cloth_offset.unwrap_or(usual.cloth_offset),
        }
    }

    /// Paths of unknown fields.
    fn unknown_fields(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut add = |path: String, unknown: &Unknown| {
            let dot = if path.is_empty() { "" } else { "." };
            found.extend(unknown.keys().map(|key| format!("{path}{dot}{key}")));
        };
        add(String::new(), &self.unknown);
        add("meshes".to_owned(), &self.meshes.unknown);
        add("air".to_owned(), &self.air.unknown);
        add("damping".to_owned(), &self.damping.unknown);
        if let Some(method) = &self.method {
            add("method".to_owned(), &method.unknown);
        }
        add("collision".to_owned(), &self.collision.unknown);
        for (k, object) in self.objects.iter().enumerate() {
            add(format!("objects[{k}]"), &object.unknown);
            add(format!("objects[{k}].transform"), &object.transform.unknown);
            let grips = object.grips.iter().enumerate();
            let led = grips.map(|(g, grip)| (format!("grips[{g}]"), grip));
            for (place, grip) in led {
                for (inner, unknown) in grip.unknown_fields() {
                    add(format!("objects[{k}].{place}{inner}"), unknown);
                }
            }
            if let Some(motion) = &object.motion {
                for (inner, unknown) in motion.unknown_fields() {
                    add(format!("objects[{k}].motion{inner}"), unknown);
                }
            }
            if let Some(material) = &object.material {
                add(format!("objects[{k}].material"), &material.unknown);
            }
        }
        for (k, elastic) in self.elastics.iter().enumerate() {
            add(format!("elastics[{k}]"), &elastic.unknown);
        }
        found
    }
}

/// The error of a JSON reader, with line and column.
pub(crate) fn json_error(error: &serde_json::Error) -> FormatError {
    let place = format!("line {}, column {}", error.line(), error.column());
    let what = error.to_string();
    let what = what.split(" at line ").next().unwrap_or_default();
    FormatError::new(place, what, "see this kind of file in docs/FORMATS.md")
}

/// Reads a scene file; also returns the paths of unknown fields.
///
/// # Errors
/// With line and column: text that is not JSON, a field that is missing or of the wrong kind.
pub fn read_scene(text: &str) -> Result<(SceneFile, Vec<String>), FormatError> {
    let file: SceneFile = serde_json::from_str(text).map_err(|error| json_error(&error))?;
    let unknown = file.unknown_fields();
    Ok((file, unknown))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_drape::{Compression, MaterialLaws};
    use toile_fabric::LibraryFabric;

    const FLAG: &str = r#"{ "duration": 2, "colour": "red", "meshes": { "upp": "z" },
        "objects": [ { "name": "flag", "kind": "deformable", "mesh": "flag.obj", "pins": [0, 4],
                       "material": { "density": 0.1, "gloss": 3 },
                       "transform": { "translation": [0, 1, 0], "scale": 2 } } ],
        "elastics": [ { "from": ["flag", 2], "to": [0, 1, 0.5], "stiffness": 40 } ] }"#;

    #[test]
    fn a_scene_is_read_and_unknown_fields_are_named() {
        let (file, unknown) = read_scene(FLAG).expect("good");
        assert_eq!(
            unknown,
            ["colour", "meshes.upp", "objects[0].material.gloss"]
        );
        assert_eq!(
            file.method().expect("default").kind,
            MethodKind::ImplicitEuler
        );
        let flag = &file.objects[0];
        let material = flag.material.as_ref().expect("given");
        let density = material.material("flag").expect("known").density;
        assert!((density - 0.1).abs() < 1e-15);
        assert_eq!(
            flag.transform.apply(Vec3::new(1.0, 1.0, 1.0)),
            Vec3::new(2.0, 3.0, 2.0)
        );
        assert!(matches!(&file.elastics[0].from, EndFile::Vertex(name, 2) if name == "flag"));
        assert!(matches!(file.elastics[0].to, EndFile::Point([_, 1.0, _])));
    }

    #[test]
    fn materials_name_fabrics_and_air_and_damping_are_read() {
        let text = r#"{ "air": { "wind": [3, 0, 0] }, "damping": { "mass": 0.5, "stiffness": 1e-4 },
            "objects": [ { "name": "a", "kind": "deformable", "mesh": "a.obj", "material":
                { "fabric": "denim", "density": 0.5, "strain_limit": [0.05, null],
                  "compression": "tension-field", "kept": [0, 0.2] } } ] }"#;
        let (file, unknown) = read_scene(text).expect("good");
        assert!(unknown.is_empty(), "{unknown:?}");
        let air = file.air.air();
        assert!((air.density - Air::SEA_LEVEL).abs() < 1e-12 && air.wind.x == 3.0);
        assert!((file.damping.damping().stiffness - 1e-4).abs() < 1e-15);
        let written = file.objects[0].material.as_ref().expect("given");
        let material = written.material("a").expect("known");
        let denim = LibraryFabric::named("denim").expect("known").material();
        assert_eq!(material.bend, denim.bend);
        assert_eq!(material.hardening, denim.hardening);
        assert!((material.density - 0.5).abs() < 1e-15);
        assert_eq!(material.strain_limit, [0.05, f64::INFINITY]);
        assert_eq!(material.compression, Compression::TensionField);
        assert!(material.check("a").is_ok());
        for wrong in [r#"{"fabric":"gold"}"#, r#"{"compression":"half"}"#] {
            let file: MaterialFile = serde_json::from_str(wrong).expect("readable");
            let error = file.material("objects[0].material").expect_err("unknown");
            assert!(error.place.starts_with("objects[0].material."), "{error}");
        }
    }

    #[test]
    fn settings_that_a_method_has_no_use_for_are_refused_by_name() {
        for (name, kind) in MethodKind::ALL {
            for (field, value) in [("substeps", "3"), ("iterations", "3"), ("tolerance", "0.1")] {
                let text = format!(
                    r#"{{ "method": {{ "name": "{name}", "{field}": {value} }}, "objects": [] }}"#
                );
                let (file, _) = read_scene(&text).expect("readable");
                let takes = kind.settings().contains(&field);
                match file.method() {
                    Ok(settings) => assert!(takes && settings.kind == kind, "{name}, {field}"),
                    Err(error) => {
                        assert!(
                            !takes && error.place == format!("method.{field}"),
                            "{error}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_broken_scene_says_where() {
        let error = read_scene("{ \"objects\": [ { \"name\": 3 } ] }").expect_err("wrong type");
        assert!(error.place.starts_with("line 1"), "{error}");
        assert!(read_scene("").is_err());
        let named = FLAG.replace("\"duration\": 2", "\"method\": {\"name\": \"guess\"}");
        let (file, _) = read_scene(&named).expect("readable");
        assert!(
            file.method()
                .expect_err("unknown")
                .to_string()
                .contains("implicit-euler")
        );
    }
}
