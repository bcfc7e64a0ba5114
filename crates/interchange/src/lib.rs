//! Readers and writers of the native formats and of foreign ones.
//!
//! Readers take bytes or text and return a value or a [`FormatError`] with place and remedy;
//! writers return bytes, and [`write_atomically`] writes them to the disk.

#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), deny(clippy::wildcard_enum_match_arm))]

mod atomic;
mod bvh;
mod character_json;
mod checkpoint;
mod drawn;
mod dxf;
mod error;
mod exchange;
mod fabric_file;
mod fabric_test;
mod file_kind;
mod frames;
mod garmentcode;
mod gltf;
mod gltf_body;
mod gltf_frames;
mod hpgl;
mod jagua;
mod mannequin_json;
mod marker_drawing;
mod marker_json;
mod marker_label;
mod marker_plot;
mod marker_report;
mod marker_settings;
mod marker_strokes;
mod marker_svg;
mod measurements_foreign;
mod measurements_formulas;
mod measurements_garmentcode;
mod measurements_json;
mod measurements_seamly;
mod mesh_read;
mod native;
mod obj;
mod obj_read;
mod part_names;
mod pc2;
mod pdf;
mod pdf_fonts;
mod ply;
mod polygon;
mod print;
mod proportions;
mod recognise;
mod scene;
mod scene_material;
mod scene_motion;
mod settings_reader;
mod shown;
mod svg;
mod svg_text;
mod valentina;
mod x3d;
mod x3d_nodes;
mod x3d_vrml;
mod x3d_xml;
mod xml;

pub use atomic::{
    check_folder, sweep_unfinished, write_all_atomically, write_atomically, write_new_atomically,
};
pub use bvh::read_bvh;
pub use character_json::{read_character, write_character};
pub use checkpoint::{CheckpointFormat, read_checkpoint, write_checkpoint};
pub use error::{FileError, FormatError, read_text};
pub use exchange::{
    Companion, Content, Format, Guess, Loss, ReadOption, ReadOptions, Reading, SizedDraft,
    WriteSource, Writing, Written, companion_names, contents, format_tables, read, write,
};
pub use fabric_file::{FabricFile, read_fabric};
pub use fabric_test::{FabricTest, read_fabric_test};
pub use file_kind::FileKind;
pub use frames::{
    Frame, FrameHead, FrameSection, FrameSurface, FrameWriter, Frames, RestShape, read_frames,
};
pub use garmentcode::{
    GarmentCodeReading, GarmentCodeWriting, read_garmentcode, write_garmentcode,
};
pub use gltf::{GlbMesh, GlbPrimitive, GlbScene, write_glb};
pub use gltf_body::write_body_glb;
pub use gltf_frames::{MovingGlbMesh, write_frames_glb};
pub use jagua::{JaguaInstance, is_jagua_instance, read_jagua, write_jagua, write_jagua_instance};
pub use mannequin_json::{read_mannequin, write_mannequin};
pub use marker_drawing::{MarkerDrawing, MarkerFacts, MarkerPiece};
pub use marker_json::{
    MarkerFabric, MarkerFile, MarkerFilePiece, MarkerFileUnplaced, MarkerFlaw, MarkerFold,
    MarkerMatch, MarkerPrint, read_marker_json, write_marker_json,
};
pub use marker_plot::{write_marker_dxf, write_marker_hpgl, write_marker_pdf};
pub use marker_report::write_marker_report;
pub use marker_settings::{
    ANY_NAME, LockSettings, MarkerSettings, PieceSettings, read_marker_settings,
};
pub use marker_svg::write_marker_svg;
pub use measurements_foreign::read_freesewing;
pub use measurements_garmentcode::read_body_yaml;
pub use measurements_json::{read_measurements, read_sized_measurements, write_measurements};
pub use measurements_seamly::{SizeChoice, read_seamly};
pub use mesh_read::read_mesh;
pub use native::{
    FABRIC_WIDTHS, Fitting, FittingFabric, FittingLayer, FittingWearer, PatternFile, read_document,
    read_pattern, write_document, write_pattern,
};
pub use obj::{ObjGroup, ObjMesh, write_obj};
pub use obj_read::read_obj;
pub use pc2::{PointCache, read_pc2, write_pc2};
pub use ply::read_ply;
pub use print::{Lines, Paper, PrintJob, PrintLayer, PrintPiece, Tile, TitleBlock};
pub use proportions::{proportion_boxes, read_proportions};
pub use recognise::ExpectedKind;
pub use scene::{
    AirFile, DampingFile, ElasticFile, EndFile, MeshesFile, ObjectFile, SceneFile, TransformFile,
    read_scene,
};
pub use scene_material::MaterialFile;
pub use scene_motion::{GripFile, KeyFile, MotionFile};
pub use shown::Shown;
pub use x3d::read_x3d;
