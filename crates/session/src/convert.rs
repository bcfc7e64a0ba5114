//! Converts patterns between formats.
//!
//! # Decided with
//! - [`crate::open::open_pattern_from`]: the pattern read, with what the file leaves open;
//! - [`toile_interchange::write`], [`toile_interchange::Format`]: formats that are written;
//! - [`crate::tools::sound_draft`]: faults that are refused.
//!
//! Options: crate `cli`, `convert_command.rs`.

use crate::event::FoundInFile;
use crate::fitting::{OpenedProject, fitting_beside};
use crate::output::cannot;
use crate::sizes::selected;
use crate::tools::{check_ending, sound_draft};
use crate::{OpenOptions, PanelOrigin, Project, SessionError};
use std::path::{Path, PathBuf};
use toile_interchange::{Format, Loss, SizedDraft, WriteSource, write, write_all_atomically};
use toile_pattern::SizeSelection;

/// How a pattern is converted.
#[derive(Clone, Debug, Default)]
pub struct ConvertOptions {
    /// How the input is read.
    pub open: OpenOptions,
    /// Format to write; `None`: the one that the output's name ends in.
    pub to: Option<Format>,
    /// Point of the body that the input places its panels round.
    pub origin: PanelOrigin,
    /// Sizes to write in a format that holds shapes; `None`: the size that the file keeps, else the base size.
    pub sizes: Option<SizeSelection>,
}

/// A pattern that was converted.
#[derive(Clone, Debug)]
pub struct Converted {
    /// Files that were written, the pattern first.
    pub files: Vec<PathBuf>,
    /// Format of the input, with what reading it found out.
    pub read: FoundInFile,
    /// Notes on the reading in words, guesses and losses too.
    pub notes: Vec<String>,
    /// Format of the output.
    pub format: Format,
    /// Contents that the output has no place for.
    pub losses: Vec<Loss>,
}

/// Reads a pattern and writes it in a format. Panels that the input places in space, round an origin, are
/// written as they stand on the floor.
///
/// # Errors
/// The input cannot be read; the output has a name of no format, or of another one than asked for, or cannot
/// be written; the garment has faults, and the format holds shapes.
pub fn convert(
    from: &Path,
    to: &Path,
    options: &ConvertOptions,
) -> Result<Converted, SessionError> {
    let format = format_of(to, options.to)?;
    let OpenedProject {
        project,
        notes,
        found,
    } = Project::open_from(from, options.origin, &options.open)?;
    let WrittenPattern { files, losses, .. } =
        write_project(&project, to, (Some(format), options.sizes.as_ref()))?;
    Ok(Converted {
        files,
        read: found,
        notes,
        format,
        losses,
    })
}

/// A pattern that was written.
#[derive(Clone, Debug)]
pub struct WrittenPattern {
    /// Files that were written, the pattern first.
    pub files: Vec<PathBuf>,
    /// Format of the files.
    pub format: Format,
    /// Contents that the format has no place for.
    pub losses: Vec<Loss>,
}

/// Writes a project in a format, else in the one that the file's name ends in; in sizes where the format
/// holds shapes.
///
/// # Errors
/// A name of no format, or of another one than asked for; sizes that the format does not hold; the garment has
/// faults, and the format holds shapes; a file cannot be written.
pub fn write_project(
    project: &Project,
    to: &Path,
    (format, sizes): (Option<Format>, Option<&SizeSelection>),
) -> Result<WrittenPattern, SessionError> {
    let format = format_of(to, format)?;
    let drafts = drafts(project, format, sizes)?;
    let fitting = fitting_beside(project, to).map_err(cannot("the pattern"))?;
    let source = WriteSource {
        pattern: &project.pattern,
        fitting: &fitting,
        drafts: &drafts,
    };
    let writing = write(&source, format).map_err(cannot("the pattern"))?;
    let folder = to.parent().unwrap_or(Path::new(""));
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let stem = &name[..name.len() - format.ending_of(&name).len()];
    let named = writing.files.iter().enumerate().map(|(k, file)| {
        let own = match k {
            0 => name.clone().into_owned(),
            _ => format!("{stem}{}", file.ending),
        };
        (own, &file.bytes)
    });
    let named: Vec<(String, &Vec<u8>)> = named.collect();
    write_all_atomically(folder, &named)?;
    Ok(WrittenPattern {
        files: named.iter().map(|(name, _)| folder.join(name)).collect(),
        format,
        losses: writing.losses,
    })
}

/// The format of an output: as asked for, else by its name.
fn format_of(to: &Path, asked: Option<Format>) -> Result<Format, SessionError> {
    let remedy = format!(
        "patterns are written as {}; `toile nest --write` writes markers as svg, dxf, pdf and plt",
        Format::written_words()
    );
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let endings = match asked {
        Some(format) => format.endings(),
        None => Format::all_endings(),
    };
    check_ending(to, &endings, &remedy)?;
    Ok(asked.or(Format::of_name(&name)).unwrap_or(Format::Native))
}

/// Drafts for a format that holds shapes, in the sizes asked for.
fn drafts(
    project: &Project,
    format: Format,
    sizes: Option<&SizeSelection>,
) -> Result<Vec<SizedDraft>, SessionError> {
    if !format.holds_shapes() {
        return match sizes {
            None => Ok(Vec::new()),
            Some(_) => Err(SessionError::Conflict(format!(
                "files of {} hold all sizes: leave --size and --all-sizes out",
                format.title()
            ))),
        };
    }
    let asked = match sizes {
        None => vec![(project.size.clone(), 1)],
        Some(sizes) => selected(sizes, &project.pattern)?,
    };
    if asked.len() > 1 && !format.holds_sizes() {
        return Err(SessionError::Conflict(format!(
            "files of {} hold one size: name one with --size",
            format.title()
        )));
    }
    let in_size = |(size, _): (Option<String>, u32)| {
        let sized = Project {
            size,
            ..project.clone()
        };
        sized.check_size()?;
        Ok(SizedDraft {
            size: sized.size_name().map(str::to_owned),
            draft: sound_draft(&sized)?,
        })
    };
    asked.into_iter().map(in_size).collect()
}
