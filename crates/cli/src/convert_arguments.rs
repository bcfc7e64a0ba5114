//! Arguments of `toile convert`.

use crate::read_options::ReadArguments;
use crate::values::{panel_origin, sizes, word};
use clap::Args;
use std::path::PathBuf;
use toile_session::{Format, PanelOrigin, SizeSelection};

/// `toile convert`.
#[derive(Debug, Args)]
pub struct Convert {
    /// The pattern to read; its format is seen from its content.
    pub input: PathBuf,
    /// The file to write; its ending says the format: NAME.toile.json, NAME.json (GarmentCode), NAME.svg, NAME.dxf (DXF-AAMA, or
    /// DXF-ASTM with --to dxf-astm).
    pub output: PathBuf,
    /// Format to write, in place of the one that the name ends in.
    #[arg(long, value_name = "FORMAT", value_parser = word::<Format>())]
    pub to: Option<Format>,
    #[command(flatten)]
    pub read: ReadArguments,
    /// Sizes to write in a format that holds shapes, as in S,M; or all. Default: the size that the file keeps, else the
    /// base size.
    #[arg(long, value_name = "NAMES", value_parser = sizes)]
    pub size: Option<SizeSelection>,
    /// Write all sizes, as --size all does.
    #[arg(long, conflicts_with = "size")]
    pub all_sizes: bool,
    /// Point of the body that the input places its panels round: auto, floor, waist, pelvis, or its height above the
    /// floor, as in 90cm. They are written as they stand on the floor.
    #[arg(long, value_name = "POINT", default_value = "auto", value_parser = panel_origin)]
    pub origin: PanelOrigin,
}
