//! Patterns written into the bytes of files.

use super::contents::losses;
use super::{Content, Format, Loss, WriteSource, Writing, Written};
use crate::dxf::{DxfWriting, write_dxf};
use crate::native::Fitting;
use crate::svg::write_svg;
use crate::{FormatError, write_document, write_garmentcode};

/// Writes a pattern in a format.
///
/// # Errors
/// A value that the format cannot hold, such as a number that is not finite; or no piece for a format that
/// holds shapes.
pub fn write(source: &WriteSource<'_>, format: Format) -> Result<Writing, FormatError> {
    let is_empty = source
        .drafts
        .iter()
        .all(|sized| sized.draft.pieces.is_empty());
    if format.holds_shapes() && is_empty {
        return Err(FormatError::new(
            "the pattern",
            format!(
                "no panel of it is cut, so that a file of {} would be empty",
                format.title()
            ),
            "add a panel, or have one cut at least once",
        ));
    }
    let mut whole = losses(source.pattern, format);
    if let Some(left) = sizes_left(source).filter(|_| format.holds_sizes()) {
        whole.retain(|loss| loss.what != Content::Sizes.words());
        whole.insert(0, left);
    }
    let one = |text: String, further: Vec<Loss>| {
        let bytes = text.into_bytes();
        let ending = format.ending();
        Writing {
            files: vec![Written { ending, bytes }],
            losses: whole.into_iter().chain(further).collect(),
        }
    };
    match format {
        Format::Native => Ok(one(
            write_document(source.pattern, source.fitting)?,
            Vec::new(),
        )),
        Format::Svg => Ok(one(write_svg(source)?, Vec::new())),
        Format::DxfAama | Format::DxfAstm => {
            let DxfWriting {
                text,
                rules,
                mut losses,
            } = write_dxf(source, format == Format::DxfAstm)?;
            losses.extend(fitting_lost(source.fitting));
            let mut writing = one(text, losses);
            writing.files.extend(rules.map(|rules| Written {
                ending: ".rul",
                bytes: rules.into_bytes(),
            }));
            Ok(writing)
        }
        Format::GarmentCode => {
            let base = source.drafts.first().ok_or_else(|| {
                FormatError::new("the pattern", "it has no draft", "mend its faults first")
            })?;
            let writing = write_garmentcode(&base.draft);
            let mut further = writing.lost;
            further.extend(fitting_lost(source.fitting));
            Ok(one(writing.text, further))
        }
        Format::Valentina | Format::Seamly => Err(FormatError::new(
            "the format",
            format!("patterns of {} are read, not written", format.title()),
            format!("patterns are written as {}", Format::written_words()),
        )),
    }
}

/// The sizes of the pattern that are none of the drafts, if there are any.
fn sizes_left(source: &WriteSource<'_>) -> Option<Loss> {
    let drafts = source.drafts.iter();
    let written: Vec<&String> = drafts.filter_map(|sized| sized.size.as_ref()).collect();
    let sizes = source.pattern.sizes.iter();
    let left = sizes.filter(|size| !written.contains(&&size.name)).count();
    (left > 0).then(|| Loss::of(Content::Sizes, left, Loss::NOT_ASKED_FOR))
}

/// The loss of a fitting, if it says anything but the size, which is the one that is written.
fn fitting_lost(fitting: &Fitting) -> Option<Loss> {
    let besides = Fitting {
        size: None,
        ..fitting.clone()
    };
    let is_plain = besides == Fitting::default();
    (!is_plain).then(|| Loss::of(Content::Fitting, 1, "the format has no place for it"))
}
