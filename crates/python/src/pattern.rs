//! Patterns: read, changed into new ones, checked, written.

use crate::arguments::{chosen, one_or_more, sizes as sizes_of};
use crate::draft::Draft;
use crate::errors::Error;
use crate::progress::detached;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_session::{
    Choice, DisplayUnit, Format, FoundInFile, OpenOptions, OpenedProject, PanelOrigin, Project,
    ReadOption, ReadOptions, Session, SizedDiagnostic, write_project,
};

/// A garment pattern with all its sizes, as read from a file. It never changes: methods that change something
/// return another one.
#[pyclass(frozen, module = "toile")]
pub struct Pattern {
    pub project: Project,
    found: Option<FoundInFile>,
    notes: Vec<String>,
}

impl Pattern {
    /// A pattern that was made, not read.
    pub fn made(project: Project) -> Self {
        Self {
            project,
            found: None,
            notes: Vec::new(),
        }
    }

    /// The project in a size, if one is asked for.
    pub fn in_size(&self, size: Option<String>) -> Project {
        match size {
            None => self.project.clone(),
            size => Project {
                size,
                ..self.project.clone()
            },
        }
    }

    fn changed(&self, project: Project) -> Self {
        Self {
            project,
            found: self.found.clone(),
            notes: self.notes.clone(),
        }
    }
}

#[pymethods]
impl Pattern {
    /// Name of the pattern (text).
    #[getter]
    fn name(&self) -> String {
        self.project.pattern.name.clone()
    }

    /// Word of the format that it was read from, as "native" or "dxf-aama" (text); None if it was not read.
    #[getter]
    fn format(&self) -> Option<&'static str> {
        self.found.as_ref().map(|found| found.format.word())
    }

    /// Names of the sizes in the pattern's order (list of texts); empty if it has none.
    #[getter]
    fn sizes(&self) -> Vec<String> {
        let sizes = self.project.pattern.sizes.iter();
        sizes.map(|size| size.name.clone()).collect()
    }

    /// Name of the size that it is drafted in if no other is asked for (text); None if it has no sizes, or is
    /// drafted for measurements.
    #[getter]
    fn size(&self) -> Option<String> {
        self.project.size_name().map(str::to_owned)
    }

    /// Names of the panels in the pattern's order (list of texts).
    #[getter]
    fn panels(&self) -> Vec<String> {
        let panels = self.project.pattern.panels.iter();
        panels.map(|panel| panel.name.clone()).collect()
    }

    /// Values of the variables by name (dict of floats: metres, radians or plain); None where a formula has no
    /// value.
    #[getter]
    fn variables(&self) -> BTreeMap<String, Option<f64>> {
        self.project.variables().into_iter().collect()
    }

    /// Measurements of the wearer that it is drafted for by name (dict of floats: metres, angles in radians), those
    /// predicted too.
    #[getter]
    fn measurements(&self) -> BTreeMap<String, f64> {
        let table = self.project.drafted_to().measurements;
        let each = table.iter();
        each.map(|(name, measured)| (name.to_owned(), measured.value))
            .collect()
    }

    /// Decisions on what the file leaves open (list of Guess).
    #[getter]
    fn guesses(&self) -> Vec<Guess> {
        let found = self.found.iter().flat_map(|found| &found.guesses);
        found.map(Guess::of).collect()
    }

    /// Contents of the file that were left out (list of Loss).
    #[getter]
    fn losses(&self) -> Vec<Loss> {
        let found = self.found.iter().flat_map(|found| &found.losses);
        found.map(Loss::of).collect()
    }

    /// Notes on the reading in words, guesses and losses too (list of texts).
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The pattern drafted for a wearer of these measurements, in place of a size.
    ///
    /// measurements: values by name (metres, angles in radians), as {"bust": 0.96}; names are those of
    /// Pattern.measurements. Those that are left out are predicted from these. Measurements given before are
    /// forgotten.
    fn with_measurements(
        &self,
        py: Python<'_>,
        measurements: BTreeMap<String, f64>,
    ) -> PyResult<Self> {
        let next = detached(py, || self.project.with_measurements(measurements))?;
        Ok(self.changed(next))
    }

    /// The pattern with a variable set to a value in every size.
    ///
    /// name: one of Pattern.variables. value: in metres if the variable is a length, in radians if it is an angle,
    /// else plain.
    fn with_variable(&self, py: Python<'_>, name: &str, value: f64) -> PyResult<Self> {
        let next = detached(py, || self.project.with_variable(name, value))?;
        Ok(self.changed(next))
    }

    /// Looks for faults; returns a list of Diagnostic, empty if nothing was found.
    ///
    /// sizes: name of a size, or several. Default: all sizes, or as drafted if it is drafted for measurements.
    #[pyo3(signature = (sizes = None))]
    fn check(&self, py: Python<'_>, sizes: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Diagnostic>> {
        let sizes = sizes.map(sizes_of).transpose()?;
        let found = detached(py, || {
            Session::of(self.project.clone()).diagnostics_by_size(sizes.as_ref())
        })?;
        let told = found
            .iter()
            .map(|sized| Diagnostic::of(&self.project, sized));
        Ok(told.collect())
    }

    /// Drafts the pattern: all formulas worked out, all pieces with their sewing and cut lines. Returns a Draft.
    ///
    /// size: name of a size; default: Pattern.size, or the measurements that were given. Raises PatternError if a
    /// fault keeps it from being drafted.
    #[pyo3(signature = (size = None))]
    fn draft(&self, py: Python<'_>, size: Option<String>) -> PyResult<Draft> {
        let project = self.in_size(size);
        detached(py, || Draft::of(&project))
    }

    fn __repr__(&self) -> String {
        let pattern = &self.project.pattern;
        format!(
            "<toile.Pattern {:?}, {} panels, {}>",
            pattern.name,
            pattern.panels.len(),
            self.project.drafted_to_words()
        )
    }
}

/// A decision on what a file leaves open.
#[pyclass(frozen, get_all, module = "toile")]
pub struct Guess {
    /// The question, as "unit" (text).
    what: &'static str,
    /// The answer that was taken, as "mm" (text).
    chosen: String,
    /// The reason (text).
    because: String,
    /// Argument of read that gives another answer, as "unit" (text).
    option: &'static str,
    /// All of it in one sentence (text).
    words: String,
}

impl Guess {
    fn of(guess: &toile_session::Guess) -> Self {
        let option = match guess.option {
            ReadOption::Format => "format",
            ReadOption::Unit => "unit",
            ReadOption::Inside => "inside",
            ReadOption::With => "companions",
        };
        Self {
            what: guess.what,
            chosen: guess.chosen.clone(),
            because: guess.because.clone(),
            option,
            words: guess.to_string(),
        }
    }
}

/// Contents of one kind that were left out, because a format has no place for them.
#[pyclass(frozen, get_all, module = "toile")]
pub struct Loss {
    /// The kind of contents, as "notches" (text).
    what: String,
    /// The part of the pattern or the place in the file; empty for the whole of it (text).
    place: String,
    /// Number of things that were left out (int).
    count: usize,
    /// The reason, or what stands in their stead (text).
    why: String,
    /// All of it in one sentence (text).
    words: String,
}

impl Loss {
    pub fn of(loss: &toile_session::Loss) -> Self {
        Self {
            what: loss.what.clone(),
            place: loss.place.clone(),
            count: loss.count,
            why: loss.why.clone(),
            words: loss.to_string(),
        }
    }
}

/// Something found wrong with a pattern.
#[pyclass(frozen, get_all, module = "toile")]
pub struct Diagnostic {
    /// "error" if it keeps the garment from being made, else "warning" or "note" (text).
    severity: String,
    /// Names of the sizes that it was found in; empty for a pattern without sizes (list of texts).
    sizes: Vec<String>,
    /// The part of the pattern (text).
    place: String,
    /// The fault (text).
    message: String,
    /// What to do about it (text).
    hint: String,
    /// All of it in one sentence (text).
    words: String,
}

impl Diagnostic {
    fn of(project: &Project, sized: &SizedDiagnostic) -> Self {
        let found = &sized.diagnostic;
        Self {
            severity: found.severity.to_string(),
            sizes: sized.sizes.clone(),
            place: project.pattern.describe(&found.place),
            message: found.message.clone(),
            hint: found.hint.clone(),
            words: sized.to_string(),
        }
    }
}

/// Reads a pattern; its format is seen from its content. Returns a Pattern.
///
/// source: path of a file, "sample:t-shirt" or another sample, or the content of a file as bytes.
/// format: word of the format, in place of the one that the content shows: native, garmentcode, dxf-aama, ...
/// unit: unit of the coordinates, in place of the one that the file states or its size suggests: mm, cm, m or in.
/// inside: distance from the outline inwards to the sewing line (metres), for a file that has cut lines alone.
/// companions: paths of files that belong to the pattern: a table of grade rules, or of measurements. Default: those
/// that it names, beside it.
///
/// What the file leaves open is decided and told in Pattern.guesses, what is left out in Pattern.losses. Raises
/// FormatError with place and remedy.
#[pyfunction]
#[pyo3(signature = (source, *, format = None, unit = None, inside = None, companions = None))]
pub fn read(
    py: Python<'_>,
    source: Source,
    format: Option<&str>,
    unit: Option<&str>,
    inside: Option<f64>,
    companions: Option<&Bound<'_, PyAny>>,
) -> PyResult<Pattern> {
    let options = OpenOptions {
        reading: ReadOptions {
            format: format
                .map(|word| chosen::<Format>("format", word))
                .transpose()?,
            unit: unit
                .map(|word| chosen::<DisplayUnit>("unit", word))
                .transpose()?,
            allowance_inside: inside,
        },
        with: match companions {
            None => Vec::new(),
            Some(paths) => one_or_more(paths, |path| path.extract())?,
        },
    };
    let opened = detached(py, || match &source {
        Source::Bytes(bytes) => Project::open_bytes(bytes, &options),
        Source::Path(path) => Project::open_from(path, PanelOrigin::Automatic, &options),
    })?;
    let OpenedProject {
        project,
        notes,
        found,
    } = opened;
    Ok(Pattern {
        project,
        found: Some(found),
        notes,
    })
}

/// A file by its path, or its content.
#[derive(FromPyObject)]
pub enum Source {
    /// Content of a file.
    Bytes(PyBackedBytes),
    /// Path of a file.
    Path(PathBuf),
}

/// Writes a pattern to a file. Returns what the format has no place for, as list of Loss.
///
/// path: the file. format: word of the format, in place of the one that the file's name ends in: native,
/// garmentcode, dxf-aama, dxf-astm, ... sizes: name of a size or several, for formats that hold shapes; default:
/// Pattern.size. A format of several files has the others beside the first, under its name.
#[pyfunction]
#[pyo3(signature = (pattern, path, *, format = None, sizes = None))]
pub fn write(
    py: Python<'_>,
    pattern: &Bound<'_, Pattern>,
    path: PathBuf,
    format: Option<&str>,
    sizes: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Loss>> {
    let format = format
        .map(|word| chosen::<Format>("format", word))
        .transpose()?;
    let sizes = sizes.map(sizes_of).transpose()?;
    let project = &pattern.get().project;
    let written = detached(py, || {
        write_project(project, &path, (format, sizes.as_ref()))
    })?;
    Ok(written.losses.iter().map(Loss::of).collect())
}

macro_rules! told_in_words {
    ($($class:ident),*) => {$(
        #[pymethods]
        impl $class {
            fn __str__(&self) -> &str {
                &self.words
            }

            fn __repr__(&self) -> String {
                format!(concat!("<toile.", stringify!($class), " {:?}>"), self.words)
            }
        }
    )*};
}

told_in_words!(Guess, Loss, Diagnostic);

/// Refuses a number that is not finite.
pub fn finite(what: &str, value: f64) -> PyResult<f64> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(Error::new_err(format!(
            "{what} is {value}; give a finite number"
        ))),
    }
}
