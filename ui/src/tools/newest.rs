//! The part that a tool made last: until the next is begun its handles and its name can be typed.

use super::planning::Planning;
use super::{Reading, number};
use crate::canvas::selection::Item;
use toile_pattern::plan::{self, NumberEntry};
use toile_pattern::{CurveRule, Edit, EditError};

/// A number of a spline's handle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Handle {
    /// Label of the number, as `x at A`.
    pub label: String,
    /// The number.
    pub entry: NumberEntry,
}

/// Numbers of the handles of a spline, those at its ends first; empty for any other part.
pub(super) fn handles(item: Item, reading: &Reading<'_>) -> Vec<Handle> {
    let Item::Curve(id) = item else {
        return Vec::new();
    };
    let pattern = reading.evaluation.pattern();
    let Some((sheet, curve)) = pattern.curve(id) else {
        return Vec::new();
    };
    let CurveRule::Spline { handles, knots, .. } = &curve.rule else {
        return Vec::new();
    };
    let ends = (0..2).map(|k| (handles[k], "at", curve.ends[k]));
    let inner = knots.iter().flat_map(|knot| {
        [
            (knot.before, "before", knot.point),
            (knot.after, "after", knot.point),
        ]
    });
    let mut found = Vec::new();
    for (handle, side, of) in ends.chain(inner) {
        let name = sheet.point(of).map_or("", |point| &*point.name);
        let entries = plan::numbers_of(reading.evaluation, handle.into());
        found.extend(entries.into_iter().map(|entry| Handle {
            label: format!("{} {side} {name}", entry.label),
            entry,
        }));
    }
    found
}

/// Kind and name of a part, in words; `None` if the pattern does not have the part.
pub(super) fn name(item: Item, reading: &Reading<'_>) -> Option<String> {
    item.words(reading.evaluation.pattern())
}

/// The edits that set the handle numbers whose text is not empty.
///
/// # Errors
/// Index of the field with the error, and the error.
pub(super) fn set_handles(
    handles: &[Handle],
    text: impl Fn(usize) -> String,
    reading: &Reading<'_>,
) -> Result<Vec<Edit>, (usize, String)> {
    let mut planning = Planning::new(reading);
    for (k, handle) in handles.iter().enumerate() {
        let typed = text(k);
        if typed.is_empty() {
            continue;
        }
        let fault = |words: String| (k, format!("{}: {words}", handle.label));
        let found = number::parse(&typed, handle.entry.want, reading.evaluation).map_err(fault)?;
        let made = planning.run(|evaluation| {
            let edits = plan::set_number(evaluation, &handle.entry.place, found)?;
            Ok((edits, ()))
        });
        made.map_err(|error| fault(error.to_string()))?;
    }
    Ok(planning.edits())
}

/// The edits that rename the part made last.
///
/// # Errors
/// The name is taken or not allowed.
pub(super) fn rename(
    item: Item,
    name: &str,
    reading: &Reading<'_>,
) -> Result<Vec<Edit>, EditError> {
    plan::rename(reading.evaluation, item.part(), name)
}
