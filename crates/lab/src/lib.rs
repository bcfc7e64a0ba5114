//! The laboratory: physical laws as small scenes, speed against accuracy, stability, benchmarks.
//! It works through the public interfaces only, and tries every method there is.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::print_stdout))]

mod accuracy;
mod bench;
mod chart;
mod chart_contact;
mod chart_data;
mod chart_plan;
mod chart_report;
mod check;
mod clock;
mod csv;
mod detect;
mod drag;
mod drag_pattern;
mod elastica;
mod error;
mod factor;
mod flat;
mod flatten;
mod freeze;
mod hard;
mod law_report;
mod laws;
mod nest;
mod propped;
mod published;
mod realtime;
mod root;
mod scenes;
mod settle;
mod shadow;
mod square;
mod stability;
mod stability_report;
mod timed;
mod tolerance;

pub use accuracy::{
    Measured, SECTIONS, Section, charts_beside, page, provenance, sections_named, write_page,
};
pub use bench::{bench, bench_names, bench_report, bench_table};
pub use chart::chart;
pub use chart_contact::{Touched, contact_chart, contact_files, contact_table};
pub use chart_data::{Agreement, ChartData, Point};
pub use chart_plan::ChartPlan;
pub use chart_report::{
    chart_files, locking_files, ready_to_write, when_to_use, with_section, write_files,
};
pub use check::{Cases, Check, table};
pub use elastica::{Elastica, heavy_elastica};
pub use error::LabError;
pub use flat::{Flat, MeshKind, disc, rectangle};
pub use freeze::{freeze, reference};
pub use hard::{HardRun, Outcome, hard_cases};
pub use law_report::law_table;
pub use laws::{Drape, LAWS, Law, Resolved, cusick, laws_named, locking, validate};
pub use propped::{Propped, propped_elastica};
pub use scenes::{Card, ClothCard, Reference, SCENES, card, subdivided};
pub use settle::{in_time, to_rest};
pub use shadow::{fold_count, shadow, shadow_area};
pub use stability::{Cell, Limit, Verdict, limits, stability_map};
pub use stability_report::{stability_files, stability_table};
pub use timed::Timed;
pub use tolerance::Tolerance;
