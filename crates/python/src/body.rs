//! Bodies that garments are draped on.

use crate::arguments::unknown;
use crate::arrays::rows;
use crate::progress::detached;
use numpy::PyArray2;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_session::{
    BodyChoice, BodySource, Command, Figure, Project, Session, SessionError, Silent, figure_named,
    make_body,
};

/// A body that garments are draped on: a mannequin in metres, y up, facing +z.
#[pyclass(frozen, module = "toile")]
pub struct Body {
    pub project: Project,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    taken: BTreeMap<String, f64>,
}

impl Body {
    fn of(commands: &[Command]) -> Result<Self, SessionError> {
        let mut session = Session::new();
        session.execute_all(commands, &mut Silent)?;
        let mannequin = session.mannequin()?;
        let skin = mannequin.skin();
        let taken = mannequin.measure().into_iter();
        Ok(Self {
            project: session.project().clone(),
            vertices: skin.positions.iter().map(|&place| place.into()).collect(),
            triangles: skin.triangles.clone(),
            taken: taken.map(|row| (row.name.to_owned(), row.got)).collect(),
        })
    }
}

#[pymethods]
impl Body {
    /// Name of the figure that it was grown from (text).
    #[getter]
    fn figure(&self) -> &'static str {
        self.project.figure().name()
    }

    /// Measurements that a tape takes on the body, by name (dict of floats: metres, angles in radians).
    #[getter]
    fn measurements(&self) -> BTreeMap<String, f64> {
        self.taken.clone()
    }

    /// Vertices of the skin as array (n, 3) of float64 (metres).
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.vertices.iter().copied())
    }

    /// Triangles of the skin as array (m, 3) of uint32: indices of vertices, counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, self.triangles.iter().copied())
    }

    /// Writes the body: NAME.obj its skin, NAME.glb skin and skeleton, NAME.json a mannequin file.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let source = match &self.project.body {
            BodyChoice::Shaped { description, .. } => BodySource::Described(description),
            _ => BodySource::Wearer(&self.project),
        };
        detached(py, || make_body(source, None, &path)).map(|_| ())
    }

    fn __repr__(&self) -> String {
        format!("<toile.Body {}>", self.project.body.words())
    }
}

/// Makes a body. Returns a Body.
///
/// figure: woman, man, mean, dress-form, or child-2 to child-14 by age; default: mean.
/// measurements: values by name (metres, angles in radians), as {"bust": 0.96}; those that are left out are predicted.
/// Default: the averages of the figure.
/// file: path of a table of measurements, or of a mannequin file, in place of measurements.
#[pyfunction]
#[pyo3(signature = (figure = None, *, measurements = None, file = None))]
pub fn body(
    py: Python<'_>,
    figure: Option<&str>,
    measurements: Option<BTreeMap<String, f64>>,
    file: Option<PathBuf>,
) -> PyResult<Body> {
    let figure = match figure {
        None => None,
        Some(name) => Some(figure_named(name).ok_or_else(|| {
            let names: Vec<&str> = Figure::ALL.iter().map(|figure| figure.name()).collect();
            unknown("figure", name, &names)
        })?),
    };
    detached(py, || {
        let mut commands = Vec::new();
        match measurements {
            Some(_) if file.is_some() => {
                let words = "a body takes measurements or a file: give one of them";
                return Err(SessionError::Conflict(words.to_owned()));
            }
            Some(given) => commands.push(Command::SetMeasurements {
                figure: Some(figure.unwrap_or(Figure::Mean)),
                measurements: Project::default().named_measurements(given)?,
            }),
            None => commands.push(Command::SetBody {
                figure: match &file {
                    None => Some(figure.unwrap_or(Figure::Mean)),
                    Some(_) => figure,
                },
                measurements: file,
            }),
        }
        Body::of(&commands)
    })
}

/// What a garment is draped on: a body, or what the pattern says.
pub fn worn_by(project: Project, body: Option<&Body>) -> Project {
    match body {
        None => project,
        Some(body) => Project {
            body: body.project.body.clone(),
            ..project
        },
    }
}
