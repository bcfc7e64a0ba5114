//! Events: what a command did, for whoever gave it.

use std::path::PathBuf;
use toile_drape::Verdict;
use toile_interchange::{Format, Guess, Loss};
use toile_marker::MarkerSummary;

/// Something that happened while a command was done.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A pattern was read.
    PatternOpened,
    /// A pattern file was read; its notes are warnings of their own.
    FileRead(FoundInFile),
    /// The project has changed.
    ProjectChanged {
        /// Number of the new state of the project; it only grows.
        revision: u64,
    },
    /// The pattern was checked.
    Checked {
        /// Number of faults that keep the garment from being made.
        errors: usize,
        /// Number of faults that are probably not intended.
        warnings: usize,
    },
    /// The pieces of one fabric were laid.
    Nested(MarkerSummary),
    /// The pieces were meshed and placed.
    Assembled(Assembled),
    /// The garment was draped.
    Draped(Draped),
    /// Files were written.
    FilesWritten {
        /// Paths of the files.
        paths: Vec<PathBuf>,
    },
    /// Something needs attention.
    Warned {
        /// The fault, its place and its remedy, in plain words.
        message: String,
    },
}

/// What reading a pattern file found out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundInFile {
    /// The format.
    pub format: Format,
    /// Files that were read with it: tables of grade rules or measurements.
    pub companions: Vec<PathBuf>,
    /// Decisions on what the file leaves open.
    pub guesses: Vec<Guess>,
    /// Contents that were left out.
    pub losses: Vec<Loss>,
}

impl Event {
    /// What reading a file found out, if this event is about that.
    pub fn file_read(&self) -> Option<&FoundInFile> {
        if let Self::FileRead(found) = self {
            return Some(found);
        }
        None
    }

    /// A warning for each note.
    pub(crate) fn warnings(notes: &[String]) -> impl Iterator<Item = Self> + '_ {
        notes.iter().map(|note| Self::Warned {
            message: note.clone(),
        })
    }
}

/// A garment's mesh in a few numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembled {
    /// Number of pieces of cloth that are sewn.
    pub panels: usize,
    /// Number of vertices before seams are merged.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertex pairs that seams join.
    pub stitches: usize,
}

/// A drape in a few numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Draped {
    /// Number of steps of sewing and of settling.
    pub steps: [usize; 2],
    /// Net force over weight (1).
    pub residual: f64,
    /// Largest seam gap in the step before merging (m).
    pub seam_gap: f64,
    /// Number of connected parts of the mesh after sewing.
    pub components: usize,
    /// Number of pairs of a cloth triangle and a body triangle that intersect.
    pub body_intersections: usize,
    /// Largest stretch along warp and weft (1).
    pub strain_max: [f64; 2],
    /// Stretch along warp and weft that 99 % of the cloth stays under (1).
    pub strain_p99: [f64; 2],
    /// Verdict on the drape.
    pub verdict: Verdict,
}
