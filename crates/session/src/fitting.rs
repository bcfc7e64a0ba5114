//! Fitting of a garment (wearer, size, fabric, layers), between a project and the file of its pattern. Files
//! that it refers to are named from the pattern's folder, so that they can be moved together.

use crate::bodies::mannequin_of;
use crate::event::FoundInFile;
use crate::fabrics::{fabric_of_file, is_known_fabric};
use crate::input::{is_input, is_pipe};
use crate::open::{OpenedPattern, is_sample, open_pattern_from};
use crate::paths::{relative, resolved};
use crate::placed_panels::PanelOrigin;
use crate::{BodyChoice, FabricChoice, OpenOptions, Project, SessionError, WornGarment};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_interchange::{
    Fitting, FittingFabric, FittingLayer, FittingWearer, FormatError, write_document,
};

/// A pattern file opened as a project.
pub(crate) struct OpenedProject {
    pub project: Project,
    /// Notes on contents that were left out, taken for granted or are missing.
    pub notes: Vec<String>,
    /// The format, with guesses and losses by themselves.
    pub found: FoundInFile,
}

impl Project {
    /// Opens a pattern file as a project, with the fitting that the file says; also returns notes on
    /// parts that were left out or are missing.
    ///
    /// # Errors
    /// The file is missing or cannot be read, or holds no pattern.
    pub fn open(path: &Path) -> Result<(Self, Vec<String>), SessionError> {
        let opened = Self::open_from(path, PanelOrigin::Automatic, &OpenOptions::default())?;
        Ok((opened.project, opened.notes))
    }

    /// Opens a pattern file as options say, with its panels placed round an origin.
    pub(crate) fn open_from(
        path: &Path,
        origin: PanelOrigin,
        options: &OpenOptions,
    ) -> Result<OpenedProject, SessionError> {
        let OpenedPattern {
            reading: opened,
            companions,
        } = open_pattern_from(path, origin, options)?;
        let mut notes = opened.words();
        let found = FoundInFile {
            format: opened.format,
            companions,
            guesses: opened.guesses,
            losses: opened.losses,
        };
        let mut project = Self {
            pattern: Arc::new(opened.pattern),
            source: Some(path.to_owned()),
            ..Self::default()
        };
        notes.extend(try_on(&mut project, opened.fitting, origin));
        Ok(OpenedProject {
            project,
            notes,
            found,
        })
    }
}

/// Fitting of a project's garment, for a file at a place.
///
/// # Errors
/// The name of a file that is worn or measured is not text.
pub(crate) fn fitting_beside(project: &Project, place: &Path) -> Result<Fitting, FormatError> {
    fitting_of(project, folder_of(Some(place)))
}

/// Fitting of a project's garment with absolute paths, for a file that may lie anywhere.
///
/// # Errors
/// The name of a file that is worn or measured is not text.
pub(crate) fn fitting_anywhere(project: &Project) -> Result<Fitting, FormatError> {
    fitting_of(project, None)
}

/// Text of a project's file, with paths relative to the folder of `place`; absolute paths if `place` is
/// `None`.
///
/// # Errors
/// Something that cannot be written, such as a file name that is not text.
pub(crate) fn document_text(
    project: &Project,
    place: Option<&Path>,
) -> Result<String, FormatError> {
    write_document(&project.pattern, &fitting_of(project, folder_of(place))?)
}

/// Folder that relative paths in a pattern file start from; `None` for a pattern without a file (a pipe, a
/// sample).
fn folder_of(file: Option<&Path>) -> Option<&Path> {
    let file = file.filter(|file| !is_pipe(file) && !is_sample(file))?;
    Some(file.parent().unwrap_or(Path::new("")))
}

/// Fitting of a project's garment, with paths relative to `folder`; absolute paths if it is `None`.
fn fitting_of(project: &Project, folder: Option<&Path>) -> Result<Fitting, FormatError> {
    let name = |path: &Path| file_name(path, folder);
    let wearer = match &project.body {
        // An edited mannequin is in no file that could be named.
        BodyChoice::OfPattern | BodyChoice::Shaped { path: None, .. } => FittingWearer::OfPattern,
        BodyChoice::Sample(figure) => FittingWearer::Figure(*figure),
        BodyChoice::Measured {
            figure,
            path,
            measurements,
        } => FittingWearer::Measured {
            figure: *figure,
            file: path.as_deref().map(name).transpose()?,
            measurements: (**measurements).clone(),
        },
        BodyChoice::Shaped {
            path: Some(path), ..
        }
        | BodyChoice::Missing { path } => FittingWearer::Mannequin { file: name(path)? },
    };
    let mut worn_with = Vec::new();
    for worn in &project.others {
        worn_with.push(FittingLayer {
            file: name(&worn.source)?,
            layer: worn.layer,
        });
    }
    let own_size = |name: &String| project.pattern.size_named(name).map(|size| size.id);
    Ok(Fitting {
        wearer,
        size: project.size.as_ref().and_then(own_size),
        fabric: match &project.fabric {
            None => None,
            Some(FabricChoice::Named(name)) => Some(FittingFabric::Named(name.clone())),
            Some(FabricChoice::File { path, .. }) => Some(FittingFabric::File(name(path)?)),
        },
        width: project.width,
        layer: project.layer,
        worn_with,
    })
}

/// Path by which a pattern file in `folder` names another file.
fn file_name(path: &Path, folder: Option<&Path>) -> Result<String, FormatError> {
    let whole = match (is_sample(path), folder) {
        (true, _) => path.to_owned(),
        (false, Some(folder)) => {
            let whole = resolved(path);
            relative(&whole, &resolved(folder)).unwrap_or(whole)
        }
        (false, None) => std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
    };
    let text = whole.to_str().map(|text| match std::path::MAIN_SEPARATOR {
        '/' => text.to_owned(),
        own => text.replace(own, "/"),
    });
    text.ok_or_else(|| {
        FormatError::new(
            path.display().to_string(),
            "the name of the file is not text in Unicode",
            "rename the file",
        )
    })
}

/// Files that are read for the fitting of a project: mannequin, fabric and other patterns. A table of
/// measurements is not among them, for the pattern holds its values.
pub(crate) fn files_to_try_on(project: &Project) -> Vec<PathBuf> {
    let body = match &project.body {
        BodyChoice::Shaped { path, .. } => path.clone(),
        BodyChoice::OfPattern
        | BodyChoice::Sample(_)
        | BodyChoice::Measured { .. }
        | BodyChoice::Missing { .. } => None,
    };
    let fabric = match &project.fabric {
        Some(FabricChoice::File { path, .. }) => Some(path.clone()),
        _ => None,
    };
    let others = project.others.iter().map(|worn| worn.source.clone());
    body.into_iter().chain(fabric).chain(others).collect()
}

/// Applies a fitting to a project that was just read. Files that it refers to are read; a file that
/// cannot be read gives a note and stays named in the project, and all else is applied.
pub(crate) fn try_on(project: &mut Project, fitting: Fitting, origin: PanelOrigin) -> Vec<String> {
    let source = project.source.clone();
    let folder = folder_of(source.as_deref()).unwrap_or(Path::new(""));
    let found = |file: &str| match is_sample(Path::new(file)) {
        true => PathBuf::from(file),
        false => folder.join(file),
    };
    let mut notes = Vec::new();
    project.body = wearer(fitting.wearer, found, &mut notes);
    if let Some(id) = fitting.size {
        let known = project.pattern.sizes.iter().find(|size| size.id == id);
        project.size = known.map(|size| size.name.clone());
        if project.size.is_none() {
            notes.push(format!(
                "{id}, which the garment was tried on in, is no more: it is drafted in its usual size"
            ));
        }
    }
    project.fabric = fitting.fabric.map(|asked| match asked {
        FittingFabric::Named(name) => {
            if !is_known_fabric(&project.pattern, &name) {
                notes.push(format!(
                    "there is no fabric {name:?}: panels are cut from their own until there is one"
                ));
            }
            FabricChoice::Named(name)
        }
        FittingFabric::File(file) => fabric(found(&file), &mut notes),
    });
    project.width = fitting.width;
    project.layer = fitting.layer;
    for FittingLayer { file, layer } in fitting.worn_with {
        let path = found(&file);
        let pattern = match refuse_itself(project, &path) {
            Ok(()) => open_pattern_from(&path, origin, &OpenOptions::default()),
            Err(error) => Err(error),
        };
        let pattern = match pattern {
            Ok(OpenedPattern {
                reading: opened, ..
            }) => {
                let note = |note| format!("{}: {note}", path.display());
                notes.extend(opened.words().into_iter().map(note));
                Some(Arc::new(opened.pattern))
            }
            Err(error) => {
                notes.push(format!(
                    "a garment that is worn with it is left off until it can be read: {error}"
                ));
                None
            }
        };
        project.others.push(WornGarment {
            pattern,
            source: path,
            layer,
        });
    }
    notes.extend(project.check_size().err().map(|error| error.to_string()));
    notes
}

fn wearer(
    wearer: FittingWearer,
    found: impl Fn(&str) -> PathBuf,
    notes: &mut Vec<String>,
) -> BodyChoice {
    match wearer {
        FittingWearer::OfPattern => BodyChoice::OfPattern,
        FittingWearer::Figure(figure) => BodyChoice::Sample(figure),
        FittingWearer::Measured {
            figure,
            file,
            measurements,
        } => {
            let path = file.map(|file| found(&file));
            if let Some(path) = path.as_ref().filter(|path| !is_input(path)) {
                notes.push(format!(
                    "the table of measurements {} is not there: the values stand as they were read from it",
                    path.display()
                ));
            }
            BodyChoice::Measured {
                figure,
                path,
                measurements: Arc::new(measurements),
            }
        }
        FittingWearer::Mannequin { file } => {
            let path = found(&file);
            mannequin_of(&path).unwrap_or_else(|error| {
                notes.push(format!(
                    "the mannequin cannot be read, and the wearer is as the pattern says until it can: {error}"
                ));
                BodyChoice::Missing { path }
            })
        }
    }
}

fn fabric(path: PathBuf, notes: &mut Vec<String>) -> FabricChoice {
    let fabric = match fabric_of_file(&path) {
        Ok((fabric, found)) => {
            notes.extend(found);
            Some(fabric)
        }
        Err(error) => {
            notes.push(format!(
                "the fabric cannot be read, and panels are cut from their own until it can: {error}"
            ));
            None
        }
    };
    FabricChoice::File { path, fabric }
}

/// Refuses the project's own pattern as a garment that is worn with it.
pub(crate) fn refuse_itself(project: &Project, path: &Path) -> Result<(), SessionError> {
    let own = project.source.as_deref();
    let is_itself = |own: &Path| !is_pipe(own) && resolved(own) == resolved(path);
    match own.is_some_and(is_itself) {
        true => Err(SessionError::Conflict(format!(
            "{} is the pattern itself: wear another with it, or a copy of the file",
            path.display()
        ))),
        false => Ok(()),
    }
}
