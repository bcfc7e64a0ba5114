//! Pieces laid on fabric.

use crate::arguments::{one_or_more, sizes as sizes_of, unknown};
use crate::arrays::{read_only, rows};
use crate::pattern::{Pattern, finite};
use crate::progress::{detached, watched};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use std::path::PathBuf;
use toile_session::{
    Budget, ClothSettings, LaidPatterns, MarkerFormat, MarkerSummary, NestOptions, Project,
    SessionError, lay_projects, write_atomically,
};

/// Kinds of files that a marker is written as, by the ending of the name or by word.
const KINDS: [(&str, MarkerFormat); 5] = [
    ("svg", MarkerFormat::Svg),
    ("json", MarkerFormat::Json),
    ("dxf", MarkerFormat::Dxf),
    ("pdf", MarkerFormat::Pdf),
    ("plt", MarkerFormat::Hpgl),
];

/// Pieces laid on fabric: a marker for each fabric and roll.
#[pyclass(frozen, module = "toile")]
pub struct Nest(LaidPatterns);

#[pymethods]
impl Nest {
    /// Every piece as it is laid, as structured array (n,) with the fields marker (uint32, number of the marker),
    /// piece (text), copy (uint32), x and y (float64, metres), turn (float64, radians, from the warp to the piece's
    /// grain) and mirrored (bool). x runs along the warp.
    #[getter]
    fn placements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let copies = self.0.copies();
        let longest = copies.iter().map(|copy| copy.piece.chars().count()).max();
        let name = format!("U{}", longest.unwrap_or(1).max(1));
        let fields = [
            ("marker", "u4"),
            ("piece", &*name),
            ("copy", "u4"),
            ("x", "f8"),
            ("y", "f8"),
            ("turn", "f8"),
            ("mirrored", "?"),
        ];
        let values = copies.iter().map(|copy| {
            let [x, y] = copy.translation;
            (
                copy.marker,
                &copy.piece,
                copy.copy,
                x,
                y,
                copy.turn,
                copy.mirrored,
            )
                .into_pyobject(py)
        });
        let values: Vec<Bound<'py, PyTuple>> = values.collect::<PyResult<_>>()?;
        let numpy = py.import("numpy")?;
        let array = numpy.call_method1("array", (values, fields.to_vec()))?;
        read_only(&array)?;
        Ok(array)
    }

    /// The cut line of every piece as it is laid, in the order of placements: arrays (n, 2) of float64 (metres), x
    /// along the warp, the first point not repeated (list).
    #[getter]
    fn outlines<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let copies = self.0.copies().into_iter();
        copies
            .map(|copy| rows(py, copy.outline.into_iter()))
            .collect()
    }

    /// The markers in numbers (list of Marker).
    #[getter]
    fn markers(&self) -> Vec<Marker> {
        self.0.summaries().into_iter().map(Marker).collect()
    }

    /// Length of fabric of all markers together, end margins included (metres).
    #[getter]
    fn length(&self) -> f64 {
        self.0.length()
    }

    /// Area of the pieces divided by the area of fabric between the end margins, over all markers (0 to 1).
    #[getter]
    fn efficiency(&self) -> f64 {
        self.0.efficiency()
    }

    /// A marker as the bytes of a file.
    ///
    /// kind: "svg", "json", "dxf", "pdf" or "plt". marker: its number, from 0.
    #[pyo3(signature = (kind, marker = 0))]
    fn to_bytes<'py>(
        &self,
        py: Python<'py>,
        kind: &str,
        marker: usize,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let format = kind_named(kind)?;
        let bytes = detached(py, || self.file(format, marker))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes a marker to a file, of the kind that its name ends in: .svg, .json, .dxf, .pdf or .plt.
    ///
    /// marker: its number, from 0.
    #[pyo3(signature = (path, marker = 0))]
    fn write(&self, py: Python<'_>, path: PathBuf, marker: usize) -> PyResult<()> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = kind_named(&ending)?;
        detached(py, || {
            Ok(write_atomically(&path, &self.file(format, marker)?)?)
        })
    }

    fn __repr__(&self) -> String {
        format!(
            "<toile.Nest {:?}, {:.4} m, {:.1} %>",
            self.0.title,
            self.0.length(),
            100.0 * self.0.efficiency()
        )
    }
}

impl Nest {
    fn file(&self, format: MarkerFormat, marker: usize) -> Result<Vec<u8>, SessionError> {
        let (files, _) = self.0.files(&[format])?;
        let count = files.len();
        let own = files.into_iter().nth(marker);
        own.map(|file| file.1).ok_or_else(|| SessionError::Unknown {
            kind: "marker",
            name: marker.to_string(),
            hint: format!("there are {count}, numbered from 0"),
        })
    }
}

fn kind_named(word: &str) -> PyResult<MarkerFormat> {
    let lower = word.to_lowercase();
    let known = KINDS.iter().find(|(ending, _)| *ending == lower);
    known.map(|(_, format)| *format).ok_or_else(|| {
        let words: Vec<&str> = KINDS.iter().map(|(ending, _)| *ending).collect();
        unknown("kind of file of a marker", word, &words)
    })
}

/// A marker in numbers: the pieces of one fabric, laid on it.
#[pyclass(frozen, module = "toile")]
pub struct Marker(MarkerSummary);

#[pymethods]
impl Marker {
    /// Name of the fabric (text).
    #[getter]
    fn fabric(&self) -> &str {
        &self.0.fabric
    }

    /// Width of the fabric (metres).
    #[getter]
    fn width(&self) -> f64 {
        self.0.width
    }

    /// Length of fabric used, end margins included (metres).
    #[getter]
    fn length(&self) -> f64 {
        self.0.length
    }

    /// Area of the pieces divided by width times length between the end margins (0 to 1).
    #[getter]
    fn efficiency(&self) -> f64 {
        self.0.efficiency
    }

    /// Area of the pieces divided by width times length (0 to 1).
    #[getter]
    fn utilisation(&self) -> f64 {
        self.0.utilisation
    }

    /// Number of pieces laid (int).
    #[getter]
    fn pieces(&self) -> usize {
        self.0.pieces
    }

    /// Pieces that could not be laid, each with the reason (list of pairs of texts).
    #[getter]
    fn missing(&self) -> Vec<(String, String)> {
        let missing = self.0.missing.iter().cloned();
        missing.map(Into::into).collect()
    }

    /// Whether the check found no fault, so that the marker can be cut (bool).
    #[getter]
    fn sound(&self) -> bool {
        self.0.sound
    }

    /// Notes for the cutter (list of texts).
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes.clone()
    }

    fn __repr__(&self) -> String {
        format!(
            "<toile.Marker of {:?}, {:.4} m>",
            self.0.fabric, self.0.length
        )
    }
}

/// Lays the pieces of one or more patterns on fabric. Returns a Nest.
///
/// patterns: a Pattern, or several that are laid together.
/// width: width of the fabric (metres); default: the fabric's own.
/// gap: distance between pieces (metres); default: the fabric's own.
/// sizes: name of a size, several, or a dict of the number of garments of each; default: Pattern.size of each.
/// evaluations: number of pairs of pieces that the search tries; more take longer and waste less. The same number and
/// seed give the same marker to the bit.
/// seconds: time that the search takes, in place of evaluations.
/// seed: of the random numbers.
/// threads: number of threads; 0 for as many as the machine has. The marker does not depend on it.
/// progress: as in drape.
#[pyfunction]
#[pyo3(signature = (
    patterns, *, width = None, gap = None, sizes = None, evaluations = None, seconds = None, seed = 1, threads = 0,
    progress = None
))]
#[allow(clippy::too_many_arguments)]
pub fn nest(
    py: Python<'_>,
    patterns: &Bound<'_, PyAny>,
    width: Option<f64>,
    gap: Option<f64>,
    sizes: Option<&Bound<'_, PyAny>>,
    evaluations: Option<u64>,
    seconds: Option<f64>,
    seed: u64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Nest> {
    let usual = NestOptions::default();
    let options = NestOptions {
        sizes: sizes.map(sizes_of).transpose()?.unwrap_or_default(),
        cloth: ClothSettings {
            width: width.map(|width| finite("width", width)).transpose()?,
            gap: gap.map(|gap| finite("gap", gap)).transpose()?,
            ..ClothSettings::default()
        },
        budget: match (evaluations, seconds) {
            (_, Some(seconds)) => Budget::Seconds(finite("seconds", seconds)?),
            (Some(evaluations), None) => Budget::Evaluations(evaluations),
            (None, None) => usual.budget,
        },
        seed,
        threads,
        ..usual
    };
    let projects: Vec<Project> = one_or_more(patterns, |pattern| {
        Ok(pattern.cast::<Pattern>()?.get().project.clone())
    })?;
    let laid = watched(py, progress, |watcher| {
        lay_projects(&projects, &options, watcher)
    })?;
    Ok(Nest(laid))
}
