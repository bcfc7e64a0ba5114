//! Drafts: pieces with their lines, edges, notches; seams.

use crate::arrays::rows;
use crate::errors::raised;
use numpy::PyArray2;
use pyo3::prelude::*;
use std::sync::Arc;
use toile_session::{DraftedPiece, DraftedSeam, Project, SessionError};

/// Line of a piece as an array.
type Line<'py> = Bound<'py, PyArray2<f64>>;

/// A pattern drafted in a size or for measurements.
#[pyclass(frozen, module = "toile")]
pub struct Draft {
    size: Option<String>,
    pieces: Vec<Arc<DraftedPiece>>,
    seams: Vec<DraftedSeam>,
}

impl Draft {
    pub fn of(project: &Project) -> Result<Self, SessionError> {
        let drafted = project.drafted()?;
        Ok(Self {
            size: drafted.size().map(str::to_owned),
            pieces: drafted.pieces()?.into_iter().map(Arc::new).collect(),
            seams: drafted.seams(),
        })
    }
}

#[pymethods]
impl Draft {
    /// Name of the size (text); None if it is drafted for measurements, or the pattern has no sizes.
    #[getter]
    fn size(&self) -> Option<String> {
        self.size.clone()
    }

    /// The pieces of cloth, each copy of a panel by itself (list of Piece).
    #[getter]
    fn pieces(&self) -> Vec<Piece> {
        let pieces = self.pieces.iter();
        pieces.map(|piece| Piece(piece.clone())).collect()
    }

    /// The seams between pieces, those of darts too (list of Seam).
    #[getter]
    fn seams(&self) -> Vec<Seam> {
        self.seams.iter().cloned().map(Seam).collect()
    }

    fn __repr__(&self) -> String {
        format!(
            "<toile.Draft of {} pieces and {} seams>",
            self.pieces.len(),
            self.seams.len()
        )
    }
}

/// A piece of cloth as it is cut and sewn, in its own plane, seen from the right side of the cloth.
#[pyclass(frozen, module = "toile")]
pub struct Piece(Arc<DraftedPiece>);

#[pymethods]
impl Piece {
    /// Name of the piece; no other of the draft has it (text).
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Name of the panel that it is a copy of (text).
    #[getter]
    fn panel(&self) -> &str {
        &self.0.panel
    }

    /// Number of the copy of the panel, from 0 (int).
    #[getter]
    fn copy(&self) -> u32 {
        self.0.copy
    }

    /// Name of the fabric (text).
    #[getter]
    fn fabric(&self) -> &str {
        &self.0.fabric
    }

    /// Direction of the warp, counter-clockwise from +x (radians).
    #[getter]
    fn grain(&self) -> f64 {
        self.0.grain
    }

    /// Whether it is sewn to others or is the only panel, else it is cut only (bool).
    #[getter]
    fn sewn(&self) -> bool {
        self.0.sewn
    }

    /// Area within the sewing line, holes taken out (m2).
    #[getter]
    fn area(&self) -> f64 {
        self.0.area
    }

    /// Area within the cut line, holes taken out (m2).
    #[getter]
    fn cut_area(&self) -> f64 {
        self.0.cut_area
    }

    /// The sewing line as array (n, 2) of float64 (metres), counter-clockwise; the first point is not repeated.
    ///
    /// tolerance: largest distance of its chords from the curves (metres).
    #[pyo3(signature = (tolerance = 1e-4))]
    fn outline<'py>(&self, py: Python<'py>, tolerance: f64) -> PyResult<Line<'py>> {
        let lines = self.lines(py, tolerance)?;
        rows(py, lines.into_iter().next().unwrap_or_default().into_iter())
    }

    /// The sewing lines of holes as arrays (n, 2) of float64 (metres), clockwise (list).
    ///
    /// tolerance: largest distance of their chords from the curves (metres).
    #[pyo3(signature = (tolerance = 1e-4))]
    fn holes<'py>(&self, py: Python<'py>, tolerance: f64) -> PyResult<Vec<Line<'py>>> {
        let lines = self.lines(py, tolerance)?.into_iter().skip(1);
        lines.map(|line| rows(py, line.into_iter())).collect()
    }

    /// The cut line as array (n, 2) of float64 (metres), counter-clockwise; the first point is not repeated. Its
    /// chords stay within 5 micrometres of the curves.
    #[getter]
    fn cut_line<'py>(&self, py: Python<'py>) -> PyResult<Line<'py>> {
        let line = self.0.cut_lines().into_iter().next();
        rows(py, line.unwrap_or_default().into_iter())
    }

    /// The cut lines of holes as arrays (n, 2) of float64 (metres), clockwise (list).
    #[getter]
    fn cut_holes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Line<'py>>> {
        let lines = self.0.cut_lines().into_iter().skip(1);
        lines.map(|line| rows(py, line.into_iter())).collect()
    }

    /// The edges of the outline in its order, then those of holes (list of Edge).
    #[getter]
    fn edges(&self) -> Vec<Edge> {
        let edges = self.0.edges.iter().map(|edge| Edge {
            name: edge.name.clone(),
            length: edge.length,
            allowance: edge.allowance,
        });
        edges.collect()
    }

    /// The notches (list of Notch).
    #[getter]
    fn notches(&self) -> Vec<Notch> {
        let notches = self.0.notches.iter().map(|notch| Notch {
            name: notch.name.clone(),
            edge: notch.edge.clone(),
            kind: notch.kind,
            at: notch.at.into(),
            depth: notch.depth,
        });
        notches.collect()
    }

    fn __repr__(&self) -> String {
        format!("<toile.Piece {:?}, {:.4} m2>", self.0.name, self.0.area)
    }
}

impl Piece {
    fn lines(&self, py: Python<'_>, tolerance: f64) -> PyResult<Vec<Vec<[f64; 2]>>> {
        let lines = self.0.sewing_lines(tolerance);
        lines.map_err(|error| raised(py, error))
    }
}

/// An edge of a piece. A spline is several edges of one name.
#[pyclass(frozen, get_all, module = "toile")]
pub struct Edge {
    /// Name of the edge, or of the operation that made it (text).
    name: String,
    /// Length along the sewing line (metres).
    length: f64,
    /// Width of the seam allowance (metres).
    allowance: f64,
}

#[pymethods]
impl Edge {
    fn __repr__(&self) -> String {
        format!("<toile.Edge {:?}, {:.4} m>", self.name, self.length)
    }
}

/// A notch of a piece.
#[pyclass(frozen, get_all, module = "toile")]
pub struct Notch {
    /// Name of the notch (text).
    name: String,
    /// Name of the edge that it is on (text).
    edge: String,
    /// Kind: "slit", "v", "castle", "t" or "check" (text).
    kind: &'static str,
    /// Place on the sewing line: x and y (metres).
    at: (f64, f64),
    /// Depth of the cut (metres); 0 if it is drawn on the sewing line.
    depth: f64,
}

#[pymethods]
impl Notch {
    fn __repr__(&self) -> String {
        format!("<toile.Notch {:?} on {:?}>", self.name, self.edge)
    }
}

/// A seam between two chains of edges.
#[pyclass(frozen, module = "toile")]
pub struct Seam(DraftedSeam);

#[pymethods]
impl Seam {
    /// Name of the seam (text).
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Lengths of both sides (two floats, metres).
    #[getter]
    fn lengths(&self) -> (f64, f64) {
        self.0.lengths.into()
    }

    /// Whether the longer side is gathered or eased on purpose (bool).
    #[getter]
    fn gathered(&self) -> bool {
        self.0.gathered
    }

    /// Both sides as they are walked: for each stretch the names of piece and edge (two lists of pairs of texts).
    #[getter]
    #[allow(clippy::type_complexity)]
    fn sides(&self) -> (Vec<(String, String)>, Vec<(String, String)>) {
        self.0.sides.clone().into()
    }

    fn __repr__(&self) -> String {
        format!("<toile.Seam {:?}>", self.0.name)
    }
}
