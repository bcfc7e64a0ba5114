//! Options of `toile flatten`.

use crate::values::{direction, share};
use clap::Args;
use std::path::PathBuf;
use toile_geometry::Length;

/// `toile flatten`.
#[derive(Debug, Args)]
pub struct Flatten {
    /// The surface: a mesh (OBJ or PLY, m), with one outline unless --loop cuts a region out of it.
    #[arg(required_unless_present = "body", conflicts_with = "body")]
    pub mesh: Option<PathBuf>,
    /// Or a body, as in `toile make --body`: woman, man, mean, dress-form, child-2, child-4, ... child-14, a mannequin file,
    /// a file of measurements, FIGURE:FILE, or a mesh.
    #[arg(long, value_name = "BODY")]
    pub body: Option<String>,
    /// File of a loop (JSON): places on the surface round the region to flatten, joined by shortest paths, and lines to cut.
    #[arg(long = "loop", value_name = "FILE")]
    pub loop_file: Option<PathBuf>,
    /// Length of the edges that the region of a loop is meshed with. Default: a thirtieth of the side of a square as large, 2mm
    /// to 12mm.
    #[arg(long, value_name = "LENGTH", requires = "loop_file")]
    pub edge: Option<Length>,
    /// The panel follows the hollows of the region, as a glued sheet does; else its cloth is drawn straight over them.
    #[arg(long, requires = "loop_file")]
    pub follow_hollows: bool,
    /// Direction of the grain in space, as in 0,1,0. Default: upwards.
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub grain: Option<[f64; 3]>,
    /// Fabric: a name of the library, or a fabric file. Default: poplin.
    #[arg(long, value_name = "NAME|FILE")]
    pub fabric: Option<String>,
    /// Most stretch on 99 % of the area, either way.
    #[arg(long, value_name = "SHARE", default_value = "2%", value_parser = share)]
    pub strain: f64,
    /// Most darts.
    #[arg(long, value_name = "COUNT", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=20))]
    pub darts: u8,
    /// Distance by which the surface is moved out to its front first.
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "0mm",
        allow_hyphen_values = true
    )]
    pub ease: Length,
    /// Pattern to write (NAME.toile.json).
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}
