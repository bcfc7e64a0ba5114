//! Commands: everything that can be asked of a session, as data.
//!
//! # Decided with
//! - [`crate::session::Session::perform`] (`perform.rs`): what each command does;
//! - [`crate::session::Session::execute`]: time taken; entry in the journal;
//! - [`crate::derived::Derived::follow`]: what a change makes out of date;
//! - [`crate::history::History`], [`crate::session::Session::change`] (`perform.rs`): steps that are undone
//!   and redone;
//! - [`crate::journal::Journal`], [`crate::file_stamp::Stamp`]: commands kept and replayed, with the files
//!   that they read;
//! - [`crate::project::Project`]: what commands change;
//! - [`crate::event::Event`], [`crate::error::SessionError`]: what a command tells; why it is refused;
//! - [`crate::export_format::ExportFormat`], [`crate::output`]: files that are written;
//! - [`crate::session::Session::replay`], [`crate::journal_files::open_journal`],
//!   [`crate::journal::read_entries`]: a journal replayed, its files, a line that is refused;
//! - [`crate::session::Session::commit`] (`gesture.rs`): a drag is one command and one step.
//!
//! The compiler asks who performs a new command and where it writes. By hand: `each_input`, `stage`,
//! `weight`; a command that opens a pattern in `execute`; `follow`.

use crate::interactive_run::read_inputs;
use crate::{Export, OpenOptions, PanelOrigin, PastStep, Quality, WriteOptions};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use strum::IntoStaticStr;
use toile_body::{Figure, PrimitiveEdit};
use toile_drape::Input;
use toile_measure::Measurements;
use toile_pattern::Edit;

/// Weight of draping in the progress of making a garment (1). Only the ratios of weights count.
const DRAPING: f64 = 80.0;
/// Weight of laying markers in this progress (1).
const LAYING: f64 = 7.0;
/// Weight of writing the exported files in this progress (1).
const WRITING: f64 = 7.0;

/// A command to a session. The journal is a list of commands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(rename_all = "snake_case", tag = "command")]
#[strum(serialize_all = "snake_case")]
pub enum Command {
    /// Replaces the project by a pattern read from a file; the format is recognised from the content.
    OpenPattern {
        /// The file.
        path: PathBuf,
        /// How it is read.
        #[serde(default, skip_serializing_if = "OpenOptions::is_empty")]
        options: OpenOptions,
    },
    /// Sets the origin that the panels of pattern files opened from now on are placed round: a point of the
    /// body.
    SetOrigin {
        /// The point of the body.
        origin: PanelOrigin,
    },
    /// Replaces the project by an empty pattern.
    NewPattern {
        /// Name of the pattern.
        name: String,
    },
    /// Replaces the project by a pattern in the native format that is in no file, such as one
    /// recovered after a crash.
    RestorePattern {
        /// The pattern, as the text of a file.
        text: String,
        /// The file that the pattern was last saved to.
        source: Option<PathBuf>,
        /// Steps of the history that led to the pattern and can be undone, the newest first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        past: Vec<PastStep>,
    },
    /// Writes the pattern in the native format.
    SavePattern {
        /// The file.
        path: PathBuf,
    },
    /// Writes the pattern in a format of another program. The project keeps its own file.
    WritePattern {
        /// The file.
        path: PathBuf,
        /// Format and sizes.
        #[serde(flatten)]
        options: WriteOptions,
    },
    /// Changes the pattern. Either all edits are made or none.
    Edit {
        /// The edits.
        edits: Vec<Edit>,
        /// The step's name in the history, as in "Move point".
        label: String,
    },
    /// Undoes the last step of the history.
    Undo,
    /// Redoes the step that was undone last.
    Redo,
    /// Chooses the body: a figure with average measurements, or the body of a file. Without either,
    /// the body is as the pattern says.
    SetBody {
        /// The figure; with a file of measurements, `None` means the mean figure.
        figure: Option<Figure>,
        /// A file of measurements, or a mannequin file, which says its figure itself.
        measurements: Option<PathBuf>,
    },
    /// Chooses a body by measurements that are given in the command.
    SetMeasurements {
        /// Figure that the body is grown from; `None` means the figure of the present body.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        figure: Option<Figure>,
        /// The measurements (m), (rad); missing ones are predicted from them.
        measurements: Measurements,
    },
    /// Edits the primitives of the body, which from then on no longer follows measurements. Either all edits
    /// are made or none.
    EditBody {
        /// The edits.
        edits: Vec<PrimitiveEdit>,
        /// The step's name in the history, as in "Move primitive".
        label: String,
    },
    /// Writes the body as a mannequin file.
    SaveBody {
        /// The file.
        path: PathBuf,
    },
    /// Chooses a named size of the pattern, or its base size.
    SetSize {
        /// Name of the size; `None` for the base size.
        size: Option<String>,
    },
    /// Cuts every panel from one fabric, or each from its own.
    SetFabric {
        /// Name of a fabric of the pattern or the library, or a fabric file; `None` for each panel's own
        /// fabric.
        fabric: Option<String>,
    },
    /// Chooses the width of the fabric, or the fabric's own.
    SetWidth {
        /// Width of the roll (m); `None` for the fabric's own width.
        width: Option<f64>,
    },
    /// Chooses how finely to mesh and how near to rest to drape.
    SetQuality {
        /// Quality of mesh and drape.
        quality: Quality,
    },
    /// Wears garments of other patterns with the project's, in layers; those worn before are taken off. A
    /// layer of a larger number lies farther out; garments with the same number have no order among them.
    SetLayers {
        /// Layer of the project's own garment, 0 to 999.
        layer: u16,
        /// The other garments.
        others: Vec<OtherGarment>,
    },
    /// Looks for faults of the pattern.
    Check,
    /// Lays the pieces on fabric.
    Nest,
    /// Meshes the pieces and places them round the mannequin.
    Assemble,
    /// Sews the garment and drapes it to rest.
    Drape {
        /// Actions on the cloth during the drape, each with its step.
        #[serde(
            default,
            skip_serializing_if = "Vec::is_empty",
            deserialize_with = "read_inputs"
        )]
        inputs: Vec<Input>,
    },
    /// Writes files of the present project: marker, garment, pictures, pieces, report.
    Export(Export),
}

/// A garment to wear with the project's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OtherGarment {
    /// The file of its pattern.
    pub path: PathBuf,
    /// Layer of the garment, 0 to 999.
    pub layer: u16,
}

/// The files that a command names.
enum NamedFiles<'a> {
    /// A file or folder that is written.
    Output(&'a mut PathBuf),
    /// A pattern and the files that belong to it, which are read.
    Pattern(&'a mut PathBuf, &'a mut [PathBuf]),
    /// A file that is read. `None`: no file is read.
    Input(Option<&'a mut PathBuf>),
    /// Garments, whose patterns are read.
    Garments(&'a mut [OtherGarment]),
    /// A fabric: its name, or the file that it is read from.
    Fabric(Option<&'a mut String>),
}

impl Command {
    /// Opens a pattern file in the format that its content shows.
    pub fn open(path: impl Into<PathBuf>) -> Self {
        Self::OpenPattern {
            path: path.into(),
            options: OpenOptions::default(),
        }
    }

    /// Sews the garment and drapes it to rest with nobody touching it.
    pub fn drape() -> Self {
        Self::Drape { inputs: Vec::new() }
    }

    /// Exports the existing results in the usual formats into a folder.
    pub fn export(dir: &Path) -> Self {
        Self::Export(Export::made(dir))
    }

    /// The files that the command names.
    fn files(&mut self) -> NamedFiles<'_> {
        match self {
            Self::SavePattern { path }
            | Self::WritePattern { path, .. }
            | Self::SaveBody { path } => NamedFiles::Output(path),
            Self::Export(export) => NamedFiles::Output(&mut export.dir),
            Self::OpenPattern { path, options } => NamedFiles::Pattern(path, &mut options.with),
            Self::SetBody { measurements, .. } => NamedFiles::Input(measurements.as_mut()),
            Self::SetLayers { others, .. } => NamedFiles::Garments(others),
            Self::SetFabric { fabric } => NamedFiles::Fabric(fabric.as_mut()),
            Self::SetOrigin { .. }
            | Self::NewPattern { .. }
            | Self::RestorePattern { .. }
            | Self::Edit { .. }
            | Self::Undo
            | Self::Redo
            | Self::SetMeasurements { .. }
            | Self::EditBody { .. }
            | Self::SetSize { .. }
            | Self::SetWidth { .. }
            | Self::SetQuality { .. }
            | Self::Check
            | Self::Nest
            | Self::Assemble
            | Self::Drape { .. } => NamedFiles::Input(None),
        }
    }

    /// The file or folder that the command writes, if it writes one.
    pub(crate) fn output_mut(&mut self) -> Option<&mut PathBuf> {
        match self.files() {
            NamedFiles::Output(path) => Some(path),
            NamedFiles::Pattern(..)
            | NamedFiles::Input(_)
            | NamedFiles::Garments(_)
            | NamedFiles::Fabric(_) => None,
        }
    }

    /// Passes every file that the command reads to `take`.
    pub(crate) fn each_input(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        match self.files() {
            NamedFiles::Pattern(path, with) => {
                take(path);
                with.iter_mut().for_each(take);
            }
            NamedFiles::Input(path) => path.into_iter().for_each(take),
            NamedFiles::Garments(others) => others.iter_mut().for_each(|o| take(&mut o.path)),
            NamedFiles::Fabric(Some(name)) => {
                let mut path = PathBuf::from(&*name);
                take(&mut path);
                *name = path.to_string_lossy().into_owned();
            }
            NamedFiles::Output(_) | NamedFiles::Fabric(None) => {}
        }
    }

    /// Stage of `timing.json` that the time of the command is added to (`None`: to no stage), and the
    /// command's weight in the progress of making a garment (1).
    fn work(&self) -> (Option<&'static str>, f64) {
        match self {
            Self::OpenPattern { .. } => (Some("open"), 1.0),
            Self::Check => (Some("check"), 1.0),
            Self::Nest => (Some("nest"), LAYING),
            Self::Assemble => (Some("assemble"), 4.0),
            Self::Drape { .. } => (Some("drape"), DRAPING),
            Self::Export(export) => {
                let hung = if export.takes_garment() { DRAPING } else { 0.0 };
                let laid = if export.takes_marker() { LAYING } else { 0.0 };
                (Some("export"), WRITING + hung + laid)
            }
            Self::SetOrigin { .. }
            | Self::NewPattern { .. }
            | Self::RestorePattern { .. }
            | Self::SavePattern { .. }
            | Self::WritePattern { .. }
            | Self::Edit { .. }
            | Self::Undo
            | Self::Redo
            | Self::SetBody { .. }
            | Self::SetMeasurements { .. }
            | Self::EditBody { .. }
            | Self::SaveBody { .. }
            | Self::SetSize { .. }
            | Self::SetFabric { .. }
            | Self::SetWidth { .. }
            | Self::SetQuality { .. }
            | Self::SetLayers { .. } => (None, 0.1),
        }
    }

    /// Stage of `timing.json` that the time of the command is added to.
    pub(crate) fn stage(&self) -> Option<&'static str> {
        self.work().0
    }

    /// Weight of the command in the progress of several commands (1): its rough work beside that of the
    /// others.
    pub(crate) fn weight(&self) -> f64 {
        self.work().1
    }
}
