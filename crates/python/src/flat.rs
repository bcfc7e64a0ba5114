//! Surfaces flattened to panels.

use crate::arrays::rows;
use crate::errors::Error;
use crate::pattern::Pattern;
use crate::progress::detached;
use numpy::{AllowTypeChange, PyArray2, PyArrayLike2};
use pyo3::prelude::*;
use std::sync::Arc;
use toile_session::{FlatSurface, FlattenOptions, Project};

/// A surface flattened to a panel of least energy of the fabric.
#[pyclass(frozen, module = "toile")]
pub struct Flat {
    surface: FlatSurface,
    report: String,
}

#[pymethods]
impl Flat {
    /// The panel as a Pattern, with its darts as operations and the grain upright.
    #[getter]
    fn pattern(&self) -> Pattern {
        Pattern::made(Project {
            pattern: Arc::new(self.surface.pattern.clone()),
            ..Project::default()
        })
    }

    /// Places of the vertices on the panel as array (n, 2) of float64 (metres), the grain along +y. A vertex on a
    /// dart is there twice, once for each side.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.surface.places().into_iter())
    }

    /// Places of the same vertices on the surface as array (n, 3) of float64 (metres).
    #[getter]
    fn surface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.surface.surface().into_iter())
    }

    /// Triangles of the panel and of the surface as array (m, 3) of uint32: indices of vertices.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, self.surface.triangles().iter().copied())
    }

    /// Relative change of length of each triangle from the panel to the surface as array (m, 2) of float64: where it
    /// is most, where it is least (0.02 is 2 % longer).
    #[getter]
    fn stretch<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.surface.stretch().into_iter())
    }

    /// The report in numbers, as the command writes it (dict); names say their units, as "energy_j".
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.report,))
    }

    /// Notes in words (list of texts).
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.surface.report.notes.clone()
    }

    fn __repr__(&self) -> String {
        let report = &self.surface.report;
        format!(
            "<toile.Flat of {} triangles, {:.1} % on 99 % of the area>",
            report.triangles,
            100.0 * report.stretch_99
        )
    }
}

/// Flattens a surface with one outline to a panel that takes the least energy of a fabric to cover it. Returns a Flat.
///
/// vertices: array (n, 3) of floats (metres). triangles: array (m, 3) of integers: indices of vertices.
/// name: of the panel. fabric: name of a fabric of the library, or path of a fabric file; default: poplin.
/// strain: most stretch on 99 % of the area, either way (0.02 is 2 %). darts: most darts that are cut to keep it.
/// grain: direction of the grain in space (three floats); default: upwards.
/// loop: array (k, 3) of places on the surface in order round a region (metres), joined by shortest paths; the region,
/// the smaller side, is cut out and flattened. Default: the whole surface, which is a disk then.
/// ease: distance by which the surface is moved out to its front first (metres).
/// edge: length of the edges that the region of a loop is meshed with (metres); default: one that suits its size.
/// follow_hollows: whether the panel follows the hollows of the region; else its cloth is drawn straight over them.
#[pyfunction]
#[pyo3(signature = (
    vertices, triangles, r#loop = None, *, name = "panel", fabric = None, strain = 0.02, darts = 0, grain = None, ease = 0.0,
    edge = None, follow_hollows = false
))]
#[allow(clippy::too_many_arguments)]
pub fn flatten(
    py: Python<'_>,
    vertices: PyArrayLike2<'_, f64, AllowTypeChange>,
    triangles: PyArrayLike2<'_, i64, AllowTypeChange>,
    r#loop: Option<PyArrayLike2<'_, f64, AllowTypeChange>>,
    name: &str,
    fabric: Option<String>,
    strain: f64,
    darts: usize,
    grain: Option<[f64; 3]>,
    ease: f64,
    edge: Option<f64>,
    follow_hollows: bool,
) -> PyResult<Flat> {
    let vertices: Vec<[f64; 3]> = triples("vertices", vertices.as_array().rows())?;
    let indices: Vec<[i64; 3]> = triples("triangles", triangles.as_array().rows())?;
    let mut triangles = Vec::with_capacity(indices.len());
    for corners in indices {
        let mut own = [0; 3];
        for (own, corner) in own.iter_mut().zip(corners) {
            *own = u32::try_from(corner).map_err(|_| {
                Error::new_err(format!(
                    "triangles name vertex {corner}; give indices from 0 to {}",
                    vertices.len().saturating_sub(1)
                ))
            })?;
        }
        triangles.push(own);
    }
    let options = FlattenOptions {
        grain,
        fabric,
        strain,
        darts,
        ease,
        loop_file: None,
        edge,
        follows_hollows: follow_hollows,
    };
    let places = r#loop.map(|places| triples("loop", places.as_array().rows()));
    let places: Option<Vec<[f64; 3]>> = places.transpose()?;
    let made = detached(py, || {
        let surface =
            FlatSurface::of_arrays(&vertices, triangles, places.as_deref(), (name, &options))?;
        let report = surface.report.to_json();
        Ok((surface, report.unwrap_or_default()))
    });
    let (surface, report) = made?;
    Ok(Flat { surface, report })
}

/// Rows of three numbers.
fn triples<'a, T: Copy + Default + 'a, Row: IntoIterator<Item = &'a T>>(
    what: &str,
    rows: impl IntoIterator<Item = Row>,
) -> PyResult<Vec<[T; 3]>> {
    let triple = |row: Row| {
        let numbers: Vec<T> = row.into_iter().copied().collect();
        <[T; 3]>::try_from(numbers).map_err(|numbers| {
            Error::new_err(format!(
                "{what} have {} columns; give an array of three",
                numbers.len()
            ))
        })
    };
    rows.into_iter().map(triple).collect()
}
