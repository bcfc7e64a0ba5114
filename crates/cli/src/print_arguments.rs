//! Options of `toile print`.

use crate::values::{scale, shrinkage, sizes};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use toile_session::{Lines, Paper, PrintOptions, Shrinkage, SizeSelection};

/// `toile print`.
#[derive(Debug, Args)]
pub struct Print {
    /// The pattern: native or GarmentCode.
    pub pattern: PathBuf,
    /// Named sizes, as in S,M; or all. Several lie one over another, each a layer. Default: the
    /// pattern's base size.
    #[arg(long, value_name = "NAMES", value_parser = sizes)]
    pub size: Option<SizeSelection>,
    /// The same as --size all.
    #[arg(long, conflicts_with = "size")]
    pub all_sizes: bool,
    /// Names of the pieces to print, as in front,back. Default: all.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub pieces: Vec<String>,
    /// Lines to print: those to cut along, those to sew along, or both.
    #[arg(long, value_enum, default_value = "both")]
    pub lines: LinesName,
    /// Length on paper to length of cloth, from 1:100 to 2:1, as in 1:4.
    #[arg(long, value_name = "RATIO", default_value = "1:1", value_parser = scale)]
    pub scale: f64,
    /// What to print on.
    #[arg(long, value_enum, default_value = "a4")]
    pub paper: PaperName,
    /// Halve pieces that are unfolded, to be laid on the fold of the cloth.
    #[arg(long)]
    pub halves: bool,
    /// What the cloth loses in the wash along warp and weft in percent, as in 3,1.5: pieces are
    /// drawn so much larger.
    #[arg(long, value_name = "WARP,WEFT", value_parser = shrinkage, allow_hyphen_values = true)]
    pub shrinkage: Option<Shrinkage>,
    /// File to write: NAME.pdf or NAME.svg.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

impl Print {
    /// What is asked for.
    pub fn options(&self) -> PrintOptions {
        PrintOptions {
            sizes: match (&self.size, self.all_sizes) {
                (Some(sizes), _) => sizes.clone(),
                (None, true) => SizeSelection::All,
                (None, false) => SizeSelection::Base,
            },
            pieces: self.pieces.clone(),
            lines: self.lines.into(),
            scale: self.scale,
            paper: self.paper.into(),
            halves: self.halves,
            shrinkage: self.shrinkage.unwrap_or_default(),
        }
    }
}

/// Lines to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LinesName {
    /// To cut along.
    Cut,
    /// To sew along.
    Sew,
    /// Both.
    Both,
}

impl From<LinesName> for Lines {
    fn from(name: LinesName) -> Self {
        match name {
            LinesName::Cut => Self::Cut,
            LinesName::Sew => Self::Sew,
            LinesName::Both => Self::Both,
        }
    }
}

/// Paper to print on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PaperName {
    /// Sheets of 210 x 297 mm.
    A4,
    /// Sheets of 8.5 x 11 in.
    Letter,
    /// Sheets of 841 x 1189 mm.
    A0,
    /// One page as large as it takes.
    Page,
    /// One page with lines that a projector shows.
    Projector,
}

impl From<PaperName> for Paper {
    fn from(name: PaperName) -> Self {
        match name {
            PaperName::A4 => Self::A4,
            PaperName::Letter => Self::Letter,
            PaperName::A0 => Self::A0,
            PaperName::Page => Self::Page,
            PaperName::Projector => Self::Projector,
        }
    }
}
