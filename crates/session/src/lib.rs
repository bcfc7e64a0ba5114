//! The application without a window: project, commands, history, journal, and the one function
//! that turns draft, fabrics and mannequin into a drape.
//!
//! Only the [`Project`] is edited, saved and undone. Draft, marker, garment and drape are derived
//! from it, kept while it does not change, and may be thrown away.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), deny(clippy::wildcard_enum_match_arm))]

mod batch;
mod bodies;
mod choice;
mod clips;
mod command;
mod convert;
mod crossings;
mod crumple;
mod derived;
mod digest;
mod drafted;
mod drape;
mod dressed_figure;
mod error;
mod event;
mod export;
mod export_format;
mod fabrics;
mod figure_track;
mod file_stamp;
mod fitting;
mod flattening;
mod frame_counts;
mod frames_export;
mod garment_edit;
mod gesture;
mod given_values;
mod history;
mod input;
mod interactive_run;
mod journal;
mod journal_files;
mod live;
mod log;
mod mannequin_source;
mod marker_cache;
mod marker_file_check;
mod markers;
mod mesh_file;
mod nest_patterns;
mod open;
mod outfit;
mod output;
mod pace;
mod paths;
mod perform;
mod pictures;
mod piece_facts;
mod placed_panels;
mod printing;
mod product;
mod project;
mod put_on;
mod realtime;
mod recorded_surface;
mod recorder;
mod recovery;
mod report;
mod rest_change;
mod scene;
mod scene_builder;
mod scene_checkpoint;
mod scene_figures;
mod scene_frames;
mod scene_pictures;
mod scene_place;
mod seams_in_sizes;
mod session;
mod setup;
mod sizes;
mod snapshot;
mod state_picture;
mod stored_marker;
mod stuck;
mod study;
mod suggested_seams;
mod timing;
mod tools;
mod verdict;
mod watched_search;
mod watcher;
mod write_options;
mod write_pattern;

pub use batch::{
    BatchFolder, BatchRun, CheckArguments, Ended, Job, JobOutcome, JobResult, Limits, Part, Report,
    Spec, Work, do_job, list_jobs, run_batch,
};
pub use bodies::{edit_body, open_body_edits, proportions_named, proportions_of_heads};
pub use choice::{BodyChoice, Quality, figure_named};
pub use command::{Command, OtherGarment};
pub use convert::{ConvertOptions, Converted, convert};
pub use drafted::{DraftedEdge, DraftedNotch, DraftedPattern, DraftedPiece, DraftedSeam};
pub use drape::DrapeResult;
pub use error::SessionError;
pub use event::{Assembled, Draped, Event, FoundInFile};
pub use export_format::{Export, ExportFormat};
pub use fabrics::{FabricChoice, library_fabric, library_origin, with_hardening};
pub use fitting::OpenedProject;
pub use flattening::{
    DartReport, FlatSurface, FlattenOptions, FlattenReport, SkinLoop, SurfaceSource,
    flatten_to_panel,
};
pub use frames_export::{FramesExport, FramesOutcome, export_frames};
pub use garment_edit::{CannotFollow, GarmentEdit};
pub use history::HistoryStep;
pub use input::is_input;
pub use interactive_run::{let_go_of_vertex, pull_vertex};
pub use journal::{journal_lines, read_journal};
pub use journal_files::open_journal;
pub use live::{LiveFrame, LiveRun};
pub use log::{is_logging, start_log};
pub use marker_file_check::{JudgedMarker, is_marker_file, judge_marker_file};
pub use markers::{FoundMarker, MarkerSearch, kept_words, other_sizes_words};
pub use nest_patterns::{
    LaidCopy, LaidPatterns, is_nesting_instance, lay_projects, nest_instance, nest_patterns,
    open_marker_settings,
};
pub use open::{
    FileUse, OpenOptions, SAMPLE, SAMPLES, file_use, open_mannequin, open_marker,
    open_measurements, open_pattern, read_input, read_pattern_text,
};
pub use outfit::GarmentPart;
pub use output::File;
pub use piece_facts::{
    DartFacts, EdgeFacts, JointFacts, NotchFacts, PieceFacts, RegionFacts, SeamFacts, piece_facts,
    seam_facts,
};
pub use placed_panels::PanelOrigin;
pub use printing::{PrintOptions, Printed, print_job, print_pattern};
pub use project::{Project, WornGarment};
pub use realtime::{Adjustment, RealtimeKey, RealtimeRun, RealtimeSurface, woman_character};
pub use recovery::{Abandoned, PastStep, Recovery, abandoned, state_folder};
pub use rest_change::RestChange;
pub use scene::{SceneOutcome, run_scene};
pub use scene_checkpoint::RunOptions;
pub use scene_pictures::{PictureOptions, PictureTime};
pub use seams_in_sizes::{SeamInSizes, SeamNotch, SizedSeam, seams_in_sizes};
pub use session::Session;
pub use setup::{GarmentJob, JobPanel, JobSeam};
pub use sizes::SizedDiagnostic;
pub use stored_marker::{MarkerJob, nest_marker};
pub use study::{RuleCost, rule_table, study_rules};
pub use suggested_seams::{
    AcceptedSeams, EdgeOfPiece, PairOfEdges, SeamOptions, SuggestedSeamsReport, Suggestion,
    suggested_seams,
};
pub use timing::cpu_seconds;
pub use toile_assembly::Garment;
pub use toile_body::{
    AskedStance, Axis, Description, Figure, Fit, MeshUnit, PrimitiveEdit, ProportionBox, Scaling,
};
pub use toile_cut::{CutList, CutListPiece, CutPiece, Drawing, Shrinkage, Stroke, StrokeKind};
pub use toile_drape::{Aspect, Finding, Stage, Verdict};
pub use toile_interchange::{
    ExpectedKind, Format, FormatError, Guess, Lines, Loss, MarkerSettings, ObjMesh, Paper,
    ReadOption, ReadOptions, Reading, Shown, SizeChoice, Tile, write_atomically,
};
pub use toile_marker::{
    DocumentMarker, FinishedMarker, Found, GivenFlaw, LaidPiece, LetGo, MarkerError, MarkerFormat,
    MarkerState, MarkerSummary, NestOptions, Obstacle, PieceOutside, PieceOverlap, SearchProgress,
    SearchWatcher, Start, WaitingPiece,
};
pub use toile_measure::{Measurements, Origin};
pub use toile_nesting::{Budget, Pose, Search, Side, Strip};
pub use toile_pattern::fields::Choice;
pub use toile_pattern::{ClothSettings, NapRule, Print, Roll, Severity, SizeSelection, Spread};
pub use toile_pattern::{Diagnostic, DisplayUnit};
pub use tools::{
    BodyReport, BodySource, BodyStretch, MeshMeasured, Moment, PersonFile, fit_mesh, make_body,
    measure_mesh, mesh_panels, stretch_body,
};
pub use watcher::{Silent, Watcher};
pub use write_options::WriteOptions;
pub use write_pattern::{WrittenPattern, write_project};
