//! Bodies of the user's own: mannequin files, edits of their primitives, and figures brought to proportions.

use crate::input::read_file;
use crate::open::{open_mannequin, open_measurements, read_input};
use crate::{BodyChoice, Project, SessionError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_body::{BodyError, Description, Figure, Mannequin, PrimitiveEdit, ProportionBox};
use toile_interchange::{
    ExpectedKind, FileKind, FormatError, SizeChoice, proportion_boxes, read_proportions,
};
use toile_measure::{Measurements, Origin};

/// Makes a body choice from a description, with the measurements that a tape takes on the body. Refuses a
/// body whose primitives leave a hole.
pub(crate) fn shaped(
    description: Description,
    path: Option<PathBuf>,
) -> Result<BodyChoice, BodyError> {
    let mannequin = Mannequin::from_description(&description)?;
    let mut measurements = Measurements::new();
    for row in mannequin.measure() {
        // A value that the catalogue of measurements refuses is left out, and predicted later.
        let _ = measurements.set(row.name, row.got, Origin::Asked);
    }
    Ok(BodyChoice::Shaped {
        description: Arc::new(description),
        path,
        measurements: Arc::new(measurements),
    })
}

/// Reads a mannequin file and makes the body that it describes.
///
/// # Errors
/// The file cannot be read, is not a mannequin file, or no body can be made from it.
pub(crate) fn mannequin_of(path: &Path) -> Result<BodyChoice, SessionError> {
    Ok(shaped(open_mannequin(path)?, Some(path.to_owned()))?)
}

/// Reads the description in a mannequin file; `None` if the file is of another kind.
fn described(path: &Path) -> Result<Option<Description>, SessionError> {
    let bytes = read_file(path)?;
    match FileKind::of(&bytes) {
        Some(FileKind::Mannequin) => open_mannequin(path).map(Some),
        _ => Ok(None),
    }
}

/// Reads a body from a file of measurements or a mannequin file, with notes for the user. A body of
/// measurements is grown from `figure`.
///
/// # Errors
/// The file cannot be read, or no body can be made from it.
pub(crate) fn body_of(
    figure: Option<Figure>,
    path: &Path,
) -> Result<(BodyChoice, Vec<String>), SessionError> {
    if let Some(description) = described(path)? {
        return Ok((shaped(description, Some(path.to_owned()))?, Vec::new()));
    }
    let (table, found) = open_measurements(path, SizeChoice::default())?;
    let body = BodyChoice::Measured {
        figure: figure.unwrap_or(Figure::Mean),
        path: Some(path.to_owned()),
        measurements: Arc::new(table),
    };
    let note = |note: &String| format!("{}: {note}", path.display());
    Ok((body, found.iter().map(note).collect()))
}

/// Description of a project's body, however the body was chosen.
pub(crate) fn description_of(project: &Project) -> Description {
    match project.body.description() {
        Some(description) => (**description).clone(),
        None => Description {
            figure: project.figure(),
            measurements: project.body_measurements(),
            primitives: Vec::new(),
            frame: None,
            rigging: Default::default(),
        }
        .with_primitives(),
    }
}

/// Reads edits of primitives from a file that holds them as a JSON list.
///
/// # Errors
/// The file cannot be read, or does not hold a list of edits.
pub fn open_body_edits(path: &Path) -> Result<Vec<PrimitiveEdit>, SessionError> {
    serde_json::from_str(&read_input(path, ExpectedKind::SmallJson)?).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new(
            format!("line {}, column {}", error.line(), error.column()),
            error.to_string(),
            "write [{\"edit\": \"weigh\", \"primitive\": 3, \"weight\": 1.2}]: create, delete, move, turn, scale, weigh, group, blend, deform, attach, detach, join, part",
        ),
    })
}

/// Edits the primitives of the body in `described`; without it, those of the project's body.
///
/// # Errors
/// An edit that cannot be made, with the remedy.
pub fn edit_body(
    described: Option<Description>,
    project: &Project,
    edits: &[PrimitiveEdit],
) -> Result<Description, SessionError> {
    let body = described.unwrap_or_else(|| description_of(project));
    Ok(body.edited(edits)?)
}

/// Finds a proportion box by its name in the table that ships with the program, or in a file:
/// `FILE.json` for the first box of the file, `FILE.json:NAME` for a named one.
///
/// # Errors
/// An unknown name (the message lists the known ones), or a file that cannot be read.
pub fn proportions_named(text: &str) -> Result<ProportionBox, SessionError> {
    let (file, name) = match text.split_once(".json") {
        Some((stem, rest)) => (
            Some(PathBuf::from(format!("{stem}.json"))),
            rest.trim_start_matches(':'),
        ),
        None => (None, text),
    };
    let table = match &file {
        None => proportion_boxes(),
        Some(path) => {
            read_proportions(&read_input(path, ExpectedKind::SmallJson)?).map_err(|error| {
                SessionError::Format {
                    path: path.clone(),
                    error,
                }
            })?
        }
    };
    let chosen = match (&file, name) {
        (Some(_), "") => table.first(),
        _ => table.iter().find(|row| row.name == name),
    };
    chosen.cloned().ok_or_else(|| SessionError::Unknown {
        kind: "proportion box",
        name: name.to_owned(),
        hint: {
            let names: Vec<&str> = table.iter().map(|row| &*row.name).collect();
            format!("choose one of {}", names.join(", "))
        },
    })
}

/// Proportion box for a stature of `heads` head lengths, interpolated between the boxes that ship with the
/// program.
pub fn proportions_of_heads(heads: f64) -> ProportionBox {
    ProportionBox::of_heads(heads, &proportion_boxes())
}
