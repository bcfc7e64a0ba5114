//! Seams: which edges of panels are sewn to which.

use crate::{LineName, Mark, Number, PanelId, SeamId};
use serde::{Deserialize, Serialize};

/// Two chains of spans that are sewn together, start to start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seam {
    /// Its id.
    pub id: SeamId,
    /// Name to show.
    pub name: String,
    /// Both chains, each in walking order.
    pub sides: [Vec<Span>; 2],
    /// How much longer one side may be than the other [m].
    pub ease: Number,
    /// Whether the longer side is gathered to fit the shorter, whatever its length.
    pub gathered: bool,
    /// Whether right sides lie together while it is sewn: the usual seam.
    pub right_sides_together: bool,
    /// Whether more than two plies may meet here.
    pub multi_ply: bool,
}

impl Seam {
    /// A usual seam without ease.
    pub fn new(id: SeamId, name: impl Into<String>, sides: [Vec<Span>; 2]) -> Self {
        Self {
            id,
            name: name.into(),
            sides,
            ease: Number::ZERO,
            gathered: false,
            right_sides_together: true,
            multi_ply: false,
        }
    }

    /// The spans of both sides.
    pub fn spans(&self) -> impl Iterator<Item = &Span> {
        self.sides.iter().flatten()
    }

    /// Every number of the seam.
    pub fn numbers(&self) -> Vec<&Number> {
        let marks = self.spans().flat_map(|span| [&span.from, &span.to]);
        std::iter::once(&self.ease)
            .chain(marks.filter_map(Mark::number))
            .collect()
    }
}

/// A stretch of a line on one copy of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// The panel.
    pub panel: PanelId,
    /// Its copy, from 0.
    pub copy: u32,
    /// Which half of a folded panel: 0 as drawn; a bit a fold, set beyond it.
    pub half: u8,
    /// The line.
    pub line: LineName,
    /// Where it starts.
    pub from: Mark,
    /// Where it ends.
    pub to: Mark,
    /// Whether it walks against the line.
    pub backwards: bool,
}

impl Span {
    /// The same span walked the other way.
    pub fn reversed(self) -> Self {
        Self {
            from: self.to,
            to: self.from,
            backwards: !self.backwards,
            ..self
        }
    }
}
