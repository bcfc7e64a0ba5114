//! Drill holes in a document: short lines inside a panel, named as such.

/// Length of the line that marks a drill hole (m).
pub(crate) const DRILL_LENGTH: f64 = 0.004;
/// First word of the names of such lines.
pub(crate) const DRILL_NAME: &str = "drill";
/// Longest line of that name that still marks a hole (m).
const MAX_LENGTH: f64 = 0.006;

/// Whether a line inside a panel marks a drill hole: by its name and its length (m).
pub(crate) fn is_drill(name: &str, length: f64) -> bool {
    let mut words = name.split_whitespace();
    length <= MAX_LENGTH && words.next() == Some(DRILL_NAME)
}
