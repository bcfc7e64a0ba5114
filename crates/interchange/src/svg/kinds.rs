//! Words by which this program marks what it writes into SVG.

use strum::{EnumIter, IntoEnumIterator};
use toile_pattern::NotchKind;
use toile_pattern::fields::Choice;

/// Name of the space of this program's elements.
pub(super) const NAMESPACE: &str = "https://toile.org/ns/pattern";
/// Attribute of a layer: the panel that it holds.
pub(super) const PANEL: &str = "data-toile-panel";
/// Attribute of an element: the kind of its lines.
pub(super) const KIND: &str = "data-toile-kind";
/// Attribute of a notch: its shape.
pub(super) const NOTCH: &str = "data-toile-notch";

/// The kind of a line that this program writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter)]
pub(super) enum LineKind {
    Cut,
    Sew,
    Hole,
    Internal,
    Notch(NotchKind),
    Grain,
}

impl LineKind {
    /// The word of the kind.
    pub fn word(self) -> &'static str {
        match self {
            Self::Cut => "cut",
            Self::Sew => "sew",
            Self::Hole => "hole",
            Self::Internal => "internal",
            Self::Notch(_) => "notch",
            Self::Grain => "grain",
        }
    }

    /// The colour of its lines, so that a cutter tells kinds apart.
    pub fn colour(self) -> &'static str {
        match self {
            Self::Cut | Self::Hole => "#d40000",
            Self::Sew => "#0044aa",
            Self::Internal => "#008033",
            Self::Notch(_) => "#000000",
            Self::Grain => "#808080",
        }
    }

    /// The kind of a word, with the shape of a notch.
    pub fn of(word: &str, notch: Option<&str>) -> Option<Self> {
        let kind = Self::iter().find(|kind| kind.word() == word)?;
        Some(match kind {
            Self::Notch(_) => {
                let all = NotchKind::all().iter().copied();
                let mut named = all.filter(|shape| Some(shape.word()) == notch);
                Self::Notch(named.next().unwrap_or(NotchKind::Slit))
            }
            Self::Cut | Self::Sew | Self::Hole | Self::Internal | Self::Grain => kind,
        })
    }
}
