//! The commands of the command line with their options.
//!
//! # Decided with
//! - [`crate::run`]: which function does a task;
//! - [`crate::session_commands`], [`crate::tool_commands`], [`crate::check_commands`]: commands with a
//!   session, without one, checks;
//! - [`crate::nest_commands`], [`crate::print_commands`], [`crate::lab_commands`]: markers, prints,
//!   laboratory;
//! - [`crate::batch_commands`]: commands as jobs of a batch;
//! - [`crate::nest_arguments::Nest`], [`crate::print_arguments::Print`], [`crate::flatten_arguments::Flatten`],
//!   [`crate::body_options::BodyOptions`], [`crate::values`]: options of several values and of single
//!   commands;
//! - [`crate::arguments::Make::choices`], [`toile_session::Command`]: options as commands of a session;
//! - [`crate::session_commands`] (`refuse_layers`): layers that are refused;
//! - [`crate::output::Output`]: words, JSON, exit status.
//!
//! By hand: a row in the README, words in `docs/GUIDE.md`, names of fabrics in the help of `Make`, wrong uses
//! in `tests/wrong-uses/table.toml`.

use crate::batch_arguments::{Batch, JobTask};
use crate::body_options::{BodyOptions, StanceOptions};
use crate::convert_arguments::Convert;
use crate::flatten_arguments::Flatten;
use crate::nest_arguments::Nest;
use crate::print_arguments::Print;
use crate::read_options::ReadArguments;
use crate::seams_arguments::Seams;
use crate::values::{blend, export_format, one_size, panel_origin, sizes};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use toile_geometry::{Duration, Length};
use toile_session::{
    Command, Export, ExportFormat, OtherGarment, PanelOrigin, PictureTime, Quality, SizeSelection,
};

/// Sewing patterns checked, laid out on fabric, sewn round a mannequin, draped and exported.
///
/// Without a command it makes the sample T-shirt into the folder `out`. Lengths are written with
/// their unit: mm, cm, m or in, as in 150cm; durations with ms, s or min, a number alone is in
/// seconds. Files are in metres, Y up, the mannequin facing +Z.
///
/// Exit status: 0 on success, 2 on bad input, 1 on failure, 3 where all was made and written but the verdict on it is
/// bad: not at rest, off the body, seams open, tangled, crumpled or slowed down.
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
    /// List faults of patterns and markers, each with its place and remedy.
    ///
    /// Exit status 2 if a garment cannot be made or a marker has faults.
    Check(Check),
    /// Lay the pieces of one or more patterns on fabric: marker.svg (true size, mm), marker.json.
    ///
    /// Ctrl-C ends the search and writes the best so far.
    ///
    /// Each fabric has its own marker, and each roll of it. Says length, efficiency, fabric needed
    /// (m), cost, and what found no place and why.
    Nest(Box<Nest>),
    /// Print the pieces at true size: sheets to join by their marks, or one page; PDF or SVG.
    ///
    /// Pieces are arranged to save paper, each panel once with how often it is cut. Sheets overlap
    /// by 10 mm and are numbered by row and column; sizes are layers of the file. A box of
    /// 50 x 100 mm is there to be measured.
    Print(Print),
    /// Write the triangulated panels as OBJ, in metres, side by side.
    Mesh(Mesh),
    /// Make a mannequin as OBJ, in metres, and list its measurements as asked and as got.
    Body(Box<Body>),
    /// Flatten a surface, or a region of a body, to a panel of least energy of its fabric, with darts where it would stretch
    /// too far.
    ///
    /// Writes the panel as a pattern (NAME.toile.json), and beside it NAME-flatten.json (SI units) and NAME-strain.png
    /// (stretch in %).
    Flatten(Flatten),
    /// Suggest seams for edges that have none, from lengths, angles, shapes, names, notches and places of the pieces.
    ///
    /// Nothing is sewn unasked: the list is by rank, and --accept sews and writes the pattern.
    Seams(Seams),
    /// Convert a pattern between formats; lists what could not be carried over.
    Convert(Convert),
    /// Do many jobs, each in a process of its own with limits of time and memory: every pattern in every size, fabric
    /// and body.
    ///
    /// Interrupted or killed, the same command goes on where it was; several processes may share the folder. A job
    /// that fails is a result, too: the others are done, and the exit status is 1. Writes report.json (figures of all
    /// jobs), timing.json (times and paths), and jobs/ID/ with result.json and files of each job.
    Batch(Batch),
    /// Do one job of a batch, as schedulers run it; `toile batch --list` writes its file.
    ///
    /// Writes result.json and the folder files beside the job's file. Exit status 1 where the job failed. It ends when
    /// a pipe on its standard input closes.
    Job(JobTask),
    /// Do the commands of a journal again; what they write goes into one folder.
    Replay(Replay),
    /// Simulate a scene: objects, elastics, gravity (JSON, SI units; see docs/FORMATS.md).
    ///
    /// Writes the frames asked for (SCENE.frames, with checkpoints beside it), the last state as OBJ (m), report.json (SI units) and
    /// timing.json (s).
    Run(Run),
    /// Write recorded frames (SCENE.frames of `toile run`) for other programs, or as pictures.
    Frames(FramesTask),
    /// Hold the simulation against physical laws: expected, measured, error, pass (SI units).
    ///
    /// Exit status 0 if every check is met, 1 if any is not; docs/methods/laws.md names those that are not.
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
    /// Measure what is claimed of speed and accuracy, a table a claim (docs/ACCURACY.md).
    ///
    /// Laws, stability, speed against accuracy, garments, layers, contact, factorisation, meshes,
    /// markers, drags: about ten minutes on two cores. Nothing is written without --write.
    Accuracy(AccuracyTask),
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
}

/// `toile accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyTask {
    /// Sections to measure or to list; `--list` names them. Default: all.
    #[arg(value_name = "SECTION")]
    pub sections: Vec<String>,
    /// Put the sections into this document (Markdown), each between `<!-- SECTION -->` and
    /// `<!-- /SECTION -->`, or at its end; charts go into the folder charts beside it.
    #[arg(long, value_name = "FILE")]
    pub write: Option<PathBuf>,
    /// List the sections with their commands instead of measuring them.
    #[arg(long, conflicts_with = "write")]
    pub list: bool,
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
    /// Save the run every so many simulated seconds to checkpoint.json in that folder, to go on from it after an
    /// interruption; where cloth meets cloth it is saved at whole seconds, and where a seam closes.
    #[arg(long, value_name = "S")]
    pub checkpoint: Option<f64>,
    /// Go on from checkpoint.json in that folder: the results are those of a run without interruption.
    #[arg(long)]
    pub resume: bool,
    /// Go on from this frame, counted from 0: from the checkpoint in SCENE.checkpoints before it.
    #[arg(long, value_name = "FRAME", conflicts_with = "resume")]
    pub restart: Option<usize>,
    /// End the run with checkpoint.json and exit status 3 once a simulated second takes more processor time than this,
    /// as in 30s or 10min.
    #[arg(long, value_name = "TIME")]
    pub give_up: Option<Duration>,
    /// Paint pictures, picture-WHEN.png, from four sides, all with one camera that takes in whatever moves: first, last,
    /// or a time as in 0.5s. Alone: first,last.
    #[arg(
        long,
        value_name = "WHEN",
        num_args = 0..=1,
        value_delimiter = ',',
        default_missing_value = "first,last"
    )]
    pub picture: Vec<PictureTime>,
    /// The object that the camera of the pictures follows. Default: it stands, and takes in all that moves.
    #[arg(long, value_name = "OBJECT", requires = "picture")]
    pub picture_of: Option<String>,
}

/// `toile frames`.
#[derive(Debug, Args)]
pub struct FramesTask {
    /// The frames (NAME.frames).
    pub frames: PathBuf,
    /// File to write, by its ending: .glb animated by morph targets; .pc2 a point cache for each surface that moves,
    /// with the mesh it belongs to as .obj beside it (Blender: mesh cache); .obj or .png a file for each frame,
    /// NAME-00000.obj and so on.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Only this object; in pictures the one that the camera goes along with.
    #[arg(long, value_name = "NAME")]
    pub object: Option<String>,
    /// Only this frame, counted from 0, as .obj or .png.
    #[arg(long, value_name = "FRAME")]
    pub frame: Option<usize>,
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

/// `toile make` and `toile drape`. What no option says is as the pattern's file keeps it: wearer, size,
/// fabric, width, and the garments that are worn with it.
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
    /// Whose body: woman, man, mean, dress-form, child-2, child-4, ... child-14 (by age), a mannequin file, a file of
    /// measurements (native JSON or GarmentCode YAML), or FIGURE:FILE; pattern for as the pattern says, whatever its
    /// file keeps: a woman of the pattern's size, mean for a pattern without sizes. Default: as the file keeps it.
    #[arg(long, value_name = "BODY")]
    pub body: Option<String>,
    /// Named size of the pattern; the mannequin gets that size too. Default: the pattern's base
    /// size, or the body's own measurements where --body is given.
    #[arg(long, value_name = "NAME", value_parser = one_size)]
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
    /// Point of the body that the patterns place their panels round, if they place them in space: auto, floor, waist,
    /// pelvis, or its height above the floor, as in 90cm.
    #[arg(long, value_name = "POINT", default_value = "auto", value_parser = panel_origin)]
    pub origin: PanelOrigin,
    /// What to write, and only that; what it takes is made first: glb, obj, drape, fit (pictures), marker-svg,
    /// marker-json, marker-dxf, marker-pdf, marker-report, marker-plt, marker-instance, pieces-pdf (A4), pieces-svg
    /// (one page), pattern-garmentcode, pattern-svg, pattern-dxf-aama, pattern-dxf-astm (the pattern, in all sizes), report, journal. Default: of what the command makes glb, obj, drape, fit, marker-svg, marker-json, report
    /// and journal.
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = export_format)]
    pub formats: Vec<ExportFormat>,
    /// Write this marker of the pattern as it is stored, instead of laying the pieces.
    #[arg(long, value_name = "NAME", requires = "formats")]
    pub marker: Option<String>,
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
            origin: PanelOrigin::Automatic,
            formats: Vec::new(),
            marker: None,
        }
    }

    /// What is written where.
    pub fn export(&self) -> Command {
        Command::Export(Export {
            dir: self.out.clone(),
            formats: self.formats.clone(),
            marker: self.marker.clone(),
        })
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
        if self.origin != PanelOrigin::Automatic {
            let origin = self.origin;
            commands.push(Command::SetOrigin { origin });
        }
        if let Some(OtherGarment { path, layer }) = garments.next() {
            commands.push(Command::open(path));
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

/// Reads `pattern`, `woman`, `man`, `mean`, `FILE` or `FIGURE:FILE`.
pub fn body_command(text: &str) -> Command {
    if text == "pattern" {
        return Command::SetBody {
            figure: None,
            measurements: None,
        };
    }
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
    /// Patterns of any format that is read; or marker.json files: their overlaps, gaps, margins, nap and
    /// flaws as they stand. Each file gets its own verdict.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Named sizes to check, as in S,M; or all. The pieces of --json are those of the first. Default:
    /// all, with the pieces of the size that the file keeps, else of the base size.
    #[arg(long, value_name = "NAMES", value_parser = sizes)]
    pub size: Option<SizeSelection>,
    /// Check all sizes, as --size all does.
    #[arg(long, conflicts_with = "size")]
    pub all_sizes: bool,
    #[command(flatten)]
    pub read: ReadArguments,
    /// Folder for the drawing of a marker, where what is cut twice is red.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
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
    #[arg(long, value_name = "NAME", value_parser = one_size)]
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
    /// Size of a table for several (.smms, .vst), as in 50: half the chest girth (cm). Default: the
    /// table's base size.
    #[arg(long, value_name = "SIZE", requires = "measurements")]
    pub size: Option<f64>,
    /// Height of a table for several sizes, as in 176cm. Default: the table's base height.
    #[arg(long, value_name = "LENGTH", requires = "measurements")]
    pub height: Option<Length>,
    /// Figure to grow it from: woman, man, mean, dress-form, or child-2, child-4, ... child-14 (by age).
    #[arg(long, value_name = "FIGURE", default_value = "mean")]
    pub figure: String,
    /// A mannequin file (JSON) to make the body from, as --out NAME.json writes it.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "mesh"])]
    pub mannequin: Option<PathBuf>,
    /// Measure somebody's mesh instead: a closed OBJ or PLY file of someone standing. --out then is the
    /// table of measurements (JSON), ready for --measurements.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "motion"])]
    pub mesh: Option<PathBuf>,
    /// Fit a mannequin of 150 ellipsoids to somebody's mesh: a closed OBJ or PLY file of someone
    /// standing, arms held off the trunk. Both sides become alike. Says how far it lies from the mesh.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measurements", "mesh", "mannequin"])]
    pub fit: Option<PathBuf>,
    /// Landmarks of --mesh or --fit (JSON): heights over the sole (m) crotch, hips, waist, underbust, bust,
    /// armpit, knee, and points (m) nape, shoulder_tip, neck_side, wrist of the left side, +X.
    /// Default: heights are found, what needs points is left out.
    #[arg(long, value_name = "FILE")]
    pub landmarks: Option<PathBuf>,
    #[command(flatten)]
    pub stance: StanceOptions,
    #[command(flatten)]
    pub stretch: BodyOptions,
    /// Edits of its ellipsoids, made last (JSON list, m and rad), as in
    /// [{"edit": "weigh", "primitive": 3, "weight": 1.2}]; also create, delete, move, turn, scale,
    /// group, blend, deform, attach, detach, join, part: their fields are in docs/FORMATS.md. Ellipsoids are counted from 0: those of
    /// trunk, head, left arm and left leg as in a mannequin file.
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub edits: Option<PathBuf>,
    /// Motion to pose it by: walk, run, a BVH file, or a VRML 97 or X3D file (.wrl, .x3d, .x3dv)
    /// with OrientationInterpolators routed to H-Anim joints. Default: at rest.
    #[arg(long, value_name = "MOTION")]
    pub motion: Option<String>,
    /// A second gait to mix in at equal phase, walk or run, with its share from 0 to 1, as in run:0.3.
    #[arg(long, value_name = "GAIT:SHARE", value_parser = blend, requires = "motion")]
    pub blend: Option<(String, f64)>,
    /// Time in the motion, as in 300ms; for .obj, as a .glb holds the whole motion. Default: 0s.
    #[arg(
        long,
        value_name = "DURATION",
        allow_negative_numbers = true,
        requires = "motion"
    )]
    pub time: Option<Duration>,
    /// File to write, by its ending: .obj the skin (m), .glb the skin with its skeleton and the
    /// whole motion, .character.json ellipsoids for real time with stand, astride, walk, run and the
    /// motion, other .json a mannequin file; measurements (JSON) with --mesh.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
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
