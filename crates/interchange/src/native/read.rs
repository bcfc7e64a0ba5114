//! Reads a pattern file: the pattern by its fields, and the fitting of its garment.

use super::fitting::Fitting;
use super::item::Item;
use super::part_reader::read_root;
use super::reader::Reader;
use crate::FormatError;
use toile_pattern::fields::Choice;
use toile_pattern::{Diagnostic, DisplayUnit, Names, Pattern};

/// Function that reads the fitting of the garment.
pub type FittingReader = for<'a> fn(&mut Reader<'a>, &Item<'a>) -> Result<Fitting, FormatError>;

/// Reads the pattern at the root of a file, and by `fitting` the fitting of its garment.
pub fn read(
    root: &Item<'_>,
    fitting: FittingReader,
    notes: &mut Vec<Diagnostic>,
) -> Result<(Pattern, Fitting), FormatError> {
    // Formulas name parts, so all parts must be known first: names are resolved in a second pass.
    let (unbound, _) = document(&mut Reader::new(Names::default()), root, fitting)?;
    let mut reader = Reader::new(Names::new(&unbound));
    let document = document(&mut reader, root, fitting)?;
    notes.extend(reader.notes);
    Ok(document)
}

/// Fields of the root that do not belong to the pattern.
const BESIDES: &[&str] = &["toile", "kind", "fitting"];

fn document<'a>(
    reader: &mut Reader<'a>,
    root: &Item<'a>,
    fitting: FittingReader,
) -> Result<(Pattern, Fitting), FormatError> {
    let head = root.fields()?;
    if let Some(unit) = head.get("unit") {
        reader.unit = DisplayUnit::all()[unit.word(DisplayUnit::words())?];
    }
    let mut pattern = Pattern::default();
    read_root(reader, root.clone(), BESIDES, &mut pattern);
    if let Some(fault) = reader.fault.take() {
        return Err(fault);
    }
    let tried_on = match head.get("fitting") {
        Some(item) => fitting(reader, &item)?,
        None => Fitting::default(),
    };
    reader.check_ids(&head.need("next_id")?, pattern.ids.next)?;
    Ok((pattern, tried_on))
}
