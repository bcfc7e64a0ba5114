//! Formats of patterns.

use super::ReadOption;
use crate::FileKind;
use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};
use toile_pattern::fields::Choice;

/// A format of patterns. Its word is that of `--from` and `--to`.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, VariantArray, VariantNames, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Format {
    /// Toile's own format.
    Native,
    /// A GarmentCode specification.
    #[serde(rename = "garmentcode")]
    #[strum(serialize = "garmentcode")]
    GarmentCode,
    /// SVG.
    Svg,
    /// DXF after ANSI/AAMA-292.
    DxfAama,
    /// DXF after ASTM D6673.
    DxfAstm,
    /// A pattern of Valentina.
    Valentina,
    /// A pattern of Seamly2D.
    Seamly,
}

impl Choice for Format {}

impl Format {
    /// The format of a kind of file, if that is a pattern that is read.
    pub fn of_kind(kind: FileKind) -> Option<Self> {
        Self::all().iter().copied().find(|of| of.kind() == kind)
    }

    /// The kind of file that the format is.
    pub fn kind(self) -> FileKind {
        match self {
            Self::Native => FileKind::Pattern,
            Self::GarmentCode => FileKind::GarmentCode,
            Self::Svg => FileKind::Svg,
            Self::DxfAama | Self::DxfAstm => FileKind::Dxf,
            Self::Valentina => FileKind::ValentinaPattern,
            Self::Seamly => FileKind::SeamlyPattern,
        }
    }

    /// The format that a file of this name is written in, by its ending.
    pub fn of_name(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let all = Self::all().iter().copied().filter(|of| of.is_written());
        let ends = all.filter(|of| name.ends_with(of.ending()));
        // The longest ending decides, .toile.json before .json; of formats with one ending the first.
        ends.min_by_key(|of| std::cmp::Reverse(of.ending().len()))
    }

    /// The ending of the names of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Native => ".toile.json",
            Self::GarmentCode => ".json",
            Self::Svg => ".svg",
            Self::DxfAama | Self::DxfAstm => ".dxf",
            Self::Valentina => ".val",
            Self::Seamly => ".sm2d",
        }
    }

    /// The endings of names that a file of this format may be written under.
    pub fn endings(self) -> Vec<&'static str> {
        match self {
            // GarmentCode's and Toile's own files are both JSON.
            Self::Native => vec![self.ending(), ".json"],
            Self::GarmentCode
            | Self::Svg
            | Self::DxfAama
            | Self::DxfAstm
            | Self::Valentina
            | Self::Seamly => vec![self.ending()],
        }
    }

    /// All endings of names that patterns are written under.
    pub fn all_endings() -> Vec<&'static str> {
        let all = Self::all().iter().filter(|of| of.is_written());
        all.map(|of| of.ending()).collect()
    }

    /// The longest of its endings that a name has; empty if it has none.
    pub fn ending_of(self, name: &str) -> &'static str {
        let name = name.to_lowercase();
        let ends = self.endings().into_iter();
        let ends = ends.filter(|ending| name.ends_with(ending));
        ends.max_by_key(|ending| ending.len()).unwrap_or_default()
    }

    /// Whether it holds the shapes of a draft, not the document that they come from.
    pub fn holds_shapes(self) -> bool {
        match self {
            Self::Native | Self::Valentina | Self::Seamly => false,
            Self::GarmentCode | Self::Svg | Self::DxfAama | Self::DxfAstm => true,
        }
    }

    /// Whether one file holds the shapes of several sizes.
    pub fn holds_sizes(self) -> bool {
        match self {
            Self::Native | Self::GarmentCode | Self::Svg | Self::Valentina | Self::Seamly => false,
            Self::DxfAama | Self::DxfAstm => true,
        }
    }

    /// The program or standard that the format is of, for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Native => "Toile",
            Self::GarmentCode => "GarmentCode",
            Self::Svg => "SVG",
            Self::DxfAama => "DXF-AAMA",
            Self::DxfAstm => "DXF-ASTM",
            Self::Valentina => "Valentina",
            Self::Seamly => "Seamly2D",
        }
    }

    /// Whether a reader of the format has a use for an answer to what files leave open.
    pub fn takes(self, option: ReadOption) -> bool {
        match (self, option) {
            (_, ReadOption::Format) => true,
            (Self::Native | Self::GarmentCode, _) => false,
            (Self::Valentina | Self::Seamly, option) => option == ReadOption::With,
            (Self::Svg, option) => option != ReadOption::With,
            (Self::DxfAama | Self::DxfAstm, _) => true,
        }
    }

    /// Whether this program writes it.
    pub fn is_written(self) -> bool {
        match self {
            Self::Native | Self::GarmentCode | Self::Svg | Self::DxfAama | Self::DxfAstm => true,
            Self::Valentina | Self::Seamly => false,
        }
    }

    /// The formats that are read, in words.
    pub fn read_words() -> String {
        let each = Self::all().iter().map(|of| match of {
            Self::Native => "*.toile.json",
            Self::GarmentCode => "GarmentCode specifications (JSON)",
            Self::Svg => "SVG",
            Self::DxfAama => "DXF-AAMA",
            Self::DxfAstm => "DXF-ASTM",
            Self::Valentina => "Valentina's .val",
            Self::Seamly => "Seamly2D's .sm2d",
        });
        listed(each.collect())
    }

    /// The formats that are written with the endings of their names, in words.
    pub fn written_words() -> String {
        let each = Self::all().iter().filter(|of| of.is_written());
        let each = each.map(|of| format!("NAME{} ({})", of.ending(), of.title()));
        listed(each.collect())
    }
}

/// Words with commas, and "and" before the last.
fn listed<Word: AsRef<str>>(words: Vec<Word>) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, before)) => format!("{} and {last}", before.join(", ")),
    }
}
