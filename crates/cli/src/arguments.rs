//! What can be asked on the command line.

use crate::stretch::Stretch;
use crate::values::{flaw, repeat, roll, size_count};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use toile_geometry::Length;
use toile_session::{
    Command, GivenFlaw, MarkerFormat, OtherGarment, PatternFormat, Quality, Spread,
};

/// Sewing patterns checked, laid out on fabric, sewn round a mannequin, draped and exported.
///
/// Without a command it makes the sample T-shirt into the folder `out`. Lengths are written with
/// their unit: mm, cm, m or in, as in 150cm. Files are in metres, Y up, the mannequin facing +Z.
///
/// Exit status: 0 on success, 2 on bad input, 1 on failure.
#[derive(Debug, Parser)]
#[command(name = "toile", version)]
pub struct Arguments {
    /// Print one machine-readable report (JSON) instead of words.
    #[arg(long, global = true)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub task: Option<Task>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Task {
    /// Check, lay out, sew, drape and export a garment, or several worn over one another.
    ///
    /// Writes marker.svg (true size, mm), marker.json, garment.glb, garment.obj (m), drape.png,
    /// fit.png (stretch in %), report.json (SI units), timing.json (s) and journal.jsonl; of several
    /// garments also layer-1-NAME.obj, layer-2-NAME.obj, ..., innermost first (m).
    Make(Make),
    /// Sew, drape and export a garment, or several in layers, without laying it out on fabric.
    Drape(Make),
    /// List faults of a pattern, each with its place and remedy.
    ///
    /// Exit status 2 if the garment cannot be made.
    Check(Check),
    /// Lay the pieces of one or more patterns on fabric: marker.svg (true size, mm), marker.json.
    ///
    /// Ctrl-C ends the search and writes the best so far.
    ///
    /// Each fabric has its own marker, and each roll of it. Says length, efficiency, fabric needed
    /// (m), cost, and what found no place and why.
    Nest(Box<Nest>),
    /// Write the triangulated panels as OBJ, in metres, side by side.
    Mesh(Mesh),
    /// Make a mannequin as OBJ, in metres, and list its measurements as asked and as got.
    Body(Body),
    /// Convert a pattern between formats; lists what could not be carried over.
    Convert(Convert),
    /// Do the commands of a journal again; what they write goes into one folder.
    Replay(Replay),
    /// Simulate a scene: objects, elastics, gravity (JSON, SI units; see docs/FORMATS.md).
    ///
    /// Writes the frames asked for and the last state as OBJ (m), report.json (SI units) and
    /// timing.json (s).
    Run(Run),
    /// Hold the simulation against physical laws: expected, measured, error, pass (SI units).
    ///
    /// Exit status 0 if every check is met, 1 if any is not: three fabrics lie outside the bands
    /// published for their drape, so that all laws together end with 1 (docs/methods/laws.md).
    Validate(Validate),
    /// Chart speed against accuracy: every method at several steps on standard scenes.
    ///
    /// Writes motion.csv and rest.csv (times in ms, errors in mm), an SVG for each scene and mesh,
    /// and locking.svg (error by resolution).
    Chart(ChartTask),
    /// Map where each method is stable, by step (s) and stiffness (N/m), with the theoretical
    /// limits, and meet the hard cases: stability.csv, stability.svg, limits.csv, hard-cases.csv.
    ///
    /// Exit status 0 if every explicit method blows up at its limit and no method goes on with an
    /// impossible state in a hard case; 1 if not, naming each.
    Stability(StabilityTask),
    /// Time benchmarks on frozen scenes, each with one thread and with two (s).
    Bench(BenchTask),
}

/// `toile chart`.
#[derive(Debug, Args)]
pub struct ChartTask {
    /// Scenes: cantilever, hang, sphere, tube, shirt; contact for the runs with contact of cloth with cloth. Default: all.
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Two steps on coarse meshes: under a minute.
    #[arg(long)]
    pub quick: bool,
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out/chart")]
    pub out: PathBuf,
    /// Also put the table of which method to use into this document, between its markers.
    #[arg(long, value_name = "FILE", hide = true)]
    pub into: Option<PathBuf>,
    /// Make the standard scenes anew in this folder instead.
    #[arg(long, value_name = "DIR", hide = true)]
    pub freeze: Option<PathBuf>,
    /// Compute where the motions converge to, into this folder, instead.
    #[arg(long, value_name = "DIR", hide = true)]
    pub reference: Option<PathBuf>,
}

/// `toile stability`.
#[derive(Debug, Args)]
pub struct StabilityTask {
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out/stability")]
    pub out: PathBuf,
    /// Also put the tables into this document, between its markers.
    #[arg(long, value_name = "FILE", hide = true)]
    pub into: Option<PathBuf>,
}

/// `toile bench`.
#[derive(Debug, Args)]
pub struct BenchTask {
    /// Benchmarks; `--list` names them. Default: those that take seconds.
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// List the benchmarks instead.
    #[arg(long, conflicts_with = "names")]
    pub list: bool,
}

/// `toile validate`.
#[derive(Debug, Args)]
pub struct Validate {
    /// Laws to measure or to list. Default: all.
    #[arg(value_name = "LAW")]
    pub laws: Vec<String>,
    /// List the laws with all their tolerances instead of measuring them.
    #[arg(long)]
    pub list: bool,
}

/// `toile run`.
#[derive(Debug, Args)]
pub struct Run {
    /// The scene file.
    pub scene: PathBuf,
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// How finely to mesh and drape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum QualityName {
    /// 25 mm edges, net force under 1e-2 of the weight: a quick look.
    Preview,
    /// 15 mm edges, net force under 5e-3 of the weight: to judge the fit.
    Fit,
    /// 10 mm edges, net force under 1e-3 of the weight: for the finished picture.
    Final,
}

impl From<QualityName> for Quality {
    fn from(name: QualityName) -> Self {
        match name {
            QualityName::Preview => Self::Preview,
            QualityName::Fit => Self::Fit,
            QualityName::Final => Self::Final,
        }
    }
}

/// `toile make` and `toile drape`.
#[derive(Debug, Args)]
pub struct Make {
    /// The pattern: native (*.toile.json) or a GarmentCode specification, seen from its content.
    /// Several are worn over one another, innermost first, and drafted to the wearer of the first.
    #[arg(required = true, value_name = "PATTERN")]
    pub patterns: Vec<PathBuf>,
    /// Layers of several patterns, 0 to 999, one each, as in 2,1: larger numbers are worn farther
    /// out, garments of one number lie as they come. Default: 1,2,3 and so on.
    #[arg(long, value_name = "NUMBER", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(0..=999))]
    pub layer: Vec<u16>,
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Whose body: woman, man, mean, child-2, child-4, ... child-14 (by age), a mannequin file, a file of
    /// measurements (native JSON or GarmentCode YAML), or FIGURE:FILE. Default: a woman of the pattern's size; mean for a pattern without sizes.
    #[arg(long, value_name = "BODY")]
    pub body: Option<String>,
    /// Named size of the pattern; the mannequin gets that size too. Default: the pattern's base
    /// size, or the body's own measurements where --body is given.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Cut every panel from this fabric: one of the pattern's, or of the library: silk,
    /// chiffon, poplin, cotton, jersey, wool, denim, leather, felt, flag-nylon. Default: each
    /// panel's own.
    #[arg(long, value_name = "NAME")]
    pub fabric: Option<String>,
    /// Width of the fabric, as in 150cm. Default: the fabric's own.
    #[arg(long, value_name = "LENGTH")]
    pub width: Option<Length>,
    /// How finely to mesh and how near to rest to drape.
    #[arg(long, value_enum, default_value = "fit")]
    pub quality: QualityName,
}

impl Make {
    /// A pattern with every default.
    pub fn of(pattern: PathBuf, out: &str) -> Self {
        Self {
            patterns: vec![pattern],
            layer: Vec::new(),
            out: out.into(),
            body: None,
            size: None,
            fabric: None,
            width: None,
            quality: QualityName::Fit,
        }
    }

    /// The commands that open the pattern and make every choice.
    pub fn choices(&self) -> Vec<Command> {
        let paths = self.patterns.iter().cloned();
        let mut garments = paths.enumerate().map(|(k, path)| {
            let layer = self.layer.get(k).copied();
            OtherGarment {
                path,
                layer: layer.unwrap_or(k as u16 + 1),
            }
        });
        let mut commands = Vec::new();
        if let Some(OtherGarment { path, layer }) = garments.next() {
            commands.push(Command::OpenPattern { path });
            let others: Vec<OtherGarment> = garments.collect();
            if !others.is_empty() {
                commands.push(Command::SetLayers { layer, others });
            }
        }
        if let Some(body) = &self.body {
            commands.push(body_command(body));
        }
        if let Some(size) = self.size.clone() {
            commands.push(Command::SetSize { size: Some(size) });
        }
        if let Some(fabric) = self.fabric.clone() {
            commands.push(Command::SetFabric {
                fabric: Some(fabric),
            });
        }
        if let Some(width) = self.width {
            commands.push(Command::SetWidth {
                width: Some(width.as_metres()),
            });
        }
        commands.push(Command::SetQuality {
            quality: self.quality.into(),
        });
        commands
    }
}

/// Reads `woman`, `man`, `mean`, `FILE` or `FIGURE:FILE`.
pub fn body_command(text: &str) -> Command {
    let figure = |name: &str| toile_session::figure_named(name);
    let (before, after) = text.split_once(':').unwrap_or((text, ""));
    match (figure(before), after) {
        (Some(figure), "") => Command::SetBody {
            figure: Some(figure),
            measurements: None,
        },
        (Some(figure), file) => Command::SetBody {
            figure: Some(figure),
            measurements: Some(file.into()),
        },
        (None, _) => Command::SetBody {
            figure: None,
            measurements: Some(text.into()),
        },
    }
}

/// `toile check`.
#[derive(Debug, Args)]
pub struct Check {
    /// The pattern: native or GarmentCode; or a marker.json: its overlaps, gaps, margins, nap and
    /// flaws as it stands.
    pub pattern: PathBuf,
    /// Named size to check. Default: the pattern's base size.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Folder for the drawing of a marker, where what is cut twice is red.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// `toile nest`.
#[derive(Debug, Args)]
pub struct Nest {
    /// The patterns: native or GarmentCode. Pieces of one fabric share a marker. Or one nesting
    /// instance in the JSON of jagua-rs: its solution is written to DIR/NAME.json.
    #[arg(required = true)]
    pub patterns: Vec<PathBuf>,
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
    #[arg(long, value_enum)]
    pub nap: Option<NapName>,
    /// How the fabric is spread. The width is that of the fabric laid open. Default: open.
    #[arg(long, value_enum)]
    pub spread: Option<SpreadName>,
    /// Layers cut at once. Default: 1; face to face 2.
    #[arg(long, value_name = "COUNT")]
    pub plies: Option<u32>,
    /// A roll at hand: its length, all plies together, and its width if that is not the fabric's.
    /// May be given again; rolls are filled in this order, and what fits none is named with the reason.
    #[arg(long, value_name = "L[,L]", value_parser = roll, conflicts_with = "length")]
    pub roll: Vec<(f64, Option<f64>)>,
    /// Price of a metre of the fabric's length.
    #[arg(long, value_name = "PRICE")]
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
    #[arg(long, value_name = "DEGREES")]
    pub tilt: Option<f64>,
    /// Repeat of stripes or checks along the warp and across, as in 50mm,40mm; 0mm where it does
    /// not repeat. The hem and the middle of every piece lie on its lines.
    #[arg(long, value_name = "L[,L]", value_parser = repeat)]
    pub repeat: Option<[f64; 2]>,
    /// A flaw no piece may lie on: x along the warp, y across the fabric laid open, length, width;
    /// where there are several fabrics after its name, as in lining:1m,20cm,3cm,3cm. May be given
    /// again.
    #[arg(long, value_name = "[FABRIC:]L,L,L,L", value_parser = flaw)]
    pub defect: Vec<GivenFlaw>,
    /// Named size. Default: each pattern's base size.
    #[arg(long, value_name = "NAME", conflicts_with = "sizes")]
    pub size: Option<String>,
    /// Several sizes in a ratio, as in S:1,M:2,L:1. Each garment is a bundle.
    #[arg(long, value_name = "NAME:COUNT", value_delimiter = ',', value_parser = size_count)]
    pub sizes: Vec<(String, u32)>,
    /// Time to search each fabric (s). The result depends on the machine; see --evaluations.
    #[arg(long, value_name = "SECONDS", conflicts_with = "evaluations")]
    pub time: Option<f64>,
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

/// How fabric is spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SpreadName {
    /// Open, right side up.
    Open,
    /// Folded in two along the warp: pieces cut on the fold lie on it, pairs are cut at once.
    Folded,
    /// A tube laid flat, a fold at both sides; its width is its girth.
    Tubular,
    /// Open, every second ply turned over: pairs are cut at once.
    FaceToFace,
}

impl From<SpreadName> for Spread {
    fn from(name: SpreadName) -> Self {
        match name {
            SpreadName::Open => Self::Open,
            SpreadName::Folded => Self::Folded,
            SpreadName::Tubular => Self::Tubular,
            SpreadName::FaceToFace => Self::FaceToFace,
        }
    }
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

/// Nap of a fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NapName {
    /// Pieces may point either way.
    None,
    /// All pieces point one way.
    OneWay,
    /// All pieces of a garment point one way.
    PerGarment,
}

impl From<NapName> for toile_session::Nap {
    fn from(name: NapName) -> Self {
        match name {
            NapName::None => Self::None,
            NapName::OneWay => Self::OneWay,
            NapName::PerGarment => Self::PerBundle,
        }
    }
}

/// `toile mesh`.
#[derive(Debug, Args)]
pub struct Mesh {
    /// The pattern: native or GarmentCode.
    pub pattern: PathBuf,
    /// Mean edge length of the triangles.
    #[arg(long, value_name = "LENGTH", default_value = "10mm")]
    pub edge: Length,
    /// Named size. Default: the pattern's base size.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// OBJ file to write (m).
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// `toile body`.
#[derive(Debug, Args)]
pub struct Body {
    /// File of measurements, any of the catalogue, the rest is predicted: native JSON (cm,
    /// degrees), GarmentCode YAML, Seamly .smis .smms, Valentina .vit .vst, or FreeSewing JSON.
    /// Default: the average of the figure.
    #[arg(long, value_name = "FILE")]
    pub measurements: Option<PathBuf>,
    /// Figure to grow it from: woman, man, mean, or child-2, child-4, ... child-14 (by age).
    #[arg(long, value_name = "FIGURE", default_value = "mean")]
    pub figure: String,
    /// A mannequin file (JSON) to make the body from, as --out NAME.json writes it.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "mesh"])]
    pub mannequin: Option<PathBuf>,
    /// Measure somebody's mesh instead: a closed OBJ file (m, Y up, facing +Z). --out then is the
    /// table of measurements (JSON), ready for --measurements.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "motion"])]
    pub mesh: Option<PathBuf>,
    /// Fit a mannequin of 150 ellipsoids to somebody's mesh: a closed OBJ file (m, Y up, facing
    /// +Z, arms held off the trunk). Both sides become alike. Says how far it lies from the mesh.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "mesh", "mannequin"])]
    pub fit: Option<PathBuf>,
    /// Landmarks of --mesh or --fit (JSON): heights over the sole (m) crotch, hips, waist, underbust, bust,
    /// armpit, knee, and points (m) nape, shoulder_tip, neck_side, wrist of the left side, +X.
    /// Default: heights are found, what needs points is left out.
    #[arg(long, value_name = "FILE")]
    pub landmarks: Option<PathBuf>,
    #[command(flatten)]
    pub stretch: Stretch,
    /// Edits of its ellipsoids, made last (JSON list, m and rad), as in
    /// [{"edit": "weigh", "primitive": 3, "weight": 1.2}]; also create, delete, move, turn, scale,
    /// group, blend, deform, attach, detach, join, part. Ellipsoids are counted from 0: those of
    /// trunk, head, left arm and left leg as in a mannequin file.
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub edits: Option<PathBuf>,
    /// Motion to pose it by: walk, run, a BVH file, or a VRML 97 or X3D file (.wrl, .x3d, .x3dv)
    /// with OrientationInterpolators routed to H-Anim joints. Default: at rest.
    #[arg(long, value_name = "MOTION")]
    pub motion: Option<String>,
    /// Time in the motion (s).
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub time: f64,
    /// File to write, by its ending: .obj the skin (m), .glb the skin with its skeleton and the
    /// whole motion, .json a mannequin file; measurements (JSON) with --mesh.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Formats of patterns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatName {
    /// Toile's own format.
    Native,
    /// GarmentCode specification.
    Garmentcode,
}

impl From<FormatName> for PatternFormat {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Native => Self::Native,
            FormatName::Garmentcode => Self::GarmentCode,
        }
    }
}

/// `toile convert`.
#[derive(Debug, Args)]
pub struct Convert {
    /// The pattern to read; its format is seen from its content.
    pub input: PathBuf,
    /// The file to write.
    pub output: PathBuf,
    /// Format to write. Default: native if the name ends in .toile.json, else GarmentCode.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub to: Option<FormatName>,
}

/// `toile replay`.
#[derive(Debug, Args)]
pub struct Replay {
    /// The journal (journal.jsonl): one command a line.
    pub journal: PathBuf,
    /// Folder to write into; it is made if need be.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}
