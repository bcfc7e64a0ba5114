//! Exports: which files are written of a garment, its markers and its pieces, and where.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use strum::{EnumCount, IntoStaticStr, VariantArray};
use toile_interchange::Format;
use toile_marker::MarkerFormat;
use toile_pattern::fields::Choice;

/// Files to export, and the folder to write them to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Export {
    /// The folder; it is made if need be.
    pub dir: PathBuf,
    /// Formats to write; results that they need are made first. Without any, the existing results of the
    /// present project are written in the usual formats ([`ExportFormat::is_usual`]).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub formats: Vec<ExportFormat>,
    /// Name of a stored marker of the pattern to write; without one the pieces are laid for a new marker.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marker: Option<String>,
}

impl Export {
    /// Exports the existing results in the usual formats.
    pub fn made(dir: &Path) -> Self {
        Self {
            dir: dir.to_owned(),
            formats: Vec::new(),
            marker: None,
        }
    }
}

/// A kind of exported file.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    EnumCount,
    VariantArray,
    IntoStaticStr,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum ExportFormat {
    /// `garment.glb`: the garment as binary glTF, UVs in metres.
    Glb,
    /// `garment.obj`, a group for each panel; for several garments also one file for each,
    /// `layer-1-NAME.obj`.
    Obj,
    /// `drape.png`: the garment worn.
    Drape,
    /// `fit.png`: the stretch of the cloth as a colour map.
    Fit,
    /// `marker.svg`: the pieces on the fabric at true size.
    MarkerSvg,
    /// `marker.json`: the marker as data.
    MarkerJson,
    /// `marker.dxf`: release 12, millimetres.
    MarkerDxf,
    /// `marker.pdf`: one page at true size.
    MarkerPdf,
    /// `marker-report.pdf`: A4, with a table of the pieces.
    MarkerReport,
    /// `marker.plt`: HPGL/2.
    MarkerPlt,
    /// `marker-instance.json`: only the pieces, for other nesting programs.
    MarkerInstance,
    /// `pieces.pdf`: the pieces on sheets of A4 at true size.
    PiecesPdf,
    /// `pieces.svg`: the pieces on one page at true size.
    PiecesSvg,
    /// `pattern.json`: the pattern as GarmentCode.
    PatternGarmentcode,
    /// `pattern.svg`: the panels in layers, with the whole document in it.
    PatternSvg,
    /// `pattern-aama.dxf`: the pieces in all sizes as DXF-AAMA.
    PatternDxfAama,
    /// `pattern-astm.dxf`: the pieces in all sizes as DXF-ASTM.
    PatternDxfAstm,
    /// `report.json`: what is exported, in numbers.
    Report,
    /// `journal.jsonl` and `timing.json`: the commands, and how long they took.
    Journal,
}

impl ExportFormat {
    /// All formats, in the order in which they are listed.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Name in journals and on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Finds a format by its name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// Name of the first file of the format.
    pub fn file(self) -> &'static str {
        match self {
            Self::Glb => "garment.glb",
            Self::Obj => "garment.obj",
            Self::Drape => "drape.png",
            Self::Fit => "fit.png",
            Self::MarkerSvg => "marker.svg",
            Self::MarkerJson => "marker.json",
            Self::MarkerDxf => "marker.dxf",
            Self::MarkerPdf => "marker.pdf",
            Self::MarkerReport => "marker-report.pdf",
            Self::MarkerPlt => "marker.plt",
            Self::MarkerInstance => "marker-instance.json",
            Self::PiecesPdf => "pieces.pdf",
            Self::PiecesSvg => "pieces.svg",
            Self::PatternGarmentcode => "pattern.json",
            Self::PatternSvg => "pattern.svg",
            Self::PatternDxfAama => "pattern-aama.dxf",
            Self::PatternDxfAstm => "pattern-astm.dxf",
            Self::Report => "report.json",
            Self::Journal => "journal.jsonl",
        }
    }

    /// Whether the format is written if the user asks for no format.
    pub fn is_usual(self) -> bool {
        match self {
            Self::Glb
            | Self::Obj
            | Self::Drape
            | Self::Fit
            | Self::MarkerSvg
            | Self::MarkerJson
            | Self::Report
            | Self::Journal => true,
            Self::MarkerDxf
            | Self::MarkerPdf
            | Self::MarkerReport
            | Self::MarkerPlt
            | Self::MarkerInstance
            | Self::PiecesPdf
            | Self::PiecesSvg
            | Self::PatternGarmentcode
            | Self::PatternSvg
            | Self::PatternDxfAama
            | Self::PatternDxfAstm => false,
        }
    }

    /// Whether the format shows the garment worn, which has to be draped first.
    pub fn is_of_garment(self) -> bool {
        matches!(self, Self::Glb | Self::Obj | Self::Drape | Self::Fit)
    }

    /// Whether the format shows a marker.
    pub fn is_of_marker(self) -> bool {
        self.of_marker().is_some()
    }

    /// The marker format that corresponds to this format; `None` if this format shows no marker.
    pub(crate) fn of_marker(self) -> Option<MarkerFormat> {
        match self {
            Self::MarkerSvg => Some(MarkerFormat::Svg),
            Self::MarkerJson => Some(MarkerFormat::Json),
            Self::MarkerDxf => Some(MarkerFormat::Dxf),
            Self::MarkerPdf => Some(MarkerFormat::Pdf),
            Self::MarkerReport => Some(MarkerFormat::Report),
            Self::MarkerPlt => Some(MarkerFormat::Hpgl),
            Self::MarkerInstance => Some(MarkerFormat::Instance),
            Self::Glb
            | Self::Obj
            | Self::Drape
            | Self::Fit
            | Self::PiecesPdf
            | Self::PiecesSvg
            | Self::PatternGarmentcode
            | Self::PatternSvg
            | Self::PatternDxfAama
            | Self::PatternDxfAstm
            | Self::Report
            | Self::Journal => None,
        }
    }

    /// The export that writes the pattern itself in a format; `None` for formats that are not written, and for
    /// the native one, which is saved.
    pub fn of_pattern_format(format: Format) -> Option<Self> {
        match format {
            Format::GarmentCode => Some(Self::PatternGarmentcode),
            Format::Svg => Some(Self::PatternSvg),
            Format::DxfAama => Some(Self::PatternDxfAama),
            Format::DxfAstm => Some(Self::PatternDxfAstm),
            Format::Native | Format::Valentina | Format::Seamly => None,
        }
    }

    /// The format of a pattern that this export writes; `None` if it writes something else.
    pub fn of_pattern(self) -> Option<Format> {
        let mut all = Format::all().iter().copied();
        all.find(|format| Self::of_pattern_format(*format) == Some(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_found_by_the_name_it_has_in_journals() {
        for format in ExportFormat::ALL {
            let written = serde_json::to_string(&format).unwrap();
            assert_eq!(written, format!("{:?}", format.name()));
            assert_eq!(ExportFormat::named(format.name()), Some(format));
            let same = ExportFormat::ALL.iter();
            let same = same.filter(|other| other.file() == format.file());
            assert_eq!(same.count(), 1, "{}", format.file());
        }
    }

    #[test]
    fn every_format_of_other_programs_that_is_written_is_an_export() {
        for &format in Format::all() {
            let export = ExportFormat::of_pattern_format(format);
            let is_foreign = format.is_written() && format != Format::Native;
            assert_eq!(export.is_some(), is_foreign, "{}", format.word());
            assert!(export.is_none_or(|own| own.file().ends_with(format.ending())));
            assert_eq!(
                export.and_then(ExportFormat::of_pattern),
                export.map(|_| format)
            );
        }
    }
}
