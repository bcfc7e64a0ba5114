//! Options of `toile nest`.

use crate::values::{flaw, nap, repeat, roll, sizes, spread};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use toile_geometry::{Duration, Length};
use toile_session::{GivenFlaw, MarkerFormat, NapRule, Print, Roll, SizeSelection, Spread};

/// `toile nest`.
#[derive(Debug, Args)]
pub struct Nest {
    /// The patterns: native or GarmentCode. Pieces of one fabric share a marker. Or one nesting
    /// instance in the JSON of jagua-rs: its solution is written to DIR/NAME.json.
    #[arg(required = true)]
    pub patterns: Vec<PathBuf>,
    /// A marker of the pattern file: it is searched for with its own fabric and order, pieces locked
    /// there stay, and where the pieces lie is stored in the file. The files of --write follow.
    #[arg(long, value_name = "NAME", conflicts_with_all = [
        "width", "length", "selvedge", "end_margin", "gap", "nap", "spread", "plies", "roll", "price",
        "settings", "tilt", "repeat", "defect", "size", "from", "lock", "study",
    ])]
    pub marker: Option<String>,
    /// Go on from where the marker's pieces lie, instead of laying them anew.
    #[arg(long, requires = "marker")]
    pub as_it_lies: bool,
    /// Only write the marker as it is stored; nothing is searched for, the pattern stays as it is.
    #[arg(long, requires = "marker", conflicts_with_all = ["as_it_lies", "time"])]
    pub stored: bool,
    /// Full width of the fabric, as in 150cm. Default: the fabric's own.
    #[arg(long, value_name = "LENGTH")]
    pub width: Option<Length>,
    /// Length of fabric at hand, all plies together. Default: as long as it takes.
    #[arg(long, value_name = "LENGTH")]
    pub length: Option<Length>,
    /// Unusable edge at either side. Default: 10mm.
    #[arg(long, value_name = "LENGTH")]
    pub selvedge: Option<Length>,
    /// Fabric left free at either end. Default: 0mm.
    #[arg(long, value_name = "LENGTH")]
    pub end_margin: Option<Length>,
    /// Least distance between pieces. Default: 2mm.
    #[arg(long, value_name = "LENGTH")]
    pub gap: Option<Length>,
    /// Nap of the fabric. Default: the fabric's own.
    #[arg(long, value_parser = nap())]
    pub nap: Option<NapRule>,
    /// How the fabric is spread. The width is that of the fabric laid open. Default: open.
    #[arg(long, value_parser = spread())]
    pub spread: Option<Spread>,
    /// Layers cut at once. Default: 1; face to face 2.
    #[arg(long, value_name = "COUNT")]
    pub plies: Option<u32>,
    /// A roll at hand: its length, all plies together, and its width if that is not the fabric's.
    /// May be given again; rolls are filled in this order, and what fits none is named with the reason.
    #[arg(long, value_name = "L[,L]", value_parser = roll, conflicts_with = "length")]
    pub roll: Vec<Roll>,
    /// Price of a metre of the fabric's length.
    #[arg(long, value_name = "PRICE", allow_negative_numbers = true)]
    pub price: Option<f64>,
    /// File of marker settings (JSON), by fabric and by piece: spreads, rolls, prices, print,
    /// flaws, gaps, blocks, turns, tilt, folds, locked pieces, marks that match, further fabrics.
    /// See docs/FORMATS.md. Options given here come first.
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// What to write: svg (true size, mm), json, dxf (release 12, mm), pdf (one page at true size),
    /// report (A4: picture, table, yardage, cost), plt (HPGL/2), instance (the pieces alone, for
    /// other nesting programs).
    #[arg(
        long,
        value_name = "FORMAT",
        value_enum,
        value_delimiter = ',',
        default_value = "svg,json"
    )]
    pub write: Vec<MarkerFormatName>,
    /// How far the grain of every piece may lie off the warp (degrees). Default: 0.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub tilt: Option<f64>,
    /// Repeat of stripes or checks along the warp and across, as in 50mm,40mm; 0mm where it does
    /// not repeat. The hem and the middle of every piece lie on its lines.
    #[arg(long, value_name = "L[,L]", value_parser = repeat)]
    pub repeat: Option<Print>,
    /// A flaw no piece may lie on: x along the warp, y across the fabric laid open, length, width;
    /// where there are several fabrics after its name, as in lining:1m,20cm,3cm,3cm. May be given
    /// again.
    #[arg(long, value_name = "[FABRIC:]L,L,L,L", value_parser = flaw)]
    pub defect: Vec<GivenFlaw>,
    /// Named sizes, each with how many garments of it where that is not one, as in S,M:2,L; or all.
    /// Each garment is a bundle. Default: each pattern's base size.
    #[arg(long, alias = "sizes", value_name = "NAMES", value_parser = sizes)]
    pub size: Option<SizeSelection>,
    /// Time to search each fabric, as in 10s or 2min. The result depends on the machine; see
    /// --evaluations.
    #[arg(
        long,
        value_name = "DURATION",
        conflicts_with = "evaluations",
        allow_negative_numbers = true
    )]
    pub time: Option<Duration>,
    /// Evaluations of pairs of pieces to search for on each fabric: the same ones give the same
    /// bytes.
    #[arg(long, value_name = "COUNT", default_value_t = 10_000_000)]
    pub evaluations: u64,
    /// Start of the sequence of chance.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Searches side by side. Default: 2; with --time one a processor, 2 at least.
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 0,
        hide_default_value = true
    )]
    pub islands: usize,
    /// Threads. Default: as many as there are processors; their number does not change the bytes.
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 0,
        hide_default_value = true
    )]
    pub threads: usize,
    /// A marker.json to go on from, made before or changed by hand; one for each fabric.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["roll", "study"])]
    pub from: Vec<PathBuf>,
    /// Pieces that stay where the marker gone on from has them, as in front,back.
    #[arg(long, value_name = "NAME", value_delimiter = ',', requires = "from")]
    pub lock: Vec<String>,
    /// Instead of one marker, lay the garments with and without each rule of the trade, and print
    /// what each costs in points of efficiency. Nothing is written.
    #[arg(long)]
    pub study: bool,
    /// Seeds that are averaged in a study.
    #[arg(long, value_name = "COUNT", default_value_t = 3, requires = "study")]
    pub seeds: u64,
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// Files of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MarkerFormatName {
    /// Drawing at true size.
    Svg,
    /// Data.
    Json,
    /// DXF release 12, millimetres.
    Dxf,
    /// One page at true size.
    Pdf,
    /// A4 report of all markers.
    Report,
    /// HPGL/2.
    Plt,
    /// The pieces as a nesting instance in the JSON of jagua-rs.
    Instance,
}

impl From<MarkerFormatName> for MarkerFormat {
    fn from(name: MarkerFormatName) -> Self {
        match name {
            MarkerFormatName::Svg => Self::Svg,
            MarkerFormatName::Json => Self::Json,
            MarkerFormatName::Dxf => Self::Dxf,
            MarkerFormatName::Pdf => Self::Pdf,
            MarkerFormatName::Report => Self::Report,
            MarkerFormatName::Plt => Self::Hpgl,
            MarkerFormatName::Instance => Self::Instance,
        }
    }
}
