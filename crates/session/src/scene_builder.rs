//! Builds a scene from a scene file, with its meshes, patterns, bodies and fabrics.
//!
//! # Decided with
//! - [`toile_interchange::ObjectFile`]: fields of the file;
//! - [`crate::mesh_file::open_mesh`], [`crate::scene_builder::Builder::stance_of_meshes`]: meshes, all turned
//!   alike;
//! - [`crate::scene_builder::Builder::change_materials`]: materials of the objects, by name or by figures;
//! - [`crate::scene_figures`]: figures: what they wear, how they move;
//! - [`crate::scene_frames`]: recorded frames as objects;
//! - [`toile_drape::Scene::check`], [`toile_drape::World::of_scene`]: how the scene is checked and made a
//!   world.
//!
//! A named shape of solid is one more field of `ObjectFile` that a mesh is made of here.

use crate::bodies::body_of;
use crate::choice::figure_named;
use crate::derived::Derived;
use crate::dressed_figure::HungGarment;
use crate::fabrics::open_fabric;
use crate::input::is_input;
use crate::mesh_file::{open_mesh, stance_error};
use crate::scene_frames::{Recorded, recorded};
use crate::scene_place::ScenePlace;
use crate::watcher::report_progress;
use crate::{BodyChoice, Command, Project, Quality, Session, SessionError, Watcher};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toile_body::{AskedStance, Mannequin, Stance};
use toile_drape::{
    Cloth, GarmentRun, Material, ObjectKind, Scene, SceneElastic, SceneEnd, SceneGrip, SceneObject,
    Stage,
};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{EndFile, MaterialFile, MotionFile, ObjectFile, SceneFile};
/// Turns a scene file into a scene.
pub(crate) struct Builder<'a> {
    /// Path of the scene file.
    pub(crate) place: ScenePlace<'a>,
    /// Content of the scene file.
    pub(crate) file: &'a SceneFile,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Stance of the mesh files: their axes and unit.
    stance: Stance,
    /// Meshes of the files read, by name, in the coordinates of their files.
    meshes: BTreeMap<String, TriangleMesh>,
    /// Bodies that wear garments, by the index of their object.
    pub(crate) figures: BTreeMap<usize, Arc<Mannequin>>,
    /// Garments that are worn, by the index of their object.
    pub(crate) garments: BTreeMap<usize, HungGarment>,
    /// For each triangle of all cloths, whether its strain counts in reports; it does not near gathers.
    pub counted: Vec<bool>,
    /// Longest lead-in of a figure, the motion into its clip before time 0 (s).
    pub(crate) lead_in: f64,
    /// Time at which the last figure has come to rest (s); `None` if no figure comes to rest.
    pub(crate) ends: Option<f64>,
}

impl<'a> Builder<'a> {
    /// A builder for a scene file.
    pub fn new(path: &'a Path, file: &'a SceneFile, notes: Vec<String>) -> Self {
        Self {
            place: ScenePlace(path),
            file,
            notes,
            stance: Stance::default(),
            meshes: BTreeMap::new(),
            figures: BTreeMap::new(),
            garments: BTreeMap::new(),
            counted: Vec::new(),
            lead_in: 0.0,
            ends: None,
        }
    }

    /// Builds the scene, with its meshes, patterns and bodies.
    ///
    /// # Errors
    /// A file that the scene names cannot be read, or its fields do not fit together.
    pub fn scene(&mut self, watcher: &mut dyn Watcher) -> Result<Scene, SessionError> {
        let file = self.file;
        let place_of_file = self.place;
        let wrong = |error| place_of_file.error(error);
        self.stance = self.stance_of_meshes()?;
        self.dress(watcher)?;
        let mut objects = Vec::new();
        for (index, object) in file.objects.iter().enumerate() {
            objects.push(self.object(index, object, watcher)?);
        }
        let mut grips = Vec::new();
        for (index, object) in file.objects.iter().enumerate() {
            grips.extend(object.grips.iter().map(|grip| SceneGrip {
                object: index,
                vertices: grip.vertices.clone(),
                motion: grip.motion.motion(),
            }));
        }
        let mut elastics = Vec::new();
        for (index, elastic) in file.elastics.iter().enumerate() {
            elastics.push(SceneElastic {
                from: self.end(index, &elastic.from, &objects)?,
                to: self.end(index, &elastic.to, &objects)?,
                stiffness: elastic.stiffness,
                merge_within: elastic.merge_within,
            });
        }
        let mut ignored = Vec::new();
        for (index, names) in file.collision.ignore.iter().enumerate() {
            let place = format!("collision.ignore[{index}]");
            let number = |name: &String| self.number(name, &place, &objects);
            ignored.push([number(&names[0])?, number(&names[1])?]);
        }
        Ok(Scene {
            gravity: Vec3::from(file.gravity),
            air: self.air(),
            damping: file.damping.damping(),
            lead_in: self.lead_in,
            duration: self.duration(),
            step: file.step,
            frame_step: file.frame_step,
            method: self.method().map_err(wrong)?,
            contact: self.contact(),
            objects,
            elastics,
            grips,
            ignored,
        })
    }

    /// Index of the object with a name.
    fn number(
        &self,
        name: &str,
        place: &str,
        objects: &[SceneObject],
    ) -> Result<usize, SessionError> {
        let found = objects.iter().position(|object| object.name == name);
        found.ok_or_else(|| {
            let what = format!("there is no object \"{name}\"");
            self.place
                .wrong(place.to_owned(), what, "name an object of the scene")
        })
    }

    fn end(
        &self,
        index: usize,
        end: &EndFile,
        objects: &[SceneObject],
    ) -> Result<SceneEnd, SessionError> {
        match end {
            EndFile::Point(point) => Ok(SceneEnd::Point(Vec3::from(*point))),
            EndFile::Vertex(name, vertex) => {
                let object = self.number(name, &format!("elastics[{index}]"), objects)?;
                Ok(SceneEnd::Vertex {
                    object,
                    vertex: *vertex,
                })
            }
        }
    }

    /// Whether an object is cloth; refused if its kind is unknown or does not fit its motion.
    fn is_deformable(&self, place: &str, object: &ObjectFile) -> Result<bool, SessionError> {
        let wrong = |what: String, remedy: &str| {
            let place = place.to_owned();
            Err(self.place.wrong(place, what, remedy))
        };
        for (g, grip) in object.grips.iter().enumerate() {
            if let Some(field) = grip.motion.clip_fields().first() {
                let what = format!("grips[{g}] has a {field}, which only the motion of a body has");
                return wrong(what, "lead its vertices by keys");
            }
        }
        match (object.kind.as_str(), &object.motion) {
            ("static", None) => Ok(false),
            ("animated", Some(motion)) => match motion.clip_fields().first() {
                Some(field) if object.body.is_none() => {
                    let what = format!("its motion has a {field}, and it is no body");
                    wrong(what, "move it by keys")
                }
                _ => Ok(false),
            },
            ("deformable", None) => Ok(true),
            ("animated", None) if object.frames.is_some() => Ok(false),
            ("animated", None) => {
                let what = "it is animated but has no motion".to_owned();
                wrong(what, "give it a motion or frames, or write static")
            }
            ("static" | "deformable", Some(_)) => {
                let what = format!("it is {} but has a motion", object.kind);
                wrong(what, "write animated; vertices of cloth are led by grips")
            }
            (other, _) => {
                let what = format!("kind \"{other}\" cannot be simulated here");
                wrong(what, "write static, animated or deformable")
            }
        }
    }

    fn object(
        &mut self,
        index: usize,
        object: &ObjectFile,
        watcher: &mut dyn Watcher,
    ) -> Result<SceneObject, SessionError> {
        let place = format!("objects[{index}]");
        let deformable = self.is_deformable(&place, object)?;
        let mut course = None;
        let cached = match (&object.frames, &object.mesh) {
            (Some(_), Some(mesh)) => Some((self.mesh(mesh)?, self.stance)),
            _ => None,
        };
        let recorded = recorded((self.place, &place), object, cached)?;
        let sources = (&object.mesh, &object.pattern, &object.body);
        let (mut mesh, mut cloth) = match (recorded, sources) {
            (Some(Recorded::Cloth(cloth)), _) => (cloth.mesh(), Some(cloth)),
            (Some(Recorded::Moving(mesh, moving)), _) => {
                course = Some(moving);
                (mesh, None)
            }
            (None, (Some(mesh), None, None)) => (self.mesh(mesh)?, None),
            (None, (None, None, Some(body))) if !deformable => {
                let body = self.mannequin(index, body)?;
                (body.skin().clone(), None)
            }
            (None, (None, Some(pattern), None)) if deformable => {
                let cloth = match self.garments.remove(&index) {
                    Some(worn) => {
                        self.counted.extend(worn.counted);
                        worn.cloth
                    }
                    None => self.garment(pattern, watcher)?,
                };
                (cloth.mesh(), Some(cloth))
            }
            _ => {
                let what = "it needs one of mesh, pattern (deformable) or body (static, animated)"
                    .to_owned();
                return Err(self.place.wrong(place, what, "name one file"));
            }
        };
        if deformable && object.on.is_none() {
            let all = self.counted.len() + mesh.triangles.len();
            self.counted.resize(all, true);
        }
        let wearer = object.on.as_ref().and_then(|on| {
            let wearer = self.file.objects.iter().find(|other| other.name == *on);
            wearer.map(|wearer| &wearer.transform)
        });
        let transform = wearer.unwrap_or(&object.transform);
        for p in mesh
            .positions
            .iter_mut()
            .chain(cloth.iter_mut().flat_map(|c| &mut c.positions))
        {
            *p = transform.apply(*p);
        }
        for corner in cloth.iter_mut().flat_map(|c| c.rest.iter_mut().flatten()) {
            *corner *= transform.scale;
        }
        let kind = if deformable {
            let mut materials = match &cloth {
                Some(cloth) => cloth.materials.clone(),
                None => vec![Material::default()],
            };
            if let Some(file) = &object.material {
                self.change_materials(file, &format!("{place}.material"), &mut materials)?;
            }
            let material = materials.first().cloned().unwrap_or_default();
            if let Some(cloth) = &mut cloth {
                cloth.materials = materials;
            }
            ObjectKind::Deformable {
                material,
                pins: object.pins.clone(),
            }
        } else {
            match (&object.motion, &object.body) {
                (motion, _) if course.is_some() => ObjectKind::Animated {
                    motion: motion.as_ref().map(MotionFile::motion),
                    track: course
                        .map(|course| course.track(|p| transform.apply(p)))
                        .transpose()
                        .map_err(|error| {
                            let remedy = "record the frames again";
                            self.place.wrong(place, error.to_string(), remedy)
                        })?,
                },
                (Some(motion), Some(body)) => {
                    let body = self.mannequin(index, body)?;
                    self.figure_kind(index, body, motion)?
                }
                (Some(motion), None) => ObjectKind::moving(motion.motion()),
                (None, _) => ObjectKind::Static,
            }
        };
        Ok(SceneObject {
            name: object.name.clone(),
            kind,
            mesh,
            cloth,
            layer: object.layer.unwrap_or_default(),
        })
    }

    /// Changes materials as a file says: to the fabric it names, of the library or of a file, and
    /// field by field.
    fn change_materials(
        &mut self,
        file: &MaterialFile,
        place: &str,
        materials: &mut [Material],
    ) -> Result<(), SessionError> {
        let place_of_file = self.place;
        let wrong = |error| place_of_file.error(error);
        let fabric_file = file.fabric.as_ref().map(|name| self.place.beside(name));
        let base = match (fabric_file.filter(|path| is_input(path)), &file.fabric) {
            (Some(path), _) => {
                let fabric = open_fabric(&path)?;
                self.notes.extend(fabric.notes);
                Some(fabric.material)
            }
            (None, Some(_)) => Some(file.material(place).map_err(wrong)?),
            (None, None) => None,
        };
        for material in materials {
            let usual = base.as_ref().unwrap_or(material).clone();
            *material = file.over(usual, place).map_err(wrong)?;
        }
        Ok(())
    }

    /// The mesh of a file, turned and scaled by the stance of the scene's meshes.
    fn mesh(&mut self, name: &str) -> Result<TriangleMesh, SessionError> {
        let stance = self.stance;
        let mut mesh = self.opened(name)?.clone();
        for p in &mut mesh.positions {
            *p = stance.place(*p);
        }
        Ok(mesh)
    }

    /// The mesh of a file in its own coordinates; each file is read once.
    fn opened(&mut self, name: &str) -> Result<&TriangleMesh, SessionError> {
        let mesh = match self.meshes.remove(name) {
            Some(mesh) => mesh,
            None => {
                let mut opened = open_mesh(&self.place.beside(name))?;
                self.notes.append(&mut opened.notes);
                opened.mesh
            }
        };
        Ok(self.meshes.entry(name.to_owned()).or_insert(mesh))
    }

    /// Stance of the scene's mesh files: as the scene says, else as detected on a person among its bodies.
    /// All files are taken to come from one program: all are turned like the mesh of the first person.
    fn stance_of_meshes(&mut self) -> Result<Stance, SessionError> {
        let path = self.place.0;
        let asked = self
            .file
            .meshes
            .asked()
            .map_err(|error| SessionError::Format {
                path: path.to_owned(),
                error,
            })?;
        let [x, y, z] = self.file.gravity;
        // A scene with another gravity than along -Y says itself which way is down: its axes are not
        // detected.
        let is_settled = (x, z) != (0.0, 0.0) || y > 0.0;
        let hint = "say how the meshes of the scene stand, as in \"meshes\": {\"up\": \"z\", \"unit\": \"cm\"}";
        let file = self.file;
        let bodies = file.objects.iter().filter(|o| o.kind != "deformable");
        let is_given = asked != AskedStance::default();
        for object in bodies.filter(|_| !is_settled && !is_given) {
            let is_turned = object.transform.rotation != [0.0; 3] || object.transform.scale != 1.0;
            let Some(name) = object.mesh.as_ref().filter(|_| !is_turned) else {
                continue;
            };
            let at = self.place.beside(name);
            let seen = Stance::seen(self.opened(name)?, &asked);
            let Some(stance) = seen.map_err(|error| stance_error(&at, &error, hint))? else {
                continue;
            };
            let stance = stance.facing_anywhere();
            if !stance.is_ours() {
                self.notes.push(format!(
                    "{}: a person of whom {stance}: all meshes of the scene are set upright in metres, y up; \
                     \"meshes\": {{\"up\": \"y\", \"unit\": \"m\"}} keeps them as they are",
                    at.display()
                ));
            }
            return Ok(stance);
        }
        Stance::of(&TriangleMesh::default(), &asked)
            .map(Stance::facing_anywhere)
            .map_err(|error| stance_error(self.place.0, &error, hint))
    }

    /// The body of an object, as it stands when it is dressed.
    fn mannequin(&mut self, index: usize, body: &str) -> Result<Arc<Mannequin>, SessionError> {
        if let Some(dressed) = self.figures.get(&index) {
            return Ok(dressed.clone());
        }
        let body = match figure_named(body) {
            Some(figure) => BodyChoice::Sample(figure),
            None => {
                let (body, notes) = body_of(None, &self.place.beside(body))?;
                self.notes.extend(notes);
                body
            }
        };
        let project = Project {
            body,
            ..Project::default()
        };
        let mannequin = Derived::default().mannequin(&project)?;
        self.figures.insert(index, mannequin.clone());
        Ok(mannequin)
    }

    /// A pattern's garment, sewn round the scene's first body, or else round the pattern's own body.
    fn garment(&self, pattern: &str, watcher: &mut dyn Watcher) -> Result<Cloth, SessionError> {
        let mut session = Session::new();
        let mut commands = vec![Command::open(self.place.beside(pattern))];
        if let Some(body) = self.file.objects.iter().find_map(|o| o.body.as_ref()) {
            let figure = figure_named(body);
            let measurements = figure.is_none().then(|| self.place.beside(body));
            commands.push(Command::SetBody {
                figure,
                measurements,
            });
        }
        commands.extend([
            // The scene wants this garment alone, without those that its file says it is worn with.
            Command::SetLayers {
                layer: 0,
                others: Vec::new(),
            },
            Command::SetQuality {
                quality: Quality::Preview,
            },
        ]);
        for command in commands {
            session.execute(command, watcher)?;
        }
        let mut setup = session.garment_setup()?.setup;
        // Only the sewing is needed, on the finest level.
        setup.levels.drain(..setup.levels.len() - 1);
        let mut cloth = setup.levels[0].cloth.clone();
        let mut run = GarmentRun::new(setup)?;
        while run.progress().stage == Stage::Sewing {
            let progress = run.advance()?;
            report_progress(
                watcher,
                "sewing",
                0.0,
                &format!("gap {:.0} mm", progress.gap * 1e3),
            )?;
        }
        let count = run.state.positions.len();
        for (position, &to) in cloth.positions.iter_mut().zip(run.target()) {
            *position = run.state.positions[to as usize];
        }
        Ok(cloth.merged(run.target(), count))
    }
}

#[cfg(test)]
mod tests;
