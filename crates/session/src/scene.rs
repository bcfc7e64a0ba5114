//! Running a scene file: its meshes, patterns and bodies found, simulated, and written.

use crate::choice::figure_named;
use crate::export::{cannot, file_name};
use crate::open::{open_measurements, read_text_file};
use crate::timing::Timing;
use crate::watcher::tell;
use crate::{BodyChoice, Command, Project, Quality, Session, SessionError, Watcher};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use toile_body::Figure;
use toile_drape::collision::Tally;
use toile_drape::{
    Cloth, GarmentRun, Material, ObjectKind, Scene, SceneElastic, SceneEnd, SceneGrip, SceneObject,
    SceneRun, Stage,
};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{
    EndFile, FormatError, ObjMesh, ObjectFile, SceneFile, SizeChoice, read_obj, read_scene,
    write_all_atomically, write_obj,
};

/// What running a scene made.
#[derive(Clone, Debug)]
pub struct SceneOutcome {
    /// Files written.
    pub files: Vec<PathBuf>,
    /// The report, as JSON.
    pub report: serde_json::Value,
}

/// Frames a scene may save: beyond this the frame step is surely a mistake.
const MOST_FRAMES: f64 = 100_000.0;

/// Runs a scene file and writes its frames, its last state and a report into a folder.
///
/// # Errors
/// The scene or a file it names cannot be read, the simulation fails, or a file cannot be written.
pub fn run_scene(
    path: &Path,
    folder: &Path,
    watcher: &mut dyn Watcher,
) -> Result<SceneOutcome, SessionError> {
    let mut timing = Timing::default();
    timing.restart();
    let start = Instant::now();
    let text = read_text_file(path)?;
    let wrong = |error| SessionError::Format {
        path: path.to_owned(),
        error,
    };
    let (file, unknown) = read_scene(&text).map_err(wrong)?;
    let base = path.parent().unwrap_or(Path::new("."));
    let builder = Builder {
        path,
        base,
        file: &file,
        notes: RefCell::default(),
    };
    let scene = builder.scene(watcher)?;
    timing.add("read", start);
    let start = Instant::now();
    let names = state_names(&scene).map_err(wrong)?;
    let frame_step = scene.frame_step;
    check_frames(&scene).map_err(wrong)?;
    let mut run = SceneRun::new(scene)?;
    let mut written: Vec<PathBuf> = Vec::new();
    let mut write = |files: &[(String, Vec<u8>)]| {
        written.extend(files.iter().map(|(name, _)| folder.join(name)));
        write_all_atomically(folder, files)
    };
    let mut frame = 0usize;
    while !run.finished() {
        if let Some(step) = frame_step
            && run.state.time + 1e-9 >= frame as f64 * step
        {
            write(&state_files(&run, (&names, &format!("frame-{frame:05}-")))?)?;
            frame += 1;
        }
        run.advance()?;
        tell(
            watcher,
            "simulating",
            run.share(),
            &format!("{:.2} s", run.state.time),
        )?;
    }
    let mut files = state_files(&run, (&names, ""))?;
    timing.add("simulate", start);
    let start = Instant::now();
    let mut report = report(&mut run, &unknown);
    if let Some(warnings) = report["warnings"].as_array_mut() {
        warnings.extend(builder.notes.into_inner().into_iter().map(Into::into));
    }
    timing.add("measure", start);
    let pretty = serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
    files.push(("report.json".to_owned(), pretty.into_bytes()));
    files.push(("timing.json".to_owned(), timing.to_json().into_bytes()));
    write(&files)?;
    Ok(SceneOutcome {
        files: written,
        report,
    })
}

/// Refuses a scene that would save more frames than anybody looks at.
fn check_frames(scene: &Scene) -> Result<(), FormatError> {
    let count = scene.frame_step.map_or(0.0, |step| scene.duration / step);
    match count > MOST_FRAMES {
        true => Err(FormatError::new(
            "frame_step",
            format!("{count:.0} frames would be saved; at most {MOST_FRAMES} are"),
            "give a longer frame step, or a shorter duration",
        )),
        false => Ok(()),
    }
}

/// Names of the files of the objects that move, of each its index; two of one name are refused.
fn state_names(scene: &Scene) -> Result<Vec<(usize, String)>, FormatError> {
    let mut names: Vec<(usize, String)> = Vec::new();
    for (index, object) in scene.objects.iter().enumerate() {
        if object.kind == ObjectKind::Static {
            continue;
        }
        let name = file_name(&object.name);
        let same = |(_, known): &&(usize, String)| known.to_lowercase() == name.to_lowercase();
        if let Some((other, _)) = names.iter().find(same) {
            let other = &scene.objects[*other].name;
            return Err(FormatError::new(
                format!("objects[{index}]"),
                format!(
                    "{:?} and {other:?} would be written to one file",
                    object.name
                ),
                "give one of them another name",
            ));
        }
        names.push((index, name));
    }
    Ok(names)
}

/// The objects that move as OBJ files.
fn state_files(
    run: &SceneRun,
    (names, prefix): (&[(usize, String)], &str),
) -> Result<Vec<(String, Vec<u8>)>, SessionError> {
    let mut files = Vec::new();
    let mut meshes: Vec<_> = run.meshes().into_iter().map(Some).collect();
    for (index, name) in names {
        let Some(mesh) = meshes.get_mut(*index).and_then(Option::take) else {
            continue;
        };
        let obj = ObjMesh {
            positions: mesh.positions,
            triangles: mesh.triangles,
            ..ObjMesh::default()
        };
        let text = write_obj(&obj).map_err(cannot("the state"))?;
        files.push((format!("{prefix}{name}.obj"), text.into_bytes()));
    }
    Ok(files)
}

fn report(run: &mut SceneRun, unknown: &[String]) -> serde_json::Value {
    let measures = run.measure();
    let mut warnings: Vec<String> = unknown
        .iter()
        .map(|field| format!("the field {field} is not known and was left out"))
        .collect();
    if run.split_steps() > 0 {
        warnings.push(format!(
            "{} steps failed and were taken in smaller ones",
            run.split_steps()
        ));
    }
    let layers = measures.layers.iter().map(|layer| {
        let of_layer = |o: &&SceneObject| {
            o.layer == layer.layer && matches!(o.kind, ObjectKind::Deformable { .. })
        };
        let names = run.scene().objects.iter().filter(of_layer).map(|o| &o.name);
        serde_json::json!({
            "layer": layer.layer,
            "objects": names.collect::<Vec<_>>(),
            "body_intersections": layer.body_intersections,
            "self_intersections": layer.self_intersections,
            "outer_intersections": layer.outer_intersections,
            "astray": layer.astray,
        })
    });
    let layers: Vec<_> = layers.collect();
    serde_json::json!({
        "method": run.scene().method.kind.name(),
        "vertices": run.state.positions.len(),
        "triangles": run.model.triangles.len(),
        "steps": run.steps(),
        "time_s": run.state.time,
        "residual": measures.residual,
        "kinetic_energy_J": measures.kinetic_energy,
        "strain_max": { "warp": measures.strain_max[0], "weft": measures.strain_max[1] },
        "strain_p99": { "warp": measures.strain_p99[0], "weft": measures.strain_p99[1] },
        "seam_gap_max_m": run.elastic_gap(),
        "body_penetration_max_m": measures.penetration_max,
        "body_intersections": measures.body_intersections,
        "self_intersections": measures.self_intersections,
        "layers": layers,
        "tangles": run.cloth_tally().map(|tally| Tangles::of(&tally)),
        "warnings": warnings,
    })
}

/// Edges of cloth that crossed a face of cloth, as a report counts them.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub(crate) struct Tangles {
    /// At the first look.
    found: usize,
    /// Most at one look.
    most: usize,
    /// At the last look.
    left: usize,
    /// Vertices of outer layers on the inside of inner ones: at the first look, most, at the last.
    astray: [usize; 3],
}

impl Tangles {
    pub(crate) fn of(tally: &Tally) -> Self {
        let [found, most, left] = tally.crossings;
        Self {
            found,
            most,
            left,
            astray: tally.astray,
        }
    }
}

/// Turns a scene file into a scene.
struct Builder<'a> {
    path: &'a Path,
    base: &'a Path,
    file: &'a SceneFile,
    /// What was taken of the files it names, and what was left out.
    notes: RefCell<Vec<String>>,
}

impl Builder<'_> {
    fn wrong(&self, place: String, what: String, hint: &str) -> SessionError {
        SessionError::Format {
            path: self.path.to_owned(),
            error: FormatError::new(place, what, hint),
        }
    }

    fn scene(&self, watcher: &mut dyn Watcher) -> Result<Scene, SessionError> {
        let file = self.file;
        let wrong = |error| SessionError::Format {
            path: self.path.to_owned(),
            error,
        };
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
        Ok(Scene {
            gravity: Vec3::from(file.gravity),
            air: file.air.air(),
            damping: file.damping.damping(),
            duration: file.duration,
            step: file.step,
            frame_step: file.frame_step,
            method: file.method().map_err(wrong)?,
            contact: file.contact(),
            objects,
            elastics,
            grips,
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
                let object = objects
                    .iter()
                    .position(|o| o.name == *name)
                    .ok_or_else(|| {
                        let what = format!("there is no object \"{name}\"");
                        self.wrong(
                            format!("elastics[{index}]"),
                            what,
                            "name an object of the scene",
                        )
                    })?;
                Ok(SceneEnd::Vertex {
                    object,
                    vertex: *vertex,
                })
            }
        }
    }

    fn object(
        &self,
        index: usize,
        object: &ObjectFile,
        watcher: &mut dyn Watcher,
    ) -> Result<SceneObject, SessionError> {
        let place = format!("objects[{index}]");
        let deformable = match (object.kind.as_str(), &object.motion) {
            ("static", None) | ("animated", Some(_)) => false,
            ("deformable", None) => true,
            ("animated", None) => {
                let what = "it is animated but has no motion".to_owned();
                return Err(self.wrong(place, what, "give it a motion, or write static"));
            }
            ("static" | "deformable", Some(_)) => {
                let what = format!("it is {} but has a motion", object.kind);
                let hint = "write animated; vertices of cloth are led by grips";
                return Err(self.wrong(place, what, hint));
            }
            (other, _) => {
                let what = format!("kind \"{other}\" cannot be simulated here");
                return Err(self.wrong(place, what, "write static, animated or deformable"));
            }
        };
        let (mut mesh, mut cloth) = match (&object.mesh, &object.pattern, &object.body) {
            (Some(mesh), None, None) => (self.obj(mesh)?, None),
            (None, None, Some(body)) if !deformable => (self.skin(body)?, None),
            (None, Some(pattern), None) if deformable => {
                let cloth = self.garment(pattern, watcher)?;
                (cloth.mesh(), Some(cloth))
            }
            _ => {
                let what = "it needs one of mesh, pattern (deformable) or body (static)".to_owned();
                return Err(self.wrong(place, what, "name one file"));
            }
        };
        for p in mesh
            .positions
            .iter_mut()
            .chain(cloth.iter_mut().flat_map(|c| &mut c.positions))
        {
            *p = object.transform.apply(*p);
        }
        let kind = if deformable {
            let material = match (&object.material, &cloth) {
                (Some(material), _) => {
                    let place = format!("{place}.material");
                    material
                        .material(&place)
                        .map_err(|error| SessionError::Format {
                            path: self.path.to_owned(),
                            error,
                        })?
                }
                (None, Some(cloth)) => cloth.materials.first().cloned().unwrap_or_default(),
                (None, None) => Material::default(),
            };
            ObjectKind::Deformable {
                material,
                pins: object.pins.clone(),
            }
        } else {
            match &object.motion {
                Some(motion) => ObjectKind::Animated {
                    motion: motion.motion(),
                },
                None => ObjectKind::Static,
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

    fn obj(&self, name: &str) -> Result<TriangleMesh, SessionError> {
        let path = self.base.join(name);
        let text = read_text_file(&path)?;
        let mesh =
            read_obj(text.as_bytes()).map_err(|error| SessionError::Format { path, error })?;
        Ok(mesh.into_triangle_mesh())
    }

    fn skin(&self, body: &str) -> Result<TriangleMesh, SessionError> {
        let body = match figure_named(body) {
            Some(figure) => BodyChoice::Sample(figure),
            None => {
                let path = self.base.join(body);
                let (table, found) = open_measurements(&path, SizeChoice::default())?;
                let note = |note: String| format!("{}: {note}", path.display());
                self.notes.borrow_mut().extend(found.into_iter().map(note));
                BodyChoice::Measured {
                    figure: Figure::Mean,
                    path,
                    measurements: Arc::new(table),
                }
            }
        };
        let project = Project {
            body,
            ..Project::default()
        };
        let mannequin = toile_body::Mannequin::new(&project.wearer(), project.figure())?;
        Ok(mannequin.skin().clone())
    }

    /// A pattern's garment, sewn round the scene's first body, or the one its pattern is for.
    fn garment(&self, pattern: &str, watcher: &mut dyn Watcher) -> Result<Cloth, SessionError> {
        let mut session = Session::new();
        let mut commands = vec![Command::OpenPattern {
            path: self.base.join(pattern),
        }];
        if let Some(body) = self.file.objects.iter().find_map(|o| o.body.as_ref()) {
            let figure = figure_named(body);
            let measurements = figure.is_none().then(|| self.base.join(body));
            commands.push(Command::SetBody {
                figure,
                measurements,
            });
        }
        commands.push(Command::SetQuality {
            quality: Quality::Preview,
        });
        for command in commands {
            session.execute(command, watcher)?;
        }
        let mut setup = session.garment_setup()?.setup;
        // Only the sewing is wanted: the finest level alone.
        setup.levels.drain(..setup.levels.len() - 1);
        let mut cloth = setup.levels[0].cloth.clone();
        let mut run = GarmentRun::new(setup)?;
        while run.progress().stage == Stage::Sewing {
            let progress = run.advance()?;
            tell(
                watcher,
                "sewing",
                0.0,
                &format!("gap {:.0} mm", progress.gap * 1e3),
            )?;
        }
        let count = run.state.positions.len();
        for (position, &to) in cloth.positions.iter_mut().zip(&run.target) {
            *position = run.state.positions[to as usize];
        }
        Ok(cloth.merged(&run.target, count))
    }
}
