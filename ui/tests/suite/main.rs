//! All tests over the public interface, in one program: `cargo test -p toile-ui --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod alter;
mod bodice;
mod commands;
mod cut_line;
mod drafter;
mod drafting;
mod every_slot;
mod every_view;
mod export;
mod fabric;
mod foreign_file;
mod freehand;
#[allow(dead_code)]
#[path = "../../../crates/session/tests/suite/support/mod.rs"]
mod garments;
mod grading;
mod guide;
mod guide_reader;
mod guides_from_rulers;
mod hanging;
mod hung_anew;
mod keeping;
mod marker;
mod marker_laying;
mod paper_cuts;
mod picture;
mod pleats;
mod problems;
mod region;
mod room;
mod screens;
mod seam_sides;
mod sheets;
mod shown;
mod skirt_block;
mod suggested_seams;
mod t_shirt;
mod typed;
mod values;
mod walk;
mod wearer;
mod window;
mod worn;
