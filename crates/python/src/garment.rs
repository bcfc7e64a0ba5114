//! Garments: sewn and draped on a body.

use crate::arguments::{chosen_named, unknown};
use crate::arrays::rows;
use crate::body::{Body, worn_by};
use crate::pattern::Pattern;
use crate::progress::{detached, watched};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PySlice};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use toile_session::{
    Command, Event, Export, ExportFormat, ObjMesh, Quality, Session, SessionError, Silent, Watcher,
    write_atomically,
};

/// Kinds of files that a garment is written as, by the ending of the name or by word.
const KINDS: [(&str, ExportFormat); 3] = [
    ("obj", ExportFormat::Obj),
    ("glb", ExportFormat::Glb),
    ("png", ExportFormat::Drape),
];

/// A garment sewn and draped to rest on a body: one mesh, welded at the seams.
#[pyclass(frozen, module = "toile")]
pub struct Garment {
    session: Mutex<Session>,
    mesh: ObjMesh,
    report: String,
    warnings: Vec<String>,
    sound: bool,
}

impl Garment {
    fn of(
        mut session: Session,
        commands: &[Command],
        watcher: &mut dyn Watcher,
    ) -> Result<Self, SessionError> {
        let mut events = session.execute_all(commands, watcher)?;
        // Exported with the garment, the report covers no marker.
        let formats = [ExportFormat::Obj, ExportFormat::Report];
        let (more, files) = session.export_files(&asked(&formats), &mut Silent)?;
        events.extend(
            more.into_iter()
                .filter(|event| !matches!(event, Event::Draped(_))),
        );
        let report = files
            .into_iter()
            .find(|file| file.0 == ExportFormat::Report.file());
        let mut warnings: Vec<String> = Vec::new();
        for event in events {
            if let Event::Warned { message } = event
                && !warnings.contains(&message)
            {
                warnings.push(message);
            }
        }
        Ok(Self {
            mesh: session.draped_mesh().unwrap_or_default(),
            sound: session
                .draped()
                .is_some_and(|drape| drape.verdict.is_sound()),
            session: Mutex::new(session),
            report: String::from_utf8(report.unwrap_or_default().1).unwrap_or_default(),
            warnings,
        })
    }

    fn file(&self, format: ExportFormat) -> Result<Vec<u8>, SessionError> {
        let mut session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        let (_, files) = session.export_files(&asked(&[format]), &mut Silent)?;
        let own = files.into_iter().find(|file| file.0 == format.file());
        Ok(own.unwrap_or_default().1)
    }
}

/// An export of formats that is not written.
fn asked(formats: &[ExportFormat]) -> Export {
    Export {
        dir: PathBuf::new(),
        formats: formats.to_vec(),
        marker: None,
    }
}

fn kind_named(word: &str) -> PyResult<ExportFormat> {
    let lower = word.to_lowercase();
    let known = KINDS.iter().find(|(ending, _)| *ending == lower);
    known.map(|(_, format)| *format).ok_or_else(|| {
        let words: Vec<&str> = KINDS.iter().map(|(ending, _)| *ending).collect();
        unknown("kind of file of a garment", word, &words)
    })
}

#[pymethods]
impl Garment {
    /// Vertices of the garment as array (n, 3) of float64 (metres); the body stands on y = 0 and faces +z.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(
            py,
            self.mesh
                .positions
                .iter()
                .map(|&place| <[f64; 3]>::from(place)),
        )
    }

    /// Triangles as array (m, 3) of uint32: indices of vertices, counter-clockwise seen from the right side of the
    /// cloth.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, self.mesh.triangles.iter().copied())
    }

    /// Unit normals of the vertices as array (n, 3) of float64.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(
            py,
            self.mesh
                .normals
                .iter()
                .map(|&normal| <[f64; 3]>::from(normal)),
        )
    }

    /// Places in the planes of the pieces as array (k, 2) of float64 (metres): the texture coordinates. A vertex on a
    /// seam has one on each side of it, so that k is larger than n.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(
            py,
            self.mesh
                .texture
                .iter()
                .map(|&place| <[f64; 2]>::from(place)),
        )
    }

    /// Corners of the triangles in the pieces as array (m, 3) of uint32: indices of rows of uv.
    #[getter]
    fn uv_triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, self.mesh.texture_triangles.iter().copied())
    }

    /// Rows of triangles that each piece has, by name (dict of slices).
    #[getter]
    fn pieces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let pieces = PyDict::new(py);
        for group in &self.mesh.groups {
            let range = &group.triangles;
            let rows = PySlice::new(py, range.start as isize, range.end as isize, 1);
            pieces.set_item(&group.name, rows)?;
        }
        Ok(pieces)
    }

    /// The report in numbers, as the command writes it in report.json (dict): strain, crossings, steps, verdict, ...
    /// Names say their units, as "area_m2".
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.report,))
    }

    /// Whether the garment is what was asked for: sewn, at rest, on the body (bool). If not, warnings say why.
    #[getter]
    fn sound(&self) -> bool {
        self.sound
    }

    /// Warnings in words (list of texts).
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The garment as the bytes of a file, equal to those that the command writes.
    ///
    /// kind: "obj" (a group for each piece, metres), "glb" (binary glTF), or "png" (a picture of it worn).
    fn to_bytes<'py>(&self, py: Python<'py>, kind: &str) -> PyResult<Bound<'py, PyBytes>> {
        let format = kind_named(kind)?;
        let bytes = detached(py, || self.file(format))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes the garment to a file, of the kind that its name ends in: .obj, .glb or .png.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = kind_named(&ending)?;
        detached(py, || Ok(write_atomically(&path, &self.file(format)?)?))
    }

    fn __repr__(&self) -> String {
        format!(
            "<toile.Garment of {} vertices and {} triangles>",
            self.mesh.positions.len(),
            self.mesh.triangles.len()
        )
    }
}

/// Sews a garment and drapes it to rest on a body. Returns a Garment.
///
/// size: name of a size of the pattern; default: Pattern.size, or the measurements that were given.
/// body: a Body; default: as the pattern says: of its size, or of the measurements that were given.
/// fabric: name of a fabric of the pattern or the library, as "denim", or path of a fabric file; default: each
/// panel's own.
/// quality: "preview" (mesh edges of 25 mm), "fit" (15 mm) or "final" (10 mm).
/// progress: function that is called with the stage (text), the share of the work done (0 to 1) and a few words, at
/// most 20 times a second. What it raises stops the drape and is raised; if it returns False, Cancelled is raised.
///
/// The same input gives the same garment to the bit. Other threads run meanwhile.
#[pyfunction]
#[pyo3(signature = (pattern, *, size = None, body = None, fabric = None, quality = "fit", progress = None))]
pub fn drape(
    py: Python<'_>,
    pattern: &Bound<'_, Pattern>,
    size: Option<String>,
    body: Option<&Bound<'_, Body>>,
    fabric: Option<String>,
    quality: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<Garment> {
    let quality = chosen_named("quality", quality, &Quality::ALL, Quality::name)?;
    let project = pattern.get().project.clone();
    let project = worn_by(project, body.map(Bound::get));
    let mut commands = Vec::new();
    if size.is_some() {
        commands.push(Command::SetSize { size });
    }
    if fabric.is_some() {
        commands.push(Command::SetFabric { fabric });
    }
    commands.extend([
        Command::SetQuality { quality },
        Command::Assemble,
        Command::drape(),
    ]);
    watched(py, progress, |watcher| {
        Garment::of(Session::of(project), &commands, watcher)
    })
}
