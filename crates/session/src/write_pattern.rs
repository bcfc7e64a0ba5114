//! Patterns written in the formats of other programs.
//!
//! # Decided with
//! - [`toile_interchange::write`], [`toile_interchange::Format`]: formats that are written;
//! - [`crate::tools::sound_draft`]: faults that are refused;
//! - [`crate::convert()`], [`crate::Command::WritePattern`], [`crate::ExportFormat`]: whence patterns are written.

use crate::fitting::{fitting_anywhere, fitting_beside};
use crate::output::cannot;
use crate::sizes::selected;
use crate::tools::{check_ending, sound_draft};
use crate::{Project, SessionError, WriteOptions};
use std::path::{Path, PathBuf};
use toile_interchange::{
    Fitting, Format, Loss, SizedDraft, WriteSource, Writing, write, write_all_atomically,
};
use toile_pattern::SizeSelection;

/// A pattern that was written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenPattern {
    /// The files, the pattern first.
    pub files: Vec<PathBuf>,
    /// Format of the pattern.
    pub format: Format,
    /// Contents that the format has no place for.
    pub losses: Vec<Loss>,
}

impl Project {
    /// Contents of the pattern that a format has no place for. Nothing is written.
    ///
    /// # Errors
    /// The garment has faults, and the format holds shapes; or it holds one size, and all are asked for.
    pub fn lost_in(
        &self,
        format: Format,
        options: &WriteOptions,
    ) -> Result<Vec<Loss>, SessionError> {
        let fitting = fitting_anywhere(self).map_err(cannot("the pattern"))?;
        Ok(written(self, format, options.sizes().as_ref(), &fitting)?.losses)
    }
}

/// The format of a file that is to be written: as asked for, else by its name.
///
/// # Errors
/// A name that ends in no format, or in another one than asked for.
pub(crate) fn format_of(to: &Path, asked: Option<Format>) -> Result<Format, SessionError> {
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

/// Writes a project in a format, else in the one that the file's name ends in; in sizes where the format holds
/// shapes.
///
/// # Errors
/// A name of no format, or of another one than asked for; sizes that the format does not hold; the garment has
/// faults, and the format holds shapes; a file cannot be written.
pub fn write_project(
    project: &Project,
    to: &Path,
    (format, sizes): (Option<Format>, Option<&SizeSelection>),
) -> Result<WrittenPattern, SessionError> {
    write_pattern(project, to, format_of(to, format)?, sizes)
}

/// Writes the pattern of a project, and the files that belong to it beside it, whole or not at all.
///
/// # Errors
/// The garment has faults and the format holds shapes; sizes that the format has no place for; a file that
/// cannot be written.
pub(crate) fn write_pattern(
    project: &Project,
    to: &Path,
    format: Format,
    sizes: Option<&SizeSelection>,
) -> Result<WrittenPattern, SessionError> {
    let fitting = fitting_beside(project, to).map_err(cannot("the pattern"))?;
    let writing = written(project, format, sizes, &fitting)?;
    let folder = to.parent().unwrap_or(Path::new(""));
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let named = named_files(&name, format, &writing);
    write_all_atomically(folder, &named)?;
    Ok(WrittenPattern {
        files: named.iter().map(|(name, _)| folder.join(name)).collect(),
        format,
        losses: writing.losses,
    })
}

/// The files of a pattern with their names: the first has `name`, the others the same name with endings of
/// their own.
pub(crate) fn named_files<'a>(
    name: &str,
    format: Format,
    writing: &'a Writing,
) -> Vec<(String, &'a [u8])> {
    let stem = &name[..name.len() - format.ending_of(name).len()];
    let named = writing.files.iter().enumerate().map(|(k, file)| {
        let own = match k {
            0 => name.to_owned(),
            _ => format!("{stem}{}", file.ending),
        };
        (own, &*file.bytes)
    });
    named.collect()
}

/// The bytes of the pattern of a project in a format.
pub(crate) fn written(
    project: &Project,
    format: Format,
    sizes: Option<&SizeSelection>,
    fitting: &Fitting,
) -> Result<Writing, SessionError> {
    let drafts = drafts(project, format, sizes)?;
    let source = WriteSource {
        pattern: &project.pattern,
        fitting,
        drafts: &drafts,
    };
    write(&source, format).map_err(cannot("the pattern"))
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
    let mut asked = match sizes {
        None => vec![(project.size.clone(), 1)],
        Some(sizes) => selected(sizes, &project.pattern)?,
    };
    let base = project.pattern.base().map(|size| &size.name);
    asked.sort_by_key(|(size, _)| size.as_ref() != base);
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
