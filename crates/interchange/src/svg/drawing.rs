//! A drawing as lines, words and signs in units of the file, y down, with the groups that they stand in.

use super::kinds::LineKind;
use crate::drawn::piece::DrawnLine;
use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// Everything that is drawn in a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawing {
    /// Groups; the first one is the whole drawing. Those within a group come after it.
    pub groups: Vec<Group>,
    /// Elements that draw lines.
    pub elements: Vec<Element>,
    /// Lines, in the order of the file.
    pub lines: Vec<Line>,
    /// Words.
    pub texts: Vec<Text>,
    /// Signs of FreeSewing that are put in by their names.
    pub signs: Vec<Sign>,
    /// Number of elements that were left out, by what they are.
    pub left_out: BTreeMap<&'static str, usize>,
}

/// A group, a layer or the whole drawing.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    /// The group that it stands in.
    pub parent: Option<usize>,
    /// The identifier in the file.
    pub id: String,
    /// The label, if there is one.
    pub label: Option<String>,
    /// Whether it is a layer.
    pub is_layer: bool,
    /// The panel that this program wrote into it.
    pub panel: Option<String>,
}

/// An element that draws lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Element {
    /// The group that it stands in.
    pub group: usize,
    /// The identifier in the file.
    pub id: String,
    /// The label or title, if there is one.
    pub label: Option<String>,
    /// The classes.
    pub classes: Vec<String>,
    /// The marker at its start.
    pub marker: String,
    /// Words that FreeSewing writes along it.
    pub words: String,
    /// The kind of line that this program wrote.
    pub kind: Option<LineKind>,
}

/// A line of an element.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// The element that draws it.
    pub element: usize,
    /// The shape.
    pub shape: DrawnLine,
}

/// Words at a place.
#[derive(Clone, Debug, Default)]
pub(super) struct Text {
    /// The group that they stand in.
    pub group: usize,
    /// Their place.
    pub at: Vec2,
    /// The words.
    pub words: String,
}

/// A sign at a place.
#[derive(Clone, Debug, Default)]
pub(super) struct Sign {
    /// The group that it stands in.
    pub group: usize,
    /// The name.
    pub name: String,
    /// The place.
    pub at: Vec2,
}

impl Drawing {
    /// Counts something that is left out.
    pub fn leave_out(&mut self, what: &'static str) {
        *self.left_out.entry(what).or_default() += 1;
    }

    /// A group and those that it stands in, from the inside out.
    pub fn chain(&self, group: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(group), |&group| self.groups[group].parent)
    }

    /// Whether a group is another one or stands in it.
    pub fn is_within(&self, group: usize, outer: usize) -> bool {
        self.chain(group).any(|group| group == outer)
    }

    /// The element of a line.
    pub fn element(&self, line: &Line) -> &Element {
        &self.elements[line.element]
    }
}

impl Element {
    /// Whether it has a class.
    pub fn has(&self, class: &str) -> bool {
        self.classes.iter().any(|own| own == class)
    }
}
